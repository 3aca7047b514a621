"""Settings of single experiments that are refused, with what is said of them."""

from dataclasses import replace
from math import nan

import pytest

from suchus.core.errors import InvalidDesign
from suchus.experiments.catalog import EXPERIMENTS


@pytest.mark.parametrize(
    ("name", "fields", "message"),
    [
        ("spine_kinematics", {"postures": 0}, "postures is 0; a whole number of 1"),
        ("leg_kinematics", {"points": 0, "grid": 1}, "grid is 1; a whole number of 2"),
        ("feedback", {"starts": 0, "hold": nan}, "hold is nan cycle"),
        ("feedback", {"push": (0.0, 1.0)}, "forward, left, up need one each"),
        ("joint_faults", {"holds": (0.5, 0.2)}, "increasing numbers within 0 to 1"),
        ("joint_faults", {"repeats": 0}, "repeats is 0"),
        ("speed_range", {"slower": (0.0,)}, "increasing numbers within 0.1 to 10"),
        ("speed_range", {"gaits": ()}, "gaits is empty"),
        ("turning", {"asked": (-1.0,)}, "asked is"),
        ("turning", {"cycles": 0}, "cycles is 0"),
        ("terrain", {"bumps": (9.0,)}, "bumps is"),
        ("terrain", {"seeds": 0, "walked": 0.0}, "seeds is 0"),
        ("terrain", {"surfaces": ()}, "even or bumps is needed"),
    ],
)
def test_impossible_settings_are_refused_before_anything_runs(name, fields, message):
    with pytest.raises(InvalidDesign, match=message):
        replace(EXPERIMENTS[name], **fields)

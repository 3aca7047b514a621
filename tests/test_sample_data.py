"""Sample data can be read, and says what it was made with."""

import re
import sys
from pathlib import Path

import pytest

import suchus
from suchus.animals.capture import observe, read_tracks
from suchus.core.errors import UnknownName
from suchus.core.samples import SAMPLES
from suchus.sim.model.importing import import_robot

sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))
from pages.blocks import blocks, follow


def test_every_sample_is_there_and_every_file_has_a_name():
    folder = suchus.sample("lizard").parent
    assert {path.name for path in folder.iterdir() if path.suffix not in (".py", "")} == set(SAMPLES.values())
    assert all(suchus.sample(name).is_file() for name in SAMPLES)


def test_a_name_that_there_is_not_is_refused_with_those_that_there_are():
    with pytest.raises(UnknownName, match="cat") as refused:
        suchus.sample("cat")
    assert all(name in str(refused.value) for name in SAMPLES)


def test_the_lizard_walks_as_it_was_made():
    walk = observe(read_tracks(suchus.sample("lizard")))
    assert walk.value("duty_LF") == pytest.approx(0.7, abs=0.03)
    assert [walk.value(f"phase_{leg}") for leg in ("RF", "LH", "RH")] == pytest.approx([0.5, 0.25, 0.75], abs=0.02)
    assert walk.value("tail_lag") == pytest.approx(1 / 3, abs=0.02)


def test_the_page_on_capture_reads_the_lizard():
    page = (Path(__file__).parents[1] / "docs" / "capture.md").read_text(encoding="utf-8")
    shown = re.findall(r"^```(?:python|text)\n.*?^```$", page, re.S | re.M)
    assert 'sample("lizard")' in blocks(shown[0])[0].text
    follow("\n".join(shown[:2]))


def test_the_quadruped_has_four_legs_of_three_joints():
    robot = import_robot(suchus.sample("quadruped"), name="dog").robot
    assert len(robot.girdles) == 2
    assert robot.mass == pytest.approx(8.0 + 4 * 1.95)

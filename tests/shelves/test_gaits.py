"""What holds for every gait on the shelf."""

from dataclasses import fields
from importlib import import_module

import numpy as np
import pytest

from suchus.gaits import GAITS
from suchus.motion import check_limits, servo_targets

PHASES = np.arange(64)[:, None] / 64
LEFT_RIGHT = [3, 4, 5, 0, 1, 2, 9, 10, 11, 6, 7, 8]


@pytest.fixture(params=list(GAITS))
def shelved(request):
    return GAITS[request.param]


def test_it_is_called_by_its_file_name(shelved):
    assert GAITS[shelved.name] is shelved


def test_the_robot_can_follow_it(shelved, robot):
    check_limits(robot, shelved)


def test_it_repeats_after_one_cycle(shelved, robot):
    phase = PHASES + np.array(shelved.limb_phases)
    assert servo_targets(robot, shelved, phase) == pytest.approx(servo_targets(robot, shelved, phase + 1), abs=1e-9)


def test_its_mirror_image_mirrors_every_servo(shelved, robot):
    phase = PHASES + np.array(shelved.limb_phases)
    there = servo_targets(robot, shelved, phase)
    back = servo_targets(robot, shelved.mirrored(), PHASES + np.array(shelved.mirrored().limb_phases))
    assert there[:, LEFT_RIGHT] == pytest.approx(back[:, :12], abs=1e-12)
    assert there[:, [12, 14, 16, 18]] == pytest.approx(-back[:, [12, 14, 16, 18]], abs=1e-12)
    assert there[:, 17] == pytest.approx(back[:, 17])


def test_every_number_not_from_the_article_has_a_range_and_a_reason(shelved):
    chosen = {entry.field for entry in import_module(f"suchus.gaits.{shelved.name}").chosen}
    assert chosen == {field.name for field in fields(shelved)} - {"name", "period", "limb_phases", "legs"}

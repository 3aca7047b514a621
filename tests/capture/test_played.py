"""Measured joint angles as a gait: every column to its servo with the right sign."""

from pathlib import Path

import numpy as np
import pytest

from suchus.animals.capture import read_angles, to_curves
from suchus.core.errors import OutsideLimits, UnknownName
from suchus.robot.design import layout
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS

TABLE = Path(__file__).parent.parent / "data" / "animals" / "salamander_walking.csv"
"""Karakasiliotis et al. 2013, Biol. Cybern. 107, 529, as processed in AlexPazzaglia/SalamandraSNN (MIT)."""


def cycle(tmp_path, columns, count=40):
    phase = np.arange(count) / count
    rows = [f"time,{','.join(columns)}"]
    rows += [",".join([f"{p}", *(f"{np.degrees(wave(p)):.9f}" for wave in columns.values())]) for p in phase]
    path = tmp_path / "angles.csv"
    path.write_text("\n".join(rows) + "\n")
    return read_angles(path)


def swung(late=0.0):
    return lambda p: 0.3 * np.cos(2 * np.pi * (p - late))


def test_the_gait_of_the_shelf_is_what_capture_makes_of_the_published_table():
    made = to_curves(read_angles(TABLE), ROBOTS["salamander"], name="animal_walk", period=1.0)
    assert made == GAITS["animal_walk"]


def test_columns_reach_their_servos_with_the_layouts_signs(tmp_path):
    robot = ROBOTS["salamander"]
    place = layout(robot)
    columns = {"Axis 2": swung(), "axis 5": swung(), "Left Shoulder-roll": swung(), "Right Knee": swung()}
    gait = to_curves(cycle(tmp_path, columns), robot, name="a", period=1.0)
    at = {curve.servo: float(curve.angle_at(np.array(0.0))) for curve in gait.curves}
    # concave on the right: ahead of the root the front end turns right (-), behind it the rear end turns right (+)
    assert at == pytest.approx({"spine_yaw_2": -0.3, "tail_yaw_2": 0.3, "LF_roll": 0.3, "RH_elbow": 0.3}, abs=1e-3)
    assert place.axial_left[1] == 1.0
    assert place.axial_left[4] == -1.0


def test_a_limb_swings_while_its_foot_goes_forward(tmp_path):
    columns = {"LF_yaw": swung(0.25), "RF_yaw": swung(0.75), "LH_yaw": swung(), "RH_yaw": swung(0.5)}
    gait = to_curves(cycle(tmp_path, columns), ROBOTS["salamander"], name="a", period=1.0)
    # a foot is foremost at its lateness and hindmost half a cycle before: there its swing begins
    assert gait.limb_phases == pytest.approx((0.25, 0.75, 0.5, 0.0), abs=0.006)
    assert gait.duty_factor == pytest.approx(0.5, abs=0.006)


def test_columns_of_nobody_and_of_the_same_servo_are_refused(tmp_path):
    robot = ROBOTS["salamander"]
    with pytest.raises(UnknownName, match=r"named 'Axis 9'.*Axis 1 to 8.*Left Hip-yaw"):
        to_curves(cycle(tmp_path, {"Axis 9": swung()}), robot, name="a", period=1.0)
    with pytest.raises(UnknownName, match="named 'Left Hip-yaw'"):
        to_curves(cycle(tmp_path, {"Left Hip-yaw": swung()}), ROBOTS["swimmer"], name="a", period=1.0)
    with pytest.raises(OutsideLimits, match="two columns for servo neck_yaw_1"):
        to_curves(cycle(tmp_path, {"Axis 1": swung(), "neck_yaw_1": swung()}), robot, name="a", period=1.0)

"""Zeros that an exporter writes when nothing was filled in are said once, and are no limits."""

from pathlib import Path

import numpy as np
import pytest
from hinge_trees import GYRATION, quadruped

from suchus.robot.design import Servo
from suchus.robot.design.scale import servo_for
from suchus.sim.model.importing import import_robot

FILES = Path(__file__).parent.parent / "data" / "imports"


def read(text, tmp_path):
    file = tmp_path / "it.urdf"
    file.write_text(text)
    return import_robot(file, name="it")


def zero_notes(draft):
    return [text for text in draft.remarks if "not filled in" in text]


def test_limits_of_zero_are_one_note_and_ranges_torques_and_speeds_are_guesses(capfd):
    draft = import_robot(FILES / "zero_limits.urdf", name="walker")
    (note,) = zero_notes(draft)
    assert "lower and upper, effort, velocity of all 12 joints are zero, equal or missing" in note
    assert "range, torque, speed are guesses" in note
    servo = servo_for(draft.robot.mass, draft.robot.length)
    for girdle in draft.robot.girdles:
        for hinge in girdle.limb.hinges:
            assert isinstance(hinge.drive, Servo)
            assert (hinge.drive.torque, hinge.drive.speed) == pytest.approx((servo.torque, servo.speed))
            assert hinge.range == pytest.approx((-np.pi, np.pi), abs=1e-3)
    assert capfd.readouterr() == ("", "")  # MuJoCo's own warnings are no notes
    ranges = [text for path, text in draft.notes.items() if path.endswith(".range")]
    assert ranges == ["guess: the file gives no limits"] * 6


def test_a_file_that_is_filled_in_gets_no_such_note(tmp_path):
    assert not zero_notes(read(quadruped(), tmp_path))
    assert not zero_notes(import_robot(FILES / "walker.urdf", name="walker"))


def test_what_is_missing_at_some_joints_is_named(tmp_path):
    text = quadruped().replace('lower="-2.7" upper="-0.9"', 'lower="0" upper="0"')
    (note,) = zero_notes(read(text, tmp_path))
    assert note.startswith("lower and upper of FL_knee, FR_knee, RL_knee, RR_knee are zero")
    speeds = quadruped().replace(' velocity="15"', "")
    (note,) = zero_notes(read(speeds, tmp_path))
    assert note.startswith("velocity of all 12 joints is zero, equal or missing")
    efforts = quadruped().replace('effort="30.0"', 'effort="0"')
    (note,) = zero_notes(read(efforts, tmp_path))
    assert note.startswith("effort of all 12 joints is zero")
    before, knee, after = quadruped().partition('<joint name="FL_knee"')
    passive = read(before + knee + after.replace('effort="30.0"', 'effort="0"', 1), tmp_path)
    assert not zero_notes(passive)  # one joint without effort beside others is one that nothing drives


def test_an_inertia_of_zero_is_that_of_the_shapes(tmp_path):
    moment = f'ixx="{GYRATION**2 * 8.0}" iyy="{GYRATION**2 * 8.0}" izz="{GYRATION**2 * 8.0}"'
    assert moment in quadruped()
    draft = read(quadruped().replace(moment, 'ixx="0" iyy="0" izz="0"'), tmp_path)
    (note,) = zero_notes(draft)
    assert "The inertia of base is zero" in note
    assert draft.robot.axis[0].inertia is None
    assert read(quadruped(), tmp_path).robot.axis[0].inertia is not None

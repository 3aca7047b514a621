"""Servos identified from motion: numbers with sources, friction as BAM has it, and what our rule makes of them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.core.errors import InvalidDesign, SuchusError, UnknownName
from suchus.robot.motors import motors
from suchus.robot.motors.identified import (
    identifications_of,
    identified_servo,
    identified_servos,
    identified_table,
    rule_ratios,
)

PAGE = Path(__file__).parents[2] / "docs" / "servos.md"
COMPLETE = [name for name, servo in identified_servos().items() if not servo.missing]
TORQUES = st.floats(-5.0, 5.0)


def test_published_numbers():
    """Rhoban/bam at the commits that the file names; the design note of the issue."""
    small, large = identified_servo("STS3215 7.4 V, m1"), identified_servo("MX-106 12 V, m6")
    assert (small.armature, small.friction, small.damping) == (0.02608, 0.05152, 0.05989)
    assert (small.torque_constant, small.resistance, small.delay) == (1.1776, 2.479, 0.0010469)
    assert small.stall_torque == pytest.approx(3.516, abs=0.02)
    assert large.stribeck_speed == pytest.approx(1.74633, abs=1e-5)
    assert identified_servo("ST3025 12 V, m4").heldout_error == 0.019208
    assert all(servo.source.startswith("https://") for servo in identified_servos().values())


def test_the_rule_lies_between_the_identified_servos():
    """It is their mean; single servos differ from it, in the commonest one by more than two."""
    ratios = rule_ratios()
    assert ratios["STS3215 7.4 V, m1"][0] == pytest.approx(2.43, rel=0.01)
    assert ratios["STS3215 7.4 V, m6"][0] == pytest.approx(2.06, rel=0.01)
    assert ratios["ST3025 12 V, m1"][0] == pytest.approx(0.27, rel=0.02)
    assert ratios["XL330 5 V, m1"][0] == pytest.approx(1.24, rel=0.01)
    assert ratios["STS3215 7.4 V, m1"][1] == pytest.approx(0.97, rel=0.01)
    assert np.isnan(ratios["STS3215 7.4 V, m6"][1])
    members = ("STS3215 7.4 V, m1", "ST3025 12 V, m1", "XL330 5 V, m1", "MX-64 12 V, m1", "MX-106 12 V, m1")
    friction = [ratios[name][1] for name in members]
    inertia = [ratios[name][0] for name in (*members, "XL-320 7.4 V, m6")]
    for factors in (friction, inertia):
        assert np.exp(np.mean(np.log(factors))) == pytest.approx(1.0, rel=0.01)


def test_friction_of_motor_and_load_by_hand():
    servo = identified_servo("MX-64 12 V, m6")
    still = servo.friction + 0.3114720375111298 * 2.0 + 0.12269525980968875 + 0.18774381222411038 * 2.0
    assert servo.friction_torque(2.0, 0.0, 0.0) == pytest.approx(still, rel=1e-5)
    assert servo.friction_torque(2.0, 0.0, 1e3) == pytest.approx(servo.friction + 0.311472 * 2.0, rel=1e-5)
    back = servo.friction_torque(2.0, -1.0, 0.0) - servo.friction_torque(2.0, 1.0, 0.0)
    linear = 2.0 * 1.0 * (2.0462e-08 + 0.0140658535)
    assert back == pytest.approx(linear + 0.00999998 * 1.0**2, rel=1e-3)  # the load's square, since the motor drives
    driven = servo.friction_torque(1.0, -2.0, 0.0) - servo.friction_torque(1.0, 2.0, 0.0)
    linear = 2.0 * 2.0 * (2.0462e-08 + 0.0140658535)
    assert driven == pytest.approx(linear + 0.00690851 * 1.0**2, rel=1e-3)  # the motor's square, since the load drives
    m1 = identified_servo("MX-64 12 V, m1")
    assert m1.friction_torque(3.0, -3.0, 0.0) == m1.friction


@pytest.mark.parametrize("name", COMPLETE)
@given(motor=TORQUES, load=TORQUES, speed=st.floats(-10.0, 10.0))
def test_friction_is_the_same_both_ways_and_least_far_from_rest(name, motor, load, speed):
    servo = identified_servo(name)
    friction = servo.friction_torque(motor, load, speed)
    assert friction >= servo.friction
    assert friction == pytest.approx(servo.friction_torque(-motor, -load, -speed))
    assert friction <= servo.friction_torque(motor, load, 0.0) + 1e-12


def test_numbers_that_a_source_does_not_give_are_named_and_not_made_up():
    servo = identified_servo("STS3215 7.4 V, m6")
    assert servo.stribeck_friction is None
    with pytest.raises(InvalidDesign, match=r"STS3215 7.4 V, m6 has no stribeck_friction, .* take its model m1"):
        servo.friction_torque(1.0, 0.0, 0.0)


def test_bad_input_is_a_sentence():
    servo = identified_servo("XL330 5 V, m1")
    with pytest.raises(SuchusError, match="source is empty; say where its numbers come from"):
        replace(servo, source=" ")
    with pytest.raises(SuchusError, match="armature"):
        replace(servo, armature=-1.0)
    with pytest.raises(SuchusError, match="which is not sold"):
        replace(servo, motor="STS9999")
    with pytest.raises(UnknownName, match="XL330"):
        identified_servo("XL330 5 V, m2")


def test_makers_numbers_stand_beside_them():
    sold = identifications_of("STS3215-7.4V")
    assert [servo.model for servo in sold] == ["m1", "m6"]
    assert sold == identifications_of(motors()["STS3215-7.4V"])
    assert identifications_of("STS3250") == ()
    maker = motors()["STS3215-7.4V"].stall_torque
    assert all(servo.stall_torque > 1.7 * maker for servo in sold)  # at 7.4 V, friction not taken off


def test_the_page_shows_the_table_as_the_file_gives_it():
    assert identified_table() in PAGE.read_text(encoding="utf-8")

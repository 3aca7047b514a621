"""Gains from inertia, delay and control period, and the rule for servos that nobody identified."""

from dataclasses import replace
from math import exp, log, pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from suchus.core.errors import InvalidDesign
from suchus.robot.design import Servo, with_named_servos
from suchus.robot.motors import motor
from suchus.robot.motors.identified import identified_servo, identified_servos
from suchus.robot.motors.servo_parameters import (
    MAX_STEP_ANGLE,
    MIN_PHASE_MARGIN,
    estimated_parameters,
    loop_gains,
    phase_margin,
    servo_parameters,
)
from suchus.robot.robots import ROBOTS, caiman
from suchus.sim.model import compile_model

LEG = ROBOTS["caiman"].servo("LF_yaw")


def step_response(inertia, damping, gains, delay, seconds=1.5, step=1e-5):
    """Return the angle after a step of the goal of 1 rad, the loop's torque being late by a delay."""
    late = round(delay / step)
    torques = np.zeros(late + 1)
    angle = speed = 0.0
    angles = np.empty(round(seconds / step))
    for k in range(len(angles)):
        torques[k % (late + 1)] = gains.kp * (1.0 - angle) - gains.kd * speed
        torque = torques[(k + 1) % (late + 1)] if k >= late else 0.0
        speed += step * (torque - damping * speed) / inertia
        angle += step * speed
        angles[k] = angle
    return angles


def test_the_margin_of_a_loop_without_delay_is_that_of_textbooks():
    """Ogata: PD control of a double integrator with w = 1 and ratio 1: crossover at sqrt(2 + sqrt 5), 76.3 degrees."""
    crossover = (2.0 + 5.0**0.5) ** 0.5
    assert phase_margin(1.0, 0.0, 1.0, 2.0, 0.0) == pytest.approx(np.arctan(2.0 * crossover), rel=1e-12)
    assert phase_margin(1.0, 0.0, 1.0, 2.0, 0.1) == pytest.approx(np.arctan(2.0 * crossover) - 0.1 * crossover)


@settings(max_examples=60, deadline=None)
@given(
    inertia=st.floats(1e-4, 0.1), stiffness=st.floats(0.1, 500.0), delay=st.floats(0.0, 0.05),
    control_period=st.floats(0.001, 0.05), damping=st.floats(0.0, 0.2),
)  # fmt: skip
def test_gains_keep_both_margins_and_take_all_the_stiffness_that_they_can(
    inertia, stiffness, delay, control_period, damping
):
    gains = loop_gains(inertia, stiffness, delay=delay, control_period=control_period, damping=damping)
    assert gains.kp <= stiffness * (1 + 1e-12)
    assert gains.phase_margin >= MIN_PHASE_MARGIN - 1e-9
    assert gains.natural_frequency * control_period <= MAX_STEP_ANGLE * (1 + 1e-9)
    if gains.kp < 0.999 * stiffness:  # one of the two is met
        at_margin = gains.phase_margin < MIN_PHASE_MARGIN + 1e-3
        assert at_margin or gains.natural_frequency * control_period > MAX_STEP_ANGLE - 1e-3


@pytest.mark.parametrize("name", ["STS3215 7.4 V, m1", "XL330 5 V, m1", "MX-106 12 V, m1"])
def test_a_loop_with_its_delay_settles_and_with_ten_times_the_gains_rings(name):
    servo = identified_servo(name)
    gains = loop_gains(servo.armature, 1e4, delay=0.01, control_period=0.01, damping=servo.damping)
    angles = step_response(servo.armature, servo.damping, gains, 0.015)
    assert angles.max() < 1.4
    assert np.abs(angles[-20000:] - 1.0).max() < 0.02
    rash = replace(gains, kp=10 * gains.kp, kd=10**0.5 * gains.kd)
    ringing = step_response(servo.armature, servo.damping, rash, 0.015, seconds=0.5)
    assert np.abs(ringing[-20000:] - 1.0).max() > 1.0


def test_mujoco_gets_what_was_identified():
    identified = identified_servo("STS3215 7.4 V, m1")
    servo = servo_parameters(identified, LEG)
    assert (servo.armature, servo.friction, servo.damping) == (0.02608, 0.05152, 0.05989)
    assert (servo.torque, servo.speed, servo.winding) == (LEG.torque, LEG.speed, LEG.winding)
    assert servo.kp == LEG.kp
    assert servo.kd == pytest.approx(2.0 * (servo.kp * servo.armature) ** 0.5 - servo.damping)
    assert servo.kd > 1.3 * LEG.kd
    caiman = ROBOTS["caiman"]
    model = compile_model(with_named_servos(caiman, {"LF_yaw": servo}))
    dof = int(model.joint("LF_yaw").dofadr[0])
    assert model.dof_armature[dof] == 0.02608
    assert model.dof_frictionloss[dof] == 0.05152
    assert model.dof_damping[dof] == 0.05989


def test_a_long_delay_takes_stiffness_and_a_load_adds_friction():
    identified = identified_servo("MX-64 12 V, m6")
    late = servo_parameters(identified, LEG, delay=0.05)
    assert late.kp < 0.5 * LEG.kp
    loaded = servo_parameters(identified, LEG, load=2.0)
    assert loaded.friction == identified.friction_torque(2.0, -2.0, 1.0)
    assert loaded.friction > 0.5
    with pytest.raises(InvalidDesign, match="stribeck"):
        servo_parameters(identified_servo("STS3215 7.4 V, m6"), LEG, load=1.0)


def test_the_rule_for_others_misses_identified_servos_by_the_factor_that_it_says():
    """Each servo is predicted from the others."""
    chosen = [
        servo for name, servo in identified_servos().items()
        if servo.model == "m1" or f"{name.partition(',')[0]}, m1" not in identified_servos()
    ]  # fmt: skip
    assert len(chosen) == 6
    for quantity, members in (
        ("armature", chosen), ("friction", [s for s in chosen if s.model == "m1"]),
        ("damping", [s for s in chosen if s.model == "m1"]),
    ):  # fmt: skip
        misses = []
        for servo in members:
            others = [log(getattr(s, quantity) / s.stall_torque) for s in members if s is not servo]
            misses.append(log(getattr(servo, quantity) / (servo.stall_torque * exp(np.mean(others)))))
        estimate = estimated_parameters(3.0)[quantity]
        assert estimate.factor == pytest.approx(exp(np.sqrt(np.mean(np.square(misses)))), rel=1e-9)
        assert 1.2 < estimate.factor < 4.0
        mean = exp(np.mean([log(getattr(s, quantity) / s.stall_torque) for s in members]))
        assert estimate.value == pytest.approx(3.0 * mean, rel=1e-9)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: loop_gains(0.0, 40.0, delay=0.0, control_period=0.01), "inertia"),
        (lambda: loop_gains(0.01, 40.0, delay=-1.0, control_period=0.01), "delay"),
        (lambda: loop_gains(0.01, 40.0, delay=0.0, control_period=0.0), "control_period"),
        (lambda: estimated_parameters(0.0), "stall_torque"),
        (lambda: servo_parameters(identified_servo("XL330 5 V, m1"), LEG, load=-1.0), "load"),
    ],
)
def test_numbers_out_of_range_are_refused(make, words):
    with pytest.raises(InvalidDesign, match=words):
        make()


def test_critical_damping_is_what_it_says():
    gains = loop_gains(0.02, 10.0, delay=0.0, control_period=0.001)
    assert gains.kd**2 == pytest.approx(4 * gains.kp * 0.02)
    assert gains.natural_frequency == pytest.approx((10.0 / 0.02) ** 0.5)
    assert gains.phase_margin < pi / 2


def test_a_servo_that_is_bought_has_the_mean_of_the_identified_ones():
    """The rule of ``Servo.from_motor``, and with it the robot of the catalog."""
    bought = motor("STS3250")
    estimates = estimated_parameters(bought.stall_torque)
    for servo in (Servo.from_motor(bought), ROBOTS["caiman"].servo("LH_pitch")):
        for name, estimate in estimates.items():
            assert getattr(servo, name) == pytest.approx(estimate.value, rel=0.01), name


def test_the_ranges_of_the_catalog_are_one_standard_deviation():
    estimates = estimated_parameters(motor("STS3250").stall_torque)
    rows = {row.field: row for row in caiman.chosen}
    for name, estimate in estimates.items():
        row = rows[f"hind_leg.servo.{name}"]
        assert row.low == pytest.approx(estimate.value / estimate.factor, rel=0.05), name
        assert row.high == pytest.approx(estimate.value * estimate.factor, rel=0.05), name

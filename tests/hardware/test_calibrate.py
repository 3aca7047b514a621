"""A robot that was built otherwise than its file says is found out; a log gives back what made it."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from tests.wires import Obedient, wiring

from suchus.core.errors import BusFailure, IncompatibleRecord, InvalidDesign
from suchus.hardware import BusClock, Rig
from suchus.hardware.calibrate import NUDGE, find_wiring, find_zeros, fit_log, fits_text
from suchus.hardware.emulator import Emulator, MemoryPort, Trouble
from suchus.robot.design import layout
from suchus.robot.robots import ROBOTS

ROBOT = ROBOTS["caiman"]
NAMES = layout(ROBOT).servos


def misbuilt(protocol="dynamixel"):
    """Return a wiring with two servos swapped, one the other way round, and one mounted some teeth off."""
    right = wiring(protocol)
    numbers = {one.name: one.id for one in right.servo}
    ids = {"spine_yaw_1": numbers["spine_yaw_2"], "spine_yaw_2": numbers["spine_yaw_1"]}
    servo = [replace(one, id=ids.get(one.name, one.id)) for one in right.servo]
    servo = [replace(one, sign=-1) if one.name == "RH_pitch" else one for one in servo]
    servo = [replace(one, zero=2048 + 114) if one.name == "LF_knee" else one for one in servo]
    return replace(right, servo=tuple(servo))


def rigged(built, trouble=None):
    body = Obedient()
    emulator = Emulator(built, body, trouble or Trouble(), has_clock=True)
    rig = Rig(ROBOT, wiring(built.bus[0].protocol), [MemoryPort(emulator)], has_clock=True)
    return body, rig


@pytest.mark.parametrize("protocol", ["dynamixel", "feetech"])
def test_who_sees_what_moves_finds_swapped_and_reversed_servos(protocol):
    built = misbuilt(protocol)
    body, rig = rigged(built)
    before = body.angles.copy()

    def answer(bus, number):
        moved = body.angles - before
        i = int(np.argmax(np.abs(moved)))
        assert abs(moved[i]) == pytest.approx(NUDGE, abs=0.002)
        assert (np.abs(np.delete(moved, i)) < 1e-9).all()  # alone
        assert (body.powered > 0.0).sum() == 1
        return NAMES[i], int(np.sign(moved[i]))

    found = find_wiring(rig, BusClock(rig), answer)
    for name in NAMES:
        one, other = (next(s for s in made.servo if s.name == name) for made in (found, built))
        assert (one.id, one.sign) == (other.id, other.sign)
    assert not body.powered.any()
    assert np.abs(body.angles - before).max() < 0.002


def test_a_joint_that_is_named_twice_or_is_none_is_refused_and_the_robot_is_limp():
    for name, says in (("LF_yaw", "each joint has one servo"), ("elbow", "is no servo")):
        body, rig = rigged(wiring())
        with pytest.raises(InvalidDesign, match=says):
            find_wiring(rig, BusClock(rig), lambda bus, number, name=name: (name, 1))
        assert not body.powered.any()


def test_where_the_servos_are_when_it_is_held_straight_is_zero():
    built = misbuilt()
    _, rig = rigged(built)
    found, off = find_zeros(rig, np.zeros(len(NAMES)))
    assert np.degrees(off[NAMES.index("LF_knee")]) == pytest.approx(10.0, abs=0.1)
    assert next(one.zero for one in found.servo if one.name == "LF_knee") == 2048 + 114
    assert np.abs(np.delete(off, NAMES.index("LF_knee"))).max() < 1e-9
    with pytest.raises(BusFailure, match="does not"):
        find_zeros(rigged(built, Trouble(mute=(4,)))[1], np.zeros(len(NAMES)))


def log_of(stiffness, play, damping, friction, noise=0.0, samples=800):
    """Return a log of one servo that swings a pendulum, by the laws that are fitted."""
    rng, time = np.random.default_rng(3), 0.01 * np.arange(samples)
    angle = 0.5 * np.sin(2.1 * time)
    speed, faster = 0.5 * 2.1 * np.cos(2.1 * time), -0.5 * 2.1**2 * np.sin(2.1 * time)
    torque = 0.3 * angle + 0.02 * faster + 0.05 * speed + friction * np.tanh(speed / 0.02)
    torque = torque + noise * rng.standard_normal(samples)
    off = torque / stiffness + damping / stiffness * speed + 0.5 * play * np.sign(torque)
    goal = np.roll(angle + off, -1)
    row = lambda values: (("time", "servo"), values[:, None])  # noqa: E731
    return xr.Dataset(
        {
            "servo_target": row(goal),
            "servo_angle": row(angle),
            "servo_velocity": row(speed),
            "servo_torque": row(torque),
        },
        coords={"time": time, "servo": ["LF_yaw"]},
    )


def test_a_log_without_noise_gives_back_what_made_it():
    fit = fit_log(log_of(31.0, 0.0175, 0.6, 0.05).isel(time=slice(0, -1)))["LF_yaw"]
    assert fit.stiffness.value == pytest.approx(31.0, rel=1e-6)
    assert fit.play.value == pytest.approx(0.0175, rel=1e-6)
    assert fit.damping.value == pytest.approx(0.6, rel=1e-6)
    assert fit.friction.value == pytest.approx(0.05, rel=0.02)
    assert abs(fit.offset.value) < 1e-9


def test_with_noise_the_intervals_hold_the_truth_and_grow():
    quiet, loud = (
        fit_log(log_of(31.0, 0.0175, 0.6, 0.05, noise).isel(time=slice(0, -1)))["LF_yaw"] for noise in (0.002, 0.02)
    )
    for fit in (quiet, loud):
        assert abs(fit.friction.value - 0.05) < 2.0 * fit.friction.half + 0.001
    assert loud.friction.half > 5.0 * quiet.friction.half


def test_a_log_that_tells_nothing_is_refused():
    log = log_of(31.0, 0.0, 0.0, 0.0)
    with pytest.raises(IncompatibleRecord, match="without torques"):
        fit_log(log.assign(servo_torque=log.servo_torque * np.nan))
    with pytest.raises(IncompatibleRecord, match="10 samples"):
        fit_log(log.isel(time=slice(11)))
    with pytest.raises(IncompatibleRecord, match="no servo of the log moved"):
        fit_log(log.assign(servo_angle=log.servo_angle * 0.0))
    assert fits_text(fit_log(log)).splitlines()[1].startswith("LF_yaw,31,")

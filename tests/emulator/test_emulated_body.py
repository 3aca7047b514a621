"""The robot behind an emulated bus moves as the simulation does, whatever comes over the wire."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.experiments.catalog.rehearsal.experiment import (
    MAX_DISPLACEMENT_CHANGE,
    MAX_HEADING_CHANGE,
    MIN_JUDGED_CYCLES,
    Rehearsal,
    exceeds_tolerance,
    rehearse,
    sent_directly,
)  # fmt: skip
from suchus.hardware.bus import BusPlace, straight
from suchus.hardware.emulator import EmulatedBody, Trouble, body
from suchus.robot.control import OpenLoop
from suchus.robot.design import layout
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START, intended
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, crawl

ROBOT, GAIT = ROBOTS["caiman"], GAITS["belly_crawl"]
TICKS = 130


def driven(ticks=TICKS, **settings):
    """Return a body that was sent the gait, without steps or wires."""
    one = EmulatedBody(ROBOT, GAIT, timestep=0.005, **settings)
    goals = intended(ROBOT, GAIT, 0.01 * np.arange(ticks)).targets
    for tick in range(ticks):
        one.aim(dict(enumerate(goals[tick].tolist())))
        one.step()
    return one


def test_a_body_that_is_sent_the_gait_moves_as_the_simulation_to_the_bit_in_blocks_too(monkeypatch):
    truth = crawl(ROBOT, GAIT, duration=0.01 * TICKS, timestep=0.005)
    monkeypatch.setattr(body, "_BLOCK_SAMPLES", 50)
    with monkeypatch.context() as moving:  # a record takes long, and whoever waits for an answer would wait for it
        moving.delattr(body.Recorder, "record")
        one = driven()
    record = one.record()
    for name in ("position", "servo_angle", "servo_torque", "foot_force", "joint_angle"):
        np.testing.assert_array_equal(record[name].values, truth[name].values)
    np.testing.assert_allclose(record.time, truth.time)
    assert record.ended == pytest.approx(0.01 * TICKS)


def test_goals_that_are_late_by_whole_ticks_shift_the_commands_and_part_of_a_tick_splits_one():
    late = driven(latency=0.02)
    wanted = intended(ROBOT, GAIT, 0.01 * np.arange(TICKS)).targets
    np.testing.assert_array_equal(late.record().servo_target.values[2:TICKS], wanted[: TICKS - 2])
    part = driven(latency=0.005)
    prompt = driven()
    half, none, whole = (one.record().servo_angle.values[-1] for one in (part, prompt, driven(latency=0.01)))
    assert np.abs(half - none).max() > 0.0
    assert np.abs(half - none).max() < np.abs(whole - none).max()


def test_a_servo_without_torque_hangs_and_with_a_fifth_of_it_gives_no_more():
    one = EmulatedBody(ROBOT, GAIT, timestep=0.005)
    i = layout(ROBOT).servos.index("LH_pitch")
    one.power(i, 0.2)
    for _ in range(30):
        one.step()
    limit = ROBOT.servo("LH_pitch").torque
    assert np.abs(one.record().servo_torque.values[1:, i]).max() <= 0.2 * limit + 1e-9
    one.power(i, 0.0)
    one.step()
    assert one.record().servo_torque.values[-1, i] == 0.0


def test_in_a_lake_it_floats_and_feels_the_water():
    one = EmulatedBody(ROBOTS["floating_caiman"], GAIT, lake=Lake(level=0.6))
    for _ in range(3):
        one.step()
    assert 0.3 < float(one.now["share_under"]) < 1.0
    assert "water_level" in one.record()


@pytest.mark.parametrize("protocol", ["dynamixel", "feetech", "line"])
def test_over_ideal_wires_it_walks_as_simulated(protocol):
    duration = START + 2 * GAIT.period
    truth = crawl(ROBOT, GAIT, duration=duration)
    walk = rehearse(ROBOT, GAIT, OpenLoop(), duration, protocol=protocol)
    assert float(_wire_off(walk)) == 0.0  # what is left to the simulation is the step of the goals, not the wire
    assert float(np.abs(walk.log.servo_target - truth.servo_target).max()) <= np.pi / 4096 + 1e-12
    assert float(np.degrees(_off(walk.log, truth)).max()) < 0.2


def test_a_wire_that_is_late_is_not_taken_for_the_step_of_the_goals():
    ideal, late = (rehearse(ROBOT, GAIT, OpenLoop(), 1.1, trouble=Trouble(latency=wait)) for wait in (0.0, 0.01))
    assert float(_wire_off(ideal)) == 0.0
    assert float(_wire_off(late)) > 1e-5


def test_flags_have_both_sides():
    assert not exceeds_tolerance(-MAX_DISPLACEMENT_CHANGE, MAX_HEADING_CHANGE)
    assert exceeds_tolerance(-1.01 * MAX_DISPLACEMENT_CHANGE, 0.0)
    assert exceeds_tolerance(0.0, 1.01 * MAX_HEADING_CHANGE)
    assert exceeds_tolerance(np.nan, 0.0)
    assert exceeds_tolerance(0.0, np.nan)
    assert not Rehearsal(rule_cycles=0.9 * MIN_JUDGED_CYCLES).is_long_enough("closed")
    assert Rehearsal(rule_cycles=MIN_JUDGED_CYCLES).is_long_enough("closed")


def test_the_same_trouble_with_the_same_seed_gives_the_same_bytes():
    walks = [
        rehearse(ROBOT, GAIT, OpenLoop(), 0.3, trouble=Trouble(lost=0.2, corrupt=0.1, noise=0.01, seed=seed)).log
        for seed in (1, 1, 2)
    ]
    assert walks[0].servo_angle.values.tobytes() == walks[1].servo_angle.values.tobytes()
    assert walks[0].servo_heard.values.tobytes() != walks[2].servo_heard.values.tobytes()


def test_a_swapped_pair_of_servos_shows_in_their_angles():
    right = straight(ROBOT, [BusPlace(port="x")], "XM430-W350", boards=True)
    places = {one.name: one for one in right.servo}
    a, b = places["LF_pitch"], places["LH_knee"]
    swapped = replace(
        right,
        servo=tuple(replace(one, id={a.name: b.id, b.name: a.id}.get(one.name, one.id)) for one in right.servo),
    )
    truth = crawl(ROBOT, GAIT, duration=1.5)
    off = {
        built: np.degrees(_off(rehearse(ROBOT, GAIT, OpenLoop(), 1.5, actual_wiring=built).log, truth))
        for built in (None, swapped)
    }
    assert off[None].max() < 0.2 < off[swapped].sel(servo=["LF_pitch", "LH_knee"]).min()


def _wire_off(walk):
    return np.abs(walk.truth.position - sent_directly(ROBOT, GAIT, walk.log.servo_target.values).position).max()


def _off(log, truth):
    both = log.sel(time=slice(-1e-9, None))
    return np.sqrt(((both.servo_angle - truth.servo_angle.isel(time=slice(both.sizes["time"]))) ** 2).mean("time"))

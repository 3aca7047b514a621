from dataclasses import replace

import numpy as np
import pytest
from tests.bodies import hatchling, six
from tests.felt import felt as feels
from tests.metres import limb_phase, placed
from tests.start_batch import start_batch

import suchus
from suchus.core.errors import InvalidDesign, UnsuitedRobot
from suchus.robot.control.standing import BALANCE, Standing
from suchus.robot.design import with_values
from suchus.robot.design.scale import coarse_step, rescale
from suchus.robot.gaits import default_gait
from suchus.robot.kinematics import leg as leg_kinematics
from suchus.robot.motion.posture import sample_postures
from suchus.robot.motion.rising import stand_up, stretched_length
from suchus.sim.land import Run, simulate
from suchus.sim.metrics.reach import lead, reach

CAIMAN, CRAWL = suchus.ROBOTS["caiman"], suchus.GAITS["belly_crawl"]
SOON = Standing(at=0.2, hold=4.0, blend=1.0)
PERIOD = 0.01


def started(standing, robots=(CAIMAN,), ticks=3000):
    many = len(robots)
    return start_batch(standing, robots, [CRAWL] * many, [0] * many, ticks, PERIOD)


def felt(pitch, *, tail=6.9, rate=0.0, count=1):
    """Return what a robot of 34.5 N feels that stands still at a pitch."""
    half = np.broadcast_to(pitch, count) / 2
    foot = (34.5 - tail) / 2
    return feels(
        CAIMAN,
        count,
        foot_pressure=[0.0, 0.0, foot, foot],
        tail_pressure=tail,
        orientation=np.stack([np.cos(half), 0 * half, -np.sin(half), 0 * half], axis=-1),
        angular_velocity=np.stack([0 * half, np.broadcast_to(rate, count), 0 * half], axis=-1),
    )


def foot_ahead(angles, pitch):
    """Return how far a foot is ahead of its hip in the world [m]."""
    _, forward, down = leg_kinematics.forward(CAIMAN.hind_leg, angles)
    return np.cos(pitch) * forward + np.sin(pitch) * down


def test_before_and_after_it_stands_it_crawls_where_it_had_stopped():
    standing = Standing(at=2.0, hold=1.0)
    blind = started(replace(standing, balance=None))
    end = standing.down_from(CAIMAN)
    for time in (0.0, 1.3, 2.0):
        phase = limb_phase(CRAWL, np.array([time]))
        assert blind.command(round(time / PERIOD), None).targets == pytest.approx(placed(CAIMAN, CRAWL, phase))
    later = blind.command(round((end + 1.5) / PERIOD), None)
    assert later.phase == pytest.approx(limb_phase(CRAWL, np.array([2.0 + 1.5])), abs=1e-9)
    assert later.targets == pytest.approx(placed(CAIMAN, CRAWL, later.phase), abs=1e-9)


def test_commands_never_jump():
    blind = started(Standing(at=0.5, hold=0.5, balance=None))
    targets = np.array([blind.command(tick, None).targets[0] for tick in range(2200)])
    assert np.abs(np.diff(targets, axis=0)).max() < CAIMAN.hind_leg.servo.speed * PERIOD


def test_in_balance_nothing_is_corrected():
    controller = started(SOON)
    tick = round((SOON.upright_from(CAIMAN) + 1.0) / PERIOD)
    top = sample_postures(CAIMAN, stand_up(CAIMAN), np.array([99.0]))
    for i in range(5):
        told = controller.command(tick + i, felt(top.pitch[0])).targets
    assert told == pytest.approx(top.targets, abs=1e-6)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_who_tips_forward_moves_hips_and_trunk_back(sign):
    controller = started(SOON)
    tick = round((SOON.upright_from(CAIMAN) + 1.0) / PERIOD)
    top = sample_postures(CAIMAN, stand_up(CAIMAN), np.array([99.0]))
    controller.command(tick, felt(top.pitch[0]))
    told = controller.command(tick + 1, felt(top.pitch[0] - sign * 0.05, rate=sign * 0.3)).targets[0]
    bend = BALANCE.trunk_per_pitch * 0.05 * (1 - PERIOD / BALANCE.washout) + BALANCE.trunk_per_rate * 0.3
    assert told[13] - top.targets[0, 13] == pytest.approx(-sign * bend, rel=0.02)
    shift = BALANCE.hips_per_pitch * 0.05 * (1 - PERIOD / BALANCE.washout)
    feet = [foot_ahead(angles, top.pitch[0]) for angles in (told[6:9], top.targets[0, 6:9])]
    # forward the stretched leg gives way a little; backward it follows exactly
    assert sign * (feet[0] - feet[1]) == pytest.approx(shift, rel=0.3 if sign > 0 else 1e-6)
    assert np.array_equal(told[6:9], told[9:12])


def test_a_tail_without_load_makes_the_hips_creep_back_to_a_limit():
    keen = replace(SOON, hold=60.0, balance=replace(BALANCE, hips_per_tail=0.5, hips_most=0.01))
    controller = started(keen, ticks=3000)
    tick = round((keen.upright_from(CAIMAN) + 1.0) / PERIOD)
    top = sample_postures(CAIMAN, stand_up(CAIMAN), np.array([99.0]))
    told = [controller.command(tick + i, felt(top.pitch[0], tail=0.0)).targets[0, 6:9] for i in range(40)]
    steps = np.linalg.norm(np.diff(told, axis=0), axis=1)
    assert steps[0] > 0
    assert steps[-1] == pytest.approx(0.0, abs=1e-12)


def test_each_robot_of_a_batch_is_answered_for_itself():
    both = started(SOON, (CAIMAN, CAIMAN))
    tick = round((SOON.upright_from(CAIMAN) + 1.0) / PERIOD)
    top = sample_postures(CAIMAN, stand_up(CAIMAN), np.array([99.0]))
    both.command(tick, felt(top.pitch[0], count=2))
    told = both.command(tick + 1, felt(np.array([top.pitch[0], top.pitch[0] - 0.1]), count=2)).targets
    assert told[0] == pytest.approx(top.targets[0], abs=1e-6)
    assert np.abs(told[1] - told[0]).max() > 0.005


def test_runs_that_stand_at_different_times_share_a_batch():
    late = replace(SOON, at=1.2, balance=None)
    runs = [Run(robot=CAIMAN, gait=CRAWL, control=c) for c in (SOON, late)]
    together = simulate(runs, duration=2.0, timestep=0.005)
    alone = simulate(runs[1:], duration=2.0, timestep=0.005)
    assert np.array_equal(together.servo_target.isel(run=1), alone.servo_target.isel(run=0))
    assert np.array_equal(together.snout.isel(run=1), alone.snout.isel(run=0))
    assert not np.array_equal(together.servo_target.isel(run=1), together.servo_target.isel(run=0))


def test_without_balance_nothing_is_corrected():
    blind = replace(SOON, balance=None)
    both = start_batch([SOON, blind], [CAIMAN] * 2, [CRAWL] * 2, [0, 0], 3000, PERIOD)
    tick = round((SOON.upright_from(CAIMAN) + 1.0) / PERIOD)
    for i, pitch in enumerate((1.4, 1.2)):
        told = both.command(tick + i, felt(np.array([pitch, pitch]), count=2)).targets
    assert np.abs(told[0] - told[1]).max() > 0.01
    assert told[1] == pytest.approx(sample_postures(CAIMAN, stand_up(CAIMAN), np.array([99.0])).targets[0], abs=1e-9)


def test_the_caiman_stands_up_and_down_again():
    record = simulate([Run(robot=CAIMAN, gait=CRAWL, control=SOON)], duration=24.0, timestep=0.005, sample_stride=10)
    height, behind = reach(CAIMAN, record).isel(run=0), lead(record).isel(run=0)
    up = slice(SOON.upright_from(CAIMAN), SOON.upright_until(CAIMAN))
    assert float(height.sel(time=up).min()) > 0.64
    assert float(behind.sel(time=up).min()) > 0.03
    assert float(height.sel(time=slice(SOON.down_from(CAIMAN), None)).max()) < 0.2
    forward = record.centre_of_mass.sel(xyz="x").isel(run=0)
    assert float(forward[-1] - forward.sel(time=SOON.down_from(CAIMAN), method="nearest")) > 0.05


def risen(robot, size):
    """Return the least height of a robot that should stand, and how high its own chains could reach [m]."""
    soon = Standing(
        at=0.2 * size**0.5,
        hold=1.0 * size**0.5,
        blend=size**0.5,
        balance=rescale(BALANCE, length_factor=size),
        rise=stand_up(robot, slower=size**0.5),
    )
    run = Run(robot=robot, gait=default_gait(robot), control=soon)
    record = simulate([run], duration=soon.upright_until(robot), timestep=coarse_step(robot), sample_stride=10)
    late = reach(robot, record).isel(run=0).sel(time=slice(soon.upright_from(robot), None))
    return float(late.min()), stretched_length(robot)


def test_a_body_of_the_article_in_another_size_stands_as_it_does():
    height, line = risen(hatchling(), 0.3 / CAIMAN.length)
    alike, whole = risen(CAIMAN, 1.0)
    assert height / line == pytest.approx(alike / whole, rel=2e-3)
    assert height > 0.95 * line


@pytest.mark.parametrize(("torque", "stands"), [(4.0, False), (9.0, True)])
def test_a_longer_body_stands_where_its_trunk_can_lift_its_forebody(torque, stands):
    """Six spine joints and servos in the tail: it takes 4.09 N m to lift its level forebody off the ground."""
    longer = with_values(six(), {"spine.pitch_servo.torque": torque})
    height, line = risen(longer, 1.0)
    assert (height > 0.9 * line) == stands
    assert stands or height < 0.3 * line


@pytest.mark.parametrize("name", ["salamander", "strider"])
def test_who_lacks_a_chain_is_refused_before_anything_moves(name):
    robot = suchus.ROBOTS[name]
    with pytest.raises(UnsuitedRobot, match=f"needs .*a trunk that bends up and down.*; robot '{name}' lacks that"):
        start_batch(Standing(at=0.1, hold=0.1), [robot], [default_gait(robot)], [0], 10, PERIOD)


def test_impossible_settings_are_refused():
    with pytest.raises(InvalidDesign, match=r"standing.hold is -1 s"):
        Standing(at=1.0, hold=-1.0)
    with pytest.raises(InvalidDesign, match=r"balance.washout is 0 s; 0.02 to 600 s is allowed"):
        replace(BALANCE, washout=0.0)

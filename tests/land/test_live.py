from dataclasses import replace

import numpy as np
import pytest

from suchus.core.errors import Diverged, InvalidDesign, OutsideLimits, UnknownName
from suchus.robot.control import LAWS, Coordinated, HeadingRule
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Limp, Live, Locked, Push, Run, simulate

ROBOT, GAIT = ROBOTS["caiman"], replace(GAITS["belly_crawl"], period=1.0)
OPEN = Coordinated(limbs=LAWS["off"], spine=None, tail=None)
STEP = 0.005


def live(**changes: object) -> Live:
    return Live(Run(robot=ROBOT, gait=GAIT, control=OPEN, **changes), timestep=STEP)


def until(walk: Live, time: float) -> Live:
    while walk.time < time - 1e-9:
        walk.step()
    return walk


def batch(duration: float, **changes: object):
    run = Run(robot=ROBOT, gait=GAIT, **{"control": OPEN, **changes})
    return simulate([run], duration=duration, timestep=STEP).isel(run=0, time=-1)


@pytest.mark.parametrize("control", [OPEN, Coordinated(heading=HeadingRule())])
def test_a_live_run_goes_as_a_batch_does(control):
    walk = until(Live(Run(robot=ROBOT, gait=GAIT, control=control), timestep=STEP), 3.5)
    record = batch(3.5, control=control)
    for name in ("position", "joint_angle", "foot_force", "servo_target"):
        np.testing.assert_allclose(walk.current_sample[name], record[name].values, atol=1e-6)


def test_what_breaks_and_pushes_live_does_so_as_in_a_batch():
    walk = until(live(), 1.5)
    walk.begin(Limp("LF_yaw"))
    walk.begin(Locked("RH_pitch"))
    walk.push(Push(force=(0.0, 8.0, 0.0), at=1.6, duration=0.2))
    until(walk, 2.5)
    faults = (Limp("LF_yaw", at=1.5), Locked("RH_pitch", at=1.5))
    record = batch(2.5, faults=faults, pushes=(Push(force=(0.0, 8.0, 0.0), at=1.6, duration=0.2),))
    assert (
        abs(walk.current_sample["position"][0] - float(record.position[0])) < 2e-3
    )  # the lock hears of it one period later


def test_a_mended_joint_obeys_again():
    walk = live(faults=(Limp("LF_pitch"),))
    until(walk, 1.2)
    lame = abs(walk.current_sample["servo_angle"][1] - walk.current_sample["servo_target"][1])
    walk.mend("LF_pitch")
    until(walk, 1.9)
    assert abs(walk.current_sample["servo_angle"][1] - walk.current_sample["servo_target"][1]) < lame / 3


def test_a_joint_that_is_broken_otherwise_is_no_longer_broken_as_before():
    walk = until(live(), 1.2)
    walk.begin(Limp("LF_pitch"))
    walk.begin(Locked("LF_pitch", angle=0.5))
    until(walk, 2.0)
    assert abs(walk.current_sample["servo_angle"][1] - 0.5) < 0.1


@pytest.mark.parametrize("period", [0.7, 2.0])
def test_another_gait_goes_on_from_the_same_phase(period):
    walk = until(live(), 1.63)
    before = walk.current_sample["limb_phase"].copy()
    walk.walk(replace(GAIT, period=period))
    walk.step()
    walk.step()
    moved = (walk.current_sample["limb_phase"] - before + 0.5) % 1.0 - 0.5
    assert np.all((moved > 0.0) & (moved < 0.04))


def test_switching_the_rules_keeps_the_asked_heading():
    rules = Coordinated(heading=HeadingRule())
    walk = Live(Run(robot=ROBOT, gait=GAIT, control=rules, faults=(Limp("LF_yaw"),)), timestep=STEP)
    until(walk, 3.0)
    turned = walk._loop.controller._heading._heading_estimator._turn_angle.copy()
    walk.walk(GAIT.strode(1.1))
    walk.step()
    assert abs(walk._loop.controller._heading._heading_estimator._turn_angle - turned) < 0.05


def test_a_gait_out_of_reach_is_refused_and_the_walk_goes_on():
    walk = until(live(), 1.2)
    with pytest.raises(OutsideLimits):
        walk.walk(GAIT.strode(5.5))
    assert until(walk, 1.4).run.gait == GAIT


def test_ground_that_tilts_sends_the_robot_downhill():
    steep = live()
    steep.tilt(Ground(sideways=0.6))
    assert abs(until(steep, 1.5).current_sample["position"][1]) > 5 * abs(
        until(live(), 1.5).current_sample["position"][1]
    )


def test_impossible_commands_are_refused():
    with pytest.raises(InvalidDesign):
        live(noise=0.1)
    with pytest.raises(UnknownName):
        live().begin(Limp("LF_wrist"))
    with pytest.raises(UnknownName):
        live().push(Push(force=(1.0, 0.0, 0.0), at=0.0, body="wing"))


def test_a_walk_that_comes_apart_says_when(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where MuJoCo writes its warnings
    walk = until(live(), 0.5)
    walk._loop.batch.qvel[0, 0] = np.nan
    with pytest.raises(Diverged) as error:
        until(walk, 1.0)
    assert abs(error.value.time - 0.5) < 0.02
    with pytest.raises(Diverged):
        walk.step()

"""The loop that batches, live walks and environments share: clocks, new beginnings, and what is not read."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.robot.design import with_values
from suchus.sim.land import Backlash, Ground, Limp, Locked, Push, Run, simulate
from suchus.sim.land.batch import Beginning
from suchus.sim.land.loop import Loop
from suchus.sim.land.readings import thin
from suchus.sim.record import EFFORT, ELECTRICAL

COARSE = 0.005
PUSH = Push(force=(0.0, 12.0, 0.0), at=0.05, duration=0.1)
FAULT = Limp("LF_yaw", at=0.08)


@pytest.fixture(scope="module")
def run(robot, crawl_gait) -> Run:
    return Run(robot=robot, gait=crawl_gait)


def state(loop: Loop, sim: int) -> Beginning:
    batch = loop.batch
    return Beginning(*(np.array(part[sim]) for part in (batch.qpos, batch.qvel, batch.activations, batch.ctrl)))


def passed(loop: Loop, periods: int, **how: bool) -> Loop:
    for _ in range(periods):
        loop.decide()
        loop.advance(**how)
    return loop


@pytest.mark.parametrize("robots", [1, 2])
def test_samples_that_are_not_kept_change_none_of_those_that_are(run, robots):
    # a joint that locks where it is, and one with backlash, look at angles in periods that are not kept
    faults = (FAULT,), (Locked("LF_pitch", at=0.04),), (Backlash("RH_pitch", at=0.02),)
    runs = [run, replace(run, pushes=(PUSH,)), *(replace(run, faults=some) for some in faults)]
    runs.append(replace(run, ground=Ground(friction_scale=0.5, uphill=0.1)))
    if robots == 2:
        heavier = with_values(run.robot, {"pelvis.mass": 1.1 * run.robot.pelvis.mass})
        runs += [replace(run, robot=heavier, faults=some) for some in faults]
    all_kept, few = (simulate(runs, duration=0.3, timestep=COARSE, sample_stride=every) for every in (1, 3))
    kept = thin(all_kept, 3)
    for name in kept.data_vars:
        if name in EFFORT or name in ELECTRICAL:
            np.testing.assert_allclose(kept[name].values, few[name].values, rtol=1e-12, atol=1e-12, err_msg=str(name))
        elif name == "foot_roll":  # a ball rolls by its turn from one kept sample to the next
            np.testing.assert_allclose(kept[name].values, few[name].values, rtol=0.0, atol=1e-6, err_msg=str(name))
        else:
            np.testing.assert_array_equal(kept[name].values, few[name].values, err_msg=str(name))


def test_contact_forces_that_nobody_reads_are_not_averaged_and_nothing_else_differs(run):
    felt, unread = (
        passed(Loop([run], COARSE, ticks=30), 20, need_forces=felt, need_effort=False) for felt in (True, False)
    )
    for name in ("servo", "imu_orientation", "centre_of_mass", "angular_momentum"):
        columns = felt.sensors.span(felt.sensors.layout.servos, "torque") if name == "servo" else None
        sides = (loop.sensors[name] if columns is None else loop.batch.readings[:, columns] for loop in (felt, unread))
        np.testing.assert_array_equal(*sides)
    np.testing.assert_array_equal(felt.batch.qpos, unread.batch.qpos)
    assert not np.array_equal(felt.batch.readings, unread.batch.readings)


def test_sensors_that_nobody_reads_are_not_worked_out_and_the_robots_go_the_same_way(run):
    read, unread = (
        passed(Loop([run], COARSE, ticks=30), 20, need_forces=False, need_readings=read, need_effort=False)
        for read in (True, False)
    )
    np.testing.assert_array_equal(read.batch.qpos, unread.batch.qpos)
    np.testing.assert_array_equal(read.batch.angles(0), unread.batch.angles(0))
    assert not np.array_equal(read.sensors["centre_of_mass"], unread.sensors["centre_of_mass"])
    for loop in (read, unread):
        passed(loop, 1)
    np.testing.assert_array_equal(read.batch.readings, unread.batch.readings)


def test_a_run_that_begins_anew_has_a_clock_and_troubles_of_its_own(run):
    first = state(Loop([run], COARSE, ticks=1), 0)
    late, fresh = (Loop([run] * 3, COARSE, ticks=99) for _ in range(2))
    passed(late, 7)
    rest = late.controller.rest()
    for loop in (late, fresh):
        loop.restart(1, first, [FAULT], [PUSH])
        for _ in range(20):
            loop.decide()
            loop.command = loop.command._replace(targets=rest)  # the controller's clock is the batch's
            loop.advance()
    assert late.clocks.tolist() == [27, 20, 27]
    np.testing.assert_array_equal(late.batch.qpos[1], fresh.batch.qpos[1])
    np.testing.assert_array_equal(late.batch.readings[1], fresh.batch.readings[1])
    assert late.disturbances.injector.broken(1) == (FAULT,)
    assert not np.array_equal(late.batch.qpos[1], late.batch.qpos[0])
    np.testing.assert_array_equal(late.batch.qpos[0], late.batch.qpos[2])


def test_a_new_beginning_forgets_what_was_ahead_and_mends_what_was_broken(run):
    loop = Loop([replace(run, faults=(FAULT,), pushes=(PUSH,)), run], COARSE, ticks=99)
    first = state(loop, 0)
    passed(loop, 9)
    assert loop.disturbances.injector.broken(0) == (FAULT,)
    loop.restart(0, first)
    loop.restart(1, first)
    passed(loop, 20)
    assert loop.disturbances.injector.broken(0) == ()
    np.testing.assert_array_equal(loop.batch.qpos[0], loop.batch.qpos[1])


def test_a_run_that_waits_stays_and_its_troubles_wait_with_it(run):
    loop = passed(Loop([replace(run, faults=(FAULT,)), run], COARSE, ticks=99), 8)  # the fault is due next
    before = state(loop, 0)
    loop.choose(np.array([False, True]))
    passed(loop, 12)
    np.testing.assert_array_equal(loop.batch.qpos[0], before.qpos)
    assert loop.clocks.tolist() == [8, 20]
    assert loop.disturbances.injector.broken(0) == ()
    loop.choose(np.array([True, True]))
    passed(loop, 1)
    assert loop.disturbances.injector.broken(0) == (FAULT,)

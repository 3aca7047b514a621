"""Runs that go alike are simulated once, and nothing shows it."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.robot.control import Coordinated
from suchus.sim.land import Backlash, Ground, Limp, Locked, LostFoot, Offset, Push, Run, simulate
from suchus.sim.land.loop import Deduplication

COARSE = 0.01


@pytest.fixture(scope="module")
def run(robot, crawl_gait) -> Run:
    return Run(robot=robot, gait=crawl_gait, control=Coordinated())


def followers(alike: Deduplication) -> dict[int, int]:
    return dict(zip(alike.followers.tolist(), alike.leader_of.tolist(), strict=True))


def test_a_batch_of_runs_that_part_is_each_run_alone(run):
    runs = [
        run,
        replace(run, pushes=(Push(force=(0.0, 15.0, 0.0), at=0.3),)),
        replace(run, pushes=(Push(force=(0.0, -15.0, 0.0), at=0.3),)),
        replace(run, faults=(Limp("LF_yaw", at=0.425),)),
        replace(run, faults=(Locked("spine_yaw_2", at=0.4),)),
        replace(run, faults=(Backlash("LF_pitch", at=0.3),)),
        replace(run, faults=(LostFoot("RH", at=0.3), Offset("LF_yaw", at=0.2))),
        replace(run, noise=0.01, seed=7),
        replace(run, ground=Ground(uphill=0.1)),
        run,
    ]
    together = simulate(runs, duration=0.6, timestep=COARSE)
    for i, one in enumerate(runs):
        alone = simulate([one], duration=0.6, timestep=COARSE)
        xr.testing.assert_identical(together.isel(run=[i]).assign_coords(run=[0]), alone)


def test_who_comes_apart_does_so_alone_and_who_goes_with_him_does_too(run):
    flung = replace(run, pushes=(Push(force=(0.0, 9e3, 9e3), at=0.1),))
    record = simulate([run, flung, run], duration=0.3, timestep=COARSE)
    assert list(record.ended < 0.3) == [False, True, False]
    assert record.position.isel(run=2).notnull().all()


def test_only_equal_robots_on_equal_grounds_begin_alike(run, long_tail):
    first = np.zeros((5, 19))
    first[4, 3] = 1e-16
    other = replace(run.gait, name="another", period=9.0)  # the physics knows no gait
    runs = [
        run,
        replace(run, gait=other),
        replace(run, robot=long_tail),
        replace(run, ground=Ground(friction_scale=0.9)),
        run,
    ]
    assert followers(Deduplication(runs, first, 0.01)) == {1: 0}


def test_runs_part_where_they_are_told_something_else_and_where_trouble_comes(run):
    pushed = replace(run, pushes=(Push(force=(1.0, 0.0, 0.0), at=0.055),))
    alike = Deduplication([run, run, run, pushed, pushed], np.zeros((5, 19)), 0.01)
    targets = np.zeros((5, 19))
    alike.separate(0, targets)
    assert followers(alike) == {1: 0, 2: 0, 3: 0, 4: 0}
    targets[1:3, 5] = 1e-16
    alike.separate(1, targets)
    assert followers(alike) == {2: 1, 3: 0, 4: 0}
    alike.separate(5, targets)
    assert followers(alike) == {2: 1}
    assert alike.is_leader.tolist() == [True, True, False, True, True]
    targets[:] = 0.0  # who has parted does not meet again
    alike.separate(6, targets)
    assert followers(alike) == {2: 1}

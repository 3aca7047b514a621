import numpy as np
import pytest

from suchus.robot.design.ground import Bumps, Step, Stone
from suchus.robot.gaits import GAITS
from suchus.sim.land import ARENAS, Ground, Run, simulate
from suchus.sim.metrics import displacement, tilt, time_window

GRAVITY = 9.81


def bumps(seed, height=0.03):
    return Ground(relief=Bumps(height=height, correlation=0.06, start=0.42, seed=seed))


def test_runs_on_all_kinds_of_ground_go_together_and_come_back_in_order(robot, crawl_gait):
    gait = GAITS["semi_erect"]
    grounds = list(ARENAS.values())
    together = simulate([Run(robot=robot, gait=gait, ground=g) for g in grounds], duration=2.5, timestep=0.005)
    for i in (0, 4, 6):
        alone = simulate([Run(robot=robot, gait=gait, ground=grounds[i])], duration=2.5, timestep=0.005)
        assert (alone.centre_of_mass.isel(run=0).values == together.centre_of_mass.isel(run=i).values).all()


def test_bumps_slow_a_walk_and_shake_it(robot):
    gait = GAITS["semi_erect"]
    runs = [Run(robot=robot, gait=gait, ground=g) for g in (Ground(), bumps(0), bumps(1))]
    record = simulate(runs, duration=6.0, timestep=0.005)
    way, roll = displacement(record).sel(xyz="x").values, tilt(time_window(record, 2.0))["roll"].std("time").values
    assert (way[1:] < way[0]).all()
    assert (roll[1:] > 1.5 * roll[0]).all()
    assert way[1] != way[2]


def test_the_ground_carries_the_weight_on_bumps_too(robot, crawl_gait, monkeypatch):
    monkeypatch.setattr("suchus.sim.land.batch.check_clear", lambda *_: None)  # it is pushed out within a second
    start = Ground(relief=Bumps(height=0.03, correlation=0.06, start=-1.0, seed=0))
    record = time_window(simulate([Run(robot=robot, gait=crawl_gait.strode(0.0), ground=start)], duration=3.0), 1.0)
    vertical = record.foot_force.sel(xyz="z").sum("leg") + record.belly_force.sel(xyz="z").sum("segment")
    vertical = vertical + record.tail_force.sel(xyz="z")
    assert vertical.mean("time").values == pytest.approx(record.mass.values * GRAVITY, rel=0.01)


def test_a_low_step_is_climbed_and_a_wall_is_not(robot):
    gait = GAITS["semi_erect"]
    grounds = [Ground(relief=Step(at=0.6, height=h)) for h in (0.01, 0.2)]
    record = simulate([Run(robot=robot, gait=gait, ground=g) for g in grounds], duration=7.0, timestep=0.005)
    risen = record.position.sel(xyz="z").isel(time=-50).values - record.position.sel(xyz="z").sel(time=1.0).values
    assert risen[0] == pytest.approx(0.01, abs=0.006)
    assert displacement(record).sel(xyz="x").values[1] < 0.4


def test_a_stone_beside_the_path_changes_nothing(robot, crawl_gait):
    stone = Stone(at=0.75, aside=1.2, height=0.05, length=0.06, width=0.05)
    runs = [Run(robot=robot, gait=crawl_gait, ground=g) for g in (Ground(), Ground(relief=stone))]
    way = displacement(simulate(runs, duration=3.0)).values
    assert np.abs(way[1] - way[0]).max() < 1e-9

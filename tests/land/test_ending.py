"""Runs that end when their answer is known: their records stop there, and nothing else changes."""

import numpy as np

from suchus.robot.control import Coordinated
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Run, simulate
from suchus.sim.land.command_speed import CommandSpeeds

STEP = 0.005


def walks(robot, gait):
    controls = [Coordinated(spine=None, tail=None, random_start=True)] * 3
    return [Run(robot=robot, gait=gait, control=control, seed=seed) for seed, control in enumerate(controls)]


def at_times(by_run):
    """Return an end rule by which runs end at a time, by their numbers in the batch."""
    asked = []

    def ends(runs, time, phase):
        asked.append((tuple(runs.tolist()), time, phase.shape))
        return np.array([time >= by_run.get(int(run), np.inf) - 1e-9 for run in runs])

    return ends, asked


def test_a_run_ends_with_the_sample_after_which_it_was_to_and_the_others_go_on_to_the_same_bytes(robot, crawl_gait):
    runs, ends_and_asked = walks(robot, crawl_gait), at_times({1: 0.5})
    options = {"duration": 1.2, "timestep": STEP, "sample_stride": 10, "effort": False}
    whole, short = simulate(runs, **options), simulate(runs, ends=ends_and_asked[0], **options)
    for name in ("position", "servo_torque", "limb_phase", "foot_force", "servo_target"):
        assert short[name].isel(run=[0, 2]).values.tobytes() == whole[name].isel(run=[0, 2]).values.tobytes()
    is_kept = short.time.values <= 0.5 + 1e-9
    kept = short.position.isel(run=1).transpose("time", ...).values
    assert kept[is_kept].tobytes() == whole.position.isel(run=1).transpose("time", ...).values[is_kept].tobytes()
    assert np.isnan(kept[~is_kept]).all()
    assert short.ended.values.tolist() == [1.2, 0.5, 1.2]
    assert short.cause.values.tolist() == ["", "", ""]
    asked = ends_and_asked[1]
    assert asked[0] == ((0, 1, 2), 0.0, (3, 4))
    assert asked[-1][0] == (0, 2)


def test_a_batch_is_over_when_all_of_its_runs_have_ended(robot, crawl_gait):
    ends, asked = at_times({0: 0.3, 1: 0.3, 2: 0.4})
    record = simulate(walks(robot, crawl_gait), duration=30.0, timestep=STEP, sample_stride=10, effort=False, ends=ends)
    assert max(time for _, time, _ in asked) < 0.45
    assert record.sizes["time"] == 301
    np.testing.assert_allclose(record.ended, [0.3, 0.3, 0.4])


def test_runs_are_asked_about_by_their_numbers_in_the_batch_whatever_group_simulates_them(robot, crawl_gait):
    closed = walks(robot, crawl_gait)
    mixed = [closed[0], Run(robot=robot, gait=crawl_gait), closed[1], Run(robot=robot, gait=crawl_gait, seed=1)]
    ends, asked = at_times({1: 0.2, 2: 0.3})
    record = simulate(mixed, duration=0.6, timestep=STEP, sample_stride=10, effort=False, ends=ends)
    np.testing.assert_allclose(record.ended, [0.6, 0.2, 0.3, 0.6])
    assert {runs for runs, _, _ in asked} == {(0, 2), (0,), (1, 3), (3,)}


def test_a_run_that_leads_equal_ones_ends_without_them(robot, crawl_gait):
    equal = [Run(robot=robot, gait=crawl_gait, ground=Ground(uphill=0.1), label=name) for name in "abc"]
    options = {"duration": 1.0, "timestep": STEP, "sample_stride": 10, "effort": False}
    whole, short = simulate(equal, **options), simulate(equal, ends=at_times({0: 0.4})[0], **options)
    assert short.position.isel(run=[1, 2]).values.tobytes() == whole.position.isel(run=[1, 2]).values.tobytes()
    np.testing.assert_allclose(short.ended, [0.4, 1.0, 1.0])


def test_what_an_ended_run_is_commanded_later_warns_of_nothing():
    run = Run(robot=ROBOTS["caiman"], gait=GAITS["belly_crawl"])
    speeds = CommandSpeeds([run, run], 0.01)
    targets = np.zeros((2, speeds.max_speeds.shape[1]))
    speeds.observe(targets, np.array([False, False]))
    speeds.observe(targets + 1.0, np.array([False, True]))
    assert (speeds.max_speeds[0] == 100.0).all()
    assert (speeds.max_speeds[1] == 0.0).all()

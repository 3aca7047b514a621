from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.experiments.catalog.feedback.experiment import ARMS, STARTS, _loop_measures, experiment
from suchus.robot.control import LAWS, Coordinated, HeadingRule, Kick, LimbLaw
from suchus.sim.land import Limp, Locked, Run, simulate
from suchus.sim.metrics import displacement, heading
from suchus.sim.metrics.coordination import cycles_until, phase_error

STEP = 0.005


@pytest.fixture(scope="module")
def started(robot, crawl_gait):
    """Two random starts of a faster crawl under three laws, phase errors (law, start, time)."""
    gait = replace(crawl_gait, period=2.0)
    laws = ("off", "cross_load", "wrong_sign")
    runs = [Run(robot=robot, gait=gait, control=STARTS[law], seed=i) for law in laws for i in range(2)]
    record = simulate(runs, duration=15.0, timestep=STEP, sample_stride=10)
    error = phase_error(record.limb_phase, gait)
    return {law: error.isel(run=slice(2 * i, 2 * i + 2)) for i, law in enumerate(laws)}


def test_cross_loads_bring_random_phases_to_the_gait_and_keep_them(started):
    cycles = cycles_until(started["cross_load"], 2.0, start=1.0, hold=2.0)
    assert (cycles <= 5.0).all()
    assert started["cross_load"].isel(time=-1).max() < 0.02


def test_without_feedback_phases_stay_and_with_the_wrong_sign_they_do_not_come(started):
    error = started["off"].transpose("run", "time").values
    assert np.ptp(error, axis=1).max() < 1e-9
    assert error.max(axis=1).min() > 0.1
    assert not np.isfinite(cycles_until(started["wrong_sign"], 2.0, start=1.0, hold=0.5)).any()


@pytest.fixture(scope="module")
def disturbed(robot, crawl_gait):
    """What happens after 5 s to a robot with and without rules, by (disturbance, arm)."""
    limp, locked = (Limp("LF_yaw", at=5.0),), (Locked("spine_yaw_2", at=5.0),)
    kicks = (Kick(5.0, experiment.kick),)
    runs = {
        ("none", "open"): Run(robot=robot, gait=crawl_gait, control=ARMS["open"]),
        ("none", "closed"): Run(robot=robot, gait=crawl_gait, control=ARMS["closed"]),
        ("kick", "open"): Run(robot=robot, gait=crawl_gait, control=replace(ARMS["open"], kicks=kicks)),
        ("kick", "closed"): Run(robot=robot, gait=crawl_gait, control=replace(ARMS["closed"], kicks=kicks)),
        ("locked", "open"): Run(robot=robot, gait=crawl_gait, control=ARMS["open"], faults=locked),
        ("locked", "spine"): Run(robot=robot, gait=crawl_gait, control=ARMS["spine"], faults=locked),
        ("limp", "closed"): Run(robot=robot, gait=crawl_gait, control=ARMS["closed"], faults=limp),
        ("limp", "steered"): Run(robot=robot, gait=crawl_gait, control=ARMS["steered"], faults=limp),
        ("tail", "closed"): Run(robot=robot, gait=crawl_gait.lifted(0.4), control=ARMS["tail"]),
    }
    record = simulate(list(runs.values()), duration=25.0, timestep=STEP, sample_stride=10)
    return {key: record.isel(run=i) for i, key in enumerate(runs)}


def way(record):
    return float(displacement(record, start=5.0).sel(xyz="x"))


def test_rules_do_not_distort_a_walk_whose_phases_are_right(disturbed, crawl_gait):
    assert float(phase_error(disturbed["none", "closed"].limb_phase, crawl_gait).max()) < 0.01
    assert way(disturbed["none", "closed"]) > 0.97 * way(disturbed["none", "open"])


def test_kicked_limbs_find_back(disturbed, crawl_gait):
    back = cycles_until(phase_error(disturbed["kick", "closed"].limb_phase, crawl_gait), 4.0, start=5.0, hold=1.0)
    assert float(back) <= 2.5
    assert way(disturbed["kick", "closed"]) > 0.85 * way(disturbed["none", "closed"])
    assert way(disturbed["kick", "open"]) < 0.6 * way(disturbed["none", "open"])


def test_the_other_spine_joints_make_up_for_a_stuck_one(disturbed):
    assert way(disturbed["locked", "spine"]) > 1.1 * way(disturbed["locked", "open"])


def test_the_tail_finds_the_pitch_at_which_the_ground_carries_it(disturbed):
    last = disturbed["tail", "closed"].sel(time=slice(17.0, None))
    assert abs(float(last.servo_torque.sel(servo="tail_pitch").mean())) < 0.1
    assert float(last.servo_target.sel(servo="tail_pitch").mean()) < 0.3


def test_the_heading_loop_makes_a_robot_that_circles_walk_straight(disturbed):
    turning = {}
    for arm in ("closed", "steered"):
        facing = heading(disturbed["limp", arm])
        turning[arm] = float(facing.sel(time=25.0, method="nearest") - facing.sel(time=17.0, method="nearest")) / 2
    assert turning["closed"] > np.radians(20)
    assert abs(turning["steered"]) < np.radians(12)
    assert way(disturbed["limp", "steered"]) > 1.05 * way(disturbed["limp", "closed"])


def test_the_arms_are_what_their_names_say():
    assert ARMS["open"] == Coordinated(limbs=LimbLaw(), spine=None, tail=None)
    assert ARMS["closed"] == Coordinated()
    assert ARMS["steered"].heading == HeadingRule()
    assert [law for law in STARTS if law in LAWS] == list(LAWS)


def test_the_question_is_answered_with_every_measure_of_the_issue(quick_outcome):
    outcome = quick_outcome("feedback")
    measures = outcome.measures
    assert measures["converged_closed"] == measures["converged_cross_load"]
    assert measures["converged_open"] == measures["converged_off"]
    assert {f"converged_{law}" for law in LAWS} <= set(measures)
    for disturbance in ("kick", "locked_spine", "uphill", "downhill", "side_slope", "push", "limp_yaw", "load_noise"):
        for arm in ("open", "closed"):
            assert measures[f"recovery_{disturbance}_{arm}"].unit == "m"
            assert measures[f"heading_{disturbance}_{arm}"].unit == "rad"
    # who feels no loads is not disturbed by noise on them
    assert measures["recovery_load_noise_open"] == measures["recovery_none_open"]
    assert measures["recovery_load_noise_closed"] != measures["recovery_none_closed"]


def loops(crawl_gait, *, grows=0.0, drifts=0.0):
    """Return five cycles after a disturbance: what spine and tail lack, growing and drifting by so much a cycle."""
    time = 5.0 + np.arange(0.0, 20.0 + 1e-9, 0.05)
    cycle = (time - 5.0) / crawl_gait.period
    swing = np.sin(2 * np.pi * cycle)
    zero = np.zeros_like(time)
    of = {
        "lacking": {"open": 0.5 * swing, "spine": 0.3 * (1.0 + grows * cycle) * swing, "tail": zero},
        "tail_load": {"open": 0.4 + swing, "spine": zero, "tail": -0.1 + swing},
        "tail_pitch": {"open": 0.2 + zero, "spine": zero, "tail": 0.1 + drifts * cycle + 0.01 * swing},
    }
    arms = list(of["lacking"])
    data = {name: (("disturbance", "arm", "time"), [[rows[arm] for arm in arms]] * 2) for name, rows in of.items()}
    return xr.Dataset(data, coords={"disturbance": ["locked_spine", "uphill"], "arm": arms, "time": time})


def test_the_loops_of_spine_and_tail_are_measured_each_by_what_it_holds(crawl_gait):
    found = {name: m.value for name, m in _loop_measures(loops(crawl_gait), crawl_gait).items()}
    assert found["spine_lacking_open"] == pytest.approx(0.5 / np.sqrt(2), rel=0.01)
    assert found["spine_lacking_spine"] == pytest.approx(0.3 / np.sqrt(2), rel=0.01)
    assert found["spine_lacking_growth"] == pytest.approx(1.0, abs=0.01)
    assert (found["tail_load_open"], found["tail_load_tail"]) == pytest.approx((0.4, 0.1), abs=0.01)
    assert found["tail_pitch_drift"] == pytest.approx(0.0, abs=1e-3)


def test_a_loop_that_grows_or_drifts_is_seen(crawl_gait):
    found = {n: m.value for n, m in _loop_measures(loops(crawl_gait, grows=0.1, drifts=0.05), crawl_gait).items()}
    assert found["spine_lacking_growth"] == pytest.approx(1.45 / 1.05, rel=0.02)
    assert found["tail_pitch_drift"] == pytest.approx(0.05, abs=2e-3)


def test_a_run_that_cannot_answer_says_why_it_is_not_judged(crawl_gait):
    assert experiment.unjudged() == ""
    faster = replace(experiment, gait=replace(crawl_gait, period=2.0))
    assert faster.unjudged().startswith("Not judged: gait is another belly_crawl, and")
    assert replace(experiment, starts=15).unjudged().startswith("Not judged: starts is 15, and 16 at least")
    assert replace(experiment, starts=16).unjudged() == ""


def test_phases_that_feel_nothing_are_those_of_a_walk_to_the_last_bit(robot, crawl_gait):
    question = replace(experiment, gait=replace(crawl_gait, period=2.0), starts=2, seed=5)
    laws = ("off", "own_load")
    runs = [Run(robot=robot, gait=question.gait, control=STARTS[law], seed=5 + i) for law in laws for i in range(2)]
    record = simulate(runs, duration=3.0, timestep=STEP, sample_stride=10)
    walked = record.limb_phase.transpose("run", "time", "leg").values
    starts = range(2)
    assert question._phases(STARTS["off"], starts, record.time.values).tobytes() == walked[:2].tobytes()
    assert question._phases(STARTS["own_load"], starts, record.time.values).tobytes() != walked[2:].tobytes()


def test_every_start_whose_distance_is_measured_walks(quick_outcome):
    record = quick_outcome("feedback").record
    walked = record.start_way.notnull().all("start_time")
    assert walked.sel(law=["closed_noisy", "isolated_noisy", "cross_load", "wrong_sign"]).all()
    assert walked.sel(law="off").values.tolist() == [True, False]
    assert record.start_phase.notnull().all()

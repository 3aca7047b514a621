"""What is smaller is better, kept limits before broken ones, walking before not walking."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import OutsideLimits, SuchusError
from suchus.experiments.optimise import Aim, Limit
from suchus.experiments.optimise import evaluate as evaluating
from suchus.experiments.optimise.aims import AIMS, LIMITS
from suchus.experiments.optimise.evaluate import evaluate, excesses, is_allowed, losses, score, units
from suchus.experiments.optimise.search import SearchResult
from suchus.robot.design import servo_names
from suchus.robot.gaits import default_gait
from suchus.robot.kinematics.tail import servo_angle
from suchus.robot.motion import excess
from suchus.robot.robots import ROBOTS


def table(ways, clear, status=None, beyond=None):
    n = len(ways)
    return xr.Dataset(
        {
            "share": (("candidate", "field"), np.full((n, 2), 0.5)),
            "aim_displacement": ("candidate", np.array(ways, dtype=float)),
            "limit_clearance": ("candidate", np.array(clear, dtype=float)),
            "status": ("candidate", np.array(status or ["walked"] * n)),
            "beyond": ("candidate", np.array(beyond or [0.0] * n)),
            "generation": ("candidate", np.arange(n)),
        }
    )


def test_farther_is_better_until_a_limit_breaks(small):
    tried = table([0.5, 1.0, 2.0], [0.02, 0.02, 0.001])
    assert excesses(small, tried)[:, 0] == pytest.approx([-3.0, -3.0, 0.8])
    assert is_allowed(small, tried).tolist() == [True, True, False]
    assert np.argsort(score(small, tried, np.array([0.5]))).tolist() == [1, 0, 2]
    assert score(small, tried, np.array([0.5]))[0] == -1.0


def test_a_most_is_broken_above_and_a_least_below(small):
    spec = replace(small, limits=(Limit(name="slip", value=0.5),))
    tried = table([1.0], [0.02]).assign(limit_slip=("candidate", np.array([0.6])))
    assert excesses(spec, tried)[0, 0] == pytest.approx(0.2)


def test_what_does_not_walk_comes_last_the_nearer_to_walking_the_better(small):
    tried = table(
        [-0.5, np.nan, np.nan, np.nan, np.nan],
        [-0.05, np.nan, np.nan, np.nan, np.nan],
        ["walked", "refused", "refused", "diverged", "refused"],
        [0.0, 0.1, 3.0, 0.0, np.inf],
    )
    found = score(small, tried, np.array([0.5]))
    assert np.argsort(found).tolist() == [0, 1, 2, 3, 4]
    assert np.isfinite(found).all()


def test_aims_are_weighed_in_parts_of_the_start(small):
    spec = replace(small, aims=(Aim(name="displacement", weight=2.0), Aim(name="cost_of_transport")), limits=())
    start = table([0.5], [0.0]).assign(aim_cost_of_transport=("candidate", np.array([0.8])))
    tried = table([1.0], [0.0]).assign(aim_cost_of_transport=("candidate", np.array([0.4])))
    parts = units(spec, start)
    assert losses(spec, tried, parts)[0] == pytest.approx([-2.0, 0.5])
    assert score(spec, tried, parts)[0] == pytest.approx(-3.5)


def test_the_front_is_what_nothing_betters_in_both(small):
    spec = replace(small, aims=(Aim(name="displacement"), Aim(name="cost_of_transport")), pareto=True)
    ways, costs = [1.0, 0.5, 0.7, 0.9, 2.0], [1.0, 0.4, 0.9, 0.7, 0.1]
    tried = table(ways, [0.02] * 4 + [0.0]).assign(aim_cost_of_transport=("candidate", np.array(costs)))
    history = tried.assign(score=("candidate", np.zeros(5)))
    found = SearchResult(spec=spec, start=tried.isel(candidate=[0]), history=history)
    assert set(found.front) == {0, 1, 3}  # 2 is bettered by 3; 4 breaks a limit
    assert set(found.chosen_indices) == {0, 1, 3}
    areas = found.covered_areas()
    assert (np.diff(areas) >= 0).all()
    assert areas[0] == pytest.approx(1.0)  # from nothing to one start, from one start's cost to two


def test_a_gait_that_can_be_followed_has_no_excess_and_others_more_the_farther_they_are(robot, crawl_gait):
    assert excess(robot, crawl_gait) == 0.0
    bends = [excess(robot, crawl_gait.with_numbers(trunk_bend=bend)) for bend in (2.35, 2.4, 2.6, 3.0)]
    assert bends[0] == 0.0  # three joints of 45 degrees bear 2.356 rad
    assert bends == sorted(bends)
    assert bends[1] == pytest.approx(3 * (2.4 / 3 - np.pi / 4) / 0.1)
    high = [excess(robot, crawl_gait.with_numbers(height=height)) for height in (0.86, 1.03, 1.15, 1.7)]
    assert 0.0 < high[1] < high[2] < high[3]
    turned = [float(servo_angle(robot.tail, np.float64(bend))) for bend in (1.7, robot.tail.bend_limit)]
    assert excess(robot, crawl_gait.with_numbers(tail_bend=1.7)) == pytest.approx((turned[0] - turned[1]) / 0.1)
    assert excess(robot, replace(crawl_gait, period=0.1)) > 0.0  # too fast for the servos


@pytest.mark.parametrize("name", ["salamander", "salamandra", "strider", "swimmer", "pleurobot"])
def test_the_own_gait_of_any_body_has_no_excess_and_a_faster_one_has(name):
    robot = ROBOTS[name]
    own = default_gait(robot)
    assert excess(robot, own) == 0.0
    speed = min(robot.servo(servo).speed for servo in servo_names(robot))
    assert excess(robot, replace(own, period=1e-3 * own.period)) > 0.1 * speed
    with pytest.raises(SuchusError):
        excess(ROBOTS["strider" if name != "strider" else "salamander"], own)


def test_a_candidate_that_the_simulation_refuses_costs_no_other_one_its_place(small, monkeypatch):
    strokes = np.array([[0.3, 0.4], [0.5, 0.4], [0.7, 0.4]])
    alone = evaluate(small, strokes)
    refused = small.candidate({"gait.stroke": 0.5, "gait.trunk_bend": 0.4}).gait
    simulate = evaluating.simulate

    def refusing(runs, **options):
        if any(run.gait == refused for run in runs):
            raise OutsideLimits("a foot point between those that were looked at is out of reach")
        return simulate(runs, **options)

    monkeypatch.setattr(evaluating, "simulate", refusing)
    tried = evaluate(small, strokes)
    assert tried.status.values.tolist() == ["walked", "refused", "walked"]
    assert tried.beyond.values.tolist() == [0.0, np.inf, 0.0]
    assert tried.aim_displacement.values[[0, 2]].tolist() == alone.aim_displacement.values[[0, 2]].tolist()


def test_the_foot_that_is_lifted_least_and_those_that_stand_most_and_least_are_told():
    time = np.arange(0.0, 9.0, 0.01)
    legs = ["LF", "RF", "LH", "RH"]
    lifts, stands = np.array([0.03, 0.02, 0.004, 0.01]), np.array([0.5, 0.75, 1.0, 0.25])
    swing = (time % 4.0)[:, None] / 4.0 >= stands
    height = np.where(swing, lifts, 0.0)
    at_rest = stands == 1.0
    height[:, at_rest] = lifts[at_rest] * (np.arange(len(time)) % 2)[:, None]
    level = np.zeros_like(height)
    dims = ("run", "time", "leg", "xyz")
    position, force = (np.stack([level, level, up], axis=-1)[None] for up in (height, 20.0 * ~swing))
    record = xr.Dataset(
        {
            "foot_position": (dims, position),
            "foot_force": (dims, force),
            "period": ("run", [4.0]),
            "mass": ("run", [3.5]),
        },
        coords={"time": time, "leg": legs, "xyz": ["x", "y", "z"]},
    )
    assert AIMS["foot_lift"].measure([], record) == pytest.approx([0.004])
    assert LIMITS["duty_greatest"].measure([], record) == pytest.approx([1.0])
    assert LIMITS["duty_least"].measure([], record) == pytest.approx([0.25], abs=0.01)

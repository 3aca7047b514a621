"""The limit study of galloping: from which servo on a bound pays."""

from dataclasses import replace
from math import inf

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import InvalidDesign
from suchus.experiments.catalog.gallop_limits.experiment import (
    COMPARED,
    GallopLimits,
    _min_paying_speed,
    experiment,
    fastest_gaits,
)
from suchus.experiments.catalog.gallop_limits.gaits import BOUNDS, TROTS
from suchus.robot.design import layout
from suchus.robot.motion import START, cycle_targets
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Tolerances
from suchus.sim.metrics import flight_share

SPEEDS = np.array([7.0, 14.0, 28.0])
EXACT = Tolerances(zero_error=0.0, dead_band=0.0, backlash=0.0, friction=0.0, mass=0.0)


def test_the_servo_that_is_needed_is_the_first_from_which_all_faster_ones_pay():
    assert _min_paying_speed(SPEEDS, np.array([False, True, True])) == 14.0
    assert _min_paying_speed(SPEEDS, np.array([True, False, True])) == 28.0  # a lucky cell is none
    assert _min_paying_speed(SPEEDS, np.array([True, True, True])) == 7.0
    assert _min_paying_speed(SPEEDS, np.array([True, True, False])) == inf


def record(bound, flight, walk=0.4, spread=0.0):
    """One torque, three servo speeds, a bound, a worse bound, a trot and a walk; bounds of six robots differ."""
    built = np.stack([bound[0] * (1.0 + spread * np.linspace(-1.0, 1.0, 6)), np.full(6, walk)])
    one = np.ones(3)
    speed = np.stack([np.array(bound), 0.1 * one, walk * one, 0.3 * one], axis=-1)[None]
    flies = np.stack([np.array(flight), 0.5 * one, 0.0 * one, 0.0 * one], axis=-1)[None]
    dims = ("torque", "servo_speed", "gait")
    return xr.Dataset(
        {
            "speed": (dims, speed),
            "flight": (dims, flies),
            "joint_speed": (dims, np.full((1, 3, 4), 20.0)),
            "built_speed": (("compared", "repeat"), built),
            "built_flight": (("compared", "repeat"), np.outer([flight[0], 0.0], np.ones(6))),
            "built_joint_speed": (("compared", "repeat"), np.full((2, 6), 20.0)),
        },
        coords={
            "torque": [2.5],
            "servo_speed": SPEEDS,
            "gait": list("abcd"),
            "kind": ("gait", ["bound", "bound", "trot", "walk"]),
            "compared": ["bound", "trot or walk"],
        },
        attrs={"own_torque": 2.5, "own_speed": 7.0},
    )


def measured(*args, **fields):
    return {name: one.value for name, one in GallopLimits().measure(record(*args, **fields)).items()}


def test_measures_of_a_record_with_a_known_answer():
    m = measured((0.2, 0.5, 0.9), (0.2, 0.2, 0.4))
    assert m["bound_over_walk"] == m["bound_over_walk_low"] == m["bound_over_walk_high"] == pytest.approx(0.5)
    apart = measured((0.2, 0.5, 0.9), (0.2, 0.2, 0.4), spread=0.1)
    assert [apart[f"bound_over_walk{end}"] for end in ("_low", "", "_high")] == pytest.approx([0.45, 0.5, 0.55])
    few = record((0.2, 0.5, 0.9), (0.2, 0.2, 0.4))
    few = few.isel(repeat=slice(0, 5))  # five robots are too few for an interval
    assert np.isnan(GallopLimits().measure(few)["bound_over_walk_low"].value)
    assert (m["speed_bound"], m["flight_bound"], m["speed_walk"]) == pytest.approx((0.2, 0.2, 0.4))  # of those as built
    assert (m["speed_bound_best"], m["servo_speed_best"], m["flight_bound_best"]) == (0.9, 28.0, 0.4)
    assert m["servo_speed_needed"] == 14.0
    assert m["gallops_share"] == pytest.approx(2 / 3)
    assert measured((0.2, 0.5, 0.9), (0.2, 0.09, 0.4))["servo_speed_needed"] == 28.0  # faster, but it hardly flies
    assert measured((0.2, 0.3, 0.39), (0.4, 0.4, 0.4))["servo_speed_needed"] == inf


def test_the_explanation_follows_the_measures():
    told = experiment.explain(measured((0.2, 0.5, 0.9), (0.2, 0.2, 0.4)))
    assert "does not outrun the fastest trot or walk (0.40 m/s)" in told
    assert "it gallops with servos of 14 rad/s and all faster ones" in told
    told = experiment.explain(measured((0.41, 0.5, 0.9), (0.2, 0.2, 0.4), spread=0.1))
    assert "may outrun or not, within what robots as built differ, the fastest trot or walk (0.40 m/s)" in told
    told = experiment.explain(measured((0.6, 0.6, 0.6), (0.09, 0.09, 0.09)))
    assert "It outruns the fastest trot or walk" in told
    assert "no servo speed of the map" in told


def test_a_better_servo_does_what_a_lesser_one_does():
    one = record((0.6, 0.3, 0.9), (0.4, 0.0, 0.2))
    strong = one.assign(speed=0.5 * one.speed).assign_coords(torque=[5.0])
    both = xr.concat([one, strong], "torque", data_vars="minimal")
    bound, walk = fastest_gaits(both, "bound"), fastest_gaits(both, "trot", "walk")
    assert bound.speed.values.tolist() == [[0.6, 0.6, 0.9]] * 2
    assert bound.flight.values.tolist() == [[0.4, 0.4, 0.2]] * 2  # of the gait that is taken
    assert walk.speed.values.tolist() == [[0.4, 0.4, 0.4]] * 2


def test_the_fastest_gaits_with_servos_like_the_robots_own_are_walked_by_robots_as_built(quick_outcome):
    """Without errors a robot as built does what the robot as designed does on the map."""
    question = replace(experiment.quick(), tolerances=EXACT, repeats=2, speeds=(5.0, 7.0), seconds=0.3)
    drawn = question.simulate().record
    mapped = {name: fastest_gaits(drawn, *group).sel(servo_speed=7.0, torque=2.5) for name, group in COMPARED.items()}
    for name, fastest in mapped.items():
        for quantity in ("speed", "flight", "joint_speed"):
            as_built = drawn[f"built_{quantity}"].sel(compared=name)
            assert as_built.values.tolist() == [float(fastest[quantity])] * 2
    built = quick_outcome("gallop_limits").record.built_speed
    assert built.notnull().all()
    assert built.dims == ("compared", "repeat")


def test_nothing_touches_in_flight():
    force = np.zeros((1, 4, 4, 3))
    force[0, 1:, 0, 2] = 5.0  # a foot stands in three of four samples
    time = START + 0.01 * np.arange(4)
    none = np.zeros((1, 4, 3, 3))
    flown = xr.Dataset(
        {
            "foot_force": (("run", "time", "leg", "xyz"), force),
            "belly_force": (("run", "time", "segment", "xyz"), none),
            "tail_force": (("run", "time", "xyz"), np.zeros((1, 4, 3))),
            "mass": ("run", [3.5]),
        },
        coords={"time": time, "xyz": list("xyz"), "leg": list("abcd"), "segment": list("abc")},
    )
    assert float(flight_share(flown)[0]) == 0.25
    flown["tail_force"][0, 0, 2] = 0.03  # less than a thousandth of 34 N
    assert float(flight_share(flown)[0]) == 0.25
    flown["tail_force"][0, 0, 2] = 0.04
    assert float(flight_share(flown)[0]) == 0.0


def test_a_shortened_map_is_not_judged_and_wrong_fields_are_told():
    assert experiment.unjudged() == ""
    assert "speeds has 2 values" in experiment.quick().unjudged()
    with pytest.raises(InvalidDesign, match="walks is empty"):
        GallopLimits(walks=())


def test_a_bound_bends_the_trunk_up_and_down_and_a_trot_does_not():
    for searched, swing in ((BOUNDS[0], 0.4674), (TROTS[0], 0.0)):
        robot = ROBOTS["caiman"]
        pitch = list(layout(robot).trunk_pitch)
        bend = cycle_targets(robot, searched.gait, np.arange(64) / 64)[:, pitch].sum(axis=1)
        assert np.ptp(bend) == pytest.approx(2 * swing, rel=0.01)
    fore = BOUNDS[0].gait.limb_phases
    assert fore[0] == fore[1]
    assert fore[2] == fore[3]

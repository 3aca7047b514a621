"""What the three experiments on postures must find, beyond what holds for every experiment."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.speed_range.experiment import _UNITS, _models, _with_other_servos
from suchus.experiments.catalog.terrain.experiment import FLAT_ARMS, SINGLE, _meets_obstacle
from suchus.robot.design import layout
from suchus.robot.design.ground import STONE, Bumps, Step, Stone
from suchus.robot.design.servos import with_full_torque, with_named_servos, with_servos
from suchus.robot.gaits import GAITS
from suchus.robot.motion import hip_height
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Run, simulate


@pytest.fixture(scope="module")
def speeds(quick_outcome):
    return quick_outcome("speed_range")


@pytest.fixture(scope="module")
def rough(quick_outcome):
    return quick_outcome("terrain")


def test_slower_cycles_walk_slower_and_cheaper(speeds):
    walked = speeds.record.sel(servo_model="own")
    assert (walked.speed.diff("slower") < 0).all()
    assert (walked.cost.diff("slower") < 0).all()


def test_froude_number_and_duty_factor_fit_the_gaits(speeds):
    record = speeds.record
    for name in ("semi_erect", "high_walk"):
        one = record.sel(gait=name)
        assert one.froude.values == pytest.approx(
            one.speed.values**2 / 9.81 / hip_height(ROBOTS["caiman"], GAITS[name])
        )
        assert one.duty.values == pytest.approx(GAITS[name].duty_factor, abs=0.08)  # it carries before and after


def test_a_speed_line_costs_no_speed_and_does_not_change_the_work_out_of_reason(speeds):
    """A DC motor's torque falls with its speed; the robot walks as fast, and its shafts do work of the same size."""
    line, full = (speeds.record.sel(servo_model=model) for model in ("own", "other"))
    assert line.speed.values == pytest.approx(full.speed.values, rel=0.08)
    assert (line.cost != full.cost).all()
    assert ((line.cost > 0.5 * full.cost) & (line.cost < 2.0 * full.cost)).all()


def test_animals_are_named_beside_their_speed_and_a_short_run_is_not_judged(speeds):
    measures = speeds.measures
    assert (measures["animals_high_walk_slowest"].value, measures["animals_high_walk_fastest"].value) == (0.1, 0.7)
    assert "Nile crocodiles" in speeds.decides
    assert speeds.verdicts == ()
    assert "gaits" in speeds.unjudged


def test_other_gaits_than_the_high_walk_are_measured_too():
    record = xr.Dataset(
        {name: (("gait", "servo_model", "slower"), np.full((1, 2, 1), 0.2)) for name in _UNITS},
        coords={"gait": ["low_crawl"], "servo_model": ["own", "other"], "slower": [1.0]},
    )
    experiment = replace(EXPERIMENTS["speed_range"], gaits=(GAITS["low_crawl"],), slower=(1.0,))
    assert experiment.measure(record)["speed_low_crawl"].value == 0.2


def test_servos_of_two_kinds_are_called_so_and_all_have_their_full_torque_in_the_other_model(robot):
    """Servos that were bought for some joints only: a motor in these, none in the others."""
    bare = with_servos(robot, with_full_torque)
    some = with_named_servos(bare, {"LF_yaw": robot.servo("LF_yaw")})  # its mirror image with it
    full, line = "servos of equal torque at any speed", "servos whose torque falls with speed"
    assert _models(bare) == (full, line)
    assert _models(robot) == (line, full)
    assert _models(some) == ("servos of which 2 of 12 lose torque with speed", full)
    legs = [name for name in layout(robot).servos if name[:2] in ("LF", "RF", "LH", "RH")]
    assert {_with_other_servos(some).servo(name).winding for name in legs} == {None}
    assert None not in {_with_other_servos(bare).servo(name).winding for name in legs}


def test_the_commanded_circle_comes_out_within_ten_percent(quick_outcome):
    measures = quick_outcome("turning").measures
    assert measures["circles_walked_semi_erect"].value == 1
    assert measures["radius_off_semi_erect"].value < 0.1
    assert measures["tightest_both_semi_erect"].value < measures["tightest_bend_semi_erect"].value


def test_a_low_belly_catches_on_a_stone_that_higher_postures_pass(robot):
    stone = Ground(relief=replace(STONE, height=0.04))
    gaits = [GAITS[name] for name in ("low_crawl", "semi_erect", "high_walk")]
    record = simulate([Run(robot=robot, gait=gait, ground=stone) for gait in gaits], duration=4.0, timestep=0.005)
    pressed = record.belly_force.sel(xyz="z").sum("segment").max("time").values
    assert pressed[0] > 5.0
    assert (pressed[1:] == 0.0).all()


def test_no_transition_falls_and_nobody_falls_on_even_ground(rough):
    assert float(rough.record.change_tilt.max()) < np.radians(30)
    assert float(rough.record.fell.isel(ground=0).max()) == 0.0


def test_a_switching_robot_is_its_home_posture_where_nothing_touches(rough):
    flat = rough.record.isel(ground=0, seed=0).forward
    assert float(flat.sel(arm="switching")) == float(flat.sel(arm="semi_erect"))


def test_every_seed_has_ground_of_its_own():
    grounds = EXPERIMENTS["terrain"].grounds()
    for _, height, reliefs in grounds:
        assert len(set(reliefs)) == (len(reliefs) if height else 1)
    assert len(grounds) == 9


def walked(front, snout, pressed):
    """Return a record in which the front feet, the snout and the ground under the belly come to these values."""
    force = np.zeros((2, 1, 3))
    force[1, 0, 2] = pressed
    return xr.Dataset(
        {
            "foot_position": (
                ("time", "leg", "xyz"),
                np.array([[[0.4, 0, 0], [0.4, 0, 0]], [[front, 0, 0], [0.4, 0, 0]]]),
            ),
            "snout": (("time", "xyz"), [[0.6, 0.0, 0.1], [snout, 0.0, 0.1]]),
            "belly_force": (("time", "segment", "xyz"), force),
        },
        coords={"leg": ["LF", "RF"], "xyz": list("xyz")},
    )


def test_an_obstacle_is_met_where_the_robot_came_to_it(robot):
    radius, head = robot.front_leg.foot_radius, robot.head.snout
    stone = replace(STONE, at=0.75, length=0.06)
    cases = [
        (Bumps(height=0.03, correlation=0.06, start=0.42, seed=0), walked(0.42, 0.7, 0.0), True),
        (Bumps(height=0.03, correlation=0.06, start=0.42, seed=0), walked(0.41, 0.7, 0.0), False),
        (Step(at=0.66, height=0.03), walked(0.66 - radius, 0.9, 0.0), True),
        (Step(at=0.66, height=0.03), walked(0.64 - radius, 0.9, 0.0), False),
        (stone, walked(0.9, 0.721 + head, 0.0), True),
        (stone, walked(0.9, 0.719 + head, 0.0), False),
        (stone, walked(0.5, 0.7, 5.0), True),
        (None, walked(0.4, 0.6, 0.0), True),
    ]
    for relief, record, met in cases:
        assert isinstance(relief, Bumps | Step | Stone | None)
        run = Run(robot=robot, gait=GAITS["low_crawl"], ground=Ground(relief=relief))
        assert _meets_obstacle(record, run) is met, relief


def rough_record(*, ahead=(True, True, False), met=1.0):
    """Return what three rough grounds and an even one came to: where the erect walk gets ahead, and who met them."""
    arms, seeds = [*SINGLE, "switching"], 2
    forward = np.ones((4, len(arms), seeds))
    for ground, erect in enumerate(ahead, start=1):
        forward[ground, arms.index("high_walk")] = 1.2 if erect else 0.8
    values = {name: np.zeros_like(forward) for name in ("aside", "fell", "belly")} | {"cost": np.ones_like(forward)}
    flat_cost = np.array([np.linspace(0.5, 0.6, 6), np.ones(6)])
    met_by = np.ones_like(forward)
    met_by[2, arms.index("low_crawl"), 1] = met
    changes = {"change_tilt": np.array([[0.2, 1.1]]), "change_after": np.array([[0.5, 0.3]])}
    return xr.Dataset(
        {name: (("ground", "arm", "seed"), v) for name, v in (values | {"forward": forward, "met": met_by}).items()}
        | {name: (("change", "surface"), v) for name, v in changes.items()}
        | {"flat_cost": (("flat_arm", "robot_built"), flat_cost)}
        | {"height": ("ground", [0.0, 0.03, 0.03, 0.04]), "size_of_robot": ((), 1.0), "looks": ((), 1)},
        coords={"arm": arms, "kind": ("ground", ["bumps", "bumps", "step", "stone"]), "surface": ["even", "bumps"]}
        | {"flat_arm": list(FLAT_ARMS)},
    )


def test_erect_legs_are_ahead_where_they_get_farther_and_told_only_if_all_met():
    found = {name: m.value for name, m in EXPERIMENTS["terrain"].measure(rough_record()).items()}
    assert found["erect_open_loop_ahead_share"] == pytest.approx(2 / 3)
    assert found["met_judged"] == 1.0
    assert (found["flat_cost_ratio_low"], found["flat_cost_ratio_high"]) == (0.5, 0.6)
    assert found["transitions_upright"] == 0.5  # 1.1 rad are more than 60 degrees
    assert found["transition_after_least"] == 0.3
    assert found["erect_open_loop_ahead_share_low"] < 2 / 3 < found["erect_open_loop_ahead_share_high"]
    behind = EXPERIMENTS["terrain"].measure(rough_record(ahead=(False, False, True)))
    assert behind["erect_open_loop_ahead_share"].value == pytest.approx(1 / 3)
    missed = EXPERIMENTS["terrain"].measure(rough_record(met=0.0))
    assert np.isnan(missed["erect_open_loop_ahead_share"].value)
    assert missed["met_step_low_crawl"].value == 0.5
    assert "met 100% of the bumps, 50% of the steps" in EXPERIMENTS["terrain"].explain(
        {n: m.value for n, m in missed.items()}
    )


def test_what_is_kept_is_a_fraction_of_the_same_robots_even_ground():
    record = rough_record()
    record.forward[0, record.arm.values.tolist().index("high_walk")] = 0.75
    found = {name: m.value for name, m in EXPERIMENTS["terrain"].measure(record).items()}
    assert found["erect_open_loop_ahead_share"] == pytest.approx(2 / 3)
    assert found["erect_open_loop_kept_share"] == 1.0  # 0.8 of 0.75 m is more than 1 of 1 m
    record.forward[0, record.arm.values.tolist().index("high_walk")] = 1.25
    assert EXPERIMENTS["terrain"].measure(record)["erect_open_loop_kept_share"].value == 0.0


def test_terrain_and_speed_are_judged_only_by_runs_that_meet_what_is_judged():
    terrain, speeds = EXPERIMENTS["terrain"], EXPERIMENTS["speed_range"]
    assert terrain.unjudged() == speeds.unjudged() == ""
    assert "surfaces is even, and" in replace(terrain, surfaces=("even",)).unjudged()
    assert "walked is 13.9 s, and 14 s at least" in replace(terrain, walked=13.9).unjudged()
    assert "stones has 2 values, and 3 at least" in replace(terrain, stones=(0.04, 0.06)).unjudged()
    assert "gaits is semi_erect, and" in replace(speeds, gaits=(GAITS["semi_erect"],)).unjudged()

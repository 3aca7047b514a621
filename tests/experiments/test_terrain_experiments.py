"""What the three experiments on postures must find, beyond what holds for every experiment."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.experiments import EXPERIMENTS
from suchus.gaits import GAITS
from suchus.land import Ground, Run, simulate
from suchus.land.arenas import STONE


@pytest.fixture(scope="module")
def speeds():
    return EXPERIMENTS["speed_range"].quick().run()


@pytest.fixture(scope="module")
def rough():
    return EXPERIMENTS["terrain"].quick().run()


def test_slower_cycles_walk_slower_and_cheaper(speeds):
    walked = speeds.record.sel(servo_model="slew")
    assert (walked.speed.diff("slower") < 0).all()
    assert (walked.cost.diff("slower") < 0).all()


def test_froude_number_and_duty_factor_fit_the_gaits(speeds):
    record = speeds.record
    for name in ("semi_erect", "high_walk"):
        one = record.sel(gait=name)
        assert one.froude.values == pytest.approx(one.speed.values**2 / 9.81 / GAITS[name].hip_height)
        assert one.duty.values == pytest.approx(GAITS[name].duty_factor, abs=0.06)


def test_a_speed_line_costs_work_and_no_speed(speeds):
    slew, line = (speeds.record.sel(servo_model=model) for model in ("slew", "line"))
    assert line.speed.values == pytest.approx(slew.speed.values, rel=0.08)
    assert (line.cost > 1.5 * slew.cost).all()


def test_animals_of_its_size_are_named_where_the_articles_speeds_are_judged(speeds):
    words = {verdict.claim.key: verdict for verdict in speeds.verdicts}
    assert words["high_walk_speed_low"].verdict == "contradicted"
    assert "Nile" in words["high_walk_speed_low"].why


def test_the_commanded_circle_comes_out_within_ten_percent():
    measures = EXPERIMENTS["turning"].quick().run().measures
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
    assert len(grounds) == 15

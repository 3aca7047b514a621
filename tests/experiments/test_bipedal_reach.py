from dataclasses import replace

import numpy as np
import pytest

from suchus.errors import InvalidDesign
from suchus.experiments import EXPERIMENTS
from suchus.figures.reach import draw_limits
from suchus.figures.standing import draw_side_views
from suchus.kinematics.mass import cantilever_torque
from suchus.motion.rising import stretched
from suchus.robots import ROBOTS

CAIMAN = ROBOTS["caiman"]


@pytest.fixture(scope="module")
def outcome():
    return EXPERIMENTS["bipedal_reach"].quick().run()


@pytest.fixture(scope="module")
def value(outcome):
    return {name: measure.value for name, measure in outcome.measures.items()}


def test_it_stands_all_the_time_and_reaches_at_most_its_own_length(value):
    assert value["held"] >= EXPERIMENTS["bipedal_reach"].quick().hold
    assert 0.64 < value["reach_standing"] < stretched(CAIMAN) + CAIMAN.hind_leg.foot_radius
    assert value["reach_standing"] <= value["ceiling"] < stretched(CAIMAN) + CAIMAN.hind_leg.foot_radius


def test_the_mass_never_passes_the_feet_between_lifting_the_front_and_standing(value):
    assert value["margin_rising"] > 0.03
    assert value["margin_standing"] > 0.03


def test_it_sits_down_into_the_crawl_and_crawls_on(value):
    assert value["reach_after"] == pytest.approx(value["reach_crawl"], abs=0.01)
    assert value["way_after"] > 0.3


def test_no_servo_gives_more_than_it_has_and_the_trunk_gives_what_the_forebody_asks_for(value):
    for leg in ("LH", "RH"):
        assert value[f"torque_rising_{leg}_pitch"] < CAIMAN.hind_leg.servo.torque
    assert value["torque_rising_spine_pitch_1"] < CAIMAN.spine.pitch_servo.torque
    assert value["torque_rising_spine_pitch_1"] > 0.95 * cantilever_torque(CAIMAN)


def test_strong_trunks_stand_and_weak_ones_do_not(outcome):
    found = outcome.record.map_reach
    assert (found.sel(torque=5.0) > 0.64).all()
    assert (found.sel(torque=2.0) < 0.3).all()
    assert (np.diff(outcome.record.map_cantilever) > 0).all()


def test_legs_decide_the_crawl_and_all_three_lengths_the_stand(value):
    assert value["gain_leg_crawling"] == pytest.approx(0.09 / 0.175, abs=0.05)  # the hips' height over the leg's length
    for part in ("spine", "head"):
        assert abs(value[f"gain_{part}_crawling"]) < 0.05
        assert value[f"gain_{part}_standing"] == pytest.approx(1.0, abs=0.05)
    assert value["gain_leg_standing"] == pytest.approx(0.94, abs=0.15)


def test_a_light_push_is_borne_and_a_hard_one_is_not(value):
    for way in ("fore", "aft", "lateral"):
        assert 2.0 < value[f"push_{way}_on"] <= 25.0


def test_figures_are_drawn_from_the_record(outcome):
    figure = draw_side_views(CAIMAN, outcome.record)
    texts = [text.get_text() for text in figure.axes[0].texts]
    assert "standing" in texts
    assert f"{float(outcome.measures['reach_standing'].value):.2f} m" in texts
    limits = draw_limits(CAIMAN, outcome.record, 0.6 * stretched(CAIMAN))
    shown = [t.get_text() for t in limits.axes[0].texts]
    assert shown == [f"{v:.2f}" for v in outcome.record.map_reach.values.ravel()]


@pytest.mark.parametrize(
    ("fields", "message"),
    [({"hold": 0.0}, "bipedal_reach.hold is 0 s"), ({"repeats": 0}, "repeats is 0; a whole number of 1")],
)
def test_impossible_settings_are_refused(fields, message):
    with pytest.raises(InvalidDesign, match=message):
        replace(EXPERIMENTS["bipedal_reach"], **fields)

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from tests.bodies import eight, six

from suchus.core.errors import InvalidDesign, UnsuitedRobot
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.bipedal_reach.experiment import min_lead
from suchus.experiments.catalog.bipedal_reach.figure import draw_limits, draw_side_views
from suchus.robot.design import lacking, with_values
from suchus.robot.motion.rising import cantilever_torque, stretched_length
from suchus.robot.robots import ROBOTS

CAIMAN = ROBOTS["caiman"]


@pytest.fixture(scope="module")
def outcome(quick_outcome):
    return quick_outcome("bipedal_reach")


@pytest.fixture(scope="module")
def value(outcome):
    return {name: measure.value for name, measure in outcome.measures.items()}


def test_it_stands_all_the_time_and_reaches_at_most_its_own_length(value):
    assert value["held"] >= EXPERIMENTS["bipedal_reach"].quick().hold
    assert 0.64 < value["reach_standing"] < stretched_length(CAIMAN) + CAIMAN.hind_leg.foot_radius
    assert value["reach_standing"] <= value["ceiling"] < stretched_length(CAIMAN) + CAIMAN.hind_leg.foot_radius


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
        assert abs(value[f"gain_{part}_crawling"]) < 0.2 * value["gain_leg_crawling"]
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
    limits = draw_limits(CAIMAN, outcome.record, 0.6 * stretched_length(CAIMAN))
    shown = [t.get_text() for t in limits.axes[0].texts]
    assert shown == [f"{v:.2f}" for v in outcome.record.map_reach.values.ravel()]


def test_a_short_stand_is_not_judged_and_says_what_a_long_one_needs(outcome):
    assert outcome.verdicts == ()
    assert outcome.unjudged == "Not judged: hold is 1 s, and 10 s at least are needed to meet what is judged."
    full = EXPERIMENTS["bipedal_reach"]
    assert full.unjudged() == ""
    assert replace(full, robot=ROBOTS["long_tail"]).unjudged().startswith("Not judged: robot is long_tail")
    for rule in full.rules():
        assert rule.needs <= set(outcome.measures)
        assert rule.reason({name: measure.value for name, measure in outcome.measures.items()})


def story(reach, lead, stretched: float) -> xr.Dataset:
    """Return the run of a robot that is told to stand up at 1 s and to be upright at 3 s."""
    stages = [0.0, 1.0, 3.0, 4.0, 5.0, 6.0]
    time = np.arange(0.0, 6.0, 0.5)
    data = {"reach": (("run", "time"), [reach]), "lead": (("run", "time"), [lead])}
    return xr.Dataset(data, coords={"time": time}, attrs={"stages": stages, "stretched": stretched})


@pytest.mark.parametrize("size", [0.1, 1.0, 5.0])
def test_the_front_lifts_at_the_same_part_of_a_robot_of_any_size(size):
    heights = size * np.array([0.1, 0.1, 0.1, 0.1, 0.3, 0.5, 0.7, 0.7, 0.7, 0.7, 0.1, 0.1])
    leads = size * np.array([0, 0, -0.2, -0.1, -0.05, 0.04, 0.03, 0.01, 0.01, 0, 0, 0])
    assert min_lead(story(heights, leads, 0.7 * size)) == pytest.approx(-0.05 * size)  # not those while it lies


def test_a_robot_whose_front_stays_down_has_no_lead():
    assert np.isnan(min_lead(story(np.full(12, 0.1), np.zeros(12), 0.7)))


def test_what_decides_follows_from_the_numbers(value):
    explain = EXPERIMENTS["bipedal_reach"].explain
    assert "enough for it" in explain(value)
    assert "too little for it" in explain(value | {"pitch_torque": 2.0})


@pytest.mark.parametrize(
    ("fields", "message"),
    [({"hold": 0.0}, "bipedal_reach.hold is 0 s"), ({"repeats": 0}, "repeats is 0; a whole number of 1")],
)
def test_impossible_settings_are_refused(fields, message):
    with pytest.raises(InvalidDesign, match=message):
        replace(EXPERIMENTS["bipedal_reach"], **fields)


def test_a_body_of_six_spine_joints_stands_up_in_the_experiment_too():
    longer = with_values(six(), {"spine.pitch_servo.torque": 9.0})
    experiment = EXPERIMENTS["bipedal_reach"].quick().for_robot(longer)
    outcome = experiment.run()
    value = {name: measure.value for name, measure in outcome.measures.items()}
    assert outcome.verdicts == ()
    assert 0.95 * value["stretched_length"] < value["reach_standing"] < value["ceiling"]
    assert value["reach_after"] < 0.2
    angles = experiment.draw(outcome)["angles"].axes[1].get_legend().get_texts()
    assert "trunk, third pitch joint" in [text.get_text() for text in angles]


def test_who_has_no_tables_or_cannot_stand_up_is_refused():
    for robot in (eight(), ROBOTS["salamander"]):
        with pytest.raises(UnsuitedRobot, match=r"^bipedal_reach needs the article's tables"):
            EXPERIMENTS["bipedal_reach"].quick().for_robot(robot)
    assert lacking(six(), EXPERIMENTS["bipedal_reach"].needs) == []

"""When spine and tail pay: both arms search fairly, and the words follow the intervals."""

from dataclasses import replace
from math import nan

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import InvalidDesign, UnsuitedRobot
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.spine_and_tail_map.cells import (
    ARMS,
    FREE,
    STILL,
    arm_searches,
    on_fields_of_their_own,
    search_in_cell,
    with_tail_size,
)
from suchus.experiments.catalog.spine_and_tail_map.experiment import QUANTITIES, listed_words, words_of
from suchus.experiments.experiment import Measure
from suchus.robot.design import value_at
from suchus.robot.gaits import GAITS
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run
from suchus.sim.model import compile_model

QUESTION = EXPERIMENTS["spine_and_tail_map"]
CAIMAN = ROBOTS["caiman"]
SPREAD = np.linspace(-1.0, 1.0, 6)
NUMBERS = {
    "forward": (0.4, 0.2), "speed": (0.1, 0.05), "cost": (0.8, 1.6), "electrical": (3.0, 3.0), "margin": (0.01, 0.03),
    "slip": (0.4, 0.5), "stance_share": (0.7, 0.8), "limb_share": (0.9, 1.0), "tail_share": (0.05, 0.0),
}  # fmt: skip
"""Number of the free and of the still arm."""


def record(**changed):
    """Return a record of two conditions, base and half the friction, whose robots differ by a little."""
    numbers = NUMBERS | changed
    shape = (1, 2, len(ARMS), SPREAD.size)
    arrays = {name: np.empty(shape) for name in numbers}
    for name, values in numbers.items():
        for arm, value in enumerate(values):
            arrays[name][:, :, arm] = value + 0.001 * (1 + arm) * SPREAD
    variables = {name: (("search", "cell", "arm", "repeat"), values, {"units": "1"}) for name, values in arrays.items()}
    kept = {"keeps_limits": (("search", "cell", "arm"), np.array([[[True, True], [True, False]]]), {"units": "1"})}
    coordinates = {"cell": ["base", "friction_0_5"], "label": ("cell", ["base", "friction x 0.5"]), "arm": list(ARMS)}
    return xr.Dataset(variables | kept, coords=coordinates)


def test_changes_are_those_between_the_gaits_of_the_same_robot():
    measures = QUESTION.measure(record())
    assert measures["gain_base"].value == pytest.approx(0.2)
    assert measures["gain_base_low"].value == pytest.approx(0.199)
    assert measures["gain_base_high"].value == pytest.approx(0.201)
    assert measures["cost_ratio_friction_0_5"].value == pytest.approx(0.5, rel=1e-3)
    assert measures["margin_change_base"].value == pytest.approx(-0.02)
    assert measures["forward_still_base"].value == pytest.approx(0.2)
    assert measures["paying_share"].value == 1.0
    assert measures["saving_share"].value == 1.0
    assert measures["saving_electrical_share"].value == 0.0
    assert measures["steadier_share"].value == 0.0
    assert measures["limits_kept_share"].value == 0.75


def test_an_interval_holds_that_of_every_search():
    first, second = record(), record(cost=(1.7, 1.6), forward=(0.5, 0.2))
    measures = QUESTION.measure(xr.concat([first, second], "search"))
    assert measures["gain_base"].value == pytest.approx(0.25)
    assert measures["gain_base_low"].value == pytest.approx(0.199)
    assert measures["gain_base_high"].value == pytest.approx(0.301)
    assert measures["saving_share"].value == 0.0
    assert words_of(measures)["cost_ratio_base"] == "undecided"
    assert measures["paying_share"].value == 1.0


def test_who_does_not_get_on_has_no_cost_and_decides_nothing():
    measures = QUESTION.measure(record(forward=(0.4, -0.1)))
    assert np.isnan(measures["cost_ratio_base"].value)
    assert measures["saving_share"].value == 0.0
    assert measures["paying_share"].value == 1.0


def measures_of(**intervals):
    return {
        name: Measure(value, "-")
        for base, (low, high) in intervals.items()
        for name, value in ((base, (low + high) / 2), (f"{base}_low", low), (f"{base}_high", high))
    }


@pytest.mark.parametrize(
    ("name", "interval", "word"),
    [
        ("gain_base", (0.001, 0.2), "pays"),
        ("gain_base", (-0.2, -0.001), "costs"),
        ("gain_base", (-0.001, 0.2), "undecided"),
        ("gain_base", (nan, nan), "undecided"),
        ("cost_ratio_base", (0.5, 0.99), "pays"),
        ("cost_ratio_base", (1.01, 1.5), "costs"),
        ("electrical_ratio_base", (0.9, 1.1), "undecided"),
        ("margin_change_base", (-0.02, -0.01), "costs"),
    ],
)
def test_the_word_follows_the_interval(name, interval, word):
    assert words_of(measures_of(**{name: interval})) == {name: word}


def test_the_clause_lists_what_costs_and_what_is_undecided():
    labels = {"base": "base", "grains_2": "grains 2 N/cm3", "period_0_5": "period x 0.5"}
    words = dict(zip((f"gain_{cell}" for cell in labels), ("pays", "costs", "undecided"), strict=True))
    assert listed_words(words, "gain", labels, ("farther", "less far")) == (
        "farther in 1 of 3, less far in 1 (grains 2 N/cm3), undecided in 1 (period x 0.5)"
    )


def test_more_than_a_few_conditions_are_counted_and_not_named():
    labels = {name: name for name in "abcd"}
    words = {f"gain_{name}": "costs" for name in labels}
    text = listed_words(words, "gain", labels, ("farther", "less far"))
    assert text == "farther in 0 of 4, less far in 4"


def test_three_sentences_that_another_run_contradicts():
    question = replace(QUESTION.quick(), repeats=6)

    def words(**changed):
        return question.explain({name: one.value for name, one in question.measure(record(**changed)).items()})

    assert words().count(". ") + 1 == 3
    assert "farther in 2 of 2." in words()
    assert "farther in 0 of 2, less far in 2 (base and friction x 0.5)." in words(forward=(0.1, 0.2))
    assert "needs less work in 2 of 2" in words()
    assert "a larger margin in 0 of 2, a smaller one in 2 (base" in words()
    assert "its feet slide 0.40 and 0.50 of that, so that less sliding has its part" in words()
    assert "longer strides and not less sliding" in words(slip=(0.6, 0.5))
    assert "no gain is left to explain" in words(forward=(0.1, 0.2))


def test_each_condition_differs_from_the_base_in_one_thing():
    base, *others = QUESTION.cells()
    assert len({cell.name for cell in (base, *others)}) == len(others) + 1 == 13
    for cell in others:
        differs = [cell.robot != base.robot, cell.ground != base.ground, cell.period != base.period]
        assert sum(differs) == 1, cell.name
    assert {cell.axis for cell in others} == {"period", "slope", "friction", "roughness", "tail", "grains"}


def test_both_arms_search_the_same_legs_and_the_still_one_bends_nothing():
    searches = arm_searches(CAIMAN, GAITS["belly_crawl"])
    fields = {arm: [vary.field for vary in spec.vary] for arm, spec in searches.items()}
    axis = {"gait.trunk_bend", "gait.axis_lag", "gait.tail_bend", "gait.tail_lag"}
    assert set(fields[FREE]) - set(fields[STILL]) == axis
    assert set(fields[STILL]) < set(fields[FREE])
    for name in ("limits", "aims", "evaluations", "population", "seed"):
        assert getattr(searches[FREE], name) == getattr(searches[STILL], name)
    rng = np.random.default_rng(0)
    for _ in range(5):
        shares = dict(zip(fields[STILL], rng.uniform(size=len(fields[STILL])), strict=True))
        gait = searches[STILL].candidate(shares).gait
        assert value_at(gait, "trunk_bend") == 0.0
        assert value_at(gait, "tail_bend") == 0.0


def test_a_search_returns_the_best_gait_that_it_tried(monkeypatch):
    """On a walk whose displacement is the stroke of its gait."""
    module = "suchus.experiments.catalog.spine_and_tail_map.cells"

    def evaluated(spec, shares):
        strokes = [share[[vary.field for vary in spec.vary].index("gait.stroke")] for share in shares]
        count = len(shares)
        table = {"aim_displacement": np.array(strokes), "beyond": np.zeros(count)}
        table |= {f"limit_{limit.name}": np.full(count, limit.value) for limit in spec.limits}
        data = {name: ("candidate", values) for name, values in table.items()}
        return xr.Dataset(
            data | {"share": (("candidate", "field"), shares), "status": ("candidate", ["walked"] * count)}
        )

    monkeypatch.setattr(f"{module}.evaluate", evaluated)
    spec, cell = arm_searches(CAIMAN, GAITS["belly_crawl"])[STILL], QUESTION.cells()[0]
    settings = {"population": 8, "cycles": 1, "sigma": 0.2}
    start = spec.run.gait
    little, kept = search_in_cell(spec, cell, start, evaluations=1, **settings)
    much, _ = search_in_cell(spec, cell, start, evaluations=40, **settings)
    assert kept
    assert value_at(little, "stroke") == pytest.approx(value_at(start, "stroke"))
    assert value_at(much, "stroke") > 1.3 * value_at(start, "stroke")
    assert isinstance(much, Gait)
    assert much.period == cell.period


def test_a_thicker_tail_has_more_area_and_mass_and_nothing_else_changes():
    thicker = with_tail_size(CAIMAN, 1.4)
    last = CAIMAN.root_index
    assert thicker.axis[: last + 1] == CAIMAN.axis[: last + 1]
    assert thicker.girdles == CAIMAN.girdles
    masses = [sum(shape.mass for s in robot.axis[last + 1 :] for shape in s.shapes) for robot in (CAIMAN, thicker)]
    assert masses[1] == pytest.approx(1.96 * masses[0])
    compile_model(thicker)
    assert with_tail_size(CAIMAN, 1.0) == CAIMAN


def test_each_robot_as_built_walks_on_a_field_of_its_own_in_both_arms():
    bumpy = next(cell for cell in QUESTION.cells() if cell.axis == "roughness")
    run = Run(robot=CAIMAN, gait=GAITS["belly_crawl"], ground=bumpy.ground)
    seeds = [one.ground.relief.seed for one in on_fields_of_their_own([run] * 6, 3)]
    assert seeds == [0, 1, 2, 0, 1, 2]
    flat = [replace(run, ground=QUESTION.cells()[0].ground)]
    assert on_fields_of_their_own(flat, 1) == flat


def test_the_map_shows_each_difference_with_its_sign():
    outcome = QUESTION.quick()
    figure = outcome.draw(type("Outcome", (), {"record": record()}))["spine_and_tail_map"]
    assert len(figure.axes) == len(QUANTITIES)
    assert [text.get_text() for text in figure.axes[0].get_yticklabels()] == ["base", "friction x 0.5"]


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"frictions": (0.0,)}, "frictions is"),
        ({"strengths": (2e6, 2e6)}, "and once"),
        ({"slopes": (2.0,)}, "each value must be from -1 to 1 rad"),
        ({"repeats": 0}, "repeats"),
    ],
)
def test_settings_that_cannot_be_are_refused(settings, words):
    with pytest.raises(InvalidDesign, match=words):
        replace(QUESTION, **settings)


def test_a_short_run_says_that_it_is_too_short():
    assert QUESTION.quick().too_short().startswith("Too short to answer: repeats is 2, and 6 at least are needed.")
    assert QUESTION.too_short() == ""


@pytest.mark.parametrize("name", ["strider", "pleurobot", "salamander", "long_tail"])
def test_another_body_searches_in_its_own_size(name):
    """Without a tail no condition changes it; bumps grow with the body, grains are the same ones."""
    robot = ROBOTS[name]
    question = QUESTION.for_robot(robot)
    cells = question.cells()
    has_tail = robot.root_index < len(robot.axis) - 1
    assert question.has_tail is has_tail
    assert ("tail" in {cell.axis for cell in cells}) is has_tail
    assert question.strengths == QUESTION.strengths
    if name in ("strider", "salamander"):
        ratio = robot.length / CAIMAN.length
        assert question.bump_heights == pytest.approx([ratio * height for height in QUESTION.bump_heights])
    searches = arm_searches(robot, question.gait)
    bends = {vary.field for vary in searches[FREE].vary} - {vary.field for vary in searches[STILL].vary}
    assert "gait.trunk_bend" in bends
    shares = dict.fromkeys((vary.field for vary in searches[STILL].vary), 0.5)
    assert value_at(searches[STILL].candidate(shares).gait, "trunk_bend") == 0.0


def test_a_body_without_a_tail_is_told_of_its_trunk():
    question = replace(QUESTION.for_robot(ROBOTS["strider"]).quick(), repeats=6)
    text = question.explain({name: one.value for name, one in question.measure(record()).items()})
    assert "a bending trunk takes the robot farther in 2 of 2" in text
    assert "tail" not in text


@pytest.mark.parametrize(("name", "lack"), [("swimmer", "limbs"), ("salamandra", "limbs of several hinges")])
def test_bodies_that_cannot_be_compared_are_refused(name, lack):
    with pytest.raises(UnsuitedRobot, match=lack):
        QUESTION.for_robot(ROBOTS[name])

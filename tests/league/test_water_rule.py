"""The water of every swimmer is that of one rule: shares of a table, drag between two sections, friction by layers."""

import json
from dataclasses import replace
from math import pi

import pytest
from tests.league.toys import stone

from evidence import store
from evidence.league import Predictor, find
from evidence.league.cases import CONTESTANTS, _water
from evidence.league.cases._water import (
    BLOCK_HEAD,
    MAX_SWIMMING_FRICTION,
    KnownSwim,
    base_drag,
    drag_across,
    form_of,
    fresh,
    share_of,
    shed_shares,
    turbulence_ratio,
)
from evidence.league.page import all_standings, page, standing_of, standing_text
from evidence.league.sealing import sealed_prediction
from evidence.league.spans import SPANS, read_spans, spans_of
from evidence.league.swims import ModelSwimmer, _shed
from suchus.robot.design import BodyForm
from suchus.robot.design.drawing import Drawing
from suchus.robot.motion.swim import swimming_gait
from suchus.swimming.water import Outline, Water, cycle, reactive

SWIMMERS = ("filmed_lamprey", "lamprey_20", "american_eel", "prickleback", "salamander", "amphibot", "tunabot",
            "catshark_2")  # fmt: skip
ROWS = [
    {"end": "pointed", "aspect": aspect, "kc": kc, "share": share, "low": share - 0.1, "high": share + 0.2}
    for aspect, kc, share in ((1.0, 4.0, 0.4), (2.0, 4.0, 0.6), (1.0, 0.0, 0.5), (4.0, 0.0, 0.9), (1.0, 1.0, 0.0))
]


def swim_of_rod(half_height=0.04, half_width=0.02, **changes):
    robot = Drawing(
        name="rod", length=0.5, mass=pi * half_width * half_height * 0.125 * 1000.0, stations=(0.0, 1.0),
        half_width=2 * (half_width,), half_height=2 * (half_height,), joints=(0.4, 0.6, 0.8), density=1000.0,
    ).robot()  # fmt: skip
    gait = swimming_gait(robot, name="wave", frequency=2.0, amplitude=(0.3, 0.4, 0.4), lag=(0.0, 0.2, 0.4))
    return KnownSwim(robot=robot, gait=gait, wavelength=1.0, **changes)


@pytest.mark.parametrize("name", SWIMMERS)
def test_every_swimmer_has_its_water_by_the_rule(name):
    inputs = find(CONTESTANTS, name).inputs
    assert {"cross_drag", "thickening", "head", "base", "edge", "taper", "added_mass"} <= set(inputs)
    assert "shedding" not in inputs
    assert ("limbs" in inputs) == (name == "salamander")
    assert inputs["head"].high == (0.8 if name == "amphibot" else 0.2)
    assert 0.0 <= inputs["taper"].low < inputs["taper"].value < inputs["taper"].high < 1.05
    assert inputs["thickening"].low == 1.0
    assert inputs["thickening"].high >= MAX_SWIMMING_FRICTION


def test_a_share_is_between_the_nodes_and_its_interval_holds_all_rows_that_count():
    middle = share_of(ROWS, "pointed", (2.0, 2.0))
    assert middle == pytest.approx(((0.6 + 0.7) / 2, 0.5, 0.9))
    thick = share_of(ROWS, "pointed", (0.5, 0.5))
    assert thick == pytest.approx((0.45, 0.3, 0.7))
    assert share_of(ROWS, "pointed", (8.0, 8.0)) == pytest.approx((0.75, 0.5, 1.1))
    both = share_of(ROWS, "pointed", (1.0, 4.0))
    assert both == pytest.approx(((0.4 + 0.6 + 0.5 + 0.9) / 4, 0.3, 1.1))


def test_a_blunt_end_sheds_as_a_square_one_and_what_falls_on_in_part_as_a_pointed_one():
    rows = store.load("shedding").values["rows"]
    blunt, taper = shed_shares(swim_of_rod(), rows)
    square = share_of(rows, "square", (2.0, 2.0))
    assert blunt.value == pytest.approx(square.value, abs=0.04)
    lamprey, less = find(CONTESTANTS, "filmed_lamprey").inputs["edge"], find(CONTESTANTS, "filmed_lamprey").inputs
    assert less["taper"].value < lamprey.value < square.high
    assert taper.value < blunt.value


def test_drag_across_is_between_a_steady_and_an_oscillating_section():
    plain = drag_across(swim_of_rod())
    assert plain.low <= 0.9 * 1.6 * 1.001
    assert plain.low < plain.value < plain.high
    small, large = (drag_across(swim_of_rod(swing=swing)) for swing in (0.15, 0.6))
    assert small.low == pytest.approx(large.low)
    assert abs(small.high / large.high - 1.0) > 0.03
    thick = drag_across(swim_of_rod(viscosity=2e-4))
    assert thick.high > 1.05 * plain.high
    round_ = drag_across(swim_of_rod(half_width=0.04))
    assert round_.low <= 0.9 * 1.3 < plain.low


@pytest.mark.parametrize(("viscosity", "turbulent"), [(1e-4, False), (1e-6, True)])
def test_friction_reaches_to_a_turbulent_layer_where_that_rubs_more(viscosity, turbulent):
    swim = swim_of_rod(viscosity=viscosity)
    ratio = turbulence_ratio(swim)
    assert (ratio > MAX_SWIMMING_FRICTION) == turbulent
    assert turbulent or ratio == 1.0
    numbers = fresh(swim)
    assert numbers["thickening"].high == pytest.approx(max(MAX_SWIMMING_FRICTION, ratio))
    assert numbers["thickening"].value == pytest.approx(numbers["thickening"].high ** 0.5)
    fastest = replace(swim, wavelength=50.0)
    assert turbulence_ratio(fastest) == pytest.approx(turbulence_ratio(replace(swim, wavelength=20.0))) or not turbulent


def test_the_form_is_made_of_the_numbers():
    swim = swim_of_rod(head=BLOCK_HEAD)
    numbers = {name: one.value for name, one in fresh(swim).items()}
    form = form_of(numbers)
    assert form.head_drag == BLOCK_HEAD[0]
    assert form.base_drag == base_drag(swim).value > 0.0
    assert (form.edge_shedding, form.taper_shedding) == (numbers["edge"], numbers["taper"])
    assert form.limb_drag == 0.0
    assert form_of(numbers | {"limbs": 0.5}).limb_drag == 0.5


def test_reactive_theory_sheds_the_momentum_that_it_is_told():
    swim = swim_of_rod()
    outline = Outline(swim.robot, 65)
    curve, water = cycle(outline, swim.gait), Water()
    whole = reactive(outline, curve, 0.1, water)
    section = pi * float(outline.silhouette.half_height[-1]) ** 2
    assert _shed(reactive, section, outline, curve, 0.1, water) == pytest.approx(whole)
    half = _shed(reactive, 0.5 * section, outline, curve, 0.1, water)
    assert half.power == pytest.approx(0.5 * whole.power)
    assert half.thrust < whole.thrust
    assert ModelSwimmer(robot=swim.robot, gait=swim.gait).form == BodyForm()


def test_spans_are_the_answers_at_both_ends_of_each_number_the_farthest_first(tmp_path):
    def fall(choices, progress):
        return [{"speed": (4.0 * one["height"] + one.get("wind", 0.0),)} for one in choices]

    plain = stone(rungs={"formula": Predictor(words="", work=fall, draws=4)})
    wind = replace(plain.inputs["height"], value=1.0, low=0.0, high=1.2)
    one = replace(plain, inputs={"wind": wind, **plain.inputs}, predicts={"speed": plain.predicts["speed"]})
    found = spans_of(one, "formula")
    assert list(found) == ["height", "wind"]
    assert found["height"] == pytest.approx(((4.0 * one.inputs["height"].low + 1.0) / 5.0,
                                             (4.0 * one.inputs["height"].high + 1.0) / 5.0))  # fmt: skip
    sealed_prediction(one, tmp_path)
    assert read_spans(tmp_path / one.name) == {}
    (bare,) = all_standings(tmp_path, [one], {one.name: tmp_path / "none"})
    assert "What makes the intervals wide" not in page([bare], "x")
    (tmp_path / one.name / SPANS).write_text(json.dumps(found))
    (entry,) = all_standings(tmp_path, [one], {one.name: tmp_path / "none"})
    assert entry.spans == {name: pytest.approx(ends) for name, ends in found.items()}
    assert "| stone | speed at the ground | height, 0." in page([entry], "x")
    assert standing_of(json.loads(standing_text([entry]))[0]) == entry


def test_the_rule_reads_the_kept_table():
    assert {row["kc"] for row in store.load("shedding").values["rows"]} >= set(_water._SHED_KC)

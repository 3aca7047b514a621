"""What holds for every gait on the shelf."""

import re
from dataclasses import replace

import numpy as np
import pytest

import suchus
from body_files import giant, hatchling, imported_quadruped
from suchus.article.paper import CYCLE_PERIOD
from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot.design import layout, value_at, with_values
from suchus.robot.design.reasons import numbers
from suchus.robot.design.scale import control_period, rescale
from suchus.robot.gaits import DRAFTED, GAITS, default_gait, in_size
from suchus.robot.gaits.belly_crawl import LIMBS
from suchus.robot.motion import check_limits, cycle_targets, limb_reaches, suits
from suchus.robot.robots import ROBOTS
from suchus.sim.metrics import displacement


def robot_of(name):
    """Return a robot of the shelf that a gait was made for, or the first that can follow it."""
    made_for = GAITS.beside(name, "made_for", ())
    return ROBOTS[made_for[0]] if made_for else next(r for r in ROBOTS.values() if suits(r, GAITS[name]))


@pytest.fixture(params=list(GAITS))
def shelved(request):
    return GAITS[request.param]


def test_it_is_called_by_its_file_name(shelved):
    assert GAITS[shelved.name] is shelved


def test_its_robot_follows_it_and_it_repeats_after_one_cycle(shelved):
    robot, clock = robot_of(shelved.name), np.arange(64) / 64
    check_limits(robot, shelved)
    cranks = [name.endswith("crank") for name in layout(robot).servos]
    turned = cycle_targets(robot, shelved, clock + 1.0) - cycle_targets(robot, shelved, clock)
    assert turned == pytest.approx(np.where(cranks, -2 * np.pi, 0.0) + np.zeros_like(turned), abs=1e-9)


def test_it_is_made_for_robots_of_the_shelf(shelved):
    assert {*GAITS.beside(shelved.name, "made_for", ())} <= set(ROBOTS)


def test_the_metres_of_the_crawls_are_for_the_legs_of_the_article_s_robot():
    assert limb_reaches(ROBOTS["caiman"]) == LIMBS


def _published(gait):
    """Patterns of the paths of what was published: the article's period and diagonal gait, and what files name."""
    found = [*GAITS.beside(gait.name, "PUBLISHED", ())] if gait.name in GAITS else []
    if gait.period == CYCLE_PERIOD:
        found.append(r"^period$")
    if gait.limb_phases == (0.0, 0.5, 0.5, 0.0) and "caiman" in robot_of(gait.name).name:
        found.append(r"^limb_phases")
    return [*found, r"^coupling", r"^limbs\[\d\]\.swivel"]  # the article's law, and the posture that it shows


def _without_a_reason(gait, chosen):
    """Return the paths of numbers that no chosen row changes, fields and named numbers alike."""
    open_ = {path for path, _ in numbers(gait) if not any(re.search(p, path) for p in _published(gait))}
    for row in chosen:
        other = with_values(gait, {row.field: value_at(gait, row.field) * 0.9 + 0.01})
        open_ -= {path for path in open_ if value_at(other, path) != value_at(gait, path)}
    return open_


def test_every_number_that_was_not_published_has_a_range_and_a_reason(shelved):
    chosen = GAITS.beside(shelved.name, "chosen", ())
    assert _without_a_reason(shelved, chosen) == set()
    assert all(len(row.why) > 10 for row in chosen)
    assert len({row.field for row in chosen}) == len(chosen)


@pytest.mark.parametrize("name", ["belly_crawl", "high_walk", "semi_erect", "low_crawl", "salamander_walk", "tripod"])
def test_a_number_lies_in_its_range(name):
    for row in GAITS.beside(name, "chosen", ()):
        assert row.low - 1e-12 <= value_at(GAITS[name], row.field) <= row.high + 1e-12, row.field


def test_a_number_without_a_reason_is_found():
    gait, chosen = GAITS["high_walk"], GAITS.beside("high_walk", "chosen", ())
    moved = 0
    for left_out in chosen:
        lacking = _without_a_reason(gait, [row for row in chosen if row is not left_out])
        assert (lacking == set()) == (
            value_at(gait, left_out.field) == 0.0 or left_out.field in ("axis_lag", "tail_lag")
        )
        moved += bool(lacking)
    assert moved > 10
    crawl = GAITS["belly_crawl"]
    faster = replace(crawl, period=3.0, limb_phases=(0.0, 0.5, 0.45, -0.05))
    assert _without_a_reason(faster, GAITS.beside("belly_crawl", "chosen", ())) == {
        "period", *(f"limb_phases[{i}]" for i in range(1, 4)),
    }  # fmt: skip


def test_a_body_of_another_size_takes_the_gait_in_the_time_that_gravity_needs_for_it():
    caiman = ROBOTS["caiman"]
    for body in (hatchling(), giant()):
        period, step = CYCLE_PERIOD * (body.length / caiman.length) ** 0.5, control_period(body)
        own = default_gait(body)
        assert own == replace(GAITS["belly_crawl"], period=own.period)
        assert abs(own.period - period) <= step / 2
        assert own.period / step == pytest.approx(round(own.period / step), abs=1e-9)
    nearly = rescale(caiman, length_factor=1.4)
    assert default_gait(nearly) is GAITS["belly_crawl"]  # a variant of a design is compared with it in one gait
    assert in_size(GAITS["high_walk"], caiman, caiman) is GAITS["high_walk"]


def test_a_quarter_of_a_body_walks_alike_at_half_the_period():
    """By dynamic similarity: all of the model scales but what MuJoCo's solver takes as a number."""
    caiman = ROBOTS["caiman"]
    small = rescale(caiman, length_factor=0.25)
    assert control_period(small) == control_period(caiman) / 2
    assert default_gait(small).period == CYCLE_PERIOD / 2
    whole, quarter = (
        float(displacement(suchus.crawl(one, default_gait(one), cycles=1)).sel(xyz="x")) for one in (caiman, small)
    )
    assert whole > 0.1
    assert 4 * quarter == pytest.approx(whole, rel=0.05)


def test_questions_with_several_gaits_ask_all_of_them_in_the_size_of_the_body():
    asked, body = EXPERIMENTS["speed_range"], hatchling()
    gaits = asked.for_robot(body).gaits
    assert [gait.name for gait in gaits] == [gait.name for gait in asked.gaits]
    assert [gait.period / of.period for gait, of in zip(gaits, asked.gaits, strict=True)] == pytest.approx(
        [(body.length / asked.robot.length) ** 0.5] * len(gaits), rel=0.01
    )
    assert [gait.name for gait in asked.for_robot(ROBOTS["strider"]).gaits] == ["tripod"]


def test_limbs_that_turn_about_other_axes_than_those_of_a_gaits_maker_get_a_gait_drafted(tmp_path):
    """They could follow the crocodile's crawl, and would walk backwards in it."""
    body = imported_quadruped(tmp_path)
    assert suits(body, GAITS["belly_crawl"])
    assert default_gait(body).name == DRAFTED
    assert float(displacement(suchus.crawl(body, default_gait(body), cycles=4)).sel(xyz="x")) > 0.1 * body.length

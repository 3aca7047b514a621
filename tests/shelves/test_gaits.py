"""What holds for every gait on the shelf."""

import re
from dataclasses import fields, replace
from importlib import import_module

import numpy as np
import pytest

from suchus.design import layout
from suchus.design.reasons import numbers
from suchus.gaits import GAITS
from suchus.motion import check_limits, pattern_targets, servo_targets
from suchus.paper import CYCLE_PERIOD
from suchus.robots import ROBOTS

MADE_FOR = {
    "animal_walk": "salamander",
    "pleurobot_walk": "pleurobot",
    "salamander_walk": "salamander",
    "salamandra_walk": "salamandra",
    "tripod": "strider",
    "undulation": "swimmer",
}
"""The robots of the gaits that are not for the article's kind."""
PHASES = np.arange(64)[:, None] / 64
LEFT_RIGHT = [3, 4, 5, 0, 1, 2, 9, 10, 11, 6, 7, 8]


@pytest.fixture(params=[name for name in GAITS if name not in MADE_FOR])
def shelved(request):
    return GAITS[request.param]


@pytest.fixture(params=list(MADE_FOR))
def pattern(request):
    return GAITS[request.param], ROBOTS[MADE_FOR[request.param]]


def test_a_pattern_is_named_by_its_file_and_followed_by_its_robot_and_repeats(pattern):
    gait, robot = pattern
    assert GAITS[gait.name] is gait
    check_limits(robot, gait)
    clock = np.arange(64) / 64
    cranks = [name.endswith("crank") for name in layout(robot).servos]
    turned = pattern_targets(robot, gait, clock + 1.0) - pattern_targets(robot, gait, clock)
    assert turned == pytest.approx(np.where(cranks, -2 * np.pi, 0.0) + np.zeros_like(turned), abs=1e-9)


def test_every_number_of_a_pattern_has_a_range_and_a_reason(pattern):
    gait, _ = pattern
    module = import_module(f"suchus.gaits.{gait.name}")
    chosen, published = {entry.field: entry for entry in module.chosen}, getattr(module, "PUBLISHED", ())
    values = {path: one for path, one in numbers(gait) if not any(re.search(pattern, path) for pattern in published)}
    assert set(chosen) == set(values)
    assert all(entry.low <= values[path] <= entry.high for path, entry in chosen.items())


def test_every_robot_of_the_shelf_has_a_gait():
    assert {robot for name in GAITS for robot in GAITS.beside(name, "made_for", ())} == set(ROBOTS)


def test_it_is_called_by_its_file_name(shelved):
    assert GAITS[shelved.name] is shelved


def test_the_robot_can_follow_it(shelved, robot):
    check_limits(robot, shelved)


def test_it_repeats_after_one_cycle(shelved, robot):
    phase = PHASES + np.array(shelved.limb_phases)
    assert servo_targets(robot, shelved, phase) == pytest.approx(servo_targets(robot, shelved, phase + 1), abs=1e-9)


def test_its_mirror_image_mirrors_every_servo(shelved, robot):
    phase = PHASES + np.array(shelved.limb_phases)
    there = servo_targets(robot, shelved, phase)
    back = servo_targets(robot, shelved.mirrored(), PHASES + np.array(shelved.mirrored().limb_phases))
    assert there[:, LEFT_RIGHT] == pytest.approx(back[:, :12], abs=1e-12)
    assert there[:, [12, 14, 16, 18]] == pytest.approx(-back[:, [12, 14, 16, 18]], abs=1e-12)
    assert there[:, 17] == pytest.approx(back[:, 17])


def _numbers(gait):
    """Yield the path and value of every number of a gait."""
    for field in fields(gait):
        value = getattr(gait, field.name)
        if isinstance(value, tuple):
            yield from ((f"{field.name}[{i}]", item) for i, item in enumerate(value))
        elif not isinstance(value, str):
            yield field.name, value


def _of_the_article(gait):
    """The four seconds of section IV.A, and the diagonal gait of II.A, where a gait has them."""
    period = {"period"} if gait.period == CYCLE_PERIOD else set()
    diagonal = (0.0, 0.5, 0.5, 0.0)
    return period | ({f"limb_phases[{i}]" for i in range(4)} if gait.limb_phases == diagonal else set())


def _without_a_reason(gait, chosen):
    return {path for path, _ in _numbers(gait)} - _of_the_article(gait) - {entry.field for entry in chosen}


def test_every_number_not_from_the_article_has_a_range_and_a_reason(shelved):
    chosen = import_module(f"suchus.gaits.{shelved.name}").chosen
    values = dict(_numbers(shelved))
    assert _without_a_reason(shelved, chosen) == set()
    assert {entry.field for entry in chosen} <= set(values) - _of_the_article(shelved)
    assert all(len(entry.why) > 10 for entry in chosen)


def test_a_number_without_a_reason_is_found():
    gait, chosen = GAITS["high_walk"], import_module("suchus.gaits.high_walk").chosen
    for left_out in chosen:
        assert _without_a_reason(gait, [entry for entry in chosen if entry is not left_out]) == {left_out.field}
    crawl = GAITS["belly_crawl"]
    faster = replace(crawl, period=3.0, limb_phases=(0.0, 0.5, 0.45, -0.05))
    assert _without_a_reason(faster, import_module("suchus.gaits.belly_crawl").chosen) == {
        "period", *(f"limb_phases[{i}]" for i in range(4)),
    }  # fmt: skip

"""Numbers, control group, limits and file of a gait in the page are those of Python."""

from contextlib import suppress
from dataclasses import replace

import pytest
from tests.laboratory.page_modules import needs_node, run

from suchus.apps.laboratory.description import gait_facts, robot_facts
from suchus.core.errors import InvalidDesign, SuchusError
from suchus.robot import blueprint
from suchus.robot.gaits import GAITS, control_group, default_gait
from suchus.robot.motion import check_limits
from suchus.robot.motion.gait import NUMBERS
from suchus.robot.robots import ROBOTS

pytestmark = needs_node


def alike(facts, gait):
    """Return whether a gait as node writes it is one of Python, to rounding."""
    expected = gait_facts(gait)

    def same(a, b):
        if isinstance(a, dict):
            return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
        if isinstance(a, list | tuple):
            return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b, strict=True))
        return a == pytest.approx(b, abs=1e-12) if isinstance(a, float | int) else a == b

    return same(facts, expected)


def test_every_number_of_every_gait_is_read_and_changed_as_in_python():
    pairs = [(gait, name) for gait in GAITS.values() for name in gait.numbers()]
    cases = [{"gait": gait_facts(gait), "name": name, "value": 0.9 * gait.number(name) + 0.01} for gait, name in pairs]
    assert {name for _, name in pairs} == {*NUMBERS}
    for (gait, name), case, done in zip(pairs, cases, run("numbers", cases=cases), strict=True):
        assert done["before"] == pytest.approx(gait.number(name), abs=1e-12), (gait.name, name)
        assert alike(done["gait"], gait.with_numbers(**{name: case["value"]})), (gait.name, name)


def test_the_control_group_has_the_same_legs_and_a_still_axis():
    for facts, gait in zip(run("control", gaits=[*map(gait_facts, GAITS.values())]), GAITS.values(), strict=True):
        assert alike(facts, control_group(gait)), gait.name


FACTORS = {
    "stroke": (1.5, 4.0),
    "trunk_bend": (1.3, 3.0),
    "axis_bend": (1.5, 3.0),
    "tail_bend": (1.5, 6.0),
    "height": (0.6, 1.9),
    "tail_pitch": (3.0, 20.0),
}


def changed_gaits():
    for robot in ROBOTS.values():
        gait = default_gait(robot)
        yield robot, gait
        for name in FACTORS.keys() & gait.numbers().keys() if gait.has("steering") else ():
            for factor in FACTORS[name]:
                with suppress(InvalidDesign):  # no gait at all, as a stroke beyond the limb
                    yield robot, gait.with_numbers(**{name: factor * gait.number(name)})


def test_what_the_joints_cannot_follow_is_refused_and_nothing_else():
    pairs = [*changed_gaits()]
    texts = run("limits", cases=[{"robot": robot_facts(robot), "gait": gait_facts(gait)} for robot, gait in pairs])
    refusals = 0
    for (robot, gait), text in zip(pairs, texts, strict=True):
        try:
            check_limits(robot, gait)
            assert text == "", (robot.name, gait)
        except SuchusError as error:
            refusals += 1
            assert text, (robot.name, gait)
            named = [servo for servo in robot_facts(robot)["servos"] if f" {servo} " in f" {error} "]
            assert not named or named[0] in text
    assert 5 < refusals < len(pairs) - 5


def test_the_file_of_a_gait_reads_back_equal(tmp_path):
    for text, gait in zip(run("toml", gaits=[*map(gait_facts, GAITS.values())]), GAITS.values(), strict=True):
        file = tmp_path / f"{gait.name}.toml"
        file.write_text(text)
        assert blueprint.read_gait(file, ROBOTS["caiman"], GAITS) == gait, text


def test_a_name_with_marks_of_its_own_stays_a_name(tmp_path):
    gait = replace(GAITS["belly_crawl"], name='a "quoted" one = 1')
    file = tmp_path / "odd.toml"
    file.write_text(run("toml", gaits=[gait_facts(gait)])[0])
    assert blueprint.read_gait(file, ROBOTS["caiman"], GAITS) == gait


def test_the_sentence_follows_the_run_whichever_way_it_comes_out():
    cases = {
        (0.74, 0.17): "is 0.74 m ahead of its start; the one with its axis still is 0.17 m ahead of its start. "
        "Bending takes it 4.4 times as far.",
        (0.17, 0.34): "Bending takes it 0.50 times as far: here it costs way.",
        (0.25, 0.245): "Bending makes no difference of more than 5 %.",
        (0.30, 0.01): "the one with its axis still has hardly moved. Here the way comes from bending.",
        (0.30, -0.20): "is 0.20 m behind its start. Here the way comes from bending.",
        (-0.30, 0.20): "Here bending the axis costs the way.",
        (0.005, -0.01): "neither robot has moved by more than 1 % of its length",
    }
    said = run("sentence", cases=[[2, list(forward), 1.0, True] for forward in cases])
    for text, expected in zip(said, cases.values(), strict=True):
        assert text.startswith("After 2 cycles ")
        assert expected in text
    assert "both robots move alike" in run("sentence", cases=[[1, [0.3, 0.3], 1.0, False]])[0]


def test_the_sentence_compares_with_the_first_numbers_where_the_axis_cannot_bend():
    same, changed = run("sentence", cases=[[1, [0.3, 0.3], 1.0, False, "first"], [1, [0.3, 0.2], 1.0, True, "first"]])
    assert "Both have the same numbers" in same
    assert "the one with the first numbers is 0.20 m ahead" in changed
    assert "Your numbers take it 1.50 times as far." in changed

"""One kind of robot, of the article's tables, of a file or part by part; what is asked of it is asked of its chain."""

import ast
import pickle
from dataclasses import fields, replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import suchus
from suchus.article import paper
from suchus.core.errors import UnknownName, UnsuitedRobot
from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot import blueprint
from suchus.robot.design import (
    MEASURED,
    NEEDS,
    Robot,
    Servo,
    cable_joints,
    lacking,
    tables_of,
    value_at,
    with_spring,
    with_values,
)
from suchus.robot.design.scale import rescale
from suchus.robot.robots import ROBOTS

CAIMAN, STRIDER = ROBOTS["caiman"], ROBOTS["strider"]
OF_TABLES = [name for name in ROBOTS if ROBOTS[name].tables is not None]
SOURCES = Path(suchus.__file__).parent
KNOW_TABLES = ("robot/design/", "robot/robots/", "robot/blueprint/")
"""Rooms that know the article's tables: where robots are made, read and written."""


def part_by_part(robot: Robot) -> Robot:
    """Return the same robot as one that no tables made."""
    same = replace(robot)
    assert same.tables is None
    return same


@pytest.mark.parametrize("name", list(ROBOTS))
def test_equal_robots_are_one_however_they_were_made(name, tmp_path):
    robot = ROBOTS[name]
    file = tmp_path / f"{name}.toml"
    file.write_text(blueprint.render(part_by_part(robot)))
    for same in (part_by_part(robot), blueprint.read_design(file, Robot, ROBOTS), pickle.loads(pickle.dumps(robot))):
        assert same == robot
        assert hash(same) == hash(robot)
        assert tables_of(same) == robot.tables
    assert replace(robot, name="other") != robot


@pytest.mark.parametrize("name", OF_TABLES)
def test_every_experiment_and_every_need_takes_either_form(name):
    robot, same = ROBOTS[name], part_by_part(ROBOTS[name])
    assert lacking(robot, tuple(NEEDS)) == lacking(same, tuple(NEEDS)) == ["salamander_joints"]
    for experiment in EXPERIMENTS.values():
        assert lacking(robot, experiment.needs) == lacking(same, experiment.needs)


@settings(max_examples=20, deadline=None)
@given(joints=st.integers(1, 12), segments=st.integers(1, 6), share=st.floats(0.5, 2.0))
def test_what_closed_forms_read_of_the_chain_is_what_the_tables_say(joints, segments, share):
    values = {"tail.joints": joints, "tail.fin_segments": segments}
    values |= {path: share * value_at(CAIMAN, path) for path in ("tail.mass", "tail.radius_root", "head.mass")}
    robot = with_values(CAIMAN, values)
    for part in ("hind_leg", "front_leg", "spine", "tail", "pelvis", "thorax", "head"):
        table, measures = getattr(robot.tables, part), getattr(robot, part)
        names = {field.name for field in fields(table)} & set(measures._fields)
        assert len(names) >= 3
        for field in names | {"length"} & {*dir(table)} & {*dir(measures)}:
            said, read = getattr(table, field), getattr(measures, field)
            assert read == (said if isinstance(said, Servo) else pytest.approx(said, rel=1e-12)), (part, field)


def test_the_caimans_published_numbers_are_the_printed_ones():
    leg, spine = CAIMAN.hind_leg, CAIMAN.spine
    assert (leg.hip_offset, leg.femur, leg.tibia) == (paper.LEG_CHAIN.a[0], paper.FEMUR, paper.TIBIA)
    assert (spine.base, spine.link, CAIMAN.tail.joints) == (*paper.SPINE_CHAIN.a[:2], paper.TAIL_JOINTS)


@pytest.mark.parametrize("part", ["hind_leg", "spine", "tail", "pelvis", "thorax", "head"])
def test_who_has_no_such_part_is_told_so(part):
    with pytest.raises(UnsuitedRobot, match=r"^robot 'swimmer' lacks .*: choose another robot\.$"):
        getattr(ROBOTS["swimmer"], part)


def test_legs_of_other_bodies_are_legs_too():
    assert STRIDER.hind_leg.reach == pytest.approx((0.02, 0.18))
    assert {"shells", "spine", "tail"} <= set(lacking(STRIDER, MEASURED))


def test_a_robot_of_another_size_is_measured_as_the_chain_it_still_is():
    small = rescale(CAIMAN, length_factor=0.3)
    assert small.tables is None
    assert not lacking(small, MEASURED)
    assert small.spine.link == pytest.approx(0.3 * CAIMAN.spine.link)
    assert small.tail.length == pytest.approx(0.3 * CAIMAN.tail.length)


def test_tables_change_in_either_form_and_what_follows_from_them_follows():
    longer = with_values(part_by_part(CAIMAN), {"spine.link": 0.07})
    assert longer == with_values(CAIMAN, {"spine.link": 0.07})
    assert longer.length == pytest.approx(CAIMAN.length + 4 * (0.07 - CAIMAN.spine.link))
    bent = replace(
        CAIMAN, axis=tuple(replace(one, front=one.front + 0.01 * (i == 1)) for i, one in enumerate(CAIMAN.axis))
    )
    for robot in (STRIDER, bent):
        assert tables_of(robot) is None
        with pytest.raises(UnknownName, match="no field named 'spine'"):
            with_values(robot, {"spine.link": 0.07})


def test_springs_under_a_cable_are_those_of_the_tables():
    assert with_spring(CAIMAN, cable_joints(CAIMAN), 0.9) == with_values(CAIMAN, {"tail.joint_stiffness": 0.9})
    assert with_spring(CAIMAN, ("LF_yaw",), 0.9) == CAIMAN
    assert len(CAIMAN.tail.passive) == 2 * CAIMAN.tail.fin_segments


def _annotations(tree: ast.Module) -> list[str]:
    """Return every annotation of an argument, a result or a field, as it is written."""
    notes: list[ast.expr | None] = []
    for node in ast.walk(tree):
        if isinstance(node, ast.arg | ast.AnnAssign):
            notes.append(node.annotation)
        if isinstance(node, ast.FunctionDef):
            notes.append(node.returns)
    return [ast.unparse(note) for note in notes if note is not None]


def test_nothing_that_simulates_draws_or_measures_takes_tables():
    for file in SOURCES.rglob("*.py"):
        takes = [
            note for note in _annotations(ast.parse(file.read_text())) if "Tables" in note.replace("'", " ").split()
        ]
        assert file.relative_to(SOURCES).as_posix().startswith(KNOW_TABLES) or not takes, file

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.core.errors import InvalidDesign, UnreadableFile
from suchus.robot.blueprint import MistakenFile, read_design, render, write
from suchus.robot.design import Robot, crocodile
from suchus.robot.gaits import GAITS
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS

CAIMAN = ROBOTS["caiman"]


@pytest.fixture
def said(tmp_path):
    """Write a file and return the mistakes that reading it names."""

    def mistakes(text, kind=Robot, shelf=ROBOTS):
        file = tmp_path / "mine.toml"
        file.write_text(text)
        with pytest.raises(MistakenFile) as error:
            read_design(file, kind, shelf)
        assert all(place in str(error.value) for place in error.value.mistakes)
        return error.value.mistakes

    return mistakes


@pytest.mark.parametrize("name", ROBOTS)
def test_every_robot_reads_back_equal(name, tmp_path):
    assert read_design(write(ROBOTS[name], tmp_path / "x.toml"), Robot, ROBOTS) == ROBOTS[name]


@pytest.mark.parametrize("name", GAITS)
def test_every_gait_reads_back_equal(name, tmp_path):
    assert read_design(write(GAITS[name], tmp_path / "x.toml"), Gait, GAITS) == GAITS[name]


def test_a_body_of_its_own_can_start_from_the_shelf_and_its_mistakes_are_named(tmp_path):
    file = tmp_path / "slippery.toml"
    file.write_text('base = "strider"\n[contact]\nfoot_friction = 0.2\n')
    robot = read_design(file, Robot, ROBOTS)
    assert (robot.name, robot.contact.foot_friction, robot.axis) == ("slippery", 0.2, ROBOTS["strider"].axis)
    file.write_text('base = "strider"\nrot = "x"\n[contact]\nfoot_friction = 99\n')
    with pytest.raises(MistakenFile, match=r"2 mistakes.*foot_friction is 99; 0.01 to 3 is allowed.*did you mean root"):
        read_design(file, Robot, ROBOTS)


@given(
    name=st.text(st.characters(exclude_categories=["Cs", "Cc", "Cf", "Zl", "Zp"]), max_size=30),
    femur=st.floats(0.08, 0.4),
    joints=st.integers(1, 30),
)
def test_any_robot_reads_back_equal(name, femur, joints, tmp_path_factory):
    robot = crocodile(
        replace(
            CAIMAN.tables,
            name=name,
            hind_leg=replace(CAIMAN.tables.hind_leg, femur=femur),
            tail=replace(CAIMAN.tables.tail, joints=joints),
        )
    )
    file = tmp_path_factory.mktemp("any") / "x.toml"
    assert read_design(write(robot, file), Robot, ROBOTS) == robot


def test_a_base_lends_what_the_file_does_not_say(tmp_path):
    file = tmp_path / "long_legs.toml"
    file.write_text('base = "caiman"\n[hind_leg]\nfemur = 0.12\n[hind_leg.servo]\nkp = 60\n')
    robot = read_design(file, Robot, ROBOTS)
    servo = replace(CAIMAN.hind_leg.servo, kp=60.0)
    assert robot == crocodile(
        replace(CAIMAN.tables, name="long_legs", hind_leg=replace(CAIMAN.tables.hind_leg, femur=0.12, servo=servo))
    )


def test_every_mistake_is_named_at_once_with_its_place(said):
    mistakes = said(
        'base = "caiman"\n'
        "[hind_leg]\nfemur = -0.1\ntibia = 90\nyaw_range = [1, 0]\nfemurr = 1\n"
        "[front_leg.servo]\nkp = nan\n"
        "[spine]\nyaw_range = [1, 2, 3]\nyaw_servo = 3\n"
        "[tail]\njoints = 2.5\n"
        '[head]\nmass = "heavy"\nsnout = 50\n'
        "[trunk]\nmass = 1\n"
    )
    assert mistakes == {
        "hind_leg.femur": "is -0.1 m; 0.0001 to 10 m is allowed",
        "hind_leg.tibia": "is 90 m; 0.0001 to 10 m is allowed",
        "hind_leg.yaw_range": "is (1.0, 0.0) rad; an increasing pair within -3.1416 to 3.1416 rad is allowed",
        "hind_leg.femurr": "is not known (did you mean hind_leg.femur?)",
        "front_leg.servo.kp": "is nan N m/rad; 1e-09 to 1e+07 N m/rad is allowed",
        "spine.yaw_range": "is [1, 2, 3]; 2 values are needed",
        "spine.yaw_servo": "is 3; a table is needed",
        "tail.joints": "is 2.5; a whole number is needed",
        "head.mass": "is 'heavy'; a number is needed",
        "head.snout": "is 50 m; 0.0001 to 20 m is allowed",
        "trunk": "is not known; there is name, hind_leg, front_leg, pelvis, spine, thorax, head, tail, contact, hull",
    }


def test_a_file_without_base_hears_what_is_missing(said):
    mistakes = said("[head]\nmass = 1\n")
    assert mistakes["tail"] == mistakes["head.snout"] == "is missing"
    assert "head.mass" not in mistakes
    assert "name" not in mistakes


def test_a_field_in_the_wrong_part_hears_where_it_stands(said):
    mistakes = said('base = "caiman"\nfemur = 0.1\n[tail]\nfoot_friction = 0.5\n[contact]\nmass = 1.0\n')
    assert mistakes == {
        "femur": "is not known there; it stands at hind_leg.femur and front_leg.femur: move it",
        "tail.foot_friction": "is not known there; it stands at contact.foot_friction: move it",
        "contact.mass": "is not known; there is foot_friction, skin_friction, time_constant, torsion, rolling, depth",
    }  # many parts have a mass


def test_mistakes_of_a_gait_are_named_at_once(said):
    mistakes = said('base = "belly_crawl"\nduty_factor = 1\nperiod = -1\nlimb_phases = [0, 3, 0, 0]\n', Gait, GAITS)
    assert mistakes.keys() == {"duty_factor", "period", "limb_phases[1]"}
    assert all("allowed" in text for text in mistakes.values())


def test_parts_that_do_not_fit_each_other_are_a_mistake(said):
    (text,) = said('base = "caiman"\n[head]\nsnout = 0.03\n').values()
    assert "the snout must lie ahead of the shoulders" in text


def test_mending_one_mistake_invents_no_other(said):
    """The spare value put in for a wrong shoulder must not be held against a right snout."""
    assert said('base = "caiman"\n[head]\nsnout = 0.04\n[thorax]\nshoulder = -1\n').keys() == {"thorax.shoulder"}


def test_an_unknown_base_is_named_with_the_rest(said):
    mistakes = said('base = "kaiman"\n[hind_leg]\nfemur = -0.1\n')
    assert mistakes["base"].startswith("is 'kaiman'; there is caiman")
    assert "hind_leg.femur" in mistakes


@pytest.mark.parametrize(
    ("content", "said"),
    [(None, "there is no file"), (b"femur = ", "not valid TOML"), (b"\xff\xfe", "not a text file")],
)
def test_what_cannot_be_read_is_one_sentence(content, said, tmp_path):
    file = tmp_path / "x.toml"
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(UnreadableFile, match=said):
        read_design(file, Robot, ROBOTS)
    with pytest.raises(UnreadableFile, match="is a folder"):
        read_design(tmp_path, Robot, ROBOTS)


def test_a_part_names_all_its_impossible_fields_when_built_in_python():
    with pytest.raises(InvalidDesign) as error:
        replace(CAIMAN.tables.hind_leg, femur=-1.0, mass=float("nan"), knee_range=(2.0, 1.0))
    for field in ("leg.femur", "leg.mass", "leg.knee_range"):
        assert field in str(error.value)


def test_written_files_tell_what_each_number_means():
    assert "femur = 0.086  # Length from hip to knee, the table's a2 [m]." in render(CAIMAN)

"""The front and the sides of an imported robot follow the names of its file, then its shape, and both are said."""

from pathlib import Path

import pytest

from suchus.core.errors import UnreadableFile
from suchus.sim.model.importing import Words, import_robot
from suchus.sim.model.importing.names import direction_of

FILES = Path(__file__).parent.parent / "data" / "imports"
WALKER = (FILES / "walker.urdf").read_text()
LEGS = ("front_left", "front_right", "hind_left", "hind_right")


def read(text, tmp_path, **words):
    file = tmp_path / "it.urdf"
    file.write_text(text)
    return import_robot(file, name="it", words=Words(**words))


def renamed(names, text=WALKER):
    """Return the walker with other names of its four legs."""
    for leg, name in zip(LEGS, names, strict=True):
        text = text.replace(f"{leg}_", f"{name}_")
    return text


def told(draft):
    return " ".join(draft.remarks)


def front_limb(draft):
    """Return the file's name of the left front limb's first hinge."""
    return next(match.file_hinge for match in draft.matches if match.hinge == "LF_yaw")


@pytest.mark.parametrize(
    ("name", "end", "side"),
    [
        ("front_left_coxa", 1, 1), ("hind_right_lift", -1, -1), ("FL_hip", 1, 1), ("FR_thigh", 1, -1),
        ("RL_calf", -1, 1), ("RR_foot", -1, -1), ("LF_HAA", 1, 1), ("RH_KFE", -1, -1), ("LH_shank", -1, 1),
        ("rf_coxa", 1, -1), ("j_c1_lf", 1, 1), ("j_c1_lm", 0, 1), ("j_tibia_rr", -1, -1), ("frontLeftHip", 1, 1),
        ("RightBackKnee", -1, -1), ("hindleft_knee", -1, 1), ("LFThigh", 1, 1), ("fl1", 1, 1), ("f_r_hip", 1, -1),
        ("right_back_leg", -1, -1), ("RL_shoulder", -1, 1), ("rear_shoulder", -1, 0), ("hip_l", 0, 1),
        ("R3_tibia", 0, -1), ("hl.hx", -1, 1), ("head", 1, 0), ("tail_yaw_1", -1, 0), ("fin_left", 0, 1),
        ("forearm_l", 1, 1), ("backbone", 0, 0), ("surface", 0, 0), ("upright", 0, 0), ("rotor_1", 0, 0),
        ("link_b", 0, 0), ("j_thigh", 0, 0),
    ],
)  # fmt: skip
def test_names_say_end_and_side(name, end, side):
    direction = direction_of(name)
    assert (direction.end, direction.side) == (end, side)


@pytest.mark.parametrize(
    "names",
    [
        LEGS, ("FL", "FR", "RL", "RR"), ("LF", "RF", "LH", "RH"), ("j_c1_lf", "j_c1_rf", "j_c1_lr", "j_c1_rr"),
        ("leftFront", "rightFront", "leftBack", "rightBack"), ("l_1", "r_1", "l_2", "r_2"),
    ],
    ids=lambda names: names[0],
)  # fmt: skip
@pytest.mark.parametrize("long_side", [0.34, 0.1], ids=["long", "short"])
def test_a_sprawling_walker_of_any_trunk_goes_where_its_names_say(names, long_side, tmp_path):
    text = renamed(names).replace('size="0.34 0.12 0.05"', f'size="{long_side} 0.12 0.05"')
    text = text.replace('"0.14 ', f'"{0.41 * long_side} ').replace('"-0.14 ', f'"{-0.41 * long_side} ')
    draft = read(text, tmp_path)
    assert front_limb(draft) == f"{names[0]}_yaw"
    assert [[hinge.turn for hinge in girdle.limb.hinges] for girdle in draft.robot.girdles] == [
        ["yaw", "pitch", "pitch"]
    ] * 2
    assert draft.robot.length == pytest.approx(long_side)
    assert "Front: along the file's x axis, as names" in told(draft)
    if long_side < 0.12:
        assert "by shape alone the front would be at 90 or 270 degrees; the names were followed" in told(draft)
    else:
        assert "disagree" not in told(draft)


def test_a_walker_without_speaking_names_goes_along_its_longer_side_and_the_other_is_named(tmp_path):
    draft = read(renamed(("p", "q", "s", "t")), tmp_path)
    assert draft.robot.length == pytest.approx(0.34)
    assert front_limb(draft) == "p_yaw"
    assert "Guess: the front is along the file's x axis" in told(draft)
    square = renamed(("p", "q", "s", "t")).replace('"0.14 ', '"0.09 ').replace('"-0.14 ', '"-0.09 ')
    text = square.replace('size="0.34 0.12 0.05"', 'size="0.2 0.12 0.05"')
    assert "mirror as well about another plane; if that is the right one, --heading 90 or 270" in told(
        read(text, tmp_path)
    )


def test_names_turn_a_robot_round_where_its_front_is_behind(tmp_path):
    draft = read(renamed(("RR", "RL", "FR", "FL")), tmp_path)
    assert "Front: against the file's x axis, as names" in told(draft)
    assert front_limb(draft) == "FL_yaw"


def test_names_of_a_front_and_a_left_that_contradict_each_other_are_said(tmp_path):
    draft = read(renamed(("FR", "FL", "RR", "RL")), tmp_path)
    assert "what they call left lies to the right of what they call front" in told(draft)
    assert "--heading 180" in told(draft)
    assert front_limb(draft) == "FR_yaw"  # the front is followed; sides are by place
    assert "disagree" not in told(read(renamed(LEGS), tmp_path))


def test_a_front_by_names_that_no_plane_mirrors_is_said_with_both(tmp_path):
    names = ("FR", "RR", "FL", "RL")  # forward is along y
    across = read(renamed(names), tmp_path)
    assert "by shape alone the front would be at 0 or 180 degrees; the names were followed" in told(across)
    assert front_limb(across) == "FL_yaw"
    narrow_behind = WALKER.replace('"-0.14 0.07 0"', '"-0.14 0.03 0"').replace('"-0.14 -0.07 0"', '"-0.14 -0.03 0"')
    along = read(renamed(names, narrow_behind), tmp_path)
    assert "by names the front is at 90 degrees to the left, where no plane mirrors" in told(along)
    assert "the shape says 0" in told(along)
    assert "Names disagree" not in told(along)


def test_an_option_decides_over_names_and_shape(tmp_path):
    assert read(WALKER, tmp_path, heading=90.0).robot.length == pytest.approx(0.14, abs=1e-6)
    assert "disagree" not in told(read(WALKER, tmp_path, front="hind_left_coxa"))
    with pytest.raises(UnreadableFile, match="no vertical plane"):
        read(WALKER, tmp_path, heading=30.0)


def test_fins_are_left_out_by_name_and_by_what_they_cannot_carry(tmp_path):
    minnow = (FILES / "minnow.xml").read_text()
    draft = read(minnow, tmp_path)
    assert draft.robot.girdles == ()
    assert [hinge.turn for hinge in draft.robot.axis_hinges] == ["yaw"]
    assert "fin_left and fin_right are fins, wings or the like by name, and were left out" in told(draft)
    unnamed = read(minnow.replace("fin_", "part_"), tmp_path)
    assert unnamed.robot.girdles == ()
    assert unnamed.robot.mass == pytest.approx(draft.robot.mass)
    assert "the belly hangs 0.04 m below it, so they cannot carry it: they are arms or fins" in told(unnamed)
    long_fins = minnow.replace('name="fin_', 'name="leg_').replace('joint="fin_', 'joint="leg_')
    long_fins = long_fins.replace('pos="0 .012 -.01" size=".01 .014 .004"', 'pos="0 .03 -.06" size=".01 .01 .06"')
    legs = read(long_fins.replace('pos="0 -.012 -.01" size=".01 .014 .004"', 'pos="0 -.03 -.06" size=".01 .01 .06"'),
                tmp_path)  # fmt: skip
    assert len(legs.robot.girdles) == 1


def test_a_trunk_whose_legs_are_all_too_short_is_refused_by_the_legs(tmp_path):
    text = WALKER.replace('<box size="0.34 0.12 0.05"/>', '<box size="0.34 0.12 0.9"/>')
    with pytest.raises(UnreadableFile, match=r"nothing is left that could move: .* cannot carry it"):
        read(text, tmp_path)

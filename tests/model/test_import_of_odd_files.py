"""Files of other people that are drawn upside down, have wheels, differ from side to side, or are written badly."""

import re
from pathlib import Path

import pytest

from suchus.core.errors import SuchusError, UnreadableFile
from suchus.robot.design.body import servos_of
from suchus.sim.model.importing import Words, import_robot

FILES = Path(__file__).parent.parent / "data" / "imports"
WALKER = (FILES / "walker.urdf").read_text()
LEGS = ("LF", "RF", "LH", "RH")


def leg(name: str, up: float, tip: str) -> str:
    """A limb of three hinges; ``tip`` is what its last body carries."""
    x, y = (0.17 if name[1] == "F" else -0.17), (up if name[0] == "L" else -up)
    rod = '<geom type="capsule" fromto="0 0 0 {}" size=".01" mass=".1"/>'
    return (
        f'<body name="{name}_hip" pos="{x} {0.06 * y} 0"><joint name="{name}_hip" axis="0 0 1"/>'
        f"{rod.format(f'0 {0.03 * y} 0')}"
        f'<body name="{name}_thigh" pos="0 {0.03 * y} 0"><joint name="{name}_thigh" axis="0 1 0"/>'
        f"{rod.format(f'0 0 {-0.1 * up}')}"
        f'<body name="{name}_shin" pos="0 0 {-0.1 * up}"><joint name="{name}_knee" axis="0 1 0"/>'
        f"{rod.format(f'0 0 {-0.1 * up}')}{tip.format(name)}</body></body></body>"
    )


def quadruped(actuators: str = "", *, up: float = 1.0, tip: str = "", tendon: str = "") -> str:
    """An MJCF of a trunk with four limbs; ``up`` is -1 where z points down."""
    limbs = "".join(leg(name, up, tip) for name in LEGS)
    return (
        '<mujoco><worldbody><body name="trunk"><freejoint/><geom type="box" size=".2 .06 .03" mass="2"/>'
        f"{limbs}</body></worldbody>{tendon}<actuator>{actuators}</actuator></mujoco>"
    )


def motors(without: str = "", right: float = 7.0) -> str:
    return "".join(
        f'<motor joint="{name}_{joint}" gear="{right if name[0] == "R" else 7}" ctrlrange="-1 1"/>'
        for name in LEGS
        for joint in ("hip", "thigh", "knee")
        if f"{name}_{joint}" != without
    )


def read(text: str, folder: Path, *, name: str = "dog.xml", **words):
    (folder / name).write_text(text)
    return import_robot(folder / name, name="it", words=Words(**words))


def told(draft) -> str:
    return "\n".join(draft.remarks)


def test_a_body_whose_feet_lie_above_it_is_turned_over(tmp_path):
    """With z down, as in aviation, the names of the sides seemed to disagree with those of the ends."""
    down, right = read(quadruped(up=-1.0), tmp_path), read(quadruped(), tmp_path)
    assert "up is the file's -z axis, since all of its feet lie above its root" in told(down)
    assert "disagree" not in told(down)
    assert "-z" not in told(right)
    assert {match.file_hinge: match.hinge[:2] for match in down.matches} == {
        match.file_hinge: match.file_hinge[:2] for match in down.matches
    }
    assert down.robot.length == pytest.approx(right.robot.length)


WHEEL = (
    '<body name="{0}" pos="{1} {2} -.03"><joint axis="0 1 0"/><geom type="cylinder" euler="90 0 0" size="{3}"/></body>'
)


def test_wheels_are_no_limbs(tmp_path):
    """A car was read as a quadruped whose limbs have one hinge."""
    wheels = "".join(
        WHEEL.format(f"{end}_{side}", x, y, ".05 .02")
        for end, x in (("front", 0.15), ("rear", -0.15))
        for side, y in (("left", 0.12), ("right", -0.12))
    )
    hull = '<body name="hull"><freejoint/><geom type="box" size=".2 .1 .04"/>'
    car = f"<mujoco><worldbody>{hull}{wheels}</body></worldbody></mujoco>"
    with pytest.raises(UnreadableFile, match="turn about their own middle, as wheels do"):
        read(car, tmp_path)
    tip = '<body name="{0}_wheel" pos="0 0 -.1"><joint name="{0}_wheel" axis="0 1 0"/>'
    tip += '<geom type="cylinder" euler="90 0 0" size=".04 .01" mass=".1"/></body>'
    rolling = read(quadruped(tip=tip), tmp_path)
    assert "LF_wheel turns about its own middle, as a wheel does" in told(rolling)
    legged = read(quadruped(tip=tip), tmp_path, leave=tuple(f"{name}_wheel" for name in LEGS))
    assert len(legged.matches) == 12
    assert "wheel does" not in told(legged)


def test_a_long_foot_is_no_wheel(tmp_path):
    assert "wheel" not in told(read(quadruped(), tmp_path))


def test_drives_that_differ_from_side_to_side_are_told(tmp_path):
    weaker = read(quadruped(motors(right=5.0)), tmp_path)
    assert "RF_knee has 5 N m (LF_knee has 7 N m)" in told(weaker)
    passive = read(quadruped(motors(without="LF_hip")), tmp_path)
    assert "RF_hip has 7 N m (LF_hip is passive)" in told(passive)
    assert "Drives differ" not in told(read(quadruped(motors()), tmp_path))


def test_what_stands_for_a_tendon_is_said_as_it_is(tmp_path):
    """Where nothing else is driven the hinges of a tendon have guessed servos; they were called springs."""
    tendon = '<tendon><fixed name="t"><joint joint="LF_hip" coef="1"/></fixed></tendon>'
    pull = '<motor tendon="t" ctrlrange="-1 1"/>'
    alone = read(quadruped(pull, tendon=tendon), tmp_path)
    assert "these hinges are guessed servos in the draft" in told(alone)
    assert len(servos_of(alone.robot)) == 12
    beside = read(quadruped(pull + motors(without="LF_hip"), tendon=tendon), tmp_path)
    assert "these hinges are springs in the draft" in told(beside)


def test_many_actuators_of_a_kind_that_is_not_taken_are_one_note(tmp_path):
    for tag, words in (("cylinder", "Cylinders are not taken"), ("damper", "Dampers brake a joint and drive none")):
        text = "".join(f'<{tag} joint="{name}_hip" ctrlrange="0 1"/>' for name in LEGS)
        draft = read(quadruped(text), tmp_path)
        assert told(draft).count(words) == 1
        assert "LF_hip, RF_hip, LH_hip, RH_hip" in told(draft)
        assert "bounds neither" not in told(draft)


BAD = {
    "two links of one name": (WALKER.replace("</robot>", '<link name="trunk"/></robot>'), "2 links are called 'trunk'"),
    "joints of one name": (re.sub(r'(<joint name=")[^"]*"', r'\1j"', WALKER), "12 joints are called 'j'"),
    "a decimal comma": (WALKER.replace('"0.34 ', '"0,34 '), "holds '0,34', which is no number"),
    "a path of xacro": (
        re.sub(r'<box size="0.34[^>]*/>', '<mesh filename="$(find dog)/trunk.stl"/>', WALKER),
        "Expand the file first, as with xacro",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_a_badly_written_urdf_is_refused_with_its_cause(case, tmp_path):
    text, words = BAD[case]
    assert text != WALKER
    with pytest.raises(UnreadableFile, match=re.escape(words)):
        read(text, tmp_path, name="dog.urdf")


def scaled(text: str, length: float, mass: float) -> str:
    """An MJCF with its lengths and masses times a factor."""

    def times(match: re.Match[str]) -> str:
        factor = mass if match[1] == "mass" else length
        numbers = " ".join(f"{factor * float(word):.9g}" for word in match[2].split())
        return f'{match[1]}="{numbers}"'

    return re.sub(r'(pos|size|fromto|mass)="([^"]*)"', times, text)


def test_lengths_in_millimetres_and_bodies_too_small_are_named(tmp_path):
    """A million times the mass was out of range; MuJoCo's own line on eigenvalues was printed."""
    with pytest.raises(UnreadableFile, match="its lengths seem to be in millimetres"):
        read(scaled(quadruped(), 1000.0, 1.0), tmp_path)
    with pytest.raises(SuchusError, match="smaller than MuJoCo computes with"):
        read(scaled(quadruped(), 0.01, 1e-6), tmp_path)


def test_a_text_in_another_encoding_is_said(tmp_path):
    for encoding, words in (("utf-16", "but in UTF-16: save it as UTF-8"), ("latin-1", "if it is a text, save it")):
        (tmp_path / "dog.urdf").write_bytes(WALKER.replace("<robot", "<!-- é --><robot", 1).encode(encoding))
        with pytest.raises(UnreadableFile, match=words):
            import_robot(tmp_path / "dog.urdf", name="it")


def test_an_arm_on_a_base_is_not_called_a_snake(tmp_path):
    arm = '<mujoco><worldbody><body name="base"><geom type="box" size=".1 .1 .05"/>'
    rod = '<geom type="capsule" fromto="0 0 0 0 0 .2" size=".02"/>'
    for i, axis in enumerate(("0 0 1", "0 1 0", "0 1 0")):
        arm += f'<body name="l{i}" pos="0 0 .2"><joint axis="{axis}"/>{rod}'
    with pytest.raises(UnreadableFile, match="an arm on a base is no robot that suchus takes"):
        read(arm + "</body>" * 4 + "</worldbody></mujoco>", tmp_path)

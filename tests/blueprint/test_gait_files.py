"""Gait files: those of former forms move as they did, what is written reads back equal, mistakes are told by place."""

import json
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.core.errors import OutsideLimits, UnreadableFile
from suchus.robot.blueprint import MistakenFile, read_gait, write
from suchus.robot.gaits import GAITS
from suchus.robot.motion import AxialWave, Bend, Curve, FixedLimbs, FootPath, Gait, GaitInMetres, Sweep, cycle_targets
from suchus.robot.motion.forms import GaitByPlaces
from suchus.robot.robots import ROBOTS

FROZEN = json.loads((Path(__file__).parent / "gait_files.json").read_text())
"""Files in the forms of before there was one, by whom they were for, and the servo angles that they gave then [rad]."""
CAIMAN = ROBOTS["caiman"]


@pytest.fixture
def gait_of(tmp_path):
    """Write a file and return the gait that is read from it."""

    def read(text, robot=CAIMAN):
        file = tmp_path / "mine.toml"
        file.write_text(text)
        return read_gait(file, robot, GAITS)

    return read


@pytest.mark.parametrize("name", FROZEN["files"])
def test_files_of_former_forms_move_as_they_did(name, gait_of):
    frozen = FROZEN["files"][name]
    robot = ROBOTS[frozen["robot"]]
    targets = cycle_targets(robot, gait_of(frozen["file"], robot), np.array(FROZEN["clock"]))
    np.testing.assert_allclose(targets, frozen["targets"], atol=1e-7)


@pytest.mark.parametrize("name", GAITS)
def test_gaits_of_the_shelf_read_back_equal(name, tmp_path):
    assert read_gait(write(GAITS[name], tmp_path / "x.toml"), CAIMAN, GAITS) == GAITS[name]


def angles(most):
    return st.floats(-most, most, allow_nan=False)


def rows(numbers):
    return st.lists(numbers, min_size=1, max_size=5).map(tuple)


SHARES = st.floats(-1.0, 1.0)
PATHS = st.builds(
    FootPath, stroke=SHARES, lift=st.floats(0.0, 1.0), outward=SHARES, ahead=SHARES, swivel=st.floats(-3.14, 3.14)
)
LIMBS = (
    PATHS
    | st.builds(Sweep, stance=st.floats(0.01, 6.0), down=angles(3.0))
    | st.builds(FixedLimbs, angles=rows(angles(9.0)))
)
BENDS = st.builds(
    Bend,
    part=st.sampled_from(["neck", "trunk", "tail", "axis"]),
    turn=st.sampled_from(["yaw", "pitch"]),
    amplitude=rows(angles(9.0)),
    lag=rows(angles(9.0)),
    offset=angles(9.0),
)
CURVES = st.builds(
    Curve,
    servo=st.text(st.characters(exclude_categories=["Cs", "Cc", "Cf", "Zl", "Zp"]), max_size=9),
    part=st.sampled_from(["limb", "neck", "trunk", "tail"]),
    angles=rows(angles(6.0)),
)


@st.composite
def gaits(draw):
    limbs = tuple(draw(st.lists(LIMBS, max_size=3)))
    phases = st.lists(SHARES, min_size=2 * len(limbs), max_size=2 * len(limbs)).map(tuple)
    return Gait(
        name=draw(st.text(st.characters(exclude_categories=["Cs", "Cc", "Cf", "Zl", "Zp"]), max_size=9)),
        period=draw(st.floats(1e-3, 3600.0)),
        duty_factor=draw(st.floats(0.05, 0.95)),
        limb_phases=draw(phases),
        limbs=limbs,
        height=draw(st.floats(0.0, 2.0)),
        axis=tuple(draw(st.lists(BENDS, max_size=3))),
        curves=tuple(draw(st.lists(CURVES, max_size=3, unique_by=lambda curve: curve.servo))),
        coupling=draw(st.just(()) | phases),
    )


@given(gait=gaits())
def test_any_gait_reads_back_equal(gait, tmp_path_factory):
    file = write(gait, tmp_path_factory.mktemp("any") / "x.toml")
    assert read_gait(file, CAIMAN, GAITS) == gait


def test_metres_are_those_of_the_robot_and_the_rest_is_the_bases(gait_of):
    for name in ("caiman", "salamander", "pleurobot"):
        gait = gait_of('base = "belly_crawl"\nstroke = 0.005\ntail_pitch = 0.1\n', ROBOTS[name])
        reaches = [girdle.limb.reach for girdle in ROBOTS[name].girdles] if name != "caiman" else [0.1575, 0.175]
        assert [limb.stroke * reach for limb, reach in zip(gait.limbs, reaches, strict=True)] == pytest.approx(
            [0.005] * 2
        )
        base = GAITS["belly_crawl"]
        assert [limb.outward for limb in gait.limbs] == [limb.outward for limb in base.limbs]
        assert (gait.axis[:2], gait.number("tail_pitch"), gait.height) == (base.axis[:2], 0.1, base.height)


def test_metres_written_back_on_themselves_are_the_same_gait():
    """All of a gait's own metres, put onto it, change nothing; onto another one they make it the first."""
    reaches = (0.1575, 0.175)
    crawl, high = GAITS["belly_crawl"], GAITS["high_walk"]
    every = {field.name for field in fields(GaitInMetres)}
    assert GaitInMetres.from_gait(crawl, reaches).override(crawl, every, reaches) == crawl
    assert GaitInMetres.from_gait(crawl, reaches).override(high, every, reaches) == crawl


@given(
    phase=st.floats(-0.9, 0.9),
    waves=st.floats(-2.0, 2.0),
    offset=st.floats(-0.2, 0.2),
    name=st.sampled_from(["salamander", "swimmer"]),
)
def test_a_wave_by_places_is_found_in_the_gait_that_it_makes(phase, waves, offset, name):
    robot = ROBOTS[name]
    base = GaitByPlaces.from_gait(
        GAITS["salamander_walk" if name == "salamander" else "undulation"],
        AxialWave(amplitude=((0.0, 0.0),), waves=0.0, phase=0.0),
    )
    wave = AxialWave(amplitude=((0.0, 0.1), (0.6, -0.3), (1.0, -0.2)), waves=waves, phase=phase, offset=offset)
    gait = GaitByPlaces.from_gait(base.gait(robot), wave).gait(robot)
    again = GaitByPlaces.from_gait(gait, AxialWave.from_gait(gait, robot)).gait(robot)
    clock = np.arange(7) / 7
    np.testing.assert_allclose(cycle_targets(robot, again, clock), cycle_targets(robot, gait, clock), atol=1e-9)


MISTAKES = {
    "a key of no form": ("perid = 1\n", "did you mean period", CAIMAN),
    "nothing at all": ("", "period is missing", CAIMAN),
    "a robot": ("femur = 1\n", r"femur is not known; there is name, period, duty_factor, limb_phases, limbs", CAIMAN),
    "a foot path without a lift": (
        "period = 1\nlimb_phases = [0, 0.5]\n[[limbs]]\nstroke = 0.1\noutward = 0.5\n",
        r"a mistake: limbs\[0\].lift is missing\.$",
        CAIMAN,
    ),
    "a crank that turns too far": (
        'base = "salamander_walk"\n[[limbs]]\nstance = 90\n[[limbs]]\nstance = 1\n',
        r"a mistake: limbs\[0\].stance is 90 rad; 0.01 to 6.27",
        CAIMAN,
    ),
    "a number for a limb": ("period = 1\nlimbs = [3]\n", r"a mistake: limbs\[0\] is 3; a table is needed", CAIMAN),
    "a part of nobody": ('period = 1\n[[axis]]\npart = "trnk"\n', r"axis\[0\].part is 'trnk'; 'neck', 'trunk'", CAIMAN),
    "metres out of range": ('base = "belly_crawl"\ntrunk_bend = 30\n', "trunk_bend is 30 rad; 0 to 3.14", CAIMAN),
    "a stroke longer than the limb": ('base = "belly_crawl"\nstroke = 0.5\n', "on robot 'caiman' .*3.17", CAIMAN),
    "sprawled feet of erect legs": ('base = "belly_crawl"\nlegs = "erect"\n', "both must be 0 m", CAIMAN),
    "an unknown base": (
        'base = "belly_craw"\nhip_height = -1\n',
        "2 mistakes.*there is animal_walk.*hip_height",
        CAIMAN,
    ),
    "metres of six limbs": (
        'base = "tripod"\nstroke = 0.1\nhip_height = 0.1\n',
        "with limbs and axis",
        ROBOTS["strider"],
    ),
    "metres of angles": ('base = "animal_walk"\nhip_height = 0.1\n', "write limbs and axis instead", CAIMAN),
    "a wave of a gait that has none": (
        'base = "salamander_walk"\nlimb_phases = [0, 0.5, 0.25, 0.75]\n[wave]\nfaze = 1\n',
        "wave.faze is not known; there is amplitude, waves, phase, offset",
        ROBOTS["salamander"],
    ),
    "girdles of another robot": (
        'base = "tripod"\n[[girdles]]\nstroke = 0.1\nlift = 0.1\noutward = 0.5\nahead = 0.0\n',
        "mine.toml: gait 'mine' is for 1 pairs of limbs",
        ROBOTS["strider"],
    ),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_is_a_sentence_with_its_place(name, gait_of):
    text, says, robot = MISTAKES[name]
    with pytest.raises(UnreadableFile, match=says) as error:
        gait_of(text, robot)
    assert "mine.toml" in str(error.value)


def test_a_curve_follows_the_part_of_its_servo(gait_of):
    curves = '[[curves]]\nservo = "LF_yaw"\nangles = [0, 0.1]\n[[curves]]\nservo = "tail_yaw_1"\nangles = [0.2]\n'
    gait = gait_of(f'base = "animal_walk"\n{curves}', ROBOTS["salamander"])
    assert [(curve.servo, curve.part) for curve in gait.curves] == [("LF_yaw", "limb"), ("tail_yaw_1", "tail")]
    with pytest.raises(MistakenFile, match=r"curves\[0\].angles is missing"):
        gait_of('period = 1\n[[curves]]\nservo = "LF_yaw"\n')


def test_bends_beyond_a_wave_are_told_how_to_be_written():
    gait = Gait(name="g", period=1.0, axis=(Bend(part="axis", amplitude=(0.5,), lag=(0.0, 0.1, 0.5, 0.6)),))
    with pytest.raises(OutsideLimits, match="give the whole wave, amplitude, waves and phase"):
        AxialWave.from_gait(gait, ROBOTS["swimmer"])
    assert AxialWave.from_gait(GAITS["belly_crawl"], CAIMAN).waves == 0.0

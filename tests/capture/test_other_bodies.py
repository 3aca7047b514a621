"""A walk that was seen goes onto any body with four limbs: its phases, bends and lengths come out as they were seen."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.animals.capture import driven_fraction, film_animal, observe, to_gait, write_table
from suchus.apps.cli import main
from suchus.core.errors import OutsideLimits, UnsuitedRobot
from suchus.robot import blueprint
from suchus.robot.design import hips_ahead, layout
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import FixedLimbs, Gait, check_limits, cycle_targets
from suchus.robot.robots import ROBOTS

CLOCK = np.arange(256) / 256


@pytest.fixture(scope="module")
def walk(lizard, clean):
    return observe(film_animal(lizard, clean, cycles=4), tail_share=1.0)


def harmonic(bend):
    """Return the first harmonic of a bend over the phase of the first limb [rad]."""
    return 2 * np.mean(bend * np.exp(-2j * np.pi * CLOCK))


def bends(robot, gait):
    """Return the first harmonics of trunk and tail, concave on the left positive, over the phase of the first limb."""
    place = layout(robot)
    targets = cycle_targets(robot, gait, CLOCK - gait.limb_phases[0])
    left = dict(zip(place.axial_yaw, place.axial_left, strict=True))
    return tuple(
        harmonic(sum(left[i] * targets[:, i] for i in servos)) for servos in (place.trunk_yaw, place.tail_yaw) if servos
    )


@pytest.mark.parametrize("name", ["salamander", "pleurobot"])
def test_bends_and_phases_are_those_of_the_walk(walk, name):
    robot, base = ROBOTS[name], default_gait(ROBOTS[name])
    captured = to_gait(walk, robot, base, name="seen")
    gait = captured.gait
    check_limits(robot, gait)
    theirs = to_gait(walk, ROBOTS["caiman"], GAITS["belly_crawl"], name="seen").gait
    assert gait.limb_phases == theirs.limb_phases
    assert gait.duty_factor == theirs.duty_factor
    trunk, tail = bends(robot, gait)
    (expected,) = bends(ROBOTS["caiman"], theirs)
    assert abs(trunk - expected) < 0.02 * abs(expected)  # amplitude and phase, as on the article's robot
    rested = np.mean([walk.value(f"duty_{leg}") for leg in ("LF", "RF", "LH", "RH")])
    clock = np.exp(1j * np.pi * (gait.duty_factor - rested))
    seen = -clock * walk.bends["tail_lateral"]
    assert abs(tail - seen) < 1e-3 * abs(seen)


def test_lengths_go_with_the_trunk(walk):
    robot, base = ROBOTS["salamander"], default_gait(ROBOTS["salamander"])
    captured = to_gait(walk, robot, base, name="seen", time="own")
    trunk, reach = hips_ahead(robot, 0), robot.girdles[0].limb.reach
    if not any("do not reach" in note for note in captured.notes):
        expected = trunk * np.mean([walk.value(f"stroke_{leg}") for leg in ("LF", "RF", "LH", "RH")]) / reach
        assert captured.gait.limbs[0].stroke == pytest.approx(expected, rel=1e-3)
    assert captured.gait.height == base.height
    assert captured.gait.period >= walk.value("period") * (1 - 1e-3)


@pytest.mark.parametrize("name", ["strider", "swimmer", "salamandra"])
def test_who_lacks_four_limbs_with_feet_is_refused(walk, name, tmp_path, capsys):
    robot = ROBOTS[name]
    with pytest.raises(UnsuitedRobot, match="a captured walk needs"):
        to_gait(walk, robot, default_gait(ROBOTS["salamander"]), name="seen")
    assert main(["capture", str(tmp_path / "any.csv"), "--robot", name]) == 2
    assert not list(tmp_path.iterdir())
    assert capsys.readouterr().err.count("\n") == 1


def test_a_base_that_holds_its_limbs_lends_nothing(walk):
    robot, base = ROBOTS["salamander"], default_gait(ROBOTS["salamander"])
    held = tuple(FixedLimbs(angles=(0.0,) * 4) for _ in base.limbs)
    with pytest.raises(OutsideLimits, match="name another one with --base"):
        to_gait(walk, robot, replace(base, limbs=held), name="seen")


def test_the_command_writes_a_gait_for_another_body(lizard, clean, tmp_path, capsys):
    tracks = write_table(film_animal(lizard, clean, cycles=3), tmp_path / "lizard.csv")
    out = tmp_path / "walk.toml"
    assert main(["capture", str(tracks), "--robot", "salamander", "--out", str(out)]) == 0
    gait = blueprint.read_design(out, Gait, GAITS)
    check_limits(ROBOTS["salamander"], gait)
    assert "suchus run displacement --robot salamander --gait" in capsys.readouterr().out


def test_what_is_driven_of_a_tail_ends_before_its_passive_end():
    assert driven_fraction(ROBOTS["salamander"]) == driven_fraction(ROBOTS["swimmer"]) == 1.0
    tail = ROBOTS["caiman"].tail
    cable = tail.root + tail.joints * tail.pitch
    assert driven_fraction(ROBOTS["caiman"]) == pytest.approx((cable - tail.pitch / 4) / (cable + tail.fin_length))


def test_a_joint_that_cannot_bend_as_far_bends_as_far_as_it_can(walk):
    robot = ROBOTS["salamander"]
    wild = replace(walk, bends=walk.bends | {"tail_lateral": 20.0 * walk.bends["tail_lateral"]})
    captured = to_gait(wild, robot, default_gait(robot), name="seen")
    check_limits(robot, captured.gait)
    assert any("bend as far as they can" in note for note in captured.notes)

"""Any body whose axis bends swims freely, and walks out of the water where it has limbs."""

from dataclasses import replace
from math import isfinite

import pytest

from body_files import eight, giant, hatchling, imported_quadruped, six
from suchus.core.errors import UnsuitedRobot
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.swim_free.experiment import _motions, _steered_gait
from suchus.robot.control import LoadRule, PatternGenerator
from suchus.robot.design import check_needs, lacking
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import START, check_speeds, straight_gait, suits
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, Run, simulate
from suchus.swimming.water import swim_of

AXIAL = [*(name for name in ROBOTS if not lacking(ROBOTS[name], ["axis"])), eight, giant, hatchling, six]


def robot_of(one):
    return ROBOTS[one] if isinstance(one, str) else one()


@pytest.mark.parametrize("one", AXIAL)
def test_every_axial_chain_has_a_swim_that_its_joints_and_servos_can_follow(one):
    robot = robot_of(one)
    swim = swim_of(robot)
    assert suits(robot, swim)
    check_speeds(robot, swim)
    steered = _steered_gait(robot, swim, tail=0.6, trunk=0.3)
    assert suits(robot, steered)
    assert steered.number("tail_offset") > 0.0


def test_a_body_that_does_not_bend_has_none():
    strider = ROBOTS["strider"]
    stiff = replace(strider, axis=tuple(replace(segment, hinges=()) for segment in strider.axis))
    with pytest.raises(UnsuitedRobot, match="a swim needs an axis that bends sideways; robot 'strider' lacks that"):
        swim_of(stiff)


@pytest.mark.parametrize(("name", "motions"), [("swimmer", 4), ("caiman", 4), ("strider", 2)])
def test_tail_and_trunk_swim_alone_where_both_bend(name, motions):
    found = _motions(swim_of(ROBOTS[name]))
    assert len(found) == motions
    assert list(found)[0 :: motions - 1] == ["whole", "reversed"]
    if "tail_only" in found:
        bends = {
            part: any(any(b.amplitude) for b in found["tail_only"].axis if b.part == part) for part in ("trunk", "tail")
        }
        assert bends == {"trunk": False, "tail": True}


def test_the_shore_takes_every_walker_in_a_gait_that_can_be_steered():
    shore = EXPERIMENTS["shore"].quick()
    for name in ("pleurobot", "salamander", "salamandra", "strider", "floating_caiman"):
        asked = shore.for_robot(ROBOTS[name])
        assert asked.gait.has("steering")
        assert suits(asked.robot, asked.gait)
        assert suits(asked.robot, asked.wade)
        assert asked.air_released == (1.0 if name == "floating_caiman" else 0.0)
    assert shore.for_robot(ROBOTS["floating_caiman"]).gait == GAITS["semi_erect"]
    assert shore.for_robot(ROBOTS["strider"]).gait == GAITS["tripod"]
    with pytest.raises(UnsuitedRobot, match="shore needs limbs to walk on; robot 'swimmer' lacks that"):
        check_needs(ROBOTS["swimmer"], EXPERIMENTS["shore"].needs, "shore")


@pytest.mark.parametrize(("name", "walks"), [("swimmer", False), ("salamander", True)])
def test_the_pattern_generator_swims_whoever_bends_and_by_the_felt_load_whoever_walks(name, walks):
    """At the drive for walking a body with limbs gets nowhere in deep water unless it feels that nothing carries it."""
    robot = ROBOTS[name]
    gait, lake = default_gait(robot), Lake(level=2 * robot.length)
    controls = [PatternGenerator(drive=4.0)]
    controls += [PatternGenerator(drive=2.0, load=rule) for rule in (None, LoadRule())] if walks else []
    runs = [Run(robot=robot, gait=gait, lake=lake, control=control) for control in controls]
    record = simulate(runs, duration=START + 3 * gait.period)
    late = record.sel(time=slice(START + gait.period, None)).centre_of_mass.sel(xyz="x").values
    ways = (late[:, -1] - late[:, 0]) / robot.length / 2  # in lengths a period
    assert ways[0] > 0.3
    if walks:
        assert ways[1] < 0.2
        assert ways[2] > 0.3


@pytest.mark.parametrize(
    ("name", "one"),
    [("swim_free", "swimmer"), ("swim_free", "pleurobot"), ("swim_free", hatchling), ("shore", "pleurobot")],
)
def test_it_answers(name, one):
    asked = EXPERIMENTS[name].quick().for_robot(robot_of(one))
    outcome = asked.run()
    assert "nan" not in outcome.decides.split()
    assert sum(isfinite(measure.value) for measure in outcome.measures.values()) > 5
    assert asked.draw(outcome)
    assert all("<canvas" in replay.html for replay in outcome.replays.values())


def test_limbs_whose_joints_do_not_reach_zero_are_held_as_near_as_they_go(tmp_path):
    robot = imported_quadruped(tmp_path)
    assert suits(robot, straight_gait(robot))
    knees = [hinge.range for hinge in robot.girdles[0].limb.hinges if not hinge.range[0] <= 0.0 <= hinge.range[1]]
    assert knees

"""What is said of a swimmer before it moves: it sinks, capsizes or lies in the air, and what mends that."""

import re
import warnings
from dataclasses import replace

import numpy as np
import pytest

from suchus.core.errors import Doubtful
from suchus.robot.control import Swimming
from suchus.robot.design import WATER_DENSITY, Foam, Hull, Inertia, Shell
from suchus.robot.design.pieces import volumes
from suchus.robot.design.water import Water
from suchus.robot.motion import cycle_targets, straight_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, Run, simulate
from suchus.sim.land.afloat import HEAVIER, INDIFFERENT, check_afloat
from suchus.sim.model.hydrostatics import hydrostatics


def straight(robot):
    """The servo angles of a straight body, its limbs back."""
    return cycle_targets(robot, straight_gait(robot), np.zeros(1), np.zeros(1))[0]


def doubts(robot, lake=Lake(level=1.0)):  # noqa: B008  frozen
    """What is told before a robot swims."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        check_afloat(robot, lake, straight(robot))
    assert len(told) <= 1
    return str(told[0].message) if told else ""


def loaded(robot, factor):
    """A robot whose every mass is another, where it was."""
    shapes = [[replace(shape, mass=factor * shape.mass) for shape in segment.shapes] for segment in robot.axis]
    axis = [replace(segment, shapes=tuple(new)) for segment, new in zip(robot.axis, shapes, strict=True)]
    return replace(robot, axis=tuple(axis))


def numbers(text):
    return [float(number) for number in re.findall(r"(?<![\w'])-?\d+\.?\d*", text)]


@pytest.mark.parametrize("name", ["swimmer", "floating_caiman", "pleurobot"])
def test_who_floats_upright_swims_without_a_word(name):
    assert doubts(ROBOTS[name]) == ""


def test_who_sinks_is_told_what_carries_it_and_that_much_does():
    caiman = ROBOTS["caiman"]
    grams, foam = numbers(doubts(caiman))[:2]
    assert "sinks" in doubts(caiman)
    for share, told in ((0.98, "sinks"), (1.02, "")):
        hull = Hull(foam=(Foam(body="thorax", volume=1e-3 * foam * share, raised=0.02),))
        assert told in doubts(replace(caiman, hull=hull))
        assert bool(told) == ("sinks" in doubts(replace(caiman, hull=hull)))
    assert grams == pytest.approx(1e3 * (caiman.mass - 1000.0 * sum(volumes(caiman).values())), rel=1e-3)


@pytest.mark.parametrize(("margin", "sinks"), [(0.5, False), (2.0, True)])
def test_a_swimmer_may_be_heavier_by_a_thousandth_of_its_mass(margin, sinks):
    swimmer = ROBOTS["swimmer"]
    density = swimmer.mass * (1 - margin * HEAVIER) / sum(volumes(swimmer).values())
    lake = Lake(level=1.0, water=Water(density=density))
    assert ("sinks" in doubts(swimmer, lake)) == sinks


@pytest.mark.parametrize(("share", "told"), [(0.99, True), (1.01, False)])
def test_who_capsizes_is_told_what_mass_to_lower_and_that_much_rights_it(share, told):
    """Mass that is moved down lowers the centre of mass, and raises the metacentric height, by as much as its share."""
    swimmer = ROBOTS["swimmer"]
    high = _higher(swimmer, 0.004)
    grams, lower = numbers(doubts(high).partition("lower more than")[2])[:2]
    assert grams == pytest.approx(1e2 * swimmer.mass, rel=0.01)
    moved = 1e-6 * grams * lower * share / swimmer.mass
    height = hydrostatics(_higher(high, -moved), straight(high), heel_count=3).metacentric_height
    assert (height < 0.0) == told
    assert ("capsizes" in doubts(_higher(high, -moved - 0.001))) is False


@pytest.mark.parametrize(("below", "capsizes"), [(0.5, False), (2.0, True)])
def test_a_metacentric_height_next_to_zero_is_not_called_capsizing(below, capsizes):
    swimmer = ROBOTS["swimmer"]
    height = hydrostatics(swimmer, straight(swimmer), heel_count=3).metacentric_height
    raised = _higher(swimmer, height + below * INDIFFERENT * swimmer.length)
    assert ("capsizes" in doubts(raised)) == capsizes


def _higher(robot, by):
    """A swimmer whose mass lies higher in every segment, its shapes where they were; by is in metres."""
    axis = []
    for segment in robot.axis:
        mass = sum(shape.mass for shape in segment.shapes)
        heights = [shape.at[2] if isinstance(shape, Shell) else shape.start[2] for shape in segment.shapes]
        middle = sum(shape.mass * z for shape, z in zip(segment.shapes, heights, strict=True)) / mass
        up = segment.inertia.centre[2] if segment.inertia else middle
        inertia = Inertia(centre=(0.0, 0.0, up + by), moments=(1e-4 * mass,) * 3)
        axis.append(replace(segment, inertia=inertia))
    return replace(robot, axis=tuple(axis))


@pytest.mark.parametrize(("share", "told"), [(0.851, False), (0.849, True)])
def test_who_lies_in_the_air_is_told_what_mass_brings_it_down(share, told):
    swimmer = ROBOTS["swimmer"]
    light = loaded(swimmer, share / 0.95)
    said = doubts(light, Lake(level=1.0, water=Water(density=WATER_DENSITY)))
    assert ("in the air" in said) == told
    if told:
        grams = numbers(said)[1]
        heavier = loaded(light, (light.mass + 1e-3 * grams) / light.mass)
        assert heavier.mass == pytest.approx(0.95 * WATER_DENSITY * sum(volumes(light).values()), rel=1e-3)


def test_it_is_said_before_a_swim_and_not_before_a_walk():
    caiman, lake = ROBOTS["caiman"], Lake(level=2.0)
    with pytest.warns(Doubtful, match="robot 'caiman' sinks: it is 999 g heavier"):
        simulate([Run(robot=caiman, gait=straight_gait(caiman), lake=lake, control=Swimming())], duration=0.1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulate([Run(robot=caiman, gait="belly_crawl", lake=lake)], duration=0.1)

"""Postures of the page are those of Python, for every gait of the catalog and for limbs of every kind."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from tests.bodies import eel, six
from tests.laboratory.page_modules import needs_node, run
from tests.model.hinge_trees import quadruped

from suchus.apps.laboratory.description import gait_facts, robot_facts
from suchus.robot.gaits import GAITS, default_gait, suits
from suchus.robot.motion import FootPath
from suchus.robot.motion.movement import cycle_targets
from suchus.robot.robots import ROBOTS
from suchus.sim.model.importing import import_robot

pytestmark = needs_node
CLOCKS = np.linspace(0.0, 1.7, 200)  # more than a cycle: cranks do not turn back
TOLERANCE = 1e-9


def compare(pairs, size=None):
    """Assert that node and Python say the same of robots in gaits, each a pair of both."""
    cases = [
        {"robot": robot_facts(robot), "gait": gait_facts(gait), "clocks": CLOCKS.tolist(), "size": size}
        for robot, gait in pairs
    ]
    sizes = None if size is None else np.full(len(CLOCKS), size)
    assert cases
    for (robot, gait), angles in zip(pairs, run("posture", cases=cases), strict=True):
        expected = cycle_targets(robot, gait, CLOCKS, sizes)
        assert np.abs(expected).max() > 0.0, (robot.name, gait.name)
        assert np.abs(np.array(angles) - expected).max() < TOLERANCE, (robot.name, gait.name)


def shelf():
    return [(ROBOTS[robot], GAITS[gait]) for robot in ROBOTS for gait in GAITS if suits(ROBOTS[robot], GAITS[gait])]


def test_every_gait_of_the_catalog_on_every_robot_that_can_follow_it():
    assert {gait.name for _, gait in shelf()} == {*GAITS}
    compare(shelf())


def test_a_gait_that_grows_from_rest_is_drawn_into_reach():
    compare([(robot, default_gait(robot)) for robot in ROBOTS.values()], size=0.35)


def test_feet_out_of_reach_are_drawn_into_it_where_a_gait_grows():
    far = tuple(replace(limb, stroke=0.9) for limb in GAITS["belly_crawl"].limbs)
    compare([(ROBOTS["caiman"], replace(GAITS["belly_crawl"], limbs=far))], size=0.9)


def test_erect_legs_cranks_and_measured_curves():
    caiman, gait = ROBOTS["caiman"], GAITS["high_walk"]
    assert any(isinstance(limb, FootPath) and abs(limb.swivel) > pi / 4 for limb in gait.limbs)
    leaning = tuple(replace(limb, ahead=0.15) for limb in gait.limbs)  # to the other side of the hip
    compare([(caiman, replace(gait, limbs=leaning)), (ROBOTS["salamandra"], GAITS["salamandra_walk"])])
    assert GAITS["animal_walk"].curves


@pytest.mark.parametrize("robot", [six(), eel()], ids=lambda robot: robot.name)
def test_bodies_that_no_catalog_has(robot):
    compare([(robot, default_gait(robot))])


def test_an_imported_quadruped_whose_limbs_have_no_closed_form(tmp_path):
    file = tmp_path / "dog.urdf"
    file.write_text(quadruped())
    robot = import_robot(file, name="dog").robot
    assert {limb["kind"] for limb in robot_facts(robot)["limbs"]} == {"other"}
    compare([(robot, default_gait(robot))])

"""Every body of the shelf walks or swims, at every size, and is refused where it makes no sense."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.core.errors import InvalidDesign, OutsideLimits, UnsuitedRobot
from suchus.robot import blueprint
from suchus.robot.control import Coordinated
from suchus.robot.design import Robot, layout
from suchus.robot.design.scale import rescale
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START
from suchus.robot.robots import ROBOTS
from suchus.sim.land import WATER, Run, crawl, simulate
from suchus.sim.metrics import displacement, heading

GAIT_OF = {
    "salamander": "salamander_walk",
    "salamandra": "salamandra_walk",
    "pleurobot": "pleurobot_walk",
    "strider": "tripod",
}


def stride(record, robot, gait, cycles) -> float:
    """Return the way ahead a cycle [body length]."""
    return float(displacement(record).sel(xyz="x")) / robot.length / cycles


@pytest.mark.parametrize("name", GAIT_OF)
def test_each_robot_walks_straight_on_its_feet(name):
    robot, gait = ROBOTS[name], GAITS[GAIT_OF[name]]
    record = crawl(robot, gait, duration=START + 2 * gait.period)
    place = layout(robot)
    assert tuple(record.leg.values) == place.limb_names
    assert tuple(record.servo.values) == place.servos
    assert tuple(record.joint.values) == place.hinges
    assert all(np.isfinite(record[v].values).all() for v in ("position", "joint_angle", "foot_force", "servo_torque"))
    assert stride(record, robot, gait, 2) > 0.1  # of a body length; with a stiff axis and slipping feet less than that
    assert abs(float(heading(record)[-1])) < 0.2
    weight = robot.mass * 9.81
    settled = record.sel(time=slice(START + gait.period, None))
    carried = settled.foot_force.sel(xyz="z").sum("leg") + settled.belly_force.sel(xyz="z").sum("segment")
    assert float((carried + settled.tail_force.sel(xyz="z")).mean()) == pytest.approx(weight, rel=0.03)
    assert float(settled.foot_force.sel(xyz="z").sum("leg").mean()) > 0.7 * weight


def test_the_swimmer_swims_and_hardly_moves_on_even_ground():
    robot, gait = ROBOTS["swimmer"], GAITS["undulation"]
    swims = simulate([Run(robot=robot, gait=gait, afloat=WATER)], duration=START + 2.0).isel(run=0)
    crawls = crawl(robot, gait, duration=START + 2.0)
    assert stride(swims, robot, gait, 2) > 0.15
    assert 0.0 < abs(stride(crawls, robot, gait, 2)) < 0.15
    assert crawls.sizes["leg"] == 0
    assert np.isfinite(crawls.position.values).all()


def test_a_wave_that_runs_backward_swims_backward():
    robot, gait = ROBOTS["swimmer"], GAITS["undulation"]
    back = gait.with_numbers(waves=-gait.number("waves"))
    record = simulate([Run(robot=robot, gait=back, afloat=WATER)], duration=START + 2.0).isel(run=0)
    assert stride(record, robot, back, 2) < -0.1


@pytest.mark.parametrize(("name", "gait"), [("caiman", "belly_crawl"), ("salamander", "salamander_walk")])
def test_three_grams_and_sixty_kilograms_walk_alike(name, gait):
    body, strides = ROBOTS[name], []
    for length, mass in ((0.1, 0.003), (3.0, 60.0)):
        factor = length / body.length
        robot = rescale(body, length_factor=factor, mass_factor=mass / body.mass)
        step = rescale(GAITS[gait], length_factor=factor)
        assert (robot.mass, robot.length) == pytest.approx((mass, length))
        record = crawl(robot, step, duration=round(START + step.period, 2))
        strides.append(stride(record, robot, step, 1))
    assert min(strides) > 0.1
    # the large one begins less settled: START is 1 s for all
    assert strides[0] == pytest.approx(strides[1], rel=0.05)


def test_six_spine_joints_and_a_servo_tail_in_five_lines_crawl(tmp_path):
    file = tmp_path / "six.toml"
    file.write_text('base = "caiman"\n[spine]\njoints = 6\n[tail]\ndrive = "servos"\n')
    robot = blueprint.read_design(file, Robot, ROBOTS)
    assert len(layout(robot).trunk_yaw) == 3
    assert len(layout(robot).trunk_pitch) == 3
    assert len(layout(robot).tail_yaw) == 6
    gait = GAITS["belly_crawl"]
    record = crawl(robot, gait, duration=START + gait.period)
    assert stride(record, robot, gait, 1) > 0.2
    coordinated = crawl(robot, gait, duration=1.5, control=Coordinated())
    assert np.isfinite(coordinated.position.values).all()


def test_a_gait_for_other_limbs_is_refused():
    with pytest.raises(OutsideLimits, match=r"has phases for 4 limbs; robot 'strider' has 6"):
        crawl(ROBOTS["strider"], GAITS["belly_crawl"], duration=0.5)
    with pytest.raises(OutsideLimits, match=r"asks .* of robot 'salamander' for .* rad is allowed"):
        crawl(ROBOTS["salamander"], GAITS["high_walk"], duration=0.5)
    with pytest.raises(OutsideLimits, match=r"has phases for 6 limbs; robot 'salamander' has 4"):
        crawl(ROBOTS["salamander"], GAITS["tripod"], duration=0.5)
    with pytest.raises(OutsideLimits, match=r"limbs LF and RF of robot .salamandra. are cranks: choose a gait"):
        crawl(ROBOTS["salamandra"], GAITS["salamander_walk"], duration=0.5)
    with pytest.raises(
        UnsuitedRobot, match=r"the feedback rule .* needs .*; robot 'strider' with gait 'tripod' lacks that"
    ):
        crawl(ROBOTS["strider"], GAITS["tripod"], duration=0.5, control=Coordinated())


def test_sizes_that_do_not_go_together_are_refused():
    runs = [
        Run(robot=ROBOTS["salamander"], gait=GAITS["salamander_walk"]),
        Run(robot=ROBOTS["strider"], gait=GAITS["tripod"]),
    ]
    with pytest.raises(InvalidDesign, match=r"control periods of 0.005 and 0.01 s"):
        simulate(runs, duration=0.5)
    with pytest.raises(InvalidDesign, match=r"the same bodies, hinges and servos"):
        simulate([replace(runs[1], robot=ROBOTS["caiman"], gait=GAITS["belly_crawl"]), runs[1]], duration=0.5)
    with pytest.raises(InvalidDesign, match=r"it must divide the control period of 0.005 s"):
        crawl(ROBOTS["salamander"], GAITS["salamander_walk"], duration=0.5, timestep=0.002)


def test_a_path_out_of_reach_names_the_limb():
    gait = GAITS["salamander_walk"]
    far = replace(gait, limbs=(replace(gait.limbs[0], outward=1.0), gait.limbs[1]))
    with pytest.raises(OutsideLimits, match=r"asks LF of robot 'salamander' for a foot path outside its reach"):
        crawl(ROBOTS["salamander"], far, duration=0.5)

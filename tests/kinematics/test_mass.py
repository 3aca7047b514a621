from dataclasses import replace

import mujoco
import numpy as np
import pytest
from tests.bodies import eight, six

import suchus
from suchus.core.errors import InvalidDesign
from suchus.robot.design import crocodile, joint_names, layout
from suchus.robot.kinematics import tree
from suchus.robot.motion.rising import cantilever_torque
from suchus.sim.model import compile_model, joint_addresses

CAIMAN = suchus.ROBOTS["caiman"]
LONG = crocodile(
    replace(
        CAIMAN.tables,
        name="long",
        spine=replace(CAIMAN.tables.spine, link=0.08, link_mass=0.3),
        tail=replace(CAIMAN.tables.tail, joints=9, fin_segments=2, mass=0.8),
        front_leg=replace(CAIMAN.tables.front_leg, mass=0.4),
    )
)

BODIES = [CAIMAN, LONG, suchus.ROBOTS["floating_caiman"], suchus.ROBOTS["salamandra"], eight()]


def in_mujoco(robot, angles):
    """Return the centre of mass that MuJoCo finds, in the frame of the pelvis [m]."""
    model = compile_model(robot)
    data = mujoco.MjData(model)
    data.qpos[joint_addresses(model, joint_names(robot))] = angles
    mujoco.mj_fwdPosition(model, data)
    root = model.body(robot.root).id
    return (data.subtree_com[root] - data.xpos[root]) @ data.xmat[root].reshape(3, 3)


@pytest.mark.parametrize("robot", BODIES, ids=lambda robot: robot.name)
def test_the_centre_of_mass_is_mujocos(robot):
    rng = np.random.default_rng(3)
    angles = rng.uniform(-1.2, 1.2, (40, len(joint_names(robot))))
    found = tree.centre_of_mass(robot, angles)
    assert found == pytest.approx(np.array([in_mujoco(robot, a) for a in angles]), abs=1e-9)


@pytest.mark.parametrize("robot", BODIES, ids=lambda robot: robot.name)
def test_the_bodies_weigh_what_the_robot_weighs(robot):
    masses, moments = tree.body_masses(robot)
    assert masses.sum() == pytest.approx(robot.mass, rel=1e-12)
    assert len(masses) == len(moments) == len(layout(robot).bodies)


def test_a_straight_robot_balances_on_its_midline():
    assert tree.centre_of_mass(CAIMAN, np.zeros(len(joint_names(CAIMAN))))[1:] == pytest.approx([0.0, 0.0], abs=1e-15)


def test_the_cantilever_torque_is_the_static_servo_torque():
    """A pelvis screwed to a wall: what holds the level forebody is the torque that gravity puts on the joint."""
    model = compile_model(CAIMAN)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    gravity = data.qfrc_bias[model.joint("spine_pitch_1").dofadr[0]]
    assert cantilever_torque(CAIMAN) == pytest.approx(abs(gravity), rel=1e-6)
    longer = six()
    model = compile_model(longer)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    gravity = data.qfrc_bias[model.joint("spine_pitch_1").dofadr[0]]
    assert cantilever_torque(longer) == pytest.approx(abs(gravity), rel=1e-6)
    light = crocodile(replace(CAIMAN.tables, head=replace(CAIMAN.tables.head, mass=0.02)))
    arm = 0.5 * (CAIMAN.thorax.shoulder + CAIMAN.head.snout) + 3 * CAIMAN.spine.link
    drop = cantilever_torque(CAIMAN) - cantilever_torque(light)
    assert drop == pytest.approx(0.20 * 9.81 * arm, rel=1e-9)


def test_a_wrong_number_of_angles_is_refused():
    with pytest.raises(InvalidDesign, match=r"caiman, .* the shape \(19,\); 30 numbers"):
        tree.centre_of_mass(CAIMAN, np.zeros(19))

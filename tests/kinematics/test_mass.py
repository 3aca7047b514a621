from dataclasses import replace

import mujoco
import numpy as np
import pytest

import suchus
from suchus.design import crocodile, joint_names
from suchus.errors import InvalidDesign
from suchus.kinematics import mass
from suchus.model import compile_model, joint_addresses

CAIMAN = suchus.ROBOTS["caiman"]
LONG = crocodile(
    replace(
        CAIMAN.tables,
        spine=replace(CAIMAN.tables.spine, link=0.08, link_mass=0.3),
        tail=replace(CAIMAN.tables.tail, joints=9, fin_segments=2, mass=0.8),
        front_leg=replace(CAIMAN.tables.front_leg, mass=0.4),
    )
)


def in_mujoco(robot, angles):
    """Return the centre of mass that MuJoCo finds, in the frame of the pelvis [m]."""
    model = compile_model(robot)
    data = mujoco.MjData(model)
    data.qpos[joint_addresses(model, joint_names(robot))] = angles
    mujoco.mj_fwdPosition(model, data)
    pelvis = model.body("pelvis").id
    return (data.subtree_com[pelvis] - data.xpos[pelvis]) @ data.xmat[pelvis].reshape(3, 3)


@pytest.mark.parametrize("robot", [CAIMAN, LONG], ids=["caiman", "long"])
def test_the_centre_of_mass_is_mujocos(robot):
    rng = np.random.default_rng(3)
    angles = rng.uniform(-1.2, 1.2, (40, len(joint_names(robot))))
    found = mass.centre_of_mass(robot, angles)
    assert found == pytest.approx(np.array([in_mujoco(robot, a) for a in angles]), abs=1e-9)


@pytest.mark.parametrize("robot", [CAIMAN, LONG], ids=["caiman", "long"])
def test_the_pieces_weigh_what_the_robot_weighs(robot):
    found = mass.pieces(robot, np.zeros(len(joint_names(robot))))
    assert found.masses.sum() == pytest.approx(robot.mass, rel=1e-12)
    assert len(found.masses) == found.centres.shape[-2]


def test_a_straight_robot_balances_on_its_midline():
    assert mass.centre_of_mass(CAIMAN, np.zeros(len(joint_names(CAIMAN))))[1:] == pytest.approx([0.0, 0.0], abs=1e-15)


def test_the_cantilever_torque_is_the_static_servo_torque():
    """A pelvis screwed to a wall: what holds the level forebody is the torque that gravity puts on the joint."""
    model = compile_model(CAIMAN)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    gravity = data.qfrc_bias[model.joint("spine_pitch_1").dofadr[0]]
    assert mass.cantilever_torque(CAIMAN) == pytest.approx(abs(gravity), rel=1e-6)
    light = crocodile(replace(CAIMAN.tables, head=replace(CAIMAN.tables.head, mass=0.02)))
    arm = 0.5 * (CAIMAN.thorax.shoulder + CAIMAN.head.snout) + 3 * CAIMAN.spine.link
    drop = mass.cantilever_torque(CAIMAN) - mass.cantilever_torque(light)
    assert drop == pytest.approx(0.20 * 9.81 * arm, rel=1e-9)


def test_a_wrong_number_of_angles_is_refused():
    with pytest.raises(InvalidDesign, match=r"caiman, .* the shape \(19,\); 30 numbers"):
        mass.pieces(CAIMAN, np.zeros(19))

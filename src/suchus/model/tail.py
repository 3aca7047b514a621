"""The tail as bodies: pitch joint, cable joints with springs, passive end, and the cable as a fixed tendon."""

from typing import Any

import mujoco

from suchus.design import Crocodile, Tail, cable_joints
from suchus.kinematics.mass import tail_segments
from suchus.model.surface import skin
from suchus.model.trunk import hinge

CABLE = "tail_cable"


def add_tail(spec: Any, pelvis: Any, robot: Crocodile) -> None:
    """Hang the tail on the pelvis and lay its cable."""
    tail, contact = robot.tail, robot.contact
    lengths, radii, masses = tail_segments(tail)
    body = pelvis.add_body(name="tail_root", pos=[-tail.offset, 0, 0])
    hinge(body, "tail_pitch", [0, -1, 0], tail.pitch_range, tail.pitch_servo)
    for i, (length, radius, mass) in enumerate(zip(lengths, radii, masses, strict=True)):
        if i > 0:
            body = body.add_body(name=f"tail_{i}", pos=[-lengths[i - 1], 0, 0])
            if i <= tail.joints:
                _cable_joint(body, f"tail_yaw_{i}", tail)
            else:
                _fin_joints(body, i - tail.joints, tail)
        skin(body, body.name, [0, 0, 0], [-length, 0, 0], radius, mass, contact)
    body.add_site(name="tail_tip", pos=[-lengths[-1], 0, 0], size=[0.002, 0, 0])
    _lay_cable(spec, robot)


def _cable_joint(body: Any, name: str, tail: Tail) -> None:
    limit = 1.5 * tail.bend_limit / tail.joints  # a joint may bend more than its share before the plates touch
    body.add_joint(
        name=name,
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=[0, 0, 1],
        range=[-limit, limit],
        limited=mujoco.mjtLimited.mjLIMITED_TRUE,
        stiffness=tail.joint_stiffness,
        damping=tail.joint_damping,
        armature=tail.cable_servo.armature / tail.joints,
    )


def _fin_joints(body: Any, number: int, tail: Tail) -> None:
    softer = 1.0 - 0.5 * (number - 1) / max(tail.fin_segments - 1, 1)
    for axis, vector, stiffness in (
        ("yaw", [0, 0, 1], tail.fin_stiffness_lateral),
        ("pitch", [0, -1, 0], tail.fin_stiffness_vertical),
    ):
        body.add_joint(
            name=f"fin_{axis}_{number}",
            type=mujoco.mjtJoint.mjJNT_HINGE,
            axis=vector,
            range=[-1.2, 1.2],
            limited=mujoco.mjtLimited.mjLIMITED_TRUE,
            stiffness=softer * stiffness,
            damping=tail.fin_damping,
            armature=1e-4,
        )


def _lay_cable(spec: Any, robot: Crocodile) -> None:
    """Lay the cable: its length is the sum of the joint angles times half the cord spacing.

    That is the first order of the exact change in length, whose relative error is below 1.2 % up to 180 degrees.
    Paper: Eq. (17).
    """
    cable = spec.add_tendon(
        name=CABLE,
        frictionloss=robot.tail.cable_servo.friction / robot.tail.pulley,
        damping=robot.tail.cable_servo.damping / robot.tail.pulley**2,
    )
    for joint in cable_joints(robot):
        cable.wrap_joint(joint, robot.tail.cord_spacing / 2)

"""Pelvis, spine, thorax and head as bodies."""

from typing import Any

import mujoco

from suchus.design import Crocodile, Servo, spine_joints
from suchus.model.surface import shell, skin


def add_trunk(pelvis: Any, robot: Crocodile) -> Any:
    """Give the pelvis its shape and hang spine, thorax and head on it.

    Args:
        pelvis: the ``MjsBody`` whose origin is the hind girdle's axis on the midline.
        robot: the design.

    Returns:
        The ``MjsBody`` of the thorax, for the front legs.
    """
    spine, contact = robot.spine, robot.contact
    half = (robot.pelvis.length / 2, robot.pelvis.width / 2, robot.pelvis.height / 2)
    shell(pelvis, "pelvis", [0, 0, 0], half, robot.pelvis.mass, contact)
    pelvis.add_site(name="imu", size=[0.004, 0, 0])
    body, at = pelvis, spine.base
    for i, joint in enumerate(spine_joints()):
        last = i == 4
        body = body.add_body(name="thorax" if last else f"spine_{i + 1}", pos=[at, 0, 0])
        yaw = "yaw" in joint
        servo = spine.yaw_servo if yaw else spine.pitch_servo
        hinge(body, joint, [0, 0, 1] if yaw else [0, 1, 0], spine.yaw_range if yaw else spine.pitch_range, servo)
        if not last:
            skin(body, f"spine_{i + 1}", [0, 0, 0], [spine.link, 0, 0], spine.radius, spine.link_mass, contact)
        at = spine.link
    _add_thorax_and_head(body, robot)
    return body


def _add_thorax_and_head(body: Any, robot: Crocodile) -> None:
    thorax, head, contact = robot.thorax, robot.head, robot.contact
    half = (max(thorax.shoulder, 0.02) + 0.012, thorax.width / 2, thorax.height / 2)
    shell(body, "thorax", [thorax.shoulder / 2, 0, 0], half, thorax.mass, contact)
    length = head.snout - thorax.shoulder
    middle = head.snout - length / 2
    shell(body, "head", [middle, 0, 0], (length / 2, head.width / 2, head.height / 2), head.mass, contact)
    body.add_site(name="snout", pos=[head.snout, 0, 0], size=[0.002, 0, 0])


def hinge(body: Any, name: str, axis: list[float], limits: tuple[float, float], servo: Servo) -> None:
    """Add a hinge that a servo turns directly."""
    body.add_joint(
        name=name,
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=axis,
        range=list(limits),
        limited=mujoco.mjtLimited.mjLIMITED_TRUE,
        armature=servo.armature,
        frictionloss=servo.friction,
        damping=servo.damping,
    )

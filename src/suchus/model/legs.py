"""Legs as bodies: yaw, pitch and knee hinges whose frames follow the D-H base of the leg."""

from typing import Any

import mujoco

from suchus.design import Contact, Leg
from suchus.kinematics.mass import LEG_SHARES
from suchus.model.surface import skin, sole


def add_leg(girdle: Any, ahead: float, name: str, leg: Leg, contact: Contact) -> None:
    """Hang a leg on the body of a girdle (x forward, y left, z up).

    Args:
        girdle: the ``MjsBody`` of the girdle.
        ahead: from the body's origin forward to the girdle's axis [m].
        name: ``LF``, ``RF``, ``LH`` or ``RH``.
        leg: dimensions of the left leg; a right leg mirrors them.
        contact: friction of foot and skin.
    """
    side = 1.0 if name.startswith("L") else -1.0
    out = [0.0, side, 0.0]
    hip = girdle.add_body(name=f"{name}_femur", pos=[ahead, side * leg.hip_offset, 0.0])
    _hinge(hip, f"{name}_yaw", [0.0, 0.0, -side], leg.yaw_range, leg)
    _hinge(hip, f"{name}_pitch", [-side, 0.0, 0.0], leg.pitch_range, leg)
    skin(
        hip,
        f"{name}_femur",
        [0, 0, 0],
        [x * leg.femur for x in out],
        leg.radius,
        LEG_SHARES[0] * leg.mass,
        contact,
    )
    shank = hip.add_body(name=f"{name}_tibia", pos=[x * leg.femur for x in out])
    _hinge(shank, f"{name}_knee", [-side, 0.0, 0.0], leg.knee_range, leg)
    end = [x * leg.tibia for x in out]
    skin(shank, f"{name}_tibia", [0, 0, 0], end, 0.8 * leg.radius, LEG_SHARES[1] * leg.mass, contact)
    sole(shank, f"{name}_foot", end, leg.foot_radius, LEG_SHARES[2] * leg.mass, contact)
    shank.add_site(name=f"{name}_foot", pos=end, size=[0.002, 0, 0])


def _hinge(body: Any, name: str, axis: list[float], limits: tuple[float, float], leg: Leg) -> None:
    body.add_joint(
        name=name,
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=axis,
        range=list(limits),
        limited=mujoco.mjtLimited.mjLIMITED_TRUE,
        armature=leg.servo.armature,
        frictionloss=leg.servo.friction,
        damping=leg.servo.damping,
    )

"""The course from lying to standing on hind legs and tail, in six postures, and how high any posture could reach."""

from dataclasses import replace
from math import radians

import numpy as np
from jaxtyping import Float

from suchus.article.paper import LIMB_REACH
from suchus.robot.design import GRAVITY, Robot, layout
from suchus.robot.kinematics.tree import body_masses, frames, landmarks
from suchus.robot.motion.posture import (
    Keyed,
    Posture,
    belly,
    centre_of_mass_forward_of_hips,
    centre_of_mass_from_hips,
    hind_leg,
    tail_down,
    trunk_angles,
    upright,
)

PELVIS_PITCH = radians(80)
"""Pitch of the pelvis when standing [rad]; it settles at 85 degrees, where the tail's joint reaches the end of its
range."""
TRUNK_FIRST, TRUNK_SECOND = radians(6), radians(3)
"""Angles of the trunk's pitch joints when standing [rad]; the trunk then points straight up."""
LEAD = 0.05
"""Where the centre of mass is commanded behind the feet when the article's robot stands [m].

The servos give way under the load and the tail pushes, so that it settles at 0.08 m. With 0.02 m the robot stands
5 mm higher and falls at less than half the push; with zero it does not stay up.
"""
STRETCH = 0.937
"""Height of the hips over the feet when standing, as a share of the hind leg [-]; a straight knee cannot push."""
_STANCE = 0.03  # [m] outside the hips, of the article's robot; farther apart the feet reach less far ahead
_LEG = LIMB_REACH  # [m]; the hind leg for which the lengths of this module were chosen
_NOT_QUITE = 0.99  # of the leg's length: a straight knee has no strength
_ARMS_LYING = {"arm_yaw": 0.0, "arm_pitch": -0.1, "arm_knee": 0.5}  # spread, so that the shoulders come down
_ARMS_RAISED = {"arm_yaw": 0.2, "arm_pitch": -0.3, "arm_knee": 1.2}  # off the ground and near the trunk


def size_of(robot: Robot) -> float:
    """Return the length of a robot's hind leg over that of the article's, by which lengths of postures scale [-]."""
    return upright(robot).leg.reach[1] / _LEG


def stand_up(
    robot: Robot,
    *,
    lead: float | None = None,
    slower: float = 1.0,
    size: float | None = None,
) -> Keyed:
    """Return the course of rising of a robot, beginning on the ground and ending on hind legs and tail.

    1. It lies on its belly. 2. The hind feet swing ahead, past the centre of mass. 3. They take the load.
    4. The trunk bends up like a cobra's while the pelvis stays low: now the centre of mass is well behind the feet.
    5. and 6. The pelvis pitches up and the hips rise over the feet while the trunk straightens.

    Heights follow the hind legs; where the hips are follows from the centre of mass.

    Args:
        robot: robot that stands up.
        lead: where the centre of mass is commanded behind the feet when standing [m]; ``LEAD`` in its size if None.
        slower: factor on all times [-].
        size: factor on clearances and on how far apart the feet stand, 1 for the article's [-]; ``size_of`` if None.

    Raises:
        UnsuitedRobot: it lacks something of ``design.STANDING``.
    """
    leg, size = upright(robot).leg, size_of(robot) if size is None else size
    length = leg.femur + leg.tibia
    ground = belly(robot) + 0.002 * size
    lying = {"pelvis_pitch": 0.0, "trunk_first": 0.0, "trunk_second": 0.0, **_ARMS_LYING}
    relaxed = {"hip_height": ground, "tail_press": -0.02 * size, **lying}
    stance, press = _STANCE * size, 0.02 * size
    level = Posture(hip_height=ground + 0.021 * size, lead=0.0, stance=stance, lift=0.0, tail_press=0.0, **lying)
    bent_posture = replace(level, trunk_first=radians(50), trunk_second=radians(40), tail_press=press, **_ARMS_RAISED)
    feet_forward = _feet_ahead(robot, level)
    lead_level, lead_bent = (
        feet_forward - centre_of_mass_forward_of_hips(robot, posture, feet_forward) for posture in (level, bent_posture)
    )
    raised_fields = {"stance": stance, "lift": 0.0, **_ARMS_RAISED}
    postures = (
        Posture(lead=-0.57 * length, stance=2 * stance, lift=0.0, **relaxed),
        Posture(lead=lead_level, stance=stance, lift=press, **relaxed),
        replace(level, lead=lead_level),
        replace(bent_posture, lead=lead_bent),
        Posture(
            hip_height=leg.foot_radius + 0.55 * length,
            pelvis_pitch=radians(45),
            lead=0.34 * length,
            trunk_first=radians(30),
            trunk_second=radians(20),
            tail_press=press,
            **raised_fields,
        ),
        Posture(
            hip_height=leg.foot_radius + STRETCH * length,
            pelvis_pitch=PELVIS_PITCH,
            lead=LEAD * size if lead is None else lead,
            trunk_first=TRUNK_FIRST,
            trunk_second=TRUNK_SECOND,
            tail_press=press / 2,
            **raised_fields,
        ),
    )
    times = tuple(slower * t for t in (0.0, 1.0, 1.5, 3.5, 5.0, 7.5))
    return Keyed(name="stand_up", times=times, postures=postures)


def _feet_ahead(robot: Robot, level: Posture) -> float:
    """Return how far ahead of its hips a lying robot sets its hind feet [m].

    That is 0.17 of the leg's length, the caiman's 30 mm, past the centre of mass, or as far as the legs reach if the
    forebody is too heavy.
    """
    leg = upright(robot).leg
    length = leg.femur + leg.tibia
    down = level.hip_height - leg.foot_radius
    max_forward = np.sqrt((_NOT_QUITE * length) ** 2 - down**2 - level.stance**2)
    return float(min(centre_of_mass_forward_of_hips(robot, level, max_forward) + 0.17 * length, max_forward))


def stretched_length(robot: Robot) -> float:
    """Return the length of hind leg, trunk and head in a straight line [m], an upper bound of the snout's height."""
    chains, straight = upright(robot), np.zeros(len(layout(robot).hinges))
    snout_forward = float(landmarks(robot, straight).snout[0]) - chains.hips[0]
    return chains.leg.femur + chains.leg.tibia + snout_forward


def cantilever_torque(robot: Robot) -> float:
    """Return the torque of the first pitch joint that lifts the level forebody off the ground [N m].

    The limbs ahead of it hang out sideways, so that their weight acts at the shoulders.
    """
    straight, (masses, moments) = frames(robot, np.zeros(len(layout(robot).hinges))), body_masses(robot)
    hinge = layout(robot).hinges[upright(robot).trunk[0]]
    bodies = layout(robot).bodies
    joint = next(i for i, body in enumerate(bodies) if any(name == hinge for _, name, _ in body.hinges))
    forward = straight.positions[:, 0] - straight.positions[joint, 0]
    is_lifted = forward + moments[:, 0] / masses > 0.0
    return float(GRAVITY * np.sum((masses * forward + moments[:, 0])[is_lifted]))


def max_snout_height(robot: Robot, lead: Float[np.ndarray, "*batch"]) -> Float[np.ndarray, "*batch"]:
    """Return how high the snout can be while the centre of mass lies ``lead`` behind the feet [m].

    Joint ranges and the length of the legs hold; torques, droop and the last millimetre of a straight knee do not
    count. Found on a grid of 2 degrees for the pelvis and 5 degrees for the trunk's joints.

    Args:
        robot: the design.
        lead: how far the centre of mass lies behind the feet [m].
    """
    chains = upright(robot)
    leg, stance = chains.leg, _STANCE * size_of(robot)
    pitch, first_angles, second_angles = (
        g.ravel()
        for g in np.meshgrid(*(np.radians(np.arange(a, b, c)) for a, b, c in ((46, 91, 2), (-15, 46, 5), (-15, 46, 5))))
    )
    angles = np.zeros((len(pitch), len(layout(robot).hinges)))
    for arm in chains.arms:
        for hinge, name in zip(arm, ("arm_yaw", "arm_pitch", "arm_knee"), strict=False):
            angles[:, hinge] = _ARMS_RAISED[name]
    angles[:, list(chains.trunk)] = trunk_angles(chains, first_angles, second_angles)
    s, c = np.sin(pitch), np.cos(pitch)
    heights = []
    for shift in np.ravel(lead):
        feet_forward, down = np.full(len(pitch), shift), np.full(len(pitch), 0.9 * leg.reach[1])
        for _ in range(4):  # the legs' own weight moves the centre of mass a little
            feet = np.stack([np.full(len(pitch), stance), feet_forward, down], axis=-1)
            leg_angles = hind_leg(leg, feet, pitch, clip=True)
            for hinges in chains.standing:
                angles[:, hinges] = leg_angles
            angles[:, chains.tail] = tail_down(chains, down + leg.foot_radius, pitch, 0.0)
            com = centre_of_mass_from_hips(robot, angles)
            feet_forward = c * com[:, 0] - s * com[:, 2] + shift
            down = np.sqrt(np.maximum(leg.reach[1] ** 2 - feet_forward**2 - stance**2, 0.0))
        snout, root = landmarks(robot, angles).snout - np.array(chains.hips), angles[:, chains.tail]
        fits = (root >= chains.tail_range[0]) & (root <= chains.tail_range[1]) & (down > 0)
        height = down + leg.foot_radius + s * snout[:, 0] + c * snout[:, 2]
        heights.append(float(np.max(np.where(fits, height, 0.0))))
    return np.reshape(np.array(heights), np.shape(lead))

"""Ankles, for the eye only: the robot has none, but a foot that stands looks wrong with its toes in the ground.

Each foot gets a bone of its own at the centre of its ball. It turns the sole down where the foot is near the ground,
as far as an ankle can, and follows the shank in the air. The ball that touches stays where it is.
"""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from suchus.core.rotation import from_axis_angle, multiply, rotate
from suchus.robot.design import LEGS, Robot
from suchus.robot.design.ground import Relief, heights
from suchus.visual.skin.bones import Poses, bone_names
from suchus.visual.skin.surface import Skin, skin

ANKLES = tuple(f"{leg}_ankle" for leg in LEGS)
"""Names of the bones, which come after those of the bodies."""
REACH = 0.9
"""Greatest angle of an ankle [rad], about that of a crocodile's high walk."""
FLAT_FOOT_HEIGHTS = (0.012, 0.06)
"""Heights of the ball over the ground between which a foot ceases to lie flat [m]."""


@lru_cache(maxsize=8)
def skin_with_ankles(robot: Robot) -> Skin:
    """Return the skin of a robot with its feet hung on ankles; the round feet of a plain body have none."""
    surface = skin(robot)
    if surface.plain:
        return surface
    indices, origins = surface.indices.copy(), [*surface.rest_origins]
    starts = np.flatnonzero(np.diff(surface.part_index, prepend=-1))
    min_weights = np.minimum.reduceat(surface.weights[:, 0], starts)
    for i, leg in enumerate(LEGS):
        bone = surface.bones.index(f"{leg}_tibia")
        is_foot_part = (np.maximum.reduceat(surface.indices[:, 0], starts) == bone) & (min_weights > 0.999)
        is_foot_part &= np.minimum.reduceat(surface.indices[:, 0], starts) == bone  # palm, toes and claws, not the limb
        indices[is_foot_part[surface.part_index]] = len(surface.bones) + i
        origins.append(surface.rest_origins[bone] + [0.0, _side(leg) * robot.leg(leg).tibia, 0.0])
    return replace(surface, bones=(*surface.bones, *ANKLES), rest_origins=np.array(origins), indices=indices)


def ankles(robot: Robot, bones: Poses, feet: np.ndarray, relief: Relief | None = None) -> Poses:
    """Return the bones of ``skin_with_ankles``: those of the bodies, and one more for each foot.

    Args:
        robot: the robot.
        bones: bones of the bodies, (frame, bone, ...).
        feet: centres of the feet, (frame, 4, 3) [m].
        relief: what stands up from the ground; None where it is even.
    """
    if skin(robot).plain:
        return bones
    names, ankle_quaternions = bone_names(robot), []
    foot_heights = feet[..., 2] - heights(relief, feet[..., 0], feet[..., 1])
    for i, leg in enumerate(LEGS):
        shank = bones.quaternions[:, names.index(f"{leg}_tibia")]
        shank_axis = rotate(shank, np.array([0.0, _side(leg), 0.0]))
        flat = np.clip(
            (FLAT_FOOT_HEIGHTS[1] - (foot_heights[:, i] - robot.leg(leg).foot_radius))
            / (FLAT_FOOT_HEIGHTS[1] - FLAT_FOOT_HEIGHTS[0]),
            0.0,
            1.0,
        )
        ankle_quaternions.append(multiply(_downward(shank_axis, flat * flat * (3 - 2 * flat)), shank))
    return Poses(
        np.concatenate([bones.positions, feet], axis=1),
        np.concatenate([bones.quaternions, np.stack(ankle_quaternions, axis=1)], axis=1),
    )


def _side(leg: str) -> float:
    return 1.0 if leg.startswith("L") else -1.0


def _downward(direction: np.ndarray, fraction: np.ndarray) -> np.ndarray:
    """Return the smallest turns that bring directions to -z, by a share and no farther than ``REACH``: (frame, 4)."""
    axis = np.cross(direction, [0.0, 0.0, -1.0])
    sine = np.linalg.norm(axis, axis=-1, keepdims=True)
    angle = np.minimum(np.arctan2(sine[:, 0], -direction[:, 2]), REACH) * fraction
    axis = np.divide(axis, sine, out=np.zeros_like(axis), where=sine > 1e-9)
    return from_axis_angle(axis, angle)

"""Ankles, for the eye only: the robot has none, but a foot that stands looks wrong with its toes in the ground.

Each foot gets a bone of its own at the centre of its ball. It turns the sole down where the foot is near the ground,
as far as an ankle can, and follows the shank in the air. The ball that touches stays where it is.
"""

import numpy as np

from suchus.design import LEGS, Crocodile
from suchus.skin import Poses, Skin
from suchus.skin.bones import multiply, rotate

REACH = 0.9
"""How far an ankle turns [rad]; a crocodile's turns about as far in the step of a high walk."""
NEAR = (0.012, 0.06)
"""Heights of the ball over the ground between which a foot ceases to lie flat [m]."""


def ankles(robot: Crocodile, surface: Skin, bones: Poses, feet: np.ndarray) -> Poses:
    """Return the bones with one more for each foot, in the order of ``LEGS``.

    Args:
        robot: the robot.
        surface: its skin.
        bones: (frame, bone, ...).
        feet: centres of the feet, (frame, 4, 3) [m].
    """
    turned = []
    for i, leg in enumerate(LEGS):
        shank = bones.quaternions[:, surface.bones.index(f"{leg}_tibia")]
        out = rotate(shank, np.array([0.0, 1.0 if leg.startswith("L") else -1.0, 0.0]))
        height = feet[:, i, 2] - robot.leg(leg).foot_radius
        flat = np.clip((NEAR[1] - height) / (NEAR[1] - NEAR[0]), 0.0, 1.0)
        turned.append(multiply(_downward(out, flat * flat * (3 - 2 * flat)), shank))
    return Poses(
        np.concatenate([bones.positions, feet], axis=1),
        np.concatenate([bones.quaternions, np.stack(turned, axis=1)], axis=1),
    )


def footed(robot: Crocodile, surface: Skin) -> tuple[np.ndarray, np.ndarray]:
    """Return which bones each vertex hangs on and the origins of the bones, with the ankles: (n, 2), (bone, 3) [m]."""
    indices, rest = surface.indices[:, :2].copy(), [*surface.rest]
    starts = np.flatnonzero(np.diff(surface.part, prepend=-1))
    least = np.minimum.reduceat(surface.weights[:, 0], starts)
    for i, leg in enumerate(LEGS):
        bone = surface.bones.index(f"{leg}_tibia")
        side = 1.0 if leg.startswith("L") else -1.0
        own = (np.maximum.reduceat(surface.indices[:, 0], starts) == bone) & (least > 0.999)
        own &= np.minimum.reduceat(surface.indices[:, 0], starts) == bone  # palm, toes and claws, not the limb
        indices[own[surface.part]] = len(surface.bones) + i
        rest.append(surface.rest[bone] + [0.0, side * robot.leg(leg).tibia, 0.0])
    return indices, np.array(rest)


def _downward(way: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Return the smallest turns that bring directions to -z, by a share and no farther than ``REACH``: (frame, 4)."""
    axis = np.cross(way, [0.0, 0.0, -1.0])
    sine = np.linalg.norm(axis, axis=-1, keepdims=True)
    angle = np.minimum(np.arctan2(sine[:, 0], -way[:, 2]), REACH) * share
    axis = np.divide(axis, sine, out=np.zeros_like(axis), where=sine > 1e-9)
    return np.concatenate([np.cos(angle / 2)[:, None], np.sin(angle / 2)[:, None] * axis], axis=-1)

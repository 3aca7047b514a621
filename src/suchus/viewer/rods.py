"""Rods and arrows from one point to another, as skinned meshes.

A browser moves the bones of a mesh at once, while a line or an arrow of viser's is built anew at every change.
"""

from dataclasses import dataclass
from math import sqrt
from typing import Any

import numpy as np

_SIDES = 12  # of a rod's section


@dataclass(frozen=True, slots=True)
class RodShape:
    """How thick a rod is, and whether it ends in a head."""

    radius: float
    """Radius of the shaft [m]."""
    head: float = 0.0
    """Length of the head [m]; 0 for a plain rod."""
    head_radius: float = 0.0
    """Radius of the head [m]."""


def rod(shape: RodShape) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return vertices [m], faces and weights of a rod from 0 to 1 along z; its two bones are its ends.

    Args:
        shape: of the rod.
    """
    turn = 2 * np.pi * np.arange(_SIDES) / _SIDES
    ring = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(_SIDES)])
    up = np.array([0.0, 0.0, 1.0])
    rings = [shape.radius * ring, shape.radius * ring + (1.0 - 0.9 * shape.head) * up]
    if shape.head > 0.0:
        rings += [shape.head_radius * ring + (1.0 - shape.head) * up]
    vertices = np.concatenate([*rings, [0.0 * up], [up], [(1.0 - shape.head) * up]])
    bottom, top, collar = len(vertices) - 3, len(vertices) - 2, len(vertices) - 1
    i = np.arange(_SIDES)
    j = (i + 1) % _SIDES
    last = 2 * _SIDES if shape.head > 0.0 else _SIDES
    faces = [
        np.column_stack([i, j, _SIDES + j]),
        np.column_stack([i, _SIDES + j, _SIDES + i]),
        np.column_stack([j, i, np.full(_SIDES, bottom)]),
        np.column_stack([last + i, last + j, np.full(_SIDES, top)]),
    ]
    if shape.head > 0.0:
        faces.append(np.column_stack([last + j, last + i, np.full(_SIDES, collar)]))
    weights = np.zeros((len(vertices), 2))
    near = np.r_[0:_SIDES, bottom]
    weights[:, 1] = 1.0
    weights[near] = (1.0, 0.0)
    return vertices, np.concatenate(faces), weights


def upright(direction: np.ndarray) -> np.ndarray:
    """Return the orientation wxyz that turns +z into a direction, a unit vector."""
    x, y, z = direction
    if z < -1.0 + 1e-9:
        return np.array([0.0, 1.0, 0.0, 0.0])
    w = sqrt((1.0 + z) / 2)
    return np.array([w, -y / (2 * w), x / (2 * w), 0.0])


class DrawnRod:
    """A rod in the scene of one browser, not seen until it is put somewhere.

    Args:
        scene: viser's scene of that browser.
        name: of its node.
        shape: how thick.
        colour: red, green, blue of 255.
    """

    def __init__(self, scene: Any, name: str, shape: RodShape, colour: tuple[int, int, int]) -> None:
        vertices, faces, weights = rod(shape)
        self._handle = scene.add_mesh_skinned(
            name,
            vertices,
            faces,
            bone_wxyzs=np.tile([1.0, 0.0, 0.0, 0.0], (2, 1)),
            bone_positions=np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]),
            skin_weights=weights,
            color=colour,
            visible=False,
            cast_shadow=False,
            receive_shadow=False,
        )

    def put(self, start: np.ndarray, end: np.ndarray) -> None:
        """Show it from one point to another [m]."""
        along = np.asarray(end, dtype=float) - start
        length = float(np.linalg.norm(along))
        if length < 1e-6:
            self.hide()
            return
        turned = upright(along / length)
        self._handle.visible = True
        for bone, place in zip(self._handle.bones, (start, end), strict=True):
            bone.position, bone.wxyz = place, turned

    def hide(self) -> None:
        """Show it no longer."""
        self._handle.visible = False

"""The shapes of a loaded model as suchus has them: rods with round ends and ellipsoids."""

from dataclasses import dataclass
from math import pi
from typing import Any

import mujoco
import numpy as np

_NEAR = 1e-6  # of a rod's size; a ball so near to its end is its round end


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShapePiece:
    """A rod, or an ellipsoid whose half axes are those of the frame; a ball has equal ones."""

    ends: np.ndarray
    """Middles of a rod's ends, shape (2, 3), or the centre of an ellipsoid, shape (1, 3) [m]."""
    half: np.ndarray
    """Radius of a rod three times, or half length, width and height, shape (3,) [m]."""

    @property
    def ball(self) -> bool:
        """Whether it is a ball."""
        return len(self.ends) == 1 and bool(np.ptp(self.half) <= 1e-9 * self.half.max())

    @property
    def centre(self) -> np.ndarray:
        """Its middle, shape (3,) [m]."""
        return np.asarray(self.ends.mean(axis=0))

    @property
    def volume(self) -> float:
        """[m3]."""
        round_ends = 4.0 / 3.0 * pi * float(np.prod(self.half))
        length = float(np.linalg.norm(self.ends[-1] - self.ends[0]))
        return round_ends + pi * float(self.half[0]) ** 2 * length

    @property
    def corners(self) -> np.ndarray:
        """Corners of the boxes around its ends, shape (n, 3) [m]."""
        signs = np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T
        return np.concatenate([end + signs * self.half for end in self.ends])


def of_body(model: Any, data: Any, body: int) -> tuple[ShapePiece, ...]:
    """Return the shapes of a body, those that touch others if there are any; a rod's round ends are its own."""
    first, count = int(model.body_geomadr[body]), int(model.body_geomnum[body])
    geoms = list(range(first, first + count))
    touching = [g for g in geoms if model.geom_contype[g] or model.geom_conaffinity[g]]
    kinds = mujoco.mjtGeom
    plain = (int(kinds.mjGEOM_PLANE), int(kinds.mjGEOM_HFIELD))
    used = [g for g in touching or geoms if model.geom_type[g] not in plain]
    pieces = [_piece(model, data, g) for g in used]
    rods = [
        _shortened(piece, pieces) if model.geom_type[g] == int(kinds.mjGEOM_CYLINDER) else piece
        for g, piece in zip(used, pieces, strict=True)
        if len(piece.ends) == 2
    ]
    return (*rods, *(piece for piece in pieces if len(piece.ends) == 1 and not _is_cap(piece, rods)))


def _piece(model: Any, data: Any, geom: int) -> ShapePiece:
    place, turn = data.geom_xpos[geom], data.geom_xmat[geom].reshape(3, 3)
    size, kind = model.geom_size[geom], mujoco.mjtGeom(int(model.geom_type[geom]))
    kinds = mujoco.mjtGeom
    if kind in (kinds.mjGEOM_CAPSULE, kinds.mjGEOM_CYLINDER) and size[1] > size[0]:
        along = size[1] * turn[:, 2]
        return ShapePiece(ends=np.array([place - along, place + along]), half=np.full(3, size[0]))
    if kind == kinds.mjGEOM_SPHERE:
        return ShapePiece(ends=place[None].copy(), half=np.full(3, size[0]))
    if kind == kinds.mjGEOM_ELLIPSOID:
        return ShapePiece(ends=place[None].copy(), half=np.sqrt((turn * size) ** 2 @ np.ones(3)))
    middle, half = model.geom_aabb[geom, :3], model.geom_aabb[geom, 3:]
    return ShapePiece(ends=(place + turn @ middle)[None], half=np.maximum(np.abs(turn) @ half, 1e-5))


def _shortened(rod: ShapePiece, pieces: list[ShapePiece]) -> ShapePiece:
    """Return a cylinder as a rod whose round ends stay inside it; one that ends in balls is a rod already."""
    if sum(_is_cap(piece, [rod]) for piece in pieces) >= 2:
        return rod
    length = float(np.linalg.norm(rod.ends[1] - rod.ends[0]))
    inward = (rod.ends[1] - rod.ends[0]) * min(rod.half[0] / length, 0.45)
    return ShapePiece(ends=np.array([rod.ends[0] + inward, rod.ends[1] - inward]), half=rod.half)


def _is_cap(ball: ShapePiece, rods: list[ShapePiece]) -> bool:
    """Return whether a ball is the round end of a rod."""
    return ball.ball and any(
        bool(ball.half[0] <= rod.half[0] * (1 + 1e-9))
        and bool(np.linalg.norm(rod.ends - ball.centre, axis=1).min() <= _NEAR * max(rod.half[0], 1e-9))
        for rod in rods
    )

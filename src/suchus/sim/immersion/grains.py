"""The surfaces of a model's geoms as small plates, on which grains act in MuJoCo's own step."""

from collections.abc import Sequence
from math import ceil, pi
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float
from numpy.polynomial.legendre import leggauss

from suchus.core.errors import InvalidDesign
from suchus.core.plate_table import pack_plates, user_numbers
from suchus.sim.immersion import wetting
from suchus.sim.immersion.attachment import GRAINS_ON_PLATES, attach_table
from suchus.sim.immersion.door import with_full_matrix

_AROUND = 12
"""Plates around a geom [-]."""
_BELTS = 3
"""Belts of plates from a pole of a ball or ellipsoid to its equator [-]."""
_SPHERE, _CAPSULE, _ELLIPSOID = (
    int(mujoco.mjtGeom.mjGEOM_SPHERE),
    int(mujoco.mjtGeom.mjGEOM_CAPSULE),
    int(mujoco.mjtGeom.mjGEOM_ELLIPSOID),
)


def grained_geoms(model: Any) -> tuple[int, ...]:
    """Return the geoms on which grains act: those of bodies that can move, where they collide.

    Args:
        model: a ``mujoco.MjModel``.
    """
    return tuple(
        g
        for g in range(model.ngeom)
        if model.body_weldid[model.geom_bodyid[g]] != 0 and (model.geom_contype[g] or model.geom_conaffinity[g])
    )


def attach_grains(spec: Any, strength: float, creep_speed: float) -> None:
    """Let grains with a level surface at height 0 resist the geoms of a ``mujoco.MjSpec``; z is up.

    Do it after all other edits: the table knows bodies by number. Plates that lie within another geom in the posture
    of the specification are left out, since no grains touch them.

    Args:
        spec: MuJoCo specification of any bodies.
        strength: vertical stress over depth on a level plate that moves down [N/m3].
        creep_speed: speed far below which the grains resist in proportion to it [m/s].

    Raises:
        InvalidDesign: MuJoCo cannot compile it, or a geom is neither ball, capsule nor ellipsoid.
    """
    wetting.install(GRAINS_ON_PLATES)
    model = with_full_matrix(spec)
    geoms = grained_geoms(model)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    surfaces = [_exposed(model, data, geom, geoms) for geom in geoms]
    numbers = pack_plates(model.geom_bodyid[list(geoms)].astype(float), surfaces, strength, creep_speed)
    attach_table(spec, numbers, user_numbers(len(geoms)), GRAINS_ON_PLATES)


def plates_of(kind: int, size: Sequence[float]) -> Float[np.ndarray, "plate 7"]:
    """Return the plates of a geom in its own frame: centres [m], outward normals, areas [m2].

    Each stands for a patch of the surface. The projected area of the leading plates is that of the geom within 3 % in
    any direction, and exactly along its own axes.

    Args:
        kind: MuJoCo's type of the geom: ball, capsule or ellipsoid.
        size: its sizes, as MuJoCo has them [m].
    """
    nodes, weights = leggauss(_BELTS)  # of each half for itself, since only one half leads
    heights, weights = np.concatenate([nodes - 1.0, nodes + 1.0]) / 2.0, np.tile(weights, 2) / 2.0
    azimuths = (np.arange(_AROUND) + 0.5) * 2.0 * pi / _AROUND
    circle = np.column_stack([np.cos(azimuths), np.sin(azimuths)])
    radii = np.sqrt(1.0 - heights**2)
    unit = np.concatenate(
        [np.column_stack([r * circle, np.full(_AROUND, z)]) for r, z in zip(radii, heights, strict=True)]
    )
    solid_angles = np.repeat(weights, _AROUND) * 2.0 * pi / _AROUND
    if kind == _CAPSULE:
        radius, half = float(size[0]), float(size[1])
        ends = unit * radius + np.column_stack([np.zeros((len(unit), 2)), np.copysign(half, unit[:, 2])])
        rings = max(1, ceil(half / radius))
        places = (2.0 * np.arange(rings) + 1.0 - rings) / rings * half
        side = np.concatenate([np.column_stack([radius * circle, np.full(_AROUND, z)]) for z in places])
        side_normals = np.tile(np.column_stack([circle, np.zeros(_AROUND)]), (rings, 1))
        side_area = 2.0 * pi * radius * 2.0 * half / (rings * _AROUND)
        return np.concatenate(
            [
                np.column_stack([ends, unit, solid_angles * radius**2]),
                np.column_stack([side, side_normals, np.full(len(side), side_area)]),
            ]
        )
    half_axes = np.full(3, size[0]) if kind == _SPHERE else np.asarray(size, float)[:3]
    directed = unit / half_axes * half_axes.prod()
    lengths = np.linalg.norm(directed, axis=1)
    return np.column_stack([unit * half_axes, directed / lengths[:, None], solid_angles * lengths])


def _exposed(model: Any, data: Any, geom: int, geoms: Sequence[int]) -> Float[np.ndarray, "plate 7"]:
    """Return the plates of a geom that lie in no other geom, in the frame of its body.

    Args:
        model: a ``mujoco.MjModel``.
        data: its ``mujoco.MjData``, with the geoms in place.
        geom: number of the geom.
        geoms: numbers of all geoms that count.
    """
    kind = int(model.geom_type[geom])
    if kind not in (_SPHERE, _CAPSULE, _ELLIPSOID):
        raise InvalidDesign(
            f"geom {model.geom(geom).name!r} is a {mujoco.mjtGeom(kind).name.removeprefix('mjGEOM_').lower()}, and "
            "grains act on spheres, capsules and ellipsoids: take one of these, or let the geom collide with nothing."
        )
    plates = plates_of(kind, model.geom_size[geom])
    turn, origin = data.geom_xmat[geom].reshape(3, 3), data.geom_xpos[geom]
    points, normals = plates[:, :3] @ turn.T + origin, plates[:, 3:6] @ turn.T
    is_exposed = np.ones(len(plates), dtype=bool)
    for other in geoms:
        if other != geom:
            is_exposed &= ~_is_inside(model, data, other, points)
    body = int(model.geom_bodyid[geom])
    body_turn, body_origin = data.xmat[body].reshape(3, 3), data.xpos[body]
    return np.column_stack([(points - body_origin) @ body_turn, normals @ body_turn, plates[:, 6]])[is_exposed]


def _is_inside(model: Any, data: Any, geom: int, points: Float[np.ndarray, "point 3"]) -> np.ndarray:
    """Return whether each point lies within a geom, shape (point,)."""
    local = (points - data.geom_xpos[geom]) @ data.geom_xmat[geom].reshape(3, 3)
    size = model.geom_size[geom]
    if model.geom_type[geom] == _ELLIPSOID:
        return np.asarray(((local / size) ** 2).sum(axis=1) < 1.0)
    half = size[1] if model.geom_type[geom] == _CAPSULE else 0.0
    local[:, 2] -= np.clip(local[:, 2], -half, half)
    return np.asarray((local**2).sum(axis=1) < size[0] ** 2)

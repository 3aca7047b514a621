"""The geoms of a MuJoCo model as a table of shapes."""

from collections.abc import Collection, Mapping
from math import pi
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float

from suchus.core.errors import InvalidDesign, UnknownName
from suchus.core.water_table import BALL, CAPSULE, CYLINDER, POLYHEDRON, SHAPE_COLUMNS, SHAPE_WIDTH
from suchus.sim.immersion.coefficients import BOX, GeomCoefficients, shape_coefficients
from suchus.sim.immersion.meshes import box_triangles, solid

_Geom = mujoco.mjtGeom
_SOLIDS = {
    int(_Geom.mjGEOM_SPHERE): "sphere",
    int(_Geom.mjGEOM_CAPSULE): "capsule",
    int(_Geom.mjGEOM_ELLIPSOID): "ellipsoid",
    int(_Geom.mjGEOM_CYLINDER): "cylinder",
    int(_Geom.mjGEOM_BOX): "box",
    int(_Geom.mjGEOM_MESH): "mesh",
}
_FLAT = 0.25
"""Thickness over width up to which a shape has faces that lift [-]."""


def wet_geoms(model: Any, coefficients: Mapping[str, GeomCoefficients], dry: Collection[str]) -> list[int]:
    """Return the geoms of a model on which water acts.

    They are on bodies that can move and have a volume. Where some geoms of a body collide the others are taken for
    pictures, unless ``coefficients`` names them.

    Args:
        model: a ``mujoco.MjModel``.
        coefficients: coefficients of geoms by their names.
        dry: names of geoms, or of bodies with all their geoms, on which no water acts.

    Raises:
        UnknownName: a name is of no geom or body.
        InvalidDesign: a geom that is named has no volume or cannot move, or no geom is left.
    """
    names = [model.geom(i).name for i in range(model.ngeom)]
    bodies = [model.body(i).name for i in range(model.nbody)]
    for name in coefficients:
        if name not in names or not name:
            raise UnknownName("geom", name, filter(None, names))
    for name in dry:
        if name not in (*names, *bodies) or not name:
            raise UnknownName("geom or body", name, filter(None, dict.fromkeys((*names, *bodies))))
    collides = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
    chosen = []
    for i, name in enumerate(names):
        body, kind = int(model.geom_bodyid[i]), int(model.geom_type[i])
        is_named = name in coefficients
        if is_named and kind not in _SOLIDS:
            word = _Geom(kind).name.removeprefix("mjGEOM_").lower()
            raise InvalidDesign(
                f"geom {name!r} is of type {word}, which has no volume; {', '.join(_SOLIDS.values())} are allowed: "
                "take it out of coefficients."
            )
        if model.body_weldid[body] == 0:
            if is_named:
                raise InvalidDesign(
                    f"geom {name!r} cannot move, so that no water moves it: take it out of coefficients."
                )
            continue
        is_picture = not collides[i] and bool(collides[model.geom_bodyid == body].any())
        is_dry = name in dry or bodies[body] in dry
        if kind in _SOLIDS and not is_dry and (is_named or not is_picture):
            chosen.append(i)
    if not chosen:
        raise InvalidDesign(
            "no geom of this model can get wet: each is dry, has no volume, or is on a body that cannot move; give a "
            f"body that moves a {', '.join(_SOLIDS.values())}."
        )
    return chosen


def shape_table(
    model: Any,
    geoms: list[int],
    coefficients: Mapping[str, GeomCoefficients],
    viscosity: float,
    lift: float,
) -> tuple[Float[np.ndarray, "shape column"], Float[np.ndarray, "triangle 9"]]:
    """Return geoms of a model as a table of shapes, and the triangles of its polyhedra.

    Args:
        model: a ``mujoco.MjModel``.
        geoms: those on which water acts.
        coefficients: coefficients of geoms by their names.
        viscosity: dynamic viscosity of the water, for the drag of slow motion [Pa s].
        lift: slope of the lift coefficient of flat shapes [1/rad].

    Raises:
        InvalidDesign: a mesh is open or has no volume.
    """
    rows, surfaces, count = [], [], 0
    for i in geoms:
        row, triangles = _shape(model, i, coefficients.get(model.geom(i).name, GeomCoefficients()), viscosity, lift)
        row[slice(*SHAPE_COLUMNS["triangles"])] = count, len(triangles)
        count += len(triangles)
        rows.append(row)
        surfaces.append(triangles)
    return np.array(rows), np.concatenate(surfaces)


def _shape(
    model: Any, geom: int, chosen: GeomCoefficients, viscosity: float, lift: float
) -> tuple[Float[np.ndarray, " column"], Float[np.ndarray, "triangle 9"]]:
    """Return the row of one geom, and its triangles if it is a polyhedron; see ``shape_table``."""
    size, triangles = np.array(model.geom_size[geom]), np.zeros((0, 9))
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, model.geom_quat[geom])
    axes, centre = turn.reshape(3, 3), np.array(model.geom_pos[geom])
    word = _SOLIDS[int(model.geom_type[geom])]
    if word == "sphere":
        kind, half, volume = BALL, np.full(3, size[0]), 4.0 / 3.0 * pi * size[0] ** 3
    elif word == "ellipsoid":
        kind, half, volume = BALL, size, 4.0 / 3.0 * pi * float(np.prod(size))
    elif word == "cylinder":
        kind, half, volume = CYLINDER, np.array([size[0], size[0], size[1]]), 2.0 * pi * size[0] ** 2 * size[1]
    elif word == "capsule":
        half = np.array([size[0], size[0], size[0] + size[1]])
        kind, volume = CAPSULE, pi * size[0] ** 2 * (2.0 * size[1] + 4.0 / 3.0 * size[0])
    elif word == "box":
        kind, half, volume, triangles = BOX, size, 8.0 * float(np.prod(size)), box_triangles(size)
    else:
        mesh = int(model.geom_dataid[geom])
        first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
        faces = model.mesh_face[model.mesh_faceadr[mesh] :][: model.mesh_facenum[mesh]]
        name = model.geom(geom).name or model.mesh(mesh).name
        surface = solid(model.mesh_vert[first : first + count], faces, name, is_convex=chosen.is_convex)
        kind, half, volume, triangles = POLYHEDRON, surface.half, surface.volume, surface.triangles
        centre, axes = centre + axes @ surface.centre, axes @ surface.axes
    parts = shape_coefficients(kind, half, volume, chosen.drag)
    radius = (0.75 * volume / pi) ** (1.0 / 3.0)
    bound = np.abs(triangles.reshape(-1, 3)).max(axis=0) if len(triangles) else half
    faces_lift = _lifting(half, parts.area, lift if chosen.lift is None else chosen.lift, chosen.lift is not None)
    added, frontal = parts.added, parts.area * parts.drag
    linear, linear_turning = np.full(3, 6.0 * pi * viscosity * radius), np.full(3, 8.0 * pi * viscosity * radius**3)
    if chosen.added_mass is not None:
        added = volume * np.broadcast_to(chosen.added_mass, 3)
    if chosen.linear_drag is not None:
        linear = np.broadcast_to(chosen.linear_drag, 3)
    if chosen.linear_turning_drag is not None:
        linear_turning = np.broadcast_to(chosen.linear_turning_drag, 3)
    row = np.zeros(SHAPE_WIDTH)
    for column, values in (
        ("body", model.geom_bodyid[geom]), ("kind", POLYHEDRON if kind == BOX else kind), ("at", centre),
        ("across", axes[:, 0]), ("upward", axes[:, 1]), ("forward", axes[:, 2]), ("half", half),
        ("volume", chosen.volume * volume), ("added", chosen.volume * added), ("solid", volume), ("bound", bound),
        ("added_inertia", chosen.volume * parts.added_inertia), ("frontal", frontal),
        ("coupled", kind not in (CYLINDER, CAPSULE)), ("turning", parts.turning), ("linear", linear),
        ("linear_turning", linear_turning), ("lift", faces_lift),
    ):  # fmt: skip
        row[slice(*SHAPE_COLUMNS[column])] = values
    return row, triangles


def _lifting(
    half: Float[np.ndarray, "3"], area: Float[np.ndarray, "3"], slope: float, is_chosen: bool
) -> Float[np.ndarray, "3"]:
    """Return area times slope of the lift coefficient of a shape's largest faces along its axes [m2].

    Args:
        half: half extents [m].
        area: projected areas [m2].
        slope: of the lift coefficient [1/rad].
        is_chosen: whether the slope is the geom's own, so that a thick shape has it too.
    """
    thin, lifting = int(np.argmin(half)), np.zeros(3)
    if is_chosen or half[thin] <= _FLAT * float(np.delete(half, thin).min()):
        lifting[thin] = slope * area[thin]
    return lifting

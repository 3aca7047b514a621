"""The ground: a plane, and what stands up from it as a block or a height field."""

from typing import Any

import mujoco

from suchus.design.relief import ASIDE, REACH, Bumps, Relief, Step, Stone, field

RELIEF = "relief"
"""Name of the geom that stands up from the plane."""
_COLOUR = (0.86, 0.84, 0.78, 1.0)
_BASE = 0.05  # [m]; a height field needs a thickness


def add_ground(spec: Any, relief: Relief | None) -> None:
    """Lay the ground, and what stands up from it.

    Models of one batch must have equal sizes: reliefs of one type do.
    """
    plane = spec.worldbody.add_geom(
        name="ground",
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[0, 0, 0.05],
        contype=1,
        conaffinity=0,
        rgba=list(_COLOUR),
    )
    spec.worldbody.add_light(pos=[0, 0, 3], dir=[0, 0, -1])
    if isinstance(relief, Step):
        half = (REACH[1] - relief.at) / 2
        _block(spec, (relief.at + half, 0.0), (max(half, 0.01), ASIDE), relief.height)
    elif isinstance(relief, Stone):
        _block(spec, (relief.at, relief.aside), (relief.length / 2, relief.width / 2), relief.height)
    elif isinstance(relief, Bumps):
        plane.pos = [0, 0, _raise(spec, relief)]  # as deep as the field


def _block(spec: Any, at: tuple[float, float], half: tuple[float, float], height: float) -> None:
    spec.worldbody.add_geom(
        name=RELIEF,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=[*at, height / 2],
        size=[*half, height / 2],
        contype=1,
        conaffinity=0,
        rgba=list(_COLOUR),
    )


def _raise(spec: Any, bumps: Bumps) -> float:
    """Add a height field; return the height of its lowest point [m]."""
    heights, (first, last) = field(bumps), bumps.reach
    low, high = float(heights.min()), float(heights.max())
    middle = (first + last) / 2
    spec.add_hfield(
        name=RELIEF,
        size=[last - middle, bumps.aside, high - low, _BASE * bumps.scale],
        nrow=heights.shape[0],
        ncol=heights.shape[1],
        userdata=((heights - low) / (high - low)).ravel(),
    )
    spec.worldbody.add_geom(
        name=RELIEF,
        type=mujoco.mjtGeom.mjGEOM_HFIELD,
        hfieldname=RELIEF,
        pos=[middle, 0.0, low],
        contype=1,
        conaffinity=0,
        rgba=list(_COLOUR),
    )
    return low

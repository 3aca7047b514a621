"""What the player receives: skin, frames and ground, as JSON and one block of bytes."""

import base64
from collections.abc import Sequence
from math import ceil, floor
from typing import Any

import numpy as np
from jaxtyping import Float

from suchus.core.rotation import rotate
from suchus.robot.design import GRAVITY, Robot, layout
from suchus.robot.design.ground import HALF_WIDTH, REACH, Bumps, Ground, Relief, Step, field, slope
from suchus.sim.metrics.gait import LOADED_SHARE
from suchus.visual.figures import COLOURS, limb_colours
from suchus.visual.replay.frames import Frames
from suchus.visual.skin import Skin, ankles, skin_with_ankles

_KINDS = {"int8", "uint8", "int16", "uint16", "uint32", "float32"}


class PackedArrays:
    """Bytes that grow; every array begins at a multiple of four."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self.size = 0
        """Bytes so far [-]."""

    def add(self, array: np.ndarray) -> dict[str, Any]:
        """Append an array and return where it lies: its ``kind``, its ``start`` [byte], its ``count`` of numbers."""
        assert array.dtype.name in _KINDS
        raw = np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("<")).tobytes()
        location = {"kind": array.dtype.name, "start": self.size, "count": int(array.size)}
        raw += bytes(-len(raw) % 4)
        self._parts.append(raw)
        self.size += len(raw)
        return location

    def text(self) -> str:
        """Return everything as base64."""
        return base64.b64encode(b"".join(self._parts)).decode("ascii")


def quantise(values: np.ndarray, kind: type[np.signedinteger[Any]]) -> tuple[np.ndarray, float]:
    """Return whole numbers and the size of the largest value, which the greatest whole number stands for."""
    max_value = float(np.abs(values).max(initial=0.0)) or 1.0
    return np.round(values / max_value * np.iinfo(kind).max).astype(kind), max_value


ARROW = 0.35
"""Length of an arrow that stands for the whole weight, over the robot's length [-]."""
KEYS = {
    "force": "#D98200",
    "mass": COLOURS["alarm"],
    "support": "#B8860B",
    "ghost": "#6F9DC4",
    "relief": "#B9AE98",
    "water": COLOURS["water"],
}
"""Colours of what is not the robot."""
_LATERAL_DISTANCE = 0.62  # lateral distance between two robots, over the robot's length


def scene(
    robot: Robot, moving: Sequence[Frames], labels: Sequence[str], ground: Ground, *, overlaid: bool
) -> tuple[dict[str, Any], str]:
    """Return the metadata of the scene, and its arrays as base64.

    Args:
        robot: robot that moves.
        moving: one run, or two of which the second is the ghost, or several of which one is chosen.
        labels: what the runs are called.
        ground: on what.
        overlaid: whether two runs begin in the same place.
    """
    pack, surface, relief = PackedArrays(), skin_with_ankles(robot), ground.relief
    x = np.concatenate([run.mass[:, 0] for run in moving])
    meta = {
        "start": moving[0].start,
        "rate": moving[0].rate,
        "bones": len(surface.bones),
        "length": robot.length,
        "size": max([robot.length, *(2 * girdle.limb.reach for girdle in robot.girdles)]),
        "aside": _LATERAL_DISTANCE * robot.length,
        "radii": [limb.girdle.limb.foot.radius for limb in layout(robot).limbs],
        "loaded": LOADED_SHARE * robot.mass * GRAVITY,
        "overlaid": overlaid,
        "slope": np.round(slope(ground.uphill, ground.sideways), 9).tolist(),
        "water": _packed_water(moving[0], ground, pack),
        "floor": float(field(relief).min())
        if isinstance(relief, Bumps)
        else 0.0,  # depth of the field, as in the physics model
        "metres_per_newton": ARROW * robot.length / (robot.mass * GRAVITY),
        "marks": [max(floor(x.min()) - 1, -50), min(ceil(x.max()) + 1, 50)],
        "mark_side": -0.4 * robot.length,
        "colours": {name: _rgb(text) for name, text in KEYS.items()}
        | {"legs": [_rgb(colour) for _, colour in limb_colours(robot)]},
        "skin": _packed_skin(surface, pack),
        "head": _head(robot, surface),
        "actors": [_packed(robot, run, name, relief, pack) for run, name in zip(moving, labels, strict=False)],
        "relief": None if relief is None else _packed_relief(relief, pack),
    }
    return meta, pack.text()


def _head(robot: Robot, surface: Skin) -> dict[str, Any]:
    """Return the bone at the front of the axis, and the foremost point of its skin at rest [m]."""
    bone = surface.bones.index(robot.axis[0].name)
    points = surface.vertices[surface.indices[:, 0] == bone]
    return {"bone": bone, "at": np.round(points[points[:, 0].argmax()], 6).tolist()}


def _packed_skin(surface: Skin, pack: PackedArrays) -> dict[str, Any]:
    """Pack the skin: vertices, normals, colours, faces, and two bones with weights for each vertex."""
    vertices, scale = quantise(surface.vertices, np.int16)
    assert (surface.weights[:, 2:] == 0).all()  # joints are so far apart that no vertex hangs on three bones
    return {
        "scale": scale,
        "rest": np.round(surface.rest_origins, 7).tolist(),
        "vertices": pack.add(vertices),
        "normals": pack.add(np.round(127 * surface.normals).astype(np.int8)),
        "colours": pack.add(surface.colours),
        "bones": pack.add(surface.indices[:, :2].astype(np.uint8)),
        "weights": pack.add(np.round(255 * surface.weights[:, 0]).astype(np.uint8)),
        "faces": pack.add(surface.faces.astype(np.uint16)),
    }


def _packed(robot: Robot, run: Frames, label: str, relief: Relief | None, pack: PackedArrays) -> dict[str, Any]:
    """Pack one run: poses of the bones, centre of mass, feet, forces and tail in every frame.

    Args:
        robot: robot that moves.
        run: frames of the run.
        label: name of the run.
        relief: what stands up from the ground; None where it is even.
        pack: takes the arrays.
    """
    bones = ankles(robot, run.bones, run.feet, relief)
    bone_positions = bones.positions
    origin = (bone_positions.max(axis=(0, 1)) + bone_positions.min(axis=(0, 1))) / 2
    positions, reach = quantise(bone_positions - origin, np.int16)
    return {
        "label": label,
        "frames": len(run.mass),
        "origin": np.round(origin, 6).tolist(),
        "reach": reach,
        "arrays": {
            "places": pack.add(positions),
            "turns": pack.add(np.round(32767 * bones.quaternions).astype(np.int16)),
            "mass": pack.add(run.mass.astype(np.float32)),
            "feet": pack.add(run.feet.astype(np.float32)),
            "forces": pack.add(run.forces.astype(np.float32)),
            "tail": pack.add(run.tail.astype(np.float32)),
        },
    }


def _packed_water(run: Frames, ground: Ground, pack: PackedArrays) -> dict[str, Any] | None:
    """Return the level of the water in each frame, and the direction against gravity in the frame of the ground."""
    if run.level is None:
        return None
    return {"levels": pack.add(run.level.astype(np.float32)), "up": np.round(upward(ground), 9).tolist()}


def upward(ground: Ground) -> Float[np.ndarray, "3"]:
    """Return the direction against gravity in the frame of the ground."""
    back = slope(ground.uphill, ground.sideways) * np.array([1.0, -1.0, -1.0, -1.0])
    return rotate(back, np.array([0.0, 0.0, 1.0]))


def _packed_relief(relief: Relief, pack: PackedArrays) -> dict[str, Any]:
    """Pack the heights of bumps, or return the block that a step or a stone is."""
    if isinstance(relief, Bumps):
        heights = field(relief)
        height_values, max_height = quantise(heights, np.int16)
        return {
            "heights": pack.add(height_values),
            "shape": list(heights.shape),
            "scale": max_height / np.iinfo(np.int16).max,
            "x0": relief.reach[0],
            "y0": -relief.half_width,
            "cell": relief.cell,
        }
    if isinstance(relief, Step):
        return {"block": [relief.at, REACH[1], -HALF_WIDTH, HALF_WIDTH, relief.height]}
    half_length, half_width = relief.length / 2, relief.width / 2
    x, y = (relief.at - half_length, relief.at + half_length), (relief.aside - half_width, relief.aside + half_width)
    return {"block": [*x, *y, relief.height]}


def _rgb(text: str) -> list[float]:
    return [round(int(text[i : i + 2], 16) / 255, 4) for i in (1, 3, 5)]

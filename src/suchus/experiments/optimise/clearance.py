"""Distance between the parts of a body; the physics has contacts with the ground only."""

from functools import lru_cache
from itertools import combinations, product
from typing import NamedTuple

import numpy as np
import xarray as xr

from suchus.robot.design import Girdle, LimbPlace, Robot, Segment, Shell, check_needs, layout
from suchus.robot.kinematics.tree import BodyFrames, frames


class _Capsule(NamedTuple):
    name: str
    start: np.ndarray
    end: np.ndarray
    radius: float


def clearance(robot: Robot, record: xr.Dataset, *, sample_interval: int = 1) -> xr.DataArray:
    """Return the least distance between parts of the body that could touch each other, negative where they overlap [m].

    The parts are capsules: the links of each limb and the shapes of the axis. Distances are measured from each limb to
    the other limbs and to the trunk. The first link is not compared with the shape that carries it, nor with one that
    it overlaps on the straight body. Hind limbs are also compared with the tail beyond its first segment, which lies
    between the hips. Parts of the axis are not compared with each other.

    Args:
        robot: robot of the record.
        record: record of one run or of several runs of robots with these lengths.
        sample_interval: number of samples of which one is evaluated.
    """
    angles = record.joint_angle.isel(time=slice(None, None, sample_interval)).transpose(..., "time", "joint")
    min_distance = part_distance(robot, angles.values.astype(float)).min(axis=-1)
    return xr.DataArray(
        min_distance, dims=angles.dims[:-2], attrs={"units": "m", "long_name": "clearance between parts"}
    )


def part_distance(robot: Robot, angles: np.ndarray) -> np.ndarray:
    """Return the least distance between parts for postures [m].

    Args:
        robot: the robot.
        angles: angles of every hinge in the order of ``joint_names(robot)``, shape (..., joint) [rad].
    """
    check_needs(robot, ("limbs",), "the distance between limbs and body")
    parts = _parts(robot, angles)
    return np.asarray(np.minimum.reduce([_capsule_distance(parts[a], parts[b]) for a, b in _pairs(robot)]))


def _parts(robot: Robot, angles: np.ndarray) -> dict[str, _Capsule]:
    """Return the shapes of the axis and the links of the limbs."""
    robot_layout, body_frames = layout(robot), frames(robot, angles)
    parts = [capsule for segment in robot.axis for capsule in _segment(robot, segment, body_frames)]
    parts += [capsule for limb in robot_layout.limbs for capsule in _limb(limb, body_frames)]
    return {shape.name: shape for shape in parts}


@lru_cache(maxsize=64)
def _pairs(robot: Robot) -> tuple[tuple[str, str], ...]:
    """Return the names of the pairs of parts whose distance counts."""
    robot_layout, straight = layout(robot), _parts(robot, np.zeros(len(layout(robot).hinges)))
    limbs = [[f"{limb.name} {link.name}" for link in limb.girdle.limb.links] for limb in robot_layout.limbs]
    trunk, tail = (
        [shape.name for segment in segments for shape in segment.shapes]
        for segments in (robot.axis[: robot.root_index + 1], robot.axis[robot.root_index + 2 :])
    )
    pairs = [pair for first_limb, second_limb in combinations(limbs, 2) for pair in product(first_limb, second_limb)]
    for limb, (first_link, *outer_links) in zip(robot_layout.limbs, limbs, strict=True):
        axis = trunk + tail if limb.girdle is robot.girdles[-1] else trunk
        overlapping = {
            shape_name for shape_name in axis if _capsule_distance(straight[first_link], straight[shape_name]) <= 0.0
        }
        pairs += [
            (first_link, shape_name)
            for shape_name in axis
            if shape_name not in {_carrier(robot, limb.girdle), *overlapping}
        ]
        pairs += [(link, shape_name) for link in outer_links for shape_name in axis]
    return tuple(pairs)


def _segment(robot: Robot, segment: Segment, body_frames: BodyFrames) -> list[_Capsule]:
    """Return the capsules of a segment: rods as they are, shells along the body.

    A shell that carries limbs is as thick as it is high, since limbs leave it at its sides, and reaches from the joint
    behind it to the girdle, or through its segment if it is the only shape. Any other shell is as thick as it is wide.

    Args:
        robot: the robot.
        segment: segment of the axis.
        body_frames: frames of all bodies.
    """
    bodies = layout(robot).bodies
    body = [tree_body.name for tree_body in bodies].index(segment.name)
    position, rotation = body_frames.positions[..., body, :], body_frames.turns[..., body, :, :]
    girdle_of_shell = {_carrier(robot, girdle): girdle for girdle in robot.girdles if girdle.segment == segment.name}
    capsules = []
    for shape in segment.shapes:
        if isinstance(shape, Shell):
            if shape.name in girdle_of_shell:
                radius = shape.half[2]
                span = -segment.rear, segment.front if len(segment.shapes) == 1 else girdle_of_shell[shape.name].at
            else:
                radius = min(shape.half[0], shape.half[1])
                span = shape.at[0] - (shape.half[0] - radius), shape.at[0] + (shape.half[0] - radius)
            ends = [np.array([x, *shape.at[1:]]) for x in span]
        else:
            radius, ends = shape.radius, [np.array(shape.start), np.array(shape.end)]
        start, end = (position + rotation @ (point + np.array([bodies[body].shift, 0.0, 0.0])) for point in ends)
        capsules.append(_Capsule(shape.name, start, end, radius))
    return capsules


def _carrier(robot: Robot, girdle: Girdle) -> str:
    """Return the name of the shape that carries the limbs of a girdle: the nearest along the body."""
    segment = next(candidate for candidate in robot.axis if candidate.name == girdle.segment)
    return min(segment.shapes, key=lambda shape: abs(shape.centre[0] - girdle.at)).name


def _limb(limb: LimbPlace, body_frames: BodyFrames) -> list[_Capsule]:
    """Return the links of a limb, the last at least as thick as its foot."""
    links, capsules = limb.girdle.limb.links, []
    for number, link in enumerate(links):
        body = limb.tip - len(links) + 1 + number
        start = body_frames.positions[..., body, :]
        end = start + body_frames.turns[..., body, :, :] @ np.array([link.end[0], limb.side * link.end[1], link.end[2]])
        radius = max(link.radius, limb.girdle.limb.foot.radius) if link is links[-1] else link.radius
        capsules.append(_Capsule(f"{limb.name} {link.name}", start, end, radius))
    return capsules


def _capsule_distance(a: _Capsule, b: _Capsule) -> np.ndarray:
    """Return the distance of two capsules' surfaces [m]."""
    return segment_distance(a.start, a.end, b.start, b.end) - (a.radius + b.radius)


def segment_distance(p: np.ndarray, p_end: np.ndarray, q: np.ndarray, q_end: np.ndarray) -> np.ndarray:
    """Return the distance of two segments, shape (...,) [m].

    The nearest points of the two lines are clamped to the first segment, then to the second, then the first follows.

    Args:
        p: start of the first segment, shape (..., 3) [m].
        p_end: its end.
        q: start of the second segment, shape (..., 3) [m].
        q_end: its end.

    Source: C. Ericson, Real-Time Collision Detection (2005), section 5.1.9.
    """
    d, e, r = p_end - p, q_end - q, p - q
    dd, ee, de = (np.einsum("...i,...i", x, y) for x, y in ((d, d), (e, e), (d, e)))
    dr, er = np.einsum("...i,...i", d, r), np.einsum("...i,...i", e, r)
    tiny = 1e-12
    determinant = dd * ee - de * de
    s = np.where(
        determinant > tiny * np.maximum(dd * ee, tiny), (de * er - dr * ee) / np.maximum(determinant, tiny), 0.0
    )
    s = np.clip(s, 0.0, 1.0)
    t = np.clip((de * s + er) / np.maximum(ee, tiny), 0.0, 1.0)
    s = np.clip((de * t - dr) / np.maximum(dd, tiny), 0.0, 1.0)
    gap = r + s[..., None] * d - t[..., None] * e
    return np.asarray(np.sqrt(np.einsum("...i,...i", gap, gap)))

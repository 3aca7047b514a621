"""How far the parts of a body stay clear of each other: the physics knows contacts with the ground only."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from suchus.design import ARTICLE_BODY, LEGS, Robot, check_needs, layout
from suchus.kinematics import body, spine
from suchus.kinematics import leg as leg_kinematics
from suchus.kinematics.links import LegLinks

_GIRDLE = {"F": ("thorax",), "H": ("pelvis",)}
_SHANK = 0.8  # of the femur's radius, as the model builds it


class _Bone(NamedTuple):
    hip_offset: float
    femur: float
    tibia: float


class _Capsule(NamedTuple):
    name: str
    start: np.ndarray
    end: np.ndarray
    radius: float


def clearance(robot: Robot, record: xr.Dataset, *, every: int = 1) -> xr.DataArray:
    """Return the least distance between parts of the body that could touch each other, negative where they overlap [m].

    The parts are capsules: femur and shank of each leg, pelvis, links of the trunk, thorax, head, segments of the
    tail. Each leg is held against the other legs and against the body; its femur is not held against the girdle that
    carries it, and no part of the body against its neighbour.

    Args:
        robot: whose record it is.
        record: of one run or of several runs of robots with these lengths.
        every: look at one sample of so many.
    """
    angles = record.joint_angle.isel(time=slice(None, None, every)).transpose(..., "time", "joint")
    least = between_parts(robot, angles.values.astype(float)).min(axis=-1)
    return xr.DataArray(least, dims=angles.dims[:-2], attrs={"units": "m", "long_name": "clearance between parts"})


def between_parts(robot: Robot, angles: np.ndarray) -> np.ndarray:
    """Return the least distance between parts for postures [m].

    Args:
        robot: the robot.
        angles: of every hinge in the order of ``joint_names(robot)``, shape (..., joint) [rad].
    """
    check_needs(robot, ARTICLE_BODY, "the distance between parts")
    trunk, tail = _trunk(robot, angles[..., layout(robot).ahead]), _tail(robot, angles[..., layout(robot).behind])
    legs = {name: _leg(robot, name, angles) for name in LEGS}
    pairs = [(a, b) for i, one in enumerate(LEGS) for two in LEGS[i + 1 :] for a in legs[one] for b in legs[two]]
    for name, (femur, shank) in legs.items():
        own = _GIRDLE[name[1]]
        pairs += [(femur, part) for part in trunk if part.name not in own]
        pairs += [(shank, part) for part in trunk]
        if name.endswith("H"):
            pairs += [(bone, part) for bone in (femur, shank) for part in tail]
    gaps = [_apart(a, b) for a, b in pairs]
    return np.asarray(np.minimum.reduce(gaps))


def _trunk(robot: Robot, bends: np.ndarray) -> list[_Capsule]:
    """Return pelvis, links, thorax and head."""
    T, joints = spine.forward(robot.spine, bends), spine.joints(robot.spine, bends)
    end, ahead = T[..., :3, 3], T[..., :3, 0]
    still = np.zeros_like(end)
    behind = still - np.array([robot.tail.offset, 0.0, 0.0])
    pelvis = _Capsule("pelvis", behind, joints[..., 0, :], robot.pelvis.height / 2)
    links = [
        _Capsule(f"link_{i}", joints[..., i, :], joints[..., i + 1, :], robot.spine.radius)
        for i in range(joints.shape[-2] - 1)
    ]
    thorax = _Capsule("thorax", end, end + robot.thorax.shoulder * ahead, robot.thorax.height / 2)
    half = robot.head.width / 2
    from_neck = max(robot.thorax.shoulder + half, 0.0)
    head = _Capsule("head", end + from_neck * ahead, end + (robot.head.snout - half) * ahead, half)
    return [pelvis, *links, thorax, head]


def _tail(robot: Robot, angles: np.ndarray) -> list[_Capsule]:
    points = body.tail_points(robot, angles)
    radii = robot.tail.radii
    return [
        _Capsule(f"tail_{i}", points[..., i, :], points[..., i + 1, :], radii[i])
        for i in range(1, points.shape[-2] - 1)  # the root lies between the hips
    ]


def _leg(robot: Robot, name: str, angles: np.ndarray) -> tuple[_Capsule, _Capsule]:
    leg, i = robot.leg(name), LEGS.index(name)
    own = angles[..., layout(robot).limbs[i].hinges]
    bones: tuple[LegLinks, ...] = (_Bone(leg.hip_offset, 0.0, 0.0), _Bone(leg.hip_offset, leg.femur, 0.0), leg)
    hip, knee, foot = (body.from_leg_frame(leg_kinematics.forward(bone, own), name) for bone in bones)
    if name.endswith("F"):
        T = spine.forward(robot.spine, angles[..., layout(robot).ahead])
        shoulder = T[..., :3, 3] + robot.thorax.shoulder * T[..., :3, 0]
        hip, knee, foot = (shoulder + np.einsum("...ij,...j->...i", T[..., :3, :3], p) for p in (hip, knee, foot))
    return (
        _Capsule(f"{name}_femur", hip, knee, leg.radius),
        _Capsule(f"{name}_shank", knee, foot, max(_SHANK * leg.radius, leg.foot_radius)),
    )


def _apart(a: _Capsule, b: _Capsule) -> np.ndarray:
    """Return the distance of two capsules' surfaces [m]."""
    return segments_apart(a.start, a.end, b.start, b.end) - (a.radius + b.radius)


def segments_apart(p: np.ndarray, p_end: np.ndarray, q: np.ndarray, q_end: np.ndarray) -> np.ndarray:
    """Return the distance of two segments, shape (...,) [m].

    The nearest points of the two lines are clamped to the first segment, then to the second, then the first follows.

    Source: C. Ericson, Real-Time Collision Detection (2005), section 5.1.9.
    """
    d, e, r = p_end - p, q_end - q, p - q
    dd, ee, de = (np.einsum("...i,...i", x, y) for x, y in ((d, d), (e, e), (d, e)))
    dr, er = np.einsum("...i,...i", d, r), np.einsum("...i,...i", e, r)
    tiny = 1e-12
    across = dd * ee - de * de
    s = np.where(across > tiny * np.maximum(dd * ee, tiny), (de * er - dr * ee) / np.maximum(across, tiny), 0.0)
    s = np.clip(s, 0.0, 1.0)
    t = np.clip((de * s + er) / np.maximum(ee, tiny), 0.0, 1.0)
    s = np.clip((de * t - dr) / np.maximum(dd, tiny), 0.0, 1.0)
    gap = r + s[..., None] * d - t[..., None] * e
    return np.asarray(np.sqrt(np.einsum("...i,...i", gap, gap)))

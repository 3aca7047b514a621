"""Filming our own robot: from a record to the keypoints that a camera would have tracked. The extraction's proof."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr

from suchus import rotation
from suchus.capture.tracks import Tracks
from suchus.design import ARTICLE_BODY, LEGS, Robot, check_needs, leg_joints, spine_joints
from suchus.design.checks import Checks
from suchus.kinematics import body, spine
from suchus.motion import START

_NECK = 0.05  # [m]; ahead of the shoulders, on the front girdle


@dataclass(frozen=True, slots=True, kw_only=True)
class Camera:
    """A camera that stands still above the walk, and the tracker behind it."""

    rate: float
    """Frames per second [1/s]."""
    noise: float
    """Standard deviation of every coordinate [m]."""
    lost: float
    """Share of the points that are lost, each on its own [-]."""
    heading: float
    """Angle by which the camera is turned against the walk [rad]."""
    scale: float | None
    """Pixels per metre, which nobody knows afterwards [px/m]; None: the tracks are in metres."""
    heights: bool
    """Whether heights are seen too, as with two cameras."""
    seed: int
    """Seed of noise and losses."""

    def __post_init__(self) -> None:
        with Checks("camera", self) as check:
            check.number("rate", 1.0, 10000.0, "1/s")
            check.number("noise", 0.0, 0.1, "m")
            check.number("lost", 0.0, 0.9, "")
            check.number("heading", -7.0, 7.0, "rad")
            if self.scale is not None:
                check.number("scale", 1e-3, 1e6, "px/m")
            check.whole("seed", 0, 2**32 - 1)


def film(robot: Robot, record: xr.Dataset, camera: Camera, *, start: float = START) -> Tracks:
    """Return the keypoints of a robot as a camera would have tracked them.

    Args:
        robot: whose record it is.
        record: of one run, without the dimension ``run``.
        camera: how it is seen.
        start: of the film [s].
    """
    times = np.arange(start, float(record.time[-1]) + 1e-9, 1.0 / camera.rate)
    part = record[["position", "orientation", "joint_angle"]].sel(time=times, method="nearest")
    return tracked(keypoints(robot, part), part.time.values, camera, source=f"the film of {robot.name}")


def tracked(points: Mapping[str, np.ndarray], time: np.ndarray, camera: Camera, *, source: str) -> Tracks:
    """Return points of the world as a camera and its tracker see them.

    Args:
        points: by name, each of shape (time, 3) [m].
        time: [s].
        camera: how they are seen.
        source: what is filmed.
    """
    place = np.stack(list(points.values()), axis=1)
    rng = np.random.default_rng(camera.seed)
    place = place + camera.noise * rng.standard_normal(place.shape)
    place[rng.uniform(size=place.shape[:2]) < camera.lost] = np.nan
    c, s = np.cos(camera.heading), np.sin(camera.heading)
    place[..., :2] = place[..., :2] @ np.array([[c, s], [-s, c]])
    return Tracks(
        time=time - time[0],
        points=tuple(points),
        position=(camera.scale or 1.0) * (place if camera.heights else place[..., :2]),
        unit="m" if camera.scale is None else "px",
        source=source,
    )


def keypoints(robot: Robot, record: xr.Dataset) -> dict[str, np.ndarray]:
    """Return where the keypoints of a robot are in the world, each of shape (time, 3) [m].

    Args:
        robot: whose record it is.
        record: of one run, without the dimension ``run``.
    """
    check_needs(robot, ARTICLE_BODY, "a made-up film")
    angles = record.joint_angle.values.astype(float)
    legs, trunk = len(leg_joints()), len(leg_joints()) + len(spine_joints())
    points = _midline(robot, angles[:, legs:trunk]) | _tail(robot, angles[:, trunk:])
    feet = body.feet(robot, angles)
    points |= {leg: feet[:, i] for i, leg in enumerate(LEGS)}
    R, at = rotation.matrix(record.orientation.values.astype(float)), record.position.values.astype(float)
    return {name: at + np.einsum("tij,tj->ti", R, point) for name, point in points.items()}


def _midline(robot: Robot, bends: np.ndarray) -> dict[str, np.ndarray]:
    """Points of the trunk in the pelvis's frame: the yaw joints, and the front girdle."""
    T = spine.forward(robot.spine, bends)
    shoulder = T[:, :3, 3] + robot.thorax.shoulder * T[:, :3, 0]
    points = {
        "snout": T[:, :3, 3] + robot.head.snout * T[:, :3, 0],
        "neck": shoulder + _NECK * T[:, :3, 0],
        "shoulder": shoulder,
    }
    for number, joint in ((3, 4), (2, 2), (1, 0)):
        before = bends.copy()
        before[:, joint:] = 0.0  # what lies beyond the joint is straight, so that it can be measured back to it
        T = spine.forward(robot.spine, before)
        points[f"spine_{number}"] = T[:, :3, 3] - (4 - joint) * robot.spine.link * T[:, :3, 0]
    return points | {"hip": np.zeros((len(bends), 3))}


def _tail(robot: Robot, angles: np.ndarray) -> dict[str, np.ndarray]:
    """Points of the tail in the pelvis's frame: every other cable joint, both ends of the last plate, the tip."""
    points = body.tail_points(robot, angles)
    last = points.shape[1] - 1
    plate = last - robot.tail.fin_segments  # where the cable section ends
    marks = sorted({*range(1, plate - 1, 2), plate - 1, plate})
    named = {f"tail_{i}": points[:, at] for i, at in enumerate(marks, 1)}
    return {"tail_base": points[:, 0], **named, "tail_tip": points[:, last]}

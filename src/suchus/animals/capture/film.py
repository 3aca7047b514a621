"""Synthetic film of our own robot: the keypoints that a camera would track in a record. It proves the extraction."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr

from suchus.animals.capture.tracks import Tracks
from suchus.core import rotation
from suchus.core.checks import Checks
from suchus.robot.design import Layout, Robot, check_needs, hips_ahead, layout
from suchus.robot.kinematics.tree import BodyFrames, frames, landmarks
from suchus.robot.motion import START

_NECK = 0.05 / 0.3425  # [length from hips to shoulders]; of the neck ahead of the shoulders, on the front girdle


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
        """Refuse rates, noise, losses and scales out of range."""
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
        robot: robot whose record it is.
        record: record of one run, without the dimension ``run``.
        camera: how it is seen.
        start: start of the film [s].
    """
    times = np.arange(start, float(record.time[-1]) + 1e-9, 1.0 / camera.rate)
    film_record = record[["position", "orientation", "joint_angle"]].sel(time=times, method="nearest")
    return tracked(keypoints(robot, film_record), film_record.time.values, camera, source=f"the film of {robot.name}")


def tracked(points: Mapping[str, np.ndarray], time: np.ndarray, camera: Camera, *, source: str) -> Tracks:
    """Return points of the world as a camera and its tracker see them.

    Args:
        points: points by name, each of shape (time, 3) [m].
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
    """Return the positions of a robot's keypoints in the world, each of shape (time, 3) [m].

    Args:
        robot: robot whose record it is.
        record: record of one run, without the dimension ``run``.

    Raises:
        UnsuitedRobot: it has not the trunk and the tail that ``Tracks`` are of, or limbs, but not four.
    """
    limbs = layout(robot).limbs
    check_needs(robot, ("four_limbs", "trunk", "tail_yaw") if limbs else ("trunk", "tail_yaw"), "a made-up film")
    angles = record.joint_angle.values.astype(float)
    place, body_frames, marks = layout(robot), frames(robot, angles), landmarks(robot, angles)
    points = {"snout": marks.snout}
    if limbs:
        front, hind = place.limbs[0].girdle, place.limbs[-1].girdle
        points["neck"] = _midline_point(body_frames, place, front.segment, front.at + _NECK * hips_ahead(robot, 0))
        points["shoulder"] = _midline_point(body_frames, place, front.segment, front.at)
    spine = [body_frames.positions[:, _body_of_hinge(place, place.servos[servo])] for servo in place.trunk_yaw]
    points |= {f"spine_{i}": spine[i - 1] for i in range(len(spine), 0, -1)}
    points |= {"hip": _midline_point(body_frames, place, hind.segment, hind.at)} if limbs else {}
    points |= _tail(place, body_frames) | {"tail_tip": marks.tail}
    points |= {limb.name: marks.feet[:, i] for i, limb in enumerate(place.limbs)}
    R, root_position = rotation.matrix(record.orientation.values.astype(float)), record.position.values.astype(float)
    return {name: root_position + np.einsum("tij,tj->ti", R, point) for name, point in points.items()}


def _midline_point(body_frames: BodyFrames, place: Layout, segment: str, forward_offset: float) -> np.ndarray:
    """Return the position of a point on the midline of a segment, in the frame of the root, shape (frame, 3) [m].

    Args:
        body_frames: frames of all bodies of the robot.
        place: layout of the robot.
        segment: name of the body that carries the point.
        forward_offset: distance of the point ahead of the segment's origin [m].
    """
    body = [segment_body.name for segment_body in place.bodies].index(segment)
    return np.asarray(
        body_frames.positions[:, body] + (place.bodies[body].shift + forward_offset) * body_frames.turns[:, body, :, 0]
    )


def _body_of_hinge(place: Layout, hinge: str) -> int:
    """Return the index of the body that a hinge turns; the body's frame lies at the hinge."""
    return next(i for i, body in enumerate(place.bodies) if any(name == hinge for _, name, _ in body.hinges))


def _tail(place: Layout, body_frames: BodyFrames) -> dict[str, np.ndarray]:
    """Return the positions of the tail's base, every second lateral joint, and the ends of the last segment [m]."""
    driven_hinges = [place.servos[servo] for servo in place.tail_yaw]
    driven_hinges += [hinge for servo in place.cables for hinge in place.cable(servo).hinges]
    bodies = [next(i for i, body in enumerate(place.bodies) if body.name == name) for name in place.tail]
    driven_bodies = sorted({_body_of_hinge(place, hinge) for hinge in driven_hinges} & set(bodies))
    marks = {*driven_bodies[::2], driven_bodies[-1], *(body for body in bodies if body == driven_bodies[-1] + 1)} - {
        bodies[0]
    }
    tail_points = {f"tail_{i}": body_frames.positions[:, body] for i, body in enumerate(sorted(marks), 1)}
    return {"tail_base": body_frames.positions[:, bodies[0]], **tail_points}

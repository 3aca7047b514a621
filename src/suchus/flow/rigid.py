# mypy: disable-error-code="no-untyped-def"
# (the kernels get their types from numba)
"""Rigid shapes in the plane: their points, velocities and fields in the world, by kernels.

A pose comes as a row of numbers: position x and y [m], cosine and sine of the angle [-], velocity x and y [m/s], and
spin [rad/s].
"""

from math import cos, sin

import numpy as np

from suchus.flow.compiled import compiled
from suchus.flow.pose import Pose

PoseRow = tuple[float, float, float, float, float, float, float]
"""Position, cosine and sine of the angle, velocity and spin; see the module."""


def pose_row(pose: Pose) -> PoseRow:
    """Return a pose in the plane as a row of numbers."""
    (x, y), (vx, vy) = pose.position[:2], pose.velocity[:2]
    return float(x), float(y), cos(pose.angle), sin(pose.angle), float(vx), float(vy), float(pose.spin)


@compiled
def to_body_points(body_points, x, y, pose):
    """Write the points of a window in the body's frame.

    Args:
        body_points: to write to, shape (2, y, x) [m].
        x: coordinates of the window's columns [m].
        y: coordinates of its rows [m].
        pose: row of the pose.
    """
    cosine, sine = pose[2], pose[3]
    for j in range(y.size):
        dy = y[j] - pose[1]
        for i in range(x.size):
            dx = x[i] - pose[0]
            body_points[0, j, i] = cosine * dx + sine * dy
            body_points[1, j, i] = cosine * dy - sine * dx


@compiled
def to_world_field(field, normal_x, normal_y, x, y, pose):
    """Write normal and velocity of a rigid body at the points of a window.

    Args:
        field: normal along x and y and velocity along x and y in the world, shape (4, y, x), to write to [-, m/s].
        normal_x: normal along the body's x, shape (y, x) [-].
        normal_y: normal along the body's y, shape (y, x) [-].
        x: coordinates of the window's columns [m].
        y: coordinates of its rows [m].
        pose: row of the pose.
    """
    cosine, sine = pose[2], pose[3]
    for j in range(y.size):
        velocity_x = pose[4] - pose[6] * (y[j] - pose[1])
        for i in range(x.size):
            field[0, j, i] = cosine * normal_x[j, i] - sine * normal_y[j, i]
            field[1, j, i] = sine * normal_x[j, i] + cosine * normal_y[j, i]
            field[2, j, i] = velocity_x
            field[3, j, i] = pose[5] + pose[6] * (x[i] - pose[0])


@compiled
def to_world_skin(points, normals, velocities, centres, body_normals, pose):
    """Write the edges of an outline in the world.

    Args:
        points: middles of the edges, shape (2, edge), to write to [m].
        normals: outward normals, shape (2, edge), to write to [-].
        velocities: velocities of the middles, shape (2, edge), to write to [m/s].
        centres: middles in the body's frame, shape (2, edge) [m].
        body_normals: outward normals in the body's frame, shape (2, edge) [-].
        pose: row of the pose.
    """
    cosine, sine = pose[2], pose[3]
    for k in range(centres.shape[1]):
        dx = cosine * centres[0, k] - sine * centres[1, k]
        dy = sine * centres[0, k] + cosine * centres[1, k]
        points[0, k], points[1, k] = pose[0] + dx, pose[1] + dy
        normals[0, k] = cosine * body_normals[0, k] - sine * body_normals[1, k]
        normals[1, k] = sine * body_normals[0, k] + cosine * body_normals[1, k]
        velocities[0, k], velocities[1, k] = pose[4] - pose[6] * dy, pose[5] + pose[6] * dx


@compiled
def ring_bounds(x, y, pose):
    """Return the smallest rectangle around a ring of points: x0, x1, y0, y1 in the world [m].

    Args:
        x: coordinates in the body's frame, shape (point,) [m].
        y: coordinates in the body's frame, shape (point,) [m].
        pose: row of the pose.
    """
    x0, x1, y0, y1 = np.inf, -np.inf, np.inf, -np.inf
    for k in range(x.size):
        world_x = pose[2] * x[k] - pose[3] * y[k] + pose[0]
        world_y = pose[3] * x[k] + pose[2] * y[k] + pose[1]
        x0, x1, y0, y1 = min(x0, world_x), max(x1, world_x), min(y0, world_y), max(y1, world_y)
    return x0, x1, y0, y1

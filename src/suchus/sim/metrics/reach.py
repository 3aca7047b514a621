"""How high the robot reaches, and how safely it stands there."""

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus.core import rotation
from suchus.robot.design import Robot, Rod, layout
from suchus.robot.kinematics.tree import frames


def reach(robot: Robot, record: xr.Dataset) -> xr.DataArray:
    """Return the height of the highest point of head and trunk over time, whatever part that is [m].

    This is what the robot could touch from below: when it crawls, the top of its back; when it stands, its snout.
    Legs and tail do not count.

    Args:
        robot: robot whose record it is.
        record: record of one run or of several runs of robots with these lengths.
    """
    tops = xr.apply_ufunc(
        lambda q, x, angles: _tops(robot, q, x, angles).max(axis=-1),
        record.orientation,
        record.position,
        record.joint_angle,
        input_core_dims=[["wxyz"], ["xyz"], ["joint"]],
    )
    return tops.assign_attrs(units="m", long_name="highest point of head and trunk")


def _tops(robot: Robot, q: np.ndarray, position: np.ndarray, angles: np.ndarray) -> Float[np.ndarray, "*batch shape"]:
    """Return the highest point of every shape from the root forward [m].

    Args:
        robot: the design.
        q: orientation of the root, shape (..., 4).
        position: position of the root in the world, shape (..., 3) [m].
        angles: angles of the hinges, shape (..., joint) [rad].
    """
    robot_layout, body_frames, up_axis = layout(robot), frames(robot, angles), rotation.upward(q)
    segments = {segment.name: segment for segment in robot_layout.robot.axis}
    tops = []
    for i, body in enumerate(robot_layout.bodies):
        shift = np.array([body.shift, 0.0, 0.0])
        for shape in segments[body.name].shapes if body.name in robot_layout.trunk else ():
            local_up = np.einsum(
                "...i,...ij->...j", up_axis, body_frames.turns[..., i, :, :]
            )  # upward, in the frame of the body
            base = np.einsum("...i,...i", up_axis, body_frames.positions[..., i, :])
            if isinstance(shape, Rod):
                ends = [np.array(end) + shift for end in (shape.start, shape.end)]
                tops.append(base + np.maximum(*(local_up @ end for end in ends)) + shape.radius)
            else:
                centre = np.array(shape.at) + shift
                tops.append(base + local_up @ centre + np.linalg.norm(local_up * np.array(shape.half), axis=-1))
    return np.asarray(position[..., 2, None] + np.stack(tops, axis=-1))


def lead(record: xr.Dataset) -> xr.DataArray:
    """Return how far the centre of mass lies behind the middle of the hind feet, seen along the body [m]."""
    hind = record.foot_position.sel(leg=record.leg.values[-2:], xyz=["x", "y"])
    forward = _forward(hind)
    offset = hind.mean("leg") - record.centre_of_mass.sel(xyz=["x", "y"])
    return (offset * forward).sum("xyz", skipna=False).assign_attrs(units="m")


def static_margin(record: xr.Dataset) -> xr.DataArray:
    """Return how far inside the triangle of hind feet and tail tip the centre of mass is projected [m].

    To the nearest side; negative outside. The tail touches the ground from its tip on, so that the rear corner is the
    most favourable one; the front side, over which a standing robot falls first, does not depend on it.
    """
    feet, xy = record.foot_position, ["x", "y"]
    hind = [feet.isel(leg=i, drop=True).sel(xyz=xy) for i in (-2, -1)]
    corners = [*hind, record.tail_tip.sel(xyz=xy)]
    com = record.centre_of_mass.sel(xyz=xy)
    margins = [
        _left_distance(com, corners[i], corners[(i + 2) % 3]) for i in range(3)
    ]  # clockwise from above: left to tail
    return (
        xr.concat(margins, "side", coords="minimal", compat="override")
        .min("side", skipna=False)
        .assign_attrs(units="m")
    )


def _left_distance(point: xr.DataArray, start: xr.DataArray, end: xr.DataArray) -> xr.DataArray:
    """Return how far a point lies to the left of a line from ``start`` to ``end`` [m]."""
    side, offset = (d.drop_vars("leg", errors="ignore") for d in (end - start, point - start))
    cross = side.sel(xyz="x") * offset.sel(xyz="y") - side.sel(xyz="y") * offset.sel(xyz="x")
    return (cross / np.hypot(side.sel(xyz="x"), side.sel(xyz="y"))).drop_vars("xyz", errors="ignore")


def _forward(hind: xr.DataArray) -> xr.DataArray:
    """Return the direction across the line from the right hind foot to the left one, to the front."""
    foot_line = hind.isel(leg=0, drop=True) - hind.isel(leg=1, drop=True)
    forward = xr.concat([foot_line.sel(xyz="y"), -foot_line.sel(xyz="x")], "xyz", coords="minimal", compat="override")
    forward = forward.assign_coords(xyz=["x", "y"]).drop_vars("leg", errors="ignore")
    return forward / np.sqrt((forward**2).sum("xyz"))


def longest_hold(height: xr.DataArray, min_height: float) -> xr.DataArray:
    """Return the longest time without a break in which a height is at least ``min_height`` [s].

    Args:
        height: height over time [m].
        min_height: height that the samples must reach [m].
    """
    step = float(height.time[1] - height.time[0])

    def longest_run(values: np.ndarray) -> float:
        """Return the duration of the longest run of samples at or above the height [s]."""
        best = run_length = 0
        for value in values:
            run_length = run_length + 1 if value >= min_height else 0
            best = max(best, run_length)
        return max(best - 1, 0) * step

    durations = xr.apply_ufunc(longest_run, height, input_core_dims=[["time"]], vectorize=True, output_dtypes=[float])
    return durations.assign_attrs(units="s")

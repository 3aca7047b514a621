"""Displacement, speed, heading and slip, and what of a displacement a fault takes away."""

import numpy as np
import xarray as xr

from suchus.core import rotation
from suchus.robot.design import GRAVITY
from suchus.robot.design.body import bends_trunk
from suchus.robot.motion import START
from suchus.sim.metrics.contact import contact_path
from suchus.sim.metrics.window import time_window


def displacement(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the displacement of the centre of mass in the world, with the dimension ``xyz`` [m]."""
    com = time_window(record, start, end).centre_of_mass
    return com.isel(time=-1) - com.isel(time=0)


def speed(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the mean speed of the centre of mass along the world's x, where the robot faced at first [m/s].

    Gaits of different cycle times are compared by it: the displacement over equal times counts other numbers of cycles.
    Whoever turns on the way comes less far than the way is long, and on a circle nowhere: see ``path_speed``, and
    ``heading_change`` beside it.
    """
    window = time_window(record, start, end)
    return displacement(record, start, end).sel(xyz="x", drop=True) / float(window.time[-1] - window.time[0])


def heading(record: xr.Dataset) -> xr.DataArray:
    """Return over time where the body heads: the mean direction of the trunk's two ends, left positive [rad]."""
    yaw = xr.apply_ufunc(rotation.yaw, record.orientation, input_core_dims=[["wxyz"]])
    names = [str(name) for name in record.joint.values if bends_trunk(str(name))]
    trunk = sum(record.joint_angle.sel(joint=name) for name in names)
    return xr.apply_ufunc(lambda a: np.unwrap(a, axis=-1), yaw.transpose(..., "time")) + trunk / 2


def heading_change(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return how far the body has turned, left positive [rad]."""
    facing = heading(time_window(record, start, end))
    return facing.isel(time=-1) - facing.isel(time=0)


def path_length(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the length of the path of the centre of mass on the ground, cycle by cycle [m].

    The swaying within a cycle does not count: the path is sampled once per cycle.
    """
    periods = np.unique(record.period)
    if len(periods) > 1:  # each run is sampled at its own period
        lengths = [path_length(record.isel(run=i), start, end) for i in range(record.sizes["run"])]
        return xr.concat(lengths, "run", coords="different", compat="equals")
    path = time_window(record, start, end).centre_of_mass.sel(xyz=["x", "y"]).transpose(..., "time", "xyz")
    stride = max(1, round(float(periods[0]) / float(path.time[1] - path.time[0])))
    points = path.isel(time=slice(None, None, stride))
    if points.sizes["time"] < 2:
        points = path.isel(time=[0, -1])
    return ((points.diff("time") ** 2).sum("xyz") ** 0.5).sum("time")


def path_speed(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the mean speed of the centre of mass along its path on the ground, cycle by cycle [m/s].

    As ``path_length``, of which it is the part of each second, it does not count the swaying within a cycle; it tells
    neither forward from backward nor whether the path closes on itself.
    """
    periods = np.unique(record.period)
    if len(periods) > 1:
        speeds = [path_speed(record.isel(run=i), start, end) for i in range(record.sizes["run"])]
        return xr.concat(speeds, "run", coords="different", compat="equals")
    time = time_window(record, start, end).time
    stride = max(1, round(float(periods[0]) / float(time[1] - time[0])))
    last_sample = stride * ((len(time) - 1) // stride) or -1  # a part of a cycle at the end is not in the path's length
    return path_length(record, start, end) / float(time[last_sample] - time[0])


def slip(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return how far the feet slide under load, over the displacement of the centre of mass [-].

    Sliding is that of the point at which a foot touches the ground: the rolling of its ball does not count. Each foot's
    sliding counts by the share of the weight that the foot carries meanwhile.
    """
    window = time_window(record, start, end)
    steps = contact_path(window).sel(xyz=["x", "y"]).diff("time")
    load_fraction = window.foot_force.sel(xyz="z").isel(time=slice(1, None)) / (window.mass * GRAVITY)
    slid = ((steps**2).sum("xyz") ** 0.5 * load_fraction).sum(["time", "leg"])
    horizontal = displacement(window, start, end).sel(xyz=["x", "y"])
    return slid / (horizontal**2).sum("xyz") ** 0.5


measures = (displacement, heading_change, path_length, path_speed, slip, speed)


def loss(distance: xr.DataArray, intact: xr.DataArray) -> xr.DataArray:
    """Return the change of displacement against an intact run, negative where the fault costs displacement [-]."""
    return distance / intact - 1.0

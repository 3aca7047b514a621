"""How a body turns about its long axis."""

import numpy as np
import xarray as xr

from suchus.core import rotation
from suchus.sim.metrics.window import time_window


def roll_angle(record: xr.Dataset, start: float = 0.0, end: float | None = None) -> xr.DataArray:
    """Return how far the pelvis has turned about the body's mean long axis, without wrapping [rad].

    The long axis is the mean over time of the direction from the tail's tip to the snout. Of the rotation since
    ``start`` only the twist about that axis counts: a pelvis that goes around on a cone and comes back as it was has
    not rolled, though its gyroscope reads a mean rate.

    Args:
        record: record of runs.
        start: start of the measurement, where the angle is zero [s].
        end: end of the measurement [s]; the last sample if None.
    """
    window = time_window(record, start, end)
    body_line = window.snout - window.tail_tip
    axis = (body_line / (body_line**2).sum("xyz") ** 0.5).mean("time")
    axis = axis / (axis**2).sum("xyz") ** 0.5
    orientations = window.orientation.transpose(..., "time", "wxyz").values
    initial_inverse = orientations[..., :1, :] * np.array([1.0, -1.0, -1.0, -1.0])
    since = rotation.multiply(orientations, initial_inverse)
    twist = np.einsum("...tx,...x->...t", since[..., 1:], axis.transpose(..., "xyz").values)
    half = np.unwrap(np.arctan2(twist, since[..., 0]), axis=-1, period=np.pi)
    angle = window.orientation.isel(wxyz=0, drop=True).transpose(..., "time").copy(data=2 * half)
    angle.attrs = {"units": "rad", "long_name": "turned about the long axis"}
    return angle


def roll_rate(record: xr.Dataset, start: float = 0.0, end: float | None = None) -> xr.DataArray:
    """Return the mean rate of roll about the long axis, right side down positive [rad/s].

    Args:
        record: record of runs.
        start: [s]; from there to the end there should be whole cycles.
        end: [s]; the last sample if None.
    """
    angle = roll_angle(record, start, end)
    return (angle.isel(time=-1, drop=True) - angle.isel(time=0, drop=True)) / float(angle.time[-1] - angle.time[0])


measures = (roll_rate,)

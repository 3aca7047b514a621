"""How fast a robot moves and turns in a window of time, and how far that is from what was commanded."""

from typing import NamedTuple

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus.core import rotation
from suchus.sim.metrics import heading, time_window

FALL_LOSS = 3.0
"""Loss of a run that fell over or diverged [-]: that of a robot that goes as fast as it can the wrong way."""
MIN_UPRIGHT = 0.3
"""Vertical component of the root's upward axis below which a robot has fallen [-]."""


class TrackedMotion(NamedTuple):
    """Mean motion of each run in a window of time."""

    speed: Float[np.ndarray, " run"]
    """Mean speed of the centre of mass along the heading [m/s]."""
    turn: Float[np.ndarray, " run"]
    """Slope of the straight line through the heading over time, left positive [rad/s]."""
    has_fallen: np.ndarray
    """Whether it has fallen over, or diverged, before the end of the window, (run,) [-]."""


def motion(record: xr.Dataset, start: float, end: float) -> TrackedMotion:
    """Return how fast each run moves and turns.

    The heading is fitted by a straight line over time, so that the swing of a cycle does not count. The speed is the
    mean of the velocity along that line.

    Args:
        record: record of runs.
        start: beginning of the window [s].
        end: end of the window [s].
    """
    window = time_window(record, start, end)
    time = window.time.values - float(window.time[0])
    facing = heading(window).transpose("run", "time").values
    has_fallen = (window.cause.values != "") | ~np.isfinite(facing).all(axis=1)
    centred = time - time.mean()
    turn = (centred * np.where(np.isfinite(facing), facing, 0.0)).sum(axis=1) / (centred**2).sum()
    line = np.nanmean(np.where(has_fallen[:, None], 0.0, facing), axis=1)[:, None] + turn[:, None] * centred
    position = window.centre_of_mass.sel(xyz=["x", "y"]).transpose("run", "time", "xyz").values
    step = np.diff(position, axis=1)
    direction = 0.5 * (line[:, 1:] + line[:, :-1])
    distance = (step[..., 0] * np.cos(direction) + step[..., 1] * np.sin(direction)).sum(axis=1)
    upright = rotation.upward(window.orientation.transpose("run", "time", "wxyz").values)[..., 2]
    has_fallen |= (np.where(np.isfinite(upright), upright, -1.0) < MIN_UPRIGHT).any(axis=1)
    speed = np.where(has_fallen, 0.0, distance / (time[-1] - time[0]))
    return TrackedMotion(speed, np.where(has_fallen, 0.0, turn), has_fallen)


def tracking_loss(
    measured_motion: TrackedMotion,
    speed: np.ndarray | float,
    turn: np.ndarray | float,
    max_speed: float,
    max_turn: float,
) -> Float[np.ndarray, " run"]:
    """Return the sizes of the errors of speed and turning rate over their greatest commands, summed [-].

    Args:
        measured_motion: motion of the runs.
        speed: commanded speed [m/s].
        turn: commanded turning rate [rad/s].
        max_speed: greatest commanded speed [m/s].
        max_turn: greatest commanded turning rate [rad/s].
    """
    loss = np.abs(measured_motion.speed - speed) / max_speed + np.abs(measured_motion.turn - turn) / max_turn
    return np.where(measured_motion.has_fallen, FALL_LOSS, np.minimum(loss, FALL_LOSS))

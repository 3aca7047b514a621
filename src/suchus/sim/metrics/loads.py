"""What carries the body."""

import numpy as np
import xarray as xr

from suchus.robot.design import GRAVITY
from suchus.robot.motion import START
from suchus.sim.metrics.contact import limb_load
from suchus.sim.metrics.gait import stance
from suchus.sim.metrics.window import time_window


def swing_loads(record: xr.Dataset, leg: str, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return what presses on the ground while a leg is meant to swing: means, with the dimension ``part`` [N].

    The parts are the four legs, ``tail`` and ``belly``.
    """
    window = time_window(record, start, end)
    loads = xr.concat(
        [
            limb_load(window).sel(xyz="z", drop=True).rename(leg="part"),
            window.tail_force.sel(xyz="z", drop=True).expand_dims(part=["tail"]),
            window.belly_force.sel(xyz="z", drop=True).sum("segment").expand_dims(part=["belly"]),
        ],
        "part",
    )
    return loads.where(_swings(window, leg)).mean("time").assign_attrs(units="N")


def swing_lift(record: xr.Dataset, leg: str, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return how far the centre of a foot rises while it is meant to swing: from lowest to highest [m]."""
    window = time_window(record, start, end)
    height = window.foot_position.sel(leg=leg, xyz="z", drop=True).where(_swings(window, leg))
    return (height.max("time") - height.min("time")).assign_attrs(units="m")


def tail_load_share(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return which share of the weight the tail carries, on average [-]."""
    load = time_window(record, start, end).tail_force.sel(xyz="z", drop=True).mean("time")
    return load / (record.mass * GRAVITY)


def swing_height(record: xr.Dataset, leg: str, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the mean height of the centre of mass while a leg is meant to swing [m]."""
    window = time_window(record, start, end)
    height = window.centre_of_mass.sel(xyz="z", drop=True).where(_swings(window, leg))
    return height.mean("time").assign_attrs(units="m")


def swing_unloaded(record: xr.Dataset, leg: str, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the share of the time in which a foot is off the ground while it is meant to swing [-]."""
    window = time_window(record, start, end)
    free = ~stance(window).sel(leg=leg, drop=True)
    return free.where(_swings(window, leg)).mean("time").assign_attrs(units="1")


def _swings(window: xr.Dataset, leg: str) -> xr.DataArray:
    return np.mod(window.limb_phase.sel(leg=leg, drop=True), 1.0) < 1.0 - window.duty_factor


measures = (tail_load_share,)

"""Mechanical work and cost of transport."""

import xarray as xr

from suchus.robot.design import GRAVITY
from suchus.robot.motion import START
from suchus.sim.metrics.progress import displacement
from suchus.sim.metrics.window import time_window

METRES = {
    "land": "on level dry land",
    "ashore": "up the shore, out of the water",
    "wading": "up the shore, wading",
    "surface": "at the surface",
    "deep": "at a depth that is held",
}
"""Endings of the measures of what a metre costs, and in words where that is, from land to depth."""


def work(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the work of all servos, braking counted as much as driving [J]."""
    window = time_window(record, start, end)
    power = abs(window.servo_torque * window.servo_velocity).sum("servo", skipna=False)
    return power.integrate("time")


def cost_of_transport(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the work per weight and displacement along the ground, the cost of transport [-]."""
    horizontal = displacement(record, start, end).sel(xyz=["x", "y"])
    return work(record, start, end) / (record.mass * GRAVITY * (horizontal**2).sum("xyz") ** 0.5)


def peak_torque(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the greatest torque of each servo [N m]."""
    return abs(time_window(record, start, end).servo_torque).max("time")


measures = (cost_of_transport, peak_torque, work)

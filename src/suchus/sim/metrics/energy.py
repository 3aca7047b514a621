"""Mechanical work of the servos, cost of transport, and the torques that heat a servo or may be too great for it."""

import xarray as xr

from suchus.core.errors import IncompatibleRecord
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


def effort(record: xr.Dataset, name: str, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return a variable of ``record.EFFORT`` over the intervals that end in a window of time, dimension ``time``.

    A value belongs to the time between the sample before and its own: the first sample of the window has no part in it.

    Args:
        record: record of one run or several.
        name: one of ``record.EFFORT``.
        start: [s].
        end: [s]; the last sample if None.

    Raises:
        IncompatibleRecord: the record does not hold the variable.
    """
    if name not in record:
        raise IncompatibleRecord(
            f"the record holds no {name}, so that work, cost of transport, peak torque and heat cannot be measured. "
            "Records of earlier versions, of servos over a bus, and of simulate(effort=False) have none. Displacement, "
            "speed, stance and stability can still be measured; for the others simulate the run again."
        )
    return time_window(record, start, end)[name].isel(time=slice(1, None))


def mean_effort(record: xr.Dataset, name: str, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the mean over time of a variable of ``record.EFFORT``; see ``effort``."""
    return effort(record, name, start, end).mean("time", skipna=False)


def work(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the work of all servos, braking counted as much as driving [J]."""
    return _duration(record, start, end) * mean_effort(record, "servo_absolute_power", start, end).sum(
        "servo", skipna=False
    )


def net_work(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the work of all servos on the joints, braking subtracted from driving [J]."""
    return _duration(record, start, end) * mean_effort(record, "servo_power", start, end).sum("servo", skipna=False)


def cost_of_transport(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the work per weight and displacement along the ground, the mechanical cost of transport [-].

    Braking costs as much as driving: the servos win nothing back. ``net_cost_of_transport`` subtracts it.
    """
    return work(record, start, end) / _transport(record, start, end)


def net_cost_of_transport(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the net work per weight and displacement along the ground: that of servos that win back braking [-]."""
    return net_work(record, start, end) / _transport(record, start, end)


def electrical_work(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the energy that all servos draw from their supply: copper and idle losses, and driving work [J].

    Nothing is returned while a servo brakes. It is not a number where a servo has no winding: its losses are not known.
    """
    if "servo_electrical_power" not in record:
        return work(record, start, end) * float("nan")
    window = time_window(record, start, end).servo_electrical_power.isel(time=slice(1, None))
    return _duration(record, start, end) * window.mean("time", skipna=False).sum("servo", skipna=False)


def electrical_cost_of_transport(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the energy from the supply per weight and displacement along the ground [-]; see ``electrical_work``."""
    return electrical_work(record, start, end) / _transport(record, start, end)


def peak_torque(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the greatest torque of each servo in any physics step [N m]."""
    return effort(record, "servo_peak_torque", start, end).max("time", skipna=False)


def rms_torque(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the root mean square of the torque of each servo, which decides on its heat [N m]."""
    return mean_effort(record, "servo_mean_square_torque", start, end) ** 0.5


def _duration(record: xr.Dataset, start: float, end: float | None) -> float:
    """Return the duration of a window of time [s]."""
    time = time_window(record, start, end).time
    return float(time[-1] - time[0])


def _transport(record: xr.Dataset, start: float, end: float | None) -> xr.DataArray:
    """Return weight times displacement along the ground [J]."""
    horizontal = displacement(record, start, end).sel(xyz=["x", "y"])
    return record.mass * GRAVITY * (horizontal**2).sum("xyz") ** 0.5


measures = (
    cost_of_transport,
    electrical_cost_of_transport,
    electrical_work,
    net_cost_of_transport,
    net_work,
    peak_torque,
    rms_torque,
    work,
)

"""Quantities that a search can optimise or limit: a number for each run of a batch."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

import numpy as np
import xarray as xr

from suchus.experiments.optimise.clearance import clearance
from suchus.robot.control import Standing
from suchus.robot.motion import START
from suchus.sim import metrics
from suchus.sim.land import Run

Measured = Callable[[Sequence[Run], xr.Dataset], np.ndarray]
"""From runs and their record to one number for each run."""
_CLEARANCE_INTERVAL = 0.04  # interval between samples of the clearance [s]: a hundredth of the article's cycle


@dataclass(frozen=True, slots=True)
class Kind:
    """A quantity that can be aimed at or limited."""

    measure: Measured
    """Function that measures it from a record."""
    unit: str
    """SI unit, ``-`` for none."""
    good: Literal["more", "less"]
    """Better direction. A limit is the least value where more is better, otherwise the greatest."""
    tells: str
    """Description of the quantity."""
    scale: float = 1.0
    """Unit of excess for a limit of zero, in the unit of the quantity."""


def _forward(runs: Sequence[Run], record: xr.Dataset) -> np.ndarray:
    del runs
    return np.asarray(metrics.displacement(record).sel(xyz="x").values, dtype=float)


def _sideways(runs: Sequence[Run], record: xr.Dataset) -> np.ndarray:
    del runs
    return np.abs(metrics.displacement(record).sel(xyz="y").values.astype(float))


def _cost(runs: Sequence[Run], record: xr.Dataset) -> np.ndarray:
    del runs
    return np.asarray(metrics.cost_of_transport(record).values, dtype=float)


def _height_std(runs: Sequence[Run], record: xr.Dataset) -> np.ndarray:
    del runs
    return np.asarray(metrics.height_std(record).values, dtype=float)


def _roll(runs: Sequence[Run], record: xr.Dataset) -> np.ndarray:
    del runs
    return np.asarray(metrics.roll_peak_to_peak(record).values, dtype=float)


def _turn(runs: Sequence[Run], record: xr.Dataset) -> np.ndarray:
    del runs
    return np.abs(metrics.heading_change(record).values.astype(float))


def _slip(runs: Sequence[Run], record: xr.Dataset) -> np.ndarray:
    del runs
    return np.asarray(metrics.slip(record).values, dtype=float)


def _torque(runs: Sequence[Run], record: xr.Dataset) -> np.ndarray:
    """Return the root mean square of the torque of the highest-loaded servo, over its limit."""
    torque = metrics.rms_torque(record).transpose("run", "servo").values
    names = [str(name) for name in record.servo.values]
    limits = np.array([[run.robot.servo(name).torque for name in names] for run in runs])
    return np.asarray((torque / limits).max(axis=1))


def _clearance(runs: Sequence[Run], record: xr.Dataset) -> np.ndarray:
    """Return the least distance between parts of the body over each run [m]."""
    step = float(record.time[1] - record.time[0])
    sample_interval = max(1, round(_CLEARANCE_INTERVAL / step))
    excerpt = metrics.time_window(record, START)
    clearances = [
        float(clearance(run.robot, excerpt.isel(run=i), sample_interval=sample_interval)) for i, run in enumerate(runs)
    ]
    return np.array(clearances)


def _foot_lift(runs: Sequence[Run], record: xr.Dataset) -> np.ndarray:
    """Return the least lift among the feet [m]."""
    del runs
    return np.asarray(metrics.foot_clearance(record).min("leg").values, dtype=float)


def _max_duty(runs: Sequence[Run], record: xr.Dataset) -> np.ndarray:
    del runs
    return np.asarray(metrics.duty_factor(record).max("leg").values, dtype=float)


def _min_duty(runs: Sequence[Run], record: xr.Dataset) -> np.ndarray:
    del runs
    return np.asarray(metrics.duty_factor(record).min("leg").values, dtype=float)


def _standing(runs: Sequence[Run], record: xr.Dataset) -> np.ndarray:
    """Return the least height reached while it should stand [m]; zero for a run without standing."""
    seconds = np.zeros(len(runs))
    for i, run in enumerate(runs):
        if isinstance(run.control, Standing):
            height = metrics.reach(run.robot, record.isel(run=i))
            start, end = run.control.upright_from(run.robot), run.control.upright_until(run.robot)
            standing_height = height.sel(time=slice(start, end))
            seconds[i] = float(standing_height.min()) if standing_height.sizes["time"] else 0.0
    return seconds


AIMS: Mapping[str, Kind] = MappingProxyType(
    {
        "displacement": Kind(_forward, "m", "more", "displacement of the centre of mass along the first heading"),
        "cost_of_transport": Kind(_cost, "-", "less", "work of the servos over weight times displacement"),
        "stability": Kind(_height_std, "m", "less", "standard deviation of the height of the centre of mass"),
        "roll": Kind(_roll, "rad", "less", "greatest less least roll of the pelvis"),
        "turning": Kind(_turn, "rad", "more", "change of heading, to whichever side"),
        "foot_lift": Kind(_foot_lift, "m", "more", "lift of the foot that is lifted least"),
        "standing_reach": Kind(_standing, "m", "more", "least height reached while standing on hind legs and tail"),
    }
)
"""Quantities that a search can optimise, by name."""
LIMITS: Mapping[str, Kind] = MappingProxyType(
    {
        "torque": Kind(_torque, "-", "less", "root mean square torque of the highest-loaded servo over its limit"),
        "slip": Kind(_slip, "-", "less", "sliding of loaded feet over displacement"),
        "clearance": Kind(_clearance, "m", "more", "least distance between parts of the body", 0.01),
        "turn": Kind(_turn, "rad", "less", "change of heading", 0.1),
        "sideways": Kind(_sideways, "m", "less", "displacement across the first heading", 0.1),
        "roll": Kind(_roll, "rad", "less", "greatest less least roll of the pelvis", 0.1),
        "cost_of_transport": Kind(_cost, "-", "less", "work of the servos over weight times displacement"),
        "displacement": Kind(_forward, "m", "more", "displacement along the first heading", 0.1),
        "foot_lift": Kind(_foot_lift, "m", "more", "lift of the foot that is lifted least", 0.01),
        "duty_greatest": Kind(_max_duty, "-", "less", "share of the time in which the foot stands that stands most"),
        "duty_least": Kind(_min_duty, "-", "more", "share of the time in which the foot stands that stands least"),
    }
)
"""Quantities that a search can limit, by name."""

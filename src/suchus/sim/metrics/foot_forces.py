"""The force of the ground on single feet over the mean cycle, as published for animals: in body weights."""

from collections.abc import Mapping
from math import nan
from typing import NamedTuple

import numpy as np
import xarray as xr

from suchus.robot.design import GRAVITY
from suchus.sim.metrics.contact import limb_load
from suchus.sim.metrics.gait import MIN_STANCE_FRACTION, without_short_intervals
from suchus.sim.metrics.window import mean_cycle

PARTS = ("vertical", "sideways", "foreaft")
"""Components of a foot's force: up, toward the midline of the course, along the course."""


class Window(NamedTuple):
    """Window of whole cycles in one run."""

    start: float
    """Time at which the first cycle begins [s]."""
    period: float
    """Period of a cycle [s]."""
    cycles: int
    """Number of cycles [-]."""

    @property
    def end(self) -> float:
        """Time at which the last cycle ends [s]."""
        return self.start + self.cycles * self.period


def weight(record: xr.Dataset) -> float:
    """Return the weight of the robot of one run [N]."""
    return float(record.mass) * GRAVITY


def displacement_per_cycle(record: xr.Dataset, window: Window) -> np.ndarray:
    """Return the mean displacement of the centre of mass in a cycle, along x and y of the world, shape (2,) [m].

    Args:
        record: record of one run.
        window: whole cycles over which the mean is taken.
    """
    centre_of_mass = record.centre_of_mass.sel(xyz=["x", "y"]).transpose("time", "xyz").values
    start_position, end_position = (
        np.array([np.interp(t, record.time.values, column) for column in centre_of_mass.T])
        for t in (window.start, window.end)
    )
    return np.asarray(end_position - start_position) / window.cycles


def stance_forces(record: xr.Dataset, window: Window) -> xr.DataArray:
    """Return the mean cycle of the force on each foot and its limb, ``phase leg part`` [body weight].

    ``vertical`` up, ``sideways`` toward the midline of the course, ``foreaft`` along the course.
    """
    force = mean_cycle(limb_load(record), *window) / weight(record)
    return _in_course_frame(force, record, window)


def _in_course_frame(force: xr.DataArray, record: xr.Dataset, window: Window) -> xr.DataArray:
    """Return the components of a force along the course of a run: up, toward the midline, forward."""
    forward, leftward = displacement_per_cycle(record, window)
    size = np.hypot(forward, leftward)
    c, s = (forward / size, leftward / size) if size > 0 else (1.0, 0.0)
    x, y, z = (force.sel(xyz=axis, drop=True) for axis in "xyz")
    side = xr.DataArray([1.0 if str(leg).startswith("L") else -1.0 for leg in force.leg.values], dims="leg")
    parts = [z, -side * (c * y - s * x), c * x + s * y]
    return xr.concat(parts, xr.DataArray(list(PARTS), dims="part", name="part"))


class FootStep(NamedTuple):
    """What the ground does to one foot in its mean stance."""

    net: float
    """Greatest net force [body weight]."""
    parts: Mapping[str, float]
    """Its components at that instant, by ``PARTS`` [body weight]."""
    time: float
    """Time of that instant as a fraction of stance [-]."""
    stance: float
    """Duration of the stance that holds it [cycle]."""


def step(force: xr.DataArray, min_force: float) -> FootStep:
    """Return what stands out in the force on one foot over a cycle.

    Its stance is the interval around the greatest net force. Gaps shorter than ``MIN_STANCE_FRACTION`` of the cycle, in
    which a foot on stiff ground bounces, belong to it.

    Args:
        force: force of one foot, ``phase part`` [body weight].
        min_force: vertical force from which it stands [body weight].
    """
    parts = {name: force.sel(part=name).values for name in PARTS}
    net = np.sqrt(sum(component**2 for component in parts.values()))
    top, count = int(np.argmax(net)), len(net)
    stands = np.roll(parts["vertical"], -top) > min_force  # begins at the peak
    closed = np.append(stands, stands[0])  # ends at the peak too, so that a gap just before it is between stances
    stands = without_short_intervals(closed, round(MIN_STANCE_FRACTION * count), values=(False,))[:-1]
    samples_after = count if stands.all() else int(np.argmin(stands))
    samples_before = 0 if stands.all() else int(np.argmin(stands[::-1]))
    length = min(samples_after + samples_before, count)
    return FootStep(
        net=float(net[top]),
        parts={name: float(component[top]) for name, component in parts.items()},
        time=samples_before / length if length else nan,
        stance=length / count,
    )

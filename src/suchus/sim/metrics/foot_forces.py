"""The force of the ground on single feet over the mean cycle, as published for animals: in body weights."""

from collections.abc import Mapping
from math import nan
from typing import NamedTuple

import numpy as np
import xarray as xr

from suchus.robot.design import GRAVITY
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


def advance(record: xr.Dataset, when: Window) -> np.ndarray:
    """Return how far the centre of mass of one run comes over the ground in a cycle, forward and left [m]."""
    place = record.centre_of_mass.sel(xyz=["x", "y"]).transpose("time", "xyz").values
    first, last = (
        np.array([np.interp(t, record.time.values, column) for column in place.T]) for t in (when.start, when.end)
    )
    return np.asarray(last - first) / when.cycles


def stance_forces(record: xr.Dataset, when: Window) -> xr.DataArray:
    """Return the mean cycle of the force on each foot, ``phase leg part`` [body weight].

    ``vertical`` up, ``sideways`` toward the midline of the course, ``foreaft`` along the course.
    """
    force = mean_cycle(record.foot_force, *when) / weight(record)
    return _turned(force, record, when)


def _turned(force: xr.DataArray, record: xr.Dataset, when: Window) -> xr.DataArray:
    along, left = advance(record, when)
    size = np.hypot(along, left)
    c, s = (along / size, left / size) if size > 0 else (1.0, 0.0)
    x, y, z = (force.sel(xyz=one, drop=True) for one in "xyz")
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
    """That instant as a share of stance [-]."""
    stance: float
    """Duration of the stance that holds it [cycle]."""


def step(force: xr.DataArray, least: float) -> FootStep:
    """Return what stands out in the force on one foot over a cycle.

    Args:
        force: of one foot, ``phase part`` [body weight].
        least: vertical force from which it stands [body weight].
    """
    parts = {name: force.sel(part=name).values for name in PARTS}
    net = np.sqrt(sum(one**2 for one in parts.values()))
    top, count = int(np.argmax(net)), len(net)
    stands = np.roll(parts["vertical"], -top) > least  # begins at the peak
    after = count if stands.all() else int(np.argmin(stands))
    before = 0 if stands.all() else int(np.argmin(stands[::-1]))
    length = min(after + before, count)
    return FootStep(
        net=float(net[top]),
        parts={name: float(one[top]) for name, one in parts.items()},
        time=before / length if length else nan,
        stance=length / count,
    )

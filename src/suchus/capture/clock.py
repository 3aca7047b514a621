"""A clock that follows the animal's pace: on it every stride lasts equally long, cut by the feet's own swings."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.capture.swings import Middles

_LEAST = 6  # swings of all feet together below which pace cannot be told from noise
_TOGETHER = 4  # swings whose mean is one mark of the clock: noise and a limping foot weigh little then


class Clock(NamedTuple):
    """Times and how many cycles had passed then; in between and beyond it goes on evenly."""

    time: Float[np.ndarray, " mark"]
    """Increasing [s]."""
    cycles: Float[np.ndarray, " mark"]
    """Increasing [cycle]."""
    period: float
    """Mean of a cycle [s]."""

    def read(self, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
        """Return what the clock shows, in mean periods [s]."""
        inside = np.interp(time, self.time, self.cycles)
        beyond = np.minimum(time - self.time[0], 0.0) + np.maximum(time - self.time[-1], 0.0)
        return np.asarray(self.period * inside + beyond)

    def seconds(self, cycles: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
        """Return when the clock shows so many cycles [s]."""
        inside = np.interp(cycles, self.cycles, self.time)
        beyond = np.minimum(cycles - self.cycles[0], 0.0) + np.maximum(cycles - self.cycles[-1], 0.0)
        return np.asarray(inside + self.period * beyond)


def paced(feet: Mapping[str, Middles], period: float) -> Clock:
    """Return the clock of a walk; an even one where too few swings were seen.

    Every foot counts its own swings; the phase lag of each other foot behind the first one is the same in all
    cycles on the clock.

    Args:
        feet: the middles of their swings.
        period: of a cycle, roughly [s].
    """
    rows = [foot for foot in feet.values() if len(foot.time) >= 2]
    if sum(len(foot.time) for foot in rows) < _LEAST:
        return Clock(np.array([0.0, period]), np.array([0.0, 1.0]), period)
    first = max(rows, key=lambda foot: (len(foot.time), -float(foot.error.mean())))
    lasts = float(np.median(np.diff(first.time)))
    counted = _counted(first.time, lasts)
    even = Clock(first.time, counted, (first.time[-1] - first.time[0]) / (counted[-1] - counted[0]))
    times, cycles, weights = [], [], []
    for foot in rows:
        shown = even.read(foot.time) / even.period
        lag = np.angle(np.mean(np.exp(2j * np.pi * shown))) / (2 * np.pi)
        times.append(foot.time)
        cycles.append(np.round(shown - lag) + lag)
        weights.append(1.0 / (foot.error**2 + (0.01 * lasts) ** 2))
    time, cycle, weight = (np.concatenate(part) for part in (times, cycles, weights))
    order = np.argsort(cycle, kind="stable")
    return _marked(time[order], cycle[order], weight[order])


def _counted(time: np.ndarray, lasts: float) -> np.ndarray:
    """Number the swings of a foot; one that was not seen is passed over."""
    return np.concatenate([[0.0], np.cumsum(np.maximum(1.0, np.round(np.diff(time) / lasts)))])


def _marked(time: np.ndarray, cycle: np.ndarray, weight: np.ndarray) -> Clock:
    """Put swings that follow each other together, and draw the clock through their means."""
    ones = np.ones(min(_TOGETHER, len(time) - 1))
    total = np.convolve(weight, ones, mode="valid")
    at = np.convolve(weight * time, ones, mode="valid") / total
    shows = np.convolve(weight * cycle, ones, mode="valid") / total
    steps = [np.diff(np.maximum.accumulate(row)) > 0 for row in (at, shows)]
    rises = np.concatenate([[True], steps[0] & steps[1]])
    slope = np.polyfit(time, cycle, 1, w=np.sqrt(weight))[0]
    return Clock(at[rises], shows[rises], float(1.0 / slope))

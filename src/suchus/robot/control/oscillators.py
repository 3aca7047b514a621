"""Coupled phase oscillators: their parameters, their couplings, and their integration.

After Ijspeert, Crespi, Ryczko and Cabelguen 2007 (Science 315, 1416): every oscillator i has a phase and an amplitude,

    phase_i' = 2 pi f_i + sum_j r_j w_ij sin(phase_j - phase_i - bias_ij)
    r_i''    = a (a/4 (R_i - r_i) - r_i')
    x_i      = r_i (1 + cos phase_i)

whose own frequency f and amplitude R are straight lines in a drive, and zero outside its range.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int

from suchus.core.checks import Checks
from suchus.core.errors import OutsideLimits, UnknownName

PUBLISHED_SEGMENTS = 8
"""Segments of the axis for which the published weights were chosen [-]."""
_STEP = 0.16
"""Integration step times the fastest rate of the network [-]; 5 ms for the published numbers.

Measured: a tenth of this step changes the phases of a lock from random starts by less than 1e-4 cycle, and nothing of
the locked state; four times the step still locks.
"""

Line = tuple[float, float]
"""A straight line: its value at drive 0 and its slope."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Oscillators:
    """The numbers of the oscillators.

    The defaults are those of the supporting table of Ijspeert et al. 2007, written down from memory; a public
    re-implementation read beside it agrees in all but the two amplitudes at drive 0, which it gives as 1.0 more.
    """

    rate: float = 20.0
    """Rate at which an amplitude approaches its own, critically damped: a of the equations [1/s]."""
    axis_weight: float = 10.0
    """Weight of the coupling between neighbours on the same side of the axis, in both directions [1/s]."""
    sides_weight: float = 10.0
    """Weight of the coupling between left and right of a segment of the axis [1/s]."""
    limb_axis_weight: float = 30.0
    """Weight of the coupling from a limb to its part of the axis, in that direction only [1/s]."""
    limb_weight: float = 10.0
    """Weight of the coupling between the limbs of a girdle, and between those of a side on neighbouring girdles
    [1/s]."""
    axis_frequency: Line = (0.3, 0.2)
    """Own frequency of the axis at drive 0, and its slope over the drive [Hz]."""
    axis_amplitude: Line = (0.196, 0.065)
    """Own amplitude of the axis at drive 0, and its slope over the drive [-]."""
    axis_drives: tuple[float, float] = (1.0, 5.0)
    """Drives between which the axis is active [-]."""
    limb_frequency: Line = (0.0, 0.2)
    """Own frequency of the limbs at drive 0, and its slope over the drive [Hz]."""
    limb_amplitude: Line = (0.131, 0.131)
    """Own amplitude of the limbs at drive 0, and its slope over the drive [-]."""
    limb_drives: tuple[float, float] = (1.0, 3.0)
    """Drives between which the limbs are active; they fall silent at a lower drive than the axis [-]."""

    def __post_init__(self) -> None:
        with Checks("oscillators", self) as check:
            check.number("rate", 0.1, 1e4, "1/s")
            for name in ("axis_weight", "sides_weight", "limb_axis_weight", "limb_weight"):
                check.number(name, 0.0, 1e4, "1/s")
            for name, unit in (("frequency", "Hz"), ("amplitude", "")):
                for group in ("axis", "limb"):
                    check.each(f"{group}_{name}", ("value", "slope"), 0.0, 100.0, unit)
            check.range("axis_drives", 0.0, 100.0, "")
            check.range("limb_drives", 0.0, 100.0, "")

    def axis(self, drive: Float[np.ndarray, "*b"]) -> tuple[Float[np.ndarray, "*b"], Float[np.ndarray, "*b"]]:
        """Return own frequency [Hz] and amplitude [-] of the axis at some drives."""
        return _lines(drive, self.axis_drives, self.axis_frequency, self.axis_amplitude)

    def limbs(self, drive: Float[np.ndarray, "*b"]) -> tuple[Float[np.ndarray, "*b"], Float[np.ndarray, "*b"]]:
        """Return own frequency [Hz] and amplitude [-] of the limbs at some drives."""
        return _lines(drive, self.limb_drives, self.limb_frequency, self.limb_amplitude)

    @property
    def reference(self) -> float:
        """The mean drive of the limbs' range, at which a gait's own period and bends apply [-]."""
        return (self.limb_drives[0] + self.limb_drives[1]) / 2


class Couplings(NamedTuple):
    """Couplings of the oscillators, one entry for each direction, sorted by receiver."""

    names: tuple[str, ...]
    """Names of the oscillators: ``axis_1_left`` from the head, then those on the right, then the limbs."""
    receiver: Int[np.ndarray, " edge"]
    """Number of the oscillator that is driven."""
    sender: Int[np.ndarray, " edge"]
    """Number of the oscillator that drives it."""
    weight: Float[np.ndarray, " edge"]
    """Strength of the coupling [1/s]."""
    bias: Float[np.ndarray, " edge"]
    """Phase lead of the sender at which the coupling vanishes [rad]."""


class LimbCoupling(NamedTuple):
    """A segment of the axis as the oscillators see it."""

    girdle: int
    """Number of the girdle whose limbs drive it; -1 without limbs."""
    phase_lag: float
    """Phase lag of its bend behind those limbs [cycle]."""


def couple(
    numbers: Oscillators, axis: Sequence[LimbCoupling], limbs: Sequence[str], phases: Sequence[float], lag: float
) -> Couplings:
    """Return the couplings of a body.

    Neighbours on the axis keep a lag from head to tail, and left and right sides alternate. Each limb drives its side
    of its part of the axis. Limbs keep the phases of a gait against the limb on the other side and the next limb on
    their own side; in a diagonal gait these are half a cycle, as published. On an axis of more segments than the
    published one the weights of the axis grow with the square of the number of segments, as the locking time of a chain
    of oscillators does.

    Args:
        numbers: parameters of the oscillators.
        axis: its segments, from head to tail.
        limbs: names of the limbs, girdle by girdle from the front, left before right.
        phases: phases of the limbs in the gait [cycle].
        lag: phase lag of each segment behind the one ahead of it [cycle].
    """
    n = len(axis)
    stiff = max(1.0, (n / PUBLISHED_SEGMENTS) ** 2)
    edges: list[tuple[int, int, float, float]] = []

    def couple_pair(leader: int, follower: int, weight: float, phase_lag: float) -> None:
        """Couple two oscillators in both directions; the follower lags the leader by ``phase_lag`` [cycle]."""
        edges.append((follower, leader, weight, 2 * pi * phase_lag))
        edges.append((leader, follower, weight, -2 * pi * phase_lag))

    for k in range(n):
        couple_pair(k, n + k, stiff * numbers.sides_weight, 0.5)
    for k in range(1, n):
        for side in (0, n):
            couple_pair(side + k - 1, side + k, stiff * numbers.axis_weight, lag)
    for i in range(0, len(limbs), 2):
        couple_pair(2 * n + i, 2 * n + i + 1, numbers.limb_weight, phases[i] - phases[i + 1])
    for i in range(2, len(limbs)):
        couple_pair(2 * n + i - 2, 2 * n + i, numbers.limb_weight, phases[i - 2] - phases[i])
    for k, segment in enumerate(axis):
        for limb in range(len(limbs)):  # limbs of other girdles get weight 0, so that equal bodies have equal edges
            girdle, side = divmod(limb, 2)
            weight = stiff * numbers.limb_axis_weight if girdle == segment.girdle else 0.0
            edges.append((side * n + k, 2 * n + limb, weight, 2 * pi * segment.phase_lag))
    edges.sort()
    receiver, sender, weights, biases = (np.array(column) for column in zip(*edges, strict=True))
    names = [f"axis_{k + 1}_{side}" for side in ("left", "right") for k in range(n)]
    return Couplings((*names, *limbs), receiver, sender, weights.astype(float), biases.astype(float))


def cut_couplings(couplings: Couplings, lesions: Sequence[tuple[str, str]]) -> Couplings:
    """Return the couplings with the weights of some set to zero, in both directions.

    Args:
        couplings: the couplings.
        lesions: pairs of names: of an oscillator (``axis_3_left``, ``LF``), of both sides of a segment (``axis_3``), or
            of many (``axis``, ``left``, ``right`` for one side of the axis, ``limbs``).

    Raises:
        UnknownName: there is no such oscillator.
        OutsideLimits: nothing couples the two.
    """
    weight = couplings.weight.copy()
    for first_name, second_name in lesions:
        a, b = (
            np.isin(np.arange(len(couplings.names)), _select_oscillators(couplings.names, name))
            for name in (first_name, second_name)
        )
        is_cut = (a[couplings.receiver] & b[couplings.sender]) | (b[couplings.receiver] & a[couplings.sender])
        if not couplings.weight[is_cut].any():
            raise OutsideLimits(
                f"no coupling joins {first_name!r} and {second_name!r}, so that none can be cut: name neighbours."
            )
        weight[is_cut] = 0.0
    return couplings._replace(weight=weight)


def _select_oscillators(names: Sequence[str], name: str) -> list[int]:
    """Return the indices of the oscillators that a name stands for; see ``cut``."""
    axis = [i for i, label in enumerate(names) if label.startswith("axis_")]
    sets = {"axis": axis, "limbs": [i for i in range(len(names)) if i not in axis]}
    sets |= {side: [i for i in axis if names[i].endswith(f"_{side}")] for side in ("left", "right")}
    sets |= {f"axis_{k + 1}": [k, len(axis) // 2 + k] for k in range(len(axis) // 2)}
    sets |= {label: [i] for i, label in enumerate(names)}
    if name not in sets:
        raise UnknownName("oscillator", name, sets)
    return sets[name]


class Rhythm:
    """The oscillators of a batch of equal bodies, integrated by Heun's method.

    Each run takes as many steps as its own couplings need, so that its result does not depend on the batch.

    Args:
        couplings: one for each run; they may differ in weights and biases.
        numbers: one for each run.
        pace: how many times faster than published everything goes, one for each run [-].
        phase: phase in which they begin [rad].
        amplitude: amplitude with which they begin [-].
        period: period over which they advance at a time [s].
    """

    def __init__(
        self,
        couplings: Sequence[Couplings],
        numbers: Sequence[Oscillators],
        pace: Float[np.ndarray, " run"],
        phase: Float[np.ndarray, "run oscillator"],
        amplitude: Float[np.ndarray, "run oscillator"],
        period: float,
    ) -> None:
        self.phase = phase
        self.amplitude = amplitude
        self._rise = np.zeros_like(amplitude)
        template = couplings[0]
        self._receiver, self._sender = template.receiver, template.sender
        self._starts = np.searchsorted(template.receiver, np.arange(len(template.names)))
        self._weight = np.stack([edges.weight for edges in couplings])
        self._bias = np.stack([edges.bias for edges in couplings])
        self._rate = np.array([parameters.rate for parameters in numbers])[:, None]
        self._steps = [
            steps_needed(edges, parameters, speed, period)
            for edges, parameters, speed in zip(couplings, numbers, pace, strict=True)
        ]
        self._step = (period * pace / np.array(self._steps))[:, None]

    def advance(
        self,
        frequency: Float[np.ndarray, "run oscillator"],
        amplitude: Float[np.ndarray, "run oscillator"],
    ) -> None:
        """Integrate one period of the published clock times the pace.

        Args:
            frequency: own frequencies, feedback included [Hz].
            amplitude: own amplitudes [-].
        """
        natural_rate = 2 * pi * frequency
        step_counts = np.array(self._steps)[:, None]
        for step in range(max(self._steps)):
            h = np.where(step < step_counts, self._step, 0.0)
            start_slopes = self._slopes(natural_rate, amplitude, self.phase, self.amplitude, self._rise)
            predicted_state = (
                y + h * dy for y, dy in zip((self.phase, self.amplitude, self._rise), start_slopes, strict=True)
            )
            end_slopes = self._slopes(natural_rate, amplitude, *predicted_state)
            self.phase, self.amplitude, self._rise = (
                y + h / 2 * (a + b)
                for y, a, b in zip((self.phase, self.amplitude, self._rise), start_slopes, end_slopes, strict=True)
            )

    def _slopes(
        self, natural_rate: np.ndarray, target: np.ndarray, phase: np.ndarray, amplitude: np.ndarray, rise: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the time derivatives of phase, amplitude and amplitude rate, each of shape (run, oscillator).

        Args:
            natural_rate: own angular frequency of each oscillator [rad/s].
            target: own amplitude of each oscillator [-].
            phase: present phases [rad].
            amplitude: present amplitudes [-].
            rise: present rates of the amplitudes [1/s].
        """
        phase_difference = phase[:, self._sender] - phase[:, self._receiver] - self._bias
        pulls = amplitude[:, self._sender] * self._weight * np.sin(phase_difference)
        turning = natural_rate + np.add.reduceat(pulls, self._starts, axis=1)
        return turning, rise, self._rate * (self._rate / 4 * (target - amplitude) - rise)


def steps_needed(couplings: Couplings, numbers: Oscillators, pace: float, period: float) -> int:
    """Return the number of integration steps of a period, from the fastest rate of the network.

    Args:
        couplings: couplings of the network.
        numbers: parameters of its oscillators.
        pace: how many times faster than published it goes [-].
        period: [s].
    """
    max_amplitude = max(
        line[0] + line[1] * drives[1]
        for line, drives in (
            (numbers.axis_amplitude, numbers.axis_drives),
            (numbers.limb_amplitude, numbers.limb_drives),
        )
    )
    max_pull = np.bincount(couplings.receiver, couplings.weight).max() * max_amplitude
    return max(1, int(np.ceil(period * pace * max(numbers.rate, max_pull) / _STEP)))


def _lines(
    drive: np.ndarray, drives: tuple[float, float], frequency: Line, amplitude: Line
) -> tuple[np.ndarray, np.ndarray]:
    active = (drive >= drives[0]) & (drive <= drives[1])
    return tuple(np.where(active, line[0] + line[1] * drive, 0.0) for line in (frequency, amplitude))  # type: ignore[return-value]

"""When feet stand, from how fast they move over the ground, and how far legs swing in their girdle's frame."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from suchus.capture.angles import azimuth
from suchus.capture.cycle import fit, harmonics_for
from suchus.capture.tracks import Tracks, UnusableTracks

GRID = 400
"""Phases of a cycle at which a foot is looked at [-]."""
MOVING = 0.15
"""Share of its top speed from which a foot moves [-]; a foot that stands may creep."""
_DUTIES = np.round(np.arange(0.30, 0.91, 0.01), 2)  # that a path is compared with
_TOP = 14  # harmonics of a foot's way; enough for the jerk of lifting off
_LOUD = 3.0  # times the uncertainty of the speed that a moving foot must exceed
_RUN_UP = 0.025  # [cycle]; the rise to ``MOVING`` and to twice it lie no farther apart, or it is a slip before it
_BLURRED = 0.45  # share of the top speed at which noise hides the steps


class Contact(NamedTuple):
    """One foot over its mean cycle; phases count from time zero of the tracks [cycle]."""

    speed: Float[np.ndarray, " grid"]
    """Over the ground [m/s or px/s]."""
    stance: Bool[np.ndarray, " grid"]
    """Whether it stands."""
    lift_off: float
    """Phase at which it begins to swing."""
    touch_down: float
    """Phase at which it begins to stand."""
    middle: float
    """Phase of the middle of its stance, half a cycle from the middle of its fast movement."""

    @property
    def duty(self) -> float:
        """Share of the cycle in which it stands [-]."""
        return (self.lift_off - self.touch_down) % 1.0


class Sweep(NamedTuple):
    """How one foot moves against its girdle over the mean cycle."""

    forward: Float[np.ndarray, " grid"]
    """How far it is ahead of the girdle [m or px]."""
    outward: float
    """Mean distance from the midline [m or px]."""
    lift: float
    """How high it is lifted over the ground [m or px]; NaN where no heights were seen."""
    stroke: float
    """Half of the way that it goes back [m or px], by the gait's path that fits best: see ``path_shape``."""
    retraction: float
    """Share of the cycle in which it goes back [-], by the same path."""


def grid() -> Float[np.ndarray, " grid"]:
    """Return the phases at which a foot is looked at [cycle]."""
    return np.arange(GRID) / GRID


def contact(tracks: Tracks, leg: str, period: float) -> Contact:
    """Return when a foot stands in the mean cycle.

    Its ways along x and y are fitted with drift and harmonics; it swings in the longest stretch in which the speed of
    that fit exceeds twice ``MOVING`` of its maximum. Shorter stretches are slips. Either edge of the swing is where
    the rise of the speed, drawn from that threshold and half of it, meets zero: right for a foot that starts smoothly
    as well as for one that starts with a jerk.

    Args:
        tracks: the keypoints.
        leg: of ``LEGS``.
        period: of the cycle [s].

    Raises:
        UnusableTracks: noise hides the steps.
    """
    place, time = tracks.at(leg)[:, :2], tracks.time
    count = _harmonics(tracks, leg, period, _TOP)
    fits = [fit(time, place[:, i], period, harmonics=count, drift=_drift(tracks, period)) for i in (0, 1)]
    phase = grid()
    velocity = [one.swing(phase * period, derivative=1) + one.drift[0] for one in fits]
    speed = np.hypot(velocity[0], velocity[1])
    top = float(speed.max())
    w = 2 * np.pi / period
    blur = float(np.hypot(fits[0].error, fits[1].error)) * w * np.sqrt(np.sum(np.arange(1, count + 1) ** 2) / 2)
    moving = max(MOVING * top, _LOUD * blur)
    if moving > _BLURRED * top:
        raise UnusableTracks(
            f"in {tracks.source} the noise of {leg} hides its steps: its speed is uncertain by "
            f"{100 * blur / top:.0f} % of its maximum, at most {100 * _BLURRED / _LOUD:.0f} % may be; film more "
            "cycles, faster, or nearer."
        )
    start, length = _longest(speed > 2 * moving)
    outward = np.arange(GRID // 2)
    lift_off = (start - _edge(speed[(start - outward) % GRID], moving)) / GRID
    last = start + length - 1
    touch_down = (last + _edge(speed[(last + outward) % GRID], moving)) / GRID
    stance = (phase - touch_down) % 1.0 < (lift_off - touch_down) % 1.0
    fast = [_crossing(speed[at % GRID], 2 * moving) for at in (start - outward, last + outward)]
    middle = (start + last + fast[1] - fast[0]) / 2 / GRID + 0.5  # noise moves these edges least
    return Contact(speed, stance, lift_off % 1.0, touch_down % 1.0, middle % 1.0)


def _edge(speed: np.ndarray, moving: float) -> float:
    """Return where a falling speed, drawn through twice ``moving`` and ``moving``, meets zero [steps of the grid]."""
    fast, slow = (_crossing(speed, level) for level in (2 * moving, moving))
    return fast + 2 * min(slow - fast, _RUN_UP * GRID)


def _crossing(speed: np.ndarray, level: float) -> float:
    """Return where a speed first falls to a level [steps]; its end if it never does."""
    below = speed <= level
    if not below.any():
        return float(len(speed))
    i = int(np.argmax(below))
    return i - float((level - speed[i]) / (speed[i - 1] - speed[i]))


def sweep(tracks: Tracks, leg: str, period: float) -> Sweep:
    """Return how a foot moves in the frame of its girdle, whose direction is smoothed over the cycle.

    Args:
        tracks: the keypoints.
        leg: of ``LEGS``.
        period: of the cycle [s].
    """
    ahead, behind = tracks.thorax if leg.endswith("F") else ("hip", "tail_base")
    origin = "shoulder" if leg.endswith("F") else "hip"
    look = smooth_azimuth(tracks, ahead, behind, period)
    d = tracks.at(leg) - tracks.at(origin)
    forward = d[:, 0] * np.cos(look) + d[:, 1] * np.sin(look)
    outward = (d[:, 1] * np.cos(look) - d[:, 0] * np.sin(look)) * (1 if leg.startswith("L") else -1)
    count = _harmonics(tracks, leg, period, 8)
    path = fit(tracks.time, forward, period, harmonics=count)
    lift = float("nan")
    if tracks.upright:
        lift = float(np.ptp(fit(tracks.time, tracks.at(leg)[:, 2], period, harmonics=count).swing(grid() * period)))
    way = path.mean + path.swing(grid() * period)
    return Sweep(way, float(np.nanmean(outward)), lift, *_fitting_path(way))


def path_shape(duty: float) -> Float[np.ndarray, " grid"]:
    """Return how far ahead a foot is in a gait of stroke one: half a cosine forward, then straight back [-].

    Args:
        duty: share of the cycle in which it goes back [-].
    """
    swing = 1.0 - duty
    phase = grid()
    return np.where(phase < swing, -np.cos(np.pi * phase / swing), 1.0 - 2.0 * (phase - swing) / duty)


def _fitting_path(ahead: Float[np.ndarray, " grid"]) -> tuple[float, float]:
    """Return stroke and duty factor of the gait's path that comes nearest to a foot's, at whatever phase."""
    seen = np.fft.rfft(ahead - ahead.mean())
    best = (-np.inf, 0.0, 0.5)
    for duty in _DUTIES:
        shape = path_shape(duty)
        shape = shape - shape.mean()
        power = float(shape @ shape)
        likeness = float(np.fft.irfft(seen * np.conj(np.fft.rfft(shape)), GRID).max())
        best = max(best, (likeness**2 / power, likeness / power, float(duty)))
    return best[1], best[2]


def smooth_azimuth(tracks: Tracks, ahead: str, behind: str, period: float) -> Float[np.ndarray, " frame"]:
    """Return whereto a segment looks as drift and six harmonics, in every frame [rad]."""
    raw = continuous(azimuth(tracks, ahead, behind))
    one = fit(tracks.time, raw, period, harmonics=_harmonics(tracks, ahead, period, 6), drift=_drift(tracks, period))
    return one.trend(tracks.time) + one.swing(tracks.time)


def continuous(angle: Float[np.ndarray, " frame"]) -> Float[np.ndarray, " frame"]:
    """Return an angle without jumps by full turns, NaN where it is [rad]."""
    seen, out = np.isfinite(angle), angle.copy()
    out[seen] = np.unwrap(angle[seen])
    return out


def _drift(tracks: Tracks, period: float) -> int:
    """A curved way needs two cycles to be told from the cycle itself."""
    return 2 if tracks.time[-1] - tracks.time[0] >= 1.9 * period else 1


def _harmonics(tracks: Tracks, point: str, period: float, most: int) -> int:
    seen = int(np.isfinite(tracks.at(point)[:, 0]).sum())
    return harmonics_for(seen, tracks.rate * period, most=most)


def _longest(holds: np.ndarray) -> tuple[int, int]:
    """Return start and length of the longest stretch on a ring."""
    if holds.all():
        return 0, len(holds)
    first = int(np.argmin(holds))  # a place where it does not hold
    ring = np.concatenate([np.roll(holds, -first).astype(int), [0]])
    edges = np.diff(np.concatenate([[0], ring]))
    starts, ends = np.flatnonzero(edges > 0), np.flatnonzero(edges < 0)
    if len(starts) == 0:
        return 0, 0
    best = int(np.argmax(ends - starts))
    return int(starts[best] + first) % len(holds), int(ends[best] - starts[best])

"""Stance and swing of feet by their speed over the ground, and their motion in the frame of the girdle."""

from functools import cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Complex, Float
from scipy.stats import t as student

from suchus.animals.capture.angles import azimuth
from suchus.animals.capture.cycle import fit, harmonics_for
from suchus.animals.capture.swings import Swing, SwingMidpoints, swing, swing_midpoints
from suchus.animals.capture.tracks import Tracks

GRID = 400
"""Phases of a cycle at which a foot is looked at [-]."""
_DUTIES = np.round(np.arange(0.30, 0.91, 0.01), 2)  # duty factors of the paths with which a path is compared
_TOP = 14  # greatest number of harmonics of a foot's path
_Z_95 = 1.96  # standard errors in half a 95 % interval
_BINS, _RARE = 40, 0.2  # bins of the cycle; greatest visible fraction of a bin with a hidden foot


class FootContact(NamedTuple):
    """One foot over its mean cycle; phases count from time zero of the tracks [cycle]."""

    speed: Float[np.ndarray, " grid"]
    """Speed over the ground in the mean cycle [m/s or px/s]."""
    stance: Bool[np.ndarray, " grid"]
    """Whether it stands."""
    lift_off: float
    """Phase at which it begins to swing."""
    touch_down: float
    """Phase at which it begins to stand."""
    middle: float
    """Phase of the middle of its stance, half a cycle from the middle of its fast movement."""
    middle_error: float
    """Half the width of the interval that holds this phase in 95 of 100 walks [cycle]."""
    duty_error: float
    """The same of the share of the cycle in which it stands [-]."""
    scatter: float
    """Standard deviation of that share from stride to stride, without what noise adds [-]; NaN with one stride."""
    hidden: float
    """Share of the cycle in which it is hardly ever seen [-]."""
    swings: Swing
    """Its swings, one by one."""

    @property
    def duty(self) -> float:
        """Fraction of the cycle in which the foot stands [-]."""
        return (self.lift_off - self.touch_down) % 1.0


class FootSweep(NamedTuple):
    """Motion of one foot relative to its girdle over the mean cycle."""

    forward: Float[np.ndarray, " grid"]
    """Distance by which it is ahead of the girdle [m or px]."""
    outward: float
    """Mean distance from the midline [m or px]."""
    lift: float
    """Height to which it is lifted over the ground [m or px]; NaN where no heights were seen."""
    stroke: float
    """Half of the distance that it moves back [m or px], by the gait's path that fits best: see ``path_shape``."""
    retraction: float
    """Share of the cycle in which it goes back [-], by the same path."""


def grid() -> Float[np.ndarray, " grid"]:
    """Return the phases at which the motion of a foot is evaluated [cycle]."""
    return np.arange(GRID) / GRID


def forward_path(tracks: Tracks, leg: str) -> Float[np.ndarray, " frame"]:
    """Return the position of a foot ahead of the rear of the trunk, NaN where it was not seen [m or px]."""
    front, rear = tracks.line
    trunk_vector = (tracks.at(front) - tracks.at(rear))[:, :2]
    forward_axis = trunk_vector / np.linalg.norm(trunk_vector, axis=1, keepdims=True)
    return np.asarray(((tracks.at(leg) - tracks.at(rear))[:, :2] * forward_axis).sum(axis=1))


def steps(tracks: Tracks, leg: str, period: float) -> SwingMidpoints:
    """Return the middles of a foot's swings; an approximate period is enough [s]."""
    return swing_midpoints(tracks.time, tracks.at(leg)[:, :2], forward_path(tracks, leg), period)


def contact(tracks: Tracks, leg: str, period: float) -> FootContact | None:
    """Return stance and swing of a foot in the mean cycle; None without a complete swing.

    Args:
        tracks: the keypoints, by a clock that follows the animal's pace.
        leg: one of ``LEGS``.
        period: period of the cycle [s].
    """
    swings = swing(tracks.time, tracks.at(leg)[:, :2], forward_path(tracks, leg), period)
    if swings is None:
        return None
    n = len(swings.phase)
    mean_phase = np.angle(np.mean(np.exp(2j * np.pi * swings.phase))) / (2 * np.pi)
    phase_deviation = np.mod(swings.phase - mean_phase + 0.5, 1.0) - 0.5
    times = float(student.ppf(0.975, n - 1)) if n > 1 else float("nan")
    scatter = swings.scatter if n > 1 else float("nan")
    middle_error = (
        np.hypot(_Z_95 * swings.middle_error, times * np.std(phase_deviation, ddof=1) / np.sqrt(n)) if n > 1 else np.nan
    )
    phase, half = grid(), swings.share / 2
    lift_off, touch_down = (mean_phase + swings.skew - half) % 1.0, (mean_phase + swings.skew + half) % 1.0
    return FootContact(
        speed=_speed(tracks, leg, period),
        stance=(phase - touch_down) % 1.0 < (lift_off - touch_down) % 1.0,
        lift_off=lift_off,
        touch_down=touch_down,
        middle=(mean_phase + 0.5) % 1.0,
        middle_error=float(middle_error),
        duty_error=float(np.hypot(_Z_95 * swings.share_error, times * scatter / np.sqrt(n))),
        scatter=scatter,
        hidden=_hidden_fraction(tracks, leg, period),
        swings=swings,
    )


def _speed(tracks: Tracks, leg: str, period: float) -> Float[np.ndarray, " grid"]:
    """Return the speed of a foot over the ground in the mean cycle [m/s or px/s]."""
    count = _harmonics(tracks, leg, period, _TOP)
    fits = [
        fit(tracks.time, row, period, harmonics=count, drift=_drift(tracks, period)) for row in tracks.at(leg).T[:2]
    ]
    return np.asarray(np.hypot(*(path.swing(grid() * period, derivative=1) + path.drift[0] for path in fits)))


def _hidden_fraction(tracks: Tracks, point: str, period: float) -> float:
    """Return the fraction of the cycle in which a point is seen in less than a fifth of the frames [-]."""
    bins = np.minimum((np.mod(tracks.time / period, 1.0) * _BINS).astype(int), _BINS - 1)
    is_seen = np.isfinite(tracks.at(point)[:, 0])
    frame_counts = np.bincount(bins, minlength=_BINS)
    seen_fraction = np.bincount(bins, weights=is_seen, minlength=_BINS) / np.maximum(frame_counts, 1)
    return float(np.mean(seen_fraction[frame_counts > 0] < _RARE))


def sweep(tracks: Tracks, leg: str, period: float) -> FootSweep | None:
    """Return the motion of a foot in the frame of its girdle, whose direction is smoothed over the cycle.

    It is None if the girdle's points were not tracked, or in a view from the side.

    Args:
        tracks: the keypoints.
        leg: one of ``LEGS``.
        period: period of the cycle [s].
    """
    girdle = tracks.thorax if leg.endswith("F") else tracks.pelvis
    if girdle is None or tracks.view == "side":
        return None
    origin = "shoulder" if leg.endswith("F") else "hip"
    heading = smooth_azimuth(tracks, *girdle, period)
    d = tracks.at(leg) - tracks.at(origin)
    forward = d[:, 0] * np.cos(heading) + d[:, 1] * np.sin(heading)
    outward = (d[:, 1] * np.cos(heading) - d[:, 0] * np.sin(heading)) * (1 if leg.startswith("L") else -1)
    if not np.isfinite(outward).any():  # never seen together with its girdle
        return None
    count = _harmonics(tracks, leg, period, 8)
    path = fit(tracks.time, forward, period, harmonics=count)
    lift = float("nan")
    if tracks.has_heights:
        lift = float(np.ptp(fit(tracks.time, tracks.at(leg)[:, 2], period, harmonics=count).swing(grid() * period)))
    course = path.mean + path.swing(grid() * period)
    return FootSweep(course, float(np.nanmean(outward)), lift, *_fitting_path(course))


def path_shape(duty: float) -> Float[np.ndarray, " grid"]:
    """Return the forward position of a foot in a gait of stroke one: half a cosine forward, then a line back [-].

    Args:
        duty: share of the cycle in which it goes back [-].
    """
    swing = 1.0 - duty
    phase = grid()
    return np.where(phase < swing, -np.cos(np.pi * phase / swing), 1.0 - 2.0 * (phase - swing) / duty)


def _fitting_path(forward: Float[np.ndarray, " grid"]) -> tuple[float, float]:
    """Return stroke and duty factor of the gait's path that is nearest to the path of a foot, at any phase."""
    shapes, power = _paths()
    spectrum = np.fft.rfft(forward - forward.mean())
    likeness = np.fft.irfft(spectrum * shapes, GRID).max(axis=1)
    best = int(np.argmax(likeness**2 / power))
    return float(likeness[best] / power[best]), float(_DUTIES[best])


@cache
def _paths() -> tuple[Complex[np.ndarray, "duty frequency"], Float[np.ndarray, " duty"]]:
    """Return the paths of gaits of each duty factor, without their means, as conjugate spectra, and their power."""
    shapes = np.array([path_shape(duty) for duty in _DUTIES])
    shapes -= shapes.mean(axis=1, keepdims=True)
    return np.conj(np.fft.rfft(shapes)), (shapes**2).sum(axis=1)


def smooth_azimuth(tracks: Tracks, front: str, rear: str, period: float) -> Float[np.ndarray, " frame"]:
    """Return the direction of a segment as drift and six harmonics, in every frame [rad]."""
    raw = continuous(azimuth(tracks, front, rear))
    course = fit(tracks.time, raw, period, harmonics=_harmonics(tracks, front, period, 6), drift=_drift(tracks, period))
    return course.trend(tracks.time) + course.swing(tracks.time)


def continuous(angle: Float[np.ndarray, " frame"]) -> Float[np.ndarray, " frame"]:
    """Return an angle without jumps by full turns; NaN stays NaN [rad]."""
    is_seen, unwrapped = np.isfinite(angle), angle.copy()
    unwrapped[is_seen] = np.unwrap(angle[is_seen])
    return unwrapped


def _drift(tracks: Tracks, period: float) -> int:
    """Return the power of time for a path: 2 if the tracks have two cycles, otherwise 1."""
    return 2 if tracks.time[-1] - tracks.time[0] >= 1.9 * period else 1


def _harmonics(tracks: Tracks, point: str, period: float, max_harmonics: int) -> int:
    """Return the number of harmonics for a point, few enough that gaps in its track leave none undetermined."""
    frame_count = int(np.isfinite(tracks.at(point)[:, 0]).sum())
    gap = _hidden_fraction(tracks, point, period)
    return min(
        harmonics_for(frame_count, tracks.rate * period, max_harmonics=max_harmonics), max(2, int(1.0 / max(gap, 1e-3)))
    )

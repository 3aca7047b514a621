"""The mean cycle of a periodic quantity: its period, its harmonics and its residual."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.optimize import minimize_scalar

from suchus.animals.capture.tracks import UnusableTracks

MIN_CYCLES = 1.2
"""Least duration of tracks: the beginning of a cycle must appear twice [cycle]."""
MIN_FRAMES_PER_CYCLE = 12
"""Least number of frames in one cycle; with fewer, steps cannot be separated [-]."""
_FASTEST = 12.0  # [1/s]; the stride frequency of the fastest small lizards
_REPEATS = 0.15  # least fraction of variance that one harmonic explains; in noise it explains less
_PIECE = 6.0  # [cycle]; duration over which a pace that varies by a tenth stays coherent
_ROUNDS = 3  # rounds of leaving out outliers
_JUMP = 8.0  # outlier over the usual residual; steps of a body stay well below


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PeriodicFit:
    """A periodic quantity: mean, drift and harmonics, fitted to the frames in which it was seen."""

    period: float
    """Period of one cycle [s]."""
    mean: float
    """Steady part at the middle of the time."""
    drift: np.ndarray
    """Coefficients of time and its square about the middle, per second and per second squared."""
    middle: float
    """Middle of the time [s]."""
    harmonics: np.ndarray
    """Complex amplitudes of ``exp(2 pi i k time / period)``, k = 1 upward."""
    residual: np.ndarray
    """What is left in each frame, NaN where it was not seen."""

    @property
    def noise(self) -> float:
        """Standard deviation of the residual."""
        residual = self.residual[np.isfinite(self.residual)]
        return float(np.sqrt(np.sum(residual**2) / max(1, len(residual) - self._parameters)))

    @property
    def error(self) -> float:
        """Standard error of the amplitude of one harmonic."""
        return self.noise * float(np.sqrt(2.0 / max(1, np.isfinite(self.residual).sum())))

    @property
    def _parameters(self) -> int:
        return 1 + len(self.drift) + 2 * len(self.harmonics)

    def swing(self, time: Float[np.ndarray, " t"], *, derivative: int = 0) -> Float[np.ndarray, " t"]:
        """Return the periodic part without the mean, or its derivative in time.

        Args:
            time: [s].
            derivative: 0 or 1.
        """
        w = 2 * np.pi * np.arange(1, len(self.harmonics) + 1) / self.period
        turn = np.exp(1j * np.multiply.outer(np.asarray(time), w))
        return np.asarray((turn * (self.harmonics * (1j * w) ** derivative)).sum(axis=-1).real)

    def trend(self, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
        """Return mean and drift."""
        t = np.asarray(time) - self.middle
        powers = np.arange(1, len(self.drift) + 1)
        return np.asarray(self.mean + np.power.outer(t, powers) @ self.drift)


def fit(time: np.ndarray, values: np.ndarray, period: float, *, harmonics: int, drift: int = 0) -> PeriodicFit:
    """Fit mean, drift and harmonics by least squares to the visible frames; outliers are left out.

    The fit of a quantity that was never seen is NaN.

    Args:
        time: shape (frame,) [s].
        values: shape (frame,), NaN where the quantity was not seen.
        period: period of one cycle [s].
        harmonics: how many.
        drift: highest power of time that is fitted, 0 to 2.
    """
    middle = float(time[0] + time[-1]) / 2
    reach = max(float(time[-1] - time[0]) / 2, 1e-12)
    t = (time - middle) / reach  # within -1 and 1, so that the normal equations below are well conditioned
    angle = 2 * np.pi * np.multiply.outer(time, np.arange(1, harmonics + 1)) / period
    X = np.hstack([np.power.outer(t, np.arange(drift + 1)), np.cos(angle), np.sin(angle)])
    use = np.isfinite(values)
    if not use.any():
        nan_harmonics = np.full(harmonics, np.nan + 0j)
        return PeriodicFit(
            period=period,
            mean=np.nan,
            drift=np.full(drift, np.nan),
            middle=middle,
            harmonics=nan_harmonics,
            residual=values,
        )
    solution = np.zeros(X.shape[1])
    for _ in range(_ROUNDS):
        solution = np.linalg.lstsq(X[use].T @ X[use], X[use].T @ values[use], rcond=None)[0]
        abs_residual = np.abs(values - X @ solution)
        residual_scale = 1.4826 * np.median(abs_residual[use]) + 1e-12
        keep = np.isfinite(values) & (abs_residual <= _JUMP * residual_scale + 1e-9)
        if keep.sum() == use.sum() or keep.sum() < 2 * X.shape[1]:
            break
        use = keep
    residual = np.where(use, values - X @ solution, np.nan)
    cos, sin = np.split(solution[drift + 1 :], 2)
    return PeriodicFit(
        period=period,
        mean=float(solution[0]),
        drift=solution[1 : drift + 1] / reach ** np.arange(1, drift + 1),
        middle=middle,
        harmonics=cos - 1j * sin,
        residual=residual,
    )


def harmonics_for(frames: int, frames_per_cycle: float, *, max_harmonics: int) -> int:
    """Return how many harmonics a fit can have: at most one for six frames, and one for four frames a cycle."""
    return int(np.clip(min(frames // 6, frames_per_cycle // 4), 2, max_harmonics))


def find_period(time: np.ndarray, signals: Float[np.ndarray, "signal frame"], source: str) -> float:
    """Return the common period of signals [s].

    A coarse search fits one harmonic on a grid of frequencies, down to a cycle three times as long as the tracks. A
    refinement fits three harmonics.

    Args:
        time: shape (frame,) [s].
        signals: signals that swing once a cycle, NaN where not seen.
        source: name of the source, for messages.

    Raises:
        UnusableTracks: nothing repeats, or less than one cycle or too few frames of it were seen.
    """
    duration = float(time[-1] - time[0])
    rate = 1.0 / float(np.median(np.diff(time)))
    fastest = min(_FASTEST, rate / 4)
    trials = np.arange(1.0 / (3.0 * duration), max(fastest, 4.0 / duration), 0.1 / duration)
    scaled = signals - np.nanmean(signals, axis=1, keepdims=True)
    spread = np.nanstd(scaled, axis=1, keepdims=True)
    weight = np.isfinite(scaled)
    y = np.where(weight, scaled / np.where(spread > 0, spread, 1.0), 0.0)
    best_frequency, best_fraction = _coarse(time - time[0], y, weight.astype(float), trials)
    if best_fraction < _REPEATS:
        raise UnusableTracks(
            f"nothing in {source} repeats: the best cycle explains {100 * best_fraction:.0f} % of what trunk, tail "
            "and feet do, "
            f"at least {100 * _REPEATS:.0f} % is needed; cut out the part in which the animal walks, with --start and "
            "--end."
        )

    def squared_residual(frequency: float) -> float:
        fits = [fit(time, row, 1.0 / frequency, harmonics=3) for row in np.where(weight, y, np.nan)]
        return sum(float(np.nansum(signal_fit.residual**2)) for signal_fit in fits)

    width = min(0.3 / duration, 0.3 * best_frequency)
    refined = minimize_scalar(
        squared_residual,
        bounds=(best_frequency - width, best_frequency + width),
        method="bounded",
        options={"xatol": 1e-5},
    )
    period = 1.0 / float(refined.x)
    _check_recording(period, duration, rate, source)
    return period


def _check_recording(period: float, duration: float, frame_rate: float, source: str) -> None:
    """Refuse tracks that show too little of a cycle, or too few frames in a cycle.

    Args:
        period: period of the gait [s].
        duration: duration of the tracks [s].
        frame_rate: frames per second [1/s].
        source: name of the tracks, for messages.
    """
    if duration < MIN_CYCLES * period:
        raise UnusableTracks(
            f"{source} lasts {duration:.2f} s, {duration / period:.1f} cycles of about {period:.2f} s; at least "
            f"{MIN_CYCLES} cycles are needed, {MIN_CYCLES - duration / period:.1f} more; a spread needs two whole "
            "cycles."
        )
    if frame_rate * period < MIN_FRAMES_PER_CYCLE:
        raise UnusableTracks(
            f"{source} shows {frame_rate * period:.0f} frames in a cycle of {period:.2f} s; at least "
            f"{MIN_FRAMES_PER_CYCLE} are needed: film faster."
        )


def _coarse(time: np.ndarray, y: np.ndarray, weight: np.ndarray, trials: np.ndarray) -> tuple[float, float]:
    """Return the frequency whose first harmonic explains most of the variance, and the fraction that it explains.

    A long film is divided into pieces, because the pace varies over a film.
    """
    explained = _explained(time, y, weight, trials)
    pieces = int(time[-1] * trials[np.argmax(explained)] / _PIECE)
    if pieces > 1:
        parts = np.array_split(np.arange(len(time)), pieces)
        fractions = [
            _explained(time[frame_indices], y[:, frame_indices], weight[:, frame_indices], trials)
            for frame_indices in parts
        ]
        explained = np.mean(fractions, axis=0)
    return float(trials[np.argmax(explained)]), float(explained.max())


def _explained(time: np.ndarray, y: np.ndarray, weight: np.ndarray, trials: np.ndarray) -> np.ndarray:
    """Return the fraction of the variance that the mean and one harmonic explain, over all signals, shape (trial,)."""
    angle = 2 * np.pi * np.multiply.outer(trials, time)
    c, s = np.cos(angle), np.sin(angle)
    constant = np.ones_like(c)
    base = (constant, c, s)
    G = np.stack(
        [np.stack([(a * b) @ weight.T for b in base], axis=-1) for a in base], axis=-1
    )  # (trial, signal, 3, 3)
    r = np.stack([a @ (weight * y).T for a in base], axis=-1)
    G = G + 1e-9 * np.eye(3) * weight.sum()
    x = np.linalg.solve(G, r[..., None])[..., 0]
    gained = (x * r).sum(axis=-1) - (r[..., 0] ** 2 / np.maximum(weight.sum(axis=1), 1))
    total = (weight * y**2).sum(axis=1)
    return np.asarray(gained.sum(axis=-1) / max(float(total.sum()), 1e-12))

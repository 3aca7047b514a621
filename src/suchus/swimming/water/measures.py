"""Measures of a tethered and of a free swim, and their definitions."""

from typing import NamedTuple

import numpy as np
import xarray as xr
from jaxtyping import Float
from scipy.optimize import least_squares


class Quarters(NamedTuple):
    """What the article says of T/4, T/2, 3T/4 and T, in that order."""

    difference: list[float]
    """Mean pressure along the convex side of the tail less that along the concave side [Pa]."""
    place: list[float]
    """Where the difference sits: the mean place along the tail, root 0 to tip 1, weighted with its size [-]."""
    thrust: list[float]
    """Force forward [N/m]."""
    aside: list[float]
    """Force to the right [N/m]."""

    @classmethod
    def from_record(cls, record: xr.Dataset) -> "list[Quarters]":
        """Return the quarters of every cycle but the first of a tethered slice, the last cycle at the end."""
        cycles = [record.isel(settled=i) for i in range(record.sizes["settled"])]
        return [cls(*(cycle[f"quarter_{name}"].values.tolist() for name in cls._fields)) for cycle in cycles]

    @property
    def moves(self) -> float:
        """Displacement of the pressure difference towards the tip from T/4 to 3T/4, in tail lengths [-]."""
        return self.place[2] - self.place[0]


def convex_higher(record: xr.Dataset) -> float:
    """Return the fraction of the cycle in which the convex side of the tail has the higher pressure [-]."""
    return float((record.difference > 0).mean())


def level(track: np.ndarray) -> np.ndarray:
    """Return a track over whole cycles, first and last instant included, minus its mean line.

    The slope of the line is the displacement from the first to the last instant. A line of least squares would be
    tilted by a sine.
    """
    drift = (track[-1] - track[0]) * np.linspace(-0.5, 0.5, track.size)
    return np.asarray(track - drift - np.mean(track[:-1] - drift[:-1]))


class LateralSwing(NamedTuple):
    """First harmonic of each station's lateral motion."""

    amplitude: Float[np.ndarray, " station"]
    """Amplitude of the sine [m]."""
    phase_lag: Float[np.ndarray, " station"]
    """Phase lag of the sine behind a cosine that begins with the samples, 0 to 1 [cycle]."""
    variance_fraction: Float[np.ndarray, " station"]
    """Fraction of the variance about the mean line that the sine has [-]."""


def swing(lateral_positions: Float[np.ndarray, "sample station"], cycles: int = 2) -> LateralSwing:
    """Return the amplitude of each station's first harmonic, its lag, and the variance that the harmonic explains.

    Args:
        lateral_positions: places to the side over whole cycles, first and last instant included [m].
        cycles: number of cycles [-].
    """
    deviations = np.column_stack([level(track) for track in lateral_positions.T])[:-1]
    harmonic = 2.0 * np.fft.rfft(deviations, axis=0)[cycles] / len(deviations)
    variance = np.maximum(np.mean(deviations**2, axis=0), np.finfo(float).tiny)
    lag = np.mod(-np.angle(harmonic) / (2.0 * np.pi), 1.0)
    return LateralSwing(np.abs(harmonic), lag, 0.5 * np.abs(harmonic) ** 2 / variance)


class Sway(NamedTuple):
    """Lateral motion of a track once a cycle."""

    amplitude: float
    """Amplitude of the sine of one cycle [m]."""
    noise: float
    """Twice the standard deviation of what is left of the track about its mean line without that sine [m]."""

    @classmethod
    def from_track(cls, track: Float[np.ndarray, " sample"], cycles: int) -> "Sway":
        """Return the sway of a lateral track over whole cycles, first and last instant included [m].

        Raises:
            ValueError: the samples are no whole number for each cycle.
        """
        if (track.size - 1) % cycles:
            raise ValueError(f"{track.size} samples are no whole number for each of {cycles} cycles.")
        amplitude, _, share = (float(values[0]) for values in swing(track[:, None], cycles))
        residual = np.sqrt(max(np.var(level(track)[:-1]) * (1.0 - share), 0.0))
        return cls(amplitude, 2.0 * float(residual))


def wave_form(
    s: Float[np.ndarray, " station"], amplitude: Float[np.ndarray, " station"], lag: Float[np.ndarray, " station"]
) -> tuple[float, float, float, float]:
    """Return the wave of the form (20) that is nearest to a midline, and the fraction of the swing that it explains.

    Args:
        s: arc length from the snout, over the length [-].
        amplitude: amplitude of each station [m].
        lag: its phase lag [cycle].

    Returns:
        c1 and c2 of the envelope c1 s + c2 s^2 [m], waves along the body (positive: from head to tail) [-], and the
        share of the mean square of the swing that the wave explains [-].

    Paper: Eq. (20).
    """
    harmonics = amplitude * np.exp(-2j * np.pi * lag)

    def residuals(guess: np.ndarray) -> np.ndarray:
        difference = (guess[0] * s + guess[1] * s**2) * np.exp(-2j * np.pi * (guess[2] * s + guess[3])) - harmonics
        return np.concatenate([difference.real, difference.imag])

    size = float(amplitude[-1])
    starts = [(0.1 * size, size, waves, lag) for waves in (-1.0, 0.2, 1.0) for lag in (0.0, 0.25, 0.5, 0.75)]
    best = min(
        (least_squares(residuals, start, x_scale=(size, size, 1.0, 1.0)) for start in starts), key=lambda f: f.cost
    )
    total_power = float(np.sum(np.abs(harmonics) ** 2))
    return float(best.x[0]), float(best.x[1]), float(best.x[2]), 1.0 - 2.0 * float(best.cost) / total_power


class SwimMeasures(NamedTuple):
    """Measures of a free swim in its last cycle."""

    speed: float
    """Forward [m/s]."""
    gain: float
    """Gain of the speed over the cycle before [-]."""
    slip: float
    """Speed over that of the body wave [-]."""
    strouhal: float
    """Frequency times the peak-to-peak amplitude of the tail's tip, over speed [-]."""
    water_cost_of_transport: float
    """Power over displaced weight and speed [-]."""
    head_yaw: float
    """Amplitude of the head's direction [rad]."""

    @classmethod
    def from_record(cls, free: xr.Dataset, frequency: float) -> "SwimMeasures":
        """Return the measures of a record of a free slice."""
        speed, power = float(free.speed[-1]), float(free.power[-1])
        return cls(
            speed,
            speed / float(free.speed[-2]) - 1.0 if free.speed.size > 1 else float("nan"),
            speed / float(free.wave_speed),
            frequency * float(np.ptp(level(free.tail_y.values))) / abs(speed),
            power / (float(free.weight) * abs(speed)),
            float(np.ptp(free.heading.values)) / 2,
        )


def efficiency(drag: float, speed: float, power: float) -> float:
    """Return the quasi-propulsive efficiency: the power for towing the straight body over that of the joints.

    Args:
        drag: drag of the straight body at that speed [N or N/m].
        speed: [m/s].
        power: power of the joints on the water [W or W/m].

    Source: Maertens, Gao and Triantafyllou 2017, J. Fluid Mech. 813, 301.
    """
    return drag * abs(speed) / power

"""Numbers from time series of forces: means, frequencies, Morison coefficients, noise."""

import numpy as np

from suchus.core.errors import NotConverged


def mean(time: np.ndarray, value: np.ndarray) -> float:
    """Return the mean over time of a series with uneven steps."""
    return float(np.trapezoid(value, time) / (time[-1] - time[0]))


def rises(time: np.ndarray, value: np.ndarray) -> np.ndarray:
    """Return the times at which a series rises through its mean, shape (crossing,) [s]."""
    y = value - mean(time, value)
    k = np.flatnonzero((y[:-1] < 0) & (y[1:] >= 0))
    return time[k] - y[k] * (time[k + 1] - time[k]) / (y[k + 1] - y[k])


def frequency(time: np.ndarray, value: np.ndarray) -> float:
    """Return the frequency of a periodic series, from the times at which it rises through its mean [Hz].

    Args:
        time: times [s].
        value: the series.

    Raises:
        NotConverged: fewer than three periods.
    """
    crossings = rises(time, value)
    if crossings.size < 4:
        raise NotConverged(
            f"the series has {crossings.size} rises in {time[-1] - time[0]:.3g} s; run for at least 3 periods."
        )
    return float((crossings.size - 1) / (crossings[-1] - crossings[0]))


def last_periods(time: np.ndarray, value: np.ndarray, count: int) -> np.ndarray:
    """Return which samples belong to the last whole periods of a series, shape (step,).

    Args:
        time: times [s].
        value: the series.
        count: number of periods [-].

    Raises:
        NotConverged: the series has fewer periods.
    """
    crossings = rises(time, value)
    if crossings.size <= count:
        raise NotConverged(f"the series has {max(crossings.size - 1, 0)} whole periods; {count} are asked for.")
    return (time >= crossings[-1 - count]) & (time <= crossings[-1])


def strouhal(time: np.ndarray, lift: np.ndarray, *, length: float, speed: float) -> float:
    """Return the Strouhal number of a lift force: frequency times ``length`` [m] over ``speed`` [m/s]."""
    return frequency(time, lift) * length / speed


def morison(
    time: np.ndarray, force: np.ndarray, *, frequency: float, speed: float, diameter: float, density: float
) -> tuple[float, float]:
    """Return drag and inertia coefficient of a cylinder that moves with ``-speed cos(2 pi f t)`` along x.

    ``F = -1/2 rho D Cd |u| u - 1/4 pi rho D^2 Ci du/dt``, fitted by least squares.

    Args:
        time: times, in whole periods [s].
        force: force on the cylinder [N/m].
        frequency: frequency f of the motion [Hz].
        speed: largest speed [m/s].
        diameter: diameter D [m].
        density: density of the water [kg/m^3].

    Source: Morison et al. 1950, Petroleum Transactions AIME 189, 149-157.
    """
    rate = 2 * np.pi * frequency
    u, du = -speed * np.cos(rate * time), speed * rate * np.sin(rate * time)
    shapes = np.stack([-0.5 * density * diameter * np.abs(u) * u, -0.25 * np.pi * density * diameter**2 * du])
    cd, ci = np.linalg.lstsq(shapes.T, force, rcond=None)[0]
    return float(cd), float(ci)


def noise(time: np.ndarray, value: np.ndarray, *, window: float) -> float:
    """Return the noise of a series: the rms deviation from piecewise cubic fits, over the standard deviation [-].

    Args:
        time: times [s].
        value: the series.
        window: duration of a fit; fits begin every half of it [s].

    Raises:
        NotConverged: no window holds enough samples for a cubic, or the series never changes.
    """
    residuals = []
    for start in np.arange(time[0], time[-1] - window, window / 2) if value.size else ():
        k = (time >= start) & (time < start + window)
        if k.sum() > 6:
            t = (time[k] - start) / window
            residuals.append(value[k] - np.polyval(np.polyfit(t, value[k], 3), t))
    if not residuals or not np.ptp(value) > 0:
        raise NotConverged(
            f"a series of {value.size} samples has no noise to tell in windows of {window:.3g} s; give a changing "
            f"series of at least two windows with 7 samples each."
        )
    return float(np.sqrt(np.mean(np.concatenate(residuals) ** 2)) / np.std(value))

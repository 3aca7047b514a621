"""The own error of published data, as far as it can be read from the data themselves.

What a source states of its error counts; else half a unit of the last digit of numbers that it prints; else, of points
that were read off a figure, how far they scatter about a smooth curve through their neighbours. An axis that was read
askew, and what the source itself did wrong, cannot be seen in this way.
"""

import numpy as np

_SIDES = 2  # neighbours to each side through which the smooth curve of a point goes
_NORMAL = 1.4826  # standard deviation over the median magnitude of a normal distribution [-]


def stated_error(error: np.ndarray, y: np.ndarray) -> float:
    """Return the root mean square of the error that a source states, over the peak of its values [-]."""
    return float(np.sqrt(np.nanmean(error**2)) / np.abs(y).max())


def half_a_digit(text: str) -> float:
    """Return half a unit of the last digit of a printed number: 0.005 of ``1.25``, 0.5 of ``120``."""
    mantissa, _, power = text.lower().partition("e")
    decimals = len(mantissa.partition(".")[2])
    return float(0.5 * 10.0 ** (int(power or 0) - decimals))


def digits_error(texts: tuple[str, ...], factor: float, y: np.ndarray) -> float:
    """Return half a unit of the last digit of the most precise of a source's numbers, over the peak [-].

    Trailing zeros may have been lost on the way, so the number with the most digits tells how many the source has.

    Args:
        texts: the numbers as they stand in the table.
        factor: by which they are multiplied before they are compared.
        y: the compared values.
    """
    return min(half_a_digit(text) for text in texts if text) * abs(factor) / float(np.abs(y).max())


def reading_error(x: np.ndarray, y: np.ndarray, period: float | None = None) -> float | None:
    """Return how far points read off a figure scatter about their curve, over the peak [-]; None of too few points.

    Each point is held against the parabola through its two neighbours to each side, without itself. The difference has
    the variance of one reading times 1 and the squares of the neighbours' weights; the median of the magnitudes over
    that leaves out the places where the curve bends more sharply than a parabola.

    Args:
        x: abscissae, shape (point,).
        y: ordinates, shape (point,).
        period: of the abscissa; None for one that has none.
    """
    order = np.argsort(x, kind="stable")
    x, y = x[order], y[order]
    if period is not None:
        x = np.concatenate([x[-_SIDES:] - period, x, x[:_SIDES] + period])
        y = np.concatenate([y[-_SIDES:], y, y[:_SIDES]])
    found = []
    for k in range(_SIDES, len(x) - _SIDES):
        near = [k + step for step in range(-_SIDES, _SIDES + 1) if step]
        if np.unique(x[near]).size < 3:
            continue
        away = x[near] - x[k]
        terms = np.vander(away / np.abs(away).max(), 3)  # the parabola's value at the point is its last coefficient
        weights = np.linalg.solve(terms.T @ terms, terms.T)[-1]
        found.append(abs(y[k] - weights @ y[near]) / np.sqrt(1 + weights @ weights))
    if not found:
        return None
    return float(_NORMAL * np.median(found) / np.abs(y).max())

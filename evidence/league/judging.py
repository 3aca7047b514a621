"""What became of a prediction when the measurement was opened, by rules that were there before."""

from math import inf
from typing import Literal, NamedTuple, get_args

import numpy as np

from evidence.league.contestant import Interval
from evidence.league.sealing import Measured
from suchus.article.verdict import Clause

Word = Literal["within", "within, wide", "missed", "not a steady swim"]
"""``within``: what was measured, in its own interval, meets that of the prediction. ``within, wide``: so, but the
interval is wider than a factor of ``WIDEST``, which says little. ``missed``: they do not meet. ``not a steady swim``:
what was measured contradicts itself as a steady swim, so that no prediction of one can be judged by it."""
WORDS: tuple[Word, ...] = get_args(Word)
WIDEST = 4.0
"""Greatest ratio of the ends of an interval that counts as a prediction [-]: a factor of two to either side; set before
any was made."""
NARROW = 2.0
"""Ratio of the ends of an interval below which it is narrow [-]."""
_MEETS = (
    Clause("high", ">=", "measured_low", "the interval reaches up to what was measured"),
    Clause("low", "<=", "measured_high", "and down to it"),
)
_TELLS = Clause("width", "<=", WIDEST, "an interval of more than a factor of two to either side says little")


class Judgement(NamedTuple):
    """What became of one rung's prediction of one quantity."""

    word: Word
    """The verdict."""
    ratio: float
    """Value of the prediction over what was measured, the worst of several numbers [-]."""


def unsteady_wave(speed: float, wave_speed: float) -> str:
    """Return why a filmed swim is no steady swim by its body wave; empty if it can be one.

    A body wave that runs backwards along the body at c gives thrust only while the body swims slower than c.

    Args:
        speed: speed of the swim U [body length/s].
        wave_speed: filmed frequency times filmed wavelength c [body length/s].

    Source: Lighthill 1960, J. Fluid Mech. 9, 305.
    """
    if speed < wave_speed:
        return ""
    return (
        f"it swims at {speed:.3g} body lengths a second, and its body wave, frequency times wavelength as printed, "
        f"runs at {wave_speed:.3g}; a wave drives a body only below its own speed"
    )


def judged(interval: Interval, measured: Measured, *, is_steady: bool = True) -> Judgement:
    """Return what became of a prediction; of several numbers in a row each must be within.

    Args:
        interval: the prediction.
        measured: what was measured, in the same unit.
        is_steady: whether what was measured can be that of a steady swim.
    """
    columns = [
        np.atleast_1d(np.asarray(one, float)) for one in (*interval, measured.value, measured.low, measured.high)
    ]
    words: list[Word] = []
    ratios: list[float] = []
    for value, low, high, truth, least, most in zip(*np.broadcast_arrays(*columns), strict=True):
        measures = {"low": low, "high": high, "measured_low": least, "measured_high": most, "width": _width(low, high)}
        met = all(clause.holds(measures) for clause in _MEETS)
        words.append("missed" if not met else "within" if _TELLS.holds(measures) else "within, wide")
        ratios.append(float(value / truth) if truth else inf)
    worst: Word = max(words, key=WORDS.index) if is_steady else "not a steady swim"
    return Judgement(worst, max(ratios, key=lambda ratio: abs(np.log(ratio)) if 0.0 < ratio < inf else inf))


def _width(low: float, high: float) -> float:
    """Return the ratio of the ends of an interval; without a bound where they differ in sign [-]."""
    ends = sorted((abs(low), abs(high)))
    return float(ends[1] / ends[0]) if low * high > 0.0 else 1e300

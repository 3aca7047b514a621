"""How far two curves, or two sets of numbers, are from each other."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from evidence.atlas.case import AtlasRow, Curves, PublishedCurves, bound, published
from evidence.atlas.source_error import digits_error, half_a_digit, reading_error, stated_error
from suchus.core.errors import IncompatibleRecord

LEAST_SHARE = 0.5
"""Share of the published points that our curve must reach for a comparison [-]."""

_FEWEST = 5  # points in common that two sources need for a scatter


@dataclass(frozen=True, slots=True, kw_only=True)
class CurveComparison:
    """A row's data beside ours."""

    x: np.ndarray
    """Abscissae of the published points that are compared, or the numbers' places, shape (point,)."""
    published: np.ndarray
    """Published ordinates, shape (point,)."""
    computed: np.ndarray
    """Ours at the same abscissae, shape (point,)."""
    rms: float
    """Root mean square of the difference over the largest published magnitude; of numbers, of the relative
    differences [-]."""
    over_range: float | None
    """The same of a curve over its range, from the least published value to the largest; None for numbers [-]."""
    source_error: float | None
    """The source's own error where it can be read, over the same peak: what the source states, the digits that it
    gives, or the scatter of points read off a figure about their curve; None where it cannot [-]."""
    scatter: float | None
    """The same between the sources; None where there is one only [-]."""
    curve: str = ""
    """Name of our curve; empty for single numbers."""
    cycles: tuple[float, ...] = ()
    """The differences of all cycles of ours, of which the nearest counts; empty where there is no choice [-]."""

    @property
    def bound(self) -> float:
        """The largest difference that counts as agreement, which the scatter decides [-]."""
        return bound(self.scatter)

    @property
    def agrees(self) -> bool:
        """Whether the difference is within the bound."""
        return self.rms <= self.bound


def compare(row: AtlasRow, curves: Curves) -> CurveComparison:
    """Return the published data of a row beside ours.

    Raises:
        IncompatibleRecord: our curve is not there or reaches fewer than half of the points.
    """
    table = published(row.data)
    if row.kind == "numbers":
        return _numbers(table, curves)
    read = values_of(row, curves)
    if read is None:
        raise IncompatibleRecord(
            f"the flow of {row.name} gave no curve named {_named(row, curves)!r}; compute it anew."
        )
    x, y, at, name = read
    reached = np.isfinite(at)
    if reached.mean() < LEAST_SHARE:
        raise IncompatibleRecord(
            f"our curve of {row.name} reaches {reached.sum()} of {x.size} published points, and at least half are "
            f"needed; run longer."
        )
    x, y, at = x[reached], y[reached], at[reached]
    return CurveComparison(
        x=x,
        published=y,
        computed=at,
        rms=rms_over_peak(at, y),
        over_range=_over_range(at, y),
        source_error=_own(row, table),
        scatter=_scatter(row, x, y),
        curve=name,
        cycles=tuple(_cycles(row, curves).values()) if row.any_cycle else (),
    )


class AtPoints(NamedTuple):
    """A row's published points with our values beside them, NaN where our curve does not reach."""

    x: np.ndarray
    """Abscissae, shape (point,)."""
    published: np.ndarray
    """Published ordinates, shape (point,)."""
    computed: np.ndarray
    """Ours at the same abscissae, shape (point,)."""
    curve: str
    """Name of our curve."""


def values_of(row: AtlasRow, curves: Curves) -> AtPoints | None:
    """Return the published points of a row that is a curve, and ours there; None if the flow gave no such curve."""
    name = _named(row, curves)
    if name not in curves:
        return None
    x, y = points(row, published(row.data))
    ours = curves[name]
    return AtPoints(x, y, _on_loop(ours, x, y) if row.kind == "loop" else at_abscissae(ours, x, row.period), name)


def _named(row: AtlasRow, curves: Curves) -> str:
    return (
        f"{row.computed_curve} {_nearest_cycle(row.cycle_of or row, curves)}" if row.any_cycle else row.computed_curve
    )


def _own(row: AtlasRow, table: PublishedCurves) -> float | None:
    """Return the own error of a curve's source over its peak [-]."""
    x, y = points(row, table)
    if row.error_column:
        return stated_error(table.values(row.error_column) * row.scale[1], y)
    if row.is_printed:
        return digits_error(table.columns[row.y], float(row.scale[1]), y)
    return None if row.kind == "loop" else reading_error(x, y, row.period)


def _cycles(row: AtlasRow, curves: Curves) -> dict[str, float]:
    """Return the difference of each cycle of ours from a row's published points, by the cycle's number [-]."""
    x, y = points(row, published(row.data))
    cycles = {
        name.removeprefix(f"{row.computed_curve} "): curve
        for name, curve in curves.items()
        if name.startswith(row.computed_curve)
    }
    return {
        cycle: rms_over_peak(at_abscissae(curve, x, row.period), y)
        for cycle, curve in cycles.items() if cycle.isdecimal()
    }  # fmt: skip


def _nearest_cycle(row: AtlasRow, curves: Curves) -> str:
    """Return the number of the cycle of ours that is nearest to a row's published points; "1" where there is none."""
    cycles = _cycles(row, curves)
    return min(cycles, key=cycles.__getitem__) if cycles else "1"


def points(row: AtlasRow, table: PublishedCurves) -> tuple[np.ndarray, np.ndarray]:
    """Return the published points that a row compares, in our units, two arrays of shape (point,)."""
    x = table.values(row.x) * row.scale[0] + row.shift[0]
    y = table.values(row.y) * row.scale[1] + row.shift[1]
    inside = (x >= row.window[0]) & (x <= row.window[1])
    if row.excluded_spacing is not None:
        spacing, half = row.excluded_spacing
        inside &= np.abs(x - spacing * np.round(x / spacing)) > half
    return x[inside], y[inside]


def rms_over_peak(a: np.ndarray, b: np.ndarray) -> float:
    """Return the root mean square of ``a - b`` over the largest magnitude of ``b`` [-]."""
    return float(np.sqrt(np.mean((a - b) ** 2)) / np.abs(b).max())


def _over_range(a: np.ndarray, b: np.ndarray) -> float | None:
    """Return the root mean square of ``a - b`` over the range of ``b`` [-]; None of a constant."""
    width = float(np.ptp(b))
    return float(np.sqrt(np.mean((a - b) ** 2))) / width if width else None


def at_abscissae(curve: np.ndarray, x: np.ndarray, period: float | None) -> np.ndarray:
    """Return the ordinates of a curve of shape (2, point) at abscissae, linear in between, NaN beyond its ends."""
    order = np.argsort(curve[0], kind="stable")
    if period is not None:
        return np.interp(x, curve[0][order], curve[1][order], period=period)
    return np.interp(x, curve[0][order], curve[1][order], left=np.nan, right=np.nan)


def _on_loop(curve: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return, of the ordinates that a closed curve has at each abscissa, the one nearest to ``y``.

    Abscissae beyond the curve's own, by less than 1 % of its width, count as its ends.
    """
    low, high = curve[0].min(), curve[0].max()
    slack = 0.01 * (high - low)
    nearest = np.full(x.shape, np.nan)
    start, end = curve, np.roll(curve, -1, axis=1)
    for k, place in enumerate(x):
        if not low - slack <= place <= high + slack:
            continue
        here = np.clip(place, low, high)
        across = (np.minimum(start[0], end[0]) <= here) & (here <= np.maximum(start[0], end[0]))
        run = np.where(end[0] == start[0], 1.0, end[0] - start[0])
        crossings = (start[1] + (here - start[0]) / run * (end[1] - start[1]))[across]
        nearest[k] = crossings[np.abs(crossings - y[k]).argmin()]
    return nearest


def _numbers(table: PublishedCurves, curves: Curves) -> CurveComparison:
    """Return the comparison of single numbers: theirs is the mean of the sources."""
    names = table.columns["quantity"]
    missing = [name for name in names if name not in curves]
    if missing:
        raise IncompatibleRecord(f"the flow gave no {', '.join(missing)}; compute it anew.")
    sources = np.stack([table.values(column) for column in table.columns if column != "quantity"])
    theirs = np.nanmean(sources, axis=0)
    off = sources / theirs - 1
    ours = np.array([float(curves[name]) for name in names])
    return CurveComparison(
        x=np.arange(len(names)), published=theirs, computed=ours, rms=float(np.sqrt(np.mean((ours / theirs - 1) ** 2))),
        over_range=None, source_error=_own_of_numbers(table, sources),
        scatter=float(np.sqrt(np.nanmean(off**2))) if len(sources) > 1 else None,
    )  # fmt: skip


def _own_of_numbers(table: PublishedCurves, sources: np.ndarray) -> float:
    """Return the root mean square of half a unit of the last digit over each published number [-]."""
    texts = [text for column in table.columns if column != "quantity" for text in table.columns[column]]
    known = [(text, value) for text, value in zip(texts, sources.ravel(), strict=True) if text]
    halves = np.array([half_a_digit(text) / value for text, value in known])
    return float(np.sqrt(np.mean(halves**2)))


def _scatter(row: AtlasRow, x: np.ndarray, y: np.ndarray) -> float | None:
    """Return the largest rms difference over the peak between a row's source and another one, where both are known."""
    differences = []
    for name, abscissa, ordinate, factor in row.other_sources:
        table = published(name)
        other = np.stack([table.values(abscissa) * factor + row.shift[0], table.values(ordinate)])
        values = at_abscissae(other, x, row.period)
        reached = np.isfinite(values)
        if reached.sum() >= _FEWEST:
            differences.append(rms_over_peak(values[reached], y[reached]))
    return max(differences) if differences else None

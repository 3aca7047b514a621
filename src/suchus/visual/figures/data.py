"""The numbers behind a figure, read from what is drawn in it: one table with quantity and unit in its header.

A row is a point of a series in a panel. Each quantity, as the axes name it, has one column, which panels that show the
same quantity share. Bars give their length, bands and outlines their corners, fields the value of each cell.
"""

import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import ceil, isfinite
from typing import Any, Final, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.cm import ScalarMappable
from matplotlib.collections import Collection, LineCollection, PathCollection, PolyCollection, QuadMesh
from matplotlib.colors import to_hex
from matplotlib.container import BarContainer, ErrorbarContainer
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch, Polygon, Rectangle, StepPatch
from matplotlib.ticker import FixedLocator

MAX_FIELD_VALUES: Final = 10_000
"""Values of one field that go into the table [-]; of a finer one every n-th along both axes."""
_FIELD_ATTRIBUTE: Final = "suchus_values"

Cells = dict[str, str]
"""One row: text by column."""


class _Quantity(NamedTuple):
    """What a panel shows along one of its axes."""

    name: str
    """Quantity and unit."""
    tick_positions: np.ndarray
    """Positions of the ticks on the axis."""
    words: list[str]
    """Labels of the ticks; empty on an axis of numbers."""

    def word(self, value: float) -> str:
        """Return the tick label at a position on the axis; empty on an axis of numbers."""
        return self.words[int(np.argmin(np.abs(self.tick_positions - float(value))))] if self.words else ""


_Quantities = tuple[_Quantity, _Quantity]
"""Quantities of a panel along x and along y."""


@dataclass(frozen=True, slots=True)
class CarriedField:
    """A field as it was computed; the drawing may smooth it or turn it into lines."""

    values: np.ndarray
    """Shape (y, x), in the unit of the colour bar."""
    x: np.ndarray | None
    """Places along x, in the unit of the axis; None: evenly over the picture."""
    y: np.ndarray | None
    """Places along y, likewise."""


def carry(
    artist: Artist | ScalarMappable, values: np.ndarray, x: np.ndarray | None = None, y: np.ndarray | None = None
) -> None:
    """Attach the computed field to the artist that draws it, for the figure's table.

    Args:
        artist: what ``imshow`` or ``contourf`` returned.
        values: the field, shape (y, x), in the unit of its colour bar.
        x: places along x, in the unit of the axis; not needed of a picture.
        y: the same along y.
    """
    setattr(artist, _FIELD_ATTRIBUTE, CarriedField(np.asarray(values), x, y))


def field_of(artist: Artist | ScalarMappable) -> np.ndarray:
    """Return the field that an artist shows, NaN where it has no value."""
    field = getattr(artist, _FIELD_ATTRIBUTE, None)
    values: Any = field.values if field is not None else artist.get_array()  # type: ignore[union-attr]
    return np.ma.filled(np.ma.asarray(values, dtype=float), np.nan)


def table(figure: Figure) -> str:
    """Return the numbers of a figure as CSV; empty where it shows none."""
    rows = list(_rows(figure))
    columns = list(dict.fromkeys(["panel", "series", *(name for row in rows for name in row)]))
    if not rows:
        return ""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([row.get(column, "") for column in columns] for row in rows)
    return text.getvalue()


def _rows(figure: Figure) -> Iterator[Cells]:
    """Yield one row for every point of every series, panel by panel."""
    panels = [panel for ax in figure.axes for panel in (ax, *ax.child_axes) if isinstance(panel, Axes)]
    axes = [ax for ax in panels if ax.get_label() != "<colorbar>"]
    labels = _labels_by_style(axes)
    for i, ax in enumerate(axes, start=1):
        title = _plain(ax.get_title("left") or ax.get_title())
        panel = f"{i} {title}".strip()
        for name, points in _series(ax, labels):
            for point in points:
                yield {"panel": panel, "series": name, **point}


def _labels_by_style(panels: Sequence[Axes]) -> Mapping[tuple[str, ...], str]:
    """Return the label of each look that a labelled line has: lines that look alike elsewhere show the same."""
    labels: dict[tuple[str, ...], str] = {}
    for line in (line for ax in panels for line in ax.lines):
        if not is_hidden(line.get_label()):
            labels.setdefault(_line_style(line), _plain(str(line.get_label())))
    return labels


def _line_style(line: Line2D) -> tuple[str, ...]:
    return to_hex(line.get_color()), str(line.get_linestyle()), str(line.get_marker())


def _series(ax: Axes, labels: Mapping[tuple[str, ...], str]) -> Iterator[tuple[str, Iterator[Cells]]]:
    """Yield the name and the points of everything that shows numbers in a panel."""
    names = _Quantity(_name(ax, "x"), *_ticks(ax.xaxis)), _Quantity(_name(ax, "y"), *_ticks(ax.yaxis))
    bars = [bar_container for bar_container in ax.containers if isinstance(bar_container, BarContainer)]
    in_bars = {id(patch) for bar_container in bars for patch in bar_container.patches}
    for line, default in zip(ax.lines, _line_names(ax, labels, names), strict=True):
        yield _series_name(line.get_label(), default), _of_line(ax, line, names)
    for i, container in enumerate(bars, start=1):
        yield _series_name(container.get_label(), f"bars {i}"), _of_bars(container, names)
    for i, collection in enumerate(ax.collections, start=1):
        yield _series_name(collection.get_label(), f"collection {i}"), _of_collection(ax, collection, names)
    for i, image in enumerate(ax.images, start=1):
        yield _series_name(image.get_label(), f"field {i}"), _of_image(image, names)
    for i, patch in enumerate(ax.patches, start=1):
        if id(patch) not in in_bars and patch.get_data_transform() == ax.transData:
            yield _series_name(patch.get_label(), f"outline {i}"), _of_patch(patch, names)


def _line_names(ax: Axes, labels: Mapping[tuple[str, ...], str], names: _Quantities) -> list[str]:
    """Return the names of the lines of a panel that have no label of their own.

    A line takes the label of the one that looks alike, or of its error bars. One across the panel is a guide. The only
    other line of a panel shows the quantity of its vertical axis; of several, each has the number of the line.
    """
    fixed_names = {
        id(line): name
        for line in ax.lines
        for transform, name in (
            (ax.get_xaxis_transform(which="grid"), "vertical guide"),
            (ax.get_yaxis_transform(which="grid"), "horizontal guide"),
        )
        if line.get_transform() == transform
    }
    for bars in (container for container in ax.containers if isinstance(container, ErrorbarContainer)):
        name = "measured" if is_nameless(bars.get_label()) else _plain(str(bars.get_label())).removeprefix("_")
        data_line, caps, _ = bars.lines
        fixed_names |= {id(cap): f"{name}, end of the bar" for cap in caps}
        fixed_names[id(data_line)] = name  # None where there are bars alone
    unnamed = [
        line
        for line in ax.lines
        if is_nameless(line.get_label()) and id(line) not in fixed_names and _line_style(line) not in labels
    ]
    quantity = names[1].name.partition(" [")[0]
    return [
        fixed_names.get(id(line))
        or labels.get(_line_style(line))
        or (quantity if len(unnamed) == 1 and ax.axison and quantity != "y" else f"line {i}")
        for i, line in enumerate(ax.lines, start=1)
    ]


def _of_line(ax: Axes, line: Line2D, names: _Quantities) -> Iterator[Cells]:
    """Yield the points of a line; of a line across the panel its one coordinate."""
    if line.get_transform() == ax.get_xaxis_transform(which="grid"):  # a vertical line over the whole height
        yield _cells(names, (float(np.asarray(line.get_xdata(orig=False))[0]), None))
    elif line.get_transform() == ax.get_yaxis_transform(which="grid"):
        yield _cells(names, (None, float(np.asarray(line.get_ydata(orig=False))[0])))
    elif line.get_transform() == ax.transData:
        for x, y in np.asarray(line.get_xydata(), dtype=float):
            yield _cells(names, (x, y))


def _of_bars(bars: BarContainer, names: _Quantities) -> Iterator[Cells]:
    """Yield the position and length of each bar."""
    for bar in bars.patches:
        if bars.orientation == "horizontal":
            yield _cells(names, (bar.get_width(), bar.get_y() + bar.get_height() / 2))
        else:
            yield _cells(names, (bar.get_x() + bar.get_width() / 2, bar.get_height()))


def _of_collection(ax: Axes, collection: Collection, names: _Quantities) -> Iterator[Cells]:
    """Yield the points of a collection: cells of a field, coloured points, or corners of lines and areas."""
    field = getattr(collection, _FIELD_ATTRIBUTE, None)
    if field is not None:
        yield from _of_field(field.x, field.y, field.values, names, _colour(collection))
    elif isinstance(collection, QuadMesh):
        corners = np.asarray(collection.get_coordinates(), dtype=float)
        centers: np.ndarray = 0.25 * (corners[1:, 1:] + corners[1:, :-1] + corners[:-1, 1:] + corners[:-1, :-1])
        values = field_of(collection).reshape(centers.shape[:2])
        yield from _of_field(centers[0, :, 0], centers[:, 0, 1], values, names, _colour(collection))
    elif isinstance(collection, PathCollection):
        coloured: Any = collection.get_array()
        for i, (x, y) in enumerate(np.ma.filled(np.ma.asarray(collection.get_offsets(), dtype=float), np.nan)):
            extra = {} if coloured is None else {_colour(collection): _text(coloured[i])}
            yield _cells(names, (x, y)) | extra
    elif isinstance(collection, (LineCollection, PolyCollection)) and collection.get_transform() == ax.transData:
        for path in collection.get_paths():
            for x, y in np.asarray(path.vertices, dtype=float):
                yield _cells(names, (x, y))


def _of_image(image: AxesImage, names: _Quantities) -> Iterator[Cells]:
    """Yield the cells of a picture that shows a field."""
    values = field_of(image)
    if values.ndim > 2:  # RGB colours are no field
        return
    x0, x1, y0, y1 = image.get_extent()
    ny, nx = values.shape[:2]
    x, y = (a + (np.arange(n) + 0.5) * (b - a) / n for a, b, n in ((x0, x1, nx), (y0, y1, ny)))
    yield from _of_field(x, y if image.origin == "lower" else y[::-1], values, names, _colour(image))


def _of_patch(patch: Patch, names: _Quantities) -> Iterator[Cells]:
    """Yield the corners of a patch; of a circle its centre, of a histogram its edges."""
    if isinstance(patch, Circle):
        yield _cells(names, patch.center)
    elif isinstance(patch, StepPatch):
        values, edges, _ = patch.get_data()
        for value, lower_edge, upper_edge in zip(values, edges[:-1], edges[1:], strict=True):
            yield _cells(names, (lower_edge, value))
            yield _cells(names, (upper_edge, value))
    elif isinstance(patch, Rectangle):
        yield _cells(names, patch.get_xy())
        yield _cells(names, (patch.get_x() + patch.get_width(), patch.get_y() + patch.get_height()))
    elif isinstance(patch, Polygon):
        for x, y in patch.get_xy():
            yield _cells(names, (x, y))


def _of_field(x: Any, y: Any, values: np.ndarray, names: _Quantities, colour: str) -> Iterator[Cells]:
    step = max(1, ceil((values.size / MAX_FIELD_VALUES) ** 0.5))
    for j in range(0, values.shape[0], step):
        for i in range(0, values.shape[1], step):
            yield _cells(names, (x[i], y[j])) | {colour: _text(values[j, i])}


def _cells(names: _Quantities, point: tuple[float | None, float | None]) -> Cells:
    pairs = zip(names, point, strict=True)
    return {quantity.name: quantity.word(value) or _text(value) for quantity, value in pairs if value is not None}


def _name(ax: Axes, axis_name: str) -> str:
    """Return the quantity and unit of an axis; inner panels have the label of the panel whose axis they share.

    A panel without axes is a drawing to scale, in metres.
    """
    group = ax.get_shared_x_axes() if axis_name == "x" else ax.get_shared_y_axes()
    for panel in (ax, *group.get_siblings(ax)):
        label = _plain(panel.get_xlabel() if axis_name == "x" else panel.get_ylabel())
        if label:
            other_label = _plain(panel.get_ylabel() if axis_name == "x" else panel.get_xlabel())
            return f"{axis_name}: {label}" if label == other_label else label
    if not ax.axison:
        return f"{axis_name} [m]"
    return "category" if _ticks(ax.xaxis if axis_name == "x" else ax.yaxis)[1] else axis_name


def _colour(artist: Any) -> str:
    """Return the label of the colour bar of a field, or of one in another panel with the same colours and range."""
    panels = artist.figure.axes
    same_scale = [
        mappable for ax in panels for mappable in (*ax.collections, *ax.images) if _scale(mappable) == _scale(artist)
    ]
    bars = [mappable.colorbar for mappable in (artist, *same_scale) if mappable.colorbar is not None]
    label = _plain(bars[0].ax.get_ylabel() or bars[0].ax.get_xlabel()) if bars else ""
    return label or "value"


def _scale(artist: Any) -> tuple[str, float | None, float | None]:
    return artist.get_cmap().name, artist.norm.vmin, artist.norm.vmax


def _ticks(axis: Axis) -> tuple[np.ndarray, list[str]]:
    """Return the places and the words at the ticks of an axis; no words where the places themselves stand there."""
    locator = axis.get_major_locator()
    positions: np.ndarray = np.array(locator() if isinstance(locator, FixedLocator) else [], dtype=float)
    if not positions.size:
        return positions, []
    words = [_plain(word) for word in axis.get_major_formatter().format_ticks(positions.tolist())]
    has_words = any(word and not _says(word, position) for word, position in zip(words, positions, strict=True))
    return positions, words if has_words else []


def _says(word: str, position: float) -> bool:
    """Return whether a tick label is the rounded number of its position."""
    number = word.replace("\N{MINUS SIGN}", "-")
    digits = number.lower().partition("e")[0].partition(".")[2]
    try:
        return abs(float(number) - position) <= 0.5000001 * 10.0 ** -len(digits)
    except ValueError:
        return False


def _series_name(label: object, default: str) -> str:
    """Return the name of a series: its label, or what follows the ``_`` that keeps a label out of the legend."""
    text = _plain(str(label))
    if not is_hidden(label):
        return text
    return default if is_nameless(label) else text[1:]


def is_nameless(label: object) -> bool:
    """Return whether a label names no series, not even outside of the legend."""
    return label is None or not str(label) or str(label).startswith(("_child", "_nolegend"))


def is_hidden(label: object) -> bool:
    """Return whether a legend leaves out a label."""
    return label is None or not str(label) or str(label).startswith("_")


def _plain(text: str) -> str:
    return " ".join(text.replace("$", "").split())


def _text(value: Any) -> str:
    number = float(value)
    return f"{number:.6g}" if isfinite(number) else ""

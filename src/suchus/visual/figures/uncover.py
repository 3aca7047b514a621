"""Legends that cover nothing: the layout of every figure, which moves a legend off what is drawn under it."""

from collections.abc import Iterator
from typing import Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import Collection, PathCollection, QuadMesh
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.transforms import Bbox, ScaledTranslation

from suchus.visual.figures.data import field_of, is_hidden

_INNER_LOCATIONS: Final = (
    "upper left", "upper right", "lower right", "lower left",
    "upper center", "lower center", "center left", "center right", "center",
)  # fmt: skip
"""Places inside the axes, in the order in which they are tried."""
_GAP: Final = 0.06
"""Gap between the axis and a legend below it [inch]."""


class UncoveredLegendLayout(ConstrainedLayoutEngine):
    """Constrained layout after which no legend lies on data: where it did, it moves inside the axes or below them."""

    def execute(self, fig: Figure) -> None:
        """Place axes and legends of a figure."""
        super().execute(fig)
        for try_inside in (True, False):  # a legend that fitted inside may not fit after others moved
            if not (lying := list(covering(fig))):
                return
            for ax, legend in lying:
                if not (try_inside and _move_inside(fig, ax, legend)):
                    _move_below(fig, ax, legend)
            super().execute(fig)


def covering(figure: Figure) -> Iterator[tuple[Axes, Legend]]:
    """Yield every legend of a figure's axes that lies on what some axes show, with the axes that it belongs to.

    A line across the axes without a label, such as a mark of a cycle, and a shade across them count as ground.
    """
    for ax in figure.axes:
        legend = ax.get_legend()
        if legend is not None and legend.get_visible() and _lies_on_data(figure, legend):
            yield ax, legend


def _lies_on_data(figure: Figure, legend: Legend) -> bool:
    box = legend.get_window_extent()
    return any(_meets(artist, ax, box) for ax in figure.axes if ax.get_visible() for artist in _visible_artists(ax))


def _visible_artists(ax: Axes) -> Iterator[Artist]:
    """Yield the artists that show data or text in axes; of a colour bar its whole area."""
    if ax.get_label() == "<colorbar>":
        yield ax.patch
        return
    for artist in (*ax.lines, *ax.patches, *ax.collections, *ax.images, *ax.texts):
        ground = (*ax.lines, *ax.patches)
        spans_axes = artist in ground and not all(artist.get_transform().contains_branch_seperately(ax.transData))
        if artist.get_visible() and not (spans_axes and is_hidden(artist.get_label())):
            yield artist


def _meets(artist: Artist, ax: Axes, box: Bbox) -> bool:
    """Return whether an artist shows something within a box of the picture.

    Args:
        artist: drawn in the axes.
        ax: the axes, which may clip the artist.
        box: of a legend [pixel].
    """
    visible_box = Bbox.intersection(box, ax.bbox) if artist.get_clip_on() and artist is not ax.patch else box
    if visible_box is None:
        return False
    if isinstance(artist, Line2D):
        path = artist.get_transform().transform_path(artist.get_path())
        radius = (
            0.5 * artist.get_markersize() * ax.figure.dpi / 72
            if artist.get_marker() not in ("None", "", " ", None)
            else 0
        )
        return (radius > 0 and _holds(visible_box.padded(radius), path.vertices)) or (
            artist.get_linestyle() not in ("None", "", " ") and path.intersects_bbox(visible_box, filled=False)
        )
    if isinstance(artist, Collection):
        return _collection_meets(artist, ax, visible_box)
    if hasattr(artist, "get_path") and hasattr(artist, "get_facecolor"):  # a patch
        path = artist.get_transform().transform_path(artist.get_path())
        return bool(path.intersects_bbox(visible_box, filled=artist.get_facecolor()[3] > 0))
    return bool(artist.get_window_extent().overlaps(visible_box))  # a picture or a text


def _collection_meets(collection: Collection, ax: Axes, visible_box: Bbox) -> bool:
    """Return whether a field, points, lines or areas show something within a box of the picture [pixel]."""
    if isinstance(collection, QuadMesh):
        corners = np.asarray(collection.get_coordinates(), dtype=float)
        grid = ax.transData.transform(corners.reshape(-1, 2)).reshape(corners.shape)
        cell_corners = np.stack([grid[1:, 1:], grid[1:, :-1], grid[:-1, 1:], grid[:-1, :-1]])
        cell_min, cell_max = cell_corners.min(axis=0), cell_corners.max(axis=0)
        has_value = np.isfinite(field_of(collection)).reshape(cell_min.shape[:2])
        return bool((has_value & ((cell_min < visible_box.max) & (cell_max > visible_box.min)).all(axis=-1)).any())
    offsets: Any = collection.get_offsets()
    if isinstance(collection, PathCollection):
        radius = 0.5 * float(np.sqrt(np.max(collection.get_sizes(), initial=0.0))) * ax.figure.dpi / 72
        return _holds(
            visible_box.padded(radius), collection.get_offset_transform().transform(np.ma.filled(offsets, np.nan))
        )
    is_filled = bool(np.size(collection.get_facecolor()))
    return any(
        collection.get_transform().transform_path(path).intersects_bbox(visible_box, filled=is_filled)
        for path in collection.get_paths()
        if np.size(path.vertices)
    )


def _holds(box: Bbox, points: Any) -> bool:
    positions = np.asarray(points, dtype=float).reshape(-1, 2)
    return bool(((positions > box.min) & (positions < box.max)).all(axis=1).any())


def _move_inside(figure: Figure, ax: Axes, legend: Legend) -> bool:
    """Move a legend to the first place inside its axes where it covers nothing; False where there is none."""
    legend.set_bbox_to_anchor(None)
    for location in _INNER_LOCATIONS:
        legend.set_loc(location)
        box = legend.get_window_extent()
        is_inside = ax.bbox.contains(*box.min) and ax.bbox.contains(*box.max)
        if is_inside and not _lies_on_data(figure, legend):
            return True
    return False


def _move_below(figure: Figure, ax: Axes, legend: Legend) -> None:
    """Make a legend anew below its axes, their numbers and their label, in as many columns as they are wide."""
    texts = legend.get_texts()
    boxes = [text.get_window_extent() for text in texts]
    entry_width = boxes[0].x0 - legend.get_window_extent().x0 + max(box.width for box in boxes)
    legend.set_in_layout(False)
    tight_box = ax.get_tightbbox()
    assert tight_box is not None
    offset = (ax.bbox.y0 - tight_box.y0) / figure.dpi + _GAP
    ax.legend(
        [handle for handle in legend.legend_handles if handle is not None],
        [text.get_text() for text in texts],
        loc="upper left",
        bbox_to_anchor=(0.0, 0.0),
        bbox_transform=ax.transAxes + ScaledTranslation(0.0, -offset, figure.dpi_scale_trans),
        borderaxespad=0.0,
        ncols=min(max(1, int(ax.bbox.width / entry_width)), len(texts)),
        fontsize=texts[0].get_fontsize(),
        title=legend.get_title().get_text() or None,
    )

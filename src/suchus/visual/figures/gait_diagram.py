"""The gait diagram: which feet stand when, and how spine and tail bend meanwhile, as in Fig. 12."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from types import MappingProxyType
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from suchus.core.errors import InvalidDesign
from suchus.robot.design import LEGS
from suchus.visual.figures.style import COLOURS, WIDTH, panels, styled

GAIT_LINES: Mapping[str, Mapping[str, Any]] = MappingProxyType(
    {
        "belly_crawl": {"color": "#767676", "marker": "v", "linestyle": (0, (1, 1.2)), "label": "belly crawl"},
        "low_crawl": {"color": "#009E73", "marker": "s", "linestyle": (0, (5, 2)), "label": "low crawl"},
        "semi_erect": {"color": "#0072B2", "marker": "o", "linestyle": "-", "label": "semi-erect"},
        "high_walk": {"color": "#D55E00", "marker": "^", "linestyle": (0, (5, 1.5, 1, 1.5)), "label": "high walk"},
        "high_walk_level": {"color": "#E69F00", "marker": "D", "linestyle": "-", "label": "high walk, IMU"},
        "switching": {"color": "#B0558A", "marker": "*", "linestyle": (0, (3, 1)), "label": "switching"},
        "thrifty": {
            "color": "#56B4E9",
            "marker": "P",
            "linestyle": (0, (3, 1, 1, 1)),
            "label": "switching, from crawl",
        },
    }
)
"""Colour, marker, dashes and label of each gait or arm."""
_EXTRA_COLOURS = ("#56B4E9", "#F0E442", "#B0558A")


def gait_lines(names: Iterable[Any]) -> Mapping[str, Mapping[str, Any]]:
    """Return ``GAIT_LINES`` with lines for further gaits, which are called by their names."""
    extra_names = [str(name) for name in names if str(name) not in GAIT_LINES]
    return {
        **GAIT_LINES,
        **{
            name: {
                "color": COLOURS["coordinated"] if i == 0 else _EXTRA_COLOURS[i % len(_EXTRA_COLOURS)],
                "marker": "o",
                "linestyle": "-",
                "label": name.replace("_", " "),
            }
            for i, name in enumerate(extra_names)
        },
    }


_BLACK, _GREY, _EDGE = "#111111", "#9A9A9A", "#333333"
_SHADES = (_BLACK, _GREY)
_DASHES: tuple[Any, ...] = ("-", (0, (4, 2)))
_BENDS = ("spine", "tail")
_STRAIGHT = 0.05  # fraction of the largest bend below which a body counts as straight
_MAX_STILL_BEND = np.radians(1.0)  # a bend that never exceeds this has no sign


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class GaitTrack:
    """One walk over time, as the diagram shows it."""

    time: np.ndarray
    """Increasing, shape (time,) [s or cycle]."""
    stance: np.ndarray
    """Whether a foot stands, in the order of ``legs``, shape (leg, time) [-]."""
    spine: np.ndarray | None
    """Lateral angle of the spine in the article's sign, right positive, shape (time,) [rad]; None where none bends."""
    tail: np.ndarray | None
    """Lateral angle of the tail in the article's sign, right positive, shape (time,) [rad]; None where none bends."""
    label: str
    """Label in the legend."""
    legs: tuple[str, ...] = LEGS
    """Names of the limbs."""
    spine_vertical: np.ndarray | None = None
    """Vertical angle of the spine in the article's sign, down positive, shape (time,) [rad]."""
    tail_vertical: np.ndarray | None = None
    """Vertical angle of the tail in the article's sign, down positive, shape (time,) [rad]."""
    spine_spread: np.ndarray | None = None
    """Half-width of a band around ``spine`` [rad]."""
    tail_spread: np.ndarray | None = None
    """Half-width of a band around ``tail`` [rad]."""

    def __post_init__(self) -> None:
        n = len(self.time)
        verticals = [name for name in ("spine_vertical", "tail_vertical") if getattr(self, name) is not None]
        shapes = {"stance": (len(self.legs), n), **dict.fromkeys((*self.bends, *verticals), (n,))}
        for name, expected_shape in shapes.items():
            shape = np.shape(getattr(self, name))
            if shape != expected_shape:
                raise InvalidDesign(f"gait track {self.label!r}: {name} has shape {shape}; {expected_shape} is needed.")
        if n < 2 or not np.all(np.diff(self.time) > 0):
            raise InvalidDesign(f"gait track {self.label!r}: time needs two samples or more that increase.")

    @property
    def bends(self) -> tuple[str, ...]:
        """The parts of the body that bend."""
        return tuple(region for region in _BENDS if getattr(self, region) is not None)


def gait_diagram(tracks: Sequence[GaitTrack], *, cycles: Sequence[float] = (), unit: str = "s") -> Figure:
    """Return the diagram of one or two walks: bars on top, the lateral angles below, then the vertical ones if given.

    Args:
        tracks: the first in black, the second in grey and dashed.
        cycles: where cycles begin and end, in the unit of time.
        unit: unit of time, ``s`` or ``cycle``.
    """
    bends = any(track.bends for track in tracks)
    vertical = bends and any(t.spine_vertical is not None or t.tail_vertical is not None for t in tracks)
    ratios = [2.1, *([1.5] if bends else []), *([1.2] if vertical else [])]
    with styled():
        height = 3.6 + 2.3 * bends + 1.9 * vertical
        figure, axes = panels(len(ratios), 1, width=WIDTH + 1.0, height=height, sharex=True, height_ratios=ratios)
        draw_bars(axes[0, 0], tracks)
        if bends:
            draw_bends(axes[1, 0], tracks)
        if vertical:
            draw_vertical(axes[2, 0], tracks)
        for ax in axes[:, 0]:
            for cycle_time in cycles:
                ax.axvline(cycle_time, color=COLOURS["neutral"], linewidth=0.9, linestyle=(0, (1, 2)), zorder=0)
        axes[-1, 0].set_xlabel(f"time [{unit}]")
    return figure


def draw_bars(ax: Axes, tracks: Sequence[GaitTrack]) -> None:
    """Draw a bar wherever a foot stands, and the signs of the two lateral angles.

    Black (or grey, for a second track): a foot stands; spine or tail bend to the right, the article's positive side.
    An open bar: they bend to the left. No bar: a foot swings; spine or tail are straight.

    Args:
        ax: axes to draw on.
        tracks: one or two.
    """
    if not 1 <= len(tracks) <= len(_SHADES):
        raise InvalidDesign(f"a gait diagram shows 1 or {len(_SHADES)} tracks; {len(tracks)} were given.")
    height, legs, regions = 0.66 / len(tracks), tracks[0].legs, tracks[0].bends
    for i, (track, shade) in enumerate(zip(tracks, _SHADES, strict=False)):
        top = -0.33 + i * height
        for row, stands in enumerate(track.stance):
            _bars(ax, track.time, stands, (row + top, 0.92 * height), shade, shade)
        for row, region in enumerate(track.bends, start=len(legs)):
            signs = bend_sign(getattr(track, region))
            row_span = (row + top + 0.25, 0.92 * height)  # a gap sets the two signs apart from the four legs
            _bars(ax, track.time, signs > 0, row_span, shade, shade, "+" if len(tracks) == 1 else "")
            _bars(ax, track.time, signs < 0, row_span, "white", shade, "\N{MINUS SIGN}" if len(tracks) == 1 else "")
    tick_positions = [*range(len(legs)), *(len(legs) + 0.25 + i for i in range(len(regions)))]
    ax.set_yticks(tick_positions, [*legs, *regions])
    ax.set_ylim(tick_positions[-1] + 0.5, -0.5)
    ax.set_xlim(min(t.time[0] for t in tracks), max(t.time[-1] for t in tracks))
    ax.tick_params(axis="y", length=0)
    ax.grid(False)
    ax.axhline(len(legs) - 0.375, color=COLOURS["grid"], linewidth=0.9)
    _bar_legend(ax, tracks)


def draw_bends(ax: Axes, tracks: Sequence[GaitTrack]) -> None:
    """Draw the lateral angles of spine and tail over time, right positive [deg].

    Args:
        ax: axes to draw on.
        tracks: the first drawn through, the second dashed.
    """
    ax.axhline(0.0, color=_EDGE, linewidth=0.8)
    for track, dashes in zip(tracks, _DASHES, strict=False):
        for name in track.bends:
            angle, spread = np.degrees(getattr(track, name)), getattr(track, f"{name}_spread")
            label = f"{name}, {track.label}" if len(tracks) > 1 else name
            ax.plot(track.time, angle, color=COLOURS[name], linestyle=dashes, label=label)
            if spread is not None:
                half = np.degrees(spread)
                ax.fill_between(track.time, angle - half, angle + half, color=COLOURS[name], alpha=0.2, linewidth=0)
    ax.set_ylabel("lateral angle [deg],\nright positive")
    ax.margins(y=0.08)
    ax.legend(
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        ncols=2 * len(tracks),
        frameon=False,
        borderpad=0.1,
        columnspacing=1.2,
        handlelength=1.7,
    )


def draw_vertical(ax: Axes, tracks: Sequence[GaitTrack]) -> None:
    """Draw the vertical angles of spine and tail over time, up above and down, the positive side, below [deg].

    Args:
        ax: axes to draw on.
        tracks: the first drawn through, the second dashed; those without vertical angles are left out.
    """
    ax.axhline(0.0, color=_EDGE, linewidth=0.8)
    for track, dashes in zip(tracks, _DASHES, strict=False):
        for name in ("spine", "tail"):
            angle = getattr(track, f"{name}_vertical")
            if angle is not None:
                ax.plot(track.time, np.degrees(angle), color=COLOURS[name], linestyle=dashes)
    ax.set_ylabel("vertical angle [deg],\ndown positive")
    ax.margins(y=0.15)
    ax.invert_yaxis()


def bend_sign(angle: np.ndarray) -> np.ndarray:
    """Return the sign of a lateral angle over time: 1 right, -1 left, 0 straight, shape (time,) [-].

    Straight is what bends less than a twentieth of the largest bend; a body that stays within a degree is straight.

    Args:
        angle: shape (time,) [rad].
    """
    max_bend = float(np.nanmax(np.abs(angle), initial=0.0))
    if max_bend < _MAX_STILL_BEND:
        return np.zeros(len(angle), dtype=int)
    return np.where(np.abs(angle) > _STRAIGHT * max_bend, np.sign(angle), 0).astype(int)


def intervals(time: np.ndarray, holds: np.ndarray) -> list[tuple[float, float]]:
    """Return from when to when something holds.

    Args:
        time: shape (time,).
        holds: shape (time,).
    """
    half = np.concatenate([[time[0]], (time[1:] + time[:-1]) / 2, [time[-1]]])
    edges = np.flatnonzero(np.diff(np.concatenate([[False], np.asarray(holds, dtype=bool), [False]]).astype(int)))
    return [(float(half[a]), float(half[b])) for a, b in list(pairwise(edges))[::2]]


def _bars(
    ax: Axes, time: np.ndarray, holds: np.ndarray, row_span: tuple[float, float], fill: str, edge: str, sign: str = ""
) -> None:
    """Draw a bar over every interval in which a condition holds.

    Args:
        ax: axes to draw on.
        time: shape (time,).
        holds: the condition, shape (time,).
        row_span: top and height of the bar.
        fill: colour of the bar.
        edge: colour of its edge.
        sign: text on bars that are long enough for it.
    """
    top, height = row_span
    span = float(time[-1] - time[0])
    for start, end in intervals(time, holds):
        ax.add_patch(
            Rectangle((start, top), end - start, height, facecolor=fill, edgecolor=edge, linewidth=1.0, zorder=3)
        )
        if sign and end - start > 0.03 * span:
            colour = "white" if fill == _BLACK else edge
            center = ((start + end) / 2, top + height / 2)
            ax.text(*center, sign, color=colour, ha="center", va="center_baseline", fontsize=13, zorder=4)


def _bar_legend(ax: Axes, tracks: Sequence[GaitTrack]) -> None:
    """Add the legend of the bars: standing feet and the two signs of a bend."""
    handles = [Patch(facecolor=shade, edgecolor=shade) for _, shade in zip(tracks, _SHADES, strict=False)]
    labels = [track.label for track in tracks]
    ax.legend(
        [*handles, Patch(facecolor="white", edgecolor=_BLACK)],
        [f"{label}: stands, bends right" for label in labels] + ["bends left"],
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=len(tracks) + 1,
        frameon=False,
        borderpad=0.1,
        handlelength=1.4,
        columnspacing=1.2,
    )

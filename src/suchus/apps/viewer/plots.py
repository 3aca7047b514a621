"""Plots beside the scene: height, displacement, loads over the last seconds, and the bars of the gait."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.ndimage import uniform_filter1d

from suchus.robot.design import GRAVITY, Robot
from suchus.sim.metrics.gait import LOADED_SHARE
from suchus.visual.figures import COLOURS
from suchus.visual.figures.style import limb_colours

_MAX_POINTS = 400  # points of a line; more cannot be distinguished
_BARS_WIDTH = 330  # [pixel]; of the picture of stances
_MIN_NEWTON_MASS = 0.1  # [kg]; the loads of lighter bodies are shown in millinewtons
PLOTS = 370
"""Width of the plots to the left of the scene [pixel]."""
AXIS = {"stroke": "#555555", "grid": {"stroke": "#e6e6e6", "width": 1}, "ticks": {"stroke": "#cccccc", "width": 1}}
"""Style of the axes, in the terms of uPlot."""


@dataclass(frozen=True, slots=True)
class Line:
    """One line of a chart."""

    label: str
    """Label in the legend."""
    column: str
    """Name of the column."""
    colour: str
    """Colour as #rrggbb."""
    dash: tuple[float, ...] = ()
    """Lengths of dashes and gaps [pixel]; empty for an unbroken line."""


@dataclass(frozen=True, slots=True)
class PlotLayout:
    """Title, lines and unit of a chart."""

    title: str
    """Title above the chart, with the unit."""
    lines: tuple[Line, ...]
    """The lines that it draws."""
    scale: float = 1.0
    """Factor from SI to the unit of the title."""
    mean: float = 0.0
    """Averaging time [s]; without it, spikes at touchdown hide the rest."""


def plans(robot: Robot) -> tuple[PlotLayout, ...]:
    """Return the charts of a robot, from above."""
    light = robot.mass < _MIN_NEWTON_MASS
    return (
        PlotLayout("height of the centre of mass [mm]", (Line("height", "height", COLOURS["ours"]),), 1e3),
        PlotLayout(
            "displacement since the first step [m]",
            (
                Line("forward", "forward", COLOURS["ours"]),
                Line("to the left", "aside", COLOURS["limbs_only"], (6.0, 3.0)),
            ),
        ),
        PlotLayout(
            f"load on the ground [{'mN' if light else 'N'}], mean over 0.1 s",
            (
                *(Line(limb, limb, colour) for limb, colour in limb_colours(robot)),
                Line("tail", "tail", COLOURS["tail"], (2.0, 3.0)),
                Line("belly", "belly", COLOURS["neutral"], (6.0, 3.0)),
            ),
            1e3 if light else 1.0,
            mean=0.1,
        ),
    )


class Chart:
    """A chart of several lines over time.

    Args:
        gui: viser's interface of one browser.
        plan: what it shows.
        uplot: viser's module of chart settings.
        has_ghost: whether there is a second run, drawn pale.
    """

    def __init__(self, gui: Any, plan: PlotLayout, uplot: Any, *, has_ghost: bool = False) -> None:
        self._plan, self._has_ghost = plan, has_ghost
        chart_series: list[Any] = [uplot.Series(label="t [s]")]
        if has_ghost:
            chart_series += [
                uplot.Series(label=f"{line.label}, ghost", stroke=line.colour + "70", width=1.2) for line in plan.lines
            ]
        chart_series += [series(uplot, line) for line in plan.lines]
        empty = tuple(np.zeros(2) for _ in chart_series)
        self._handle = gui.add_uplot(
            data=(np.array([0.0, 1.0]), *empty[1:]),
            series=tuple(chart_series),
            title=plan.title,
            scales={"x": uplot.Scale(time=False, auto=True), "y": uplot.Scale(auto=True)},
            axes=(uplot.Axis(**AXIS, size=26), uplot.Axis(**AXIS, size=46)),
            legend=uplot.Legend(show=False),
            padding=(10, 16, 0, 0),
            height=150 if len(plan.lines) < 4 else 185,
        )
        if len(plan.lines) > 1:
            gui.add_html(legend(plan.lines))

    def draw(self, table: Mapping[str, np.ndarray], ghost: Mapping[str, np.ndarray] | None = None) -> None:
        """Draw columns over the column ``time``; those of the ghost at the same times."""
        stride = max(1, len(table["time"]) // _MAX_POINTS)
        time = table["time"][::stride]
        if len(time) < 2:
            return
        lines = [self._values(table, line)[::stride] for line in self._plan.lines]
        ghost_lines = []
        if self._has_ghost:
            ghost_table = ghost or table
            ghost_lines = [
                np.interp(time, ghost_table["time"], self._values(ghost_table, line), right=np.nan)
                for line in self._plan.lines
            ]
        self._handle.data = tuple(np.asarray(column, dtype=float) for column in (time, *ghost_lines, *lines))

    def _values(self, table: Mapping[str, np.ndarray], line: Line) -> np.ndarray:
        """Return the values of a line in the unit of the title, averaged over the layout's interval."""
        values = self._plan.scale * table.get(
            line.column, np.full(len(table["time"]), np.nan)
        )  # a ghost with other limbs lacks the column
        count = round(self._plan.mean / float(np.diff(table["time"][:2])[0])) if self._plan.mean else 0
        return values if count < 2 or len(values) < count else uniform_filter1d(values, count, mode="nearest")


def legend(lines: Sequence[Line]) -> str:
    """Return the legend of a chart as HTML."""
    entries = (
        f'<span style="white-space:nowrap;margin-right:12px"><span style="display:inline-block;width:18px;'
        f'border-top:3px {"dashed" if line.dash else "solid"} {line.colour};margin:0 5px 3px 0"></span>'
        f"{line.label}</span>"
        for line in lines
    )
    return f'<div style="font:11px sans-serif;color:#444;padding:0 12px 4px">{"".join(entries)}</div>'


def series(uplot: Any, line: Line) -> Any:
    """Return the series of viser's chart for a line."""
    dashes = {"dash": line.dash} if line.dash else {}
    return uplot.Series(label=line.label, stroke=line.colour, width=1.6, **dashes)


def gait_bars(robot: Robot, table: Mapping[str, np.ndarray], *, cursor: float | None = None) -> str:
    """Return the gait as an SVG picture: a bar for every stance of every foot; empty for a robot without limbs.

    Args:
        robot: robot that walks.
        table: columns by name, see ``history.columns``.
        cursor: where to draw a cursor [s]; None for none.
    """
    time, limbs, load_threshold = table["time"], limb_colours(robot), LOADED_SHARE * robot.mass * GRAVITY
    if not limbs:
        return ""
    x_start, x_end, row, top = 30, _BARS_WIDTH - 12, 19, 20
    start, end = float(time[0]), max(float(time[-1]), float(time[0]) + 1.0)
    pixels = (x_end - x_start) / (end - start)
    elements = [f'<text x="{x_start}" y="12" class="t">feet that stand (more than {load_threshold:.1g} N)</text>']
    for i, (leg, colour) in enumerate(limbs):
        y = top + i * row
        elements.append(f'<text x="2" y="{y + 12}">{leg}</text>')
        elements.append(f'<rect x="{x_start}" y="{y}" width="{x_end - x_start}" height="15" fill="#f0efec"/>')
        for a, b in _stances(time, table[leg] > load_threshold):
            bar = f'x="{x_start + (a - start) * pixels:.1f}" width="{max((b - a) * pixels, 0.8):.1f}"'
            elements.append(f'<rect {bar} y="{y}" height="15" fill="{colour}"/>')
    bottom = top + len(limbs) * row
    for tick in np.arange(np.ceil(start), end + 1e-9, max(1.0, np.ceil((end - start) / 6))):
        x = x_start + (tick - start) * pixels
        elements.append(
            f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{top}" y2="{bottom}" stroke="#ffffff" stroke-opacity=".6"/>'
        )
        elements.append(f'<text x="{x:.1f}" y="{bottom + 11}" text-anchor="middle">{tick:g} s</text>')
    if cursor is not None:
        x = x_start + (cursor - start) * pixels
        elements.append(
            f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{top - 4}" y2="{bottom}" stroke="#111" stroke-width="1.5"/>'
        )
    style = "text{font:11px sans-serif;fill:#444}.t{font-weight:600;fill:#222}"
    return (
        f'<svg viewBox="0 0 {_BARS_WIDTH} {bottom + 16}" width="100%" role="img" '
        f'aria-label="When each foot stands"><style>{style}</style>{"".join(elements)}</svg>'
    )


def _stances(time: np.ndarray, stands: np.ndarray) -> Sequence[tuple[float, float]]:
    """Return when each stretch of standing begins and ends [s]."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], stands.astype(int), [0]])))
    last_sample = len(time) - 1
    return [(float(time[a]), float(time[min(b, last_sample)])) for a, b in edges.reshape(-1, 2)]


class Plots:
    """The panel of plots.

    Args:
        gui: viser's interface of one browser.
        uplot: viser's module of chart settings.
        robot: robot that walks.
        has_ghost: whether there is a second run, drawn pale.
    """

    def __init__(self, gui: Any, uplot: Any, robot: Robot, *, has_ghost: bool = False) -> None:
        self._robot = robot
        panel = gui.add_panel()
        with panel.add_tab("Measured"):
            self._charts = [Chart(gui, plan, uplot, has_ghost=has_ghost) for plan in plans(robot)]
            self._bars = gui.add_html("")
        panel.dock_left()
        panel.set_width(PLOTS)

    def draw(
        self,
        table: Mapping[str, np.ndarray],
        ghost: Mapping[str, np.ndarray] | None = None,
        cursor: float | None = None,
    ) -> None:
        """Draw the columns of ``history.columns``.

        Args:
            table: columns of the run, each (row,).
            ghost: columns of a second run; None: none.
            cursor: time at which the gait diagram has a cursor [s]; None: no cursor.
        """
        if len(table["time"]) < 2:
            return
        for chart in self._charts:
            chart.draw(table, ghost)
        self._bars.content = gait_bars(self._robot, table, cursor=cursor)

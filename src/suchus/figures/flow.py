"""Pictures of flows: vorticity, pressure, and forces over time."""

from textwrap import wrap

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from suchus.figures.data import carry
from suchus.figures.fields import EDGE, PRESSURE, SKIN, VORTICITY, smooth
from suchus.figures.style import COLOURS, WIDTH, panels, styled
from suchus.flow import ALONG_THE_SKIN, Markers, Record, Simulation, SkinMarkers, Surface
from suchus.flow.pose import speeds

_PIXELS = 900
_COVERING = 1.5  # width of the dots of a skin, over the side of the patch that the largest stands for
"""About how many pixels the longer side of a field has [-]."""


def _panel(width: float, height: float) -> tuple[Figure, Axes]:
    with styled(axes__grid=False):
        figure, axes = panels(1, 1, width=width, height=height)
    return figure, axes[0, 0]


def _field(sim: Simulation, values: np.ndarray, limit: float, label: str, cmap: str, shift: float) -> Figure:
    grid = sim.setup.grid
    wide, high = grid.size
    with styled(axes__grid=False):
        figure, axes = _panel(WIDTH, 1.2 + 0.76 * WIDTH * high / wide)
        x0, y0 = grid.origin[0] + shift * grid.cell, grid.origin[1] + shift * grid.cell
        extent = (x0, x0 + values.shape[1] * grid.cell, y0, y0 + values.shape[0] * grid.cell)
        fine = smooth(values, _PIXELS)
        image = axes.imshow(fine, origin="lower", extent=extent, cmap=cmap, vmin=-limit, vmax=limit)
        carry(image, values)
        for body in sim.setup.bodies:
            edge = sim.surface(body.name).markers
            axes.add_patch(Polygon(np.column_stack([edge.x, edge.y]), facecolor=SKIN, edgecolor=EDGE, label=body.name))
        axes.set_xlabel("x [m]")
        axes.set_ylabel("y [m]")
        axes.set_title(f"t = {sim.time:.3g} s")
        figure.colorbar(image, ax=axes, label=label, shrink=0.85, extend="both")
    return figure


def vorticity(sim: Simulation, *, limit: float | None = None) -> Figure:
    """Return a picture of the vorticity, red counter-clockwise; ``limit`` is the end of the scale [1/s]."""
    values = sim.vorticity
    end = float(np.quantile(np.abs(values), 0.99)) if limit is None else limit
    return _field(sim, values, max(end, 1e-9), "vorticity [1/s]", VORTICITY, 0.5)


def pressure(sim: Simulation, *, limit: float | None = None) -> Figure:
    """Return a picture of the pressure; ``limit`` is the end of the scale [Pa]."""
    values = sim.pressure
    end = float(np.quantile(np.abs(values), 0.99)) if limit is None else limit
    return _field(sim, values, max(end, 1e-9), "pressure [Pa]", PRESSURE, 0.0)


def forces(record: Record, body: str | int = 0) -> Figure:
    """Return the force on a body over time, after the transient of the first steps."""
    with styled():
        figure, grid = panels(1, 1, height=3.4)
        axes = grid[0, 0]
        force = record.force(body)
        for values, label, role, dashes in (
            (force[:, 0], "along x", "coordinated", "-"),
            (force[:, 1], "along y", "limbs_only", (0, (5, 2))),
        ):
            axes.plot(record.time, values, label=label, color=COLOURS[role], linestyle=dashes, linewidth=1.4)
        late = force[len(force) // 20 :]
        low, high = float(late.min()), float(late.max())
        margin = 0.1 * max(high - low, 1e-12)
        axes.set_ylim(low - margin, high + margin)
        axes.set_xlabel("time [s]")
        axes.set_ylabel("force per depth [N/m]")
        axes.legend()
    return figure


def skin(sim: Simulation, body: str | None = None) -> Figure:
    """Return pressure and friction along a body's outline or over its skin now, and what is known of their error."""
    surface = sim.surface(body)
    with styled():
        draw = _over_the_skin if isinstance(surface.markers, SkinMarkers) else _along_the_outline
        figure: Figure = draw(surface)
        figure.suptitle(f"t = {sim.time:.3g} s", fontsize="medium", x=0.02, ha="left")
        figure.supxlabel("\n".join(wrap(ALONG_THE_SKIN, 110)), fontsize="x-small", x=0.02, ha="left")
    return figure


def _along_the_outline(surface: Surface[Markers]) -> Figure:
    m = surface.markers
    place = np.cumsum(m.length) - m.length / 2
    friction = surface.shear[1] * m.normal_x - surface.shear[0] * m.normal_y
    figure, grid = panels(1, 2, width=WIDTH, height=3.8)
    for axes, values, label in zip(
        grid[0], (surface.pressure, friction), ("pressure [Pa]", "friction, counter-clockwise [Pa]"), strict=True
    ):
        axes.plot(place, values, color=COLOURS["coordinated"], linewidth=1.4)
        axes.set(xlabel="along the outline, counter-clockwise [m]", ylabel=label)
    return figure


def _over_the_skin(surface: Surface[SkinMarkers]) -> Figure:
    """Draw both as one looks along y, and from above, each point where it faces who looks."""
    m, friction = surface.markers, speeds(surface.shear)
    most = max(float(np.abs(surface.pressure).max()), 1e-12)
    views = (("seen along y", 2, 1, -1.0), ("from above", 1, 2, 1.0))
    wide, *across = np.ptp(m.points, axis=1)
    side = _COVERING * np.sqrt(m.share.max()) / wide * 0.4 * WIDTH * 72.0  # of a dot, in points of the page
    figure, grid = panels(2, 2, width=WIDTH, height=2.4 + min(2 * 0.4 * WIDTH * max(across) / wide, 6.0))
    for row, (values, label, cmap, low, high) in zip(
        grid,
        (
            (surface.pressure, "pressure [Pa]", PRESSURE, -most, most),
            (friction, "friction [Pa]", "viridis", 0.0, max(float(friction.max()), 1e-12)),
        ),
        strict=True,
    ):
        for axes, (view, up, depth, way) in zip(row, views, strict=True):
            seen = (way * m.normals[depth] > 0) & (m.share > 0)
            order = np.argsort(way * m.points[depth, seen])
            x, y, shown = m.points[0, seen][order], m.points[up, seen][order], values[seen][order]
            points = axes.scatter(x, y, c=shown, cmap=cmap, vmin=low, vmax=high, s=side**2, linewidths=0.0)
            axes.locator_params(axis="y", nbins=3)
            axes.set(xlabel="x [m]", ylabel=f"{'xyz'[up]} [m]", title=view, aspect="equal")
        figure.colorbar(points, ax=list(row), label=label, shrink=0.85)
    return figure

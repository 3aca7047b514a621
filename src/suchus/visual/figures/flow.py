"""Pictures and films of flows: vorticity, pressure, what acts on the skin, and forces over time."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from textwrap import wrap
from types import MappingProxyType
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon, Rectangle

from suchus.core.errors import InvalidDesign, UnknownName
from suchus.core.writing import write
from suchus.flow import ALONG_THE_SKIN, Record, Simulation, Surface
from suchus.flow.fields import Fields
from suchus.flow.pose import speeds
from suchus.flow.rake import due_after
from suchus.visual.figures.data import carry
from suchus.visual.figures.fields import EDGE, PRESSURE, SKIN, VORTICITY, smooth, span
from suchus.visual.figures.film import film
from suchus.visual.figures.style import COLOURS, WIDTH, panels, styled

_PIXELS = 900
"""About how many pixels the longer side of a field has [-]."""
_COVERING = 1.5
"""Width of the dots of a skin, over the side of the patch that the largest stands for [-]."""
_FILM_DPI = 75
"""Resolution of a film [dot/inch]: the colours have to be found for every frame."""


def _panel(width: float, height: float) -> tuple[Figure, Axes]:
    with styled(axes__grid=False):
        figure, axes = panels(1, 1, width=width, height=height)
    return figure, axes[0, 0]


class _Picture:
    """Picture of a plane flow's field and bodies, which can show other instants; a fine patch lies on the domain."""

    def __init__(
        self, sim: Simulation, fields: list[np.ndarray], limit: float, label: str, cmap: str, shift: float
    ) -> None:
        self._images = []
        width, height = sim.domain.water.grid.size
        with styled(axes__grid=False):
            self.figure, self._axes = _panel(WIDTH, 1.2 + 0.76 * WIDTH * height / width)
            for view, values in zip(_views(sim), fields, strict=True):
                grid = view.water.grid
                (x0, y0), (rows, columns) = np.array(grid.origin) + shift * grid.cell, values.shape
                image = self._axes.imshow(
                    smooth(values, _PIXELS), origin="lower", cmap=cmap, vmin=-limit, vmax=limit,
                    extent=(x0, x0 + columns * grid.cell, y0, y0 + rows * grid.cell),
                )  # fmt: skip
                self._images.append(image)
                if view is not sim.domain:
                    self._axes.add_patch(
                        Rectangle(
                            (grid.origin[0], grid.origin[1]), *grid.size, fill=False, edgecolor=EDGE, linewidth=0.6
                        )
                    )
            x0, y0 = sim.domain.water.grid.origin
            self._axes.set(xlim=(x0, x0 + width), ylim=(y0, y0 + height))
            self._bodies = [
                Polygon(edge, facecolor=SKIN, edgecolor=EDGE, label=body.name)
                for body, edge in zip(sim.setup.bodies, _edges(sim), strict=True)
            ]
            for outline in self._bodies:
                self._axes.add_patch(outline)
            carry(self._images[-1], fields[-1])
            self._axes.set_xlabel("x [m]")
            self._axes.set_ylabel("y [m]")
            self._axes.set_title(f"t = {sim.time:.3g} s", loc="left")
            self.figure.colorbar(self._images[-1], ax=self._axes, label=label, shrink=0.85, extend="both")

    def move_on(self, time: float, fields: list[np.ndarray], edges: list[np.ndarray]) -> None:
        """Show another instant: its time [s], fields and outlines of the bodies."""
        for image, values in zip(self._images, fields, strict=True):
            image.set_data(smooth(values, _PIXELS))
        self._axes.set_title(f"t = {time:.3g} s", loc="left")
        for body, edge in zip(self._bodies, edges, strict=True):
            body.set_xy(edge)


def _edges(sim: Simulation) -> list[np.ndarray]:
    """Return the outlines of the bodies in the frame of the grid, each of shape (marker, 2) [m]."""
    return [sim.surface(body.name).markers.points.T for body in sim.setup.bodies]


FieldName = Literal["vorticity", "pressure"]
_FIELDS: Mapping[FieldName, tuple[str, str, float]] = MappingProxyType(
    {"vorticity": ("vorticity [1/s]", VORTICITY, 0.5), "pressure": ("pressure [Pa]", PRESSURE, 0.0)}
)


def _views(sim: Simulation) -> list[Fields]:
    """Return the fields in drawing order: the whole domain, then the fine patch if there is one."""
    return [sim] if sim.domain is sim else [sim.domain, sim]


def _field_values(sim: Simulation, field_name: FieldName) -> list[np.ndarray]:
    return [view.vorticity if field_name == "vorticity" else view.pressure for view in _views(sim)]


def vorticity(sim: Simulation, *, limit: float | None = None) -> Figure:
    """Return a picture of the vorticity, red counter-clockwise; ``limit`` is the end of the scale [1/s]."""
    return _field_figure(sim, "vorticity", limit)


def pressure(sim: Simulation, *, limit: float | None = None) -> Figure:
    """Return a picture of the pressure; ``limit`` is the end of the scale [Pa]."""
    return _field_figure(sim, "pressure", limit)


def _field_figure(sim: Simulation, field_name: FieldName, limit: float | None) -> Figure:
    fields = _field_values(sim, field_name)
    return _Picture(sim, fields, span(fields[-1], 0.99) if limit is None else limit, *_FIELDS[field_name]).figure


@dataclass(slots=True)
class FieldFilm:
    """A film of a plane flow, taken during a run: ``sim.run(until, watch=film)``, then ``film.save("eel.gif")``.

    The picture travels with the grid. Vorticity is red counter-clockwise, pressure purple above that of the far water.
    """

    interval: float
    """Interval of the frames [s]."""
    field_name: FieldName = "vorticity"
    """Name of the field."""
    limit: float | None = None
    """End of the scale [1/s, Pa]; None takes what 99 % of the values stay below."""
    speed: float = 1.0
    """Seconds of the flow in a second of the film [-]."""
    _frames: list[tuple[float, list[np.ndarray], list[np.ndarray]]] = field(default_factory=list)
    _due: float = 0.0
    _sim: Simulation | None = None

    def __post_init__(self) -> None:
        for name, value in (("interval", self.interval), ("speed", self.speed), ("limit", self.limit)):
            if value is not None and not (isfinite(value) and value > 0):
                raise InvalidDesign(f"{name} of a film is {value}; a positive number is needed.")
        if self.field_name not in _FIELDS:
            raise UnknownName("field", str(self.field_name), tuple(_FIELDS))

    def __call__(self, sim: Simulation) -> None:
        """Store the field and the outlines, if a frame is due.

        Raises:
            InvalidDesign: in space.
        """
        if sim.setup.grid.ndim == 3:
            raise InvalidDesign("this film is of plane flows, and this one has three axes; see suchus view swim.")
        if sim.time >= self._due:
            self._due, self._sim = due_after(sim.time, self.interval), sim
            fields = [values.astype(np.float32) for values in _field_values(sim, self.field_name)]
            self._frames.append((sim.time, fields, _edges(sim)))

    def save(self, path: Path | str) -> Path:
        """Write the film as a GIF, which every browser plays, and return its place.

        Raises:
            InvalidDesign: another ending than .gif, or no run has been watched.
            Unwritable: it cannot be written.
        """
        target_path = Path(path)
        if target_path.suffix.lower() != ".gif":
            raise InvalidDesign(f"a film is a GIF; give {target_path.name!r} the ending .gif.")
        if self._sim is None:
            raise InvalidDesign("the film holds no frame; give it to a run first: sim.run(until, watch=film).")
        limit = self.limit if self.limit is not None else span(np.stack([f[-1] for _, f, _ in self._frames]), 0.99)
        picture = _Picture(self._sim, self._frames[0][1], limit, *_FIELDS[self.field_name])
        picture.figure.set_dpi(_FILM_DPI)
        times = [time for time, _, _ in self._frames]
        seconds = max(times[-1] - times[0] + self.interval, self.interval) / self.speed
        caption = f"{self.field_name} of a flow from {times[0]:.3g} to {times[-1]:.3g} s"
        frames = self._frames
        data = film(
            picture.figure, lambda i: picture.move_on(*frames[i]), len(frames), seconds=seconds, caption=caption
        )
        return write(target_path, data)


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
        settled_force = force[len(force) // 20 :]
        lower_bound, upper_bound = float(settled_force.min()), float(settled_force.max())
        margin = 0.1 * max(upper_bound - lower_bound, 1e-12)
        axes.set_ylim(lower_bound - margin, upper_bound + margin)
        axes.set_xlabel("time [s]")
        axes.set_ylabel("force per depth [N/m]")
        axes.legend()
    return figure


def skin(sim: Simulation, body: str | None = None) -> Figure:
    """Return pressure and friction along a body's outline or over its skin now, and what is known of their error."""
    surface = sim.surface(body)
    with styled():
        draw = _over_the_skin if sim.setup.grid.ndim == 3 else _along_the_outline
        figure: Figure = draw(surface)
        figure.suptitle(f"t = {sim.time:.3g} s", fontsize="medium", x=0.02, ha="left")
        figure.supxlabel("\n".join(wrap(ALONG_THE_SKIN, 110)), fontsize="x-small", x=0.02, ha="left")
    return figure


def _along_the_outline(surface: Surface) -> Figure:
    """Draw pressure and friction over the arc length of a plane body's outline."""
    m = surface.markers
    arc_length = np.cumsum(m.weight) - m.weight / 2
    friction = surface.shear[1] * m.normals[0] - surface.shear[0] * m.normals[1]
    figure, grid = panels(1, 2, width=WIDTH, height=3.8)
    for axes, values, label in zip(
        grid[0], (surface.pressure, friction), ("pressure [Pa]", "friction, counter-clockwise [Pa]"), strict=True
    ):
        axes.plot(arc_length, values, color=COLOURS["coordinated"], linewidth=1.4)
        axes.set(xlabel="along the outline, counter-clockwise [m]", ylabel=label)
    return figure


def _over_the_skin(surface: Surface) -> Figure:
    """Draw pressure and friction seen along y and from above, on the points that face the viewer."""
    m, friction = surface.markers, speeds(surface.shear)
    max_pressure = max(float(np.abs(surface.pressure).max()), 1e-12)
    views = (("seen along y", 2, 1, -1.0), ("from above", 1, 2, 1.0))
    length, *extents = np.ptp(m.points, axis=1)
    side = _COVERING * np.sqrt(m.weight.max()) / length * 0.4 * WIDTH * 72.0  # side of a dot, in points of the page
    figure, grid = panels(2, 2, width=WIDTH, height=2.4 + min(2 * 0.4 * WIDTH * max(extents) / length, 6.0))
    for row, (values, label, cmap, lower_bound, upper_bound) in zip(
        grid,
        (
            (surface.pressure, "pressure [Pa]", PRESSURE, -max_pressure, max_pressure),
            (friction, "friction [Pa]", "viridis", 0.0, max(float(friction.max()), 1e-12)),
        ),
        strict=True,
    ):
        for axes, (view, vertical_axis, depth, view_sign) in zip(row, views, strict=True):
            is_visible = (view_sign * m.normals[depth] > 0) & (m.weight > 0)
            order = np.argsort(view_sign * m.points[depth, is_visible])
            x, y, visible_values = (
                m.points[0, is_visible][order],
                m.points[vertical_axis, is_visible][order],
                values[is_visible][order],
            )
            points = axes.scatter(
                x, y, c=visible_values, cmap=cmap, vmin=lower_bound, vmax=upper_bound, s=side**2, linewidths=0.0
            )
            axes.locator_params(axis="y", nbins=3)
            axes.set(xlabel="x [m]", ylabel=f"{'xyz'[vertical_axis]} [m]", title=view, aspect="equal")
        figure.colorbar(points, ax=list(row), label=label, shrink=0.85)
    return figure

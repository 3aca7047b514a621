"""The setup of a simulation: grid, water, sides and bodies, checked before anything runs."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import ceil, isfinite, prod
from typing import Any, Literal

import numpy as np

from suchus.core.errors import Doubtful, InvalidDesign
from suchus.core.kinds import show
from suchus.flow.body import Body, cuts, thin_fraction, window_of
from suchus.flow.compiled import PAD
from suchus.flow.contact import BodyContact
from suchus.flow.free import FreeBody
from suchus.flow.grid import Grid, check_kinds, check_memory
from suchus.flow.integrator import HEUN, Integrator
from suchus.flow.markers import Markers, extent, kernel_array, max_speed
from suchus.flow.midline import Spined, check_state
from suchus.flow.nest import patch_sides
from suchus.flow.resolution import (
    MAX_FORCE_ERROR,
    WARNING_FORCE_ERROR,
    cells_across,
    estimate_force_error,
    required_cells,
)
from suchus.flow.scheme import QUICK, Scheme
from suchus.flow.sides import NAMES, Periodic, Sides
from suchus.flow.swimmer import Swimmer

MIN_LAYER_CELLS = required_cells(MAX_FORCE_ERROR)
"""Fewest cells across a boundary layer of thickness L / sqrt(Re), for bodies other than blunt ones in space [-]."""


MAX_TOLERANCE = 0.01
"""Greatest tolerance [-]. With it, the drag of a cylinder at Reynolds number 40 fluctuates from step to step by 4 %;
with a tenth of it, by 0.2 %."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Setup:
    """A flow to be simulated.

    Raises:
        InvalidDesign: on creation, for values that are impossible or that the grid cannot resolve.
    """

    grid: Grid
    """The cells of the domain; with ``coarse_grid``, the fine cells of a patch around the bodies, see
    ``Grid.patch``."""
    coarse_grid: Grid | None = None
    """Coarse cells of the whole domain, in which ``grid`` is a patch; None if ``grid`` is the whole domain."""
    viscosity: float
    """Kinematic viscosity of the water [m^2/s]."""
    density: float = 1.0
    """Density of the water [kg/m^3]. With the default of 1, forces are in units of speed squared times length."""
    stream: tuple[float, float] | tuple[float, float, float] | Callable[[float], tuple[float, ...]] = (0.0, 0.0)
    """Velocity of the far water, (x, y) or (x, y, z), constant or a function of the time; two numbers in space mean no
    velocity along z [m/s]."""
    start: Callable[..., Sequence[np.ndarray]] | None = None
    """Velocity of the water at time 0 along every axis, a function of the coordinates x, y (and z) [m] that returns
    arrays of their shape; None is that of the far stream. The first step removes its divergence [m/s]."""
    perturb: float = 0.0
    """Disturbance of the water at time 0, over the speed of the far stream: a gust across the stream, as wide as the
    first body and 1.5 widths behind it. A symmetric wake needs one to begin to shed vortices; 0.2 is enough [-]."""
    sides: Sides = field(default_factory=Sides)
    """Boundary conditions on the sides of the domain."""
    bodies: tuple[Body | FreeBody, ...] = ()
    """The bodies in the water."""
    contact: BodyContact | None = None
    """Force between bodies that nearly touch, and between a body and a wall; None lets them run into each other."""
    follow: str | None = None
    """Name of the body with whose centre the grid travels; None fixes the grid."""
    follow_axes: tuple[bool, bool] | tuple[bool, bool, bool] = (True, True)
    """Whether the grid travels along x, y (and z); two entries in space mean that it does not travel along z."""
    scheme: Scheme = QUICK
    """Advection scheme: limited QUICK, ``CENTRAL``, ``UPWIND`` or your own."""
    integrator: Integrator = HEUN
    """Time integrator: Heun's method, ``SHU_OSHER``, ``EULER`` or your own."""
    courant: float = 0.8
    """Courant number: distance that the water crosses in one step, over a cell [-]."""
    step: float | None = None
    """Fixed time step, or None to choose it from ``courant`` [s]."""
    tolerance: float = 1e-5
    """Limit of the mean divergence, over the fastest speed per cell; the limit of the largest divergence is ten times
    that [-]."""
    precision: Literal["single", "double"] = "single"
    """Precision of the fields; sums are always double."""
    coarse: bool = False
    """Whether a Reynolds number that the grid cannot resolve is allowed, without a warning."""

    def __post_init__(self) -> None:
        """Check all values and their combinations."""
        check_kinds(self)
        for name in ("viscosity", "density", "tolerance"):
            value = getattr(self, name)
            if not (isfinite(value) and value > 0):
                raise InvalidDesign(f"{name} is {value}; a positive number is needed.")
        if not 0 < self.courant <= 1:
            raise InvalidDesign(f"courant is {self.courant}; above 1 the time stepping explodes. Give 0 to 1, say 0.8.")
        if not callable(self.stream) and not all(isfinite(component) for component in self.stream):
            raise InvalidDesign(f"stream is {self.stream} m/s; two finite numbers are needed.")
        if self.step is not None and not (isfinite(self.step) and self.step > 0):
            raise InvalidDesign(f"step is {self.step} s; a time step is positive. Give None to let the solver choose.")
        if self.precision not in ("single", "double"):
            raise InvalidDesign(f"precision is {self.precision!r}; there is 'single' and 'double'.")
        if self.precision == "single" and self.tolerance < 5e-7:
            raise InvalidDesign(
                f"tolerance {self.tolerance} is below what single precision resolves (5e-7); take precision='double'."
            )
        if self.tolerance > MAX_TOLERANCE:
            raise InvalidDesign(
                f"tolerance is {self.tolerance}; above {MAX_TOLERANCE} water is lost in every cell and forces shake. "
                f"Give at "
                f"most that, say 1e-5."
            )
        bodies: Any = self.bodies
        if not isinstance(bodies, tuple) or not all(isinstance(b, Body | FreeBody) for b in bodies):
            type_name = getattr(bodies, "__name__", type(bodies).__name__)
            raise InvalidDesign(
                f"bodies is a {type_name}; give a tuple of Body and FreeBody, (body,) for a single one."
            )
        if not callable(self.stream):
            self._check_stream(self.stream, "")
        elif isinstance(self.stream, type):
            raise InvalidDesign(
                f"stream is the class {self.stream.__name__}; give a velocity in m/s, or a function of the time that "
                f"returns one."
            )
        if not (isfinite(self.perturb) and abs(self.perturb) <= 1):
            raise InvalidDesign(f"perturb is {self.perturb}; give -1 to 1, over the stream's speed, say 0.2.")
        if self.perturb and not (self.bodies and any(self.far_velocity(0.0))):
            raise InvalidDesign(
                f"perturb is {self.perturb}, and there is no body or no far stream at t = 0 to disturb; give both, or "
                f"start= for water that moves otherwise."
            )
        names = [b.name for b in self.bodies]
        if len(set(names)) != len(names):
            raise InvalidDesign(f"bodies are named {names}; give each its own name.")
        if self.follow is not None and self.follow not in names:
            raise InvalidDesign(f"the grid is to follow {self.follow!r}, and the bodies are named {names}.")
        self._check_dimension()
        self._check_passage(self.far_velocity(0.0), "")
        if self.scheme != QUICK:  # the check compiles the scheme
            self.scheme.check()
        if self.follow is not None:
            x, y, z = (*self.follow_axes, False)[:3]
            self.sides.check_travel(self.grid.ndim, (x, y, z), self.follow)
        if self.coarse_grid is not None:
            patch_sides(self.grid, self.coarse_grid, self.sides)
            check_memory(self.coarse_grid, self.dtype)
        check_memory(self.grid, self.dtype)

    def _check_dimension(self) -> None:
        """Refuse plane bodies in a grid in space, and bodies in space in a plane grid."""
        ndim = self.grid.ndim
        self.sides.check(ndim)
        for body in self.bodies:
            if isinstance(body, FreeBody) and ndim == 2:
                body.check_plane()
            if body.shape.ndim == ndim:
                continue
            shape = type(body.shape).__name__
            if ndim == 3:
                raise InvalidDesign(
                    f"{body.name} is a {shape}, which is plane, and the grid has three axes; give a shape in space, "
                    f"say a Sphere, or a grid of two axes."
                )
            raise InvalidDesign(
                f"{body.name} is a {shape}, which is a shape in space, and the grid has two axes; give the grid a "
                f"third pair, or a plane shape."
            )

    def _check_passage(self, stream: tuple[float, ...], time_text: str) -> None:
        """Refuse a far stream through a side through which no water passes.

        Args:
            stream: velocity of the far water [m/s].
            time_text: when, for the message; empty for a constant stream.

        Raises:
            InvalidDesign: naming the side.
        """
        for axis, component in enumerate(stream):
            for name in NAMES[2 * axis : 2 * axis + 2]:
                side = getattr(self.sides, name)
                if component and not (side.is_permeable or isinstance(side, Periodic)) and side.is_domain_end:
                    raise InvalidDesign(
                        f"stream has {component:.4g} m/s along {'xyz'[axis]}{time_text}, and the {name} side is a "
                        f"{type(side).__name__}, through which no water passes; take a stream without that component, "
                        f"another side, or start= for water that moves in a closed box."
                    )

    @property
    def dtype(self) -> type:
        """Type of the fields."""
        return np.float32 if self.precision == "single" else np.float64

    def far_velocity(self, time: float) -> tuple[float, ...]:
        """Return the velocity of the far water at a time [s], along every axis [m/s]."""
        if callable(self.stream):
            stream = self.stream(time)
            self._check_stream(stream, f" at t = {time:.4g} s")
            self._check_passage(stream, f" at t = {time:.4g} s")
        else:
            stream = self.stream
        return stream if len(stream) == self.grid.ndim else (*stream, 0.0)

    def initial_velocity(self, component: int, grid: Grid) -> np.ndarray | float:
        """Return one component of the initial velocity of the water on all faces across its axis [m/s].

        Args:
            component: axis of the component.
            grid: the cells whose faces are meant, with the padding.

        Raises:
            InvalidDesign: ``start`` returns something else than a velocity.
        """
        if self.start is None and not self.perturb:
            return self.far_velocity(0.0)[component]
        ends = [n + 2 * PAD for n in grid.cells]
        coordinates = [(grid.faces if component == d else grid.centres)(0, end, d) for d, end in enumerate(ends)]
        points = np.meshgrid(*coordinates[::-1], indexing="ij")[::-1]
        if self.start is None:
            return self.far_velocity(0.0)[component] + self._gust(component, points)
        velocities = self.start(*points)
        if not isinstance(velocities, Sequence | np.ndarray):
            raise InvalidDesign(
                f"start gives {show(velocities)}; it returns {self.grid.ndim} arrays, velocities along each axis [m/s]."
            )
        if len(velocities) != self.grid.ndim:
            raise InvalidDesign(
                f"start gives {len(velocities)} velocities; one along each of {self.grid.ndim} axes counts."
            )
        velocity = np.asarray(velocities[component], float)
        if velocity.shape not in ((), points[0].shape) or not np.isfinite(velocity).all():
            raise InvalidDesign(
                f"start gives {show(velocities[component])} along {'xyz'[component]}; a finite velocity for each point "
                f"is needed [m/s], shape {points[0].shape}."
            )
        return velocity + self._gust(component, points)

    def _gust(self, component: int, points: Sequence[np.ndarray]) -> np.ndarray | float:
        """Return one component of the disturbance of the water at time 0; see ``perturb`` [m/s].

        Args:
            component: axis of the component.
            points: coordinates along each axis [m].
        """
        if not self.perturb:
            return 0.0
        body, stream = self.bodies[0], np.array(self.far_velocity(0.0))
        pose = body.pose(0.0) if isinstance(body, Body) else Swimmer.from_body(body).pose(body.shape.mass(0.0))
        ends = np.reshape(body.shape.bounds(0.0, pose.in_dimensions(self.grid.ndim)), (-1, 2))
        speed, width = float(np.linalg.norm(stream)), float(np.ptp(ends, axis=1).max())
        direction = stream / speed
        transverse = np.zeros(self.grid.ndim)
        transverse[int(np.abs(direction).argmin())] = 1.0  # an axis across the stream
        transverse -= (transverse @ direction) * direction
        centre = ends.mean(axis=1) + 1.5 * width * direction
        square = sum((p - c) ** 2 for p, c in zip(points, centre, strict=True)) / width**2
        gust: np.ndarray = self.perturb * speed * transverse[component] / np.linalg.norm(transverse) * np.exp(-square)
        return gust

    def _check_stream(self, stream: Any, time_text: str) -> None:
        allowed = [(2,), (self.grid.ndim,)]
        if np.shape(stream) not in allowed or not np.isfinite(np.asarray(stream, float)).all():
            needs = "two finite velocities (x, y)" if self.grid.ndim == 2 else "finite velocities (x, y) or (x, y, z)"
            raise InvalidDesign(f"stream is {show(stream)}{time_text}; give {needs} in m/s.")

    def check_bodies(self) -> dict[str, float]:
        """Return, for each body, the fraction of its length that is too thin for the grid.

        Raises:
            InvalidDesign: a body outside the domain, too thin everywhere, or a Reynolds number that the grid
                cannot resolve.
        """
        thin_fractions = {}
        for body in self.bodies:
            if isinstance(body.shape, Spined):
                check_state(body.shape.spine(0.0), 0.0)
            pose = body.pose(0.0) if isinstance(body, Body) else Swimmer.from_body(body).pose(body.shape.mass(0.0))
            pose = pose.in_dimensions(self.grid.ndim)
            window = window_of(body, pose, self.grid, 0.0, *self._closed_ends)
            if isinstance(body, FreeBody):
                self._check_weight(body, cuts(window, self.grid, self._closed_ends[0]))
            thin_fractions[body.name] = thin_fraction(body, self.grid, 0.0)
            self.layer_error(body, body.shape.markers(0.0, pose, self.grid.cell), self.far_velocity(0.0), 0.0)
        return thin_fractions

    @property
    def _closed_ends(self) -> tuple[tuple[bool, ...], tuple[bool, ...]]:
        """Whether there are mirrors, and walls, at the ends of the axes of ``grid``; see ``Sides``."""
        sides = self.sides if self.coarse_grid is None else patch_sides(self.grid, self.coarse_grid, self.sides)
        return sides.has_mirror(self.grid.ndim), sides.is_solid(self.grid.ndim)

    def _check_weight(self, body: FreeBody, mirror_cuts: tuple[bool, ...]) -> None:
        """Refuse gravity that would move a body through a mirror that cuts it.

        Args:
            body: the body.
            mirror_cuts: whether the mirror at the low and the high end of each axis cuts it.

        Raises:
            InvalidDesign: naming the axis.
        """
        for axis, pull in enumerate(body.gravity):
            if pull and any(mirror_cuts[2 * axis : 2 * axis + 2]):
                name = "xyz"[axis]
                raise InvalidDesign(
                    f"gravity of {body.name} is {body.gravity} m/s2, and a Mirror across {name} cuts it, where it must "
                    f"stay; give a gravity without a component along {name}, or take another side."
                )

    def layer_error(
        self,
        body: Body | FreeBody,
        markers: Markers,
        stream: tuple[float, ...],
        time: float,
        *,
        slack: float = 1.0,
    ) -> float:
        """Return the relative error of a body's force, estimated by the cells across its boundary layer [-].

        See ``resolution``.

        Args:
            body: the body.
            markers: its outline or skin at that time.
            stream: velocity of the far water, in the frame of the markers [m/s].
            time: time at which it is estimated [s].
            slack: factor by which the speed may exceed what the grid resolves [-].

        Raises:
            InvalidDesign: the estimate is above ``MAX_FORCE_ERROR``; the message names a sufficient cell.
        """
        length = extent(kernel_array(markers.points))
        speed = max_speed(kernel_array(markers.velocities), np.array(stream, float))
        cells, is_blunt = cells_across(length, speed, self.viscosity, self.grid.cell), body.shape.is_compact
        error, min_cells = (
            estimate_force_error(cells, is_compact=is_blunt),
            required_cells(MAX_FORCE_ERROR, is_compact=is_blunt),
        )
        if not self.coarse and cells * slack**0.5 < min_cells:
            layer = cells * self.grid.cell
            million_cells = prod(self.grid.cells) * (min_cells / cells) ** self.grid.ndim / 1e6
            size = f" (this domain then takes {million_cells:.3g} million cells)" if self.grid.ndim == 3 else ""
            raise InvalidDesign(
                f"at t = {time:.4g} s and Reynolds number {speed * length / self.viscosity:.4g} the boundary layer of "
                f"{body.name} is {layer:.3g} m thin and a cell {self.grid.cell:.3g} m: its force would be off by some "
                f"{100 * error:.0f} %; take cells of at most {layer / min_cells:.3g} m{size}, better "
                f"{layer / required_cells(WARNING_FORCE_ERROR, is_compact=is_blunt):.3g} m, a lower Reynolds number, "
                f"or, in a Setup of your "
                f"own, coarse=True to go on anyway."
            )
        return error

    def layer_warning(self, body: Body | FreeBody, error: float) -> Doubtful | None:
        """Return a warning about the estimated error of a body's force, or None if the error is small.

        Args:
            body: the body.
            error: relative error of its force; see ``layer_error`` [-].
        """
        if self.coarse or error <= WARNING_FORCE_ERROR:
            return None
        cells, better = (
            required_cells(target_error, is_compact=body.shape.is_compact)
            for target_error in (error, WARNING_FORCE_ERROR)
        )
        times = ceil(100 * better / cells) / 100
        return Doubtful(
            f"the boundary layer of {body.name} is {cells:.2g} cells thin: its force may be off by some "
            f"{100 * error:.0f} %. For {100 * WARNING_FORCE_ERROR:.0f} % take {times:g} times as many cells along "
            f"each axis, of "
            f"{self.grid.cell / times:.3g} m.",
            kind="cells",
            size=error,
        )

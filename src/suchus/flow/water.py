"""The water's fields and one time step: stages of an integrator, each immersed and projected.

Arrays have the padded shape of the grid, the last axis first: (ny + 2 PAD, nx + 2 PAD), and vectors the component
before that; what counts around the bodies only has the shape of their window. Kernels see them slab by slab (``slab``).
Inside, lengths are in cells: a time step is ``dt / cell``, a viscosity ``viscosity / cell``, a pressure that over the
density [m^2/s^2].
"""

from typing import Any, NamedTuple

import numpy as np

from suchus.core.errors import NotConverged
from suchus.flow import multigrid, patch, poisson
from suchus.flow.advect import advance_by
from suchus.flow.body import AnyBody, Overlap, cuts, measure_all, reaches_beyond, rows_of, unite, window_of
from suchus.flow.border import Border
from suchus.flow.compiled import PAD, Window
from suchus.flow.grid import Grid
from suchus.flow.immerse import CLOSING_KERNELS, fill, fill_source, immerse
from suchus.flow.integrator import HEUN, Integrator
from suchus.flow.momentum import (
    add_contents,
    add_immersion_impulse,
    add_internal_pressure,
    contents_of,
    dilatation_work,
    subtract_joint_pressure,
    sums_of,
)
from suchus.flow.pose import Pose
from suchus.flow.project import correct, fastest, residual, side_mean
from suchus.flow.scheme import QUICK, Scheme
from suchus.flow.shape import Shape
from suchus.flow.sides import Sides
from suchus.flow.slab import inner_strides

MAX_PRESSURE_CYCLES = 60
"""Most iterations of the pressure solver [-]."""

MAX_FIRST_STEP_ROUNDS = 12
"""Most rounds in which the first step and the water around the domain converge [-]."""

MIN_SOLVED_RESIDUAL = 0.01
"""Residual over its limit below which the pressure is not solved [-]. With 1, whole steps would skip the solve, and
their residual would appear in the force of the next step."""

MAX_FINAL_RESIDUAL = 1000.0
"""Residual over its limit above which a solve has failed; below it, rounding has stopped the solve [-]."""


def _inflow(velocity: np.ndarray, axis: int) -> np.ndarray:
    """Return the inflow into the cells of a window through their faces across an axis, that axis first.

    Args:
        velocity: velocity on the faces of the window.
        axis: index of the axis in the array.
    """
    faces = np.moveaxis(velocity, axis, 0)
    return (faces[:-1] - faces[1:])[:, *(slice(None, -1),) * (velocity.ndim - 1)]


class PlannedStage(NamedTuple):
    """A stage of an integrator: ``result = w blend + (1 - w) B[base + dt (f(rate) + push - grad p)]``.

    w is ``blend_fraction``, B the immersion, f advection and diffusion. All fields are velocities, shape
    (axis, ...) [m/s].
    """

    result: np.ndarray
    """Velocity at the end of the stage, which is written."""
    blend: np.ndarray
    """Velocity that is blended with it."""
    base: np.ndarray
    """Velocity that the stage starts from."""
    rate: np.ndarray
    """Velocity at which advection and diffusion are taken."""
    blend_fraction: float
    """Fraction of ``blend`` [-]."""
    dt: float
    """Length of the stage from ``base`` [cells per (m/s)]."""
    coarse_stage: Any = None
    """The same stage of the coarser water around a patch; see ``nest``."""

    @property
    def pressure_duration(self) -> float:
        """Duration for which the solved pressure acts on ``result`` [cells per (m/s)]."""
        return (1 - self.blend_fraction) * self.dt


class Fluid:
    """Velocity and pressure on a grid, and the bodies as coefficients of the equations.

    Attributes:
        velocity: on the faces before the cells along each axis, shape (axis, ...) [m/s].
        p: pressure over density at the cell centres [m^2/s^2].
        mu0: fraction of the fluid on these faces, shape (axis, ...) [-].
        mu1: half the first moment of the kernel along each axis on these faces, in the window, shape
            (face's axis, axis, ...) [cells].
        b: velocity of the bodies on these faces, in the window, shape (axis, ...) [m/s].
        source: divergence of the bodies' own motion, times the body's fraction, in the window [m/s per cell].
        window: padded cell indices around the bodies; it includes a cell beyond a mirror that cuts one.
        mirror_cuts: for each body, which mirrors cut it; see ``body.cuts``.
        rows: for each body the rows of its parts in arrays of sums; one for a body that is not divided.
        owners: for each component, the row of the part that is nearest to the points of the window, shape (axis, ...).
        immersion_sums: momentum and energy given to the water by the immersion in the last step, per row; see
            ``momentum.add_immersion_impulse``.
        internal_pressure_sums: integral of the pressure inside divided bodies in the last step, per row; see
            ``pressures``.
        solves: statistics of the pressure solves of the last step, one a stage.
        overlap: the two bodies that overlap most.
        min_cycles: fewest iterations of a pressure solve.
    """

    def __init__(
        self,
        grid: Grid,
        sides: Sides,
        viscosity: float,
        dtype: type,
        scheme: Scheme = QUICK,
        integrator: Integrator = HEUN,
    ) -> None:
        """Allocate the fields of water at rest without bodies.

        Args:
            grid: the cells.
            sides: sides of the domain.
            viscosity: kinematic viscosity [m^2/s].
            dtype: precision of the fields.
            scheme: advection scheme.
            integrator: time integrator.
        """
        self.grid, self.sides, self.dtype, self.integrator = grid, sides, dtype, integrator
        self._advance_all = advance_by(scheme)
        self.ndim, self.repeats = grid.ndim, sides.is_periodic(grid.ndim)
        self._mirrors, self._solids = sides.has_mirror(grid.ndim), sides.is_solid(grid.ndim)
        self.inner = inner_strides(grid.cells)
        self.nu = dtype(viscosity / grid.cell)
        self.border = Border.for_grid(sides, grid, dtype)
        shape = tuple(n + 2 * PAD for n in reversed(grid.cells))
        slabs = shape[0], int(np.prod(shape[1:]))
        vector = (self.ndim, *shape)
        # Fluid: now, predicted, corrected; pressure
        self._flat_views: dict[int, tuple[np.ndarray, np.ndarray]] = {}
        self._flat_near_views: dict[int, tuple[np.ndarray, np.ndarray]] = {}
        self.velocity: np.ndarray = np.zeros(vector, dtype)
        self._predicted: np.ndarray = np.zeros(vector, dtype)
        self._corrected: np.ndarray = np.zeros(vector, dtype)
        self.p: np.ndarray = np.zeros(shape, dtype)
        self.mu0: np.ndarray = np.ones(vector, dtype)
        # Pressure solver
        self._x: np.ndarray = np.zeros(slabs, dtype)
        self._d: np.ndarray = np.zeros(slabs, dtype)
        self._q: np.ndarray = np.zeros(slabs, dtype)
        self._layout = poisson.levels(grid.cells)
        self._store = poisson.make_store(self._layout, dtype)
        parts = (multigrid.level(self._store, self._layout, self.inner, kind, 0) for kind in range(multigrid.FACES))
        faces = multigrid.faces_of(self._store, self._layout, self.inner, 0)
        self._views = (*parts, faces.reshape(vector))  # of its finest level
        for a in (self.velocity, self._predicted, self._corrected, self.p, self.mu0, self.passage):
            self._flat_views[id(a)] = a, a.reshape(*a.shape[: a.ndim - self.ndim + 1], -1)
        self._patches = patch.patch_layouts(self._layout, self.repeats)
        self._buffer: np.ndarray = np.zeros((patch.FACES + self.ndim, 0), dtype)
        self._sums = np.zeros((shape[0], 4))
        self._near_layout = self._layout[0].copy()
        self._set_window((PAD,) * (2 * self.ndim))
        self._level_window = self.window  # that of the levels
        self.mirror_cuts: list[tuple[bool, ...]] = []
        self.offset = 0.0
        self.solves: list[poisson.Solve] = []
        self.min_cycles = 1
        self.overlap = Overlap(0.0, (0, 0))
        self.rows: list[range] = []
        self.immersion_sums = np.zeros((0, sums_of(self.ndim)))
        self.internal_pressure_sums = np.zeros((0, 1 + self.ndim))
        self._jointed = False
        self.widening: np.ndarray = np.zeros((0,) * self.ndim, dtype)
        self._widens = False
        self.mean: np.ndarray = np.zeros((self.ndim, *(0,) * self.ndim), dtype)

    @property
    def u(self) -> np.ndarray:
        """Velocity along x on the left faces [m/s]."""
        return self.velocity[0]

    @property
    def v(self) -> np.ndarray:
        """Velocity along y on the lower faces [m/s]."""
        return self.velocity[1]

    @property
    def previous_velocity(self) -> np.ndarray:
        """Velocity at the start of the last step [m/s]."""
        return self._corrected

    def _flat(self, a: np.ndarray) -> np.ndarray:
        """Return a field or values of the window as the kernels see them: slabs, and components before them.

        The views of arrays that last are kept: making one takes as long as a kernel call.
        """
        key = id(a)
        entry = self._flat_views.get(key) or self._flat_near_views.get(key)
        if entry is not None and entry[0] is a:
            return entry[1]
        return a.reshape(*a.shape[: a.ndim - self.ndim + 1], -1)

    def _keep_flat(self, *arrays: np.ndarray) -> None:
        """Keep the views of arrays that last as long as the window; see ``_flat``."""
        for a in arrays:
            self._flat_near_views[id(a)] = a, a.reshape(*a.shape[: a.ndim - self.ndim + 1], -1)

    def _set_window(self, window: Window) -> None:
        """Set the window around the bodies and allocate its arrays.

        These are kernel moments, body velocity, source, bare update and parts; and the coordinates of the points.

        Args:
            window: padded indices, first and end along each axis, the last axis first.
        """
        self.window: Window = window
        self._near_layout[1 + self.ndim :] = window
        shape = tuple(end - start + 1 for start, end in zip(window[::2], window[1::2], strict=True))
        self.mu1: np.ndarray = np.zeros((self.ndim, self.ndim, *shape), self.dtype)
        self.b: np.ndarray = np.zeros((self.ndim, *shape), self.dtype)
        self._raw: np.ndarray = np.zeros((self.ndim, *shape), self.dtype)
        self.source: np.ndarray = np.zeros(shape, self.dtype)
        self.owners: np.ndarray = np.zeros((self.ndim, *shape), np.int8)
        self._flat_near_views.clear()
        self._keep_flat(self.mu1, self.b, self._raw, self.source, self.owners)
        ends = [(start, end + 1) for start, end in zip(window[-2::-2], window[::-2], strict=True)]
        centres, faces = (
            [axis_points(*axis_ends, d) for d, axis_ends in enumerate(ends)]
            for axis_points in (self.grid.centres, self.grid.faces)
        )
        self._points = [tuple((faces if c == d else centres)[d] for d in range(self.ndim)) for c in range(self.ndim)]
        self._first_centre = [float(points[0]) for points in centres]
        self._beyond = [k for k, is_beyond in enumerate(reaches_beyond(window, self.grid)) if is_beyond]
        self._low_sides = [
            c for c, repeats in enumerate(self.repeats) if not repeats and window[2 * (self.ndim - 1 - c)] <= PAD
        ]

    def _in_window(self, values: np.ndarray, window: Window) -> np.ndarray:
        """Return values of another window in the present one, shape (axis, ...), 0 outside the other window.

        Args:
            values: values on the faces of the other window, shape (axis, ...).
            window: the other window.
        """
        result = np.zeros_like(self.b)
        overlaps = [
            (max(a, c), min(b, d) + 1)
            for a, b, c, d in zip(window[::2], window[1::2], self.window[::2], self.window[1::2], strict=True)
        ]
        target, source = (
            tuple(slice(max(a - start, 0), max(b - start, 0)) for (a, b), start in zip(overlaps, w[::2], strict=True))
            for w in (self.window, window)
        )
        if all(a < b for a, b in overlaps):
            result[:, *target] = values[:, *source]
        return result

    @property
    def weighted_body_velocity(self) -> np.ndarray:
        """Velocity of the bodies times their share on the faces before the cells, shape (axis, ...) [m/s]."""
        weighted_velocity = np.zeros_like(self.velocity)
        weighted_velocity[:, *self.window_slices] = (1 - self.mu0[:, *self.window_slices]) * self.b
        return weighted_velocity

    @property
    def window_slices(self) -> tuple[slice, ...]:
        """The window of an array, with the faces behind its last cells."""
        return self._window_slices(self.window)

    def _window_slices(self, window: Window) -> tuple[slice, ...]:
        """Return the window of an array, with the faces behind its last cells."""
        return tuple(slice(a, b + 1) for a, b in zip(window[::2], window[1::2], strict=True))

    @property
    def layers(self) -> "list[Fluid]":
        """This water alone; of a patch also the coarser water around it, which is the last."""
        return [self]

    @property
    def level(self) -> float:
        """Mean pressure along the outermost cells of the domain, from which pressures count [m^2/s^2]."""
        return self._level_of(self.p)

    def _level_of(self, p: np.ndarray) -> float:
        """Return the mean of a field at the cells along the outermost ones of this grid."""
        mean: float = side_mean(self._flat(p), self.inner)
        return mean

    def imposed(self, time: float) -> float:
        """Return the fastest speed that a side of the domain itself imposes at a time, a wall or an inflow [m/s]."""
        return self.border.fastest(time)

    def state(self) -> dict[str, np.ndarray]:
        """Return what changes and cannot be placed anew, by name."""
        return {"velocity": self.velocity, "p": self.p, "offset": np.array(self.offset), **self.border.state()}

    def resume(self, state: dict[str, np.ndarray]) -> None:
        """Set what changes."""
        self.velocity[:], self.p[:] = state["velocity"], state["p"]
        self.offset = float(state["offset"])
        self.border.resume(state)

    def _level_view(self, kind: int) -> np.ndarray:
        return self._views[kind]

    @property
    def passage(self) -> np.ndarray:
        """Share of the pressure's gradient that acts on the faces before the cells, shape (axis, ...) [-]."""
        return self._views[multigrid.FACES]

    @property
    def arrays(self) -> float:
        """Memory of all fields in arrays of the padded grid [-]."""
        fields = [a for a in vars(self).values() if isinstance(a, np.ndarray) and a.dtype == self.dtype]
        return sum(a.size for a in fields) / self.p.size

    def place(self, bodies: list[AnyBody], poses: list[Pose], time: float) -> None:
        """Write the bodies at a time into the equations of the water.

        Args:
            bodies: the bodies.
            poses: their poses in the frame of the grid.
            time: time [s].

        Raises:
            InvalidDesign: a body reaches out of the domain.
        """
        old = self.window
        mirrors, solids = self._mirrors, self._solids
        windows = [window_of(b, p, self.grid, time, mirrors, solids) for b, p in zip(bodies, poses, strict=True)]
        self.mirror_cuts, new = [cuts(window, self.grid, mirrors) for window in windows], unite(windows, self.ndim)
        old_velocity = self.b
        if new == old:  # every value in it is written anew
            self.b = np.empty_like(old_velocity)
            self._keep_flat(self.b)
        else:
            self._clear(old)
            self._set_window(new)
        filled_windows = [w for w in (old, new) if w[1] > w[0]]
        self.rows = rows_of(bodies)
        self.immersion_sums = np.zeros((sum(map(len, self.rows)), sums_of(self.ndim)))
        self.internal_pressure_sums = np.zeros((len(self.immersion_sums), 1 + self.ndim))
        self._jointed = any(body.shape.jointed for body in bodies)
        if not filled_windows:
            return
        has_moved = new != self._level_window
        if has_moved:
            self._level_window = ()
            poisson.place_window(self._layout[:1], new)
        if new[1] > new[0]:
            self._measure(bodies, poses, time)
            self.mean = 0.5 * ((self._in_window(old_velocity, old) if new != old else old_velocity) + self.b)
            self._keep_flat(self.mean)
            self._widening(bodies)
        if has_moved:
            poisson.place_window(self._layout, unite(filled_windows, self.ndim))
        multigrid.coarsen(self._store, self._layout, self.inner)
        if has_moved:
            poisson.place_window(self._layout, new)
            self._level_window = new
            self._patches = patch.patch_layouts(self._layout, self.repeats)
            self._buffer = patch.allocate_buffer(self._buffer, self._patches)
        multigrid.copy_coefficients(self._store, self._layout, self._buffer, self._patches, self.inner)

    def _widening(self, bodies: list[AnyBody]) -> None:
        """Compute the source of the mean of the step's start and end; it is 0 for bodies that do not bend."""
        was_wide, self._widens = self._widens, not all(body.shape.rigid for body in bodies)
        if self._widens or was_wide or self.widening.shape != self.source.shape:
            self.widening = np.zeros_like(self.source)
        if self._widens:
            widening, mean, mu0 = (self._flat(a) for a in (self.widening, self.mean, self.mu0))
            fill_source(widening, mean, mu0, self._layout[0], self._near_layout, self.inner)

    def _clear(self, window: Window) -> None:
        """Set the coefficients of a window to those of water without bodies."""
        slices = self._window_slices(window)
        for fraction in (self.mu0, self.passage):
            fraction[:, *slices] = 1

    def _measure(self, bodies: list[AnyBody], poses: list[Pose], time: float) -> None:
        """Compute the kernel moments, the velocity and the source of the bodies in the window.

        Args:
            bodies: the bodies.
            poses: their poses in the frame of the grid.
            time: time [s].
        """
        h, slices = self.grid.cell, self._window_slices(self.window)
        self.overlap = Overlap(0.0, (0, 0))
        for c, points in enumerate(self._points):
            f, self.owners[c], overlap = measure_all(bodies, poses, points, time, h)
            self.overlap = max(self.overlap, overlap)
            mu0: np.ndarray = np.empty(f.distance.size, self.dtype)
            normal = np.empty((self.ndim, mu0.size))
            for d, component in enumerate(f.normal):
                normal[d] = component.ravel()
            fill(
                f.distance.ravel(), normal, f.thickness.ravel(), h, self.offset, mu0, self.mu1[c].reshape(self.ndim, -1)
            )  # fmt: skip
            self.mu0[c][slices] = self.passage[c][slices] = mu0.reshape(f.distance.shape)
            self.b[c] = f.velocity[c]
        for body, pose in zip(bodies, poses, strict=True):
            self._close(body.shape, pose, time, self._first_centre)
        source, b, mu0 = (self._flat(a) for a in (self.source, self.b, self.mu0))
        fill_source(source, b, mu0, self._layout[0], self._near_layout, self.inner)

    def _close(self, shape: Shape, pose: Pose, time: float, first_centre: list[float]) -> None:
        """Set the pressure to act on no face through the middle of a thin body.

        Args:
            shape: shape of the body.
            pose: its pose in the frame of the grid.
            time: time [s].
            first_centre: centre of the first cell of the window, x first [m].
        """
        surface = shape.midsurface(time, pose)
        if surface is not None:
            slices = self._window_slices(self.window)
            for c in range(self.ndim):
                CLOSING_KERNELS[self.ndim](self.passage[c][slices], c, surface, np.array(first_centre), self.grid.cell)

    def fastest(self) -> float:
        """Return the largest sum of the sizes of the components in a cell [m/s]."""
        speed: float = fastest(self._flat(self.velocity), self.inner, self._sums)
        return speed

    def step(
        self, dt: float, stream: tuple[float, ...], push: tuple[float, ...], limits: tuple[float, float],
        time: float = 0.0,
    ) -> None:  # fmt: skip
        """Advance velocity and pressure by ``dt`` [s] around the bodies placed at its end.

        Args:
            dt: time step [s].
            stream: velocity of the far water at the end of the step [m/s].
            push: uniform acceleration of the water [m/s^2].
            limits: mean and largest divergence that may be left [m/s per cell].
            time: time of the end of the step, for sides that change [s].

        On return the velocity is divergence-free to ``limits`` outside the bodies and fits the sides.
        """
        span, force = self._begin(dt, stream, push, time)
        is_first, plan = self.border.steps == 1 and self._learns, self._plan(span)
        start = self.p.copy() if is_first else self.p
        self._stages(plan, force, limits)
        if is_first:  # an impulsively started body moves the far water at once
            for _ in range(MAX_FIRST_STEP_ROUNDS):
                if self._is_first_step_converged(plan[-1], limits):
                    break
                self._reset_first_step(start)
                self._stages(plan, force, limits)
        self._swap()

    def _begin(
        self, dt: float, stream: tuple[float, ...], push: tuple[float, ...], time: float
    ) -> tuple[float, tuple[float, ...]]:
        """Prepare the sides for a step.

        Args:
            dt: time step [s].
            stream: velocity of the far water at the end of the step [m/s].
            push: uniform acceleration of the water [m/s^2].
            time: time of the end of the step [s].

        Returns:
            length of the step [cells per (m/s)] and the acceleration times the cell [(m/s)^2].
        """
        real, h = self.dtype, self.grid.cell
        span = real(dt / h)
        self.border.prepare(self.velocity, self.window, float(span), stream, time)
        return span, tuple(real(component * h) for component in push)

    def _plan(self, span: float) -> list[PlannedStage]:
        """Return the stages of a step; Heun's method has two.

        Args:
            span: length of the step [cells per (m/s)].
        """
        plan, previous, buffers = [], self.velocity, (self._corrected, self._predicted)
        stages = self.integrator.stages
        for remaining, stage in zip(reversed(range(len(stages))), stages, strict=True):
            result, dt = buffers[remaining % 2], self.dtype(stage.span) * span
            plan.append(PlannedStage(result, previous, self.velocity, previous, self.dtype(stage.keep), dt))
            previous = result
        return plan

    def _stages(self, plan: list[PlannedStage], push: tuple[float, ...], limits: tuple[float, float]) -> None:
        """Take the stages of a step; each is immersed and then made divergence-free.

        On return ``_corrected`` is the velocity at the end of the step, ``p`` its pressure, and ``immersion_sums`` the
        sums of the immersion.

        Args:
            plan: the stages.
            push: uniform acceleration of the water times the cell [(m/s)^2].
            limits: mean and largest divergence that may be left [m/s per cell].
        """
        self.solves = []
        self.immersion_sums[:] = 0
        self.internal_pressure_sums[:] = 0
        for k, (stage, weight) in enumerate(zip(plan, self.integrator.weights, strict=True)):
            if k > 0:
                self._hear(plan[k - 1])
            self._take(stage, push, limits)
            self._collect(stage, weight)
        if len(plan) == 1:  # with a single stage, the water beyond the sides is updated here
            self._hear(plan[0])

    def _take(self, stage: PlannedStage, push: tuple[float, ...], limits: tuple[float, float]) -> None:
        """Take one stage."""
        self._advance(stage, push)
        self._project(stage.result, stage.pressure_duration, limits)

    def _hear(self, stage: PlannedStage) -> float:
        """Update the water beyond the sides after a stage; return the largest change of their velocity [m/s]."""
        return self.border.update_induced(stage.result, self.window)

    @property
    def _learns(self) -> bool:
        """Whether water beyond the sides, or around a patch, has to converge in the first step."""
        return self.border.water is not None

    def _is_first_step_converged(self, last_stage: PlannedStage, limits: tuple[float, float]) -> bool:
        """Return whether a repetition of the first step would not change it; updates the water beyond the sides.

        Args:
            last_stage: last stage of the step.
            limits: mean and largest divergence that may be left [m/s per cell].
        """
        return self._hear(last_stage) <= limits[1]

    def _reset_first_step(self, start: np.ndarray) -> None:
        """Prepare a repetition of the first step, with the pressure with which it started."""
        self.p[:] = start

    def _swap(self) -> None:
        """Make the velocity at the end of the step the present one."""
        self.velocity, self._corrected = self._corrected, self.velocity

    def _advance(self, stage: PlannedStage, push: tuple[float, ...]) -> None:
        """Write the velocity of a stage, immersed and with its sides filled; its divergence is not yet removed.

        Args:
            stage: the stage; its ``result`` is written.
            push: uniform acceleration of the water times the cell [(m/s)^2].
        """
        flat = self._flat
        result, blend, base, rate = flat(stage.result), flat(stage.blend), flat(stage.base), flat(stage.rate)
        level_layout, raw, p = self._layout[0], flat(self._raw), flat(self.p)
        self._advance_all(
            result,
            blend,
            base,
            rate,
            p,
            raw,
            level_layout,
            self._near_layout,
            self.inner,
            self.repeats,
            stage.dt,
            self.nu,
            push,
            stage.blend_fraction,
        )
        if self.window[1] > self.window[0]:
            self._clear_raw_on_sides()
            self._extend_raw()
            b, mu0, mu1, passage = flat(self.b), flat(self.mu0), flat(self.mu1), flat(self.passage)
            immerse(
                result, blend, raw, b, mu0, passage, mu1, p, self._near_layout, self.inner, stage.dt,
                stage.blend_fraction,
            )  # fmt: skip
        self.border.fill(stage.result)

    def _clear_raw_on_sides(self) -> None:
        """Set the bare update on the low sides of the domain to 0, as far as the window reaches them.

        The kernel computes no flux through these faces and leaves undefined numbers there.
        """
        for c in self._low_sides:
            axis = self.ndim - 1 - c
            np.moveaxis(self._raw[c], axis, 0)[PAD - self.window[2 * axis]] = 0

    def _extend_raw(self) -> None:
        """Fill the bare update beyond the mirrors that cut bodies, and beyond the walls beside bodies.

        Beyond a mirror and a wall without friction it is the mirror image. Beyond a wall with friction the velocity
        along it is that whose mean with the image is the wall's.
        """
        for k in self._beyond:
            axis, is_low = k // 2, k % 2 == 0
            start = self.window[2 * (self.ndim - 1 - axis)]
            wall_velocity = self.border.wall_velocity(axis, is_low=is_low)
            for c, component in enumerate(self._raw):
                planes = np.moveaxis(component, self.ndim - 1 - axis, 0)
                n = self.grid.cells[axis] + PAD - start
                if c == axis:  # across the mirror, which lies on these faces
                    low_planes = PAD - start, PAD - 1 - start, PAD + 1 - start
                    face, image, source = low_planes if is_low else (n, n + 1, n - 1)
                    planes[face], planes[image] = 0, -planes[source]
                else:
                    image, source = (PAD - 1 - start, PAD - start) if is_low else (n, n - 1)
                    planes[image] = planes[source] if wall_velocity is None else 2 * wall_velocity[c] - planes[source]

    def _collect(self, stage: PlannedStage, weight: float) -> None:
        """Add the momentum and energy that the immersion gave to the water in a stage to ``immersion_sums``.

        Args:
            stage: the stage after its projection.
            weight: share of the stage in the step [-].
        """
        if self.window[1] <= self.window[0]:
            return
        dt, keep, near_layout, inner = float(stage.dt), float(stage.blend_fraction), self._near_layout, self.inner
        sums, p, flat = np.zeros_like(self.immersion_sums), self._flat(self.p), self._flat
        result, blend, raw, passage, mu1 = (
            flat(stage.result), flat(stage.blend), flat(self._raw), flat(self.passage), flat(self.mu1)
        )  # fmt: skip
        add_immersion_impulse(
            sums, result, blend, raw, flat(self.mean), passage, mu1, p, flat(self.owners), near_layout, inner, dt, keep
        )  # fmt: skip
        self.subtract_dilatation_work(sums, self.p, dt)
        if self._jointed:
            sums = sums + self.joint_pressure_sums(self.p, dt)
        self.immersion_sums += weight * sums
        if len(self.immersion_sums) > len(self.rows):
            self.internal_pressure_sums += self.pressures(self.p, weight * dt)

    def subtract_dilatation_work(self, sums: np.ndarray, p: np.ndarray, weight: float) -> None:
        """Subtract the work of a pressure on the widening inside bending bodies from the energy in ``sums``.

        Args:
            sums: see ``immersion_sums``.
            p: pressure over density at the cells.
            weight: factor of the pressure.
        """
        if not self._widens:
            return
        flat = self._flat(p), self._flat(self.widening), self._flat(self.owners)
        dilatation_work(sums, *flat, self._near_layout, self.inner, weight)

    def joint_pressure_sums(self, p: np.ndarray, weight: float) -> np.ndarray:
        """Return the correction for the force with which a pressure pushes linked parts apart inside the bodies.

        Its shape is that of ``immersion_sums``; it is 0 for bodies without joints. See
        ``momentum.subtract_joint_pressure``.

        Args:
            p: pressure over density at the cells.
            weight: factor of the pressure.
        """
        sums = np.zeros_like(self.immersion_sums)
        if self._jointed and self.window[1] > self.window[0]:
            flat = self._flat(p), self._flat(self.mu0), self._flat(self.owners)
            subtract_joint_pressure(sums, *flat, self._layout[0], self._near_layout, self.inner, weight)
        return sums

    def pressures(self, p: np.ndarray, weight: float) -> np.ndarray:
        """Return integral and first moments of a pressure inside the region of each part, shape (row, 1 + axis).

        The integral is a sum over the cells, weighted by the bodies' fraction of each. Moments are taken from the
        corner of the grid [unit of pressure times weight; the same times cells].

        Args:
            p: pressure over density at the cells.
            weight: factor of the pressure.
        """
        sums = np.zeros_like(self.internal_pressure_sums)
        if self.window[1] > self.window[0]:
            flat = self._flat(p), self._flat(self.mu0), self._flat(self.owners)
            add_internal_pressure(sums, *flat, self._layout[0], self._near_layout, self.inner, weight)
        return sums

    def contents(self) -> np.ndarray:
        """Return momentum, volume and first moments inside the region of each part of each placed body.

        The shape is (row, ``momentum.contents_of``). Half of the volume of a face on a mirror lies in the domain.
        """
        sums = np.zeros((len(self.immersion_sums), contents_of(self.ndim)))
        if self.window[1] > self.window[0]:
            b, mu0 = self._flat(self.b), self._flat(self.mu0)
            add_contents(sums, b, mu0, self._flat(self.owners), self._layout[0], self._near_layout, self.inner)
            for k, is_cut in enumerate(cuts(self.window, self.grid, self._mirrors)):
                if is_cut:
                    self._add_half_faces(sums, k // 2, is_low=k % 2 == 0)
        return sums

    def _add_half_faces(self, sums: np.ndarray, axis: int, *, is_low: bool) -> None:
        """Count half of the volume of the faces on a mirror: ``add_contents`` counts all of it, at a high end none.

        Nothing moves through a mirror, so that these faces have no momentum.

        Args:
            sums: see ``contents``, to change.
            axis: axis of the mirror's normal.
            is_low: whether the mirror is at the low end of the axis.
        """
        ndim, starts = self.ndim, self.window[::2][::-1]  # x first
        plane = PAD if is_low else PAD + self.grid.cells[axis]
        spans = [
            (plane, plane + 1) if d == axis else (max(start, PAD), min(stop, PAD + n))
            for d, (start, stop, n) in enumerate(zip(starts, self.window[1::2][::-1], self.grid.cells, strict=True))
        ]
        index = tuple(slice(*span) for span in reversed(spans))
        near_index = tuple(slice(a - start, b - start) for (a, b), start in zip(spans, starts, strict=True))[::-1]
        volume = (0.5 - is_low) * (1 - self.mu0[axis][index].astype(float)) / ndim
        rows = self.owners[axis][near_index].ravel()
        places = np.meshgrid(
            *(np.arange(*span) - PAD + 0.5 * (d != axis) for d, span in reversed(list(enumerate(spans)))), indexing="ij"
        )[::-1]
        for column, weight in enumerate((1.0, *places), start=contents_of(ndim) - 1 - ndim):
            sums[:, column] += np.bincount(rows, (volume * weight).ravel(), len(sums))

    def _project(self, velocity: np.ndarray, dt: float, limits: tuple[float, float]) -> None:
        """Make the divergence of a velocity that of the bodies, and add the pressure that this takes to ``p``.

        Args:
            velocity: shape (axis, ...), which is changed [m/s].
            dt: duration for which the pressure acts [cells per (m/s)].
            limits: mean and largest divergence that may be left [m/s per cell].
        """
        r, level_layout, near_layout, inner = self._views[multigrid.B], self._layout[0], self._near_layout, self.inner
        u, source = self._flat(velocity), self._flat(self.source)
        mean, maximum = residual(
            r, u, source, self._views[multigrid.DINV], level_layout, near_layout, inner, self.repeats, self._sums
        )
        solve = poisson.Solve(0, mean, maximum)
        if (
            solve.mean_divergence > MIN_SOLVED_RESIDUAL * limits[0]
            or solve.max_divergence > MIN_SOLVED_RESIDUAL * limits[1]
        ):
            solve, (a, b) = self._solve(limits)
            d, x, gain = self._d, self._views[multigrid.X], self.dtype(1 / dt)
            p, passage = self._flat(self.p), self._flat(self.passage)
            correct(u, p, d, x, a, b, passage, level_layout, inner, self.repeats, gain)
            self.border.fill(velocity)
        self.solves.append(solve)

    def _seal(self, x: np.ndarray) -> None:
        """Fill the cells beside the domain with mirrored values, or with those at the other end of a periodic axis."""
        for axis, is_periodic in zip(reversed(range(self.ndim)), self.repeats, strict=True):
            before: tuple[slice | int, ...] = (slice(None),) * axis
            first, last = PAD, int(x.shape[axis]) - PAD - 1
            lower_source, upper_source = (last, first) if is_periodic else (first, last)
            x[(*before, first - 1)] = x[(*before, lower_source)]
            x[(*before, last + 1)] = x[(*before, upper_source)]

    def potential(self, acceleration: np.ndarray, limit: float) -> np.ndarray:
        """Return the pressure of the water's response to an acceleration of the bodies.

        The result is a work array: use it before the next call.

        Args:
            acceleration: acceleration on the faces of the window, shape (axis, ...).
            limit: mean divergence that may be left.

        Raises:
            NotConverged: the pressure solver did not converge.
        """
        return self._answering(acceleration, None, limit)

    def _answering(self, acceleration: np.ndarray, side_velocity: np.ndarray | None, limit: float) -> np.ndarray:
        """Return ``potential`` with an additional flow through the sides.

        Args:
            acceleration: acceleration on the faces of the window, shape (axis, ...).
            side_velocity: flow through the sides, as a velocity of the whole grid; None for none.
            limit: mean divergence that may be left.
        """
        r = self._level_view(multigrid.B)
        r[:] = 0
        net = sum(
            np.moveaxis(_inflow(component, self.ndim - 1 - c), 0, self.ndim - 1 - c)
            for c, component in enumerate(acceleration)
        )
        window_cells = tuple(slice(a, b) for a, b in zip(self.window[::2], self.window[1::2], strict=True))
        field = r.reshape(self.p.shape)
        field[window_cells] = net
        if side_velocity is not None:
            for c, component in enumerate(side_velocity):
                lines, faces = np.moveaxis(field, self.ndim - 1 - c, 0), np.moveaxis(component, self.ndim - 1 - c, 0)
                lines[:-1] += faces[:-1] - faces[1:]
        for axis in range(self.ndim):  # a body cut by a mirror has cells beyond the mirror
            lines = np.moveaxis(field, axis, 0)
            lines[:PAD], lines[-PAD:] = 0, 0
        r[self._level_view(multigrid.DINV) == 0] = 0
        _, (a, b) = self._solve((limit, 10 * limit))
        x, d, z = (slabs.reshape(self.p.shape) for slabs in (self._x, self._d, self._level_view(multigrid.X)))
        cells = (slice(PAD, -PAD),) * self.ndim  # the multigrid leaves undefined values beyond them
        x[:] = 0
        np.multiply(d[cells], a, out=x[cells])
        x[cells] += b * z[cells]
        self._seal(x)
        return x

    def apply_velocity_change(self, velocity_change: np.ndarray, dt: float, limit: float) -> np.ndarray:
        """Add a velocity change on the faces of the window to the water, with the pressure of its response.

        The sides are not changed. Returns ``potential`` of the velocity change: the pressure times the step in cells.

        Args:
            velocity_change: shape (axis, ...) [m/s].
            dt: length of the step [s].
            limit: mean divergence that may be left [m/s per cell].

        Raises:
            NotConverged: the pressure solver did not converge.
        """
        x = self.potential(velocity_change, limit)
        self._answer_with(velocity_change, dt)
        self.border.fill(self.velocity)
        return x

    def _answer_with(self, velocity_change: np.ndarray, dt: float) -> None:
        """Add a velocity change on the faces of the window, and the response of the water to it.

        The response is the last ``potential``. The sides are not changed.

        Args:
            velocity_change: shape (axis, ...) [m/s].
            dt: length of the step [s].
        """
        solution, z, unity, zero = self._x, self._level_view(multigrid.X), self.dtype(1), self.dtype(0)
        self.velocity[:, *self.window_slices] += velocity_change.astype(self.dtype)
        velocity, p, passage = (self._flat(a) for a in (self.velocity, self.p, self.passage))
        gain = self.dtype(self.grid.cell / dt)
        correct(velocity, p, solution, z, unity, zero, passage, self._layout[0], self.inner, self.repeats, gain)

    def along_sides(self, x: np.ndarray) -> list[np.ndarray]:
        """Return the values of the cells along each side: left, right, bottom, top (low and high)."""
        cells = x[(slice(PAD, -PAD),) * self.ndim]
        return [np.moveaxis(cells, axis, 0)[end] for axis in reversed(range(self.ndim)) for end in (0, -1)]

    def side_accelerations(self, acceleration: np.ndarray) -> list[np.ndarray]:
        """Return the acceleration into the domain that the last ``potential`` induces on each side [m/s^2].

        The list is empty if the domain is bounded.

        Args:
            acceleration: argument of that ``potential``.
        """
        if self.border.water is None:
            return []
        sides = self.border.water.inward(self._gained(acceleration), self.window, [])
        moves = [float(edge.unbounded) for edge in self.border.edges]
        level = sum(float(s.sum()) for s in sides) / sum(m * s.size for m, s in zip(moves, sides, strict=True))
        return [s - m * level for m, s in zip(moves, sides, strict=True)]

    def _gained(self, acceleration: np.ndarray) -> np.ndarray:
        """Return the acceleration of the water by the last ``potential``, shape (axis, ...) [m/s^2].

        Args:
            acceleration: argument of that ``potential``, on the faces of the window.
        """
        slices, x, gained = (
            self._window_slices(self.window),
            self._x.reshape(self.p.shape),
            np.zeros_like(self.velocity),
        )
        for c, work in enumerate(gained):
            axis = self.ndim - 1 - c
            np.moveaxis(work, axis, 0)[1:] = -np.moveaxis(np.diff(x, axis=axis), axis, 0)
            work[slices] = acceleration[c] + self.passage[c][slices] * work[slices]
        return gained

    def _solve(self, limits: tuple[float, float]) -> tuple[poisson.Solve, tuple[float, float]]:
        """Solve the pressure equation for the right side of the finest level.

        Args:
            limits: mean and largest residual at which the iteration stops.

        Returns:
            statistics of the solve, and the factors of the two arrays of the solution; see ``poisson.solve``.

        Raises:
            NotConverged: the residual is above ``MAX_FINAL_RESIDUAL`` times its limit.
        """
        *result, a, b = poisson.solve(
            self._x, self._d, self._q, self._store, self._layout, self._buffer, self._patches, self.inner,
            self.repeats, self._sums, *limits, self.min_cycles, MAX_PRESSURE_CYCLES,
        )  # fmt: skip
        solve = poisson.Solve(*result)
        if not (
            solve.mean_divergence <= MAX_FINAL_RESIDUAL * limits[0]
            and solve.max_divergence <= MAX_FINAL_RESIDUAL * limits[1]
        ):
            raise NotConverged(
                f"the pressure solver stopped after {solve.cycles} cycles with a divergence of "
                f"{solve.mean_divergence:.2g} m/s per cell on the average and {solve.max_divergence:.2g} at most, "
                f"where {limits[0]:.2g} and {limits[1]:.2g} are allowed; take a larger tolerance, "
                "or precision='double'."
            )
        return solve, (self.dtype(a), self.dtype(b))

"""A patch of fine cells around the bodies, nested in a coarser grid that covers the whole domain.

The two grids do not move relative to each other, and they take the same time steps. Each stage of a step has four
parts. First, the fine cells advance without the pressure. Their velocities then replace the coarse velocities inside
the patch, and the coarse pressure is solved on the whole domain. The coarse velocities on the sides of the patch are
spread over the fine faces, so that each coarse face passes the same flux, and the fine pressure is solved with them.
Finally, velocity and pressure of the fine cells replace the coarse ones inside the patch. So neither grid loses water
to the other. The two pressures agree at the sides of the patch, up to the error of the coarse pressure in the change
of one stage. The coarse cells see the bodies only as cells on which no pressure acts.

Source: the composite projection of Almgren, Bell, Colella, Howell and Welcome 1998, J. Comput. Phys. 142, 1-46, with
one cycle a stage of McCormick's fast adaptive composite grids (1989).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import ceil, log, pi
from typing import ClassVar, NamedTuple

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.flow.body import AnyBody
from suchus.flow.compiled import PAD, UNIT, compiled, unsigned
from suchus.flow.grid import RATIOS, Grid
from suchus.flow.integrator import Integrator
from suchus.flow.pose import Pose
from suchus.flow.scheme import Scheme
from suchus.flow.sides import NAMES, Side, Sides
from suchus.flow.water import Fluid, PlannedStage

MIN_SIDE_CLEARANCE = 4
"""Coarse cells between a patch and a side of the domain that it does not share, at least [-]. The stencil around the
patch must lie inside the domain."""

MIN_BODY_CLEARANCE = 2
"""Coarse cells between the window of a body and the patch's sides, at least [-]. The stencil around the patch reads
velocities that far inside, which must not be those of a body."""

ALIGNMENT_TOLERANCE = 1e-6
"""Deviation of a patch from the coarse cells that counts as rounding, over a coarse cell [-]."""

COARSE_TOLERANCE_RATIO = 0.25
"""Limit of the divergence of the coarse cells, over that of the fine ones [-]. The coarse residual reaches the patch as
a flux through its sides, which changes from step to step. With a ratio of 1, the force on an oscillating cylinder of 32
fine cells a diameter, with coarse cells of twice the size, fluctuates by 0.35 % of its rms; with 0.25, by 0.1 %."""

MAX_CYCLE_RESIDUAL = 0.05
"""Largest residual of the pressure difference along the patch's sides after one multigrid cycle, over the difference
before it [-]."""

_SHIFT = -0.8  # of the wall's offset in cells, over the cell: see ``immerse.wall_offset``


@dataclass(frozen=True, slots=True)
class CoarseSide(Side):
    """The side of a patch beyond which the coarser cells continue."""

    is_domain_end: ClassVar[bool] = False


def locate_patch(grid: Grid, coarse_grid: Grid) -> tuple[int, tuple[int, ...]]:
    """Return the refinement ratio of a patch and the coarse cell in its low corner, x first.

    Args:
        grid: the fine cells of the patch.
        coarse_grid: the coarse cells of the whole domain.

    Returns:
        fine cells along a coarse cell, and the index of the coarse cell along each axis [-].

    Raises:
        InvalidDesign: the cells of both do not fit, or the patch reaches out of the domain.
    """
    if coarse_grid.ndim != grid.ndim:
        raise InvalidDesign(
            f"the patch has {grid.ndim} axes and the grid around it {coarse_grid.ndim}; give both the same."
        )
    ratio = round(coarse_grid.cell / grid.cell)
    low_corner = [(a - b) / coarse_grid.cell for a, b in zip(grid.origin, coarse_grid.origin, strict=True)]
    fits = abs(coarse_grid.cell / grid.cell - ratio) < ALIGNMENT_TOLERANCE and all(n % ratio == 0 for n in grid.cells)
    is_aligned = all(abs(coordinate - round(coordinate)) <= ALIGNMENT_TOLERANCE * ratio for coordinate in low_corner)
    if ratio not in RATIOS or not fits or not is_aligned:
        raise InvalidDesign(
            f"the patch of {' x '.join(map(str, grid.cells))} cells of {grid.cell:.6g} m from {grid.origin} m on does "
            f"not fill whole cells, {coarse_grid.cell:.6g} m wide, of the grid around it, {RATIOS[0]}, {RATIOS[1]} or "
            f"{RATIOS[2]} to one; take around.patch(x, y, ratio=4), in space with z."
        )
    corner = tuple(map(round, low_corner))
    for d, (a, n, m) in enumerate(zip(corner, grid.cells, coarse_grid.cells, strict=True)):
        if a < 0 or a + n // ratio > m:
            ends = (
                f"{domain.origin[d]:.6g} to {domain.origin[d] + domain.size[d]:.6g} m" for domain in (grid, coarse_grid)
            )
            raise InvalidDesign(
                f"along {'xyz'[d]} the patch from {next(ends)} reaches out of the grid around it, which goes from "
                f"{next(ends)}; take around.patch(x, y, ratio=4), in space with z."
            )
    return ratio, corner


def patch_sides(grid: Grid, coarse_grid: Grid, sides: Sides) -> Sides:
    """Return the sides of a patch: the side of the domain where it reaches one, else the border to the coarse cells.

    Args:
        grid: the fine cells of the patch.
        coarse_grid: the coarse cells of the whole domain.
        sides: sides of the domain.

    Raises:
        InvalidDesign: the patch comes near a side of the domain without reaching it, or reaches a side that is open.
    """
    ratio, corner = locate_patch(grid, coarse_grid)
    patch_sides: dict[str, Side] = {}
    for d, (start, n, m) in enumerate(zip(corner, grid.cells, coarse_grid.cells, strict=True)):
        for k, margin in enumerate((start, m - start - n // ratio)):
            name = NAMES[2 * d + k]
            side: Side = getattr(sides, name)
            shared = margin == 0 and not side.is_open and not side.is_permeable
            if not shared and margin < MIN_SIDE_CLEARANCE:
                raise InvalidDesign(
                    f"the patch comes within {margin * coarse_grid.cell:.4g} m of the {name} side of the domain; keep "
                    f"{MIN_SIDE_CLEARANCE * coarse_grid.cell:.4g} m away, {MIN_SIDE_CLEARANCE} coarse cells, or end "
                    f"on it where it is a wall, "
                    f"a mirror or periodic."
                )
            patch_sides[name] = side if shared else CoarseSide()
    return replace(sides, **patch_sides)


def min_pressure_cycles(side_cells: int) -> int:
    """Return the fewest pressure cycles with which errors at the sides of a patch do not grow from step to step.

    After a stage, the coarse pressure inside the patch is the pressure of the fine cells. It differs slightly from the
    pressure outside. This jump lies along a single coarse cell, and the next stage has to remove its gradient. The fine
    pressure takes the flux through the sides as given: it turns what is left of the jump into a smooth error that is up
    to ``side_cells / pi`` times as large.

    Args:
        side_cells: coarse cells along the longest side of the patch [-].
    """
    return max(1, ceil(log(2 * side_cells / pi) / log(1 / MAX_CYCLE_RESIDUAL)))


def _weights(index: np.ndarray, ratio: int, *, on_faces: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return the coarse cells from which values of a patch are interpolated along one axis, and the weights.

    On faces across this axis, a cubic goes through four coarse values. Otherwise a parabola goes through three values,
    and the mean of the fine values in a coarse cell is the coarse value.

    Args:
        index: index of the fine values, padded [-].
        ratio: fine cells along a coarse one [-].
        on_faces: whether the values lie on faces across this axis.

    Returns:
        Coarse indices, counted from the patch's first cell, and weights, each of shape (value, 4 or 3).
    """
    cell, subcell = np.divmod(index - PAD, ratio)
    if on_faces:
        t = subcell / ratio
        weights = [
            -t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
            (t + 1) * t * (t - 1) / 6,
        ]  # fmt: skip
    else:
        centres = (np.arange(ratio) + 0.5) / ratio - 0.5
        offset = centres[subcell]
        bend = offset**2 - np.mean(centres**2)
        weights = [(bend - offset) / 2, 1 - bend, (bend + offset) / 2]
    return cell[:, None] + np.arange(-1, len(weights) - 1), np.stack(weights, axis=1)


@compiled
def average(fine, coarse, starts, steps, spans):  # type: ignore[no-untyped-def]
    """Write the mean of a box of fine values to each coarse value; all vectors have three axes, the last axis first.

    Args:
        fine: padded fine values.
        coarse: the means, which are written.
        starts: first fine value of the first box, along each axis [-].
        steps: distance of consecutive boxes, along each axis [fine values].
        spans: length of a box, along each axis [fine values].
    """
    fraction = fine.dtype.type(1.0 / (spans[0] * spans[1] * spans[2]))
    for k in range(coarse.shape[0]):
        for j in range(coarse.shape[1]):
            for i in range(coarse.shape[2]):
                total = fine.dtype.type(0)
                for n in range(spans[0]):
                    for m in range(spans[1]):
                        row, slab = starts[1] + steps[1] * j + m, starts[0] + steps[0] * k + n
                        for c in range(spans[2]):
                            total += fine[slab, row, starts[2] + steps[2] * i + c]
                coarse[k, j, i] = fraction * total


@compiled
def _interpolate(coarse, runs, first_cells, weights, taps, values):  # type: ignore[no-untyped-def]
    """Write values around a patch, each a weighted sum over a box of coarse values.

    All vectors have three axes, the last axis first.

    Args:
        coarse: padded values, shape (slab, row, cell).
        runs: consecutive values along one row of the patch: slab, row, first and end index along the row, and the index
            in ``values`` of the first one, shape (run, 5).
        first_cells: first coarse index of a box, by axis and index in the patch.
        weights: weights of the coarse values along an axis, by axis, index in the patch, and position in the box.
        taps: coarse values of a box along each axis.
        values: the values, shape (value,).
    """
    line = np.empty(coarse.shape[2], values.dtype)
    for n in range(unsigned(runs.shape[0])):
        k, j, start, end, value_start = runs[n, 0], runs[n, 1], runs[n, 2], runs[n, 3], runs[n, 4]
        start_column, end_column = first_cells[2, start], first_cells[2, end - UNIT] + taps[2]
        for column in range(start_column, end_column):
            line[column] = 0
        for a in range(taps[0]):
            for b in range(taps[1]):
                weight, slab, row = weights[0, k, a] * weights[1, j, b], first_cells[0, k] + a, first_cells[1, j] + b
                for column in range(start_column, end_column):
                    line[column] += weight * coarse[slab, row, column]
        for i in range(start, end):
            total = values.dtype.type(0)
            for c in range(taps[2]):
                total += weights[2, i, c] * line[first_cells[2, i] + c]
            values[value_start + i - start] = total


class RimStencil(NamedTuple):
    """Interpolation stencil of one velocity component around a patch; see ``_interpolate``."""

    flat_indices: np.ndarray
    """Flat indices of the values in the padded patch."""
    runs: np.ndarray
    """Runs of consecutive values along the rows."""
    first_cells: np.ndarray
    """First coarse index of a box."""
    weights: np.ndarray
    """Weights of the coarse values."""
    taps: np.ndarray
    """Coarse values of a box along each axis."""


def _runs(places: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Return the runs of consecutive cells along the rows, shape (run, 5); see ``_interpolate``.

    Args:
        places: flat indices of the cells, rising.
        shape: padded shape of the patch, three axes.
    """
    slab, row, number = np.unravel_index(places, shape)
    begins = np.flatnonzero(np.diff(places, prepend=-2) - 1 + (np.diff(row, prepend=-1) != 0))
    ends = np.append(begins[1:], places.size) - 1
    return np.stack([slab[begins], row[begins], number[begins], number[ends] + 1, begins], axis=1).astype(unsigned)


class Rim:
    """Interpolation of the velocity around a patch from the coarser water, on its sides and beyond them."""

    def __init__(self, patch: Grid, coarse_grid: Grid, sides: Sides, dtype: type) -> None:
        """Prepare the interpolation stencil of each velocity component.

        Args:
            patch: the fine cells.
            coarse_grid: the coarse cells of the whole domain.
            sides: sides of the patch.
            dtype: precision of the fields.
        """
        self._dtype = dtype
        ratio, corner = locate_patch(patch, coarse_grid)
        ndim = patch.ndim
        shape = tuple(n + 2 * PAD for n in reversed(patch.cells))
        is_coarse_side, repeats = (
            [isinstance(side, CoarseSide) for side in sides.of_axes(ndim)],
            sides.is_periodic(ndim),
        )
        self._stencils = []
        for c in range(ndim):
            is_rim, is_excluded = np.zeros(shape, bool), np.zeros(shape, bool)
            for d, n in enumerate(patch.cells):
                rim_lines = np.moveaxis(is_rim, ndim - 1 - d, 0)
                excluded_lines = np.moveaxis(is_excluded, ndim - 1 - d, 0)
                low_end, high_end = slice(0, PAD + (c == d and not repeats[d])), slice(PAD + n, None)
                for end, is_coarse in zip((low_end, high_end), is_coarse_side[2 * d :], strict=False):
                    if is_coarse:
                        rim_lines[end] = True
                    else:
                        excluded_lines[end] = True
            places = np.flatnonzero(is_rim & ~is_excluded)
            self._stencils.append(self._component(c, places, shape, ratio, corner))

    def _component(
        self, c: int, places: np.ndarray, shape: tuple[int, ...], ratio: int, corner: tuple[int, ...]
    ) -> RimStencil:
        """Return the interpolation stencil of one velocity component.

        Args:
            c: axis of the component.
            places: flat indices of the values in the padded patch.
            shape: padded shape of the patch.
            ratio: fine cells along a coarse cell [-].
            corner: coarse cell in the low corner of the patch, x first [-].
        """
        ndim = len(shape)
        flat = 3 - ndim  # of a plane the first of three axes is a single place
        first_cells, taps = np.zeros((3, max(shape)), unsigned), np.ones(3, unsigned)
        weights: np.ndarray = np.zeros((3, max(shape), 4), self._dtype)
        weights[:flat, 0, 0] = 1
        for axis, n in enumerate(shape):
            d = ndim - 1 - axis
            coarse_cells, axis_weights = _weights(np.arange(n), ratio, on_faces=c == d)
            first_cells[flat + axis, :n] = coarse_cells[:, 0] + corner[d] + PAD
            taps[flat + axis] = axis_weights.shape[1]
            weights[flat + axis, :n, : axis_weights.shape[1]] = axis_weights
        return RimStencil(places, _runs(places, (1,) * flat + shape), first_cells, weights, taps)

    def interpolate(self, coarse: np.ndarray) -> list[np.ndarray]:
        """Return the velocity around the patch, interpolated from the coarse faces, one array for each component [m/s].

        Args:
            coarse: padded velocity of the coarse grid, shape (axis, ...) [m/s].
        """
        values = []
        for component, stencil in zip(coarse, self._stencils, strict=True):
            rim_values: np.ndarray = np.empty(stencil.flat_indices.size, self._dtype)
            slabs = component if component.ndim == 3 else component[None]
            _interpolate(slabs, stencil.runs, stencil.first_cells, stencil.weights, stencil.taps, rim_values)
            values.append(rim_values)
        return values

    def write(self, velocity: np.ndarray, values: Sequence[np.ndarray]) -> None:
        """Write interpolated values, see ``read``, to the padded velocity of the patch."""
        for component, stencil, rim_values in zip(velocity, self._stencils, values, strict=True):
            component.reshape(-1)[stencil.flat_indices] = rim_values


class Nested(Fluid):
    """The water on a patch of fine cells and on the coarser cells around it.

    Its fields as a ``Fluid`` are those of the patch.

    Attributes:
        coarse: the water on the whole domain, which inside the patch holds means over the fine cells.
    """

    def __init__(
        self, grid: Grid, coarse_grid: Grid, sides: Sides, viscosity: float, dtype: type, scheme: Scheme,
        integrator: Integrator,
    ) -> None:  # fmt: skip
        """Set up the patch and the coarse water around it.

        Args:
            grid: the fine cells of the patch.
            coarse_grid: the coarse cells of the whole domain.
            sides: sides of the domain.
            viscosity: kinematic viscosity [m^2/s].
            dtype: precision of the fields.
            scheme: advection scheme.
            integrator: time integrator.
        """
        sides_of_patch = patch_sides(grid, coarse_grid, sides)
        super().__init__(grid, sides_of_patch, viscosity, dtype, scheme, integrator)
        self.coarse = Fluid(coarse_grid, sides, viscosity, dtype, scheme, integrator)
        self.ratio, corner = locate_patch(grid, coarse_grid)
        self.coarse.min_cycles = min_pressure_cycles(max(grid.cells) // self.ratio)
        self._rim = Rim(grid, coarse_grid, sides_of_patch, dtype)
        self._values: list[np.ndarray] = []  # around the patch, as they were last read
        self._previous_values: list[np.ndarray] = []  # a round of the first step earlier
        counts = [n // self.ratio for n in grid.cells]
        self._cells = tuple(
            slice(a + PAD, a + PAD + n) for a, n in zip(corner[::-1], counts[::-1], strict=True)
        )  # fmt: skip
        self._faces = []
        for c, is_periodic in enumerate(self.repeats):
            face_slices, axis = list(self._cells), grid.ndim - 1 - c
            face_slices[axis] = slice(face_slices[axis].start + (not is_periodic), face_slices[axis].stop)
            self._faces.append(tuple(face_slices))
        self._has_domain_sides = any(not isinstance(side, CoarseSide) for side in sides_of_patch.of_axes(grid.ndim))
        self._push: tuple[float, ...] = ()
        self._span = 0.0
        self._coarse_acceleration: np.ndarray = np.zeros(0)

    @property
    def layers(self) -> list[Fluid]:
        """The patch, and the water on the whole domain."""
        return [self, self.coarse]

    @property
    def level(self) -> float:
        """Mean pressure along the sides of the domain [m^2/s^2]."""
        return self.coarse.level

    def state(self) -> dict[str, np.ndarray]:
        """Return what changes of both; see ``Fluid``."""
        return {**super().state(), **{f"coarse.{name}": value for name, value in self.coarse.state().items()}}

    def resume(self, state: dict[str, np.ndarray]) -> None:
        """Set what changes of both."""
        super().resume(state)
        prefix = "coarse."
        self.coarse.resume({name.removeprefix(prefix): state[name] for name in state if name.startswith(prefix)})

    def imposed(self, time: float) -> float:
        """Return the fastest speed that a side of the domain imposes; see ``Fluid``."""
        return self.coarse.imposed(time)

    def fastest(self) -> float:
        """Return the largest sum of the sizes of the components in a cell, of a coarse one in fine cells [m/s]."""
        return max(super().fastest(), self.coarse.fastest() / self.ratio)

    def place(self, bodies: list[AnyBody], poses: list[Pose], time: float) -> None:
        """Write the bodies into the equations of both grids; see ``Fluid``.

        Raises:
            InvalidDesign: a body comes too near to the patch's sides.
        """
        super().place(bodies, poses, time)
        self._refuse_near(bodies, time)
        self.coarse.offset = self.offset * self.ratio**_SHIFT
        self.coarse.place(bodies, poses, time)

    def _refuse_near(self, bodies: list[AnyBody], time: float) -> None:
        """Refuse bodies that come too near to where the coarser cells begin."""
        if self.window[1] <= self.window[0]:
            return
        min_clearance, sides = MIN_BODY_CLEARANCE * self.ratio, self.sides.of_axes(self.ndim)
        for d, n in enumerate(self.grid.cells):
            start, end = self.window[2 * (self.ndim - 1 - d) : 2 * (self.ndim - d)]
            for k, clearance in enumerate((start - PAD, n + PAD - end)):
                if isinstance(sides[2 * d + k], CoarseSide) and clearance < min_clearance:
                    names, missing = ", ".join(body.name for body in bodies), min_clearance - clearance
                    raise InvalidDesign(
                        f"at t = {time:.4g} s the cells around {names} come within {max(clearance, 0)} fine cells of "
                        f"the {NAMES[2 * d + k]} side of the patch, and {min_clearance} are needed, "
                        f"{MIN_BODY_CLEARANCE} coarse "
                        f"ones; give a patch that is {missing * self.grid.cell:.3g} m larger there, or let the grid "
                        f"follow the body."
                    )

    def _surround(self, velocity: np.ndarray, coarse: np.ndarray) -> None:
        """Write the velocity on and beyond the sides of the patch, by that on the coarse faces."""
        self._values = self._rim.interpolate(coarse)
        self._rim.write(velocity, self._values)
        self.border.fill(velocity)

    def _give(self, fine: np.ndarray, coarse: np.ndarray) -> None:
        """Put the mean velocity through the fine faces of each coarse face inside the patch in its place."""
        for c, (fine_component, coarse_component) in enumerate(zip(fine, coarse, strict=True)):
            self._average(fine_component, coarse_component[self._faces[c]], c)

    def _replace(self, fine: np.ndarray, coarse: np.ndarray) -> None:
        """Let the coarse velocity inside the patch be the mean of the fine one, and fit sides that both share."""
        self._give(fine, coarse)
        if self._has_domain_sides:
            self.coarse.border.fill(coarse)

    def _average(self, fine: np.ndarray, coarse: np.ndarray, face_axis: int | None = None) -> None:
        """Write means over the fine cells in each coarse one, or over the fine faces in each coarse face.

        Args:
            fine: padded values on the patch.
            coarse: where they go; the coarse cells of the patch, or the faces between them.
            face_axis: the axis that the faces lie across; None for cells.
        """
        spans = [1 if d == face_axis else self.ratio for d in reversed(range(self.ndim))]
        inner = face_axis is not None and not self.repeats[face_axis]  # the first face lies on a side
        starts = [PAD + self.ratio * (d == face_axis and inner) for d in reversed(range(self.ndim))]
        steps = [self.ratio] * self.ndim
        if self.ndim == 2:
            fine, coarse, spans, starts, steps = fine[None], coarse[None], [1, *spans], [0, *starts], [1, *steps]
        average(fine, coarse, tuple(starts), tuple(steps), tuple(spans))

    def _give_pressure(self) -> float:
        """Put the mean pressure of the fine cells in the place of the coarse one, and make both count from one level.

        The level is that at which the outermost coarse cells of the patch have the mean that they had; returns by how
        much it rose [m^2/s^2].
        """
        coarse_pressure = self.coarse.p[self._cells]
        mean = np.empty_like(coarse_pressure)
        self._average(self.p, mean)
        rise = coarse_pressure - mean
        core = rise[(slice(1, -1),) * self.ndim]
        level = self.dtype((rise.sum(dtype=np.float64) - core.sum(dtype=np.float64)) / (rise.size - core.size))
        self.p += level
        coarse_pressure[:] = mean + level
        self.coarse._seal(self.coarse.p)
        return float(level)

    # --- one step ----------------------------------------------------------------------------------------------

    def _begin(
        self, dt: float, stream: tuple[float, ...], push: tuple[float, ...], time: float
    ) -> tuple[float, tuple[float, ...]]:
        """Prepare the sides of both grids for a step; see ``Fluid``."""
        self._previous_values, self.coarse.solves = [], []
        self._span, self._push = self.coarse._begin(dt, stream, push, time)
        return super()._begin(dt, stream, push, time)

    def _plan(self, span: float) -> list[PlannedStage]:
        pairs = zip(super()._plan(span), self.coarse._plan(self._span), strict=True)
        return [stage._replace(coarse_stage=coarse_stage) for stage, coarse_stage in pairs]

    def _take(self, stage: PlannedStage, push: tuple[float, ...], limits: tuple[float, float]) -> None:
        """Take one stage on both grids: fine advance, coarse advance and pressure, then the fine pressure."""
        coarse, coarse_stage = self.coarse, stage.coarse_stage
        self._advance(stage, push)
        coarse._advance(coarse_stage, self._push)
        self._replace(stage.result, coarse_stage.result)
        coarse._project(
            coarse_stage.result,
            coarse_stage.pressure_duration,
            (COARSE_TOLERANCE_RATIO * limits[0], COARSE_TOLERANCE_RATIO * limits[1]),
        )
        self._surround(stage.result, coarse_stage.result)
        self._project(stage.result, stage.pressure_duration, limits)
        self._replace(stage.result, coarse_stage.result)
        self._give_pressure()

    def _hear(self, stage: PlannedStage) -> float:
        return self.coarse._hear(stage.coarse_stage)

    @property
    def _learns(self) -> bool:
        return True

    def _is_first_step_converged(self, last_stage: PlannedStage, limits: tuple[float, float]) -> bool:
        """Return whether far water and velocity around the patch stayed the same in this round of the first step."""
        side_change = self._hear(last_stage)
        previous_values, self._previous_values = self._previous_values, self._values
        if not previous_values:
            return False
        change = max(float(np.abs(a - b).max()) for a, b in zip(previous_values, self._values, strict=True))
        return max(side_change, change) <= limits[1]

    def _reset_first_step(self, start: np.ndarray) -> None:
        """Keep the current pressure: the two grids converge to a common pressure round by round."""

    def _swap(self) -> None:
        super()._swap()
        self.coarse._swap()

    # --- what bodies that are accelerated meet -----------------------------------------------------------------

    def _coarsened(self, face_values: np.ndarray) -> np.ndarray:
        """Return values on the faces of the fine window, averaged onto those of the coarse window, (axis, ...)."""
        fine, coarse = np.zeros(self.velocity.shape), np.zeros(self.coarse.velocity.shape)
        fine[:, *self.window_slices] = face_values
        self._give(fine, coarse)
        return coarse[:, *self.coarse.window_slices]

    def potential(self, acceleration: np.ndarray, limit: float) -> np.ndarray:
        """Return the pressure that answers a body acceleration on the patch; see ``Fluid``."""
        self._coarse_acceleration = self._coarsened(acceleration)
        self.coarse.potential(self._coarse_acceleration, COARSE_TOLERANCE_RATIO * limit)
        return self._answering(acceleration, self._side_velocity(self._coarse_acceleration), limit)

    def apply_velocity_change(self, velocity_change: np.ndarray, dt: float, limit: float) -> np.ndarray:
        """Add a velocity change to the water on both grids, with the pressure that it causes; see ``Fluid``.

        Only the change is solved for on both grids. The step leaves a divergence; beside it, a change ten thousand
        times smaller than the velocity would be lost.

        Args:
            velocity_change: change of velocity on the faces of the fine window, shape (axis, ...) [m/s].
            dt: length of the step [s].
            limit: mean divergence that may be left [m/s per cell].
        """
        span = self.dtype(dt / self.grid.cell)
        self.coarse.apply_velocity_change(self._coarsened(velocity_change), dt, COARSE_TOLERANCE_RATIO * limit)
        x = self._answering(velocity_change, self._side_velocity(self._coarsened(velocity_change)), limit)
        self._answer_with(velocity_change, dt)
        self._surround(self.velocity, self.coarse.velocity)
        self._replace(self.velocity, self.coarse.velocity)
        return x + (self._give_pressure() * span - self._level_of(x))  # as it was added to the pressure

    def _side_velocity(self, acceleration: np.ndarray) -> np.ndarray:
        """Return the velocity that the last coarse ``potential`` induces on the sides of the patch.

        Args:
            acceleration: argument of that ``potential``, on the faces of the coarse window, shape (axis, ...).
        """
        velocity = np.zeros(self.velocity.shape)
        self._rim.write(velocity, self._rim.interpolate(self.coarse._gained(acceleration)))
        return velocity

    def along_sides(self, x: np.ndarray) -> list[np.ndarray]:
        """Return the values of ``potential``'s last answer along the sides of the domain; see ``Fluid``."""
        del x
        return self.coarse.along_sides(self.coarse._x.reshape(self.coarse.p.shape))

    def side_accelerations(self, acceleration: np.ndarray) -> list[np.ndarray]:
        """Return the acceleration into the domain on each side that ``potential``'s last answer induces."""
        del acceleration
        return self.coarse.side_accelerations(self._coarse_acceleration)

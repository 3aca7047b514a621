"""The water's fields and one time step: predict, project, correct, project.

All arrays have the padded shape (ny + 2 PAD, nx + 2 PAD), rows contiguous. Inside, lengths are in cells: a time
step is ``dt / cell``, a viscosity ``viscosity / cell``, a pressure that over the density [m^2/s^2].
"""

import numpy as np

from suchus.errors import NotConverged
from suchus.flow import multigrid, patch, poisson
from suchus.flow.advect import advance
from suchus.flow.body import AnyBody, measure_all, unite, window_of
from suchus.flow.border import Border
from suchus.flow.compiled import PAD, Window
from suchus.flow.exchange import CONTENTS, SUMS, collect, contents, swelling
from suchus.flow.grid import Grid
from suchus.flow.immerse import close, fill, fill_source, immerse
from suchus.flow.pose import Pose
from suchus.flow.project import correct, fastest, mean_residual, residual
from suchus.flow.sides import Sides
from suchus.flow.stencil import seal_ends

MOST_CYCLES = 60
"""Iterations of the pressure solver before it counts as stuck [-]."""

MOST_ROUNDS = 12
"""Rounds in which the first step and the water around the domain come to terms [-]."""

SKIPPED = 0.01
"""Residual over its limit below which nothing is solved [-]; at 1 whole steps pass so, and the force of the next one
that does not carries what was left over."""

STUCK = 1000.0
"""Residual over its limit above which a solve has failed; below, rounding stopped it short [-]."""

Vector = tuple[np.ndarray, np.ndarray]
"""A pair along x and y."""


def _fields(count: int, shape: tuple[int, int], dtype: type) -> list[np.ndarray]:
    return [np.zeros(shape, dtype) for _ in range(count)]


class Water:
    """Velocity and pressure on a grid, and the bodies as the equations see them.

    Attributes:
        u, v: velocity on the left and lower faces [m/s].
        p: pressure over density at the cell centres [m^2/s^2].
        mu0: share of the fluid on the left and lower faces [-].
        window: padded cell indices around the bodies.
        owners: on the window's u and v points, which body is nearest.
        given: what the immersion gave to the water in the last step, per body; see ``exchange.collect``.
        solves: how the last two pressure solves went.
    """

    def __init__(self, grid: Grid, sides: Sides, viscosity: float, dtype: type) -> None:
        nx, ny = grid.cells
        shape = (ny + 2 * PAD, nx + 2 * PAD)
        self.grid, self.sides, self.dtype = grid, sides, dtype
        self.nu = dtype(viscosity / grid.cell)
        self.border = Border.of(sides, grid, dtype)
        # Fluid: now, predicted, corrected; pressure
        self.u, self.v, self._u1, self._v1, self._u2, self._v2, self.p = _fields(7, shape, dtype)
        # Body: its velocity, kernel moments, own divergence; and the fluid's bare update in its window
        self.bu, self.bv, self._mu1xx, self._mu1xy, self._mu1yx, self._mu1yy = _fields(6, shape, dtype)
        self._source, self._raw_u, self._raw_v = _fields(3, shape, dtype)
        self.mu0: tuple[np.ndarray, np.ndarray] = np.ones(shape, dtype), np.ones(shape, dtype)
        # Pressure solver
        self._x, self._d, self._q = _fields(3, shape, dtype)
        self._layout = poisson.levels(ny, nx)
        self._store = poisson.make_store(self._layout, dtype)
        self._patches = patch.rects(self._layout)
        self._room: np.ndarray = np.zeros((6, 0), dtype)
        self._sums = np.zeros((shape[0], 4))
        self.window: Window = (PAD, PAD, PAD, PAD)
        self.offset = 0.0
        self.solves: list[poisson.Solve] = []
        self.given = np.zeros((0, SUMS))
        self._mean: list[np.ndarray] = [np.zeros((0, 0), dtype)] * 2
        self.owners = [np.zeros((0, 0), np.int8)] * 2

    def state(self) -> dict[str, np.ndarray]:
        """Return what changes and cannot be placed anew, by name."""
        return {"u": self.u, "v": self.v, "p": self.p, "offset": np.array(self.offset), **self.border.state()}

    def resume(self, state: dict[str, np.ndarray]) -> None:
        """Set what changes."""
        self.u[:], self.v[:], self.p[:] = state["u"], state["v"], state["p"]
        self.offset = float(state["offset"])
        self.border.resume(state)

    def _part(self, kind: int) -> np.ndarray:
        return multigrid.level(self._store, self._layout, kind, 0)

    @property
    def passage(self) -> tuple[np.ndarray, np.ndarray]:
        """Share of the pressure's gradient that acts on the left and lower faces [-]."""
        return self._part(multigrid.CX), self._part(multigrid.CY)

    @property
    def arrays(self) -> float:
        """Memory of all fields in arrays of the padded grid [-]."""
        own = [a for a in (*vars(self).values(), *self.mu0) if isinstance(a, np.ndarray) and a.dtype == self.dtype]
        return sum(a.size for a in own) / self.u.size

    def place(self, bodies: list[AnyBody], poses: list[Pose], time: float) -> None:
        """Write the bodies into the equations as they are at a time [s].

        Raises:
            InvalidDesign: a body reaches out of the domain.
        """
        old = self.window
        new = unite([window_of(b, p, self.grid, time) for b, p in zip(bodies, poses, strict=True)])
        here = np.s_[new[0] : new[1] + 1, new[2] : new[3] + 1]
        before = [b[here].copy() for b in (self.bu, self.bv)]
        self._clear(old)
        self.window = new
        poisson.place_window(self._layout, unite([w for w in (old, new) if w[1] > w[0]]))
        self.given = np.zeros((len(bodies), SUMS))
        if new[1] > new[0]:
            self._measure(bodies, poses, time)
            self._mean = [0.5 * (was + b[here]) for was, b in zip(before, (self.bu, self.bv), strict=True)]
        multigrid.coarsen(self._store, self._layout)
        poisson.place_window(self._layout, new)
        self._patches = patch.rects(self._layout)
        self._room = patch.room_for(self._room, self._patches)
        multigrid.spread(self._store, self._layout, self._room, self._patches)

    def _clear(self, window: Window) -> None:
        j0, j1, i0, i1 = window
        here = np.s_[j0 : j1 + 1, i0 : i1 + 1]
        for share in (*self.mu0, *self.passage):
            share[here] = 1
        for a in (self.bu, self.bv, self._mu1xx, self._mu1xy, self._mu1yx, self._mu1yy, self._source):
            a[here] = 0

    def _measure(self, bodies: list[AnyBody], poses: list[Pose], time: float) -> None:
        j0, j1, i0, i1 = self.window
        h, grid = self.grid.cell, self.grid
        here = np.s_[j0 : j1 + 1, i0 : i1 + 1]
        x_face, y_face = grid.faces(i0, i1 + 1, 0), grid.faces(j0, j1 + 1, 1)
        x_mid, y_mid = grid.centres(i0, i1 + 1, 0), grid.centres(j0, j1 + 1, 1)
        mu0_u, mu0_v = self.mu0
        for k, (x, y, mu0, mu1_x, mu1_y) in enumerate(
            ((x_face, y_mid, mu0_u, self._mu1xx, self._mu1xy), (x_mid, y_face, mu0_v, self._mu1yx, self._mu1yy))
        ):
            f, self.owners[k] = measure_all(bodies, poses, x, y, time, h)
            near, thickness = f.distance / h - self.offset, f.thickness / h + 2 * self.offset
            fill(near, f.normal_x, f.normal_y, thickness, mu0[here], mu1_x[here], mu1_y[here])
            (self.bu, self.bv)[k][here] = (f.velocity_x, f.velocity_y)[k]
            self.passage[k][here] = mu0[here]
        for sheet in [b.shape.sheet(time, p) for b, p in zip(bodies, poses, strict=True)]:
            if sheet is not None:
                close(self.passage[0][here], sheet[0], sheet[1], x_mid[0] - h, y_mid[0], h)
                close(self.passage[1][here].T, sheet[1], sheet[0], y_mid[0] - h, x_mid[0], h)
        fill_source(self._source, self.bu, self.bv, mu0_u, mu0_v, np.array(self.window))

    def fastest(self) -> float:
        """Return the largest |u| + |v| [m/s]."""
        fastest(self.u, self.v, self._sums)
        return float(self._sums[PAD:-PAD, 0].max())

    def step(
        self, dt: float, stream: tuple[float, float], push: tuple[float, float], limits: tuple[float, float]
    ) -> None:
        """Advance velocity and pressure by ``dt`` [s] around the bodies placed at its end.

        Args:
            dt: time step [s].
            stream: velocity of the far water at the end of the step [m/s].
            push: uniform acceleration of the water [m/s^2].
            limits: mean and largest divergence that may be left [m/s per cell].

        On return the velocity is divergence-free to ``limits`` outside the bodies and fits the sides.
        """
        real, h = self.dtype, self.grid.cell
        step = real(dt / h)
        force = (real(push[0] * h), real(push[1] * h))
        first = self.border.steps == 0 and self.border.water is not None
        start = self.p.copy() if first else self.p
        self.border.prepare(self.u, self.v, self.window, float(step), stream)
        self._heun(step, force, limits)
        if first:  # a body that starts at once moves the far water at once
            for _ in range(MOST_ROUNDS):
                if self.border.settle(self._u2, self._v2, self.window) <= limits[1]:
                    break
                self.p[:] = start
                self._heun(step, force, limits)
        (self.u, self.v), (self._u2, self._v2) = (self._u2, self._v2), (self.u, self.v)

    def _heun(self, step: float, force: tuple[float, float], limits: tuple[float, float]) -> None:
        """Take a step of Heun's method: predict, project, correct, project.

        On return the second pair of fields, ``_u2`` and ``_v2``, is the velocity at the step's end, ``p`` its pressure,
        and ``given`` what the immersion gave to the water.
        """
        self.solves = []
        self.given[:] = 0
        now, predicted, corrected = (self.u, self.v), (self._u1, self._v1), (self._u2, self._v2)
        half = self.dtype(0.5)
        self._predict(predicted, now, step, force)
        self._project(predicted, step, limits)
        self._collect(predicted, now, step, self.dtype(0))
        self.border.settle(*predicted, self.window)
        self._correct(corrected, now, predicted, step, force)
        self._project(corrected, half * step, limits)
        self._collect(corrected, predicted, step, half)

    def _predict(self, out: Vector, now: Vector, step: float, force: tuple[float, float]) -> None:
        """On return ``out`` is Euler's step from ``now``, immersed, before its divergence is projected out."""
        self._advance(out, now, now, now, step, force, self.dtype(0))

    def _correct(self, out: Vector, now: Vector, predicted: Vector, step: float, force: tuple[float, float]) -> None:
        """On return ``out`` is the mean of ``predicted`` and of a step from ``now`` with its rates, immersed."""
        self._advance(out, predicted, now, predicted, step, force, self.dtype(0.5))

    def _advance(self, out, blend, base, rate, dt, push, keep) -> None:  # type: ignore[no-untyped-def]
        """On return ``out = keep blend + (1 - keep) B[base + dt (f(rate) + push) - dt grad p]``, B the immersion."""
        window = np.array(self.window)
        advance(
            out[0], out[1], blend[0], blend[1], base[0], base[1], rate[0], rate[1], self.p, self._raw_u, self._raw_v,
            window, self.sides.repeats, dt, self.nu, push, keep,
        )  # fmt: skip
        if window[1] > window[0]:
            kernels = (self.bu, self._mu1xx, self._mu1xy), (self.bv, self._mu1yx, self._mu1yy)
            for k, (raw, (b, mu1_x, mu1_y)) in enumerate(zip((self._raw_u, self._raw_v), kernels, strict=True)):
                immerse(
                    out[k], blend[k], raw, b, self.mu0[k], self.passage[k], mu1_x, mu1_y, self.p, k, window, dt, keep
                )
        self.border.fill(*out)

    def _collect(self, out, blend, dt, keep) -> None:  # type: ignore[no-untyped-def]
        """Add half of what the immersion gave in this stage: the step is the mean of its two stages."""
        window = np.array(self.window)
        if window[1] <= window[0]:
            return
        dt, keep = float(dt), float(keep)
        sums = np.zeros_like(self.given)
        for k, (raw, passage, mu1_x, mu1_y) in enumerate(
            (
                (self._raw_u, self.passage[0], self._mu1xx, self._mu1xy),
                (self._raw_v, self.passage[1], self._mu1yx, self._mu1yy),
            )
        ):
            collect(
                sums, out[k], blend[k], raw, self._mean[k], passage, mu1_x, mu1_y, self.p, self.owners[k], k, window,
                dt, keep,
            )  # fmt: skip
        swelling(sums, self.p, self._source, self.owners[0], window, dt)
        self.given += 0.5 * sums

    def contents(self) -> np.ndarray:
        """Return what the region of each placed body holds, shape (body, 7); see ``exchange.contents``."""
        sums = np.zeros((len(self.given), CONTENTS))
        window = np.array(self.window)
        if window[1] > window[0]:
            mu0_u, mu0_v = self.mu0
            contents(sums, self.bu, mu0_u, self.owners[0], 0, window)
            contents(sums, self.bv, mu0_v, self.owners[1], 1, window)
        return sums

    def _project(self, velocity: Vector, dt: float, limits: tuple[float, float]) -> None:
        """On return the divergence of ``velocity`` is that of the bodies, to ``limits``; ``p`` has what that took."""
        window = np.array(self.window)
        r = self._part(multigrid.B)
        mean = mean_residual(*velocity, self._source, window)
        residual(
            r, *velocity, self._source, self._part(multigrid.DINV), window, self.dtype(mean), self.sides.repeats[0],
            self._sums,
        )  # fmt: skip
        sums = self._sums[PAD:-PAD]
        cells = self.grid.cells[0] * self.grid.cells[1]
        went = poisson.Solve(0, float(sums[:, 0].sum()) / cells, float(sums[:, 1].max()))
        if went.mean > SKIPPED * limits[0] or went.largest > SKIPPED * limits[1]:
            went, parts = self._solve(limits)
            x, gain = (self._d, self._part(multigrid.X)), self.dtype(1 / dt)
            correct(*velocity, self.p, *x, *parts, *self.passage, window, gain)
            for seal, axis in ((self.p, 0), (self.p.T, 1)):
                seal_ends(seal, self.sides.repeats[1 - axis])
            self.border.fill(*velocity)
        self.solves.append(went)

    def potential(self, u: np.ndarray, v: np.ndarray, limit: float) -> np.ndarray:
        """Return the pressure that answers a body acceleration given on the faces of the window.

        The result is a work array: use it before the next call.

        Raises:
            NotConverged: the pressure solver got stuck.
        """
        j0, j1, i0, i1 = self.window
        r = self._part(multigrid.B)
        r[:] = 0
        r[j0:j1, i0:i1] = (u[:-1, :-1] - u[:-1, 1:]) + (v[:-1, :-1] - v[1:, :-1])
        r[self._part(multigrid.DINV) == 0] = 0
        _, (a, b) = self._solve((limit, 10 * limit))
        np.multiply(self._d, a, out=self._x)
        self._x += b * self._part(multigrid.X)
        return self._x

    def along_sides(self, x: np.ndarray) -> list[np.ndarray]:
        """Return the values of the cells along each side: left, right, bottom, top."""
        a, b = PAD, -PAD
        return [x[a:b, a], x[a:b, b - 1], x[a, a:b], x[b - 1, a:b]]

    def answer(self, u: np.ndarray, v: np.ndarray) -> list[np.ndarray]:
        """Return the acceleration into the domain that ``potential``'s last answer induces on each side [m/s^2].

        Takes what ``potential`` took. Empty if the domain is not in water without end.
        """
        if self.border.water is None:
            return []
        j0, j1, i0, i1 = self.window
        here, x = np.s_[j0 : j1 + 1, i0 : i1 + 1], self._x
        for work, passage, given, axis in ((self._raw_u, self.passage[0], u, 1), (self._raw_v, self.passage[1], v, 0)):
            work[(np.s_[:], np.s_[1:])[:: axis * 2 - 1]] = -np.diff(x, axis=axis)
            work[here] = given + passage[here] * work[here]
        sides = self.border.water.inward(self._raw_u, self._raw_v, self.window, [])
        level = sum(float(s.sum()) for s in sides) / sum(s.size for s in sides)
        return [s - level for s in sides]

    def _solve(self, limits: tuple[float, float]) -> tuple[poisson.Solve, tuple[float, float]]:
        """Return how the solve went, and what the solution is made of; see ``poisson.solve``."""
        *told, a, b = poisson.solve(
            self._x, self._d, self._q, self._store, self._layout, self._room, self._patches, self.sides.repeats,
            self._sums, *limits, MOST_CYCLES,
        )  # fmt: skip
        went = poisson.Solve(*told)
        if not (went.mean <= STUCK * limits[0] and went.largest <= STUCK * limits[1]):
            raise NotConverged(
                f"the pressure solver stopped after {went.cycles} cycles with a divergence of {went.mean:.2g} m/s per "
                f"cell on the average and {went.largest:.2g} at most, where {limits[0]:.2g} and {limits[1]:.2g} are "
                f"allowed; take a larger tolerance, or precision='double'."
            )
        return went, (self.dtype(a), self.dtype(b))

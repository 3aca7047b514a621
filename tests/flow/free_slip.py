"""A study, not a part of the package: bodies along which the water slips, friction left to a law.

The water's own velocity w is kept near and in the bodies, and what the equations project is its blend with theirs,
``u = a w + (1 - a) V`` with the share a of each face that is wet, taken as if the wall were a plane there. The pressure
acts on the same share (Ng, Min and Gibou 2009, J. Comput. Phys. 228, 8807-8829), so that it holds the water off the
wall and nothing else does. After each stage w is found again: from u where at least half of a face is wet, elsewhere
carried on along the normal from ``OUT`` cells off the wall, its part along the wall as it is there and that along the
normal straight through the wall's own. Beside cut faces w has a divergence; advection there is u grad u, not
div(u u), or the water gains energy at the wall.

``slipping()`` makes simulations take this water within a ``with``.
"""

from contextlib import contextmanager
from unittest.mock import patch

import numba
import numpy as np

from suchus import flow
from suchus.flow import simulation
from suchus.flow.advect import advance
from suchus.flow.body import measure_all
from suchus.flow.compiled import PAD
from suchus.flow.immerse import MIN_FLUID_FRACTION, fill_source, immerse
from suchus.flow.momentum import add_immersion_impulse, dilatation_work
from suchus.flow.water import MAX_FIRST_STEP_ROUNDS, Fluid, PlannedStage

OUT = 1.5
"""Distance from the wall from which the velocity is carried into the body: all its neighbours are wet [cells]."""

DEEP = 4.0
"""Depth from which the body's velocity stands in the body [cells]."""

HALF = 0.5
"""Wet share of a face from which its velocity is the water's own [-]."""


def wet_share(distance, along):
    """Return the wet share of a face ``distance`` cells off a plane; ``along`` has its normal's sizes in the face."""
    if len(along) == 1:
        return np.clip(0.5 + distance / np.maximum(along[0], 1e-6), 0, 1)
    a, b = np.maximum(along, 1e-3)
    corners = ((1, a + b), (-1, a - b), (-1, b - a), (1, -a - b))
    square = sum(sign * np.maximum(distance + 0.5 * off, 0) ** 2 for sign, off in corners)
    return np.clip(square / (2 * a * b), 0, 1)


@numba.njit
def _unblend(u, wet, b, first):
    for c in range(b.shape[0]):
        for k in range(b.shape[1]):
            for j in range(b.shape[2]):
                for i in range(b.shape[3]):
                    z, y, x = k + first[0], j + first[1], i + first[2]
                    a = wet[c, z, y, x]
                    if HALF <= a < 1:
                        u[c, z, y, x] = (u[c, z, y, x] - (1 - a) * b[c, k, j, i]) / a


@numba.njit
def _sample(u, wet, c, x, y, z):
    """Return one component between the wet faces around a point in padded cells, and how much of them is wet."""
    x, y, z = x - 0.5 * (c != 0), y - 0.5 * (c != 1), z - 0.5 * (c != 2)
    planes = min(u.shape[1], 2)
    i, j, k = int(np.floor(x)), int(np.floor(y)), int(np.floor(z)) if planes == 2 else 0
    fx, fy, fz = x - i, y - j, z - k if planes == 2 else 0.0
    total, weight = 0.0, 0.0
    for n in range(4 * planes):
        p, q, r = n % 2, n // 2 % 2, n // 4
        part = (fx if p else 1 - fx) * (fy if q else 1 - fy) * (fz if r else 1 - fz)
        inside = 0 <= i + p < u.shape[3] and 0 <= j + q < u.shape[2] and 0 <= k + r < u.shape[1]
        if part > 0 and inside and wet[c, k + r, j + q, i + p] >= HALF:
            total += part * u[c, k + r, j + q, i + p]
            weight += part
    return (total / weight if weight > 0.05 else 0.0), weight


@numba.njit
def _extend(u, wet, b, distance, normal, first):
    """Carry the velocity on into the bodies; only wet faces are read, and only the others are written."""
    axes, slip, n = b.shape[0], np.zeros(3), np.zeros(3)
    for c in range(axes):
        for k in range(b.shape[1]):
            for j in range(b.shape[2]):
                for i in range(b.shape[3]):
                    z, y, x = k + first[0], j + first[1], i + first[2]
                    if wet[c, z, y, x] >= HALF:
                        continue
                    d, known, through = distance[c, k, j, i], distance[c, k, j, i] > -DEEP, 0.0
                    for e in range(axes):
                        n[e] = normal[c, e, k, j, i]
                    px, py, pz = x + 0.5 * (c != 0), y + 0.5 * (c != 1), z + 0.5 * (c != 2)
                    for e in range(axes):
                        s = OUT - d
                        value, weight = _sample(u, wet, e, px + s * n[0], py + s * n[1], pz + s * n[2])
                        known = known and weight > 0.05
                        slip[e] = value - b[e, k, j, i]
                        through += slip[e] * n[e]
                    own = b[c, k, j, i]
                    u[c, z, y, x] = own + slip[c] + n[c] * through * (d / OUT - 1) if known else own


@numba.njit
def _leave_divergence(raw, w, first, dt):
    """Take ``w div w`` out of the divergence of ``w w``."""
    axes = raw.shape[0]
    for c in range(axes):
        p, q, r = c == 2, c == 1, c == 0
        for k in range(raw.shape[1] - (axes == 3)):
            for j in range(raw.shape[2] - 1):
                for i in range(raw.shape[3] - 1):
                    z, y, x, net = k + first[0], j + first[1], i + first[2], 0.0
                    for d in range(axes):
                        f, g, h = d == 2, d == 1, d == 0
                        net += w[d, z + f, y + g, x + h] + w[d, z + f - p, y + g - q, x + h - r]
                        net -= w[d, z, y, x] + w[d, z - p, y - q, x - r]
                    raw[c, k, j, i] += 0.5 * dt * w[c, z, y, x] * net


class SlipWater(Fluid):
    """``Fluid`` whose bodies only keep the water out; ``velocity`` is w between the steps."""

    _blended = None  # u of ``velocity``
    _distance = _normal = _bare = None

    def _measure(self, bodies, poses, time):
        self.offset, here, h = 0.0, self._window_slices(self.window), self.grid.cell
        ends = [(s.start, s.stop) for s in reversed(here)]
        self._distance = np.empty(self.b.shape, self.dtype)
        self._normal = np.empty((self.ndim, *self.b.shape), self.dtype)
        self.mu1[:] = 0
        for c in range(self.ndim):
            points = [(self.grid.faces if c == d else self.grid.centres)(*ends[d], d) for d in range(self.ndim)]
            f, self.owners[c], _ = measure_all(bodies, poses, points, time, h)
            near, far = f.distance / h, -(f.thickness + f.distance) / h
            along = np.delete(np.abs(np.stack(f.normal)), c, axis=0)
            share = np.clip(wet_share(near, along) + wet_share(far, along), MIN_FLUID_FRACTION, 1)
            self.mu0[c][here] = self.passage[c][here] = share
            self.b[c], self._distance[c], self._normal[c] = f.velocity[c], near, np.stack(f.normal)
        source, b, mu0 = (self._flat(a) for a in (self.source, self.b, self.mu0))
        fill_source(source, b, mu0, self._layout[0], self._near_layout, self.inner)

    def _in_space(self, a, ahead):
        """Return an array of the grid or window with a third axis, one plane thick where there are two."""
        return a if self.ndim == 3 else a.reshape(*a.shape[:ahead], 1, *a.shape[ahead:])

    @property
    def _first(self):
        return np.array((*(0,) * (3 - self.ndim), *self.window[::2]))

    def _unblended(self, u):
        """Turn u into w."""
        if self.window[1] > self.window[0]:
            w, wet, b, distance = (self._in_space(a, 1) for a in (u, self.mu0, self.b, self._distance))
            _unblend(w, wet, b, self._first)
            _extend(w, wet, b, distance, self._in_space(self._normal, 2), self._first)
            self.border.fill(u)

    def step(self, dt, stream, push, limits, time=0.0):
        real, h = self.dtype, self.grid.cell
        step, force = real(dt / h), tuple(real(part * h) for part in push)
        first = self.border.steps == 0 and self.border.water is not None
        start = self.p.copy()
        if self._blended is None:
            self._blended = self.velocity.copy()
        self.border.prepare(self._blended, self.window, float(step), stream, time)
        self._stages(step, force, limits)
        rounds = 0
        while (
            first
            and rounds < MAX_FIRST_STEP_ROUNDS
            and self.border.update_induced(self._corrected, self.window) > limits[1]
        ):
            self.p[:] = start
            self._stages(step, force, limits)
            rounds += 1
        self._blended = self._corrected.copy()
        self._unblended(self._corrected)
        self.velocity, self._corrected = self._corrected, self.velocity

    def _stages(self, step, push, limits):
        self.solves, half, now = [], self.dtype(0.5), self.velocity
        self.immersion_sums[:] = 0
        stage = PlannedStage(self._predicted, now, now, now, self.dtype(0), step)
        self._advance(stage, push)
        self._project(self._predicted, step, limits)
        self._collect(stage, 0.5)
        self.border.update_induced(self._predicted, self.window)
        predicted = self._predicted.copy()
        self._unblended(self._predicted)
        stage = PlannedStage(self._corrected, predicted, now, self._predicted, half, step)
        self._advance(stage, push)
        self._project(self._corrected, half * step, limits)
        self._collect(stage, 0.5)

    def _advance(self, stage, push):
        out, blend, base, rate = (self._flat(a) for a in stage[:4])
        place, raw, p, step = self._layout[0], self._flat(self._raw), self._flat(self.p), stage.dt
        advance(
            out,
            blend,
            base,
            rate,
            p,
            raw,
            place,
            self._near_layout,
            self.inner,
            self.repeats,
            step,
            self.nu,
            push,
            stage.blend_fraction,
        )
        if self.window[1] > self.window[0]:
            here = self.window_slices
            self._bare = self._raw - (stage.base[:, *here] - self._blended[:, *here])
            _leave_divergence(self._in_space(self._raw, 1), self._in_space(stage.rate, 1), self._first, step)
            self._extend_raw()
            b, mu0, mu1, passage = (self._flat(a) for a in (self.b, self.mu0, self.mu1, self.passage))
            immerse(
                out, blend, raw, b, mu0, passage, mu1, p, self._near_layout, self.inner, step, stage.blend_fraction
            )  # fmt: skip
        self.border.fill(stage.result)

    def _collect(self, stage, weight):
        """Add up all that the window's momentum gains otherwise than by fluxes through its sides."""
        if self.window[1] <= self.window[0]:
            return
        dt, keep, near, inner = float(stage.dt), float(stage.blend_fraction), self._near_layout, self.inner
        sums, p, everywhere = (
            np.zeros_like(self.immersion_sums),
            self._flat(self.p),
            np.zeros_like(self._flat(self.mu0)),
        )
        out, blend, bare, mu1 = (self._flat(a) for a in (stage.result, stage.blend, self._bare, self.mu1))
        owners = self._flat(self.owners)
        add_immersion_impulse(
            sums, out, blend, bare, self._flat(self.mean), everywhere, mu1, p, owners, near, inner, dt, keep
        )  # fmt: skip
        dilatation_work(sums, p, self._flat(self.source), owners, near, inner, dt)
        self.immersion_sums += weight * sums


class SlipSetup(flow.Setup):
    """A set-up whose bodies have no layer that a grid would have to carry."""

    __slots__ = ()

    def layer_error(self, *_, **__):
        return 0.0


@contextmanager
def slipping():
    """Let simulations that are made here slip along their bodies, whatever the layer that a grid would carry."""
    with patch.object(simulation, "Fluid", SlipWater), patch.object(flow, "Setup", SlipSetup):
        yield


def sampled(field, points, grid, faces=None):
    """Return a field of a grid in space at points (3, point) [m]; ``faces`` is the axis of a velocity."""
    at = [
        (p - o) / grid.cell + PAD - 0.5 * (d != faces) for d, (p, o) in enumerate(zip(points, grid.origin, strict=True))
    ]
    low = [np.floor(a).astype(int) for a in at]
    total = np.zeros(points.shape[1])
    for n in range(8):
        ends = [(n >> d) & 1 for d in range(3)]
        weight = np.prod([np.where(e, a - b, 1 - a + b) for e, a, b in zip(ends, at, low, strict=True)], axis=0)
        i, j, k = (b + e for b, e in zip(low, ends, strict=True))
        total += weight * field[k, j, i]
    return total

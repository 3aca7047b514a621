# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision and number of dimensions)
"""Forces on bodies from the momentum that the immersion itself exchanges with the water.

In each step the immersion changes the momentum of the cells in and around a body by a known amount. What of it does
not go into the momentum of the region that the body fills is what the body gives to the water: the balance of the
discrete equations is exact, whatever the wall looks like between the nodes. Angular momentum gives the torque and
energy the power in the same way. The immersion holds a skin ``wall_offset`` thick with the body; it counts as water.
With it as a part of the body the torque of a turning cylinder is 6 % off at 32 cells a diameter, without 0.8 %. (The
inertia of a translating one, whose skin also keeps the water away, comes out 2 to 3 % too large.)
"""

from dataclasses import dataclass

import numpy as np

from suchus.flow.compiled import PAD, compiled, signed
from suchus.flow.shape import Markers
from suchus.flow.slab import row_length
from suchus.flow.solid import Skin


def sums_of(axes: int) -> int:
    """Return how many sums are kept per body: momentum, angular momentum about z, energy."""
    return axes + 2


def contents_of(axes: int) -> int:
    """Return how much is kept of a body's region: the sums of its motion, its volume and its first moments."""
    return 2 * axes + 3


@compiled
def collect(sums, out, blend, raw, mean, passage, mu1, p, owner, component, place, inner, dt, keep):
    """Add to ``sums`` (body, ``sums_of``) what the immersion gave to one component of the velocity in one stage.

    ``mean`` is the body's velocity in the window, mean of the step's start and end: with that of the end alone the
    power is too large by half the work of the added mass in a step. The sums are of m/s per cell; lengths for the
    moments are in cells from the grid's corner. ``mean``, ``raw``, ``mu1`` and ``owner`` are arrays of the window; see
    ``slab``.
    """
    up, w = len(inner), len(inner) + 2
    wide, columns = signed(row_length(inner, p.shape[1])), place[3 * up + 3] - place[3 * up + 2] + 1
    r0, r1 = (place[w + 2], place[w + 3]) if up > 1 else (-1, 2)
    c0, c1 = place[3 * up + 2], place[3 * up + 3]
    for j in range(place[w] + 1, place[w + 1] - 1):
        for row in range(r0 + 1, r1 - 1):
            for i in range(c0 + 1, c1 - 1):
                k = row * wide + i
                at = (row - r0) * columns + i - c0 if up > 1 else i - c0
                touched = passage[j, k] < 1
                for d in range(up + 1):
                    touched = touched or mu1[d, j - place[w], at] != 0
                if not touched:
                    continue
                before = p[j - 1, k]
                for d in range(up):
                    before = p[j, k - signed(inner[d])] if component == d else before
                rise = np.float64(p[j, k]) - before
                moved = (np.float64(out[j, k]) - keep * np.float64(blend[j, k])) / (1.0 - keep)
                given = moved - raw[j - place[w], at] + dt * rise
                m, y = owner[j - place[w], at], (row if up > 1 else j) - PAD + 0.5
                sums[m, component] += given
                if component == 0:
                    sums[m, up + 1] += -y * given
                elif component == 1:
                    sums[m, up + 1] += (i - PAD + 0.5) * given
                sums[m, up + 2] += mean[j - place[w], at] * given


@compiled
def dilatation_work(sums, p, source, owner, place, inner, dt):
    """Take from the energy what the pressure does on the divergence of the bodies' own motion inside them."""
    up, w = len(inner), len(inner) + 2
    wide, columns = signed(row_length(inner, p.shape[1])), place[3 * up + 3] - place[3 * up + 2] + 1
    r0, r1 = (place[w + 2], place[w + 3]) if up > 1 else (0, 1)
    c0, c1 = place[3 * up + 2], place[3 * up + 3]
    for j in range(place[w], place[w + 1]):
        for row in range(r0, r1):
            for i in range(c0, c1):
                o, at = j - place[w], (row - r0) * columns + i - c0
                if source[o, at] != 0:
                    sums[owner[o, at], up + 2] += dt * np.float64(p[j, row * wide + i]) * source[o, at]


@compiled
def contents(sums, b, mu0, owner, component, place, near, inner):
    """Add to ``sums`` (body, ``contents_of``) what the region of each body holds of one component of the velocity.

    Columns: the sums of its motion, its volume and first moments [m/s, m^2/s^2, cells]. What lies in the window of
    ``place`` counts; ``b`` and ``owner`` are arrays of the window ``near``.
    """
    up, w = len(inner), len(inner) + 2
    wide, columns = signed(row_length(inner, mu0.shape[1])), near[3 * up + 3] - near[3 * up + 2] + 1
    n0, n1 = near[w + 2] if up > 1 else 0, near[3 * up + 2]
    r0, r1 = (place[w + 2], place[w + 3]) if up > 1 else (0, 1)
    c0, c1 = place[3 * up + 2], place[3 * up + 3]
    axes = up + 1
    for j in range(place[w], place[w + 1]):
        for row in range(r0, r1):
            for i in range(c0, c1):
                k = row * wide + i
                share = 1.0 - np.float64(mu0[j, k])
                if share == 0.0:
                    continue
                o, at = j - near[w], (row - n0) * columns + i - n1
                m = owner[o, at]
                x = i - PAD + (0.0 if component == 0 else 0.5)
                y = (row if up > 1 else j) - PAD + (0.0 if component == 1 else 0.5)
                held, part_of = share * b[o, at], share / axes
                sums[m, component] += held
                if component == 0:
                    sums[m, axes] += -y * held
                elif component == 1:
                    sums[m, axes] += x * held
                sums[m, axes + 1] += 0.5 * held * b[o, at]
                sums[m, axes + 2] += part_of
                sums[m, axes + 3] += part_of * x
                sums[m, axes + 4] += part_of * y
                if up > 1:
                    sums[m, axes + 5] += part_of * (j - PAD + (0.0 if component == 2 else 0.5))


def skin(markers: Markers | Skin, offset: float, origin: tuple[float, ...], h: float) -> np.ndarray:
    """Return what ``contents`` counts too much: the skin ``offset`` cells thick, which is water, (``contents_of``,)."""
    axes = len(origin)
    w = offset * markers.share / h ** (axes - 1)
    place = [(p - start) / h for p, start in zip(markers.points, origin, strict=True)]
    v = markers.velocities
    square = v[0] ** 2 + v[1] ** 2
    if axes == 3:
        square = square + v[2] ** 2
    columns = (*v, place[0] * v[1] - place[1] * v[0], 0.5 * square, np.ones(w.size), *place)
    return np.array([(w * column).sum() for column in columns])


@dataclass(frozen=True, slots=True, kw_only=True)
class Reaction:
    """What the water does to a body, mean over a step; in the plane per metre of depth."""

    force: tuple[float, ...]
    """Force (x, y) or (x, y, z) [N/m, N]."""
    torque: float
    """Torque about the z axis through the asked point, counter-clockwise [N, N m]."""
    power: float
    """Power that the body's surface gives to the water, in the frame of the grid [W/m, W]."""

    def whole(self, cut: tuple[bool, ...]) -> "Reaction":
        """Return that of the whole body, of which this is the part between the mirrors that cut it; see ``body.cuts``.

        Forces through a mirror, and a torque about an axis in it, vanish.
        """
        times, across = 2 ** sum(cut), [low or high for low, high in zip(cut[::2], cut[1::2], strict=True)]
        return Reaction(
            force=tuple(0.0 if off else times * part for part, off in zip(self.force, across, strict=True)),
            torque=0.0 if any(across[:2]) else times * self.torque, power=times * self.power,
        )  # fmt: skip


def reaction(
    given: np.ndarray, before: np.ndarray, now: np.ndarray, *, dt: float, push: tuple[float, ...], about: np.ndarray,
    origin: tuple[float, ...], h: float, density: float,
) -> Reaction:  # fmt: skip
    """Return the water's action on one body over a step.

    Args:
        given: what the immersion gave over the step, shape (``sums_of``,) [m/s and so on].
        before: contents of the body's region at the start of the step, shape (``contents_of``,).
        now: the same at its end.
        dt: the step [s].
        push: uniform acceleration of the water [m/s^2].
        about: point of the torque, in the frame of the grid [m].
        origin: corner of the grid [m].
        h: cell [m].
        density: of the water [kg/m^3].
    """
    axes = len(origin)
    change, middle = now[: axes + 2] - before[: axes + 2], 0.5 * (now + before)
    cx, cy = ((about - np.array(origin)) / h)[:2]
    size, sx, sy = middle[axes + 2 : axes + 5]
    force = (change[:axes] - given[:axes]) / dt - size * np.array(push)
    torque = (change[axes] - given[axes]) / dt - (sx * push[1] - sy * push[0]) - (cx * force[1] - cy * force[0])
    power, scale = (given[axes + 1] - change[axes + 1]) / dt, density
    for part, momentum in zip(push, middle, strict=False):
        power += part * momentum
        scale *= h
    return Reaction(force=tuple(scale * part for part in force), torque=scale * h * torque, power=scale * power)

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

from suchus.flow.compiled import PAD, compiled, part, signed
from suchus.flow.markers import Markers
from suchus.flow.pose import TURNS
from suchus.flow.slab import row_length


def sums_of(axes: int) -> int:
    """Return how many sums are kept per body: momentum, angular momentum (in the plane that about z), energy."""
    return axes + len(TURNS[axes]) + 1


def contents_of(axes: int) -> int:
    """Return how much is kept of a body's region: the sums of its motion, its volume and its first moments."""
    return sums_of(axes) + 1 + axes


@part
def _about_z(up):
    """Return where the angular momentum about z is kept; those about x and y, in space, stand before it."""
    return up + 1 if up == 1 else up + 3


@part
def _tilt(sums, m, component, x, y, z, given):
    """Add the angular momentum about x and about y that a component of a momentum has at a place in space."""
    if component == 0:
        sums[m, 4] += z * given
    elif component == 1:
        sums[m, 3] += -z * given
    else:
        sums[m, 3] += y * given
        sums[m, 4] += -x * given


@compiled
def collect(sums, out, blend, raw, mean, passage, mu1, p, owner, component, place, inner, dt, keep):
    """Add to ``sums`` (body, ``sums_of``) what the immersion gave to one component of the velocity in one stage.

    ``mean`` is the body's velocity in the window, mean of the step's start and end: with that of the end alone the
    power is too large by half the work of the added mass in a step. The sums are of m/s per cell; lengths for the
    moments are in cells from the grid's corner. ``mean``, ``raw``, ``mu1`` and ``owner`` are arrays of the window; see
    ``slab``.
    """
    up, w, turn = len(inner), len(inner) + 2, _about_z(len(inner))
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
                    sums[m, turn] += -y * given
                elif component == 1:
                    sums[m, turn] += (i - PAD + 0.5) * given
                if up > 1:
                    _tilt(sums, m, component, i - PAD + 0.5, y, j - PAD + 0.5, given)
                sums[m, turn + 1] += mean[j - place[w], at] * given


@part
def _to_owners(sums, column, owners, o, at, columns, done):
    """Add what is done in a cell to the parts that own its faces, to each by as many of these as it has."""
    axes = len(owners)
    share = done / (2 * axes)
    for d in range(axes):
        behind, beside = (1 if d == axes - 1 else 0), (0 if d == axes - 1 else 1 if d == 0 else columns)
        sums[owners[d, o, at], column] += share
        sums[owners[d, o + behind, at + beside], column] += share


@compiled
def dilatation_work(sums, p, source, owners, place, inner, dt):
    """Take from the energy what the pressure does on the divergence of the bodies' own motion inside them."""
    up, w, turn = len(inner), len(inner) + 2, _about_z(len(inner))
    wide, columns = signed(row_length(inner, p.shape[1])), place[3 * up + 3] - place[3 * up + 2] + 1
    r0, r1 = (place[w + 2], place[w + 3]) if up > 1 else (0, 1)
    c0, c1 = place[3 * up + 2], place[3 * up + 3]
    for j in range(place[w], place[w + 1]):
        for row in range(r0, r1):
            for i in range(c0, c1):
                o, at = j - place[w], (row - r0) * columns + i - c0
                if source[o, at] != 0:
                    done = dt * np.float64(p[j, row * wide + i]) * source[o, at]
                    _to_owners(sums, turn + 1, owners, o, at, columns, done)


@compiled
def pressed(sums, p, mu0, owners, place, near, inner, weight):
    """Add to ``sums`` (body, 1 + axes) what the pressure does inside the region of each body, times a weight.

    Columns: the pressure summed over its cells, each by the body's share, and its first moments from the grid's corner
    [.., .. cells]. What lies in the window of ``place`` counts; ``owners``, one for each axis, are arrays of the window
    ``near``.
    """
    up, w = len(inner), len(inner) + 2
    wide, columns = signed(row_length(inner, p.shape[1])), near[3 * up + 3] - near[3 * up + 2] + 1
    n0, n1 = near[w + 2] if up > 1 else 0, near[3 * up + 2]
    r0, r1 = (place[w + 2], place[w + 3]) if up > 1 else (0, 1)
    c0, c1 = place[3 * up + 2], place[3 * up + 3]
    for j in range(place[w], place[w + 1]):
        for row in range(r0, r1):
            for i in range(c0, c1):
                k = row * wide + i
                wet = np.float64(mu0[up, j, k]) + mu0[up, j + 1, k]
                for d in range(up):
                    wet += np.float64(mu0[d, j, k]) + mu0[d, j, k + signed(inner[d])]
                share = 1.0 - wet / (2 * up + 2)
                if share <= 0.0:
                    continue
                o, at = j - near[w], (row - n0) * columns + i - n1
                done = weight * share * np.float64(p[j, k])
                _to_owners(sums, 0, owners, o, at, columns, done)
                _to_owners(sums, 1, owners, o, at, columns, done * (i - PAD + 0.5))
                _to_owners(sums, 2, owners, o, at, columns, done * ((row if up > 1 else j) - PAD + 0.5))
                if up > 1:
                    _to_owners(sums, 3, owners, o, at, columns, done * (j - PAD + 0.5))


@compiled
def parted(sums, p, mu0, owners, place, near, inner, weight):
    """Take from ``sums`` (body, ``sums_of``) what the pressure inside bodies does across joints of their links.

    A body has no pressure inside. Where a cell's two faces across an axis belong to two links, the pressure that
    stands there pushes these apart: it cancels in their sum, and works where they turn against each other. By the
    share of the cell in the body this is what ``dilatation_work`` takes from the power. In space only; see ``pressed``.
    """
    w = len(inner) + 2
    wide, columns = signed(row_length(inner, p.shape[1])), near[9] - near[8] + 1
    n0, n1 = near[w + 2], near[8]
    for j in range(place[w], place[w + 1]):
        for row in range(place[w + 2], place[w + 3]):
            for i in range(place[8], place[9]):
                o, at = j - near[w], (row - n0) * columns + i - n1
                left, right = owners[0, o, at], owners[0, o, at + 1]
                before, behind = owners[1, o, at], owners[1, o, at + columns]
                low, high = owners[2, o, at], owners[2, o + 1, at]
                if left == right and before == behind and low == high:
                    continue
                k = row * wide + i
                wet = np.float64(mu0[2, j, k]) + mu0[2, j + 1, k]
                for d in range(2):
                    wet += np.float64(mu0[d, j, k]) + mu0[d, j, k + signed(inner[d])]
                share = 1.0 - wet / 6
                if share <= 0.0:
                    continue
                push = weight * share * np.float64(p[j, k])
                x, y, z = i - PAD + 0.5, row - PAD + 0.5, j - PAD + 0.5
                for m, way in ((left, -push), (right, push)):
                    sums[m, 0] += way
                    sums[m, 4] += z * way
                    sums[m, 5] += -y * way
                for m, way in ((before, -push), (behind, push)):
                    sums[m, 1] += way
                    sums[m, 3] += -z * way
                    sums[m, 5] += x * way
                for m, way in ((low, -push), (high, push)):
                    sums[m, 2] += way
                    sums[m, 3] += y * way
                    sums[m, 4] += -x * way


@compiled
def contents(sums, b, mu0, owner, component, place, near, inner):
    """Add to ``sums`` (body, ``contents_of``) what the region of each body holds of one component of the velocity.

    Columns: the sums of its motion, its volume and first moments [m/s, m^2/s^2, cells]. What lies in the window of
    ``place`` counts; ``b`` and ``owner`` are arrays of the window ``near``.
    """
    up, w, turn = len(inner), len(inner) + 2, _about_z(len(inner))
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
                    sums[m, turn] += -y * held
                elif component == 1:
                    sums[m, turn] += x * held
                sums[m, turn + 1] += 0.5 * held * b[o, at]
                sums[m, turn + 2] += part_of
                sums[m, turn + 3] += part_of * x
                sums[m, turn + 4] += part_of * y
                if up > 1:
                    z = j - PAD + (0.0 if component == 2 else 0.5)
                    _tilt(sums, m, component, x, y, z, held)
                    sums[m, turn + 5] += part_of * z


def skins(
    markers: Markers, offset: float, origin: tuple[float, ...], h: float, count: int
) -> np.ndarray:  # fmt: skip
    """Return what ``contents`` counts too much: the skin ``offset`` cells thick, which is water, part by part.

    Args:
        markers: of one body.
        offset: of the wall [cells].
        origin: corner of the grid [m].
        h: cell [m].
        count: parts of the body, the rows of the result, shape (part, ``contents_of``) [-].
    """
    axes = len(origin)
    w = offset * markers.share / h ** (axes - 1)
    place = [(p - start) / h for p, start in zip(markers.points, origin, strict=True)]
    v = markers.velocities
    square = v[0] ** 2 + v[1] ** 2
    if axes == 3:
        square = square + v[2] ** 2
    around = (place[a] * v[b] - place[b] * v[a] for a, b in TURNS[axes])
    columns = (*v, *around, 0.5 * square, np.ones(w.size), *place)
    if count == 1 or markers.part is None:
        return (w * np.array(columns)).sum(axis=1)[None]
    return np.stack([np.bincount(markers.part, w * column, count) for column in columns], axis=1)


@dataclass(frozen=True, slots=True, kw_only=True)
class Reaction:
    """What the water does to a body, or to each of its parts, mean over a step; in the plane per metre of depth."""

    force: np.ndarray
    """Force (x, y) or (x, y, z), shape (..., axis) [N/m, N]."""
    moment: np.ndarray
    """Torque about the axes through the asked point, (z,) in the plane, counter-clockwise, or (x, y, z), shape
    (..., turn) [N, N m]."""
    power: np.ndarray
    """Power that the surface gives to the water, in the frame of the grid, shape (...) [W/m, W]."""

    @property
    def torque(self) -> np.ndarray:
        """Torque about z, shape (...) [N, N m]."""
        return self.moment[..., -1]

    def __getitem__(self, which: int | slice) -> "Reaction":
        """Return that on one or some of several bodies or parts."""
        return Reaction(force=self.force[which], moment=self.moment[which], power=self.power[which])

    def whole(self, cut: tuple[bool, ...]) -> "Reaction":
        """Return that of the whole body, of which this is the part between the mirrors that cut it; see ``body.cuts``.

        Forces through a mirror, and torques about the axes in it, vanish.
        """
        times, across = 2 ** sum(cut), [low or high for low, high in zip(cut[::2], cut[1::2], strict=True)]
        moved = np.array([0.0 if off else times for off in across])
        turned = np.array([0.0 if across[a] or across[b] else times for a, b in TURNS[len(across)]])
        return Reaction(force=moved * self.force, moment=turned * self.moment, power=times * self.power)


def reaction(
    given: np.ndarray, before: np.ndarray, now: np.ndarray, *, dt: float, push: tuple[float, ...], about: np.ndarray,
    origin: tuple[float, ...], h: float, density: float,
) -> Reaction:  # fmt: skip
    """Return the water's action on a body, or on each of its parts, over a step.

    Args:
        given: what the immersion gave over the step, shape (..., ``sums_of``) [m/s and so on].
        before: contents of the region at the start of the step, shape (..., ``contents_of``).
        now: the same at its end.
        dt: the step [s].
        push: uniform acceleration of the water [m/s^2].
        about: point of the torque, in the frame of the grid [m].
        origin: corner of the grid [m].
        h: cell [m].
        density: of the water [kg/m^3].
    """
    axes, turns = len(origin), TURNS[len(origin)]
    energy = axes + len(turns)
    change, middle = now[..., : energy + 1] - before[..., : energy + 1], 0.5 * (now + before)
    centre = (about - np.array(origin)) / h
    size, first = middle[..., energy + 1, None], middle[..., energy + 2 :]
    force = (change[..., :axes] - given[..., :axes]) / dt - size * np.array(push)
    moment = [
        (change[..., axes + n] - given[..., axes + n]) / dt - (first[..., a] * push[b] - first[..., b] * push[a])
        - (centre[a] * force[..., b] - centre[b] * force[..., a])
        for n, (a, b) in enumerate(turns)
    ]  # fmt: skip
    power, scale = (given[..., energy] - change[..., energy]) / dt, density
    for d, own in enumerate(push):
        power = power + own * middle[..., d]
        scale *= h
    return Reaction(force=scale * force, moment=scale * h * np.stack(moment, axis=-1), power=scale * power)

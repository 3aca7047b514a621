# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision and number of dimensions)
"""Forces on bodies from the momentum that the immersion itself exchanges with the water.

In each step the immersion changes the momentum of the cells in and around a body by a known amount. One part of it
changes the momentum of the region that the body fills; the body gives the rest to the water. This balance is exact for
the discrete equations, whatever the wall looks like between the nodes. Angular momentum gives the torque and energy the
power in the same way. The immersion moves a skin of thickness ``wall_offset`` with the body; the skin counts as water.
If it counted as body, the torque of a turning cylinder would be wrong by 6 % at 32 cells a diameter; as water it is
wrong by 0.8 %. (The inertia of a translating cylinder, whose skin also keeps the water away, is 2 to 3 % too large.)
"""

from dataclasses import dataclass
from math import prod

import numpy as np

from suchus.flow.compiled import PAD, compiled, kernel_part, signed
from suchus.flow.markers import Markers, kernel_array
from suchus.flow.pose import ROTATION_PLANES
from suchus.flow.slab import row_length


def sums_of(ndim: int) -> int:
    """Return the number of sums per body: momentum, angular momentum (in the plane only about z), energy."""
    return ndim + len(ROTATION_PLANES[ndim]) + 1


def contents_of(ndim: int) -> int:
    """Return the number of sums per body's region: the sums of its motion, its volume and its first moments."""
    return sums_of(ndim) + 1 + ndim


@kernel_part
def _spin_column(slab_axis):
    """Return the column of the angular momentum about z; in space those about x and y come before it."""
    return slab_axis + 1 if slab_axis == 1 else slab_axis + 3


@kernel_part
def _tilt(sums, m, component, x, y, z, impulse):
    """Add the angular momentum about x and about y of an impulse along one axis at a place in space.

    Args:
        sums: shape (body, ``sums_of``).
        m: row of the body.
        component: axis of the impulse.
        x: place [cells].
        y: place [cells].
        z: place [cells].
        impulse: along the axis.
    """
    if component == 0:
        sums[m, 4] += z * impulse
    elif component == 1:
        sums[m, 3] += -z * impulse
    else:
        sums[m, 3] += y * impulse
        sums[m, 4] += -x * impulse


@kernel_part
def _add_component_impulse(
    sums, velocity, blend, raw, mean, passage, mu1, p, owner, component, layout, inner, dt, keep
):  # fmt: skip
    """Add the impulse of the immersion on one component of the velocity; see ``add_immersion_impulse``."""
    slab_axis, w, turn = len(inner), len(inner) + 2, _spin_column(len(inner))
    row_cells = signed(row_length(inner, p.shape[1]))
    columns = layout[3 * slab_axis + 3] - layout[3 * slab_axis + 2] + 1
    r0, r1 = (layout[w + 2], layout[w + 3]) if slab_axis > 1 else (-1, 2)
    c0, c1 = layout[3 * slab_axis + 2], layout[3 * slab_axis + 3]
    for j in range(layout[w] + 1, layout[w + 1] - 1):
        for row in range(r0 + 1, r1 - 1):
            for i in range(c0 + 1, c1 - 1):
                k = row * row_cells + i
                index = (row - r0) * columns + i - c0 if slab_axis > 1 else i - c0
                is_immersed = passage[j, k] < 1
                for d in range(slab_axis + 1):
                    is_immersed = is_immersed or mu1[d, j - layout[w], index] != 0
                if not is_immersed:
                    continue
                pressure_before = p[j - 1, k]
                for d in range(slab_axis):
                    pressure_before = p[j, k - signed(inner[d])] if component == d else pressure_before
                rise = np.float64(p[j, k]) - pressure_before
                immersed_velocity = (np.float64(velocity[j, k]) - keep * np.float64(blend[j, k])) / (1.0 - keep)
                impulse = immersed_velocity - raw[j - layout[w], index] + dt * rise
                m, y = owner[j - layout[w], index], (row if slab_axis > 1 else j) - PAD + 0.5
                sums[m, component] += impulse
                if component == 0:
                    sums[m, turn] += -y * impulse
                elif component == 1:
                    sums[m, turn] += (i - PAD + 0.5) * impulse
                if slab_axis > 1:
                    _tilt(sums, m, component, i - PAD + 0.5, y, j - PAD + 0.5, impulse)
                sums[m, turn + 1] += mean[j - layout[w], index] * impulse


@compiled
def add_immersion_impulse(sums, velocity, blend, raw, mean, passage, mu1, p, owners, layout, inner, dt, keep):
    """Add the impulse of the immersion in one stage, with its moments and energy.

    ``mean``, ``raw``, ``mu1`` and ``owners`` are near arrays, those of the window; see ``slab``. The mean velocity is
    needed: with that of the step's end alone the power is too large by half the work of the added mass in a step.

    Args:
        sums: shape (body, ``sums_of``), to add to [m/s per cell; moments about the grid's corner, lengths in cells].
        velocity: after the stage, shape (axis, slab, cell) [m/s].
        blend: velocity at the last stage [m/s].
        raw: the fluid's own update without the pressure [m/s].
        mean: the bodies' velocity, mean of the step's start and end [m/s].
        passage: fraction of the pressure's gradient that acts on the faces [-].
        mu1: first moments of the kernel, shape (component, axis, slab, cell).
        p: pressure over density.
        owners: part of the bodies that each face belongs to, shape (axis, slab, cell) [-].
        layout: row of the multigrid's layout whose window counts; see ``slab``.
        inner: strides within a slab.
        dt: length of the stage [cells per (m/s)].
        keep: fraction of ``blend`` that stayed [-].
    """
    for c in range(len(inner) + 1):
        _add_component_impulse(
            sums, velocity[c], blend[c], raw[c], mean[c], passage[c], mu1[c], p, owners[c], c, layout, inner, dt, keep
        )  # fmt: skip


@kernel_part
def _add_to_owners(sums, column, owners, o, index, columns, contribution):
    """Add a cell's contribution to the parts that own its faces, an equal amount for each face.

    Args:
        sums: shape (body, column).
        column: column to add to.
        owners: part that each face belongs to, shape (axis, slab, cell), near arrays.
        o: slab in the window.
        index: cell in the slab of the window.
        columns: cells along a row of the window.
        contribution: contribution of the cell.
    """
    ndim = len(owners)
    face_contribution = contribution / (2 * ndim)
    for d in range(ndim):
        slab_step, cell_step = (1 if d == ndim - 1 else 0), (0 if d == ndim - 1 else 1 if d == 0 else columns)
        sums[owners[d, o, index], column] += face_contribution
        sums[owners[d, o + slab_step, index + cell_step], column] += face_contribution


@compiled
def dilatation_work(sums, p, source, owners, layout, inner, dt):
    """Subtract from the energy the work of the pressure on the divergence of the bodies' own motion inside them.

    Args:
        sums: shape (body, ``sums_of``), to change.
        p: pressure over density.
        source: divergence of the bodies' own motion, near array.
        owners: part that each face belongs to, near array, shape (axis, slab, cell).
        layout: row of the multigrid's layout whose window counts; see ``slab``.
        inner: strides within a slab.
        dt: length of the step [cells per (m/s)].
    """
    slab_axis, w, turn = len(inner), len(inner) + 2, _spin_column(len(inner))
    row_cells = signed(row_length(inner, p.shape[1]))
    columns = layout[3 * slab_axis + 3] - layout[3 * slab_axis + 2] + 1
    r0, r1 = (layout[w + 2], layout[w + 3]) if slab_axis > 1 else (0, 1)
    c0, c1 = layout[3 * slab_axis + 2], layout[3 * slab_axis + 3]
    for j in range(layout[w], layout[w + 1]):
        for row in range(r0, r1):
            for i in range(c0, c1):
                o, index = j - layout[w], (row - r0) * columns + i - c0
                if source[o, index] != 0:
                    work = dt * np.float64(p[j, row * row_cells + i]) * source[o, index]
                    _add_to_owners(sums, turn + 1, owners, o, index, columns, work)


@compiled
def add_internal_pressure(sums, p, mu0, owners, layout, near_layout, inner, weight):
    """Add the integral of the pressure inside the region of each body and its first moments, times a weight.

    Args:
        sums: shape (body, 1 + axes), to add to: the pressure summed over the cells, each by the body's fraction, and
            its first moments about the grid's corner [.., .. cells].
        p: pressure over density.
        mu0: fluid fraction of the faces, shape (axis, slab, cell).
        owners: part that each face belongs to, near array, shape (axis, slab, cell).
        layout: row of the multigrid's layout whose window counts; see ``slab``.
        near_layout: the same with the window of the near arrays.
        inner: strides within a slab.
        weight: factor of all sums.
    """
    slab_axis, w = len(inner), len(inner) + 2
    row_cells = signed(row_length(inner, p.shape[1]))
    columns = near_layout[3 * slab_axis + 3] - near_layout[3 * slab_axis + 2] + 1
    n0, n1 = near_layout[w + 2] if slab_axis > 1 else 0, near_layout[3 * slab_axis + 2]
    r0, r1 = (layout[w + 2], layout[w + 3]) if slab_axis > 1 else (0, 1)
    c0, c1 = layout[3 * slab_axis + 2], layout[3 * slab_axis + 3]
    for j in range(layout[w], layout[w + 1]):
        for row in range(r0, r1):
            for i in range(c0, c1):
                k = row * row_cells + i
                mu0_sum = np.float64(mu0[slab_axis, j, k]) + mu0[slab_axis, j + 1, k]
                for d in range(slab_axis):
                    mu0_sum += np.float64(mu0[d, j, k]) + mu0[d, j, k + signed(inner[d])]
                body_fraction = 1.0 - mu0_sum / (2 * slab_axis + 2)
                if body_fraction <= 0.0:
                    continue
                o, index = j - near_layout[w], (row - n0) * columns + i - n1
                weighted_pressure = weight * body_fraction * np.float64(p[j, k])
                _add_to_owners(sums, 0, owners, o, index, columns, weighted_pressure)
                _add_to_owners(sums, 1, owners, o, index, columns, weighted_pressure * (i - PAD + 0.5))
                _add_to_owners(
                    sums, 2, owners, o, index, columns, weighted_pressure * ((row if slab_axis > 1 else j) - PAD + 0.5)
                )
                if slab_axis > 1:
                    _add_to_owners(sums, 3, owners, o, index, columns, weighted_pressure * (j - PAD + 0.5))


@compiled
def subtract_joint_pressure(sums, p, mu0, owners, layout, near_layout, inner, weight):
    """Subtract from the sums what the pressure inside bodies does across joints of their links.

    A body has no pressure inside. Where a cell's two faces across an axis belong to two links, the pressure in the cell
    pushes these links apart. It cancels in their sum, and it does work where they turn against each other. By the
    body's fraction of the cell this is what ``dilatation_work`` takes from the power. In space only.

    Args:
        sums: shape (body, ``sums_of``), to change.
        p: see ``add_internal_pressure``.
        mu0: see ``add_internal_pressure``.
        owners: see ``add_internal_pressure``.
        layout: see ``add_internal_pressure``.
        near_layout: see ``add_internal_pressure``.
        inner: see ``add_internal_pressure``.
        weight: see ``add_internal_pressure``.
    """
    w = len(inner) + 2
    row_cells, columns = signed(row_length(inner, p.shape[1])), near_layout[9] - near_layout[8] + 1
    n0, n1 = near_layout[w + 2], near_layout[8]
    for j in range(layout[w], layout[w + 1]):
        for row in range(layout[w + 2], layout[w + 3]):
            for i in range(layout[8], layout[9]):
                o, index = j - near_layout[w], (row - n0) * columns + i - n1
                owner_left, owner_right = owners[0, o, index], owners[0, o, index + 1]
                owner_front, owner_back = owners[1, o, index], owners[1, o, index + columns]
                owner_below, owner_above = owners[2, o, index], owners[2, o + 1, index]
                if owner_left == owner_right and owner_front == owner_back and owner_below == owner_above:
                    continue
                k = row * row_cells + i
                mu0_sum = np.float64(mu0[2, j, k]) + mu0[2, j + 1, k]
                for d in range(2):
                    mu0_sum += np.float64(mu0[d, j, k]) + mu0[d, j, k + signed(inner[d])]
                body_fraction = 1.0 - mu0_sum / 6
                if body_fraction <= 0.0:
                    continue
                push = weight * body_fraction * np.float64(p[j, k])
                x, y, z = i - PAD + 0.5, row - PAD + 0.5, j - PAD + 0.5
                for m, force in ((owner_left, -push), (owner_right, push)):
                    sums[m, 0] += force
                    sums[m, 4] += z * force
                    sums[m, 5] += -y * force
                for m, force in ((owner_front, -push), (owner_back, push)):
                    sums[m, 1] += force
                    sums[m, 3] += -z * force
                    sums[m, 5] += x * force
                for m, force in ((owner_below, -push), (owner_above, push)):
                    sums[m, 2] += force
                    sums[m, 3] += y * force
                    sums[m, 4] += -x * force


@kernel_part
def _add_component_contents(sums, b, mu0, owner, component, layout, near_layout, inner):
    """Add what the region of each body holds of one component of the velocity; see ``add_contents``."""
    slab_axis, w, turn = len(inner), len(inner) + 2, _spin_column(len(inner))
    row_cells = signed(row_length(inner, mu0.shape[1]))
    columns = near_layout[3 * slab_axis + 3] - near_layout[3 * slab_axis + 2] + 1
    n0, n1 = near_layout[w + 2] if slab_axis > 1 else 0, near_layout[3 * slab_axis + 2]
    r0, r1 = (layout[w + 2], layout[w + 3]) if slab_axis > 1 else (0, 1)
    c0, c1 = layout[3 * slab_axis + 2], layout[3 * slab_axis + 3]
    ndim = slab_axis + 1
    for j in range(layout[w], layout[w + 1]):
        for row in range(r0, r1):
            for i in range(c0, c1):
                k = row * row_cells + i
                body_fraction = 1.0 - np.float64(mu0[j, k])
                if body_fraction == 0.0:
                    continue
                o, index = j - near_layout[w], (row - n0) * columns + i - n1
                m = owner[o, index]
                x = i - PAD + (0.0 if component == 0 else 0.5)
                y = (row if slab_axis > 1 else j) - PAD + (0.0 if component == 1 else 0.5)
                momentum, axis_fraction = body_fraction * b[o, index], body_fraction / ndim
                sums[m, component] += momentum
                if component == 0:
                    sums[m, turn] += -y * momentum
                elif component == 1:
                    sums[m, turn] += x * momentum
                sums[m, turn + 1] += 0.5 * momentum * b[o, index]
                sums[m, turn + 2] += axis_fraction
                sums[m, turn + 3] += axis_fraction * x
                sums[m, turn + 4] += axis_fraction * y
                if slab_axis > 1:
                    z = j - PAD + (0.0 if component == 2 else 0.5)
                    _tilt(sums, m, component, x, y, z, momentum)
                    sums[m, turn + 5] += axis_fraction * z


@compiled
def add_contents(sums, b, mu0, owners, layout, near_layout, inner):
    """Add what the region of each body holds.

    Args:
        sums: shape (body, ``contents_of``), to add to: the sums of its motion, its volume and first moments [m/s,
            m^2/s^2, cells].
        b: the bodies' velocity, near array, shape (axis, slab, cell) [m/s].
        mu0: fluid fraction of the faces, shape (axis, slab, cell).
        owners: part that each face belongs to, near array, shape (axis, slab, cell).
        layout: row of the multigrid's layout whose window counts; see ``slab``.
        near_layout: the same with the window of the near arrays.
        inner: strides within a slab.
    """
    for c in range(len(inner) + 1):
        _add_component_contents(sums, b[c], mu0[c], owners[c], c, layout, near_layout, inner)


def skin_contents(
    markers: Markers, offset: float, origin: tuple[float, ...], h: float, count: int
) -> np.ndarray:  # fmt: skip
    """Return the contents of the layer of water that ``add_contents`` counts as body, part by part.

    The layer is ``offset`` cells thick.

    Args:
        markers: markers of one body.
        offset: offset of the wall [cells].
        origin: corner of the grid [m].
        h: cell [m].
        count: parts of the body, the rows of the result, shape (part, ``contents_of``) [-].
    """
    sums = np.zeros((count, contents_of(len(origin))))
    parts = np.zeros(markers.weight.size, np.int64)
    if count > 1 and markers.part_index is not None:
        parts = markers.part_index.astype(np.int64)
    points, velocities, weight = (kernel_array(a) for a in (markers.points, markers.velocities, markers.weight))
    planes = np.array(ROTATION_PLANES[len(origin)])
    add_skin_contents(sums, points, velocities, weight, parts, np.array(origin), h, offset, planes)
    return sums


@compiled
def add_skin_contents(sums, points, velocities, weight, parts, origin, h, offset, planes):
    """Add the contents of the layer of water along a skin; see ``skin_contents``.

    Args:
        sums: shape (part, ``contents_of``), to add to.
        points: positions of the markers, shape (axis, marker) [m].
        velocities: shape (axis, marker) [m/s].
        weight: length or area of each marker, shape (marker,) [m, m^2].
        parts: part that each marker belongs to, shape (marker,).
        origin: corner of the grid, shape (axis,) [m].
        h: cell [m].
        offset: offset of the wall [cells].
        planes: the two axes across each axis of rotation, shape (turn, 2).
    """
    ndim, turns = points.shape[0], planes.shape[0]
    factor, energy = offset / h ** (ndim - 1), ndim + turns
    for k in range(weight.size):
        w, m, square = factor * weight[k], parts[k], 0.0
        for d in range(ndim):
            sums[m, d] += w * velocities[d, k]
            square += velocities[d, k] ** 2
            sums[m, energy + 2 + d] += w * (points[d, k] - origin[d]) / h
        for n in range(turns):
            a, b = planes[n, 0], planes[n, 1]
            arm_a, arm_b = (points[a, k] - origin[a]) / h, (points[b, k] - origin[b]) / h
            sums[m, ndim + n] += w * (arm_a * velocities[b, k] - arm_b * velocities[a, k])
        sums[m, energy] += 0.5 * w * square
        sums[m, energy + 1] += w


@dataclass(frozen=True, slots=True, kw_only=True)
class Reaction:
    """Load of the water on a body, or on each of its parts, mean over a step; in the plane per metre of depth."""

    force: np.ndarray
    """Force (x, y) or (x, y, z), shape (..., axis) [N/m, N]."""
    moment: np.ndarray
    """Torque about the axes through a reference point, (z,) in the plane, counter-clockwise, or (x, y, z), shape
    (..., turn) [N, N m]."""
    power: np.ndarray
    """Power that the surface gives to the water, in the frame of the grid, shape (...) [W/m, W]."""

    @property
    def torque(self) -> np.ndarray:
        """Torque about z, shape (...) [N, N m]."""
        return self.moment[..., -1]

    def __getitem__(self, index: int | slice) -> "Reaction":
        """Return the loads on one or some of several bodies or parts."""
        return Reaction(force=self.force[index], moment=self.moment[index], power=self.power[index])

    def of_whole_body(self, mirror_cuts: tuple[bool, ...]) -> "Reaction":
        """Return the load on the whole body, if mirrors cut it and this is the load on the part in the domain.

        Forces through a mirror, and torques about the axes in it, vanish.
        """
        if not any(mirror_cuts):
            return self
        times, has_mirror = (
            2 ** sum(mirror_cuts),
            [
                has_lower_mirror or has_upper_mirror
                for has_lower_mirror, has_upper_mirror in zip(mirror_cuts[::2], mirror_cuts[1::2], strict=True)
            ],
        )
        force_factor = np.array([0.0 if is_cut else times for is_cut in has_mirror])
        moment_factor = np.array(
            [0.0 if has_mirror[a] or has_mirror[b] else times for a, b in ROTATION_PLANES[len(has_mirror)]]
        )
        return Reaction(force=force_factor * self.force, moment=moment_factor * self.moment, power=times * self.power)


@compiled
def fill_reaction(loads, impulse, start_contents, end_contents, dt, push, centre, planes, h, density):
    """Write force, torque and power on each part; see ``reaction``.

    Args:
        loads: shape (part, axis + turn + 1), to write to.
        impulse: shape (part, ``sums_of``).
        start_contents: shape (part, ``contents_of``).
        end_contents: the same at the end of the step.
        dt: the step [s].
        push: uniform acceleration of the water, shape (axis,) [m/s^2].
        centre: point of the torque, from the corner of the grid, shape (axis,) [cells].
        planes: the two axes across each axis of rotation, shape (turn, 2).
        h: cell [m].
        density: density of the water [kg/m^3].
    """
    ndim, turns = push.size, planes.shape[0]
    energy = ndim + turns
    scale = density * h**ndim
    for m in range(loads.shape[0]):
        size = 0.5 * (start_contents[m, energy + 1] + end_contents[m, energy + 1])
        power = (impulse[m, energy] - (end_contents[m, energy] - start_contents[m, energy])) / dt
        for d in range(ndim):
            change = end_contents[m, d] - start_contents[m, d]
            loads[m, d] = (change - impulse[m, d]) / dt - size * push[d]
            power += push[d] * 0.5 * (start_contents[m, d] + end_contents[m, d])
        for n in range(turns):
            a, b = planes[n, 0], planes[n, 1]
            change = end_contents[m, ndim + n] - start_contents[m, ndim + n]
            moment_a = 0.5 * (start_contents[m, energy + 2 + a] + end_contents[m, energy + 2 + a])
            moment_b = 0.5 * (start_contents[m, energy + 2 + b] + end_contents[m, energy + 2 + b])
            torque = (change - impulse[m, ndim + n]) / dt - (moment_a * push[b] - moment_b * push[a])
            loads[m, ndim + n] = scale * h * (torque - (centre[a] * loads[m, b] - centre[b] * loads[m, a]))
        for d in range(ndim):
            loads[m, d] *= scale
        loads[m, energy] = scale * power


def reaction(
    impulse: np.ndarray, start_contents: np.ndarray, end_contents: np.ndarray, *, dt: float,
    push: tuple[float, ...], reference_point: np.ndarray, origin: tuple[float, ...], h: float, density: float,
) -> Reaction:  # fmt: skip
    """Return the mean load of the water on a body, or on each of its parts, over a step.

    Args:
        impulse: sums that the immersion added over the step, shape (..., ``sums_of``) [m/s and so on].
        start_contents: contents of the region at the start of the step, shape (..., ``contents_of``).
        end_contents: the same at its end.
        dt: the step [s].
        push: uniform acceleration of the water [m/s^2].
        reference_point: point of the torque, in the frame of the grid [m].
        origin: corner of the grid [m].
        h: cell [m].
        density: density of the water [kg/m^3].
    """
    ndim = len(origin)
    shape = impulse.shape[:-1]
    loads = np.empty((prod(shape), ndim + len(ROTATION_PLANES[ndim]) + 1))
    part_impulse, start, end = (sums.reshape(len(loads), -1) for sums in (impulse, start_contents, end_contents))
    centre = (reference_point - np.array(origin)) / h
    planes = np.array(ROTATION_PLANES[ndim])
    fill_reaction(loads, part_impulse, start, end, dt, np.array(push), centre, planes, h, density)
    loads = loads.reshape(*shape, -1)
    return Reaction(force=loads[..., :ndim], moment=loads[..., ndim:-1], power=loads[..., -1])

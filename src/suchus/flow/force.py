# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision)
"""Forces on bodies: pressure and shear over the skin, and the momentum through a box around them."""

from dataclasses import dataclass

import numpy as np

from suchus.flow.compiled import PAD, compiled, kernel_part
from suchus.flow.grid import Grid
from suchus.flow.markers import Markers, kernel_array
from suchus.flow.pose import ROTATION_PLANES
from suchus.flow.water import Fluid

WALL_POINT_SPACING = 1.0
"""Spacing of the points off the wall from which wall pressure and wall shear are fitted [cells]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Load:
    """Load of the water on a body; in the plane per metre of depth."""

    pressure: tuple[float, ...]
    """Force by pressure, along each axis [N/m, N]."""
    shear: tuple[float, ...]
    """Force by friction, along each axis [N/m, N]."""
    moment: tuple[float, ...]
    """Torque about the axes through a reference point, (z,) in the plane, counter-clockwise, or (x, y, z) [N, N m]."""
    power: float
    """Power that the body's surface gives to the water [W/m, W]."""

    @property
    def force(self) -> tuple[float, ...]:
        """Pressure and friction together, along each axis [N/m, N]."""
        return tuple(push + rub for push, rub in zip(self.pressure, self.shear, strict=True))

    @property
    def torque(self) -> float:
        """Torque about z [N, N m]."""
        return self.moment[-1]


@dataclass(frozen=True, slots=True, kw_only=True)
class Surface:
    """Distribution of pressure and friction along a body's outline or over its skin.

    For their errors see ``resolution.ALONG_THE_SKIN``. For the total force take ``Record.force``.
    """

    markers: Markers
    """Points on the skin, where the values are given [m]."""
    pressure: np.ndarray
    """Pressure, zero on the average along the sides of the domain, shape (marker,) [Pa]."""
    shear: np.ndarray
    """Friction per area, shape (axis, marker) [Pa]."""

    @property
    def traction(self) -> np.ndarray:
        """Force per area, shape (axis, marker) [Pa]."""
        return self.shear - self.pressure * self.markers.normals

    def load(self, reference_point: tuple[float, ...]) -> Load:
        """Return the integral over the outline or the skin, torque about a point [m]."""
        m, ndim = self.markers, len(self.shear)
        planes = np.array(ROTATION_PLANES[ndim])
        sums = np.zeros(2 * ndim + len(planes) + 1)
        weight, normals, points, velocities = (kernel_array(a) for a in (m.weight, m.normals, m.points, m.velocities))
        pressure, shear = kernel_array(self.pressure), kernel_array(self.shear)
        add_loads(sums, pressure, shear, weight, normals, points, velocities, kernel_array(reference_point), planes)
        numbers = sums.tolist()
        return Load(
            pressure=tuple(numbers[:ndim]), shear=tuple(numbers[ndim : 2 * ndim]), moment=tuple(numbers[2 * ndim : -1]),
            power=numbers[-1],
        )  # fmt: skip


def padded(points: np.ndarray, grid: Grid) -> np.ndarray:
    """Return points, shape (axis, point) [m], in padded indices of the cell centres."""
    return (points - np.array(grid.origin)[:, None]) / grid.cell + (PAD - 0.5)


def steps_of(a: np.ndarray) -> np.ndarray:
    """Return the distance in memory between neighbours of a field along x, y (and z) [-]."""
    return np.array([stride // a.itemsize for stride in reversed(a.strides)])


def sample(water: Fluid, markers: Markers, density: float) -> Surface:
    """Return pressure and friction at the markers; densities in [kg/m^3].

    Args:
        water: water with its pressure and velocity.
        markers: points on the body's surface.
        density: density of the water [kg/m^3].
    """
    pressure, shear = np.empty(markers.weight.size), np.empty(markers.points.shape)
    points, normals, velocities, spins = (
        kernel_array(a) for a in (markers.points, markers.normals, markers.velocities, markers.spins)
    )
    sample_skin(
        water.p.reshape(-1), water.velocity.reshape(water.ndim, -1), steps_of(water.p), points, normals, velocities,
        spins, np.array(water.grid.origin), water.grid.cell, np.array(ROTATION_PLANES[water.ndim]), water.level,
        density, density * float(water.nu), pressure, shear,
    )  # fmt: skip
    return Surface(markers=markers, pressure=pressure, shear=shear)


def momentum(velocity: np.ndarray, box: tuple[int, ...]) -> np.ndarray:
    """Return the momentum of the faces of a box of cells, half of those on its sides, shape (axis,) [m/s cells].

    Args:
        velocity: velocity on the faces before the cells, shape (axis, ...) [m/s].
        box: padded cell indices, first and end along each axis, the last axis first.
    """
    ndim = len(velocity)
    total = np.zeros(ndim)
    for c, component in enumerate(velocity):
        n = ndim - 1 - c
        faces = component[tuple(slice(box[2 * m], box[2 * m + 1] + (m == n)) for m in range(ndim))]
        ends = np.take(faces, (0, -1), axis=n)
        total[c] = faces.sum(dtype=np.float64) - 0.5 * ends.sum(dtype=np.float64)
    return total


def boundary_flux(velocity: np.ndarray, p: np.ndarray, nu: float, box: tuple[int, ...]) -> np.ndarray:
    """Return the flux into a box through its sides, shape (2, axis) [(m/s)^2 cells].

    The rows are momentum with friction, and pressure.

    Args:
        velocity: velocity on the faces before the cells, shape (axis, ...) [m/s].
        p: pressure over density [m^2/s^2].
        nu: viscosity [m/s cells].
        box: as for ``momentum``.
    """
    ndim = len(velocity)
    total, pressed = np.zeros(ndim), np.zeros(ndim)
    for d in range(ndim):
        for end, outward_sign in ((box[2 * (ndim - 1 - d)], -1.0), (box[2 * (ndim - 1 - d) + 1], 1.0)):

            def at_side(
                a: np.ndarray, shift: tuple[tuple[int, int], ...] = (), d: int = d, end: int = end
            ) -> np.ndarray:
                """Return the values at the cells behind this side, some cells further along some axes."""
                offsets, places = dict(shift), []
                for n in range(ndim):
                    offset = offsets.get(ndim - 1 - n, 0)
                    extent = slice(box[2 * n] + offset, box[2 * n + 1] + offset)
                    places.append(end + offset if n == ndim - 1 - d else extent)
                return np.asarray(a[tuple(places)], np.float64)

            normal_velocity, normal = at_side(velocity[d]), velocity[d]
            stretch = at_side(normal, ((d, 1),)) - at_side(normal, ((d, -1),))
            push = 0.5 * (at_side(p, ((d, -1),)) + at_side(p))
            total[d] += outward_sign * (nu * stretch - normal_velocity**2).sum()
            pressed[d] -= outward_sign * push.sum()
            for c in set(range(ndim)) - {d}:
                tangential = velocity[c]
                before_side = at_side(tangential, ((d, -1),)) + at_side(tangential, ((d, -1), (c, 1)))
                behind_side = at_side(tangential) + at_side(tangential, ((c, 1),))
                shear = 0.5 * (behind_side - before_side + at_side(normal, ((c, 1),)) - at_side(normal, ((c, -1),)))
                total[c] += outward_sign * (nu * shear - normal_velocity * 0.25 * (before_side + behind_side)).sum()
    return np.array([total, pressed])


@dataclass(slots=True)
class ControlVolume:
    """A box of cells whose momentum is followed from step to step."""

    box: tuple[int, ...]
    """Padded cell indices, first and end along each axis, the last axis first."""
    last_balance: np.ndarray | None = None
    """Momentum of water and bodies, flow through the sides, and pressure on them, at the last step, shape (4, axis)."""

    def start(self, water: Fluid) -> np.ndarray:
        """Store and return the balance now, from which the next step counts; see ``last_balance``."""
        self.last_balance = np.array(
            [
                momentum(water.velocity, self.box), momentum(water.weighted_body_velocity, self.box),
                *boundary_flux(water.velocity, water.p, float(water.nu), self.box),
            ]
        )  # fmt: skip
        return self.last_balance

    def force(self, water: Fluid, dt: float, push: tuple[float, ...], density: float) -> tuple[float, ...]:
        """Return the mean force on the bodies in the box over the step that just ended [N/m, N].

        Momentum flows at the mean of the step's start and end. The pressure after a step is that which acted in it, as
        the acceleration of the grid is. Not a number in the first step, unless ``start`` was called before it.

        Args:
            water: after the step.
            dt: length of the step [s].
            push: uniform acceleration of the water [m/s^2].
            density: density of the water [kg/m^3].
        """
        h, previous_balance = water.grid.cell, self.last_balance
        balance = self.start(water)
        if previous_balance is None:
            return (float("nan"),) * water.ndim
        cells = np.prod(np.subtract(self.box[1::2], self.box[::2]))
        body_cells = (1 - water.mu0[0]).sum(dtype=np.float64)
        rate = (balance[0] - balance[1] - previous_balance[0] + previous_balance[1]) / dt
        body = (cells - body_cells) * np.array(push)
        flux = 0.5 * (balance[2] + previous_balance[2]) + balance[3]
        total = density * h ** (water.ndim - 1) * (flux + h * (body - rate))
        return tuple(total.tolist())


@kernel_part
def interpolate_at(field, strides, position):
    """Return the value of a flat field at a position, interpolated linearly along each axis; bounds are not checked.

    Args:
        field: values of the cells, end to end, shape (cell,).
        strides: difference of the flat indices of neighbours along each axis, shape (axis,) [-].
        position: fractional index of the padded array along each axis, shape (axis,).
    """
    if position.size == 2:
        i, j = int(position[0]), int(position[1])
        fraction_x, fraction_y = position[0] - i, position[1] - j
        lower_index = i * strides[0] + j * strides[1]
        upper_index = lower_index + strides[1]
        lower_value = (1.0 - fraction_x) * field[lower_index] + fraction_x * field[lower_index + strides[0]]
        upper_value = (1.0 - fraction_x) * field[upper_index] + fraction_x * field[upper_index + strides[0]]
        return (1.0 - fraction_y) * lower_value + fraction_y * upper_value
    total = 0.0
    for corner in range(1 << position.size):
        weight, flat_index = 1.0, 0
        for d in range(position.size):
            i = int(position[d])
            fraction = position[d] - i
            is_upper = (corner >> d) & 1
            weight *= fraction if is_upper else 1.0 - fraction
            flat_index += (i + is_upper) * strides[d]
        total += weight * field[flat_index]
    return total


@compiled
def interpolate(a, steps, places, samples):
    """Write the interpolation of a flat field at places, shape (axis, point), in padded indices.

    Args:
        a: the field, its cells end to end.
        steps: distance in memory of neighbours along each axis [-].
        places: positions in padded indices, shape (axis, point).
        samples: array to write to, shape (point,).
    """
    position = np.empty(places.shape[0])
    for m in range(places.shape[1]):
        for d in range(position.size):
            position[d] = places[d, m]
        samples[m] = interpolate_at(a, steps, position)


@kernel_part
def _wall_pressure(p, steps, places, normals, gap, pressure):
    """Write the pressure at the markers from a parabola through three points off the wall.

    The points lie 1, 2 and 3 times ``gap`` cells off the wall; marker positions in padded indices of the cells.
    Read on the wall itself, the pressures of both sides of a thin tail mix and the force is ten times as noisy.

    Args:
        p: pressure over density, its cells end to end.
        steps: distance in memory of neighbours along each axis [-].
        places: positions of the markers in padded indices, shape (axis, marker).
        normals: outward normals, shape (axis, marker).
        gap: distance of the points [cells].
        pressure: array to write to, shape (marker,).
    """
    position = np.empty(places.shape[0])
    for m in range(places.shape[1]):
        pressure[m] = 0.0
        for k in range(1, 4):
            for d in range(position.size):
                position[d] = places[d, m] + k * gap * normals[d, m]
            pressure[m] += (3.0, -3.0, 1.0)[k - 1] * interpolate_at(p, steps, position)


@kernel_part
def _wall_shear(velocity, steps, places, normals, walls, spins, cell, turns, gap, shear):
    """Write the rate of shear at the markers from a cubic through the wall and three points off the wall.

    The points lie 1, 2 and 3 times ``gap`` cells off the wall.

    Args:
        velocity: components, each with its cells end to end [m/s].
        steps: distance in memory of neighbours along each axis [-].
        places: positions of the markers in padded indices, shape (axis, marker).
        normals: outward normals, shape (axis, marker).
        walls: velocities of the wall, shape (axis, marker) [m/s].
        spins: angular velocities of the wall about the axes of ``turns`` [rad/s].
        cell: side of a cell [m].
        turns: the two axes across each axis of rotation, shape (turn, 2).
        gap: distance of the points [cells].
        shear: array to write to, shape (axis, marker) [m/s per cell].
    """
    ndim = places.shape[0]
    position, wall_velocity = np.empty(ndim), np.empty(ndim)
    for m in range(places.shape[1]):
        for c in range(ndim):
            shear[c, m] = 0.0
        for k in range(1, 4):
            weight = (3.0, -1.5, 1.0 / 3.0)[k - 1] / gap
            for d in range(ndim):
                wall_velocity[d] = walls[d, m]
            for n in range(turns.shape[0]):
                first_axis, second_axis = turns[n, 0], turns[n, 1]
                wall_velocity[first_axis] -= spins[n, m] * cell * k * gap * normals[second_axis, m]
                wall_velocity[second_axis] += spins[n, m] * cell * k * gap * normals[first_axis, m]
            for c in range(ndim):
                for d in range(ndim):
                    position[d] = places[d, m] + k * gap * normals[d, m] + (0.5 if d == c else 0.0)
                shear[c, m] += weight * (interpolate_at(velocity[c], steps, position) - wall_velocity[c])
        normal_shear = 0.0
        for d in range(ndim):
            normal_shear += shear[d, m] * normals[d, m]
        for d in range(ndim):
            shear[d, m] -= normal_shear * normals[d, m]


@compiled
def sample_skin(
    p, velocity, steps, points, normals, walls, spins, origin, cell, turns, level, density, viscosity, pressure, shear
):  # fmt: skip
    """Write pressure and friction at the markers; see ``_wall_pressure`` and ``_wall_shear``.

    Args:
        p: pressure over density, its cells end to end.
        velocity: components, each with its cells end to end [m/s].
        steps: distance in memory of neighbours along each axis [-].
        points: positions of the markers, shape (axis, marker) [m].
        normals: outward normals, shape (axis, marker).
        walls: velocities of the wall, shape (axis, marker) [m/s].
        spins: angular velocities of the wall about the axes of ``turns`` [rad/s].
        origin: corner of the grid, shape (axis,) [m].
        cell: side of a cell [m].
        turns: the two axes across each axis of rotation, shape (turn, 2).
        level: pressure over density from which the pressure counts.
        density: density of the water [kg/m^3].
        viscosity: density times viscosity over the cell [Pa s/m].
        pressure: array to write to, shape (marker,) [Pa].
        shear: array to write to, shape (axis, marker) [Pa].
    """
    places = np.empty(points.shape)
    for d in range(points.shape[0]):
        for m in range(points.shape[1]):
            places[d, m] = (points[d, m] - origin[d]) / cell + (PAD - 0.5)
    _wall_pressure(p, steps, places, normals, WALL_POINT_SPACING, pressure)
    _wall_shear(velocity, steps, places, normals, walls, spins, cell, turns, WALL_POINT_SPACING, shear)
    for m in range(pressure.size):
        pressure[m] = density * (pressure[m] - level)
        for d in range(points.shape[0]):
            shear[d, m] *= viscosity


@compiled
def add_loads(sums, pressure, shear, weight, normals, points, velocities, reference_point, planes):
    """Add pressure, friction, torque and power over a skin; see ``Surface.load``.

    Args:
        sums: force by pressure, force by friction, torques and power, shape (2 axis + turn + 1,), to add to.
        pressure: shape (marker,) [Pa].
        shear: shape (axis, marker) [Pa].
        weight: length or area of each marker, shape (marker,) [m, m^2].
        normals: outward normals, shape (axis, marker) [-].
        points: positions of the markers, shape (axis, marker) [m].
        velocities: velocities of the skin, shape (axis, marker) [m/s].
        reference_point: point of the torques, shape (axis,) [m].
        planes: the two axes across each axis of rotation, shape (turn, 2).
    """
    ndim = points.shape[0]
    for m in range(weight.size):
        for d in range(ndim):
            push, rub = -pressure[m] * normals[d, m] * weight[m], shear[d, m] * weight[m]
            sums[d] += push
            sums[ndim + d] += rub
            sums[sums.size - 1] -= (push + rub) * velocities[d, m]
        for n in range(planes.shape[0]):
            a, b = planes[n, 0], planes[n, 1]
            force_a = (shear[a, m] - pressure[m] * normals[a, m]) * weight[m]
            force_b = (shear[b, m] - pressure[m] * normals[b, m]) * weight[m]
            sums[2 * ndim + n] += (points[a, m] - reference_point[a]) * force_b
            sums[2 * ndim + n] -= (points[b, m] - reference_point[b]) * force_a

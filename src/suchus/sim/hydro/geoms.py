"""What the water does to shapes of any size: the exact part under water, drag, lift, and the change of added mass.

A shape is a geom of any model. The surface over a shape is the plane through the waves at six points of it. The kinetic
energy of the added mass is T = f (w . A w + omega . J omega) / 2, where f is the fraction under water. What follows
where f changes is said by ``forces.change_added_mass``.
"""

from math import cos, exp, sin, sqrt
from typing import NamedTuple

import numpy as np

from suchus.core.water_table import (
    CAPSULE,
    CURRENT,
    CYLINDER,
    LEVEL,
    POLYHEDRON,
    SHAPE_COLUMNS,
    SHEAR,
)
from suchus.sim.hydro import lanes
from suchus.sim.hydro.forces import change_added_mass, immersed
from suchus.sim.hydro.lanes import WaterProperties
from suchus.sim.hydro.shapes import Immersion, capsule, cylinder, polyhedron
from suchus.sim.hydro.vectors import (
    Vector,
    blend,
    compile_inline,
    cross,
    dot,
    lane,
    plus,
    three,
    times,
    write_lane,
)

(
    _SOLID, _BOUND, _ADDED_INERTIA, _FRONTAL, _COUPLED, _TURNING, _LINEAR, _LINEAR_TURNING, _LIFT, _TRIANGLES,
) = (
    SHAPE_COLUMNS[name][0]
    for name in ("solid", "bound", "added_inertia", "frontal", "coupled", "turning", "linear", "linear_turning", "lift",
                 "triangles")
)  # fmt: skip
_NODE = 0.5773502691896257
"""Where, between the middle and the end of a shape, the waves are taken: Gauss's rule of two points [-]."""


@compile_inline
def scheduled(rows: np.ndarray, time: float) -> float:
    """Return a quantity that is given over time; straight between the rows, steady beyond.

    Args:
        rows: time [s] and quantity, shape (row, 2); at least one.
        time: [s].
    """
    last = len(rows) - 1
    if time <= rows[0, 0]:
        return float(rows[0, 1])
    for i in range(last):
        if time < rows[i + 1, 0]:
            f = (time - rows[i, 0]) / (rows[i + 1, 0] - rows[i, 0])
            return float(rows[i, 1] + f * (rows[i + 1, 1] - rows[i, 1]))
    return float(rows[last, 1])


class _Waves(NamedTuple):
    """Waves on deep water over a shape; above the level the water moves as at the level."""

    height: float
    """Mean height of the surface above the level, at six points of the shape [m]."""
    slope: Vector
    """Gradient of that height, along the shape's axes [-]."""
    velocity: Vector
    """Velocity of the water at the centre [m/s]."""
    acceleration: Vector
    """Its rate at that point [m/s2]."""
    gradient: tuple[Vector, Vector, Vector]
    """Rows of the gradient of the velocity, which is symmetric [1/s]."""


@compile_inline
def _waves_over(
    waves: np.ndarray, time: float, x: Vector, level: float, up_axis: Vector, reaches: tuple[Vector, Vector, Vector]
) -> _Waves:
    """Return what waves do at a shape.

    Args:
        waves: shape (wave, ``WAVE_WIDTH``).
        time: [s].
        x: centre of the shape [m].
        level: level of the surface [m].
        up_axis: unit vector against gravity.
        reaches: half of the distances between the points at which the surface is taken, along three axes [m].
    """
    zero = (0.0, 0.0, 0.0)
    height, slope, velocity, acceleration = 0.0, zero, zero, zero
    gradient = (zero, zero, zero)
    above = min(dot(up_axis, x) - level, 0.0)
    is_under = 1.0 if above < 0.0 else 0.0
    for wave in waves:
        k, omega = (wave[1], wave[2], wave[3]), wave[4]
        number = sqrt(dot(k, k))
        phase = dot(k, x) - omega * time + wave[5]
        c, s = cos(phase), sin(phase)
        mean, first, second, third = 1.0, dot(k, reaches[0]), dot(k, reaches[1]), dot(k, reaches[2])
        mean += _cosine(first) + _cosine(second) + _cosine(third) - 3.0
        height += wave[0] * c * mean
        steep = wave[0] * s
        slope = plus(slope, (-steep * _sine(first), -steep * _sine(second), -steep * _sine(third)))
        speed = wave[0] * omega * exp(number * above)
        along = times(1.0 / number, k)
        velocity = plus(velocity, blend(speed * c, along, speed * s, up_axis, 0.0, zero))
        acceleration = plus(acceleration, blend(omega * speed * s, along, -omega * speed * c, up_axis, 0.0, zero))
        rate, climb = number * speed, number * speed * is_under
        gradient = (
            plus(gradient[0], _row(0, along, up_axis, rate, climb, c, s)),
            plus(gradient[1], _row(1, along, up_axis, rate, climb, c, s)),
            plus(gradient[2], _row(2, along, up_axis, rate, climb, c, s)),
        )
    return _Waves(height, slope, velocity, acceleration, gradient)


@compile_inline
def _cosine(x: float) -> float:
    """Return the cosine, by its series where that is exact to rounding."""
    if abs(x) < 0.1:
        y = x * x
        return 1.0 - y * (0.5 - y * (1.0 / 24.0 - y * (1.0 / 720.0 - y / 40320.0)))
    return cos(x)


@compile_inline
def _sine(x: float) -> float:
    """Return the sine, by its series where that is exact to rounding."""
    if abs(x) < 0.1:
        y = x * x
        return x * (1.0 - y * (1.0 / 6.0 - y * (1.0 / 120.0 - y * (1.0 / 5040.0 - y / 362880.0))))
    return sin(x)


@compile_inline
def _row(i: int, along: Vector, up_axis: Vector, rate: float, climb: float, c: float, s: float) -> Vector:
    """Return a row of the gradient of a wave's velocity: how its component i changes along each direction [1/s].

    Args:
        i: component.
        along: direction of the wave.
        up_axis: unit vector against gravity.
        rate: wave number times speed of the water [1/s].
        climb: the same if the velocity changes with height, 0 above the level [1/s].
        c: cosine of the wave's phase.
        s: its sine.
    """
    return blend(
        rate * (c * up_axis[i] - s * along[i]), along, climb * (c * along[i] + s * up_axis[i]), up_axis, 0.0, along
    )


@compile_inline
def stir(
    table: np.ndarray,
    rows: np.ndarray,
    user: np.ndarray,
    header: np.ndarray,
    waves: np.ndarray,
    time: float,
    surge: Vector,
    up_axis: Vector,
    count: int,
) -> None:
    """Write the surface over each shape, and velocity and acceleration of the water at its centre.

    Args:
        table: table of the shapes, shape (column, lane).
        rows: quantities of the shapes, see ``lanes``; written.
        user: numbers of the water, see ``water_table``.
        header: header of the table of shapes.
        waves: shape (wave, ``WAVE_WIDTH``).
        time: [s].
        surge: acceleration of the current [m/s2].
        up_axis: unit vector against gravity.
        count: number of shapes in the table [-].
    """
    shear, current = three(header, SHEAR), three(user, CURRENT)
    for n in range(count):
        centre = lane(rows, lanes.CENTRE, n)
        above = dot(up_axis, centre) - user[LEVEL]
        stream, gain, normal, height = plus(current, times(min(above, 0.0), shear)), surge, up_axis, 0.0
        if len(waves) > 0:
            axes = lane(rows, lanes.E_A, n), lane(rows, lanes.E_B, n), lane(rows, lanes.E_T, n)
            half = lane(table, lanes.HALF, n)
            reach = times(_NODE, half)
            reaches = times(reach[0], axes[0]), times(reach[1], axes[1]), times(reach[2], axes[2])
            over = _waves_over(waves, time, centre, user[LEVEL], up_axis, reaches)
            height = over.height
            slope = blend(
                over.slope[0] / reach[0], axes[0], over.slope[1] / reach[1], axes[1], over.slope[2] / reach[2], axes[2]
            )
            normal = plus(up_axis, times(-1.0, plus(slope, times(-dot(slope, up_axis), up_axis))))
            normal = times(1.0 / sqrt(dot(normal, normal)), normal)
            stream = plus(stream, over.velocity)
            passing = dot(over.gradient[0], stream), dot(over.gradient[1], stream), dot(over.gradient[2], stream)
            gain = plus(gain, plus(over.acceleration, passing))
        if above < 0.0:
            gain = plus(gain, times(dot(stream, up_axis), shear))
        rows[lanes.ELEVATION, n] = height
        write_lane(rows, lanes.STREAM, n, stream)
        write_lane(rows, lanes.SURGE, n, gain)
        write_lane(rows, lanes.NORMAL, n, normal)


@compile_inline
def _ellipsoid(half: Vector, volume: float, normal: Vector, height: float) -> Immersion:
    """Return what of an ellipsoid is under a plane.

    Args:
        half: half axes [m].
        volume: its volume [m3].
        normal: unit normal of the plane, along the axes.
        height: distance of the plane from the centre along the normal [m].
    """
    x, y, z = half[0] * normal[0], half[1] * normal[1], half[2] * normal[2]
    extent = sqrt(x * x + y * y + z * z)
    d = height / extent
    fraction, moment = immersed(1.0, d)  # a ball
    arm = half[0] * x / extent, half[1] * y / extent, half[2] * z / extent
    area = volume * 0.75 * (1.0 - d * d) / extent
    return Immersion(volume * fraction, times(volume * moment, arm), area, times(area * d, arm))


@compile_inline
def immerse(table: np.ndarray, rows: np.ndarray, water: WaterProperties, triangles: np.ndarray, count: int) -> None:
    """Write which fraction of each shape is under water, where its centre is, and the surface's cut through the shape.

    Args:
        table: table of the shapes, shape (column, lane).
        rows: quantities of the shapes, see ``lanes``; written.
        water: its properties.
        triangles: those of all polyhedra, shape (triangle, 9).
        count: number of shapes in the table [-].
    """
    for n in range(count):
        a, b, t = lane(rows, lanes.E_A, n), lane(rows, lanes.E_B, n), lane(rows, lanes.E_T, n)
        up, centre = lane(rows, lanes.NORMAL, n), lane(rows, lanes.CENTRE, n)
        normal = dot(up, a), dot(up, b), dot(up, t)
        gap = water.level + rows[lanes.ELEVATION, n] - dot(water.up_axis, centre)
        height = gap * dot(up, water.up_axis)
        kind, half = int(table[lanes.KIND, n]), lane(table, lanes.HALF, n)
        slant = sqrt(normal[0] * normal[0] + normal[1] * normal[1])
        if kind == CYLINDER:
            reach = half[0] * slant + half[2] * abs(normal[2])
        elif kind == CAPSULE:
            reach = half[0] + (half[2] - half[0]) * abs(normal[2])
        elif kind == POLYHEDRON:
            bound = lane(table, _BOUND, n)
            reach = bound[0] * abs(normal[0]) + bound[1] * abs(normal[1]) + bound[2] * abs(normal[2])
        else:
            x, y, z = half[0] * normal[0], half[1] * normal[1], half[2] * normal[2]
            reach = sqrt(x * x + y * y + z * z)
        fraction, offset, cut, cut_offset = 0.0, (0.0, 0.0, 0.0), 0.0, (0.0, 0.0, 0.0)
        if height >= reach:
            fraction = 1.0
        elif height > -reach:
            solid = table[_SOLID, n]
            if kind == CYLINDER:
                part = cylinder(half[0], half[2], normal, height)
            elif kind == CAPSULE:
                part = capsule(half[0], half[2] - half[0], normal, height)
            elif kind == POLYHEDRON:
                first = int(table[_TRIANGLES, n])
                part = polyhedron(triangles[first : first + int(table[_TRIANGLES + 1, n])], normal, height)
            else:
                part = _ellipsoid(half, solid, normal, height)
            if part.volume > 1e-12 * solid:
                fraction = min(part.volume / solid, 1.0)
                m = times(1.0 / part.volume, part.moment)
                offset = blend(m[0], a, m[1], b, m[2], t)
                if part.area > 0.0:
                    cut = part.area / solid
                    m = times(1.0 / part.area, part.area_moment)
                    cut_offset = blend(m[0], a, m[1], b, m[2], t)
        rows[lanes.WET_FRACTION, n] = fraction
        rows[lanes.WET_VOLUME, n] = fraction * table[lanes.VOLUME, n]
        rows[lanes.CUT, n] = cut
        write_lane(rows, lanes.OFFSET, n, offset)
        write_lane(rows, lanes.CUT_OFFSET, n, cut_offset)
        r = plus(centre, times(-1.0, lane(rows, lanes.REFERENCE, n)))
        v = plus(lane(rows, lanes.MOVING + 3, n), cross(lane(rows, lanes.MOVING, n), r))
        v = plus(v, times(-1.0, lane(rows, lanes.STREAM, n)))
        write_lane(rows, lanes.LEVER, n, r)
        write_lane(rows, lanes.AGAINST, n, v)
        write_lane(rows, lanes.SPEED, n, (dot(v, a), dot(v, b), dot(v, t)))


@compile_inline
def _load(rows: np.ndarray, n: int, force: Vector, point: Vector, couple: Vector) -> None:
    """Add a force at a point, from the point of reference, and a couple to the load of a shape."""
    torque = plus(lane(rows, lanes.FORCE - 3, n), plus(couple, cross(point, force)))
    write_lane(rows, lanes.FORCE - 3, n, torque)
    write_lane(rows, lanes.FORCE, n, plus(lane(rows, lanes.FORCE, n), force))


@compile_inline
def _tensor(values: Vector, a: Vector, b: Vector, t: Vector) -> tuple[Vector, Vector, Vector]:
    """Return the rows of a symmetric tensor in the world, given its values along three axes."""
    x, y, z = values
    return (
        blend(x * a[0], a, y * b[0], b, z * t[0], t),
        blend(x * a[1], a, y * b[1], b, z * t[1], t),
        blend(x * a[2], a, y * b[2], b, z * t[2], t),
    )


@compile_inline
def _add_inertia(
    rows: np.ndarray, n: int, linear: tuple[Vector, Vector, Vector], turning: tuple[Vector, Vector, Vector]
) -> None:
    """Add an inertia at the centre of a shape to the shape's spatial inertia about the point of reference.

    Args:
        rows: quantities of the shapes, see ``lanes``; written.
        n: which shape.
        linear: rows of the tensor of mass [kg].
        turning: rows of the tensor of moments of inertia about the centre [kg m2].
    """
    r = lane(rows, lanes.LEVER, n)
    x, y, z = cross(r, linear[0]), cross(r, linear[1]), cross(r, linear[2])
    for i, row in ((0, x), (3, y), (6, z)):
        write_lane(rows, lanes.COUPLING_INERTIA + i, n, plus(lane(rows, lanes.COUPLING_INERTIA + i, n), row))
    first = (
        r[1] * z[0] - r[2] * y[0] + turning[0][0],
        r[2] * x[0] - r[0] * z[0] + turning[1][0],
        r[2] * x[1] - r[0] * z[1] + turning[1][1],
    )
    second = (
        r[0] * y[0] - r[1] * x[0] + turning[2][0],
        r[0] * y[1] - r[1] * x[1] + turning[2][1],
        r[0] * y[2] - r[1] * x[2] + turning[2][2],
    )
    start = lanes.ROTATIONAL_INERTIA
    write_lane(rows, start, n, plus(lane(rows, start, n), first))
    write_lane(rows, start + 3, n, plus(lane(rows, start + 3, n), second))
    start = lanes.LINEAR_INERTIA
    mass = linear[0][0], linear[1][0], linear[1][1]
    write_lane(rows, start, n, plus(lane(rows, start, n), mass))
    write_lane(rows, start + 3, n, plus(lane(rows, start + 3, n), linear[2]))


@compile_inline
def float_up(rows: np.ndarray, water: WaterProperties, count: int) -> None:
    """Write buoyancy and the pressure of accelerated water, at the centre of what is under water, as each shape's load.

    Args:
        rows: quantities of the shapes, see ``lanes``; written.
        water: its properties.
        count: number of shapes in the table [-].
    """
    zero = (0.0, 0.0, 0.0)
    for n in range(count):
        volume = rows[lanes.WET_VOLUME, n]
        pull = plus(times(water.gravity, water.up_axis), lane(rows, lanes.SURGE, n))
        write_lane(rows, lanes.FORCE, n, zero)
        write_lane(rows, lanes.FORCE - 3, n, zero)
        point = plus(lane(rows, lanes.LEVER, n), lane(rows, lanes.OFFSET, n))
        _load(rows, n, times(water.density * volume, pull), point, zero)
        rows[lanes.FIRST_SUM + lanes.LOAD_VOLUME, n] = volume


@compile_inline
def resist(table: np.ndarray, rows: np.ndarray, water: WaterProperties, step: float, count: int) -> None:
    """Add drag and lift, the rotational part of the added mass, and the forces of its change, to each shape.

    Resistances are taken at the velocity at the end of a step: what they change of it within the step is added to the
    inertia, so that a light body does not overshoot.

    Args:
        table: table of the shapes, shape (column, lane).
        rows: quantities of the shapes, see ``lanes``; written after ``added_mass``.
        water: its properties.
        step: time step of an implicit step, 0 to take resistances as they are [s].
        count: number of shapes in the table [-].
    """
    for n in range(count):
        fraction = rows[lanes.WET_FRACTION, n]
        if fraction == 0.0:
            continue
        a, b, t = lane(rows, lanes.E_A, n), lane(rows, lanes.E_B, n), lane(rows, lanes.E_T, n)
        r, omega, v = lane(rows, lanes.LEVER, n), lane(rows, lanes.MOVING, n), lane(rows, lanes.AGAINST, n)
        w, spin = lane(rows, lanes.SPEED, n), (dot(omega, a), dot(omega, b), dot(omega, t))
        dense = water.density * fraction
        # drag, along the axes of the shape, as a force or torque over a speed or rate
        across, axial = w[0] * w[0] + w[1] * w[1], w[2] * w[2]
        coupled = table[_COUPLED, n]
        sideways, forward = sqrt(across + coupled * axial), sqrt(axial + coupled * across)
        c, k = lane(table, _FRONTAL, n), lane(table, _LINEAR, n)
        drag = (
            0.5 * dense * c[0] * sideways + fraction * k[0],
            0.5 * dense * c[1] * sideways + fraction * k[1],
            0.5 * dense * c[2] * forward + fraction * k[2],
        )
        c, k = lane(table, _TURNING, n), lane(table, _LINEAR_TURNING, n)
        brake = (
            0.5 * dense * c[0] * abs(spin[0]) + fraction * k[0],
            0.5 * dense * c[1] * abs(spin[1]) + fraction * k[1],
            0.5 * dense * c[2] * abs(spin[2]) + fraction * k[2],
        )
        # the rotational part of the added mass
        scale = water.density * water.added_mass_factor
        j = times(scale, lane(table, _ADDED_INERTIA, n))
        inertia = _tensor(times(fraction, j), a, b, t)
        alpha = lane(rows, lanes.BIAS, n)
        momentum = dot(inertia[0], omega), dot(inertia[1], omega), dot(inertia[2], omega)
        couple = plus((dot(inertia[0], alpha), dot(inertia[1], alpha), dot(inertia[2], alpha)), cross(omega, momentum))
        _load(rows, n, (0.0, 0.0, 0.0), r, times(-1.0, couple))
        # the change of the added mass at the surface
        cut, zero = rows[lanes.CUT, n], (0.0, 0.0, 0.0)
        if cut > 0.0 and scale > 0.0:
            up, lever = lane(rows, lanes.NORMAL, n), lane(rows, lanes.CUT_OFFSET, n)
            m = times(scale, lane(table, lanes.ADDED_MASS, n))
            twice = m[0] * w[0] * w[0] + m[1] * w[1] * w[1] + m[2] * w[2] * w[2]
            twice += j[0] * spin[0] * spin[0] + j[1] * spin[1] * spin[1] + j[2] * spin[2] * spin[2]
            lost, push = change_added_mass(cut, up, plus(v, cross(omega, lever)), twice, water.splash)
            _load(rows, n, push, plus(r, lever), zero)
            drag = plus(drag, times(lost, m))
            brake = plus(brake, times(lost, j))
        force = blend(-drag[0] * w[0], a, -drag[1] * w[1], b, -drag[2] * w[2], t)
        couple = blend(-brake[0] * spin[0], a, -brake[1] * spin[1], b, -brake[2] * spin[2], t)
        # lift of flat faces, normal to the flow
        slope = lane(table, _LIFT, n)
        speed = sqrt(across + axial)
        if speed > 0.0 and slope[0] + slope[1] + slope[2] > 0.0:
            x, y, z = slope[0] * w[0], slope[1] * w[1], slope[2] * w[2]
            along = (x * w[0] + y * w[1] + z * w[2]) / (speed * speed)
            lift = plus(blend(x, a, y, b, z, t), times(-along, v))
            force = plus(force, times(-0.5 * dense * speed, lift))
        _load(rows, n, force, r, couple)
        late, late_turning = zero, zero
        if step > 0.0:
            late = (step * max(drag[0], 0.0), step * max(drag[1], 0.0), step * max(drag[2], 0.0))
            late_turning = (step * max(brake[0], 0.0), step * max(brake[1], 0.0), step * max(brake[2], 0.0))
        _add_inertia(rows, n, _tensor(late, a, b, t), _tensor(plus(times(fraction, j), late_turning), a, b, t))

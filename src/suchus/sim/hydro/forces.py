"""The formulas: what the water does to pieces of bodies, and what is under water of a body at rest.

Added mass is Kirchhoff's: a piece of added inertia A that moves at w against the water has the momentum p = A w; the
water answers its rate of change with a force -(A dw/dt + omega x p) and the couple -w x p (Munk). What is proportional
to the accelerations goes into the mass matrix, the rest to the passive forces. Lighthill's momentum is shed at the
tail's end: -u p' + (p' . w) t / 2, where the water passes towards the tail (u > 0).

The kinetic energy of the added mass is T = f w . A w / 2, where f is the fraction under water. Where f changes,
Lagrange's equations give, beside the terms of constant f, the force -f' A w, f' being the rate of f, and the gradient
of T. Both follow from the surface's cut: f falls by S / V for each metre by which the middle of the cut rises. A splash
takes a fraction of what f' moves: with all of it, a body that enters keeps momentum, not energy (von Karman 1929), and
a body that leaves gets nothing back.

Some pieces at a time are taken together, quantity by quantity below each other (``lanes``), so that the compiler
handles several with one instruction. It does only where a loop has neither branches nor calls of a library: what needs
them stands in loops of its own, and what holds for some pieces only is multiplied by zero for the others.
"""

from math import cos, exp, pi, sin, sqrt

import numpy as np

from suchus.core.water_table import BALL, CURRENT, DISC, LANES, LEVEL, WAVE
from suchus.sim.hydro import lanes
from suchus.sim.hydro.lanes import WaterProperties
from suchus.sim.hydro.vectors import (
    Vector,
    blend,
    compile_inline,
    compile_kernel,
    cross,
    dot,
    lane,
    plus,
    three,
    times,
    to_world,
    write_lane,
)

_TURBULENT = 5e5
"""Reynolds number from which a plate's turbulent friction counts [-]."""
_SERIES = (
    0.1666666666666665,
    0.07500000000020764,
    0.044642857103423646,
    0.03038194736709848,
    0.02237204763174451,
    0.01735525995578633,
    0.013929652902326577,
    0.011875494382637216,
    0.007802949477352493,
    0.016035514349149713,
    -0.010749050339696914,
    0.02816921806087918,
)
"""(asin(x) / x - 1) / x^2 as a polynomial of x^2 up to 1/4, by interpolation at Chebyshev's points."""


@compile_inline
def immersed(kind: float, depth: float) -> tuple[float, float]:
    """Return the share of a unit shape under a plane, and its first moment along the plane's normal.

    Args:
        kind: kind of the shape.
        depth: depth of its centre over its half extent along the normal; beyond -1 and 1 it is dry or under water.
    """
    d = min(max(depth, -1.0), 1.0)
    chord_squared = 1.0 - d * d
    half_chord = sqrt(chord_squared)
    disc, ball, slab = 0.5 + (_arcsine(d) + d * half_chord) / pi, (2.0 + 3.0 * d - d * d * d) / 4.0, (1.0 + d) / 2.0
    flat = -2.0 / 3.0 / pi * chord_squared * half_chord
    fraction = disc if kind == DISC else (ball if kind == BALL else slab)
    return fraction, flat if kind == DISC else (
        -3.0 / 16.0 * chord_squared * chord_squared if kind == BALL else -chord_squared / 4.0
    )


@compile_inline
def _arcsine(x: float) -> float:
    """Return the arc sine, to a few units in the last place; the library's would keep a loop from being vectorised."""
    size = abs(x)
    small = size < 0.5
    z = x * x if small else 0.5 * (1.0 - size)
    y = size if small else sqrt(z)
    p = _SERIES[11]
    p = p * z + _SERIES[10]
    p = p * z + _SERIES[9]
    p = p * z + _SERIES[8]
    p = p * z + _SERIES[7]
    p = p * z + _SERIES[6]
    p = p * z + _SERIES[5]
    p = p * z + _SERIES[4]
    p = p * z + _SERIES[3]
    p = p * z + _SERIES[2]
    p = p * z + _SERIES[1]
    p = p * z + _SERIES[0]
    base_angle = y + y * z * p
    angle = base_angle if small else 0.5 * pi - 2.0 * base_angle
    return angle if x > 0.0 else -angle


@compile_kernel
def hydrostatic(
    table: np.ndarray,
    xpos: np.ndarray,
    xmat: np.ndarray,
    up_axis: np.ndarray,
    level: float,
    air_fraction: tuple[float, float],
) -> np.ndarray:
    """Return the submerged volume, its first moment about the world's origin, and the work of submerging it.

    Shape (5,): [m3], three [m4], and the work over density and gravity [m4].

    Args:
        table: table of pieces.
        xpos: origins of the bodies, shape (body, 3) [m].
        xmat: their orientations, shape (body, 9).
        up_axis: unit vector against gravity, shape (3,).
        level: level of the surface above the origin [m].
        air_fraction: shares of the air that are kept, in the front and in the rear chambers [-].
    """
    sums, vertical = np.zeros(5), three(up_axis, 0)
    for row in table:
        body = int(row[0])
        axes = to_world(xmat[body], row, 5), to_world(xmat[body], row, 8), to_world(xmat[body], row, 11)
        centre = plus(three(xpos[body], 0), to_world(xmat[body], row, 2))
        ua, ub, ut = (
            row[14] * dot(vertical, axes[0]),
            row[15] * dot(vertical, axes[1]),
            row[16] * dot(vertical, axes[2]),
        )
        extent = sqrt(ua * ua + ub * ub + ut * ut)
        depth = (level - dot(vertical, centre)) / extent
        fraction, moment = immersed(row[1], depth)
        arm = blend(row[14] * ua, axes[0], row[15] * ub, axes[1], row[16] * ut, axes[2])
        volume = row[17] - (1.0 - air_fraction[0]) * row[18] - (1.0 - air_fraction[1]) * row[19]
        sums[0] += volume * fraction
        for i in range(3):
            sums[1 + i] += volume * (fraction * centre[i] + moment * arm[i] / extent)
        sums[4] += volume * extent * (depth * fraction - moment)
    return sums


@compile_inline
def _orbit(user: np.ndarray, time: float, x: Vector, up_axis: Vector) -> tuple[float, Vector, Vector]:
    """Return the surface elevation of waves at a point [m], and velocity and acceleration of the water there.

    Airy's waves on deep water, as they are at the surface for points above the level, and the current.

    Args:
        user: numbers of the water, see ``water_table``.
        time: [s].
        x: the point in the world [m].
        up_axis: unit vector against gravity.
    """
    current, zero = three(user, CURRENT), (0.0, 0.0, 0.0)
    height, omega = user[WAVE], user[WAVE + 4]
    if height == 0.0:
        return 0.0, current, zero
    wave = three(user, WAVE + 1)
    number = sqrt(dot(wave, wave))
    phase = dot(wave, x) - omega * time + user[WAVE + 5]
    c, s = cos(phase), sin(phase)
    speed = height * omega * exp(number * min(dot(up_axis, x) - user[LEVEL], 0.0))
    moving = blend(1.0, current, speed * c / number, wave, speed * s, up_axis)
    return height * c, moving, blend(omega * speed * s / number, wave, -omega * speed * c, up_axis, 0.0, zero)


@compile_inline
def place(table: np.ndarray, rows: np.ndarray) -> None:
    """Turn axes and centres of pieces from the frames of their bodies into the world."""
    for n in range(LANES):
        turn = lane(rows, lanes.TURN, n), lane(rows, lanes.TURN + 3, n), lane(rows, lanes.TURN + 6, n)
        a, b = lane(table, lanes.AXIS_A, n), lane(table, lanes.AXIS_B, n)
        t, centre = lane(table, lanes.AXIS_T, n), lane(table, lanes.CENTRE_IN_BODY, n)
        write_lane(rows, lanes.E_A, n, (dot(turn[0], a), dot(turn[1], a), dot(turn[2], a)))
        write_lane(rows, lanes.E_B, n, (dot(turn[0], b), dot(turn[1], b), dot(turn[2], b)))
        write_lane(rows, lanes.E_T, n, (dot(turn[0], t), dot(turn[1], t), dot(turn[2], t)))
        centre = (dot(turn[0], centre), dot(turn[1], centre), dot(turn[2], centre))
        write_lane(rows, lanes.CENTRE, n, plus(lane(rows, lanes.ORIGIN, n), centre))


@compile_inline
def flow(rows: np.ndarray, user: np.ndarray, time: float, up_axis: Vector) -> None:
    """Write the surface elevation at each piece, and velocity and acceleration of the water there.

    Args:
        rows: quantities of the pieces, see ``lanes``; written.
        user: numbers of the water, see ``water_table``.
        time: [s].
        up_axis: unit vector against gravity.
    """
    current, zero, wave = three(user, CURRENT), (0.0, 0.0, 0.0), user[WAVE] != 0.0
    for n in range(LANES):
        elevation, stream, surge = 0.0, current, zero
        if wave:
            elevation, stream, surge = _orbit(user, time, lane(rows, lanes.CENTRE, n), up_axis)
        rows[lanes.ELEVATION, n] = elevation
        write_lane(rows, lanes.STREAM, n, stream)
        write_lane(rows, lanes.SURGE, n, surge)


@compile_inline
def meet(table: np.ndarray, rows: np.ndarray, water: WaterProperties) -> None:
    """Write the depth of each piece below the surface, and its velocity relative to the water.

    Args:
        table: table of the pieces, shape (column, lane).
        rows: quantities of the pieces, see ``lanes``; written.
        water: its properties.
    """
    for n in range(LANES):
        a, b, t = lane(rows, lanes.E_A, n), lane(rows, lanes.E_B, n), lane(rows, lanes.E_T, n)
        ua, ub, ut = dot(water.up_axis, a), dot(water.up_axis, b), dot(water.up_axis, t)
        ua, ub, ut = table[lanes.HALF, n] * ua, table[lanes.HALF + 1, n] * ub, table[lanes.HALF + 2, n] * ut
        extent, centre = sqrt(ua * ua + ub * ub + ut * ut), lane(rows, lanes.CENTRE, n)
        depth = (water.level + rows[lanes.ELEVATION, n] - dot(water.up_axis, centre)) / extent
        rows[lanes.DEPTH, n] = depth
        arm = blend(table[lanes.HALF, n] * ua, a, table[lanes.HALF + 1, n] * ub, b, table[lanes.HALF + 2, n] * ut, t)
        write_lane(rows, lanes.ARM, n, times(1.0 / extent, arm))
        r = plus(centre, times(-1.0, lane(rows, lanes.REFERENCE, n)))
        v = plus(lane(rows, lanes.MOVING + 3, n), cross(lane(rows, lanes.MOVING, n), r))
        v = plus(v, times(-1.0, lane(rows, lanes.STREAM, n)))  # of the centre against the water
        write_lane(rows, lanes.LEVER, n, r)
        write_lane(rows, lanes.AGAINST, n, v)
        write_lane(rows, lanes.SPEED, n, (dot(v, a), dot(v, b), dot(v, t)))


@compile_inline
def rub(rows: np.ndarray, water: WaterProperties) -> None:
    """Write the coefficient of turbulent friction of each piece; 0 below the critical Reynolds number."""
    per_speed = water.length / water.viscosity
    for n in range(LANES):
        reynolds, friction = abs(rows[lanes.SPEED + 2, n]) * per_speed, 0.0
        if reynolds > _TURBULENT:
            friction = 0.074 * reynolds**-0.2
        rows[lanes.TURBULENT, n] = friction


@compile_inline
def press(table: np.ndarray, rows: np.ndarray, water: WaterProperties) -> None:
    """Write the load of the water on each piece: force, couple about the point of reference, submerged volume.

    Args:
        table: table of the pieces, shape (column, lane).
        rows: quantities of the pieces, see ``lanes``; written.
        water: its properties.
    """
    per_speed, (front, rear) = water.length / water.viscosity, water.air_fraction
    for n in range(LANES):
        fraction, moment = immersed(table[lanes.KIND, n], rows[lanes.DEPTH, n])
        emptied = (1.0 - front) * table[lanes.AIR, n] + (1.0 - rear) * table[lanes.AIR + 1, n]
        volume = (table[lanes.VOLUME, n] - emptied) * fraction
        a, b, t, w = (
            lane(rows, lanes.E_A, n),
            lane(rows, lanes.E_B, n),
            lane(rows, lanes.E_T, n),
            lane(rows, lanes.SPEED, n),
        )
        r, omega, surge = lane(rows, lanes.LEVER, n), lane(rows, lanes.MOVING, n), lane(rows, lanes.SURGE, n)
        # buoyancy and the pressure of the waves, at the centre of what is under water
        f = times(water.density * volume, plus(times(water.gravity, water.up_axis), surge))
        torque = cross(times(moment / fraction, lane(rows, lanes.ARM, n)), f)
        # drag across and along, and of a flat piece that rolls, over the share under water
        dense = water.density * fraction
        cross_factor = -0.5 * dense * water.cross_drag * sqrt(w[0] * w[0] + w[1] * w[1])
        speed, roll = abs(w[2]), dot(omega, t)
        friction = water.thickening * max(1.328 / sqrt(max(speed * per_speed, 1.0)), rows[lanes.TURBULENT, n])
        axial_factor = -0.5 * dense * (table[lanes.SKIN, n] * friction + table[lanes.END, n]) * speed
        f = plus(
            f,
            blend(
                cross_factor * table[lanes.AREA, n] * w[0],
                a,
                cross_factor * table[lanes.AREA + 1, n] * w[1],
                b,
                axial_factor * w[2],
                t,
            ),
        )
        torque = plus(torque, times(-dense * water.cross_drag * table[lanes.ROLL, n] * abs(roll) * roll, t))
        # momentum that is shed, where the tail ends and the water passes towards it
        end = times(table[lanes.SHED_POSITION, n], t)
        end_velocity = plus(lane(rows, lanes.AGAINST, n), cross(omega, end))
        u, wa, wb = dot(end_velocity, t), dot(end_velocity, a), dot(end_velocity, b)
        momentum_flux = dense * water.added_mass_factor * water.shedding * max(u, 0.0)
        pa, pb = momentum_flux * table[lanes.SHED_MASS, n] * wa, momentum_flux * table[lanes.SHED_MASS + 1, n] * wb
        half = (
            0.5
            * dense
            * water.added_mass_factor
            * water.shedding
            * (table[lanes.SHED_MASS, n] * wa * wa + table[lanes.SHED_MASS + 1, n] * wb * wb)
        )
        shed_force = blend(-pa, a, -pb, b, half if u > 0.0 else 0.0, t)
        torque = plus(plus(torque, cross(end, shed_force)), cross(r, plus(f, shed_force)))
        write_lane(rows, lanes.FORCE, n, plus(f, shed_force))
        write_lane(rows, lanes.FORCE - 3, n, torque)
        rows[lanes.WET_FRACTION, n], rows[lanes.WET_VOLUME, n] = fraction, volume


@compile_inline
def added_mass(table: np.ndarray, rows: np.ndarray, water: WaterProperties) -> None:
    """Add the added mass of each piece, as a spatial inertia about the point of reference, and its bias force.

    Args:
        table: table of the pieces, shape (column, lane).
        rows: quantities of the pieces, see ``lanes``; written.
        water: its properties.
    """
    for n in range(LANES):
        dense = water.density * rows[lanes.WET_FRACTION, n] * water.added_mass_factor
        a, b, t = lane(rows, lanes.E_A, n), lane(rows, lanes.E_B, n), lane(rows, lanes.E_T, n)
        ma, mb, mt = (
            dense * table[lanes.ADDED_MASS, n],
            dense * table[lanes.ADDED_MASS + 1, n],
            dense * table[lanes.ADDED_MASS + 2, n],
        )
        tensor = (
            blend(ma * a[0], a, mb * b[0], b, mt * t[0], t),
            blend(ma * a[1], a, mb * b[1], b, mt * t[1], t),
            blend(ma * a[2], a, mb * b[2], b, mt * t[2], t),
        )  # rows of the tensor A
        r, v, omega = lane(rows, lanes.LEVER, n), lane(rows, lanes.AGAINST, n), lane(rows, lanes.MOVING, n)
        alpha, stream = lane(rows, lanes.BIAS, n), lane(rows, lanes.STREAM, n)
        p = dot(tensor[0], v), dot(tensor[1], v), dot(tensor[2], v)
        rate = plus(lane(rows, lanes.BIAS + 3, n), plus(cross(alpha, r), cross(omega, stream)))
        rate = plus(rate, times(-1.0, lane(rows, lanes.SURGE, n)))
        f = plus((dot(tensor[0], rate), dot(tensor[1], rate), dot(tensor[2], rate)), cross(omega, p))
        torque = plus(cross(v, p), cross(r, f))
        write_lane(rows, lanes.FORCE, n, plus(lane(rows, lanes.FORCE, n), times(-1.0, f)))
        write_lane(rows, lanes.FORCE - 3, n, plus(lane(rows, lanes.FORCE - 3, n), times(-1.0, torque)))
        x, y, z = cross(r, tensor[0]), cross(r, tensor[1]), cross(r, tensor[2])  # rows: force by rotation
        write_lane(rows, lanes.COUPLING_INERTIA, n, x)
        write_lane(rows, lanes.COUPLING_INERTIA + 3, n, y)
        write_lane(rows, lanes.COUPLING_INERTIA + 6, n, z)
        write_lane(
            rows,
            lanes.ROTATIONAL_INERTIA,
            n,
            (r[1] * z[0] - r[2] * y[0], r[2] * x[0] - r[0] * z[0], r[2] * x[1] - r[0] * z[1]),
        )
        write_lane(
            rows,
            lanes.ROTATIONAL_INERTIA + 3,
            n,
            (r[0] * y[0] - r[1] * x[0], r[0] * y[1] - r[1] * x[1], r[0] * y[2] - r[1] * x[2]),
        )
        write_lane(rows, lanes.LINEAR_INERTIA, n, (tensor[0][0], tensor[1][0], tensor[1][1]))
        write_lane(rows, lanes.LINEAR_INERTIA + 3, n, (tensor[2][0], tensor[2][1], tensor[2][2]))


@compile_inline
def change_added_mass(
    cut: float, up_axis: Vector, cut_velocity: Vector, twice_energy: float, splash: float
) -> tuple[float, Vector]:
    """Return the rate of the fraction under water with what a splash loses [1/s], and the force on the cut [N].

    The rate times the added mass is a resistance to the motion of the piece. The force acts at the middle of the cut.

    Args:
        cut: area of the cut over the volume of the piece: by how much the fraction falls for each metre of rise [1/m].
        up_axis: unit normal of the surface.
        cut_velocity: velocity against the water of the point of the piece that is at the middle of the cut [m/s].
        twice_energy: twice the kinetic energy of the piece's added mass, if it were all under water [J].
        splash: fraction of what the change of added mass moves that is lost [-].
    """
    rate = -cut * dot(up_axis, cut_velocity)
    return rate + 0.5 * splash * abs(rate), times(-0.5 * cut * twice_energy, up_axis)


@compile_inline
def _emerged_per_rise(kind: float, depth: float) -> float:
    """Return how the share of a unit shape under a plane changes with its depth, see ``immersed``."""
    d = min(max(depth, -1.0), 1.0)
    chord_squared = 1.0 - d * d
    slab = 0.5 if abs(depth) < 1.0 else 0.0
    return 2.0 / pi * sqrt(chord_squared) if kind == DISC else (0.75 * chord_squared if kind == BALL else slab)


@compile_inline
def cross_surface(table: np.ndarray, rows: np.ndarray, water: WaterProperties) -> None:
    """Add the force of the change of added mass to each piece that crosses the surface.

    The depth of a piece is that of its centre over its half extent against gravity, and that extent turns with the
    piece: so the middle of the cut lies at the depth times the point highest up.

    Args:
        table: table of the pieces, shape (column, lane).
        rows: quantities of the pieces, see ``lanes``; written after ``added_mass``.
        water: its properties.
    """
    scale = water.density * water.added_mass_factor
    for n in range(LANES):
        depth, arm = rows[lanes.DEPTH, n], lane(rows, lanes.ARM, n)
        cut = _emerged_per_rise(table[lanes.KIND, n], depth) / dot(water.up_axis, arm)
        lever, r, omega = times(depth, arm), lane(rows, lanes.LEVER, n), lane(rows, lanes.MOVING, n)
        w, m = lane(rows, lanes.SPEED, n), times(scale, lane(table, lanes.ADDED_MASS, n))
        momentum = m[0] * w[0], m[1] * w[1], m[2] * w[2]
        cut_velocity = plus(lane(rows, lanes.AGAINST, n), cross(omega, lever))
        rate, push = change_added_mass(cut, water.up_axis, cut_velocity, dot(momentum, w), water.splash)
        a, b, t = lane(rows, lanes.E_A, n), lane(rows, lanes.E_B, n), lane(rows, lanes.E_T, n)
        force = plus(push, times(-rate, blend(momentum[0], a, momentum[1], b, momentum[2], t)))
        torque = plus(cross(lever, push), cross(r, force))
        write_lane(rows, lanes.FORCE, n, plus(lane(rows, lanes.FORCE, n), force))
        write_lane(rows, lanes.FORCE - 3, n, plus(lane(rows, lanes.FORCE - 3, n), torque))

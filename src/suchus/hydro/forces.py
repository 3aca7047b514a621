"""The formulas: what the water does to one piece, and what is under water of a body at rest.

Added mass is Kirchhoff's: a piece of added inertia A that moves at w against the water has the momentum p = A w; the
water answers its rate of change with a force -(A dw/dt + omega x p) and the couple -w x p (Munk). What is proportional
to the accelerations goes into the mass matrix, the rest to the passive forces. Lighthill's momentum is shed at the
tail's end: -u p' + (p' . w) t / 2, where the water passes towards the tail (u > 0).

After an edit here delete ``__pycache__/*.nb*``: numba looks at the file of the kernel alone.
"""

from math import acos, cos, exp, pi, sin, sqrt

import numpy as np

from suchus.hydro.table import (
    ADDED,
    BALL,
    BREATH,
    CROSS_DRAG,
    CURRENT,
    DENSITY,
    DISC,
    LEVEL,
    SHEDDING,
    THICKENING,
    VISCOSITY,
    WAVE,
)
from suchus.hydro.vectors import Axes, Vector, blend, compiled, cross, dot, part, plus, row3, three, times, turned

_TURBULENT = 5e5
"""Reynolds number from which a plate's turbulent friction counts [-]."""


@part
def immersed(kind: int, d: float) -> tuple[float, float]:
    """Return the share of a unit shape under a plane, and its first moment along the plane's normal.

    Args:
        kind: of the shape.
        d: depth of its centre over its half extent along the normal; beyond -1 and 1 it is dry or under water.
    """
    if d >= 1.0:
        return 1.0, 0.0
    if d <= -1.0:
        return 0.0, 0.0
    rest = 1.0 - d * d
    if kind == DISC:
        root = sqrt(rest)
        return (pi - acos(d) + d * root) / pi, -2.0 / 3.0 * rest * root / pi
    if kind == BALL:
        return (2.0 + 3.0 * d - d**3) / 4.0, -3.0 / 16.0 * rest * rest
    return (1.0 + d) / 2.0, -rest / 4.0


@compiled
def hydrostatic(
    table: np.ndarray, xpos: np.ndarray, xmat: np.ndarray, up: np.ndarray, level: float, breath: float
) -> np.ndarray:
    """Return the volume under water, its first moment about the world's origin, and the work of pushing it there.

    Shape (5,): [m3], three [m4], and the work over density and gravity [m4].


    Args:
        table: of pieces.
        xpos: origins of the bodies, shape (body, 3) [m].
        xmat: their orientations, shape (body, 9).
        up: unit vector against gravity, shape (3,).
        level: of the surface above the origin [m].
        breath: share of the air that is kept [-].
    """
    found, ahead = np.zeros(5), three(up, 0)
    for row in table:
        body = int(row[0])
        axes = turned(xmat[body], row, 5), turned(xmat[body], row, 8), turned(xmat[body], row, 11)
        at = plus(three(xpos[body], 0), turned(xmat[body], row, 2))
        ua, ub, ut = row[14] * dot(ahead, axes[0]), row[15] * dot(ahead, axes[1]), row[16] * dot(ahead, axes[2])
        extent = sqrt(ua * ua + ub * ub + ut * ut)
        depth = (level - dot(ahead, at)) / extent
        share, moment = immersed(int(row[1]), depth)
        arm = blend(row[14] * ua, axes[0], row[15] * ub, axes[1], row[16] * ut, axes[2])
        volume = row[17] - (1.0 - breath) * row[18]
        found[0] += volume * share
        for i in range(3):
            found[1 + i] += volume * (share * at[i] + moment * arm[i] / extent)
        found[4] += volume * extent * (depth * share - moment)
    return found


@part
def _orbit(user: np.ndarray, time: float, x: Vector, up: Vector) -> tuple[float, Vector, Vector]:
    """Return how high waves stand at a point [m], and velocity and acceleration of the water there.

    Airy's waves on deep water, as they are at the surface for points above the level, and the current.
    """
    current, still = three(user, CURRENT), (0.0, 0.0, 0.0)
    height, omega = user[WAVE], user[WAVE + 4]
    if height == 0.0:
        return 0.0, current, still
    wave = three(user, WAVE + 1)
    number = sqrt(dot(wave, wave))
    phase = dot(wave, x) - omega * time + user[WAVE + 5]
    c, s = cos(phase), sin(phase)
    speed = height * omega * exp(number * min(dot(up, x) - user[LEVEL], 0.0))
    moving = blend(1.0, current, speed * c / number, wave, speed * s, up)
    return height * c, moving, blend(omega * speed * s / number, wave, -omega * speed * c, up, 0.0, still)


@part
def _rub(speed: float, length: float, viscosity: float) -> float:
    """Return the friction coefficient of a plate times the speed [m/s]: laminar, or turbulent where that is more."""
    if speed == 0.0:
        return 0.0
    reynolds = max(abs(speed) * length / viscosity, 1.0)
    laminar = 1.328 / sqrt(reynolds)
    if reynolds > _TURBULENT:
        return max(laminar, 0.074 * reynolds**-0.2) * abs(speed)
    return laminar * abs(speed)


@part
def _drag(
    row: np.ndarray, axes: Axes, w: Vector, roll: float, user: np.ndarray, length: float
) -> tuple[Vector, Vector]:
    """Return drag across and along a piece, and the couple of a flat piece that rolls, over its share under water."""
    rho, coefficient = user[DENSITY], user[CROSS_DRAG]
    across = -0.5 * rho * coefficient * sqrt(w[0] * w[0] + w[1] * w[1])
    along = -0.5 * rho * (row[24] * user[THICKENING] * _rub(w[2], length, user[VISCOSITY]) + row[25] * abs(w[2]))
    force = blend(across * row[22] * w[0], axes[0], across * row[23] * w[1], axes[1], along * w[2], axes[2])
    return force, times(-rho * coefficient * row[26] * abs(roll) * roll, axes[2])


@part
def _shed(row: np.ndarray, axes: Axes, v: Vector, omega: Vector, dense: float) -> tuple[Vector, Vector]:
    """Return force and couple of the momentum that is shed where the tail ends."""
    none = (0.0, 0.0, 0.0)
    if row[27] + row[28] <= 0.0:
        return none, none
    arm = times(row[29], axes[2])
    here = plus(v, cross(omega, arm))
    u = dot(here, axes[2])
    if u <= 0.0:
        return none, none
    wa, wb = dot(here, axes[0]), dot(here, axes[1])
    pa, pb = dense * row[27] * wa, dense * row[28] * wb
    force = blend(-u * pa, axes[0], -u * pb, axes[1], 0.5 * (pa * wa + pb * wb), axes[2])
    return force, cross(arm, force)


@part
def _spatial(mass: float, axis: Vector, r: Vector, inertia: np.ndarray, b: int) -> None:
    """Add the inertia of a point at r that resists along one axis only to the spatial inertia of a body, (21,).

    Of the symmetric (6, 6) only the lower half is kept, row by row; written out, since numba picks the parts of a tuple
    one by one where the index is not known beforehand.
    """
    turn = cross(r, axis)
    g0, g1, g2 = mass * turn[0], mass * turn[1], mass * turn[2]
    g3, g4, g5 = mass * axis[0], mass * axis[1], mass * axis[2]
    inertia[b, 0] += g0 * turn[0]
    inertia[b, 1] += g1 * turn[0]
    inertia[b, 2] += g1 * turn[1]
    inertia[b, 3] += g2 * turn[0]
    inertia[b, 4] += g2 * turn[1]
    inertia[b, 5] += g2 * turn[2]
    inertia[b, 6] += g3 * turn[0]
    inertia[b, 7] += g3 * turn[1]
    inertia[b, 8] += g3 * turn[2]
    inertia[b, 9] += g3 * axis[0]
    inertia[b, 10] += g4 * turn[0]
    inertia[b, 11] += g4 * turn[1]
    inertia[b, 12] += g4 * turn[2]
    inertia[b, 13] += g4 * axis[0]
    inertia[b, 14] += g4 * axis[1]
    inertia[b, 15] += g5 * turn[0]
    inertia[b, 16] += g5 * turn[1]
    inertia[b, 17] += g5 * turn[2]
    inertia[b, 18] += g5 * axis[0]
    inertia[b, 19] += g5 * axis[1]
    inertia[b, 20] += g5 * axis[2]


@part
def piece(
    row: np.ndarray,
    b: int,
    poses: tuple[np.ndarray, np.ndarray, np.ndarray],
    motion: np.ndarray,
    bias: np.ndarray,
    up: Vector,
    gravity: float,
    user: np.ndarray,
    time: float,
    length: float,
    force: np.ndarray,
    inertia: np.ndarray,
) -> float:
    """Add what the water does to one piece to the force and the added inertia of its body.

    Args:
        row: of the table.
        b: number of the body.
        poses: origins (body, 3) and orientations (body, 9) of the bodies, and the point of reference (3,).
        motion: spatial velocities of the bodies, (body, 6).
        bias: their spatial accelerations without those of the joints, (body, 6).
        up: against gravity.
        gravity: its size [m/s2].
        user: the numbers of the water.
        time: [s].
        length: for the Reynolds number [m].
        force: spatial forces on the bodies, (body, 6), changed.
        inertia: lower halves of the spatial added inertias of the bodies, (body, 21), changed.

    Returns:
        The volume under water [m3].
    """
    turn = poses[1][b]
    axes = turned(turn, row, 5), turned(turn, row, 8), turned(turn, row, 11)
    at = plus(row3(poses[0], b, 0), turned(turn, row, 2))
    raised, stream, surge = _orbit(user, time, at, up)
    ua, ub, ut = row[14] * dot(up, axes[0]), row[15] * dot(up, axes[1]), row[16] * dot(up, axes[2])
    extent = sqrt(ua * ua + ub * ub + ut * ut)
    share, moment = immersed(int(row[1]), (user[LEVEL] + raised - dot(up, at)) / extent)
    if share <= 0.0:
        return 0.0
    volume = (row[17] - (1.0 - user[BREATH]) * row[18]) * share
    r = plus(at, times(-1.0, three(poses[2], 0)))
    omega, alpha = row3(motion, b, 0), row3(bias, b, 0)
    v = plus(row3(motion, b, 3), plus(cross(omega, r), times(-1.0, stream)))  # of the centre against the water
    w = dot(v, axes[0]), dot(v, axes[1]), dot(v, axes[2])
    # buoyancy and the pressure of the waves, at the centre of what is under water
    f = times(user[DENSITY] * volume, plus(times(gravity, up), surge))
    arm = blend(row[14] * ua, axes[0], row[15] * ub, axes[1], row[16] * ut, axes[2])
    torque = cross(times(moment / (share * extent), arm), f)
    rubbed, couple = _drag(row, axes, w, dot(omega, axes[2]), user, length)
    f, torque = plus(f, times(share, rubbed)), plus(torque, times(share, couple))
    dense = user[DENSITY] * share * user[ADDED]
    if dense > 0.0:  # added mass: its bias here, the rest in the matrix
        ma, mb, mt = dense * row[19], dense * row[20], dense * row[21]
        p = blend(ma * w[0], axes[0], mb * w[1], axes[1], mt * w[2], axes[2])
        a = plus(row3(bias, b, 3), plus(cross(alpha, r), plus(cross(omega, stream), times(-1.0, surge))))
        rate = blend(ma * dot(a, axes[0]), axes[0], mb * dot(a, axes[1]), axes[1], mt * dot(a, axes[2]), axes[2])
        lost, twist = _shed(row, axes, v, omega, dense * user[SHEDDING])
        f = plus(f, blend(-1.0, rate, -1.0, cross(omega, p), 1.0, lost))
        torque = plus(torque, blend(-1.0, cross(v, p), 1.0, twist, 0.0, twist))
        _spatial(ma, axes[0], r, inertia, b)
        _spatial(mb, axes[1], r, inertia, b)
        if mt > 0.0:
            _spatial(mt, axes[2], r, inertia, b)
    torque = plus(torque, cross(r, f))
    force[b, 0] += torque[0]
    force[b, 1] += torque[1]
    force[b, 2] += torque[2]
    force[b, 3] += f[0]
    force[b, 4] += f[1]
    force[b, 5] += f[2]
    return volume

"""The compiled kernel: what the water does to a body of pieces, inside the physics step.

It reads a MuJoCo model and its data at addresses and byte offsets that it is given (see ``land.structs``), so that it
needs neither MuJoCo nor Python's lock while it runs. All spatial vectors are MuJoCo's: rotation first, about the centre
of mass of the whole tree.

Added mass is Kirchhoff's: a piece of added inertia A that moves at w against the water has the momentum p = A w; the
water answers its rate of change with a force -(A dw/dt + omega x p) and the couple -w x p (Munk). What is proportional
to the accelerations goes into the mass matrix, the rest to the passive forces. Lighthill's momentum is shed at the
tail's end: -u p' + (p' . w) t / 2, where the water passes towards the tail (u > 0).
"""

from collections.abc import Callable
from math import acos, cos, exp, pi, sin, sqrt
from typing import ParamSpec, TypeVar

import numpy as np
from numba import carray, njit, types
from numba.core import cgutils
from numba.extending import intrinsic

from suchus.hydro.table import (
    ADDED,
    BALL,
    BREATH,
    COLUMNS,
    CROSS_DRAG,
    CURRENT,
    DENSITY,
    DISC,
    FORCE,
    HEADER,
    LEVEL,
    MAGIC,
    NUMBERS,
    POWER,
    SHEDDING,
    THICKENING,
    UNDER,
    VISCOSITY,
    WAVE,
    WIDTH,
)

FIELDS = (
    "nv", "nbody", "nnumericdata", "nuserdata", "opt.gravity", "numeric_data", "body_parentid", "body_rootid",
    "body_dofadr", "body_dofnum", "dof_bodyid", "M_rownnz", "M_rowadr", "M_colind",
)  # fmt: skip
"""Fields of the model whose offsets the kernel needs, in the order of the table of offsets; then those of the data."""
DATA_FIELDS = (
    "time", "qvel", "qacc", "xpos", "xmat", "subtree_com", "cvel", "cdof", "cdof_dot", "qfrc_passive", "M", "userdata",
)  # fmt: skip
"""Fields of the data."""
(
    _NV, _NBODY, _NNUMERIC, _NUSER, _GRAVITY, _NUMERIC, _PARENT, _ROOT, _DOFADR, _DOFNUM, _DOFBODY, _ROWNNZ, _ROWADR,
    _COLIND, _TIME, _QVEL, _QACC, _XPOS, _XMAT, _COM, _CVEL, _CDOF, _CDOFDOT, _PASSIVE, _MASS, _USER,
) = range(26)  # fmt: skip

Vector = tuple[float, float, float]
Axes = tuple[Vector, Vector, Vector]
_REACH = COLUMNS["reach"][0]
_TURBULENT = 5e5
"""Reynolds number from which a plate's turbulent friction counts [-]."""
P = ParamSpec("P")
R = TypeVar("R")


def _compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compile what is called from outside; keep the code on disk (``NUMBA_CACHE_DIR`` moves it)."""
    options = {"nogil": True, "error_model": "numpy"}
    try:
        made: Callable[P, R] = njit(cache=True, **options)(function)
    except RuntimeError:  # neither this folder nor the user's cache can be written: compile anew every time
        made = njit(**options)(function)
    return made


def _part(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a part of these, which nothing else calls."""
    made: Callable[P, R] = njit(nogil=True, error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True)(
        function
    )
    return made


@intrinsic
def _pointer(typing, address):  # type: ignore[no-untyped-def]
    """Take a number for an address."""
    del typing, address

    def generate(context, builder, signature, given):  # type: ignore[no-untyped-def]
        del context, signature
        return builder.inttoptr(given[0], cgutils.voidptr_t)

    return types.voidptr(types.int64), generate


@_part
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


@_part
def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@_part
def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@_part
def _plus(a: Vector, b: Vector) -> Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@_part
def _times(a: float, b: Vector) -> Vector:
    return a * b[0], a * b[1], a * b[2]


@_part
def _blend(a: float, x: Vector, b: float, y: Vector, c: float, z: Vector) -> Vector:
    return a * x[0] + b * y[0] + c * z[0], a * x[1] + b * y[1] + c * z[1], a * x[2] + b * y[2] + c * z[2]


@_part
def _three(values: np.ndarray, start: int) -> Vector:
    return values[start], values[start + 1], values[start + 2]


@_part
def _row(values: np.ndarray, row: int, start: int) -> Vector:
    return values[row, start], values[row, start + 1], values[row, start + 2]


@_part
def _turned(xmat: np.ndarray, values: np.ndarray, start: int) -> Vector:
    """Return three numbers of a row, a vector in the frame of a body, in the world."""
    v = _three(values, start)
    return _dot(_three(xmat, 0), v), _dot(_three(xmat, 3), v), _dot(_three(xmat, 6), v)


@_compiled
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
    found, ahead = np.zeros(5), _three(up, 0)
    for row in table:
        body = int(row[0])
        axes = _turned(xmat[body], row, 5), _turned(xmat[body], row, 8), _turned(xmat[body], row, 11)
        at = _plus(_three(xpos[body], 0), _turned(xmat[body], row, 2))
        ua, ub, ut = row[14] * _dot(ahead, axes[0]), row[15] * _dot(ahead, axes[1]), row[16] * _dot(ahead, axes[2])
        extent = sqrt(ua * ua + ub * ub + ut * ut)
        depth = (level - _dot(ahead, at)) / extent
        share, moment = immersed(int(row[1]), depth)
        arm = _blend(row[14] * ua, axes[0], row[15] * ub, axes[1], row[16] * ut, axes[2])
        volume = row[17] - (1.0 - breath) * row[18]
        found[0] += volume * share
        for i in range(3):
            found[1 + i] += volume * (share * at[i] + moment * arm[i] / extent)
        found[4] += volume * extent * (depth * share - moment)
    return found


@_part
def _orbit(user: np.ndarray, time: float, x: Vector, up: Vector) -> tuple[float, Vector, Vector]:
    """Return how high waves stand at a point [m], and velocity and acceleration of the water there.

    Airy's waves on deep water, as they are at the surface for points above the level, and the current.
    """
    current, still = _three(user, CURRENT), (0.0, 0.0, 0.0)
    height, omega = user[WAVE], user[WAVE + 4]
    if height == 0.0:
        return 0.0, current, still
    wave = _three(user, WAVE + 1)
    number = sqrt(_dot(wave, wave))
    phase = _dot(wave, x) - omega * time + user[WAVE + 5]
    c, s = cos(phase), sin(phase)
    speed = height * omega * exp(number * min(_dot(up, x) - user[LEVEL], 0.0))
    moving = _blend(1.0, current, speed * c / number, wave, speed * s, up)
    return height * c, moving, _blend(omega * speed * s / number, wave, -omega * speed * c, up, 0.0, still)


@_part
def _rub(speed: float, length: float, viscosity: float) -> float:
    """Return the friction coefficient of a plate times the speed [m/s]: laminar, or turbulent where that is more."""
    if speed == 0.0:
        return 0.0
    reynolds = max(abs(speed) * length / viscosity, 1.0)
    laminar = 1.328 / sqrt(reynolds)
    if reynolds > _TURBULENT:
        return max(laminar, 0.074 * reynolds**-0.2) * abs(speed)
    return laminar * abs(speed)


@_part
def _drag(
    row: np.ndarray, axes: Axes, w: Vector, roll: float, user: np.ndarray, length: float
) -> tuple[Vector, Vector]:
    """Return drag across and along a piece, and the couple of a flat piece that rolls, over its share under water."""
    rho, coefficient = user[DENSITY], user[CROSS_DRAG]
    across = -0.5 * rho * coefficient * sqrt(w[0] * w[0] + w[1] * w[1])
    along = -0.5 * rho * (row[24] * user[THICKENING] * _rub(w[2], length, user[VISCOSITY]) + row[25] * abs(w[2]))
    force = _blend(across * row[22] * w[0], axes[0], across * row[23] * w[1], axes[1], along * w[2], axes[2])
    return force, _times(-rho * coefficient * row[26] * abs(roll) * roll, axes[2])


@_part
def _shed(row: np.ndarray, axes: Axes, v: Vector, omega: Vector, dense: float) -> tuple[Vector, Vector]:
    """Return force and couple of the momentum that is shed where the tail ends."""
    none = (0.0, 0.0, 0.0)
    if row[27] + row[28] <= 0.0:
        return none, none
    arm = _times(row[29], axes[2])
    here = _plus(v, _cross(omega, arm))
    u = _dot(here, axes[2])
    if u <= 0.0:
        return none, none
    wa, wb = _dot(here, axes[0]), _dot(here, axes[1])
    pa, pb = dense * row[27] * wa, dense * row[28] * wb
    force = _blend(-u * pa, axes[0], -u * pb, axes[1], 0.5 * (pa * wa + pb * wb), axes[2])
    return force, _cross(arm, force)


@_part
def _spatial(mass: float, axis: Vector, r: Vector, inertia: np.ndarray, b: int) -> None:
    """Add the inertia of a point at r that resists along one axis only to the spatial inertia of a body, (21,).

    Of the symmetric (6, 6) only the lower half is kept, row by row; written out, since numba picks the parts of a tuple
    one by one where the index is not known beforehand.
    """
    turn = _cross(r, axis)
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


@_part
def _piece(
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
    axes = _turned(turn, row, 5), _turned(turn, row, 8), _turned(turn, row, 11)
    at = _plus(_row(poses[0], b, 0), _turned(turn, row, 2))
    raised, stream, surge = _orbit(user, time, at, up)
    ua, ub, ut = row[14] * _dot(up, axes[0]), row[15] * _dot(up, axes[1]), row[16] * _dot(up, axes[2])
    extent = sqrt(ua * ua + ub * ub + ut * ut)
    share, moment = immersed(int(row[1]), (user[LEVEL] + raised - _dot(up, at)) / extent)
    if share <= 0.0:
        return 0.0
    volume = (row[17] - (1.0 - user[BREATH]) * row[18]) * share
    r = _plus(at, _times(-1.0, _three(poses[2], 0)))
    omega, alpha = _row(motion, b, 0), _row(bias, b, 0)
    v = _plus(_row(motion, b, 3), _plus(_cross(omega, r), _times(-1.0, stream)))  # of the centre against the water
    w = _dot(v, axes[0]), _dot(v, axes[1]), _dot(v, axes[2])
    # buoyancy and the pressure of the waves, at the centre of what is under water
    f = _times(user[DENSITY] * volume, _plus(_times(gravity, up), surge))
    arm = _blend(row[14] * ua, axes[0], row[15] * ub, axes[1], row[16] * ut, axes[2])
    torque = _cross(_times(moment / (share * extent), arm), f)
    rubbed, couple = _drag(row, axes, w, _dot(omega, axes[2]), user, length)
    f, torque = _plus(f, _times(share, rubbed)), _plus(torque, _times(share, couple))
    dense = user[DENSITY] * share * user[ADDED]
    if dense > 0.0:  # added mass: its bias here, the rest in the matrix
        ma, mb, mt = dense * row[19], dense * row[20], dense * row[21]
        p = _blend(ma * w[0], axes[0], mb * w[1], axes[1], mt * w[2], axes[2])
        a = _plus(_row(bias, b, 3), _plus(_cross(alpha, r), _plus(_cross(omega, stream), _times(-1.0, surge))))
        rate = _blend(ma * _dot(a, axes[0]), axes[0], mb * _dot(a, axes[1]), axes[1], mt * _dot(a, axes[2]), axes[2])
        lost, twist = _shed(row, axes, v, omega, dense * user[SHEDDING])
        f = _plus(f, _blend(-1.0, rate, -1.0, _cross(omega, p), 1.0, lost))
        torque = _plus(torque, _blend(-1.0, _cross(v, p), 1.0, twist, 0.0, twist))
        _spatial(ma, axes[0], r, inertia, b)
        _spatial(mb, axes[1], r, inertia, b)
        if mt > 0.0:
            _spatial(mt, axes[2], r, inertia, b)
    torque = _plus(torque, _cross(r, f))
    force[b, 0] += torque[0]
    force[b, 1] += torque[1]
    force[b, 2] += torque[2]
    force[b, 3] += f[0]
    force[b, 4] += f[1]
    force[b, 5] += f[2]
    return volume


@_compiled
def wet(model: int, data: int, at: np.ndarray) -> bool:
    """Add the forces of the water to the passive forces, and its added mass to the matrix; tell whether that changed.

    Args:
        model: address of a ``mjModel``.
        data: address of its ``mjData``.
        at: offsets of ``FIELDS`` and ``DATA_FIELDS`` [byte].
    """
    whole, count = carray(model, (4096,), np.int64), at[_NNUMERIC] // 8
    if whole[count] < HEADER:
        return False
    numbers = carray(_pointer(whole[at[_NUMERIC] // 8]), (whole[count],), np.float64)
    if numbers[0] != MAGIC or whole[at[_NUSER] // 8] < NUMBERS:
        return False
    return _wet(model, data, at, numbers)


@_part
def _wet(model: int, data: int, at: np.ndarray, numbers: np.ndarray) -> bool:
    """Gather what the water does piece by piece and body by body, and hand it to the joints."""
    whole, real = carray(model, (4096,), np.int64), carray(model, (4096,), np.float64)
    state, clock = carray(data, (65536,), np.int64), carray(data, (65536,), np.float64)
    nv, nbody = whole[at[_NV] // 8], whole[at[_NBODY] // 8]
    parent = carray(_pointer(whole[at[_PARENT] // 8]), (nbody,), np.int32)
    root = carray(_pointer(whole[at[_ROOT] // 8]), (nbody,), np.int32)
    first = carray(_pointer(whole[at[_DOFADR] // 8]), (nbody,), np.int32)
    dofs = carray(_pointer(whole[at[_DOFNUM] // 8]), (nbody,), np.int32)
    owner = carray(_pointer(whole[at[_DOFBODY] // 8]), (nv,), np.int32)
    xpos = carray(_pointer(state[at[_XPOS] // 8]), (nbody, 3), np.float64)
    xmat = carray(_pointer(state[at[_XMAT] // 8]), (nbody, 9), np.float64)
    com = carray(_pointer(state[at[_COM] // 8]), (nbody, 3), np.float64)
    cvel = carray(_pointer(state[at[_CVEL] // 8]), (nbody, 6), np.float64)
    cdof = carray(_pointer(state[at[_CDOF] // 8]), (nv, 6), np.float64)
    cdof_dot = carray(_pointer(state[at[_CDOFDOT] // 8]), (nv, 6), np.float64)
    qvel = carray(_pointer(state[at[_QVEL] // 8]), (nv,), np.float64)
    passive = carray(_pointer(state[at[_PASSIVE] // 8]), (nv,), np.float64)
    user = carray(_pointer(state[at[_USER] // 8]), (NUMBERS,), np.float64)
    down = _three(real, at[_GRAVITY] // 8)
    gravity = sqrt(_dot(down, down))
    up = _times(-1.0 / gravity, down) if gravity > 0.0 else (0.0, 0.0, 1.0)
    bias = np.zeros((nbody, 6))
    for b in range(1, nbody):
        for i in range(6):
            bias[b, i] = bias[parent[b], i]
            for j in range(first[b], first[b] + dofs[b]):
                bias[b, i] += cdof_dot[j, i] * qvel[j]
    force, inertia, under = np.zeros((nbody, 6)), np.zeros((nbody, 21)), 0.0
    table = numbers[HEADER:]
    for n in range(int(numbers[1])):
        row = table[n * WIDTH : (n + 1) * WIDTH]
        b = int(row[0])
        if user[LEVEL] + abs(user[WAVE]) - _dot(up, _row(xpos, b, 0)) <= -row[_REACH]:
            continue  # far above the surface
        poses = xpos, xmat, com[root[b]]
        under += _piece(row, b, poses, cvel, bias, up, gravity, user, clock[at[_TIME] // 8], numbers[2], force, inertia)
    for i in range(4):
        user[FORCE + i] = 0.0
    user[UNDER] = under
    if under == 0.0:
        return False
    if user[ADDED] > 0.0:
        qacc = carray(_pointer(state[at[_QACC] // 8]), (nv,), np.float64)
        _taken(parent, first, dofs, cdof, qacc, cvel, inertia, user)
    for b in range(nbody - 1, 0, -1):
        if parent[b] > 0:
            for i in range(6):
                force[parent[b], i] += force[b, i]
            for i in range(21):
                inertia[parent[b], i] += inertia[b, i]
        else:
            for i in range(3):
                user[FORCE + i] += force[b, 3 + i]
    for i in range(nv):
        acts = 0.0
        for k in range(6):
            acts += cdof[i, k] * force[owner[i], k]
        passive[i] += acts
        user[POWER] += acts * qvel[i]
    if user[ADDED] <= 0.0:
        return False
    _burden(whole, state, at, inertia, cdof, owner)
    return True


@_part
def _taken(
    parent: np.ndarray,
    first: np.ndarray,
    dofs: np.ndarray,
    cdof: np.ndarray,
    qacc: np.ndarray,
    cvel: np.ndarray,
    inertia: np.ndarray,
    user: np.ndarray,
) -> None:
    """Take from force and power of the water what the added mass takes by the accelerations of the last step."""
    acceleration = np.zeros((len(parent), 6))
    for b in range(1, len(parent)):
        for i in range(6):
            acceleration[b, i] = acceleration[parent[b], i]
            for j in range(first[b], first[b] + dofs[b]):
                acceleration[b, i] += cdof[j, i] * qacc[j]
        if inertia[b, 9] + inertia[b, 14] + inertia[b, 20] <= 0.0:
            continue
        for i in range(6):
            k, reaction = i * (i + 1) // 2, 0.0
            for n in range(i + 1):
                reaction += inertia[b, k + n] * acceleration[b, n]
            for n in range(i + 1, 6):
                reaction += inertia[b, n * (n + 1) // 2 + i] * acceleration[b, n]
            user[POWER] -= reaction * cvel[b, i]
            if i > 2:
                user[FORCE + i - 3] -= reaction


@_part
def _burden(
    whole: np.ndarray, state: np.ndarray, at: np.ndarray, inertia: np.ndarray, cdof: np.ndarray, owner: np.ndarray
) -> None:
    """Add the composite added inertia to the joints' matrix."""
    nv = len(owner)
    rownnz = carray(_pointer(whole[at[_ROWNNZ] // 8]), (nv,), np.int32)
    rowadr = carray(_pointer(whole[at[_ROWADR] // 8]), (nv,), np.int32)
    size = rowadr[nv - 1] + rownnz[nv - 1]
    column = carray(_pointer(whole[at[_COLIND] // 8]), (size,), np.int32)
    mass = carray(_pointer(state[at[_MASS] // 8]), (size,), np.float64)
    given = np.empty(6)
    for i in range(nv):
        b = owner[i]
        for k in range(6):
            given[k] = 0.0
        for k in range(6):
            for n in range(k):
                given[k] += inertia[b, k * (k + 1) // 2 + n] * cdof[i, n]
                given[n] += inertia[b, k * (k + 1) // 2 + n] * cdof[i, k]
            given[k] += inertia[b, k * (k + 3) // 2] * cdof[i, k]
        for n in range(rowadr[i], rowadr[i] + rownnz[i]):
            j, more = column[n], 0.0
            for k in range(6):
                more += cdof[j, k] * given[k]
            mass[n] += more

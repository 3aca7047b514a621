"""The compiled kernel: reads a MuJoCo model and its data, gathers what the water does, hands it to the joints.

It is given addresses and byte offsets (see ``land.structs``), so that it needs neither MuJoCo nor Python's lock while
it runs. All spatial vectors are MuJoCo's: rotation first, about the centre of mass of the whole tree.
"""

from math import sqrt

import numpy as np
from numba import carray, types
from numba.core import cgutils
from numba.extending import intrinsic

from suchus.hydro.forces import piece
from suchus.hydro.table import ADDED, COLUMNS, FORCE, HEADER, LEVEL, MAGIC, NUMBERS, POWER, UNDER, WAVE, WIDTH
from suchus.hydro.vectors import Vector, compiled, dot, part, row3, three, times

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

_REACH = COLUMNS["reach"][0]


@intrinsic
def _pointer(typing, address):  # type: ignore[no-untyped-def]
    """Take a number for an address."""
    del typing, address

    def generate(context, builder, signature, given):  # type: ignore[no-untyped-def]
        del context, signature
        return builder.inttoptr(given[0], cgutils.voidptr_t)

    return types.voidptr(types.int64), generate


@compiled
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


@part
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
    down = three(real, at[_GRAVITY] // 8)
    gravity = sqrt(dot(down, down))
    up = times(-1.0 / gravity, down) if gravity > 0.0 else (0.0, 0.0, 1.0)
    table, surface = numbers[HEADER:], user[LEVEL] + abs(user[WAVE])
    near = 0  # the first piece that is not far above the surface
    while near < int(numbers[1]) and _dry(table, near, surface, up, xpos):
        near += 1
    for i in range(4):
        user[FORCE + i] = 0.0
    user[UNDER] = 0.0
    if near == int(numbers[1]):
        return False
    bias = np.zeros((nbody, 6))
    for b in range(1, nbody):
        for i in range(6):
            bias[b, i] = bias[parent[b], i]
            for j in range(first[b], first[b] + dofs[b]):
                bias[b, i] += cdof_dot[j, i] * qvel[j]
    force, inertia, under = np.zeros((nbody, 6)), np.zeros((nbody, 21)), 0.0
    for n in range(near, int(numbers[1])):
        if _dry(table, n, surface, up, xpos):
            continue
        row = table[n * WIDTH : (n + 1) * WIDTH]
        b = int(row[0])
        poses = xpos, xmat, com[root[b]]
        under += piece(row, b, poses, cvel, bias, up, gravity, user, clock[at[_TIME] // 8], numbers[2], force, inertia)
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
    power = user[POWER]  # memory is not summed up in: the compiler cannot know that nothing else lies there
    for i in range(nv):
        acts, b = 0.0, owner[i]
        for k in range(6):
            acts += cdof[i, k] * force[b, k]
        passive[i] += acts
        power += acts * qvel[i]
    user[POWER] = power
    if user[ADDED] <= 0.0:
        return False
    _burden(whole, state, at, inertia, cdof, owner)
    return True


@part
def _dry(table: np.ndarray, n: int, surface: float, up: Vector, xpos: np.ndarray) -> bool:
    """Return whether a piece is far above the surface."""
    return surface - dot(up, row3(xpos, int(table[n * WIDTH]), 0)) <= -table[n * WIDTH + _REACH]


@part
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
    power, pulled = user[POWER], three(user, FORCE)
    for b in range(1, len(parent)):
        for i in range(6):
            sum_ = acceleration[parent[b], i]
            for j in range(first[b], first[b] + dofs[b]):
                sum_ += cdof[j, i] * qacc[j]
            acceleration[b, i] = sum_
        if inertia[b, 9] + inertia[b, 14] + inertia[b, 20] <= 0.0:
            continue
        for i in range(6):
            k, reaction = i * (i + 1) // 2, 0.0
            for n in range(i + 1):
                reaction += inertia[b, k + n] * acceleration[b, n]
            for n in range(i + 1, 6):
                reaction += inertia[b, n * (n + 1) // 2 + i] * acceleration[b, n]
            power -= reaction * cvel[b, i]
            if i == 3:
                pulled = pulled[0] - reaction, pulled[1], pulled[2]
            elif i == 4:
                pulled = pulled[0], pulled[1] - reaction, pulled[2]
            elif i == 5:
                pulled = pulled[0], pulled[1], pulled[2] - reaction
    user[POWER] = power
    for i in range(3):
        user[FORCE + i] = pulled[i]


@part
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

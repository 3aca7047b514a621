"""MuJoCo's memory as the kernel reads it: a model and its data at addresses, their fields at byte offsets."""

from math import sqrt
from typing import NamedTuple

import numpy as np
from numba import carray, types
from numba.core import cgutils
from numba.extending import intrinsic

from suchus.core.plate_table import LOAD_NUMBERS, PLATE_LOADS, PLATE_MAGIC
from suchus.core.water_table import (
    ADDED_MASS_FACTOR,
    AIR_FRACTION,
    CROSS_DRAG,
    DENSITY,
    HEADER,
    LEVEL,
    LOAD_WIDTH,
    MAGIC,
    NUMBERS,
    SHAPE_MAGIC,
    SHEDDING,
    SPLASH,
    THICKENING,
    VISCOSITY,
)
from suchus.sim.hydro.lanes import WaterProperties
from suchus.sim.hydro.vectors import compile_inline, dot, three, times

FIELDS = (
    "nv", "nbody", "nnumericdata", "nuserdata", "opt.gravity", "numeric_data", "body_parentid", "body_rootid",
    "body_dofadr", "body_dofnum", "dof_bodyid", "M_rownnz", "M_rowadr", "M_colind", "nnumeric", "numeric_adr",
    "numeric_size", "opt.timestep", "opt.integrator",
)  # fmt: skip
"""Fields of the model whose offsets the kernel needs, in the order of the table of offsets; then those of the data."""
DATA_FIELDS = (
    "time", "qvel", "qacc", "xpos", "xmat", "subtree_com", "cvel", "cdof", "cdof_dot", "qfrc_passive", "M", "userdata",
)  # fmt: skip
"""Fields of the data."""
(
    _NV, NBODY, NNUMERIC, NUSER, _GRAVITY, NUMERIC, _PARENT, _ROOT, _DOFADR, _DOFNUM, _DOFBODY, _ROWNNZ, _ROWADR,
    _COLIND, _NNUMERIC, _NUMERIC_START, _NUMERIC_SIZE, _TIMESTEP, _INTEGRATOR,
    _TIME, _QVEL, _QACC, _XPOS, _XMAT, _COM, _CVEL, _CDOF, _CDOFDOT, _PASSIVE, _MASS, _USER,
) = range(31)  # fmt: skip


_RUNGE_KUTTA = 1
"""Number of MuJoCo's integrator of fourth order (``mjINT_RK4``)."""


@intrinsic
def pointer(typing, address):  # type: ignore[no-untyped-def]
    """Take a number for an address."""
    del typing, address

    def generate(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        del context, signature
        return builder.inttoptr(arguments[0], cgutils.voidptr_t)

    return types.voidptr(types.int64), generate


class Bodies(NamedTuple):
    """The tree of bodies and degrees of freedom (dof) of a MuJoCo model, and the pattern of its mass matrix."""

    parent: np.ndarray
    """Index of each body's parent, shape (body,)."""
    root: np.ndarray
    """First body of each body's tree, shape (body,)."""
    first_dof: np.ndarray
    """First degree of freedom of each body, shape (body,)."""
    dof_counts: np.ndarray
    """Number of degrees of freedom of each body, shape (body,)."""
    owner: np.ndarray
    """Body that each degree of freedom moves, shape (dof,)."""
    rownnz: np.ndarray
    """Number of entries in each row of the sparse mass matrix, shape (dof,)."""
    rowadr: np.ndarray
    """Index of the first entry of each row, shape (dof,)."""
    column: np.ndarray
    """Degree of freedom of each entry's column, shape (entry,)."""


class Motion(NamedTuple):
    """Where the bodies are and how they move, in the world."""

    time: float
    """Time of the simulation [s]."""
    xpos: np.ndarray
    """Origins (body, 3) [m]."""
    xmat: np.ndarray
    """Orientations (body, 9)."""
    com: np.ndarray
    """Centres of mass of the subtrees (body, 3) [m]."""
    cvel: np.ndarray
    """Spatial velocities (body, 6)."""
    cdof: np.ndarray
    """Spatial velocities by the joints (joint, 6)."""
    cdof_dot: np.ndarray
    """Their rates (joint, 6)."""
    qvel: np.ndarray
    """Velocities of the joints (joint,)."""
    qacc: np.ndarray
    """Their accelerations in the last step (joint,)."""
    passive: np.ndarray
    """Passive forces on them (joint,), changed."""
    mass: np.ndarray
    """The matrix, changed."""
    user: np.ndarray
    """The numbers of the water, changed."""


@compile_inline
def find_table(model: int, offsets: np.ndarray) -> tuple[float, int, int]:
    """Return the first number of a model's table, and the table's start and size among the custom numbers.

    The first number is 0 where the model has no table.

    Args:
        model: address of a ``mjModel``.
        offsets: offsets of ``FIELDS`` and ``DATA_FIELDS`` [byte].
    """
    words = carray(model, (4096,), np.int64)
    count, numbers = words[offsets[_NNUMERIC] // 8], words[offsets[NNUMERIC] // 8]
    starts = carray(pointer(words[offsets[_NUMERIC_START] // 8]), (count,), np.int32)
    sizes = carray(pointer(words[offsets[_NUMERIC_SIZE] // 8]), (count,), np.int32)
    values = carray(pointer(words[offsets[NUMERIC] // 8]), (numbers,), np.float64)
    for i in range(count):
        first = values[starts[i]]
        if sizes[i] >= HEADER and first in (MAGIC, SHAPE_MAGIC, PLATE_MAGIC):
            return first, starts[i], sizes[i]
    return 0.0, 0, 0


@compile_inline
def read_implicit_step(model: int, offsets: np.ndarray) -> float:
    """Return the time step if drag is taken at its end, 0 for the stages of a Runge-Kutta step [s]."""
    step = carray(model, (4096,), np.float64)[offsets[_TIMESTEP] // 8]
    return 0.0 if carray(model, (8192,), np.int32)[offsets[_INTEGRATOR] // 4] == _RUNGE_KUTTA else step


@compile_inline
def read_bodies(model: int, offsets: np.ndarray) -> Bodies:
    """Return the tree of a model."""
    model_words = carray(model, (4096,), np.int64)
    nv, nbody = model_words[offsets[_NV] // 8], model_words[offsets[NBODY] // 8]
    rownnz = carray(pointer(model_words[offsets[_ROWNNZ] // 8]), (nv,), np.uint32)
    rowadr = carray(pointer(model_words[offsets[_ROWADR] // 8]), (nv,), np.uint32)
    return Bodies(
        carray(pointer(model_words[offsets[_PARENT] // 8]), (nbody,), np.uint32),
        carray(pointer(model_words[offsets[_ROOT] // 8]), (nbody,), np.uint32),
        carray(pointer(model_words[offsets[_DOFADR] // 8]), (nbody,), np.uint32),
        carray(pointer(model_words[offsets[_DOFNUM] // 8]), (nbody,), np.uint32),
        carray(pointer(model_words[offsets[_DOFBODY] // 8]), (nv,), np.uint32),
        rownnz,
        rowadr,
        carray(pointer(model_words[offsets[_COLIND] // 8]), (rowadr[nv - 1] + rownnz[nv - 1],), np.uint32),
    )


@compile_inline
def read_motion(model: int, data: int, offsets: np.ndarray, user_start: int) -> Motion:
    """Return where the bodies of a model are.

    Args:
        model: address of a ``mjModel``.
        data: address of its ``mjData``.
        offsets: offsets of ``FIELDS`` and ``DATA_FIELDS`` [byte].
        user_start: place of the numbers of the water in the user data [-].
    """
    model_words = carray(model, (4096,), np.int64)
    state, clock = carray(data, (65536,), np.int64), carray(data, (65536,), np.float64)
    nv, nbody = model_words[offsets[_NV] // 8], model_words[offsets[NBODY] // 8]
    return Motion(
        clock[offsets[_TIME] // 8],
        carray(pointer(state[offsets[_XPOS] // 8]), (nbody, 3), np.float64),
        carray(pointer(state[offsets[_XMAT] // 8]), (nbody, 9), np.float64),
        carray(pointer(state[offsets[_COM] // 8]), (nbody, 3), np.float64),
        carray(pointer(state[offsets[_CVEL] // 8]), (nbody, 6), np.float64),
        carray(pointer(state[offsets[_CDOF] // 8]), (nv, 6), np.float64),
        carray(pointer(state[offsets[_CDOFDOT] // 8]), (nv, 6), np.float64),
        carray(pointer(state[offsets[_QVEL] // 8]), (nv,), np.float64),
        carray(pointer(state[offsets[_QACC] // 8]), (nv,), np.float64),
        carray(pointer(state[offsets[_PASSIVE] // 8]), (nv,), np.float64),
        carray(pointer(state[offsets[_MASS] // 8]), (nv * nv,), np.float64),
        carray(pointer(state[offsets[_USER] // 8] + 8 * user_start), (NUMBERS,), np.float64),
    )


@compile_inline
def read_added_mass(model: int, data: int, offsets: np.ndarray) -> np.ndarray:
    """Return the stored added mass, which follows the numbers of the water in the user data."""
    model_words, state = carray(model, (4096,), np.int64), carray(data, (65536,), np.int64)
    start_byte = 8 * NUMBERS
    return carray(
        pointer(state[offsets[_USER] // 8] + start_byte), (model_words[offsets[NUSER] // 8] - NUMBERS,), np.float64
    )


@compile_inline
def read_loads(model: int, data: int, offsets: np.ndarray, user_start: int) -> np.ndarray:
    """Return where the loads of the bodies are left, shape (body, ``LOAD_WIDTH``), after the numbers of the water."""
    words, state = carray(model, (4096,), np.int64), carray(data, (65536,), np.int64)
    start_byte = 8 * (user_start + NUMBERS)
    return carray(
        pointer(state[offsets[_USER] // 8] + start_byte), (words[offsets[NBODY] // 8], LOAD_WIDTH), np.float64
    )


@compile_inline
def read_plate_loads(data: int, offsets: np.ndarray, shapes: int) -> np.ndarray:
    """Return where the loads of the grains on some shapes are left, shape (shape, ``LOAD_NUMBERS``)."""
    state = carray(data, (65536,), np.int64)
    return carray(pointer(state[offsets[_USER] // 8] + 8 * PLATE_LOADS), (shapes, LOAD_NUMBERS), np.float64)


@compile_inline
def read_water(model: int, user: np.ndarray, offsets: np.ndarray, length: float) -> WaterProperties:
    """Return what the water is.

    Args:
        model: address of a ``mjModel``.
        user: numbers of the water, see ``water_table``.
        offsets: offsets of ``FIELDS`` and ``DATA_FIELDS`` [byte].
        length: length of the robot, for the Reynolds number of friction [m].
    """
    down = three(carray(model, (4096,), np.float64), offsets[_GRAVITY] // 8)
    gravity = sqrt(dot(down, down))
    up_axis = times(-1.0 / gravity, down) if gravity > 0.0 else (0.0, 0.0, 1.0)
    return WaterProperties(
        user[LEVEL], user[DENSITY], (user[AIR_FRACTION], user[AIR_FRACTION + 1]), user[VISCOSITY], user[CROSS_DRAG],
        user[THICKENING], user[ADDED_MASS_FACTOR], user[SHEDDING], user[SPLASH], up_axis, gravity, length,
    )  # fmt: skip

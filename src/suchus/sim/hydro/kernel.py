"""The compiled kernels, one for each kind of table: they hand what water or grains do to the joints of a MuJoCo model.

They are given addresses and byte offsets (see ``immersion.structs``), so that they need neither MuJoCo nor Python's
lock while they run. All spatial vectors are MuJoCo's: rotation first, about the centre of mass of the whole tree.
"""

import numpy as np
from numba import carray

from suchus.core.plate_table import PLATE_MAGIC
from suchus.core.plate_table import SHAPE_COUNT as PLATE_SHAPE_COUNT
from suchus.core.water_table import (
    BODY_COUNT,
    COLUMNS,
    CURRENT,
    CURRENT_COUNT,
    FORCE,
    HEADER,
    LANES,
    LEVEL,
    LEVEL_COUNT,
    LOAD_WIDTH,
    MAGIC,
    NUMBERS,
    POWER,
    SHAPE_COUNT,
    SHAPE_HEADER,
    SHAPE_MAGIC,
    SHAPE_WIDTH,
    SUBMERGED_VOLUME,
    TRIANGLE_COUNT,
    USERDATA_START,
    WAVE,
    WAVE_COUNT,
    WAVE_WIDTH,
    WIDTH,
)
from suchus.sim.hydro import lanes, memory
from suchus.sim.hydro.forces import added_mass, cross_surface, flow, meet, place, press, rub
from suchus.sim.hydro.geoms import float_up, immerse, resist, scheduled, stir
from suchus.sim.hydro.lanes import (
    COUPLING_INERTIA,
    LINEAR_INERTIA,
    LOAD_VOLUME,
    ROTATIONAL_INERTIA,
    ROWS,
    SHAPE_ROWS,
    SUMS,
    WaterProperties,
)
from suchus.sim.hydro.memory import (
    Bodies,
    Motion,
    find_table,
    pointer,
    read_added_mass,
    read_bodies,
    read_implicit_step,
    read_loads,
    read_motion,
    read_plate_loads,
    read_water,
)
from suchus.sim.hydro.plates import resist_plates, room_for_loads
from suchus.sim.hydro.vectors import (
    Vector,
    compile_inline,
    compile_kernel,
    cross,
    dot,
    plus,
    three,
    times,
    write,
    write_lane,
)

_MOMENT = 1e-4
"""Time over which the change of a current is taken [s]."""
_BODY, _REACH = COLUMNS["body"][0], COLUMNS["reach"][0]
_COUPLE, _LINEAR = lanes.FORCE - 3 - lanes.FIRST_SUM, lanes.FORCE - lanes.FIRST_SUM
_ROTATIONAL_INERTIA, _COUPLING_INERTIA, _LINEAR_INERTIA = (
    ROTATIONAL_INERTIA - lanes.FIRST_SUM,
    COUPLING_INERTIA - lanes.FIRST_SUM,
    LINEAR_INERTIA - lanes.FIRST_SUM,
)


@compile_inline
def _numbers(model: int, offsets: np.ndarray, start: int, size: int) -> np.ndarray:
    """Return a table among the custom numbers of a model.

    Args:
        model: address of a ``mjModel``.
        offsets: offsets of ``FIELDS`` and ``DATA_FIELDS`` [byte].
        start: where it starts [-].
        size: how many numbers it has [-].
    """
    words = carray(model, (4096,), np.int64)
    return carray(pointer(words[offsets[memory.NUMERIC] // 8] + 8 * start), (size,), np.float64)


@compile_kernel
def apply_to_pieces(model: int, data: int, offsets: np.ndarray) -> bool:
    """Add the water's forces to the passive forces and its added mass to the mass matrix; return whether that changed.

    Args:
        model: address of a ``mjModel`` that carries a table of pieces; another table is left alone.
        data: address of its ``mjData``.
        offsets: offsets of ``FIELDS`` and ``DATA_FIELDS`` [byte].
    """
    magic, start, size = find_table(model, offsets)
    if magic != MAGIC:
        return False
    model_words = carray(model, (4096,), np.int64)
    numbers = _numbers(model, offsets, start, size)
    if model_words[offsets[memory.NUSER] // 8] < NUMBERS:
        return False
    if model_words[offsets[memory.NUSER] // 8] > NUMBERS:
        _add_stored_mass(model, data, offsets)
        return True
    motion = read_motion(model, data, offsets, 0)
    user, water = motion.user, read_water(model, motion.user, offsets, numbers[2])
    blocks = (len(numbers) - HEADER) // (WIDTH * LANES)
    table = numbers[HEADER : HEADER + blocks * WIDTH * LANES].reshape((blocks, WIDTH, LANES))
    for i in range(4):
        user[FORCE + i] = 0.0
    user[SUBMERGED_VOLUME] = 0.0
    if _all_dry(table, int(numbers[1]), water, abs(user[WAVE]), motion):
        return False
    bodies = read_bodies(model, offsets)
    sums = _gathered(table, int(numbers[1]), water, bodies, motion)
    if user[SUBMERGED_VOLUME] == 0.0:
        return False
    _hand_over(sums, bodies, motion)
    if water.added_mass_factor <= 0.0:
        return False
    _burden(sums, bodies, motion)
    return True


@compile_kernel
def apply_to_shapes(model: int, data: int, offsets: np.ndarray) -> bool:
    """Do what ``apply_to_pieces`` does, with a table of shapes; leave the load of each body in the user data.

    Args:
        model: address of a ``mjModel`` that carries such a table; another table is left alone.
        data: address of its ``mjData``.
        offsets: offsets of ``FIELDS`` and ``DATA_FIELDS`` [byte].
    """
    magic, start, size = find_table(model, offsets)
    if magic != SHAPE_MAGIC:
        return False
    numbers = _numbers(model, offsets, start, size)
    header, user_start = numbers[:SHAPE_HEADER], int(numbers[USERDATA_START])
    motion, bodies = read_motion(model, data, offsets, user_start), read_bodies(model, offsets)
    loads = read_loads(model, data, offsets, user_start)
    first = SHAPE_HEADER + NUMBERS
    levels = numbers[first : first + 2 * int(header[LEVEL_COUNT])].reshape((-1, 2))
    first += levels.size
    factors = numbers[first : first + 2 * int(header[CURRENT_COUNT])].reshape((-1, 2))
    first += factors.size
    waves = numbers[first : first + WAVE_WIDTH * int(header[WAVE_COUNT])].reshape((-1, WAVE_WIDTH))
    first += waves.size
    count = int(header[SHAPE_COUNT])
    blocks = -(-count // LANES)
    table = numbers[first : first + blocks * SHAPE_WIDTH * LANES].reshape((blocks, SHAPE_WIDTH, LANES))
    first += table.size
    triangles = numbers[first : first + 9 * int(header[TRIANGLE_COUNT])].reshape((-1, 9))
    user = motion.user
    for i in range(NUMBERS):
        user[i] = numbers[SHAPE_HEADER + i]
    user[LEVEL] = scheduled(levels, motion.time)
    factor = scheduled(factors, motion.time)
    surge = times((scheduled(factors, motion.time + _MOMENT) - factor) / _MOMENT, three(user, CURRENT))
    write(user, CURRENT, times(factor, three(user, CURRENT)))
    loads[:] = 0.0
    water = read_water(model, user, offsets, 1.0)
    height = 0.0
    for wave in waves:
        height += abs(wave[0])
    if _all_dry(table, count, water, height, motion):
        return False
    bias = _bias_accelerations(bodies, motion)
    rows, sums = np.zeros((SHAPE_ROWS, LANES)), np.zeros((len(bodies.parent), SUMS))
    wet_volume, step = 0.0, read_implicit_step(model, offsets)
    for block in range(blocks):
        block_table, used = table[block], min(LANES, count - block * LANES)
        _gather_motion(block_table, rows, bodies, motion, bias)
        place(block_table, rows)
        stir(block_table, rows, user, header, waves, motion.time, surge, water.up_axis, used)
        immerse(block_table, rows, water, triangles, used)
        float_up(rows, water, used)
        added_mass(block_table, rows, water)
        resist(block_table, rows, water, step, used)
        for n in range(used):
            if rows[lanes.WET_FRACTION, n] > 0.0:
                wet_volume += rows[lanes.WET_VOLUME, n]
                b = np.uint32(block_table[_BODY, n])
                for k in range(SUMS):
                    sums[b, k] += rows[lanes.FIRST_SUM + k, n]
    user[SUBMERGED_VOLUME] = wet_volume
    if wet_volume == 0.0:
        return False
    _leave_loads(sums, loads, bodies, motion)
    _hand_over(sums, bodies, motion)
    _burden(sums, bodies, motion)
    return True


@compile_kernel
def apply_to_plates(model: int, data: int, offsets: np.ndarray) -> bool:
    """Add the resistance of grains to the passive forces, and its damping to the mass matrix; return whether any acts.

    The matrix grows by damping times time step, so that the resistance is that of the velocity at the end of the step.

    Args:
        model: address of a ``mjModel`` that carries a table of plates; another table is left alone.
        data: address of its ``mjData``.
        offsets: offsets of ``FIELDS`` and ``DATA_FIELDS`` [byte].
    """
    magic, start, size = find_table(model, offsets)
    if magic != PLATE_MAGIC:
        return False
    numbers = _numbers(model, offsets, start, size)
    motion, bodies = read_motion(model, data, offsets, 0), read_bodies(model, offsets)
    loads = read_plate_loads(data, offsets, int(numbers[PLATE_SHAPE_COUNT]))
    user, sums = motion.user, np.zeros((len(bodies.parent), SUMS))
    write(user, FORCE, (0.0, 0.0, 0.0))
    user[POWER] = 0.0
    if not resist_plates(numbers, loads, sums, bodies, motion, read_implicit_step(model, offsets)):
        return False
    _hand_over(sums, bodies, motion)
    force, power = three(user, FORCE), user[POWER]
    _burden(sums, bodies, motion)
    write(user, FORCE, force)  # no inertia of the grains, whose force it would be
    user[POWER] = power
    return True


@compile_inline
def _leave_loads(sums: np.ndarray, loads: np.ndarray, bodies: Bodies, motion: Motion) -> None:
    """Write the load of the water on each body, its added inertia at the accelerations of the last step.

    Args:
        sums: loads and inertias of the bodies, shape (body, ``SUMS``).
        loads: force, torque about the body's origin, volume under water, shape (body, ``LOAD_WIDTH``); written.
        bodies: the tree of bodies and joints.
        motion: positions and accelerations of the bodies.
    """
    gains = np.zeros((len(bodies.parent), 6))
    for b in range(1, len(bodies.parent)):
        angular, linear = three(gains[bodies.parent[b]], 0), three(gains[bodies.parent[b]], 3)
        for dof in range(bodies.first_dof[b], bodies.first_dof[b] + bodies.dof_counts[b]):
            angular = plus(angular, times(motion.qacc[dof], three(motion.cdof[dof], 0)))
            linear = plus(linear, times(motion.qacc[dof], three(motion.cdof[dof], 3)))
        write(gains[b], 0, angular)
        write(gains[b], 3, linear)
        if sums[b, LOAD_VOLUME] > 0.0:
            couple, force = _answer(sums[b], angular, linear)
            force = plus(three(sums[b], _LINEAR), times(-1.0, force))
            couple = plus(three(sums[b], _COUPLE), times(-1.0, couple))
            arm = plus(three(motion.com[bodies.root[b]], 0), times(-1.0, three(motion.xpos[b], 0)))
            write(loads[b], 0, force)
            write(loads[b], 3, plus(couple, cross(arm, force)))
            loads[b, 6] = sums[b, LOAD_VOLUME]


@compile_inline
def _gather_motion(table: np.ndarray, rows: np.ndarray, bodies: Bodies, motion: Motion, bias: np.ndarray) -> None:
    """Write orientation, position and motion of the bodies that carry the pieces of a block.

    Args:
        table: table of the block, shape (column, lane).
        rows: quantities of the pieces, see ``lanes``; written.
        bodies: the tree of bodies and joints.
        motion: positions and velocities of the bodies.
        bias: accelerations of the bodies without those of the joints, shape (body, 6).
    """
    for n in range(LANES):
        b = np.uint32(table[_BODY, n])
        for k in range(0, 9, 3):
            write_lane(rows, lanes.TURN + k, n, three(motion.xmat[b], k))
        write_lane(rows, lanes.ORIGIN, n, three(motion.xpos[b], 0))
        write_lane(rows, lanes.REFERENCE, n, three(motion.com[bodies.root[b]], 0))
        write_lane(rows, lanes.MOVING, n, three(motion.cvel[b], 0))
        write_lane(rows, lanes.MOVING + 3, n, three(motion.cvel[b], 3))
        write_lane(rows, lanes.BIAS, n, three(bias[b], 0))
        write_lane(rows, lanes.BIAS + 3, n, three(bias[b], 3))


@compile_inline
def _add_stored_mass(model: int, data: int, offsets: np.ndarray) -> None:
    """Add the stored added mass to the mass matrix; it follows the numbers of the water in the user data."""
    bodies, motion = read_bodies(model, offsets), read_motion(model, data, offsets, 0)
    stored_mass = read_added_mass(model, data, offsets)
    for n in range(len(bodies.column)):
        motion.mass[n] += stored_mass[n]


@compile_inline
def _all_dry(table: np.ndarray, count: int, water: WaterProperties, height: float, motion: Motion) -> bool:
    """Return whether all pieces are far above the surface, waves of a height included.

    Args:
        table: table of the pieces, shape (block, column, lane).
        count: number of pieces [-].
        water: its properties.
        height: height of the waves above the level, at most [m].
        motion: positions of the bodies.
    """
    for n in range(count):
        block, lane = n // LANES, n % LANES
        origin = three(motion.xpos[int(table[block, _BODY, lane])], 0)
        if water.level + height - dot(water.up_axis, origin) > -table[block, _REACH, lane]:
            return False
    return True


@compile_inline
def _gathered(table: np.ndarray, count: int, water: WaterProperties, bodies: Bodies, motion: Motion) -> np.ndarray:
    """Return inertia, couple and force of the water on each body, shape (body, ``SUMS``).

    Args:
        table: table of the pieces, shape (block, column, lane).
        count: number of pieces [-].
        water: its properties.
        bodies: the tree of bodies and joints.
        motion: positions and velocities of the bodies.
    """
    bias = _bias_accelerations(bodies, motion)
    rows, sums, wet_volume = np.zeros((ROWS, LANES)), np.zeros((len(bodies.parent), SUMS)), 0.0
    for block in range(table.shape[0]):
        block_table = table[block]
        _gather_motion(block_table, rows, bodies, motion, bias)
        place(block_table, rows)
        if block == 0 or motion.user[WAVE] != 0.0:
            flow(rows, motion.user, motion.time, water.up_axis)
        meet(block_table, rows, water)
        rub(rows, water)
        press(block_table, rows, water)
        added_mass(block_table, rows, water)
        cross_surface(block_table, rows, water)
        for n in range(min(LANES, count - block * LANES)):
            if rows[lanes.WET_FRACTION, n] > 0.0:
                wet_volume += rows[lanes.WET_VOLUME, n]
                b = np.uint32(block_table[_BODY, n])
                for k in range(SUMS):
                    sums[b, k] += rows[lanes.FIRST_SUM + k, n]
    motion.user[SUBMERGED_VOLUME] = wet_volume
    return sums


@compile_inline
def _bias_accelerations(bodies: Bodies, motion: Motion) -> np.ndarray:
    """Return the spatial acceleration of each body with all joint accelerations set to zero, shape (body, 6).

    Rotation comes first [rad/s2], then translation [m/s2], in MuJoCo's frame of the centre of mass (``cdof_dot``).
    Gravity is left out.
    """
    bias = np.empty((len(bodies.parent), 6))
    bias[0] = 0.0
    for body in range(1, len(bodies.parent)):
        parent_bias = bias[bodies.parent[body]]
        angular, linear = three(parent_bias, 0), three(parent_bias, 3)
        for dof in range(bodies.first_dof[body], bodies.first_dof[body] + bodies.dof_counts[body]):
            angular = plus(angular, times(motion.qvel[dof], three(motion.cdof_dot[dof], 0)))
            linear = plus(linear, times(motion.qvel[dof], three(motion.cdof_dot[dof], 3)))
        write(bias[body], 0, angular)
        write(bias[body], 3, linear)
    return bias


@compile_inline
def _hand_over(sums: np.ndarray, bodies: Bodies, motion: Motion) -> None:
    """Sum the loads of the bodies from the leaves to the roots, and add the generalised forces to the joints.

    Args:
        sums: loads of the bodies, shape (body, ``SUMS``); each body's become those of its subtree.
        bodies: the tree of bodies and joints.
        motion: passive forces and numbers of the water, which are written.
    """
    user, power = motion.user, 0.0
    for b in range(len(bodies.parent) - 1, 0, -1):
        parent = bodies.parent[b]
        if parent > 0:
            for k in range(SUMS):
                sums[parent, k] += sums[b, k]
        else:
            for i in range(3):
                user[FORCE + i] += sums[b, _LINEAR + i]
    for i in range(len(bodies.owner)):
        acts, b = 0.0, bodies.owner[i]
        for k in range(6):
            acts += motion.cdof[i, k] * sums[b, _COUPLE + k]
        motion.passive[i] += acts
        power += acts * motion.qvel[i]
    user[POWER] = power


@compile_inline
def _burden(sums: np.ndarray, bodies: Bodies, motion: Motion) -> None:
    """Add the added inertia of each joint's subtree to the mass matrix.

    The force and power of this inertia, at the accelerations of the last step, are subtracted from those of the water.

    Args:
        sums: loads and inertias of the subtrees, shape (body, ``SUMS``).
        bodies: the tree of bodies and joints.
        motion: mass matrix and numbers of the water, which are written.
    """
    power, added_force, cdof, qvel, qacc = 0.0, (0.0, 0.0, 0.0), motion.cdof, motion.qvel, motion.qacc
    for i in range(len(bodies.owner)):
        turns, moves = three(cdof[i], 0), three(cdof[i], 3)
        couple, force = _answer(sums[bodies.owner[i]], turns, moves)
        start, speeds, speedings = bodies.rowadr[i], 0.0, 0.0
        for n in range(start, start + bodies.rownnz[i]):
            j = bodies.column[n]
            inertia = dot(three(cdof[j], 0), couple) + dot(three(cdof[j], 3), force)
            motion.mass[n] += inertia
            speeds += inertia * qvel[j]
            speedings += inertia * qacc[j]
        momentum = (dot(turns, couple) + dot(moves, force)) * qvel[i]
        power += qvel[i] * speedings + qacc[i] * (speeds - momentum)
        added_force = plus(added_force, times(qacc[i], force))
    motion.user[POWER] -= power
    write(motion.user, FORCE, plus(three(motion.user, FORCE), times(-1.0, added_force)))


@compile_inline
def _answer(inertia: np.ndarray, turns: Vector, moves: Vector) -> tuple[Vector, Vector]:
    """Return couple and force of an added inertia that is accelerated.

    Args:
        inertia: sums of a subtree, shape (``SUMS``,).
        turns: angular acceleration [rad/s2].
        moves: linear acceleration [m/s2].
    """
    s, x, y = (
        three(inertia, _ROTATIONAL_INERTIA),
        three(inertia, _COUPLING_INERTIA),
        three(inertia, _COUPLING_INERTIA + 3),
    )
    spun_row, z = three(inertia, _ROTATIONAL_INERTIA + 3), three(inertia, _COUPLING_INERTIA + 6)
    m, mass_row = three(inertia, _LINEAR_INERTIA), three(inertia, _LINEAR_INERTIA + 3)
    force = (
        dot(x, turns) + dot((m[0], m[1], mass_row[0]), moves),
        dot(y, turns) + dot((m[1], m[2], mass_row[1]), moves),
        dot(z, turns) + dot(mass_row, moves),
    )
    couple = (
        dot((s[0], s[1], spun_row[0]), turns) + dot((x[0], y[0], z[0]), moves),
        dot((s[1], s[2], spun_row[1]), turns) + dot((x[1], y[1], z[1]), moves),
        dot(spun_row, turns) + dot((x[2], y[2], z[2]), moves),
    )
    return couple, force


@compile_kernel
def has_misfit(model: int, offsets: np.ndarray) -> bool:
    """Return whether a table of shapes was made for another number of bodies, or one has no room for what it leaves.

    Args:
        model: address of a ``mjModel``.
        offsets: offsets of ``FIELDS`` and ``DATA_FIELDS`` [byte].
    """
    magic, start, size = find_table(model, offsets)
    if magic != SHAPE_MAGIC and magic != PLATE_MAGIC:
        return False
    words = carray(model, (4096,), np.int64)
    numbers = _numbers(model, offsets, start, size)
    if magic == PLATE_MAGIC:
        return words[offsets[memory.NUSER] // 8] < room_for_loads(numbers)
    bodies = words[offsets[memory.NBODY] // 8]
    room = words[offsets[memory.NUSER] // 8] - numbers[USERDATA_START]
    return bodies != numbers[BODY_COUNT] or room < NUMBERS + LOAD_WIDTH * bodies

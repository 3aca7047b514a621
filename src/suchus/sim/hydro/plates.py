"""Granular ground: what dry grains do to small plates that move through them, by resistive force theory.

The stress on a plate grows with depth and depends on the directions of plate and motion, not on the speed. Li, Zhang
and Goldman (Science 339, 1408, 2013) measured it for plates whose normal and motion lie in one vertical plane, and
found that one function with one factor of the medium fits all media that they tried. For other directions of motion
the stress of the part in that plane and the shear of the part across it add up, each in proportion to its part of the
speed.

Stress acts where it resists the motion. It is taken as a damping of the velocity at the end of the step, so that the
grains never give energy, and hold what rests in them without a spring.
"""

from math import sqrt

import numpy as np

from suchus.core.plate_table import (
    CREEP_SPEED,
    LOAD_NUMBERS,
    PLATE_HEADER,
    PLATE_IS_STEPPED,
    PLATE_LOADS,
    PLATE_NUMBERS,
    PLATE_TIME,
    SHAPE_BODY,
    SHAPE_COUNT,
    SHAPE_FIRST,
    SHAPE_NUMBERS,
    SHAPE_PLATES,
    SHAPE_REACH,
    STRENGTH,
)
from suchus.sim.hydro import lanes
from suchus.sim.hydro.memory import Bodies, Motion
from suchus.sim.hydro.vectors import Vector, compile_inline, cross, dot, plus, three, times, to_world, write

_A00, _A10, _B11, _B01, _BM11 = 0.206, 0.169, 0.212, 0.358, 0.055
_C11, _C01, _CM11, _D10 = -0.124, 0.253, 0.007, 0.088
"""Fourier coefficients of the generic stress, over that on a level plate that moves down [-]. Li, Zhang and Goldman
(2013), supplementary material; they add up to 1 for that plate."""
_SHEAR = _C11 + _C01 + _CM11
"""Generic stress against a level plate that slides [-]."""
_LEVEL = 1e-9
"""Horizontal part of a normal below which a plate is level [-]."""
_MIN_SPEED = 1e-12
"""Speed below which a plate is at rest [m/s]."""
_ROTATIONAL, _COUPLING, _LINEAR_INERTIA, _COUPLE, _LINEAR = (
    row - lanes.FIRST_SUM
    for row in (
        lanes.ROTATIONAL_INERTIA,
        lanes.COUPLING_INERTIA,
        lanes.LINEAR_INERTIA,
        lanes.FORCE - 3,
        lanes.FORCE,
    )
)


@compile_inline
def resist_plates(
    numbers: np.ndarray, loads: np.ndarray, sums: np.ndarray, bodies: Bodies, motion: Motion, step: float
) -> bool:
    """Add the resistance of the grains to the sums of the bodies, and leave the loads of each shape.

    Return whether any plate is met. The force of the last step is its damping at the velocities with which it ended; of
    a first evaluation it is the present one.

    Args:
        numbers: table of plates, see ``core.plate_table``.
        loads: loads of each shape, shape (shape, ``LOAD_NUMBERS``); written.
        sums: load and inertia of each body, shape (body, ``SUMS``); written.
        bodies: the tree of bodies and joints.
        motion: positions and velocities of the bodies.
        step: time over which the resistance is taken at the end of the step, 0 for none [s].
    """
    count, strength, creep_speed = int(numbers[SHAPE_COUNT]), numbers[STRENGTH], numbers[CREEP_SPEED]
    shapes = numbers[PLATE_HEADER : PLATE_HEADER + SHAPE_NUMBERS * count].reshape((count, SHAPE_NUMBERS))
    plates = numbers[PLATE_HEADER + SHAPE_NUMBERS * count :].reshape((-1, PLATE_NUMBERS))
    is_met, user = False, motion.user
    is_first, is_next = user[PLATE_IS_STEPPED] == 0.0, motion.time > user[PLATE_TIME]
    user[PLATE_TIME], user[PLATE_IS_STEPPED] = motion.time, 1.0
    shape_sums = np.zeros(lanes.SUMS)
    for s in range(count):
        b = int(shapes[s, SHAPE_BODY])
        origin, turn = three(motion.xpos[b], 0), motion.xmat[b]
        angular, linear = three(motion.cvel[b], 0), three(motion.cvel[b], 3)
        if is_next:
            write(loads[s], 0, _stored_force(loads[s], angular, linear))
        loads[s, 3:] = 0.0
        if origin[2] > shapes[s, SHAPE_REACH]:
            if is_first:
                write(loads[s], 0, (0.0, 0.0, 0.0))
            continue
        reference = three(motion.com[bodies.root[b]], 0)
        shape_sums[:] = 0.0
        first = int(shapes[s, SHAPE_FIRST])
        for p in range(first, first + int(shapes[s, SHAPE_PLATES])):
            point = plus(origin, to_world(turn, plates[p], 0))
            if point[2] >= 0.0:
                continue
            normal, arm = to_world(turn, plates[p], 3), plus(point, times(-1.0, reference))
            velocity = plus(linear, cross(angular, arm))
            stress = plate_stress(normal, velocity)
            power = dot(stress, velocity)
            if power >= 0.0:
                continue
            scale, size = -strength * point[2] * plates[p, 6], sqrt(dot(stress, stress))
            speed = sqrt(dot(velocity, velocity))
            along = scale / (size * creep_speed - power)
            force = times(-along * power, stress)
            write(shape_sums, _COUPLE, plus(three(shape_sums, _COUPLE), cross(arm, force)))
            write(shape_sums, _LINEAR, plus(three(shape_sums, _LINEAR), force))
            turning = step * scale * size / (speed + creep_speed)
            _add_inertia(shape_sums, step * along, stress, turning, times(1.0 / speed, velocity), arm)
            is_met = True
        sums[b] += shape_sums
        if is_first or step == 0.0:
            write(loads[s], 0, three(shape_sums, _LINEAR))
        if step > 0.0:
            for k in range(6):
                loads[s, 3 + k] = shape_sums[_LINEAR_INERTIA + k] / step
            for k in range(9):
                loads[s, 9 + k] = shape_sums[_COUPLING + k] / step
    return is_met


@compile_inline
def _stored_force(loads: np.ndarray, angular: Vector, linear: Vector) -> Vector:
    """Return the force of the damping that the step before has left, at the velocity of a body now [N].

    Args:
        loads: loads of the shape, shape (``LOAD_NUMBERS``,).
        angular: rate of rotation [rad/s].
        linear: velocity at the point of reference [m/s].
    """
    spun = (
        dot(three(loads, 9), angular),
        dot(three(loads, 12), angular),
        dot(three(loads, 15), angular),
    )
    xx, yx, yy, zx, zy, zz = loads[3], loads[4], loads[5], loads[6], loads[7], loads[8]
    moved = dot((xx, yx, zx), linear), dot((yx, yy, zy), linear), dot((zx, zy, zz), linear)
    return times(-1.0, plus(spun, moved))


@compile_inline
def plate_stress(normal: Vector, velocity: Vector) -> Vector:
    """Return the generic stress on a plate, over that on a level plate that moves down; 0 where it does not lead.

    Args:
        normal: outward normal of the plate, unit vector; z is up.
        velocity: velocity of the plate [m/s].
    """
    speed = sqrt(dot(velocity, velocity))
    if dot(normal, velocity) <= 0.0 or speed < _MIN_SPEED:
        return 0.0, 0.0, 0.0
    tilted, horizontal = normal, sqrt(normal[0] * normal[0] + normal[1] * normal[1])
    if horizontal < _LEVEL:
        tilted, horizontal = velocity, sqrt(velocity[0] * velocity[0] + velocity[1] * velocity[1])
    heading = (1.0, 0.0, 0.0)
    if horizontal >= _MIN_SPEED:
        heading = (tilted[0] / horizontal, tilted[1] / horizontal, 0.0)
    forward = dot(velocity, heading) / speed
    shear = _SHEAR * (velocity[1] * heading[0] - velocity[0] * heading[1]) / speed
    stress_forward, stress_up = generic_stress(dot(normal, heading), normal[2], forward, velocity[2] / speed)
    return (
        stress_forward * heading[0] + shear * heading[1],
        stress_forward * heading[1] - shear * heading[0],
        stress_up,
    )


@compile_inline
def generic_stress(normal_forward: float, normal_up: float, forward: float, up: float) -> tuple[float, float]:
    """Return the generic stress on a plate, forward and up, over that on a level plate that moves down [-].

    With the angles of the source, the attack angle beta and the intrusion angle gamma, the normal is (sin beta,
    -cos beta) and the motion (cos gamma, -sin gamma). A motion that is shorter than 1 gives as much less stress.

    Source: Li, Zhang and Goldman, Science 339, 1408 (2013), supplementary material, with the generic coefficients.

    Args:
        normal_forward: part of the normal along the horizontal direction in the plate's vertical plane [-].
        normal_up: part of the normal upward [-].
        forward: part of the motion along that direction [-].
        up: part of the motion upward [-].
    """
    length = sqrt(forward * forward + up * up)
    if length == 0.0:
        return 0.0, 0.0
    cosine, sine = forward / length, -up / length
    double_cosine, double_sine = (
        normal_up * normal_up - normal_forward * normal_forward,
        -2.0 * normal_forward * normal_up,
    )
    plus_sine, minus_sine = double_sine * cosine + double_cosine * sine, double_cosine * sine - double_sine * cosine
    plus_cosine, minus_cosine = double_cosine * cosine - double_sine * sine, double_cosine * cosine + double_sine * sine
    vertical = _A00 + _A10 * double_cosine + _B11 * plus_sine + _B01 * sine + _BM11 * minus_sine
    horizontal = _C11 * plus_cosine + _C01 * cosine + _CM11 * minus_cosine + _D10 * double_sine
    return -length * horizontal, length * vertical


@compile_inline
def _add_inertia(
    sums: np.ndarray, along: float, stress: Vector, turning: float, direction: Vector, arm: Vector
) -> None:
    """Add a point whose mass differs between directions to the inertia of a body.

    Its matrix is ``along`` times stress times stress, plus ``turning`` in all directions at right angles to the motion:
    the damping that goes with the stress, and that which goes with the turn of the stress as the motion turns.

    Args:
        sums: load and inertia of the body, shape (``SUMS``,); written.
        along: mass in the direction of the stress, over the square of the stress [kg].
        stress: generic stress [-].
        turning: mass at right angles to the motion [kg].
        direction: direction of the motion, unit vector.
        arm: position of the point from the point of reference [m].
    """
    units = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    levers = ((0.0, -arm[2], arm[1]), (arm[2], 0.0, -arm[0]), (-arm[1], arm[0], 0.0))
    entry = 0
    for i in range(3):
        moved = _times_mass(along, stress, turning, direction, units[i])
        spun = _times_mass(along, stress, turning, direction, levers[i])
        for j in range(i + 1):
            sums[_LINEAR_INERTIA + entry] += dot(units[j], moved)
            sums[_ROTATIONAL + entry] += dot(levers[j], spun)
            entry += 1
        for j in range(3):
            sums[_COUPLING + 3 * i + j] += dot(levers[j], moved)


@compile_inline
def _times_mass(along: float, stress: Vector, turning: float, direction: Vector, values: Vector) -> Vector:
    """Return the matrix of ``_add_inertia`` times a vector."""
    across = plus(values, times(-dot(direction, values), direction))
    return plus(times(along * dot(stress, values), stress), times(turning, across))


@compile_inline
def room_for_loads(numbers: np.ndarray) -> int:
    """Return how many numbers of user data a table of plates needs."""
    return PLATE_LOADS + LOAD_NUMBERS * int(numbers[SHAPE_COUNT])

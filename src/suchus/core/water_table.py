"""The table of a body's pieces, and the row of numbers that say what the water is: what the kernel reads and writes.

Every piece is an affine image of a unit shape: half axes a and b across, c along, with unit axes e_a, e_b and t, which
points forward. All of it in the frame of the body that carries the piece.
"""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

DISC = 0
"""Kind of piece: a section of a trunk, tail or limb."""
BALL = 1
"""Kind of piece: an ellipsoid."""
SLAB = 2
"""Kind of piece: a column of a box."""
CYLINDER = 3
"""Kind of shape: a round cylinder along t."""
CAPSULE = 4
"""Kind of shape: a round cylinder along t with half balls at its ends; c is half its whole length."""
POLYHEDRON = 5
"""Kind of shape: a closed surface of triangles; a, b and c are the half axes of the ellipsoid that stands for it."""

COLUMNS: Mapping[str, tuple[int, int]] = {
    name: (start, stop)
    for name, start, stop in (
        ("body", 0, 1),  # which carries it
        ("kind", 1, 2),
        ("at", 2, 5),  # its centre [m]
        ("across", 5, 8),  # e_a
        ("upward", 8, 11),  # e_b
        ("forward", 11, 14),  # t
        ("half", 14, 17),  # a, b, c [m]
        ("volume", 17, 18),  # [m3]
        ("air", 18, 20),  # of which so much can be let out, from the front and from the rear chambers [m3]
        ("added", 20, 23),  # added mass over density along e_a, e_b, t [m3]
        ("area", 23, 25),  # drag area over the cross drag coefficient, for motion along e_a and e_b [m2]
        ("skin", 25, 26),  # wetted area [m2]
        ("end", 26, 27),  # drag area of motion along t [m2]
        ("roll", 27, 28),  # roll drag over density, cross drag coefficient and the square of the rate [m5]
        ("shed", 28, 30),  # added mass per length over density, along e_a and e_b, where the tail ends; else 0 [m2]
        ("shed_at", 30, 31),  # of that end from the centre along t [m]
        ("reach", 31, 32),  # no part of it is farther from the body's origin; filled where the table is packed [m]
    )
}
"""Columns of each quantity in the table."""
WIDTH = 32
"""Columns of the table [-]."""

LANES = 16
"""Pieces that the kernel takes at once; a packed table has room for a whole number of these [-]."""

MAGIC = 7.3115e77
"""First number of a model's table, by which it is known."""
HEADER = 3
"""Numbers ahead of the table: magic number, number of pieces, length for the Reynolds number [m]."""

LEVEL = 0
"""Place, among a run's numbers, of the level of the surface above the world's origin, against gravity [m]."""
DENSITY = 1
"""Place of the density [kg/m3]."""
AIR_FRACTION = 2
"""Place of the shares of the hull's air that are kept, in the front and in the rear chambers (2) [-]."""
CURRENT = 4
"""Place of the velocity of the current in the world (3) [m/s]."""
VISCOSITY = 7
"""Place of the kinematic viscosity [m2/s]."""
CROSS_DRAG = 8
"""Place of the drag coefficient of a section across [-]."""
THICKENING = 9
"""Place of the factor on plate friction [-]."""
ADDED_MASS_FACTOR = 10
"""Place of the factor on added mass [-]."""
SHEDDING = 11
"""Place of the factor on what is shed at the tail [-]."""
WAVE = 12
"""Place of a wave's amplitude [m], wave vector in the world (3) [rad/m], angular frequency [rad/s], phase [rad]."""
SPLASH = 18
"""Place of the fraction of what the change of added mass at the surface moves that is lost [-]."""
FORCE = 19
"""Place where the kernel leaves the force of the water on the robot (3) [N]."""
POWER = 22
"""Place where it leaves the power of that force [W]."""
SUBMERGED_VOLUME = 23
"""Place where it leaves the volume under water [m3]."""
NUMBERS = 24
"""Length of the row [-]. Where it is longer the water is solved elsewhere: from this place on stands the added mass
that the kernel adds to MuJoCo's matrix, number by number in the order of that matrix [kg, kg m, kg m2]; it does nothing
else."""


def column(table: Float[np.ndarray, "piece column"], name: str) -> Float[np.ndarray, "piece part"]:
    """Return a view of one quantity of a table, see ``COLUMNS``."""
    start, stop = COLUMNS[name]
    return table[:, start:stop]


def pack_table(
    table: Float[np.ndarray, "piece column"], length: float, count: int | None = None
) -> Float[np.ndarray, " n"]:
    """Return a table as the row of numbers that a model carries: the header, then ``LANES`` pieces at a time.

    The numbers of one column stand beside each other.

    Args:
        table: the pieces.
        length: length of the body, for the Reynolds number of its friction [m].
        count: pieces to make room for; as many as there are if None.
    """
    blocks = -(-(len(table) if count is None else count) // LANES)
    rows = np.zeros((blocks * LANES, WIDTH))
    rows[: len(table)] = table
    half = np.linalg.norm(column(rows, "half"), axis=1)
    column(rows, "reach")[:, 0] = np.linalg.norm(column(rows, "at"), axis=1) + half
    return np.concatenate([[MAGIC, len(table), length], rows.reshape(blocks, LANES, WIDTH).swapaxes(1, 2).ravel()])


def unpack_table(numbers: Float[np.ndarray, " n"]) -> Float[np.ndarray, "piece column"]:
    """Return the table in the row of numbers that a model carries; a copy."""
    blocks = numbers[HEADER:].reshape(-1, WIDTH, LANES)
    return np.array(blocks.swapaxes(1, 2).reshape(-1, WIDTH)[: int(numbers[1])])


SHAPE_MAGIC = 7.3116e77
"""First number of a table of shapes, the geoms of any model, by which it is known."""
SHAPE_COLUMNS: Mapping[str, tuple[int, int]] = dict(COLUMNS) | {
    name: (start, stop)
    for name, start, stop in (
        ("solid", 32, 33),  # volume of the shape itself [m3]; "volume" is what of it displaces water
        ("bound", 33, 36),  # half extents along e_a, e_b, t of the box around a polyhedron's vertices [m]
        ("added_inertia", 36, 39),  # added inertia over density for rotation about e_a, e_b, t [m5]
        ("frontal", 39, 42),  # drag area times drag coefficient for motion along e_a, e_b, t [m2]
        ("coupled", 42, 43),  # 1: drag goes with the whole speed; 0: with the speed across and along t apart
        ("turning", 43, 46),  # torque of drag over half the density and the square of the rate [m5]
        ("linear", 46, 49),  # force of linear drag over the speed along e_a, e_b, t [kg/s]
        ("linear_turning", 49, 52),  # torque of linear drag over the rate [kg m2/s]
        ("lift", 52, 55),  # area times slope of the lift coefficient, of faces normal to e_a, e_b, t [m2]
        ("triangles", 55, 57),  # first triangle and number of triangles of a polyhedron
    )
}
"""Columns of a table of shapes: those of a table of pieces and more."""
SHAPE_WIDTH = 60
"""Columns of a table of shapes [-]."""
(
    SHAPE_COUNT, USERDATA_START, BODY_COUNT, WAVE_COUNT, LEVEL_COUNT, CURRENT_COUNT, TRIANGLE_COUNT, SHEAR,
) = range(1, 9)  # fmt: skip
"""Indices in the header of a table of shapes: number of shapes, first number in the user data, bodies of the model,
rows of waves, of the level over time and of the current's factor over time, triangles, and the current's change per
height (3) [1/s]."""
SHAPE_HEADER = 12
"""Numbers ahead of the numbers of the water in a table of shapes; after those stand levels, factors, waves, shapes and
triangles."""
WAVE_WIDTH = 6
"""Numbers of a wave: amplitude [m], wave vector (3) [rad/m], angular frequency [rad/s], phase [rad]."""
LOAD_WIDTH = 7
"""Numbers that the kernel leaves for each body, after the row of the water: force (3) [N], torque about the body's
origin (3) [N m], volume under water [m3]."""


def pack_shapes(
    table: Float[np.ndarray, "shape column"],
    triangles: Float[np.ndarray, "triangle 9"],
    water: Float[np.ndarray, " n"],
    schedules: tuple[Float[np.ndarray, "row 2"], Float[np.ndarray, "row 2"]],
    waves: Float[np.ndarray, "wave 6"],
    header: Mapping[int, float],
) -> Float[np.ndarray, " n"]:
    """Return a table of shapes and what the water is as the row of numbers that a model carries.

    Args:
        table: the shapes, columns as in ``SHAPE_COLUMNS``; "reach" is filled here.
        triangles: corners of the triangles of all polyhedra [m].
        water: numbers of the water, as in a run's row.
        schedules: level of the surface [m], and factor on the current [-], over time [s].
        waves: see ``WAVE_WIDTH``.
        header: numbers of the header by index: ``USERDATA_START``, ``BODY_COUNT``, ``SHEAR`` and after.
    """
    blocks = -(-len(table) // LANES)
    rows = np.zeros((blocks * LANES, SHAPE_WIDTH))
    rows[: len(table)] = table
    start, stop = SHAPE_COLUMNS["bound"]
    column(rows, "reach")[:, 0] = np.linalg.norm(column(rows, "at"), axis=1) + np.linalg.norm(
        rows[:, start:stop], axis=1
    )
    head = np.zeros(SHAPE_HEADER)
    head[0], head[SHAPE_COUNT], head[WAVE_COUNT] = SHAPE_MAGIC, len(table), len(waves)
    head[LEVEL_COUNT], head[CURRENT_COUNT] = (len(schedule) for schedule in schedules)
    head[TRIANGLE_COUNT] = len(triangles)
    for index, number in header.items():
        head[index] = number
    lanes = rows.reshape(blocks, LANES, SHAPE_WIDTH).swapaxes(1, 2)
    parts = (head, water, *schedules, waves, lanes, triangles)
    return np.concatenate([np.ravel(part) for part in parts])

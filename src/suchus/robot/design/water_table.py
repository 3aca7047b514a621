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
FORCE = 18
"""Place where the kernel leaves the force of the water on the robot (3) [N]."""
POWER = 21
"""Place where it leaves the power of that force [W]."""
SUBMERGED_VOLUME = 22
"""Place where it leaves the volume under water [m3]."""
NUMBERS = 23
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

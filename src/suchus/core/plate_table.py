"""The table of plates: the surfaces of a body as small flat plates, as the kernel of granular ground reads it.

Positions and normals are in the frame of the body that carries the plate.
"""

import numpy as np
from jaxtyping import Float

from suchus.core.water_table import NUMBERS

PLATE_MAGIC = 7.3117e77
"""First number of a table of plates, by which it is known."""
SHAPE_COUNT, STRENGTH, CREEP_SPEED = 1, 2, 3
"""Indices in the header: number of shapes, strength of the grains [N/m3], speed of creep [m/s]."""
PLATE_HEADER = 4
"""Numbers ahead of the shapes."""
SHAPE_BODY, SHAPE_FIRST, SHAPE_PLATES, SHAPE_REACH = range(4)
"""Numbers of a shape: its body, its first plate, its number of plates, and how far a plate is from the body's origin at
most [m]."""
SHAPE_NUMBERS = 4
"""Numbers of a shape in all."""
PLATE_NUMBERS = 7
"""Numbers of a plate: centre (3) [m], outward normal (3), area [m2]."""
PLATE_TIME, PLATE_IS_STEPPED = 0, 1
"""Indices in the user data of the time of the last evaluation [s], and whether there was one. Total force and power of
the grains stand where water leaves its own."""
PLATE_LOADS = NUMBERS
"""Index in the user data of the loads of the first shape; those of the others follow."""
LOAD_NUMBERS = 18
"""Numbers of a shape's loads: the force of the grains in the last step (3) [N], then the damping of the step to come:
force over velocity, the lower half row by row (6) [kg/s], and force over rate of rotation (9) [kg m/s]."""


def user_numbers(shapes: int) -> int:
    """Return how many numbers of user data a model with so many shapes needs."""
    return PLATE_LOADS + LOAD_NUMBERS * shapes


def pack_plates(
    bodies: Float[np.ndarray, " shape"],
    surfaces: list[Float[np.ndarray, "plate 7"]],
    strength: float,
    creep_speed: float,
) -> Float[np.ndarray, " n"]:
    """Return a table of plates as the row of numbers that a model carries.

    Args:
        bodies: number of the body that carries each shape.
        surfaces: plates of each shape, see ``PLATE_NUMBERS``.
        strength: vertical stress over depth on a level plate that moves down [N/m3].
        creep_speed: speed far below which the grains resist in proportion to the speed [m/s].
    """
    counts = np.array([len(plates) for plates in surfaces])
    reaches = [np.linalg.norm(plates[:, :3], axis=1).max(initial=0.0) for plates in surfaces]
    shapes = np.column_stack([bodies, np.cumsum(counts) - counts, counts, reaches])
    header = np.array([PLATE_MAGIC, len(surfaces), strength, creep_speed])
    return np.concatenate([header, shapes.ravel(), *(plates.ravel() for plates in surfaces)])

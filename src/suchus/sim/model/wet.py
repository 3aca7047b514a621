"""A model on which water acts: it carries the table of the robot's pieces, and room for what the water is."""

from functools import lru_cache
from typing import Any

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.core.water_table import column, pack_table
from suchus.robot.design import Robot, layout
from suchus.robot.design.ground import Relief
from suchus.robot.design.pieces import pieces
from suchus.sim.immersion.attachment import with_pieces
from suchus.sim.model.build import build


@lru_cache(maxsize=32)
def wet_model(
    robot: Robot,
    timestep: float,
    relief: Relief | None,
    max_pieces: int,
    *,
    acting: bool = False,
    is_solved: bool = False,
) -> Any:
    """Compile a robot for the water; the same values give the same ``mujoco.MjModel`` again: copy it before an edit.

    Args:
        robot: the design.
        timestep: time step of the physics [s].
        relief: what stands up from even ground.
        max_pieces: pieces that the table has room for, alike in all models of a batch.
        acting: whether the water acts in it; ``immersion.wetting.install`` goes before.
        is_solved: whether the water is solved elsewhere, so that the model has room for the added mass that it is told.

    Raises:
        InvalidDesign: MuJoCo cannot compile it.
    """
    try:
        spec = build(robot, timestep=timestep, relief=relief)
        if not is_solved:
            return compile_with_pieces(spec, robot, max_pieces, acting=acting)
        velocities = 6 + len(layout(robot).hinges)
        return compile_with_pieces(
            spec, robot, max_pieces, acting=acting, extra_numbers=velocities * (velocities + 1) // 2
        )
    except ValueError as error:
        raise InvalidDesign(f"robot {robot.name!r} does not compile: {error}") from error


def compile_with_pieces(
    spec: Any, robot: Robot, max_pieces: int | None = None, *, acting: bool = False, extra_numbers: int = 0
) -> Any:
    """Return a compiled ``mujoco.MjSpec`` that carries a robot's pieces.

    Args:
        spec: MuJoCo specification of a robot, perhaps with further edits that keep its bodies.
        robot: the design.
        max_pieces: see ``wet_model``; as much as needed if None.
        acting: see ``wet_model``.
        extra_numbers: numbers for the added mass of water that is solved elsewhere, see ``hydro.NUMBERS``.
    """
    table = np.array(pieces(robot))
    names = [body.name for body in layout(robot).bodies]
    model = with_pieces(spec, table, robot.length, max_pieces, acting=acting, extra_numbers=extra_numbers)
    ids = np.array([model.body(name).id for name in names])
    column(table, "body")[:, 0] = ids[table[:, 0].astype(int)]
    model.numeric_data[:] = pack_table(table, robot.length, max_pieces)
    return model

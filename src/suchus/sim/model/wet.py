"""A model on which water acts: it carries the table of the robot's pieces, and room for what the water is."""

from functools import lru_cache
from typing import Any

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.robot.design import Robot, layout
from suchus.robot.design.ground import Relief
from suchus.robot.design.pieces import pieces
from suchus.robot.design.water_table import NUMBERS, column, packed
from suchus.sim.model.build import build

NUMERIC = "water"
"""Name of the custom number that holds the table; see ``hydro.packed``."""


PLUGIN = "suchus.swimming.water"
"""Name of MuJoCo's plugin that lets the water act; ``land.wetting`` registers it."""


@lru_cache(maxsize=32)
def wet_model(
    robot: Robot, timestep: float, relief: Relief | None, room: int, *, acting: bool = False, solved: bool = False
) -> Any:
    """Compile a robot for the water; the same values give the same ``mujoco.MjModel`` again: copy it before an edit.

    Args:
        robot: the design.
        timestep: of the physics [s].
        relief: what stands up from even ground.
        room: pieces that the table has room for, alike in all models of a batch.
        acting: whether the water acts in it; ``land.wetting.install`` goes before.
        solved: whether the water is solved elsewhere, so that the model has room for the added mass that it is told.

    Raises:
        InvalidDesign: MuJoCo cannot compile it.
    """
    try:
        spec = build(robot, timestep=timestep, relief=relief)
        if not solved:
            return carrying(spec, robot, room, acting=acting)
        velocities = 6 + len(layout(robot).hinges)
        return carrying(spec, robot, room, acting=acting, more=velocities * (velocities + 1) // 2)
    except ValueError as error:
        raise InvalidDesign(f"robot {robot.name!r} does not compile: {error}") from error


def carrying(spec: Any, robot: Robot, room: int | None = None, *, acting: bool = False, more: int = 0) -> Any:
    """Return a compiled ``mujoco.MjSpec`` that carries a robot's pieces.

    Args:
        spec: of a robot, perhaps with further edits that keep its bodies.
        robot: the design.
        room: see ``wet_model``; as much as needed if None.
        acting: see ``wet_model``.
        more: numbers for the added mass of water that is solved elsewhere, see ``hydro.NUMBERS``.
    """
    table = np.array(pieces(robot))
    names = [body.name for body in layout(robot).bodies]
    model = with_pieces(spec, table, robot.length, room, acting=acting, more=more)
    ids = np.array([model.body(name).id for name in names])
    column(table, "body")[:, 0] = ids[table[:, 0].astype(int)]
    model.numeric_data[:] = packed(table, robot.length, room)
    return model


def with_pieces(
    spec: Any, table: np.ndarray, length: float, room: int | None = None, *, acting: bool = False, more: int = 0
) -> Any:
    """Return a compiled ``mujoco.MjSpec`` that carries a table of pieces.

    Args:
        spec: of any bodies.
        table: of pieces; its bodies are numbered as MuJoCo numbers them.
        length: for the Reynolds number of friction [m].
        room: pieces that the table has room for; as many as there are if None.
        acting: see ``wet_model``.
        more: see ``carrying``.
    """
    data = packed(table, length, room)
    numeric = spec.add_numeric(name=NUMERIC, size=len(data))
    numeric.data = data
    spec.nuserdata = NUMBERS + more
    if acting:
        spec.activate_plugin(PLUGIN)
        spec.add_plugin(name=NUMERIC, plugin_name=PLUGIN, active=True)
    return spec.compile()

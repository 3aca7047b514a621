"""A model on ground of grains: it has no hard ground, and carries the table of the robot's plates."""

from functools import lru_cache
from typing import Any

from suchus.core.errors import InvalidDesign
from suchus.robot.design import Robot
from suchus.robot.design.ground import Grains
from suchus.sim.immersion.grains import attach_grains
from suchus.sim.model.build import build


@lru_cache(maxsize=64)
def granular_model(robot: Robot, timestep: float, grains: Grains) -> Any:
    """Compile a robot on grains; the same values give the same ``mujoco.MjModel`` again: copy it before an edit.

    Args:
        robot: the design.
        timestep: time step of the physics [s].
        grains: the grains, whose surface is level at height 0.

    Raises:
        InvalidDesign: MuJoCo cannot compile it.
    """
    spec = build(robot, timestep=timestep)
    spec.geom("ground").contype = 0
    attach_grains(spec, grains.strength, grains.creep_speed)
    try:
        return spec.compile()
    except ValueError as error:
        raise InvalidDesign(f"robot {robot.name!r} does not compile: {error}") from error

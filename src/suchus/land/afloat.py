"""A robot put on the water: level with the surface, as deep as its weight asks for."""

import mujoco
import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq

from suchus.design import Robot
from suchus.design.hull import Hull
from suchus.design.pieces import pieces
from suchus.errors import InvalidDesign
from suchus.hydro import column, unpacked
from suchus.hydro.forces import hydrostatic
from suchus.land import wetting
from suchus.land.lake import Lake
from suchus.model.wet import wet_model
from suchus.rotation import about, multiply


def capacity(robot: Robot, lake: Lake) -> tuple[float, float]:
    """Return the volume of a robot wholly under water with the air that it keeps, and that of its weight [m3].

    Args:
        robot: the design; it floats if the first is greater.
        lake: the water, as it is at the beginning.
    """
    table = pieces(robot)
    lost = (1 - lake.at(0.0)[1]) * column(table, "air").sum()
    return float(column(table, "volume").sum() - lost), robot.mass / lake.water.density


def check_floats(robot: Robot, lake: Lake) -> None:
    """Refuse a robot that is heavier than the water that it displaces.

    Args:
        robot: the design.
        lake: the water, as it is at the beginning.

    Raises:
        InvalidDesign: it sinks; the message says by how much, and what foam is missing.
    """
    volume, weight = capacity(robot, lake)
    if volume < weight:
        surplus, foam = (weight - volume) * lake.water.density, Hull(foam=()).density
        raise InvalidDesign(
            f"robot {robot.name!r} sinks: it is {1e3 * surplus:.0f} g heavier than the water that it displaces; give "
            f"it a design.Hull with at least {1e3 * surplus / (lake.water.density - foam):.2f} l more foam, as "
            "design.flotation.float_hull makes, or keep more of its air."
        )


def surfaced(
    robot: Robot, lake: Lake, up: Float[np.ndarray, "3"], qpos: Float[np.ndarray, " q"], timestep: float
) -> Float[np.ndarray, " q"]:
    """Return a posture lifted to the surface, level with it but for its heel, if the robot floats clear of the ground.

    A robot that is heavier than its water, or that would touch the ground, stays as it stands.

    Args:
        robot: the design.
        lake: the water.
        up: against gravity, unit vector.
        qpos: the posture on the ground.
        timestep: of the physics [s].
    """
    level, air_fraction = lake.at(0.0)
    table = np.array(pieces(robot))
    volume, weight = capacity(robot, lake)
    if volume <= weight:
        return qpos
    wetting.install()
    model = wet_model(robot, timestep, None, len(table), acting=True)
    data = mujoco.MjData(model)
    floating = np.array(qpos)
    floating[3:7] = multiply(multiply(_raising(up), about(np.array([1.0, 0.0, 0.0]), lake.heel)), qpos[3:7])
    floating[:3] = 0.0
    data.qpos[:] = floating
    mujoco.mj_kinematics(model, data)
    bodies = unpacked(model.numeric_data)

    def lacking(height: float) -> float:
        return float(hydrostatic(bodies, data.xpos, data.xmat, up, -height, (air_fraction, air_fraction))[0]) - weight

    reach = float(robot.length)
    height = brentq(lacking, -reach, reach, xtol=1e-9)  # of the root above the surface
    floating[:3] = qpos[:3] + (level + height - float(up @ qpos[:3])) * up
    data.qpos[:] = floating
    mujoco.mj_forward(model, data)
    touching = any(contact.dist < 0.0 for contact in data.contact)
    return qpos if touching else floating


def _raising(up: np.ndarray) -> np.ndarray:
    """Return the shortest turn that takes z to ``up``, as a quaternion wxyz."""
    axis = np.cross([0.0, 0.0, 1.0], up)
    turn = np.array([1.0 + up[2], *axis])
    return np.asarray(turn / np.linalg.norm(turn))

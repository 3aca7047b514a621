"""Refuse a robot that would begin inside a step, a stone or bumps."""

import mujoco
import numpy as np
from jaxtyping import Float

from suchus.core.errors import InvalidDesign
from suchus.robot.design import Robot
from suchus.robot.design.ground import Bumps, Relief, Step
from suchus.sim.model import compile_model
from suchus.sim.model.build import RELIEF

OVERLAP_TOLERANCE = 1e-3
"""Depth over the robot's length up to which a body may begin inside a relief [-]: about how far resting feet sink."""


def check_clear(robot: Robot, relief: Relief | None, qpos: Float[np.ndarray, " q"], timestep: float) -> None:
    """Refuse a first posture in which the robot overlaps what stands up from the ground.

    Args:
        robot: the design.
        relief: what stands up from the ground; None for even ground.
        qpos: generalised positions of the first posture.
        timestep: time step of the physics [s].

    Raises:
        InvalidDesign: it overlaps; the message names the body that is deepest inside, the depth and a remedy.
    """
    if relief is None:
        return
    model = compile_model(robot, timestep, relief)
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_fwdPosition(model, data)
    relief_geom = model.geom(RELIEF).id
    contacts = [contact for contact in data.contact if relief_geom in contact.geom]
    deepest = min(contacts, key=lambda contact: float(contact.dist), default=None)
    if deepest is None or -float(deepest.dist) <= OVERLAP_TOLERANCE * robot.length:
        return
    geom = next(int(geom) for geom in deepest.geom if geom != relief_geom)
    body = model.body(model.geom_bodyid[geom]).name
    name = type(relief).__name__.lower()
    setting = "start" if isinstance(relief, Bumps) else "at"
    robot_geoms = model.geom_bodyid > 0
    front = float(np.max((data.geom_xpos[:, 0] + model.geom_rbound)[robot_geoms]))
    behind = "" if isinstance(relief, Step | Bumps) else ", or behind it"
    raise InvalidDesign(
        f"robot {robot.name!r} begins inside the {name}: {body} overlaps it by {-1e3 * float(deepest.dist):.3g} mm; "
        f"{name}.{setting} is {getattr(relief, setting):g} m from the hips, and the robot reaches to {front:.3g} m: "
        f"put the {name} ahead of it{behind}."
    )

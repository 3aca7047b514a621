"""A robot put on the ground in a posture."""

from typing import Any

import mujoco
import numpy as np

from suchus.design import Robot, layout
from suchus.model.build import joint_addresses
from suchus.rotation import about


def standing(model: Any, robot: Robot, hip_height: float, servos: np.ndarray) -> np.ndarray:
    """Return the generalised positions of a robot that stands on the ground with given servo angles.

    It faces forward on the whole: a bent trunk turns the girdles to either side of +x by equal angles.

    Args:
        model: its ``mujoco.MjModel``, with a ground.
        robot: the design.
        hip_height: of the root, higher where something would be below the ground [m].
        servos: shape (servo,) [rad].
    """
    data = mujoco.MjData(model)
    place = layout(robot)
    data.qpos[2] = hip_height
    turn = -sum(servos[i] for i in place.trunk_yaw) / 2
    data.qpos[3:7] = about(np.array([0.0, 0.0, 1.0]), turn)
    direct = len(place.servos) - len(place.cables)
    data.qpos[joint_addresses(model, place.servos[:direct])] = servos[:direct]
    for i in place.cables:
        cable = place.cable(i)
        pulley_per_bend = cable.cord_spacing / 2 / cable.pulley
        data.qpos[joint_addresses(model, cable.hinges)] = servos[i] / pulley_per_bend / cable.joints
    mujoco.mj_forward(model, data)
    deepest = min((float(c.dist) for c in data.contact), default=0.0)
    data.qpos[2] -= min(deepest, 0.0)
    return np.array(data.qpos)


def activations(model: Any, servos: np.ndarray) -> np.ndarray:
    """Return the servos' inner states at rest: the slew-limited target first, then the integral."""
    act = np.zeros(model.na)
    act[model.actuator_actadr] = servos
    return act

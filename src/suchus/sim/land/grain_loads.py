"""The forces of grains on feet, limbs, trunk and tail, in the order of the sensors of contact forces."""

from typing import Any

import numpy as np
from jaxtyping import Float

from suchus.core.plate_table import LOAD_NUMBERS, PLATE_LOADS
from suchus.robot.design import Robot, layout
from suchus.sim.immersion.grains import grained_geoms
from suchus.sim.model import force_sensors


class GrainLoads:
    """What the sensors of contact forces would show of the grains, which are no contacts of MuJoCo's.

    Args:
        model: a model of a robot on grains.
        robot: the design.
        user_data: user data of all runs in the memory that the physics writes, shape (run, number).
    """

    def __init__(self, model: Any, robot: Robot, user_data: Float[np.ndarray, "run number"]) -> None:
        """Find the sensors that the force on each geom belongs to."""
        geoms = grained_geoms(model)
        self._loads = user_data[:, PLATE_LOADS : PLATE_LOADS + LOAD_NUMBERS * len(geoms)]  # the physics writes into it
        robot_layout, sensors = layout(robot), force_sensors(robot)
        parents = {body.name: body.parent for body in robot_layout.bodies}
        names = [body.name for body in robot_layout.bodies]
        hips = {
            names[limb.tip - len(limb.girdle.limb.links) + 1]: f"{limb.name}_limb_force" for limb in robot_layout.limbs
        }
        tails = dict.fromkeys(robot_layout.tail[:1], "tail_force")
        self._belongs = np.zeros((len(sensors), len(geoms)))
        for column, geom in enumerate(geoms):
            geom_name, body = model.geom(geom).name, model.body(int(model.geom_bodyid[geom])).name
            if geom_name.endswith("_foot"):
                self._belongs[sensors.index(f"{geom_name.removesuffix('_foot')}_force"), column] = 1.0
            while body not in hips and body not in tails and parents[body] >= 0 and body not in robot_layout.trunk:
                body = names[parents[body]]
            sensor = hips.get(body) or tails.get(body) or f"{body}_force"
            self._belongs[sensors.index(sensor), column] = 1.0

    def forces(self) -> Float[np.ndarray, "run number"]:
        """Return the forces of the parts on the grains in the last step of the physics [N]."""
        loads = self._loads.reshape(len(self._loads), -1, LOAD_NUMBERS)[..., :3]
        return -np.asarray(self._belongs @ loads).reshape(len(loads), -1)

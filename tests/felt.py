"""What robots feel, made by hand."""

import numpy as np

from suchus.robot.control import Sensed
from suchus.robot.design import layout


def felt(robot, runs=1, time=0.0, **readings):
    """Return the readings of robots, all alike, that stand level and feel nothing but what is given."""
    place = layout(robot)
    sizes = dict.fromkeys(("servo_position", "servo_velocity", "servo_torque"), len(place.servos))
    sizes |= {"foot_pressure": len(place.limbs), "belly_pressure": len(place.trunk)}
    sizes |= {"angular_velocity": 3, "acceleration": 3}
    values = {name: np.zeros((runs, size)) for name, size in sizes.items()}
    values |= {"tail_pressure": np.zeros(runs), "depth": np.zeros(runs)}
    values |= {"orientation": np.tile([1.0, 0.0, 0.0, 0.0], (runs, 1))}
    given = {name: np.broadcast_to(reading, values[name].shape) for name, reading in readings.items()}
    return Sensed(time=time, **(values | given))

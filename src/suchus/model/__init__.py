"""From a design to a MuJoCo model: the only room that writes MJCF."""

from suchus.model.build import SLEW, build, compile_model, joint_addresses, topology
from suchus.model.names import force_sensors, sensor_names, sites
from suchus.model.standing import activations, standing

__all__ = [
    "SLEW",
    "activations",
    "build",
    "compile_model",
    "force_sensors",
    "joint_addresses",
    "sensor_names",
    "sites",
    "standing",
    "topology",
]

"""From a design to a MuJoCo model: the only room that writes MJCF."""

from suchus.model.build import SLEW, build, compile_model, joint_addresses, topology
from suchus.model.names import SITES, TRUNK_BODIES, sensor_names
from suchus.model.standing import activations, standing

__all__ = [
    "SITES",
    "SLEW",
    "TRUNK_BODIES",
    "activations",
    "build",
    "compile_model",
    "joint_addresses",
    "sensor_names",
    "standing",
    "topology",
]

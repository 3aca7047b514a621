"""From a design to a MuJoCo model: the only room that writes MJCF."""

from suchus.model.build import (
    SLEW,
    activations,
    build,
    compile_model,
    force_sensors,
    joint_addresses,
    sensor_names,
    sites,
    standing,
    topology,
)

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

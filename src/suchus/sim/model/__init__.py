"""From a design to a MuJoCo model: the only package that writes MJCF."""

from suchus.sim.model.actuators import SUPPLY, activations, ambient, slew_column, supplies, warming
from suchus.sim.model.build import (
    build,
    compile_model,
    force_sensors,
    joint_addresses,
    sensor_names,
    sites,
    standing,
    topology,
)
from suchus.sim.model.stability import longest_step

__all__ = [
    "SUPPLY",
    "activations",
    "ambient",
    "build",
    "compile_model",
    "force_sensors",
    "joint_addresses",
    "longest_step",
    "sensor_names",
    "sites",
    "slew_column",
    "standing",
    "supplies",
    "topology",
    "warming",
]

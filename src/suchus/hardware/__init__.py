"""From a gait to the servos of a robot that stands on a table: angles, pulses, limits, files."""

from suchus.hardware.commands import Commands, commands, csv_text, trajectory_text
from suchus.hardware.limits import (
    ServoLoad,
    check_commands,
    check_loads,
    loads,
    loads_of_each,
    overloaded,
    share_at_limit,
)
from suchus.hardware.servo_map import ServoLine, ServoMap, read_map, straight, write_map

__all__ = [
    "Commands",
    "ServoLine",
    "ServoLoad",
    "ServoMap",
    "check_commands",
    "check_loads",
    "commands",
    "csv_text",
    "loads",
    "loads_of_each",
    "overloaded",
    "read_map",
    "share_at_limit",
    "straight",
    "trajectory_text",
    "write_map",
]

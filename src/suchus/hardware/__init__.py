"""From a gait to the servos of a robot that stands on a table: angles, pulses, limits, files."""

from suchus.hardware.blind import BlindRig
from suchus.hardware.commands import Commands, commands, csv_text, trajectory_text
from suchus.hardware.drive import BusClock, Clock, DriveSettings, WallClock, about, check_drive, drive
from suchus.hardware.guard import DriveLimits
from suchus.hardware.limits import (
    ServoLoad,
    check_commands,
    check_loads,
    loads,
    loads_of_each,
    overloaded,
    share_at_limit,
)
from suchus.hardware.log import Log, held
from suchus.hardware.rig import Reading, Rig, senses
from suchus.hardware.servo_map import ServoLine, ServoMap, read_map, straight, write_map
from suchus.hardware.wiring import read_wiring, wiring_text, write_wiring

__all__ = [
    "BlindRig",
    "BusClock",
    "Clock",
    "Commands",
    "DriveLimits",
    "DriveSettings",
    "Log",
    "Reading",
    "Rig",
    "ServoLine",
    "ServoLoad",
    "ServoMap",
    "WallClock",
    "about",
    "check_commands",
    "check_drive",
    "check_loads",
    "commands",
    "csv_text",
    "drive",
    "held",
    "loads",
    "loads_of_each",
    "overloaded",
    "read_map",
    "read_wiring",
    "senses",
    "share_at_limit",
    "straight",
    "trajectory_text",
    "wiring_text",
    "write_map",
    "write_wiring",
]

"""From a gait to the servos of a robot that stands on a table: angles, pulses, loads, sizes, limits, files, driving.

``hardware.bus`` has packets, control tables and ports, ``hardware.emulator`` servos that are simulated behind a bus.
Nothing here knows an experiment.

Start reading with ``hardware.commands``, then ``hardware.drive``.
"""

from suchus.hardware.blind import BlindRig
from suchus.hardware.commands import Commands, commands, csv_text, trajectory_text
from suchus.hardware.drive import BusClock, DriveSettings, TickClock, WallClock, check_drive, drive, wire_statistics
from suchus.hardware.guard import DriveLimits
from suchus.hardware.limits import check_commands, check_loads, overloaded
from suchus.hardware.loads import LoadCase, ServoLoad, cases, loads, loads_of_cases, share_at_limit
from suchus.hardware.log import DriveLog, fix_in_place, hinge_angles
from suchus.hardware.odometry import walked_distance
from suchus.hardware.rig import Rig, RigReading, senses
from suchus.hardware.servo_map import ServoLine, ServoMap, read_map, straight, write_map
from suchus.hardware.sizing import ServoFamily, Sizing, size, with_better, with_motors
from suchus.hardware.wiring import read_wiring, wiring_text, write_wiring

__all__ = [
    "BlindRig",
    "BusClock",
    "Commands",
    "DriveLimits",
    "DriveLog",
    "DriveSettings",
    "LoadCase",
    "Rig",
    "RigReading",
    "ServoFamily",
    "ServoLine",
    "ServoLoad",
    "ServoMap",
    "Sizing",
    "TickClock",
    "WallClock",
    "cases",
    "check_commands",
    "check_drive",
    "check_loads",
    "commands",
    "csv_text",
    "drive",
    "fix_in_place",
    "hinge_angles",
    "loads",
    "loads_of_cases",
    "overloaded",
    "read_map",
    "read_wiring",
    "senses",
    "share_at_limit",
    "size",
    "straight",
    "trajectory_text",
    "walked_distance",
    "wire_statistics",
    "wiring_text",
    "with_better",
    "with_motors",
    "write_map",
    "write_wiring",
]

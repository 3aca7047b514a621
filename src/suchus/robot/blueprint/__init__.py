"""Robots, gaits and servos as TOML files that people write, and every mistake in them named at once."""

from suchus.robot.blueprint.corrections import read_correction
from suchus.robot.blueprint.foreign import check_no_xml, check_robot_format
from suchus.robot.blueprint.gaits import read_gait
from suchus.robot.blueprint.mistakes import MistakenFile
from suchus.robot.blueprint.motors import read_motors
from suchus.robot.blueprint.read import parse_robot, parse_table, read_design
from suchus.robot.blueprint.write import render, write

__all__ = [
    "MistakenFile",
    "check_no_xml",
    "check_robot_format",
    "parse_robot",
    "parse_table",
    "read_correction",
    "read_design",
    "read_gait",
    "read_motors",
    "render",
    "write",
]

"""Files to save from a live walk: its gait, as the sliders and switches set it, and its robot, as TOML."""

from dataclasses import replace
from typing import NamedTuple

from suchus.blueprint import render
from suchus.design import Robot
from suchus.gaits import GAITS
from suchus.viewer.session import Settings


class SavedFile(NamedTuple):
    """A file that a browser is given."""

    name: str
    """Name of the file."""
    content: bytes
    """Its text, in UTF-8."""


def gait_file(robot: Robot, settings: Settings) -> SavedFile:
    """Return the gait that is walked; one that differs from the shelf's gait of its name is called ``NAME_tuned``.

    Args:
        robot: the robot that walks.
        settings: sliders and switches.
    """
    gait = settings.walked(robot)
    if gait.name in GAITS and GAITS[gait.name] != gait:
        gait = replace(gait, name=f"{gait.name}_tuned")
    head = (f"Saved from a live walk of {robot.name}: suchus view {robot.name} {gait.name}.toml",)
    return _file(gait.name, render(gait, head=head))


def robot_file(robot: Robot) -> SavedFile:
    """Return the robot that is watched."""
    return _file(robot.name, render(robot, head=("Saved from a live walk.",)))


def _file(name: str, text: str) -> SavedFile:
    return SavedFile(f"{name}.toml", text.encode("utf-8"))

"""``suchus export``: a robot as a folder that other tools open."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, get_args

import tyro

from suchus.apps.cli.options import parse
from suchus.apps.cli.word_checks import option_values
from suchus.core.errors import UnknownName
from suchus.core.files import check_name, check_writable
from suchus.robot.design import Robot
from suchus.robot.gaits import default_gait
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.model.export import Format, export


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportOptions:
    """Options of ``suchus export``."""

    format: Format = "mjcf"
    """MJCF for MuJoCo, USD for Isaac, Newton and Omniverse (extra usd), URDF for nearly everything else."""
    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that is exported."""
    home: Gait | None = None
    """Gait whose mid-stance is the home posture of the MJCF; by default the robot's own."""
    timestep: Annotated[float, tyro.conf.arg(metavar="SECONDS")] = 0.002
    """Time step of the physics in the MJCF [s]."""
    out: Path | None = None
    """The folder; by default export/ROBOT_FORMAT. An older export there is replaced, anything else is refused."""


def export_robot(words: Sequence[str]) -> int:
    """Write the folder, say where it is, and return 0.

    Raises:
        SuchusError: the words make no sense, or the place cannot be written to.
    """
    description = (
        "Write a robot for other tools: model, scene, home posture, and a README of what the format leaves out."
    )
    _check_format(words)
    options = parse(ExportOptions, "suchus export", words, description)
    if options.out is None:
        check_name(options.robot.name, "robot")
    folder = options.out or Path("export") / f"{options.robot.name}_{options.format}"
    check_writable(folder.parent)
    export(
        options.robot, options.home or default_gait(options.robot), folder, options.format, timestep=options.timestep
    )
    print(f"{options.robot.name} as {options.format.upper()}: {folder}")
    return 0


def _check_format(words: Sequence[str]) -> None:
    """Refuse an unknown format with a suggestion of similar ones; the parser only lists all formats."""
    for word in option_values(words, "--format"):
        if word not in get_args(Format):
            raise UnknownName("format", word, get_args(Format))

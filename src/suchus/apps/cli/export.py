"""``suchus export``: a robot as a folder that other tools open."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal, get_args

import tyro

from suchus.apps.cli.entry import BadCommand
from suchus.apps.cli.options import parse
from suchus.apps.cli.word_checks import option_values
from suchus.core.errors import UnknownName
from suchus.core.files import check_name, check_writable
from suchus.robot.control.onnx_file import export_onnx
from suchus.robot.design import Robot
from suchus.robot.gaits import default_gait
from suchus.robot.motion import Gait
from suchus.robot.policies import policy_of
from suchus.robot.robots import ROBOTS
from suchus.sim.model.export import Format, export

ONNX: Literal["onnx"] = "onnx"
FORMATS = (*get_args(Format), ONNX)
"""Formats of a robot, and that of a policy."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportOptions:
    """Options of ``suchus export``."""

    format: Format | Literal["onnx"] = "mjcf"
    """MJCF for MuJoCo, USD for Isaac, Newton and Omniverse (extra usd), URDF for nearly everything else; ONNX for the
    network of a policy (extra onnx)."""
    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that is exported."""
    home: Gait | None = None
    """Gait whose mid-stance is the home posture of the MJCF; by default the robot's own."""
    timestep: Annotated[float, tyro.conf.arg(metavar="SECONDS")] = 0.002
    """Time step of the physics in the MJCF [s]."""
    policy: str | None = None
    """Policy of which the network is exported, its name or its file; for the format onnx."""
    out: Path | None = None
    """The folder; by default export/ROBOT_FORMAT. An older export there is replaced, anything else is refused. Of a
    policy the file; by default export/POLICY.onnx."""


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
    if (options.policy is not None) != (options.format == ONNX):
        raise BadCommand("--format onnx and --policy belong together: a policy is exported as ONNX, a robot is not.")
    if options.policy is not None:
        return _export_policy(options, options.policy)
    if options.out is None:
        check_name(options.robot.name, "robot")
    folder = options.out or Path("export") / f"{options.robot.name}_{options.format}"
    check_writable(folder.parent)
    assert options.format != ONNX
    export(
        options.robot, options.home or default_gait(options.robot), folder, options.format, timestep=options.timestep
    )
    print(f"{options.robot.name} as {options.format.upper()}: {folder}")
    return 0


def _export_policy(options: ExportOptions, policy_word: str) -> int:
    """Write the network of a policy as ONNX, say where it is, and return 0."""
    policy = policy_of(options.robot, policy_word)
    path = export_onnx(policy, options.robot, options.out or Path("export") / f"{policy.name}.onnx")
    print(f"{policy.name} as ONNX: {path}")
    return 0


def _check_format(words: Sequence[str]) -> None:
    """Refuse an unknown format with a suggestion of similar ones; the parser only lists all formats."""
    for word in option_values(words, "--format"):
        if word not in FORMATS:
            raise UnknownName("format", word, FORMATS)

"""A folder for another tool: the model, what goes with it, and what the format leaves out."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Literal, get_args

from suchus.core.checks import require
from suchus.core.errors import InvalidDesign, UnknownName
from suchus.core.files import digest, new_folder, versions
from suchus.robot import blueprint
from suchus.robot.design import Robot
from suchus.robot.motion import Gait, check_limits
from suchus.sim.model.build import TIMESTEP
from suchus.sim.model.export.mjcf import mjcf
from suchus.sim.model.export.urdf import BALL, ball, unsaid, urdf
from suchus.sim.model.export.usd import scene, unsaid_in_usd, usd

Format = Literal["mjcf", "urdf", "usd"]
MARK = "suchus_export.json"
"""The file that says what is exported, and by what."""
_LICENCE = """This model was written by suchus and carries its licence, Apache-2.0:
https://www.apache.org/licenses/LICENSE-2.0
Its numbers come from robot.toml; keep this note with copies.
"""


def export(robot: Robot, gait: Gait, folder: str | Path, kind: Format, *, timestep: float = TIMESTEP) -> Path:
    """Write a robot for another tool and return the folder, which appears whole or not at all.

    Args:
        robot: the design.
        gait: gait whose mid-stance is the home posture.
        folder: an older export there is replaced where nobody changed it.
        kind: kind of model.
        timestep: time step of the physics, for MJCF [s].

    Raises:
        UnknownName: there is no such format.
        InvalidDesign: the robot's name makes no file name.
        OutsideLimits: the robot cannot take the home posture.
        Unwritable: the place cannot be written to, or is taken.
        NoUsd: USD without usd-core.
    """
    folder = Path(folder)
    if kind not in get_args(Format):
        raise UnknownName("format", kind, get_args(Format))
    if not robot.name or robot.name.startswith(".") or any(c in robot.name for c in "/\\\0"):
        raise InvalidDesign(f"the robot is named {robot.name!r}, which makes no file name; give it another name.")
    require("export", "timestep", timestep, 1e-5, 0.1, "s")
    check_limits(robot, gait)
    texts = _texts(robot, gait, kind, timestep)
    origin = {"format": kind, "robot": digest({"robot": robot}), "home": digest({"gait": gait}), "versions": versions()}
    texts |= {
        "robot.toml": blueprint.render(robot),
        "LICENSE": _LICENCE,
        MARK: json.dumps(origin, indent=1, sort_keys=True) + "\n",
    }
    with new_folder(folder) as draft:
        for name, text in texts.items():
            (draft / name).parent.mkdir(exist_ok=True)
            (draft / name).write_text(text, encoding="utf-8")
    return folder


def _texts(robot: Robot, gait: Gait, kind: Format, timestep: float) -> dict[str, str]:
    if kind == "mjcf":
        return _mjcf(robot, gait, timestep)
    return _urdf(robot) if kind == "urdf" else _usd(robot, gait)


def _mjcf(robot: Robot, gait: Gait, timestep: float) -> dict[str, str]:
    """Return the texts of the files of an MJCF export by name."""
    model, scene = mjcf(robot, gait, timestep=timestep)
    files = {
        f"{robot.name}.xml": "the robot: bodies, joints, tendon, servos, sensors, keyframe `home`",
        "scene.xml": "the robot on flat ground",
    }
    text = _readme(
        robot,
        files,
        f"python -m mujoco.viewer --mjcf={_quoted('scene.xml')}",
        f"Needs MuJoCo 4.0 or later: the servos are its `pid` actuators. `home` is the mid-stance of {gait.name}: "
        "start from it, with `mj_resetDataKeyframe`. The scene compiles to the numbers of suchus's own model, to the "
        "last bit.",
        (
            "The gait and its controller: MJCF holds a body, not what it does. Servo angles over time come from "
            "`suchus export-commands`.",
            f"{_cords(robot)}the tendon is the first order of their change in length (within 1.2 % "
            "up to a bend of 180 degrees), as in suchus itself.",
        ),
    )
    return {f"{robot.name}.xml": model, "scene.xml": scene, "README.md": text}


def _cords(robot: Robot) -> str:
    """Return in words what moves the cords of a cable, and in what its actuator is told."""
    linear = next((cable for cable in robot.cables if cable.linear is not None), None)
    if linear is None:
        return "The two cords run over one pulley; "
    return (
        f"One linear actuator moves the two cords: the control of {linear.name} is its travel over {linear.pulley:g} "
        "m, the force its torque over the same; "
    )


def _urdf(robot: Robot) -> dict[str, str]:
    """Return the texts of the files of a URDF export by name."""
    files = {f"{robot.name}.urdf": "the robot: links, joints, limits, shapes", BALL: "a ball that ellipsoids stretch"}
    introduction = (
        "Joints and frames (feet, snout, tail_tip, imu) carry the names that suchus gives them; x forward, y left, z "
        "up, in metres, kilograms and radians."
    )
    text = _readme(robot, files, f"yourdfpy {_quoted(robot.name + '.urdf')}", introduction, unsaid(robot))
    return {f"{robot.name}.urdf": urdf(robot), BALL: ball(), "README.md": text}


def _usd(robot: Robot, gait: Gait) -> dict[str, str]:
    """Return the texts of the files of a USD export by name."""
    name = f"{robot.name}.usda"
    files = {
        name: "the robot: bodies, joints with limits and drives, shapes, frames",
        "scene.usda": "the robot on level ground, with gravity and a light",
    }
    introduction = (
        "UsdPhysics, in metres and kilograms, z up, x forward; angles are degrees, as the schema has them. All joints "
        f"are at zero; their drives lead to the mid-stance of {gait.name}. Bodies, joints (below `joints`) and frames "
        "(feet, snout, tail_tip, imu, below their bodies) carry the names that suchus gives them."
    )
    text = _readme(robot, files, f"usdview {_quoted('scene.usda')}", introduction, unsaid_in_usd(robot))
    return {name: usd(robot, gait), "scene.usda": scene(robot), "README.md": text}


def _readme(robot: Robot, files: Mapping[str, str], command: str, introduction: str, omissions: tuple[str, ...]) -> str:
    """Return the README of an export in Markdown.

    Args:
        robot: the design.
        files: what each file holds, by name.
        command: shell command that shows the model.
        introduction: text before the table of files.
        omissions: what the format leaves out, a sentence or more each.
    """
    files = {
        **files,
        "robot.toml": "every number, with its meaning and unit",
        "LICENSE": "Apache-2.0",
        MARK: "which robot, which software",
    }
    robot_text = "A robot" if robot.tables is None else "A crocodile-like robot"
    lines = [
        f"# {robot.name}",
        "",
        f"{robot_text} of {robot.mass:.2f} kg and {robot.length:.2f} m, written by suchus.",
        "",
        introduction,
        "",
        "| file | holds |",
        "|---|---|",
        *(f"| `{name}` | {description} |" for name, description in files.items()),
        "",
        f"Look at it: `{command}`",
        "",
        "## What this format does not say",
        "",
        *(f"* {text}" for text in omissions),
    ]
    return "\n".join(lines) + "\n"


def _quoted(name: str) -> str:
    return f"'{name}'" if " " in name else name

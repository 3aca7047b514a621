"""``suchus parts ROBOT``: what it is built of, as a page, tables, outlines, and what ROS 2 needs."""

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import takewhile
from pathlib import Path
from typing import Annotated

import tyro

from suchus.apps.cli.options import parse
from suchus.apps.cli.terminal import working
from suchus.apps.cli.word_checks import check_named_once
from suchus.apps.report.building_sheet import PAGE, floating_sentence, mass_sentences, write_parts
from suchus.core.files import check_name, check_replaceable, check_writable, digest, new_folder, versions
from suchus.hardware import commands, straight
from suchus.hardware.outlines import libraries
from suchus.hardware.parts import PLASTIC, WALL, sheet
from suchus.hardware.ros import unfit_reason
from suchus.robot import blueprint
from suchus.robot.design import Robot
from suchus.robot.gaits import default_gait
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS

MARK = "suchus_parts.json"


@dataclass(frozen=True, slots=True, kw_only=True)
class PartsOptions:
    """Options of ``suchus parts``."""

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """Robot that is to be built; the first word."""
    gait: Gait | None = None
    """Gait whose trajectory is written; by default the robot's own."""
    motors: Path | None = None
    """TOML file of servos that are sold, in the place of those that suchus knows."""
    wall: float = WALL
    """Thickness of printed walls [m]."""
    density: float = PLASTIC
    """Density of what is printed [kg/m3]."""
    no_outlines: tyro.conf.FlagCreatePairsOff[bool] = False
    """Write no STL and DXF, which need the extra parts."""
    out: Annotated[Path | None, tyro.conf.arg(help="The folder; by default export/ROBOT_parts.")] = None


def list_parts(words: Sequence[str]) -> int:
    """Write the building sheet, say what is in it, and return 0.

    Raises:
        SuchusError: the words make no sense, a library is missing, or the place cannot be written to.
    """
    description = (
        "A building sheet: parts with masses and lengths, frames, cables, plates, wiring, foam; outlines as STL and "
        "DXF; URDF with ros2_control, controllers and a trajectory.\n\nusage: suchus parts ROBOT [options]"
    )
    positional = list(takewhile(lambda word: not word.startswith("-"), words[:1]))
    check_named_once(positional, ("--robot",), words)
    robot_words = ["--robot", positional[0]] if positional else []
    options = parse(PartsOptions, "suchus parts", [*robot_words, *words[len(positional) :]], description)
    robot = options.robot
    gait = options.gait or default_gait(robot)
    motors = None if options.motors is None else blueprint.read_motors(options.motors)
    if not options.no_outlines:
        libraries()
    if options.out is None:
        check_name(robot.name, "robot")
    folder = options.out or Path("export") / f"{robot.name}_parts"
    check_writable(folder.parent)
    check_replaceable(folder)
    parts_sheet = sheet(robot, motors=motors, wall=options.wall, density=options.density)
    samples = commands(robot, gait, straight(robot))
    origin = {"robot": digest({"robot": robot}), "gait": digest({"gait": gait}), "versions": versions()}
    with working() as bars, new_folder(folder) as draft:
        bars.task(f"building sheet of {robot.name}")
        write_parts(parts_sheet, draft, gait=gait, samples=samples, outlines=not options.no_outlines)
        (draft / MARK).write_text(json.dumps(origin, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    for sentence in (*mass_sentences(parts_sheet), floating_sentence(parts_sheet), unfit_reason(robot)):
        if sentence:
            print(sentence)
    print(f"the page with all of it: {folder / PAGE}")
    return 0

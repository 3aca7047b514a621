"""``suchus size ROBOT GAIT ...``: what its servos bear, and which servos that are sold are enough."""

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import takewhile
from math import radians
from pathlib import Path
from typing import Annotated

import tyro

from suchus.apps.cli.entry import BadCommand
from suchus.apps.cli.options import parse
from suchus.apps.cli.terminal import working
from suchus.apps.cli.word_checks import check_named_once
from suchus.apps.report.size_page import PAGE, answer, write_size
from suchus.core.checks import require
from suchus.core.files import check_name, check_replaceable, check_writable, digest, new_folder, versions
from suchus.hardware import cases, size
from suchus.robot import blueprint
from suchus.robot.design import Motor, Robot
from suchus.robot.gaits import default_gait, gait_of
from suchus.robot.robots import ROBOTS
from suchus.sim.fault import Fault
from suchus.sim.faults import FAULTS, from_text

MARK = "suchus_size.json"


@dataclass(frozen=True, slots=True, kw_only=True)
class SizeOptions:
    """Options of ``suchus size``."""

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """Robot whose servos are sized; the first word."""
    gaits: tuple[str, ...] = ()
    """Gaits that it shall walk, names or files; the words after the robot. By default its own."""
    family: str | None = None
    """Only this family of servos, as suchus list names them; by default all."""
    motors: Path | None = None
    """TOML file of servos that are sold, in the place of those that suchus knows."""
    slope: tuple[float, ...] = ()
    """Slopes up which it shall walk too [degrees]."""
    fault: tuple[str, ...] = ()
    """Faults with which it shall walk too, as limp:LF_pitch or weak:LF_pitch,fraction=0.3."""
    standing: tyro.conf.FlagCreatePairsOff[bool] = False
    """Let it stand up, too."""
    water: tyro.conf.FlagCreatePairsOff[bool] = False
    """Let it swim, too; the robot must float."""
    hours: float = 1.0
    """Time for which the battery is asked [h]."""
    out: Annotated[Path | None, tyro.conf.arg(help="The folder; by default export/ROBOT_size.")] = None


def size_servos(words: Sequence[str]) -> int:
    """Size the servos, write page and tables, print the answer, and return 0.

    Raises:
        SuchusError: the words make no sense, a simulation fails, or the place cannot be written to.
    """
    description = (
        "Size the servos of a robot: what each bears in its gaits, and the cheapest servos of one family that are "
        "enough, by simulation; if a gait is too fast for them, the period at which they are.\n\n"
        "usage: suchus size ROBOT GAIT ... [options]"
    )
    positional = list(takewhile(lambda word: not word.startswith("-"), words))
    check_named_once(positional, ("--robot", "--gaits"), words)
    robot_words = ["--robot", positional[0]] if positional else []
    gait_words = ["--gaits", *positional[1:]] if len(positional) > 1 else []
    options = parse(SizeOptions, "suchus size", [*robot_words, *words[len(positional) :], *gait_words], description)
    robot = options.robot
    require("size", "hours", options.hours, 0.01, 1000.0, "h")
    for slope in options.slope:
        require("size", "slope", slope, -45.0, 45.0, "degrees")
    gaits = [gait_of(robot, word) for word in options.gaits] or [default_gait(robot)]
    motors = None if options.motors is None else blueprint.read_motors(options.motors)
    if options.out is None:
        check_name(robot.name, "robot")
    folder = options.out or Path("export") / f"{robot.name}_size"
    check_writable(folder.parent)
    check_replaceable(folder)
    load_cases = cases(
        robot,
        gaits,
        slopes=[radians(slope) for slope in options.slope],
        faults=[_fault(word, robot) for word in options.fault],
        standing=options.standing,
        water=options.water,
    )
    with working() as bars:
        sizing = size(
            robot, load_cases, motors=motors, family=options.family, progress=bars.reporter(f"sizing {robot.name}")
        )
    origin = {
        "robot": digest({"robot": robot}),
        "cases": [case.name for case in load_cases],
        "motors": "those of suchus" if motors is None else _digests(list(motors.values())),
        "versions": versions(),
    }
    with new_folder(folder) as draft:
        write_size(sizing, draft, hours=options.hours)
        (draft / MARK).write_text(json.dumps(origin, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    for sentence in answer(sizing, options.hours):
        print(sentence)
    print(f"the page with all of it: {folder / PAGE}")
    return 0


def _digests(motors: Sequence[Motor]) -> str:
    return digest({motor.name: motor for motor in motors})


def _fault(word: str, robot: Robot) -> Fault:
    """Return the fault that a word names.

    Raises:
        BadCommand: it is not of the form KIND:PART.
        UnknownName: there is no such kind, or the robot has no such part.
    """
    _, colon, joint = word.partition(":")
    if not colon or not joint:
        raise BadCommand(f"--fault {word} is no fault; say KIND:PART, as limp:LF_pitch, with {', '.join(FAULTS)}.")
    fault = from_text(word)
    fault.refuse(robot)
    return fault

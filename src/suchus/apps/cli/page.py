"""``suchus page``: a robot that walks in a browser, in one HTML file that needs no server and no network."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import takewhile
from pathlib import Path
from typing import Annotated

import tyro

from suchus.apps.cli.options import parse
from suchus.apps.cli.word_checks import check_named_once, check_page, option_values
from suchus.apps.laboratory.page import laboratory_page
from suchus.core.files import check_name, check_replaceable
from suchus.robot.design import Robot
from suchus.robot.gaits import default_gait
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS
from suchus.visual.replay import save


@dataclass(frozen=True, slots=True, kw_only=True)
class PageOptions:
    """Options of ``suchus page``."""

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that walks; the first word."""
    gait: Gait | None = None
    """Its gait at the beginning; the second word. By default the robot's own."""
    water: Annotated[float | None, tyro.conf.arg(metavar="METRES")] = None
    """Level of the water above the ground where it begins [m]; by default water for what swims alone."""
    out: Path | None = None
    """The page; by default ROBOT.html."""


def make_page(words: Sequence[str]) -> int:
    """Write the page, say where it is, and return 0.

    Raises:
        SuchusError: the words make no sense, the robot cannot follow the gait, the engine is not on this machine, or
            the place cannot be written to.
    """
    description = (
        "Make one HTML file in which a robot walks or swims in a browser, beside the same legs with the axis still. It "
        "needs no server and no network: sliders change gait, ground and water, a tap breaks a joint, and each cycle "
        "is judged."
    )
    positional = list(takewhile(lambda word: not word.startswith("-"), words[:2]))
    check_named_once(positional, ("--robot", "--gait"), words)
    named = [word for pair in zip(("--robot", "--gait"), positional, strict=False) for word in pair]
    all_words = [*named, *words[len(positional) :]]
    options = parse(PageOptions, "suchus page", all_words, description)
    check_name(options.robot.name, "robot")
    output = options.out or Path(f"{options.robot.name}.html")
    check_page(output)
    check_replaceable(output)
    gait = options.gait or default_gait(options.robot)
    robot_word = ["", *option_values(all_words, "--robot")][-1]
    save(laboratory_page(options.robot, gait, level=options.water, robot_word=robot_word), output)
    print(f"{options.robot.name}, {gait.name}: {output}, {output.stat().st_size / 1e6:.1f} MB; open it in a browser")
    return 0

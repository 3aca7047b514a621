"""``suchus import ROBOT.urdf``: a robot of another tool as a draft, with a gait to begin with."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import tyro

from suchus.apps.cli.options import parse
from suchus.apps.cli.run import floating_command_lines, run_command_lines
from suchus.apps.cli.word_checks import check_toml
from suchus.core.errors import OutsideLimits
from suchus.core.files import check_replaceable, check_writable
from suchus.robot import blueprint
from suchus.robot.design import layout
from suchus.robot.motion import Gait, draft_gait
from suchus.sim.model.importing import Draft, Words, import_robot

_METRES = Annotated[float | None, tyro.conf.arg(metavar="METRES")]


@dataclass(frozen=True, slots=True, kw_only=True)
class ImportOptions:
    """Options of ``suchus import``."""

    file: Annotated[Path, tyro.conf.Positional]
    """URDF or MJCF, a tree of hinges drawn upright and straight at zero posture."""
    out: Path | None = None
    """The robot's file; by default the file's name with .toml, in this folder. A gait is written beside it."""
    front: str | None = None
    """A body at the front end. By default guessed from names, else along the file's x axis."""
    heading: Annotated[float | None, tyro.conf.arg(metavar="DEGREES")] = None
    """Direction of the front, from the file's x axis to the left; needed if a body is as long as it is wide."""
    up: Literal["z", "y", "x", "-z", "-y", "-x"] | None = None
    """Axis of the file that points up. By default found by its gravity or its feet."""
    neck: str | None = None
    """Body in which the axis ends in front, where it forks, as into a jaw or an arm on the back."""
    tail: str | None = None
    """Body in which the axis ends behind, where it forks."""
    leave: tuple[str, ...] = ()
    """Bodies to leave out with all that is attached to them, such as arms or fins; their mass goes to their parent."""
    foot_radius: _METRES = None
    """Radius of every foot, if the shapes in the file do not give it."""
    packages: Annotated[tuple[Path, ...], tyro.conf.arg(metavar="FOLDER")] = ()
    """Folders in which the packages lie that meshes name by package://NAME/..., or these packages themselves."""
    without_meshes: bool = False
    """Take a body whose mesh is not read all the same, with a rod for its shape."""


def import_file(words: Sequence[str]) -> int:
    """Read a robot from a file of another tool, write it and a gait, say what was guessed, and return 0.

    Raises:
        SuchusError: the words make no sense, or the file is no robot that can be taken.
    """
    description = (
        "Read a robot from a URDF or an MJCF: a draft in which every guess has a comment, and a gait to begin with. "
        "Nothing in the file is executed; what it includes is read from its own folder only."
    )
    options = parse(ImportOptions, "suchus import", words, description)
    blueprint.check_robot_format(options.file, is_import=True)
    output = options.out or Path(f"{options.file.stem}.toml")
    check_toml(output, "robot")
    check_writable(output.parent)
    gait_file = output.with_name(f"{output.stem}_walk.toml")
    for file in (output, gait_file):
        check_replaceable(file)
    settings = Words(
        front=options.front,
        heading=options.heading,
        up=options.up,
        neck=options.neck,
        tail=options.tail,
        leave=options.leave,
        foot_radius=options.foot_radius,
        packages=options.packages,
        without_meshes=options.without_meshes,
    )
    draft = import_robot(options.file, name=output.stem, words=settings)
    print(*_plan(draft), *(f"note: {text}" for text in draft.remarks), sep="\n")
    gait = _gait(draft, f"{output.stem}_walk")
    head = (f"A draft that suchus read from {options.file.name}. Check it; what is guessed says so.", *draft.remarks)
    blueprint.write(draft.robot, output, notes=draft.notes, head=head)
    print(f"robot: {output}")
    if gait is not None:
        file = blueprint.write(gait, gait_file, head=("A first gait, not the best.",))
        print(f"gait: {file}", *run_command_lines(draft.robot, str(output), file), sep="\n")
    else:
        print(*floating_command_lines(str(output)), sep="\n")
    return 0


def _plan(draft: Draft) -> list[str]:
    """Return the body plan in lines."""
    robot, robot_layout = draft.robot, layout(draft.robot)
    hinges = [hinge.turn for hinge in robot.axis_hinges]
    counts = ", ".join(f"{hinges.count(turn)} {turn}" for turn in ("yaw", "pitch", "roll") if turn in hinges)
    lines = [
        f"{robot.name}: {robot.mass:.4g} kg, {robot.length:.4g} m, {len(robot_layout.hinges)} hinges, "
        f"{len(robot_layout.servos)} driven",
        f"axis: {len(robot.axis)} segment{'s' * (len(robot.axis) > 1)} from {robot.axis[0].name} to "
        f"{robot.axis[-1].name}; {counts or 'no'} hinges; root {robot.root}",
    ]
    for girdle in robot.girdles:
        turns = ", ".join(hinge.turn for hinge in girdle.limb.hinges)
        lines.append(
            f"limbs L{girdle.name}, R{girdle.name} on {girdle.segment}: {turns}; reach {girdle.limb.reach:.3g} m"
        )
    return lines


def _gait(draft: Draft, name: str) -> Gait | None:
    """Return a first gait for the draft; None, with a printed note, where its joints allow none."""
    try:
        return draft_gait(draft.robot, name)
    except OutsideLimits as error:
        print(f"note: {error}")
        return None

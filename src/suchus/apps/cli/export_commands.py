"""``suchus export-commands GAIT``: a gait as servo angles and pulses, checked against what the servos can do."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated

import tyro

from suchus.apps.cli.options import gait_first, parse
from suchus.apps.cli.terminal import working
from suchus.core.checks import require
from suchus.core.errors import OutsideLimits
from suchus.core.files import check_name, check_replaceable, check_writable, digest, new_folder, versions
from suchus.core.progress import staged
from suchus.hardware import (
    ServoLoad,
    cases,
    check_commands,
    check_loads,
    commands,
    csv_text,
    loads_of_cases,
    overloaded,
    read_map,
    straight,
    trajectory_text,
    with_better,
    write_map,
)
from suchus.hardware.limits import TRACKING
from suchus.hardware.loads import AT_LIMIT
from suchus.robot import blueprint
from suchus.robot.design import Robot
from suchus.robot.gaits import GAITS, default_gait, suits
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS

MARK = "suchus_commands.json"


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportCommandsOptions:
    """Options of ``suchus export-commands``."""

    gait: Annotated[Gait, tyro.conf.Positional] = field(default_factory=lambda: GAITS["belly_crawl"])
    """The gait; by default, if the robot cannot follow this one, the robot's own."""
    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """Robot whose joints and servos are commanded."""
    map: Path | None = None
    """Servo map; by default 270 degree servos mounted in the middle, channels in order."""
    write_map: Path | None = None
    """Only write the default map to this TOML file, as a start for your own."""
    cycles: int = 1
    """Number of cycles; one can be repeated, since its last sample equals its first."""
    at_limit: float = AT_LIMIT
    """Fraction of the walk at the torque limit beyond which a servo counts as overloaded [-]."""
    tracking: float = TRACKING
    """Greatest error of an overloaded servo against its commanded angle [rad]; beyond it the gait is refused."""
    out: Path | None = None
    """The folder; by default export/GAIT_commands. An older one there is replaced, anything else is refused."""


def export_commands(words: Sequence[str]) -> int:
    """Write the commands, say what the servos bear, and return 0.

    Raises:
        SuchusError: the words make no sense, the servos cannot do it, or the place cannot be written to.
    """
    description = "Write a gait as timed servo angles: CSV with pulses, and a ROS trajectory_msgs/JointTrajectory."
    options = parse(ExportCommandsOptions, "suchus export-commands", gait_first(words), description)
    if (
        options.gait == ExportCommandsOptions().gait
        and options.gait.name not in words
        and not suits(options.robot, options.gait)
    ):
        options = replace(options, gait=default_gait(options.robot))
    if options.write_map is not None:
        print(f"servo map: {write_map(straight(options.robot), options.write_map)}")
        return 0
    require("export-commands", "at_limit", options.at_limit, 0.0, 1.0, "")
    require("export-commands", "tracking", options.tracking, 0.0, 7.0, "rad")
    if options.out is None:
        check_name(options.gait.name, "gait")
    folder = options.out or Path("export") / f"{options.gait.name}_commands"
    check_writable(folder.parent)
    check_replaceable(folder)
    servo_map = straight(options.robot) if options.map is None else read_map(options.map, options.robot)
    samples = commands(options.robot, options.gait, servo_map, options.cycles)
    with working() as bars:
        move = bars.task(options.gait.name)
        load_cases = cases(options.robot, (options.gait,))
        (loads,) = loads_of_cases(options.robot, load_cases, progress=staged(move, "walking", 0.0, 0.7))
        loads = with_better(options.robot, load_cases[0], loads)
        move("walking", 1.0)
    try:
        check_commands(options.robot, options.gait, servo_map, samples)
        check_loads(options.robot, options.gait, loads, options.at_limit, options.tracking)
    except OutsideLimits as error:
        with new_folder(folder) as draft:
            _write_loads(options, loads, draft)
        raise OutsideLimits(f"{error} What each servo bears stands in {folder / 'loads.csv'}.") from error
    with new_folder(folder) as draft:
        _write_loads(options, loads, draft)
        (draft / "commands.csv").write_text(csv_text(samples), encoding="utf-8")
        (draft / "trajectory.yaml").write_text(trajectory_text(options.robot, samples), encoding="utf-8")
        write_map(servo_map, draft / "servo_map.toml")
        (draft / "gait.toml").write_text(blueprint.render(options.gait), encoding="utf-8")
    hardest = max(loads, key=lambda name: loads[name].torque / loads[name].limit)
    load = loads[hardest]
    print(f"{len(samples.time)} samples over {samples.time[-1]:g} s: {folder}")
    print(
        f"highest-loaded in simulation: {hardest}, {load.torque:.2f} of {load.limit:g} N m, "
        f"at the limit for {100 * load.at_limit:.1f} % of the walk"
    )
    for sentence in overloaded(loads, options.at_limit):
        print(f"warning: {sentence}")
    return 0


def _write_loads(options: ExportCommandsOptions, loads: Mapping[str, ServoLoad], draft: Path) -> None:
    """Write the loads of the servos, and the digests of robot and gait."""
    origin = {"gait": digest({"gait": options.gait}), "robot": digest({"robot": options.robot}), "versions": versions()}
    (draft / "loads.csv").write_text(_loads_text(loads, options.at_limit), encoding="utf-8")
    (draft / MARK).write_text(json.dumps(origin, indent=1, sort_keys=True) + "\n", encoding="utf-8")


def _loads_text(loads: Mapping[str, ServoLoad], at_limit: float) -> str:
    """Return the loads as CSV, one row for each servo; torques in N m, times in s, angles in rad."""
    lines = ["servo,peak_torque_Nm,torque_limit_Nm,share_at_limit,first_at_s,off_rad,needed_Nm,would_do"]
    for name, load in loads.items():
        first_time = "" if load.first != load.first else f"{load.first:.2f}"
        cells = f"{load.torque:.4f},{load.limit:g},{load.at_limit:.4f},{first_time},{load.off:.4f},{load.needed:.4f}"
        lines.append(f"{name},{cells},{load.other if load.at_limit > at_limit else ''}")
    return "\n".join(lines) + "\n"

"""``suchus calibrate wiring | zero | log``: what a robot that was built says of itself, into new files."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
import tyro
from rich.console import Console
from rich.table import Table

from suchus.apps.cli.entry import BadCommand
from suchus.apps.cli.options import parse
from suchus.core.files import check_replaceable, check_writable, load, new_folder, write
from suchus.hardware import BusClock, Rig, WallClock, read_wiring, write_wiring
from suchus.hardware.bus import BusPlace, Wiring, straight
from suchus.hardware.calibrate import FitEstimate, find_wiring, find_zeros, fit_log, fits_text
from suchus.hardware.identification import bam_parameters, identification_table, identify_servos, identify_walking
from suchus.hardware.protocols import servo_table
from suchus.robot.design import Robot, layout
from suchus.robot.gaits import gait_of
from suchus.robot.motion import intended
from suchus.robot.robots import ROBOTS


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibrateOptions:
    """Options of ``suchus calibrate``."""

    what: Annotated[Literal["wiring", "zero", "log"], tyro.conf.Positional]
    """wiring: each servo moves alone by 5 degrees, and you say what moved; zero: hold the robot in a posture, and where
    the servos are then is that posture; log: stiffness, play and friction by a log of suchus drive."""
    record: Annotated[Path | None, tyro.conf.Positional] = None
    """The record.nc of a drive, for log."""
    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot."""
    hardware: Path = Path("hardware.toml")
    """Where its servos hang, as far as is known; for wiring it may be missing if --port is given."""
    port: str | None = None
    """Port of its only bus."""
    model: str = "XM430-W350"
    """Model of its servos, where there is no file."""
    baud: int = 1_000_000
    """Bit rate of the bus, where there is no file [1/s]."""
    posture: str | None = None
    """Gait in whose first posture the robot is held, for zero; all joints at zero if it is left out."""
    clock: Literal["wall", "bus"] = "wall"
    """wall: this computer's time; bus: an emulator is told the time."""
    held: tyro.conf.FlagCreatePairsOff[bool] = False
    """The log is of a robot whose trunk was held in the air: inertia, friction, torque constant, delay and play follow
    from the masses of its file, for log."""
    walked: tyro.conf.FlagCreatePairsOff[bool] = False
    """The log is of a robot that walked on its feet in a quick gait: inertia, delay and play of the servos of its limbs
    follow from the swings of its feet and the makers' torque constants, for log."""
    json: Path | None = None
    """New folder for one JSON file a servo, as the project Better Actuator Models reads it; with --held."""
    out: Path | None = None
    """The new file; by default hardware_wired.toml, hardware_zeroed.toml, servos_measured.csv, or with --held or
    --walked servos_identified.csv."""


_IDENTIFIED = "servos_identified.csv"
_NEW = {"wiring": "hardware_wired.toml", "zero": "hardware_zeroed.toml", "log": "servos_measured.csv"}


def calibrate(words: Sequence[str]) -> int:
    """Calibrate, write the new file, say what is in it, and return 0.

    Raises:
        SuchusError: the words or a file make no sense, or the place is taken.
        BusFailure: a servo does not answer.
    """
    description = (
        "Find out how a robot is wired, where its zeros are and how stiff its servos are; files are never changed."
    )
    options = parse(CalibrateOptions, "suchus calibrate", words, description)
    is_identified = options.held or options.walked
    if (is_identified or options.json is not None) and options.what != "log":
        raise BadCommand(
            f"--held, --walked and --json are for suchus calibrate log; leave them out of calibrate {options.what}."
        )
    if options.held and options.walked:
        raise BadCommand(
            "--held and --walked contradict each other: a robot in the air does not walk; say one of them."
        )
    if options.json is not None and not options.held:
        raise BadCommand("--json needs what only a robot in the air shows: say --held if its trunk was held.")
    output = options.out or Path(_IDENTIFIED if is_identified else _NEW[options.what])
    check_writable(output.parent)
    check_replaceable(output)
    if options.json is not None:
        check_writable(options.json.parent)
        check_replaceable(options.json)
    if options.what == "log":
        return _identify_log(options, output) if is_identified else _fit_log(options, output)
    rig = Rig(options.robot, _initial_wiring(options), has_clock=options.clock == "bus")
    try:
        if options.what == "wiring":
            clock = BusClock(rig) if options.clock == "bus" else WallClock(rig.period)
            write_wiring(find_wiring(rig, clock, lambda bus, number: _ask_joint(options.robot, bus, number)), output)
        else:
            posture = np.zeros(len(rig.servos))
            if options.posture is not None:
                posture = intended(options.robot, gait_of(options.robot, options.posture), np.zeros(1)).targets[0]
            wiring, offsets = find_zeros(rig, posture)
            for name, angle in zip(rig.names, np.degrees(offsets), strict=True):
                print(f"{name}: its zero moves by {angle:.1f} degrees")
            write_wiring(wiring, output)
    finally:
        rig.close()
    print(f"written: {output}; try it with suchus drive --hardware {output} --dry-run")
    return 0


def _initial_wiring(options: CalibrateOptions) -> Wiring:
    """Return the wiring as far as it is known."""
    if options.hardware.exists():
        wiring = read_wiring(options.hardware, options.robot)
        if options.port is not None:
            wiring = replace(wiring, bus=(replace(wiring.bus[0], port=options.port),))
        return wiring
    if options.port is None:
        raise BadCommand(f"there is no {options.hardware}: say --port PORT and --model MODEL of the servos instead.")
    bus = BusPlace(port=options.port, baud=options.baud, protocol=servo_table(options.model).protocol)
    return straight(options.robot, [bus], options.model)


def _ask_joint(robot: Robot, bus: int, number: int) -> tuple[str, int]:
    """Ask a person which joint moved, until the answer names one, and return the joint and the sign of its motion.

    Args:
        robot: robot whose servos are calibrated.
        bus: index of the servo's bus.
        number: id of the servo on its bus.
    """
    names = layout(robot).servos
    print(f"Number {number} on bus {bus} has turned by 5 degrees to more steps. Which joint moved, and in its positive")
    print(f"sense (+) or the other (-)? One of {', '.join(names)}, as {names[0]} +")
    while True:
        print("> ", end="", flush=True)
        line = sys.stdin.readline()
        if not line:
            raise BadCommand("the answers ended before all servos had moved; nothing is written.")
        words = line.split()
        if len(words) == 2 and words[0] in names and words[1] in ("+", "-"):
            return words[0], 1 if words[1] == "+" else -1
        print("Say the joint and + or -.")


def _fit_log(options: CalibrateOptions, output: Path) -> int:
    """Fit stiffness, play, friction and zero of every servo to a log, print them, write them, and return 0."""
    if options.record is None:
        raise BadCommand("suchus calibrate log needs the record.nc of a drive, as out/drive_belly_crawl/record.nc.")
    record = load(options.record)
    fits = fit_log(record.isel(run=0) if "run" in record.dims else record)
    table = Table("servo", "stiffness [N m/rad]", "play [degrees]", "friction [N m]", "zero off [degrees]", box=None)
    for name, fit in fits.items():
        degrees = (
            f"{np.degrees(estimate.value):.2f} +- {np.degrees(estimate.half):.2f}"
            for estimate in (fit.play, fit.offset)
        )
        play, offset = degrees
        table.add_row(name, str(fit.stiffness), play, str(fit.friction), offset)
    Console(highlight=False).print(table)
    measured_file = write(output, fits_text(fits))
    print(f"written: {measured_file}; intervals hold 95 % of what scatters, not what the model leaves out")
    return 0


def _identify_log(options: CalibrateOptions, output: Path) -> int:
    """Identify the servos of a robot that was held in the air or walked, print and write them, and return 0."""
    if options.record is None:
        raise BadCommand("suchus calibrate log needs the record.nc of a drive, as out/drive_belly_crawl/record.nc.")
    record = load(options.record)
    models = {}
    if options.hardware.exists():
        wiring = read_wiring(options.hardware, options.robot)
        models = {servo.name: servo.model for servo in wiring.servo}
    record = record.isel(run=0) if "run" in record.dims else record
    if options.walked:
        models = models or dict.fromkeys(layout(options.robot).servos, options.model)
        identified, refusals = identify_walking(record, options.robot, models)
    else:
        identified, refusals = identify_servos(record, options.robot, models or None)
    columns = (
        ("torque_constant", "torque constant [N m/A]", 1.0), ("armature", "inertia [g m2]", 1e3),
        ("friction", "Coulomb [mN m]", 1e3), ("damping", "viscous [mN m s/rad]", 1e3), ("delay", "delay [ms]", 1e3),
        ("play", "play [degrees]", float(np.degrees(1.0))),
    )  # fmt: skip
    table = Table("servo", *(label for _, label, _ in columns), box=None)
    for name, servo in identified.items():
        table.add_row(name, *(_scaled(getattr(servo, field), scale) for field, _, scale in columns))
    Console(highlight=False).print(table)
    for name, refusal in refusals.items():
        print(f"{name} is left out: {refusal}")
    written = write(output, identification_table(identified))
    if options.json is not None:
        with new_folder(options.json) as draft:
            for name, servo in identified.items():
                text = bam_parameters(servo, models.get(name, options.robot.name))
                (draft / f"{name}.json").write_text(text, encoding="utf-8")
    if options.walked:
        print(
            "inertia is counted with the makers' torque constants; torque constant and friction show in the air: "
            "suchus calibrate log --held"
        )
    print(f"written: {written}; intervals hold 95 %")
    return 0


def _scaled(estimate: FitEstimate, scale: float) -> str:
    """Return an estimate in another unit; a dash for one that the log does not show."""
    if not np.isfinite(estimate.value):
        return "-"
    return str(FitEstimate(value=scale * estimate.value, half=scale * estimate.half))

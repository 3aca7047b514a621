"""``suchus drive GAIT``: a robot of servos moves in a gait, by rules, or swims; its log is a record."""

import select
import shlex
import shutil
import sys
import termios
import time
import tty
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, suppress
from dataclasses import dataclass, field, replace
from itertools import chain, count, pairwise
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import tyro
import xarray as xr
from rich.console import Console

from suchus.apps.cli.entry import BadCommand
from suchus.apps.cli.options import gait_first, parse
from suchus.apps.cli.terminal import working
from suchus.apps.report import PAGE, check_place, save_outcome
from suchus.apps.report.result import RECORD
from suchus.core.errors import BusFailure, UnknownName
from suchus.core.files import check_writable, new_folder, path_exists, save
from suchus.core.stopping import StopSignal, finishing
from suchus.experiments.catalog._driven import Driven
from suchus.hardware import (
    BlindRig,
    BusClock,
    DriveSettings,
    Rig,
    WallClock,
    check_drive,
    drive,
    read_map,
    read_wiring,
    walked_distance,
)
from suchus.hardware.bus import BusProtocol, Instruction, Packet, Port, Wiring
from suchus.hardware.emulator import EmulatedBody, Emulator, MemoryPort
from suchus.hardware.protocols import bus_protocol, channel_protocol
from suchus.robot.control import (
    Control,
    Coordinated,
    HeadingRule,
    Learned,
    OpenLoop,
    PatternGenerator,
    Standing,
    Swimming,
    needs,
)
from suchus.robot.design import Robot
from suchus.robot.gaits import default_gait, gait_of, suits
from suchus.robot.motion import START, Gait
from suchus.robot.policies import policy_of
from suchus.robot.robots import ROBOTS
from suchus.swimming.water import swim_of
from suchus.visual.figures import styled

SWIM = "swim"
"""Gait that is the robot's own wave, as in suchus view --lake."""
_SHUTDOWN_TIME = 60.0  # [s]; for letting a robot down and writing its log, on a computer that is told to stop
_MAX_PRINTED_TICKS = 3  # ticks whose packets a dry run prints
_STANDING_TIME = 4.0  # [s]; how long a robot stands up


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveOptions:
    """Options of ``suchus drive``."""

    gait: Annotated[str, tyro.conf.Positional] = ""
    """The gait, a name that suchus list shows or a TOML file; swim for the robot's own wave; its own gait if none."""
    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that is driven."""
    hardware: Path = Path("hardware.toml")
    """Which servo hangs where, as suchus calibrate or suchus emulate write it."""
    map: Path | None = None
    """Servo map of hobby servos on boards that give pulses, as PCA9685, in the place of --hardware; the servos tell
    nothing, and --port names the boards' bus."""
    port: str | None = None
    """Port of its only bus, in the place of the file's; /dev/i2c-1 for --map."""
    clock: Literal["wall", "bus"] = "wall"
    """wall: this computer's time; bus: an emulator is told the time, and nothing is ever late."""
    control: Literal["open", "closed", "steered", "pattern", "stand", "swim"] = "open"
    """What decides: the gait alone, the three feedback rules, these and the heading loop, coupled oscillators, standing
    up and sitting down again, or a swim."""
    policy: str | None = None
    """A trained policy, its name or its file, in the place of gait and control."""
    forward: float | None = None
    """Commanded forward speed of the policy [m/s]; half of its greatest one by default."""
    turn: float = 0.0
    """Commanded turning rate of the policy, left positive [rad/s]."""
    seconds: float = 30.0
    """How long, the first second of standing included [s]."""
    rate: float | None = None
    """Ticks in a second [Hz]; by default what suits a robot of its size, 100 for one of 1 m."""
    stop: Literal["sag", "hold", "off"] = "sag"
    """How it ends: let down with a fifth of its torque and switched off, left standing, or switched off at once."""
    without: tuple[str, ...] = ()
    """Servos that are not there: it goes on with them limp."""
    dry_run: tyro.conf.FlagCreatePairsOff[bool] = False
    """Open no port: show what would be sent, and drive an emulated robot instead."""
    out: Path | None = None
    """Folder of the log, its figures and its page; by default out/drive_GAIT."""


def run(words: Sequence[str]) -> int:
    """Drive until the time is over, a key is pressed or something is wrong, and return 0.

    Raises:
        SuchusError: the words or a file make no sense, or the robot cannot do it; nothing has moved.
        BusFailure: servos cannot be reached, or the robot had to be stopped; the log is kept.
    """
    description = (
        "Drive a robot of servos. Any key stops it, as Ctrl-C and the end of the terminal do; then it is let down."
    )
    options = parse(DriveOptions, "suchus drive", gait_first(words), description)
    gait, control = _movement(options)
    folder = options.out or Path("out") / f"drive_{gait.name}"
    check_writable(folder.parent)
    check_place(folder)
    if options.map is not None:
        return _drive(options, gait, control, folder, words, lambda: _open_blind_rig(options))
    wiring = read_wiring(options.hardware, options.robot)
    if options.port is not None:
        if len(wiring.bus) != 1:
            raise BadCommand(
                f"--port names one port, and {options.hardware} has {len(wiring.bus)} buses: name them there."
            )
        wiring = replace(wiring, bus=(replace(wiring.bus[0], port=options.port),))
    return _drive(options, gait, control, folder, words, lambda: _open_rig(options, wiring, gait, control))


def _drive(
    options: DriveOptions,
    gait: Gait,
    control: Control,
    folder: Path,
    words: Sequence[str],
    open_rig: Callable[[], AbstractContextManager[tuple[Rig | BlindRig, Any]]],
) -> int:
    """Drive a robot, save its log, and return 0.

    Args:
        options: options of the command.
        gait: the gait.
        control: the controller.
        folder: folder of the log.
        words: words of the command line, for the log.
        open_rig: opens the robot and returns it with its clock.
    """
    settings = DriveSettings(duration=options.seconds, stop=options.stop)
    start = time.perf_counter()
    print(_opening(options, gait, words), flush=True)
    experiment = Driven(robot=options.robot, gait=gait, control=options.control, stop=options.stop)
    log = _SavedLog(folder)
    with finishing(_SHUTDOWN_TIME), open_rig() as (rig, clock):
        check_drive(rig, gait, control)
        try:
            with _watch_keys() as stop_reason, working() as bars:
                record = drive(
                    rig,
                    gait,
                    control,
                    settings,
                    clock=clock,
                    stop_request=stop_reason,
                    say=bars.say,
                    progress=bars.task(gait.name),
                    save_log=log.save,
                )
        except StopSignal:
            log.announce()
            raise
        except (BusFailure, KeyboardInterrupt) as error:
            _report(experiment, getattr(error, "record", None), log, words, time.perf_counter() - start)
            raise
        except BaseException:
            log.announce()
            raise
    _report(experiment, record, log, words, time.perf_counter() - start)
    return 0


def _opening(options: DriveOptions, gait: Gait, words: Sequence[str]) -> str:
    """Return the first line of a drive: what is driven, and what to start if nobody answers.

    Args:
        options: of the command.
        gait: the gait.
        words: words of the command line, which name the robot or its file.
    """
    robot = options.robot.name
    if options.dry_run:
        return f"dry run of {robot} in {gait.name}: no port is opened."
    if options.map is not None:
        return (
            f"driving {robot} in {gait.name} by the pulses of {options.map}. These servos answer nothing: if none "
            "moves, look at their supply."
        )
    given = dict(pairwise([word for pair in words for word in pair.split("=", 1)]))
    emulate = ["suchus", "emulate", given.get("--robot", robot), "--hardware", str(options.hardware)]
    emulate += ["--clock", "bus"] if options.clock == "bus" else []
    return (
        f"driving {robot} in {gait.name} over {options.hardware}. If nobody answers: switch the servos on, or start "
        f"`{shlex.join(emulate)}` in another terminal."
    )


@contextmanager
def _open_blind_rig(options: DriveOptions) -> Iterator[tuple[BlindRig, Any]]:
    """Yield a robot of hobby servos and its clock; a dry run prints what would be written."""
    assert options.map is not None
    if options.clock == "bus":
        raise BadCommand("hobby servos have no bus whose emulator could be told the time: leave out --clock bus.")
    servo_map = read_map(options.map, options.robot)
    protocol = channel_protocol(servo_map.protocol)
    boards = sorted({line.board for line in servo_map.servos})
    pulses = (
        protocol.open_printing(print, boards, servo_map.rate)
        if options.dry_run
        else protocol.open(options.port or protocol.default_port, boards, servo_map.rate)
    )
    rig = BlindRig(options.robot, servo_map, pulses)
    try:
        yield rig, WallClock(rig.period)
    finally:
        rig.close()


def _movement(options: DriveOptions) -> tuple[Gait, Control]:
    """Return the gait and the controller that the options name."""
    robot = options.robot
    if options.policy is not None:
        if options.gait or options.control != "open":
            raise BadCommand("--policy brings its own gait and decides alone: leave out the gait and --control.")
        policy = policy_of(robot, options.policy)
        return policy.gait, Learned(policy=policy, forward=options.forward, turn=options.turn)
    if options.gait == SWIM or (options.control == "swim" and not options.gait):
        gait, kind = swim_of(robot), "swim"
    else:
        try:
            gait = gait_of(robot, options.gait or None)
        except UnknownName as error:
            raise BadCommand(f"{error} {SWIM} and a path to a TOML file will do as well.") from error
        kind = options.control
        if not options.gait and not suits(robot, gait):
            gait = default_gait(robot)
    closed = Coordinated().suited(robot, gait)
    controls: dict[str, Callable[[], Control]] = {
        "open": OpenLoop,
        "closed": lambda: closed,
        "steered": lambda: replace(closed, heading=HeadingRule()),
        "pattern": PatternGenerator,
        "stand": lambda: Standing(at=START + gait.period, hold=_STANDING_TIME),
        "swim": Swimming,
    }
    return gait, controls[kind]()


@contextmanager
def _open_rig(options: DriveOptions, wiring: Wiring, gait: Gait, control: Control) -> Iterator[tuple[Rig, Any]]:
    """Yield the opened robot and its clock; a dry run emulates the robot in this process.

    Args:
        options: options of the command.
        wiring: buses and servos of the robot.
        gait: gait in whose first posture an emulated robot starts.
        control: the controller, which says which readings it needs.
    """
    ports: list[Port] = []
    is_clocked = options.clock == "bus" or options.dry_run
    if options.dry_run:
        emulator = Emulator(wiring, EmulatedBody(options.robot, gait), has_clock=True)
        ports = [
            PrintingPort(MemoryPort(emulator, number), bus_protocol(bus.protocol), wiring)
            for number, bus in enumerate(wiring.bus)
        ]
    rig = Rig(
        options.robot, wiring, ports, has_clock=is_clocked, limp_servos=options.without,
        rate=None if options.dry_run else options.rate, required_senses=needs(control),
    )  # fmt: skip
    try:
        yield rig, BusClock(rig) if is_clocked else WallClock(rig.period)
    finally:
        rig.close()


class _SavedLog:
    """The log of a drive on the disk, from the moment at which the robot stands.

    Args:
        folder: of the drive; where something is there already, a folder beside it takes the log until its page is made.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._draft: Path | None = None

    def save(self, record: xr.Dataset) -> None:
        """Save the log in a folder that suchus signs; an earlier log is not overwritten."""
        if record.sizes["time"] < 1:
            return
        alternatives = (self.folder.with_name(f"{self.folder.name}_stopped{number}") for number in count(1))
        free_folder = next(place for place in chain([self.folder], alternatives) if not path_exists(place))
        with new_folder(free_folder, lasting=True) as draft:
            save(record, draft / RECORD)
        self._draft = free_folder

    def announce(self) -> None:
        """Print where the log is, if one was saved."""
        if self._draft is not None:
            with suppress(OSError):  # the terminal may be closed
                print(f"the log: {self._draft / RECORD}", flush=True)

    def discard_draft(self) -> None:
        """Remove the log beside the folder, once the folder itself holds it."""
        if self._draft is not None and self._draft != self.folder:
            shutil.rmtree(self._draft, ignore_errors=True)


def _report(
    experiment: Driven, record: xr.Dataset | None, log: _SavedLog, words: Sequence[str], seconds: float
) -> None:
    """Draw a saved log, write its page, and print the result, its cause and a summary.

    Args:
        experiment: the question that the log answers.
        record: the log; None or empty: nothing is written.
        log: where it is saved.
        words: words of the command line.
        seconds: duration of the drive [s].
    """
    if record is None or record.sizes["time"] < 1:
        return
    try:
        outcome = experiment.tell(record, seconds)
        with styled():
            figures = experiment.draw(outcome)
        save_outcome(outcome, figures, experiment, log.folder, command=shlex.join(["suchus", "drive", *words]))
    except BaseException:
        log.announce()
        raise
    log.discard_draft()
    console = Console(highlight=False)
    console.print(outcome.decides, markup=False)
    cause = str(record.cause.item())
    if cause:
        console.print(cause, markup=False)
    print(f"the log, its figures and its replay: {log.folder / PAGE}")
    print(_summary(record, experiment))


def _summary(record: xr.Dataset, experiment: Driven) -> str:
    """Return the last line of a drive: the distance, how well servos followed, and which one got warmest."""
    is_measured = bool(np.isfinite(record.position.values).all(axis=-1).sum() > 1)
    is_walk = is_measured or (experiment.gait.limb_phases and experiment.control != SWIM)
    distance = walked_distance(record, experiment.robot) if is_walk else float("nan")
    if not np.isfinite(distance):
        parts = ["nothing measured how far it went"]
    elif is_measured:
        parts = [f"it went {distance:.2f} m"]
    else:
        parts = [f"by its legs it walked about {distance:.2f} m, if no foot slipped"]
    errors = np.degrees(np.sqrt(((record.servo_angle - record.servo_asked) ** 2).mean("time"))).values
    if np.isfinite(errors).any():
        worst = int(np.nanargmax(errors))
        mean_error = float(np.sqrt(np.nanmean(errors**2)))
        parts.append(
            f"servos followed to {mean_error:.1f} degrees (root mean square), {record.servo.values[worst]} worst with "
            f"{errors[worst]:.1f}"
        )
    temperatures = record.servo_temperature.values
    if np.isfinite(temperatures).any():
        hottest = np.nanmax(np.where(np.isfinite(temperatures), temperatures, -np.inf), axis=0)
        first = next(row for row in temperatures if np.isfinite(row).any())
        warmest = int(np.argmax(hottest))
        start = float(first[warmest]) if np.isfinite(first[warmest]) else float(np.nanmin(first))
        parts.append(
            f"{record.servo.values[warmest]} got warmest, {hottest[warmest]:.0f} degrees Celsius (from {start:.0f})"
        )
    return "; ".join(parts) + "."


@contextmanager
def _watch_keys() -> Iterator[Callable[[], str]]:
    """Yield a function that returns why to stop, such as a pressed key; restore the terminal at the end."""
    terminal_settings = None
    with suppress(termios.error, OSError, ValueError, AttributeError):  # no terminal, or one that cannot be set
        if sys.stdin.isatty():
            terminal_settings = termios.tcgetattr(sys.stdin)
            tty.setcbreak(sys.stdin)

    def stop_reason() -> str:
        """Return why the robot must stop: a key or a closed terminal; empty while neither happened."""
        if terminal_settings is None:
            return ""
        try:
            ready, _, _ = select.select((sys.stdin,), (), (), 0.0)
            return ("a key." if sys.stdin.read(1) else "the terminal was closed.") if ready else ""
        except (OSError, ValueError):
            return "the terminal was closed."

    try:
        yield stop_reason
    finally:
        if terminal_settings is not None:
            with suppress(termios.error, OSError, ValueError):
                termios.tcsetattr(sys.stdin, termios.TCSADRAIN, terminal_settings)


class PrintingPort:
    """A port that prints the packets sent over it during the first ticks.

    Args:
        port: carries the packets.
        protocol: what is spoken.
        wiring: gives the names of the servos.
    """

    def __init__(self, port: Port, protocol: BusProtocol, wiring: Wiring) -> None:
        self.name = port.name
        self._port, self._decoder, self._printed_ticks = port, protocol.requests(), 0
        self._word = protocol.word
        self._names = {servo.id: servo.name for servo in wiring.servo}
        self._tables = {servo.id: servo.table for servo in wiring.servo}

    def send(self, data: bytes, timeout: float) -> None:
        """Send bytes, and print the packets in them."""
        for packet in self._decoder.feed(data):
            self._tell(packet, data)
        self._port.send(data, timeout)

    def receive(self, timeout: float) -> bytes:
        """Return what has arrived."""
        return self._port.receive(timeout)

    def close(self) -> None:
        """Close the port."""
        self._port.close()

    def _tell(self, packet: Packet, data: bytes) -> None:
        """Print a packet that reads or writes all servos at once, with the servos' names and the bytes on the wire."""
        if packet.code not in (Instruction.SYNC_READ, Instruction.SYNC_WRITE):
            return
        word, payload = self._word, packet.data
        address = int.from_bytes(payload[:word], "little")
        length = int.from_bytes(payload[word : 2 * word], "little")
        table = next(iter(self._tables.values()))
        register = next((entry.name for entry in table.registers if entry.address == address), str(address))
        if register == "goal_position":
            self._printed_ticks += 1
        if self._printed_ticks > _MAX_PRINTED_TICKS:
            return
        kind = "write" if packet.code == Instruction.SYNC_WRITE else "read"
        step = length + 1 if kind == "write" else 1
        servo_names = [self._names.get(payload[i], str(payload[i])) for i in range(2 * word, len(payload), step)]
        print(f"{kind} {register}, {len(servo_names)} of {', '.join(servo_names[:3])} ...\n  {data.hex(' ')}")

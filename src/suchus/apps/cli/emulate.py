"""``suchus emulate ROBOT``: its servos on buses that other programs open, with the simulated robot behind them."""

from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from math import radians
from pathlib import Path
from typing import Annotated, Any, Literal

import tyro

from suchus.apps.cli.entry import BadCommand
from suchus.apps.cli.options import parse
from suchus.apps.cli.view import pages_of_viewer
from suchus.core.checks import require
from suchus.core.files import check_replaceable, check_writable, write
from suchus.core.files.store import packed
from suchus.hardware import read_wiring, write_wiring
from suchus.hardware.bus import BusPlace, Wiring, own_models, straight
from suchus.hardware.emulator import EmulatedBody, Emulator, Server, Trouble
from suchus.hardware.protocols import bus_protocol, servo_table
from suchus.robot.design import Robot, layout
from suchus.robot.gaits import default_gait
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.faults import FAULTS, from_text
from suchus.sim.land import Ground, Lake

_PLACE = Path("hardware.toml")
_MAX_DURATION = 1e6  # [s]
_DEFAULT_PROTOCOL = "dynamixel"  # of a robot whose file names no servos that a bus speaks with


@dataclass(frozen=True, slots=True, kw_only=True)
class EmulateOptions:
    """Options of ``suchus emulate``."""

    robot: Annotated[Robot, tyro.conf.Positional] = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that is emulated."""
    hardware: Path = _PLACE
    """Which servo hangs where, with the paths of the ports; written for this robot where there is no such file."""
    protocol: str | None = None
    """What servos speak, where the file is written: dynamixel, feetech, line (hobby servos behind a board of your
    own), or a protocol of your own; suchus list shows them. By default the servos that the robot's file names, on the
    buses that they speak."""
    clock: Literal["wall", "bus"] = "wall"
    """wall: time passes by itself; bus: the robot moves when it is told to, by suchus drive --clock bus."""
    gait: Gait | None = None
    """Gait in whose first posture the robot begins; by default its own."""
    lake: float | None = None
    """Level of the water around it [m]; dry land if it is left out."""
    held: tyro.conf.FlagCreatePairsOff[bool] = False
    """Hold its trunk in the air, level, as a builder does who identifies the servos by suchus calibrate log --held."""
    slope: float = 0.0
    """Slope of the ground, uphill positive [degrees]."""
    socket: tyro.conf.FlagCreatePairsOff[bool] = False
    """Listen on a socket of this computer in the place of a pseudo-terminal."""
    trouble: Annotated[Trouble, tyro.conf.arg(name="")] = field(default_factory=Trouble)
    """What goes wrong on the wire and in servos."""
    fault: tuple[str, ...] = ()
    """What breaks in the servos, as limp:LF_yaw or weak:RH_pitch,fraction=0.3,rate=1,length=0.2: a fault that suchus
    list shows, its part, and fields."""
    seconds: float | None = None
    """How long to serve [s]; until Ctrl-C if it is left out."""
    view: tyro.conf.FlagCreatePairsOff[bool] = False
    """Show the robot in the browser (extra: viewer)."""
    port: int = 8080
    """Port of the page in the browser; 0 for any that is free."""
    out: Path | None = None
    """Where to keep what truly happened, a record that suchus view and suchus replay show; nothing by default."""


def emulate(words: Sequence[str]) -> int:
    """Serve until interrupted, and return 0.

    Raises:
        SuchusError: the words or a file make no sense, or the ports cannot be made.
    """
    description = (
        "Emulate a robot's servos on a bus: what drives them cannot tell them from real ones, and nothing can break."
    )
    options = parse(EmulateOptions, "suchus emulate", _robot_first(words), description)
    if options.seconds is not None:
        require("emulate", "seconds", options.seconds, 0.0, _MAX_DURATION, "s")
    if options.out is not None:
        check_writable(options.out.parent)
        check_replaceable(options.out)
    trouble = options.trouble
    is_clocked = options.clock == "bus"
    body = EmulatedBody(
        options.robot,
        options.gait or default_gait(options.robot),
        ground=Ground(uphill=radians(options.slope)),
        lake=None if options.lake is None else Lake(level=options.lake),
        faults=[_fault(text, trouble.at) for text in options.fault],
        latency=trouble.latency if is_clocked else 0.0,
        held=options.held,
    )
    wiring, links = _wiring_and_links(options)
    emulator = Emulator(wiring, body, trouble, has_clock=is_clocked, say=_say)
    server = Server(emulator, links, sockets=options.socket, say=_say)
    viewer: Any = None
    after_step: Callable[[], None] = _do_nothing
    try:
        if options.socket or not links:
            wiring = _with_ports(wiring, server.ports)
        if not options.hardware.exists():
            write_wiring(_with_ports(wiring, server.ports), options.hardware)
        print(
            f"{', '.join(server.ports)}: the servos of {options.robot.name}, {_models_text(wiring)}, wired as "
            f"{options.hardware} says",
            flush=True,
        )
        if trouble.latency and is_clocked and abs(body.latency - trouble.latency) > 1e-9:
            print(f"goals are {1e3 * body.latency:g} ms on their way, whole steps of the physics", flush=True)
        if options.view:
            viewer = _watching_page(options, server, body)
            after_step = viewer.send_state
            print(f"open {viewer.url} in a browser; Ctrl-C ends it.", flush=True)
        end = body.tick + round(options.seconds / body.period) if options.seconds is not None else None
        with suppress(KeyboardInterrupt):
            server.serve(should_stop=lambda: end is not None and body.tick >= end, after_period=after_step)
    finally:
        server.close()
        if viewer is not None:
            viewer.stop()
        if options.out is not None and body.tick > 0:
            print(f"what truly happened: {write(options.out, packed(body.record()))}")
    print("ended.")
    return 0


def _say(sentence: str) -> None:
    """Print what a host should know, at once."""
    print(sentence, flush=True)


def _models_text(wiring: Wiring) -> str:
    """Return how many servos of each model there are, in words."""
    counts = Counter(servo.model for servo in wiring.servo)
    return " and ".join(f"{count} {model} ({servo_table(model).protocol})" for model, count in counts.items())


def _do_nothing() -> None:
    """Do nothing after a step."""


def _wiring_and_links(options: EmulateOptions) -> tuple[Wiring, list[Path]]:
    """Return the wiring, and the links under which the pseudo-terminals are found."""
    if options.hardware.exists():
        wiring = read_wiring(options.hardware, options.robot)
        ports = [Path(bus.port) for bus in wiring.bus if "://" not in bus.port]
        return wiring, ports if len(ports) == len(wiring.bus) and not options.socket else []
    check_writable(options.hardware.parent)
    models = servo_models(options.robot, options.protocol)
    protocols = [bus_protocol(name) for name in dict.fromkeys(servo_table(model).protocol for model in models.values())]
    stem = options.hardware.stem
    names = [f"{stem}.port" if i == 0 else f"{stem}{i + 1}.port" for i in range(len(protocols))]
    buses = [
        BusPlace(port=name, protocol=protocol.name, baud=protocol.default_baud)
        for name, protocol in zip(names, protocols, strict=True)
    ]
    wiring = straight(options.robot, buses, models, boards=True)
    return wiring, [] if options.socket else [options.hardware.parent / name for name in names]


def servo_models(robot: Robot, protocol: str | None) -> dict[str, str]:
    """Return the models of an emulated robot's servos by name: its own, where they speak the protocol.

    A servo whose model the robot's file does not name, or that speaks another protocol, is the default model of the
    protocol.

    Args:
        robot: that is emulated.
        protocol: of all servos; None for what the robot's own servos speak.
    """
    models = own_models(robot)
    if protocol is None:
        spoken = [servo_table(model).protocol for model in models.values()]
        default = bus_protocol(spoken[0] if spoken else _DEFAULT_PROTOCOL).default_model
    else:
        default = bus_protocol(protocol).default_model
        models = {name: model for name, model in models.items() if servo_table(model).protocol == protocol}
    return {name: models.get(name, default) for name in layout(robot).servos}


def _with_ports(wiring: Wiring, ports: Sequence[str]) -> Wiring:
    """Return the wiring with the buses' present ports."""
    port_names = [port if "://" in port else Path(port).name for port in ports]
    return replace(wiring, bus=tuple(replace(bus, port=port) for bus, port in zip(wiring.bus, port_names, strict=True)))


def _fault(text: str, onset: float) -> Any:
    _, colon, joint = text.partition(":")
    if not colon or not joint:
        raise BadCommand(f"--fault {text} names no part; say as limp:LF_yaw. The kinds are {', '.join(FAULTS)}.")
    return from_text(text, at=onset)


def _watching_page(options: EmulateOptions, server: Server, body: EmulatedBody) -> Any:
    """Return the page in a browser that watches the robot."""
    pages, ports = pages_of_viewer(), ", ".join(server.ports)

    def picture() -> Any:
        torque = "with its torque on" if (body.powered > 0.0).any() else "limp: nobody drives it"
        return pages.WatchedRobot(body.time, body.now, options.lake, f"{ports}, {torque}")

    return pages.WatchProcess(options.robot, picture, port=options.port, title=f"{options.robot.name}, emulated")


def _robot_first(words: Sequence[str]) -> list[str]:
    """Move the value of ``--robot`` to the first place, where the parser expects the robot."""
    words = list(words)
    for i, word in enumerate(words):
        if word == "--robot" and i + 1 < len(words):
            return [words[i + 1], *words[:i], *words[i + 2 :]]
        if word.startswith("--robot="):
            return [word.partition("=")[2], *words[:i], *words[i + 1 :]]
    return words

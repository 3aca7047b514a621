"""``hardware.toml``, the wiring of a robot: read and written."""

from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from suchus.core.errors import UnreadableFile
from suchus.core.files import path_exists, read_toml, write
from suchus.hardware.bus import STEP, BoardPlace, BusPlace, ServoPlace, Wiring
from suchus.robot.blueprint import parse_table
from suchus.robot.design import Robot
from suchus.robot.design.meaning import meanings


def read_wiring(path: str | Path, robot: Robot) -> Wiring:
    """Read the wiring of a robot; a port that is no whole path is looked for beside the file.

    Raises:
        UnreadableFile: the file is missing or no TOML.
        MistakenFile: values are missing, unknown, of the wrong kind or impossible.
        InvalidDesign: it is for another robot, or not for all of its servos.
    """
    path = Path(path)
    if not path_exists(path):
        raise UnreadableFile(
            f"there is no file {path}, which says where each servo hangs: suchus calibrate wiring --robot {robot.name} "
            "writes one with the servos at hand, and suchus emulate ROBOT one of an emulated robot."
        )
    wiring: Wiring = parse_table(read_toml(path), Wiring, path.name)
    wiring.ordered(robot)
    return replace(
        wiring, bus=tuple(replace(bus_place, port=_resolve_port(bus_place.port, path)) for bus_place in wiring.bus)
    )


def write_wiring(wiring: Wiring, path: str | Path) -> Path:
    """Write a wiring, and return the path.

    Raises:
        Unwritable: the place cannot be written to, or is taken.
    """
    return write(path, wiring_text(wiring))


def wiring_text(wiring: Wiring) -> str:
    """Return a wiring as TOML: the meaning of each value once, then a line for each bus, servo and board."""
    lines = [
        f"# The angle of a joint is sign (steps - zero) {_step_text(wiring)}.",
        f"robot = {_value(wiring.robot)}",
        f"fingerprint = {_value(wiring.fingerprint)}",
    ]
    for name, kind in (("bus", BusPlace), ("servo", ServoPlace), ("board", BoardPlace)):
        rows = getattr(wiring, name)
        if rows:
            descriptions = meanings(kind)
            lines += ["", *(f"# {key}: {' '.join(descriptions[key].split())}" for key in descriptions), f"{name} = ["]
            for row in rows:
                items = ", ".join(f"{f.name} = {_value(getattr(row, f.name))}" for f in fields(row))
                lines.append(f"  {{{items}}},")
            lines.append("]")
    return "\n".join(lines) + "\n"


def _step_text(wiring: Wiring) -> str:
    """Return the angle of a step in words: one for all servos, or that of each model."""
    steps_by_model = {servo.model: servo.table.step for servo in wiring.servo}
    if all(step == STEP for step in steps_by_model.values()):
        return "2 pi / 4096"
    steps = ", ".join(f"{step:.9g} rad for {model}" for model, step in steps_by_model.items())
    return f"times the model's step: {steps}"


def _resolve_port(port: str, path: Path) -> str:
    return port if "://" in port or Path(port).is_absolute() else str(path.parent / port)


def _value(value: Any) -> str:
    text = str(value).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{text}"' if isinstance(value, str) else repr(value)

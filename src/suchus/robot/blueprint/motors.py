"""A user's own servos as they are bought, from TOML files as the catalog's."""

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from suchus.core.reading import read_toml
from suchus.robot.blueprint.mistakes import MistakenFile, Place
from suchus.robot.blueprint.read import validated
from suchus.robot.design import Motor
from suchus.robot.motors import split


def read_motors(path: str | Path) -> Mapping[str, Motor]:
    """Read servos from a TOML file: a table for each, in which a number is ``{value = 2.94, source = "..."}``.

    A number may stand alone; its source is then empty. Texts have no source.

    Raises:
        UnreadableFile: the file is missing or no TOML.
        MistakenFile: values are missing, unknown, of the wrong kind or impossible, or there is no servo in it; it names
            all of them.
    """
    path = Path(path)
    data = read_toml(path)
    if not data:
        raise MistakenFile(path.name, {(): "has no servo; give a table for each, as in [my_servo]"})
    motors: dict[str, Motor] = {}
    mistakes: dict[Place, str] = {}
    for name, table in data.items():
        if not isinstance(table, dict):
            mistakes[name,] = f"is {table!r:.40}; a table of a servo's numbers is needed"
            continue
        values, sources, odd = split(table)
        mistakes |= {(name, field): text for field, text in odd.items()}
        try:
            motor_fields = {**values, "name": name, "sources": [list(pair) for pair in sources.items()]}
            motors[name] = validated(motor_fields, Motor, {}, path.name, {})
        except MistakenFile as error:
            mistakes |= {
                (name, place) if place else (name,): text for place, text in error.mistakes.items() if place not in odd
            }
    if mistakes:
        raise MistakenFile(path.name, mistakes)
    return MappingProxyType(motors)

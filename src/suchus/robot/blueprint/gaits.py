"""From a TOML file to a gait, in whichever form it is written: shares of the body, metres, or places along the axis."""

from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from suchus.core.errors import InvalidDesign, OutsideLimits, UnreadableFile
from suchus.core.files import read_toml
from suchus.robot.blueprint.mistakes import MistakenFile, Place
from suchus.robot.blueprint.read import merged, plain, validated
from suchus.robot.design import Robot
from suchus.robot.motion import (
    AxialWave,
    Gait,
    GaitByPlaces,
    GaitInMetres,
    form_of,
    in_metres,
    limb_reaches,
    servo_parts,
)

_WAVE = ("amplitude", "waves", "phase")


def read_gait(path: str | Path, robot: Robot, shelf: Mapping[str, Gait]) -> Gait:
    """Read a gait from a TOML file.

    The keys of the file decide its form: fields of a ``Gait``; metres, as ``front_reach`` or ``trunk_bend``; or places
    along the body, ``girdles`` and ``wave``. A curve without a part gets the part of its servo. With ``base =
    "belly_crawl"`` at the top the file changes numbers of that gait of the catalog. A gait without a ``name`` is named
    after the file.

    Args:
        path: the file.
        robot: robot for whose limbs metres are, and in whose hinges places.
        shelf: what ``base`` may name.

    Raises:
        UnreadableFile: the file is missing or no TOML, or its base has nothing that its keys could change.
        MistakenFile: values are missing, unknown, of the wrong kind or impossible; it names all of them.
        OutsideLimits: metres are given and the robot has not two pairs of limbs.
    """
    path = Path(path)
    data = read_toml(path)
    base_name = data.pop("base", None)
    mistakes: dict[Place, str] = {}
    base = shelf[base_name] if isinstance(base_name, str) and base_name in shelf else None
    if base_name is not None and base is None:
        mistakes["base",] = f"is {base_name!r}; there is {', '.join(shelf)}"
        base = _metric_gait(shelf)  # supplies values, so that further mistakes are found
    form = form_of(data)
    # a file that changes the limbs' phases alone keeps the coupling of a gait in metres
    if form is None and base is not None and in_metres(base) and "limb_phases" in data and "coupling" not in data:
        form = GaitInMetres
    data = {"name": path.stem, **data}
    try:
        if form is GaitInMetres:
            return _in_metres(data, robot, base, shelf, path.name, mistakes)
        if form is GaitByPlaces:
            return _by_places(data, robot, base, shelf, path.name, mistakes)
    except InvalidDesign as error:
        if isinstance(error, UnreadableFile):
            raise
        raise MistakenFile(path.name, {(): f"on robot {robot.name!r} {str(error).rstrip('.')}"}) from error
    except OutsideLimits as error:
        raise UnreadableFile(f"{path.name}: {error}") from error
    fallback, data = plain(asdict(base or _metric_gait(shelf))), _with_parts(data, robot)
    return validated(data if base is None else merged(fallback, data), Gait, fallback, path.name, mistakes)


def _metric_gait(shelf: Mapping[str, Gait]) -> Gait:
    """Return a gait that can be written in every form."""
    return next(gait for gait in shelf.values() if in_metres(gait))


def _with_parts(data: dict[str, Any], robot: Robot) -> dict[str, Any]:
    """Return a table whose curves say which part of the body they move.

    Args:
        data: the table of a gait.
        robot: robot whose servos the curves move.
    """
    if not isinstance(data.get("curves"), list):
        return data
    parts = servo_parts(robot)
    curves = [
        {"part": parts.get(str(curve.get("servo")), "trunk"), **curve} if isinstance(curve, Mapping) else curve
        for curve in data["curves"]
    ]
    return {**data, "curves": curves}


def _in_metres(
    data: dict[str, Any],
    robot: Robot,
    base: Gait | None,
    shelf: Mapping[str, Gait],
    name: str,
    mistakes: dict[Place, str],
) -> Gait:
    """Return the gait that a table in metres describes.

    Args:
        data: the table.
        robot: robot for whose limbs the metres are.
        base: gait that the table changes; None if the table gives every number.
        shelf: gaits by name; one of them supplies values to go on with after a mistake.
        name: name of the file.
        mistakes: those that are known already, by place.
    """
    reaches, keys = limb_reaches(robot), frozenset(data)
    fallback = plain(asdict(GaitInMetres.from_gait(base or _metric_gait(shelf), reaches)))
    table = data if base is None else merged(fallback, data)
    metres = validated(table, GaitInMetres, fallback, name, mistakes)
    return metres.gait(reaches) if base is None else metres.override(base, keys, reaches)


def _by_places(
    data: dict[str, Any],
    robot: Robot,
    base: Gait | None,
    shelf: Mapping[str, Gait],
    name: str,
    mistakes: dict[Place, str],
) -> Gait:
    """Return the gait that a table with a wave by places along the body describes; arguments as for ``_in_metres``."""
    wave = data.get("wave")
    straight_wave = AxialWave(amplitude=((0.0, 0.0),), waves=0.0, phase=0.0)
    is_partial = isinstance(wave, Mapping) and not set(_WAVE) <= set(wave)
    fallback = plain(
        asdict(
            GaitByPlaces.from_gait(
                base or _metric_gait(shelf),
                AxialWave.from_gait(base, robot) if base is not None and is_partial else straight_wave,
            )
        )
    )
    table = data if base is None else merged(fallback, data)
    gait = validated(table, GaitByPlaces, fallback, name, mistakes).gait(robot)
    return gait if base is None or wave is not None else replace(gait, axis=base.axis)

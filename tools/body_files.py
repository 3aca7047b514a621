"""Eight bodies as files, such as users bring: what a name in the catalog answers to, a file must answer to as well."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

from suchus.robot import blueprint
from suchus.robot.design import Robot, crocodile
from suchus.robot.design.scale import rescale
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.model.export import export
from suchus.sim.model.importing import import_robot

_CAIMAN: Robot = ROBOTS["caiman"]


def hatchling() -> Robot:
    """The article's tables in a body of 0.3 m and 60 g."""
    return _sized("hatchling", length=0.3, mass=0.06)


def giant() -> Robot:
    """The article's tables in a body of 3 m."""
    return _sized("giant", length=3.0, mass=_CAIMAN.mass * (3.0 / _CAIMAN.length) ** 3)


def _sized(name: str, length: float, mass: float) -> Robot:
    assert _CAIMAN.tables is not None
    factors = {"length_factor": length / _CAIMAN.length, "mass_factor": mass / _CAIMAN.mass}
    return crocodile(replace(rescale(_CAIMAN.tables, **factors), name=name))


def six() -> Robot:
    """A caiman of six vertebrae, with servos in its tail."""
    assert _CAIMAN.tables is not None
    spine, tail = replace(_CAIMAN.tables.spine, joints=6), replace(_CAIMAN.tables.tail, drive="servos")
    return crocodile(replace(_CAIMAN.tables, name="six", spine=spine, tail=tail))


def general() -> Robot:
    """The caiman part by part: the general form, which no tables make."""
    return replace(_CAIMAN, name="general")


def eight() -> Robot:
    """A body of eight legs, light ones in the middle, the hind ones not at the root's origin; no tables make it."""
    front, hind = _CAIMAN.girdles
    light = replace(front.limb, links=tuple(replace(link, mass=0.01) for link in front.limb.links))
    middle = [replace(front, name=name, segment=f"spine_{i}", at=0.0, limb=light) for name, i in (("M", 3), ("N", 2))]
    return replace(_CAIMAN, name="eight", girdles=(front, *middle, replace(hind, at=-0.02, above=-0.006)))


def rigid() -> Robot:
    """Three pairs of legs on a trunk that does not bend."""
    strider = ROBOTS["strider"]
    return replace(strider, name="rigid", axis=tuple(replace(segment, hinges=()) for segment in strider.axis))


def imported_quadruped(folder: Path) -> Robot:
    """A trotting robot as they are built today, read from a file of another tool: a box on legs that hang down."""
    leg = (
        '<body name="{0}_hip" pos="{1} {2} 0"><joint name="{0}_abduction" axis="1 0 0" range="-0.86 0.86"/>'
        '<geom type="sphere" size="0.04" mass="0.7"/>'
        '<body name="{0}_thigh" pos="0 {3} 0"><joint name="{0}_swing" axis="0 1 0" range="-0.7 3.2"/>'
        '<geom type="capsule" size="0.02" fromto="0 0 0 0 0 -0.21" mass="1"/>'
        '<body name="{0}_calf" pos="0 0 -0.21"><joint name="{0}_knee" axis="0 1 0" range="-2.7 -0.9"/>'
        '<geom type="capsule" size="0.015" fromto="0 0 0 0 0 -0.21" mass="0.2"/>'
        '<geom type="sphere" size="0.02" pos="0 0 -0.21" mass="0.05"/></body></body></body>'
    )
    legs = [leg.format(f"{end}{side}", 0.19 * x, 0.05 * y, 0.08 * y) for end, x in _ENDS for side, y in _SIDES]
    box = '<geom type="box" size="0.2 0.09 0.06" mass="8"/>'
    file = folder / "quadruped.xml"
    file.write_text(
        '<mujoco model="quadruped"><compiler angle="radian"/><worldbody><body name="base"><freejoint/>'
        f"{box}{''.join(legs)}</body></worldbody></mujoco>"
    )
    return import_robot(file, name="quadruped").robot


_ENDS, _SIDES = (("F", 1), ("R", -1)), (("L", 1), ("R", -1))


def imported_snake(folder: Path) -> Robot:
    """The swimmer's URDF, read as one of another tool."""
    export(ROBOTS["swimmer"], GAITS["undulation"], folder / "snake", "urdf")
    return import_robot(folder / "snake" / "swimmer.urdf", name="snake").robot


MADE: Mapping[str, Callable[[], Robot]] = MappingProxyType(
    {one.__name__: one for one in (hatchling, six, eight, rigid, general, giant)}
)
IMPORTED: Mapping[str, Callable[[Path], Robot]] = MappingProxyType(
    {"quadruped": imported_quadruped, "snake": imported_snake}
)
FILES = tuple(f"{name}.toml" for name in (*MADE, *IMPORTED))
"""Names of the files."""


def write_files(folder: Path) -> dict[str, Path]:
    """Write all of them into a folder, and return their paths by file name."""
    robots = [make() for make in MADE.values()] + [read(folder) for read in IMPORTED.values()]
    return {f"{robot.name}.toml": blueprint.write(robot, folder / f"{robot.name}.toml") for robot in robots}

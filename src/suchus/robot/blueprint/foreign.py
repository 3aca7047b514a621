"""Files of other programs that hold a robot in a form that is not read, and how each becomes one that is."""

import re
from pathlib import Path

from suchus.core.errors import UnreadableFile
from suchus.core.reading import check_file

_MAX_HEAD = 65_536  # bytes of a file in which its first element is looked for
_ROOT = re.compile(r"\A\s*(?:<\?.*?\?>\s*|<!--.*?-->\s*|<!DOCTYPE[^>]*>\s*)*<([\w:.-]+)", re.DOTALL)
_MESH = "is a mesh, a shape without joints: give the URDF or MJCF that names it"
_CAD = (
    "is a drawing of a CAD program, without joints that can be read: export a URDF from that program, as with "
    "onshape-to-robot or the URDF exporter of SolidWorks"
)
_SCENE = "is a scene in USD, which is not read: export it as URDF or MJCF from the program that wrote it"
_WEBOTS = "is of Webots, which is not read: write the robot's URDF with robot.getUrdf() in its controller"
_ARCHIVE = "is an archive, which is not read: unpack it, and give the .urdf or .xml in it"
_SDF = (
    "is an SDF, which is not read: convert it with sdf2mjcf {name} {stem}.xml (pip install sdformat-mjcf), or take the "
    "URDF or xacro that it was made of"
)
_XACRO = "is a xacro, a URDF with macros: expand it with xacro {name} > {stem}.urdf"
_TABLE = "is no robot's file: a robot is a TOML, a URDF or an MJCF"
_OURS = "is a robot of suchus already: give it as --robot {name}"
_REMEDIES = {
    ".sdf": _SDF,
    ".world": _SDF,
    ".xacro": _XACRO,
    **dict.fromkeys((".usd", ".usda", ".usdc", ".usdz"), _SCENE),
    **dict.fromkeys((".proto", ".wbt"), _WEBOTS),
    **dict.fromkeys((".stl", ".obj", ".dae", ".ply", ".off", ".glb", ".gltf", ".3mf"), _MESH),
    **dict.fromkeys((".step", ".stp", ".iges", ".igs", ".sldasm", ".sldprt", ".f3d", ".fcstd"), _CAD),
    **dict.fromkeys((".zip", ".tar", ".gz", ".tgz", ".bz2", ".xz", ".7z", ".rar"), _ARCHIVE),
    **dict.fromkeys((".json", ".yaml", ".yml", ".csv", ".nc"), _TABLE),
}


def check_robot_format(path: str | Path, *, is_import: bool = False) -> None:
    """Refuse a robot of a format that is not read, known by its ending or its first element.

    Args:
        path: the file.
        is_import: whether a file of another program is expected, so that one of ours is refused too.

    Raises:
        UnreadableFile: it says what the file is, and how to make one that is read of it.
    """
    path = Path(path)
    check_file(path)
    if is_import and path.suffix.lower() == ".toml":
        raise UnreadableFile(f"{path} {_OURS.format(name=path)}.")
    text = _REMEDIES.get(path.suffix.lower()) or (_SDF if root_element(path) == "sdf" else None)
    if text is not None:
        stem = path.name.partition(".")[0]
        if path.name in (f"{stem}.xml", f"{stem}.urdf"):  # what is written is another file than what is read
            stem = f"{stem}_converted"
        raise UnreadableFile(f"{path} {text.format(name=path.name, stem=stem)}.")


def root_element(path: str | Path) -> str | None:
    """Return the name of an XML file's first element; None for what is no XML."""
    with Path(path).open("rb") as file:
        head = file.read(_MAX_HEAD).decode("utf-8-sig", errors="replace")
    match = _ROOT.match(head)
    return match[1] if match else None


def check_no_xml(path: str | Path) -> None:
    """Refuse an XML file where a TOML file is read.

    Raises:
        UnreadableFile: it says how a URDF or an MJCF must end.
    """
    path = Path(path)
    root = root_element(path)
    ending = {"robot": ".urdf", "mujoco": ".xml"}.get(root or "")
    if ending:
        kind = {".urdf": "a URDF", ".xml": "an MJCF"}[ending]
        raise UnreadableFile(
            f"{path} is {kind} and no TOML: name it {path.stem}{ending}, by which it is known, or import it first "
            f"with: suchus import {path}."
        )
    if root:
        raise UnreadableFile(f"{path} is XML that begins with <{root[:40]}>; a robot is a TOML, a URDF or an MJCF.")

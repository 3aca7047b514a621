"""A file of another tool, loaded by MuJoCo with all its joints at zero."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal
from xml.etree import ElementTree

import mujoco
import numpy as np

from suchus.errors import SuchusError, UnreadableFile
from suchus.model.importing.cleaning import Drive, clean_mjcf, clean_urdf, inside, parse, with_includes
from suchus.reading import check_file

Format = Literal["URDF", "MJCF"]
_BODIES = 1000  # at most; MuJoCo walks down a chain by recursion
_MESHES = 64 * 2**20  # bytes of all meshes
_NAMES = ("name", "class", "childclass", "link", "joint", "file", "filename", "mesh", "type")
_SUFFIXES = (".stl", ".obj")


@dataclass(frozen=True, slots=True, kw_only=True)
class Loaded:
    """A model that MuJoCo made of a file, and what the file says beside it."""

    kind: Format
    """Format of the file."""
    model: Any
    """The ``mujoco.MjModel``: bodies, hinges and shapes."""
    drives: dict[str, Drive]
    """What drives each hinge; empty where the file says nothing of drives."""
    remarks: tuple[str, ...]
    """Notes on what was not taken over, a sentence each."""


def load(path: Path) -> Loaded:
    """Load a URDF or an MJCF. No file outside its folder is read, nothing in it is executed.

    Raises:
        UnreadableFile: it cannot be read, or is no tree of hinges.
    """
    root = parse(path)
    lost: list[str] = []
    assets: dict[str, bytes] = {}

    def mesh(name: str) -> str | None:
        return _given(path, name, assets, lost)

    try:
        if root.tag == "robot":
            kind: Format = "URDF"
            clean, drives, remarks = clean_urdf(root, mesh)
        elif root.tag == "mujoco":
            kind = "MJCF"
            clean, drives, remarks = clean_mjcf(with_includes(root, path), mesh)
        else:
            raise UnreadableFile(
                f"it begins with <{root.tag[:40]}>; a URDF begins with <robot>, an MJCF with <mujoco>."
            )
        model = _compiled(clean, assets)
    except SuchusError as error:
        raise UnreadableFile(f"{path.name} cannot be imported: {error}") from error
    if lost:
        remarks += (
            f"{len(lost)} meshes were not read ({', '.join(sorted(set(lost))[:3])}): only STL and OBJ files in the "
            "file's own folder are.",
        )
    return Loaded(kind=kind, model=model, drives=drives, remarks=remarks)


def _given(path: Path, name: str, assets: dict[str, bytes], lost: list[str]) -> str | None:
    """Take a mesh from the folder of the file and return the name under which MuJoCo finds it."""
    where = inside(path.resolve().parent, name.removeprefix("file://"))
    if where is None or where.suffix.lower() not in _SUFFIXES:
        lost.append(name[-60:])
        return None
    try:
        check_file(where)
        size = where.stat().st_size
        if size + sum(map(len, assets.values())) > _MESHES:
            raise UnreadableFile(f"mesh {where.name} makes the meshes larger than {_MESHES // 2**20} MiB.")
        data = where.read_bytes()
    except (UnreadableFile, OSError):
        lost.append(name[-60:])
        return None
    known = next((key for key, held in assets.items() if held == data and key.endswith(where.suffix.lower())), None)
    given = known or f"mesh_{len(assets)}{where.suffix.lower()}"
    assets[given] = data
    return given


def _check_numbers(clean: ElementTree.Element) -> None:
    """Refuse numbers that are none and masses that cannot be; MuJoCo would mend or log them."""
    for element in clean.iter():
        for key, text in element.attrib.items():
            if key in _NAMES:
                continue
            odd = next((word for word in text.split() if word.strip("+-").lower() in ("nan", "inf", "infinity")), "")
            mass = key in ("mass", "density") or (element.tag == "mass" and key == "value")
            if odd or (mass and not _is_mass(text)):
                raise UnreadableFile(
                    f"<{element.tag} {key}={(odd or text)[:40]!r}> is not allowed; "
                    + ("a finite number from 0 on is needed." if mass else "finite numbers are needed.")
                )


def _is_mass(text: str) -> bool:
    try:
        return float(text) >= 0.0
    except ValueError:
        return False


def _compiled(clean: ElementTree.Element, assets: dict[str, bytes]) -> Any:
    _check_numbers(clean)
    if sum(1 for e in clean.iter() if e.tag in ("body", "link")) > _BODIES:
        raise UnreadableFile(f"it has more than {_BODIES} bodies.")
    try:
        model = mujoco.MjModel.from_xml_string(ElementTree.tostring(clean, encoding="unicode"), assets)
    except (ValueError, mujoco.FatalError) as error:
        said = " ".join(str(error).split())
        raise UnreadableFile(f"MuJoCo says: {said[:240].rstrip('.')}.") from error
    for name in ("body_pos", "body_quat", "body_mass", "body_ipos", "jnt_axis", "jnt_pos", "jnt_range", "geom_size"):
        if not np.isfinite(getattr(model, name)).all():
            raise UnreadableFile(f"a number of its {name.replace('_', ' ')} is not finite.")
    for joint in range(model.njnt):
        kind = mujoco.mjtJoint(int(model.jnt_type[joint]))
        if kind in (mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_BALL):
            word = "slides (prismatic)" if kind == mujoco.mjtJoint.mjJNT_SLIDE else "is a ball joint"
            raise UnreadableFile(
                f"joint {model.joint(joint).name!r} {word}; suchus takes hinges: remove it"
                f"{', or give the root a <freejoint/>' if model.jnt_bodyid[joint] == 1 else ''}."
            )
    if not (model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE).any():
        raise UnreadableFile("it has no hinge; a robot needs some.")
    return model

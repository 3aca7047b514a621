"""A file of another tool, loaded by MuJoCo with all its joints at zero."""

import re
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import Any, Literal
from xml.etree import ElementTree

import mujoco
import numpy as np

from suchus.core.errors import SuchusError, UnreadableFile
from suchus.robot import blueprint
from suchus.sim.model.importing.cleaning import (
    Drive,
    clean_mjcf,
    clean_urdf,
    parse,
    with_includes,
    with_passive,
)
from suchus.sim.model.importing.drives import actuated_drives
from suchus.sim.model.importing.meshes import Meshes

Format = Literal["URDF", "MJCF"]
_BODIES = 1000  # at most; MuJoCo walks down a chain by recursion
_INERTIA = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
_NUMBERS = {
    "origin": ("xyz", "rpy"), "axis": ("xyz",), "box": ("size",), "cylinder": ("radius", "length"),
    "sphere": ("radius",), "mass": ("value",), "inertia": _INERTIA, "body": ("pos", "quat", "euler"),
    "joint": ("axis", "range"), "geom": ("size", "fromto"), "inertial": ("pos", "diaginertia", "fullinertia"),
}  # fmt: skip
"""Attributes that are numbers, by the tag of their element."""
_NAMES = ("name", "class", "childclass", "link", "joint", "file", "filename", "mesh", "type")


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
    gravity: tuple[float, float, float] | None
    """What the file says of gravity, in its own frame [m/s2]; None where it says nothing."""


def load(path: Path, *, packages: Sequence[str | Path] = (), without_meshes: bool = False) -> Loaded:
    """Load a URDF or an MJCF. No file outside its folder and those of packages is read, nothing in it is executed.

    Args:
        path: the file.
        packages: folders in which packages lie that meshes name by ``package://``.
        without_meshes: whether bodies whose meshes cannot be read are loaded without a shape.

    Raises:
        UnreadableFile: it cannot be read, is no tree of hinges, or the shape of a body is a mesh that is not read.
    """
    blueprint.check_robot_format(path, is_import=True)
    root = parse(path)
    meshes = Meshes(path.resolve().parent, packages)
    try:
        if root.tag == "robot":
            kind: Format = "URDF"
            clean, drives, remarks = clean_urdf(root, meshes)
        elif root.tag == "mujoco":
            kind = "MJCF"
            clean, remarks = clean_mjcf(with_includes(root, path), meshes)
            drives = {}
        else:
            raise UnreadableFile(
                f"it begins with <{root.tag[:40]}>; a URDF begins with <robot>, an MJCF with <mujoco>."
            )
        if not without_meshes:
            meshes.check()
        model, inertia_remarks = _compiled(clean, meshes)
        if kind == "MJCF":
            drives, drive_remarks = actuated_drives(model)
            drives, remarks = with_passive(root, drives), (*remarks, *drive_remarks)
    except SuchusError as error:
        raise UnreadableFile(f"{path.name} cannot be imported: {error}") from error
    if meshes.read_errors:
        remarks += (
            f"{len(meshes.read_errors)} mesh{'es were' if len(meshes.read_errors) > 1 else ' was'} not read: "
            f"{'; '.join(list(meshes.read_errors.values())[:3])}.",
        )
    gravity = _gravity(root) if kind == "MJCF" else None
    return Loaded(kind=kind, model=model, drives=drives, remarks=(*remarks, *inertia_remarks), gravity=gravity)


def _gravity(root: ElementTree.Element) -> tuple[float, float, float] | None:
    """Return the gravity that an MJCF states [m/s2]; None where it states none.

    Raises:
        UnreadableFile: it is no three finite numbers.
    """
    texts = [text for option in root.findall("option") if (text := option.get("gravity")) is not None]
    if not texts:
        return None
    try:
        x, y, z = (float(word) for word in texts[-1].split())
    except ValueError:
        x = y = z = float("nan")
    if not isfinite(x + y + z):
        raise UnreadableFile(f"<option gravity={texts[-1][:60]!r}> is not allowed; three finite numbers are needed.")
    return x, y, z


def _check_numbers(clean: ElementTree.Element) -> None:
    """Refuse numbers that are none and masses that cannot be; MuJoCo would mend or log them."""
    for element in clean.iter():
        for key, text in element.attrib.items():
            if key in _NAMES:
                continue
            if key in _NUMBERS.get(element.tag, ()):
                no_number = next((word for word in text.split() if not _is_number(word)), None)
                if no_number is not None:
                    raise UnreadableFile(
                        f"<{element.tag} {key}={text[:60]!r}> holds {no_number[:40]!r}, which is no number; numbers "
                        "have a decimal point and stand apart by spaces."
                    )
            odd = next((word for word in text.split() if word.strip("+-").lower() in ("nan", "inf", "infinity")), "")
            mass = key in ("mass", "density") or (element.tag == "mass" and key == "value")
            if odd or (mass and not _is_mass(text)):
                raise UnreadableFile(
                    f"<{element.tag} {key}={(odd or text)[:40]!r}> is not allowed; "
                    + ("a finite number from 0 on is needed." if mass else "finite numbers are needed.")
                )


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _is_mass(text: str) -> bool:
    try:
        return float(text) >= 0.0
    except ValueError:
        return False


def _compiled(clean: ElementTree.Element, meshes: Meshes) -> tuple[Any, tuple[str, ...]]:
    """Return the model, and sentences on inertias that had to be mended or guessed."""
    _check_numbers(clean)
    if sum(1 for e in clean.iter() if e.tag in ("body", "link")) > _BODIES:
        raise UnreadableFile(f"it has more than {_BODIES} bodies.")
    text = ElementTree.tostring(clean, encoding="unicode")
    try:
        spec = mujoco.MjSpec.from_string(text, assets=meshes.assets)
        for mesh in spec.meshes:
            exact = mesh.file not in meshes.open
            mesh.inertia = getattr(mujoco.mjtMeshInertia, f"mjMESH_INERTIA_{'EXACT' if exact else 'CONVEX'}")
        model, inertia_remarks = _balanced(spec)
    except (ValueError, mujoco.FatalError) as error:
        message = re.sub(
            r",? line \d+", "", " ".join(str(error).split())
        )  # lines of the text that was made of the file
        raise UnreadableFile(f"MuJoCo says: {message[:240].rstrip('.')}.") from error
    if meshes.open:
        inertia_remarks += (
            f"{len(meshes.open)} meshes are no closed surfaces, or have more than 200 000 faces: where a body has no "
            "<inertial>, its mass is that of the convex hull.",
        )
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
    return model, inertia_remarks


def _balanced(spec: Any) -> tuple[Any, tuple[str, ...]]:
    """Return a compiled model; where a body's inertia is none that a body can have, MuJoCo makes its moments equal."""
    spec.compiler.balanceinertia = False
    try:
        return _quietly_compiled(spec), ()
    except ValueError as error:
        spec.compiler.balanceinertia = True
        model = _quietly_compiled(spec)
        body = re.search(r"Element name '([^']*)'", str(error))
        body_text = f"of {body[1]}" if body else "of a body"
        return model, (
            f"The inertia {body_text} is none that a body can have, one principal moment being greater than the sum of "
            "the others; MuJoCo gives all such bodies three equal moments of the same sum.",
        )


def _quietly_compiled(spec: Any) -> Any:
    """Return a compiled model; warnings of MuJoCo on attributes that it will drop say nothing to who wrote none."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return spec.compile()

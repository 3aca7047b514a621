"""What of an MJCF describes its tree of hinges, checked, and freed of all that names files or makes bodies."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from xml.etree import ElementTree

from suchus.errors import UnreadableFile
from suchus.model.export.urdf import MUJOCO
from suchus.model.importing.drives import Drive
from suchus.model.importing.safe_xml import parse
from suchus.model.importing.urdf_file import Mesh

_BODIES = ("replicate", "composite", "flexcomp", "attach")
_KEPT = ("body", "joint", "freejoint", "geom", "inertial", "site", "frame")
_COMPILER = ("angle", "eulerseq", "autolimits", "coordinate", "inertiafromgeom", "inertiagrouprange", "settotalmass")
_UNTOLD = ("compiler", "option", "size", "visual", "statistic", "default", "asset", "worldbody", "actuator", "equality")
_FILES = 50  # included ones at most


def with_includes(root: ElementTree.Element, path: Path) -> ElementTree.Element:
    """Put what an MJCF includes in its place; only files in its own folder are opened, each once.

    Raises:
        UnreadableFile: an included file lies elsewhere, is included twice, or cannot be read.
    """
    home, seen = path.resolve().parent, [path.resolve()]

    def expand(element: ElementTree.Element) -> None:
        for place, child in reversed(list(enumerate(element))):
            if child.tag != "include":
                expand(child)
                continue
            where = inside(home, child.get("file", ""))
            if where is None:
                raise UnreadableFile(
                    f"the MJCF includes {child.get('file', '')[:100]!r}, which lies outside its folder and is not "
                    "read; put it beside the file."
                )
            if where in seen or len(seen) > _FILES:
                raise UnreadableFile(f"the MJCF includes {where.name!r} twice, or includes too many files.")
            seen.append(where)
            part = parse(where)
            expand(part)
            element[place : place + 1] = list(part)

    expand(root)
    return root


def inside(home: Path, name: str) -> Path | None:
    """Return the path of a file named in a robot's file; None where it would lie outside the robot's folder."""
    try:
        where = (home / name).resolve()
    except (OSError, ValueError, RuntimeError):
        return None
    return where if name and where.is_relative_to(home) else None


def clean_mjcf(root: ElementTree.Element, mesh: Mesh) -> tuple[ElementTree.Element, dict[str, Drive], tuple[str, ...]]:
    """Return an MJCF of bodies, joints and shapes alone, what drives each hinge, and sentences on what was left out.

    Raises:
        UnreadableFile: it has loops, makes bodies by rule, or has no bodies.
    """
    remarks = _equalities(root)
    drives, of_tendons = _actuators(root)
    remarks += of_tendons
    made = ElementTree.Element("mujoco", model="imported")
    compiler = {k: v for e in root.findall("compiler") for k, v in e.attrib.items() if k in _COMPILER}
    bounds = {key: MUJOCO[key] for key in ("boundmass", "boundinertia")}
    ElementTree.SubElement(made, "compiler", {**compiler, **bounds, "balanceinertia": "true"})
    for element in root.findall("default"):
        made.append(_cleaned(element, (*_KEPT, "mesh", "default"), None))
    meshes = _meshes(root, made, mesh)
    worlds = root.findall("worldbody")
    if not any(world.find(".//body") is not None for world in worlds):
        raise UnreadableFile("the MJCF has no <body>; a robot needs some.")
    for world in worlds:
        for element in world.iter():
            if element.tag in _BODIES:
                raise UnreadableFile(
                    f"the MJCF makes bodies with <{element.tag}>; write them out first, as with mujoco.mj_saveLastXML."
                )
        made.append(_cleaned(world, _KEPT, meshes))
    left = sorted({element.tag for element in root if element.tag not in _UNTOLD})
    if left:
        remarks += (f"Of the MJCF these are not part of a body and were not read: {', '.join(left)}.",)
    return made, drives, remarks


def _cleaned(element: ElementTree.Element, tags: tuple[str, ...], meshes: set[str] | None) -> ElementTree.Element:
    """Return a copy with these tags alone, without materials, and without geoms whose mesh or field is not read."""
    kept = ElementTree.Element(element.tag, {k: v for k, v in element.attrib.items() if k not in ("material", "mocap")})
    for child in element:
        lost = child.tag == "geom" and (
            child.get("type") in ("hfield", "sdf")
            or (meshes is not None and child.get("mesh") is not None and child.get("mesh") not in meshes)
        )
        if child.tag in tags and not lost:
            kept.append(_cleaned(child, tags, meshes))
    return kept


def _meshes(root: ElementTree.Element, made: ElementTree.Element, mesh: Mesh) -> set[str]:
    """Add the meshes that are read as assets and return their names."""
    asset, names = ElementTree.SubElement(made, "asset"), set()
    folder = next((v for e in root.findall("compiler") for k in ("meshdir", "assetdir") if (v := e.get(k))), "")
    for element in (e for part in root.findall("asset") for e in part.findall("mesh")):
        file = element.get("file", "")
        name = element.get("name") or Path(file).stem
        attributes = {k: v for k, v in element.attrib.items() if k in ("class", "scale", "refpos", "refquat", "vertex")}
        if file:
            given = mesh(f"{folder.rstrip('/')}/{file}" if folder else file)
            if given is None:
                continue
            attributes["file"] = given
        elif "vertex" not in attributes:
            continue
        ElementTree.SubElement(asset, "mesh", {"name": name, **attributes})
        names.add(name)
    return names


def _equalities(root: ElementTree.Element) -> tuple[str, ...]:
    remarks = []
    for element in (e for part in root.findall("equality") for e in part):
        if element.get("active") == "false":
            continue
        if element.tag in ("connect", "weld"):
            ends = [element.get(key) for key in ("body1", "body2", "site1", "site2") if element.get(key)]
            raise UnreadableFile(
                f"a <{element.tag}> of {' and '.join(map(str, ends)) or 'two bodies'} closes a loop; suchus takes "
                "trees: remove it, or make it inactive."
            )
        remarks.append(f"An equality <{element.tag}> was not taken: the joints that it ties are hinges of their own.")
    return tuple(remarks)


def _actuators(root: ElementTree.Element) -> tuple[dict[str, Drive], tuple[str, ...]]:
    """Return the drive of each hinge; where a file drives some hinges, the others are passive."""
    defaults = dict(_defaults(root))
    driven: dict[str, Drive] = {}
    remarks = []
    tendons = {e.get("name"): e for part in root.findall("tendon") for e in part}
    for element in (e for part in root.findall("actuator") for e in part):
        joint = element.get("joint") or element.get("jointinparent")
        given = {**defaults.get((element.get("class", "main"), element.tag), {}), **element.attrib}
        if joint:
            driven[joint] = Drive(torque=_torque(given), speed=None, passive=False)
        elif element.get("tendon") in tendons:
            over = [e.get("joint", "") for e in tendons[element.get("tendon")].iter("joint")]
            remarks.append(
                f"Actuator {element.get('name', element.tag)} pulls a tendon over {', '.join(over) or 'sites'}; this "
                "drive was not taken: these hinges are springs in the draft. Say it as [[cables]], with cord spacing "
                "and pulley, or give them servos."
            )
        else:
            remarks.append(f"Actuator {element.get('name', element.tag)} drives no joint and was not taken.")
    if not driven:
        return {}, tuple(remarks)
    others = {e.get("name", ""): Drive(torque=None, speed=None, passive=True) for e in root.iter("joint")}
    return {**others, **driven}, tuple(remarks)


def _defaults(root: ElementTree.Element) -> Iterator[tuple[tuple[str, str], Mapping[str, str]]]:
    """Yield the default attributes of each class and tag, those of the classes above it included."""

    def walk(
        element: ElementTree.Element, above: Mapping[str, Mapping[str, str]], name: str
    ) -> Iterator[tuple[tuple[str, str], Mapping[str, str]]]:
        own = {e.tag: {**above.get(e.tag, {}), **e.attrib} for e in element if e.tag != "default"}
        here = {**above, **own}
        for tag, attributes in here.items():
            yield (name, tag), attributes
        for child in element.findall("default"):
            yield from walk(child, here, child.get("class", ""))

    for element in root.findall("default"):
        yield from walk(element, {}, element.get("class", "main"))


def _torque(given: Mapping[str, str]) -> float | None:
    """Return the greatest torque that an actuator may give; None if the file does not say."""
    try:
        ends = [abs(float(word)) for word in given.get("forcerange", "").split()]
    except ValueError:
        raise UnreadableFile(f'forcerange="{given["forcerange"][:60]}" is not two numbers.') from None
    return max(ends) if len(ends) == 2 and 0 < max(ends) < float("inf") else None

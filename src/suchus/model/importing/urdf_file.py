"""What of a URDF describes its tree of hinges, checked, and written so that MuJoCo loads it whole."""

from collections import Counter
from collections.abc import Callable
from math import isfinite
from xml.etree import ElementTree

from suchus.errors import UnreadableFile
from suchus.model.export.urdf import MUJOCO
from suchus.model.importing.drives import Drive

Mesh = Callable[[str], str | None]
"""Takes the file that a mesh names; returns the name by which MuJoCo is given it, or None if it is not read."""
_TURNING = ("revolute", "continuous")
_OTHER = ("prismatic", "planar", "floating")


def clean_urdf(root: ElementTree.Element, mesh: Mesh) -> tuple[ElementTree.Element, dict[str, Drive], tuple[str, ...]]:
    """Return a URDF of links and joints alone, what drives each hinge, and sentences on what was left out.

    Raises:
        UnreadableFile: it has loops, joints that do not turn, or no links.
    """
    links, joints = root.findall("link"), root.findall("joint")
    if not links:
        raise UnreadableFile("the URDF has no <link>; a robot needs some.")
    _refuse_kinds(joints)
    _refuse_loops(links, joints)
    made = ElementTree.Element("robot", name="imported")
    compiler = {**MUJOCO, "balanceinertia": "true", "discardvisual": "true"}
    ElementTree.SubElement(ElementTree.SubElement(made, "mujoco"), "compiler", compiler)
    for link in links:
        _add_link(made, link, mesh)
    for joint in joints:
        kept = ElementTree.SubElement(made, "joint", {k: joint.get(k, "") for k in ("name", "type")})
        bounded = ("limit",) if joint.get("type") == "revolute" else ()  # MuJoCo before 4.0 bounds continuous ones too
        kept.extend(e for e in joint if e.tag in ("origin", "parent", "child", "axis", *bounded))
    turning = [joint for joint in joints if joint.get("type") in _TURNING]
    remarks = [
        f"Joint {joint.get('name')} follows {mimic.get('joint')} (mimic): it is a hinge of its own in the draft."
        for joint in turning
        if (mimic := joint.find("mimic")) is not None
    ]
    remarks.append("A URDF holds no cables, springs, rotor inertia or gains: what the draft has of them is a guess.")
    drives = {str(joint.get("name")): _drive(joint) for joint in turning}
    if drives and all(drive.torque == 0.0 for drive in drives.values()):
        drives = {name: Drive(torque=None, speed=drive.speed, passive=False) for name, drive in drives.items()}
    return made, drives, tuple(remarks)


def _refuse_kinds(joints: list[ElementTree.Element]) -> None:
    for joint in joints:
        kind, name = joint.get("type", ""), joint.get("name", "")
        if kind in _OTHER:
            raise UnreadableFile(
                f"joint {name!r} is {kind}; suchus takes hinges (revolute, continuous) and fixed joints: make it one "
                "of these, or remove what it carries."
            )
        if kind not in (*_TURNING, "fixed"):
            raise UnreadableFile(f"joint {name!r} is of type {kind!r}; revolute, continuous and fixed are allowed.")


def _refuse_loops(links: list[ElementTree.Element], joints: list[ElementTree.Element]) -> None:
    """Refuse what is no tree: a link with two parents, or links that carry each other."""
    names = {link.get("name") for link in links}
    parent: dict[str, str] = {}
    counted = Counter(_linked(joint, "child") for joint in joints)
    for joint in joints:
        child, above = _linked(joint, "child"), _linked(joint, "parent")
        for name in (child, above):
            if name not in names:
                raise UnreadableFile(f"joint {joint.get('name')!r} names link {name!r}, which is not there.")
        if counted[child] > 1:
            raise UnreadableFile(
                f"link {child!r} hangs on {counted[child]} joints, which makes a loop; suchus takes trees: open the "
                "loop at one of them."
            )
        parent[child] = above
    for link in parent:
        seen, now = {link}, link
        while now in parent:
            now = parent[now]
            if now in seen:
                raise UnreadableFile(f"link {link!r} carries itself, a loop of joints; suchus takes trees: open it.")
            seen.add(now)
    roots = [name for name in names if name not in parent]
    if len(roots) > 1:
        raise UnreadableFile(
            f"{len(roots)} links hang on no joint ({', '.join(sorted(map(str, roots))[:4])}); one root is needed: join "
            "them, or remove the others."
        )


def _linked(joint: ElementTree.Element, which: str) -> str:
    found = joint.find(which)
    return "" if found is None else found.get("link", "")


def _add_link(made: ElementTree.Element, link: ElementTree.Element, mesh: Mesh) -> None:
    kept = ElementTree.SubElement(made, "link", name=link.get("name", ""))
    kept.extend(e for e in link if e.tag == "inertial")
    shapes = link.findall("collision") or link.findall("visual")
    for shape in shapes:
        geometry = shape.find("geometry")
        named = None if geometry is None else geometry.find("mesh")
        if geometry is None or not len(geometry):
            continue
        if named is not None:
            given = mesh(named.get("filename", ""))
            if given is None:
                continue
            named.set("filename", given)
        part = ElementTree.SubElement(kept, "collision")
        part.extend(e for e in shape if e.tag in ("origin", "geometry"))


def _drive(joint: ElementTree.Element) -> Drive:
    limit = joint.find("limit")
    torque, speed = (_number(limit, key) for key in ("effort", "velocity"))
    return Drive(torque=torque, speed=speed, passive=torque == 0.0)


def _number(element: ElementTree.Element | None, key: str) -> float | None:
    if element is None or element.get(key) is None:
        return None
    try:
        value = float(element.get(key, ""))
    except ValueError:
        raise UnreadableFile(f"<limit {key}={element.get(key, '')[:40]!r}> is no number.") from None
    if not isfinite(value) or value < 0:
        raise UnreadableFile(f'<limit {key}="{value:g}"> makes no sense; a number from 0 on is allowed.')
    return value

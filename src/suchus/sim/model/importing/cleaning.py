"""The tree of hinges in a URDF or an MJCF: checked, and without elements that name files or generate bodies.

XML from outside is parsed without entities, within a size and a depth, or refused in one sentence.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from xml.etree import ElementTree
from xml.parsers import expat

from suchus.core.errors import UnreadableFile
from suchus.core.files import read_text
from suchus.core.printable import escaped, unprintable
from suchus.sim.model.export.urdf import MUJOCO
from suchus.sim.model.importing.meshes import Meshes, path_inside

MAX_ROBOT_FILE_SIZE = 16 * 2**20
"""Size of a file of a robot [byte]."""
_MAX_DEPTH, _MAX_ELEMENTS = 200, 200_000  # levels of nesting; elements


def parse(path: Path) -> ElementTree.Element:
    """Return the root element of an XML file; nothing that it names is opened, no entity is expanded.

    Raises:
        UnreadableFile: it is no ordinary file, too large, no XML, declares a document type, or nests too deeply.
    """
    text = read_text(path, MAX_ROBOT_FILE_SIZE)
    builder, parser = ElementTree.TreeBuilder(), expat.ParserCreate("utf-8")
    depth = count = 0

    def start(tag: str, attributes: dict[str, str]) -> None:
        """Begin an element; refuse too many elements, too deep ones, and those of a macro language."""
        nonlocal depth, count
        depth, count = depth + 1, count + 1
        if depth > _MAX_DEPTH:
            raise UnreadableFile(f"{path} nests more than {_MAX_DEPTH} elements; no robot needs so many.")
        if count > _MAX_ELEMENTS:
            raise UnreadableFile(f"{path} holds more than {_MAX_ELEMENTS} elements; no robot needs so many.")
        if ":" in tag:
            raise UnreadableFile(
                f"{path} holds <{tag[:40]}>, an element of a macro language; expand it first, as with "
                "`xacro robot.urdf.xacro > robot.urdf`."
            )
        for name in (tag, *attributes, *attributes.values()):
            character = unprintable(name, allow_lines=True)
            if character is not None:
                raise UnreadableFile(
                    f"{path} holds '{escaped(name)}' with the character {character}, which "
                    "steers a terminal or turns its writing round; letters, digits and signs are allowed: rename it."
                )
        builder.start(tag, attributes)

    def end(tag: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(tag)

    def doctype(*_: object) -> None:
        raise UnreadableFile(f"{path} declares a document type, in which entities could hide; remove <!DOCTYPE ...>.")

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.StartDoctypeDeclHandler = doctype
    try:
        parser.Parse(text.encode(), True)
    except expat.ExpatError as error:
        raise UnreadableFile(f"{path} is no XML: {error}.") from error
    return builder.close()


@dataclass(frozen=True, slots=True, kw_only=True)
class Drive:
    """Torque and speed of the drive of a hinge, where the file states them."""

    torque: float | None
    """Greatest torque [N m]; None if not said."""
    speed: float | None
    """Greatest speed [rad/s]; None if not said."""
    passive: bool
    """Whether nothing drives it."""
    kp: float | None = None
    """Proportional gain at the hinge [N m/rad]; None if not said."""
    kd: float | None = None
    """Derivative gain at the hinge [N m s/rad]; None if not said."""


_TURNING = ("revolute", "continuous")
_UNSUPPORTED_JOINTS = ("prismatic", "planar", "floating")


def clean_urdf(
    root: ElementTree.Element, meshes: Meshes
) -> tuple[ElementTree.Element, dict[str, Drive], tuple[str, ...]]:
    """Return a URDF of links and joints alone, the drive of each hinge, and remarks on omitted elements.

    Raises:
        UnreadableFile: it has loops, joints that do not turn, or no links.
    """
    links, joints = root.findall("link"), root.findall("joint")
    if not links:
        raise UnreadableFile("the URDF has no <link>; a robot needs some.")
    _refuse_duplicates(links, joints)
    links, joints, floating_remarks = _freed(links, joints)
    _refuse_kinds(joints)
    _refuse_loops(links, joints)
    clean_root = ElementTree.Element("robot", name="imported")
    compiler = {**MUJOCO, "discardvisual": "true"}
    ElementTree.SubElement(ElementTree.SubElement(clean_root, "mujoco"), "compiler", compiler)
    for link in links:
        _add_link(clean_root, link, meshes)
    for joint in joints:
        copy = ElementTree.SubElement(clean_root, "joint", {k: joint.get(k, "") for k in ("name", "type")})
        is_bounded = joint.get("type") == "revolute" and _has_range(joint)
        bounded = ("limit",) if is_bounded else ()  # MuJoCo before 4.0 bounds continuous ones too
        copy.extend(e for e in joint if e.tag in ("origin", "parent", "child", "axis", "dynamics", *bounded))
    turning = [joint for joint in joints if joint.get("type") in _TURNING]
    remarks = [
        f"Joint {joint.get('name')} follows {mimic.get('joint')} (mimic): it is a hinge of its own in the draft."
        for joint in turning
        if (mimic := joint.find("mimic")) is not None
    ]
    remarks += floating_remarks
    remarks.append("A URDF holds no cables, springs, rotor inertia or gains: what the draft has of them is a guess.")
    remarks += _remarks_on_zeros(turning)
    drives = {str(joint.get("name")): _drive(joint) for joint in turning}
    if drives and all(drive.torque == 0.0 for drive in drives.values()):
        drives = {name: Drive(torque=None, speed=drive.speed, passive=False) for name, drive in drives.items()}
    return clean_root, drives, tuple(remarks)


def _freed(
    links: list[ElementTree.Element], joints: list[ElementTree.Element]
) -> tuple[list[ElementTree.Element], list[ElementTree.Element], list[str]]:
    """Return links, joints and remarks without a floating joint to the world, since the root of a robot is free."""
    children = {_linked(joint, "child") for joint in joints}
    floating = [j for j in joints if j.get("type") == "floating" and _linked(j, "parent") not in children]
    if len(floating) != 1:
        return links, joints, []
    robot = {_linked(floating[0], "child")}
    robot_joints: list[ElementTree.Element] = []
    while next_joints := [j for j in joints if _linked(j, "parent") in robot and j not in robot_joints]:
        robot_joints += next_joints
        robot |= {_linked(joint, "child") for joint in next_joints}
    other_links = [link for link in links if link.get("name") not in robot]
    solid = [str(link.get("name")) for link in other_links if len(link)]
    remarks = [f"Beside the robot the file holds {', '.join(solid[:4])}, which was not taken."] if solid else []
    return [link for link in links if link not in other_links], robot_joints, remarks


def _refuse_duplicates(links: list[ElementTree.Element], joints: list[ElementTree.Element]) -> None:
    """Refuse two links or two joints of one name, by which a URDF refers to them."""
    for kind, elements in (("links", links), ("joints", joints)):
        counts = Counter(element.get("name", "") for element in elements)
        name, count = counts.most_common(1)[0] if counts else ("", 0)
        if count > 1:
            raise UnreadableFile(f"{count} {kind} are called {name[:60]!r}; each needs a name of its own.")


def _refuse_kinds(joints: list[ElementTree.Element]) -> None:
    """Refuse joints that are neither hinges nor fixed."""
    for joint in joints:
        kind, name = joint.get("type", ""), joint.get("name", "")
        if kind in _UNSUPPORTED_JOINTS:
            raise UnreadableFile(
                f"joint {name!r} is {kind}; suchus takes hinges (revolute, continuous) and fixed joints: make it one "
                "of these, or remove what it carries. A floating joint may carry the whole robot, and nothing else."
            )
        if kind not in (*_TURNING, "fixed"):
            raise UnreadableFile(f"joint {name!r} is of type {kind!r}; revolute, continuous and fixed are allowed.")


def _refuse_loops(links: list[ElementTree.Element], joints: list[ElementTree.Element]) -> None:
    """Refuse what is no tree: a link with two parents, or links that carry each other."""
    names = {link.get("name") for link in links}
    parent: dict[str, str] = {}
    parent_counts = Counter(_linked(joint, "child") for joint in joints)
    for joint in joints:
        child, parent_name = _linked(joint, "child"), _linked(joint, "parent")
        for name in (child, parent_name):
            if name not in names:
                raise UnreadableFile(f"joint {joint.get('name')!r} names link {name!r}, which is not there.")
        if parent_counts[child] > 1:
            raise UnreadableFile(
                f"link {child!r} hangs on {parent_counts[child]} joints, which makes a loop; suchus takes trees: open "
                "the loop at one of them."
            )
        parent[child] = parent_name
    for link in parent:
        visited, ancestor = {link}, link
        while ancestor in parent:
            ancestor = parent[ancestor]
            if ancestor in visited:
                raise UnreadableFile(f"link {link!r} carries itself, a loop of joints; suchus takes trees: open it.")
            visited.add(ancestor)
    roots = [name for name in names if name not in parent]
    if len(roots) > 1:
        raise UnreadableFile(
            f"{len(roots)} links hang on no joint ({', '.join(sorted(map(str, roots))[:4])}); one root is needed: join "
            "them, or remove the others."
        )


def _linked(joint: ElementTree.Element, end: str) -> str:
    element = joint.find(end)
    return "" if element is None else element.get("link", "")


def _add_link(clean_root: ElementTree.Element, link: ElementTree.Element, meshes: Meshes) -> None:
    """Add a link with its inertia and its collision shapes; meshes that are not read are noted."""
    copy = ElementTree.SubElement(clean_root, "link", name=link.get("name", ""))
    copy.extend(e for e in link if e.tag == "inertial")
    unread_file = ""
    for shape in link.findall("collision") or link.findall("visual"):
        geometry = shape.find("geometry")
        mesh = None if geometry is None else geometry.find("mesh")
        if geometry is None or not len(geometry):
            continue
        if mesh is not None:
            asset_name = meshes.asset_name(mesh.get("filename", ""))
            if asset_name is None:
                unread_file = mesh.get("filename", "")
                continue
            mesh.set("filename", asset_name)
        collision = ElementTree.SubElement(copy, "collision")
        collision.extend(e for e in shape if e.tag in ("origin", "geometry"))
    if unread_file and copy.find("collision") is None:
        meshes.shapeless_bodies[f"link {link.get('name', '')}"] = unread_file


def _drive(joint: ElementTree.Element) -> Drive:
    limit = joint.find("limit")
    torque, speed = (_number(limit, key) for key in ("effort", "velocity"))
    return Drive(torque=torque, speed=speed, passive=torque == 0.0)


def _remarks_on_zeros(joints: list[ElementTree.Element]) -> list[str]:
    """Return a sentence on limits that are zero, as an exporter writes them when nothing was filled in.

    A single effort of zero beside others says that nothing drives that joint, and is not such a limit.
    """
    names_of: dict[str, list[str]] = {"lower and upper": [], "effort": [], "velocity": []}
    for joint in joints:
        limit = joint.find("limit")
        name = joint.get("name", "")
        if joint.get("type") == "revolute" and not _has_range(joint):
            names_of["lower and upper"].append(name)
        for key in ("effort", "velocity"):
            if not _number(limit, key):
                names_of[key].append(name)
    if len(names_of["effort"]) < len(joints):
        names_of["effort"] = []
    guesses = {"lower and upper": "range", "effort": "torque", "velocity": "speed"}
    keys = [key for key, names in names_of.items() if names]
    if not keys:
        return []
    names = list(dict.fromkeys(name for key in keys for name in names_of[key]))
    joints_text = f"all {len(joints)} joints" if len(names) == len(joints) else ", ".join(names[:4])
    joints_text += f" and {len(names) - 4} more" if 4 < len(names) < len(joints) else ""
    verb = "is" if keys in (["effort"], ["velocity"]) else "are"
    guesses_text = ", ".join(guesses[key] for key in keys)
    return [
        f"{', '.join(keys)} of {joints_text} {verb} zero, equal or missing in the file, which was taken as not filled "
        f"in: {guesses_text} {'is a guess' if len(keys) == 1 else 'are guesses'}. A joint that does not turn is fixed."
    ]


def _has_range(joint: ElementTree.Element) -> bool:
    limit = joint.find("limit")
    return _angle_limit(limit, "lower") != _angle_limit(limit, "upper")


def _angle_limit(limit: ElementTree.Element | None, key: str) -> float:
    """Return a limit of angle [rad]; 0 where the file has none."""
    text = "" if limit is None else limit.get(key, "0")
    try:
        return float(text or 0.0)
    except ValueError:
        raise UnreadableFile(f"<limit {key}={text[:40]!r}> is no number.") from None


def _number(element: ElementTree.Element | None, key: str) -> float | None:
    """Return a number of a limit, None where the file has none; refuse negative and infinite ones."""
    if element is None or element.get(key) is None:
        return None
    try:
        value = float(element.get(key, ""))
    except ValueError:
        raise UnreadableFile(f"<limit {key}={element.get(key, '')[:40]!r}> is no number.") from None
    if not isfinite(value) or value < 0:
        raise UnreadableFile(f'<limit {key}="{value:g}"> makes no sense; a number from 0 on is allowed.')
    return value


_BODIES = ("replicate", "composite", "flexcomp", "attach")
_ACTUATOR_TAGS = (
    "general", "motor", "position", "velocity", "intvelocity", "damper", "dcmotor", "cylinder", "muscle", "adhesion"
)  # fmt: skip
GUESSED = "suchus_guess_"
"""Beginning of the name of a motor that stands for an actuator of which nothing is taken but that it drives."""
_UNTAKEN_ACTUATORS = ("damper", "cylinder", "muscle", "adhesion")
_BODY_TAGS = ("body", "joint", "freejoint", "geom", "inertial", "site", "frame")
_COMPILER = ("angle", "eulerseq", "autolimits", "coordinate", "inertiafromgeom", "inertiagrouprange", "settotalmass")
_UNTOLD = ("compiler", "option", "size", "visual", "statistic", "default", "asset", "worldbody", "actuator", "equality")
_FILES = 50  # included ones at most


def with_includes(root: ElementTree.Element, path: Path) -> ElementTree.Element:
    """Replace the includes of an MJCF by their content; only files in its own folder are opened, each once.

    Raises:
        UnreadableFile: an included file lies elsewhere, is included twice, or cannot be read, or all together nest too
            deeply.
    """
    home, opened_files = path.resolve().parent, [path.resolve()]

    def expand(element: ElementTree.Element, depth: int) -> None:
        """Replace the includes below an element by what the included files hold."""
        if depth > _MAX_DEPTH:
            raise UnreadableFile(f"{path.name} and what it includes nest more than {_MAX_DEPTH} elements.")
        for index, child in reversed(list(enumerate(element))):
            if child.tag != "include":
                expand(child, depth + 1)
                continue
            included_file = path_inside(home, child.get("file", ""))
            if included_file is None:
                raise UnreadableFile(
                    f"the MJCF includes {child.get('file', '')[:100]!r}, which lies outside its folder and is not "
                    "read; put it beside the file."
                )
            if included_file in opened_files or len(opened_files) > _FILES:
                raise UnreadableFile(f"the MJCF includes {included_file.name!r} twice, or includes too many files.")
            opened_files.append(included_file)
            included_root = parse(included_file)
            expand(included_root, depth)
            element[index : index + 1] = list(included_root)

    expand(root, 1)
    return root


def clean_mjcf(root: ElementTree.Element, meshes: Meshes) -> tuple[ElementTree.Element, tuple[str, ...]]:
    """Return an MJCF of bodies, joints, shapes and actuators of joints alone, and remarks on omitted elements.

    Raises:
        UnreadableFile: it has loops, makes bodies by rule, or has no bodies.
    """
    remarks = _equalities(root)
    actuators, actuator_remarks = _actuators(root)
    remarks += actuator_remarks
    clean_root = ElementTree.Element("mujoco", model="imported")
    compiler = {k: v for e in root.findall("compiler") for k, v in e.attrib.items() if k in _COMPILER}
    bounds = {key: MUJOCO[key] for key in ("boundmass", "boundinertia")}
    ElementTree.SubElement(clean_root, "compiler", {**compiler, **bounds})
    for element in root.findall("default"):
        clean_root.append(_cleaned(element, (*_BODY_TAGS, *_ACTUATOR_TAGS, "mesh", "default"), None))
    unread_meshes = _meshes(root, clean_root, meshes)
    worlds = root.findall("worldbody")
    if not any(world.find(".//body") is not None for world in worlds):
        raise UnreadableFile("the MJCF has no <body>; a robot needs some.")
    for world in worlds:
        for element in world.iter():
            if element.tag in _BODIES:
                raise UnreadableFile(
                    f"the MJCF makes bodies with <{element.tag}>; write them out first, as with mujoco.mj_saveLastXML."
                )
        clean_root.append(_cleaned(world, _BODY_TAGS, unread_meshes))
        meshes.shapeless_bodies |= _shapeless_bodies(world, unread_meshes)
    clean_root.append(actuators)
    unread_tags = sorted({element.tag for element in root if element.tag not in _UNTOLD})
    if unread_tags:
        remarks += (f"Of the MJCF these are not part of a body and were not read: {', '.join(unread_tags)}.",)
    return clean_root, remarks


def _cleaned(
    element: ElementTree.Element, tags: tuple[str, ...], unread_meshes: Mapping[str, str] | None
) -> ElementTree.Element:
    """Return a copy of an element that has children of some tags alone.

    Materials are left out, and geoms whose mesh or height field is not read.

    Args:
        element: the element.
        tags: tags of the children that are copied.
        unread_meshes: file of each mesh that is not read, by name.
    """
    copy = ElementTree.Element(element.tag, {k: v for k, v in element.attrib.items() if k not in ("material", "mocap")})
    for child in element:
        is_dropped = child.tag == "geom" and (
            child.get("type") in ("hfield", "sdf") or child.get("mesh") in (unread_meshes or ())
        )
        if child.tag in tags and not is_dropped:
            copy.append(_cleaned(child, tags, unread_meshes))
    return copy


def _shapeless_bodies(world: ElementTree.Element, unread_meshes: Mapping[str, str]) -> dict[str, str]:
    """Return the file of the unread mesh of each body that has no other shape, by body."""
    shapes = {f"body {body.get('name', '')}": [geom.get("mesh") for geom in body.findall("geom")]
              for body in world.iter("body")}  # fmt: skip
    return {
        body: unread_meshes[str(meshes[0])]
        for body, meshes in shapes.items()
        if meshes and all(mesh_name in unread_meshes for mesh_name in meshes)
    }


def _meshes(root: ElementTree.Element, clean_root: ElementTree.Element, meshes: Meshes) -> dict[str, str]:
    """Add the meshes that are read as assets; return the files of the others by name."""
    asset, unread_meshes = ElementTree.SubElement(clean_root, "asset"), {}
    folder = next((v for e in root.findall("compiler") for k in ("meshdir", "assetdir") if (v := e.get(k))), "")
    for element in (e for section in root.findall("asset") for e in section.findall("mesh")):
        file_name = element.get("file", "")
        file = f"{folder.rstrip('/')}/{file_name}" if folder and file_name else file_name
        name = element.get("name") or Path(file_name).stem
        attributes = {k: v for k, v in element.attrib.items() if k in ("class", "scale", "refpos", "refquat", "vertex")}
        if file_name or "vertex" not in attributes:
            asset_name = meshes.asset_name(file)
            if asset_name is None:
                unread_meshes[name] = file
                continue
            attributes["file"] = asset_name
        ElementTree.SubElement(asset, "mesh", {"name": name, **attributes})
    return unread_meshes


def _equalities(root: ElementTree.Element) -> tuple[str, ...]:
    """Return remarks on equalities that are not taken; refuse those that close a loop."""
    remarks = []
    for element in (e for section in root.findall("equality") for e in section):
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


def _actuators(root: ElementTree.Element) -> tuple[ElementTree.Element, tuple[str, ...]]:
    """Return the actuators that turn a joint, and a remark on each kind that is not taken.

    A hinge whose actuator is a muscle or a cylinder keeps a motor without limits in its place, so that it counts as
    driven.
    """
    joints = {e.get("name") for e in root.iter("joint")}
    actuators, tendons = ElementTree.Element("actuator"), dict[str, str]()
    untaken: dict[str, list[str]] = {"muscle": [], "cylinder": [], "damper": [], "other": []}
    pulled = _pulled_joints(root)
    for element in (e for section in root.findall("actuator") for e in section):
        joint, name = element.get("joint") or element.get("jointinparent"), element.get("name", element.tag)
        is_muscle = element.tag == "muscle" or "muscle" in (element.get("gaintype"), element.get("dyntype"))
        if joint and joint not in joints:
            raise UnreadableFile(f"actuator {name} names joint {joint[:60]!r}, which is not there.")
        if joint and (is_muscle or element.tag == "cylinder"):
            ElementTree.SubElement(
                actuators, "motor", name=f"{GUESSED}{len(actuators)}", joint=joint, ctrllimited="false",
                forcelimited="false",
            )  # fmt: skip
            untaken["muscle" if is_muscle else "cylinder"].append(joint)
        elif joint and element.tag in _ACTUATOR_TAGS and element.tag not in _UNTAKEN_ACTUATORS:
            actuators.append(ElementTree.Element(element.tag, element.attrib))
        elif joint and element.tag == "damper":
            untaken["damper"].append(joint)
        elif element.get("tendon") in pulled:
            tendons[name] = ", ".join(pulled[str(element.get("tendon"))]) or "sites"
        else:
            untaken["other"].append(name)
    sentences = {
        "muscle": "Muscles are not taken: the draft has servos of their size at {}.",
        "cylinder": "Cylinders are not taken: the draft has servos of their size at {}.",
        "damper": "Dampers brake a joint and drive none; those of {} were not taken.",
        "other": "These actuators drive no joint and were not taken: {}.",
    }
    replacement = "springs" if len(actuators) else "guessed servos"
    tendon_remarks = [
        f"Actuator {name} pulls a tendon over {places}; this drive was not taken: these hinges are {replacement} in "
        "the draft. Say it as [[cables]], with cord spacing and pulley, or give them servos."
        for name, places in tendons.items()
    ]
    remarks = [sentences[kind].format(listed(names)) for kind, names in untaken.items() if names]
    return actuators, (*tendon_remarks, *remarks)


def _pulled_joints(root: ElementTree.Element) -> dict[str, list[str]]:
    """Return the joints along each tendon of an MJCF, by the tendon's name; a tendon through sites has none."""
    return {
        e.get("name", ""): [joint.get("joint", "") for joint in e.iter("joint")]
        for section in root.findall("tendon")
        for e in section
    }


def listed(names: Sequence[str]) -> str:
    """Return the first names of several, and how many more there are; a name that repeats counts once."""
    names = tuple(dict.fromkeys(names))
    return f"{', '.join(names[:4])}{f' and {len(names) - 4} more' if len(names) > 4 else ''}"


def with_passive(root: ElementTree.Element, drives: dict[str, Drive]) -> dict[str, Drive]:
    """Return the drives of all joints of an MJCF: where it drives some hinges, the others are passive."""
    if not drives:
        return {}
    passive_drives = {e.get("name", ""): Drive(torque=None, speed=None, passive=True) for e in root.iter("joint")}
    return {**passive_drives, **drives}

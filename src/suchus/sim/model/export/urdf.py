"""URDF: links, joints, limits and shapes; what it cannot say is listed in ``UNSAID``."""

from collections.abc import Mapping, Sequence
from typing import Any
from xml.etree import ElementTree

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from suchus.robot.design import Cable, Robot, Spring, layout
from suchus.sim.model.build import IMU, compile_model, sites
from suchus.sim.model.export.mjcf import numbers

_CABLES, _SPRINGS = "The cable.", "Springs"
_SPRING_TEXT = "{name} {stiffness:g} N m/rad"


def pulls(cable: Cable) -> str:
    """Return in words what pulls a cable."""
    return "one servo turns a pulley" if cable.linear is None else "one linear actuator moves two cords"


def fill_texts(texts: Sequence[str], robot: Robot, **format_values: object) -> tuple[str, ...]:
    """Return sentences with the robot's numbers in their braces; those about cables or springs only if it has some.

    Args:
        texts: what a format leaves out, and what to do about it.
        robot: the design.
        format_values: further values, of the format.
    """
    robot_layout, contact = layout(robot), robot.contact
    cables = robot_layout.robot.cables
    springs = [
        _SPRING_TEXT.format(name=name, stiffness=hinge.drive.stiffness)
        for body in robot_layout.bodies
        for hinge, name, _ in body.hinges
        if isinstance(hinge.drive, Spring)
    ]
    values = {
        "cables": cables[0].joints if cables else 0,
        "first": cables[0].hinges[0] if cables else "",
        "last": cables[0].hinges[-1] if cables else "",
        "pulls": pulls(cables[0]) if cables else "",
        "springs": ", ".join(springs),
        "foot": contact.foot_friction,
        "skin": contact.skin_friction,
        "root": robot_layout.robot.root,
    }
    fitting = [
        text
        for text in texts
        if (cables or not text.startswith(_CABLES)) and (springs or not text.startswith(_SPRINGS))
    ]
    return tuple(text.format(**values, **format_values) for text in fitting)


BALL = "meshes/ball.obj"
"""A ball of radius 1, which ellipsoids stretch; URDF has none of its own."""
UNSAID = (
    "The cable. In the model {pulls} and a tendon bends all {cables} tail joints ({first} to {last}) "
    "at once; here each is a joint of its own, its effort limit the torque that the cable can give it. "
    "Turn them all by the same angle: the bend of the tail over {cables}.",
    "Springs: {springs}. Where no cable bends them their effort limit is 0, since nothing drives them. Add the springs "
    "in your simulator, or hold these joints at zero.",
    "Servos. They are position servos (PID) with a slew limit; only the limits of torque and speed are here. The gains "
    "are in robot.toml.",
    "Rotor inertia of the servos (armature), in robot.toml.",
    "Contact: the friction of feet ({foot:g}) and skin ({skin:g}), and that the body does not touch itself: leave "
    "self-collision off.",
    "Joints in one point. All but the last of their links have no mass; such a link is named after the joint that "
    "carries it.",
    "Capsules are a cylinder and two balls; ellipsoids are a faceted ball ("
    + BALL
    + "), up to {faceted:.2g} % inside.",
    "Sensors, and the free joint: the root link is {root}.",
)
MUJOCO: Mapping[str, str] = {
    "fusestatic": "false",
    "strippath": "false",
    "boundmass": "1e-10",
    "boundinertia": "1e-14",
}
"""What MuJoCo needs to know; others skip it: keep the root and the frames as bodies, and where the ball lies; links
between joints in one point have no mass, and MuJoCo wants some [kg, kg m2]."""
_RINGS, _SECTORS = 24, 48
_FREE_SPEED = 100.0  # [rad/s]; a limit must be given; nothing on the robot turns so fast


def urdf(robot: Robot) -> str:
    """Return a robot as URDF, with the joints and frames of the MuJoCo model by the same names, in full precision.

    Args:
        robot: the design.
    """
    model = compile_model(robot)
    root = ElementTree.Element("robot", name=robot.name)
    ElementTree.SubElement(ElementTree.SubElement(root, "mujoco"), "compiler", dict(MUJOCO))
    for body in range(1, model.nbody):
        _add_body(root, model, body, robot)
    for site in (*sites(robot), IMU):
        site_view = model.site(site)
        ElementTree.SubElement(root, "link", name=site)
        parent = model.body(int(site_view.bodyid[0])).name
        joint = _joint(root, f"{site}_fixed", "fixed", parent, site)
        _origin(joint, site_view.pos, site_view.quat)
    ElementTree.indent(root)
    return '<?xml version="1.0"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def unsaid(robot: Robot) -> tuple[str, ...]:
    """Return what the URDF of a robot leaves out, and what to do about it."""
    return fill_texts(UNSAID, robot, faceted=100 * (1 - np.cos(np.pi / _SECTORS)))


def ball() -> str:
    """Return a ball of radius 1 as a Wavefront OBJ text: corners on the sphere, triangles facing outward."""
    corners = [(0.0, 0.0, 1.0)]
    for polar in np.pi * np.arange(1, _RINGS) / _RINGS:
        for turn in 2 * np.pi * np.arange(_SECTORS) / _SECTORS:
            corners.append((np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)))
    corners.append((0.0, 0.0, -1.0))

    def corner_index(ring: int, sector: int) -> int:
        if ring in (0, _RINGS):
            return 1 if ring == 0 else len(corners)
        return 2 + (ring - 1) * _SECTORS + sector % _SECTORS

    lines = ["# a ball of radius 1, written by suchus", *(f"v {x:.9f} {y:.9f} {z:.9f}" for x, y, z in corners)]
    for ring in range(_RINGS):
        for sector in range(_SECTORS):
            a, b = corner_index(ring, sector), corner_index(ring, sector + 1)
            c, d = corner_index(ring + 1, sector), corner_index(ring + 1, sector + 1)
            lines += [f"f {a} {c} {d}"] if ring < _RINGS - 1 else []
            lines += [f"f {a} {d} {b}"] if 0 < ring < _RINGS - 1 else []
            lines += [f"f {a} {c} {b}"] if ring == _RINGS - 1 else []
    return "\n".join(lines) + "\n"


def _add_body(root: ElementTree.Element, model: Any, body: int, robot: Robot) -> None:
    """Add a body's link, and before it the joints that carry it: all but the last end in a massless link."""
    name = model.body(body).name
    parent = model.body(int(model.body_parentid[body])).name
    first_joint, count = int(model.body_jntadr[body]), int(model.body_jntnum[body])
    hinges = [j for j in range(first_joint, first_joint + count) if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE]
    for number, hinge in enumerate(hinges):
        label = model.joint(hinge).name
        child = name if number == len(hinges) - 1 else f"{label}_link"
        if child != name:
            ElementTree.SubElement(root, "link", name=child)
        kind = "revolute" if model.jnt_limited[hinge] else "continuous"
        joint = _joint(root, label, kind, parent, child)
        pose = (model.body_pos[body], model.body_quat[body]) if number == 0 else (np.zeros(3), np.array([1.0, 0, 0, 0]))
        _origin(joint, *pose)
        _turn(joint, model, hinge, robot)
        parent = child
    if body > 1 and not hinges:
        _origin(_joint(root, f"{name}_fixed", "fixed", parent, name), model.body_pos[body], model.body_quat[body])
    link = ElementTree.SubElement(root, "link", name=name)
    _inertial(link, model, body)
    for geom in range(int(model.body_geomadr[body]), int(model.body_geomadr[body] + model.body_geomnum[body])):
        _shape(link, model, geom)


def _joint(root: ElementTree.Element, name: str, kind: str, parent: str, child: str) -> ElementTree.Element:
    joint = ElementTree.SubElement(root, "joint", name=name, type=kind)
    ElementTree.SubElement(joint, "parent", link=parent)
    ElementTree.SubElement(joint, "child", link=child)
    return joint


def _turn(joint: ElementTree.Element, model: Any, hinge: int, robot: Robot) -> None:
    """Say about what axis, how far, with what friction, and within what limits a hinge turns."""
    name = model.joint(hinge).name
    dof = int(model.jnt_dofadr[hinge])
    ElementTree.SubElement(joint, "axis", xyz=numbers(model.jnt_axis[hinge]))
    robot_layout = layout(robot)
    cables = [cable for cable in robot_layout.robot.cables if name in cable.hinges]
    if name in robot_layout.servos:
        servo = robot.servo(name)
        effort, speed = servo.torque, servo.speed
    elif cables:
        cable = cables[0]
        effort, speed = cable.turning.torque * cable.cord_spacing / 2 / cable.pulley, cable.turning.speed
    else:
        effort, speed = 0.0, _FREE_SPEED
    lower_limit, upper_limit = model.jnt_range[hinge]
    limit = {"lower": lower_limit, "upper": upper_limit} if model.jnt_limited[hinge] else {}
    limit |= {"effort": effort, "velocity": speed}
    ElementTree.SubElement(joint, "limit", {k: numbers([v]) for k, v in limit.items()})
    rubbing = {"damping": model.dof_damping[dof], "friction": model.dof_frictionloss[dof]}
    ElementTree.SubElement(joint, "dynamics", {k: numbers([v]) for k, v in rubbing.items()})


def _inertial(link: ElementTree.Element, model: Any, body: int) -> None:
    """Add mass, centre of mass and principal moments of a body to its link."""
    inertial = ElementTree.SubElement(link, "inertial")
    _origin(inertial, model.body_ipos[body], model.body_iquat[body])
    ElementTree.SubElement(inertial, "mass", value=numbers([model.body_mass[body]]))
    xx, yy, zz = model.body_inertia[body]
    moments = {"ixx": xx, "ixy": 0.0, "ixz": 0.0, "iyy": yy, "iyz": 0.0, "izz": zz}
    ElementTree.SubElement(inertial, "inertia", {k: numbers([v]) for k, v in moments.items()})


def _shape(link: ElementTree.Element, model: Any, geom: int) -> None:
    """Add a geom to its link, as visual and as collision shape."""
    kinds = mujoco.mjtGeom
    kind, size, centre = model.geom_type[geom], model.geom_size[geom], model.geom_pos[geom]
    quat, colour = model.geom_quat[geom], model.geom_rgba[geom]
    pieces: list[tuple[str, dict[str, str], np.ndarray]]
    if kind == kinds.mjGEOM_SPHERE:
        pieces = [("sphere", {"radius": numbers([size[0]])}, centre)]
    elif kind == kinds.mjGEOM_ELLIPSOID:
        pieces = [("mesh", {"filename": BALL, "scale": numbers(size)}, centre)]
    else:
        end = _rotation(quat).apply([0.0, 0.0, size[1]])
        rod = {"radius": numbers([size[0]]), "length": numbers([2 * size[1]])}
        cap = {"radius": numbers([size[0]])}
        pieces = [("cylinder", rod, centre), ("sphere", cap, centre - end), ("sphere", cap, centre + end)]
    shade = " ".join(f"{c:.3g}" for c in colour)
    for purpose in ("visual", "collision"):
        for tag, attributes, position in pieces:
            element = ElementTree.SubElement(link, purpose)
            _origin(element, position, quat)
            ElementTree.SubElement(ElementTree.SubElement(element, "geometry"), tag, attributes)
            if purpose == "visual":
                material = ElementTree.SubElement(element, "material", name=f"colour_{shade.replace(' ', '_')}")
                ElementTree.SubElement(material, "color", rgba=shade)


def _origin(element: ElementTree.Element, position: np.ndarray, quat: np.ndarray) -> None:
    ElementTree.SubElement(element, "origin", xyz=numbers(position), rpy=numbers(_roll_pitch_yaw(quat)))


def _roll_pitch_yaw(quat: np.ndarray) -> tuple[float, float, float]:
    """Return the angles about the fixed axes x, y, z; where x and z fall together, all of the turn is about z [rad]."""
    turn = _rotation(quat).as_matrix()
    level = np.hypot(turn[0, 0], turn[1, 0])
    pitch = np.arctan2(-turn[2, 0], level)
    if level < 1e-9:
        return 0.0, pitch, np.arctan2(-turn[0, 1], turn[1, 1])
    return np.arctan2(turn[2, 1], turn[2, 2]), pitch, np.arctan2(turn[1, 0], turn[0, 0])


def _rotation(quat: np.ndarray) -> Rotation:
    return Rotation.from_quat(quat, scalar_first=True)

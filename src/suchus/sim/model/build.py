"""A whole model: ground, bodies with hinges, shapes and sites, servos, sensors; and a robot put in a posture there."""

from collections.abc import Sequence
from functools import lru_cache
from math import pi
from typing import Any

import mujoco
import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.core.rotation import from_axis_angle
from suchus.robot.design import GRAVITY, Contact, Hinge, Layout, LimbPlace, Robot, Rod, Segment, Spring, layout
from suchus.robot.design.body import servos_of
from suchus.robot.design.ground import HALF_WIDTH, REACH, Bumps, Relief, Step, Stone, field
from suchus.robot.design.pieces import foam_centres, masses
from suchus.robot.design.segment import Point, combine_inertias
from suchus.sim.model.actuators import add_servo, warms

TIMESTEP = 0.002  # [s]; of the article's robot; 0.5 to 8 ms were measured to give the same displacement within 1 %


def build(robot: Robot, *, timestep: float = TIMESTEP, relief: Relief | None = None) -> Any:
    """Write a robot on the ground as a ``mujoco.MjSpec``.

    World: x forward, y left, z up; the free joint carries the root, in a crocodile the pelvis, the spine's frame 0.

    Args:
        robot: the design.
        timestep: time step of the physics [s].
        relief: what stands up from even ground.

    Returns:
        The ``mujoco.MjSpec``, ready for ``compile()`` or for further edits.
    """
    robot_layout = layout(robot)
    spec = mujoco.MjSpec()
    spec.modelname = robot.name
    spec.compiler.degree = False
    _set_options(spec, timestep)
    add_ground(spec, relief)
    root = spec.worldbody.add_body(name=robot_layout.robot.root, pos=[0, 0, 0.2])
    root.add_freejoint(name="root")
    add_bodies(root, robot_layout)
    add_foam(spec, robot_layout)
    state_inertia(spec, robot_layout)
    lay_cables(spec, robot_layout.robot)
    servos = servos_of(robot_layout.robot)
    for number, name in enumerate(robot_layout.servos):
        add_servo(spec, number, name, servos[name], robot_layout)
    _add_sensors(spec, robot_layout)
    return spec


def compile_model(robot: Robot, timestep: float = TIMESTEP, relief: Relief | None = None) -> Any:
    """Compile a robot on its ground; the same values give the same ``mujoco.MjModel`` again: copy it before an edit.

    Raises:
        InvalidDesign: MuJoCo cannot compile it.
    """
    return _compiled(robot, timestep, relief)


@lru_cache(maxsize=64)
def _compiled(robot: Robot, timestep: float, relief: Relief | None) -> Any:
    """Compile once, whether the caller named what is the default or not."""
    try:
        return build(robot, timestep=timestep, relief=relief).compile()
    except ValueError as error:
        raise InvalidDesign(f"robot {robot.name!r} does not compile: {error}") from error


def topology(robot: Robot) -> tuple[object, ...]:
    """Return what two robots must share to run in one batch: all that decides the sizes of states and sensors.

    That is every body with its parent and its hinges, which of them are free of limits or springs, the servos, and
    which of them have integral action or warm up, and so a state of its own.
    """
    robot_layout = layout(robot)
    bodies = tuple((body.name, body.parent, tuple(name for _, name, _ in body.hinges)) for body in robot_layout.bodies)
    servos = servos_of(robot)
    states = tuple((servos[name].ki > 0, warms(servos[name])) for name in robot_layout.servos)
    shapes = tuple(len(segment.shapes) for segment in robot_layout.robot.axis)
    foam = () if robot_layout.robot.hull is None else tuple(piece.body for piece in robot_layout.robot.hull.foam)
    return bodies, foam, robot_layout.servos, shapes, tuple(cable.hinges for cable in robot_layout.robot.cables), states


def joint_addresses(model: Any, names: Sequence[str]) -> list[int]:
    """Return where the angles of named hinges stand in ``qpos``: MuJoCo orders joints by body, depth first."""
    return [int(model.joint(name).qposadr[0]) for name in names]


def _set_options(spec: Any, timestep: float) -> None:
    """Set time step, gravity, integrator and contact solver of a model."""
    option = spec.option
    option.timestep = timestep
    option.gravity = [0.0, 0.0, -GRAVITY]
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.impratio = 10.0
    option.jacobian = mujoco.mjtJacobian.mjJAC_SPARSE  # 1.6 to 1.8 times faster here than dense
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET  # divergence ends a run, it does not restart it


def _add_sensors(spec: Any, robot_layout: Layout) -> None:
    """Add the sensors in the order of ``sensor_names``."""
    kind, object_types = mujoco.mjtSensor, mujoco.mjtObj
    for suffix, sensor in (
        ("position", kind.mjSENS_ACTUATORPOS),
        ("velocity", kind.mjSENS_ACTUATORVEL),
        ("torque", kind.mjSENS_ACTUATORFRC),
    ):
        for servo in robot_layout.servos:
            spec.add_sensor(name=f"{servo}_{suffix}", type=sensor, objtype=object_types.mjOBJ_ACTUATOR, objname=servo)
    for limb in robot_layout.limb_names:
        _add_force(spec, f"{limb}_force", object_types.mjOBJ_GEOM, f"{limb}_foot")
    for limb_place in robot_layout.limbs:
        hip = robot_layout.bodies[limb_place.tip - len(limb_place.girdle.limb.links) + 1].name
        _add_force(spec, f"{limb_place.name}_limb_force", object_types.mjOBJ_XBODY, hip)
    for body in robot_layout.trunk:
        _add_force(spec, f"{body}_force", object_types.mjOBJ_BODY, body)
    for body in robot_layout.tail[:1]:
        _add_force(spec, "tail_force", object_types.mjOBJ_XBODY, body)
    spec.add_sensor(name="imu_orientation", type=kind.mjSENS_FRAMEQUAT, objtype=object_types.mjOBJ_SITE, objname="imu")
    spec.add_sensor(name="imu_gyroscope", type=kind.mjSENS_GYRO, objtype=object_types.mjOBJ_SITE, objname="imu")
    spec.add_sensor(
        name="imu_accelerometer", type=kind.mjSENS_ACCELEROMETER, objtype=object_types.mjOBJ_SITE, objname="imu"
    )
    spec.add_sensor(
        name="centre_of_mass",
        type=kind.mjSENS_SUBTREECOM,
        objtype=object_types.mjOBJ_BODY,
        objname=robot_layout.robot.root,
    )
    spec.add_sensor(
        name="angular_momentum",
        type=kind.mjSENS_SUBTREEANGMOM,
        objtype=object_types.mjOBJ_BODY,
        objname=robot_layout.robot.root,
    )
    for site in sites(robot_layout.robot):
        spec.add_sensor(
            name=f"{site}_position", type=kind.mjSENS_FRAMEPOS, objtype=object_types.mjOBJ_SITE, objname=site
        )
    for limb in robot_layout.limb_names:
        spec.add_sensor(
            name=f"{limb}_foot_orientation",
            type=kind.mjSENS_FRAMEQUAT,
            objtype=object_types.mjOBJ_SITE,
            objname=f"{limb}_foot",
        )


def _add_force(spec: Any, name: str, object_type: Any, touching: str) -> None:
    """Add a sensor of the net contact force of a part on the ground, in the world frame.

    Args:
        spec: MuJoCo specification of the model.
        name: name of the sensor.
        object_type: type of the part: a geom, a body, or an x-body, which stands for its whole subtree.
        touching: name of the part.
    """
    force, net, count = 1 << int(mujoco.mjtConDataField.mjCONDATA_FORCE), 3, 1
    spec.add_sensor(
        name=name,
        type=mujoco.mjtSensor.mjSENS_CONTACT,
        objtype=object_type,
        objname=touching,
        intprm=[force, net, count],
    )


SNOUT, TAIL_TIP, IMU = "snout", "tail_tip", "imu"
"""Sites that every model carries."""


def sites(robot: Robot) -> tuple[str, ...]:
    """Return the points whose world positions are sensed: the feet's centres, the snout's tip, the tail's tip."""
    return (*(f"{limb}_foot" for limb in layout(robot).limb_names), SNOUT, TAIL_TIP)


def force_sensors(robot: Robot) -> tuple[str, ...]:
    """Return the sensors of contact forces: feet, whole limbs, bodies of the trunk from the root forward, the tail.

    They stand side by side in the model's readings. Whole limbs have their feet among them: limbs, trunk and tail are
    all that can touch the ground.
    """
    robot_layout = layout(robot)
    return (
        *(f"{limb}_force" for limb in robot_layout.limb_names),
        *(f"{limb}_limb_force" for limb in robot_layout.limb_names),
        *(f"{body}_force" for body in robot_layout.trunk),
        *(("tail_force",) if robot_layout.tail else ()),
    )


def sensor_names(robot: Robot) -> tuple[str, ...]:
    """Return every sensor, in the order in which the model lists them."""
    servos, limbs = layout(robot).servos, layout(robot).limb_names
    return (
        *(f"{s}_position" for s in servos),
        *(f"{s}_velocity" for s in servos),
        *(f"{s}_torque" for s in servos),
        *force_sensors(robot),
        "imu_orientation",
        "imu_gyroscope",
        "imu_accelerometer",
        "centre_of_mass",
        "angular_momentum",
        *(f"{site}_position" for site in sites(robot)),
        *(f"{limb}_foot_orientation" for limb in limbs),
    )


FOOT_COLOUR = (0.16, 0.20, 0.18, 1.0)
SKIN_COLOUR = (0.36, 0.46, 0.30, 1.0)
_IMPEDANCE = (0.9, 0.95, 0.5, 2.0)  # MuJoCo's defaults of solimp but for its width


def sole(body: Any, name: str, pos: list[float], radius: float, mass: float, contact: Contact) -> None:
    """Add a spherical foot."""
    geom = body.add_geom(name=name, type=mujoco.mjtGeom.mjGEOM_SPHERE, pos=pos, size=[radius, 0, 0], mass=mass)
    _touches(geom, contact.foot_friction, contact, 4, FOOT_COLOUR)


def skin(
    body: Any, name: str, start: list[float], end: list[float], radius: float, mass: float, contact: Contact
) -> None:
    """Add a capsule of skin from ``start`` to ``end``.

    Args:
        body: body that carries the capsule.
        name: name of the geom.
        start: centre of one end in the body's frame [m].
        end: centre of the other end [m].
        radius: [m].
        mass: [kg].
        contact: friction and stiffness of the skin.
    """
    geom = body.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_CAPSULE,
        fromto=[*start, *end],
        size=[radius, 0, 0],
        mass=mass,
    )
    _touches(geom, contact.skin_friction, contact, 3, SKIN_COLOUR)


def shell(
    body: Any, name: str, pos: list[float], half: tuple[float, float, float], mass: float, contact: Contact
) -> None:
    """Add an ellipsoid of skin with half axes ``half``."""
    geom = body.add_geom(name=name, type=mujoco.mjtGeom.mjGEOM_ELLIPSOID, pos=pos, size=list(half), mass=mass)
    _touches(geom, contact.skin_friction, contact, 3, SKIN_COLOUR)


def _touches(geom: Any, friction: float, contact: Contact, dimensions: int, colour: tuple[float, ...]) -> None:
    """Give a geom its friction, its contact stiffness and its colour; it touches the ground alone.

    Args:
        geom: the shape.
        friction: sliding friction coefficient [-].
        contact: stiffness, torsional and rolling friction.
        dimensions: dimensions of the contact, MuJoCo's ``condim`` [-].
        colour: red, green, blue and opacity, 0 to 1.
    """
    # MuJoCo takes the maximum of two frictions at equal priority, so the robot's surfaces take precedence.
    geom.priority = 1
    geom.friction = [friction, contact.torsion, contact.rolling]
    geom.condim = dimensions
    geom.solref = [contact.time_constant, 1.0]
    geom.solimp = [*_IMPEDANCE[:2], contact.depth, *_IMPEDANCE[2:]]
    geom.contype, geom.conaffinity = 0, 1  # the ground only: no self-collision
    geom.fluid_ellipsoid = 1  # how a fluid would act, where there is one
    geom.rgba = list(colour)


_SITE = 0.002  # [m]; as they are drawn
_MIN_FOAM_MASS = 1e-9  # [kg] of foam; less than MuJoCo takes for a mass


def add_bodies(root: Any, robot_layout: Layout) -> None:
    """Give the root its shape and hang all other bodies on it.

    Args:
        root: the ``MjsBody`` that carries the free joint.
        robot_layout: the layout of the robot.
    """
    robot = robot_layout.robot
    segments = {segment.name: segment for segment in robot.axis}
    links = {
        limb.tip - i: (limb, len(limb.girdle.limb.links) - 1 - i)
        for limb in robot_layout.limbs
        for i in range(len(limb.girdle.limb.links))
    }
    body_specs: list[Any] = []
    for number, body in enumerate(robot_layout.bodies):
        body_spec = root if body.parent < 0 else body_specs[body.parent].add_body(name=body.name, pos=list(body.offset))
        body_specs.append(body_spec)
        for hinge, name, axis in body.hinges:
            _add_hinge(body_spec, hinge, name, list(axis))
        if number in links:
            _add_link(body_spec, *links[number], robot.contact)
        else:
            _add_segment(body_spec, segments[body.name], body.shift, robot)


def _add_hinge(body: Any, hinge: Hinge, name: str, axis: list[float]) -> None:
    """Add a hinge with its range and with armature, friction and damping of its servo or spring."""
    attributes: dict[str, Any] = {"name": name, "type": mujoco.mjtJoint.mjJNT_HINGE, "axis": axis}
    if hinge.range is not None:
        attributes |= {"range": list(hinge.range), "limited": mujoco.mjtLimited.mjLIMITED_TRUE}
    servo = hinge.servo
    if servo is not None:
        attributes |= {"armature": servo.armature, "frictionloss": servo.friction, "damping": servo.damping}
    elif isinstance(hinge.drive, Spring):
        spring = hinge.drive
        attributes |= {"stiffness": spring.stiffness, "damping": spring.damping, "armature": spring.armature}
    body.add_joint(**attributes)


def _add_segment(body: Any, segment: Segment, shift: float, robot: Robot) -> None:
    """Add the shapes of a segment, moved forward by ``shift`` [m], and the sites that it carries."""
    for shape in segment.shapes:
        if isinstance(shape, Rod):
            start, end = _shifted(shape.start, shift), _shifted(shape.end, shift)
            skin(body, shape.name, start, end, shape.radius, shape.mass, robot.contact)
        else:
            shell(body, shape.name, _shifted(shape.at, shift), shape.half, shape.mass, robot.contact)
    if segment.name == robot.root:
        body.add_site(name=IMU, pos=[shift, 0, 0], size=[2 * _SITE, 0, 0])
    if segment is robot.axis[0]:
        body.add_site(name=SNOUT, pos=[shift + segment.front, 0, 0], size=[_SITE, 0, 0])
    if segment is robot.axis[-1]:
        body.add_site(name=TAIL_TIP, pos=[shift - segment.rear, 0, 0], size=[_SITE, 0, 0])


def _shifted(point: Point, shift: float) -> list[float]:
    return [point[0] + shift, point[1], point[2]]


def _add_link(body: Any, limb: LimbPlace, number: int, contact: Contact) -> None:
    """Add a link of a limb; the last one carries the foot."""
    design = limb.girdle.limb
    link = design.links[number]
    end = [link.end[0], limb.side * link.end[1], link.end[2]]
    skin(body, f"{limb.name}_{link.name}", [0, 0, 0], end, link.radius, link.mass, contact)
    if number == len(design.links) - 1:
        sole(body, f"{limb.name}_foot", end, design.foot.radius, design.foot.mass, contact)
        body.add_site(name=f"{limb.name}_foot", pos=end, size=[_SITE, 0, 0])


def add_foam(spec: Any, robot_layout: Layout) -> None:
    """Add the mass of the robot's foam: balls of its volume around its centres, which touch nothing."""
    hull = robot_layout.robot.hull
    if hull is None:
        return
    centres = foam_centres(robot_layout.robot)
    for foam in hull.foam:
        if foam.volume * hull.density < _MIN_FOAM_MASS:
            continue
        spec.body(foam.body).add_geom(
            name=f"{foam.body}_foam",
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=[(3 * foam.volume / (4 * pi)) ** (1 / 3), 0, 0],
            pos=list(centres[foam.body]),
            mass=hull.density * foam.volume,
            contype=0,
            conaffinity=0,
            priority=1,
            group=4,
        )


def state_inertia(spec: Any, robot_layout: Layout) -> None:
    """Give the bodies whose design states where their mass lies that mass, with their foam, in the shapes' place."""
    foams = (
        {} if robot_layout.robot.hull is None else {piece.body: piece.volume for piece in robot_layout.robot.hull.foam}
    )
    density = 0.0 if robot_layout.robot.hull is None else robot_layout.robot.hull.density
    shape_masses = masses(robot_layout.robot)
    for body in (candidate for candidate in robot_layout.bodies if candidate.inertia is not None):
        assert body.inertia is not None
        volume = foams.get(body.name, 0.0)
        parts = [(shape_masses[body.name], np.array(body.inertia.centre), body.inertia.tensor)]
        if volume * density >= _MIN_FOAM_MASS:
            ball = 0.4 * density * volume * (3 * volume / (4 * pi)) ** (2 / 3)
            parts.append((density * volume, np.array(foam_centres(robot_layout.robot)[body.name]), ball * np.eye(3)))
        mass, centre, tensor = combine_inertias(parts)
        body_spec = spec.body(body.name)
        body_spec.mass, body_spec.ipos, body_spec.explicitinertial = mass, centre.tolist(), True
        body_spec.fullinertia = [*np.diag(tensor), tensor[0, 1], tensor[0, 2], tensor[1, 2]]


def lay_cables(spec: Any, robot: Robot) -> None:
    """Lay the cables: the length of each is the sum of its hinges' angles times half the cord spacing.

    That is the first order of the exact change in length, whose relative error is below 1.2 % up to 180 degrees.
    """
    for cable in robot.cables:
        servo = cable.turning
        tendon = spec.add_tendon(
            name=cable.name,
            frictionloss=servo.friction / cable.pulley,
            damping=servo.damping / cable.pulley**2,
            armature=servo.armature / cable.pulley**2,
        )
        for joint in cable.hinges:
            tendon.wrap_joint(joint, cable.cord_spacing / 2)


RELIEF = "relief"
"""Name of the geom that stands up from the plane."""
_COLOUR = (0.86, 0.84, 0.78, 1.0)
_BASE = 0.05  # [m]; a height field needs a thickness


def add_ground(spec: Any, relief: Relief | None) -> None:
    """Lay the ground, and what stands up from it.

    Models of one batch must have equal sizes: reliefs of one type do.
    """
    plane = spec.worldbody.add_geom(
        name="ground",
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[0, 0, 0.05],
        contype=1,
        conaffinity=0,
        rgba=list(_COLOUR),
    )
    spec.worldbody.add_light(pos=[0, 0, 3], dir=[0, 0, -1])
    if isinstance(relief, Step):
        half = (REACH[1] - relief.at) / 2
        _block(spec, (relief.at + half, 0.0), (max(half, 0.01), HALF_WIDTH), relief.height)
    elif isinstance(relief, Stone):
        _block(spec, (relief.at, relief.aside), (relief.length / 2, relief.width / 2), relief.height)
    elif isinstance(relief, Bumps):
        plane.pos = [0, 0, _raise(spec, relief)]  # as deep as the field


def _block(spec: Any, centre: tuple[float, float], half: tuple[float, float], height: float) -> None:
    """Add a box on the ground: centre and half widths along x and y, and its height [m]."""
    spec.worldbody.add_geom(
        name=RELIEF,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=[*centre, height / 2],
        size=[*half, height / 2],
        contype=1,
        conaffinity=0,
        rgba=list(_COLOUR),
    )


def _raise(spec: Any, bumps: Bumps) -> float:
    """Add a height field; return the height of its lowest point [m]."""
    heights, (x_start, x_end) = field(bumps), bumps.reach
    min_height, max_height = float(heights.min()), float(heights.max())
    x_centre = (x_start + x_end) / 2
    spec.add_hfield(
        name=RELIEF,
        size=[x_end - x_centre, bumps.half_width, max_height - min_height, _BASE * bumps.scale],
        nrow=heights.shape[0],
        ncol=heights.shape[1],
        userdata=((heights - min_height) / (max_height - min_height)).ravel(),
    )
    spec.worldbody.add_geom(
        name=RELIEF,
        type=mujoco.mjtGeom.mjGEOM_HFIELD,
        hfieldname=RELIEF,
        pos=[x_centre, 0.0, min_height],
        contype=1,
        conaffinity=0,
        rgba=list(_COLOUR),
    )
    return min_height


def standing(model: Any, robot: Robot, hip_height: float, servos: np.ndarray) -> np.ndarray:
    """Return the generalised positions of a robot that stands on the ground with given servo angles.

    It faces forward on the whole: a bent trunk turns the girdles to either side of +x by equal angles.

    Args:
        model: its ``mujoco.MjModel``, with a ground.
        robot: the design.
        hip_height: height of the root, higher where something would be below the ground [m].
        servos: shape (servo,) [rad].
    """
    data = mujoco.MjData(model)
    robot_layout = layout(robot)
    data.qpos[2] = hip_height
    turn = -sum(servos[i] for i in robot_layout.trunk_yaw) / 2
    data.qpos[3:7] = from_axis_angle(np.array([0.0, 0.0, 1.0]), turn)
    direct = len(robot_layout.servos) - len(robot_layout.cables)
    data.qpos[joint_addresses(model, robot_layout.servos[:direct])] = servos[:direct]
    for i in robot_layout.cables:
        cable = robot_layout.cable(i)
        pulley_per_bend = cable.cord_spacing / 2 / cable.pulley
        data.qpos[joint_addresses(model, cable.hinges)] = servos[i] / pulley_per_bend / cable.joints
    mujoco.mj_forward(model, data)
    deepest = min((float(c.dist) for c in data.contact), default=0.0)
    data.qpos[2] -= min(deepest, 0.0)
    return np.array(data.qpos)

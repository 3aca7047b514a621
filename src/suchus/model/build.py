"""A whole model: world, robot, servos, sensors."""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import mujoco

from suchus.design import GRAVITY, Layout, Robot, Servo, layout
from suchus.design.body import servos_of
from suchus.design.relief import Relief
from suchus.errors import InvalidDesign
from suchus.model.bodies import add_bodies, add_foam, lay_cables
from suchus.model.ground import add_ground
from suchus.model.names import sites

TIMESTEP = 0.002  # [s]; of the article's robot; 0.5 to 8 ms were measured to give the same displacement within 1 %
SLEW = 1
"""Column of ``actuator_dynprm`` in which MuJoCo's pid keeps its slew limit."""
_POSITION_INPUT = 1  # the servo takes an angle; the other inputs of MuJoCo's pid stay unused


def build(robot: Robot, *, timestep: float = TIMESTEP, relief: Relief | None = None) -> Any:
    """Write a robot on the ground as a ``mujoco.MjSpec``.

    World: x forward, y left, z up; the free joint carries the root, in a crocodile the pelvis, the spine's frame 0.

    Args:
        robot: the design.
        timestep: of the physics [s].
        relief: what stands up from even ground.

    Returns:
        The ``mujoco.MjSpec``, ready for ``compile()`` or for further edits.
    """
    place = layout(robot)
    spec = mujoco.MjSpec()
    spec.modelname = robot.name
    spec.compiler.degree = False
    _set_options(spec, timestep)
    add_ground(spec, relief)
    root = spec.worldbody.add_body(name=place.robot.root, pos=[0, 0, 0.2])
    root.add_freejoint(name="root")
    add_bodies(root, place)
    add_foam(spec, place)
    lay_cables(spec, place.robot)
    servos = servos_of(place.robot)
    for number, name in enumerate(place.servos):
        _add_servo(spec, number, name, servos[name], place)
    _add_sensors(spec, place)
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
    which of them have integral action and so a state of its own.
    """
    place = layout(robot)
    bodies = tuple((body.name, body.parent, tuple(name for _, name, _ in body.hinges)) for body in place.bodies)
    servos = servos_of(robot)
    integrating = tuple(name for name in place.servos if servos[name].ki > 0)
    shapes = tuple(len(segment.shapes) for segment in place.robot.axis)
    foam = () if place.robot.hull is None else tuple(one.body for one in place.robot.hull.foam)
    return bodies, foam, place.servos, shapes, tuple(cable.hinges for cable in place.robot.cables), integrating


def joint_addresses(model: Any, names: Sequence[str]) -> list[int]:
    """Return where the angles of named hinges stand in ``qpos``: MuJoCo orders joints by body, depth first."""
    return [int(model.joint(name).qposadr[0]) for name in names]


def servo_of(robot: Robot, name: str) -> Servo:
    """Return the servo that carries a name of ``design.servo_names(robot)``."""
    return robot.servo(name)


def _set_options(spec: Any, timestep: float) -> None:
    option = spec.option
    option.timestep = timestep
    option.gravity = [0.0, 0.0, -GRAVITY]
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.impratio = 10.0
    option.jacobian = mujoco.mjtJacobian.mjJAC_SPARSE  # 1.6 to 1.8 times faster here than dense
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET  # divergence ends a run, it does not restart it


def _add_servo(spec: Any, number: int, name: str, servo: Servo, place: Layout) -> None:
    actuator = spec.add_actuator(name=name, group=number)
    actuator.set_to_pid(
        kp=servo.kp,
        kv=servo.kd,
        ki=servo.ki if servo.ki > 0 else -1,
        imax=servo.integral_limit / servo.ki if servo.ki > 0 else -1,
        slewmax=servo.speed,
        ctrlspec=_POSITION_INPUT,
    )
    if number in place.cables:
        actuator.trntype = mujoco.mjtTrn.mjTRN_TENDON
        actuator.target = name
        actuator.gear[0] = (
            1.0 / place.cable(number).pulley
        )  # cable length to angle of the pulley, and its torque to tension
    else:
        actuator.trntype = mujoco.mjtTrn.mjTRN_JOINT
        actuator.target = name
    actuator.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE
    actuator.forcerange = [-servo.torque, servo.torque]


def _add_sensors(spec: Any, place: Layout) -> None:
    kind, of = mujoco.mjtSensor, mujoco.mjtObj
    for suffix, sensor in (
        ("position", kind.mjSENS_ACTUATORPOS),
        ("velocity", kind.mjSENS_ACTUATORVEL),
        ("torque", kind.mjSENS_ACTUATORFRC),
    ):
        for servo in place.servos:
            spec.add_sensor(name=f"{servo}_{suffix}", type=sensor, objtype=of.mjOBJ_ACTUATOR, objname=servo)
    for limb in place.limb_names:
        _add_force(spec, f"{limb}_force", of.mjOBJ_GEOM, f"{limb}_foot")
    for body in place.trunk:
        _add_force(spec, f"{body}_force", of.mjOBJ_BODY, body)
    for body in place.tail[:1]:
        _add_force(spec, "tail_force", of.mjOBJ_XBODY, body)  # an x-body stands for its whole subtree
    spec.add_sensor(name="imu_orientation", type=kind.mjSENS_FRAMEQUAT, objtype=of.mjOBJ_SITE, objname="imu")
    spec.add_sensor(name="imu_gyroscope", type=kind.mjSENS_GYRO, objtype=of.mjOBJ_SITE, objname="imu")
    spec.add_sensor(name="imu_accelerometer", type=kind.mjSENS_ACCELEROMETER, objtype=of.mjOBJ_SITE, objname="imu")
    spec.add_sensor(name="centre_of_mass", type=kind.mjSENS_SUBTREECOM, objtype=of.mjOBJ_BODY, objname=place.robot.root)
    spec.add_sensor(
        name="angular_momentum", type=kind.mjSENS_SUBTREEANGMOM, objtype=of.mjOBJ_BODY, objname=place.robot.root
    )
    for site in sites(place.robot):
        spec.add_sensor(name=f"{site}_position", type=kind.mjSENS_FRAMEPOS, objtype=of.mjOBJ_SITE, objname=site)


def _add_force(spec: Any, name: str, of: Any, touching: str) -> None:
    """Add a sensor of the net contact force of a part on the ground, in the world frame."""
    force, net, one = 1 << int(mujoco.mjtConDataField.mjCONDATA_FORCE), 3, 1
    spec.add_sensor(
        name=name,
        type=mujoco.mjtSensor.mjSENS_CONTACT,
        objtype=of,
        objname=touching,
        intprm=[force, net, one],
    )

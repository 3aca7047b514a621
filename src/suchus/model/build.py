"""A whole model: world, robot, servos, sensors."""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import mujoco

from suchus.design import LEGS, Crocodile, Servo, servo_names
from suchus.design.relief import Relief
from suchus.errors import InvalidDesign
from suchus.model.ground import add_ground
from suchus.model.legs import add_leg
from suchus.model.names import SITES, TRUNK_BODIES
from suchus.model.tail import CABLE, add_tail
from suchus.model.trunk import add_trunk

TIMESTEP = 0.002  # [s]; 0.5 to 8 ms were measured to give the same displacement within 1 %
SLEW = 1
"""Column of ``actuator_dynprm`` in which MuJoCo's pid keeps its slew limit."""
_POSITION_INPUT = 1  # the servo takes an angle; the other inputs of MuJoCo's pid stay unused


def build(robot: Crocodile, *, timestep: float = TIMESTEP, relief: Relief | None = None) -> Any:
    """Write a robot on the ground as a ``mujoco.MjSpec``.

    World: x forward, y left, z up; the free joint carries the pelvis, whose frame is the spine's frame 0.

    Args:
        robot: the design.
        timestep: of the physics [s].
        relief: what stands up from even ground.

    Returns:
        The ``mujoco.MjSpec``, ready for ``compile()`` or for further edits.
    """
    spec = mujoco.MjSpec()
    spec.modelname = robot.name
    spec.compiler.degree = False
    _set_options(spec, timestep)
    add_ground(spec, relief)
    pelvis = spec.worldbody.add_body(name="pelvis", pos=[0, 0, 0.2])
    pelvis.add_freejoint(name="root")
    thorax = add_trunk(pelvis, robot)
    for leg in LEGS:
        girdle, ahead = (thorax, robot.thorax.shoulder) if leg.endswith("F") else (pelvis, 0.0)
        add_leg(girdle, ahead, leg, robot.leg(leg), robot.contact)
    add_tail(spec, pelvis, robot)
    for servo in servo_names():
        _add_servo(spec, servo, robot)
    _add_sensors(spec)
    return spec


def compile_model(robot: Crocodile, timestep: float = TIMESTEP, relief: Relief | None = None) -> Any:
    """Compile a robot on its ground; the same values give the same ``mujoco.MjModel`` again: copy it before an edit.

    Raises:
        InvalidDesign: MuJoCo cannot compile it.
    """
    return _compiled(robot, timestep, relief)


@lru_cache(maxsize=64)
def _compiled(robot: Crocodile, timestep: float, relief: Relief | None) -> Any:
    """Compile once, whether the caller named what is the default or not."""
    try:
        return build(robot, timestep=timestep, relief=relief).compile()
    except ValueError as error:
        raise InvalidDesign(f"robot {robot.name!r} does not compile: {error}") from error


def topology(robot: Crocodile) -> tuple[int, int, tuple[str, ...]]:
    """Return what two robots must share to run in one batch.

    That is their numbers of cable and passive joints, and which servos have integral action and so a state of its own.
    """
    integrating = tuple(name for name in servo_names() if servo_of(robot, name).ki > 0)
    return robot.tail.joints, robot.tail.fin_segments, integrating


def joint_addresses(model: Any, names: Sequence[str]) -> list[int]:
    """Return where the angles of named hinges stand in ``qpos``: MuJoCo orders joints by body, depth first."""
    return [int(model.joint(name).qposadr[0]) for name in names]


def servo_of(robot: Crocodile, name: str) -> Servo:
    """Return the servo that carries a name of ``design.servo_names()``."""
    return robot.servo(name)


def _set_options(spec: Any, timestep: float) -> None:
    option = spec.option
    option.timestep = timestep
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.impratio = 10.0
    option.jacobian = mujoco.mjtJacobian.mjJAC_SPARSE  # 1.6 to 1.8 times faster here than dense
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET  # divergence ends a run, it does not restart it


def _add_servo(spec: Any, name: str, robot: Crocodile) -> None:
    servo = servo_of(robot, name)
    actuator = spec.add_actuator(name=name, group=servo_names().index(name))
    actuator.set_to_pid(
        kp=servo.kp,
        kv=servo.kd,
        ki=servo.ki if servo.ki > 0 else -1,
        imax=servo.integral_limit / servo.ki if servo.ki > 0 else -1,
        slewmax=servo.speed,
        ctrlspec=_POSITION_INPUT,
    )
    if name == "tail_cable":
        actuator.trntype = mujoco.mjtTrn.mjTRN_TENDON
        actuator.target = CABLE
        actuator.gear[0] = 1.0 / robot.tail.pulley  # cable length to angle of the pulley, and its torque to tension
    else:
        actuator.trntype = mujoco.mjtTrn.mjTRN_JOINT
        actuator.target = name
    actuator.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE
    actuator.forcerange = [-servo.torque, servo.torque]


def _add_sensors(spec: Any) -> None:
    kind, of = mujoco.mjtSensor, mujoco.mjtObj
    for suffix, sensor in (
        ("position", kind.mjSENS_ACTUATORPOS),
        ("velocity", kind.mjSENS_ACTUATORVEL),
        ("torque", kind.mjSENS_ACTUATORFRC),
    ):
        for servo in servo_names():
            spec.add_sensor(name=f"{servo}_{suffix}", type=sensor, objtype=of.mjOBJ_ACTUATOR, objname=servo)
    for leg in LEGS:
        _add_force(spec, f"{leg}_force", of.mjOBJ_GEOM, f"{leg}_foot")
    for body in TRUNK_BODIES:
        _add_force(spec, f"{body}_force", of.mjOBJ_BODY, body)
    _add_force(spec, "tail_force", of.mjOBJ_XBODY, "tail_root")  # an x-body stands for its whole subtree
    spec.add_sensor(name="imu_orientation", type=kind.mjSENS_FRAMEQUAT, objtype=of.mjOBJ_SITE, objname="imu")
    spec.add_sensor(name="imu_gyroscope", type=kind.mjSENS_GYRO, objtype=of.mjOBJ_SITE, objname="imu")
    spec.add_sensor(name="imu_accelerometer", type=kind.mjSENS_ACCELEROMETER, objtype=of.mjOBJ_SITE, objname="imu")
    spec.add_sensor(name="centre_of_mass", type=kind.mjSENS_SUBTREECOM, objtype=of.mjOBJ_BODY, objname="pelvis")
    spec.add_sensor(name="angular_momentum", type=kind.mjSENS_SUBTREEANGMOM, objtype=of.mjOBJ_BODY, objname="pelvis")
    for site in SITES:
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

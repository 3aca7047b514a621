"""One joint of a robot fixed on a stand: the response of its servo to steps, loads and a clamp."""

from typing import NamedTuple

import mujoco
import numpy as np
from jaxtyping import Bool, Float

from suchus.core.errors import Diverged, InvalidDesign, UnknownName
from suchus.robot.design import Robot, layout
from suchus.sim.land.step_division import divided_step
from suchus.sim.model import activations, build

_HEIGHT = 2.0  # [m]; of the stand: nothing touches the ground
_GRIP = "clamp"


class Response(NamedTuple):
    """Response of a servo over time, one entry for each physics step."""

    time: Float[np.ndarray, " time"]
    """Time since the first command [s]."""
    angle: Float[np.ndarray, " time"]
    """Angle of the joint [rad]."""
    torque: Float[np.ndarray, " time"]
    """Torque of the servo [N m]."""


def on_stand(
    robot: Robot,
    joint: str,
    *,
    target: Float[np.ndarray, " time"],
    load: Float[np.ndarray, " time"],
    gripped: Bool[np.ndarray, " time"],
    timestep: float = 0.002,
) -> Response:
    """Return what a joint does while the root, the pelvis, is fixed in the air, without gravity.

    All other servos hold zero. The joint starts at rest at zero; a clamp holds it at zero whatever its servo does.

    Args:
        robot: the design.
        joint: name of a servo that turns a joint of its own, as ``LH_pitch``.
        target: commanded angle at each step [rad].
        load: torque that acts on the joint from outside at each step [N m].
        gripped: whether the joint is clamped at each step.
        timestep: time step of the physics, and of all samples [s].

    Raises:
        UnknownName: there is no such servo.
        InvalidDesign: the servo turns no joint of its own, or the courses differ in length.
        Diverged: the joint's angle is no number any more.
    """
    servos = layout(robot).servos
    if joint not in servos:
        raise UnknownName("servo", joint, servos)
    if not len(target) == len(load) == len(gripped):
        lengths = f"{len(target)}, {len(load)} and {len(gripped)}"
        raise InvalidDesign(f"target, load and gripped have {lengths} samples; give as many of each.")
    step = divided_step(timestep)
    model = _model(robot, joint, step)
    data = mujoco.MjData(model)
    data.act[:] = activations(model, np.zeros(model.nu))
    servo, hinge = model.actuator(joint).id, model.joint(joint)
    angle, torque = np.empty(len(target)), np.empty(len(target))
    for i in range(len(target)):
        data.ctrl[servo] = target[i]
        data.qfrc_applied[hinge.dofadr[0]] = load[i]
        data.eq_active[0] = gripped[i]
        mujoco.mj_step(model, data, round(timestep / step))
        angle[i], torque[i] = data.qpos[hinge.qposadr[0]], data.actuator_force[servo]
        if not np.isfinite(angle[i]):
            raise Diverged(f"{joint} on the stand diverged at {data.time:.3f} s.", time=float(data.time), record=None)
    return Response(timestep * np.arange(1, len(target) + 1), angle, torque)


def _model(robot: Robot, joint: str, timestep: float) -> mujoco.MjModel:
    """Compile a robot whose root is fixed in the air, with a clamp on one joint."""
    spec = build(robot, timestep=timestep)
    if spec.joint(joint) is None:
        raise InvalidDesign(f"servo {joint!r} turns no joint of its own; name one that does.")
    spec.delete(spec.joint("root"))
    spec.body(robot.root).pos = [0.0, 0.0, _HEIGHT]
    spec.option.gravity = [0.0, 0.0, 0.0]
    hinge = mujoco.mjtObj.mjOBJ_JOINT
    spec.add_equality(name=_GRIP, type=mujoco.mjtEq.mjEQ_JOINT, objtype=hinge, name1=joint, active=False)
    return spec.compile()

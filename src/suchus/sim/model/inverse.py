"""Torques that a motion of the joints needs while the root is held: weight and inertia of the bodies alone."""

import mujoco
import numpy as np
from jaxtyping import Float

from suchus.robot.design import Robot, layout
from suchus.sim.model.build import compile_model


def held_torques(
    robot: Robot,
    angles: Float[np.ndarray, "sample hinge"],
    rates: Float[np.ndarray, "sample hinge"],
    accelerations: Float[np.ndarray, "sample hinge"],
) -> Float[np.ndarray, "sample servo"]:
    """Return the torque that each servo needs to move the bodies of a robot whose root is held level in the air.

    Inertia, friction and damping of the servos themselves are left out. A servo that turns no hinge of its own, as that
    of a cable, has not a number.

    Args:
        robot: the robot.
        angles: of all hinges, in the order of the layout [rad].
        rates: [rad/s].
        accelerations: [rad/s2].
    """
    model, robot_layout = compile_model(robot), layout(robot)
    data = mujoco.MjData(model)
    joints = [model.joint(name) for name in robot_layout.hinges]
    positions = np.array([int(joint.qposadr[0]) for joint in joints], dtype=int)
    dofs = np.array([int(joint.dofadr[0]) for joint in joints], dtype=int)
    acceleration, inertial = np.zeros(model.nv), np.zeros(model.nv)
    rotor_inertia = model.dof_armature[dofs]
    data.qpos[3:7] = (1.0, 0.0, 0.0, 0.0)
    torques = np.full((len(angles), len(robot_layout.servos)), np.nan)
    servo_hinges = np.array(robot_layout.servo_hinges)
    has_hinge = servo_hinges >= 0
    for sample, (angle, rate, change) in enumerate(zip(angles, rates, accelerations, strict=True)):
        data.qpos[positions], data.qvel[dofs], acceleration[dofs] = angle, rate, change
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_fwdVelocity(model, data)
        mujoco.mj_mulM(model, data, inertial, acceleration)
        load = inertial[dofs] - rotor_inertia * change + data.qfrc_bias[dofs]
        torques[sample, has_hinge] = load[servo_hinges[has_hinge]]
    return torques


def held_inertias(robot: Robot) -> dict[str, float]:
    """Return the inertia of what each servo moves while the root and all other joints are held, all joints at zero.

    The rotors are left out, and so are servos that turn no hinge of their own.

    Returns:
        Inertia about the hinge of each servo, by its name [kg m2].
    """
    robot_layout = layout(robot)
    count = len(robot_layout.hinges)
    still, unit = np.zeros((count + 1, count)), np.vstack([np.zeros((1, count)), np.eye(count)])
    torques = held_torques(robot, still, still, unit)
    return {
        name: float(torques[1 + hinge, servo] - torques[0, servo])
        for servo, (name, hinge) in enumerate(zip(robot_layout.servos, robot_layout.servo_hinges, strict=True))
        if hinge >= 0
    }

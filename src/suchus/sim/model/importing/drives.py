"""Torque and gains of the actuators of an MJCF at its hinges, as MuJoCo computes them (``qfrc_actuator``)."""

from copy import copy
from typing import Any

import mujoco
import numpy as np

from suchus.sim.model.importing.cleaning import GUESSED, Drive, listed

_SATURATING = 1e9  # control value that brings every actuator to its limit of force
_INTEGRATOR = int(mujoco.mjtDyn.mjDYN_INTEGRATOR)
_DISABLED = (
    mujoco.mjtDisableBit.mjDSBL_CONSTRAINT, mujoco.mjtDisableBit.mjDSBL_GRAVITY, mujoco.mjtDisableBit.mjDSBL_CONTACT
)  # fmt: skip


def actuated_drives(model: Any) -> tuple[dict[str, Drive], tuple[str, ...]]:
    """Return the drive of each hinge that an actuator turns, by the hinge's name, and remarks on missing limits.

    The torque is the greatest ``qfrc_actuator`` at standstill over the ranges of controls, forces and angles: gear,
    ``ctrlrange``, ``forcerange`` and the joint's ``actuatorfrcrange`` count, and actuators on one hinge add up.

    Args:
        model: compiled, with actuators that act on joints alone.
    """
    actuators = {i: int(model.actuator_trnid[i, 0]) for i in range(model.nu)}
    torques = _max_torques(model, actuators)
    drives: dict[str, Drive] = {}
    unbounded, powerless = [], []
    for joint in dict.fromkeys(actuators.values()):
        members = [i for i, actuated_joint in actuators.items() if actuated_joint == joint]
        name, torque = str(model.joint(joint).name), torques[joint]
        if torque is None:
            is_guessed = all(str(model.actuator(i).name).startswith(GUESSED) for i in members)
            unbounded += [] if is_guessed else [name]
        elif torque == 0.0:
            powerless.append(name)
        kp, kd = (_joint_gain(model, members, term) for term in (1, 2))
        speed = max((_max_speed(model, i) for i in members), default=0.0)
        drives[name] = Drive(
            torque=torque or None, speed=speed or None, passive=False, kp=kp or None, kd=kd if kp or kd else None
        )
    remarks = []
    if unbounded:
        remarks.append(
            f"The file bounds neither control nor force of the actuators of {listed(unbounded)}: their torque is a "
            "guess (ctrlrange, forcerange or actuatorfrcrange would state it)."
        )
    if powerless:
        remarks.append(
            f"The actuators of {listed(powerless)} give no torque in the file (a range or gear of zero): it was "
            "taken as not filled in, and their torque is a guess."
        )
    return drives, tuple(remarks)


def _max_torques(model: Any, actuators: dict[int, int]) -> dict[int, float | None]:
    """Return the greatest torque of the actuators of each hinge at standstill [N m]; None where nothing bounds it.

    Args:
        model: model of the file.
        actuators: hinge of each actuator.
    """
    trial = copy(model)
    for flag in _DISABLED:
        trial.opt.disableflags |= int(flag)
    controls = {i: _control_range(model, i, joint) for i, joint in actuators.items()}
    trial.actuator_ctrllimited[:] = 0
    data = mujoco.MjData(trial)
    torques: dict[int, float | None] = dict.fromkeys(actuators.values(), 0.0)
    for joint_end in (0, 1, None):
        for sign in (1.0, -1.0):
            mujoco.mj_resetData(trial, data)
            for i, joint in actuators.items():
                if joint_end is not None and model.jnt_limited[joint]:
                    data.qpos[model.jnt_qposadr[joint]] = model.jnt_range[joint, joint_end]
                limits = controls[i]
                if limits is None:
                    torques[joint] = None
                    continue
                control = limits[1] if sign * model.actuator_gear[i, 0] >= 0 else limits[0]
                if model.actuator_dyntype[i]:
                    data.act[model.actuator_actadr[i]] = control
                data.ctrl[i] = control
            mujoco.mj_forward(trial, data)
            for joint, earlier in torques.items():
                if earlier is not None:
                    torque = abs(float(data.qfrc_actuator[model.jnt_dofadr[joint]]))
                    torques[joint] = max(earlier, torque)
    return torques


def _control_range(model: Any, actuator: int, joint: int) -> tuple[float, float] | None:
    """Return the controls, or the states of an integrator, between which an actuator's force is greatest.

    Returns:
        None where neither control nor force is bounded.
    """
    is_position = -float(model.actuator_biasprm[actuator, 1]) > 0.0
    is_integrator = int(model.actuator_dyntype[actuator]) == _INTEGRATOR
    is_limited = model.actuator_actlimited[actuator] if is_integrator else model.actuator_ctrllimited[actuator]
    limits = (model.actuator_actrange if is_integrator else model.actuator_ctrlrange)[actuator]
    if (is_position or not is_limited) and (model.actuator_forcelimited[actuator] or model.jnt_actfrclimited[joint]):
        return -_SATURATING, _SATURATING
    if is_limited:
        return float(limits[0]), float(limits[1])
    if is_position and model.jnt_limited[joint]:
        lower, upper = sorted(float(model.actuator_gear[actuator, 0]) * end for end in model.jnt_range[joint])
        return lower, upper
    return None


def _joint_gain(model: Any, actuators: list[int], term: int) -> float:
    """Return the proportional (1) or derivative (2) gain of actuators at their hinge [N m/rad] or [N m s/rad]."""
    is_affine = int(mujoco.mjtBias.mjBIAS_AFFINE)
    return sum(
        max(-float(model.actuator_biasprm[i, term]), 0.0) * float(model.actuator_gear[i, 0]) ** 2
        for i in actuators
        if int(model.actuator_biastype[i]) == is_affine
    )


def _max_speed(model: Any, actuator: int) -> float:
    """Return the greatest speed that a velocity servo is commanded [rad/s]; 0 for other actuators."""
    bias, gear = model.actuator_biasprm[actuator], abs(float(model.actuator_gear[actuator, 0]))
    if bias[1] != 0.0 or bias[2] >= 0.0 or not model.actuator_ctrllimited[actuator] or gear == 0.0:
        return 0.0
    ratio = float(model.actuator_gainprm[actuator, 0]) / -float(bias[2])
    return abs(ratio) * float(np.abs(model.actuator_ctrlrange[actuator]).max()) / gear

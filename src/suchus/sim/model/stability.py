"""How long a time step may be before explicit steps no longer hold a robot's joints."""

from functools import lru_cache
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Float

from suchus.robot.design import Robot
from suchus.sim.model.build import compile_model

_KP_MOTOR, _KD_MOTOR = 4, 6  # columns of ``actuator_gainprm`` in which MuJoCo keeps the gains of a dcmotor
_REACH = 2.785
"""Step times rate up to which a fourth-order Runge-Kutta step lets a decay decay [-]."""


@lru_cache(maxsize=64)
def longest_step(robot: Robot) -> float:
    """Return the longest time step with which fourth-order Runge-Kutta steps hold a robot's joints at rest [s].

    It is that of the fastest rate of the joints about the straight posture, by their springs, dampers and servos and
    those of the cables, in the air and off the ground. Bent or loaded they may ask for somewhat less.
    """
    model = compile_model(robot)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    damping, stiffness = damping_of(model, data), np.zeros_like(mass)
    hinges = np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE)
    hinge_dofs = model.jnt_dofadr[hinges]
    stiffness[hinge_dofs, hinge_dofs] = _linear_coefficients(model.jnt_stiffness, model.njnt)[hinges]
    servos = _dense(data.actuator_moment, data.moment_rownnz, data.moment_rowadr, data.moment_colind, model.nv)
    stiffness_gains, damping_gains = _gains(model)
    stiffness += servos.T @ (stiffness_gains[:, None] * servos)
    damping += servos.T @ (damping_gains[:, None] * servos)
    cables = _cables(model, data)
    stiffness += cables.T @ (_linear_coefficients(model.tendon_stiffness, model.ntendon)[:, None] * cables)
    zeros = np.zeros_like(mass)
    stiffness_rates, damping_rates = (-np.linalg.solve(mass, matrix) for matrix in (stiffness, damping))
    rates = np.linalg.eigvals(np.block([[zeros, np.eye(model.nv)], [stiffness_rates, damping_rates]]))
    return _REACH / float(np.abs(rates).max())


def damping_of(model: Any, data: Any) -> Float[np.ndarray, "dof dof"]:
    """Return the damping matrix of joints and cables, without servos [N m s/rad]."""
    cables = _cables(model, data)
    dampers = _linear_coefficients(model.tendon_damping, model.ntendon)
    return np.diag(np.asarray(model.dof_damping, float)) + cables.T @ (dampers[:, None] * cables)


def _cables(model: Any, data: Any) -> Float[np.ndarray, "cable dof"]:
    """Return the derivative of each cable's length with respect to each joint angle [m/rad]."""
    return _dense(data.ten_J, model.ten_J_rownnz, model.ten_J_rowadr, model.ten_J_colind, model.nv)


def _gains(model: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return the proportional [N m/rad] and derivative gains [N m s/rad] of a model's servos."""
    is_motor = model.actuator_dyntype == int(mujoco.mjtDyn.mjDYN_DCMOTOR)
    return (
        np.where(is_motor, model.actuator_gainprm[:, _KP_MOTOR], -model.actuator_biasprm[:, 1]),
        np.where(is_motor, model.actuator_gainprm[:, _KD_MOTOR], -model.actuator_biasprm[:, 2]),
    )


def _linear_coefficients(values: Any, count: int) -> Float[np.ndarray, " n"]:
    """Return the linear coefficient of each of some springs or dampers, which may have further ones."""
    return np.asarray(np.reshape(values, (count, -1))[:, 0] if count else np.zeros(0), float)


def _dense(values: Any, counts: Any, starts: Any, columns: Any, width: int) -> Float[np.ndarray, "row dof"]:
    """Return a dense matrix from compressed sparse rows.

    Args:
        values: entries, row by row.
        counts: number of entries of each row.
        starts: index of the first entry of each row.
        columns: column of each entry.
        width: number of columns [-].
    """
    matrix = np.zeros((len(counts), width))
    for row, (count, start) in enumerate(zip(counts, starts, strict=True)):
        entries = slice(start, start + count)
        matrix[row, np.ravel(columns)[entries]] = np.ravel(values)[entries]
    return matrix

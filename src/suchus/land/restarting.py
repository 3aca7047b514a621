"""Restart of single robots of a running batch, as learning in many episodes needs it."""

from typing import NamedTuple

import mujoco
import numpy as np
from jaxtyping import Float

from suchus.land.batch import SimulationBatch


class Beginning(NamedTuple):
    """State in which a robot begins."""

    qpos: Float[np.ndarray, " q"]
    """Generalised positions [m], [rad]."""
    qvel: Float[np.ndarray, " v"]
    """Generalised velocities [m/s], [rad/s]."""
    act: Float[np.ndarray, " a"]
    """Inner states of the servos: slew-limited targets and integrals."""
    commanded: Float[np.ndarray, " servo"]
    """Last commanded angle of each servo [rad]."""


def restart(batch: SimulationBatch, sim: int, begin: Beginning) -> None:
    """Put one robot of a batch into a state, without a push, also after it has diverged; faults are the injector's.

    The others stay as they are. From then on it moves as a robot of a fresh batch does, to the last bit.

    Args:
        batch: the simulations; its runs must be of one robot on one relief.
        sim: index of the robot in the batch.
        begin: the state in which it begins.
    """
    physics, who = batch.physics, np.array([sim])
    physics.reset(who, stage=mujoco.mjtStage.mjSTAGE_NONE)
    batch.qpos[sim], batch.qvel[sim], batch.ctrl[sim] = begin.qpos, begin.qvel, begin.commanded
    physics.bind("act")[sim] = begin.act
    batch.waters.refill(sim)
    physics.forward(who)
    batch.read(sim)
    batch.alive[sim], batch.ended[sim], batch.cause[sim] = True, np.inf, ""

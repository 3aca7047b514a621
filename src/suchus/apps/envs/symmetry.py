"""The mirror image of what a robot observes and does, by which a learner sees each experience twice."""

import numpy as np
from jaxtyping import Float

from suchus.apps.envs.task import Task
from suchus.robot.control.policy import mirror_shift, observation_mirror, servo_mirror


def mirror_observations(observations: Float[np.ndarray, "*b n"], task: Task) -> Float[np.ndarray, "*b n"]:
    """Return the observations of the mirrored robot: left and right exchanged, its clock half a cycle ahead.

    Args:
        observations: observations of the task.
        task: the task; its gait is symmetric.

    Raises:
        InvalidDesign: the mirror image of the gait is another gait.
    """
    mirror_shift(task.gait)
    columns, signs = observation_mirror(task.robot, task.gait, task.observed)
    return np.asarray(observations[..., columns] * signs, dtype=observations.dtype)


def mirror_actions(actions: Float[np.ndarray, "*b servo"], task: Task) -> Float[np.ndarray, "*b servo"]:
    """Return the actions of the mirrored robot; an episode begins in a posture that is its own mirror image.

    Args:
        actions: actions of the task.
        task: the task.
    """
    images, signs = servo_mirror(task.robot)
    return np.asarray(actions[..., images] * signs, dtype=actions.dtype)

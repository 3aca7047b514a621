"""Robots as Gymnasium environments; importing this package registers them. The extra ``gym`` installs gymnasium."""

from suchus.apps.envs.shelf import IDS, MAX_STEPS_BY_TASK, MAX_STEPS, TASKS, register  # isort: skip  # says what is missing, if it is
from suchus.apps.envs.policies import (
    ControllerPolicy,
    EpisodeResults,
    GaitFollower,
    HoldStill,
    Policy,
    RandomActions,
    SwimToGoal,
    play,
)
from suchus.apps.envs.senses import SENSES, reading_columns, senses
from suchus.apps.envs.single import CrocodileEnv, action_space, observation_space
from suchus.apps.envs.symmetry import mirror_actions, mirror_observations
from suchus.apps.envs.task import AnyGoal, Breaks, CommandRanges, Goal, Landing, Pushes, Rewards, Task, remaining
from suchus.apps.envs.vector import CrocodileVectorEnv

register()

__all__ = [
    "IDS",
    "MAX_STEPS",
    "MAX_STEPS_BY_TASK",
    "SENSES",
    "TASKS",
    "AnyGoal",
    "Breaks",
    "CommandRanges",
    "ControllerPolicy",
    "CrocodileEnv",
    "CrocodileVectorEnv",
    "EpisodeResults",
    "GaitFollower",
    "Goal",
    "HoldStill",
    "Landing",
    "Policy",
    "Pushes",
    "RandomActions",
    "Rewards",
    "SwimToGoal",
    "Task",
    "action_space",
    "mirror_actions",
    "mirror_observations",
    "observation_space",
    "play",
    "reading_columns",
    "register",
    "remaining",
    "senses",
]

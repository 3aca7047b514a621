"""Robots as Gymnasium environments; importing this room registers them. The extra ``gym`` installs gymnasium."""

from suchus.apps.envs.shelf import IDS, LONGER, STEPS, TASKS, register  # isort: skip  # says what is missing, if it is
from suchus.apps.envs.policies import Anything, Controlled, Follow, Played, Policy, Still, SwimToGoal, play
from suchus.apps.envs.senses import SENSES, part, senses
from suchus.apps.envs.single import CrocodileEnv, action_space, observation_space
from suchus.apps.envs.task import AnyGoal, Breaks, Goal, Landing, Pushes, Rewards, Task, remaining
from suchus.apps.envs.vector import CrocodileVectorEnv

register()

__all__ = [
    "IDS",
    "LONGER",
    "SENSES",
    "STEPS",
    "TASKS",
    "AnyGoal",
    "Anything",
    "Breaks",
    "Controlled",
    "CrocodileEnv",
    "CrocodileVectorEnv",
    "Follow",
    "Goal",
    "Landing",
    "Played",
    "Policy",
    "Pushes",
    "Rewards",
    "Still",
    "SwimToGoal",
    "Task",
    "action_space",
    "observation_space",
    "part",
    "play",
    "register",
    "remaining",
    "senses",
]

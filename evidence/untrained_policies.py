"""Tasks of ``suchus.apps.envs`` played by policies that nobody trained, for the page on environments."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from math import radians, sin
from typing import Any

import numpy as np

from suchus.apps.envs import (
    MAX_STEPS,
    MAX_STEPS_BY_TASK,
    TASKS,
    ControllerPolicy,
    CrocodileVectorEnv,
    GaitFollower,
    HoldStill,
    RandomActions,
    SwimToGoal,
    Task,
)
from suchus.apps.envs.policies import EpisodeResults, Policy, play
from suchus.apps.envs.shelf import resolve_task
from suchus.robot.control import Amphibious, HeadingHold, HeadingRule, Swimming
from suchus.robot.design import layout
from suchus.robot.gaits import default_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Lake

NAME = "untrained_policies"
EPISODES, SEED = 32, 1000
SHORE_EPISODES = 3
SLOPES = (8, 12, 15)
"""Slopes of the shores on which the controller of the catalog is tried [deg], the first that of the task."""
OFFSHORE = 1.6
"""Distance of the water line from the beginning [m]."""
BODY_STEPS, BODY_EPISODES = 80, 2


def centre(task: Task) -> tuple[float, ...]:
    """Return the servo angles of an action of zero [rad]."""
    return tuple(CrocodileVectorEnv(1, task).pack.centre)


def follow(task: Task) -> Policy:
    """Return the policy that follows the task's gait by the clock."""
    return GaitFollower(task=task, centre=centre(task), gait=task.gait)


def random(task: Task) -> Policy:
    """Return the policy that draws its actions at random, from a seed."""
    return RandomActions(task, np.random.default_rng(0))


def swim_to_goal(task: Task) -> Policy:
    """Return the policy that swims to the goal."""
    return SwimToGoal(task=task, centre=centre(task))


def amphibious(task: Task) -> Policy:
    """Return the controller of the catalog that swims to the shore and walks on."""
    control = Amphibious(swim=task.swimming_gait, swimming=Swimming(heading=HeadingHold()), heading=HeadingRule())
    return ControllerPolicy(task, centre(task), control, steps=MAX_STEPS_BY_TASK["Shore"])


PLAYERS: Mapping[str, Mapping[str, Callable[[Task], Policy]]] = {
    "Crawl": {"still": HoldStill, "random": random, "follow": follow},
    "Fault": {"still": HoldStill, "random": random, "follow": follow},
    "Stand": {"still": HoldStill, "random": random},
    "Swim": {"still": HoldStill, "random": random, "swim_to_goal": swim_to_goal},
    "Shore": {"still": HoldStill, "random": random},
}
"""Policies of each task, by name."""


def results(task: str, policy: str) -> dict[str, float]:
    """Return what the episodes of a task with a policy gave, see ``summary``."""
    played = play(
        TASKS[task],
        PLAYERS[task][policy](TASKS[task]),
        episodes=EPISODES,
        seed=SEED,
        steps=MAX_STEPS_BY_TASK.get(task, MAX_STEPS),
    )
    return summary(played, MAX_STEPS_BY_TASK.get(task, MAX_STEPS) * TASKS[task].decision)


def summary(played: EpisodeResults, longest: float) -> dict[str, float]:
    """Return means over episodes, and how many reached the goal or ended before their time.

    Args:
        played: the episodes.
        longest: duration of an episode that nothing ends [s].
    """
    return {
        "episodes": len(played.returns),
        "return_mean": float(played.returns.mean()),
        "return_std": float(played.returns.std()),
        "lasted": float(played.durations.mean()),
        "forward": float(played.forward.mean()),
        "approach": float(played.approach.mean()),
        "reached": int(played.goal.sum()),
        "ended_early": int((played.durations < longest - 1e-6).sum()),
    }


def shore_results(slope: float) -> dict[str, float]:
    """Return what the controller of the catalog gave on a shore of a slope [deg], see ``summary``."""
    angle, steps = radians(slope), MAX_STEPS_BY_TASK["Shore"]
    task = replace(TASKS["Shore"], ground=Ground(uphill=angle), lake=Lake(level=OFFSHORE * sin(angle)))
    episodes = SHORE_EPISODES if slope == SLOPES[0] else 1
    return summary(play(task, amphibious(task), episodes=episodes, seed=0, steps=steps), steps * task.decision)


def body_results(robot: str) -> dict[str, Any]:
    """Return the size of the crawl's task for a robot, and how far its own gait by the clock gets [body length]."""
    task = resolve_task("Crawl", {"robot": robot, "gait": default_gait(ROBOTS[robot])})
    played = play(task, follow(task), episodes=BODY_EPISODES, seed=0, steps=BODY_STEPS)
    lengths = played.forward / task.robot.length
    env = CrocodileVectorEnv(1, task)
    return {
        "servos": len(layout(task.robot).servos),
        "readings": int(env.single_observation_space.shape[0]),
        "decision": task.decision,
        "gait": task.gait.name,
        "least": float(lengths.min()),
        "greatest": float(lengths.max()),
        "cycles": BODY_STEPS * task.decision / task.gait.period,
    }


def measured() -> dict[str, Any]:
    """Return all results by task and policy, by shore, and by robot."""
    return {
        "tasks": {task: {policy: results(task, policy) for policy in policies} for task, policies in PLAYERS.items()},
        "shores": {str(slope): shore_results(slope) for slope in SLOPES},
        "bodies": {robot: body_results(robot) for robot in ROBOTS if robot != "floating_caiman"},
    }

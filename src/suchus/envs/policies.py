"""What a learner has to beat: doing nothing, doing anything, and the shelf's gait through the same door."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from suchus.design import layout
from suchus.envs.registering import STEPS
from suchus.envs.senses import part, turning
from suchus.envs.task import Task
from suchus.envs.vector import CrocodileVectorEnv
from suchus.motion import AnyGait, cycle_targets

Policy = Callable[[Float[np.ndarray, "run n"]], Float[np.ndarray, "run servo"]]
"""From observations to actions."""


@dataclass(frozen=True, slots=True)
class Still:
    """All actions are zero: the posture in which the episode begins is held."""

    task: Task
    """Whose actions they are."""

    def __call__(self, seen: Float[np.ndarray, "run n"]) -> Float[np.ndarray, "run servo"]:
        """Return zeros."""
        return np.zeros((len(seen), len(layout(self.task.robot).servos)))


@dataclass(slots=True)
class Anything:
    """Actions drawn evenly from all that there are."""

    task: Task
    """Whose actions they are."""
    random: np.random.Generator
    """What draws."""

    def __call__(self, seen: Float[np.ndarray, "run n"]) -> Float[np.ndarray, "run servo"]:
        """Draw."""
        return self.random.uniform(-1.0, 1.0, (len(seen), len(layout(self.task.robot).servos)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Follow:
    """A gait that follows the clock of the observation and, where limbs are cranks, the angles of the cranks."""

    task: Task
    """Whose actions they are."""
    centre: tuple[float, ...]
    """Servo angles of an action of zero, ``Pack.centre`` [rad]."""
    gait: AnyGait
    """Which gait; its period should be the task's, or it goes at that one's pace."""

    def __call__(self, seen: Float[np.ndarray, "run n"]) -> Float[np.ndarray, "run servo"]:
        """Look up where the servos shall be when the step ends."""
        task, gait, robot = self.task, self.gait, self.task.robot
        sine, cosine = part(seen, "clock", robot).astype(float).T
        clock = np.arctan2(sine, cosine) / (2 * np.pi) + task.decision / task.gait.period
        targets = cycle_targets(robot, gait, clock)
        actions = (targets - np.array(self.centre)) / task.span
        cranks = turning(robot)
        if cranks.any():
            behind = targets - np.pi * part(seen, "servo_position", robot)
            speed = np.array([robot.servo(name).speed for name in layout(robot).servos])
            ahead = (np.mod(behind + np.pi, 2 * np.pi) - np.pi) / (task.decision * speed)
            actions = np.where(cranks, ahead, actions)
        return np.clip(actions, -1.0, 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Played:
    """What came of some episodes, one entry for each."""

    returns: Float[np.ndarray, " episode"]
    """Sum of the rewards [-]."""
    lasted: Float[np.ndarray, " episode"]
    """How long it lasted [s]."""
    forward: Float[np.ndarray, " episode"]
    """Way along the world's x axis [m]."""


def play(task: Task, policy: Policy, *, episodes: int = 32, seed: int = 0, steps: int = STEPS) -> Played:
    """Play episodes side by side and return what came of them.

    Args:
        task: the task.
        policy: what acts.
        episodes: how many.
        seed: of the first, the others following by one.
        steps: after how many an episode ends.
    """
    env = CrocodileVectorEnv(episodes, task, max_episode_steps=steps)
    seen, _ = env.reset(seed=seed)
    going = np.ones(episodes, dtype=bool)
    returns, lasted, forward = np.zeros((3, episodes))
    while going.any():
        seen, rewards, terminated, truncated, infos = env.step(policy(seen))
        returns += np.where(going, rewards, 0.0)
        lasted += going * task.decision
        forward += np.where(going, infos["forward"], 0.0)
        going &= ~(terminated | truncated)
    return Played(returns=returns, lasted=lasted, forward=forward)

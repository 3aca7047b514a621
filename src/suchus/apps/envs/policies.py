"""Policies to compare with what is learned: holding still, random actions, and the built-in gait by actions."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Bool, Float

from suchus.apps.envs.senses import decode_observations, is_crank, reading_columns
from suchus.apps.envs.shelf import MAX_STEPS
from suchus.apps.envs.task import Task
from suchus.apps.envs.vector import CrocodileVectorEnv
from suchus.robot.control import Control, Controller, HeadingHold, Runs
from suchus.robot.design import layout
from suchus.robot.design.scale import control_period
from suchus.robot.motion import Gait, Steer, cycle_targets, movement

Policy = Callable[[Float[np.ndarray, "run n"]], Float[np.ndarray, "run servo"]]
"""Function from observations to actions."""


@dataclass(frozen=True, slots=True)
class HoldStill:
    """All actions are zero: the posture in which the episode begins is held."""

    task: Task
    """The task, for whose robot the actions are."""

    def __call__(self, observations: Float[np.ndarray, "run n"]) -> Float[np.ndarray, "run servo"]:
        """Return zeros."""
        return np.zeros((len(observations), len(layout(self.task.robot).servos)))


@dataclass(slots=True)
class RandomActions:
    """Actions drawn uniformly from -1 to 1."""

    task: Task
    """The task, for whose robot the actions are."""
    random: np.random.Generator
    """Random generator."""

    def __call__(self, observations: Float[np.ndarray, "run n"]) -> Float[np.ndarray, "run servo"]:
        """Return random actions."""
        return self.random.uniform(-1.0, 1.0, (len(observations), len(layout(self.task.robot).servos)))


@dataclass(frozen=True, slots=True, kw_only=True)
class GaitFollower:
    """A gait that follows the clock of the observation and, where limbs are cranks, the angles of the cranks."""

    task: Task
    """The task, for whose robot the actions are."""
    centre: tuple[float, ...]
    """Servo angles of an action of zero, ``Pack.centre`` [rad]."""
    gait: Gait
    """The gait; it is played with the period of the task's gait."""

    def __call__(self, observations: Float[np.ndarray, "run n"]) -> Float[np.ndarray, "run servo"]:
        """Return the actions that bring the servos to the gait's angles at the end of the step."""
        task, gait, robot = self.task, self.gait, self.task.robot
        sine, cosine = reading_columns(observations, "clock", robot, task.observed).astype(float).T
        clock = np.arctan2(sine, cosine) / (2 * np.pi) + task.decision / task.gait.period
        targets = cycle_targets(robot, gait, clock)
        actions = (targets - np.array(self.centre)) / task.span
        cranks = is_crank(robot)
        if cranks.any():
            crank_error = targets - np.pi * reading_columns(observations, "servo_position", robot, task.observed)
            speed = np.array([robot.servo(name).speed for name in layout(robot).servos])
            crank_actions = (np.mod(crank_error + np.pi, 2 * np.pi) - np.pi) / (task.decision * speed)
            actions = np.where(cranks, crank_actions, actions)
        return np.clip(actions, -1.0, 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class SwimToGoal:
    """The task's swim by the clock of the observation, steered towards the goal by a mean bend."""

    task: Task
    """The task; it begins swimming and has a goal."""
    centre: tuple[float, ...]
    """Servo angles of an action of zero, ``Pack.centre`` [rad]."""
    hold: HeadingHold = field(default_factory=HeadingHold)
    """Gain and bends of the steering, driven by the present bearing of the goal; the state is not used."""

    def __call__(self, observations: Float[np.ndarray, "run n"]) -> Float[np.ndarray, "run servo"]:
        """Return the actions that bring the servos to the steered swim's angles at the end of the step."""
        task, robot = self.task, self.task.robot
        swim = movement(robot, task.swimming_gait)
        sine, cosine = reading_columns(observations, "clock", robot, task.observed).astype(float).T
        clock = np.arctan2(sine, cosine) / (2 * np.pi) + task.decision / task.period
        direction = reading_columns(observations, "goal_direction", robot, task.observed).astype(float)
        hinge_counts = np.clip(self.hold.gain * np.arctan2(direction[:, 1], direction[:, 0]), -1.0, 1.0)
        steer = Steer(bend=self.hold.trunk_turn * hinge_counts, tail=self.hold.turn * hinge_counts)
        phases = clock[:, None] + np.array(swim.gaits[0].limb_phases)
        targets = swim.targets(phases, swim.axis_of_clock(clock), steer)
        return np.clip((targets - np.array(self.centre)) / task.span, -1.0, 1.0)


class ControllerPolicy:
    """A controller of the catalog that reads the observations; it has state, so use one for each ``play``.

    It is called in every control period with the observation of the present step; its commands for air are ignored.

    Args:
        task: the task.
        centre: servo angles of an action of zero, ``Pack.centre`` [rad].
        control: the controller, as ``Run.control`` takes it.
        steps: greatest number of steps of an episode.
        gait: the gait of the run that it controls; that of the task if None.

    Raises:
        SuchusError: on the first call, if the controller does not suit the robot or its gait.
    """

    def __init__(
        self, task: Task, centre: tuple[float, ...], control: Control, *, steps: int, gait: Gait | None = None
    ) -> None:
        self._task, self._centre, self._control = task, np.array(centre), control
        self._gait = gait or task.gait
        self._period = control_period(task.robot)
        self._per_step = round(task.decision / self._period)
        self._ticks, self._tick = steps * self._per_step, 0
        self._controller: Controller | None = None

    def __call__(self, observations: Float[np.ndarray, "run n"]) -> Float[np.ndarray, "run servo"]:
        """Call the controller for every control period of the step and return the last commanded angles as actions."""
        task, count = self._task, len(observations)
        if self._controller is None:
            runs = Runs.identical(self._control, task.robot, self._gait, count=count, ticks=self._ticks)
            self._controller = self._control.start(runs, self._period)
        sensed = decode_observations(observations, task.robot, self._tick * self._period)
        for _ in range(self._per_step):
            targets = self._controller.command(self._tick, sensed).targets
            self._tick += 1
        return np.asarray(np.clip((targets - self._centre) / task.span, -1.0, 1.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class EpisodeResults:
    """Results of episodes, one entry for each."""

    returns: Float[np.ndarray, " episode"]
    """Sum of the rewards [-]."""
    durations: Float[np.ndarray, " episode"]
    """Duration of the episode [s]."""
    forward: Float[np.ndarray, " episode"]
    """Displacement along the world's x axis [m]."""
    approach: Float[np.ndarray, " episode"]
    """Decrease of the distance that remains to the goal; 0 without a goal [m]."""
    goal: Bool[np.ndarray, " episode"]
    """Whether the goal was reached [-]."""


def play(task: Task, policy: Policy, *, episodes: int = 32, seed: int = 0, steps: int = MAX_STEPS) -> EpisodeResults:
    """Play episodes side by side and return their results.

    Args:
        task: the task.
        policy: function from observations to actions.
        episodes: number of episodes.
        seed: seed of the first episode; each further one has the next number.
        steps: number of steps after which an episode ends.
    """
    env = CrocodileVectorEnv(episodes, task, max_episode_steps=steps)
    observations, _ = env.reset(seed=seed)
    is_running = np.ones(episodes, dtype=bool)
    returns, durations, forward, approach = np.zeros((4, episodes))
    goal = np.zeros(episodes, dtype=bool)
    while is_running.any():
        observations, rewards, terminated, truncated, infos = env.step(policy(observations))
        returns += np.where(is_running, rewards, 0.0)
        durations += is_running * task.decision
        forward += np.where(is_running, infos["forward"], 0.0)
        approach += np.where(is_running, infos["approach"], 0.0)
        goal |= is_running & infos["goal"]
        is_running &= ~(terminated | truncated)
    return EpisodeResults(returns=returns, durations=durations, forward=forward, approach=approach, goal=goal)

"""One robot as a ``gymnasium.Env``: its spaces, the checks of what users give, and its picture, without OpenGL."""

from functools import lru_cache
from typing import Any

import gymnasium
import numpy as np
from jaxtyping import Float, UInt8

from suchus.apps.envs.pack import Pack
from suchus.apps.envs.senses import senses
from suchus.apps.envs.shelf import resolve_task
from suchus.apps.envs.task import TERMS, Task, Terms
from suchus.core.errors import OutsideLimits, UnknownName
from suchus.robot.control.observation import observation_layout
from suchus.robot.design import Robot, layout
from suchus.sim.land.lake import up_direction
from suchus.visual.replay.rendering import Renderer, Scenery
from suchus.visual.skin import Poses, bone_names

RENDER_MODES = ("rgb_array",)


def action_space(robot: Robot) -> Any:
    """Return the ``gymnasium.spaces.Box`` of a robot's actions: one number of -1 to 1 for each servo."""
    return gymnasium.spaces.Box(-1.0, 1.0, (len(layout(robot).servos),), np.float32)


def observation_space(robot: Robot, *, goal: bool = False, readings: tuple[str, ...] | None = None) -> Any:
    """Return the ``gymnasium.spaces.Box`` of a robot's observations.

    Args:
        robot: the robot.
        goal: whether the task has a goal, see ``senses.senses``.
        readings: readings of the observation, as ``Task.observed``; None for those of a task with or without a goal.
    """
    columns = senses(robot, goal=goal) if readings is None else observation_layout(robot, readings)
    return gymnasium.spaces.Box(-1.0, 1.0, (columns[-1].columns.stop,), np.float32)


def checked(actions: Any, shape: tuple[int, ...]) -> Float[np.ndarray, "*b servo"]:
    """Return actions as numbers.

    Raises:
        OutsideLimits: they have another shape, or are not finite.
    """
    action_values = np.asarray(actions, dtype=float)
    if action_values.shape != shape:
        raise OutsideLimits(
            f"actions have the shape {action_values.shape}; {shape} is needed: one number for each servo."
        )
    if not np.isfinite(action_values).all():
        raise OutsideLimits("an action is not a finite number; -1 to 1 is allowed.")
    return action_values


def check_render_mode(mode: str | None) -> None:
    """Refuse an unknown render mode.

    Raises:
        UnknownName: the message lists those that are.
    """
    if mode is not None and mode not in RENDER_MODES:
        raise UnknownName("render mode", mode, RENDER_MODES)


class CrocodileEnv(gymnasium.Env):  # type: ignore[misc]  # gymnasium is not read by mypy
    """A robot at a task: a pack of one, see ``Pack``.

    Args:
        task: the task, or its name.
        render_mode: None or ``rgb_array``.
        **changes: fields of the task to change; ``robot`` and ``gait`` also by name.

    Raises:
        UnknownName: no such task, field or render mode.
        InvalidDesign: a value that makes no sense.
    """

    metadata: dict[str, Any] = {"render_modes": list(RENDER_MODES)}  # noqa: RUF012  gymnasium reads it off the class

    def __init__(self, task: Task | str = "Crawl", render_mode: str | None = None, **changes: Any) -> None:
        check_render_mode(render_mode)
        self.task = resolve_task(task, changes)
        self.pack = Pack(self.task, 1)
        self.action_space = action_space(self.task.robot)
        self.observation_space = observation_space(self.task.robot, readings=self.task.observed)
        self.render_mode = render_mode
        self.metadata = metadata(self.task)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begin an episode; equal seeds give equal episodes.

        Args:
            seed: seed of everything that is left to chance; None goes on with the last one.
            options: none are known.

        Returns:
            The observation, and ``time`` and ``fault``.
        """
        super().reset(seed=seed)
        del options
        self.pack.restart([0], [self.np_random])
        return self.pack.feel()[0], {"time": 0.0, "fault": self.pack.chances[0].fault}

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Act once.

        Args:
            action: one number of -1 to 1 for each servo; what is beyond counts as -1 or 1.

        Returns:
            Observation; reward; whether it fell or reached its goal; False, since time limits are a wrapper's; and the
            terms of the reward, ``time``, ``fault`` and ``cause``, the sentence that says why the episode ended.

        Raises:
            OutsideLimits: an action of another shape, or not finite.
        """
        terms = self.pack.act(checked(action, self.action_space.shape)[None], np.ones(1, dtype=bool))
        info = {name: values.tolist()[0] for name, values in step_info(self.pack, terms).items()}
        return self.pack.feel()[0], float(terms.reward(self.task.rewards)[0]), bool(terms.is_over[0]), False, info

    def render(self) -> np.ndarray | None:
        """Return a picture of (480, 640, 3) for ``rgb_array``, else None."""
        return portrait(self.pack, 0) if self.render_mode == "rgb_array" else None


def step_info(pack: Pack, terms: Terms) -> dict[str, np.ndarray]:
    """Return the entries of ``info`` after a step, each with one value for each robot."""
    info = {name: getattr(terms, name) for name in TERMS if name != "fall"}
    return info | {"time": pack.time, "fault": pack.faults.copy(), "cause": pack.causes.copy()}


def portrait(pack: Pack, robot: int) -> UInt8[np.ndarray, "height width 3"]:
    """Return a picture of one robot of a pack in the look of the replays, as red, green and blue.

    Water is blue; the goal is a ring, or a line where it is land, and an arrow points to one that is out of sight.
    """
    task, sensors = pack.task, pack.loop.sensors
    place = layout(task.robot)
    positions, quaternions = pack.loop.batch.body_poses(robot, bone_names(task.robot))
    feet = np.array([sensors[f"{limb}_foot_position"][robot] for limb in place.limb_names]).reshape(-1, 3)
    scenery = Scenery(
        upward=up_direction(task.ground),
        level=None if task.lake is None else task.lake.state_at(0.0)[0],
        goal=None if task.goal is None else pack.goals[robot],
        goal_radius=0.0 if task.goal is None else task.goal.within,
        relief=task.ground.relief,
        text=f"{pack.time[robot]:.2f} s  {pack.chances[robot].fault}",
    )
    mass = np.array(sensors["centre_of_mass"][robot])
    return _renderer(task.robot).render(Poses(positions, quaternions), feet, mass, scenery)


@lru_cache(maxsize=4)
def _renderer(robot: Robot) -> Renderer:
    """Return what draws a robot, the same for all environments with it."""
    return Renderer(robot)


def metadata(task: Task) -> dict[str, Any]:
    """Return render modes and frame rate, as gymnasium's ``metadata``."""
    return {"render_modes": list(RENDER_MODES), "render_fps": round(1.0 / task.decision)}

"""Many robots as one ``gymnasium.vector.VectorEnv``: all of them are one batch of physics."""

from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space

from suchus.apps.envs.pack import Pack
from suchus.apps.envs.shelf import resolve_task
from suchus.apps.envs.single import (
    action_space,
    check_render_mode,
    checked,
    metadata,
    observation_space,
    portrait,
    step_info,
)
from suchus.apps.envs.task import Task
from suchus.core.checks import require
from suchus.core.errors import InvalidDesign

_AT_RESET = ("time", "fault")  # entries of ``info`` when an episode begins


class CrocodileVectorEnv(gymnasium.vector.VectorEnv):  # type: ignore[misc]  # gymnasium is not read by mypy
    """Robots at a task, each in an episode of its own, with the numbers of as many single environments.

    Args:
        num_envs: number of robots.
        task: the task, or its name.
        max_episode_steps: number of steps after which an episode is truncated; None: never.
        autoreset_mode: how episodes begin anew, see gymnasium: ``NextStep``, ``SameStep`` or ``Disabled``.
        render_mode: None or ``rgb_array``.
        **changes: fields of the task to change; ``robot`` and ``gait`` also by name.

    Raises:
        UnknownName: no such task, field or render mode.
        InvalidDesign: a value that makes no sense.
    """

    def __init__(
        self,
        num_envs: int = 1,
        task: Task | str = "Crawl",
        max_episode_steps: int | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        render_mode: str | None = None,
        **changes: Any,
    ) -> None:
        check_render_mode(render_mode)
        require("make_vec", "num_envs", num_envs, 1, 100_000, "")
        self.task = resolve_task(task, changes)
        self.pack = Pack(self.task, num_envs)
        self.num_envs, self.max_episode_steps, self.render_mode = num_envs, max_episode_steps, render_mode
        self.autoreset_mode = _mode(autoreset_mode)
        self.metadata = {**metadata(self.task), "autoreset_mode": self.autoreset_mode}
        robot = self.task.robot
        self.single_action_space = action_space(robot)
        self.single_observation_space = observation_space(robot, readings=self.task.observed)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self._randoms = [seeding.np_random()[0] for _ in range(num_envs)]
        self._is_over = np.ones(num_envs, dtype=bool)
        self._steps = np.zeros(num_envs, dtype=int)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begin the episodes of all robots, or of those in ``options["reset_mask"]``.

        Args:
            seed: seed of the first robot, the others following by one; or one for each; None goes on with the last
                ones.
            options: ``reset_mask``, booleans of shape (num_envs,).

        Raises:
            InvalidDesign: not as many seeds as robots, or a mask of another shape.
        """
        mask = _mask(options, self.num_envs)
        for i, episode_seed in enumerate(_seeds(seed, self.num_envs)):
            if episode_seed is not None and mask[i]:
                self._randoms[i] = seeding.np_random(episode_seed)[0]
        self._restart(mask)
        infos: dict[str, Any] = {}
        self._add_infos(infos, self._beginnings(), mask)
        return self.pack.feel(), infos

    def step(self, actions: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Act once with every robot; with ``NextStep`` those whose episode is over begin a new one instead.

        Raises:
            OutsideLimits: actions of another shape, or not finite.
            gymnasium.error.ResetNeeded: an episode is over and ``autoreset_mode`` is ``Disabled``.
        """
        action_values = checked(actions, self.action_space.shape)
        was_over = self._is_over.copy()
        if self.autoreset_mode is not AutoresetMode.NEXT_STEP and was_over.any():
            raise gymnasium.error.ResetNeeded(f"the episodes of robots {np.flatnonzero(was_over).tolist()} are over.")
        terms = self.pack.act(action_values, ~was_over)
        self._steps[~was_over] += 1
        rewards = np.where(was_over, 0.0, terms.reward(self.task.rewards))
        terminated = ~was_over & terms.is_over
        has_timed_out = self._steps >= (self.max_episode_steps or np.inf)
        truncated = ~was_over & has_timed_out
        step_values = step_info(self.pack, terms)
        self._is_over = terminated | truncated
        infos: dict[str, Any] = {}
        new_mask = was_over
        if self.autoreset_mode is AutoresetMode.SAME_STEP and self._is_over.any():
            new_mask = self._is_over.copy()
            self._add_final_infos(infos, step_values, new_mask)
        self._add_infos(infos, step_values, ~new_mask)
        if new_mask.any():
            self._restart(new_mask)
            self._add_infos(infos, self._beginnings(), new_mask)
        return self.pack.feel(), rewards, terminated, truncated, infos

    def render(self) -> tuple[np.ndarray, ...] | None:
        """Return a picture of each robot for ``rgb_array``, else None."""
        if self.render_mode != "rgb_array":
            return None
        return tuple(portrait(self.pack, i) for i in range(self.num_envs))

    def _restart(self, mask: np.ndarray) -> None:
        robots = np.flatnonzero(mask).tolist()
        self.pack.restart(robots, [self._randoms[i] for i in robots])
        self._steps[mask], self._is_over[mask] = 0, False

    def _beginnings(self) -> dict[str, np.ndarray]:
        return dict(zip(_AT_RESET, (self.pack.time, self.pack.faults.copy()), strict=True))

    def _add_infos(self, infos: dict[str, Any], values_by_name: dict[str, np.ndarray], mask: np.ndarray) -> None:
        """Add values of some robots to ``infos``, and under ``_NAME`` the mask of these robots.

        Args:
            infos: to add to; earlier values of other robots stay.
            values_by_name: one value for each robot, (num_envs,).
            mask: the robots whose values are added, (num_envs,).
        """
        if not mask.any():
            return
        if mask.all():
            infos |= values_by_name | {f"_{name}": mask.copy() for name in values_by_name}
            return
        for name, values in values_by_name.items():
            default = np.full(self.num_envs, None) if values.dtype == object else np.zeros_like(values)
            infos[name] = np.where(mask, values, infos.get(name, default))
            infos[f"_{name}"] = infos.get(f"_{name}", np.zeros(self.num_envs, dtype=bool)) | mask

    def _add_final_infos(self, infos: dict[str, Any], values_by_name: dict[str, np.ndarray], mask: np.ndarray) -> None:
        """Add last observations and values of the robots whose episodes end now, as gymnasium names them."""
        observations, final_observations = self.pack.feel(), np.full(self.num_envs, None)
        for i in np.flatnonzero(mask):
            final_observations[i] = observations[i].copy()
        final_info: dict[str, Any] = {}
        self._add_infos(final_info, values_by_name, mask)
        infos.update(
            final_obs=final_observations, _final_obs=mask.copy(), final_info=final_info, _final_info=mask.copy()
        )


def _mode(mode: AutoresetMode | str) -> Any:
    """Return the mode of automatic resets that a word names; refuse an unknown one."""
    try:
        return AutoresetMode(mode)
    except ValueError as error:
        allowed = ", ".join(repr(mode_member.value) for mode_member in AutoresetMode)
        raise InvalidDesign(f"autoreset_mode is {mode!r}; {allowed} are allowed.") from error


def _seeds(seed: int | Sequence[int | None] | None, count: int) -> list[int | None]:
    """Return one seed for each robot, None where a robot keeps its random generator."""
    if seed is None:
        return [None] * count
    if isinstance(seed, (int, np.integer)):
        return [int(seed) + i for i in range(count)]
    if len(seed) != count:
        raise InvalidDesign(f"there are {len(seed)} seeds for {count} robots; one each is needed, or one number.")
    return list(seed)


def _mask(options: dict[str, Any] | None, count: int) -> np.ndarray:
    """Return which robots are reset, (num_envs,); refuse a mask of another shape or type."""
    if not options or "reset_mask" not in options:
        return np.ones(count, dtype=bool)
    mask = np.asarray(options["reset_mask"])
    if mask.shape != (count,) or mask.dtype != bool or not mask.any():
        raise InvalidDesign(
            f"reset_mask has the shape {mask.shape} and holds {mask.dtype}; {count} booleans are needed, one true."
        )
    return mask

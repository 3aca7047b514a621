"""The spaces of one robot, and the checks of what users give."""

from typing import Any

import numpy as np
from jaxtyping import Float

from suchus.design import Robot, layout
from suchus.envs.senses import senses
from suchus.errors import OutsideLimits, SuchusError, UnknownName


class NoGymnasium(SuchusError, ImportError):
    """The environments without the library that they are for."""


try:
    import gymnasium
except ImportError as _error:
    raise NoGymnasium("environments need gymnasium; install it with: pip install 'suchus[gym]'.") from _error

RENDER_MODES = ("rgb_array",)


def action_space(robot: Robot) -> Any:
    """Return the ``gymnasium.spaces.Box`` of a robot's actions: one number of -1 to 1 for each servo."""
    return gymnasium.spaces.Box(-1.0, 1.0, (len(layout(robot).servos),), np.float32)


def observation_space(robot: Robot, *, goal: bool = False) -> Any:
    """Return the ``gymnasium.spaces.Box`` of a robot's observations, with or without a goal: see ``senses.senses``."""
    return gymnasium.spaces.Box(-1.0, 1.0, (senses(robot, goal=goal)[-1].columns.stop,), np.float32)


def checked(actions: Any, shape: tuple[int, ...]) -> Float[np.ndarray, "*b servo"]:
    """Return actions as numbers.

    Raises:
        OutsideLimits: they have another shape, or are not finite.
    """
    numbers = np.asarray(actions, dtype=float)
    if numbers.shape != shape:
        raise OutsideLimits(f"actions have the shape {numbers.shape}; {shape} is needed: one number for each servo.")
    if not np.isfinite(numbers).all():
        raise OutsideLimits("an action is not a finite number; -1 to 1 is allowed.")
    return numbers


def check_render_mode(mode: str | None) -> None:
    """Refuse a way of rendering that is not there.

    Raises:
        UnknownName: the message lists those that are.
    """
    if mode is not None and mode not in RENDER_MODES:
        raise UnknownName("render mode", mode, RENDER_MODES)

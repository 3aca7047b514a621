"""Goals of a task: a point, or a distance beyond the water line of a shore."""

from dataclasses import dataclass
from math import pi, sin

import numpy as np
from jaxtyping import Float

from suchus.design.checks import Checks
from suchus.design.ground import Ground
from suchus.errors import InvalidDesign
from suchus.land import Lake


@dataclass(frozen=True, slots=True, kw_only=True)
class Goal:
    """A point on the ground or the water, drawn anew for each episode; reached by the centre of mass."""

    distance: float = 1.2
    """Distance of the goal from the centre of mass at the beginning, 0.01 to 1000 [m]."""
    bearing: float = 0.5
    """Greatest bearing of the goal to either side of straight ahead, from which it is drawn evenly, 0 to pi [rad]."""
    within: float = 0.1
    """Horizontal distance at which the goal is reached, 0.001 to 100, less than ``distance`` [m]."""

    def __post_init__(self) -> None:
        with Checks("goal", self) as check:
            check.number("distance", 0.01, 1000.0, "m")
            check.number("bearing", 0.0, pi, "rad")
            check.number("within", 1e-3, 100.0, "m")
            check.that(
                not self.within >= self.distance,
                f"goal.within is {self.within:g} m and goal.distance {self.distance:g} m; within must be less, or the "
                "episode ends where it begins",
            )

    def check(self, ground: Ground, lake: Lake | None) -> None:
        """Accept every ground and lake."""

    def draw(self, random: np.random.Generator) -> float:
        """Return the bearing of the goal of one episode, left positive [rad]."""
        return float(random.uniform(-self.bearing, self.bearing))

    def place(
        self, begin: Float[np.ndarray, "2"], bearing: float, ground: Ground, lake: Lake | None
    ) -> Float[np.ndarray, "2"]:
        """Return where the goal of one episode is, forward and left in the world [m].

        Args:
            begin: the centre of mass at the beginning [m].
            bearing: as drawn [rad].
            ground: not looked at.
            lake: not looked at.
        """
        del ground, lake
        return begin + self.distance * np.array([np.cos(bearing), np.sin(bearing)])

    def offset(self, place: Float[np.ndarray, "run 2"], goal: Float[np.ndarray, "run 2"]) -> Float[np.ndarray, "run 2"]:
        """Return the vectors from centres of mass to their goals [m]."""
        return goal - place


@dataclass(frozen=True, slots=True, kw_only=True)
class Landing:
    """Land beyond the water line of a shore that rises ahead; reached by the centre of mass, wherever along it."""

    beyond: float = 1.0
    """Distance beyond the water line, up the slope, 0 to 1000 [m]."""

    def __post_init__(self) -> None:
        with Checks("landing", self) as check:
            check.number("beyond", 0.0, 1000.0, "m")

    @property
    def within(self) -> float:
        """Distance from the goal at which it is reached: none [m]."""
        return 0.0

    def check(self, ground: Ground, lake: Lake | None) -> None:
        """Refuse a world without a shore ahead.

        Raises:
            InvalidDesign: there is no lake, or the ground does not rise ahead.
        """
        if lake is None or not ground.uphill > 0.0:
            raise InvalidDesign(
                f"task.goal is a Landing, task.lake is {'None' if lake is None else 'a lake'} and task.ground.uphill "
                f"{ground.uphill:g} rad; it needs a lake and ground that rises ahead: give both, or another goal."
            )

    def draw(self, random: np.random.Generator) -> float:
        """Return straight ahead, without a draw [rad]."""
        del random
        return 0.0

    def place(
        self, begin: Float[np.ndarray, "2"], bearing: float, ground: Ground, lake: Lake | None
    ) -> Float[np.ndarray, "2"]:
        """Return a point on the line that has to be reached, forward and left in the world [m].

        Args:
            begin: the centre of mass at the beginning [m].
            bearing: not looked at.
            ground: whose slope is the shore.
            lake: whose level at the beginning makes the water line.
        """
        del bearing
        assert lake is not None  # see ``check``
        return np.array([lake.at(0.0)[0] / sin(ground.uphill) + self.beyond, begin[1]])

    def offset(self, place: Float[np.ndarray, "run 2"], goal: Float[np.ndarray, "run 2"]) -> Float[np.ndarray, "run 2"]:
        """Return the vectors from centres of mass straight up the shore to the line, zero beyond it [m]."""
        ahead = np.maximum(goal[:, 0] - place[:, 0], 0.0)
        return np.stack([ahead, np.zeros_like(ahead)], axis=1)


AnyGoal = Goal | Landing


def remaining(goal: AnyGoal, offset: Float[np.ndarray, "run 2"]) -> Float[np.ndarray, " run"]:
    """Return the distance that remains until a goal is reached, 0 from then on [m].

    Args:
        goal: the goal.
        offset: from the centres of mass to it [m].
    """
    return np.asarray(np.maximum(np.hypot(offset[:, 0], offset[:, 1]) - goal.within, 0.0))

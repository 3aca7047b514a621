"""The interface of a controller: a frozen setting that starts the controller of a batch."""

from dataclasses import fields
from typing import Any, NamedTuple, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from suchus.robot.control.sensed import Sensed
from suchus.robot.design import Robot
from suchus.robot.motion import Gait


class Command(NamedTuple):
    """The command of a controller for one control period."""

    targets: Float[np.ndarray, "run servo"]
    """Servo angles [rad]."""
    phase: Float[np.ndarray, "run limb"]
    """Phase of each limb, not wrapped [cycle]."""
    air_fraction: Float[np.ndarray, "run 2"] | None = None
    """Share of the air that is kept in the front and in the rear chambers of each robot's hull, 0 to 1, NaN to leave it
    to the lake [-]; None for all."""


@runtime_checkable
class Controller(Protocol):
    """A running controller of a batch; it may keep state."""

    def rest(self) -> Float[np.ndarray, "run servo"]:
        """Return the servo angles in which the robots are put on the ground [rad]."""

    def command(self, tick: int, sensed: Sensed | None) -> Command:
        """Answer for control period ``tick``; ``sensed`` is None where ``Control.feels`` is false."""


SENSED = tuple(field.name for field in fields(Sensed) if field.name != "time")
"""What a robot can sense: the fields of ``Sensed``, the time aside."""


def union_of_needs(*rule_needs: tuple[str, ...]) -> tuple[str, ...]:
    """Return the sensors that any of several rules needs, in the order of ``Sensed``."""
    return tuple(name for name in SENSED if any(name in names for names in rule_needs))


def needs(control: "Control") -> tuple[str, ...]:
    """Return the sensors that a control needs: its property ``needs``, else all fields of ``Sensed`` if it reads any.

    A simulated robot has all sensors, a real one those that it is built with.
    """
    return tuple(getattr(control, "needs", SENSED if control.feels else ()))


class Runs(NamedTuple):
    """The runs of a batch as a controller sees them, one entry for each."""

    controls: tuple[Any, ...]
    """Settings, all of one class."""
    robots: tuple[Robot, ...]
    """Designs, all of one layout."""
    gaits: tuple[Gait, ...]
    """Gaits."""
    seeds: tuple[int, ...]
    """Seeds of whatever is random."""
    ticks: int
    """Number of control periods to come."""

    @classmethod
    def identical(cls, control: Any, robot: Robot, gait: Gait, *, count: int = 1, ticks: int = 1) -> "Runs":
        """Return several equal runs, all with the seed 0."""
        return cls((control,) * count, (robot,) * count, (gait,) * count, (0,) * count, ticks)


@runtime_checkable
class Control(Protocol):
    """A controller as a setting of a run; runs of a batch whose controls have one class share one controller.

    A control that reads sensors may name them in a property ``needs``; see the function of that name.
    """

    @property
    def feels(self) -> bool:
        """Whether the controller reads sensors."""

    @staticmethod
    def start(runs: Runs, period: float) -> Controller:
        """Start the controller of some runs.

        Args:
            runs: runs whose controls are of this class, different as they may be.
            period: control period [s].
        """

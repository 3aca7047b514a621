"""The contract of a controller: a frozen setting that starts a machine for a batch."""

from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from suchus.control.sensed import Sensed
from suchus.design import AnyRobot
from suchus.motion import AnyGait


class Command(NamedTuple):
    """What a controller says for one control period."""

    targets: Float[np.ndarray, "run servo"]
    """Servo angles [rad]."""
    phase: Float[np.ndarray, "run limb"]
    """Phase of each limb, not wrapped [cycle]."""
    breath: Float[np.ndarray, "run 2"] | None = None
    """Share of the air that is kept in the front and in the rear chambers of each robot's hull, 0 to 1, NaN to leave it
    to the lake [-]; None for all."""


@runtime_checkable
class Controller(Protocol):
    """A running controller of a batch; it may keep state."""

    def rest(self) -> Float[np.ndarray, "run servo"]:
        """Return the servo angles in which the robots are put on the ground [rad]."""

    def command(self, tick: int, sensed: Sensed | None) -> Command:
        """Answer for control period ``tick``; ``sensed`` is None where ``Control.feels`` is false."""


@runtime_checkable
class Control(Protocol):
    """A controller as a value on a run; runs with equal values share one running controller."""

    @property
    def feels(self) -> bool:
        """Whether it wants to know what the robot senses."""

    def start(
        self,
        robots: Sequence[AnyRobot],
        gaits: Sequence[AnyGait],
        seeds: Sequence[int],
        ticks: int,
        period: float,
    ) -> Controller:
        """Start the controller for a batch: one robot, gait and seed per run.

        Args:
            robots: the designs.
            gaits: the gaits.
            seeds: for whatever is random.
            ticks: number of control periods to come.
            period: of control [s].
        """


@runtime_checkable
class Joinable(Control, Protocol):
    """A control whose values, different as they may be, can steer the runs of one batch together."""

    @staticmethod
    def start_together(
        controls: Sequence[Any],
        robots: Sequence[AnyRobot],
        gaits: Sequence[AnyGait],
        seeds: Sequence[int],
        ticks: int,
        period: float,
    ) -> Controller:
        """Start the controller for a batch: one control, robot, gait and seed per run; see ``Control.start``."""

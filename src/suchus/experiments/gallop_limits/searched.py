"""A gait that a search found, with a trunk that bends up and down."""

from dataclasses import dataclass, replace

import numpy as np

from suchus.design import Robot, layout
from suchus.design.checks import Checks
from suchus.motion import AngleTable, Curve, Gait, as_table

_SAMPLES = 32  # of a cycle


@dataclass(frozen=True, slots=True, kw_only=True)
class Searched:
    """A gait that a search found for one kind of servo: feet as a gait says, and a trunk that bends up and down too."""

    servo_speed: float
    """No-load speed of the servos with which it was searched [rad/s]."""
    gait: Gait
    """Gait that gives the paths of the feet."""
    trunk_mean: float
    """Mean vertical bend of the trunk, down positive [rad]."""
    trunk_amplitude: float
    """Amplitude of the vertical bend of the trunk [rad]."""
    trunk_phase: float
    """When in the cycle the trunk is bent down most [cycle]."""

    def __post_init__(self) -> None:
        with Checks("searched", self) as check:
            check.number("servo_speed", 0.1, 1e3, "rad/s")
            check.number("trunk_mean", -1.0, 1.0, "rad")
            check.number("trunk_amplitude", 0.0, 1.5, "rad")
            check.number("trunk_phase", -1.0, 1.0, "cycle")

    def table(self, robot: Robot) -> AngleTable:
        """Return the gait as a table of servo angles."""
        table = as_table(robot, self.gait, _SAMPLES)
        place = layout(robot)
        pitch = [place.servos[i] for i in place.trunk_pitch]
        clock = np.arange(_SAMPLES) / _SAMPLES - self.trunk_phase
        bend = (self.trunk_mean + self.trunk_amplitude * np.cos(2 * np.pi * clock)) / len(pitch)
        others = tuple(curve for curve in table.curves if curve.servo not in pitch)
        return replace(table, curves=(*others, *(Curve(servo=name, angles=tuple(bend)) for name in pitch)))

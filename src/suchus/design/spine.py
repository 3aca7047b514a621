"""The trunk: five hinges in a row, yaw and pitch in turn."""

from dataclasses import dataclass

from suchus.design.checks import Checks
from suchus.design.servo import Servo


@dataclass(frozen=True, slots=True, kw_only=True)
class Spine:
    """From the pelvis forward: yaw, pitch, yaw, pitch, yaw; +yaw bends left, +pitch bends down.

    The D-H base frame is the pelvis: x forward, y left, z up.

    Paper: Figs 4, 8.
    """

    base: float
    """From the hind girdle's axis to the first joint, the table's a0 [m]."""
    link: float
    """From each joint to the next, the table's a1 to a4 [m]."""
    radius: float
    """Radius of the trunk's links [m]."""
    link_mass: float
    """Of each of the four links between the five joints [kg]."""
    yaw_range: tuple[float, float]
    """Limits of each yaw joint [rad]."""
    pitch_range: tuple[float, float]
    """Limits of each pitch joint [rad]."""
    yaw_servo: Servo
    """The servo of each yaw joint."""
    pitch_servo: Servo
    """The servo of each pitch joint: it carries the forebody as a cantilever when the robot rises."""

    def __post_init__(self) -> None:
        with Checks("spine", self) as check:
            check.number("base", 0.005, 2.0, "m")
            check.number("link", 0.01, 1.0, "m")
            check.number("radius", 0.005, 0.5, "m")
            check.number("link_mass", 0.01, 20.0, "kg")
            check.range("yaw_range", -3.1416, 3.1416, "rad")
            check.range("pitch_range", -3.1416, 3.1416, "rad")

    @property
    def length(self) -> float:
        """From the hind girdle's axis to the fifth joint when straight [m]."""
        return self.base + 4 * self.link

"""The trunk: hinges in a row, yaw and pitch in turn; five in the article."""

from dataclasses import dataclass

from suchus.design.checks import Checks
from suchus.design.servo import Servo

ARTICLE_JOINTS = 5
"""Joints of the article's spine [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Spine:
    """From the pelvis forward: yaw, pitch, yaw, pitch, yaw and so on; +yaw bends left, +pitch bends down.

    The D-H base frame is the pelvis: x forward, y left, z up.

    Paper: Figs 4, 8.
    """

    base: float
    """Distance from the hind girdle's axis to the first joint, the table's a0 [m]."""
    link: float
    """Length from each joint to the next, the table's a1 to a4 [m]."""
    radius: float
    """Radius of the trunk's links [m]."""
    link_mass: float
    """Mass of each of the links between the joints [kg]."""
    yaw_range: tuple[float, float]
    """Limits of each yaw joint [rad]."""
    pitch_range: tuple[float, float]
    """Limits of each pitch joint [rad]."""
    yaw_servo: Servo
    """The servo of each yaw joint."""
    pitch_servo: Servo
    """The servo of each pitch joint: it carries the forebody as a cantilever when the robot rises."""
    joints: int = ARTICLE_JOINTS
    """Number of joints; the article's closed forms are for five [-]."""

    def __post_init__(self) -> None:
        with Checks("spine", self) as check:
            check.number("base", 1e-4, 10.0, "m")
            check.number("link", 1e-4, 10.0, "m")
            check.number("radius", 1e-5, 10.0, "m")
            check.number("link_mass", 1e-8, 1e4, "kg")
            check.whole("joints", 1, 15)
            check.range("yaw_range", -3.1416, 3.1416, "rad")
            check.range("pitch_range", -3.1416, 3.1416, "rad")

    @property
    def length(self) -> float:
        """Length from the hind girdle's axis to the last joint when straight [m]."""
        return self.base + (self.joints - 1) * self.link

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the joints from the pelvis forward."""
        return tuple(f"spine_{'pitch' if i % 2 else 'yaw'}_{i // 2 + 1}" for i in range(self.joints))

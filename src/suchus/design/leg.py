"""A leg: yaw and pitch axes that meet at the hip, a knee, and a ball for a foot."""

from dataclasses import dataclass

from suchus.design.checks import Checks
from suchus.design.servo import Servo

LEG_SHARES = (0.60, 0.35, 0.05)
"""How a leg's mass is spread over femur, tibia and foot [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Leg:
    """One girdle's left leg; the right one is its mirror image.

    The D-H base frame stands on the midline: x outward, y forward, z down.

    Paper: Figs 3, 6.
    """

    hip_offset: float
    """Distance from the midline to the hip's yaw axis, the table's a0 [m]."""
    femur: float
    """Length from hip to knee, the table's a2 [m]."""
    tibia: float
    """Length from knee to the foot's centre, the table's a3 [m]."""
    foot_radius: float
    """Radius of the spherical foot [m]."""
    radius: float
    """Radius of femur and tibia [m]."""
    mass: float
    """Mass of one leg with its servos [kg]: 60 % in the femur, 35 % in the tibia, 5 % in the foot."""
    yaw_range: tuple[float, float]
    """Limits of the yaw joint, forward positive [rad]."""
    pitch_range: tuple[float, float]
    """Limits of the pitch joint, foot down positive [rad]."""
    knee_range: tuple[float, float]
    """Limits of the knee, shank down positive [rad]."""
    servo: Servo
    """The servo at each of the three joints."""

    def __post_init__(self) -> None:
        with Checks("leg", self) as check:
            check.number("hip_offset", 1e-5, 10.0, "m")
            check.number("femur", 1e-4, 10.0, "m")
            check.number("tibia", 1e-4, 10.0, "m")
            check.number("foot_radius", 1e-5, 1.0, "m")
            check.number("radius", 1e-5, 1.0, "m")
            check.number("mass", 1e-7, 1e4, "kg")
            for field in ("yaw_range", "pitch_range", "knee_range"):
                check.range(field, -3.1416, 3.1416, "rad")

    @property
    def reach(self) -> tuple[float, float]:
        """Nearest and farthest distance of the foot from the hip [m]."""
        return abs(self.femur - self.tibia), self.femur + self.tibia

"""A leg: yaw and pitch axes that meet at the hip, a knee, and a ball for a foot."""

from dataclasses import dataclass

from suchus.design.checks import require, require_range
from suchus.design.servo import Servo


@dataclass(frozen=True, slots=True, kw_only=True)
class Leg:
    """One girdle's left leg; the right one is its mirror image.

    The D-H base frame stands on the midline: x outward, y forward, z down.
    """

    hip_offset: float
    """From the midline to the hip's yaw axis, the table's a0 [m]."""
    femur: float
    """From hip to knee, the table's a2 [m]."""
    tibia: float
    """From knee to the foot's centre, the table's a3 [m]."""
    foot_radius: float
    """Radius of the spherical foot [m]."""
    radius: float
    """Radius of femur and tibia [m]."""
    mass: float
    """Of one leg with its servos [kg]: 60 % in the femur, 35 % in the tibia, 5 % in the foot."""
    yaw_range: tuple[float, float]
    """Limits of the yaw joint, forward positive [rad]."""
    pitch_range: tuple[float, float]
    """Limits of the pitch joint, foot down positive [rad]."""
    knee_range: tuple[float, float]
    """Limits of the knee, shank down positive [rad]."""
    servo: Servo
    """The servo at each of the three joints."""

    def __post_init__(self) -> None:
        require("leg", "hip_offset", self.hip_offset, 0.005, 1.0, "m")
        require("leg", "femur", self.femur, 0.01, 1.0, "m")
        require("leg", "tibia", self.tibia, 0.01, 1.0, "m")
        require("leg", "foot_radius", self.foot_radius, 0.002, 0.1, "m")
        require("leg", "radius", self.radius, 0.002, 0.1, "m")
        require("leg", "mass", self.mass, 0.02, 20.0, "kg")
        for field in ("yaw_range", "pitch_range", "knee_range"):
            require_range("leg", field, getattr(self, field), -3.1416, 3.1416, "rad")

    @property
    def reach(self) -> tuple[float, float]:
        """Nearest and farthest distance of the foot from the hip [m]."""
        return abs(self.femur - self.tibia), self.femur + self.tibia

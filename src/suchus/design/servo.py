"""A position servo: PID gains and what the motor can give."""

from dataclasses import dataclass

from suchus.design.checks import require


@dataclass(frozen=True, slots=True, kw_only=True)
class Servo:
    """A geared position servo with an inner PID loop."""

    kp: float
    """Proportional gain [N m/rad]."""
    ki: float
    """Integral gain [N m/(rad s)]; zero switches integral action off."""
    kd: float
    """Derivative gain [N m s/rad]."""
    integral_limit: float
    """Greatest torque that integral action may build up [N m]."""
    torque: float
    """Torque limit [N m]."""
    speed: float
    """Slew limit of the commanded angle [rad/s]: the no-load speed."""
    armature: float
    """Rotor inertia seen at the output shaft [kg m2]."""
    friction: float
    """Dry friction of the gear at the output shaft [N m]; it stays when the servo is limp."""
    damping: float
    """Viscous friction of the gear [N m s/rad]."""

    def __post_init__(self) -> None:
        require("servo", "kp", self.kp, 0.1, 1e4, "N m/rad")
        require("servo", "ki", self.ki, 0.0, 1e4, "N m/(rad s)")
        require("servo", "kd", self.kd, 0.0, 1e3, "N m s/rad")
        require("servo", "integral_limit", self.integral_limit, 0.0, 1e3, "N m")
        require("servo", "torque", self.torque, 0.01, 1e3, "N m")
        require("servo", "speed", self.speed, 0.1, 100.0, "rad/s")
        require("servo", "armature", self.armature, 1e-4, 1.0, "kg m2")
        require("servo", "friction", self.friction, 0.0, 10.0, "N m")
        require("servo", "damping", self.damping, 0.0, 10.0, "N m s/rad")

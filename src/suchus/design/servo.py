"""A position servo: PID gains and what the motor can give."""

from dataclasses import dataclass, replace

from suchus.design.checks import Checks


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
        with Checks("servo", self) as check:
            check.number("kp", 1e-9, 1e7, "N m/rad")
            check.number("ki", 0.0, 1e7, "N m/(rad s)")
            check.number("kd", 0.0, 1e6, "N m s/rad")
            check.number("integral_limit", 0.0, 1e6, "N m")
            check.number("torque", 1e-9, 1e6, "N m")
            check.number("speed", 0.01, 1e4, "rad/s")
            check.number("armature", 1e-15, 100.0, "kg m2")
            check.number("friction", 0.0, 1e4, "N m")
            check.number("damping", 0.0, 1e4, "N m s/rad")

    def with_speed_line(self) -> "Servo":
        """Return the servo with a straight torque-speed line.

        Its damping then takes away what a motor at its voltage lacks when it turns: the torque that reaches the joint
        falls from ``torque`` at rest to nothing at ``speed``. It costs the physics no time. Below saturation a real
        servo would make up for the loss; this one lags behind instead, by less than 0.08 rad at ``speed``.
        """
        return replace(self, damping=self.torque / self.speed)

"""Hinges and what moves them: a servo, a crank, a spring, or a cable over several that a servo or a screw pulls."""

from dataclasses import dataclass, replace
from math import sin
from typing import Literal, Optional, Self

import numpy as np
from jaxtyping import Float

from suchus.core.checks import Checks
from suchus.robot.design.motor import Motor, Winding


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
    """Torque limit [N m]: with a winding, the torque at standstill."""
    speed: float
    """Slew limit of the commanded angle [rad/s]: the no-load speed, friction of the gear included.

    Without a winding it limits the commanded angle alone: a load, or the loop that catches up, can turn the joint
    faster. ``with_speed_line`` gives a motor that limits the joint too."""
    armature: float
    """Rotor inertia seen at the output shaft [kg m2]."""
    friction: float
    """Dry friction of the gear at the output shaft [N m]; it stays when the servo is limp."""
    damping: float
    """Viscous friction of the gear [N m s/rad]."""
    winding: Winding | None = None
    """Its DC motor, by which torque falls with speed, supply and heat; None: full torque at any speed, for ever."""

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
            if self.winding is not None:
                check.that(
                    self._idle < _MOST_IDLE * self.torque,
                    f"friction and damping of its gear take {self._idle:.3g} N m at {self.speed:g} rad/s, of a torque "
                    f"of {self.torque:g} N m: it cannot reach that speed; give less of them, or less speed",
                )

    @property
    def _idle(self) -> float:
        """Torque that its gear takes at the speed without load [N m]."""
        return self.friction + self.damping * self.speed

    @property
    def ideal_speed(self) -> float:
        """Speed at which its motor gives nothing, above ``speed``, at which it turns its gear alone [rad/s]."""
        return self.speed / (1.0 - self._idle / self.torque)

    def available_torque(self, speed: Float[np.ndarray, "..."]) -> Float[np.ndarray, "..."]:
        """Return the greatest torque of the motor at a speed, in the direction of that torque [N m].

        Args:
            speed: speed of the shaft in that direction; negative where it is driven backwards [rad/s].
        """
        if self.winding is None:
            return np.full(np.shape(speed), self.torque)
        return np.clip(self.torque * (1.0 - np.asarray(speed) / self.ideal_speed), 0.0, self.torque)

    @staticmethod
    def from_motor(motor: Motor, volts: float | None = None, *, template: Optional["Servo"] = None) -> "Servo":
        """Return a servo that is bought, at a supply.

        Torque, speed and winding are those of the motor. Data sheets give no rotor inertia, no friction of the gear
        and no gains that suit a robot. These are taken from another servo, or, without one, in proportion to the
        torque: inertia and friction as the identified servos have them on average, gains as the article's robot has
        them. ``suchus calibrate`` measures them.

        Args:
            motor: as it is bought.
            volts: its supply [V]; that of its data sheet if None.
            template: template whose gains, rotor inertia and friction it has; None for those in proportion to its
                torque.

        Raises:
            InvalidFields: the supply is not one that the motor bears.
        """
        volts = motor.volts if volts is None else volts
        winding, supply_ratio = motor.winding(volts), volts / motor.volts
        torque, speed = supply_ratio * motor.stall_torque, supply_ratio * motor.no_load_speed
        if template is not None:
            return replace(template, torque=torque, speed=speed, winding=winding)
        return Servo(
            kp=_STIFFNESS * torque,
            ki=0.0,
            kd=_STIFFNESS * _LEAD * torque,
            integral_limit=0.0,
            torque=torque,
            speed=speed,
            armature=_INERTIA * motor.stall_torque,
            friction=_FRICTION * motor.stall_torque,
            damping=_DAMPING * motor.stall_torque,
            winding=winding,
        )


_MOST_IDLE = 0.9  # of the torque; beyond, the motor's own line would be that of a motor ten times as fast
_STIFFNESS = 40.0 / 3.0  # stiffness over torque [1/rad]
_LEAD = 1.5 / 40.0  # derivative gain over stiffness [s]: critical damping of rotor and leg of the article's robot
_INERTIA, _FRICTION, _DAMPING = 3.05e-3, 1.52e-2, 5.4e-3
"""Rotor inertia [s2], dry friction [-] and damping [s/rad] of a gear over its torque at standstill: geometric means
over the identified servos (``suchus.robot.motors.servo_parameters.estimated_parameters``)."""

Turn = Literal["yaw", "pitch", "roll"]
"""What a hinge does.

On the axis: yaw about the vertical, pitch about the lateral axis, roll about the long axis. On a limb that points
straight out: yaw moves the foot forward, pitch moves it down, roll turns the limb about itself.
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Spring:
    """A hinge that nothing drives, or only a cable: a spring and a damper about zero."""

    stiffness: float
    """[N m/rad]."""
    damping: float
    """[N m s/rad]."""
    armature: float
    """Rotor inertia that turns with the hinge [kg m2]."""

    def __post_init__(self) -> None:
        with Checks("spring", self) as check:
            check.number("stiffness", 0.0, 1e5, "N m/rad")
            check.number("damping", 0.0, 1e4, "N m s/rad")
            check.number("armature", 0.0, 100.0, "kg m2")


@dataclass(frozen=True, slots=True, kw_only=True)
class Crank:
    """A hinge that a servo turns all round."""

    servo: Servo
    """The servo."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Hinge:
    """One hinge and what drives it.

    A positive angle on the axis turns the end that is farther from the root: the front end left (yaw) or down
    (pitch), the rear end right (yaw) or down (pitch). On a limb it moves the foot forward (yaw) or down (pitch), and
    a lower limb that hangs down forward (roll).
    """

    name: str
    """On the axis its whole name; on a limb, the part after the limb's, as ``yaw`` in ``LF_yaw``."""
    turn: Turn
    """``yaw``, ``pitch`` or ``roll``."""
    drive: Servo | Spring | Crank
    """Its drive: a servo, a spring or a crank."""
    range: tuple[float, float] | None = None
    """Limits [rad]; None for a crank, which has none."""

    def __post_init__(self) -> None:
        with Checks(f"hinge {self.name}", self) as check:
            check.that(bool(self.name), "a hinge needs a name")
            if isinstance(self.drive, Crank):
                check.that(self.range is None, f"hinge {self.name} is a crank, which turns all round: remove its range")
            else:
                check.range("range", -3.1416, 3.1416, "rad")

    @property
    def servo(self) -> Servo | None:
        """The servo that turns it directly, if one does."""
        if isinstance(self.drive, Servo):
            return self.drive
        return self.drive.servo if isinstance(self.drive, Crank) else None


@dataclass(frozen=True, slots=True, kw_only=True)
class LinearActuator:
    """A motor with a screw that moves the two cords of a cable along a line, as far as it is told.

    The article calls it the drive of the tail without a number of it, so that all of them are to be given. What a
    servo's fields are to its shaft these are to the cords: metres for radians, newtons for newton metres.

    Paper: Sections II.B and III.D.
    """

    travel: float
    """How far it moves the cords from the middle to either side [m]: half of the stroke that its maker gives."""
    force: float
    """Greatest force of its motor on the cords, dry friction not taken off [N]: with a winding, that at standstill.
    The load that a maker says it lifts is less by ``friction``."""
    speed: float
    """Speed without load, and slew limit of the commanded place [m/s]."""
    kp: float
    """Proportional gain [N/m]."""
    ki: float
    """Integral gain [N/(m s)]; zero switches integral action off."""
    kd: float
    """Derivative gain [N s/m]."""
    integral_limit: float
    """Greatest force that integral action may build up [N]."""
    mass: float
    """Inertia of rotor, gear and screw as the cords feel it [kg]."""
    friction: float
    """Dry friction of gear and screw at the cords [N]: the force that drives it back when it is off."""
    damping: float
    """Viscous friction of gear and screw [N s/m]."""
    winding: Winding | None = None
    """Its DC motor, by which force falls with speed, supply and heat; None: full force at any speed, for ever."""

    def __post_init__(self) -> None:
        with Checks("linear actuator", self) as check:
            check.number("travel", 1e-6, 10.0, "m")
            check.number("force", 1e-6, 1e6, "N")
            check.number("speed", 1e-5, 1e3, "m/s")
            check.number("kp", 1e-6, 1e9, "N/m")
            check.number("ki", 0.0, 1e9, "N/(m s)")
            check.number("kd", 0.0, 1e8, "N s/m")
            check.number("integral_limit", 0.0, 1e6, "N")
            check.number("mass", 1e-9, 1e5, "kg")
            check.number("friction", 0.0, 1e6, "N")
            check.number("damping", 0.0, 1e7, "N s/m")
            if self.winding is not None:
                idle = self.friction + self.damping * self.speed
                check.that(
                    idle < _MOST_IDLE * self.force,
                    f"friction and damping take {idle:.3g} N at {self.speed:g} m/s, of a force of {self.force:g} N: it "
                    "cannot reach that speed; give less of them, or less speed",
                )

    @classmethod
    def from_servo(cls, servo: Servo, radius: float, travel: float) -> Self:
        """Return the actuator that moves the cords as a servo with a pulley does.

        Args:
            servo: the servo.
            radius: radius of its pulley [m].
            travel: travel of the actuator to either side [m].
        """
        return cls(
            travel=travel,
            force=servo.torque / radius,
            speed=servo.speed * radius,
            kp=servo.kp / radius**2,
            ki=servo.ki / radius**2,
            kd=servo.kd / radius**2,
            integral_limit=servo.integral_limit / radius,
            mass=servo.armature / radius**2,
            friction=servo.friction / radius,
            damping=servo.damping / radius**2,
            winding=servo.winding,
        )

    def equivalent_servo(self, radius: float) -> Servo:
        """Return the servo that moves the cords in the same way by a pulley.

        Args:
            radius: radius of the pulley [m].
        """
        return Servo(
            kp=self.kp * radius**2,
            ki=self.ki * radius**2,
            kd=self.kd * radius**2,
            integral_limit=self.integral_limit * radius,
            torque=self.force * radius,
            speed=self.speed / radius,
            armature=self.mass * radius**2,
            friction=self.friction * radius,
            damping=self.damping * radius**2,
            winding=self.winding,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Cable:
    """Two cords that bend hinges which follow each other, all by the same angle where nothing resists.

    A servo pulls the cords over one pulley, or a linear actuator moves them directly. Commands and records give angles
    and torques for both: those of a linear actuator are the angle and torque of an equivalent servo on a pulley of the
    radius ``pulley``; its travel is the angle times that radius.

    Paper: Eqs (16) to (18).
    """

    name: str
    """Name of its servo or actuator, and of the cable."""
    hinges: tuple[str, ...]
    """The hinges that it bends, from its drive to its end."""
    cord_spacing: float
    """Distance between the two cords, the article's d [m]."""
    bend_limit: float
    """Greatest sum of the hinges' angles to either side [rad]."""
    servo: Servo | LinearActuator
    """The servo that turns the pulley, with torque and angle of its own shaft; or a linear actuator."""
    pulley: float = 0.0
    """Radius of the servo's pulley, the article's r [m]. A linear actuator has none: 0 counts its travel as on one of
    half the cord spacing, so that its angle is nearly the bend."""
    gap: float = 0.0
    """Gap between the plates at each hinge, the article's h [m]; 0: that which closes at the limit of the bend."""

    def __post_init__(self) -> None:
        with Checks(f"cable {self.name}", self) as check:
            check.that(bool(self.hinges), f"cable {self.name} bends no hinge; name one at least")
            check.number("cord_spacing", 1e-5, 10.0, "m")
            check.number("bend_limit", 0.01, 6.2832, "rad")
            check.number("gap", 0.0, 10.0, "m")
            if isinstance(self.servo, LinearActuator) and self.hinges:
                if self.pulley == 0.0:
                    object.__setattr__(self, "pulley", self.cord_spacing / 2)
                required_travel = self.cord_travel(self.bend_limit)
                check.that(
                    required_travel <= self.servo.travel * (1 + 1e-9),
                    f"cable {self.name} bends up to {self.bend_limit:.4g} rad, for which its linear actuator must "
                    f"move {required_travel:.4g} m to either side, and its travel is {self.servo.travel:.4g} m: let "
                    "it bend less, give more travel, or cords that are closer together",
                )
            check.number("pulley", 1e-5, 10.0, "m")

    @property
    def joints(self) -> int:
        """Number of hinges, the article's N [-]."""
        return len(self.hinges)

    @property
    def turning(self) -> Servo:
        """The servo on its pulley; of a linear actuator the one that would do the same."""
        return self.servo.equivalent_servo(self.pulley) if isinstance(self.servo, LinearActuator) else self.servo

    @property
    def linear(self) -> LinearActuator | None:
        """The linear actuator that moves the cords; None where a servo does by a pulley."""
        return self.servo if isinstance(self.servo, LinearActuator) else None

    def cord_travel(self, bend: float) -> float:
        """Return by how much a cord is drawn in at a sum of the hinges' angles, the article's X [m].

        Args:
            bend: sum of the angles [rad].
        """
        return self.joints * self.cord_spacing * sin(bend / (2 * self.joints))

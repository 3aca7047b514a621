"""Hinges and what moves them: a servo, a crank, a spring, or a cable over several."""

from dataclasses import dataclass
from typing import Literal

from suchus.design.checks import Checks
from suchus.design.servo import Servo

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
class Cable:
    """Two cords over one pulley that bend hinges which follow each other, all by the same angle where nothing resists.

    Paper: Eqs (16) to (18).
    """

    name: str
    """Name of the servo and the cable."""
    hinges: tuple[str, ...]
    """The hinges that it bends, from its servo to its end."""
    cord_spacing: float
    """Distance between the two cords, the article's d [m]."""
    pulley: float
    """Radius of the servo's pulley, the article's r [m]."""
    bend_limit: float
    """Greatest sum of the hinges' angles to either side [rad]."""
    servo: Servo
    """The servo that turns the pulley; torque and angle are those of its own shaft."""
    gap: float = 0.0
    """Gap between the plates at each hinge, the article's h [m]; 0: that which closes at the limit of the bend."""

    def __post_init__(self) -> None:
        with Checks(f"cable {self.name}", self) as check:
            check.that(bool(self.hinges), f"cable {self.name} bends no hinge; name one at least")
            check.number("cord_spacing", 1e-5, 10.0, "m")
            check.number("pulley", 1e-5, 10.0, "m")
            check.number("bend_limit", 0.01, 6.2832, "rad")
            check.number("gap", 0.0, 10.0, "m")

    @property
    def joints(self) -> int:
        """Number of hinges, the article's N [-]."""
        return len(self.hinges)

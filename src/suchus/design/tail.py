"""The tail: a pitch joint, plates bent sideways by one cable, and a flexible end."""

from dataclasses import dataclass

from suchus.design.checks import Checks
from suchus.design.servo import Servo


@dataclass(frozen=True, slots=True, kw_only=True)
class Tail:
    """From the pelvis backward: pitch joint, root, ``joints`` cable joints, ``fin_segments`` passive ones.

    The frame of the cable section: x backward, y right, z up; a positive bend turns the tip to the right.

    Paper: Figs 5, 9.
    """

    offset: float
    """From the hind girdle's axis back to the pitch joint [m]."""
    root: float
    """From the pitch joint to the middle of the first plate, where the cable section begins [m]."""
    joints: int
    """Number of cable joints, the article's N [-]."""
    plate: float
    """Thickness of a plate, the article's H [m]."""
    gap: float
    """Gap between plates, the article's h [m]."""
    cord_spacing: float
    """Between the two cords, the article's d [m]."""
    pulley: float
    """Radius of the servo's wheel, the article's r [m]."""
    joint_stiffness: float
    """Lateral spring at each cable joint [N m/rad]."""
    joint_damping: float
    """Lateral damper at each cable joint [N m s/rad]."""
    fin_segments: int
    """Number of segments of the passive end [-]."""
    fin_length: float
    """Length of the passive end [m]."""
    fin_stiffness_lateral: float
    """Lateral spring at the first passive joint [N m/rad]; it falls linearly to half at the last."""
    fin_stiffness_vertical: float
    """Vertical spring at the first passive joint [N m/rad]; it falls linearly to half at the last."""
    fin_damping: float
    """Damper at each passive joint [N m s/rad]."""
    radius_root: float
    """Radius at the root [m]."""
    radius_tip: float
    """Radius at the tip [m]."""
    mass: float
    """Of the whole tail, spread in proportion to volume [kg]."""
    pitch_range: tuple[float, float]
    """Limits of the pitch joint, down positive [rad]."""
    bend_limit: float
    """Greatest lateral bend of the cable section to either side [rad]."""
    pitch_servo: Servo
    """The servo of the pitch joint."""
    cable_servo: Servo
    """The servo that turns the pulley; torque and angle are those of its own shaft."""

    def __post_init__(self) -> None:
        with Checks("tail", self) as check:
            check.number("offset", 0.0, 1.0, "m")
            check.number("root", 0.001, 1.0, "m")
            check.number("plate", 0.001, 0.5, "m")
            check.number("gap", 0.001, 0.5, "m")
            check.number("cord_spacing", 0.001, 0.5, "m")
            check.number("pulley", 0.001, 0.5, "m")
            check.number("joint_stiffness", 0.0, 100.0, "N m/rad")
            check.number("joint_damping", 0.0, 10.0, "N m s/rad")
            check.number("fin_length", 0.01, 2.0, "m")
            check.number("fin_stiffness_lateral", 0.001, 100.0, "N m/rad")
            check.number("fin_stiffness_vertical", 0.001, 100.0, "N m/rad")
            check.number("fin_damping", 0.0, 10.0, "N m s/rad")
            check.number("radius_root", 0.002, 0.5, "m")
            check.number("radius_tip", 0.002, 0.5, "m")
            check.number("mass", 0.02, 20.0, "kg")
            check.range("pitch_range", -3.1416, 3.1416, "rad")
            check.number("bend_limit", 0.01, 3.1416, "rad")
            check.whole("joints", 1, 30)
            check.whole("fin_segments", 1, 30)

    @property
    def pitch(self) -> float:
        """From each cable joint to the next, H + h [m]."""
        return self.plate + self.gap

    @property
    def length(self) -> float:
        """From the hind girdle's axis to the tip when straight [m]."""
        return self.offset + self.root + self.joints * self.pitch + self.fin_length

"""The tail: a pitch joint, plates bent sideways by one cable, and a flexible end."""

from dataclasses import dataclass

from suchus.design.checks import require, require_range
from suchus.design.servo import Servo
from suchus.errors import InvalidDesign


@dataclass(frozen=True, slots=True, kw_only=True)
class Tail:
    """From the pelvis backward: pitch joint, root, ``joints`` cable joints, ``fin_segments`` passive segments.

    The frame of the cable section: x backward, y right, z up; a positive bend turns the tip to the right.
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
        require("tail", "offset", self.offset, 0.0, 1.0, "m")
        require("tail", "root", self.root, 0.001, 1.0, "m")
        require("tail", "plate", self.plate, 0.001, 0.5, "m")
        require("tail", "gap", self.gap, 0.001, 0.5, "m")
        require("tail", "cord_spacing", self.cord_spacing, 0.001, 0.5, "m")
        require("tail", "pulley", self.pulley, 0.001, 0.5, "m")
        require("tail", "joint_stiffness", self.joint_stiffness, 0.0, 100.0, "N m/rad")
        require("tail", "joint_damping", self.joint_damping, 0.0, 10.0, "N m s/rad")
        require("tail", "fin_length", self.fin_length, 0.01, 2.0, "m")
        require("tail", "fin_stiffness_lateral", self.fin_stiffness_lateral, 0.001, 100.0, "N m/rad")
        require("tail", "fin_stiffness_vertical", self.fin_stiffness_vertical, 0.001, 100.0, "N m/rad")
        require("tail", "fin_damping", self.fin_damping, 0.0, 10.0, "N m s/rad")
        require("tail", "radius_root", self.radius_root, 0.002, 0.5, "m")
        require("tail", "radius_tip", self.radius_tip, 0.002, 0.5, "m")
        require("tail", "mass", self.mass, 0.02, 20.0, "kg")
        require_range("tail", "pitch_range", self.pitch_range, -3.1416, 3.1416, "rad")
        require("tail", "bend_limit", self.bend_limit, 0.01, 3.1416, "rad")
        for field, low, high in (("joints", 1, 30), ("fin_segments", 1, 30)):
            value = getattr(self, field)
            if not (isinstance(value, int) and low <= value <= high):
                raise InvalidDesign(f"tail.{field} is {value!r}; a whole number of {low} to {high} is allowed.")

    @property
    def pitch(self) -> float:
        """From each cable joint to the next, H + h [m]."""
        return self.plate + self.gap

    @property
    def length(self) -> float:
        """From the hind girdle's axis to the tip when straight [m]."""
        return self.offset + self.root + self.joints * self.pitch + self.fin_length

"""The tail: a pitch joint, plates bent sideways by one cable, and a flexible end."""

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from suchus.design.checks import Checks
from suchus.design.servo import Servo

TailDrive = Literal["cable", "servos"]
"""What bends the tail sideways: one cable over all of its driven joints, or a servo in each of them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tail:
    """From the pelvis backward: pitch joint, root, ``joints`` cable joints, ``fin_segments`` passive ones.

    The frame of the cable section: x backward, y right, z up; a positive bend turns the tip to the right.

    Paper: Figs 5, 9.
    """

    offset: float
    """Distance from the hind girdle's axis back to the pitch joint [m]."""
    root: float
    """Distance from the pitch joint to the middle of the first plate, where the cable section begins [m]."""
    joints: int
    """Number of cable joints, the article's N [-]."""
    plate: float
    """Thickness of a plate, the article's H [m]."""
    gap: float
    """Gap between plates, the article's h [m]."""
    cord_spacing: float
    """Distance between the two cords, the article's d [m]."""
    pulley: float
    """Radius of the servo's pulley, the article's r [m]."""
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
    """Mass of the whole tail, spread in proportion to volume [kg]."""
    pitch_range: tuple[float, float]
    """Limits of the pitch joint, down positive [rad]."""
    bend_limit: float
    """Greatest lateral bend of the cable section to either side [rad]."""
    pitch_servo: Servo
    """The servo of the pitch joint."""
    cable_servo: Servo
    """The servo that turns the pulley, or each driven joint; torque and angle are those of its own shaft."""
    drive: TailDrive = "cable"
    """``cable`` as in the article, or ``servos``, one in each driven joint."""

    def __post_init__(self) -> None:
        with Checks("tail", self) as check:
            check.number("offset", 0.0, 10.0, "m")
            check.number("root", 1e-4, 10.0, "m")
            check.number("plate", 1e-5, 5.0, "m")
            check.number("gap", 1e-5, 5.0, "m")
            check.number("cord_spacing", 1e-5, 5.0, "m")
            check.number("pulley", 1e-5, 5.0, "m")
            check.number("joint_stiffness", 0.0, 1e5, "N m/rad")
            check.number("joint_damping", 0.0, 1e4, "N m s/rad")
            check.number("fin_length", 1e-4, 20.0, "m")
            check.number("fin_stiffness_lateral", 1e-8, 1e5, "N m/rad")
            check.number("fin_stiffness_vertical", 1e-8, 1e5, "N m/rad")
            check.number("fin_damping", 0.0, 1e4, "N m s/rad")
            check.number("radius_root", 1e-5, 5.0, "m")
            check.number("radius_tip", 1e-5, 5.0, "m")
            check.number("mass", 1e-7, 1e4, "kg")
            check.range("pitch_range", -3.1416, 3.1416, "rad")
            check.number("bend_limit", 0.01, 3.1416, "rad")
            check.whole("joints", 1, 30)
            check.whole("fin_segments", 1, 30)

    @property
    def pitch(self) -> float:
        """Distance from each cable joint to the next, H + h [m]."""
        return self.plate + self.gap

    @property
    def length(self) -> float:
        """Length from the hind girdle's axis to the tip when straight [m]."""
        return self.offset + self.root + self.joints * self.pitch + self.fin_length


class TailSegments(NamedTuple):
    """The segments of a tail, the root first: plates between their joints, then the passive end."""

    lengths: list[float]
    """[m]."""
    radii: list[float]
    """[m]."""
    masses: list[float]
    """[kg]."""


def tail_segments(tail: Tail) -> TailSegments:
    """Return length, radius and mass of each segment; the mass is spread in proportion to volume."""
    lengths = [
        tail.root + tail.pitch / 2,
        *([tail.pitch] * (tail.joints - 1)),
        tail.pitch / 2,
        *([tail.fin_length / tail.fin_segments] * tail.fin_segments),
    ]
    middles = np.cumsum(lengths) - 0.5 * np.array(lengths)
    radii = np.interp(middles, [0.0, float(np.sum(lengths))], [tail.radius_root, tail.radius_tip])
    volumes = radii**2 * lengths
    return TailSegments(lengths, radii.tolist(), (tail.mass * volumes / volumes.sum()).tolist())

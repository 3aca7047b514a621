"""The article's tables, and what it does not give, as the measures of a crocodile-like robot.

They are an argument of ``design.crocodile`` and no robot: nothing simulates, draws or measures them.
"""

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from suchus.core.checks import Checks
from suchus.core.kinds import show
from suchus.robot.design.ground import Contact
from suchus.robot.design.hinge import LinearActuator, Servo
from suchus.robot.design.hull import Hull
from suchus.robot.design.limb import is_thick_enough

LEG_SHARES = (0.60, 0.35, 0.05)
"""How a leg's mass is spread over femur, tibia and foot [-]."""
TIBIA_RADIUS_RATIO = 0.8
"""Radius of a tibia over that of its femur [-]."""


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
            shank_radius = TIBIA_RADIUS_RATIO * self.radius
            check.that(
                is_thick_enough(self.foot_radius, shank_radius),
                f"leg.foot_radius is {self.foot_radius:.4g} m, thinner than the shank's {shank_radius:.4g} m "
                f"({TIBIA_RADIUS_RATIO:g} of leg.radius), which would carry the load in its place; "
                "make the foot thicker or the leg thinner",
            )

    @property
    def reach(self) -> tuple[float, float]:
        """Nearest and farthest distance of the foot from the hip [m]."""
        return abs(self.femur - self.tibia), self.femur + self.tibia


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


TailDrive = Literal["cable", "linear_actuator", "servos"]
"""What bends the tail sideways: one cable over all of its driven joints, on the pulley of a servo (section III.C of the
article) or moved by a linear actuator (II.B, III.D), or a servo in each of them."""


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
    """Radius of the servo's pulley, the article's r [m]; a linear actuator has none."""
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
    """``cable`` on the pulley of a servo, ``linear_actuator`` for cords that it moves, or ``servos``, one in each
    driven joint."""
    actuator: LinearActuator | None = None
    """The linear actuator; None for one that gives the cords what the servo would by its pulley, with the travel that
    the greatest bend asks for."""

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
            check.that(
                self.actuator is None or self.drive == "linear_actuator",
                f"actuator is given and drive is {show(self.drive)}, so that nothing would use it: set drive to "
                "'linear_actuator', or take the actuator away",
            )

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
    centers = np.cumsum(lengths) - 0.5 * np.array(lengths)
    radii = np.interp(centers, [0.0, float(np.sum(lengths))], [tail.radius_root, tail.radius_tip])
    volumes = radii**2 * lengths
    return TailSegments(lengths, radii.tolist(), (tail.mass * volumes / volumes.sum()).tolist())


@dataclass(frozen=True, slots=True, kw_only=True)
class Pelvis:
    """The hind girdle, frame 0 of the spine; it holds battery and electronics."""

    mass: float
    """[kg]."""
    length: float
    """Length along the body [m]."""
    width: float
    """Across the body [m]."""
    height: float
    """[m]."""

    def __post_init__(self) -> None:
        with Checks("pelvis", self) as check:
            check.number("mass", 1e-7, 1e5, "kg")
            for field in ("length", "width", "height"):
                check.number(field, 1e-5, 10.0, "m")


@dataclass(frozen=True, slots=True, kw_only=True)
class Thorax:
    """The front girdle, rigid with the last frame of the spine."""

    mass: float
    """[kg]."""
    shoulder: float
    """Distance from the last spine joint forward to the front girdle's axis [m]."""
    width: float
    """Across the body [m]."""
    height: float
    """[m]."""

    @property
    def half(self) -> tuple[float, float, float]:
        """Half axes of its ellipsoid: length, width, height [m]; it reaches a little beyond joint and shoulders."""
        return max(self.shoulder, 0.02) + 0.012, self.width / 2, self.height / 2

    def __post_init__(self) -> None:
        with Checks("thorax", self) as check:
            check.number("mass", 1e-7, 1e5, "kg")
            check.number("shoulder", 0.0, 10.0, "m")
            for field in ("width", "height"):
                check.number(field, 1e-5, 10.0, "m")


@dataclass(frozen=True, slots=True, kw_only=True)
class Head:
    """The head, rigid with the thorax."""

    mass: float
    """[kg]."""
    snout: float
    """Distance from the last spine joint forward to the tip of the snout [m]."""
    width: float
    """Width at the jaw joint [m]."""
    height: float
    """Height at the jaw joint [m]."""

    def __post_init__(self) -> None:
        with Checks("head", self) as check:
            check.number("mass", 1e-7, 1e5, "kg")
            check.number("snout", 1e-4, 20.0, "m")
            for field in ("width", "height"):
                check.number(field, 1e-5, 10.0, "m")


@dataclass(frozen=True, slots=True, kw_only=True)
class Tables:
    """The measures of a crocodile-like robot: four legs, a spine, a tail; ``crocodile`` makes the robot.

    Paper: Fig. 2.
    """

    name: str
    """Name, as messages, tables and files show it."""
    hind_leg: Leg
    """The left hind leg; the right one mirrors it."""
    front_leg: Leg
    """The left front leg; the right one mirrors it."""
    pelvis: Pelvis
    """The hind girdle."""
    spine: Spine
    """The trunk between the girdles."""
    thorax: Thorax
    """The front girdle."""
    head: Head
    """The head."""
    tail: Tail
    """The tail."""
    contact: Contact
    """Friction, stiffness and damping of the contact of its surfaces with the ground."""
    hull: Hull | None = None
    """Foam and air that make it float; None for a robot without."""

    def __post_init__(self) -> None:
        with Checks("robot", self) as check:
            check.that(
                self.head.snout > self.thorax.shoulder,
                f"head.snout is {self.head.snout:g} m but thorax.shoulder is {self.thorax.shoulder:g} m: "
                "the snout must lie ahead of the shoulders",
            )
            belly = max(self.spine.radius, self.pelvis.height / 2, self.thorax.height / 2)
            for name, leg in (("front_leg", self.front_leg), ("hind_leg", self.hind_leg)):
                depth = leg.reach[1] + leg.foot_radius
                check.that(
                    depth > belly,
                    f"{name} reaches {depth:.3f} m below its hip but the belly hangs {belly:.3f} m below it: "
                    "the foot cannot reach the ground; lengthen femur or tibia",
                )

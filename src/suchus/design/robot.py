"""The article's kind of robot, by the measures of its own tables."""

from dataclasses import dataclass

from suchus.design.body import check_scale
from suchus.design.checks import Checks
from suchus.design.contact import Contact
from suchus.design.hull import Hull
from suchus.design.leg import Leg
from suchus.design.servo import Servo
from suchus.design.spine import Spine
from suchus.design.tail import Tail
from suchus.design.trunk import Head, Pelvis, Thorax


@dataclass(frozen=True, slots=True, kw_only=True)
class Crocodile:
    """A crocodile-like robot: four legs, a spine, a tail; ``design.general`` maps it to the form of any robot.

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
            check_scale(check, self.name, self._servos(), self.mass, self.length)
            belly = max(self.spine.radius, self.pelvis.height / 2, self.thorax.height / 2)
            for name, leg in (("front_leg", self.front_leg), ("hind_leg", self.hind_leg)):
                depth = leg.reach[1] + leg.foot_radius
                check.that(
                    depth > belly,
                    f"{name} reaches {depth:.3f} m below its hip but the belly hangs {belly:.3f} m below it: "
                    "the foot cannot reach the ground; lengthen femur or tibia",
                )

    @property
    def mass(self) -> float:
        """Mass of the whole robot [kg]."""
        trunk = self.pelvis.mass + (self.spine.joints - 1) * self.spine.link_mass + self.thorax.mass + self.head.mass
        foam = 0.0 if self.hull is None else self.hull.mass
        return trunk + 2 * (self.hind_leg.mass + self.front_leg.mass) + self.tail.mass + foam

    @property
    def length(self) -> float:
        """Length from the tip of the snout to the tip of the tail when straight [m]."""
        return self.spine.length + self.head.snout + self.tail.length

    def leg(self, name: str) -> Leg:
        """Return the leg of a girdle: ``LF`` and ``RF`` the front one, ``LH`` and ``RH`` the hind one."""
        return self.front_leg if name.endswith("F") else self.hind_leg

    def servo(self, name: str) -> Servo:
        """Return the servo that carries a name of ``design.servo_names(robot)``."""
        if name == "tail_pitch":
            return self.tail.pitch_servo
        if name.startswith("tail"):
            return self.tail.cable_servo
        if name.startswith("spine"):
            return self.spine.yaw_servo if "yaw" in name else self.spine.pitch_servo
        return self.leg(name[:2]).servo

    def _servos(self) -> dict[str, Servo]:
        return {
            name: self.servo(name)
            for name in ("LF_yaw", "LH_yaw", "spine_yaw_1", "spine_pitch_1", "tail_pitch", "tail_cable")
        }

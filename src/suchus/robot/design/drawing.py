"""A limbless swimmer from a drawing: how wide and how high it is along its length, what it weighs, where it bends."""

from dataclasses import dataclass
from itertools import pairwise
from math import pi, radians

import numpy as np

from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign
from suchus.core.physics import WATER_DENSITY
from suchus.robot.design.body import Robot
from suchus.robot.design.hinge import Hinge, Servo
from suchus.robot.design.pieces import volumes
from suchus.robot.design.scale import contact_for, swim_servo_for
from suchus.robot.design.segment import Rod, Segment, Shell

_OVERLAP = 1.6
"""Half-length of an ellipsoid over the distance to the next one: they overlap, so that the outline closes [-]."""
_KEEL = 0.25
"""Share of the mass that lies in a keel inside the body, low, unless a drawing says otherwise [-]."""
_FRICTION = 0.4
"""Coefficient of friction of the skin on the ground, which a swimmer does not touch [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Drawing:
    """A body without limbs as its drawings show it, its sections ellipses."""

    name: str
    """Name, as messages, tables and files show it."""
    length: float
    """Length from the tip of the snout to the tip of the tail [m]."""
    mass: float
    """Mass of the whole body [kg]."""
    density: float = WATER_DENSITY
    """Mass over volume of the whole body, its air and lungs included [kg/m3]: the drawn sections are made larger or
    smaller alike until the volume is right. One that hovers has the density of its water."""
    stations: tuple[float, ...]
    """Where the drawing was measured, from the snout, rising from 0 to 1 [body length]."""
    half_width: tuple[float, ...]
    """Half of the width there [body length]."""
    half_height: tuple[float, ...]
    """Half of the height there, fins in the plane of symmetry included; at 1 the trailing edge [body length]."""
    joints: tuple[float, ...]
    """Where it bends, from the snout, rising [body length]; a row of rigid segments lies between."""
    bend: float = radians(65)
    """How far each joint goes to either side [rad]."""
    keel: float = _KEEL
    """Share of the mass that lies low in each segment, so that the centre of mass is below that of buoyancy [-]."""

    def __post_init__(self) -> None:
        with Checks(f"drawing {self.name}", self) as check:
            check.number("length", 1e-3, 100.0, "m")
            check.number("mass", 1e-6, 1e5, "kg")
            check.number("density", 50.0, 2e4, "kg/m3")
            check.rising("joints", 0.001, 0.999, "body length")
            check.number("bend", 0.01, pi, "rad")
            check.number("keel", 0.0, 0.9, "")
            check.that(
                len(self.stations) >= 2 and self.stations[0] == 0.0 and self.stations[-1] == 1.0,
                f"drawing.stations reach from {self.stations[:1]} to {self.stations[-1:]}; "
                "they must begin at 0 and end at 1",
            )
            for field in ("half_width", "half_height"):
                values = getattr(self, field)
                check.that(
                    len(values) == len(self.stations) and all(0.0 < value < 0.5 for value in values),
                    f"drawing.{field} has {len(values)} numbers for {len(self.stations)} stations; each station needs "
                    "one, above 0 and below 0.5 body lengths",
                )

    def robot(self, servo: Servo | None = None) -> Robot:
        """Return it as a robot.

        Args:
            servo: servo in every joint; one that holds the water if None, see ``design.scale.swim_servo_for``.

        Raises:
            InvalidDesign: no sections of these proportions have the volume.
        """
        target_volume, scale = self.mass / self.density, 1.0
        for _ in range(30):
            robot = self._robot(scale, servo)
            volume = sum(volumes(robot).values())
            if abs(volume / target_volume - 1.0) < 1e-9:
                return robot
            scale *= (target_volume / volume) ** 0.5
        raise InvalidDesign(
            f"drawing {self.name} would need sections {scale:.2g} times as wide as drawn for {target_volume:.3g} m3 of "
            "volume; check mass, density and length."
        )

    def _robot(self, scale: float, servo: Servo | None) -> Robot:
        """Return the robot with its sections scaled.

        Args:
            scale: factor on width and height of the drawn sections [-].
            servo: servo in every joint; None for one that holds the water.
        """
        ends = (0.0, *self.joints, 1.0)
        drive = servo or swim_servo_for(self.mass, self.length)
        root = len(ends) // 2 - 1 if len(ends) > 2 else 0
        shells = [self._shells(i, ends, scale) for i in range(len(ends) - 1)]
        total = sum(size for row in shells for _, _, size in row)
        axis = tuple(
            Segment(
                name=f"segment_{i + 1}",
                front=0.5 * (b - a) * self.length,
                rear=0.5 * (b - a) * self.length,
                shapes=self._shapes(i, shells[i], 0.5 * (a + b), total, b - a),
                hinges=(self._hinge(i, root, drive),) if i < len(self.joints) else (),
            )
            for i, (a, b) in enumerate(pairwise(ends))
        )
        contact = contact_for(self.length, foot_friction=_FRICTION, skin_friction=_FRICTION)
        return Robot(name=self.name, root=f"segment_{root + 1}", axis=axis, girdles=(), cables=(), contact=contact)

    def _hinge(self, number: int, root: int, drive: Servo) -> Hinge:
        word, count = ("spine", root - number) if number < root else ("tail", number - root + 1)
        return Hinge(name=f"{word}_yaw_{count}", turn="yaw", drive=drive, range=(-self.bend, self.bend))

    def _shells(self, number: int, ends: tuple[float, ...], scale: float) -> list[tuple[float, np.ndarray, float]]:
        """Return place and half axes, both [body length], and relative size of each ellipsoid of a segment.

        Args:
            number: number of the segment, from the snout [-].
            ends: places of the joints with both ends of the body [body length].
            scale: factor on width and height [-].
        """
        a, b = ends[number], ends[number + 1]
        count = max(2, round((b - a) * 24))
        step = (b - a) / count
        places = list(a + step * (np.arange(count) + 0.5))
        if number == len(ends) - 2:
            places.append(b)  # trailing edge: half of this ellipsoid lies behind the tip, and its size counts half
        ellipsoids = []
        for place in places:
            half_width, half_height = (
                np.interp(place, self.stations, values) for values in (self.half_width, self.half_height)
            )
            half_length = _OVERLAP * step
            if place != b and number == len(ends) - 2:
                half_length = min(half_length, b - place)
            if number == 0:
                half_length = min(half_length, place) if place < half_length else half_length
            half = np.array([half_length, scale * half_width, scale * half_height])
            ellipsoids.append(
                (float(place), half, float(half_width * half_height * step * (0.5 if place == b else 1.0)))
            )
        return ellipsoids

    def _shapes(
        self,
        number: int,
        shells: list[tuple[float, np.ndarray, float]],
        center: float,
        total: float,
        segment_length: float,
    ) -> tuple[Rod | Shell, ...]:
        """Return the ellipsoids of one segment, and its keel if there is one.

        Args:
            number: number of the segment, from the snout [-].
            shells: place [body length], half axes [body length] and relative size of each ellipsoid.
            center: center of the segment, from the snout [body length].
            total: sum of the relative sizes of all segments.
            segment_length: length of the segment [body length].
        """
        length = self.length
        shapes: list[Rod | Shell] = []
        weight = sum(size for _, _, size in shells) / total * self.mass
        for k, (place, half, size) in enumerate(shells):
            shapes.append(
                Shell(
                    name=f"segment_{number + 1}_{k + 1}",
                    at=((center - place) * length, 0.0, 0.0),
                    half=tuple(float(value) for value in half * length),  # type: ignore[arg-type]
                    mass=(1.0 - self.keel) * size / total * self.mass,
                )
            )
        if self.keel > 0.0:
            half_height = min(half[2] for _, half, _ in shells) * length
            radius = 0.2 * min(min(half[1] for _, half, _ in shells) * length, half_height)
            reach = 0.3 * segment_length * length
            keel_z = -(0.8 * half_height - radius)
            shapes.append(
                Rod(
                    name=f"segment_{number + 1}_keel",
                    start=(reach, 0.0, keel_z),
                    end=(-reach, 0.0, keel_z),
                    radius=radius,
                    mass=self.keel * weight,
                )
            )
        return tuple(shapes)

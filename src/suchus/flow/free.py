"""Bodies that the water moves, as they are given: three degrees of freedom in the plane, six in space."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import isfinite

from suchus.core.errors import InvalidDesign
from suchus.flow.grid import check_kinds
from suchus.flow.pose import Pose
from suchus.flow.shape import Shape

Three = tuple[float, float, float]
Six = tuple[float, float, float, float, float, float]

Force = Callable[[float, Pose], Sequence[float]]
"""Force along x and y [N/m] and torque about the centre of mass [N], counter-clockwise and per metre of depth; in space
force along x, y and z [N] and torque about them [N m], or three numbers [N, N, N m] for a body that stays in its plane.
From the time [s] and the state: a ``Pose`` with the centre of mass, the attitude and their rates."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FreeBody:
    """A shape that the water moves, and weight, springs, dampers and other forces, if it has any.

    Degrees of freedom are x, y and the angle; in space those along x, y and z, then those about x, y and z through the
    centre of mass. Where they are counted, three numbers in space mean x, y and about z.
    """

    shape: Shape
    """Shape of the body in its own frame, at every time."""
    start: tuple[float, float] | Three = (0.0, 0.0)
    """Centre of mass at time 0 (x, y), in space (x, y, z); z is 0 if it is not given [m]."""
    angle: float = 0.0
    """Angle of the body's frame at time 0, in space its yaw; see ``Pose`` [rad]."""
    velocity: tuple[float, float] | Three = (0.0, 0.0)
    """Velocity of the centre of mass at time 0 (x, y), in space (x, y, z) [m/s]."""
    spin: float = 0.0
    """Angular momentum about z over moment of inertia at time 0; in space see ``spin_x`` [rad/s]."""
    density: float | None = None
    """Density [kg/m^3]; None is the water's."""
    free: tuple[bool, bool, bool] | tuple[bool, bool, bool, bool, bool, bool] | None = None
    """Whether it may move in each degree of freedom; a locked one keeps its rate at time 0, exactly. None: it may in
    all, but for what would break the symmetry of a ``Mirror`` that cuts it. Three in space: z and the turns about x and
    y are locked."""
    gravity: tuple[float, float] | Three = (0.0, 0.0)
    """Acceleration of gravity (x, y), in space (x, y, z); it acts on the mass of the body less that of the water
    displaced [m/s^2]."""
    springs: Three | Six = (0.0, 0.0, 0.0)
    """Stiffness along x, along y and about the centre of mass, per metre of depth [N/m^2, N/m^2, N/rad], in space
    along and about each axis of the world [N/m, N m/rad]."""
    dampers: Three | Six = (0.0, 0.0, 0.0)
    """Damping along x, along y and about the centre of mass, per metre of depth [N s/m^2, N s/m^2, N s/rad], in space
    along and about each axis of the world [N s/m, N m s/rad]."""
    anchor: Three | Six | None = None
    """Centre of mass and angle at which the springs are slack, in space (x, y, z, yaw, pitch, roll); None is the start
    [m, rad]."""
    force: Force | None = None
    """Any other force, from the time and the state; see ``Force``."""
    name: str = "body"
    """Its name in records and messages."""
    pitch: float = 0.0
    """Pitch at time 0, in space; see ``Pose`` [rad]."""
    roll: float = 0.0
    """Roll at time 0, in space [rad]."""
    spin_x: float = 0.0
    """Component along x, in space, of the tensor of inertia's inverse times the angular momentum at time 0 [rad/s]."""
    spin_y: float = 0.0
    """Its component along y; ``spin`` is that along z. Of a rigid body it is the angular velocity [rad/s]."""

    def __post_init__(self) -> None:
        """Refuse numbers that are not finite, a density that is not positive, and negative springs or dampers."""
        check_kinds(self)
        if self.density is not None and not (isfinite(self.density) and self.density > 0):
            raise InvalidDesign(f"density of {self.name} is {self.density} kg/m3; a positive density is needed.")
        for field_name in ("start", "velocity", "gravity", "springs", "dampers", "anchor"):
            components = getattr(self, field_name) or ()
            if not all(isfinite(component) for component in components):
                raise InvalidDesign(f"{field_name} of {self.name} is {components}; finite numbers are needed.")
            if field_name in ("springs", "dampers") and min(components) < 0:
                raise InvalidDesign(
                    f"{field_name} of {self.name} is {components}; none may be negative. Give what pushes away "
                    f"as a force."
                )
        if not (isfinite(self.angle) and isfinite(self.spin)):
            raise InvalidDesign(
                f"angle and spin of {self.name} are {self.angle} rad and {self.spin} rad/s; finite numbers are needed."
            )
        if not all(map(isfinite, (self.pitch, self.roll, self.spin_x, self.spin_y))):
            raise InvalidDesign(
                f"pitch, roll, spin_x and spin_y of {self.name} are {self.pitch} rad, {self.roll} rad, {self.spin_x} "
                f"and {self.spin_y} rad/s; finite numbers are needed."
            )

    @property
    def is_static(self) -> bool:
        """False: a free body can always move."""
        return False

    def check_plane(self) -> None:
        """Refuse fields that need three axes, for a body in the plane.

        Raises:
            InvalidDesign: such a field is set.
        """
        if len(self.start) > 2:
            raise InvalidDesign(f"{self.name} starts at {self.start} m, and the grid has two axes; give (x, y).")
        for field_name, max_count in (
            ("velocity", 2),
            ("gravity", 2),
            ("free", 3),
            ("springs", 3),
            ("dampers", 3),
            ("anchor", 3),
        ):
            components = getattr(self, field_name) or ()
            if len(components) > max_count:
                count = "two" if max_count == 2 else "three"
                raise InvalidDesign(
                    f"{field_name} of {self.name} is {components}, and the grid has two axes; give {count}."
                )
        for field_name in ("pitch", "roll", "spin_x", "spin_y"):
            if getattr(self, field_name):
                raise InvalidDesign(
                    f"{field_name} of {self.name} is {getattr(self, field_name)}, and the grid has two axes; there a "
                    f"body turns about z alone. Give an angle and a spin."
                )

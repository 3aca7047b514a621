"""Bodies that swim: three degrees of freedom under the water's forces, in the plane or in space.

The pressure answers a body's acceleration at once, ``F = F0 - Ma a``; the added mass ``Ma`` comes from three
solves of the pressure equation itself and goes to the left side, ``(M + Ma) a = F0``. Without it the coupling
of a light body is unstable. A body's deformation carries no momentum of its own: its frame moves so that the
centre of mass and the angular momentum change by outer forces alone: the water's, the body's weight less its buoyancy,
its springs and dampers, and what else it is given. In space bodies move in their plane of symmetry, along x and y and
about z.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import isfinite

import numpy as np

from suchus.errors import InvalidDesign
from suchus.flow.grid import check_kinds
from suchus.flow.mass import Mass, SpaceMass
from suchus.flow.pose import Pose
from suchus.flow.shape import Shape
from suchus.flow.solid import SpaceShape
from suchus.kinds import show

Force = Callable[[float, Pose], tuple[float, float, float]]
"""Force along x and y [N/m] and torque about the centre of mass [N], counter-clockwise and per metre of depth, in space
[N, N m], from the time [s] and the state: a ``Pose`` with the centre of mass, the angle and their rates."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FreeBody:
    """A shape that the water moves, and weight, springs, dampers and other forces, if it has any."""

    shape: Shape | SpaceShape
    """Shape of the body in its own frame, at every time."""
    start: tuple[float, float] | tuple[float, float, float] = (0.0, 0.0)
    """Centre of mass at time 0 (x, y), in space (x, y, z) too; z, which is 0 if it is not given, stays as it is [m]."""
    angle: float = 0.0
    """Angle of the body's frame at time 0 [rad]."""
    velocity: tuple[float, float] = (0.0, 0.0)
    """Velocity of the centre of mass at time 0 [m/s]."""
    spin: float = 0.0
    """Angular momentum over moment of inertia at time 0 [rad/s]."""
    density: float | None = None
    """Density [kg/m^3]; None is the water's."""
    free: tuple[bool, bool, bool] = (True, True, True)
    """Whether it may move along x, along y, and turn; a locked degree of freedom keeps its rate at time 0, exactly."""
    gravity: tuple[float, float] = (0.0, 0.0)
    """Acceleration of gravity (x, y); it acts on the mass of the body less that of the water displaced [m/s^2]."""
    springs: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Stiffness along x, along y and about the centre of mass, per metre of depth [N/m^2, N/m^2, N/rad], in space
    [N/m, N/m, N m/rad]."""
    dampers: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Damping along x, along y and about the centre of mass, per metre of depth [N s/m^2, N s/m^2, N s/rad], in space
    [N s/m, N s/m, N m s/rad]."""
    anchor: tuple[float, float, float] | None = None
    """Centre of mass and angle at which the springs are slack; None is the start [m, m, rad]."""
    force: Force | None = None
    """Any other force, from the time and the state; see ``Force``."""
    name: str = "body"
    """Its name in records and messages."""

    def __post_init__(self) -> None:
        check_kinds(self)
        if self.density is not None and not (isfinite(self.density) and self.density > 0):
            raise InvalidDesign(f"density of {self.name} is {self.density} kg/m3; a positive density is needed.")
        for what in ("start", "velocity", "gravity", "springs", "dampers", "anchor"):
            given = getattr(self, what) or ()
            if not all(isfinite(part) for part in given):
                raise InvalidDesign(f"{what} of {self.name} is {given}; finite numbers are needed.")
            if what in ("springs", "dampers") and min(given) < 0:
                raise InvalidDesign(
                    f"{what} of {self.name} is {given}; none may be negative. Give what pushes away as a force."
                )
        if not (isfinite(self.angle) and isfinite(self.spin)):
            raise InvalidDesign(
                f"angle and spin of {self.name} are {self.angle} rad and {self.spin} rad/s; finite numbers are needed."
            )

    @property
    def still(self) -> bool:
        """A free body is never taken for still."""
        return False


_CHANGING = ("place", "rate", "push", "load", "added", "momentum", "owed", "applied", "span", "steps")

REPAID = 0.5
"""Share of the momentum still owed that a step repays [-]; all at once rings."""


@dataclass(slots=True)
class Swimmer:
    """A free body under way. Vectors are (x, y, turning); in the plane per metre of depth."""

    body: FreeBody
    """Which body."""
    place: np.ndarray
    """Centre of mass and angle of the frame, shape (3,) [m, rad]."""
    rate: np.ndarray
    """Velocity of the centre and angular momentum over moment, shape (3,) [m/s, rad/s]."""
    push: np.ndarray = field(default_factory=lambda: np.zeros(3))
    """Acceleration in the last step, shape (3,) [m/s^2, rad/s^2]."""
    load: np.ndarray = field(default_factory=lambda: np.zeros(3))
    """Force and torque of the water in the last step [N/m, N; in space N, N m]."""
    added: np.ndarray = field(default_factory=lambda: np.zeros((3, 3)))
    """Added mass [kg/m, kg, kg m; in space kg, kg m, kg m^2]."""
    momentum: np.ndarray = field(default_factory=lambda: np.zeros(3))
    """Momentum and angular momentum before the last step [kg/s, kg m/s]."""
    owed: np.ndarray = field(default_factory=lambda: np.zeros(3))
    """Momentum that the water and the other forces gave and the body has not got yet [kg/s, kg m/s]."""
    applied: np.ndarray = field(default_factory=lambda: np.zeros(3))
    """Force and torque of all but the water in the last step, shape (3,) [N/m, N]."""
    span: float = 0.0
    """Length of the last step [s]."""
    steps: int = 0
    """Steps taken so far [-]."""

    @classmethod
    def of(cls, body: FreeBody) -> "Swimmer":
        """Return the body at its start."""
        return cls(body, np.array([*body.start[:2], body.angle]), np.array([*body.velocity, body.spin]))

    def pose(self, mass: Mass | SpaceMass) -> Pose:
        """Return the pose of the body's frame, whose deformation it has taken out of the motion."""
        angle = self.place[2]
        c, s = np.cos(angle), np.sin(angle)
        spin = self.rate[2] - mass.swirl / mass.moment if self.body.free[2] else 0.0
        rx, ry = c * mass.centre[0] - s * mass.centre[1], s * mass.centre[0] + c * mass.centre[1]
        ux, uy = (c * mass.centre_rate[0] - s * mass.centre_rate[1], s * mass.centre_rate[0] + c * mass.centre_rate[1])
        return self._at(
            position=(self.place[0] - rx, self.place[1] - ry), angle=angle,
            velocity=(self.rate[0] - ux + spin * ry, self.rate[1] - uy - spin * rx), spin=spin,
        )  # fmt: skip

    def _at(
        self, *, position: tuple[float, float], angle: float, velocity: tuple[float, float], spin: float
    ) -> Pose:  # fmt: skip
        """Return a pose in the plane or, for a shape in space, at the height where the body started."""
        height = self.body.start[2:] or (0.0,) * (self.body.shape.axes - 2)
        still = (0.0,) * len(height)
        return Pose(position=(*position, *height), angle=angle, velocity=(*velocity, *still), spin=spin)

    @property
    def place_and_rate(self) -> Pose:
        """Centre of mass and angle, with the velocities that the water's forces change."""
        (x, y, angle), (u, v, spin) = self.place.tolist(), self.rate.tolist()
        return self._at(position=(x, y), angle=angle, velocity=(u, v), spin=spin)

    def state(self) -> dict[str, np.ndarray]:
        """Return all that changes, by name."""
        return {key: np.array(getattr(self, key)) for key in _CHANGING}

    def resume(self, state: dict[str, np.ndarray]) -> None:
        """Set all that changes."""
        for key in _CHANGING:
            setattr(self, key, state[key] if state[key].ndim else state[key].item())

    def advance(self, time: float, dt: float, water_density: float, contact: np.ndarray | None = None) -> None:
        """Advance by ``dt`` [s] under the water's forces of the last step and the other forces of this one.

        Springs and dampers act at the mean of the step's start and end, the other forces at a middle foreseen from
        its start: neither adds energy.

        Args:
            time: start of the step [s].
            dt: length of the step [s].
            water_density: of the water [kg/m^3].
            contact: force and torque of other bodies that nearly touch, shape (3,) [N/m, N].

        Raises:
            InvalidDesign: the body's own force is not three finite numbers.
        """
        shape = self.body.shape
        density = water_density if self.body.density is None else self.body.density
        now, then = shape.mass(time), shape.mass(time + dt)
        inertia = np.diag([density * then.size, density * then.size, density * then.moment])
        momentum = density * np.array([now.size, now.size, now.moment]) * self.rate
        guess = self.load + self.added @ self.push
        if self.steps:
            self.owed = self.owed + self.span * (self.load + self.applied) - (momentum - self.momentum)
        if self.steps > 1:  # the second step itself repays the jolt of the start
            # Extrapolating instead feeds every ripple of the force back into the motion. The last step's force comes
            # a step late; what the body therefore did not get, it gets little by little. Without that an eel, whose
            # added mass aside is ten times its own, sways several times too much.
            guess = guess + REPAID * self.owed / dt
        self.momentum, self.span = momentum, dt
        guess = guess - np.array([0, 0, density * (then.moment - now.moment) / dt * self.rate[2]])
        go = np.array(self.body.free)
        recoil = np.array([0.0, 0.0, (now.swirl / now.moment + then.swirl / then.moment) if go[2] else 0.0])
        outer, yielding = self._outer(time, dt, (density - water_density) * now.size, recoil)
        if contact is not None:
            outer = outer + contact
        push = np.zeros(3)
        if self.steps:
            whole = inertia + self.added + np.diag(yielding)
            push[go] = np.linalg.solve(whole[np.ix_(go, go)], (guess + outer)[go])
        self.applied = outer - yielding * push
        rate = self.rate + dt * push
        move = dt * 0.5 * (self.rate + rate) - dt * 0.5 * recoil
        self.place, self.rate, self.push = self.place + move, rate, push
        self.steps += 1

    def _outer(self, time: float, dt: float, weight: float, recoil: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the mean over a step of all forces but the water's, and by how much an acceleration lessens them.

        The first is that of a body that does not accelerate; each of shape (3,) [N/m, N], [kg/m, kg m].

        Args:
            time: start of the step [s].
            dt: length of the step [s].
            weight: mass of the body less that of the water it displaces [kg/m].
            recoil: rate of the frame's angle at start and end that the deformation takes away, summed [rad/s].

        Raises:
            InvalidDesign: the body's own force is not three finite numbers.
        """
        body = self.body
        middle = self.place + 0.5 * dt * (self.rate - 0.5 * recoil)
        slack = np.array([*body.start[:2], body.angle] if body.anchor is None else body.anchor)
        stiff, viscous = np.array(body.springs), np.array(body.dampers)
        outer = weight * np.array([*body.gravity, 0.0]) - stiff * (middle - slack) - viscous * self.rate
        if body.force is not None:
            (x, y, angle), (u, v, spin) = middle.tolist(), self.rate.tolist()
            given = body.force(time + 0.5 * dt, self._at(position=(x, y), angle=angle, velocity=(u, v), spin=spin))
            if np.shape(given) != (3,) or not np.isfinite(np.asarray(given, float)).all():
                raise InvalidDesign(
                    f"the force of {body.name} at t = {time:.4g} s is {show(given)}; give three finite numbers, the "
                    f"force along x and y in N/m and the torque in N (in space N and N m)."
                )
            outer = outer + np.asarray(given, float)
        return outer, 0.5 * dt * viscous + 0.25 * dt**2 * stiff

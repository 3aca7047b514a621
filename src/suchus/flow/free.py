"""Bodies that swim: three degrees of freedom under the water's forces.

The pressure answers a body's acceleration at once, ``F = F0 - Ma a``; the added mass ``Ma`` comes from three
solves of the pressure equation itself and goes to the left side, ``(M + Ma) a = F0``. Without it the coupling
of a light body is unstable. A body's deformation carries no momentum of its own: its frame moves so that the
centre of mass and the angular momentum change by the water's forces alone.
"""

from dataclasses import dataclass, field

import numpy as np

from suchus.errors import InvalidDesign
from suchus.flow.mass import Mass
from suchus.flow.pose import Pose
from suchus.flow.shape import Shape


@dataclass(frozen=True, slots=True, kw_only=True)
class FreeBody:
    """A shape that the water moves."""

    shape: Shape
    """What it looks like in its own frame, at every time."""
    start: tuple[float, float] = (0.0, 0.0)
    """Centre of mass at time 0 [m]."""
    angle: float = 0.0
    """Angle of the body's frame at time 0 [rad]."""
    velocity: tuple[float, float] = (0.0, 0.0)
    """Velocity of the centre of mass at time 0 [m/s]."""
    spin: float = 0.0
    """Angular momentum over moment of inertia at time 0 [rad/s]."""
    density: float | None = None
    """Density [kg/m^3]; None is the water's."""
    free: tuple[bool, bool, bool] = (True, True, True)
    """Whether it may move along x, along y, and turn."""
    name: str = "body"
    """Its name in records and messages."""

    def __post_init__(self) -> None:
        if self.density is not None and not self.density > 0:
            raise InvalidDesign(f"density of {self.name} is {self.density} kg/m3; a positive density is needed.")

    @property
    def still(self) -> bool:
        """A free body is never taken for still."""
        return False


_CHANGING = ("place", "rate", "push", "load", "added", "momentum", "owed", "span", "steps")

REPAID = 0.5
"""Share of the momentum still owed that a step repays [-]; all at once rings."""


@dataclass(slots=True)
class Swimmer:
    """A free body under way. Vectors are (x, y, turning)."""

    body: FreeBody
    """Which body."""
    place: np.ndarray
    """Centre of mass and angle of the frame, shape (3,) [m, rad]."""
    rate: np.ndarray
    """Velocity of the centre and angular momentum over moment, shape (3,) [m/s, rad/s]."""
    push: np.ndarray = field(default_factory=lambda: np.zeros(3))
    """Acceleration in the last step, shape (3,) [m/s^2, rad/s^2]."""
    load: np.ndarray = field(default_factory=lambda: np.zeros(3))
    """Force and torque of the water in the last step [N/m, N]."""
    added: np.ndarray = field(default_factory=lambda: np.zeros((3, 3)))
    """Added mass [kg/m, kg, kg m]."""
    momentum: np.ndarray = field(default_factory=lambda: np.zeros(3))
    """Momentum and angular momentum before the last step [kg/s, kg m/s]."""
    owed: np.ndarray = field(default_factory=lambda: np.zeros(3))
    """Momentum that the water gave and the body has not got yet [kg/s, kg m/s]."""
    span: float = 0.0
    """Length of the last step [s]."""
    steps: int = 0
    """Steps taken so far [-]."""

    @classmethod
    def of(cls, body: FreeBody) -> "Swimmer":
        """Return the body at its start."""
        return cls(body, np.array([*body.start, body.angle]), np.array([*body.velocity, body.spin]))

    def pose(self, mass: Mass) -> Pose:
        """Return the pose of the body's frame, whose deformation it has taken out of the motion."""
        angle = self.place[2]
        c, s = np.cos(angle), np.sin(angle)
        spin = self.rate[2] - mass.swirl / mass.moment if self.body.free[2] else 0.0
        rx, ry = c * mass.centre[0] - s * mass.centre[1], s * mass.centre[0] + c * mass.centre[1]
        ux, uy = (c * mass.centre_rate[0] - s * mass.centre_rate[1], s * mass.centre_rate[0] + c * mass.centre_rate[1])
        return Pose(
            position=(self.place[0] - rx, self.place[1] - ry), angle=angle,
            velocity=(self.rate[0] - ux + spin * ry, self.rate[1] - uy - spin * rx), spin=spin,
        )  # fmt: skip

    @property
    def place_and_rate(self) -> Pose:
        """Centre of mass and angle, with the velocities that the water's forces change."""
        (x, y, angle), (u, v, spin) = self.place.tolist(), self.rate.tolist()
        return Pose(position=(x, y), angle=angle, velocity=(u, v), spin=spin)

    def state(self) -> dict[str, np.ndarray]:
        """Return all that changes, by name."""
        return {key: np.array(getattr(self, key)) for key in _CHANGING}

    def resume(self, state: dict[str, np.ndarray]) -> None:
        """Set all that changes."""
        for key in _CHANGING:
            setattr(self, key, state[key] if state[key].ndim else state[key].item())

    def advance(self, time: float, dt: float, water_density: float) -> None:
        """Move on by ``dt`` [s] under the water's forces of the last step."""
        shape = self.body.shape
        density = water_density if self.body.density is None else self.body.density
        now, then = shape.mass(time), shape.mass(time + dt)
        inertia = np.diag([density * then.area, density * then.area, density * then.moment])
        momentum = density * np.array([now.area, now.area, now.moment]) * self.rate
        guess = self.load + self.added @ self.push
        if self.steps:
            self.owed = self.owed + self.span * self.load - (momentum - self.momentum)
        if self.steps > 1:  # the second step itself repays the jolt of the start
            # Extrapolating instead feeds every ripple of the force back into the motion. The last step's force comes
            # a step late; what the body therefore did not get, it gets little by little. Without that an eel, whose
            # added mass aside is ten times its own, sways several times too much.
            guess = guess + REPAID * self.owed / dt
        self.momentum, self.span = momentum, dt
        guess = guess - np.array([0, 0, density * (then.moment - now.moment) / dt * self.rate[2]])
        go = np.array(self.body.free)
        push = np.zeros(3)
        if self.steps:
            whole = inertia + self.added
            push[go] = np.linalg.solve(whole[np.ix_(go, go)], guess[go])
        rate = self.rate + dt * push
        recoil = [m.swirl / m.moment for m in (now, then)]
        move = dt * 0.5 * (self.rate + rate)
        if go[2]:
            move[2] -= dt * 0.5 * (recoil[0] + recoil[1])
        self.place, self.rate, self.push = self.place + move, rate, push
        self.steps += 1

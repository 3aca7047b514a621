"""Free bodies in motion: three degrees of freedom in the plane, six in space.

The pressure responds at once to a body's acceleration, ``F = F0 - Ma a``. The added mass ``Ma`` comes from three or
six solves of the pressure equation and is moved to the left side, ``(M + Ma) a = F0``. Otherwise the coupling of a
light body is unstable. The deformation of a body has no momentum of its own: the body's frame moves so that the centre
of mass and the angular momentum change by external forces alone. These are the forces of the water, weight minus
buoyancy, springs and dampers, and a force that the user gives.

In space the attitude is a rotation vector, which remains a rotation whatever a step adds to it. A step rotates the
body by the mean of the angular velocities at its start and end. Both follow from the angular momentum, which changes
by the torque times the step. A body without torques therefore keeps its angular momentum to rounding, its energy does
not drift, and the error of its attitude is of second order.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple
from warnings import warn

import numpy as np

from suchus.core import rotation
from suchus.core.errors import Diverged, Doubtful, InvalidDesign
from suchus.core.kinds import show
from suchus.flow.free import FreeBody
from suchus.flow.mass import Mass
from suchus.flow.pose import ROTATION_PLANES, Pose, cross, rotate_vectors


def to_degrees_of_freedom(values: Sequence[float], ndim: int) -> np.ndarray:
    """Return values for all degrees of freedom; of three values in space, those along z and about x and y are 0.

    Args:
        values: along x and y and about z, or all six.
        ndim: number of axes of the domain, 2 or 3.
    """
    if ndim == 2 or len(values) == 6:
        return np.array(values)
    x, y, turn = values
    return np.array([x, y, 0 * x, 0 * x, 0 * x, turn])


def _lengthened(vector: Sequence[float], ndim: int) -> list[float]:
    """Return a vector with as many components as there are axes."""
    return [*vector, *(0.0,) * (ndim - len(vector))]


def _attitude(yaw: float, pitch: float, roll: float) -> np.ndarray:
    """Return the rotation vector of three angles, shape (3,) [rad]."""
    if not (pitch or roll):
        return np.array([0.0, 0.0, yaw])
    return rotation.to_vector(rotation.from_angles(yaw, pitch, roll), np.zeros(3))


def _unwinding(vector: np.ndarray, slope: np.ndarray) -> np.ndarray:
    """Return the torque of a potential that depends on the attitude, shape (3,).

    It is ``-J^-T slope``, where the rotation vector r changes by ``J^-1 dw`` as the body turns by dw.
    Source: Sola, Deray, Atchuthan 2018, arXiv:1812.01537, Eq. (146).

    Args:
        vector: rotation vector of the attitude [rad].
        slope: gradient of the potential by the rotation vector.
    """
    angle = float(np.linalg.norm(vector))
    curvature = 1 / 12 if angle < 1e-3 else (1 - 0.5 * angle / np.tan(0.5 * angle)) / angle**2
    twist = np.cross(vector, slope)
    torque: np.ndarray = -(slope + 0.5 * twist + curvature * np.cross(vector, twist))
    return torque


_CHANGING = {
    "place": "coordinates",
    "rate": "rate",
    "push": "acceleration",
    "load": "load",
    "added": "added_mass",
    "momentum": "momentum",
    "owed": "residual_impulse",
    "applied": "applied",
    "span": "span",
    "steps": "steps",
}
"""Attributes that change, by their key in a checkpoint."""

RESIDUAL_RELAXATION = 0.5
"""Fraction of the momentum still owed that a step repays [-]; all at once excites oscillations."""

MAX_ITERATIONS = 40
"""Most iterations in which attitude and angular velocity at the end of a step converge [-]. Each reduces the error by
about the angle that the body turns in a step."""

_RATE_TOLERANCE = 1e-14
"""Relative change of the rates at which the iteration stops [-]."""


_FORCE_MOMENTS = 0.5, 1.0
"""Fractions of a step at which a body's own force is evaluated to bound the step; the first counts for its motion."""

MAX_STEP_REDUCTIONS = 40
"""Most attempts to find a step in which a body does not move too far [-]. Each shortens the step."""


class _Motion(NamedTuple):
    """Motion of a free body in one step, per degree of freedom."""

    coordinates: np.ndarray
    """Centre of mass and attitude at the end [m, rad]."""
    rate: np.ndarray
    """Rates at the end [m/s, rad/s]."""
    acceleration: np.ndarray
    """Mean acceleration [m/s^2, rad/s^2]."""
    applied: np.ndarray
    """Mean force and torque except those of the water [N/m, N]."""
    momentum: np.ndarray
    """Momentum and angular momentum at the start [kg/s, kg m/s]."""
    residual_impulse: np.ndarray
    """Momentum still owed at the start [kg/s, kg m/s]."""


@dataclass(slots=True)
class Swimmer:
    """State of a free body. Vectors are per degree of freedom, shape (3,) or (6,); in the plane per metre of depth."""

    body: FreeBody
    """The free body."""
    coordinates: np.ndarray
    """Centre of mass and angle of the frame, in space its rotation vector [m, rad]."""
    rate: np.ndarray
    """Velocity of the centre, and angular momentum over the tensor of inertia [m/s, rad/s]."""
    is_free: np.ndarray
    """Whether the body is free in each degree of freedom."""
    acceleration: np.ndarray = field(init=False)
    """Acceleration in the last step [m/s^2, rad/s^2]."""
    load: np.ndarray = field(init=False)
    """Force and torque of the water in the last step [N/m, N; in space N, N m]."""
    added_mass: np.ndarray = field(init=False)
    """Added mass, a square matrix [kg/m, kg, kg m; in space kg, kg m, kg m^2]."""
    momentum: np.ndarray = field(init=False)
    """Momentum and angular momentum before the last step [kg/s, kg m/s; in space kg m/s, kg m^2/s]."""
    residual_impulse: np.ndarray = field(init=False)
    """Momentum given by water and other forces that has not yet changed the body's motion [kg/s, kg m/s]."""
    applied: np.ndarray = field(init=False)
    """Force and torque in the last step, except those of the water [N/m, N]."""
    is_said: bool = False
    """Whether a warning of a force of three numbers has been issued."""
    span: float = 0.0
    """Length of the last step [s]."""
    steps: int = 0
    """Number of steps taken [-]."""

    def __post_init__(self) -> None:
        count = len(self.coordinates)
        self.acceleration, self.load, self.momentum, self.residual_impulse, self.applied = np.zeros((5, count))
        self.added_mass = np.zeros((count, count))

    @classmethod
    def from_body(cls, body: FreeBody) -> "Swimmer":
        """Return a free body in its initial state."""
        ndim = body.shape.ndim
        turns = len(ROTATION_PLANES[ndim])
        place = np.array([*_lengthened(body.start, ndim), *_attitude(body.angle, body.pitch, body.roll)[-turns:]])
        rate = np.array([*_lengthened(body.velocity, ndim), *(body.spin_x, body.spin_y, body.spin)[-turns:]])
        free = (True,) * place.size if body.free is None else body.free
        return cls(body, place, rate, to_degrees_of_freedom(free, ndim).astype(bool))

    @property
    def _ndim(self) -> int:
        return self.body.shape.ndim

    @staticmethod
    def _angles(turn: np.ndarray) -> tuple[float, float, float]:
        """Return yaw, pitch and roll of an attitude; a body that turns about z alone counts its whole turns.

        Args:
            turn: angle in the plane, shape (1,), or rotation vector in space, shape (3,) [rad].
        """
        if turn[:-1].any():
            return rotation.angles(rotation.from_vector(turn))
        return float(turn[-1]), 0.0, 0.0

    def _matrix(self, place: np.ndarray) -> np.ndarray:
        """Return the rotation matrix of the body's frame, shape (3, 3); see ``Pose.matrix``.

        Args:
            place: centre of mass and attitude [m, rad].
        """
        turn = place[self._ndim :]
        return rotation.turn(turn) if turn[:-1].any() else Pose(angle=float(turn[-1])).matrix

    def _pose(self, place: np.ndarray, velocity: np.ndarray, spins: np.ndarray) -> Pose:
        """Return the pose whose origin is a place.

        Args:
            place: position and attitude [m, rad].
            velocity: velocity of the origin [m/s].
            spins: angular velocity about z, in space about x, y and z [rad/s].
        """
        ndim = self._ndim
        yaw, pitch, roll = self._angles(place[ndim:])
        spin_x, spin_y, spin = (0.0, 0.0, *spins.tolist())[-3:]
        return Pose(
            position=tuple(place[:ndim].tolist()), angle=yaw, pitch=pitch, roll=roll, velocity=tuple(velocity.tolist()),
            spin_x=spin_x, spin_y=spin_y, spin=spin,
        )  # fmt: skip

    def pose(self, mass: Mass) -> Pose:
        """Return the pose of the body's frame, which recoils from the deformation of the body.

        Args:
            mass: mass properties of the present shape in the body's frame.
        """
        ndim, matrix = self._ndim, self._matrix(self.coordinates)
        rate, spins = self.rate[:ndim], self.rate[ndim:]
        spins = np.where(self.is_free[ndim:], spins - mass.recoil(matrix)[ndim:], spins)
        offset, drift = rotate_vectors(matrix, mass.centre), rotate_vectors(matrix, mass.centre_rate)
        place = np.concatenate([self.coordinates[:ndim] - np.array(offset), self.coordinates[ndim:]])
        return self._pose(place, rate - np.array(drift) - np.array(cross(spins, offset)), spins)

    @property
    def place_and_rate(self) -> Pose:
        """Centre of mass and attitude, with the velocities that the water's forces change."""
        return self._state(self.coordinates)

    def _state(self, place: np.ndarray) -> Pose:
        return self._pose(place, self.rate[: self._ndim], self.rate[self._ndim :])

    def set_added_mass(self, mass: np.ndarray, time: float) -> None:
        """Set the added mass.

        Args:
            mass: square matrix; NaN is allowed in locked degrees of freedom and counts as 0.
            time: time of its computation, for the message [s].

        Raises:
            Diverged: it is not finite in a free degree of freedom.
        """
        free_mass = mass[np.ix_(self.is_free, self.is_free)]
        if not np.isfinite(free_mass).all():
            entry = free_mass[~np.isfinite(free_mass)][0]
            raise Diverged(
                f"at t = {time:.4g} s the added mass of {self.body.name} is {entry} in a degree of freedom in which it "
                f"may move; take a finer grid around it, precision='double', or lock that degree.",
                time=time,
            )
        self.added_mass = np.nan_to_num(mass)

    def state(self) -> dict[str, np.ndarray]:
        """Return all that changes, by name."""
        return {key: np.array(getattr(self, name)) for key, name in _CHANGING.items()}

    def resume(self, state: dict[str, np.ndarray]) -> None:
        """Set all that changes."""
        for key, name in _CHANGING.items():
            setattr(self, name, state[key] if state[key].ndim else state[key].item())

    def advance(self, time: float, dt: float, water_density: float, contact: np.ndarray | None = None) -> None:
        """Advance by one step under the water's forces of the last step and the other forces of this one.

        Springs and dampers act at the mean of the step's start and end, the other forces at a midpoint extrapolated
        from the start. Neither adds energy.

        Args:
            time: start of the step [s].
            dt: length of the step [s].
            water_density: density of the water [kg/m^3].
            contact: force and torque of bodies and walls that nearly touch, shape (degree,) [N/m, N; in space N, N m].

        Raises:
            InvalidDesign: the body's own force is not three or six finite numbers.
        """
        motion = self._motion(time, dt, water_density, contact)
        self.momentum, self.span, self.residual_impulse = motion.momentum, dt, motion.residual_impulse
        self.coordinates, self.rate, self.acceleration = motion.coordinates, motion.rate, motion.acceleration
        self.applied = motion.applied
        self.steps += 1

    def is_pushed(self, water_density: float) -> bool:
        """Return whether weight, springs, dampers or a force act on the body besides the water.

        Args:
            water_density: density of the water [kg/m^3].
        """
        body = self.body
        is_heavy = body.density not in (None, water_density) and any(body.gravity)
        return is_heavy or any(body.springs) or any(body.dampers) or body.force is not None

    def max_step(
        self, time: float, dt: float, water_density: float, contact: np.ndarray | None, grid_velocity: np.ndarray,
        reach: float, max_distance: float,
    ) -> float:  # fmt: skip
        """Return the longest step in which the body, at its speed at the end, moves by a distance [s]; ``dt`` at most.

        The speed at the start does not bound the step of a body that is released or pushed.

        Args:
            time: start of the step [s].
            dt: length of the step that the fields allow [s].
            water_density: density of the water [kg/m^3].
            contact: see ``advance``.
            grid_velocity: velocity relative to which the distance counts, shape (axis,) [m/s].
            reach: distance of the surface from the centre of mass [m].
            max_distance: largest distance of a point of the surface [m].

        Raises:
            InvalidDesign: see ``advance``.
        """
        ndim, start_speed = self._ndim, self._surface_speed(self.rate, grid_velocity, reach)
        pushed = self.body.force is not None
        for _ in range(MAX_STEP_REDUCTIONS):
            motions = [
                self._motion(time, dt, water_density, contact, moment) for moment in _FORCE_MOMENTS[: 1 + pushed]
            ]
            motion = max(motions, key=lambda motion: self._surface_speed(motion.rate, grid_velocity, reach))
            end_speed = self._surface_speed(motion.rate, grid_velocity, reach)
            if end_speed <= start_speed or end_speed * dt <= max_distance:
                break
            acceleration = self._surface_speed(motion.acceleration, np.zeros(ndim), reach)
            dt = min(
                0.99 * dt,
                2 * max_distance / (start_speed + np.sqrt(start_speed**2 + 4 * acceleration * max_distance)),
            )
        return float(dt)

    def _surface_speed(self, rate: np.ndarray, grid_velocity: np.ndarray, reach: float) -> float:
        """Return the greatest speed of a point of the surface [m/s].

        Args:
            rate: rate of each degree of freedom [m/s, rad/s].
            grid_velocity: velocity relative to which it counts [m/s].
            reach: distance of the surface from the centre of mass [m].
        """
        ndim = self._ndim
        return float(np.linalg.norm(rate[:ndim] - grid_velocity) + reach * np.linalg.norm(rate[ndim:]))

    def _motion(
        self, time: float, dt: float, water_density: float, contact: np.ndarray | None, force_moment: float = 0.5
    ) -> "_Motion":
        """Return the motion in a step; see ``advance``. The state does not change.

        Args:
            time: start of the step [s].
            dt: length of the step [s].
            water_density: density of the water [kg/m^3].
            contact: force and torque of other bodies that nearly touch, or None.
            force_moment: fraction of the step at which the body's own force is evaluated [-].
        """
        shape = self.body.shape
        density = water_density if self.body.density is None else self.body.density
        start_mass, end_mass = shape.mass(time), shape.mass(time + dt)
        matrix = self._matrix(self.coordinates)
        start_inertia, slip = start_mass.inertia(matrix), self._slip(start_mass, matrix)
        momentum = (density * start_inertia) @ self.rate
        residual_impulse = self._residual_impulse_before(momentum)
        expected_force = self._expected_force(residual_impulse, dt)
        recoil = slip + self._slip(end_mass, matrix)
        outer, yielding = self._outer(time, dt, (density - water_density) * start_mass.volume, recoil, force_moment)
        if contact is not None:
            outer = outer + contact
        rate = self.rate
        for count in range(MAX_ITERATIONS):  # one is exact in the plane; in space the first assumes a fixed attitude
            end_inertia = end_mass.inertia(matrix)
            inertia_change = end_inertia - start_inertia
            inertia_change[: self._ndim] = 0
            force = expected_force - (density * inertia_change / dt) @ self.rate + outer
            total_inertia = density * end_inertia + self.added_mass + np.diag(yielding)
            push = self._accelerated(total_inertia, force)
            previous_rate, rate = rate, self.rate + dt * push
            place = self._displaced(dt * 0.5 * (self.rate + rate) - dt * 0.5 * recoil)
            rate_change = np.abs(rate - previous_rate).max()
            if self._ndim == 2 or (count and rate_change <= _RATE_TOLERANCE * np.abs(rate).max()):
                break
            matrix = self._matrix(place)
            recoil = slip + self._slip(end_mass, matrix)
        return _Motion(place, rate, push, outer - yielding * push, momentum, residual_impulse)

    def _residual_impulse_before(self, momentum: np.ndarray) -> np.ndarray:
        """Return the momentum still owed at the start of a step [kg/s, kg m/s; in space kg m/s, kg m^2/s].

        Args:
            momentum: momentum of the body at the start of the step, in the same units.
        """
        if not self.steps:
            return self.residual_impulse
        return self.residual_impulse + self.span * (self.load + self.applied) - (momentum - self.momentum)

    def _expected_force(self, residual_impulse: np.ndarray, dt: float) -> np.ndarray:
        """Return the water's force expected in a step without acceleration [N/m, N; in space N, N m].

        Args:
            residual_impulse: momentum still owed at the start of the step [kg/s, kg m/s].
            dt: length of the step [s].
        """
        force: np.ndarray = self.load + self.added_mass @ self.acceleration
        if self.steps > 1:  # the second step compensates the sudden start by itself
            # The force of the last step is one step late. The missing momentum is repaid gradually. Otherwise an eel,
            # whose lateral added mass is ten times its own mass, sways several times too much. An extrapolation of the
            # force would instead amplify its fluctuations.
            force = force + RESIDUAL_RELAXATION * residual_impulse / dt
        return force

    def _accelerated(self, total_inertia: np.ndarray, force: np.ndarray) -> np.ndarray:
        """Return the acceleration in the free degrees of freedom, and 0 in the others.

        Args:
            total_inertia: mass of the body and added mass, with the terms of springs and dampers, a square matrix.
            force: force on a body that does not accelerate.
        """
        push = np.zeros(self.coordinates.size)
        push[self.is_free] = np.linalg.solve(total_inertia[np.ix_(self.is_free, self.is_free)], force[self.is_free])
        return push

    def _slip(self, mass: Mass, matrix: np.ndarray) -> np.ndarray:
        """Return the velocity that the deformation takes from the frame, as far as it is free."""
        slip: np.ndarray = np.where(self.is_free, mass.recoil(matrix), 0.0)
        return slip

    def _displaced(self, step: np.ndarray) -> np.ndarray:
        """Return the place after a displacement; in space the rotations are composed.

        Args:
            step: displacement and rotation vector [m, rad].
        """
        place = self.coordinates + step
        if step[3:5].any() or (self.coordinates[3:5].any() and step[3:].any()):  # else about z alone
            turn = rotation.multiply(rotation.from_vector(step[3:]), rotation.from_vector(self.coordinates[3:]))
            place[3:] = rotation.to_vector(turn, self.coordinates[3:] + step[3:])
        return place

    def _outer(
        self, time: float, dt: float, weight: float, recoil: np.ndarray, force_moment: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the mean of all external forces except the water's over a step, and their decrease per acceleration.

        The force is that on a body that does not accelerate [N/m, N]; the decrease is the diagonal of a matrix [kg/m,
        kg m].

        Args:
            time: start of the step [s].
            dt: length of the step [s].
            weight: mass of the body minus that of the displaced water [kg/m].
            recoil: velocity of the frame due to the deformation, sum of start and end [m/s, rad/s].
            force_moment: fraction of the step at which the body's own force is evaluated [-].

        Raises:
            InvalidDesign: the body's own force is not three or six finite numbers.
        """
        body, ndim = self.body, self._ndim
        mid_place = self._displaced(0.5 * dt * (self.rate - 0.5 * recoil))
        stiff, viscous = to_degrees_of_freedom(body.springs, ndim), to_degrees_of_freedom(body.dampers, ndim)
        pull = _lengthened(body.gravity, ndim)
        outer = weight * np.array([*pull, *np.zeros(mid_place.size - ndim)]) - self._spring_force(mid_place, stiff)
        outer = outer - viscous * self.rate
        if body.force is not None:
            force = body.force(time + force_moment * dt, self._state(mid_place))
            sizes = [(3,)] if ndim == 2 else [(3,), (6,)]
            if np.shape(force) not in sizes or not np.isfinite(np.asarray(force, float)).all():
                raise InvalidDesign(
                    f"the force of {body.name} at t = {time:.4g} s is {show(force)}; give three finite numbers, the "
                    f"force along x and y in N/m and the torque in N (in space N and N m, or six numbers: forces along "
                    f"and torques about x, y and z)."
                )
            if ndim == 3 and len(force) == 3 and self.is_free[2:5].any() and not self.is_said:
                self.is_said = True
                warn(
                    Doubtful(
                        f"the force of {body.name} at t = {time:.4g} s is {show(force)}; of three numbers in space the "
                        f"third is the torque about z. Give six: forces along and torques about x, y and z."
                    ),
                    stacklevel=2,
                )
            outer = outer + to_degrees_of_freedom(np.asarray(force, float).tolist(), ndim)
        return outer, 0.5 * dt * viscous + 0.25 * dt**2 * stiff

    def _spring_force(self, mid_place: np.ndarray, stiff: np.ndarray) -> np.ndarray:
        """Return the elastic force of the springs, positive along the displacement [N/m, N].

        Args:
            mid_place: place of the body [m, rad].
            stiff: stiffness of each degree of freedom.
        """
        slack = self._slack_place()
        spring_force = stiff * (mid_place - slack)
        if stiff[3:].any():
            turn = rotation.multiply(rotation.from_vector(mid_place[3:]), rotation.from_vector(-slack[3:]))
            vector = rotation.to_vector(turn, mid_place[3:] - slack[3:])
            spring_force[3:] = -_unwinding(vector, stiff[3:] * vector)
        return np.asarray(spring_force)

    def _slack_place(self) -> np.ndarray:
        """Return the place at which the springs are slack; of an anchor of three, the rest is that of the start."""
        anchor = self.body.anchor
        if anchor is None:
            return Swimmer.from_body(self.body).coordinates
        if self._ndim == 2:
            return np.array(anchor)
        if len(anchor) == 3:
            x, y, turn = anchor
            anchor = x, y, _lengthened(self.body.start, 3)[2], turn, 0.0, 0.0
        return np.array([*anchor[:3], *_attitude(*anchor[3:])])

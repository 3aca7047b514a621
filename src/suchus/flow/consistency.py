# mypy: disable-error-code="no-untyped-def"
# (the kernels get their types from numba)
"""Check that the rates that a motion or a bending body declares are the time derivatives of its positions.

The solver takes the velocity of the wall from the rates and its place from the positions. Where they differ, forces and
power are wrong and nothing else shows it.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol
from warnings import warn

import numpy as np

from suchus.core import rotation
from suchus.core.errors import Doubtful, InvalidDesign
from suchus.flow.compiled import compiled
from suchus.flow.linked import LinkStates
from suchus.flow.midline import MidlineState
from suchus.flow.pose import Motion, Pose

RATE_TOLERANCE = 0.1
"""Largest difference of declared and measured rate, over the larger of the two [-]."""

DOUBTFUL_RATE_TOLERANCE = 0.03
"""The same difference above which a warning is issued [-]."""

MIN_SPEED_RATIO = 0.05
"""Speed, over the fastest so far, below which differences are compared with this speed instead of the rates [-]."""

MIN_RATE_RATIO = 0.05
"""Speed, over the fastest now, up to which one kind of rate may be wrong [-]. An undulation changes arc lengths, and so
half-widths, by some 2 %; the rate of a heading moves an eel's sides by 7 % and more."""

DISTANCE_TOLERANCE = 1e-5
"""Distance between the two in one step that is always allowed [cells]."""

RIGID_TOLERANCE = 1e-3
"""Largest distance that a body with ``deforms=False`` may move by itself in the first step [cells]."""

MAX_CONSECUTIVE_ERRORS = 3
"""Consecutive disagreements that raise an error: a kink of the motion causes one [-]."""

MAX_POSITION_ERROR = 1.0
"""Largest distance of a body from the position that its rates lead to [cells]. A kink within a step, where the rates
change at once, may add half of the distance that the greatest rate so far covers in a step."""

_HALVINGS = 40  # of a step, until no point moves farther than a cell
_COMPARISON_FRACTION = 0.01  # fraction of a step over which positions are compared


@compiled
def compare_rates(excess, doubt, sizes, declared_rate, measured_rate, arms, kinds, max_speed, distance_speed):
    """Write the differences of declared and measured rates over those that are allowed.

    Args:
        excess: difference over what ``RATE_TOLERANCE`` allows, shape (coordinate,), to write to [-].
        doubt: difference over what ``DOUBTFUL_RATE_TOLERANCE`` allows, to write to [-].
        sizes: fastest speed of each kind of coordinate, to add to [m/s].
        declared_rate: shape (coordinate,) [m/s, rad/s].
        measured_rate: shape (coordinate,) [m/s, rad/s].
        arms: see ``CoordinateSeries``.
        kinds: see ``CoordinateSeries``.
        max_speed: fastest speed so far [m/s].
        distance_speed: difference that is always allowed [m/s].

    Returns:
        The fastest speed with this one [m/s], and the largest of both ratios [-].
    """
    fastest = 0.0
    for k in range(arms.size):
        speed = max(abs(declared_rate[k]), abs(measured_rate[k])) * arms[k]
        sizes[kinds[k]] = max(sizes[kinds[k]], speed)
        fastest = max(fastest, speed)
    max_speed = max(max_speed, fastest)
    min_speed = max(MIN_RATE_RATIO * fastest, RATE_TOLERANCE * MIN_SPEED_RATIO * max_speed, distance_speed)
    max_excess, max_doubt = 0.0, 0.0
    for k in range(arms.size):
        error, size = abs(declared_rate[k] - measured_rate[k]) * arms[k], sizes[kinds[k]]
        excess[k] = error / max(RATE_TOLERANCE * size, min_speed)
        doubt[k] = error / max(DOUBTFUL_RATE_TOLERANCE * size, min_speed)
        max_excess, max_doubt = max(max_excess, excess[k]), max(max_doubt, doubt[k])
    return max_speed, max_excess, max_doubt


@compiled
def follow_rates(drift, path, deviation, displacement, rates, arms, half_step, max_half_step_distance):
    """Add a step to the distances of a body from where its rates lead; return the largest distance in half a step [m].

    Args:
        drift: see ``Consistency``, shape (coordinate,), changed [m].
        path: see ``Consistency``, shape (coordinate,), changed [m].
        deviation: distance that the step adds, shape (coordinate,), to write to [m].
        displacement: change of the coordinates, shape (coordinate,) [m, rad].
        rates: their rates at the start and the end of the step, shape (2, coordinate) [m/s, rad/s].
        arms: see ``CoordinateSeries``.
        half_step: half of the step [s].
        max_half_step_distance: largest distance in half a step before [m].
    """
    for k in range(arms.size):
        start_distance, end_distance = half_step * rates[0, k] * arms[k], half_step * rates[1, k] * arms[k]
        max_half_step_distance = max(max_half_step_distance, abs(start_distance), abs(end_distance))
        deviation[k] = displacement[k] * arms[k] - (start_distance + end_distance)
        drift[k] += deviation[k]
        path[k] += abs(displacement[k] * arms[k])
    return max_half_step_distance


@compiled
def exceeds(deviation, drift, path, tolerance):
    """Return whether a body is not where its rates lead.

    Args:
        deviation: see ``follow_rates`` [m].
        drift: see ``follow_rates`` [m].
        path: see ``follow_rates`` [m].
        tolerance: distance that is allowed [m].
    """
    for k in range(drift.size):
        if abs(deviation[k]) > tolerance or abs(drift[k]) > max(tolerance, RATE_TOLERANCE * path[k]):
            return True
    return False


class CoordinateSeries(NamedTuple):
    """Coordinates of a body at some times, each of shape (time, coordinate)."""

    coordinates: np.ndarray
    """Coordinates less those at the first time [m, rad]."""
    rates: np.ndarray
    """Their declared rates [m/s, rad/s]."""
    arms: np.ndarray
    """Displacement of the surface per unit of each coordinate, shape (coordinate,) [m/m, m/rad]."""
    kinds: np.ndarray
    """Kind of each coordinate, counted from 0, shape (coordinate,) [-]."""


class RateSource(Protocol):
    """A source of coordinates and their rates."""

    def sample(self, times: Sequence[float]) -> CoordinateSeries:
        """Return the coordinates and rates at some times [s]."""

    def error_text(self, index: int, declared_rate: np.ndarray, measured_rate: np.ndarray) -> str:
        """Return a sentence with the declared and the measured rate of a coordinate, and the remedy."""

    def label(self, index: int) -> str:
        """Return the name of a coordinate for messages."""


def _wrap_angle(angle: np.ndarray) -> np.ndarray:
    """Return angles from -pi to pi: whole turns move nothing [rad]."""
    wrapped_angle: np.ndarray = (angle + np.pi) % (2 * np.pi) - np.pi
    return wrapped_angle


_PLANE_KINDS = np.array([0, 0, 1])
"""Kinds of the coordinates of a pose in the plane: position and angle [-]."""


class MotionSource(NamedTuple):
    """The poses of a body."""

    name: str
    """Name of the body."""
    motion: Motion
    """Its motion."""
    bounding_radius: float
    """Distance of the body's surface from the origin of its frame [m]."""

    def sample(self, times: Sequence[float]) -> CoordinateSeries:
        """Return positions and angles, in space rotation vectors from the first pose, and their rates."""
        poses = [self.motion(time) for time in times]
        ndim = len(poses[0].position)
        if ndim == 2:
            rows = np.array([(*p.position, p.angle, *p.velocity, p.spin) for p in poses])
            shifts = rows[:, :3] - rows[0, :3]
            shifts[:, 2] = _wrap_angle(shifts[:, 2])
            return CoordinateSeries(
                shifts, np.ascontiguousarray(rows[:, 3:]), np.array([1.0, 1.0, self.bounding_radius]), _PLANE_KINDS
            )
        places = np.array([[*p.position, *_turn(poses[0], p)] for p in poses])
        rates = np.array([[*p.velocity, *([p.spin] if ndim == 2 else p.spins)] for p in poses])
        turns = (np.arange(places.shape[1]) >= ndim).astype(int)
        return CoordinateSeries(places - places[0], rates, np.where(turns, self.bounding_radius, 1.0), turns)

    def error_text(self, index: int, declared_rate: np.ndarray, measured_rate: np.ndarray) -> str:
        """Return both rates and the remedy."""
        ndim = 2 if declared_rate.size == 3 else 3
        turning = index >= ndim
        rate_name, position_name = (
            ("spin", "angle" if ndim == 2 else "attitude") if turning else ("velocity", "position")
        )

        def numbers(rate: np.ndarray) -> str:
            parts, unit = (rate[ndim:], "rad/s") if turning else (rate[:ndim], "m/s")
            text = ", ".join(f"{component:.4g}" for component in parts)
            return f"({text}) {unit}" if parts.size > 1 else f"{text} {unit}"

        return (
            f"the motion of {self.name} gives the {rate_name} {numbers(declared_rate)}, and its {position_name} "
            f"changes by {numbers(measured_rate)}; give a Pose whose {rate_name} is the rate of its {position_name}."
        )

    def label(self, index: int) -> str:  # noqa: ARG002 - a midline says which station it is
        """Return which body it is."""
        return self.name


class MidlineSource(NamedTuple):
    """The stations of a body that bends."""

    name: str
    """Name of the body."""
    spine: Callable[[float], MidlineState]
    """Its midline at every time [s]."""

    def sample(self, times: Sequence[float]) -> CoordinateSeries:
        """Return position, heading and half-width of the stations, one after the other, and their rates.

        Raises:
            InvalidDesign: the number of stations changes.
        """
        states = [self.spine(time) for time in times]
        count = states[0].x.size
        samples = np.empty((len(times), 8, count))  # x, y, heading, half-width, and their rates
        for time, state, sample in zip(times, states, samples, strict=True):
            if state.x.size != count:
                raise InvalidDesign(
                    f"the midline of {self.name} has {count} stations at t = {times[0]:.4g} s and "
                    f"{state.x.size} at t = {time:.4g} s; give as many at every time."
                )
            sample[0], sample[1], sample[2], sample[3] = state.x, state.y, state.heading, state.half_width
            sample[4], sample[5], sample[6] = state.x_rate, state.y_rate, state.heading_rate
            sample[7] = 0.0 if state.half_width_rate is None else state.half_width_rate
        reference = samples[0]
        places, rates = samples[:, :4] - reference[:4], samples[:, 4:]
        places[:, 2] = _wrap_angle(places[:, 2])
        arms = np.ones(places.shape[1:])
        arms[2] = reference[3]
        kinds = np.repeat([0, 0, 1, 2], arms.shape[1])
        return CoordinateSeries(places.reshape(len(times), -1), rates.reshape(len(times), -1), arms.ravel(), kinds)

    def refuse_motion(self, time: float, dt: float, cell: float) -> None:
        """Refuse a midline that moves although its body is declared not to deform.

        Args:
            time: time [s].
            dt: a step, after which the midline is compared [s].
            cell: side of a cell [m].

        Raises:
            InvalidDesign: a station moves, or has a rate.
        """
        series = self.sample((time, time + dt))
        distance = float(np.abs(np.array([series.coordinates[1], dt * series.rates[0]]) * series.arms).max())
        if distance > RIGID_TOLERANCE * cell:
            raise InvalidDesign(
                f"{self.name} has deforms=False, and its midline moves by {distance:.3g} m in the first step of "
                f"{dt:.3g} s, by its places or its rates; leave out deforms, or move the whole body by its motion."
            )

    def error_text(self, index: int, declared_rate: np.ndarray, measured_rate: np.ndarray) -> str:
        """Return both rates of the worst station and the remedy."""
        row, station = divmod(index, declared_rate.size // 4)
        quantity, unit = ("x", "y", "heading", "half_width")[row], "rad/s" if row == 2 else "m/s"
        return (
            f"the midline of {self.name} gives the {quantity}_rate {declared_rate[index]:.4g} {unit} at station "
            f"{station}, and its {quantity} changes by {measured_rate[index]:.4g} {unit}; give a MidlineState whose "
            f"{quantity}_rate is the rate of its {quantity}."
        )

    def label(self, index: int) -> str:
        """Return which station it is."""
        return f"station {index % self.spine(0.0).x.size} of the midline of {self.name}"


class LinkSource(NamedTuple):
    """The links of a body, each with a pose of its own."""

    name: str
    """Name of the body."""
    motion: Callable[[float], LinkStates]
    """The links at every time [s]."""
    bounding_radii: np.ndarray
    """Distance of each link's surface from its origin, shape (link,) [m]."""

    def sample(self, times: Sequence[float]) -> CoordinateSeries:
        """Return positions of the links and their rotation vectors from the first time, and their rates."""
        states = [self.motion(time) for time in times]
        reference, count = states[0], len(self.bounding_radii)
        turns = [rotation.vectors(state.matrix @ np.swapaxes(reference.matrix, 1, 2)) for state in states]
        places = np.array(
            [[*(s.position - reference.position).ravel(), *t.ravel()] for s, t in zip(states, turns, strict=True)]
        )
        rates = np.array([[*s.velocity.ravel(), *s.spin.ravel()] for s in states])
        arms = np.concatenate([np.ones(3 * count), np.repeat(self.bounding_radii, 3)])
        return CoordinateSeries(places, rates, arms, np.repeat([0, 1], 3 * count))

    def error_text(self, index: int, declared_rate: np.ndarray, measured_rate: np.ndarray) -> str:
        """Return both rates of the worst link and the remedy."""
        turning = index >= 3 * len(self.bounding_radii)
        rate_name, position_name, unit = ("spin", "matrix", "rad/s") if turning else ("velocity", "position", "m/s")
        return (
            f"the motion of {self.name} gives link {self._link(index)} the {rate_name} {declared_rate[index]:.4g} "
            f"{unit} along {'xyz'[index % 3]}, and its {position_name} changes by {measured_rate[index]:.4g} {unit}; "
            f"give LinkStates whose {rate_name} is the rate of the {position_name}."
        )

    def label(self, index: int) -> str:
        """Return which link it is."""
        return f"link {self._link(index)} of {self.name}"

    def _link(self, index: int) -> int:
        return index % (3 * len(self.bounding_radii)) // 3


@dataclass(slots=True)
class Consistency:
    """Checks the rates of one motion or bending body, step by step."""

    source: RateSource
    """The motion or body."""
    cell: float
    """Side of a cell [m]."""
    check_interval: int = 1
    """Steps between two comparisons of the rates [-]; leaps are looked for in every step."""
    max_speed: float = 0.0
    """Fastest speed so far, of either kind [m/s]."""
    consecutive_errors: int = 0
    """Times in a row that rates and positions disagreed [-]."""
    consecutive_doubts: int = 0
    """Times in a row that they disagreed by more than ``DOUBTFUL_RATE_TOLERANCE`` [-]."""
    is_doubtful: bool = False
    """Whether a warning of rates has been issued."""
    steps: int = 0
    """Steps looked at [-]."""
    max_half_step_distance: float = 0.0
    """Largest distance that the rates covered in half a step so far [m]."""
    drift: np.ndarray = field(default_factory=lambda: np.zeros(1))
    """Displacement of each coordinate minus the integral of its rate [m]."""
    path: np.ndarray = field(default_factory=lambda: np.zeros(1))
    """Length of the path of each coordinate [m]."""

    def max_step(self, time: float, dt: float) -> float:
        """Return the longest step in which no point moves farther than a cell [s]; ``dt`` for a body that leaps.

        The speed at the start does not bound the step of a body that accelerates, such as one that starts from rest.

        Args:
            time: start of the step [s].
            dt: length of the step that is wanted [s].
        """
        step = dt
        for _ in range(_HALVINGS):
            series = self.source.sample((time, *(time + fraction * step for fraction in (1 / 3, 1 / 2, 1))))
            if np.abs(series.coordinates * series.arms).max() <= MAX_POSITION_ERROR * self.cell:
                return step
            step /= 2
        return dt

    def start(self, time: float, dt: float) -> None:
        """Compare rates and positions in the first step.

        Args:
            time: start of the step [s].
            dt: approximate length of the step [s].

        Raises:
            InvalidDesign: rates and positions disagree, with both numbers.
        """
        for k in reversed(
            range(MAX_CONSECUTIVE_ERRORS)
        ):  # last at the start of the step, so that the message is about the start
            self._compare(time + k * dt / MAX_CONSECUTIVE_ERRORS, dt)
        self.consecutive_errors = self.consecutive_doubts = 0

    def check_step(self, time: float, dt: float) -> None:
        """Compare rates and positions at the start of a step and over all of it.

        Args:
            time: start of the step [s].
            dt: length of the step [s].

        Raises:
            InvalidDesign: they disagree for the third time in a row, or the body is not where its rates lead.
        """
        if self.steps % self.check_interval == 0:
            self._compare(time, dt)
        self.steps += 1
        series = self.source.sample((time, time + dt))
        count = series.arms.size
        drift, path = (np.array(np.broadcast_to(a, count)) for a in (self.drift, self.path))
        deviation = np.empty(count)
        self.max_half_step_distance = follow_rates(
            drift, path, deviation, series.coordinates[1], series.rates, series.arms, 0.5 * dt,
            self.max_half_step_distance,
        )  # fmt: skip
        self.drift, self.path = drift, path
        tolerance = MAX_POSITION_ERROR * self.cell + self.max_half_step_distance
        if not exceeds(deviation, drift, path, tolerance):
            return
        is_inconsistent = (np.abs(deviation) > tolerance) | (
            np.abs(self.drift) > np.maximum(tolerance, RATE_TOLERANCE * self.path)
        )
        worst_index = int(np.where(is_inconsistent, np.abs(self.drift), 0.0).argmax())
        raise InvalidDesign(
            f"at t = {time + dt:.4g} s {self.source.label(worst_index)} is {abs(self.drift[worst_index]):.3g} m away "
            f"from where its rates have led it ({abs(deviation[worst_index]):.3g} m in the last step of {dt:.3g} s; a "
            f"cell is {self.cell:.3g} m): a body cannot leap. Give places without jumps and rates that are theirs, or, "
            f"if they are right and only fast, a smaller step."
        )

    def _compare(self, time: float, dt: float) -> None:
        """Compare the declared rates with difference quotients of the positions, at the start of a step.

        Args:
            time: start of the step [s].
            dt: length of the step [s].

        Raises:
            InvalidDesign: they disagree for the third time in a row.
        """
        span = _COMPARISON_FRACTION * dt
        series = self.source.sample([time + k * span for k in range(3)])
        declared_rate, measured_rate = series.rates[0], (4 * series.coordinates[1] - series.coordinates[2]) / (2 * span)
        excess, doubt, sizes = np.zeros((3, series.arms.size))
        self.max_speed, max_excess, max_doubt = compare_rates(
            excess, doubt, sizes, declared_rate, measured_rate, series.arms, series.kinds, self.max_speed,
            DISTANCE_TOLERANCE * self.cell / dt,
        )  # fmt: skip
        self.consecutive_doubts = self.consecutive_doubts + 1 if max_doubt > 1 else 0
        if self.consecutive_doubts == MAX_CONSECUTIVE_ERRORS and not self.is_doubtful:
            self.is_doubtful = True
            text = self.source.error_text(int(doubt.argmax()), declared_rate, measured_rate)
            warn(Doubtful(f"at t = {time:.4g} s {text}"), stacklevel=4)
        if not max_excess > 1:
            self.consecutive_errors = 0
            return
        self.consecutive_errors += 1
        if self.consecutive_errors >= MAX_CONSECUTIVE_ERRORS:
            raise InvalidDesign(
                f"at t = {time:.4g} s {self.source.error_text(int(excess.argmax()), declared_rate, measured_rate)}"
            )


def _turn(start: Pose, end: Pose) -> np.ndarray:
    """Return the rotation vector from one pose in space to another [rad]."""
    if start.pitch == end.pitch == 0 and start.roll == end.roll == 0:
        return _wrap_angle(np.array([0.0, 0.0, end.angle - start.angle]))
    start_quaternion, end_quaternion = (rotation.from_angles(p.angle, p.pitch, p.roll) for p in (start, end))
    return rotation.to_vector(rotation.multiply(end_quaternion, start_quaternion * [1, -1, -1, -1]), np.zeros(3))

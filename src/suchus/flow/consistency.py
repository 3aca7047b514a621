"""Whether the rates that a motion or a bending body gives are those of its positions.

The wall moves with the ones and stands at the others: where they differ, forces and power are wrong without a trace.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np

from suchus.core import rotation
from suchus.core.errors import InvalidDesign
from suchus.flow.linked import LinkStates
from suchus.flow.midline import MidlineState
from suchus.flow.pose import Motion, Pose

SHARE = 0.1
"""Difference of the two, over the larger one, from which they disagree [-]."""

QUIET = 0.05
"""Speed, over the fastest so far, below which differences count relative to that [-]."""

MINOR = 0.05
"""Speed, over the fastest now, by which one kind of rate may be off beside the others [-]: half-widths follow what an
undulation does to arc lengths by some 2 %, and a heading's rate moves an eel's sides by 7 % and more."""

NOTHING = 1e-5
"""Distance by which the two may part in a step without further question [cells]."""

PATIENCE = 3
"""Times in a row that they must disagree: at a kink of the motion they do so once [-]."""

LEAP = 1.0
"""Distance by which a body may be off the place that its rates lead to [cells]. To it comes what a kink within a step,
where they change at once, may make: half of the distance at the greatest rate so far."""

_HALVINGS = 40  # of a first step, until nothing goes farther than a cell
_LOOK = 0.01  # share of a step over which positions are compared


class Watched(NamedTuple):
    """Coordinates of a body at some times, each of shape (time, coordinate)."""

    places: np.ndarray
    """Coordinates less those at the first time [m, rad]."""
    rates: np.ndarray
    """Their rates as they are given [m/s, rad/s]."""
    arms: np.ndarray
    """How far one unit of each moves the surface, shape (coordinate,) [m/m, m/rad]."""
    kinds: np.ndarray
    """What kind of coordinate each is, counted from 0, shape (coordinate,) [-]."""


class Told(Protocol):
    """What gives coordinates and their rates."""

    def at(self, times: Sequence[float]) -> Watched:
        """Return what is told of some times [s]."""

    def sentence(self, worst: int, given: np.ndarray, seen: np.ndarray) -> str:
        """Return what is wrong with a coordinate's rate, given and seen, and the remedy."""

    def place(self, worst: int) -> str:
        """Return what a coordinate is called."""


def _short(angle: np.ndarray) -> np.ndarray:
    """Return angles without whole turns, which move nothing [rad]."""
    turned: np.ndarray = (angle + np.pi) % (2 * np.pi) - np.pi
    return turned


class GivenMotion(NamedTuple):
    """The poses of a body."""

    name: str
    """Name of the body."""
    motion: Motion
    """Its motion."""
    reach: float
    """Distance of the body's surface from the origin of its frame [m]."""

    def at(self, times: Sequence[float]) -> Watched:
        """Return positions and angles, in space rotation vectors from the first pose, and their rates."""
        poses = [self.motion(time) for time in times]
        axes = len(poses[0].position)
        places = np.array([[*p.position, *_turn(poses[0], p)] for p in poses])
        rates = np.array([[*p.velocity, *([p.spin] if axes == 2 else p.spins)] for p in poses])
        turns = (np.arange(places.shape[1]) >= axes).astype(int)
        return Watched(places - places[0], rates, np.where(turns, self.reach, 1.0), turns)

    def sentence(self, worst: int, given: np.ndarray, seen: np.ndarray) -> str:
        """Return both rates and the remedy."""
        axes = 2 if given.size == 3 else 3
        turning = worst >= axes
        what, of = ("spin", "angle" if axes == 2 else "attitude") if turning else ("velocity", "position")

        def numbers(rate: np.ndarray) -> str:
            parts, unit = (rate[axes:], "rad/s") if turning else (rate[:axes], "m/s")
            text = ", ".join(f"{part:.4g}" for part in parts)
            return f"({text}) {unit}" if parts.size > 1 else f"{text} {unit}"

        return (
            f"the motion of {self.name} gives the {what} {numbers(given)}, and its {of} changes by {numbers(seen)}; "
            f"give a Pose whose {what} is the rate of its {of}."
        )

    def place(self, worst: int) -> str:  # noqa: ARG002 - a midline says which station it is
        """Return which body it is."""
        return self.name


class GivenMidline(NamedTuple):
    """The stations of a body that bends."""

    name: str
    """Name of the body."""
    spine: Callable[[float], MidlineState]
    """Its midline at every time [s]."""

    def at(self, times: Sequence[float]) -> Watched:
        """Return position, heading and half-width of the stations, one after the other, and their rates.

        Raises:
            InvalidDesign: the number of stations changes.
        """
        first, *others = (np.concatenate([state.rows, [state.swell]]) for state in map(self.spine, times))
        for time, other in zip(times[1:], others, strict=True):
            if other.shape != first.shape:
                raise InvalidDesign(
                    f"the midline of {self.name} has {first.shape[1]} stations at t = {times[0]:.4g} s and "
                    f"{other.shape[1]} at t = {time:.4g} s; give as many at every time."
                )
        every = np.array([first, *others])  # x, y, heading, half-width, and their rates
        places, rates = every[:, :4] - first[:4], every[:, 4:]
        places[:, 2] = _short(places[:, 2])
        arms = np.ones(places.shape[1:])
        arms[2] = first[3]
        kinds = np.repeat([0, 0, 1, 2], arms.shape[1])
        return Watched(places.reshape(len(times), -1), rates.reshape(len(times), -1), arms.ravel(), kinds)

    def sentence(self, worst: int, given: np.ndarray, seen: np.ndarray) -> str:
        """Return both rates of the worst station and the remedy."""
        row, station = divmod(worst, given.size // 4)
        what, unit = ("x", "y", "heading", "half_width")[row], "rad/s" if row == 2 else "m/s"
        return (
            f"the midline of {self.name} gives the {what}_rate {given[worst]:.4g} {unit} at station {station}, and its "
            f"{what} changes by {seen[worst]:.4g} {unit}; give a MidlineState whose {what}_rate is the rate of its "
            f"{what}."
        )

    def place(self, worst: int) -> str:
        """Return which station it is."""
        return f"station {worst % self.spine(0.0).x.size} of the midline of {self.name}"


class GivenLinks(NamedTuple):
    """The links of a body, each with a pose of its own."""

    name: str
    """Name of the body."""
    motion: Callable[[float], LinkStates]
    """The links at every time [s]."""
    reach: np.ndarray
    """Distance of each link's surface from its origin, shape (link,) [m]."""

    def at(self, times: Sequence[float]) -> Watched:
        """Return positions of the links and their rotation vectors from the first time, and their rates."""
        states = [self.motion(time) for time in times]
        first, count = states[0], len(self.reach)
        turns = [rotation.vectors(one.matrix @ np.swapaxes(first.matrix, 1, 2)) for one in states]
        places = np.array(
            [[*(s.position - first.position).ravel(), *t.ravel()] for s, t in zip(states, turns, strict=True)]
        )
        rates = np.array([[*s.velocity.ravel(), *s.spin.ravel()] for s in states])
        arms = np.concatenate([np.ones(3 * count), np.repeat(self.reach, 3)])
        return Watched(places, rates, arms, np.repeat([0, 1], 3 * count))

    def sentence(self, worst: int, given: np.ndarray, seen: np.ndarray) -> str:
        """Return both rates of the worst link and the remedy."""
        turning = worst >= 3 * len(self.reach)
        what, of, unit = ("spin", "matrix", "rad/s") if turning else ("velocity", "position", "m/s")
        return (
            f"the motion of {self.name} gives link {self._link(worst)} the {what} {given[worst]:.4g} {unit} along "
            f"{'xyz'[worst % 3]}, and its {of} changes by {seen[worst]:.4g} {unit}; give LinkStates whose {what} is "
            f"the rate of the {of}."
        )

    def place(self, worst: int) -> str:
        """Return which link it is."""
        return f"link {self._link(worst)} of {self.name}"

    def _link(self, worst: int) -> int:
        return worst % (3 * len(self.reach)) // 3


@dataclass(slots=True)
class Consistency:
    """A motion or a bending body under watch."""

    told: Told
    """What is watched."""
    cell: float
    """Side of a cell [m]."""
    every: int = 1
    """Steps from one close look at the rates to the next [-]; for leaps every step is looked at."""
    top: float = 0.0
    """Fastest speed so far, of either kind [m/s]."""
    strikes: int = 0
    """Times in a row that rates and positions disagreed [-]."""
    steps: int = 0
    """Steps looked at [-]."""
    slack: float = 0.0
    """Farthest that half of a step led so far [m]."""
    drift: np.ndarray = field(default_factory=lambda: np.zeros(1))
    """Way of each coordinate less what its rates add up to [m]."""
    path: np.ndarray = field(default_factory=lambda: np.zeros(1))
    """Way of each coordinate, to and fro [m]."""

    def longest(self, time: float, dt: float) -> float:
        """Return how much of a step [s] it takes until a place has gone a cell; all of it for a body that leaps.

        A body that begins at rest in water at rest says nothing yet of how fast it will be.
        """
        step = dt
        for _ in range(_HALVINGS):
            seen = self.told.at((time, *(time + part * step for part in (1 / 3, 1 / 2, 1))))
            if np.abs(seen.places * seen.arms).max() <= LEAP * self.cell:
                return step
            step /= 2
        return dt

    def start(self, time: float, dt: float) -> None:
        """Look at the first step, of about ``dt`` [s].

        Raises:
            InvalidDesign: rates and positions disagree, with both numbers.
        """
        for k in reversed(range(PATIENCE)):  # the message then tells of the start
            self._compare(time + k * dt / PATIENCE, dt)
        self.strikes = 0

    def look(self, time: float, dt: float) -> None:
        """Compare rates and positions at the start of a step, a time [s] and ``dt`` [s], and over all of it.

        Raises:
            InvalidDesign: they disagree for the third time in a row, with both numbers, or the body is not where its
                rates have led it.
        """
        if self.steps % self.every == 0:
            self._compare(time, dt)
        self.steps += 1
        seen = self.told.at((time, time + dt))
        way, ahead = seen.places[1] * seen.arms, 0.5 * dt * seen.rates * seen.arms
        self.slack = max(self.slack, float(np.abs(ahead).max()))
        off = way - ahead.sum(axis=0)
        self.drift, self.path = self.drift + off, self.path + np.abs(way)
        room = LEAP * self.cell + self.slack
        wrong = (np.abs(off) > room) | (np.abs(self.drift) > np.maximum(room, SHARE * self.path))
        if not wrong.any():
            return
        worst = int(np.where(wrong, np.abs(self.drift), 0.0).argmax())
        raise InvalidDesign(
            f"at t = {time + dt:.4g} s {self.told.place(worst)} is {abs(self.drift[worst]):.3g} m away from where its "
            f"rates have led it ({abs(off[worst]):.3g} m in the last step of {dt:.3g} s; a cell is {self.cell:.3g} m): "
            f"a body cannot leap. Give places without jumps and rates that are theirs, or, if they are right and only "
            f"fast, a smaller step."
        )

    def _compare(self, time: float, dt: float) -> None:
        span = _LOOK * dt
        found = self.told.at([time + k * span for k in range(3)])
        given, seen = found.rates[0], (4 * found.places[1] - found.places[2]) / (2 * span)
        size, moved, apart = (np.abs(rate * found.arms) for rate in (given, seen, given - seen))
        sizes = np.array([np.maximum(size, moved)[found.kinds == k].max() for k in range(found.kinds.max() + 1)])
        self.top = max(self.top, float(sizes.max()))
        least = max(MINOR * float(sizes.max()), SHARE * QUIET * self.top, NOTHING * self.cell / dt)
        excess = apart / np.maximum(SHARE * sizes, least)[found.kinds]
        if not (excess > 1).any():
            self.strikes = 0
            return
        self.strikes += 1
        if self.strikes >= PATIENCE:
            raise InvalidDesign(f"at t = {time:.4g} s {self.told.sentence(int(excess.argmax()), given, seen)}")


def _turn(now: Pose, then: Pose) -> np.ndarray:
    """Return by how much a pose is turned, in space the rotation vector from another one to it [rad]."""
    if len(now.position) == 2:
        return _short(np.array([then.angle - now.angle]))
    if now.pitch == then.pitch == 0 and now.roll == then.roll == 0:
        return _short(np.array([0.0, 0.0, then.angle - now.angle]))
    one, other = (rotation.from_angles(p.angle, p.pitch, p.roll) for p in (now, then))
    return rotation.to_vector(rotation.multiply(other, one * [1, -1, -1, -1]), np.zeros(3))

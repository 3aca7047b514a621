"""The axis: which hinges bend it, and what the bends of gaits ask of each of them."""

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Complex, Float

from suchus.robot.design import Robot, layout
from suchus.robot.motion.gait import Gait
from suchus.robot.motion.parts import Bend, Part


class Hinges(NamedTuple):
    """The hinges of the axis that turn one way, from head to tail; a cable has one for each of its joints."""

    names: tuple[str, ...]
    """Name of each of them."""
    servos: tuple[int, ...]
    """Servo that moves each of them."""
    signs: tuple[float, ...]
    """1 where a positive angle of the servo is a positive bend, else -1 [-]."""
    parts: tuple[Part, ...]
    """Part of the axis that each belongs to."""
    places: tuple[float, ...]
    """Of each along the body, 0 at the snout and 1 at the tip of the tail [-]."""

    def within(self, part: Part) -> list[int]:
        """Return which of them a part has."""
        return [i for i, mine in enumerate(self.parts) if part in ("axis", mine)]


@lru_cache(maxsize=256)
def yaw_hinges(robot: Robot) -> Hinges:
    """Return the driven hinges that bend a robot sideways; positive is concave to the left."""
    place = layout(robot)
    rows: list[tuple[float, str, int, float, Part]] = []
    for servo, left, along in zip(place.axial_yaw, place.axial_left, place.axial_place, strict=True):
        part: Part = "trunk" if servo in place.trunk_yaw else "tail" if servo in place.tail_yaw else "neck"
        rows.append((along, place.servos[servo], servo, left, part))
    for servo in place.cables:
        hinges = place.cable(servo).hinges
        behind = place.hinges.index(hinges[0]) >= place.behind.start
        for along, name in zip(place.cable_places(servo), hinges, strict=True):
            rows.append((along, name, servo, -1.0, "tail" if behind else "trunk"))
    rows.sort(key=lambda row: row[0])
    places, names, servos, signs, parts = tuple(zip(*rows, strict=True)) or ((), (), (), (), ())
    return Hinges(names, servos, signs, parts, places)


@lru_cache(maxsize=256)
def pitch_hinges(robot: Robot) -> Hinges:
    """Return the driven hinges that bend a robot up and down; positive is concave below."""
    place = layout(robot)

    def part(servo: int) -> Part:
        return "trunk" if servo in place.trunk_pitch else "tail" if servo in place.tail_pitch else "neck"

    servos = place.axial_pitch
    names = tuple(place.servos[servo] for servo in servos)
    return Hinges(names, servos, (1.0,) * len(servos), tuple(part(servo) for servo in servos), (0.0,) * len(servos))


class Waves:
    """What gaits ask of one row of hinges: of a part's bend b, ``offset + Re(swing z)``, each hinge turns an nth."""

    def __init__(self, hinges: Hinges, turn: str, gaits: Sequence[Gait]) -> None:
        self.hinges = hinges
        shape = (len(gaits), len(hinges.servos))
        self.swing, self.offset, self.share = np.zeros(shape, dtype=complex), np.zeros(shape), np.ones(shape)
        for run, gait in enumerate(gaits):
            bends = [bend for bend in gait.axis if bend.turn == turn and hinges.within(bend.part)]
            for k in range(len(hinges.servos)):
                mine = [bend for bend in bends if k in hinges.within(bend.part)]
                counts = {len(hinges.within(bend.part)) for bend in mine}
                whole = counts.pop() if len(counts) == 1 else 1
                self.share[run, k] = whole
                for bend in mine:
                    among = hinges.within(bend.part)
                    scale = whole / len(among)
                    self.swing[run, k] += scale * _swing(bend, among.index(k), len(among))
                    self.offset[run, k] += scale * bend.offset
        self._real = not self.swing.imag.any()
        self._steady = bool(self.offset.any())
        self.moves = bool(self.swing.any()) or self._steady
        self._alike: dict[tuple[int, ...], np.ndarray] = {}

    def bends(
        self, z: Complex[np.ndarray, "*batch"], size: np.ndarray | float | None = None
    ) -> Float[np.ndarray, "*batch hinge"]:
        """Return the bend of the whole part, as each hinge takes its share of it [rad]."""
        z = np.asarray(z)[..., None]
        swung = self.swing.real * z.real if self._real else self.swing.real * z.real - self.swing.imag * z.imag
        if size is not None:
            swung = np.asarray(size)[..., None] * swung
        return np.asarray(swung + self.offset if self._steady else swung)

    def whole(self, among: Sequence[int], bends: Float[np.ndarray, "*batch hinge"]) -> Float[np.ndarray, "*batch"]:
        """Return the bend of some hinges together [rad]."""
        if not len(among):
            return np.zeros(bends.shape[:-1])
        alike, first = self._takes_the_same(tuple(among)), bends[..., among[0]]
        if alike.all():  # n nths of a number are not the number
            return np.asarray(first)
        parts = (bends[..., among] / self.share[:, among]).sum(axis=-1)
        return np.asarray(np.where(alike, first, parts))

    def _takes_the_same(self, among: tuple[int, ...]) -> Bool[np.ndarray, " run"]:
        """Return of each run whether some hinges share the bend of one part evenly, and it is all of them."""
        if among not in self._alike:
            rows, first = list(among), [among[0]]
            same = (self.swing[:, rows] == self.swing[:, first]) & (self.offset[:, rows] == self.offset[:, first])
            self._alike[among] = (same & (self.share[:, rows] == len(among))).all(axis=1)
        return self._alike[among]

    def together(self, among: Sequence[int]) -> tuple[Complex[np.ndarray, " run"], Float[np.ndarray, " run"]]:
        """Return swing and steady bend of some hinges together [rad]."""
        share = self.share[:, among]
        return (self.swing[:, among] / share).sum(axis=1), (self.offset[:, among] / share).sum(axis=1)

    def amplitude(self) -> Float[np.ndarray, "run hinge"]:
        """Return the most that each hinge turns to either side, its steady angle aside [rad]."""
        return np.abs(self.swing) / self.share


def _swing(bend: Bend, place: int, count: int) -> complex:
    """Return the complex amplitude of a part's bend as its hinge number ``place`` sees it [rad]."""
    amplitude, lag = (at_knot(row, place, count) for row in (bend.amplitude, bend.lag))
    half = round(2.0 * lag)  # half cycles change the sign alone, and exactly
    rest = 2 * np.pi * (lag - half / 2.0)
    signed = amplitude if half % 2 else -amplitude
    return complex(signed) if rest == 0.0 else complex(signed * np.cos(rest), -signed * np.sin(rest))


def at_knot(row: tuple[float, ...], place: int, count: int) -> float:
    """Return the value of knots, evenly spread over ``count`` hinges, at one of them."""
    if len(row) in (1, count):
        return row[place] if len(row) == count else row[0]
    along = place / (count - 1) if count > 1 else 0.5
    return float(np.interp(along, np.linspace(0.0, 1.0, len(row)), row))

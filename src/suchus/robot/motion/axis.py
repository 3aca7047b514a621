"""The axis: its hinges, and the angle of each in the bends of a gait."""

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Complex, Float

from suchus.robot.design import Robot, layout
from suchus.robot.motion.gait import Gait
from suchus.robot.motion.parts import AxisRegion, Bend


class Hinges(NamedTuple):
    """The hinges of the axis with one turn, from head to tail; a cable has one for each of its joints."""

    names: tuple[str, ...]
    """Name of each of them."""
    servos: tuple[int, ...]
    """Servo that moves each of them."""
    signs: tuple[float, ...]
    """1 where a positive angle of the servo is a positive bend, else -1 [-]."""
    parts: tuple[AxisRegion, ...]
    """Part of the axis that each belongs to."""
    axial_positions: tuple[float, ...]
    """Position of each along the body, 0 at the snout and 1 at the tip of the tail [-]."""

    def indices_in(self, region: AxisRegion) -> list[int]:
        """Return which of them a part has."""
        return [i for i, hinge_region in enumerate(self.parts) if region in ("axis", hinge_region)]


@lru_cache(maxsize=256)
def yaw_hinges(robot: Robot) -> Hinges:
    """Return the driven hinges that bend a robot sideways; positive is concave to the left."""
    place = layout(robot)
    rows: list[tuple[float, str, int, float, AxisRegion]] = []
    for servo, sign, position in zip(place.axial_yaw, place.axial_left, place.axial_positions, strict=True):
        region: AxisRegion = "trunk" if servo in place.trunk_yaw else "tail" if servo in place.tail_yaw else "neck"
        rows.append((position, place.servos[servo], servo, sign, region))
    for servo in place.cables:
        hinges = place.cable(servo).hinges
        is_tail = place.hinges.index(hinges[0]) >= place.backward_hinges.start
        for position, name in zip(place.cable_positions(servo), hinges, strict=True):
            rows.append((position, name, servo, -1.0, "tail" if is_tail else "trunk"))
    rows.sort(key=lambda row: row[0])
    places, names, servos, signs, parts = tuple(zip(*rows, strict=True)) or ((), (), (), (), ())
    return Hinges(names, servos, signs, parts, places)


@lru_cache(maxsize=256)
def pitch_hinges(robot: Robot) -> Hinges:
    """Return the driven hinges that bend a robot up and down; positive is concave below."""
    place = layout(robot)

    def region_of(servo: int) -> AxisRegion:
        return "trunk" if servo in place.trunk_pitch else "tail" if servo in place.tail_pitch else "neck"

    servos = place.axial_pitch
    names = tuple(place.servos[servo] for servo in servos)
    return Hinges(
        names, servos, (1.0,) * len(servos), tuple(region_of(servo) for servo in servos), (0.0,) * len(servos)
    )


class Waves:
    """Bends that gaits demand of a row of hinges: ``offset + Re(swing z)`` of a region, an nth at each of n hinges."""

    def __init__(self, hinges: Hinges, turn: str, gaits: Sequence[Gait]) -> None:
        """Add up what the bends of each gait ask of each hinge.

        Args:
            hinges: one row of hinges of the axis.
            turn: turning axis of these hinges, ``yaw`` or ``pitch``.
            gaits: gait of each run.
        """
        self.hinges = hinges
        shape = (len(gaits), len(hinges.servos))
        self.swing, self.offset, self.hinge_counts = np.zeros(shape, dtype=complex), np.zeros(shape), np.ones(shape)
        for run, gait in enumerate(gaits):
            bends = [bend for bend in gait.axis if bend.turn == turn and hinges.indices_in(bend.part)]
            for k in range(len(hinges.servos)):
                hinge_bends = [bend for bend in bends if k in hinges.indices_in(bend.part)]
                counts = {len(hinges.indices_in(bend.part)) for bend in hinge_bends}
                hinge_count = counts.pop() if len(counts) == 1 else 1
                self.hinge_counts[run, k] = hinge_count
                for bend in hinge_bends:
                    indices = hinges.indices_in(bend.part)
                    scale = hinge_count / len(indices)
                    self.swing[run, k] += scale * _swing(bend, indices.index(k), len(indices))
                    self.offset[run, k] += scale * bend.offset
        self._real = not self.swing.imag.any()
        self._real_swing, self._imaginary_swing = self.swing.real.copy(), self.swing.imag.copy()
        self._steady = bool(self.offset.any())
        self.moves = bool(self.swing.any()) or self._steady
        self._is_evenly_shared: dict[tuple[int, ...], tuple[np.ndarray, bool]] = {}

    def bends(
        self, z: Complex[np.ndarray, "*batch"], size: np.ndarray | float | None = None
    ) -> Float[np.ndarray, "*batch hinge"]:
        """Return, at each hinge, the bend of its whole region [rad]; the hinge turns by its share of it.

        Args:
            z: order parameter that the axis follows [-].
            size: factor on the swing [-]; None for 1.
        """
        z = np.asarray(z)[..., None]
        swing_bend = self._real_swing * z.real
        if not self._real:
            swing_bend = swing_bend - self._imaginary_swing * z.imag
        if size is not None:
            swing_bend = np.asarray(size)[..., None] * swing_bend
        return np.asarray(swing_bend + self.offset if self._steady else swing_bend)

    def total_bend(
        self, indices: Sequence[int], bends: Float[np.ndarray, "*batch hinge"]
    ) -> Float[np.ndarray, "*batch"]:
        """Return the bend of some hinges together [rad].

        Args:
            indices: indices of the hinges.
            bends: bends as ``bends`` returns them [rad].
        """
        if not len(indices):
            return np.zeros(bends.shape[:-1])
        (is_shared_evenly, are_all), first_bend = self._takes_the_same(tuple(indices)), bends[..., indices[0]]
        if are_all:  # the sum of n nths differs by rounding
            return np.asarray(first_bend)
        parts = (bends[..., indices] / self.hinge_counts[:, indices]).sum(axis=-1)
        return np.asarray(np.where(is_shared_evenly, first_bend, parts))

    def _takes_the_same(self, indices: tuple[int, ...]) -> tuple[Bool[np.ndarray, " run"], bool]:
        """Return for each run whether some hinges are exactly those that share one bend evenly, and whether in all."""
        if indices not in self._is_evenly_shared:
            rows, first_row = list(indices), [indices[0]]
            is_equal = (self.swing[:, rows] == self.swing[:, first_row]) & (
                self.offset[:, rows] == self.offset[:, first_row]
            )
            is_shared = (is_equal & (self.hinge_counts[:, rows] == len(indices))).all(axis=1)
            self._is_evenly_shared[indices] = is_shared, bool(is_shared.all())
        return self._is_evenly_shared[indices]

    def swing_and_offset(self, indices: Sequence[int]) -> tuple[Complex[np.ndarray, " run"], Float[np.ndarray, " run"]]:
        """Return swing and steady bend of some hinges together [rad]."""
        hinge_counts = self.hinge_counts[:, indices]
        return (self.swing[:, indices] / hinge_counts).sum(axis=1), (self.offset[:, indices] / hinge_counts).sum(axis=1)

    def amplitude(self) -> Float[np.ndarray, "run hinge"]:
        """Return the most that each hinge turns to either side, its steady angle aside [rad]."""
        return np.abs(self.swing) / self.hinge_counts


def _swing(bend: Bend, place: int, count: int) -> complex:
    """Return the complex amplitude of a region's bend at one of its hinges [rad].

    Args:
        bend: bend angle of the region.
        place: index of the hinge in the region, from the head [-].
        count: number of hinges of the region [-].
    """
    amplitude, lag = (at_knot(row, place, count) for row in (bend.amplitude, bend.lag))
    half = round(2.0 * lag)  # half cycles change the sign only, without rounding
    remainder = 2 * np.pi * (lag - half / 2.0)
    signed = amplitude if half % 2 else -amplitude
    return complex(signed) if remainder == 0.0 else complex(signed * np.cos(remainder), -signed * np.sin(remainder))


def at_knot(row: tuple[float, ...], place: int, count: int) -> float:
    """Return the value at one hinge of knots that are evenly spread over ``count`` hinges.

    Args:
        row: values of the knots, from the head.
        place: index of the hinge [-].
        count: number of hinges [-].
    """
    if len(row) in (1, count):
        return row[place] if len(row) == count else row[0]
    position = place / (count - 1) if count > 1 else 0.5
    return float(np.interp(position, np.linspace(0.0, 1.0, len(row)), row))

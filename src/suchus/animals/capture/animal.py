"""A synthetic animal with known angles, which tests the extraction on a body that is not our robot."""

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from suchus.animals.capture.film import Camera, tracked
from suchus.animals.capture.tracks import Tracks
from suchus.core.checks import Checks
from suchus.robot.design import LEGS

Swing = Literal["cosine", "jerk_free", "ramp", "hasty"]
"""How far a foot has gone over the time of its swing: half a cosine, with the least jerk, at a constant speed that is
reached in a quarter of the time, or fast at first."""
_JOINTS = 3  # bends of the trunk, evenly along it
_TAIL = 6  # segments of the tail


@dataclass(frozen=True, slots=True, kw_only=True)
class SyntheticAnimal:
    """A lizard-like body that walks straight on with feet that never slip."""

    trunk: float
    """Length from hip to shoulder [m]."""
    tail: float
    """Length of the tail [m]."""
    period: float
    """Period of one cycle [s]."""
    duty_factor: float
    """Share of the cycle in which a foot stands [-]."""
    limb_phases: tuple[float, float, float, float]
    """Phase of LF, RF, LH, RH at time zero; a limb swings first, then stands [cycle]."""
    stride: float
    """Distance that the body moves in one cycle [m]."""
    outward: float
    """Distance by which feet stand from the midline [m]."""
    lift: float
    """Height to which feet are lifted [m]."""
    spine_bend: float
    """Amplitude of the trunk's lateral angle, right positive [rad]."""
    spine_rightmost: float
    """Phase at which the trunk is bent farthest to the right [cycle]."""
    tail_bend: float
    """Amplitude of the tail's lateral angle at its tip, right positive [rad]."""
    tail_lag: float
    """Phase lag of the tail's root behind the trunk [cycle]."""
    tail_wave: float
    """Phase lag of the tip behind the root [cycle]; 0: a standing wave."""
    swing: Swing = "cosine"
    """Course of a foot in swing."""

    def __post_init__(self) -> None:
        """Refuse lengths, times and angles that no animal has."""
        with Checks("animal", self) as check:
            for field in ("trunk", "tail", "stride", "outward"):
                check.number(field, 0.001, 10.0, "m")
            check.number("lift", 0.0, 1.0, "m")
            check.number("period", 0.01, 60.0, "s")
            check.number("duty_factor", 0.05, 0.95, "")
            for field in ("spine_bend", "tail_bend"):
                check.number(field, 0.0, 3.0, "rad")
            for field in ("spine_rightmost", "tail_lag", "tail_wave"):
                check.number(field, -2.0, 2.0, "cycle")
            check.that(
                self.swing in get_args(Swing),
                f"animal.swing is {self.swing!r}; {', '.join(get_args(Swing))} are allowed",
            )


def film_animal(animal: SyntheticAnimal, camera: Camera, *, cycles: float, pace: ArrayLike = (1.0,)) -> Tracks:
    """Return the tracks of an animal.

    Args:
        animal: animal that walks.
        camera: how it is seen.
        cycles: number of cycles that are filmed [-].
        pace: how long one cycle after another lasts, in periods of the animal; the last one's pace goes on.
    """
    lasts = np.asarray(pace, dtype=float)
    lasts = animal.period * np.pad(lasts, (0, int(cycles) + 2), mode="edge")[: int(cycles) + 2]
    ends = np.concatenate([[0.0], np.cumsum(lasts)])
    time = np.arange(0.0, np.interp(cycles, np.arange(len(ends)), ends) + 1e-9, 1.0 / camera.rate)
    clock = animal.period * np.interp(time, ends, np.arange(len(ends)))
    points = _midline(animal, clock) | {leg: _foot(animal, leg, clock) for leg in LEGS}
    return tracked(points, time, camera, source="the film of an animal")


def _midline(animal: SyntheticAnimal, time: np.ndarray) -> dict[str, np.ndarray]:
    """Return the positions of the points from neck to tail tip, each of shape (frame, 3) [m].

    Every joint of the trunk bends by the same angle, and so does every joint of the tail.
    """
    phase = time / animal.period
    spine = animal.spine_bend * np.cos(2 * np.pi * (phase - animal.spine_rightmost))
    pelvis = spine / 2  # the girdles counter-rotate, so that the trunk looks straight on
    link, height = animal.trunk / (_JOINTS + 1), np.full_like(time, animal.lift)
    hip = np.stack([animal.stride * phase, np.zeros_like(time), height], axis=1)
    points, position = {"hip": hip}, hip
    for i in range(1, _JOINTS + 2):
        position = position + link * _direction(pelvis - spine * (i - 1) / _JOINTS)
        points["shoulder" if i > _JOINTS else f"spine_{i}"] = position
    points["neck"] = position + link * _direction(pelvis - spine)
    points["tail_base"] = position = hip - link * _direction(pelvis)
    for i in range(1, _TAIL + 1):
        bend = np.zeros_like(time)
        for j in range(i):
            lag = animal.spine_rightmost + animal.tail_lag + animal.tail_wave * j / (_TAIL - 1)
            bend += animal.tail_bend / _TAIL * np.cos(2 * np.pi * (phase - lag))
        position = position - animal.tail / _TAIL * _direction(pelvis + bend)
        points["tail_tip" if i == _TAIL else f"tail_{i}"] = position
    return points


def _foot(animal: SyntheticAnimal, leg: str, time: np.ndarray) -> np.ndarray:
    """Return the position of a foot, shape (frame, 3) [m]: it rests in stance and moves by one stride in swing."""
    phase = time / animal.period + animal.limb_phases[LEGS.index(leg)]
    number, cycle_phase = np.floor(phase), np.mod(phase, 1.0)
    swing = np.clip(cycle_phase / (1.0 - animal.duty_factor), 0.0, 1.0)
    # in the middle of its stance a foot is beside its girdle
    mid_stance = number - animal.duty_factor / 2 - animal.limb_phases[LEGS.index(leg)]
    girdle = animal.trunk if leg.endswith("F") else 0.0
    x = girdle + animal.stride * (mid_stance + _swing_progress(animal.swing, swing))
    y = np.full_like(time, animal.outward if leg.startswith("L") else -animal.outward)
    return np.stack([x, y, animal.lift * np.sin(np.pi * swing) ** 2], axis=1)


def _swing_progress(swing: Swing, fraction: np.ndarray) -> np.ndarray:
    """Return the fraction of its path that a foot has covered, 0 to 1 [-].

    Args:
        swing: speed profile of the swing.
        fraction: time since lift-off over the duration of the swing, 0 to 1 [-].
    """
    if swing == "cosine":
        return np.asarray((1 - np.cos(np.pi * fraction)) / 2)
    if swing == "jerk_free":
        return np.asarray(fraction**3 * (10 - 15 * fraction + 6 * fraction**2))
    if swing == "hasty":
        return np.asarray(fraction**2 * (6 - 8 * fraction + 3 * fraction**2))
    edge, top = 0.25, 1 / 0.75
    start, end = np.minimum(fraction, edge), np.maximum(fraction - (1 - edge), 0.0)
    return np.asarray(top * (start**2 / (2 * edge) + np.maximum(fraction - edge, 0.0) - end**2 / (2 * edge)))


def _direction(azimuth: np.ndarray) -> np.ndarray:
    return np.stack([np.cos(azimuth), np.sin(azimuth), np.zeros_like(azimuth)], axis=1)

"""Synthetic animals of known truth, drawn by a number: how they walk, how they are filmed, and what goes wrong."""

from dataclasses import replace
from typing import NamedTuple, get_args

import numpy as np

from suchus.capture import Animal, Camera, Tracks, UnusableTracks, film_animal, observe
from suchus.capture.animal import Swing
from suchus.design import LEGS


class Filmed(NamedTuple):
    animal: Animal
    pace: np.ndarray
    tracks: Tracks


def drawn(seed: int) -> Filmed:
    """An animal of random build and gait, 4 to 12 cycles, 16 to 90 frames a cycle, a pace that varies by up to 10 %,
    noise of 0.2 to 3 % of the trunk, 5 % of the points lost and 1 % of them two trunk lengths off."""
    random = np.random.default_rng(seed)
    trunk, period, lag = random.uniform(0.05, 0.4), random.uniform(0.5, 2.0), random.uniform(0.2, 0.3)
    animal = Animal(
        trunk=trunk,
        tail=1.7 * trunk,
        period=period,
        duty_factor=random.uniform(0.55, 0.8),
        limb_phases=(0.0, 0.5, lag, lag + 0.5),
        stride=1.2 * trunk,
        outward=0.5 * trunk,
        lift=0.15 * trunk,
        spine_bend=random.uniform(0.2, 0.6),
        spine_rightmost=random.uniform(0.0, 1.0),
        tail_bend=random.uniform(0.3, 0.9),
        tail_lag=random.uniform(0.0, 0.5),
        tail_wave=0.0,
        swing=get_args(Swing)[seed % 4],
    )
    cycles = int(random.integers(4, 13))
    pace = 1.0 + random.uniform(0.0, 0.1) * np.clip(random.standard_normal(cycles), -2.0, 2.0)
    camera = Camera(
        rate=random.uniform(16.0, 90.0) / period,
        noise=random.uniform(0.002, 0.03) * trunk,
        lost=0.05,
        heading=random.uniform(-3.0, 3.0),
        scale=None,
        heights=False,
        seed=seed,
    )
    tracks = film_animal(animal, camera, cycles=cycles, pace=pace)
    return Filmed(animal, pace, jumping(tracks, 0.01, 2.0 * trunk, random))


def jumping(tracks: Tracks, share: float, far: float, random: np.random.Generator) -> Tracks:
    """Put a share of the points off by a distance, each in a direction of its own."""
    position = tracks.position.copy()
    off = random.uniform(size=position.shape[:2]) < share
    turn = random.uniform(0.0, 2 * np.pi, off.sum())
    position[off, :2] += far * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    return replace(tracks, position=position)


def hidden(tracks: Tracks, leg: str, period: float, start: float, share: float) -> Tracks:
    """Hide a foot in the same share of every cycle, from a phase on."""
    position = tracks.position.copy()
    position[np.mod(tracks.time / period - start, 1.0) < share, tracks.points.index(leg)] = np.nan
    return replace(tracks, position=position)


def truth(filmed: Filmed) -> dict[str, float]:
    """What ``observe`` should find."""
    animal = filmed.animal
    return {
        **{f"duty_{leg}": animal.duty_factor for leg in LEGS},
        **{f"phase_{leg}": phase for leg, phase in zip(LEGS[1:], animal.limb_phases[1:], strict=True)},
        "period": animal.period * float(filmed.pace.mean()),
        "stride": animal.stride / animal.trunk,
        "spine_lateral": animal.spine_bend,
        "tail_lateral": animal.tail_bend,
        "tail_lag": animal.tail_lag,
        "spine_rightmost": animal.spine_rightmost,
    }


def held(seed: int) -> dict[str, bool] | None:
    """Whether each interval holds the truth; None if the animal is refused."""
    filmed = drawn(seed)
    try:
        numbers = observe(filmed.tracks).numbers
    except UnusableTracks:
        return None
    return {name: apart(numbers[name], value) <= numbers[name].error for name, value in truth(filmed).items()}


def apart(seen, value: float) -> float:
    """How far a number that was seen is from a value, around the cycle if it is a phase."""
    error = seen.value - value
    return abs((error + 0.5) % 1.0 - 0.5 if seen.unit == "cycle" else error)

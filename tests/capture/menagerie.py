"""Synthetic animals of known truth, drawn by a number: how they walk, how they are filmed, and what goes wrong."""

from dataclasses import replace
from typing import NamedTuple, get_args

import numpy as np

from suchus.animals.capture import Camera, SyntheticAnimal, Tracks, UnusableTracks, film_animal, observe
from suchus.animals.capture.animal import Swing
from suchus.robot.design import LEGS

AILMENTS = (
    "a foot hidden in the same 20 to 30 % of every cycle",
    "15 frames a second",
    "2 % of the points 0.3 m off",
    "an exactly straight tail",
    "8 mm of noise, 9 s",
    "8 mm of noise, 90 s",
)
"""What goes wrong in the films of ``ailing``, each in every sixth."""


class Filmed(NamedTuple):
    animal: SyntheticAnimal
    pace: np.ndarray
    tracks: Tracks


def drawn(seed: int) -> Filmed:
    """An animal of random build and gait, 4 to 12 cycles, 16 to 90 frames a cycle, a pace that varies by up to 10 %,
    noise of 0.2 to 3 % of the trunk, 5 % of the points lost and 1 % of them two trunk lengths off."""
    random = np.random.default_rng(seed)
    animal = built(random, seed, trunk=(0.05, 0.4), period=(0.5, 2.0))
    trunk, period = animal.trunk, animal.period
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


def ailing(seed: int) -> Filmed:
    """An animal whose pace varies by 7 to 10 %, filmed for 9 s, and of ``AILMENTS`` that of its number."""
    random, ailment = np.random.default_rng(seed), AILMENTS[seed % len(AILMENTS)]
    animal = built(random, seed, trunk=(0.1, 0.2), period=(0.9, 1.3))
    if ailment == "an exactly straight tail":
        animal = replace(animal, tail_bend=0.0)
    noisy = ailment.startswith("8 mm")
    cycles = round((90.0 if ailment.endswith("90 s") else 9.0) / animal.period)
    pace = 1.0 + random.uniform(0.07, 0.1) * np.clip(random.standard_normal(cycles), -2.0, 2.0)
    camera = Camera(
        rate=15.0 if ailment.startswith("15") else 20.0 if noisy else random.uniform(30.0, 60.0),
        noise=0.008 if noisy else random.uniform(0.002, 0.01) * animal.trunk,
        lost=0.0 if noisy else 0.02,
        heading=random.uniform(-3.0, 3.0),
        scale=None,
        heights=False,
        seed=seed,
    )
    tracks = film_animal(animal, camera, cycles=cycles, pace=pace)
    if ailment.startswith("2 %"):
        tracks = jumping(tracks, 0.02, 0.3, random)
    if ailment.startswith("a foot"):
        ends = animal.period * np.concatenate([[0.0], np.cumsum(pace)])
        cycle = np.interp(tracks.time, ends, np.arange(len(ends)))
        leg = LEGS[int(random.integers(4))]
        start = random.uniform() - animal.limb_phases[LEGS.index(leg)]
        tracks = hidden(tracks, leg, cycle, start, random.uniform(0.2, 0.3))
    return Filmed(animal, pace, tracks)


def built(
    random: np.random.Generator, seed: int, *, trunk: tuple[float, float], period: tuple[float, float]
) -> SyntheticAnimal:
    """An animal of random gait, its trunk [m] and its period [s] between two numbers each."""
    long, lasts, lag = random.uniform(*trunk), random.uniform(*period), random.uniform(0.2, 0.3)
    return SyntheticAnimal(
        trunk=long,
        tail=1.7 * long,
        period=lasts,
        duty_factor=random.uniform(0.55, 0.8),
        limb_phases=(0.0, 0.5, lag, lag + 0.5),
        stride=1.2 * long,
        outward=0.5 * long,
        lift=0.15 * long,
        spine_bend=random.uniform(0.2, 0.6),
        spine_rightmost=random.uniform(0.0, 1.0),
        tail_bend=random.uniform(0.3, 0.9),
        tail_lag=random.uniform(0.0, 0.5),
        tail_wave=0.0,
        swing=get_args(Swing)[seed % 4],
    )


def jumping(tracks: Tracks, share: float, far: float, random: np.random.Generator) -> Tracks:
    """Put a share of the points off by a distance, each in a direction of its own."""
    position = tracks.position.copy()
    off = random.uniform(size=position.shape[:2]) < share
    turn = random.uniform(0.0, 2 * np.pi, off.sum())
    position[off, :2] += far * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    return replace(tracks, position=position)


def hidden(tracks: Tracks, leg: str, cycle: np.ndarray, start: float, share: float) -> Tracks:
    """Hide a foot in the same share of every cycle, from a phase on; ``cycle`` counts the cycles of each frame."""
    position = tracks.position.copy()
    position[np.mod(cycle - start, 1.0) < share, tracks.points.index(leg)] = np.nan
    return replace(tracks, position=position)


def truth(filmed: Filmed) -> dict[str, float]:
    """What ``observe`` should find; of a straight tail that it bends by nothing."""
    animal = filmed.animal
    bends = {"tail_lag": animal.tail_lag, "tail_lateral": animal.tail_bend} if animal.tail_bend else {}
    return {
        **{f"duty_{leg}": animal.duty_factor for leg in LEGS},
        **{f"phase_{leg}": phase for leg, phase in zip(LEGS[1:], animal.limb_phases[1:], strict=True)},
        "period": animal.period * float(filmed.pace.mean()),
        "stride": animal.stride / animal.trunk,
        "stride_length": animal.stride,
        "speed": animal.stride / (animal.period * float(filmed.pace.mean())),
        "turning": 0.0,
        **{f"step_length_{leg}": animal.stride for leg in LEGS},
        "spine_lateral": animal.spine_bend,
        "spine_rightmost": animal.spine_rightmost,
        **bends,
    }


def read(filmed: Filmed) -> dict[str, tuple[float, float]] | None:
    """How far each number is from the truth, and its interval's half width; None if the animal is refused."""
    try:
        numbers = observe(filmed.tracks).numbers
    except UnusableTracks:
        return None
    true = truth(filmed).items()
    return {name: (apart(numbers[name], value), numbers[name].error) for name, value in true if name in numbers}


def held(seed: int) -> dict[str, bool] | None:
    """Whether each interval holds the truth; None if the animal is refused."""
    found = read(drawn(seed))
    return None if found is None else {name: off <= error for name, (off, error) in found.items()}


def counted(animals: dict[int, dict[str, tuple[float, float]] | None]) -> dict[str, dict[str, float]]:
    """What became of animals of ``ailing``, by number.

    Of each quantity, with the four feet as one: how many intervals there are and hold the truth, the error's root mean
    square and the median of the half width. The same of the duty factor for each ailment.
    """
    found = {}
    groups = {"": list(animals.values())}
    groups |= {one: [animals[seed] for seed in animals if AILMENTS[seed % len(AILMENTS)] == one] for one in AILMENTS}
    for ailment, group in groups.items():
        every: dict[str, list[tuple[float, float]]] = {}
        for animal in group:
            for name, seen in (animal or {}).items():
                every.setdefault(name.partition("_")[0] if name[-2:] in LEGS else name, []).append(seen)
        told = {"animals": {"asked": len(group), "read": sum(one is not None for one in group)}}
        for name in every.keys() & {"duty"} if ailment else every:
            off, error = np.array(every[name]).T
            told[name] = {
                "intervals": len(off),
                "hold": int((off <= error).sum()),
                "error": float(np.sqrt((off**2).mean())),
                "width": float(np.median(error)),
            }
        found |= {f"{ailment}: {name}" if ailment else name: value for name, value in told.items()}
    return found


def apart(seen, value: float) -> float:
    """How far a number that was seen is from a value, around the cycle if it is a phase."""
    error = seen.value - value
    return abs((error + 0.5) % 1.0 - 0.5 if seen.unit == "cycle" else error)

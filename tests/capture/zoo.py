"""Films of animals of real proportions, which walk, turn, climb, start and stop; names of keypoints can be exchanged.

Nothing here is shared with ``SyntheticAnimal``: the path may be curved, the clock may stand still, and feet are placed
beside the girdles of a body that follows its path.

``python tests/capture/zoo.py [COUNT]`` prints what the screening says of them.
"""

import sys
from collections import Counter
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from suchus.animals.capture import Tracks, UnusableTracks
from suchus.animals.capture.screen import screen_tracks
from suchus.robot.design import LEGS


class Species(NamedTuple):
    """Ranges of proportions; lengths over the trunk's, angles in rad."""

    head: tuple[float, float]  # from the shoulder to the snout
    tail: tuple[float, float]
    outward: tuple[float, float]  # of the feet from the midline
    stride: tuple[float, float]
    duty: tuple[float, float]
    spine: tuple[float, float]  # amplitude of the bend between the girdles
    tail_bend: tuple[float, float]
    period: tuple[float, float]  # [s]


SPECIES = {  # proportions of adults and of their walks and trots, rounded from drawings and films
    "gecko": Species(
        (0.40, 0.60), (0.8, 1.2), (0.40, 0.65), (0.8, 1.4), (0.50, 0.70), (0.2, 0.6), (0.2, 0.9), (0.15, 0.5)
    ),
    "lizard": Species(
        (0.35, 0.50), (1.4, 2.6), (0.35, 0.60), (0.8, 1.6), (0.50, 0.80), (0.2, 0.9), (0.2, 1.0), (0.2, 1.0)
    ),
    "salamander": Species(
        (0.25, 0.40), (0.8, 1.3), (0.25, 0.40), (0.5, 0.9), (0.65, 0.85), (0.4, 1.0), (0.4, 1.2), (0.8, 2.5)
    ),
    "mouse": Species(
        (0.50, 0.80), (1.0, 1.6), (0.14, 0.25), (0.7, 1.2), (0.50, 0.75), (0.05, 0.3), (0.1, 0.8), (0.2, 0.6)
    ),
    "crocodile": Species(
        (0.50, 0.75), (1.1, 1.6), (0.25, 0.40), (0.6, 1.0), (0.60, 0.85), (0.1, 0.5), (0.2, 0.8), (0.8, 2.5)
    ),
    "snake": Species(
        (0.10, 0.20), (0.2, 0.4), (0.10, 0.20), (0.5, 0.9), (0.50, 0.70), (0.6, 1.6), (0.2, 0.8), (0.5, 2.0)
    ),
}
SWINGS = {  # fraction of the way over the fraction of a swing
    "cycloid": lambda u: u - np.sin(2 * np.pi * u) / (2 * np.pi),
    "even": lambda u: u,
    "cosine": lambda u: (1 - np.cos(np.pi * u)) / 2,
    "jerk-free": lambda u: u**3 * (10 - 15 * u + 6 * u**2),
    "ramp": lambda u: (
        np.clip(np.where(u < 0.2, u**2 / 0.4, u - 0.1), 0, None) / 0.8 - np.clip(u - 0.8, 0, None) ** 2 / 0.32
    ),
    "late": lambda u: (1 - np.cos(np.pi * u**1.3)) / 2,
}
PATHS = ("straight", "turning", "climbing", "stopping", "starting and stopping")


class Specimen(NamedTuple):
    species: str
    path: str
    duty_factor: float
    limb_phases: tuple[float, ...]
    stride: float
    period: float
    trunk: float
    tracks: Tracks
    ends: np.ndarray
    """Times at which the clock shows whole cycles, as time and cycle, shape (2, frame)."""


def specimen(
    seed: int,
    *,
    species: str | None = None,
    path: str | None = None,
    points: str | None = None,
    trunk: float | None = None,
    noise: float | None = None,
    lost: float | None = None,
    duty: float | None = None,
    cycles: float | None = None,
    rate: float | None = None,
    jumps: float | None = None,
    swing: str = "cycloid",
) -> Specimen:
    """Return the animal of a number and its film in pixels; what is not given is drawn.

    Args:
        seed: of all that is drawn.
        species: of ``SPECIES``.
        path: of ``PATHS``.
        points: all keypoints, "needed" ones, or "some".
        trunk: its length [px].
        noise: standard deviation [px].
        lost: fraction of points that are lost, each for itself.
        duty: duty factor.
        cycles: that are filmed.
        rate: frames per cycle.
        jumps: fraction of points two trunk lengths off.
        swing: of ``SWINGS``.
    """
    random = np.random.default_rng(seed)
    species = species or list(SPECIES)[seed % len(SPECIES)]
    kind = SPECIES[species]
    path = path or PATHS[int(random.integers(len(PATHS)))]
    points = points or ("all", "needed", "some")[int(random.integers(3))]
    head, tail, outward, stride, drawn_duty, spine, tail_bend, period = (random.uniform(*limits) for limits in kind)
    duty = drawn_duty if duty is None else duty
    trunk_px = float(np.exp(random.uniform(np.log(20.0), np.log(400.0))))
    trunk = trunk_px if trunk is None else trunk
    noise_px = min(random.uniform(0.2, 2.0), 0.04 * trunk)
    noise = noise_px if noise is None else noise
    drawn_lost, drawn_jumps = random.choice([0.0, 0.02, 0.1]), random.choice([0.0, 0.0, 0.01])
    lost, jumps = drawn_lost if lost is None else lost, drawn_jumps if jumps is None else jumps
    drawn_cycles, drawn_rate = random.uniform(3.0, 9.0), random.uniform(16.0, 60.0)
    cycles, rate = cycles or drawn_cycles, rate or drawn_rate
    lag = random.uniform(0.2, 0.5) if duty > 0.6 else random.uniform(0.4, 0.5)
    limb_phases = (0.0, 0.5, lag, (lag + 0.5) % 1.0)
    time, clock = _clock(random, path, cycles, period, rate)
    midline = _Body(
        random=random,
        clock=clock,
        snake=species == "snake",
        turning=path == "turning",
        spine=spine,
        tail_bend=tail_bend,
        stride=stride,
        head=head,
        tail=tail,
    )
    midline.swing = swing
    position = midline.points()
    if species != "snake":
        reach = random.uniform(-0.05, 0.25), random.uniform(-0.05, 0.25)
        wide = random.uniform(0.8, 1.2)
        for leg, phase in zip(LEGS, limb_phases, strict=True):
            girdle, ahead = (1.0, reach[0]) if leg.endswith("F") else (0.0, reach[1])
            side = outward * (wide if leg.endswith("H") else 1.0) * (1 if leg.startswith("L") else -1)
            position[leg] = midline.foot(clock + phase, phase, duty, girdle + ahead, side)
    names = _chosen(random, points, position, species)
    place = trunk * np.stack([position[name] for name in names], axis=1)
    heading = np.pi / 2 if path == "climbing" else random.uniform(-np.pi, np.pi)
    c, s = np.cos(heading), np.sin(heading)
    place = place @ np.array([[c, s], [-s, c]]) + random.uniform(100.0, 900.0, 2)
    place += noise * random.standard_normal(place.shape)
    off = random.uniform(size=place.shape[:2]) < jumps
    turn = random.uniform(0.0, 2 * np.pi, off.sum())
    place[off] += 2 * trunk * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    place[random.uniform(size=place.shape[:2]) < lost] = np.nan
    if lost >= 0.1:  # a gap of some frames
        start = int(random.integers(len(time) // 2))
        place[start : start + int(rate / 3), int(random.integers(len(names)))] = np.nan
    tracks = Tracks(time=time, points=names, position=place, unit="px", source=f"the film of {species} {seed}")
    return Specimen(species, path, duty, limb_phases, stride * trunk, period, trunk, tracks, np.stack([time, clock]))


def _clock(random, path: str, cycles: float, period: float, rate: float) -> tuple[np.ndarray, np.ndarray]:
    """Return times of frames [s] and the cycles that are walked until then."""
    fine = np.arange(0.0, cycles * 3.0, 0.002)
    pace = 1.0 + 0.08 * np.sin(2 * np.pi * random.uniform(0.05, 0.2) * fine + random.uniform(0.0, 6.0))
    if path == "stopping":
        pace *= np.clip((random.uniform(0.6, 0.9) * cycles - fine) / 0.4, 0.0, 1.0)
    if path == "starting and stopping":
        first, pause = random.uniform(0.3, 0.5) * cycles, random.uniform(0.5, 1.5)
        pace *= 1.0 - np.clip((fine - first) / 0.4, 0.0, 1.0) * np.clip((first + 0.8 + pause - fine) / 0.4, 0.0, 1.0)
    if path == "climbing":
        pace *= 0.7
    if path == "slowing":
        pace = np.clip(1.15 - 0.5 * fine / cycles, 0.6, None)  # to half of the first
    shows = np.concatenate([[0.0], np.cumsum(pace[:-1]) * 0.002])
    last = np.interp(cycles, shows, fine) if shows[-1] > cycles else 1.2 * cycles
    time = np.arange(0.0, last, 1.0 / rate)
    return period * time, random.uniform() + np.interp(time, fine, shows)


class _Body:
    """A midline that follows a path, with a bend that stands or travels; lengths in trunks, the hip goes ahead."""

    def __init__(self, *, random, clock, snake, turning, spine, tail_bend, stride, head, tail) -> None:
        self.random, self.clock, self.snake, self.stride = random, clock, snake, stride
        self.curvature = random.uniform(0.2, 0.6) * random.choice([-1, 1]) if turning else 0.0
        self.head, self.tail, self.spine, self.tail_bend = head, tail, spine, tail_bend
        self.wave = random.uniform(0.0, 0.5)  # lag of the tail's tip behind its root
        self.tail_lag = random.uniform(0.0, 0.5)
        self.rightmost, self.swing = random.uniform(), "cycloid"
        self.curl = random.uniform(-0.8, 0.8) if random.uniform() < 0.3 else 0.0
        self.joints = int(random.integers(2, 5))
        self.tails = int(random.integers(2, 6))

    def course(self, clock):
        """Return place and heading of the hip's path."""
        way = self.stride * clock
        if not self.curvature:
            return np.stack([way, 0 * way], axis=-1), 0.0 * way
        angle = self.curvature * way
        return np.stack([np.sin(angle), 1 - np.cos(angle)], axis=-1) / self.curvature, angle

    def points(self) -> dict[str, np.ndarray]:
        """Return the places of the midline's points in each frame."""
        hip, heading = self.course(self.clock)
        turn = 2 * np.pi * (self.clock - self.rightmost)
        if self.snake:
            return self._snake(hip, heading, turn)
        fine = 40
        bend = self.spine * np.cos(turn)
        points, position = {"hip": hip}, hip
        marks = {round(fine * (i + 1) / (self.joints + 1)): f"spine_{i + 1}" for i in range(self.joints)}
        marks[fine] = "shoulder"
        for i in range(1, fine + 1):  # an even bend, and the path's own
            yaw = heading + bend * (0.5 - (i - 0.5) / fine) + self.curvature * (i - 0.5) / fine
            position = position + _way(yaw) / fine
            if i in marks:
                points[marks[i]] = position
        yaw = heading - bend / 2 + self.curvature
        points["neck"] = position + 0.4 * self.head * _way(yaw)
        points["snout"] = points["neck"] + 0.6 * self.head * _way(yaw - 0.1 * bend)
        yaw = heading + bend / 2
        points["tail_base"] = position = hip - 0.15 * _way(yaw)
        marks = {round(fine * (i + 1) / (self.tails + 1)): f"tail_{i + 1}" for i in range(self.tails)}
        marks[fine] = "tail_tip"
        for i in range(1, fine + 1):
            share = (i - 0.5) / fine
            lag = 2 * np.pi * (self.tail_lag + self.wave * share)
            bent = yaw + share * (self.tail_bend * np.cos(turn - lag) - self.curvature * self.tail + self.curl)
            position = position - self.tail / fine * _way(bent)
            if i in marks:
                points[marks[i]] = position
        return points

    def _snake(self, hip, heading, turn) -> dict[str, np.ndarray]:
        """Return the places of the points of a body whose bend travels; it is four trunks of limbed animals long."""
        fine, names = 200, ["snout", *(f"spine_{i}" for i in range(8, 0, -1)), "tail_base", "tail_tip"]
        share = (np.arange(fine) + 0.5) / fine
        waves = self.random.uniform(1.0, 2.0)
        yaw = heading[:, None] + self.spine * 0.7 * np.cos(turn[:, None] - 2 * np.pi * waves * share)
        place = hip[:, None] - np.cumsum(_way(yaw), axis=1) * (4.0 / fine)
        marks = np.linspace(0, fine - 1, len(names)).astype(int)
        return {name: place[:, mark] for name, mark in zip(names, marks, strict=True)}

    def foot(self, phases, phase, duty, ahead, side) -> np.ndarray:
        """Return the places of a foot: it rests where it passes its girdle in the middle of its stance."""
        number, part = np.floor(phases), np.mod(phases, 1.0)  # a swing, then a stance
        swing = np.clip(part / (1.0 - duty), 0.0, 1.0)
        gone = SWINGS[self.swing](swing)

        def print_of(number):
            middle = number + 1.0 - duty / 2 - phase
            place, heading = self.course(middle + ahead / self.stride)
            return place + side * np.stack([-np.sin(heading), np.cos(heading)], axis=-1)

        return print_of(number - 1) * (1 - gone)[:, None] + print_of(number) * gone[:, None]


def _way(yaw):
    return np.stack([np.cos(yaw), np.sin(yaw)], axis=-1)


def _chosen(random, points: str, position: dict[str, np.ndarray], species: str) -> tuple[str, ...]:
    names = list(position)
    if species == "snake":
        return tuple(names)
    if points == "needed":
        head = ("neck", "snout")[int(random.integers(2))]
        return (head, "shoulder", "hip", "tail_base", "tail_tip", *LEGS)
    if points == "some":
        gone = set(random.choice([name for name in names if name not in ("hip", "shoulder")], 4, replace=False))
        names = [name for name in names if name not in gone]
    return tuple(names)


def exchanged(tracks: Tracks, first: str, second: str) -> Tracks:
    """Return tracks with the names of two keypoints exchanged."""
    position = tracks.position.copy()
    i, j = tracks.points.index(first), tracks.points.index(second)
    position[:, [i, j]] = position[:, [j, i]]
    return replace(tracks, position=position)


def exchange(seed: int, tracks: Tracks) -> tuple[str, str]:
    """Return a pair of keypoints whose exchange the film can show: the ends of a midline without feet are not."""
    random = np.random.default_rng([seed, 1])
    names = [name for name in tracks.points if name in (*tracks.midline, *tracks.legs)]
    while True:
        first, second = (str(name) for name in random.choice(names, 2, replace=False))
        if tracks.legs or {first, second} != {tracks.midline[0], tracks.midline[-1]}:
            return first, second


def said(tracks: Tracks) -> tuple[bool, str]:
    """Return whether tracks are refused, and all that the screening says of their keypoints."""
    try:
        screened = screen_tracks(tracks)
    except UnusableTracks as error:
        return True, str(error)
    return False, "; ".join(f"{name} {reason}" for name, reason in screened.wrong.items())


def accuses(text: str) -> bool:
    """Return whether a sentence says that names are exchanged."""
    return "exchanged" in text or "swapped" in text


if __name__ == "__main__":
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 500
    found: Counter[str] = Counter()
    for seed in range(count):
        animal = specimen(seed)
        refused, text = said(animal.tracks)
        if refused or text:
            word = "falsely accused" if accuses(text) else "refused" if refused else "left out"
            found[word] += 1
            print(word, seed, animal.species, animal.path, f"{animal.trunk:.0f} px", text[:230])
        pair = exchange(seed, animal.tracks)
        refused, text = said(exchanged(animal.tracks, *pair))
        kind = " and ".join(sorted("foot" if name in LEGS else "midline" for name in pair))
        if refused and accuses(text) and all(name in text for name in pair):
            found[f"named: {kind}"] += 1
        else:
            found[f"not named: {kind}"] += 1
            print(
                "not named",
                seed,
                animal.species,
                animal.path,
                f"{animal.trunk:.0f} px",
                pair,
                animal.tracks.points,
                text[:260],
            )
    print(*sorted(found.items()), sep="\n")

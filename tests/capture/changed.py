"""Films of which one thing was changed, and what came of each: the battery of wrong keypoints.

``python tests/capture/changed.py SEED [KIND ...]`` goes through every keypoint of an animal.
"""

import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from menagerie import Filmed, apart, built, truth

from suchus.animals.capture import Camera, Tracks, UnusableTracks, film_animal, observe

PIXELS = 1000.0
"""Pixels per metre of the films."""


class Told(NamedTuple):
    """What came of a changed film."""

    refused: bool
    """Whether nothing was measured."""
    outside: tuple[str, ...]
    """Numbers whose interval does not hold the truth."""
    named: bool
    """Whether a keypoint that was changed is named."""
    said: str
    """All that was said."""


def walker(seed: int) -> Filmed:
    """An animal that walks for eight cycles, filmed in pixels with little noise."""
    random = np.random.default_rng(seed)
    animal = built(random, seed, trunk=(0.1, 0.2), period=(0.8, 1.2))
    camera = Camera(
        rate=50.0,
        noise=0.005 * animal.trunk,
        lost=0.02,
        heading=random.uniform(-3.0, 3.0),
        scale=PIXELS,
        heights=False,
        seed=seed,
    )
    pace = 1.0 + 0.04 * random.standard_normal(8).clip(-2.0, 2.0)
    tracks = film_animal(animal, camera, cycles=8, pace=pace)
    return Filmed(animal, pace, replace(tracks, position=tracks.position + np.array([500.0, -400.0])))


def swapped(tracks: Tracks, one: str, other: str, frames: slice = slice(None)) -> Tracks:
    position = tracks.position.copy()
    i, j = tracks.points.index(one), tracks.points.index(other)
    position[frames, [i, j]] = position[frames, [j, i]] if frames == slice(None) else position[frames][:, [j, i]]
    return replace(tracks, position=position)


def put(tracks: Tracks, point: str, place: np.ndarray, frames: slice = slice(None)) -> Tracks:
    position = tracks.position.copy()
    position[frames, tracks.points.index(point)] = place[frames]
    return replace(tracks, position=position)


def delayed(tracks: Tracks, point: str, frames: int) -> Tracks:
    place = tracks.at(point)
    return put(tracks, point, np.concatenate([np.repeat(place[:1], frames, axis=0), place[:-frames]]))


def shaken(tracks: Tracks, point: str, by: float, seed: int = 0) -> Tracks:
    place = tracks.at(point)
    return put(tracks, point, place + by * np.random.default_rng(seed).standard_normal(place.shape))


def changes(tracks: Tracks) -> Iterator[tuple[str, tuple[str, ...], Tracks]]:
    """Every change of every keypoint: its kind, whom it befalls, and the film."""
    n, names = len(tracks.time), tracks.points
    while_ = slice(n // 3, n // 3 + n // 5)
    for i, one in enumerate(names):
        place, other, far = tracks.at(one), names[(i + 1) % len(names)], names[(i + 5) % len(names)]
        yield "zero", (one,), put(tracks, one, 0.0 * np.nan_to_num(place))
        yield "zero for a while", (one,), put(tracks, one, 0.0 * np.nan_to_num(place), while_)
        yield "frozen for a while", (one,), put(tracks, one, np.broadcast_to(place[n // 3], place.shape), while_)
        for by in (10.0, 1000.0, 10000.0):
            yield f"shaken by {by:g} px", (one,), shaken(tracks, one, by, i)
        yield "swapped with the next", (one, other), swapped(tracks, one, other)
        yield "swapped for a while", (one, other), swapped(tracks, one, other, while_)
        yield "swapped with another", (one, far), swapped(tracks, one, far)
        yield "mirrored", (one,), put(tracks, one, place * [1.0, -1.0])
        yield "lost", (one,), put(tracks, one, np.nan * place)
        for late in (3, 5, 8):
            yield f"{late} frames late", (one,), delayed(tracks, one, late)


def told(filmed: Filmed, tracks: Tracks, names: tuple[str, ...]) -> Told:
    """Read a changed film and hold what comes of it against the truth; lengths are in pixels."""
    try:
        walk = observe(tracks)
    except UnusableTracks as error:
        return Told(True, (), any(name in str(error) for name in names), str(error))
    true = {
        name: value * _scale(walk.numbers[name].unit) for name, value in truth(filmed).items() if name in walk.numbers
    }
    outside = [name for name, value in true.items() if not apart(walk.numbers[name], value) <= walk.numbers[name].error]
    said = "\n".join(walk.notes)
    return Told(False, tuple(outside), any(name in said for name in names), said)


def _scale(unit: str) -> float:
    return PIXELS if unit.startswith("px") else 1.0


if __name__ == "__main__":
    filmed, found = walker(int(sys.argv[1])), Counter()
    for kind, names, tracks in changes(filmed.tracks):
        if not sys.argv[2:] or any(kind.startswith(word) for word in sys.argv[2:]):
            one = told(filmed, tracks, names)
            word = "refused" if one.refused else "outside" if one.outside else "inside"
            found[kind, word, one.named] += 1
            if one.outside or not one.named:
                print(kind, names, word, *one.outside, one.said.replace("\n", " | ")[:200], flush=True)
    for (kind, word, named), count in sorted(found.items()):
        print(f"{kind:24s} {word:8s} {'named' if named else 'not named':10s} {count}")

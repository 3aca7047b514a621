"""Animals of real proportions are not accused of what the geometry does not prove, and what it proves is named."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from changed import delayed, put
from zoo import SPECIES, accuses, exchange, exchanged, said, specimen

from suchus.animals.capture import observe, read_tracks
from suchus.animals.capture.exchange import MAX_FALSE_ACCUSATIONS
from suchus.animals.capture.screen import screen_tracks
from suchus.robot.design import LEGS

DATA = Path(__file__).parents[1] / "data" / "animals"
MIN_NAMED = 0.95
"""Least fraction of exchanges that are named."""


def battery(seeds) -> tuple[list[str], list[str], int]:
    """Return what was accused falsely, the exchanges that were not named, and the number of animals."""
    false, silent = [], []
    for seed in seeds:
        tracks = specimen(seed).tracks
        refused, text = said(tracks)
        if refused or accuses(text):
            false.append(text)
        pair = exchange(seed, tracks)
        refused, text = said(exchanged(tracks, *pair))
        if not (refused and accuses(text) and all(name in text for name in pair)):
            silent.append(f"{seed} {pair}: {text}")
    return false, silent, len(seeds)


def test_nobody_is_accused_falsely_and_exchanges_are_named():
    """One in ten of the animals of the great battery."""
    false, silent, count = battery(range(0, 500, 10))
    assert not false
    assert len(silent) <= (1 - MIN_NAMED) * count, silent


@pytest.mark.slow("more than ten seconds: five hundred films")
def test_five_hundred_animals():
    false, silent, count = battery(range(500))
    assert len(false) <= MAX_FALSE_ACCUSATIONS * count, false
    assert len(silent) <= (1 - MIN_NAMED) * count, silent


def test_the_zoo_holds_what_it_says():
    animals = [specimen(seed) for seed in range(30)]
    assert {animal.species for animal in animals} == set(SPECIES)
    for animal in animals:
        if animal.tracks.has("shoulder", "hip"):
            length = np.nanmedian(np.linalg.norm(animal.tracks.at("shoulder") - animal.tracks.at("hip"), axis=-1))
            assert length == pytest.approx(animal.trunk, rel=0.12)


def test_the_keypoints_that_a_gait_needs_are_enough():
    """A long tail without keypoints between bends, and its chord with it; a foot is as near to the tail's base."""
    walk = observe(read_tracks(DATA / "needed_points.csv"))
    assert not walk.wrong
    assert walk.value("period") == pytest.approx(1.6, abs=0.01)
    assert walk.value("stride") == pytest.approx(0.9, abs=0.01)
    assert walk.value("duty_LF") == pytest.approx(0.7, abs=0.02)
    walk = observe(read_tracks(DATA / "snout_first.csv"))
    assert not walk.wrong
    assert walk.value("stride") == pytest.approx(0.9, abs=0.01)


def names_of(tracks) -> set[str]:
    """Return the keypoints that the screening names."""
    screened = screen_tracks(tracks)
    frames = [note.partition(":")[2] for note in screened.notes]
    return {name for name in tracks.points if name in screened.wrong or any(f" {name} in " in text for text in frames)}


def culprits(tracks, point, random):
    """Films in which one keypoint is stuck, jumps, or stays behind for a while."""
    place, frames = tracks.at(point), len(tracks.time)
    pause = slice(frames // 3, frames // 3 + frames // 5)
    seen = place[np.isfinite(place[:, 0])][0]
    away = place.copy()
    often = random.uniform(size=frames) < 0.1
    away[often] += random.uniform(-3.0, 3.0, (often.sum(), 2)) * 100.0
    yield "x is zero", put(tracks, point, place * [0.0, 1.0])
    yield "y is zero", put(tracks, point, place * [1.0, 0.0])
    yield "frozen", put(tracks, point, np.broadcast_to(seen, place.shape))
    yield "jumps", put(tracks, point, away)
    yield "frozen for a while", put(tracks, point, np.broadcast_to(place[frames // 3], place.shape), pause)


def test_one_culprit_is_named_alone():
    """A keypoint at fault is named itself; its neighbours, which are as far from it as it from them, are not."""
    found: Counter[str] = Counter()
    for seed in range(3, 33):
        tracks = specimen(seed, lost=0.0, jumps=0.0, path="straight", trunk=120.0).tracks
        usual, random = names_of(tracks), np.random.default_rng(seed)
        point = str(random.choice([name for name in tracks.points if name in (*tracks.midline, *LEGS)]))
        for kind, film in culprits(tracks, point, random):
            names = names_of(film) - usual
            found[kind, "innocent" if names - {point} else "culprit" if names else "none"] += 1
    count = {kind: sum(found[kind, word] for word in ("innocent", "culprit", "none")) for kind, _ in found}
    assert sum(found[kind, "innocent"] for kind in count) <= 0.02 * sum(count.values()), found
    for kind in set(count) - {"frozen for a while"}:  # a foot that stands as long may be frozen
        assert found[kind, "culprit"] >= 0.95 * count[kind], found


def test_a_late_keypoint_is_named_without_its_neighbour():
    for seed, point in ((25, "tail_1"), (35, "spine_8"), (24, "tail_base")):
        animal = specimen(seed, jumps=0.0)
        late = delayed(animal.tracks, point, round(0.08 * animal.period * animal.tracks.rate))
        assert set(observe(late).wrong) <= {point}


@pytest.mark.parametrize(
    "seed",
    [
        *(18, 22, 24, 28, 39, 63, 75, 80, 87, 90, 93, 96, 101, 113, 116, 134, 142, 146, 151),
        *(82, 203, 208, 240, 307, 309, 313, 314, 333, 746, 934),
    ],
)
def test_what_stops_turns_or_climbs_is_measured_and_nobody_is_late(seed):
    """Each of these was refused, or had a keypoint whose frames were called late."""
    animal = specimen(seed)
    walk = observe(animal.tracks)
    assert not walk.wrong
    assert walk.value("period") == pytest.approx(animal.period / (0.7 if animal.path == "climbing" else 1.0), rel=0.12)

"""Duty factors and strides of gaits as animals have them: any swing, films that slow down, turn, stop or follow."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.stats import binom
from zoo import SWINGS, specimen

from suchus.animals.capture import observe
from suchus.robot.design import LEGS


@cache
def read(seed: int, path: str, swing: str, duty: float | None = None):
    """An animal with feet that walks for six cycles, and what is measured of it."""
    random = np.random.default_rng(seed + 9)
    duty = duty or float(random.uniform(0.5, 0.85))
    animal = specimen(
        seed + seed // 5,  # every sixth has no feet
        path=path,
        points="all",
        duty=duty,
        swing=swing,
        jumps=0.0,
        trunk=float(random.uniform(60.0, 400.0)),
        cycles=6.0,
        rate=float(random.uniform(25.0, 80.0)),
    )
    return animal, observe(animal.tracks)


def duties(animals) -> tuple[np.ndarray, np.ndarray]:
    """Return errors and half widths of the duty factors of all feet."""
    pairs = [
        (walk.value(f"duty_{leg}") - animal.duty_factor, walk.numbers[f"duty_{leg}"].error)
        for animal, walk in animals
        for leg in LEGS
        if f"duty_{leg}" in walk.numbers
    ]
    error, width = np.transpose(pairs)
    return error[np.isfinite(width)], width[np.isfinite(width)]


def stride_errors(animals) -> tuple[np.ndarray, np.ndarray]:
    """Return errors and half widths of all strides, over the stride."""
    error = np.concatenate([walk.strides.stride_length.values / animal.stride - 1 for animal, walk in animals])
    width = np.concatenate(
        [
            (walk.strides.stride_length_high - walk.strides.stride_length).values / animal.stride
            for animal, walk in animals
        ]
    )
    return error, width


def holds(error, width) -> bool:
    """Whether intervals hold the truth in 95 of 100 cases, by the binomial law at 1 %."""
    return (np.abs(error) <= width).sum() >= binom.ppf(0.01, len(error), 0.95)


@pytest.mark.parametrize("swing", ["even", "cosine"])
def test_a_duty_factor_is_right_whatever_the_shape_of_the_swing(swing):
    """A swing at an even speed has no slow ends to hide in the noise; it was taken for longer than it is."""
    error, width = duties([read(seed, "straight", swing) for seed in range(8)])
    assert abs(error.mean()) < 0.012
    assert holds(error, width)
    assert np.median(width) < 0.05


@pytest.mark.slow("more than ten seconds: two hundred walks")
def test_two_hundred_gaits():
    """Duty factors of 0.5 to 0.85, six shapes of swing, straight and turning."""
    films = [
        read(seed, ("straight", "turning", "climbing", "slowing")[seed % 4], list(SWINGS)[seed % len(SWINGS)])
        for seed in range(200)
    ]
    error, width = duties(films)
    strides, stride_width = stride_errors(films)
    inside = np.mean(np.abs(error) <= width)
    print(f"duty: bias {error.mean():.4f}, {inside:.3f} of {len(error)} hold, ±{np.median(width):.3f}")
    print(f"stride: bias {strides.mean():.4f}, {np.mean(np.abs(strides) <= stride_width):.3f} of {len(strides)} hold")
    assert abs(error.mean()) < 0.01
    assert holds(error, width)
    assert holds(strides, stride_width)


def test_every_stride_has_a_duty_factor_of_its_own():
    animals = [read(seed, "straight", "cosine") for seed in range(8)]
    for _, walk in animals:
        assert (walk.strides.duty.std("stride").values > 1e-5).all()
    error = np.concatenate([(walk.strides.duty - animal.duty_factor).values.ravel() for animal, walk in animals])
    width = np.concatenate([(walk.strides.duty_high - walk.strides.duty).values.ravel() for _, walk in animals])
    use = np.isfinite(error)
    assert holds(error[use], width[use])


def test_the_last_stride_of_a_film_that_slows_down_is_no_shorter():
    """The pace falls to half of the first."""
    animals = [read(seed, "slowing", "cosine") for seed in range(8)]
    error, width = stride_errors(animals)
    assert holds(error, width)
    assert np.mean([walk.strides.stride_length.values[-1] / animal.stride - 1 for animal, walk in animals]) > -0.02


def test_strides_are_taken_along_the_path_of_an_animal_that_turns():
    error, width = stride_errors([read(seed, "turning", "ramp") for seed in range(8)])
    assert abs(error.mean()) < 0.006
    assert holds(error, width)


def test_of_an_animal_that_stops_its_longest_walk_is_measured():
    animals = [read(seed, "starting and stopping", "cosine") for seed in range(8)]
    said = [any("the animal stands from" in note for note in walk.notes) for _, walk in animals]
    assert sum(said) >= 6  # a pause may be shorter than a rest of the gait
    error, width = duties(animals)
    assert holds(error, width)
    straight = read(0, "straight", "cosine")[1]
    assert not any("stands" in note for note in straight.notes)


@pytest.mark.parametrize("follow", [0.2, 1.0])
def test_a_camera_that_follows_is_found_by_the_feet_that_stand(follow):
    """A fifth of the animal's speed made strides a fifth short; at its whole speed, or on a belt, it seems to stay."""
    for seed in (0, 2, 4):
        animal, walk = read(seed, "straight", "cosine")
        hip = animal.tracks.at("hip")
        seen = np.isfinite(hip[:, 0])
        speed = np.polyfit(animal.tracks.time[seen], hip[seen], 1)[0]
        moved = animal.tracks.position - follow * (animal.tracks.time[:, None] * speed)[:, None, :]
        followed = observe(replace(animal.tracks, position=moved))
        note = next(note for note in followed.notes if "standing feet move" in note)
        assert float(note.partition("/s, ")[2].partition(" %")[0]) == pytest.approx(100 * follow, abs=3.0)
        stride = followed.numbers["stride_length"]
        assert abs(stride.value - animal.stride) <= stride.error < 0.08 * animal.stride
        assert not any("standing feet move" in note for note in walk.notes)

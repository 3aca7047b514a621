"""Sampling that ends once a claim has a word: when it ends, and with which intervals."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.core.intervals import fraction_interval, median_interval
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.feedback.experiment import Feedback, sharing_measures
from suchus.experiments.catalog.feedback.rules import EXAMPLES as FEEDBACK_EXAMPLES
from suchus.experiments.catalog.terrain.experiment import Terrain, _rough_grounds, _rough_measures
from suchus.experiments.catalog.terrain.rules import EXAMPLES as TERRAIN_EXAMPLES
from suchus.experiments.experiment import Measure, silent
from suchus.robot.motion import START

OPEN_TERRAIN = 3
"""Examples of the claim on rough grounds in which a reading is undecided: two of distance, one of the fraction kept."""


def measured(numbers):
    return {name: Measure(value, "-") for name, value in numbers.items()}


def test_a_claim_has_a_word_unless_a_reading_of_it_is_undecided():
    words = [
        (Terrain.has_word("erect_structure_rough", measured(numbers)), word)
        for numbers, word in TERRAIN_EXAMPLES["erect_structure_rough"]
    ]
    assert sum(not has_word for has_word, _ in words) == OPEN_TERRAIN
    assert all(not has_word for has_word, word in words if word == "undecided")
    for numbers, word in FEEDBACK_EXAMPLES["shared_variables"]:
        assert Feedback.has_word("shared_variables", measured(numbers)) is (word != "undecided")


def starts(gains):
    """Return a stand-in for ``Feedback._further_starts`` whose gain by sharing is given for each start [m]."""

    def simulate(question, laws, numbers, progress):
        del progress
        time = START + np.arange(0.0, question.cycles + 0.25, 0.5) * question.gait.period
        alone = np.where(np.array(numbers) == 0, -1.0, 0.3)  # the worst start of both is the first
        speeds = np.array([alone + np.array(gains)[list(numbers)], alone])
        way = speeds[..., None] * (time - START) / question.gait.period
        coords = {"law": list(laws), "start": list(numbers), "start_time": time}
        return xr.Dataset({"start_way": (("law", "start", "start_time"), way)}, coords=coords)

    return simulate


def sampled(question):
    """Return the starts with and without sharing that a question samples."""
    first_starts = question._further_starts(["closed_noisy", "isolated_noisy"], range(question._looks[0]), silent)
    return question._sharing_record(first_starts, silent)


@pytest.mark.parametrize(
    ("gains", "count"),
    [
        (np.linspace(0.05, 0.2, 16), 8),  # all gain
        (np.linspace(-0.2, -0.05, 16), 8),  # all lose
        (np.array([0.2, -0.2] * 8), 16),  # as many gain as lose
        (np.array([0.2, -0.1] + 14 * [0.2]), 16),  # of eight the interval still holds the least
    ],
)
def test_starts_with_and_without_sharing_end_at_the_first_look_that_decides(gains, count, monkeypatch):
    monkeypatch.setattr(Feedback, "_further_starts", starts(gains))
    question = replace(EXPERIMENTS["feedback"], sharing_starts=16)
    record = sampled(question)
    assert record.sizes["start"] == count
    found = sharing_measures(record, question.gait, question.hold)
    low, high = median_interval(gains[:count], confidence=0.975)
    ends = [found[f"way_gain_shared{end}"].value for end in ("_low", "_high")]
    assert ends == pytest.approx([low, high])


@pytest.mark.parametrize(
    ("gains", "count"),
    [
        (np.linspace(0.05, 0.2, 32), 8),
        (np.array([0.2, -0.1] + 30 * [0.2]), 16),  # of eight the interval holds the least, of sixteen no more
        (np.array([0.2, -0.2] * 16), 32),
    ],
)
def test_for_verdicts_starts_end_after_a_quarter_if_that_decides(gains, count, monkeypatch):
    monkeypatch.setattr(Feedback, "_further_starts", starts(gains))
    question = EXPERIMENTS["feedback"].for_verdicts()
    record = sampled(question)
    assert (question.sharing_starts, record.sizes["start"]) == (32, count)
    found = sharing_measures(record, question.gait, question.hold)
    low, high = median_interval(gains[:count], confidence=1.0 - 0.05 / 3)
    ends = [found[f"way_gain_shared{end}"].value for end in ("_low", "_high")]
    assert ends == pytest.approx([low, high])


def test_without_an_early_end_all_starts_are_sampled_and_their_interval_is_that_of_one_look(monkeypatch):
    gains = np.linspace(0.05, 0.2, 16)
    monkeypatch.setattr(Feedback, "_further_starts", starts(gains))
    question = replace(EXPERIMENTS["feedback"], sharing_starts=16, early_end=False)
    record = sampled(question)
    assert record.sizes["start"] == 16
    found = sharing_measures(record, question.gait, question.hold)
    ends = [found[f"way_gain_shared{end}"].value for end in ("_low", "_high")]
    assert ends == pytest.approx(median_interval(gains, confidence=0.95))


def rough_walks(erect):
    """Return a stand-in for ``Terrain._walks_of_seeds``: how far the erect walk gets on each seed, if the crawl 1 m."""

    def walk(question, seeds, progress, names):
        del progress, names
        arms, heights = ["low_crawl", "semi_erect", "high_walk", "high_walk_level"], [0.0, *np.full(8, 0.04)]
        forward = np.ones((len(heights), len(arms), len(seeds)))
        forward[1:, 2] = np.array(erect)[list(seeds)]
        dims = ("ground", "arm", "seed")
        record = xr.Dataset(
            {"forward": (dims, forward), "met": (dims, np.ones_like(forward)), "fell": (dims, np.zeros_like(forward))},
            coords={"arm": arms, "kind": ("ground", ["bumps"] * len(heights))},
        )
        return record.assign(height=("ground", heights), size_of_robot=((), question._size))

    return walk


@pytest.mark.parametrize(("erect", "count"), [([1.2, 1.2, 0.8, 0.8], 2), ([1.2, 0.8, 1.2, 1.2], 4)])
def test_walks_on_rough_ground_end_at_the_first_look_that_decides(erect, count, monkeypatch):
    monkeypatch.setattr(Terrain, "_walks_of_seeds", rough_walks(erect))
    question = EXPERIMENTS["terrain"]
    record = question._ground_record(lambda stage, fraction: None)
    assert record.sizes["seed"] == count
    found = _rough_measures(_rough_grounds(record), record)
    ahead = sum(8 * (way > 1.0) for way in erect[:count])
    ends = [found[f"erect_open_loop_ahead_share{end}"].value for end in ("_low", "_high")]
    assert ends == pytest.approx(fraction_interval(ahead, 8 * count, confidence=0.975))


def test_without_an_early_end_all_seeds_walk_on_rough_ground(monkeypatch):
    erect = [1.2, 1.2, 0.8, 0.8]
    monkeypatch.setattr(Terrain, "_walks_of_seeds", rough_walks(erect))
    record = replace(EXPERIMENTS["terrain"], early_end=False)._ground_record(lambda stage, fraction: None)
    assert record.sizes["seed"] == 4
    found = _rough_measures(_rough_grounds(record), record)
    ends = [found[f"erect_open_loop_ahead_share{end}"].value for end in ("_low", "_high")]
    assert ends == pytest.approx(fraction_interval(16, 32, confidence=0.95))


def test_without_a_claim_on_rough_ground_half_of_the_seeds_suffice(monkeypatch):
    monkeypatch.setattr(Terrain, "_walks_of_seeds", rough_walks([1.2, 0.8, 1.2, 0.8]))
    question = EXPERIMENTS["terrain"]
    flat = question._ground_record(lambda stage, fraction: None)
    assert flat.sizes["seed"] == 4  # undecided after half of them

    def even_walks(asked, seeds, progress, names):
        return rough_walks([1.0] * 4)(asked, seeds, progress, names).isel(ground=[0])

    monkeypatch.setattr(Terrain, "_walks_of_seeds", even_walks)
    assert question._ground_record(lambda stage, fraction: None).sizes["seed"] == 2

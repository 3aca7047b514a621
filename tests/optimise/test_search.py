"""The search finds what is known to be there, and asks the same again."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.experiments.optimise import Aim, NoOptimiser
from suchus.experiments.optimise.search import search

BEST = np.array([0.3, 0.7])


def tried(spec, generations, loss):
    driver, asked = search(spec), []
    for _ in range(generations):
        points = driver.ask()
        asked.append(points)
        driver.tell(loss(points))
    return asked


def bowl(points):
    return ((points - BEST) ** 2).sum(axis=1)


def test_the_bottom_of_a_bowl_is_found_within_its_range(small):
    asked = tried(replace(small, population=8), 40, bowl)
    assert np.abs(asked[-1].mean(axis=0) - BEST).max() < 0.02
    assert min(p.min() for p in asked) >= 0.0
    assert max(p.max() for p in asked) <= 1.0


def test_a_best_at_the_end_of_the_range_is_found_there(small):
    asked = tried(replace(small, population=8), 40, lambda points: -points.sum(axis=1))
    assert max(points.min() for points in asked) > 0.98


def test_the_same_seed_asks_the_same_whatever_else_draws(small):
    first = tried(small, 6, bowl)
    np.random.seed(3)  # noqa: NPY002  whoever uses the global generator must not matter
    again = tried(small, 6, bowl)
    assert all(np.array_equal(a, b) for a, b in zip(first, again, strict=True))
    other = tried(replace(small, seed=9), 6, bowl)
    assert not np.array_equal(first[0], other[0])


def test_when_it_has_converged_it_starts_again_with_more(small):
    asked = tried(small, 150, bowl)
    assert {len(points) for points in asked} >= {4, 8}


def test_a_front_is_pushed_to_both_of_its_ends(small):
    aims = (Aim(name="displacement"), Aim(name="cost_of_transport"))
    spec = replace(small, aims=aims, pareto=True, population=6, points=5)

    def two(points):
        x = points[:, 0]
        return np.column_stack([-x, 1.8 * x**2 + points[:, 1]])

    last = np.concatenate(tried(spec, 30, two)[-3:])
    assert np.quantile(last[:, 1], 0.5) < 0.1  # what neither aim wants
    assert last[:, 0].min() < 0.4
    assert last[:, 0].max() > 0.7


@pytest.mark.parametrize("missing", ["cma", "comocma"])
def test_without_its_library_the_sentence_says_how_to_install_it(missing, small, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, missing, None)
    aims = (Aim(name="displacement"), Aim(name="cost_of_transport"))
    with pytest.raises(NoOptimiser, match=rf"needs {missing}; install it with: pip install 'suchus\[optimise\]'"):
        search(replace(small, aims=aims, pareto=missing == "comocma"))

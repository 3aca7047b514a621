"""The page on environments states what policies that nobody trained get."""

import pytest

import policies
from pages.stated import kept

KEPT = kept(policies.NAME)


def same(results, stored):
    return results == pytest.approx(stored, rel=0.02, abs=0.01)


@pytest.mark.parametrize("robot", list(KEPT["bodies"]))
def test_each_body_gets_as_far_by_its_clock_as_is_kept(robot):
    """Renew with ``python tools/policies.py``."""
    results, stored = policies.body_results(robot), dict(KEPT["bodies"][robot])
    assert results.pop("gait") == stored.pop("gait")
    assert same(results, stored)


def test_what_is_kept_is_of_the_tasks_and_bodies_that_are_played():
    assert {task: set(rows) for task, rows in KEPT["tasks"].items()} == {
        task: set(players) for task, players in policies.PLAYERS.items()
    }
    assert set(KEPT["shores"]) == {str(slope) for slope in policies.SLOPES}


@pytest.mark.validate
@pytest.mark.parametrize(("task", "policy"), [(t, p) for t, players in policies.PLAYERS.items() for p in players])
def test_episodes_of_a_policy_give_what_is_kept(task, policy):
    assert same(policies.results(task, policy), KEPT["tasks"][task][policy])


@pytest.mark.validate
@pytest.mark.parametrize("slope", policies.SLOPES)
def test_the_controller_comes_ashore_as_is_kept(slope):
    assert same(policies.shore_results(slope), KEPT["shores"][str(slope)])

"""The page on environments states what policies that nobody trained get."""

from evidence import untrained_policies
from pages.stated import kept

KEPT = kept(untrained_policies.NAME)


def test_what_is_kept_is_of_the_tasks_and_bodies_that_are_played():
    assert {task: set(rows) for task, rows in KEPT["tasks"].items()} == {
        task: set(players) for task, players in untrained_policies.PLAYERS.items()
    }
    assert set(KEPT["shores"]) == {str(slope) for slope in untrained_policies.SLOPES}

"""What the documentation says of verdicts is what the experiments said."""

import pytest

import verdict_table
from pages import article
from pages.stated import kept
from suchus.article.paper import CLAIMS, ERRATA
from suchus.article.verdict.judging import WORDS
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.claims import RULES

TABLE = kept(verdict_table.NAME)
QUICKLY = ("gait_diagram", "leg_kinematics", "spine_kinematics", "tail_bending")
"""Experiments whose whole form takes seconds."""


def test_the_table_has_a_word_for_every_rule():
    assert set(TABLE) == set(RULES)
    assert {row["verdict"] for row in TABLE.values()} <= set(WORDS)


def test_the_rules_of_today_say_the_words_of_the_table_of_what_is_kept():
    """So that no rule changes while its word stays."""
    again = verdict_table.judged_again()
    assert len(again) > 30
    for claim, row in again.items():
        assert (claim, row["verdict"], row["fragile"]) == (claim, TABLE[claim]["verdict"], TABLE[claim]["fragile"])
        assert (claim, row.get("time_step")) == (claim, TABLE[claim].get("time_step"))


def test_a_verdict_that_the_time_step_may_change_says_so_in_its_row():
    lines = article.verdicts().splitlines()
    sensitive = [claim for claim, row in TABLE.items() if row.get("time_step")]
    assert 0 < len(sensitive) < len(TABLE)
    for claim, row in TABLE.items():
        line = next(line for line in lines if line.startswith("| [") and f"(#{claim})" in line)
        assert ("sensitive to the time step" in line) == (claim in sensitive)
        assert row.get("time_step", "") in article.verdicts()


def test_the_readme_counts_what_the_table_says():
    readme = verdict_table.README.read_text(encoding="utf-8")
    assert readme == verdict_table.written(readme, TABLE)
    changed = {**TABLE, "tail_swing": {**TABLE["tail_swing"], "verdict": "reproduced"}}
    assert (verdict_table.written(readme, changed) == readme) == (TABLE["tail_swing"]["verdict"] == "reproduced")


def test_the_page_in_the_repository_is_that_of_the_table():
    """Renew with ``python tools/verdict_table.py OUT``."""
    assert verdict_table.PAGE.read_text(encoding="utf-8") == article.verdicts()


def test_the_page_gives_the_words_the_rule_the_reason_and_the_verdict_of_every_claim():
    page = article.verdicts()
    for claim, rule in RULES.items():
        entry = page.split(f'<a id="{claim}">')[1].split("\n###")[0]
        assert CLAIMS[claim].quote in entry
        assert f"**{TABLE[claim]['verdict']}" in entry
        assert all(str(clause) in entry for clause in rule.holds)
        assert TABLE[claim]["why"] in entry


def test_every_table_equation_and_misprint_has_a_line_and_what_is_right_says_so():
    lines = article.verdicts().split("## Equation by equation")[1].split("\n## ")[0]
    rows = {line.split(" | ")[0].removeprefix("| "): line for line in lines.splitlines() if line.startswith("| ")}
    assert {f"({n})" for n in range(1, 21)} <= set(rows)
    assert all(f"[{key.replace('_', ' ')}](../src/suchus/article/paper/errata.py)" in lines for key in ERRATA)
    assert "| nothing |" in rows["(6)"]
    assert "#spine_forward" in rows["(15)"]
    assert all("| nothing |" not in row for row in rows.values() if "errata.py" in row)


@pytest.mark.parametrize("name", QUICKLY)
def test_what_runs_quickly_still_says_the_same(name):
    for verdict in EXPERIMENTS[name].run().verdicts:
        assert TABLE[verdict.claim.key]["verdict"] == verdict.verdict, verdict.why


@pytest.mark.validate
@pytest.mark.parametrize(
    "name", [name for name, one in EXPERIMENTS.items() if {*one.claims} & {*RULES} and name not in QUICKLY]
)
def test_what_runs_for_long_still_says_the_same(name):
    for verdict in EXPERIMENTS[name].run().verdicts:
        assert TABLE[verdict.claim.key]["verdict"] == verdict.verdict, verdict.why

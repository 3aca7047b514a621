"""What holds for the rules of every experiment: what each says of its examples, and that they notice any break of it.

A test of the tests: each rule is broken in every way that could hide a wrong verdict, and its examples must notice.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import get_args

import pytest
from tests.rule_examples import examples_of

from suchus.article.verdict import Clause, ControlGroup, Kind, Rule, judge
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.claims import claims_of, known_claims, rules_of

ALL = {rule.claim: (name, rule) for name in EXPERIMENTS for rule in rules_of(name)}
CLAIMS = {key: claim for name in EXPERIMENTS for key, claim in known_claims(name).items()}
ROWS = [pytest.param(claim, measures, word, id=f"{name}-{claim}-{i}") for name in EXPERIMENTS
        for claim, rows in examples_of(name).items() for i, (measures, word) in enumerate(rows)]  # fmt: skip
EACH_RULE = pytest.mark.parametrize("claim", [pytest.param(claim, id=f"{name}-{claim}")
                                              for claim, (name, _) in ALL.items()])  # fmt: skip
"""Every rule, under the name of its experiment, so that ``-k NAME`` finds those of one."""
_REVERSED = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}
_OFF = 0.05
"""How far a bound is moved [-]."""
_KINDS: tuple[Kind, ...] = get_args(Kind)


@pytest.mark.parametrize(("claim", "measures", "word"), ROWS)
def test_a_rule_says_of_measures_what_they_mean(claim, measures, word):
    verdict = judge(ALL[claim][1], measures, claims=CLAIMS)
    assert verdict.verdict == word
    assert len(verdict.why) > 20


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_its_rules_have_examples_of_two_words_at_least(name):
    examples = examples_of(name)
    assert set(examples) == {rule.claim for rule in rules_of(name)}
    for claim, rows in examples.items():
        assert len({word for _, word in rows}) > 1, claim


@EACH_RULE
def test_a_rule_is_of_a_claim_and_of_the_experiment_beside_which_it_stands(claim):
    name, rule = ALL[claim]
    assert rule.experiment == name
    assert claim in CLAIMS
    assert rule.holds or (rule.kind == "construction" and CLAIMS[claim].value is not None)
    assert all(clause.why for clause in rule.holds)


@EACH_RULE
def test_a_clause_above_or_below_zero_says_which_difference_matters(claim):
    for clause in ALL[claim][1].holds:
        if clause.bound == 0.0:
            assert clause.smallest_effect, f"{clause.measure} needs a smallest effect that matters"
        if clause.smallest_effect:
            assert clause.smallest_effect.size > 0.0
            assert len(clause.smallest_effect.why) > 20


@pytest.mark.parametrize("claim", [claim for claim, (_, rule) in ALL.items() if rule.control])
def test_a_control_group_says_why_it_is_the_one_of_the_claim(claim):
    _, rule = ALL[claim]
    assert rule.control.group
    assert len(rule.control.why) > 20
    assert all(need.why for need in rule.control.needs)
    assert not rule.rungs or not rule.control.needs  # a rung has no control group of its own to ask


def test_no_claim_has_two_rules():
    assert len(ALL) == sum(len(rules_of(name)) for name in EXPERIMENTS)


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_an_experiment_judges_each_claim_that_it_states(name):
    assert set(claims_of(name)) <= {rule.claim for rule in rules_of(name)}


@EACH_RULE
def test_every_way_to_break_a_rule_changes_a_word(claim):
    survived = []
    (name, rule), printed = ALL[claim], CLAIMS[claim]
    rows = examples_of(name)[claim]
    for what, broken, rounding in mutated(rule, numeric=printed.value is not None):
        if rounding != 1.0 and printed.rounding == 0.0:
            continue  # a count has no rounding
        claims = {claim: replace(printed, rounding=rounding * printed.rounding)}
        if all(judge(broken, measures, {}, claims=claims).verdict == word for measures, word in rows):
            survived.append(what)
    assert survived == []


def mutated(rule: Rule, numeric: bool) -> Iterator[tuple[str, Rule, float]]:
    """Yield what was done to the rule, the broken rule, and the factor on the claim's rounding.

    Args:
        rule: which is broken.
        numeric: whether the article prints a number of the claim.
    """
    for i, clause in enumerate(rule.holds):
        name = f"{rule.claim}: {clause.measure} {clause.relation} {clause.bound}"
        yield f"{name} dropped", _with(rule, i, ()), 1.0
        yield f"{name} never", _with(rule, i, (Clause(rule.measure, ">", float("inf"), "never"),)), 1.0
        yield f"{name} reversed", _with(rule, i, (replace(clause, relation=_REVERSED[clause.relation]),)), 1.0
        if not isinstance(clause.bound, str):
            for sign in (-1, 1):
                moved = clause.bound + sign * _OFF * (abs(clause.bound) or 1.0)
                yield f"{name} moved to {moved:.4g}", _with(rule, i, (replace(clause, bound=moved),)), 1.0
        effect = clause.smallest_effect
        for factor in (1.0 - _OFF, 1.0 + _OFF) if effect else ():
            moved_effect = replace(effect, size=factor * effect.size)
            yield f"{name}: effect x {factor}", _with(rule, i, (replace(clause, smallest_effect=moved_effect),)), 1.0
        if effect:
            yield f"{name}: any effect", _with(rule, i, (replace(clause, smallest_effect=None),)), 1.0
    for what, control in _without_control(rule):
        yield f"{rule.claim}: {what}", replace(rule, control=control), 1.0
    for kind in _KINDS:
        if kind != rule.kind:
            yield f"{rule.claim}: {kind} instead of {rule.kind}", replace(rule, kind=kind), 1.0
    if numeric and rule.kind != "animals":
        yield f"{rule.claim}: rounding doubled", rule, 2.0
        yield f"{rule.claim}: rounding removed", rule, 0.0
    for rung in rule.rungs:
        rest = tuple(other for other in rule.rungs if other != rung)
        if rung.carries:
            yield f"{rule.claim}: without {rung.model}", replace(rule, rungs=rest), 1.0
        else:
            heard = tuple(replace(other, carries=True) if other == rung else other for other in rule.rungs)
            yield f"{rule.claim}: {rung.model} heard", replace(rule, rungs=heard), 1.0
    for meaning in rule.interpretations:
        rest = tuple(other for other in rule.interpretations if other != meaning)
        yield f"{rule.claim}: {meaning.name} unheard", replace(rule, interpretations=rest), 1.0
    for factor in (1.0 - _OFF, 1.0 + _OFF) if rule.rungs else ():
        yield f"{rule.claim}: settled x {factor}", replace(rule, settled=factor * rule.settled), 1.0
    clauses = (*rule.holds, *(rule.control.needs if rule.control else ()))
    decisive = {clause.measure for clause in clauses} | {str(clause.bound) for clause in clauses}
    for name in decisive & set(rule.spread):
        rest = tuple(other for other in rule.spread if other != name)
        yield f"{rule.claim}: without the interval of {name}", replace(rule, spread=rest), 1.0


def _without_control(rule: Rule) -> Iterator[tuple[str, ControlGroup]]:
    """Yield what was done to what a control group needs, and what is left of it."""
    needs = rule.control.needs if rule.control else ()
    for i, need in enumerate(needs):
        moved = [replace(need, bound=factor * float(need.bound)) for factor in (1.0 - _OFF, 1.0 + _OFF)]
        ways = {"dropped": (), "reversed": (replace(need, relation=_REVERSED[need.relation]),)}
        ways |= {f"moved to {one.bound:.4g}": (one,) for one in moved}
        for what, instead in ways.items():
            left = (*needs[:i], *instead, *needs[i + 1 :])
            yield f"{need.measure} of the control group {what}", replace(rule.control, needs=left)


def _with(rule: Rule, at: int, clauses: tuple[Clause, ...]) -> Rule:
    return replace(rule, holds=(*rule.holds[:at], *clauses, *rule.holds[at + 1 :]))

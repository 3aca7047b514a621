"""Every rule, broken in every way that could hide a wrong verdict."""

from collections.abc import Iterator
from dataclasses import replace
from typing import get_args

from suchus.verdict import Clause, Kind, Rule

_REVERSED = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}
_OFF = 0.05
"""How far a bound is moved [-]."""
_KINDS: tuple[Kind, ...] = get_args(Kind)


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
    for kind in _KINDS:
        if kind != rule.kind:
            yield f"{rule.claim}: {kind} instead of {rule.kind}", replace(rule, kind=kind), 1.0
    if numeric and rule.kind != "animals":
        yield f"{rule.claim}: rounding doubled", rule, 2.0
        yield f"{rule.claim}: rounding removed", rule, 0.0
        if rule.band is not None:
            yield f"{rule.claim}: without the spread of repeats", replace(rule, band=None), 1.0


def _with(rule: Rule, at: int, clauses: tuple[Clause, ...]) -> Rule:
    return replace(rule, holds=(*rule.holds[:at], *clauses, *rule.holds[at + 1 :]))

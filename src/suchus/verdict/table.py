"""All rules, by claim and by experiment."""

from collections.abc import Mapping
from types import MappingProxyType

from suchus.verdict.rule import Rule
from suchus.verdict.rules import EXPERIMENTS

RULES: Mapping[str, Rule] = MappingProxyType({rule.claim: rule for rules in EXPERIMENTS for rule in rules})
"""By claim."""


def rules_of(experiment: str) -> tuple[Rule, ...]:
    """Return the rules that read the measures of an experiment, in the order of its page."""
    return tuple(rule for rule in RULES.values() if rule.experiment == experiment)

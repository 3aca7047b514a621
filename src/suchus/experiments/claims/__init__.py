"""Rules of all experiments by claim, and how many of their verdicts are evidence."""

from suchus.experiments.claims.counting import EvidenceCount, Standing, counted, standings
from suchus.experiments.claims.table import RULES, UNRULED, examples_of, rules_of, varied_of

__all__ = [
    "RULES",
    "UNRULED",
    "EvidenceCount",
    "Standing",
    "counted",
    "examples_of",
    "rules_of",
    "standings",
    "varied_of",
]

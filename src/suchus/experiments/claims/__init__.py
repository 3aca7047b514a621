"""Rules of all experiments by claim, and how many of their verdicts are evidence."""

from suchus.experiments.claims.counting import EvidenceCount, Standing, count_evidence, standings
from suchus.experiments.claims.table import RULES, UNRULED, design_sweep_of, rules_of

__all__ = [
    "RULES",
    "UNRULED",
    "EvidenceCount",
    "Standing",
    "count_evidence",
    "design_sweep_of",
    "rules_of",
    "standings",
]

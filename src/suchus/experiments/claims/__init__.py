"""Rules of all experiments by claim, claims of experiments, and how many of their verdicts are evidence."""

from suchus.experiments.claims.counting import EvidenceCount, Standing, count_evidence, standings
from suchus.experiments.claims.table import (
    RULES,
    UNRULED,
    check_claims,
    claims_of,
    design_sweep_of,
    known_claims,
    rules_of,
)

__all__ = [
    "RULES",
    "UNRULED",
    "EvidenceCount",
    "Standing",
    "check_claims",
    "claims_of",
    "count_evidence",
    "design_sweep_of",
    "known_claims",
    "rules_of",
    "standings",
]

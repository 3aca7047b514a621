"""Many runs: what varies and what is measured; a job of batches, see ``suchus.core.jobs``.

The page of the claims, ``study.claims_page``, is asked for by its own name: batches need no figures.
"""

from suchus.experiments.study.arm import Arm
from suchus.experiments.study.chunk import run_chunk
from suchus.experiments.study.claims import Claims, answer_finished, conduct_claims
from suchus.experiments.study.conduct import conduct, conducted
from suchus.experiments.study.measures import MEASURES
from suchus.experiments.study.page import read_study
from suchus.experiments.study.plan import Plan
from suchus.experiments.study.study import Study, Vary

__all__ = [
    "MEASURES",
    "Arm",
    "Claims",
    "Plan",
    "Study",
    "Vary",
    "answer_finished",
    "conduct",
    "conduct_claims",
    "conducted",
    "read_study",
    "run_chunk",
]

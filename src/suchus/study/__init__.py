"""Many runs: what varies and what is measured; a job of batches, see ``suchus.jobs``.

The page of the claims, ``study.claims_page``, is asked for by its own name: batches need no figures.
"""

from suchus.study.arm import Arm
from suchus.study.chunk import run_chunk
from suchus.study.claims import Claims, answer_finished, conduct_claims
from suchus.study.conduct import conduct, conducted
from suchus.study.measures import MEASURES
from suchus.study.page import read_study
from suchus.study.plan import Plan
from suchus.study.study import Study, Vary

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

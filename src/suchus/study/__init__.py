"""Many runs: what varies, what is measured, and a store that a kill cannot spoil.

The page of the claims, ``study.claims_page``, is asked for by its own name: batches need no figures.
"""

from suchus.study.arm import Arm
from suchus.study.chunk import run_chunk
from suchus.study.claims import Claims, answer_finished, conduct_claims
from suchus.study.cluster import NoCluster, at_scheduler, connected
from suchus.study.conduct import StudyProgress, conduct, conducted
from suchus.study.measures import MEASURES
from suchus.study.page import read_study
from suchus.study.plan import Plan
from suchus.study.store import Store
from suchus.study.study import Study, Vary
from suchus.study.sweep import conduct_sweep

__all__ = [
    "MEASURES",
    "Arm",
    "Claims",
    "NoCluster",
    "Plan",
    "Store",
    "Study",
    "StudyProgress",
    "Vary",
    "answer_finished",
    "at_scheduler",
    "conduct",
    "conduct_claims",
    "conduct_sweep",
    "conducted",
    "connected",
    "read_study",
    "run_chunk",
]

"""The atlas: published data of flows around bodies, many of which move, beside the results of the flow solver.

A ``Case`` is a flow that is computed once; an ``AtlasRow`` is one published data set that it is compared with. The
bound of a row follows from the scatter of its sources, before anything is computed.
"""

from suchus.atlas.case import AtlasRow, Case, Curves, PublishedCurves, RunEffort, bound, published
from suchus.atlas.comparison import CurveComparison, compare, rms_over_peak
from suchus.atlas.marching import refined
from suchus.atlas.outcome import (
    FlowOutcome,
    compute,
    compute_all,
    digest_of,
    finished_outcome,
    load_outcome,
    save_outcome,
)
from suchus.atlas.rows import CASES, GROUPS, LONGEST, ROWS, chosen
from suchus.atlas.skin import WallValues, read_skin

__all__ = [
    "CASES",
    "GROUPS",
    "LONGEST",
    "ROWS",
    "AtlasRow",
    "Case",
    "CurveComparison",
    "Curves",
    "FlowOutcome",
    "PublishedCurves",
    "RunEffort",
    "WallValues",
    "bound",
    "chosen",
    "compare",
    "compute",
    "compute_all",
    "digest_of",
    "finished_outcome",
    "load_outcome",
    "published",
    "read_skin",
    "refined",
    "rms_over_peak",
    "save_outcome",
]

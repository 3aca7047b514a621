"""The atlas: published data of flows around bodies, many of which move, beside the results of the flow solver.

A ``Case`` is a flow that is computed once; an ``AtlasRow`` is one published data set that it is compared with. The
bound of a row follows from the scatter of its sources, before anything is computed.
"""

from evidence.atlas.case import AtlasRow, Case, Curves, PublishedCurves, RunEffort, bound, published
from evidence.atlas.comparison import CurveComparison, compare, rms_over_peak
from evidence.atlas.convergence import GRIDS, GridConvergence, grid_convergence, row_convergence
from evidence.atlas.marching import refined
from evidence.atlas.outcome import (
    FlowOutcome,
    compute,
    compute_all,
    digest_of,
    finished_outcome,
    flow_on,
    load_outcome,
    load_outcomes,
    save_outcome,
)
from evidence.atlas.rows import CASES, GROUPS, LONGEST, ROWS, chosen
from evidence.atlas.skin import WallValues, read_skin

__all__ = [
    "CASES",
    "GRIDS",
    "GROUPS",
    "LONGEST",
    "ROWS",
    "AtlasRow",
    "Case",
    "CurveComparison",
    "Curves",
    "FlowOutcome",
    "GridConvergence",
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
    "flow_on",
    "grid_convergence",
    "load_outcome",
    "load_outcomes",
    "published",
    "read_skin",
    "refined",
    "rms_over_peak",
    "row_convergence",
    "save_outcome",
]

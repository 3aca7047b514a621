"""The search for better gaits and bodies: CMA-ES on the land simulation, a generation in one batch."""

from suchus.optimise.aims import AIMS, LIMITS
from suchus.optimise.clearance import clearance
from suchus.optimise.conduct import optimise
from suchus.optimise.ready import READY
from suchus.optimise.results import write_results
from suchus.optimise.search import NoOptimiser, SearchResult
from suchus.optimise.spec import Aim, Limit, Optimisation, read_optimisation

__all__ = [
    "AIMS",
    "LIMITS",
    "READY",
    "Aim",
    "Limit",
    "NoOptimiser",
    "Optimisation",
    "SearchResult",
    "clearance",
    "optimise",
    "read_optimisation",
    "write_results",
]

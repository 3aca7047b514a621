"""The search for better gaits and bodies: CMA-ES on the land simulation, a generation in one batch."""

from suchus.experiments.optimise.aims import AIMS, LIMITS
from suchus.experiments.optimise.clearance import clearance
from suchus.experiments.optimise.conduct import optimise
from suchus.experiments.optimise.ready import READY
from suchus.experiments.optimise.results import write_results
from suchus.experiments.optimise.search import NoOptimiser, SearchResult
from suchus.experiments.optimise.spec import Aim, Limit, Optimisation, read_optimisation

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

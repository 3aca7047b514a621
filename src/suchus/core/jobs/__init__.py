"""One engine for all that is many pieces of work: a study, a search, a sweep, the flow atlas, ``suchus reproduce``.

A ``Job`` is what is to be done: a function, items, and how they are called. A ``Place`` does its pieces: this process,
processes of this machine, the workers of a Dask cluster. A ``ResultStore`` keeps each result as it is finished.
``finish`` does what is missing, and the bytes are the same wherever, beside whatever and after however many stops.
"""

from suchus.core.jobs.cluster import NoCluster, at_scheduler, connected
from suchus.core.jobs.engine import ProcessCrash, Tally, finish
from suchus.core.jobs.job import InMemory, Job, PieceCrash, ResultStore
from suchus.core.jobs.made_by import LAND_SOURCES, source_versions
from suchus.core.jobs.places import IN_PROCESS, Cluster, Place, Processes, ThisProcess, place_for
from suchus.core.jobs.store import Store
from suchus.core.jobs.sweep import conduct_sweep

__all__ = [
    "IN_PROCESS",
    "LAND_SOURCES",
    "Cluster",
    "InMemory",
    "Job",
    "NoCluster",
    "PieceCrash",
    "Place",
    "ProcessCrash",
    "Processes",
    "ResultStore",
    "Store",
    "Tally",
    "ThisProcess",
    "at_scheduler",
    "conduct_sweep",
    "connected",
    "finish",
    "place_for",
    "source_versions",
]

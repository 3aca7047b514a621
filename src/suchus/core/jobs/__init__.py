"""One engine for all that is many pieces of work: a study, a search, a sweep, the flow atlas, ``suchus reproduce``.

A ``Job`` is what is to be done: a function, items, and how they are called. A ``Place`` does its pieces: this process,
processes of this machine, the workers of a Dask cluster. A ``ResultStore`` keeps each result as it is finished.
``finish`` does what is missing, and the bytes are the same wherever, beside whatever and after however many stops.
"""

from suchus.core.jobs.cluster import NoCluster, at_scheduler, connected
from suchus.core.jobs.engine import ProcessDied, Tally, finish
from suchus.core.jobs.job import Died, InMemory, Job, ResultStore
from suchus.core.jobs.made_by import MADE_BY, deciding
from suchus.core.jobs.places import HERE, Cluster, Place, Processes, ThisProcess, place_for
from suchus.core.jobs.store import Store
from suchus.core.jobs.sweep import conduct_sweep

__all__ = [
    "HERE",
    "MADE_BY",
    "Cluster",
    "Died",
    "InMemory",
    "Job",
    "NoCluster",
    "Place",
    "ProcessDied",
    "Processes",
    "ResultStore",
    "Store",
    "Tally",
    "ThisProcess",
    "at_scheduler",
    "conduct_sweep",
    "connected",
    "deciding",
    "finish",
    "place_for",
]

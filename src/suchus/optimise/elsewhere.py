"""One generation shared out among the workers of a cluster."""

from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from suchus.optimise.evaluate import Progress, evaluate
from suchus.optimise.spec import Optimisation
from suchus.study.cluster import cores, spread
from suchus.study.makers import MADE_BY, deciding

ROOMS = (*MADE_BY, *(f"optimise/{module}.py" for module in ("aims", "clearance", "evaluate", "spec")))
"""Whose code decides what a candidate reaches."""


def evaluate_on(client: Any, spec: Optimisation, shares: np.ndarray, progress: Progress | None = None) -> xr.Dataset:
    """Try candidates on a cluster, an equal share on each core; a candidate reaches the same in company as alone.

    Args:
        client: a ``distributed.Client``.
        spec: the search, of one condition.
        shares: as of ``evaluate``.
        progress: called with the share that is done.

    Returns:
        As of ``evaluate``, to the same bytes.

    Raises:
        NoCluster: the cluster was lost.
        IncompatibleRecord: a worker has other versions.
    """
    pieces = np.array_split(shares, min(len(shares), cores(client)))
    tables: dict[int, xr.Dataset] = {}
    versions = partial(deciding, rooms=ROOMS)
    for i, table in spread(partial(evaluate, spec), pieces, client, name=spec.name, versions=versions):
        tables[i] = table
        if progress is not None:
            progress(len(tables) / len(pieces))
    return xr.concat([tables[i] for i in range(len(pieces))], "candidate")

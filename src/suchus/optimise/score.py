"""From what candidates reach and break to what the search makes small."""

import numpy as np
import xarray as xr

from suchus.optimise.aims import AIMS, LIMITS
from suchus.optimise.evaluate import APART, WALKED
from suchus.optimise.spec import Limit, Optimisation

_PENALTY = 5.0  # per limit exceeded by its own size, in parts of what the start has
_REFUSED, _APART, _NEVER = 1e3, 2e3, 4e3  # ranks below all that walk, the nearer to walking the better
ACTIVE = 0.03
"""A limit that is kept by less than this part of it counts as active [-]."""


def excesses(spec: Optimisation, table: xr.Dataset) -> np.ndarray:
    """Return by which part of itself each limit is exceeded, negative where it is kept, shape (candidate, limit)."""
    rows = [over(limit, table[f"limit_{limit.name}"].values) for limit in spec.limits]
    return np.array(rows).T if rows else np.zeros((table.sizes["candidate"], 0))


def over(limit: Limit, values: np.ndarray) -> np.ndarray:
    """Return by which part of itself a limit is exceeded."""
    kind = LIMITS[limit.name]
    sign = 1.0 if kind.good == "less" else -1.0
    return np.asarray(sign * (values - limit.value) / max(abs(limit.value), 1e-9 if limit.value else kind.scale))


def allowed(spec: Optimisation, table: xr.Dataset) -> np.ndarray:
    """Tell which candidates walked and kept every limit."""
    walked = table.status.values == WALKED
    return np.asarray(walked & (excesses(spec, table) <= 0.0).all(axis=1))


def units(spec: Optimisation, start: xr.Dataset) -> np.ndarray:
    """Return what one part of each aim is: the start's own value, or 1 where it has none."""
    values = np.array([abs(float(start[f"aim_{aim.name}"][0])) for aim in spec.aims])
    return np.where(np.isfinite(values) & (values > 1e-9), values, 1.0)


def losses(spec: Optimisation, table: xr.Dataset, parts: np.ndarray) -> np.ndarray:
    """Return each aim as something to make small, in parts of the start's, shape (candidate, aim).

    Limits that are exceeded make all aims worse; what cannot walk comes after everything that does.
    """
    signs = np.array([-1.0 if AIMS[aim.name].good == "more" else 1.0 for aim in spec.aims])
    values = np.column_stack([table[f"aim_{aim.name}"].values for aim in spec.aims])
    penalty = _PENALTY * np.maximum(excesses(spec, table), 0.0).sum(axis=1)
    found = signs * values / parts + penalty[:, None]
    status, beyond = table.status.values, table.beyond.values
    worst = np.where(status == APART, _APART, np.where(np.isfinite(beyond), _REFUSED + np.minimum(beyond, 1e3), _NEVER))
    bad = (status != WALKED) | ~np.isfinite(found).all(axis=1)
    return np.where(bad[:, None], worst[:, None], found)


def score(spec: Optimisation, table: xr.Dataset, parts: np.ndarray) -> np.ndarray:
    """Return the weighted sum of all losses, shape (candidate,); the smallest is best."""
    weights = np.array([aim.weight for aim in spec.aims])
    return np.asarray(losses(spec, table, parts) @ weights)

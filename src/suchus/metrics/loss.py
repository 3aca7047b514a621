"""What a fault costs, and where the article's words for it are true."""

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus.verdict import RULES


def loss(way: xr.DataArray, intact: xr.DataArray) -> xr.DataArray:
    """Return the change of displacement against an intact run, negative where the fault costs displacement [-]."""
    return way / intact - 1.0


def says(claim: str, change: Float[np.ndarray, "*b"]) -> np.ndarray:
    """Tell where the sentence of a claim about a fault is true; nowhere for a change that is not a number.

    The bounds are those of the claim's rule, see ``verdict.rules.joint_faults``.

    Args:
        claim: key of the claim.
        change: of displacement [-].
    """
    rule = RULES[claim]
    return np.array([rule.held({rule.measure: float(one)}) for one in np.ravel(change)]).reshape(np.shape(change))

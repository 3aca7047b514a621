"""What a fault costs, and the article's words for it as bands of numbers."""

from collections.abc import Mapping
from math import inf

import numpy as np
import xarray as xr
from jaxtyping import Float

BANDS: Mapping[str, tuple[float, float]] = {
    "fault_front_yaw_limbs_only": (-inf, -1 / 2),
    "fault_front_yaw_coordinated": (-1 / 3, inf),
    "fault_hind_yaw_limbs_only": (-inf, -1 / 2),
    "fault_hind_yaw_coordinated": (-1 / 3, inf),
    "fault_front_pitch_limbs_only": (-inf, -0.9),
    "fault_front_pitch_coordinated": (-inf, -0.9),
    "fault_hind_pitch_limbs_only": (-0.7, -0.4),
    "fault_hind_pitch_coordinated": (-0.1, inf),
}
"""Claim: the changes of displacement of which its sentence is true [-].

"Costs little" is less than a third, "most" more than half, "ends forward motion" leaves less than a tenth, "about
half" is 40 to 70 %, "almost nothing" less than a tenth.
"""


def loss(way: xr.DataArray, intact: xr.DataArray) -> xr.DataArray:
    """Return the change of displacement against an intact run, negative where the fault costs way [-]."""
    return way / intact - 1.0


def says(claim: str, change: Float[np.ndarray, "*b"]) -> np.ndarray:
    """Tell where the sentence of a claim about a fault is true; nowhere for a change that is not a number.

    Args:
        claim: key of the claim.
        change: of displacement [-].
    """
    low, high = BANDS[claim]
    return np.asarray((change >= low) & (change <= high))

"""Standing or travelling: whether the joints of a body bend all at once or one after another."""

import numpy as np
from numpy.typing import ArrayLike

STANDING = 0.8
"""Index from which we speak of a standing wave [-]; a salamander's walk has 0.91, its swimming 0.08."""


def standing_index(amplitude: ArrayLike, phase: ArrayLike) -> float:
    """Return 1 for a standing wave, 0 for a travelling one: ``|sum A exp(2 i phi)| / sum A`` [-].

    Joints in antiphase count as in phase, since a standing wave may have a node. A straight line through the phases
    cannot tell the two apart: a half turn at the node looks like a lag.

    Args:
        amplitude: of the bend at each joint, of any one unit.
        phase: of the bend at each joint [rad].

    Returns:
        NaN if nothing bends.
    """
    A, phi = np.asarray(amplitude, dtype=float), np.asarray(phase, dtype=float)
    total = A.sum()
    return float(np.abs((A * np.exp(2j * phi)).sum()) / total) if total > 0 else float("nan")

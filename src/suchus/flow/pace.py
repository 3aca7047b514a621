"""When things are due: the last steps of a run, and the next look at it."""

import numpy as np

LANDING = 16
"""Steps before the end of a run over which the time step is evened out, so that the last one is no jolt [-]."""


def even(dt: float, left: float) -> float:
    """Return the step that arrives in whole steps, once the end is near [s]."""
    count = np.ceil(left / dt * (1 - 1e-9))
    return float(left / count) if count <= LANDING else dt


def due_after(time: float, every: float | None) -> float:
    """Return the next multiple of ``every`` after a time [s]; 0, which is always past, if that is None."""
    return 0.0 if every is None else float((np.floor(time / every * (1 + 1e-12)) + 1) * every * (1 - 1e-12))

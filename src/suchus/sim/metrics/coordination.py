"""How well the limbs keep the phases of their gait, and when they have found them."""

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus.robot.motion import Gait
from suchus.sim.metrics.gait import diagonals

PHASE_TOLERANCE = 0.1
"""Greatest phase error against another limb with which a limb counts as coordinated [cycle]."""


def phase_error(phase: xr.DataArray, gait: Gait) -> xr.DataArray:
    """Return how far the limbs are from the gait's phases against each other [cycle].

    It is the largest error of four differences, the two diagonal pairs and the two girdles; of any body as many as it
    has.

    Args:
        phase: phase of the limbs, with the dimension ``leg`` [cycle].
        gait: gait whose phases are meant.
    """
    error = xr.apply_ufunc(greatest_phase_error, phase, kwargs={"gait": gait}, input_core_dims=[["leg"]])
    return error.rename("phase_error")


def greatest_phase_error(phase: Float[np.ndarray, "*batch leg"], gait: Gait) -> Float[np.ndarray, "*batch"]:
    """Return ``phase_error`` of phases in an array [cycle].

    Args:
        phase: phase of the limbs [cycle].
        gait: gait whose phases are meant.
    """
    target_phases, legs = gait.limb_phases, phase.shape[-1]
    pairs = [*diagonals(legs), *((i, i + 1) for i in range(0, legs, 2))]
    first_legs, second_legs = (list(column) for column in zip(*pairs, strict=True))
    target_differences = np.array([target_phases[first] - target_phases[second] for first, second in pairs])
    deviation = phase[..., first_legs] - phase[..., second_legs] - target_differences
    return np.asarray(np.fmax.reduce(np.abs(np.mod(deviation + 0.5, 1.0) - 0.5), axis=-1))


def cycles_until(
    error: xr.DataArray, period: float, *, start: float, hold: float, tolerance: float = PHASE_TOLERANCE
) -> xr.DataArray:
    """Return after how many cycles an error has come within bounds for good, infinity if it has not [cycle].

    For good: every later sample of the record is within bounds, for at least ``hold`` cycles.

    Args:
        error: error with the dimension ``time`` [cycle].
        period: period of one cycle [s].
        start: from when the cycles count [s].
        hold: least time within the tolerance until the end of the record [cycle].
        tolerance: the bounds [cycle].
    """
    cycles = (error.time - start) / period
    is_outside = (error > tolerance) & (cycles >= 0.0)
    step = float(cycles[1] - cycles[0])
    last_violation = cycles.where(is_outside).max("time") + step
    settling_cycles = last_violation.fillna(0.0)
    return settling_cycles.where(settling_cycles <= float(cycles[-1]) - hold, np.inf)

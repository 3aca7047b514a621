"""What the experiment ``feedback`` reads from its record: every number, and what decided."""

import numpy as np
import xarray as xr

from suchus.experiment import Measure
from suchus.metrics.coordination import cycles_until, phase_error
from suchus.motion import START, Gait

SHOWN = ("open", "closed", "steered")
"""The arms whose measures are named."""
_GROUP = 8
"""Random starts that are counted together, for the spread [-]."""


def start_measures(record: xr.Dataset, gait: Gait, hold: float, cycles: int) -> dict[str, Measure]:
    """Return how many starts converge, how fast and how well, and what the phases' sharing is worth.

    Args:
        record: what happened.
        gait: how they were meant to walk.
        hold: for how long a start stays to count as converged [cycle].
        cycles: how many were walked [-].
    """
    error = phase_error(record.start_phase, gait).rename(start_time="time")
    period = gait.period
    found = cycles_until(error, period, start=START, hold=hold)
    measures = {}
    for law in record.law.values:
        taken = found.sel(law=law).values
        measures[f"converged_{law}"] = Measure(float(np.isfinite(taken).mean()), "-")
        measures[f"phase_error_{law}"] = Measure(float(_ending(error.sel(law=law), hold * period).mean()), "-")
        if law in ("own_load", "cross_load", "body_limb", "closed_noisy"):
            worst = np.quantile(np.minimum(taken, cycles), 0.9)
            measures[f"cycles_to_converge_{law}"] = Measure(float(worst), "-")
    measures["cycles_to_converge"] = measures.pop("cycles_to_converge_cross_load")
    measures["converged_closed"] = measures["converged_cross_load"]
    measures["converged_open"] = measures["converged_off"]
    converged = np.isfinite(found.sel(law="cross_load").values)
    shares = [float(group.mean()) for group in np.array_split(converged, max(converged.size // _GROUP, 1))]
    measures["converged_cross_load_low"] = Measure(min(shares), "-")
    measures["converged_cross_load_high"] = Measure(max(shares), "-")
    distances = _ending(record.start_way.rename(start_time="time"), hold * period)
    distances = (distances.isel(time=-1) - distances.isel(time=0)) / hold
    for name, law in (("shared", "closed_noisy"), ("isolated", "isolated_noisy")):
        measures[f"way_{name}"] = Measure(float(distances.sel(law=law).mean()), "m")
        measures[f"way_{name}_least"] = Measure(float(distances.sel(law=law).min()), "m")
        measures[f"way_{name}_most"] = Measure(float(distances.sel(law=law).max()), "m")
    return measures


def disturbed_measures(record: xr.Dataset, gait: Gait, hold: float, after: int) -> dict[str, Measure]:
    """Return distances and turns after each disturbance, and what the rules make of them.

    Args:
        record: what happened.
        gait: how they walked; the disturbance comes after one cycle.
        hold: for how long phases stay to count as recovered, at most [cycle].
        after: how many cycles were walked after it [-].
    """
    at = START + gait.period
    part = record.sel(time=slice(at - 1e-9, None))
    change = part.isel(time=-1) - part.isel(time=0)
    moved = {(d, a): change.sel(disturbance=d, arm=a) for d in record.disturbance.values for a in record.arm.values}
    distance = {key: float(value.x) for key, value in moved.items()}
    measures = {}
    for name in record.disturbance.values:
        for arm in SHOWN:
            measures[f"recovery_{name}_{arm}"] = Measure(distance[name, arm], "m")
            measures[f"heading_{name}_{arm}"] = Measure(float(moved[name, arm].heading), "rad")
    error = phase_error(record.limb_phase.sel(disturbance="kick", arm="closed"), gait)
    back = float(cycles_until(error, gait.period, start=at, hold=min(hold, 0.5)))
    shares = {
        "kick_kept_open": distance["kick", "open"] / distance["none", "open"],
        "kick_kept_closed": distance["kick", "closed"] / distance["none", "closed"],
        "cycles_after_kick": min(back, float(after)),
        "locked_spine_loss_open": 1.0 - distance["locked_spine", "open"] / distance["none", "open"],
        "locked_spine_loss_closed": 1.0 - distance["locked_spine", "closed"] / distance["none", "open"],
        "locked_spine_loss_of_own": 1.0 - distance["locked_spine", "closed"] / distance["none", "closed"],
        "uphill_gain_closed": distance["uphill", "closed"] / distance["uphill", "open"] - 1.0,
    }
    if ("uphill", "tail") in distance:
        shares["uphill_gain_tail"] = distance["uphill", "tail"] / distance["uphill", "open"] - 1.0
    measures |= {name: Measure(value, "-") for name, value in shares.items()}
    last = part.heading.sel(time=part.time[-1] - gait.period, method="nearest")
    turning = (part.heading.isel(time=-1) - last).sel(disturbance="limp_yaw")
    for arm in SHOWN:
        drift = float(moved["other_side", arm].y - moved["side_slope", arm].y) / 2
        measures[f"drift_side_slope_{arm}"] = Measure(drift, "m")
        measures[f"turning_limp_yaw_{arm}"] = Measure(float(turning.sel(arm=arm)), "rad")
    return measures | _undisturbed_measures(record, gait) | _loop_measures(part, gait)


def _loop_measures(part: xr.Dataset, gait: Gait) -> dict[str, Measure]:
    """Return how well the loops of spine and tail hold what they control, from the disturbance on."""
    stuck = part.lacking.sel(disturbance="locked_spine")
    first = part.time[0] + gait.period
    missing = {arm: _rms(_ending(stuck.sel(arm=arm), gait.period)) for arm in ("open", "spine")}
    begun = _rms(stuck.sel(arm="spine", time=slice(None, first)))
    found = {
        "spine_lacking_open": Measure(missing["open"], "rad"),
        "spine_lacking_spine": Measure(missing["spine"], "rad"),
        "spine_lacking_growth": Measure(missing["spine"] / begun, "-"),
    }
    if "tail_load" not in part:
        return found
    uphill = part.sel(disturbance="uphill")
    load = {arm: abs(float(_ending(uphill.tail_load.sel(arm=arm), gait.period).mean())) for arm in ("open", "tail")}
    pitch = uphill.tail_pitch.sel(arm="tail")
    before = pitch.sel(time=slice(None, float(pitch.time[-1]) - gait.period))
    drift = abs(float(_ending(pitch, gait.period).mean() - _ending(before, gait.period).mean()))
    return found | {
        "tail_load_open": Measure(load["open"], "N m"),
        "tail_load_tail": Measure(load["tail"], "N m"),
        "tail_pitch_drift": Measure(drift, "rad"),
    }


def _undisturbed_measures(record: xr.Dataset, gait: Gait) -> dict[str, Measure]:
    """Return what the rules do to a robot whose phases are right, over the first two cycles."""
    part = record.sel(time=slice(START - 1e-9, START + 2 * gait.period + 1e-9), disturbance="none")
    change = part.isel(time=-1) - part.isel(time=0)
    distance = {arm: float(change.x.sel(arm=arm)) for arm in record.arm.values}
    clock = change.limb_phase.mean("leg")
    found = {
        "distortion": Measure(abs(distance["limbs"] / distance["open"] - 1.0), "-"),
        "kept_undisturbed_spine": Measure(distance["spine"] / distance["open"], "-"),
        "way_gained": Measure(distance["closed"] / distance["open"] - 1.0, "-"),
        "clock_closed": Measure(float(clock.sel(arm="closed")) / float(clock.sel(arm="open")), "-"),
    }
    if "tail_pitch" not in record:
        return found
    pitch = record.tail_pitch.sel(arm="closed").isel(time=-1)
    return found | {
        "kept_undisturbed_tail": Measure(distance["tail"] / distance["open"], "-"),
        "tail_pitch_level": Measure(float(pitch.sel(disturbance="none")), "rad"),
        "tail_pitch_uphill": Measure(float(pitch.sel(disturbance="uphill")), "rad"),
    }


def _ending(values: xr.DataArray, seconds: float) -> xr.DataArray:
    return values.sel(time=slice(float(values.time[-1]) - seconds - 1e-9, None))


def _rms(values: xr.DataArray) -> float:
    return float((values**2).mean() ** 0.5)

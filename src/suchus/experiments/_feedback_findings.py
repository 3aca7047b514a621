"""What the experiment ``feedback`` reads from its record: every number, and a verdict on each claim."""

from collections.abc import Mapping
from math import degrees

import numpy as np
import xarray as xr

from suchus.experiment import Measure, Verdict, judge
from suchus.metrics.coordination import cycles_until, phase_error
from suchus.motion import START, Gait

SHOWN = ("open", "closed", "steered")
"""The arms whose measures are named."""


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
    ways = _ending(record.start_way.rename(start_time="time"), hold * period)
    ways = (ways.isel(time=-1) - ways.isel(time=0)) / hold
    for name, law in (("shared", "closed_noisy"), ("isolated", "isolated_noisy")):
        measures[f"way_{name}"] = Measure(float(ways.sel(law=law).mean()), "m")
        measures[f"way_{name}_least"] = Measure(float(ways.sel(law=law).min()), "m")
    return measures


def disturbed_measures(record: xr.Dataset, gait: Gait, hold: float, after: int) -> dict[str, Measure]:
    """Return ways and turns after each disturbance, and what the rules make of them.

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
    way = {key: float(value.x) for key, value in moved.items()}
    measures = {}
    for name in record.disturbance.values:
        for arm in SHOWN:
            measures[f"recovery_{name}_{arm}"] = Measure(way[name, arm], "m")
            measures[f"heading_{name}_{arm}"] = Measure(float(moved[name, arm].heading), "rad")
    error = phase_error(record.limb_phase.sel(disturbance="kick", arm="closed"), gait)
    back = float(cycles_until(error, gait.period, start=at, hold=min(hold, 0.5)))
    shares = {
        "kick_kept_open": way["kick", "open"] / way["none", "open"],
        "kick_kept_closed": way["kick", "closed"] / way["none", "closed"],
        "cycles_after_kick": min(back, float(after)),
        "locked_spine_loss_open": 1.0 - way["locked_spine", "open"] / way["none", "open"],
        "locked_spine_loss_closed": 1.0 - way["locked_spine", "closed"] / way["none", "open"],
        "locked_spine_loss_of_own": 1.0 - way["locked_spine", "closed"] / way["none", "closed"],
        "uphill_gain_tail": way["uphill", "tail"] / way["uphill", "open"] - 1.0,
        "uphill_gain_closed": way["uphill", "closed"] / way["uphill", "open"] - 1.0,
    }
    measures |= {name: Measure(value, "-") for name, value in shares.items()}
    last = part.heading.sel(time=part.time[-1] - gait.period, method="nearest")
    turning = (part.heading.isel(time=-1) - last).sel(disturbance="limp_yaw")
    for arm in SHOWN:
        drift = float(moved["other_side", arm].y - moved["side_slope", arm].y) / 2
        measures[f"drift_side_slope_{arm}"] = Measure(drift, "m")
        measures[f"turning_limp_yaw_{arm}"] = Measure(float(turning.sel(arm=arm)), "rad")
    return measures | _undisturbed_measures(record, gait)


def verdicts(measures: Mapping[str, Measure]) -> tuple[Verdict, ...]:
    """Return what became of the article's claims."""
    m = {name: measure.value for name, measure in measures.items()}
    stable = m["converged_cross_load"] >= 0.95 and m["converged_wrong_sign"] < 0.05 and m["distortion"] <= 0.03
    return (
        judge(
            "feedback_rules",
            m["converged_cross_load"],
            f"From random limb phases {m['converged_cross_load']:.0%} find the gait, 90 % of them within "
            f"{m['cycles_to_converge']:.1f} cycles; {m['converged_off']:.0%} without feedback, "
            f"{m['converged_own_load']:.0%} if every limb feels its own foot alone. From the right phases the way "
            f"changes by {m['way_gained']:+.1%}. A stuck spine joint costs {m['locked_spine_loss_closed']:.0%} of the "
            f"way instead of {m['locked_spine_loss_open']:.0%}. A push still turns the robot by "
            f"{degrees(m['heading_push_closed']):.0f} degrees ({degrees(m['heading_push_open']):.0f} without feedback) "
            f"and a limp front yaw by {degrees(m['heading_limp_yaw_closed']):.0f} "
            f"({degrees(m['heading_limp_yaw_open']):.0f}).",
            holds=stable and m["locked_spine_loss_closed"] < m["locked_spine_loss_open"],
        ),
        judge(
            "shared_variables",
            m["way_shared"],
            f"After random starts a cycle's way is {m['way_shared']:.2f} m (at least {m['way_shared_least']:.2f}) "
            f"where spine and tail hear of the limbs' phases, and {m['way_isolated']:.2f} m (at least "
            f"{m['way_isolated_least']:.2f}) where each follows the clock for itself.",
            holds=m["way_shared"] > m["way_isolated"] and m["way_shared_least"] > m["way_isolated_least"],
        ),
    )


def _undisturbed_measures(record: xr.Dataset, gait: Gait) -> dict[str, Measure]:
    """Return what the rules do to a robot whose phases are right, over the first two cycles."""
    part = record.sel(time=slice(START - 1e-9, START + 2 * gait.period + 1e-9), disturbance="none")
    change = part.isel(time=-1) - part.isel(time=0)
    way = {arm: float(change.x.sel(arm=arm)) for arm in record.arm.values}
    clock = change.limb_phase.mean("leg")
    pitch = record.tail_pitch.sel(arm="closed").isel(time=-1)
    return {
        "distortion": Measure(abs(way["limbs"] / way["open"] - 1.0), "-"),
        "way_gained": Measure(way["closed"] / way["open"] - 1.0, "-"),
        "clock_closed": Measure(float(clock.sel(arm="closed")) / float(clock.sel(arm="open")), "-"),
        "tail_pitch_level": Measure(float(pitch.sel(disturbance="none")), "rad"),
        "tail_pitch_uphill": Measure(float(pitch.sel(disturbance="uphill")), "rad"),
    }


def _ending(values: xr.DataArray, seconds: float) -> xr.DataArray:
    return values.sel(time=slice(float(values.time[-1]) - seconds - 1e-9, None))

"""What the experiment ``terrain`` reads from its record: every number, and what decided."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from suchus.experiment import Measure

FALLEN = np.radians(60)
"""Roll or pitch beyond which nothing on the robot brings it back [rad]."""
ROUGH = 0.03
"""Least height of what counts as rough ground for the article's robot [m]: a third of the legs' hip height in the
sprawled crawl is less. For others it is in proportion to their length."""
_EVEN = 1e-9  # [m]; heights that differ by less are equal
SINGLE = ("low_crawl", "semi_erect", "high_walk", "high_walk_level")
"""Arms that keep one posture."""
_COMPARED = ("low_crawl", "high_walk_level")


def measures(record: xr.Dataset) -> Mapping[str, Measure]:
    """Return every number of the experiment, from its record."""
    rough = record.isel(ground=np.flatnonzero(record.height.values >= ROUGH * float(record.size_of_robot) - _EVEN))
    found: dict[str, Measure] = {}
    for arm in record.arm.values:
        one = record.sel(arm=arm)
        flat = one.isel(ground=0, seed=0)
        found |= {
            f"flat_forward_{arm}": Measure(float(flat.forward), "m"),
            f"flat_cost_{arm}": Measure(float(flat.cost), "-"),
            f"falls_{arm}": Measure(float(one.fell.sum()), "-"),
            f"falls_rough_{arm}": Measure(float(rough.fell.sel(arm=arm).sum()), "-"),
            f"belly_{arm}": Measure(float(one.belly.mean()), "-"),
            f"aside_{arm}": Measure(float(abs(one.aside).mean()), "m"),
        }
        for kind in dict.fromkeys(record.kind.values):
            covered = one.isel(ground=np.flatnonzero((record.kind.values == kind) & (record.height.values > 0)))
            found[f"kept_{kind}_{arm}"] = Measure(float(covered.forward.mean() / flat.forward), "-")
            found[f"met_{kind}_{arm}"] = Measure(float(covered.met.mean()), "-")
    low = record.isel(ground=np.flatnonzero(record.height.values <= 0.04 * float(record.size_of_robot) + _EVEN))
    share = _share_of_best(record)
    return found | {
        **_flat(record),
        **_rough(rough),
        "switching_share_of_best_worst": Measure(float(share.min()), "-"),
        "switching_worst_height": Measure(float(record.height[int(share.argmin("ground"))]), "m"),
        "switching_grounds_within_5_percent": Measure(float((share >= 0.95).sum()), "-"),
        "grounds": Measure(float(record.sizes["ground"]), "-"),
        "switching_falls_up_to_40_mm": Measure(float(low.fell.sel(arm="switching").sum()), "-"),
        **_transitions(record),
    }


def _flat(record: xr.Dataset) -> dict[str, Measure]:
    """Return what the crawl costs on even ground, of what the high walk costs, over the repeats with noise."""
    cost = record.isel(ground=0).cost
    ratio = cost.sel(arm="low_crawl") / cost.sel(arm="high_walk")
    return {
        "flat_cost_ratio": Measure(float(ratio[0]), "-"),
        "flat_cost_ratio_low": Measure(float(ratio.min()), "-"),
        "flat_cost_ratio_high": Measure(float(ratio.max()), "-"),
    }


def _rough(rough: xr.Dataset) -> dict[str, Measure]:
    """Return on which share of the rough grounds erect legs get farther; no number where anybody met too little."""
    met = float(rough.met.sel(arm=list(_COMPARED)).mean("seed").min()) if rough.sizes["ground"] else 0.0
    ahead = (rough.forward.sel(arm="high_walk_level") > rough.forward.sel(arm="low_crawl")).mean("ground")
    distance = rough.forward.mean("seed")
    crawl, semi, erect, level = (distance.sel(arm=arm) for arm in SINGLE)
    met_enough = met >= 1.0
    return {
        "met_judged": Measure(met, "-"),
        "rough_grounds": Measure(float(rough.sizes["ground"]), "-"),
        "rough_runs": Measure(float(rough.sizes["ground"] * rough.sizes["seed"]), "-"),
        "erect_ahead_share": Measure(float((level > crawl).mean()) if met_enough else float("nan"), "-"),
        "erect_ahead_share_low": Measure(float(ahead.min()) if met_enough else float("nan"), "-"),
        "erect_ahead_share_high": Measure(float(ahead.max()) if met_enough else float("nan"), "-"),
        "erect_open_loop_ahead_share": Measure(float((erect > crawl).mean()), "-"),
        "semi_erect_ahead_of_both_share": Measure(float(((semi > level) & (semi > crawl)).mean()), "-"),
    }


def _transitions(record: xr.Dataset) -> dict[str, Measure]:
    """Return how many transitions stay upright, and how far the robot walks after them at least."""
    return {
        "transitions": Measure(float(record.change_tilt.size), "-"),
        "transitions_upright": Measure(float((record.change_tilt < FALLEN).mean()), "-"),
        "transition_after_least": Measure(float(record.change_after.min()), "m"),
        **{
            f"transition_tilt_{surface}": Measure(float(record.change_tilt.sel(surface=surface).max()), "rad")
            for surface in record.surface.values
        },
        "transition_tilt": Measure(float(record.change_tilt.max()), "rad"),
    }


def _share_of_best(record: xr.Dataset) -> xr.DataArray:
    """Return the displacement of the switching robot over that of the best single posture, by ground [-]."""
    distance = record.forward.mean("seed")
    return distance.sel(arm="switching", drop=True) / distance.sel(arm=list(SINGLE)).max("arm")

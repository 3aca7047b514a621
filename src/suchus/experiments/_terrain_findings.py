"""What the experiment ``terrain`` reads from its record: every number, and a verdict on each claim."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from suchus.experiment import Measure, Verdict, judge

FALLEN = np.radians(60)
"""Roll or pitch beyond which nothing on the robot brings it back [rad]."""
_SINGLE = ("low_crawl", "semi_erect", "high_walk", "high_walk_level")


def measures(record: xr.Dataset) -> Mapping[str, Measure]:
    """Return every number of the experiment, from its record."""
    found: dict[str, Measure] = {}
    for arm in record.arm.values:
        one = record.sel(arm=arm)
        flat = one.isel(ground=0, seed=0)
        found |= {
            f"flat_forward_{arm}": Measure(float(flat.forward), "m"),
            f"flat_cost_{arm}": Measure(float(flat.cost), "-"),
            f"falls_{arm}": Measure(float(one.fell.sum()), "-"),
            f"belly_{arm}": Measure(float(one.belly.mean()), "-"),
            f"aside_{arm}": Measure(float(abs(one.aside).mean()), "m"),
        }
        for kind in dict.fromkeys(record.kind.values):
            rough = one.isel(ground=np.flatnonzero((record.kind.values == kind) & (record.height.values > 0)))
            found[f"kept_{kind}_{arm}"] = Measure(float(rough.forward.mean() / flat.forward), "-")
    low = record.isel(ground=np.flatnonzero(record.height.values <= 0.04))
    share = _share_of_best(record)
    worst = int(share.argmin("ground"))
    return found | {
        "switching_share_of_best_worst": Measure(float(share.min()), "-"),
        "switching_worst_height": Measure(float(record.height[worst]), "m"),
        "switching_grounds_within_5_percent": Measure(float((share >= 0.95).sum()), "-"),
        "grounds": Measure(float(record.sizes["ground"]), "-"),
        "switching_falls_up_to_40_mm": Measure(float(low.fell.sel(arm="switching").sum()), "-"),
        **{
            f"transition_tilt_{surface}": Measure(float(record.change_tilt.sel(surface=surface).max()), "rad")
            for surface in record.surface.values
        },
    }


def verdicts(record: xr.Dataset) -> tuple[Verdict, ...]:
    """Return what became of the article's claims, from the record."""
    flat = record.isel(ground=0, seed=0)
    cost = float(flat.cost.sel(arm="low_crawl") / flat.cost.sel(arm="high_walk"))
    rough = record.isel(ground=np.flatnonzero(record.height.values >= 0.03))
    way, fell = rough.forward.mean("seed"), rough.fell.sum(["ground", "seed"])
    crawl, erect = way.sel(arm="low_crawl").values, way.sel(arm="high_walk").values
    level, semi = way.sel(arm="high_walk_level").values, way.sel(arm="semi_erect").values
    ahead, n, runs = float((level > crawl).mean()), len(crawl), rough.sizes["ground"] * rough.sizes["seed"]
    upright = float((record.change_tilt < FALLEN).mean())
    return (
        judge(
            "crawl_structure_flat",
            cost,
            f"On even ground the crawl costs {cost:.2f} of the high walk's work per way, at about its speed.",
            holds=cost < 1.0,
        ),
        judge(
            "erect_structure_rough",
            ahead,
            f"With the IMU. Of {n} grounds 30 mm and rougher the erect walk that answers the IMU gets farther "
            f"than the crawl on {int((level > crawl).sum())}, falling {int(fell.sel(arm='high_walk_level'))} times "
            f"in {runs} runs; open loop on {int((erect > crawl).sum())}, falling {int(fell.sel(arm='high_walk'))} "
            f"times. Semi-erect legs beat both structures on {int((semi > np.maximum(level, crawl)).sum())}.",
            holds=bool(ahead > 0.5 and fell.sel(arm="high_walk_level") <= fell.sel(arm="low_crawl")),
        ),
        judge(
            "switches_structure",
            upright,
            f"{record.change_tilt.size} transitions out of one walk into another, 3.5 s each, on even ground and "
            f"bumps of 30 mm: {100 * upright:.0f} % upright, with tilts up to "
            f"{np.degrees(float(record.change_tilt.max())):.0f} degrees.",
            holds=upright == 1.0,
        ),
    )


def _share_of_best(record: xr.Dataset) -> xr.DataArray:
    """Return the way of the switching robot over that of the best single posture, by ground [-]."""
    way = record.forward.mean("seed")
    return way.sel(arm="switching", drop=True) / way.sel(arm=list(_SINGLE)).max("arm")

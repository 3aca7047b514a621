"""What the experiment ``bipedal_reach`` reads from its record: every number, and a verdict on each claim."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from suchus.design import Crocodile
from suchus.experiment import Measure, Verdict, judge
from suchus.kinematics.mass import cantilever_torque
from suchus.metrics import held, peak_torque
from suchus.motion import Gait
from suchus.motion.rising import LEAD, stretched
from suchus.paper import CLAIMS


def measures(record: xr.Dataset, robot: Crocodile, least: float) -> dict[str, Measure]:
    """Return every number of the experiment.

    Args:
        record: what happened.
        robot: who stood up.
        least: reach that counts as standing [m].
    """
    start, at, up, leave, down, _ = record.attrs["stages"]
    height, margin = record.reach.isel(run=0), record.margin.isel(run=0)
    crawling, upright = height.sel(time=slice(start, at)), height.sel(time=slice(up, leave))
    after = height.sel(time=slice(down, None))
    crawl, stand = float(crawling.max()), float(upright.min())
    found = {
        "reach_crawl": Measure(crawl, "m"),
        "reach_standing": Measure(stand, "m"),
        "reach_ratio": Measure(stand / crawl, "-"),
        "held": Measure(float(held(height, least)), "s"),
        "margin_standing": Measure(float(margin.sel(time=slice(up, leave)).min()), "m"),
        "margin_rising": Measure(float(record.lead.isel(run=0).sel(time=slice(_lifts(height, at), up)).min()), "m"),
        "reach_after": Measure(float(after.max()), "m"),
        "way_after": Measure(
            float(record.centre_of_mass.isel(run=0).sel(xyz="x").sel(time=slice(down, None))[[0, -1]].diff("time")[0]),
            "m",
        ),
        "stretched_length": Measure(stretched(robot), "m"),
        "ceiling": Measure(float(record.ceiling.max()), "m"),
        "reach_crawl_high": Measure(float(record.crawl_reach.max()), "m"),
        "hips_at_printed_height": Measure(_hips_at(record, CLAIMS["height_crawl"].value or 0.0), "m"),
        "cantilever_torque": Measure(cantilever_torque(robot), "N m"),
    }
    for name, torque in zip(record.servo.values, peak_torque(record.isel(run=0), at, leave).values, strict=True):
        found[f"torque_rising_{name}"] = Measure(float(torque), "N m")
    for feedback in ("on", "off"):
        stays = (record.repeat_reach.sel(feedback=feedback, repeat_time=slice(up, leave)) > least).all("repeat_time")
        found[f"stays_up_{feedback}"] = Measure(float(stays.mean()), "-")
        for way in record.way.values:
            found[f"push_{way}_{feedback}"] = Measure(
                float(record.push.sel(feedback=feedback, commanded=LEAD, way=way)), "N"
            )
    for part in record.part.values:
        for pose in record.pose.values:
            found[f"gain_{part}_{pose}"] = Measure(float(record.gain.sel(part=part, pose=pose)), "-")
    return found


def verdicts(
    measures: Mapping[str, Measure], robot: Crocodile, gait: Gait, least: float, hold: float
) -> tuple[Verdict, ...]:
    """Return what became of the article's claims.

    Args:
        measures: every number of the experiment.
        robot: who stood up.
        gait: how it crawled.
        least: reach that counts as standing [m].
        hold: how long it stood [s].
    """
    m = {name: measure.value for name, measure in measures.items()}
    hips, longest = 1000 * gait.hip_height, m["stretched_length"]
    gains = {pose: [m[f"gain_{part}_{pose}"] for part in ("leg", "spine", "head")] for pose in ("crawling", "standing")}
    return (
        judge(
            "height_crawl",
            m["reach_crawl"],
            f"The top of the back, with the hips at {hips:.0f} mm; the article says neither what it measured nor "
            f"how high the hips are. The printed height takes hips at {1000 * m['hips_at_printed_height']:.0f} mm.",
        ),
        judge(
            "height_standing",
            m["reach_standing"],
            f"The snout, above {least:g} m for {m['held']:.0f} s, with trunk servos of "
            f"{robot.spine.pitch_servo.torque:g} N m; the level forebody asks for "
            f"{m['cantilever_torque']:.2f} N m. "
            f"Hind leg, spine and head in one line are {longest:.3f} m.",
            holds=m["reach_standing"] > 2 * m["reach_crawl"] and m["held"] >= 0.99 * hold,
        ),
        judge(
            "height_ratio",
            m["reach_ratio"],
            "The crawl shown is lower than the printed one, the stand almost as high; against a crawl that reaches "
            f"the printed height the ratio is {m['reach_standing'] / (CLAIMS['height_crawl'].value or 1.0):.2f}.",
            holds=m["reach_ratio"] > 2,
        ),
        judge(
            "height_from_legs",
            gains["crawling"][0],
            "Per millimetre of longer legs, with the gait's heights in proportion, the crawl reaches "
            f"{gains['crawling'][0]:.2f} mm higher; per millimetre of spine {gains['crawling'][1]:.2f}, of head "
            f"{gains['crawling'][2]:.2f} mm.",
            holds=gains["crawling"][0] > 0.25 and max(map(abs, gains["crawling"][1:])) < 0.1,
        ),
        judge(
            "height_from_spine_head_legs",
            min(gains["standing"]),
            "Per millimetre of hind leg, spine and head the stand reaches "
            f"{gains['standing'][0]:.2f}, {gains['standing'][1]:.2f} and {gains['standing'][2]:.2f} mm higher.",
            holds=min(gains["standing"]) > 0.5,
        ),
    )


def _lifts(height: xr.DataArray, since: float) -> float:
    """Return when the front has left the ground for good: the reach passes a quarter of a metre [s]."""
    late = height.sel(time=slice(since, None))
    return float(late.time[np.argmax(late.values > 0.25)])


def _hips_at(record: xr.Dataset, height: float) -> float:
    """Return the height of the hips at which a crawl reaches a height [m], by a line through those tried."""
    line = np.polyfit(record.crawl_reach.values, record.hip_height.values, 1)
    return float(np.polyval(line, height))

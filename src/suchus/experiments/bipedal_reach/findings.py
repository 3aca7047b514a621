"""What the experiment ``bipedal_reach`` reads from its record: every number, and what decides."""

import numpy as np
import xarray as xr

from suchus.experiment import Measure
from suchus.metrics import held, peak_torque
from suchus.paper import CLAIMS

_LIFTED = 0.37
"""Share of the stretched length beyond which the reach shows that the front has left the ground [-].

Lying or crawling a robot reaches a fifth of it, the trunk bent up like a cobra's two fifths and more.
"""


def measures(record: xr.Dataset) -> dict[str, Measure]:
    """Return every number of the experiment.

    Args:
        record: what happened; its attributes hold what the numbers are held against.
    """
    _, at, up, leave, down, _ = record.attrs["stages"]
    facts, height, margin = record.attrs, record.reach.isel(run=0), record.margin.isel(run=0)
    stood = float(held(height, facts["least"]))
    highest = int(np.argmax(record.crawl_reach.values))
    found = {
        **_heights(record),
        "held": Measure(stood, "s"),
        "held_share": Measure(stood / facts["hold"], "-"),
        "margin_standing": Measure(float(margin.sel(time=slice(up, leave)).min()), "m"),
        "margin_rising": Measure(least_lead(record), "m"),
        "reach_after": Measure(float(height.sel(time=slice(down, None)).max()), "m"),
        "way_after": Measure(_distance(record.centre_of_mass.isel(run=0), down), "m"),
        "stretched_length": Measure(facts["stretched"], "m"),
        "ceiling": Measure(float(record.ceiling.max()), "m"),
        "reach_crawl_high": Measure(float(record.crawl_reach[highest]), "m"),
        "distance_crawl_high": Measure(float(record.crawl_way[highest]), "m"),
        "hip_height": Measure(facts["hip_height"], "m"),
        "hip_height_plausible": Measure(facts["hip_height_plausible"], "m"),
        "hips_at_printed_height": Measure(_hips_at(record, CLAIMS["height_crawl"].value or 0.0), "m"),
        "cantilever_torque": Measure(facts["cantilever"], "N m"),
        "pitch_torque": Measure(facts["pitch_torque"], "N m"),
        "map_told_by_cantilever": Measure(_decided_by_torque(record), "-"),
    }
    for name, torque in zip(record.servo.values, peak_torque(record.isel(run=0), at, leave).values, strict=True):
        found[f"torque_rising_{name}"] = Measure(float(torque), "N m")
    return found | _pushes(record) | _gains(record)


def _heights(record: xr.Dataset) -> dict[str, Measure]:
    """Return the heights that are reached crawling and standing and their ratio, each with the ends of its repeats."""
    start, at, up, leave, _, _ = record.attrs["stages"]
    calm, noisy = record.reach.isel(run=0), record.repeat_reach.sel(feedback="on").rename(repeat_time="time")
    found = {}
    for end, one in (("", calm), ("_repeated_low", noisy), ("_repeated_high", noisy)):
        crawl = one.sel(time=slice(start, at)).max("time")
        stand = one.sel(time=slice(up, leave)).min("time")
        for name, unit, value in (("crawl", "m", crawl), ("standing", "m", stand), ("ratio", "-", stand / crawl)):
            found[f"reach_{name}{end}"] = Measure(float(value.max() if end == "_repeated_high" else value.min()), unit)
    return found


def _pushes(record: xr.Dataset) -> dict[str, Measure]:
    """Return whether it stays up with noise, and the smallest pushes that topple it, with feedback and without."""
    _, _, up, leave, _, _ = record.attrs["stages"]
    found = {}
    for feedback in ("on", "off"):
        reach = record.repeat_reach.sel(feedback=feedback, repeat_time=slice(up, leave))
        stays = (reach > record.attrs["least"]).all("repeat_time")
        found[f"stays_up_{feedback}"] = Measure(float(stays.mean()), "-")
        for direction in record.direction.values:
            force = record.push.sel(feedback=feedback, commanded=record.attrs["commanded_lead"], direction=direction)
            found[f"push_{direction}_{feedback}"] = Measure(float(force), "N")
    return found


def _gains(record: xr.Dataset) -> dict[str, Measure]:
    """Return by how much the heights grow with the lengths of legs, spine and head [-]."""
    found = {
        f"gain_{part}_{pose}": Measure(float(record.gain.sel(part=part, pose=pose)), "-")
        for part in record.part.values
        for pose in record.pose.values
    }
    others = record.gain.sel(pose="crawling", part=["spine", "head"])
    found["gain_others_crawling"] = Measure(float(abs(others).max()), "-")
    found["gain_least_standing"] = Measure(float(record.gain.sel(pose="standing").min()), "-")
    return found


def least_lead(record: xr.Dataset) -> float:
    """Return the least distance of the centre of mass behind the feet from lifting the front to standing [m].

    Not a number for a robot whose front does not leave the ground before it should stand.
    """
    _, at, up, *_ = record.attrs["stages"]
    rising = record.isel(run=0).sel(time=slice(at, up))
    off = np.flatnonzero(rising.reach.values > _LIFTED * record.attrs["stretched"])
    return float(rising.lead[off[0] :].min()) if off.size else float("nan")


def _distance(place: xr.DataArray, since: float) -> float:
    """Return how far a place moves forward from a time on [m]."""
    x = place.sel(xyz="x", time=slice(since, None))
    return float(x[-1] - x[0])


def _decided_by_torque(record: xr.Dataset) -> float:
    """Return for which share of the robots on the map the cantilever's torque alone decides whether they stand [-]."""
    stands = record.map_reach > record.attrs["up"]
    return float((stands == (record.torque > record.map_cantilever)).mean())


def _hips_at(record: xr.Dataset, height: float) -> float:
    """Return the height of the hips at which a crawl reaches a height [m], by a line through those tried."""
    line = np.polyfit(record.crawl_reach.values, record.hip_height.values, 1)
    return float(np.polyval(line, height))

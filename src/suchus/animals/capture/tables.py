"""What was measured of a walk as one table: every number with its interval, stride by stride and over the phase."""

import numpy as np
import xarray as xr

from suchus.animals.capture.strides import PHASES
from suchus.animals.capture.table import AngleCycle
from suchus.animals.capture.walk import Walk

_MEANINGS = {
    "duty": "share of the cycle in which the foot rests on the ground",
    "phase": "how much earlier than LF the foot is in the middle of its stance",
    "retraction": "share of the cycle in which the foot goes back along the body",
    "stroke": "half of the distance by which it goes back",
    "outward": "mean distance of the foot from the midline",
    "ahead": "mean distance by which the foot is ahead of its girdle",
    "lift": "height to which the foot is lifted",
    "step": "distance over the ground from one place of the foot to the next",
    "standing": "standing index of the bends: 1 a standing wave, 0 a travelling one",
    "stride": "distance by which the trunk goes on in one cycle, in lengths of the trunk",
    "stride_length": "distance by which the trunk goes on in one cycle",
    "trunk_length": "length of the trunk from hip to shoulder, along the points between",
    "speed": "mean speed of the trunk",
    "turning": "change of heading in one cycle, left positive",
    "period": "duration of the cycle",
    "spine_rightmost": "phase at which the trunk is bent farthest to the right",
    "tail_lag": "how much later than the trunk's the tail's bend is",
}


def tables(walk: Walk) -> xr.Dataset:
    """Return what was measured as one dataset, as ``record.write_tables`` and ``record.save`` write it.

    Over ``quantity`` stand the means with ``low``, ``high`` and ``spread``; over ``stride`` and ``leg`` each stride;
    over ``phase``, ``leg`` and ``place`` the mean cycle. What was not seen is NaN or not there.

    Args:
        walk: the measured walk.
    """
    names = list(walk.numbers)
    measurements = [walk.numbers[name] for name in names]
    value, spread, error = (np.array([measurement[i] for measurement in measurements], dtype=float) for i in range(3))
    data = xr.Dataset(coords={"quantity": ("quantity", names)})
    data["value"] = ("quantity", value, {"long_name": "over all cycles"})
    data["low"] = ("quantity", value - error, {"long_name": "lower end of the 95 % interval"})
    data["high"] = ("quantity", value + error, {"long_name": "upper end of the 95 % interval"})
    data["spread"] = ("quantity", spread, {"long_name": "standard deviation from cycle to cycle"})
    data["unit"] = (
        "quantity",
        [measurement.unit for measurement in measurements],
        {"long_name": "unit of the quantity"},
    )
    data["meaning"] = ("quantity", [_meaning(name) for name in names], {"long_name": "what it is"})
    legs = [str(leg) for leg in walk.cycle.leg.values]
    strides, phases = (
        table.reindex(leg=legs) if "leg" in table.dims else table for table in (walk.strides, walk.phases)
    )
    phase_step = walk.cycle.sizes["phase"] // phases.sizes["phase"]
    cycle = walk.cycle[["stance", "foot_speed"]].isel(phase=slice(None, None, phase_step))
    cycle["stance"] = cycle.stance.astype(int).assign_attrs(units="1", long_name="1 where the foot stands")
    cycle["foot_speed"] = cycle.foot_speed.assign_attrs(long_name="speed of the foot over the ground")
    data = xr.merge(
        [data, strides, phases, cycle.assign_coords(phase=phases.phase)], join="exact", combine_attrs="override"
    )
    data.attrs = {
        "title": f"walk measured on {walk.source}",
        "cycles": walk.cycles,
        "notes": "\n".join(walk.notes),
        "intervals": "hold the truth in 95 of 100 cases",
    }
    return data


def angle_tables(cycle: AngleCycle) -> xr.Dataset:
    """Return a table of joint angles as what it shows of each joint, over ``joint`` and ``phase``.

    Args:
        cycle: cycle as ``read_angles`` returns it.
    """
    phase, first_harmonic = np.arange(PHASES) / PHASES, cycle.harmonics[:, 1]
    data = xr.Dataset(coords={"joint": ("joint", list(cycle.joints)), "phase": ("phase", phase, {"units": "1"})})
    variables = {
        "mean": (cycle.harmonics[:, 0].real, "rad", "mean angle"),
        "amplitude": (np.abs(first_harmonic), "rad", "amplitude of the first harmonic"),
        "phase_of_peak": (
            -np.angle(first_harmonic) / (2 * np.pi) % 1.0,
            "cycle",
            "phase at which the first harmonic is greatest",
        ),
        "residual": (cycle.residual, "rad", "root mean square of what the harmonics leave of the table"),
    }
    for name, (value, unit, meaning) in variables.items():
        data[name] = ("joint", value, {"units": unit, "long_name": meaning})
    data["angle"] = (("joint", "phase"), cycle.at(phase).T, {"units": "rad", "long_name": "angle over the mean cycle"})
    data.attrs["title"] = f"joint angles of {cycle.source}"
    return data


def _meaning(name: str) -> str:
    """Return what a number of a walk is, for tables; empty for a name without an entry."""
    stem = name.partition("_")[0]
    if name in _MEANINGS:
        return _MEANINGS[name]
    if stem in ("spine", "tail"):
        region, turn = name.split("_")[:2]
        side = "right" if turn == "lateral" else "down"
        statistic = {"steady": "mean of", "overtones": "share of overtones in"}.get(
            name.rsplit("_", maxsplit=1)[-1], "amplitude of"
        )
        return f"{statistic} the {region}'s {turn} angle, {side} positive"
    return _MEANINGS.get(stem, "")

"""The kept paths of the experiment ``shore``, and the measures that are computed from them."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from jaxtyping import Bool, Float

from suchus import rotation
from suchus.design import GRAVITY
from suchus.experiment import Measure
from suchus.land import Run
from suchus.land.lake import up

FALLEN = np.radians(60)
"""Tilt of the body against gravity beyond which it has fallen [rad]."""
AFLOAT = 0.01
"""Share of the weight on the ground below which it floats free [-]."""
LAST = 2.0
"""Duration at the end over which it must float free to count as in the water [s]."""
_UNITS = {
    "ahead": ("m", "centre of mass beyond the water line, up the shore; less than 0 on the water's side"),
    "aside": ("m", "displacement of the centre of mass to the left"),
    "under": ("1", "volume under water over the whole volume"),
    "feet": ("1", "share of the weight that the feet carry"),
    "ground": ("1", "share of the weight that feet, belly and tail carry"),
    "walks": ("1", "1 where the limbs' phases advance, else 0"),
    "tilt": ("rad", "angle of the body's upward axis to the vertical"),
    "power": ("W", "power of all servos on the joints"),
}


def paths(record: xr.Dataset, runs: list[Run], every: int) -> xr.Dataset:
    """Return the kept path of each run, and how often it changed between swimming and walking.

    Args:
        record: of the runs.
        runs: on even slopes in lakes of constant level.
        every: number of samples of which one is kept; powers and shares are means over them.
    """
    ups = np.array([up(run.ground) for run in runs])
    line = np.array([water_line(run) for run in runs])
    ashore = np.sign([run.ground.uphill for run in runs])  # whether the land is ahead of the line or behind it
    shares = _ground_share(record, ups)
    walks = walking(record.limb_phase.isel(leg=0).values)
    high = rotation.rotate(record.orientation.values, np.array([0.0, 0.0, 1.0]))
    values = {
        "ahead": ashore[:, None] * (record.centre_of_mass.sel(xyz="x").values - line[:, None]),
        "aside": record.centre_of_mass.sel(xyz="y").values,
        "under": record.share_under.values,
        "feet": record.feet_share.values,
        "ground": shares,
        "walks": walks.astype(float),
        "tilt": np.arccos(np.clip(np.einsum("rti,ri->rt", high, ups), -1.0, 1.0)),
        "power": record.servo_power.values,
    }
    means = ("feet", "ground", "power")
    count = record.sizes["time"] // every
    whole = {name: value[:, : count * every].reshape(len(runs), count, every) for name, value in values.items()}
    kept = {name: value.mean(axis=-1) if name in means else value[..., 0] for name, value in whole.items()}
    found = xr.Dataset(
        {name: (("case", "moment"), kept[name], {"units": unit, "long_name": what})
         for name, (unit, what) in _UNITS.items()},
        coords={"moment": ("moment", record.time.values[: count * every : every], {"units": "s"})},
    )  # fmt: skip
    changes = np.diff(walks[:, 1:].astype(int), axis=1) != 0
    found["switches"] = ("case", changes.sum(axis=1), {"units": "1"})
    found["weight"] = ("case", GRAVITY * record.mass.values, {"units": "N"})
    return found


def water_line(run: Run) -> float:
    """Return the distance from the robot's beginning to where the surface meets the slope [m]."""
    assert run.lake is not None
    return run.lake.shore(run.ground.uphill)


def walking(phase: Float[np.ndarray, "run time"]) -> Bool[np.ndarray, "run time"]:
    """Return when a limb's phase advances; the first sample has the value of the second [-]."""
    moves = np.diff(phase, axis=1) > 1e-9
    return np.concatenate([moves[:, :1], moves], axis=1)


def _ground_share(record: xr.Dataset, ups: np.ndarray) -> np.ndarray:
    force = record.foot_force.sum("leg").values + record.belly_force.sum("segment").values + record.tail_force.values
    return np.asarray(np.einsum("rti,ri->rt", force, ups) / (GRAVITY * record.mass.values[:, None]))


def fallen(record: xr.Dataset) -> Bool[np.ndarray, " case"]:
    """Return which cases tilted too far, or diverged [-]."""
    return np.asarray(~(record.tilt < FALLEN).all("moment").values)


def times_ashore(record: xr.Dataset) -> Float[np.ndarray, " case"]:
    """Return the time at which each case was first ashore, NaN for one that never was or fell [s]."""
    reached = record.ahead.values >= record.attrs["beyond"]
    first = record.moment.values[reached.argmax(axis=1)]
    return np.where(reached.any(axis=1) & ~fallen(record), first, np.nan)


def ending(record: xr.Dataset) -> str:
    """Return how the case that is drawn ended, in words."""
    case = record.isel(case=[record.attrs["shown"]])
    walked, found = case.walks.values[0] > 0, []
    if walked.any():
        found.append(f"after {float(case.moment[walked.argmax()]):.0f} s it walks")
    else:
        found.append("it does not begin to walk")
    time = float(times_ashore(case)[0])
    if np.isfinite(time):
        found.append(f"after {time:.0f} s it is {record.attrs['beyond']:g} m beyond the water line")
    elif fallen(case)[0]:
        found.append("it falls")
    else:
        found.append(f"it does not get {record.attrs['beyond']:g} m beyond the water line")
    return ", and ".join(found)


def in_water(record: xr.Dataset) -> Bool[np.ndarray, " case"]:
    """Return which cases swim at the end on the water's side of the line and float free for the last seconds [-]."""
    end = record.sel(moment=slice(float(record.moment[-1]) - LAST, None))
    free = (end.ground.mean("moment") < AFLOAT) & (end.walks.max("moment") == 0.0)
    return np.asarray((free & (end.ahead < 0).all("moment")).values) & ~fallen(record)


def measures(record: xr.Dataset) -> dict[str, Measure]:
    """Return the measures of the experiment from its record."""
    kind = record.kind.values
    times, fell = times_ashore(record), fallen(record)
    main, into = kind == "ashore", kind == "into_water"
    ashore = times[main][np.isfinite(times[main])]
    slope, grip = record.slope.values, record.grip.values
    steep = main & np.isclose(slope, slope[main].max())
    found = {
        "ashore_share": Measure(_share(times, main), "-"),
        "falls": Measure(float(fell[main].sum()), "-"),
        "switches": Measure(float(record.switches.values[main].max()), "-"),
        "time_ashore": Measure(float(np.median(ashore)) if ashore.size else float("nan"), "s"),
        "time_ashore_longest": Measure(float(ashore.max()) if ashore.size else float("nan"), "s"),
        "into_water_share": Measure(float(in_water(record)[into].mean()), "-"),
        "falls_into_water": Measure(float(fell[into].sum()), "-"),
        "switches_into_water": Measure(float(record.switches.values[into].max()), "-"),
        "ashore_share_steepest": Measure(_share(times, steep), "-"),
        "ashore_share_least_grip": Measure(_share(times, main & np.isclose(grip, grip[main].min())), "-"),
        "ashore_share_most_grip": Measure(_share(times, main & np.isclose(grip, grip[main].max())), "-"),
    }
    for i, out in enumerate(np.unique(record.air_released.values[(kind == "air") | steep])):
        mine = ((kind == "air") | steep) & (record.air_released.values == out)
        found[f"air_released_{i}"] = Measure(float(out), "-")
        found[f"ashore_share_air_released_{i}"] = Measure(_share(times, mine), "-")
    middle = float(record.grip.values[kind == "gait"].mean()) if (kind == "gait").any() else 0.0
    for name in np.unique(record.walk.values[(kind == "gait") | main]):
        mine = (kind == "gait") & (record.walk.values == name)
        if not mine.any():
            mine = main & np.isclose(grip, middle)
        if mine.any():
            found[f"ashore_share_{name}"] = Measure(_share(times, mine), "-")
    return found | _costs(record.isel(case=np.flatnonzero(main))) | _metre_costs(record)


def _share(times: np.ndarray, mine: np.ndarray) -> float:
    return float(np.isfinite(times[mine]).mean())


def metres(record: xr.Dataset, names: Sequence[str], last: float) -> xr.Dataset:
    """Return speed along its course, power of the servos and error of the depth of each run, over its last seconds.

    Args:
        record: record with one run for each name.
        names: names of the conditions, in the order of the runs.
        last: duration of the end that is measured [s].
    """
    part = record.sel(time=slice(float(record.time[-1]) - last - 1e-9, None))
    moved = (part.centre_of_mass.isel(time=-1) - part.centre_of_mass.isel(time=0)).sel(xyz=["x", "y"])
    deep = (part.water_level - part.position.sel(xyz="z")).mean("time")
    return xr.Dataset(
        {
            "metre_speed": ("where", np.hypot(*moved.transpose("xyz", "run").values) / last, {"units": "m/s"}),
            "metre_power": ("where", part.servo_power.mean("time").values, {"units": "W"}),
            "metre_depth": ("where", deep.values, {"units": "m"}),
            "metre_weight": ("where", GRAVITY * record.mass.values, {"units": "N"}),
        },
        coords={"where": list(names)},
    )


def _metre_costs(record: xr.Dataset) -> dict[str, Measure]:
    """Return speed, work over distance and cost of transport on land, at the surface and at depth."""
    found = {}
    for where in record["where"].values:
        one = record.sel(where=where)
        speed, work = float(one.metre_speed), float(one.metre_power / one.metre_speed)
        found[f"speed_{where}"] = Measure(speed, "m/s")
        found[f"work_per_metre_{where}"] = Measure(work, "J/m")
        found[f"cost_of_transport_{where}"] = Measure(work / float(one.metre_weight), "-")
    error = abs(float(record.metre_depth.sel(where="deep")) - record.attrs["depth"])
    return found | {"depth_error": Measure(error, "m")}


def _costs(record: xr.Dataset) -> dict[str, Measure]:
    """Return speed [m/s] and work of the servos over distance [J/m] while it swims, wades and walks ashore.

    Both along its heading, which need not be straight up the shore.
    """
    step, course = float(record.moment[1] - record.moment[0]), record.attrs["approach"]
    along = np.cos(course) * record.ahead.values + np.sin(course) * record.aside.values
    speed = np.gradient(along, step, axis=1)
    walks, under = record.walks.values > 0, record.under.values
    late = (record.moment.values > 3.0)[None, :]
    found = {}
    for name, when in (
        ("swimming", ~walks & late & (record.ground.values < AFLOAT)),
        ("wading", walks & (under > 0.05)),
        ("ashore", walks & (under <= 0.0)),
    ):
        ahead, power = speed[when], record.power.values[when]
        mean = float(ahead.mean()) if ahead.size else float("nan")
        found[f"speed_{name}"] = Measure(mean, "m/s")
        found[f"work_per_metre_{name}"] = Measure(float(power.mean()) / mean if ahead.size else float("nan"), "J/m")
    return found

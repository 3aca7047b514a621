"""The swims of ``swim_free`` below the surface: pitch and depth, by place of the air and control of the pitch."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from suchus.core import rotation
from suchus.experiments.experiment import Measure, Measures
from suchus.robot.control import DepthHold, HeadingHold, PitchHold, Swimming
from suchus.robot.control.holding import neutral_air_fraction
from suchus.robot.design import Robot, with_values
from suchus.robot.design.pieces import chambers
from suchus.robot.motion import Gait, cycle_targets
from suchus.sim.land import Lake, Run
from suchus.sim.land.afloat import hovers
from suchus.sim.metrics import settled_mean, whole_cycles
from suchus.sim.model.hydrostatics import hydrostatics

DIVE_LABELS = {
    "deep": "chambers as designed", "held": "the same, pitch held", "pitched": "the same, dives by pitch",
    "in_foam": "air in the foam",
}  # fmt: skip
"""Labels of the swims by name."""
DEPTH_TOLERANCE = 0.05
"""Greatest distance from the depth at which a dive counts as finished [m]."""
_DIVE = 1.0
"""Pitch of the swim that dives by pitch, over its height above the depth [rad/m]."""


def deep_runs(robot: Robot, gait: Gait, lake: Lake, depth: float) -> list[Run]:
    """Return swims that dive from the surface to a depth; none if the robot has not the air to hover.

    Args:
        robot: robot that swims.
        gait: gait in which it swims.
        lake: lake in which it swims.
        depth: depth of its root below the level [m].
    """
    if not hovers(robot, lake):
        return []
    plain = Swimming(heading=HeadingHold(), depth=DepthHold(depth=depth))
    cases: dict[str, tuple[Robot, Swimming]] = {"deep": (robot, plain)}
    if min(chambers(robot)) > 0.0:
        cases["held"] = robot, replace(plain, pitch=PitchHold())
        cases["pitched"] = robot, replace(plain, pitch=PitchHold(dive=_DIVE))
    if robot.hull is not None and robot.hull.chambers:
        cases["in_foam"] = with_values(robot, {"hull.chambers": ()}), plain
    return [
        Run(robot=swimmer, gait=gait, lake=lake, control=control, label=name)
        for name, (swimmer, control) in cases.items()
    ]


def dive_record(record: xr.Dataset, runs: Sequence[Run]) -> xr.Dataset:
    """Return the stored variables of the swims below the surface, by name, over their own time.

    Beside it, from statics: the pitch at which each robot hovers, straight and at rest, and how much of its air is in
    front chambers.

    Args:
        record: record of the swims.
        runs: runs of ``deep_runs``.
    """
    names = [str(label) for label in record.label.values]
    values = {
        "deep_pitch": (rotation.pitch(record.orientation.values), "rad"),
        "deep_depth": ((record.water_level - record.position.sel(xyz="z")).values, "m"),
        "deep_along": (record.centre_of_mass.sel(xyz="x").values, "m"),
        "deep_power": (record.servo_power.sum("servo", skipna=False).values, "W"),
        "deep_air_fraction": (record.air_fraction.values, "1"),
    }
    air = np.array([chambers(run.robot) for run in runs])
    statics = {
        "deep_trim": ("dive", [_hovering(run) for run in runs], {"units": "rad"}),
        "deep_front": ("dive", air[:, 0] / air.sum(axis=1), {"units": "1"}),
    }
    return xr.Dataset(
        statics | {name: (("dive", "dive_time"), series, {"units": unit}) for name, (series, unit) in values.items()},
        coords={"dive": names, "dive_time": ("dive_time", record.time.values, {"units": "s"})},
    )


def _hovering(run: Run) -> float:
    """Return the pitch of a robot that hovers in the first posture of its swim, nose down positive [rad]."""
    posture = cycle_targets(run.robot, run.gait, np.zeros(1), np.zeros(1))[0]
    return hydrostatics(run.robot, posture, air_fraction=neutral_air_fraction(run.robot), heel_count=3).trim_submerged


def measures(record: xr.Dataset) -> Measures:
    """Return of each swim below the surface its trim and mean pitch, its speed, and the greatest error of its depth.

    Beside them: how long each dive takes until it stays within ``DEPTH_TOLERANCE`` of the depth; NaN if it never does.
    """
    if "dive" not in record:
        return Measures()
    excerpt, depth = record.sel(dive_time=slice(record.attrs["deep_from"] - 1e-9, None)), record.attrs["depth"]
    dive_measures, unsettled_dives = Measures(), 0
    for name in (str(label) for label in record.dive.values):
        swim, ending = excerpt.sel(dive=name), "_deep" if name == "deep" else f"_deep_{name}"
        speed = settled_mean(_forward_speeds(record.sel(dive=name)), fallback_cycles=record.attrs["measured_cycles"])
        if not speed.is_settled:
            unsettled_dives += 1
        if name in ("deep", "in_foam"):  # rest is the same for what moves its air
            dive_measures[f"trim{ending}"] = Measure(round(float(swim.deep_trim), 9) + 0.0, "rad")
        dive_measures[f"pitch{ending}"] = Measure(float(swim.deep_pitch.mean()), "rad")
        dive_measures[f"speed{ending}"] = Measure(speed.mean, "m/s")
        dive_measures[f"depth_error{ending}"] = Measure(float(np.abs(swim.deep_depth.values - depth).max()), "m")
        far_samples = np.flatnonzero(np.abs(record.deep_depth.sel(dive=name).values - depth) > DEPTH_TOLERANCE)
        times = record.dive_time.values
        arrived = (
            0.0
            if not far_samples.size
            else float(times[far_samples[-1] + 1])
            if far_samples[-1] + 1 < len(times)
            else float("nan")
        )
        dive_measures[f"dive_time{ending}"] = Measure(arrived, "s")
    return dive_measures | {
        "front_air": Measure(float(record.deep_front[0]), "-"),
        "unsettled_dives": Measure(float(unsettled_dives), "-"),
    }


def _forward_speeds(swim: xr.Dataset) -> np.ndarray:
    """Return the mean speed of each cycle along the first heading, from rest [m/s]."""
    time, period = swim.dive_time.values.astype(float), 1.0 / swim.attrs["frequency"]
    ends = period * np.arange(whole_cycles(time, period) + 1)
    return np.asarray(np.diff(np.interp(ends, time, swim.deep_along.values)) / period)

"""One drive from the water onto the land: a pattern generator with a constant drive and a load sensor."""

from math import sin

import numpy as np
import xarray as xr

from suchus.experiments.experiment import Measure, Measures
from suchus.robot.control import LoadRule, PatternGenerator
from suchus.robot.design import Robot
from suchus.robot.design.ground import Ground
from suchus.robot.motion import START, Gait
from suchus.sim.land import Lake, Run

ARMS = ("felt", "unfelt")
"""With the sensed load, and without."""
_SETTLING_TIME = 1.0
"""Time after the start of the walk at which measuring begins; the low pass of the load has settled [s]."""
_SILENT = 0.02
"""Rate below which the limbs' clock stands still [cycle/s]; walking at the lowest drive it is six times as much."""


def runs(robot: Robot, gait: Gait, drive: float, slope: float, water_line: float) -> list[Run]:
    """Return a run towards a shore with the sensed load, and one without.

    Args:
        robot: a floating robot.
        gait: gives bends and foot paths.
        drive: drive of the oscillators, for the whole run [-].
        slope: slope of the shore [rad].
        water_line: distance of the water line ahead, along the ground [m].
    """
    return [
        Run(
            robot=robot,
            gait=gait,
            ground=Ground(uphill=slope),
            lake=Lake(level=water_line * sin(slope)),
            control=PatternGenerator(drive=drive, load=rule),
            label=arm,
        )
        for arm, rule in zip(ARMS, (LoadRule(), None), strict=True)
    ]


def reduced(record: xr.Dataset, water_line: float) -> xr.Dataset:
    """Return the stored part of these runs: distance up the shore from the water line, limb phase, load on the feet.

    Args:
        record: record of the runs, in the order of ``ARMS``.
        water_line: distance of the water line from the start, along the ground [m].
    """
    limbs = record.limb_phase.isel(leg=0, drop=True)
    distance = record.centre_of_mass.sel(xyz="x", drop=True) - water_line
    return xr.Dataset(
        {
            "shore_ahead": (("shore_arm", "shore_time"), distance.values, {"units": "m"}),
            "shore_limbs": (("shore_arm", "shore_time"), limbs.values, {"units": "1", "long_name": "[cycle]"}),
            "shore_feet": (("shore_arm", "shore_time"), record.feet_share.values, {"units": "1"}),
        },
        coords={"shore_arm": list(ARMS), "shore_time": ("shore_time", record.time.values, {"units": "s"})},
    )


def measures(record: xr.Dataset) -> Measures:
    """Return speeds afloat and ashore, number of changes between them, and the distance reached, by one drive."""
    steady_record = record.sel(shore_time=slice(START + _SETTLING_TIME - 1e-9, None))
    time, distance = steady_record.shore_time.values, steady_record.shore_ahead.sel(shore_arm="felt").values
    step = np.diff(time)
    silent = np.diff(steady_record.shore_limbs.sel(shore_arm="felt").values) / step < _SILENT
    speed = np.diff(distance) / step
    parts = {"swim": silent, "walk": ~silent}
    measures_of_arm = Measures(
        {
            f"drive_{name}_speed": Measure(float(speed[mask].mean()) if mask.any() else float("nan"), "m/s")
            for name, mask in parts.items()
        }
    )
    unfelt = steady_record.shore_ahead.sel(shore_arm="unfelt").values
    return Measures(
        measures_of_arm,
        {
            "drive_changes": Measure(float(np.count_nonzero(np.diff(silent.astype(int)))), "-"),
            "drive_afloat_share": Measure(float(silent.mean()), "-"),
            "drive_ashore": Measure(float(distance[-1]), "m"),
            "drive_ashore_unfelt": Measure(float(unfelt[-1]), "m"),
            "drive_feet_walking": Measure(
                float(steady_record.shore_feet.sel(shore_arm="felt").values[1:][~silent][-len(time) // 4 :].mean())
                if (~silent).any()
                else float("nan"),
                "-",
            ),
        },
    )

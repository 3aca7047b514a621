"""Numbers of a run that are compared with published numbers of walking salamanders."""

import csv
import io
from collections.abc import Mapping
from math import nan

import numpy as np
import xarray as xr

from suchus.animals.capture import standing_index
from suchus.article.paper.walking_salamanders import ANIMAL
from suchus.experiments.experiment import Measure, Measures
from suchus.sim.metrics import each_cycle, first_harmonic, mean_cycle
from suchus.sim.metrics.contact import contact_path
from suchus.sim.metrics.foot_forces import PARTS, Window, advance, stance_forces, step, weight

PAIRS = ("fore", "hind")


def window(record: xr.Dataset) -> Window:
    """Return the cycles of a record that are measured."""
    return Window(float(record.attrs["measured_from"]), float(record.period[0]), int(record.attrs["cycles"]))


def waves(record: xr.Dataset, cycle_window: Window) -> Measures:
    """Return the standing index of the axis, commanded and achieved [-], and the rms tracking error [rad].

    Args:
        record: of one run.
        cycle_window: start of the first cycle [s], period [s], number of cycles.
    """
    names = list(record.attrs["axis"])
    servos = [str(name) for name in record.servo.values if name in record.joint.values]
    cycle = {
        "walk": mean_cycle(record.joint_angle.sel(joint=servos), *cycle_window),
        "commanded": mean_cycle(record.servo_target.sel(servo=servos).rename(servo="joint"), *cycle_window),
    }
    measures = Measures()
    for name, angles in cycle.items():
        harmonic = first_harmonic(angles.sel(joint=names))
        measures[f"standing_index_{name}"] = Measure(standing_index(np.abs(harmonic), np.angle(harmonic)), "-")
    tracking_error = float(np.sqrt(((cycle["walk"] - cycle["commanded"]) ** 2).mean()))
    return measures | {"angle_missed": Measure(tracking_error, "rad")}


def steps(record: xr.Dataset, cycle_window: Window, stance_threshold: float) -> Measures:
    """Return forces on fore and hind feet, each the mean of left and right, and the slip of the feet.

    Args:
        record: of one run.
        cycle_window: start of the first cycle [s], period [s], number of cycles.
        stance_threshold: vertical force from which a foot stands [body weight].
    """
    force = stance_forces(record, cycle_window)
    measures = Measures()
    singles = each_cycle(record.foot_force, *cycle_window) / weight(record)
    single = ((singles**2).sum("xyz") ** 0.5).max("phase").mean("cycle")
    for pair in PAIRS:
        legs = list(record.attrs[pair])
        foot_steps = [step(force.sel(leg=leg), stance_threshold) for leg in legs]
        means = {
            component: float(np.mean([foot_step.parts[component] for foot_step in foot_steps])) for component in PARTS
        }
        measures |= {
            f"foot_force_peak_{pair}": Measure(means["vertical"], "body weight"),
            f"foot_force_net_{pair}": Measure(
                float(np.mean([foot_step.net for foot_step in foot_steps])), "body weight"
            ),
            f"foot_force_single_{pair}": Measure(float(single.sel(leg=legs).mean()), "body weight"),
            f"foot_force_sideways_{pair}": Measure(means["sideways"], "body weight"),
            f"foot_force_foreaft_{pair}": Measure(means["foreaft"], "body weight"),
            f"foot_force_time_{pair}": Measure(float(np.mean([foot_step.time for foot_step in foot_steps])), "stance"),
            f"stance_share_{pair}": Measure(float(np.mean([foot_step.stance for foot_step in foot_steps])), "cycle"),
            f"foot_slip_{pair}": Measure(_slip(record, cycle_window, legs, stance_threshold), "-"),
        }
    return measures


def _slip(record: xr.Dataset, cycle_window: Window, legs: list[str], stance_threshold: float) -> float:
    """Return the mean sliding speed of standing feet over the robot's speed [-]; NaN if none stands or it rests."""
    excerpt = record.sel(time=slice(cycle_window.start - 1e-9, cycle_window.end + 1e-9), leg=legs)
    speed = (contact_path(excerpt).sel(xyz=["x", "y"]).differentiate("time") ** 2).sum("xyz") ** 0.5
    stands = excerpt.foot_force.sel(xyz="z") > stance_threshold * weight(record)
    forward = np.hypot(*advance(record, cycle_window)) / cycle_window.period
    return float(speed.where(stands).mean()) / forward if forward > 0 and bool(stands.any()) else nan


def comparison_table(measures: Mapping[str, Measure]) -> str:
    """Return a CSV table with a row for each published number: robot, animal, standard deviation, unit, source."""
    file = io.StringIO()
    rows = csv.writer(file, lineterminator="\n")
    rows.writerow(["quantity", "robot", "animal", "standard_deviation", "unit", "animal_and_source"])
    for name, animal in ANIMAL.items():
        spread = "" if np.isnan(animal.spread) else f"{animal.spread:g}"
        rows.writerow([name, f"{measures[name].value:.4g}", f"{animal.value:g}", spread, animal.unit, animal.source])
    return file.getvalue()

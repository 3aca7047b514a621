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
from suchus.sim.metrics.foot_forces import PARTS, Window, displacement_per_cycle, stance_forces, step, weight

PAIRS = ("fore", "hind")


def window(record: xr.Dataset) -> Window:
    """Return the cycles of a record that are measured."""
    return Window(float(record.attrs["measured_from"]), float(record.period[0]), int(record.attrs["cycles"]))


def axis_wave_measures(record: xr.Dataset, cycle_window: Window) -> Measures:
    """Return how far the wave of the axis is a standing one, and how far servos are from their commands.

    The standing index [-] is that of the first harmonic of the axis' joints, of the achieved angles and of the
    commanded ones. The rms tracking error [rad] is that of the mean cycle, over all servos that drive one joint.

    Args:
        record: record of one run.
        cycle_window: start of the first cycle [s], period [s], number of cycles.
    """
    axis_joints = list(record.attrs["axis"])
    joint_servos = [str(angle_kind) for angle_kind in record.servo.values if angle_kind in record.joint.values]
    mean_cycles = {
        "walk": mean_cycle(record.joint_angle.sel(joint=joint_servos), *cycle_window),
        "commanded": mean_cycle(record.servo_target.sel(servo=joint_servos).rename(servo="joint"), *cycle_window),
    }
    measures = Measures()
    for angle_kind, angles in mean_cycles.items():
        harmonic = first_harmonic(angles.sel(joint=axis_joints))
        measures[f"standing_index_{angle_kind}"] = Measure(standing_index(np.abs(harmonic), np.angle(harmonic)), "-")
    tracking_error = float(np.sqrt(((mean_cycles["walk"] - mean_cycles["commanded"]) ** 2).mean()))
    return measures | {"angle_missed": Measure(tracking_error, "rad")}


def steps(record: xr.Dataset, cycle_window: Window, stance_threshold: float) -> Measures:
    """Return forces on fore and hind feet, each the mean of left and right, and the slip of the feet.

    Args:
        record: record of one run.
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
    forward = np.hypot(*displacement_per_cycle(record, cycle_window)) / cycle_window.period
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

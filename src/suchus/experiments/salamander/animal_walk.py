"""What is published of walking salamanders, and the numbers of a run that stand beside it."""

import csv
import io
from collections.abc import Mapping
from math import nan
from typing import NamedTuple

import numpy as np
import xarray as xr

from suchus.capture import standing_index
from suchus.design import GRAVITY
from suchus.experiment import Measure, Measures
from suchus.metrics import each_cycle, first_harmonic, mean_cycle

PAIRS = ("fore", "hind")
PARTS = ("vertical", "sideways", "foreaft")


class AnimalValue(NamedTuple):
    """A number of the animal."""

    value: float
    """In ``unit``."""
    spread: float
    """Standard deviation over trials, in ``unit``; NaN where none is published."""
    unit: str
    """``-`` for none."""
    source: str
    """Publication, or the simulation, that it is from."""


_KINEMATICS = "Pleurodeles waltl; Karakasiliotis et al. 2013, Biol. Cybern. 107, 529"
_FORCES = "Ambystoma tigrinum; computed from the public data of Kawano and Blob (FinsAndLimbs/mudskipperKinematics)"


def _force(value: float, spread: float = nan) -> AnimalValue:
    return AnimalValue(value, spread, "body weight", _FORCES)


ANIMAL: Mapping[str, AnimalValue] = {
    "standing_index_walk": AnimalValue(0.91, nan, "-", _KINEMATICS),
    "foot_force_peak_fore": _force(0.447),
    "foot_force_peak_hind": _force(0.439),
    "foot_force_net_fore": _force(0.457, 0.063),
    "foot_force_net_hind": _force(0.479, 0.070),
    "foot_force_sideways_fore": _force(0.068),
    "foot_force_sideways_hind": _force(0.071),
    "foot_force_foreaft_fore": _force(-0.028),
    "foot_force_foreaft_hind": _force(0.151),
    "foot_force_time_fore": AnimalValue(0.61, nan, "stance", _FORCES),
    "foot_force_time_hind": AnimalValue(0.33, nan, "stance", _FORCES),
}
"""Numbers of the animals by the names of the measures beside which they stand.

Forces are those at the instant of the greatest net force on one foot, means over 50 (fore) and 48 (hind) trials.
"""


class Window(NamedTuple):
    """Window of whole cycles in one run."""

    start: float
    """Time at which the first cycle begins [s]."""
    period: float
    """Period of a cycle [s]."""
    cycles: int
    """Number of cycles [-]."""

    @property
    def end(self) -> float:
        """Time at which the last cycle ends [s]."""
        return self.start + self.cycles * self.period


def window(record: xr.Dataset) -> Window:
    """Return the cycles of a record that are measured."""
    return Window(float(record.attrs["measured_from"]), float(record.period[0]), int(record.attrs["cycles"]))


def weight(record: xr.Dataset) -> float:
    """Return the weight of the robot of one run [N]."""
    return float(record.mass) * GRAVITY


def advance(record: xr.Dataset, when: Window) -> np.ndarray:
    """Return how far the centre of mass of one run comes over the ground in a cycle, forward and left [m]."""
    place = record.centre_of_mass.sel(xyz=["x", "y"]).transpose("time", "xyz").values
    first, last = (
        np.array([np.interp(t, record.time.values, column) for column in place.T]) for t in (when.start, when.end)
    )
    return np.asarray(last - first) / when.cycles


def waves(record: xr.Dataset, when: Window) -> Measures:
    """Return how far the axis bends as a standing wave, as commanded and as achieved, and how well it follows."""
    names = list(record.attrs["axis"])
    moved = [str(name) for name in record.servo.values if name in record.joint.values]
    cycle = {
        "walk": mean_cycle(record.joint_angle.sel(joint=moved), *when),
        "commanded": mean_cycle(record.servo_target.sel(servo=moved).rename(servo="joint"), *when),
    }
    found = Measures()
    for name, angles in cycle.items():
        first = first_harmonic(angles.sel(joint=names))
        found[f"standing_index_{name}"] = Measure(standing_index(np.abs(first), np.angle(first)), "-")
    missed = float(np.sqrt(((cycle["walk"] - cycle["commanded"]) ** 2).mean()))
    return found | {"angle_missed": Measure(missed, "rad")}


def stance_forces(record: xr.Dataset, when: Window) -> xr.DataArray:
    """Return the mean cycle of the force on each foot, ``phase leg part`` [body weight].

    ``vertical`` up, ``sideways`` toward the midline of the course, ``foreaft`` along the course.
    """
    force = mean_cycle(record.foot_force, *when) / weight(record)
    return _turned(force, record, when)


def _turned(force: xr.DataArray, record: xr.Dataset, when: Window) -> xr.DataArray:
    along, left = advance(record, when)
    size = np.hypot(along, left)
    c, s = (along / size, left / size) if size > 0 else (1.0, 0.0)
    x, y, z = (force.sel(xyz=one, drop=True) for one in "xyz")
    side = xr.DataArray([1.0 if str(leg).startswith("L") else -1.0 for leg in force.leg.values], dims="leg")
    parts = [z, -side * (c * y - s * x), c * x + s * y]
    return xr.concat(parts, xr.DataArray(list(PARTS), dims="part", name="part"))


class FootStep(NamedTuple):
    """What the ground does to one foot in its mean stance."""

    net: float
    """Greatest net force [body weight]."""
    parts: Mapping[str, float]
    """Its components at that instant, by ``PARTS`` [body weight]."""
    time: float
    """That instant as a share of stance [-]."""
    stance: float
    """Duration of the stance that holds it [cycle]."""


def step(force: xr.DataArray, least: float) -> FootStep:
    """Return what stands out in the force on one foot over a cycle.

    Args:
        force: of one foot, ``phase part`` [body weight].
        least: vertical force from which it stands [body weight].
    """
    parts = {name: force.sel(part=name).values for name in PARTS}
    net = np.sqrt(sum(one**2 for one in parts.values()))
    top, count = int(np.argmax(net)), len(net)
    stands = np.roll(parts["vertical"], -top) > least  # begins at the peak
    after = count if stands.all() else int(np.argmin(stands))
    before = 0 if stands.all() else int(np.argmin(stands[::-1]))
    length = min(after + before, count)
    return FootStep(
        net=float(net[top]),
        parts={name: float(one[top]) for name, one in parts.items()},
        time=before / length if length else nan,
        stance=length / count,
    )


def steps(record: xr.Dataset, when: Window, least: float) -> Measures:
    """Return the forces on fore and hind feet, the mean of left and right, and how far the feet slip."""
    force = stance_forces(record, when)
    measures = Measures()
    singles = each_cycle(record.foot_force, *when) / weight(record)
    single = ((singles**2).sum("xyz") ** 0.5).max("phase").mean("cycle")
    for pair in PAIRS:
        legs = list(record.attrs[pair])
        found = [step(force.sel(leg=leg), least) for leg in legs]
        one = {part: float(np.mean([each.parts[part] for each in found])) for part in PARTS}
        measures |= {
            f"foot_force_peak_{pair}": Measure(one["vertical"], "body weight"),
            f"foot_force_net_{pair}": Measure(float(np.mean([each.net for each in found])), "body weight"),
            f"foot_force_single_{pair}": Measure(float(single.sel(leg=legs).mean()), "body weight"),
            f"foot_force_sideways_{pair}": Measure(one["sideways"], "body weight"),
            f"foot_force_foreaft_{pair}": Measure(one["foreaft"], "body weight"),
            f"foot_force_time_{pair}": Measure(float(np.mean([each.time for each in found])), "stance"),
            f"stance_share_{pair}": Measure(float(np.mean([each.stance for each in found])), "cycle"),
            f"foot_slip_{pair}": Measure(_slip(record, when, legs, least), "-"),
        }
    return measures


def _slip(record: xr.Dataset, when: Window, legs: list[str], least: float) -> float:
    """Return the mean speed of feet that stand, over the speed of the robot [-]; NaN if none stands or it rests."""
    part = record.sel(time=slice(when.start - 1e-9, when.end + 1e-9), leg=legs)
    speed = np.sqrt((part.foot_position.sel(xyz=["x", "y"]).differentiate("time") ** 2).sum("xyz"))
    stands = part.foot_force.sel(xyz="z") > least * weight(record)
    forward = np.hypot(*advance(record, when)) / when.period
    return float(speed.where(stands).mean()) / forward if forward > 0 and bool(stands.any()) else nan


def beside(measures: Mapping[str, Measure]) -> str:
    """Return a CSV table: each published number of the animal beside the robot's."""
    file = io.StringIO()
    rows = csv.writer(file, lineterminator="\n")
    rows.writerow(["quantity", "robot", "animal", "standard_deviation", "unit", "animal_and_source"])
    for name, animal in ANIMAL.items():
        spread = "" if np.isnan(animal.spread) else f"{animal.spread:g}"
        rows.writerow([name, f"{measures[name].value:.4g}", f"{animal.value:g}", spread, animal.unit, animal.source])
    return file.getvalue()

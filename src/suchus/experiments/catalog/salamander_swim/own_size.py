"""Animals at their own length, mass and volume: how they float, and how they swim with their own waves."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.animals.forces.body import widen_body
from suchus.core import rotation
from suchus.core.progress import Progress, portion
from suchus.experiments.catalog._similar import similar
from suchus.experiments.catalog.salamander_swim.animal_swim import FREQUENCIES, animal_gait
from suchus.experiments.experiment import Measure, Measures
from suchus.robot.control import Swimming
from suchus.robot.design import Robot
from suchus.robot.design.pieces import volumes
from suchus.robot.design.scale import rescale
from suchus.robot.design.water import Water
from suchus.robot.motion import Gait, cycle_targets
from suchus.robot.robots import ROBOTS
from suchus.robot.robots._animals import catshark, eel, pleurodeles
from suchus.sim.land import Lake, Run, simulate
from suchus.sim.metrics import cycle_speeds, settled_mean, swim_numbers
from suchus.sim.model.hydrostatics import hydrostatics
from suchus.swimming.water import FilmedWave, fit, swim_of
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

ROLLOVER_HEEL = float(np.radians(90.0))
"""Heel above which a body counts as rolled over [rad]."""
_WATER_DEPTH = 4.0  # [body length]


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnSize:
    """An animal at its own size, and how it swims."""

    length: float
    """Length of the body [m]."""
    mass: float
    """Mass of the body [kg]."""
    density: float
    """Mass over volume, lungs or air included [kg/m3]."""
    frequency: float
    """Frequency of the swim [Hz]."""
    body: "Callable[[OwnSize], Robot]"
    """Makes its body."""
    swim: "Callable[[OwnSize, Robot], Gait]"
    """Makes its swim."""
    source: str
    """Where length, mass, density and swim are from."""


def _salamander(animal: OwnSize) -> Robot:
    return pleurodeles(animal.length, animal.mass, animal.density, 0.25, beat=FREQUENCIES[-1])


def _catshark(animal: OwnSize) -> Robot:
    return catshark(animal.length, animal.mass, animal.density, 1.0, 1.0, beat=animal.frequency)


def _eel(animal: OwnSize) -> Robot:
    return eel(animal.length, animal.mass, animal.density, beat=animal.frequency)


def _alligator(animal: OwnSize) -> Robot:
    """Return the article's robot with air at the size of an alligator, its axis as wide as the volume asks."""
    floating_robot = ROBOTS["floating_caiman"]
    scaled_robot = rescale(
        floating_robot,
        length_factor=animal.length / floating_robot.length,
        mass_factor=animal.mass / floating_robot.mass,
    )
    return widen_body(scaled_robot, animal.mass / animal.density)


def _filmed_gait(animal: OwnSize, robot: Robot) -> Gait:
    return animal_gait(robot, animal.frequency)


def _wave(wavelength: float, head: float, tail: float) -> Callable[[OwnSize, Robot], Gait]:
    """Return a function that makes the gait of a wave with filmed wavelength and amplitudes [body length]."""

    def make_gait(animal: OwnSize, robot: Robot) -> Gait:
        wave = FilmedWave(
            length=robot.length, frequency=animal.frequency, wavelength=wavelength, head=head, tail=tail
        )  # fmt: skip
        return fit(robot, wave, name="filmed_wave", max_misfit=0.4).gait

    return make_gait


def _robot_wave_gait(animal: OwnSize, robot: Robot) -> Gait:
    return swim_of(robot, frequency=animal.frequency)


_PLEURODELES = (
    "length, angles and density: Karakasiliotis et al. 2013, Biol. Cybern. 107, 529, public data and model of "
    "SalamandraSNN (MIT); mass: 3.0 g at 0.1 m of that model, with the cube of the length"
)
_SCYLIORHINUS = (
    "fberio/scanicula_steady_swimming (MIT): length, amplitudes and wavelength at two body lengths a second, the "
    "latter halfway between its two readings; mass: FishBase [memory]; outline from memory; the frequency is chosen"
)
_ALLIGATOR = (
    "mass: 0.3 kg at 0.46 m to 5.6 kg at 1.27 m (JEB 224, jeb242990, abstract), 2.9 kg/m3 of the cube of the length in "
    "the middle; density that of floating_caiman: lungs hold it afloat; no filmed wave could be read here, so that it "
    "is that of (20) on the robot's joints, its frequency by dynamic similarity from 1 Hz at 1 m"
)
ANIMALS: Mapping[str, OwnSize] = {
    "salamander": OwnSize(
        length=0.176, mass=0.0163, density=900.0, frequency=2.9, body=_salamander, swim=_filmed_gait,
        source=f"{_PLEURODELES}; lungs filled",
    ),
    "salamander_neutral": OwnSize(
        length=0.176, mass=0.0163, density=997.0, frequency=2.9, body=_salamander, swim=_filmed_gait,
        source=f"{_PLEURODELES}; air let out until it hovers",
    ),
    "catshark": OwnSize(
        length=0.165, mass=0.0148, density=997.5, frequency=2.5, body=_catshark,
        swim=_wave(0.8545, 0.0173, 0.0960), source=f"{_SCYLIORHINUS}; carried by its fins, and so as if neutral",
    ),
    "catshark_dense": OwnSize(
        length=0.165, mass=0.0148, density=1050.0, frequency=2.5, body=_catshark,
        swim=_wave(0.8545, 0.0173, 0.0960),
        source=f"{_SCYLIORHINUS}; without a swim bladder sharks have 1020 to 1060 kg/m3 (Bone and Roberts 1969, "
        "J. Mar. Biol. Assoc. 49, 913 [memory])",
    ),
    "eel": OwnSize(
        length=0.20, mass=0.0143, density=997.5, frequency=3.2, body=_eel, swim=_wave(0.60, 0.012, 0.069),
        source="shape: Kern and Koumoutsakos 2006, J. Exp. Biol. 209, 4841; length, amplitude, wavelength and "
        "frequency: Tytell and Lauder 2004, J. Exp. Biol. 207, 1825 [memory]; mass: that volume of water",
    ),
    "alligator_0_3": OwnSize(
        length=0.3, mass=2.9 * 0.3**3, density=950.0, frequency=1.8, body=_alligator, swim=_robot_wave_gait,
        source=_ALLIGATOR,
    ),
    "alligator_1": OwnSize(
        length=1.0, mass=2.9, density=950.0, frequency=1.0, body=_alligator, swim=_robot_wave_gait, source=_ALLIGATOR
    ),
}  # fmt: skip
"""The animals by name."""
ANIMAL_LABELS: Mapping[str, str] = {
    "salamander": "salamander with filled lungs",
    "salamander_neutral": "salamander that hovers",
    "catshark": "catshark whose fins carry it",
    "catshark_dense": "catshark at its own density",
    "eel": "eel",
    "alligator_0_3": "alligator of 0.3 m",
    "alligator_1": "alligator of 1 m",
}
"""Labels of the animals in sentences and figures."""


def swim_animals(names: Sequence[str], *, settle: int, cycles: int, progress: Progress) -> xr.Dataset:
    """Return how animals at their own size float and swim, over ``animal``.

    Each starts upright at the surface, or on the ground if it sinks, and swims.

    Args:
        names: names in ``ANIMALS``.
        settle: cycles before anything is measured [-].
        cycles: number of cycles that are measured [-].
        progress: called with the fraction that is done.
    """
    rows = [
        _swim_animal(ANIMALS[name], settle, cycles, portion(progress, i, len(names))) for i, name in enumerate(names)
    ]
    data = {
        f"own_{key}": ("animal", [row[key] for row in rows], {"units": unit}) for key, unit in _QUANTITY_UNITS.items()
    }
    return xr.Dataset(data, coords={"animal": list(names)})


_QUANTITY_UNITS = {
    "length": "m", "mass": "kg", "volume": "m3", "frequency": "Hz", "keel": "m", "trim": "rad", "vanishing": "rad",
    "speed": "m/s", "surplus": "kg", "heel": "rad", "pitch": "rad", "under": "1", "swing": "m", "missed": "rad",
    "unsettled": "1",
}  # fmt: skip


def _swim_animal(animal: OwnSize, settle: int, cycles: int, progress: Progress) -> dict[str, float]:
    """Return size, stability and swim of one animal by quantity, each in its unit of ``_QUANTITY_UNITS``.

    The swim is measured over the last ``cycles``. The speed is negative where the animal moves tail first.

    Args:
        animal: the animal at its own size.
        settle: cycles before anything is measured [-].
        cycles: measured cycles [-].
        progress: called with the fraction that is done.
    """
    robot = animal.body(animal)
    gait = animal.swim(animal, robot)
    straight = cycle_targets(robot, gait, np.arange(32) / 32).mean(axis=0)  # limbs as they are held
    flotation = hydrostatics(robot, straight)
    run = Run(
        robot=robot, gait=gait, lake=Lake(level=_WATER_DEPTH * robot.length), label=robot.name,
        control=Swimming(ramp=0.0 if gait.curves else gait.period),
    )  # fmt: skip
    record = simulate([run], duration=(settle + cycles) * gait.period, progress=progress).isel(run=0)
    excerpt = record.sel(time=slice(settle * gait.period - 1e-9, None))
    centre = excerpt.centre_of_mass.transpose("time", "xyz").values
    duration = float(excerpt.time[-1] - excerpt.time[0])
    displacement = centre[-1] - centre[0]
    facing = rotation.rotate(excerpt.orientation.transpose("time", "wxyz").values, np.array([1.0, 0.0, 0.0]))
    course = displacement[:2] / max(float(np.hypot(*displacement[:2])), 1e-12)
    lateral_offset = (excerpt.tail_tip.transpose("time", "xyz").values - centre)[:, :2] @ np.array(
        [-course[1], course[0]]
    )
    direction_sign = float(np.sign(displacement[:2] @ facing[:, :2].mean(axis=0)))
    settled = settled_mean(cycle_speeds(record, gait.period))
    names = [name for name in excerpt.servo.values if name in excerpt.joint.values]
    angle_error = excerpt.joint_angle.sel(joint=names).values - excerpt.servo_target.sel(servo=names).values
    return {
        "length": robot.length, "mass": robot.mass, "volume": sum(volumes(robot).values()),
        "frequency": gait.frequency, "keel": flotation.metacentric_height,
        "trim": flotation.trim if flotation.is_floating else flotation.trim_submerged, "vanishing": flotation.vanishing,
        "speed": direction_sign * float(np.hypot(*displacement[:2])) / duration, "surplus": flotation.surplus_mass,
        "heel": float(np.abs(rotation.heel(excerpt.orientation.values)).max()),
        "pitch": float(rotation.pitch(excerpt.orientation.values).mean()),
        "under": float(excerpt.share_under.mean()), "swing": float(np.ptp(lateral_offset)),
        "missed": float(np.sqrt((angle_error**2).mean())),
        "unsettled": float(not (settled.is_settled and settled.start <= settle)),
    }  # fmt: skip


def trim_submerged(robot: Robot) -> float:
    """Return the equilibrium pitch of a submerged robot in the mean posture of the swim, nose down positive [rad]."""
    gait = animal_gait(robot, FREQUENCIES[0])
    return hydrostatics(robot, cycle_targets(robot, gait, np.arange(32) / 32).mean(axis=0), heel_count=3).trim_submerged


def measures(record: xr.Dataset) -> Measures:
    """Return size, stability and swim of each animal; nothing if the record has none."""
    animal_measures = Measures()
    for name in record.animal.values if "animal" in record.dims else ():
        row = {key: float(record[f"own_{key}"].sel(animal=name)) for key in _QUANTITY_UNITS}
        length, frequency = row["length"], row["frequency"]
        for key in ("length", "mass", "volume", "trim", "vanishing", "heel", "pitch"):
            animal_measures[f"{key}_{name}"] = Measure(row[key], _QUANTITY_UNITS[key])
        animal_measures |= {
            f"density_{name}": Measure(row["mass"] / row["volume"], "kg/m3"),
            f"metacentric_height_{name}": Measure(row["keel"], "m"),
            f"share_under_{name}": Measure(row["under"], "-"),
            f"too_heavy_{name}": Measure(row["surplus"] / row["mass"], "-"),
            f"speed_{name}": Measure(row["speed"] / length, "body length/s"),
            f"stride_{name}": Measure(row["speed"] / frequency / length, "body length"),
            f"angle_missed_{name}": Measure(row["missed"], "rad"),
            f"unsettled_{name}": Measure(row["unsettled"], "-"),
        }
        numbers = swim_numbers(
            speed=row["speed"], length=length, frequency=frequency, swing=row["swing"], viscosity=Water().viscosity
        )
        animal_measures |= similar(numbers, f"_{name}")
    return animal_measures


def draw(record: xr.Dataset, filmed_stride: float) -> Figure:
    """Draw how far each animal comes in a cycle, and how it lies in the water.

    Args:
        record: record with ``animal``.
        filmed_stride: stride of the salamander that was filmed [body length].
    """
    names, rows = [str(name) for name in record.animal.values], np.arange(record.sizes["animal"])
    stride = (record.own_speed / record.own_frequency / record.own_length).values
    heel, pitch = np.degrees(record.own_heel.values), np.degrees(record.own_pitch.values)
    with styled():
        figure, axes = panels(1, 2, width=9.0, height=1.6 + 0.45 * len(names))
        stride_ax, angle_ax = axes[0]
        stride_ax.barh(rows, stride, color=COLOURS["coordinated"], height=0.6)
        salamanders = [i for i, name in enumerate(names) if name.startswith("salamander")]
        stride_ax.plot([filmed_stride] * len(salamanders), salamanders, "D", color=COLOURS["neutral"], label="filmed")
        stride_ax.set(
            xlabel="stride [body lengths a cycle]", yticks=rows, yticklabels=[ANIMAL_LABELS[name] for name in names]
        )
        angle_ax.barh(rows - 0.17, heel, height=0.3, color=COLOURS["coordinated"], label="greatest heel")
        angle_ax.barh(rows + 0.17, -pitch, height=0.3, color=COLOURS["neutral"], label="mean pitch, nose up positive")
        angle_ax.set(xlabel="angle [deg]", yticks=rows, yticklabels=[])
        for ax in (stride_ax, angle_ax):
            ax.invert_yaxis()
            ax.axvline(0.0, color="black", linewidth=0.6)
        if salamanders:
            stride_ax.legend(loc="lower right")
        angle_ax.legend(loc="best")
    return captioned(
        figure,
        "Animals at their own length, mass and volume, swimming with their own waves: how far they come in a cycle, "
        "and how they lie in the water meanwhile.",
    )

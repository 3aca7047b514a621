"""How does it swim in six degrees of freedom, at the surface?"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import isfinite, pi
from typing import Any, ClassVar
from warnings import warn

import numpy as np
import xarray as xr

from suchus.core import rotation
from suchus.core.checks import Checks
from suchus.core.errors import Doubtful
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.catalog._similar import similar
from suchus.experiments.catalog.swim_free import submerged
from suchus.experiments.catalog.swim_free.figure import draw_below, draw_speeds, draw_tail
from suchus.experiments.catalog.swim_free.flow_figure import draw_in_flow, film_slice
from suchus.experiments.catalog.swim_free.in_flow import (
    checkpoint_names,
    fin_runs,
    flow_measures,
    flow_runs,
    passive_joints,
    residual_text,
    swim_in_flow,
    water_of,
)
from suchus.experiments.experiment import (
    Experiment,
    Extent,
    Measure,
    Measures,
    Outcome,
    Progress,
    Replay,
    SimulationResult,
    silent,
    staged,
)
from suchus.robot.blueprint import read_correction, render
from suchus.robot.control import Swimming
from suchus.robot.design import GRAVITY, Robot, SectionCorrection, layout, with_spring, with_values
from suchus.robot.design.water import Water
from suchus.robot.motion import LIMBS_BACK, Gait, suits
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, Run, simulate
from suchus.sim.land.afloat import check_floats
from suchus.sim.land.lake import check_lake
from suchus.sim.land.waters import Form
from suchus.sim.metrics import SettledMean, cycle_speeds, settled_mean, swim_numbers, whole_cycles
from suchus.sim.record import WATER
from suchus.swimming.water import Outline, RealWaterSpeed, SpeedEstimate, real_water_speed, swim, swim_of
from suchus.swimming.water.samples import check_checkpoint_folder, checkpoint_paths
from suchus.swimming.water.sections import correction_factors
from suchus.swimming.water.slender import cruise, cycle, reactive
from suchus.visual.figures.vortices import film_vortices

MOTIONS = ("whole", "tail_only", "trunk_only", "reversed")
"""Motions that are compared, in open loop; those of a tail or a trunk alone where both bend."""
SPREAD, FASTER = "limbs_spread", "faster"
"""Further swims by the whole wave: with the limbs straight out, and with more frequent swings."""
FASTER_SWINGS = 1.25
"""Frequency of the swings of ``FASTER`` over that of the others [-]."""
_MODELS = ("resistive", "reactive")
_COEFFICIENT_FACTORS = {
    "cross_drag": (0.7, 1.5),
    "thickening": (0.5, 2.0),
    "added_mass": (0.7, 1.4),
    "shedding": (0.5, 1.5),
}
"""Plausible factors on the coefficients of the water [-]: round sections that oscillate, swimming fish, how the tail
sheds. Drag and added mass may be farther off, as ``water.sections.correction_factors`` says of the robot's sections."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SwimFree(Experiment):
    """The wave of (20) on the joints of a floating robot, in open loop: whole, tail only, trunk only and reversed.

    Two more swims by the whole wave have the limbs straight out, and swings that are a quarter more frequent.
    The robot floats, heaves, rolls, pitches and steers as the water lets it. A cable fixes the sum of its joints'
    angles only; how they share it is up to rubber and water. So the swims of a robot with cables are repeated with
    stiffer joints. All are set beside two models whose midline is commanded and cannot see this. One run steers by a
    mean bend; further runs vary each coefficient of the water over its plausible range, wide enough for the table of
    oscillating sections at the aspects and Keulegan numbers of this body, and halve the time step. Last, a robot with
    the air for it dives and swims below the surface, neutrally buoyant: with the air in the chambers of the design,
    with its pitch held or used to dive by air that moves between them, and with the air in the foam, where it lies
    without chambers.

    With ``water`` "slice" or "space" the robot swims, beside all this, in a flow that is solved with it, deep
    below the surface and, unless it is ``linked``, in its plane: the same servos, cable and passive end, but the water
    is that of the Navier-Stokes equations. ``speed_space`` is then set beside the speeds above, ``coupling_residual``
    is the force that a step left over and ``energy_error`` what is missing in the robot's balance of energy. The
    section model is held against that flow link by link and joint by joint along the motion that the robot took there.
    """

    title = "How does it swim in six degrees of freedom, at the surface?"
    shows = "Section IV.B, eq. (20); beyond the article"
    answers = (
        "speed_real_water",
        "speed_space",
        "speed_slice",
        "speed_whole",
        "speed_trunk_only",
        "speed_tail_only",
        "turn_radius",
        "servo_power",
    )
    needs = ("axis",)
    answer_minima: ClassVar[Mapping[str, float]] = {"settle": 24, "dive": 24}
    judged_minima: ClassVar[Mapping[str, float]] = {"settle": 24}

    robot: Robot = field(default_factory=lambda: ROBOTS["floating_caiman"])
    """The robot that swims; it must float."""
    reading: str = "I"
    """Letter of the reading of (20), see ``kinematics.wave.READINGS``."""
    frequency: float = 1.0
    """Frequency of the wave [Hz]."""
    stiffness: float = 2.4
    """Stiffness of the cable's joints in the further runs [N m/rad]."""
    limb_pitch: float = LIMBS_BACK[1]
    """Angle by which the limbs, which lie back along the body, point down [rad]."""
    turn: float = 0.6
    """Mean bend of the tail in the run that steers [rad]."""
    trunk_turn: float = 0.3
    """Mean bend of the trunk in that run [rad]."""
    settle: int = 36
    """Cycles that are swum before the last ``cycles`` [-]."""
    cycles: int = 12
    """Last cycles, which are measured where a swim is too short to be settled [-]; others are measured from their
    first settled cycle on."""
    spread: tuple[str, ...] = tuple(_COEFFICIENT_FACTORS)
    """Coefficients of the water that are varied."""
    extent: Extent = "whole"
    """How much swims by sections: the whole, or the motions, the swim that steers and what the verdicts need. Then
    joints are as they are, no swim is below the surface or at half the time step, nor reversed where a tail alone
    swims, and without varied coefficients the speed in real water, whose range they give, is left out."""
    level: float = 2.0
    """Depth of the water [m]."""
    depth: float = 0.6
    """Depth of the root in the swims below the surface [m]."""
    dive: int = 36
    """Cycles that are swum in those before the last ``cycles``, over which pitch and depth are measured [-]."""
    water: Form = "sections"
    """Rung of the water: "sections" alone, or beside it a flow solved with the robot, a "slice" of it or in "space"."""
    in_flow: tuple[str, ...] = ("whole", "tail_only", "whole_stiff", "tail_only_stiff")
    """Swims that are repeated in the flow, of those that the robot has; the whole wave always."""
    cells: int = 80
    """Cells per body length of the flow [-]."""
    reynolds: float = 7000.0
    """Frequency times length squared over viscosity in the flow [-], chosen for what the cells carry."""
    flow_cycles: int = 4
    """Cycles that are swum in the flow, from rest. Speeds are of the settled cycles; where there are none, of the last,
    and ``unsettled_...`` is 1 [-]."""
    correction: str = ""
    """File with factors on the section model, such as the ``correction.toml`` of a run in a flow. All swims by sections
    then have them, and a line says if they are at another Reynolds number; empty leaves the model as it is."""
    fin: tuple[float, ...] = ()
    """Stiffness of each joint of the passive end in further swims in the flow, by the whole wave: speed and cost of
    transport are drawn over it; none where it is empty [N m/rad]."""
    linked: bool = False
    """In space: whether each piece of the robot, its limbs too, is in the water as its own joints move it and the root
    goes in all six ways. Without it there is the body alone, which bends in its plane, and half of the water."""
    tail_height: float = 0.0
    """In space: height to which the last third of the tail is raised, as a fin as thick as it is; 0 for none [m]."""
    floor: float = 0.0
    """In space: depth of the lake's floor below the middle of the body, which stays in its plane; 0 is far from any
    floor [m]."""
    keep: str = ""
    """Folder in which swims in a flow, robot and water, are kept as far as they have come: an interrupted run goes on
    from there to the same bytes; empty keeps nothing."""

    def __post_init__(self) -> None:
        """Refuse settings outside their ranges, unknown swims and coefficients, and contradictory flow settings."""
        with Checks(self.name(), self) as check:
            check.number("frequency", 0.05, 10.0, "Hz")
            check.number("stiffness", 1e-9, 1e6, "N m/rad")
            check.number("limb_pitch", -pi, pi, "rad")
            check.number("turn", -pi, pi, "rad")
            check.number("trunk_turn", -pi, pi, "rad")
            check.whole("settle", 0, 1000)
            check.whole("cycles", 1, 1000)
            check.number("level", 0.3 * self.robot.length, 1000.0, "m")
            check.number("depth", 0.05 * self.robot.length, 1000.0, "m")
            check.whole("dive", 0, 1000)
            check.that(
                self.depth <= self.level - 0.2 * self.robot.length,
                f"swim_free.depth is {self.depth:g} m in water {self.level:g} m deep; at least a fifth of the robot's "
                f"length, {0.2 * self.robot.length:.2g} m, must be below it",
            )
            check.whole("cells", 32, 4096)
            check.number("reynolds", 10.0, 1e7, "")
            check.whole("flow_cycles", 2, 1000)
            for number, stiffness in enumerate(self.fin):
                check.that(
                    isfinite(stiffness) and 1e-6 <= stiffness <= 1e6,
                    f"swim_free.fin[{number}] is {stiffness:g} N m/rad; stiffnesses are from 1e-6 to 1e6",
                )
            if self.fin:
                check.that(
                    self.water != "sections",
                    'fin is of swims in a flow, and water is "sections"; take "slice" or "space", or leave out fin',
                )
                check.that(
                    bool(passive_joints(self.robot)),
                    f"robot {self.robot.name!r} has no passive lateral joint with a spring for fin to be the stiffness "
                    "of; leave it out",
                )
            check.number("tail_height", 0.0, 1.0, "m")
            check.number("floor", 0.0, 100.0, "m")
            if self.floor:
                check.that(
                    self.water == "space" and not self.linked,
                    f"floor is below a body that swims in its plane in space, and water is {self.water!r}"
                    f'{" with linked" if self.linked else ""}; take water="space" without linked, or leave out floor',
                )
            if self.linked:
                check.that(
                    self.water == "space",
                    f'linked is of swims in space, and water is "{self.water}"; take "space", or leave out linked',
                )
                check.that(
                    self.tail_height == 0.0,
                    f"linked has the robot's own pieces in the water, and tail_height raises its tail to "
                    f"{self.tail_height:g} m; leave out one of them",
                )
            swims = [name + ending for name in MOTIONS for ending in ("", "_stiff")]
            odd = [name for name in self.in_flow if name not in swims]
            check.that(not odd, f"in_flow names {', '.join(odd)}; there is {', '.join(swims)}")
            unknown = [name for name in self.spread if name not in _COEFFICIENT_FACTORS]
            check.that(not unknown, f"spread names {', '.join(unknown)}; there is {', '.join(_COEFFICIENT_FACTORS)}")

    def for_verdicts(self) -> "SwimFree":
        """Return the same question with swims as short as can answer, without those that are only compared."""
        cycles = {name: min(int(least), getattr(self, name)) for name, least in self.answer_minima.items()}
        return replace(self, **cycles, extent="verdicts", spread=())

    def quick(self) -> "SwimFree":
        """Return the first cycle alone, coefficients as they are."""
        return replace(
            self, settle=0, cycles=1, spread=(), dive=0, in_flow=("whole",), cells=min(self.cells, 60),
            reynolds=min(self.reynolds, 3000.0), flow_cycles=2, fin=self.fin[:2],
        )  # fmt: skip

    @property
    def _correction(self) -> SectionCorrection | None:
        return read_correction(self.correction) if self.correction else None

    @property
    def _lake(self) -> Lake:
        """The water of the swims by sections."""
        return Lake(level=self.level, correction=self._correction)

    def _doubt_correction(self) -> None:
        """Warn if the requested correction was fitted at another Reynolds number."""
        if self._correction is not None:
            doubt = self._correction.validity_warning(self.frequency * self.robot.length**2 / Water().viscosity)
            if doubt:
                warn(doubt, Doubtful, stacklevel=2)

    @property
    def _duration(self) -> float:
        return (self.settle + self.cycles) / self.frequency

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Swim in every motion, stiffer, steered, in other waters, and at half the time step."""
        check_checkpoint_folder(self.keep)
        check_floats(self.robot, Lake(level=self.level))
        check_lake(self.robot, self._lake)
        self._doubt_correction()
        motion = swim_of(
            self.robot, frequency=self.frequency, reading=self.reading, limbs=(LIMBS_BACK[0], self.limb_pitch)
        )
        motions = _motions(motion)
        flow = self._flow_runs(motions)
        by_table = self._by_table(motion)
        runs = self._runs(motions, _ends(self.spread, by_table))
        record = simulate(runs, duration=self._duration, progress=staged(progress, "swims", 0.0, 0.7))
        models = self._models(motions)
        dive_records = []
        if self.extent == "whole":
            fine = simulate(
                runs[:1],
                duration=self._duration,
                timestep=record.attrs["timestep"] / 2,
                progress=staged(progress, "half the time step", 0.7, 0.8),
            )
            record["fine_centre_of_mass"] = fine.centre_of_mass.isel(run=0, drop=True)
            dive_records = self._dive_records(motion, staged(progress, "swims below the surface", 0.8, 1.0))
        record = xr.merge(
            [record, models, *dive_records], join="exact", compat="no_conflicts", combine_attrs="override"
        )
        record.attrs.update(
            measured_from=self.settle / self.frequency,
            measured_cycles=self.cycles,
            deep_from=self.dive / self.frequency,
            depth=self.depth,
            frequency=self.frequency,
            cable=list(self._cable),
            meant=motion.number("tail_bend") / max(len(self._cable), 1),
            **{f"{name}_by_table": factor for name, factor in by_table.items()},
        )
        if not flow:
            return SimulationResult(record=record, replays=self._replays(record))
        flow_record, first_record, judgement, correction = swim_in_flow(flow, self.flow_cycles, self.keep, progress)
        record = xr.merge([record, flow_record], join="exact", compat="no_conflicts", combine_attrs="override")
        record.attrs.update(flow=self.water, linked=int(self.linked))
        films = {"swim_in_flow.gif": film_vortices(record)} if "vortices" in record else film_slice(record)
        return SimulationResult(
            record=record, replays={**self._replays(record), **self._flow_replay(first_record)}, films=films,
            tables={
                "residual.md": residual_text(record, judgement, is_earned=correction is not None),
                **({} if correction is None else {"correction.toml": render(correction)}),
            },
            checkpoint_files=checkpoint_paths(self.keep, checkpoint_names([run.label for run in flow])),
        )  # fmt: skip

    def _flow_runs(self, motions: Mapping[str, Gait]) -> list[Run]:
        """Return the runs in a flow; none on the rung of sections."""
        if self.water == "sections":
            return []
        water = water_of(
            self.water, self.cells, self.reynolds, self.tail_height, linked=self.linked, floor=self.floor or None
        )
        runs = flow_runs(self._joints, motions, ("whole", *self.in_flow), water)
        return [*runs, *fin_runs(runs[0], self.fin)]

    def _flow_replay(self, record: xr.Dataset) -> Mapping[str, Replay]:
        """Return the page of the first swim in the flow."""
        return replayed(
            "swim_in_flow_replay.html",
            record.drop_vars([*WATER, "swims_in"]),
            self.robot,
            title="Swimming in a flow that is solved with the robot",
            caption=f"The whole wave on the robot's own servos, in the {self.water} of water around it at "
            f"f L² / ν = {self.reynolds:.0f}, from rest.",
        )

    @property
    def _cable(self) -> tuple[str, ...]:
        """Joints that cables bend, from the front to the rear."""
        return tuple(name for cable in self.robot.cables for name in cable.hinges)

    def _dive_records(self, motion: Gait, progress: Any) -> list[xr.Dataset]:
        """Return the stored variables of the swims below the surface; nothing of a robot that cannot hover."""
        runs = submerged.deep_runs(self.robot, motion, self._lake, self.depth)
        duration = (self.dive + self.cycles) / self.frequency
        return [submerged.dive_record(simulate(runs, duration=duration, progress=progress), runs)] if runs else []

    def _by_table(self, motion: Gait) -> Mapping[str, float]:
        """Return the factors by which the table of sections differs from the coefficients of the swims [-]."""
        outline = Outline(with_values(self.robot, {"hull": None}))
        free_swim = cruise(outline, motion, reactive, Water())
        side = np.ptp(cycle(outline, motion, free_swim.sway, free_swim.turn).y, axis=0) / 2
        return dict(zip(("cross_drag", "added_mass"), correction_factors(*outline.silhouette, side), strict=True))

    @property
    def _joints(self) -> Mapping[str, Robot]:
        """The robot by the ending of its swims' names: as it is, and with stiffer joints if it has a cable."""
        if not self._cable:
            return {"": self.robot}
        return {"": self.robot, "_stiff": with_spring(self.robot, self._cable, self.stiffness)}

    def _runs(self, motions: Mapping[str, Gait], factors: Mapping[str, tuple[float, float]]) -> list[Run]:
        """Return every run by sections: motions, stiffer joints, steering, varied coefficients of the water.

        Args:
            motions: motions by name.
            factors: least and greatest factor on each coefficient [-].
        """
        lake, whole_wave = self._lake, motions["whole"]
        control = Swimming(ramp=1.0 / self.frequency)
        runs = [
            Run(robot=robot, gait=gait, lake=lake, control=control, label=name + ending)
            for ending, robot in self._joints.items()
            for name, gait in motions.items()
            if self.extent == "whole" or (not ending and (name != "reversed" or "tail_only" not in motions))
        ]
        steered_gait = _steered_gait(self.robot, whole_wave, tail=self.turn, trunk=self.trunk_turn)
        runs.append(Run(robot=self.robot, gait=steered_gait, lake=lake, control=control, label="steered"))
        for name, gait in self._varied_swims().items():
            runs.append(Run(robot=self.robot, gait=gait, lake=lake, control=control, label=name))
        for name, ends in factors.items():
            for factor in ends:
                lake_variant = _lake_with_factor(lake, name, factor)
                label = f"{name} x {factor:g}"
                runs.append(Run(robot=self.robot, gait=whole_wave, lake=lake_variant, control=control, label=label))
        return runs

    def _varied_swims(self) -> Mapping[str, Gait]:
        """Return the whole wave with limbs straight out and with faster swings, where limbs and joints allow them."""
        back, settings = (LIMBS_BACK[0], self.limb_pitch), {"robot": self.robot, "reading": self.reading}
        gaits = {FASTER: swim_of(**settings, frequency=FASTER_SWINGS * self.frequency, limbs=back)}
        if layout(self.robot).limbs:
            gaits[SPREAD] = swim_of(**settings, frequency=self.frequency, limbs=(0.0, self.limb_pitch))
        return {name: gait for name, gait in gaits.items() if suits(self.robot, gait)}

    def _models(self, motions: Mapping[str, Gait]) -> xr.Dataset:
        """Return the speeds of the models whose midline is commanded, and the speed of the body wave [m/s]."""
        bare_robot = with_values(self.robot, {"hull": None})
        model_swims = {name: swim(bare_robot, gait) for name, gait in motions.items()}
        speeds = [[float(model_swims[name].speed.sel(model=model)) for model in _MODELS] for name in motions]
        whole_swim = model_swims["whole"].sel(model="reactive")
        return xr.Dataset(
            {
                "model_speed": (("motion", "model"), speeds, {"units": "m/s"}),
                "wave_speed": ((), float(whole_swim.speed / whole_swim.slip), {"units": "m/s"}),
            },
            coords={"motion": list(motions), "model": list(_MODELS)},
        )

    def _replays(self, record: xr.Dataset) -> Mapping[str, Replay]:
        """Return the replay of the whole wave at the surface, with one other swim half transparent, by file name."""
        labels = [str(label) for label in record.label.values]
        ghost = next(label for label in ("whole_stiff", "tail_only", "reversed") if label in labels)
        ghost_label = {"whole_stiff": "stiffer joints", "tail_only": "tail only", "reversed": "reversed wave"}[ghost]
        is_stiff = ghost == "whole_stiff"
        return replayed(
            "swim_replay.html",
            record.isel(run=0),
            self.robot,
            ghost=record.isel(run=labels.index(ghost)),
            labels=("joints as designed" if is_stiff else "whole wave", ghost_label),
            title="Swimming in six degrees of freedom",
            caption=f"Swimming at the surface by a wave{', limbs held back' if self.robot.girdles else ''}; half "
            f"transparent, with {'stiffer joints' if is_stiff else f'the {ghost_label}'}.",
        )

    def measure(self, record: xr.Dataset) -> Measures:
        """Return speeds, what the swim costs, how it rolls and turns, and how the cable's joints share their bend."""
        labels = [str(label) for label in record.label.values]
        means = {
            label: _settled_speed(record.centre_of_mass.isel(run=i), record, FASTER_SWINGS if label == FASTER else 1.0)
            for i, label in enumerate(labels)
        }
        speed = {label: mean.mean for label, mean in means.items()}
        excerpts = {label: _settled_cycles(record.isel(run=i), means[label].start) for i, label in enumerate(labels)}
        whole_swim, measures = excerpts["whole"], Measures()
        for name in [name for name in MOTIONS if name in labels]:
            measures[f"speed_{name}"] = Measure(speed[name], "m/s")
            if f"{name}_stiff" in speed:
                measures[f"speed_{name}_stiff"] = Measure(speed[f"{name}_stiff"], "m/s")
            for label in (name, f"{name}_stiff"):
                if label in means:
                    measures[f"half_width_{label}"] = Measure(0.5 * (means[label].high - means[label].low), "m/s")
            for model in _MODELS:
                value = float(record.model_speed.sel(motion=name, model=model))
                measures[f"speed_{name}_{model}"] = Measure(value, "m/s")
        absolute_speed, weight = abs(speed["whole"]), float(whole_swim.mass) * GRAVITY
        swing = float(np.ptp((whole_swim.tail_tip - whole_swim.centre_of_mass).sel(xyz="y").values))
        steered_start = _steered_start(record.isel(run=labels.index("steered")), record)
        steered_swim = _settled_cycles(record.isel(run=labels.index("steered")), steered_start)
        yaw = np.unwrap(rotation.yaw(whole_swim.orientation.values))
        measures |= (
            submerged.measures(record)
            | {
                "cross_drag_by_table": Measure(record.attrs["cross_drag_by_table"], "-"),
                "added_mass_by_table": Measure(record.attrs["added_mass_by_table"], "-"),
                "roll_amplitude": Measure(float(np.abs(rotation.heel(whole_swim.orientation.values)).max()), "rad"),
                "pitch": Measure(float(rotation.pitch(whole_swim.orientation.values).mean()), "rad"),
                "yaw_amplitude": Measure(float(np.ptp(yaw)) / 2, "rad"),
                "share_above": Measure(float(1.0 - whole_swim.share_under.mean()), "-"),
                "slip": Measure(speed["whole"] / float(record.wave_speed), "-"),
                "servo_power": Measure(float(whole_swim.servo_power.sum("servo").mean()), "W"),
                "water_power": Measure(-float(whole_swim.water_power.mean()), "W"),
                "net_cost_of_transport": Measure(
                    float(whole_swim.servo_power.sum("servo").mean()) / (weight * absolute_speed), "-"
                ),
                "water_cost_of_transport": Measure(
                    -float(whole_swim.water_power.mean()) / (weight * absolute_speed), "-"
                ),
                "turn_radius": Measure(_radius(steered_swim, record.attrs["frequency"]), "m"),
                "unsettled_swims": Measure(
                    float(sum(not mean.is_settled for label, mean in means.items() if label != "steered")), "-"
                ),
            }
            | similar(
                swim_numbers(
                    speed=absolute_speed,
                    length=self.robot.length,
                    frequency=record.attrs["frequency"],
                    swing=swing,
                    viscosity=Water().viscosity,
                )
            )
            | _shares(excerpts, record.attrs["cable"])
            | flow_measures(record)
        )
        measures |= {f"speed_{name}": Measure(speed[name], "m/s") for name in (SPREAD, FASTER) if name in speed}
        if SPREAD in speed:
            measures["gain_limbs_pressed"] = Measure(speed["whole"] / speed[SPREAD] - 1.0, "-")
        if FASTER in speed:
            measures["gain_faster_swings"] = Measure(speed[FASTER] / speed["whole"] - 1.0, "-")
        if "fine_centre_of_mass" not in record:
            return measures
        fine = _settled_speed(record.fine_centre_of_mass, record).mean
        waters = [value for label, value in speed.items() if " x " in label] + [speed["whole"]]
        measures |= {
            "speed_low": Measure(min(waters), "m/s"),
            "speed_high": Measure(max(waters), "m/s"),
            "step_change": Measure(abs(fine - speed["whole"]) / absolute_speed, "-"),
        }
        real_water = self.real_water_speed({name: measure.value for name, measure in measures.items()})
        return measures | {
            "speed_real_water": Measure(real_water.speed, "m/s"),
            "speed_real_water_low": Measure(real_water.low, "m/s"),
            "speed_real_water_high": Measure(real_water.high, "m/s"),
        }

    def real_water_speed(self, measures: Mapping[str, float]) -> RealWaterSpeed:
        """Return the speed of the whole wave in real water, over the models that apply.

        Args:
            measures: numbers of the run by name.
        """
        reynolds = self.frequency * self.robot.length**2 / Water().viscosity
        sections = SpeedEstimate(
            model="sections",
            speed=measures["speed_whole"],
            low=measures["speed_low"],
            high=measures["speed_high"],
            reynolds=reynolds,
        )
        speeds = {model: (measures[f"speed_whole_{model}"], reynolds) for model in _MODELS}
        speeds |= {
            model: (measures[f"speed_{model}"], self.reynolds)
            for model in ("slice", "space")
            if f"speed_{model}" in measures
        }
        others = [
            SpeedEstimate(model=model, speed=speed, low=speed, high=speed, reynolds=number)
            for model, (speed, number) in speeds.items()
        ]
        return real_water_speed([sections, *others], reynolds)

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say how fast it swims in real water first, then what its parts, its cable and the flow do."""
        real_water = self.real_water_speed(measures) if "speed_low" in measures else None
        return self.render_explanation(measures, real_water=real_water)

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the speeds beside the models', and how the joints of the cable share the bend."""
        speeds = {name: measure.value for name, measure in self.measure(outcome.record).items()}
        motions = [name for name in MOTIONS if f"speed_{name}" in speeds]
        figures = {"swim_speeds": draw_speeds(speeds, motions, _MODELS), "tail_shares": draw_tail(outcome.record)}
        if "dive" in outcome.record:
            figures["below"] = draw_below(outcome.record, submerged.DIVE_LABELS)
        return {**figures, **(draw_in_flow(outcome.record) if "flow_run" in outcome.record else {})}


def _motions(motion: Gait) -> dict[str, Gait]:
    """Return those of ``MOTIONS`` that a wave along an axis has."""
    motions = {"whole": motion}
    bends = {"tail" if bend.part == "tail" else "trunk" for bend in motion.axis if any(bend.amplitude)}
    if len(bends) == 2:
        motions |= {"tail_only": motion.straightened("neck", "trunk"), "trunk_only": motion.straightened("tail")}
    return motions | {"reversed": motion.reversed()}


def _steered_gait(robot: Robot, motion: Gait, *, tail: float, trunk: float) -> Gait:
    """Return a wave about mean bends, which are halved until the joints can follow it."""
    candidate = motion.with_numbers(tail_offset=tail, trunk_offset=trunk)
    return candidate if suits(robot, candidate) else _steered_gait(robot, motion, tail=tail / 2, trunk=trunk / 2)


def _shares(excerpts: Mapping[str, xr.Dataset], cable: Sequence[str]) -> Measures:
    """Return the largest amplitude of a cable joint over the mean; nothing of a robot without cables.

    Args:
        excerpts: settled cycles of the swims by label.
        cable: joints that cables bend.
    """
    ends = {"": "whole", "_stiff": "whole_stiff"} if cable else {}
    return Measures(
        {
            f"tail_spread{end}": Measure(_uneven(excerpts[name], cable), "-")
            for end, name in ends.items()
            if name in excerpts
        }
    )


def _ends(names: Sequence[str], by_table: Mapping[str, float]) -> dict[str, tuple[float, float]]:
    """Return the least and the greatest factor on each coefficient, those of the table among them [-]."""
    factors_by_name = {
        name: (*_COEFFICIENT_FACTORS[name], by_table.get(name, _COEFFICIENT_FACTORS[name][0])) for name in names
    }
    return {name: (min(factors), max(factors)) for name, factors in factors_by_name.items()}


def _lake_with_factor(lake: Lake, name: str, factor: float) -> Lake:
    """Return a lake in which one coefficient of the water is multiplied by a factor."""
    if name in ("added_mass", "shedding"):
        return replace(lake, **{name: factor})  # type: ignore[arg-type]
    return replace(lake, water=replace(Water(), **{name: factor * getattr(Water(), name)}))


def _settled_speed(centre: xr.DataArray, record: xr.Dataset, frequency_factor: float = 1.0) -> SettledMean:
    """Return the settled speed of the centre of mass along its first heading, +x [m/s].

    Where the swim is too short to be settled, it is the mean of the last ``measured_cycles``.

    Args:
        centre: centre of mass of one run, over ``time`` and ``xyz`` [m].
        record: record with ``frequency`` and ``measured_cycles``.
        frequency_factor: frequency of this swim over that of the record [-].
    """
    period = 1.0 / (frequency_factor * record.attrs["frequency"])
    time = centre.time.values.astype(float)
    ends = period * np.arange(whole_cycles(time, period) + 1)
    speeds = np.diff(np.interp(ends, time, centre.sel(xyz="x").values)) / period
    return settled_mean(speeds, fallback_cycles=record.attrs["measured_cycles"])


def _settled_cycles(run_record: xr.Dataset, start: int) -> xr.Dataset:
    """Return a run from the start of a cycle on, counted from 0."""
    return run_record.sel(time=slice(start / run_record.attrs["frequency"] - 1e-9, None))


def _steered_start(run_record: xr.Dataset, record: xr.Dataset) -> int:
    """Return the first settled cycle of a swim in a circle, by its speed along the path [-]."""
    speeds = cycle_speeds(run_record, 1.0 / record.attrs["frequency"])
    return settled_mean(speeds, fallback_cycles=record.attrs["measured_cycles"]).start


def _radius(excerpt: xr.Dataset, frequency: float) -> float:
    """Return the radius of a circle, left positive: distance over the turn, cycle by cycle [m]."""
    samples_per_cycle = max(round(1.0 / (frequency * float(excerpt.time[1] - excerpt.time[0]))), 1)
    x, y = (excerpt.centre_of_mass.sel(xyz=axis).values[::samples_per_cycle] for axis in "xy")
    yaw = np.unwrap(rotation.yaw(excerpt.orientation.values))[::samples_per_cycle]
    return float(np.hypot(np.diff(x), np.diff(y)).sum() / (yaw[-1] - yaw[0]))


def _uneven(excerpt: xr.Dataset, cable: Sequence[str]) -> float:
    """Return the largest amplitude of a cable joint over their mean [-]."""
    angles = excerpt.joint_angle.sel(joint=cable).transpose("time", "joint").values
    half = np.ptp(angles, axis=0) / 2
    return float(half.max() / half.mean())


experiment = SwimFree()

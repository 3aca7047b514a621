"""How does the robot's own body swim in the water of three dimensions, and what would a higher tail do?"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, ClassVar, NamedTuple

import numpy as np
import xarray as xr

from suchus.core.checks import Checks
from suchus.core.fingerprint import fingerprint
from suchus.core.jobs import at_scheduler, conduct_sweep
from suchus.experiments.catalog._similar import similar
from suchus.experiments.catalog._taken import TAKEN, TakenMidline, midlines
from suchus.experiments.catalog.swim_3d.figure import draw_joints, draw_speeds, draw_tails, draw_wake, drive_caption
from suchus.experiments.experiment import (
    Experiment,
    Measure,
    Measures,
    Outcome,
    Progress,
    Replay,
    SimulationResult,
    silent,
    staged,
)
from suchus.robot.design import GRAVITY, Robot
from suchus.robot.design.water import Water
from suchus.robot.kinematics.wave import READINGS
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.metrics import settled_mean, swim_numbers
from suchus.swimming.coupling import check_on_joints, swim_on_joints
from suchus.swimming.water import (
    Motion,
    SpeedEstimate,
    fit,
    printed_wave,
    real_water_speed,
    swim,
)
from suchus.swimming.water.resolved import ON_THE_SPOT, SwimSetting, check_resolved_swim, resolved_swim
from suchus.swimming.water.samples import check_checkpoint_folder, checkpoint_path, checkpoint_paths
from suchus.swimming.water.setting import MARGIN_BESIDE
from suchus.visual.figures.vortices import draw_vortices, film_vortices
from suchus.visual.replay import wake_replay

MAX_REYNOLDS = 2e4
"""Largest frequency times length squared over viscosity [-]."""
TRUNK_AND_TAIL = "trunk and tail"
"""The motion that the others are compared with."""
LIMBS = "limbs folded"
"""The same with the limbs in the water."""
AS_COMMANDED = "as commanded"
"""The same along the midline that is commanded."""
COUPLED = ("coupling_residual", "energy_error", "power_error")
"""Measures of the convergence of robot and water; see ``coupling.swim_on_joints``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Swim3d(Experiment):
    """The robot free in three dimensions, from rest, its servos fitted to (20); no article's claim is judged by it.

    The body has elliptic sections as wide and high as the robot's pieces, without limbs unless it is said, and moves in
    its plane of symmetry: along, to the side and about the vertical. Its servos, springs, cables and passive end are
    solved together with the water, which so decides how a cable's joints share their bend; the robot has its own mass,
    with foam if it would sink. On one grid it swims along the commanded midline too, as heavy as the water that it
    displaces: ``speed_as_commanded``; with ``joints`` False all swims are of that kind. It swims on several grids, in a
    water so thick that ``reynolds``, the frequency times the length squared over the viscosity, is what the grids
    carry; the same number holds for the slice of the experiment ``swimming`` and the slender-body models beside it,
    which are commanded. Nothing here is in newtons or watts of the robot in real water, whose number is
    ``reynolds_real_water``.

    ``speed`` is the mean of the last cycle on the finest grid and ``speed_gain`` by how much that is above the cycle
    before: a body so light for its power takes tens of cycles to its last speed. ``speed_over_grids`` is by how much
    the finest grid is faster than the next coarser one in the same cycle. ``thrust_held`` is the mean force forward on
    a body that sways and turns as commanded but is kept from moving on. ``power`` is that on the water, ``servo_power``
    that of the servos, ``tail_spread`` the largest amplitude of a cable's joint over their mean, ``servo_load_peak``
    the greatest torque of a servo over its limit: its own, or that which the water alone asks of it along a commanded
    midline. ``coupling_residual`` is the greatest force that a step of any swim left over between robot and water after
    the first cycle, ``energy_error`` what is missing in a robot's balance of energy. Trunk only, tail only, the printed
    direction, the body with its limbs folded straight back and higher tails swim on ``compared_cells``. With ``taken``
    the midlines that the same commands give in six degrees of freedom at the surface, where the water distributes the
    cable's bend among its joints, swim there as further conditions, joint by joint; of these midlines only yaw counts.
    """

    title = "How fast does the robot's own body swim in three dimensions, and what does a higher tail change?"
    shows = "Beyond the article: Section IV.B, whose flow is a slice"
    answers = (
        "speed",
        "speed_over_grids",
        "slice_over_body",
        "power",
        "speed_resistive_real_water",
        "speed_reactive_real_water",
    )
    needs = ("trunk", "tail_yaw")
    answer_minima: ClassVar[Mapping[str, float]] = {"cycles": 6}
    reproduces: ClassVar[bool] = False

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that swims."""
    joints: bool = True
    """Whether the robot's own servos, springs and cables move the body, solved together with the water; False: it
    follows the commanded midline."""
    reading: str = "I"
    """Letter of the reading of (20), see ``kinematics.wave.READINGS``."""
    frequency: float = 1.0
    """Frequency of the wave, which the article does not give [Hz], 0.01 to 20."""
    reynolds: float = 7000.0
    """Frequency times length squared over viscosity [-], chosen for what the grids carry; in real water it is
    ``reynolds_real_water``."""
    cells: tuple[int, ...] = (68, 80, 96)
    """Cells per body length of the grids, rising [-]."""
    cycles: int = 6
    """Cycles of the free body; numbers are of the last [-]."""
    compared_cells: int = 68
    """Cells per body length where motions and tails are compared, and the body is held [-]."""
    compared_cycles: int = 6
    """Cycles of these [-]."""
    tail_heights: tuple[float, ...] = (0.06, 0.1)
    """Heights to which the last third of the body is raised, as a fin as thick as the tail; rising [m]."""
    taken: bool = False
    """Whether the midline that the joints take in six degrees of freedom swims too, with trunk and tail and with the
    tail alone: two more swims like those of trunk and tail."""
    beside: float = MARGIN_BESIDE
    """Water between the widest swing and the sides of the box [body length]."""
    slice_cells: int = 96
    """Cells per body length of the slice [-]."""
    frames: int = 24
    """Instants of the last cycle on the finest grid that film and replay show [-]."""
    keep: str = ""
    """Folder for finished swims, and for how far unfinished ones have come, from which an interrupted run goes on;
    empty keeps nothing."""
    jobs: int = 2
    """Swims that are computed side by side, in processes that share the threads of this machine [-]."""
    scheduler: str = ""
    """Address of a Dask scheduler whose workers compute the swims, as tcp://127.0.0.1:8786; empty: they are computed
    here."""

    def __post_init__(self) -> None:
        """Refuse an unknown reading, a Reynolds number that no grid resolves, and settings outside their ranges."""
        with Checks(self.name(), self) as check:
            check.number("frequency", 0.01, 20.0, "Hz")
            check.number("beside", 0.0, 3.0, "body lengths")
            reynolds: Any = self.reynolds  # a file may say anything
            if isinstance(reynolds, (int, float)) and reynolds > MAX_REYNOLDS:
                check.that(False, f"{self.name()}.reynolds is {self.reynolds:.3g}: real water, 1e6 at 1 Hz and 1 m, "
                           "would need to slip along the body and to leave it where its layer does, and that is not "
                           f"built; at most {MAX_REYNOLDS:.0f} is allowed, whose layers a grid carries")  # fmt: skip
            else:
                check.number("reynolds", 10.0, MAX_REYNOLDS, "")
            check.that(self.reading in READINGS, f"{self.name()}.reading is {self.reading!r}; there are "
                       f"{', '.join(READINGS)}")  # fmt: skip
            check.rising("cells", 32, 512, "cells")
            for name in ("compared_cells", "slice_cells"):
                check.whole(name, 32, 512)
            check.whole("frames", 1, 200)
            check.whole("jobs", 1, 256)
            for name in ("cycles", "compared_cycles"):
                check.whole(name, 2, 100)
            if self.tail_heights:
                check.rising("tail_heights", 1e-3, 1.0, "m")

    def quick(self) -> "Swim3d":
        """A coarse grid, a thick water, two cycles."""
        return replace(
            self, cells=(54,), compared_cells=54, slice_cells=40, cycles=2, compared_cycles=2, reynolds=2500.0,
            tail_heights=(), frames=4, jobs=1,
        )  # fmt: skip

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Swim on every grid, held, in other motions and with higher tails; the slice and the models beside them."""
        with at_scheduler(self.scheduler or None) as client:  # refused before anything is computed
            return self._simulated(progress, client)

    def _simulated(self, progress: Progress, client: Any) -> SimulationResult:
        """Run every swim, here or on a cluster, and return record, film, replay and checkpoint files.

        Args:
            progress: called with the stage and the fraction that is done.
            client: Dask client of the scheduler; None computes the swims in processes of this machine.
        """
        check_checkpoint_folder(self.keep)
        swim_gait, printed_gait = (self._motion(sign) for sign in (-1, 1))
        joint_midlines = midlines(self.robot, swim_gait, self.compared_cells + 1) if self.taken else []
        runs = self._runs(swim_gait, printed_gait, joint_midlines)
        for _, item in runs:
            check_resolved_swim(self.robot, item.motion, item.setting)
            if item.joints:
                assert isinstance(item.motion, Gait)
                check_on_joints(self.robot, item.motion, item.setting)
        check_resolved_swim(self.robot, swim_gait, self._slice)
        items = [item for _, item in runs]
        with nullcontext(self.keep) if self.keep else TemporaryDirectory() as folder:
            records = conduct_sweep(
                self.name(), partial(swim_in_space, self.robot), items, Path(folder) / "swims", client=client,
                progress=staged(progress, "", 0.0, 0.9), jobs=self.jobs,
                local=partial(_swim_locally, self.robot, self.keep),
            )  # fmt: skip
        reference = self._reference_speeds(swim_gait, staged(progress, "the slice", 0.9, 0.95))
        swims = {name: swim_record for (name, _), swim_record in zip(runs, records, strict=True)}
        record = self.recorded(swims, with_midlines(reference, joint_midlines))
        film = film_vortices(record, staged(progress, "the film", 0.95, 1.0))
        stored_swims = checkpoint_paths(self.keep, ["slice", *map(_checkpoint_name, items)])
        return SimulationResult(
            record=record, films={"swim_3d.gif": film}, replays=_replays(record), checkpoint_files=stored_swims
        )

    def recorded(self, swims: Mapping[str, xr.Dataset], reference: xr.Dataset) -> xr.Dataset:
        """Return the record of the experiment.

        Args:
            swims: records of the swims in three dimensions, by name.
            reference: speeds of slice and slender-body models, of ``with_midlines``.
        """
        grids = [swims[f"{cells} cells"] for cells in self.cells]
        base_swim = swims.get("compared", swims.get(f"{self.compared_cells} cells"))
        assert base_swim is not None
        arms = ("trunk only", "tail only", "as printed", AS_COMMANDED, LIMBS, *TAKEN)
        names = [name for name in arms if name in swims]
        tails = {f"tail {height:g} m": height for height in self.tail_heights}
        compared_swims = {TRUNK_AND_TAIL: base_swim, **{name: swims[name] for name in (*names, *tails)}}
        dropped_names = ("speed", "thrust", "power", "steps", "million_cells", "thin", "cycle", *COUPLED)
        finest_record = grids[-1].drop_vars(dropped_names, errors="ignore")
        n, held_swim = self.compared_cycles, swims["held"]
        coupled_swims = [
            swim_record
            for swim_record in {
                id(swim_record): swim_record for swim_record in (*grids, *compared_swims.values())
            }.values()
            if COUPLED[0] in swim_record
        ]
        terms = {
            name: ("own", [float(swim_record[name]) for swim_record in coupled_swims], {"units": "1"})
            for name in COUPLED
            if coupled_swims
        }
        speeds, powers = (
            [swim_record[name].values[:n] for swim_record in compared_swims.values()] for name in ("speed", "power")
        )
        weights = [float(swim_record.weight) for swim_record in compared_swims.values()]
        data = xr.Dataset(
            {
                **{name: (("grid", "cycle"), [swim_record[name].values for swim_record in grids], grids[0][name].attrs)
                   for name in ("speed", "thrust", "power")},
                **{name: ("grid", [float(swim_record[name]) for swim_record in grids], grids[0][name].attrs)
                   for name in ("steps", "million_cells", "thin")},
                "compared_speed": (("compared", "compared_cycle"), speeds, {"units": "m/s"}),
                "compared_power": (("compared", "compared_cycle"), powers, {"units": "W"}),
                "tail_height": ("compared", [tails.get(name, 0.0) for name in compared_swims], {"units": "m"}),
                "weight_compared": ("compared", weights, {"units": "N"}),
                "held_thrust": ((), float(held_swim.thrust[-1]), {"units": "N"}),
                "held_power": ((), float(held_swim.power[-1]), {"units": "W"}),
                "compared_cells": ((), float(self.compared_cells), {"units": "1"}),
                "reynolds": ((), self.reynolds, {"units": "1"}),
                **terms,
            },
            coords={"cells": ("grid", list(self.cells)), "compared": list(compared_swims),
                    "cycle": grids[0].cycle.values, "compared_cycle": np.arange(1, n + 1)},
        )  # fmt: skip
        return data.merge(finest_record).merge(reference).assign_attrs(joints=int(self.joints))

    def _motion(self, sign: int) -> Gait:
        wave = printed_wave(self.robot, self.reading, frequency=self.frequency, sign=sign)
        return fit(self.robot, wave, name=f"(20), reading {self.reading}").gait

    @property
    def viscosity(self) -> float:
        """Kinematic viscosity of the water [m2/s]."""
        return self.frequency * self.robot.length**2 / self.reynolds

    @property
    def _slice(self) -> SwimSetting:
        """Grid, water and time of the slice."""
        return SwimSetting(cells=self.slice_cells, viscosity=self.viscosity, cycles=self.cycles)

    def _runs(
        self, swim_gait: Gait, printed_gait: Gait, joint_midlines: Sequence[TakenMidline] = ()
    ) -> "Sequence[tuple[str, Item]]":
        """Return the name of every swim in three dimensions with its motion, grid and time.

        Args:
            swim_gait: wave that swims forward.
            printed_gait: wave in the printed direction.
            joint_midlines: midlines of the joints in six degrees of freedom.
        """

        def setting(cells: int, cycles: int, **options: Any) -> SwimSetting:
            return SwimSetting(
                axes=3, cells=cells, viscosity=self.viscosity, cycles=cycles, beside=self.beside, **options
            )

        def swims(name: str, motion: Gait, grid_setting: SwimSetting) -> tuple[str, Item]:
            return name, Item(motion, grid_setting, self.joints)

        compared_setting = setting(self.compared_cells, self.compared_cycles)
        runs = [swims(f"{cells} cells", swim_gait, setting(cells, self.cycles)) for cells in self.cells[:-1]]
        runs.append(
            swims(f"{self.cells[-1]} cells", swim_gait, setting(self.cells[-1], self.cycles, frames=self.frames))
        )
        if self.compared_cells not in self.cells or self.compared_cycles > self.cycles:
            runs.append(swims("compared", swim_gait, compared_setting))
        runs.append(
            ("held", Item(swim_gait, setting(self.compared_cells, min(3, self.compared_cycles), free=ON_THE_SPOT)))
        )
        if self.tail_heights:
            trunk, tail = swim_gait.straightened("tail"), swim_gait.straightened("trunk")
            arms = {"trunk only": trunk, "tail only": tail, "as printed": printed_gait}
            runs += [swims(name, motion, compared_setting) for name, motion in arms.items()]
            runs += [(AS_COMMANDED, Item(swim_gait, compared_setting))] * self.joints
            runs.append(swims(LIMBS, swim_gait, replace(compared_setting, limbs=True)))
        runs += [(midline.name, Item(midline.motion, compared_setting)) for midline in joint_midlines]
        return runs + [
            swims(f"tail {height:g} m", swim_gait, replace(compared_setting, tail_height=height))
            for height in self.tail_heights
        ]

    def _reference_speeds(self, swim_gait: Any, progress: Any) -> xr.Dataset:
        """Return the speed of the slice and of the slender-body models at the same Reynolds number."""
        plane = resolved_swim(
            self.robot, swim_gait, self._slice, checkpoint=checkpoint_path(self.keep, "slice"), progress=progress
        )
        models, real = swim(self.robot, swim_gait, water=Water(viscosity=self.viscosity)), swim(self.robot, swim_gait)
        return xr.Dataset(
            {
                "slice_speed": ("cycle", plane.speed.values, {"units": "m/s"}),
                "model_speed": models.speed, "model_power": models.power, "model_thrust": models.thrust_held,
                "real_model_speed": real.speed,
            }
        )  # fmt: skip

    def measure(self, record: xr.Dataset) -> Measures:
        """Return what the body did on every grid, and beside it slice, models, motions and tails."""
        return Measures(
            _body(record, self.robot, self.frequency),
            _grids(record),
            _slice_and_models(record),
            _comparison_measures(record),
            _loads(record),
            _joints(record),
        )

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say how fast the body swims in this water, and what that says of real water."""
        reynolds = measures["reynolds_real_water"]
        speeds = {model: (measures[f"speed_{model}_real_water"], reynolds) for model in ("resistive", "reactive")}
        speeds |= {"slice": (measures["speed_slice"], measures["reynolds"])}
        speeds |= {"space": (measures["speed"], measures["reynolds"])}
        estimates = [
            SpeedEstimate(model=model, speed=speed, low=speed, high=speed, reynolds=number)
            for model, (speed, number) in speeds.items()
        ]
        return self.render_explanation(measures, real_water=real_water_speed(estimates, reynolds))

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw speeds over the cycles, the wake, the tails and the joints' torques."""
        record = outcome.record
        figures = {
            "swim_3d_speeds": draw_speeds(record),
            "swim_3d_vortices": draw_vortices(record),
            "swim_3d_wake": draw_wake(record),
            "swim_3d_joints": draw_joints(record),
        }
        return figures | ({"swim_3d_tails": draw_tails(record)} if record.sizes["compared"] > 1 else {})


class Item(NamedTuple):
    """Motion and setting of one swim."""

    motion: Motion
    """Commanded motion."""
    setting: SwimSetting
    """Grid, water, time, and degrees of freedom of the body."""
    joints: bool = False
    """Whether the robot's own joints move the body; otherwise it follows the commanded midline."""


def swim_in_space(robot: Robot, item: Item, progress: Progress, checkpoint: Path | None = None) -> xr.Dataset:
    """Return a swim of a robot, see ``water.resolved``; the result depends on robot and item alone."""
    motion, setting, joints = item
    if joints:
        assert isinstance(motion, Gait)
        return swim_on_joints(robot, motion, setting, checkpoint=checkpoint, progress=progress)
    return resolved_swim(robot, motion, setting, checkpoint=checkpoint, progress=progress)


def _swim_locally(robot: Robot, keep: str, item: Item, progress: Progress) -> xr.Dataset:
    """Return the same swim, with a checkpoint in the folder ``keep``."""
    return swim_in_space(robot, item, progress, checkpoint_path(keep, _checkpoint_name(item)))


def _checkpoint_name(item: Item) -> str:
    """Return the name of the checkpoint of an unfinished swim."""
    return fingerprint(item)[:16]


def _joints(record: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    """Yield servo power and tail spread on the finest grid, and the coupling errors of all swims."""
    if not record.attrs["joints"]:
        return
    yield "servo_power", Measure(float(record.servo_power[-1]), "W")
    if not np.isnan(record.tail_spread):
        yield "tail_spread", Measure(float(record.tail_spread), "-")
    for name in COUPLED:
        yield name, Measure(float(record[name].max()), "-")


def _replays(record: xr.Dataset) -> dict[str, Replay]:
    """Return the page on which the body swims through its last cycle on the finest grid, vortices around it."""
    caption = (
        f"The body of the robot in three dimensions{drive_caption(record)} at f L² / ν = "
        f"{float(record.reynolds):.0f}, on "
        f"{int(record.cells[-1])} cells a length, in its last cycle. Surfaces lie where the second invariant of the "
        f"velocity gradient is {float(record.vortex_level):.3g} 1/s², around vortices."
    )
    page = partial(wake_replay, record, title="Vortices around the swimming robot", caption=caption)
    return {"swim_3d_replay.html": Replay(caption=caption, make=page)}


def with_midlines(reference: xr.Dataset, joint_midlines: Sequence[TakenMidline]) -> xr.Dataset:
    """Return the reference speeds with the misfit of the joints' midlines, where there are midlines."""
    if not joint_midlines:
        return reference
    misfit = (
        "taken_arm",
        [midline.relative_error for midline in joint_midlines],
        {"units": "1", "long_name": "rms angle off, over that commanded"},
    )
    return reference.assign(taken_away=misfit).assign_coords(taken_arm=[midline.name for midline in joint_midlines])


def _body(record: xr.Dataset, robot: Robot, frequency: float) -> Iterator[tuple[str, Measure]]:
    """Yield speed, power, mass and similarity numbers of the free body on the finest grid, and its thrust while held.

    Args:
        record: record of ``Swim3d.recorded``.
        robot: the robot that swims.
        frequency: frequency of the wave [Hz].
    """
    speeds, power = record.speed.values[-1], float(record.power[-1, -1])
    speed, weight = float(speeds[-1]), float(record.weight)
    yield "reynolds", Measure(float(record.reynolds), "-")
    real = frequency * robot.length**2 / Water().viscosity
    yield "reynolds_real_water", Measure(real, "-")
    yield "cells_per_length", Measure(float(record.cells[-1]), "-")
    yield "cycles", Measure(float(record.sizes["cycle"]), "-")
    yield "mass", Measure(weight / GRAVITY, "kg")
    yield "speed", Measure(speed, "m/s")
    yield "speed_lengths", Measure(speed / robot.length, "1/s")
    yield "speed_gain", Measure(_gain(speeds), "-")
    yield "unsettled", Measure(float(not settled_mean(speeds).is_settled), "-")
    yield "power", Measure(power, "W")
    yield "water_cost_of_transport", Measure(power / (weight * abs(speed)), "-")
    numbers = swim_numbers(
        speed=speed, length=robot.length, frequency=frequency, swing=float(record["swing"]),
        viscosity=frequency * robot.length**2 / float(record.reynolds),
    )  # fmt: skip
    yield "reynolds_of_speed", Measure(numbers.reynolds, "-")
    yield from similar(numbers, but=("reynolds",)).items()
    yield "slip", Measure(speed / float(record.wave_speed), "-")
    yield "head_yaw", Measure(float(record.head_yaw), "rad")
    yield "thrust_held", Measure(float(record.held_thrust), "N")
    yield "power_held", Measure(float(record.held_power), "W")


def _grids(record: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    """Yield speed and power by grid, and by which fraction the finest grid differs from the next coarser one."""
    for i, cells in enumerate(record.cells.values):
        yield f"speed_{cells}_cells", Measure(float(record.speed[i, -1]), "m/s")
        yield f"power_{cells}_cells", Measure(float(record.power[i, -1]), "W")
        yield f"thin_share_{cells}_cells", Measure(float(record["thin"][i]), "-")
    if record.sizes["grid"] > 1:
        final_speeds, power = record.speed.values[-2:, -1], record.power.values[-2:, -1]
        yield "speed_over_grids", Measure(float(final_speeds[1] / final_speeds[0] - 1.0), "-")
        yield "power_over_grids", Measure(float(power[1] / power[0] - 1.0), "-")


def _slice_and_models(record: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    """Yield the speed of the slice, and speed, power and thrust by slender-body model."""
    plane, speed = float(record.slice_speed[-1]), float(record.speed[-1, -1])
    yield "speed_slice", Measure(plane, "m/s")
    yield "slice_over_body", Measure(plane / speed, "-")
    for model in record.model.values:
        model_record = record.sel(model=model)
        yield f"speed_{model}", Measure(float(model_record.model_speed), "m/s")
        yield f"power_{model}", Measure(float(model_record.model_power), "W")
        yield f"thrust_held_{model}", Measure(float(model_record.model_thrust), "N")
        yield f"speed_{model}_real_water", Measure(float(model_record.real_model_speed), "m/s")


def _comparison_measures(record: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    """Yield speed, power and cost of transport of each motion and tail on the compared grid."""
    for name in record.compared.values:
        motion_record, key = record.sel(compared=name), _key(str(name))
        speed, power = motion_record.compared_speed.values, float(motion_record.compared_power[-1])
        yield f"speed_{key}", Measure(float(speed[-1]), "m/s")
        yield f"speed_gain_{key}", Measure(_gain(speed), "-")
        yield f"power_{key}", Measure(power, "W")
        yield (
            f"water_cost_of_transport_{key}",
            Measure(power / (float(motion_record.weight_compared) * abs(float(speed[-1]))), "-"),
        )
    for name in record.taken_arm.values if "taken_away" in record else ():
        yield f"misfit_{_key(str(name))}", Measure(float(record.taken_away.sel(taken_arm=name)), "-")


def _gain(speeds: np.ndarray) -> float:
    """Return by how much the last cycle is faster than the one before; NaN where that stood still [-]."""
    return float(speeds[-1] / speeds[-2] - 1.0) if speeds[-2] != 0.0 else float("nan")


def _key(name: str) -> str:
    return name.replace(" m", "").replace(" ", "_").replace(".", "_")


def _loads(record: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    """Yield the greatest torque of each servo over its torque limit [-]."""
    for servo in record.servo.values:
        servo_record = record.sel(servo=servo)
        yield (
            f"servo_load_peak_{servo}",
            Measure(float(abs(servo_record.servo_torque).max() / servo_record.servo_limit), "-"),
        )


experiment = Swim3d()

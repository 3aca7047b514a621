"""The swims of ``swim_free`` in a flow that is solved with the robot: servos, cable and passive end as they are."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from suchus.core.errors import Diverged
from suchus.experiments.experiment import Measure, Measures, Progress, staged
from suchus.robot.control import Swimming
from suchus.robot.design import GRAVITY, Robot, SectionCorrection, Spring, with_spring
from suchus.robot.design.water import Water
from suchus.robot.motion import Gait
from suchus.sim.land import Lake, Run, simulate
from suchus.sim.land.waters import Slice, Space
from suchus.sim.metrics import SettledMean, settled_mean, whole_cycles
from suchus.swimming.coupling import Swim, earned_correction, judgement_text, residual_table
from suchus.swimming.coupling.earned import LinkJudgement
from suchus.swimming.water.field_samples import FieldWindow, VortexSampler, midline, midline_values, wake
from suchus.swimming.water.samples import checkpoint_path

_FLOW_VARIABLES = (
    "centre_of_mass", "position", "orientation", "joint_angle", "servo_power", "water_force", "water_power",
    "link_force", "link_torque", "joint_water_torque",
)  # fmt: skip
"""Variables of each swim that are stored as ``flow_NAME``, over their own time."""
_COUPLING = ("coupling_residual", "coupling_first", "coupling_iterations", "energy_error", "power_error")
FRAMES = 24
"""Instants of the last cycle that are filmed [-]."""
FIN = "_fin_"
"""Separator of motion and stiffness in the label of a swim with another passive end."""
_RESIDUAL_NUMBERS = ("r2", "added", "added_low", "added_high", "drag", "drag_low", "drag_high", "r2_held_out")
"""Residual numbers that are measured for every link and joint of the first swim in a flow."""
_GROWTH_CYCLES = 1.0
"""Cycles from the start in which the motion grows; the coupling residual is measured after them [-]."""


def flow_runs(
    joints: Mapping[str, Robot], motions: Mapping[str, Gait], swim_names: Sequence[str], water: Any
) -> list[Run]:
    """Return the requested runs in a flow, of those that the robot has.

    Args:
        joints: the robot by the ending of its swims' names, as it is and with stiffer joints.
        motions: motions by name.
        swim_names: names of swims.
        water: a ``Slice`` or a ``Space``.
    """
    period = motions["whole"].period
    return [
        Run(robot=robot, gait=gait, water=water, control=Swimming(ramp=period), label=name + ending)
        for ending, robot in joints.items()
        for name, gait in motions.items()
        if name + ending in swim_names
    ]


def is_filmed(run: Run) -> bool:
    """Return whether a run is filmed: in space only the half of a body above a plane of symmetry is."""
    flow = run.solved_flow
    return not (isinstance(flow, Space) and (flow.linked or flow.floor is not None))


def passive_joints(robot: Robot) -> list[str]:
    """Return the lateral joints of the axis that springs alone hold, no cable among them."""
    cabled = {name for cable in robot.cables for name in cable.hinges}
    return [
        hinge.name
        for hinge in robot.axis_hinges
        if hinge.turn == "yaw" and isinstance(hinge.drive, Spring) and hinge.name not in cabled
    ]


def fin_runs(run: Run, stiffnesses: Sequence[float]) -> list[Run]:
    """Return a run with other stiffnesses of the passive end's joints, the softest first.

    Args:
        run: run in a flow.
        stiffnesses: stiffnesses of each joint [N m/rad].
    """
    joints = passive_joints(run.robot)
    return [
        replace(run, robot=with_spring(run.robot, joints, stiffness), label=f"{run.label}{FIN}{stiffness:g}")
        for stiffness in sorted(set(stiffnesses))
    ]


def fins(record: xr.Dataset) -> xr.Dataset:
    """Return speed [m/s] and cost of transport [-] in the last cycle over the stiffness of the passive end [N m/rad].

    The cost is that of the servos, of the robot's weight in air and as far as it comes ahead. Swims that broke off have
    NaN; a record without such swims has none.

    Args:
        record: record of the experiment with a flow.
    """
    names = [str(name) for name in record.flow_run.values if FIN in str(name)]
    last_cycle = record.flow_servo_power.sel(
        flow_time=slice(float(record.flow_time[-1] - record.flow_period) - 1e-9, None)
    )
    weight = float(record.mass.isel(run=0) if "run" in record.mass.dims else record.mass) * GRAVITY
    speeds = np.array([flow_speed(record, name) for name in names])
    powers = np.array([float(last_cycle.sel(flow_run=name).mean(skipna=False)) for name in names])
    costs = np.divide(powers, weight * speeds, out=np.full(speeds.shape, np.nan), where=speeds > 0)
    return xr.Dataset(
        {"speed": ("stiffness", speeds), "cost": ("stiffness", costs)},
        coords={"stiffness": [float(name.partition(FIN)[2]) for name in names]},
    )


def checkpoint_names(labels: Sequence[str]) -> list[str]:
    """Return the checkpoint names of unfinished swims in a flow."""
    return [f"flow {label}" for label in labels]


class FlowSwims(NamedTuple):
    """Results of the swims in a flow."""

    record: xr.Dataset
    """Stored variables of all swims."""
    first_record: xr.Dataset
    """Record of the first swim."""
    judgement: str
    """Whether the swims justify a correction of the section model, link by link, as Markdown."""
    correction: SectionCorrection | None
    """The justified correction of the section model; None if there is none."""


def swim_in_flow(runs: Sequence[Run], cycles: int, keep: str, progress: Progress) -> FlowSwims:
    """Simulate swims in a flow that is solved with the robot.

    A later swim that diverges has NaN from there on.

    Args:
        runs: runs of ``flow_runs``.
        cycles: number of cycles of each swim [-].
        keep: folder of checkpoints, from which swims resume; empty keeps nothing.
        progress: called with the fraction that is done.

    Raises:
        Diverged: the first swim diverged.
        UnreadableFile: a checkpoint is broken or belongs to other swims.
    """
    swims = [Swim(run, cycles * run.gait.period) for run in runs]  # refused before any is computed
    records, film_data = [], xr.Dataset()
    for number, (run, swim) in enumerate(zip(runs, swims, strict=True)):
        stage = staged(progress, f"{run.label} in the flow", number / len(runs), (number + 1) / len(runs))
        film = _Film(swim, cycles) if number == 0 and is_filmed(run) else None
        with suppress(*([Diverged] if number else [])):
            swim.go(
                swim.ticks * swim.stepper.period, progress=stage, watch=film,
                checkpoint=checkpoint_path(keep, *checkpoint_names([run.label])),
            )  # fmt: skip
        records.append(swim.record().isel(run=0))
        film_data = film.dataset() if film is not None else film_data
        del swim.sim
    first_record = records[0]
    units = {name: first_record[name].attrs for name in (*_FLOW_VARIABLES, *_COUPLING)}
    data = {
        (name if name in _COUPLING else f"flow_{name}"): (
            ("flow_run", *("flow_time" if dim == "time" else dim for dim in first_record[name].dims)),
            np.stack([record[name].values for record in records]), units[name],
        )
        for name in (*_FLOW_VARIABLES, *_COUPLING)
    }  # fmt: skip
    coords = {
        "flow_run": [run.label for run in runs],
        "flow_time": ("flow_time", first_record.time.values, {"units": "s"}),
        "link": first_record.link.values, "joint": first_record.joint.values,
        "xyz": first_record.xyz.values, "wxyz": first_record.wxyz.values,
    }  # fmt: skip
    water = runs[0].solved_flow
    assert water is not None
    period, viscosity = runs[0].gait.period, swims[0].viscosity
    complete_records = [record for record in records if np.isfinite(record.coupling_residual.values[1:]).all()]
    table = _section_tables(runs, records, complete_records, viscosity)
    numbers = {
        "flow_period": ((), period, {"units": "s"}),
        "flow_radius": ("flow_run", [float(record.radius) for record in records], {"units": "1"}),
        "cells": ("grid", [water.cells], {"units": "1"}),
        "reynolds": ((), water.reynolds, {"units": "1"}),
        "added_mass": (
            ("coordinate", "coordinate_too"), first_record.added_mass.values, first_record.added_mass.attrs,
        ),
    }  # fmt: skip
    names = {"coordinate": first_record.coordinate.values, "coordinate_too": first_record.coordinate_too.values}
    correction, judgements = None, dict[str, LinkJudgement]()
    if complete_records and complete_records[0] is first_record:
        held_out_names = [
            run.label
            for run, record in zip(runs, records, strict=True)
            if record is not first_record and _is_in(record, complete_records)
        ]
        correction, judgements = earned_correction(
            runs[0].robot, complete_records, period=period, start_time=_GROWTH_CYCLES * period, viscosity=viscosity,
            name=f"{runs[0].robot.name}_{water.reynolds:.0f}",
        )  # fmt: skip
    flow_record = xr.Dataset({**data, **numbers}, coords={**coords, **names}).merge(table).merge(film_data)
    text = judgement_text(judgements, held_out_names) if judgements else ""
    if correction is not None:
        held_out_runs = [run for run in runs[1:] if run.label in held_out_names]
        in_flow = [flow_speed(flow_record, name) for name in held_out_names]
        speed_text, is_nearer = compare_section_speeds(held_out_runs, in_flow, cycles, viscosity, correction)
        text, correction = text + speed_text, correction if is_nearer else None
    return FlowSwims(flow_record, first_record, text, correction)


def _section_tables(
    runs: Sequence[Run], records: Sequence[xr.Dataset], complete_records: Sequence[xr.Dataset], viscosity: float
) -> xr.Dataset:
    """Return the residual table of the first swim, and those of all swims as ``swim_NAME`` over ``flow_run``.

    A later swim that broke off has NaN.

    Args:
        runs: runs in the flow.
        records: records of the runs.
        complete_records: those of ``records`` that did not diverge.
        viscosity: kinematic, of the flow's water [m2/s].
    """
    period = runs[0].gait.period
    tables = list[xr.Dataset]()
    for run, record in zip(runs, records, strict=True):
        valid = record.isel(time=np.flatnonzero(np.isfinite(record.coupling_residual.values)))
        if not tables or _is_in(record, complete_records):
            tables.append(
                residual_table(run.robot, valid, period=period, start_time=_GROWTH_CYCLES * period, viscosity=viscosity)
            )
        else:
            tables.append(
                tables[0].map(lambda variable: variable if variable.dtype.kind in "US" else variable * np.nan)
            )
    swims = {
        f"swim_{name}": (("flow_run", "part"), np.stack([table[f"residual_{name}"].values for table in tables]))
        for name in ("rms", "r2", "added", "drag", "r2_fitted", "r2_held_out")
    }
    return tables[0].assign(swims)


def reduces_speed_error(flow: Sequence[float], shipped: Sequence[float], corrected: Sequence[float]) -> bool:
    """Return whether corrected speeds have a smaller mean absolute error than those of the shipped model.

    Args:
        flow: speeds in the flow [m/s].
        shipped: speeds by sections with the shipped coefficients [m/s].
        corrected: speeds by sections with the correction [m/s].
    """
    misses = [float(np.abs(np.subtract(speeds, flow)).mean()) for speeds in (shipped, corrected)]
    return misses[1] < misses[0]


def compare_section_speeds(
    runs: Sequence[Run], in_flow: Sequence[float], cycles: int, viscosity: float, correction: SectionCorrection
) -> tuple[str, bool]:
    """Swim by sections as in the flow, with a correction and without, at the flow's viscosity and below the surface.

    Better forces do not guarantee a better speed, because speed depends on the small difference of thrust and drag.

    Args:
        runs: runs in the flow, without those that the correction was fitted to.
        in_flow: speeds of the runs in the flow [m/s].
        cycles: number of cycles of each swim [-].
        viscosity: kinematic, of the flow's water [m2/s].
        correction: fitted to the forces.

    Returns:
        A table of the speeds as Markdown, and whether the correction reduces the error of the speeds.
    """
    water = Water(viscosity=viscosity)
    lakes = [Lake(level=2 * runs[0].robot.length, water=water, correction=factors) for factors in (None, correction)]
    section_runs = [replace(run, water=None, lake=lake) for lake in lakes for run in runs]
    period = runs[0].gait.period
    x = simulate(section_runs, duration=cycles * period).centre_of_mass.sel(xyz="x")
    last_cycle = x.sel(time=slice((cycles - 1) * period - 1e-9, None)).transpose("run", "time").values
    speeds = ((last_cycle[:, -1] - last_cycle[:, 0]) / period).reshape(2, len(runs))
    is_nearer = reduces_speed_error(in_flow, speeds[0], speeds[1])
    head = "\n| speed in the last cycle | flow | sections as shipped | corrected |\n|---|---:|---:|---:|\n"
    rows = [
        f"| {run.label} | {1e3 * flow:.1f} mm/s | {1e3 * shipped:.1f} | {1e3 * corrected:.1f} |\n"
        for run, flow, shipped, corrected in zip(runs, in_flow, *speeds, strict=True)
    ]
    end = (
        "nearer to the flow with the factors"
        if is_nearer
        else "no nearer to the flow with the factors, so that no file is written"
    )
    return f"{head}{''.join(rows)}\nIn the mean these speeds are {end}.\n", is_nearer


def _is_in(record: xr.Dataset, records: Sequence[xr.Dataset]) -> bool:
    return any(record is candidate for candidate in records)


class _Film:
    """Samples the last cycle of a swim: vortices in space, vorticity in the plane, as ``field_NAME``."""

    def __init__(self, swim: Swim, cycles: int) -> None:
        """Prepare to sample the last of ``cycles`` cycles of a swim at ``FRAMES`` instants."""
        self._swim = swim
        self._end, frequency = cycles * swim.run.gait.period, 1.0 / swim.run.gait.period
        self._frequency = frequency
        self._vortices = VortexSampler(frequency, self._end, FRAMES)
        length = swim.run.robot.length
        self._window = FieldWindow(swim.sim.setup.grid, length, 2.0, 0.6) if swim.sim.ndim == 2 else None

    def __call__(self, swim: Swim) -> None:
        """Take a frame if one is due."""
        if self._window is None:
            self._vortices.sample(swim.sim, swim.samples)
            return
        remaining_cycles = (self._end - swim.sim.time) * self._frequency
        if remaining_cycles < 1.0 - (self._swim.samples.count("frames") + 1) / FRAMES + 1e-6:
            fields = {"vorticity": self._window.fields(swim.sim)["vorticity"]}
            values = {**fields, **midline_values(midline(swim.sim))}
            self._swim.samples.add("frames", swim.sim.time, **values)

    def dataset(self) -> xr.Dataset:
        """Return the sampled fields; nothing of a swim that ended before the first sample."""
        if not self._swim.samples.count("frames"):
            return xr.Dataset()
        if self._window is None:
            return wake(self._swim.sim).merge(self._vortices.record(self._swim.samples))
        series = self._swim.samples.series("frames")
        phase = (series["time"] - self._end) * self._frequency + 1.0
        field_record = self._window.dataset(series, "frame").assign_coords(frame=("frame", phase, {"units": "1"}))
        return field_record.rename({str(name): f"field_{name}" for name in field_record.variables})


def flow_speed(record: xr.Dataset, name: str) -> float:
    """Return the mean speed of the centre of mass along its first heading in the last cycle of a swim [m/s]."""
    x = record.flow_centre_of_mass.sel(flow_run=name, xyz="x")
    end = float(record.flow_time[-1])
    last_cycle = x.sel(flow_time=slice(end - float(record.flow_period) - 1e-9, None))
    return float((last_cycle[-1] - last_cycle[0]) / (last_cycle.flow_time[-1] - last_cycle.flow_time[0]))


def flow_settled_speed(record: xr.Dataset, name: str) -> SettledMean:
    """Return the settled speed of a swim in the flow along its first heading; see ``metrics.settled_mean`` [m/s].

    Where the swim is too short to be settled, or has broken off, the mean is the speed of its last cycle.
    """
    x = record.flow_centre_of_mass.sel(flow_run=name, xyz="x").values
    time, period = record.flow_time.values.astype(float), float(record.flow_period)
    speeds = np.diff(np.interp(period * np.arange(whole_cycles(time, period) + 1), time, x)) / period
    speed = settled_mean(speeds)
    return speed if speed.is_settled else speed._replace(mean=flow_speed(record, name))


def flow_measures(record: xr.Dataset) -> Measures:
    """Return speeds in the flow, coupling errors, and the residual of the section model."""
    if "flow_run" not in record:
        return Measures()
    rung = record.attrs["flow"]
    period, measures = float(record.flow_period), Measures()
    grown_record = record.sel(flow_time=slice(_GROWTH_CYCLES * period, None))
    last_cycle = record.sel(flow_time=slice(float(record.flow_time[-1]) - period - 1e-9, None))
    fin_swims = fins(record)
    if np.isfinite(fin_swims.speed.values).any():
        fastest = fin_swims.isel(stiffness=int(np.nanargmax(fin_swims.speed.values)))
        measures["fin_fastest"] = Measure(float(fastest.stiffness), "N m/rad")
        measures["fin_speed"] = Measure(float(fastest.speed), "m/s")
        measures["fin_slowest"] = Measure(float(fin_swims.speed.min()), "m/s")
        if np.isfinite(fin_swims.cost.values).any():
            measures["fin_cheapest"] = Measure(
                float(fin_swims.stiffness[int(np.nanargmin(fin_swims.cost.values))]), "N m/rad"
            )
            measures["fin_cost"] = Measure(float(fin_swims.cost.min()), "-")
    for name in (str(label) for label in record.flow_run.values if FIN not in str(label)):
        ending = rung if name == "whole" else f"{rung}_{name}"
        speed = flow_settled_speed(record, name)
        measures[f"speed_{ending}"] = Measure(speed.mean, "m/s")
        measures[f"half_width_{ending}"] = Measure(0.5 * (speed.high - speed.low), "m/s")
        measures[f"unsettled_{ending}"] = Measure(float(not speed.is_settled), "-")
        measures[f"servo_power_{ending}"] = Measure(
            float(last_cycle.flow_servo_power.sel(flow_run=name).sum("servo").mean()), "W"
        )
        if record.attrs["cable"]:
            angles = last_cycle.flow_joint_angle.sel(flow_run=name, joint=record.attrs["cable"]).values
            half = np.ptp(angles, axis=0) / 2
            measures[f"tail_spread_{ending}"] = Measure(float(half.max() / half.mean()), "-")
    end = record.isel(flow_time=-1)
    for name, cycles_record in {
        "coupling_residual": grown_record,
        "coupling_first": grown_record,
        "energy_error": end,
        "power_error": end,
    }.items():
        measures[name] = Measure(
            float(abs(cycles_record[name]).max(skipna=False)), "-"
        )  # NaN says that a swim broke off
    measures["added_mass_radius"] = Measure(float(record.flow_radius.max()), "-")
    for kind in ("link", "joint"):
        kind_record = record.isel(part=np.flatnonzero(record.part_kind.values == kind))
        loaded_parts = kind_record.isel(
            part=np.flatnonzero(kind_record.residual_rms.values > 0.1 * float(kind_record.residual_rms.max()))
        )
        for name, unit in (("r2", "-"), ("r2_held_out", "-"), ("added", "-"), ("drag", "-")):
            measures[f"{kind}_{name}"] = Measure(float(loaded_parts[f"residual_{name}"].median()), unit)
        for name in _RESIDUAL_NUMBERS:
            for part_name in kind_record.part.values:
                measures[f"{kind}_{name}_of_{part_name}"] = Measure(
                    float(kind_record[f"residual_{name}"].sel(part=part_name)), "-"
                )
        for swim in (str(label) for label in record.flow_run.values[1:] if FIN not in str(label)):
            for name in ("r2", "r2_fitted", "added", "drag"):
                middle = loaded_parts[f"swim_{name}"].sel(flow_run=swim).median(skipna=False)
                measures[f"{kind}_{name}_in_{swim}"] = Measure(float(middle), "-")
    return measures


def residual_text(record: xr.Dataset, judgement: str = "", *, is_earned: bool = False) -> str:
    """Return the table of the section model beside the flow, as Markdown.

    Args:
        record: record of the experiment.
        judgement: see ``FlowSwims``; empty for none.
        is_earned: whether a correction is written beside it.
    """
    correction_text = (
        "\n## Whether a correction is earned\n\nThe factors are fitted to the whole of the first swim and held against "
        "the other ones, which the fit never saw: they are offered where they leave less of the force unexplained in "
        "each of them, by more than its cycles differ, and swims by sections with them come nearer to its speeds. "
        + (
            "`correction.toml` beside this page has what is offered, for `suchus run swim_free --correction FILE`.\n\n"
            if is_earned
            else "None is earned, and no file is written.\n\n"
        )
        + judgement
    )
    head = (
        "| part | rms in the flow | rms by sections | R2 | added mass x | drag x | R2 fitted | R2 held out |\n"
        "|---|---:|---:|---:|---:|---:|---:|---:|\n"
    )
    rows = []
    for k, name in enumerate(record.part.values):
        numbers = {key: float(record[f"residual_{key}"][k]) for key in (
            "rms", "rms_sections", "r2", "added", "added_low", "added_high", "drag", "drag_low", "drag_high",
            "r2_fitted", "r2_held_out")}  # fmt: skip
        unit = "N" if record.part_kind.values[k] == "link" else "N m"
        rows.append(
            f"| {name} | {numbers['rms']:.3g} {unit} | {numbers['rms_sections']:.3g} | {numbers['r2']:.2f} | "
            f"{_factor(numbers, 'added')} | {_factor(numbers, 'drag')} | {numbers['r2_fitted']:.2f} | "
            f"{numbers['r2_held_out']:.2f} |\n"
        )
    return (
        f"# The section model beside the flow\n\nAt f L2 / nu = {float(record.reynolds):.0f}, along the motion that "
        "the robot took in the flow. Links by the force across them, joints by the moment of the water; added mass and "
        "drag are factors on the two parts of the section model's force, fitted to the first half of the measured "
        "cycles and held against the second; intervals need a half of one and a half cycles or more.\n\n"
        + head
        + "".join(rows)
        + _other_swims(record)
        + (correction_text if judgement else "")
    )


def _other_swims(record: xr.Dataset) -> str:
    """Return R2 and fitted factors of the section model for each further swim, as Markdown; empty for one swim."""
    complete_swims = [
        swim for swim in record.flow_run.values[1:] if np.isfinite(record.swim_r2.sel(flow_run=swim)).all()
    ]
    parts = {kind: np.flatnonzero(record.part_kind.values == kind) for kind in ("link", "joint")}
    rows = [
        f"| {swim} | {kind}s | {_spread_text(record.sel(flow_run=swim).isel(part=indices))} |\n"
        for swim in complete_swims
        for kind, indices in parts.items()
    ]
    if not rows:
        return ""
    return (
        "\n## The other swims\n\nEach along its own motion, with factors of its own: median, and from the least to the "
        "greatest, of all links and of all joints.\n\n| swim | of | R2 | added mass x | drag x | R2 fitted |\n"
        "|---|---|---:|---:|---:|---:|\n" + "".join(rows)
    )


def _spread_text(swim: xr.Dataset) -> str:
    """Return median, least and greatest over the parts of one swim, cell by cell."""
    values = [swim[f"swim_{name}"] for name in ("r2", "added", "drag", "r2_fitted")]
    return " | ".join(
        f"{float(quantity.median()):.2f} ({float(quantity.min()):.2f} to {float(quantity.max()):.2f})"
        for quantity in values
    )


def _factor(row: Mapping[str, float], name: str) -> str:
    """Return a factor, with its interval if it has one."""
    lower_bound, upper_bound = row[f"{name}_low"], row[f"{name}_high"]
    return f"{row[name]:.2f}" + (f" ({lower_bound:.2f} to {upper_bound:.2f})" if lower_bound <= upper_bound else "")


def water_of(
    rung: str, cells: int, reynolds: float, tail_height: float, *, linked: bool = False, floor: float | None = None
) -> Slice | Space:
    """Return the flow of a rung, "slice" or "space".

    Args:
        rung: "slice" or "space".
        cells: cells per body length [-].
        reynolds: frequency times length squared over viscosity [-].
        tail_height: in space, height of the raised tail [m].
        linked: in space, whether all of the robot's pieces are to move.
        floor: in space, depth of a floor below the body's middle; None is no floor [m].
    """
    if rung == "slice":
        return Slice(cells=cells, reynolds=reynolds)
    return Space(cells=cells, reynolds=reynolds, tail_height=tail_height, linked=linked, floor=floor)

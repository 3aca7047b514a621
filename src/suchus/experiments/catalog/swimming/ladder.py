"""The rungs of the ladder: one motion and its parts in six models of the water, each until its numbers converge."""

import json
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from hashlib import sha256
from importlib import resources
from math import isfinite, nan, pi
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from suchus.article.verdict import ladder
from suchus.core import rotation
from suchus.core.errors import IncompatibleRecord, SuchusError, UnreadableFile, Unwritable
from suchus.core.fingerprint import fingerprint
from suchus.core.progress import Progress, portion, staged
from suchus.experiments.catalog._taken import bare, swum_in_sections
from suchus.experiments.catalog.swimming.rules import LADDER, MAX_SETTLED_SPREAD, MIN_VISIBLE_SWAY, RULES
from suchus.experiments.experiment import Measure
from suchus.robot.design import Robot
from suchus.robot.motion import Gait, check_limits, check_speeds
from suchus.sim.metrics import settled_mean
from suchus.swimming.water import (
    MODELS,
    Fit,
    Motion,
    Outline,
    Sway,
    Water,
    cruise,
    cycle,
    motion_of_record,
    swing,
    undulation,
    unevenness,
    wave_form,
)
from suchus.swimming.water.field_samples import COURSE, TICKS
from suchus.swimming.water.resolved import FREE, TETHERED, SwimSetting, resolved_swim
from suchus.swimming.water.samples import checkpoint_path
from suchus.swimming.water.setting import MARGIN_BEHIND

MOTIONS = ("trunk and tail", "tail only", "trunk only")
"""Motions that swim on every rung."""
SWIMS = (*MOTIONS, "held")
"""The swims of a rung that resolves the water: each motion swims freely, and the first also with its snout fixed."""
_SWIMS_OF_MEASURE: Mapping[str, tuple[str, ...]] = {
    "gain_tail": (MOTIONS[0], MOTIONS[2]), "gain_spine": MOTIONS[:2], "track": MOTIONS[:1], "wave": MOTIONS[:1],
    "tail_sine": MOTIONS[:1], "pressure": ("held",), "force": ("held",), "thrust": ("held",),
}  # fmt: skip
"""Swims that a measure is read from, by the beginning of its name."""
MIN_SETTLED_CYCLES = 6
"""Fewest cycles over which a number can be settled [-]: two halves of three."""
_QUARTERS: Mapping[str, str] = {"difference": "Pa", "thrust": "N/m", "aside": "N/m"}
"""What is read at the quarters of a cycle, and its unit; forces of rungs in three dimensions are in N."""
GRIDS = "grids.json"
"""File beside this module: numbers on several grids in three dimensions, see ``tools/ladder_grids.py``."""
SECTION_SETTLING_CYCLES = 24
"""Cycles that are swum on sections before the stored ones, where these can be settled [-]: they are cheap."""
WATER_BEHIND = 0.75
"""In three dimensions: water behind the tail [body length], three times the width of the swimming body.

The flow warns below that. The box has 1.3 times as many cells as with the usual 0.35."""
_AVERAGED_CYCLES = 3  # last cycles of the swim on sections over which the joints' midline is averaged [-]


def motions(gait: Gait) -> dict[str, Gait]:
    """Return the gaits of ``MOTIONS``, by name."""
    return dict(zip(MOTIONS, (gait, gait.straightened("trunk"), gait.straightened("tail")), strict=True))


@dataclass(frozen=True, slots=True, kw_only=True)
class LadderSetting:
    """Robot, motion, water and grids of the ladder."""

    robot: Robot
    """The robot that swims."""
    wave_fit: Fit
    """Motion of the robot, and the turn of its head while the snout is held."""
    viscosity: float
    """Kinematic viscosity on the rungs that resolve the water [m2/s]; theories and sections take real water."""
    cycles: int
    """Cycles of every swim, from rest [-]."""
    cells: int
    """Cells per body length of the slices [-]."""
    space_cells: int
    """Cells per body length in three dimensions [-]."""
    keep: str = ""
    """Folder for swims that were not finished; empty keeps nothing."""

    @property
    def digest(self) -> str:
        """Hash of body, motion and water; a study of grids is valid for the setting with the same hash."""
        outline, length = Outline(self.robot), self.robot.length
        bend_phasors = undulation(outline, self.wave_fit.gait).middles
        inputs = (
            *outline.silhouette,
            bend_phasors.real,
            bend_phasors.imag,
            length,
            self.viscosity,
            self.wave_fit.head,
            self.cycles,
        )
        return fingerprint([np.round(quantity, 9) for quantity in inputs])[:16]

    def setting(self, *, space: bool, is_held: bool) -> SwimSetting:
        """Return grid, water and time of a rung that resolves the water.

        Args:
            space: whether it is in three dimensions; otherwise in a slice.
            is_held: whether the snout is fixed; otherwise the body swims freely.
        """
        return SwimSetting(
            axes=3 if space else 2, cells=self.space_cells if space else self.cells, viscosity=self.viscosity,
            cycles=self.cycles, free=TETHERED if is_held else FREE, behind=WATER_BEHIND if space else MARGIN_BEHIND,
        )  # fmt: skip


Swims = Mapping[str, xr.Dataset]
"""Free swims by motion, and the one that is held at its snout as ``held``."""


def run_ladder(
    climb: LadderSetting,
    progress: Progress,
    *,
    slices: Callable[[Collection[str]], Swims] | None = None,
    claims: Collection[str] | None = None,
) -> xr.Dataset:
    """Return the results of every rung; ``unable`` has the reason why a rung could not run, as JSON by its name.

    Args:
        climb: what is asked.
        progress: told the share that is done.
        slices: swims the slice's swims of some names with the commanded midline; None: as those of other rungs.
        claims: keys of the claims for whose words alone swims are swum. What none of them needs is left out: rungs that
            disagree stay at odds, whatever the next one says. None swims everything.

    Raises:
        OutsideLimits: joints or servos cannot follow the motion, so that it is no swim of this robot.
    """
    unable: dict[str, str] = {}
    sections = _attempt("sections", unable, lambda: _in_sections(climb, staged(progress, "sections", 0.0, 0.1)))
    joint_midlines = (
        None if sections is None else _attempt("slice_taken", unable, lambda: _joint_midlines(climb, sections))
    )
    results = {model: _attempt(model, unable, partial(_of_theory, climb, model)) for model in MODELS}
    if sections is None:
        unable["slice_taken"] = unable["sections"]
    else:
        results["sections"] = _attempt("sections", unable, lambda: _of_sections(climb, sections))
    commanded_motions = motions(climb.wave_fit.gait)

    def needed() -> Collection[str]:
        return SWIMS if claims is None else _needed_swims(_ladder(climb, results, unable), climb, claims)

    def resolve(rung: str, rung_motions: Mapping[str, Motion], stage: Progress) -> None:
        swim_names = needed()
        results[rung] = _attempt(
            rung, unable, lambda: _of_swims(climb, swims(climb, rung, rung_motions, stage, swim_names=swim_names))
        )

    if slices is None:
        check_limits(climb.robot, climb.wave_fit.gait)  # theories would swim all the same
        check_speeds(climb.robot, climb.wave_fit.gait)
        resolve("slice", commanded_motions, staged(progress, "slice", 0.1, 0.35))
    else:
        results["slice"] = _of_swims(climb, slices(needed()))
    if joint_midlines is not None:
        resolve("slice_taken", joint_midlines, staged(progress, "taken", 0.35, 0.6))
    resolve("space", commanded_motions, staged(progress, "three dimensions", 0.6, 1.0))
    misfit_attrs = {"units": "1", "long_name": "rms angle of the joints' midline off the commanded, over that"}
    data = _ladder(climb, results, unable)
    data["taken_away"] = "ladder_motion", _midline_misfits(climb, joint_midlines), misfit_attrs
    return data


def _ladder(climb: LadderSetting, results: Mapping[str, Any], unable: Mapping[str, str]) -> xr.Dataset:
    """Return the results of the rungs so far as a record; NaN of rungs without results."""
    data = xr.Dataset(
        {key: _stacked(key, [results.get(name) or {} for name in LADDER], climb.cycles) for key in _SHAPES},
        coords={"rung": list(LADDER), "ladder_motion": list(MOTIONS)},
    )
    return data.assign_attrs(unable=json.dumps(unable), grids=json.dumps(kept_grids(climb)))


def _needed_swims(record: xr.Dataset, climb: LadderSetting, claims: Collection[str]) -> set[str]:
    """Return the swims that the next rung needs for some claims, without claims on which rungs disagree already."""
    numbers = {name: float(measure.value) for name, measure in _of_rungs(record, climb.robot.length)}
    rules = [rule for rule in RULES if rule.claim in claims and not ladder.disagree(ladder.voices(rule, numbers))]
    measure_names = {name for rule in rules for name in (rule.measure, *(clause.measure for clause in rule.holds))}
    return {
        swim
        for name in measure_names
        for start, swim_names in _SWIMS_OF_MEASURE.items()
        if name.startswith(start)
        for swim in swim_names
    }


def _attempt(name: str, unable: dict[str, str], run: Callable[[], Any]) -> Any:
    """Return the result of a rung; None if the rung cannot run, and then ``unable`` has the reason.

    Args:
        name: name of the rung.
        unable: reasons by rung; a reason is added to it.
        run: computes the result.

    Raises:
        Unwritable: a checkpoint could not be written.
        UnreadableFile: a checkpoint is damaged, or belongs to another swim.
    """
    try:
        return run()
    except (Unwritable, UnreadableFile):
        raise
    except SuchusError as refused:
        unable[name] = f"Not run: {' '.join(str(refused).split())}"
        return None


_SHAPES: Mapping[str, tuple[tuple[str, ...], str]] = {
    "ladder_speed": (("ladder_motion", "ladder_cycle"), "m/s"),
    "ladder_centre": (("ladder_tick",), "m"),
    "ladder_course": (("ladder_tick", "ladder_place"), "m"),
    **{f"ladder_{name}": (("ladder_cycle", "ladder_quarter"), unit) for name, unit in _QUARTERS.items()},
}
"""Dimensions after ``rung``, and unit, of the results of a rung. Forces at quarters are in N/m on rungs in a
plane, in N on those in three dimensions."""


def _stacked(key: str, results: Iterable[Mapping[str, Any]], cycles: int) -> Any:
    """Return one variable of all rungs as a tuple for xarray: dimensions, values, attributes.

    Args:
        key: key of ``_SHAPES``.
        results: results of each rung, by variable; a missing variable becomes NaN.
        cycles: cycles of each swim [-].
    """
    dims, unit = _SHAPES[key]
    sizes = {"ladder_motion": len(MOTIONS), "ladder_cycle": cycles, "ladder_tick": TICKS * cycles + 1,
             "ladder_place": COURSE, "ladder_quarter": 4}  # fmt: skip
    empty = np.full([sizes[dim] for dim in dims], np.nan)
    return ("rung", *dims), np.array([np.asarray(result.get(key, empty), float) for result in results]), {"units": unit}


def _of_theory(climb: LadderSetting, model: str) -> dict[str, Any]:
    """Return speed and sway of the centre of mass by a slender-body theory, the same in every cycle.

    Args:
        climb: setting of the ladder.
        model: name in ``MODELS``.
    """
    outline, water = Outline(climb.robot), Water()
    steady_swims = {
        name: cruise(outline, gait, MODELS[model], water) for name, gait in motions(climb.wave_fit.gait).items()
    }
    whole_swim = steady_swims[MOTIONS[0]]
    y = cycle(outline, climb.wave_fit.gait, whole_swim.sway, whole_swim.turn).y
    width, height = outline.silhouette
    centre = np.average(y, axis=1, weights=width * height)
    instants = np.arange(TICKS * climb.cycles + 1) / TICKS % 1.0
    return {
        "ladder_speed": np.tile([[steady_swim.speed] for steady_swim in steady_swims.values()], climb.cycles),
        "ladder_centre": np.interp(instants, np.arange(len(centre) + 1) / len(centre), [*centre, centre[0]]),
    }


def _of_swims(climb: LadderSetting, swims: Swims) -> dict[str, Any]:
    """Return speeds, midline and forces of the swims of a rung that resolves the water; NaN of missing swims.

    Args:
        climb: setting of the ladder.
        swims: swims by motion, and ``held``.
    """
    missing = np.full(climb.cycles, np.nan)
    results: dict[str, Any] = {
        "ladder_speed": [swims[motion].speed.values if motion in swims else missing for motion in MOTIONS]
    }
    if (whole_swim := swims.get(MOTIONS[0])) is not None:
        results |= {"ladder_centre": whole_swim.course_centre.values, "ladder_course": whole_swim.course.values}
    if (held_swim := swims.get("held")) is not None:
        settling_cycles = np.full((climb.cycles - held_swim.sizes["settled"], 4), np.nan)
        results |= {
            f"ladder_{name}": np.vstack([settling_cycles, held_swim[f"quarter_{name}"].values]) for name in _QUARTERS
        }
    return results


def _in_sections(climb: LadderSetting, progress: Progress) -> xr.Dataset:
    """Return the run in six degrees of freedom, the motions along ``run``."""
    cycles = climb.cycles + _section_settling_cycles(climb)
    return swum_in_sections(climb.robot, [*motions(climb.wave_fit.gait).values()], cycles, progress)


def _section_settling_cycles(climb: LadderSetting) -> int:
    """Return the cycles on sections before the stored ones; none where these are too few to be settled [-]."""
    return SECTION_SETTLING_CYCLES if climb.cycles > MIN_SETTLED_CYCLES else 0


def _joint_midlines(climb: LadderSetting, record: xr.Dataset) -> dict[str, Motion]:
    """Return the midlines of the joints in six degrees of freedom, by motion."""
    outline, frequency = Outline(bare(climb.robot), climb.cells + 1), climb.wave_fit.gait.frequency
    averaged_cycles = min(_AVERAGED_CYCLES, climb.cycles)
    return {
        name: motion_of_record(
            outline, record.isel(run=i), frequency=frequency, cycles=averaged_cycles, name=f"{name} as taken"
        )
        for i, name in enumerate(MOTIONS)
    }


def _midline_misfits(climb: LadderSetting, joint_midlines: Mapping[str, Motion] | None) -> list[float]:
    """Return the rms difference of the joints' midlines to the commanded ones, over the commanded angles [-]."""
    if joint_midlines is None:
        return [nan] * len(MOTIONS)
    outline = Outline(bare(climb.robot), climb.cells + 1)
    commanded_motions = motions(climb.wave_fit.gait)
    return [
        unevenness(undulation(outline, joint_midlines[name]), undulation(outline, commanded_motions[name]))
        for name in MOTIONS
    ]


def space_swims(climb: LadderSetting, progress: Progress) -> Swims:
    """Return the swims in three dimensions."""
    return swims(climb, "space", motions(climb.wave_fit.gait), progress)


def swims(
    climb: LadderSetting,
    rung: str,
    rung_motions: Mapping[str, Motion],
    progress: Progress,
    *,
    frames: int = 0,
    swim_names: Collection[str] = SWIMS,
) -> Swims:
    """Return the free swims of a rung by motion, and the first motion with its snout fixed.

    Args:
        climb: what is asked.
        rung: which; ``space`` is in three dimensions, the others are slices.
        rung_motions: the motions by name.
        progress: told the share that is done.
        frames: number of flow fields of the first swim that are stored [-].
        swim_names: names of the swims, the others are left out.
    """
    records: dict[str, xr.Dataset] = {}
    names = [name for name in SWIMS if name in swim_names]
    for i, name in enumerate(names):
        is_held, is_first = name == "held", name == MOTIONS[0]
        setting = climb.setting(space=rung == "space", is_held=is_held)
        records[name] = resolved_swim(
            climb.robot,
            rung_motions[MOTIONS[0] if is_held else name],
            replace(setting, frames=frames) if is_first else setting,
            turn=climb.wave_fit.head if is_held else 0j,
            checkpoint=checkpoint_path(climb.keep, f"{rung} {name}"),
            progress=portion(progress, i, len(names)),
        )
    return records


def _of_sections(climb: LadderSetting, record: xr.Dataset) -> dict[str, Any]:
    """Return speeds and midline of the runs in six degrees of freedom; y is turned from left to right.

    Args:
        climb: setting of the ladder.
        record: record of ``_in_sections``.
    """
    period, time = 1.0 / climb.wave_fit.gait.frequency, record.time.values.astype(float)
    settling_time = period * _section_settling_cycles(climb)
    ends = settling_time + period * np.arange(climb.cycles + 1)
    forward_positions = [
        np.interp(ends, time, record.centre_of_mass.isel(run=i).sel(xyz="x")) for i in range(len(MOTIONS))
    ]
    whole_swim, sample_times = record.isel(run=0), settling_time + period * np.arange(TICKS * climb.cycles + 1) / TICKS
    outline = Outline(bare(climb.robot))
    angles = whole_swim.joint_angle.sel(joint=list(outline.joints)).transpose("time", "joint").values
    middle = 0.5 * (outline.s[1:] + outline.s[:-1])
    root = outline.joints_at(np.array([outline.tail_root - 1e-6])) @ angles.T  # the heading of the root's segment
    heading = np.unwrap(rotation.yaw(whole_swim.orientation.values)) + outline.joints_at(middle) @ angles.T - root
    step = outline.s[1] - outline.s[0]
    tip = -whole_swim.tail_tip.sel(xyz="y").values
    lateral_to_tip = step * np.cumsum(np.sin(heading)[::-1], axis=0)[::-1]  # from each station to the tip
    lateral_offsets = tip - np.vstack([lateral_to_tip, np.zeros_like(tip)])
    positions = np.linspace(0.0, len(outline.s) - 1.0, COURSE)
    course = np.array([np.interp(positions, np.arange(len(outline.s)), offsets) for offsets in lateral_offsets.T])
    return {
        "ladder_speed": np.diff(forward_positions, axis=1) / period,
        "ladder_centre": np.interp(sample_times, time, -whole_swim.centre_of_mass.sel(xyz="y")),
        "ladder_course": np.column_stack([np.interp(sample_times, time, course_column) for course_column in course.T]),
    }


def rules_digest() -> str:
    """Return a hash of the rules that read the study of grids; a study with another hash is out of date."""
    clauses = [
        f"{rule.claim} {rule.measure} {clause.measure} {clause.relation} {clause.bound} {rule.settled}"
        for rule in RULES
        for clause in rule.holds
    ]
    return sha256("\n".join([*clauses, str(MIN_SETTLED_CYCLES)]).encode()).hexdigest()[:16]


def kept_grids(climb: LadderSetting) -> dict[str, Any]:
    """Return the stored study of grids in three dimensions: its cells, and the range of each measure.

    It is empty for another body, motion or water.

    Raises:
        IncompatibleRecord: it is older than the rules.
    """
    file = resources.files("suchus.experiments.catalog.swimming") / GRIDS
    if not file.is_file():
        return {}
    grid_study: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    if grid_study["rules"] != rules_digest():
        raise IncompatibleRecord(
            f"the study of grids that ships with swimming ({GRIDS}) is older than the rules that read it; renew it in "
            "a checkout with: python tools/ladder_grids.py FOLDER"
        )
    return grid_study if grid_study["swim"] == climb.digest else {}


class SettledNumber(NamedTuple):
    """A number of a rung over its settled cycles, with bounds and spread."""

    value: float
    """Mean over halves and starting sides."""
    low: float
    """Least of them."""
    high: float
    """Greatest of them."""
    relative_spread: float
    """Greatest minus least, over the scale of the number [-]; NaN with too few cycles."""

    @classmethod
    def from_values(cls, values: Iterable[float], scale: float) -> "SettledNumber":
        """Return a settled number from the values of both halves and both starting sides."""
        sorted_values = np.sort(np.asarray([*values], float))  # sorted, so that a mirrored swim gives the same bytes
        return cls(
            float(sorted_values.mean()),
            float(sorted_values.min()),
            float(sorted_values.max()),
            float(np.ptp(sorted_values)) / scale,
        )


def settle(
    half: Callable[[int, int], list[float]], cycles: int, scale: float = 1.0, min_start: int = 1
) -> SettledNumber:
    """Return a number over the most cycles whose two halves agree within ``MAX_SETTLED_SPREAD``.

    The first cycle is left out.

    Args:
        half: returns the number between two cycles, once for each side to which the swim may start.
        cycles: number of cycles of the swim [-].
        scale: scale of the number, in its unit.
        min_start: first cycle that may count [-].
    """
    number = None
    longest = max(cycles - min_start, min(MIN_SETTLED_CYCLES, cycles - 1)) // 2 * 2
    for count in range(longest, MIN_SETTLED_CYCLES - 1, -2):
        ends = cycles - count, cycles - count // 2, cycles
        number = SettledNumber.from_values([*half(*ends[:2]), *half(*ends[1:])], scale)
        if number.relative_spread <= MAX_SETTLED_SPREAD:
            return number
    return number or SettledNumber.from_values(half(cycles - 1, cycles), scale)._replace(relative_spread=nan)


def numbers_in_space(climb: LadderSetting, swims: Swims) -> Iterator[tuple[str, SettledNumber]]:
    """Return the numbers of the rung in three dimensions from its swims."""
    results = _of_swims(climb, swims)
    rung = xr.Dataset({key: _stacked(key, [results], climb.cycles) for key in _SHAPES}).isel(rung=0)
    return _numbers(rung.assign_coords(ladder_motion=list(MOTIONS)), climb.robot.length)


def measures(record: xr.Dataset, length: float) -> Iterator[tuple[str, Measure]]:
    """Return every rung's numbers, ``_low``, ``_high`` and ``_apart``, and its speeds.

    Args:
        record: record with what ``run_ladder`` returned.
        length: length of the robot [m].
    """
    yield from _of_rungs(record, length)
    for motion in MOTIONS:
        misfit = float(record.taken_away.sel(ladder_motion=motion))
        yield f"misfit_{motion.replace(' ', '_')}_as_taken", Measure(misfit, "-")
    yield "space_grids", Measure(float(len(json.loads(record.attrs["grids"]).get("cells", [0]))), "-")


def _of_rungs(record: xr.Dataset, length: float) -> Iterator[tuple[str, Measure]]:
    """Yield by rung the speeds, and each number with its bounds and its spread.

    In three dimensions the bounds include those of the stored study of grids.

    Args:
        record: record of ``run_ladder``.
        length: length of the robot [m].
    """
    grids = json.loads(record.attrs["grids"])
    for name in record.rung.values:
        rung = record.sel(rung=name)
        for motion in MOTIONS:
            speed = settled_mean(rung.ladder_speed.sel(ladder_motion=motion).values)
            yield f"speed_{motion.replace(' ', '_')}_{name}", Measure(speed.mean, "m/s")
            yield f"unsettled_{motion.replace(' ', '_')}_{name}", Measure(float(not speed.is_settled), "-")
        for quantity, (value, lower_bound, upper_bound, spread) in _numbers(rung, length):
            ends = grids.get("measures", {}).get(quantity, ()) if name == "space" else ()
            number_by_ending = {
                "": value,
                "_low": min(lower_bound, *ends, lower_bound),
                "_high": max(upper_bound, *ends, upper_bound),
                "_apart": spread,
            }
            for end, number in number_by_ending.items():
                yield (
                    f"{quantity}_{name}{end}",
                    Measure(number, "rad" if "angle" in quantity and end != "_apart" else "-"),
                )


def _numbers(rung: xr.Dataset, length: float) -> Iterator[tuple[str, SettledNumber]]:
    """Yield every number of one rung by name.

    Args:
        rung: record of one rung.
        length: length of the robot [m].
    """
    cycles = rung.sizes["ladder_cycle"]
    whole_speed, tail, trunk = (rung.ladder_speed.sel(ladder_motion=motion).values for motion in MOTIONS)

    def gain(partial_speed: np.ndarray) -> SettledNumber:
        """Return the fraction of the speed that is missing without a part of the motion."""

        def share(a: int, b: int) -> list[float]:
            whole_mean = float(whole_speed[a:b].mean())
            return [(whole_mean - float(partial_speed[a:b].mean())) / abs(whole_mean) if whole_mean else nan]

        means = [settled_mean(speeds) for speeds in (whole_speed, partial_speed)]
        start = max(mean.start for mean in means) if all(mean.is_settled for mean in means) else 1
        return settle(share, cycles, min_start=max(start, 1))

    yield "gain_tail_share", gain(trunk)
    yield "gain_spine_share", gain(tail)
    yield from _swaying(rung.ladder_centre.values / length, cycles)
    yield from _waving(rung.ladder_course.values / length, cycles)
    yield from _pressing(rung.ladder_difference.values, cycles)
    yield from _pushing(np.stack([rung.ladder_thrust.values, rung.ladder_aside.values], axis=-1), cycles)


def _swaying(centre: np.ndarray, cycles: int) -> Iterator[tuple[str, SettledNumber]]:
    """Yield the sway amplitude of the centre of mass, and the part of its track that is no sine [body length]."""

    def sway(a: int, b: int) -> Sway:
        return Sway.from_track(centre[a * TICKS : b * TICKS + 1], b - a)

    size = max(sway(1, cycles).amplitude, MIN_VISIBLE_SWAY) if isfinite(centre.sum()) else nan
    yield "track_sway", settle(lambda a, b: [sway(a, b).amplitude], cycles, size)
    yield "track_noise", settle(lambda a, b: [sway(a, b).noise], cycles, size)


def _waving(course: np.ndarray, cycles: int) -> Iterator[tuple[str, SettledNumber]]:
    """Yield the sine fraction of the tip's swing, and the wave of the form (20) that fits the midline best.

    Args:
        course: lateral position of the midline, shape (tick, place) [body length].
        cycles: number of cycles of the swim [-].
    """
    names = ("wave_share", "wave_waves_per_body", "wave_envelope_middle", "wave_envelope_tip")

    def wave(a: int, b: int) -> tuple[float, ...]:
        excerpt = np.ascontiguousarray(course[a * TICKS : b * TICKS + 1])
        return _wave(excerpt.tobytes(), course.shape[1], b - a)

    def tip(a: int, b: int) -> list[float]:
        cycle_courses = [course[i * TICKS : (i + 1) * TICKS + 1, -1:] for i in range(a, b)]
        return [float(np.mean([swing(cycle_course, 1).variance_fraction[0] for cycle_course in cycle_courses]))]

    is_moving = float(np.ptp(course[:, -1])) > 0.0  # neither NaN nor at rest
    no_number = SettledNumber(nan, nan, nan, nan)
    yield "tail_sine_share", settle(tip, cycles) if is_moving else no_number
    size = wave(1, cycles)[-1] if is_moving else nan

    def wave_component(index: int, a: int, b: int) -> list[float]:
        return [wave(a, b)[index]]

    for i, (name, scale) in enumerate(zip(names, (1.0, 1.0, size, size), strict=True)):
        yield name, settle(partial(wave_component, i), cycles, scale) if is_moving else no_number


@lru_cache(maxsize=1024)  # a ladder asks for some 60 waves, again for each rung, its table and its measures
def _wave(course: bytes, places: int, cycles: int) -> tuple[float, float, float, float]:
    """Return the wave of the form (20) that fits a part of a midline's course best.

    Args:
        course: bytes of the lateral positions, shape (tick, place) [body length].
        places: number of places along the body [-].
        cycles: number of cycles [-].

    Returns:
        Share of the swing that is the wave [-], waves per body [-], amplitudes at the middle and the tip [body length].
    """
    excerpt = np.frombuffer(course).reshape(-1, places)
    side = 1.0 if excerpt[0, -1] >= excerpt[:-1, -1].mean() else -1.0  # so that a mirrored swim gives the same bytes
    swing_fit = swing(side * excerpt, cycles)
    linear, quadratic, waves, share = wave_form(np.linspace(0.0, 1.0, places), swing_fit.amplitude, swing_fit.phase_lag)
    sine = float(np.average(swing_fit.variance_fraction, weights=swing_fit.amplitude**2))
    return sine * share, waves, abs(0.5 * linear + 0.25 * quadratic), abs(linear + quadratic)


def _pressing(difference: np.ndarray, cycles: int) -> Iterator[tuple[str, SettledNumber]]:
    """Yield the pressure difference of the tail's sides at T/4, and its fall to 3T/4, over its mean size [-].

    A swim that starts to the other side is the mirror image of this one: it does at T/4 what this one does at 3T/4.

    Args:
        difference: mean pressure difference, shape (cycle, quarter).
        cycles: number of cycles of the swim [-].
    """
    size = float(np.sort(np.abs(difference[1:]), axis=None).mean())

    def quarter_differences(a: int, b: int) -> tuple[float, float]:
        first_quarter, third_quarter = difference[a:b, [0, 2]].mean(axis=0) / size
        return float(first_quarter), float(third_quarter)

    def fall(a: int, b: int) -> list[float]:
        first_quarter, third_quarter = quarter_differences(a, b)
        return [abs(first_quarter) - abs(third_quarter), abs(third_quarter) - abs(first_quarter)]

    yield "pressure_convex_share", settle(lambda a, b: [*quarter_differences(a, b)], cycles)
    yield "pressure_fall_share", settle(fall, cycles)


def _pushing(force: np.ndarray, cycles: int) -> Iterator[tuple[str, SettledNumber]]:
    """Yield angle, asymmetry and forward part of the force at the quarters, for a start to either side.

    Args:
        force: forward and lateral, shape (cycle, quarter, 2).
        cycles: number of cycles of the swim [-].
    """
    size = float(np.sort(np.hypot(force[1:, :, 0], force[1:, :, 1]), axis=None).mean())

    def sides(a: int, b: int) -> list[tuple[np.ndarray, np.ndarray]]:
        first_quarter, third_quarter = force[a:b, 0].mean(axis=0), force[a:b, 2].mean(axis=0)
        return [(first_quarter, third_quarter), (third_quarter * (1.0, -1.0), first_quarter * (1.0, -1.0))]

    def angle(first_quarter: np.ndarray, third_quarter: np.ndarray) -> float:
        del third_quarter
        return float(np.arctan2(abs(first_quarter[1]), first_quarter[0]))

    def asymmetry(first_quarter: np.ndarray, third_quarter: np.ndarray) -> float:
        difference, peak_force = np.abs(first_quarter - third_quarter * (1.0, -1.0)).max(), np.abs(first_quarter).max()
        return float(difference / peak_force) if peak_force > 0.0 else nan

    def forward(first_quarter: np.ndarray, third_quarter: np.ndarray) -> float:
        del first_quarter
        return float(third_quarter[0]) / size

    def both_sides(component: Callable[[np.ndarray, np.ndarray], float], a: int, b: int) -> list[float]:
        return [component(*pair) for pair in sides(a, b)]

    yield "force_angle_1_quarter", settle(partial(both_sides, angle), cycles, pi / 2)
    yield "thrust_asymmetry", settle(partial(both_sides, asymmetry), cycles)
    yield "thrust_3_quarter_share", settle(partial(both_sides, forward), cycles)


def table(numbers: Mapping[str, float], unable: Mapping[str, str]) -> str:
    """Return the ladder of every claim as Markdown: what each model says of this robot's swim, and why."""
    lines = ["# What each model says", ""]
    for rule in RULES:
        lines += [f"## {rule.claim}: `{rule.measure}`", "", "| model | number | says | why |", "|---|---|---|---|"]
        rows = ladder.rows(ladder.voices(rule, numbers, unable), rule.form)
        lines += [f"| {row['model']} | {row['number']} | {row['says']} | {row['why']} |" for row in rows] + [""]
    return "\n".join(lines)

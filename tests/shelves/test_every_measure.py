"""A test of the tests: what measures compute is broken in every way that could hide a wrong number.

Each function of an experiment that reads measures from its record is broken once at every place: the least for the
greatest, the first for the last, one of two that are compared for the other; so are the tables of conditions that are
compared. The record stays, nothing is simulated anew. A break is noticed if a number is another, beyond what the kept
numbers of ``tests/golden`` allow, or none.
"""

import ast
import inspect
import json
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from copy import deepcopy
from dataclasses import replace
from textwrap import dedent
from types import CodeType, FunctionType, ModuleType
from typing import Any

import numpy as np
import pytest
import xarray as xr
from tests.experiments.test_swim_ladder import rung

from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.swimming.rules import LADDER
from suchus.experiments.experiment import Measure
from suchus.robot.motion import START

NAMES = [name for name, one in EXPERIMENTS.items() if one.rules()]
LONG = [pytest.mark.slow("more than ten seconds: each measure of 24 swims is broken at every place")]
SAME = 1e-6
"""Relative difference up to which a measure is the same [-]."""
_LEAST = {
    "min": "max",
    "amin": "amax",
    "nanmin": "nanmax",
    "argmin": "argmax",
    "idxmin": "idxmax",
    "minimum": "maximum",
}
_OTHER = _LEAST | {greatest: least for least, greatest in _LEAST.items()}
_MORE_CYCLES = 3
"""Cycles that are added by hand to a walk of one cycle after a disturbance [-]."""
_SIZE = "Its size or its square is taken, which has no sign."
_ONE_RUN = "What is read there holds one run."
_ONE_SWIM = "In its quick form it swims once."
_ANY_PERIOD = "The mean posture of a cycle is read, which is the same at any frequency."
_ONE_WATER = "In its quick form no other water is tried, and both ends are of the one there is."
EXCUSED: Mapping[str, Mapping[str, str]] = {
    "gait_diagram": {
        "measure: float(phase.sel(leg=leg)) - _ANIMAL_PHASES[leg] the other way round": _SIZE,
        "_harmonic: values - values.mean() the other way round": "Lag and gain are of quotients of two of these.",
        "_period: load[n:] - load[:-n] the other way round": _SIZE,
        "_period: min(int(1.5 * period / step), len(load) - 2) is max": "The best shift is shorter than both.",
    },
    "pattern_generator": {
        "_turn_measures: measures['turn_asymmetry'].value - measu ... traight'].value the other way round": _SIZE,
        "_TURNS: straight asymmetry the other way round": "Which walks are run, in whatever order.",
        "_lock_measures: cycle.dims[0] is the last": "A cycle's index is all that the error of a start is over.",
    },
    "salamander": {
        "window: record.period[0] is the last": "All of its runs are of one gait.",
        "axis_wave_measures: mean_cycles['walk'] - mean_cycles['commanded'] the other way round": _SIZE,
    },
    "salamander_swim": {
        "measure: other_strides.min() is max": _ONE_WATER,
        "measure: other_strides.max() is min": _ONE_WATER,
        "measure: record.missed.max() is min": _ONE_SWIM,
        "measure: record.heel.max() is min": _ONE_SWIM,
        "animal_gait: 1.0 / frequency the other way round": _ANY_PERIOD,
        "trim_submerged: FREQUENCIES[0] is the last": _ANY_PERIOD,
    },
    "swimming": {
        **{
            f"_VOICE_STYLES: {colour} {sign} the other way round": "Colours and signs of a figure, and no measure."
            for colour, sign in (("#cfe8d5", "✓"), ("#f3d0c9", "×"), ("#f6e8b8", "?"), ("#ececec", ""))
        },
        "_waving: swing(cycle_course, 1).variance_fraction[0] is the last": (
            "What is read there is the tip's position alone."
        ),
        **dict.fromkeys(
            (
                "settle: min(MIN_SETTLED_CYCLES, cycles - 1) is max",
                "_numbers: max((mean.start for mean in means)) is min",
                "_numbers: max(start, 1) is min",
            ),
            "Of ten cycles, as they are here, eight count either way; test_swim_ladder.py looks at it.",
        ),
        "_pushing: first_quarter - third_quarter * (1.0, -1.0) the other way round": _SIZE,
    },
    "swim_free": {
        **dict.fromkeys(
            (
                "flow_measures: record.flow_radius.max() is min",
                "flow_measures: fin_swims.speed.min() is max",
                "flow_measures: fin_swims.cost.min() is max",
                "flow_measures: abs(cycles_record[name]).max(skipna=False) is min",
                "flow_measures: float(record.flow_time[-1]) - period the other way round",
                "flow_measures: record.flow_time[-1] is the first",
                "flow_measures: half.max() / half.mean() the other way round",
                "flow_measures: half.max() is min",
                "flow_measures: kind_record.residual_rms.max() is min",
                "flow_measures: speed.high - speed.low the other way round",
            ),
            "In its quick form nothing swims in a flow; test_swim_in_flow.py looks at it.",
        ),
        **dict.fromkeys(
            (
                "_steered_start: 1.0 / record.attrs['frequency'] the other way round",
                "_forward_speeds: 1.0 / swim.attrs['frequency'] the other way round",
            ),
            "The frequency is 1 Hz.",
        ),
        **dict.fromkeys(("measure: min(waters) is max", "measure: max(waters) is min"), _ONE_WATER),
        **dict.fromkeys(
            (
                "measure: whole_swim.tail_tip - whole_swim.centre_of_mass the other way round",
                "measure: fine - speed['whole'] the other way round",
                "measures: record.deep_depth.sel(dive=name).values - depth the other way round",
                "measures: swim.deep_depth.values - depth the other way round",
            ),
            _SIZE,
        ),
        "measure: means[label].high - means[label].low the other way round": (
            "In its quick form no swim is settled, and the interval is unknown."
        ),
        "measures: far_samples[-1] is the first": "In its quick form no dive has ended.",
    },
    "joint_loops": {"_loop_errors: float(angle.sel(test='step')[-1]) - step the other way round": _SIZE},
    "displacement": {
        "_GAINS: policy policy coordinated the other way round": (
            "In its quick form no policy walks; tests/control/test_learned.py has one that does."
        ),
    },
    "gallop_limits": {
        "_min_paying_speed: speeds[all_faster_pay][0] is the last": "In its quick form one speed pays at most."
    },
    "joint_faults": {"_effects: change.sel({dim: a}) - change.sel({dim: b}) the other way round": _SIZE},
    "bipedal_reach": {
        "min_lead: run=0 is the last": _ONE_RUN,
        "measure: run=0 is the last": _ONE_RUN,
    },
    "terrain": {
        "_most_tilt: abs(angles['pitch']).max('time') is min": "In its quick form the roll is the greater tilt.",
        "_rough_measures: rough_record.forward / even_distances the other way round": (
            "In its quick form not all robots come to what stands in their path, so that nothing is said; "
            "test_terrain_experiments.py says something."
        ),
    },
    "feedback": {
        "_loop_measures: _last_seconds(pitch, gait.period).mean() ... .period).mean() the other way round": _SIZE,
        "_undisturbed_measures: first_cycles.isel(time=-1) - first_cycles.isel(time=0) the other way round": (
            "Both ends of a quotient."
        ),
    },
}
"""By experiment the breaks that no measure of its quick form notices, and why that hides nothing."""


@pytest.mark.parametrize("name", [pytest.param(name, marks=LONG * (name == "swimming")) for name in NAMES])
def test_every_way_to_break_a_measure_changes_a_number(name, quick_outcome):
    record = _MORE.get(name, lambda one: one)(quick_outcome(name).record)
    survived = [broken for broken, noticed in tried(name, record) if not noticed]
    assert set(survived) == set(EXCUSED.get(name, {}))


def test_a_break_that_is_noticed_and_one_that_is_not():
    """So that a search that finds no survivor has looked."""
    source = "def number(values):\n    unread = min(values)\n    return max(values) - values[0]\n"
    function, space = _made(ast.parse(source).body[0], {})
    told = {what: _made(broken, space)[0]([1.0, 5.0, 2.0]) for what, broken in breaks(ast.parse(source).body[0])}
    assert function([1.0, 5.0, 2.0]) == 4.0
    assert told == {
        "number: max(values) is min": 0.0,
        "number: max(values) - values[0] the other way round": -4.0,
        "number: values[0] is the last": 3.0,
        "number: min(values) is max": 4.0,
    }


def swum_on(record: xr.Dataset) -> xr.Dataset:
    """Return the record of a quick swim with one more cycle of the held one, and ten of each rung, made by hand.

    Two cycles settle no rung, so that the quick form has no numbers of its ladder.
    """
    settled = [name for name in record.data_vars if "held_settled" in record[name].dims]
    longer = xr.concat([record[settled], 1.1 * record[settled]], "held_settled").assign_coords(held_settled=[1, 2])
    rungs = []
    for i, name in enumerate(LADDER):
        one = rung(speeds=(0.2 + 0.01 * i, 0.25, 0.03), sway=0.02, drift=0.01 * i)
        grown = {
            what: one[what] * (1.0 + 0.01 * one[dim] / one.sizes[dim])
            for what, dim in (("ladder_centre", "ladder_tick"), ("ladder_course", "ladder_tick"))
        }
        grown["ladder_aside"] = 1.05 * one.ladder_aside  # no two numbers are alike by chance
        rungs.append(one.assign(grown).assign_coords(rung=[name]).drop_vars("taken_away"))
    ladder = xr.concat(rungs, "rung")
    grids = {"cells": [48, 68], "measures": {key: [-0.5, 0.9] for key in ("gain_tail_share", "track_sway")}}
    kept = record.drop_dims(["held_settled", "ladder_cycle", "ladder_tick", "ladder_place", "ladder_quarter"])
    return xr.merge([kept, longer, ladder], join="exact").assign_attrs(record.attrs | {"grids": json.dumps(grids)})


def outdone(record: xr.Dataset) -> xr.Dataset:
    """Return the record of a quick walk in which the robot that switches is behind the best, farther on each ground."""
    behind = xr.ones_like(record.forward)
    behind.loc[{"arm": "switching"}] = 1.0 - 0.1 * np.arange(1, record.sizes["ground"] + 1)[:, None]
    return record.assign(forward=record.forward * behind)


def walked_on(record: xr.Dataset) -> xr.Dataset:
    """Return the record of quick disturbances with three more cycles after them, made by hand.

    With one cycle the last is the first after the disturbance, too. Each further one goes on from the one before, a
    part faster; what limbs, spine and tail lack grows. Kicked limbs are back in step for the last 0.6 cycles.
    """
    gait = EXPERIMENTS["feedback"].quick().gait
    timed = record[[name for name in record.data_vars if "time" in record[name].dims]]
    begun = timed.sel(time=START + gait.period, method="nearest")
    first = timed.sel(time=slice(float(begun.time) + 1e-9, None))
    moved = first.isel(time=-1) - begun
    later = [
        (first * (1.0 + 0.1 * k) + moved * k).assign_coords(time=first.time + k * gait.period)
        for k in range(1, _MORE_CYCLES + 1)
    ]
    longer = xr.concat([timed, *later], "time").transpose(*timed.limb_phase.dims)
    back = longer.time > float(longer.time[-1]) - 0.6 * gait.period
    kicked = {"disturbance": "kick", "arm": "closed"}
    right = xr.zeros_like(longer.limb_phase.loc[kicked]) + np.array(gait.limb_phases)
    longer.limb_phase.loc[kicked] = longer.limb_phase.loc[kicked].where(~back, right)
    return xr.merge([record.drop_dims("time"), longer], join="exact").assign_attrs(record.attrs)


def unlocked(record: xr.Dataset) -> xr.Dataset:
    """Return the record of quick starts of which the last never locks."""
    return record.assign(
        {name: record[name] + np.eye(len(record[name]))[-1][:, None] for name in ("walk_error", "swim_error")}
    )


_MORE: Mapping[str, Callable[[xr.Dataset], xr.Dataset]] = {
    "swimming": swum_on, "terrain": outdone, "pattern_generator": unlocked, "feedback": walked_on,
}  # fmt: skip
"""What is done to records of quick forms in which two things are the same that need not be."""
_ASKED: Mapping[str, Mapping[str, Any]] = {"feedback": {"hold": 0.75, "after": 1 + _MORE_CYCLES}}
"""Fields of questions whose records were made longer."""


def tried(name: str, record: xr.Dataset) -> Iterator[tuple[str, bool]]:
    """Yield every break of the functions that read the record, and whether a number noticed."""
    question = replace(EXPERIMENTS[name].quick(), **_ASKED.get(name, {}))
    with _called(question) as codes:
        whole = _numbers(question.measure, record)
    for what, module, table, broken in swapped(question):
        kept = getattr(module, table)
        setattr(module, table, broken)
        try:
            yield what, not _same(whole, _numbers(question.measure, record))
        finally:
            setattr(module, table, kept)
    for module, owner, function in _functions(question):
        measures = function.__code__ in codes
        numbers = whole if measures else _of_a_record(function, record)
        if numbers is None:
            continue
        for what, broken in breaks(_tree(function)):
            made, _ = _made(broken, vars(module))
            kept = inspect.getattr_static(owner, function.__name__)
            holders = [owner, *(one for one in _modules(question) if vars(one).get(function.__name__) is kept)]
            for holder in holders:  # modules that imported it call it by their own name for it
                setattr(holder, function.__name__, made)
            try:
                found = _numbers(question.measure if measures else made, record)
            except Exception:
                found = {}
            finally:
                for holder in holders:
                    setattr(holder, function.__name__, kept)
            yield what, not _same(numbers, found)


def swapped(question: Any) -> Iterator[tuple[str, ModuleType, str, Any]]:
    """Yield tables of what is compared with what, one row of which has its last two names exchanged."""
    for module in _modules(question):
        for name, table in vars(module).items():
            rows = list(table.values()) if isinstance(table, dict) else list(table) if isinstance(table, tuple) else []
            pairs = [
                isinstance(row, tuple) and len(row) > 1 and all(isinstance(one, str) for one in row) for row in rows
            ]
            if not rows or not all(pairs) or (isinstance(table, tuple) and any(len(row) < 3 for row in rows)):
                continue
            for i, row in enumerate(rows):
                other = [*rows[:i], (*row[:-2], row[-1], row[-2]), *rows[i + 1 :]]
                broken = dict(zip(table, other, strict=True)) if isinstance(table, dict) else tuple(other)
                yield f"{name}: {' '.join(row)} the other way round", module, name, broken


def breaks(tree: ast.FunctionDef) -> Iterator[tuple[str, ast.FunctionDef]]:
    """Yield what was done to a function, and the broken function."""
    for i, node in enumerate(ast.walk(tree)):
        told = _broken(node)
        if told is not None:
            copy = deepcopy(tree)
            at = next(one for j, one in enumerate(ast.walk(copy)) if j == i)
            _break(at)
            yield f"{tree.name}: {told}", copy


def _broken(node: ast.AST) -> str | None:
    """Return what would be done to a node, or None."""
    if isinstance(node, ast.Call) and _word(node.func) in _OTHER:
        return f"{_short(node)} is {_OTHER[_word(node.func)]}"
    if isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Sub, ast.Div)):
        one_less = isinstance(node.right, ast.Constant)
        return None if one_less else f"{_short(node)} the other way round"
    if isinstance(node, ast.Subscript) and _first_or_last(node.slice) is not None:
        return f"{_short(node)} is the {'last' if _first_or_last(node.slice) == 0 else 'first'}"
    if (
        isinstance(node, ast.keyword)
        and node.arg in ("run", "time", "cycle")
        and _first_or_last(node.value) is not None
    ):
        return f"{node.arg}={ast.unparse(node.value)} is the {'last' if _first_or_last(node.value) == 0 else 'first'}"
    return None


def _break(node: ast.AST) -> None:
    if isinstance(node, ast.Call):
        where = node.func
        if isinstance(where, ast.Attribute):
            where.attr = _OTHER[where.attr]
        elif isinstance(where, ast.Name):
            where.id = _OTHER[where.id]
    elif isinstance(node, ast.BinOp):
        node.left, node.right = node.right, node.left
    elif isinstance(node, ast.Subscript):
        node.slice = _other_end(node.slice)
    elif isinstance(node, ast.keyword):
        node.value = _other_end(node.value)


def _word(node: ast.expr) -> str:
    return node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""


def _first_or_last(node: ast.expr) -> int | None:
    text = ast.unparse(node)
    return int(text) if text in ("0", "-1") else None


def _other_end(node: ast.expr) -> ast.expr:
    return ast.parse("-1" if _first_or_last(node) == 0 else "0", mode="eval").body


def _short(node: ast.AST) -> str:
    text = " ".join(ast.unparse(node).split())
    return text if len(text) <= 60 else f"{text[:40]} ... {text[-15:]}"


@contextmanager
def _called(question: Any) -> Iterator[set[CodeType]]:
    """Note which functions of the question's own package run."""
    found: set[CodeType] = set()
    package = type(question).__module__.removesuffix(".experiment")

    def note(frame: Any, event: str, _: Any) -> None:
        if event == "call" and str(frame.f_globals.get("__name__", "")).startswith(package):
            found.add(frame.f_code)

    sys.setprofile(note)
    try:
        yield found
    finally:
        sys.setprofile(None)


def _modules(question: Any) -> list[ModuleType]:
    package = type(question).__module__.removesuffix(".experiment")
    return [one for name, one in sorted(sys.modules.items()) if f"{name}.".startswith(f"{package}.")]


def _functions(question: Any) -> Iterator[tuple[ModuleType, Any, FunctionType]]:
    """Yield module, owner and function of the question's own package."""
    for module in _modules(question):
        classes = [one for one in vars(module).values() if inspect.isclass(one) and one.__module__ == module.__name__]
        for owner in (module, *classes):
            for held in list(vars(owner).values()):
                function = getattr(held, "__func__", held)
                if isinstance(function, FunctionType) and function.__module__ == module.__name__:
                    yield module, owner, function


def _of_a_record(function: FunctionType, record: xr.Dataset) -> dict[str, float] | None:
    """Return what a function reads of a record, as those do that a run calls for each robot; None of another."""
    parameters = inspect.signature(function).parameters
    if [one.annotation for one in parameters.values()] != [xr.Dataset]:
        return None
    try:
        return _numbers(function, record) or None
    except Exception:
        return None


def _tree(function: FunctionType) -> ast.FunctionDef:
    tree = ast.parse(dedent(inspect.getsource(function))).body[0]
    assert isinstance(tree, ast.FunctionDef)
    return tree


def _made(tree: ast.FunctionDef, space: Mapping[str, Any]) -> tuple[Callable[..., Any], dict[str, Any]]:
    """Return what a function is, made of its source in a copy of its module's names."""
    names = dict(space)
    module = ast.fix_missing_locations(ast.Module(body=[tree], type_ignores=[]))
    exec(compile(module, f"<{tree.name}, broken>", "exec"), names)
    return names[tree.name], names


def _numbers(read: Callable[[xr.Dataset], Any], record: xr.Dataset) -> dict[str, float]:
    """Return every number that is read of a record, by name."""
    return dict(_flat("", read(record)))


def _flat(name: str, value: Any) -> Iterator[tuple[str, float]]:
    if isinstance(value, Mapping):
        for key, one in value.items():
            yield from _flat(f"{name} {key}", one)
    elif isinstance(value, (list, tuple)):
        for i, one in enumerate(value):
            yield from _flat(f"{name} {i}", one)
    elif isinstance(value, Measure):
        yield name, float(value.value)
    elif isinstance(value, (bool, int, float, np.ndarray, np.generic, xr.DataArray)):
        for i, one in enumerate(np.asarray(value, float).ravel()):
            yield f"{name} {i}", float(one)


def _same(whole: Mapping[str, float], broken: Mapping[str, float]) -> bool:
    if set(whole) != set(broken):
        return False
    one, other = (np.array([numbers[name] for name in whole]) for numbers in (whole, broken))
    return bool(np.allclose(one, other, rtol=SAME, atol=0.0, equal_nan=True))

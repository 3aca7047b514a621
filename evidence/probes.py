"""Probes: what the code does in a few seconds, by which a stored result is compared with the code of today.

A probe returns numbers by name. It takes the path that the result takes, in its shortest form: the measures of an
experiment's quick form, the first steps of a flow on a coarse grid, the first generation of a search.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from functools import cache
from typing import Any
from unittest import mock

import numpy as np

from evidence.atlas import CASES
from evidence.league import find
from evidence.league.cases import CONTESTANTS
from suchus import flow
from suchus.core.errors import SuchusError
from suchus.core.progress import silent
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.optimise import READY
from suchus.experiments.optimise.evaluate import evaluate
from suchus.experiments.study.chunk import run_chunk
from suchus.experiments.study.claims import Claims
from suchus.hardware import cases, loads_of_cases
from suchus.robot.gaits import GAITS
from suchus.robot.motion import cycle_targets
from suchus.robot.robots import ROBOTS
from suchus.swimming.water import fit, printed_wave

Numbers = Mapping[str, float]
"""What a probe gives: numbers by name."""
STEPS = 4
"""Steps that a probe takes of a flow [-]."""
PLANE = ("started_re550", "in_line", "settling", "flapping", "cavity_re400")
"""Flows of the atlas whose first steps stand for the flow solver in the plane."""
ATLAS = (
    "cavity_re400", "dfg_2d1", "settling", "started_re40", "started_re1000", "turning_re200", "steady_re40", "in_line",
    "flapping", "shaken_1", "pitching", "snake_30_re1000", "oscillating_sphere",
)  # fmt: skip
"""Flows whose first steps stand for the atlas: one of each kind."""
SPACE = ("oscillating_sphere",)
"""Those that stand for it in space."""


def flat(value: Any, path: str = "") -> dict[str, float]:
    """Return all numbers of nested mappings and lists by their paths; texts are left out, and None is NaN.

    Args:
        value: a number, or mappings and lists of numbers.
        path: of the value within the whole.
    """
    if isinstance(value, Mapping | list | tuple):
        items = value.items() if isinstance(value, Mapping) else enumerate(value)
        inner = (flat(part, f"{path}_{key}" if path else str(key)) for key, part in items)
        return {name: number for numbers in inner for name, number in numbers.items()}
    return {} if isinstance(value, str) else {path: float("nan") if value is None else float(value)}


def experiment(name: str) -> Numbers:
    """Return the measures of an experiment's quick form."""
    return _quick(name)


@cache
def _quick(name: str) -> Numbers:
    return {key: float(measure.value) for key, measure in EXPERIMENTS[name].quick().run().measures.items()}


class _Enough(SuchusError):
    """The first steps of a flow have been taken."""


@contextmanager
def _first_steps(count: int) -> Iterator[list[flow.Simulation]]:
    """While the block runs, let each flow take a few steps and end; yield the flows that did."""
    taken: list[flow.Simulation] = []

    def run(sim: flow.Simulation, *_: object, **__: object) -> None:
        for _ in range(count):
            sim.advance()
        taken.append(sim)
        raise _Enough("the probe has what it needs.")

    with mock.patch.object(flow.Simulation, "run", run):
        yield taken


def first_steps(names: Sequence[str], count: int = STEPS) -> Numbers:
    """Return forces, speeds and energy after the first steps of flows of the atlas, on the grids of their trials.

    Args:
        names: of the flows.
        count: number of steps.
    """
    numbers: dict[str, float] = {}
    for name in names:
        numbers |= {f"{name}_{quantity}": value for quantity, value in _started(name, count).items()}
    return numbers


@cache
def _started(name: str, count: int) -> Numbers:
    case = CASES[name]
    with _first_steps(count) as taken, suppress(_Enough):
        case.run(case.quick_effort, silent)
    (sim,) = taken
    return flow_state(sim)


def flow_state(sim: flow.Simulation) -> Numbers:
    """Return what a flow has come to: time, kinetic energy, and of each body its force and its speed."""
    layer = sim.water.layers[-1]
    energy = sum(float(np.square(component, dtype=float).mean()) for component in layer.velocity)
    numbers = {"time": float(sim.time), "energy": energy}
    for body in sim.setup.bodies:
        loads = sim.last_loads(body.name).total
        numbers |= {f"{body.name}_force_{axis}": float(value) for axis, value in zip("xyz", loads.force, strict=False)}
    for name in sim.swimmers:
        velocity = sim.pose(name).velocity
        numbers |= {f"{name}_velocity_{axis}": float(value) for axis, value in zip("xyz", velocity, strict=False)}
    return numbers


def search(name: str, candidates: int = 4, duration: float = 2.5) -> Numbers:
    """Return what the first candidates of a search reach: its aims and limits, of each condition.

    Args:
        name: of the search.
        candidates: how many are tried of each condition, evenly from the least to the greatest of all ranges.
        duration: of each walk [s].
    """
    spec = replace(READY[name](), duration=duration)
    numbers: dict[str, float] = {}
    for arm in spec.arms:
        of_arm = spec.for_arm(arm)
        shares = np.tile(np.linspace(0.35, 0.65, candidates)[:, None], len(of_arm.vary))
        table = evaluate(of_arm, shares)
        for key, values in table.data_vars.items():
            if values.dtype.kind == "f" and values.dims == ("candidate",):
                numbers |= {f"{arm.name}_{key}_{k}": float(value) for k, value in enumerate(values.values)}
    return numbers


def claims(samples: int = 2, cycles: int = 1) -> Numbers:
    """Return what a few designs of the study of the claims measure: means over designs and conditions.

    Args:
        samples: number of designs.
        cycles: of each walk.
    """
    asked = Claims(samples=samples, together=samples, cycles=cycles)
    table = run_chunk(asked.study(samples, timestep=0.01), 0)
    columns = {key: values.values for key, values in table.data_vars.items() if values.dtype.kind == "f"}
    return {key: float(np.nanmean(column)) for key, column in columns.items() if np.isfinite(column).any()}


def predictions(names: Sequence[str] = ("salamandra_walk", "alligator_roll")) -> Numbers:
    """Return what the cheapest model of some benchmark cases predicts with the most likely numbers.

    Args:
        names: of the cases.
    """
    numbers: dict[str, float] = {}
    for name in names:
        case = find(CONTESTANTS, name)
        model, predictor = next((key, one) for key, one in case.rungs.items() if one.draws)
        (answer,) = predictor.work([case.likely], silent)
        for quantity, value in answer.items():
            parts = np.atleast_1d(np.asarray(value, float))
            numbers |= {f"{name}_{model}_{quantity}_{k}": float(part) for k, part in enumerate(parts)}
    return numbers


def wave_fit() -> Numbers:
    """Return the misfit [-] between the article's robot and a body wave, and the swing of each servo [rad]."""
    robot = ROBOTS["caiman"]
    match = fit(robot, printed_wave(robot, "I"))
    targets = cycle_targets(robot, match.gait, np.linspace(0.0, 1.0, 50, endpoint=False))
    return {"misfit": float(match.misfit)} | {f"swing_{k}": float(np.ptp(angle)) for k, angle in enumerate(targets.T)}


def servo_loads(gait: str = "belly_crawl", cycles: float = 0.5) -> Numbers:
    """Return what the servos of the article's robot bear in a part of a walk.

    Args:
        gait: of the walk.
        cycles: length of the walk [-].
    """
    robot = ROBOTS["caiman"]
    (case,) = cases(robot, [GAITS[gait]])
    (loads,) = loads_of_cases(robot, [replace(case, seconds=cycles * case.gait.period)], timestep=0.005)
    return {f"{name}_{key}": float(getattr(load, key)) for name, load in loads.items() for key in ("at_limit", "off")}

"""Conducting a search: each generation is stored, and the best so far is always on disk.

At the end the best is checked with a finer time step, on other ground and from other starts, and each field is varied
around it.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from math import ceil
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from suchus.core import large
from suchus.core.errors import IncompatibleRecord, NotConverged
from suchus.core.jobs import LAND_SOURCES, InMemory, Job, Place, Store, Tally, finish, place_for, source_versions
from suchus.core.progress import Progress, portion, silent
from suchus.experiments.optimise.aims import AIMS
from suchus.experiments.optimise.evaluate import columns, evaluate, is_allowed, losses, measure, score, units
from suchus.experiments.optimise.search import SearchResult, search, titled
from suchus.experiments.optimise.spec import Optimisation
from suchus.robot import blueprint
from suchus.robot.design import with_values
from suchus.robot.design.scale import physics_step
from suchus.sim.land import Run, Tolerances, simulate
from suchus.sim.land.extent import processor_seconds

LIBRARIES = ("cma", "comocma", "moarchiving")
"""Packages whose versions affect which candidates are evaluated."""
SOURCE_FILES = (
    *LAND_SOURCES,
    *(f"experiments/optimise/{module}.py" for module in ("aims", "clearance", "evaluate", "spec")),
)
"""Source files whose code affects the result of a candidate."""
_DECIDING = partial(source_versions, SOURCE_FILES, LIBRARIES)
_CHECK_NUMBER, _NEIGHBOURHOOD_NUMBER = (
    900_000,
    950_000,
)  # first store numbers of the checks; the number of generations is added


def optimise(
    spec: Optimisation, folder: str | Path, *, progress: Progress = silent, client: Any = None
) -> tuple[SearchResult, ...]:
    """Search each condition, check the best candidates, and return the results.

    Each finished generation is stored, so that an interruption loses at most the running one. A restarted search
    resumes and ends with the same bytes as an uninterrupted one. The best gait so far is always a file,
    ``ARM.toml``; a robot that changes too is ``ARM_robot.toml``.

    Args:
        spec: the search; with more evaluations than before, an earlier one is continued.
        folder: folder for its results and, below it, the store of each condition.
        progress: called with the condition, the number of evaluated candidates, and the best value.
        client: a ``distributed.Client``, among whose workers each generation is shared out; this process if None. The
            bytes are the same.

    Raises:
        Unwritable: the folder cannot be written to.
        IncompatibleRecord: a store below it belongs to another search or version.
        NoOptimiser: a library is missing.
        NotConverged: no evaluated candidate keeps all limits.
        NoCluster: the cluster was lost.
        InvalidDesign: the work exceeds the allowed size, see ``suchus.core.large``.
    """
    folder = Path(folder)
    place, count = place_for("a search", client=client), len(spec.arms)
    walks = count * spec.evaluations * len(spec.friction_scales)
    seconds = walks * processor_seconds(spec.run, spec.duration, spec.timestep)
    large.check_work(f"search {spec.name!r} of {walks} walks", seconds, "ask for fewer evaluations or shorter walks")
    return tuple(
        _arm(spec.for_arm(arm), folder, portion(progress, number, count), place) for number, arm in enumerate(spec.arms)
    )


def _arm(spec: Optimisation, folder: Path, progress: Progress, place: Place) -> SearchResult:
    """Search one condition, check its best candidates, and vary each field around the best.

    Args:
        spec: the search, of one condition.
        folder: folder for its results and its store.
        progress: called with the stage and the fraction that is done.
        place: where candidates are evaluated.
    """
    name = spec.arms[0].name
    with opened(spec, folder / name) as store:
        result = _searched(spec, store, folder, progress, place)
        if not result.chosen_indices:
            raise NotConverged(
                f"nothing of {result.history.sizes['candidate']} candidates of {name} keeps all limits; widen ranges "
                "or limits, or raise evaluations."
            )
        write_runs(result.spec, result.runs, folder)
        generations = int(result.history.generation.max())
        check = _stored_part(store, _CHECK_NUMBER + generations, lambda: run_checks(spec, result.runs))
        neighbourhood = _stored_part(
            store,
            _NEIGHBOURHOOD_NUMBER + generations,
            lambda: vary_around_best(spec, result.range_fractions[0], partial(try_candidates, place)),
        )
        return result.with_checks(check, neighbourhood)


@contextmanager
def opened(spec: Optimisation, folder: Path) -> Iterator[Store]:
    """Open the store of one condition; searches that differ in their budget only share it."""
    with Store(folder, replace(spec, evaluations=1), kind="optimisation", versions=_DECIDING).opened() as store:
        yield store


def try_candidates(place: Place, spec: Optimisation, shares: np.ndarray, progress: Progress = silent) -> xr.Dataset:
    """Evaluate candidates in equal parts; the result of a candidate does not depend on the other candidates.

    Args:
        place: where they are evaluated.
        spec: the search, of one condition.
        shares: as of ``evaluate``.
        progress: called with the number of evaluated candidates.

    Returns:
        As of ``evaluate``, to the same bytes.
    """
    pieces = np.array_split(shares, min(len(shares), place.at_once))
    job = Job(
        name=spec.name,
        kind="optimisation",
        piece="part of a generation",
        unit="candidates",
        work=partial(evaluate, spec),
        items=pieces,
        sizes=[len(piece) for piece in pieces],
        versions=partial(source_versions, SOURCE_FILES),
    )
    tables = InMemory[xr.Dataset]()
    finish(job, tables, place=place, progress=progress)
    return xr.concat([tables.get(number) for number in range(len(pieces))], "candidate")


def _searched(spec: Optimisation, store: Store, folder: Path, progress: Progress, place: Place) -> SearchResult:
    """Evaluate the generations that are not in the store, and return all candidates.

    Args:
        spec: the search, of one condition.
        store: store of the generations.
        folder: folder for the best gait so far.
        progress: called with the stage and the fraction that is done.
        place: where candidates are evaluated.
    """
    start = _generation(store, 0, np.array([spec.start]), lambda x: try_candidates(place, spec, x))
    parts, driver = units(spec, start), search(spec)
    name, aim = spec.arms[0].name, spec.aims[0].name
    tally = Tally(spec.evaluations, "tried", lambda stage, share: progress(f"{name}: {stage}", share))
    tables, best = [_with_generation(start, 0)], np.inf
    while tally.done < spec.evaluations:
        shares, number = driver.ask(), len(tables)
        tally.total = _whole_generations(tally.done, spec.evaluations, len(shares))
        is_stored = store.has(number)

        def tell(stage: str, share: float, number: int = number, count: int = len(shares)) -> None:
            del stage
            tally.under_way(number, share * count)

        table = _generation(store, number, shares, lambda x, tell=tell: try_candidates(place, spec, x, tell))  # type: ignore[misc]
        driver.tell(losses(spec, table, parts) if spec.pareto else score(spec, table, parts))
        tables.append(_with_generation(table, number))
        values = np.where(is_allowed(spec, table), score(spec, table, parts), np.inf)
        if values.min() < best:
            i, best = int(values.argmin()), float(values.min())
            tally.note = f"best {float(table[f'aim_{aim}'][i]):.3g} {AIMS[aim].unit}"
            if not spec.pareto and not is_stored:
                run = spec.candidate({v.field: float(s) for v, s in zip(spec.vary, shares[i], strict=True)})
                write_runs(spec, [titled(spec, run, name)], folder)
        tally.finished(number, len(shares), fresh=not is_stored)
    history = xr.concat(tables, "candidate")
    return SearchResult(
        spec=spec, start=start, history=history.assign(score=("candidate", score(spec, history, parts)))
    )


def _whole_generations(tried: float, evaluations: int, population: int) -> float:
    """Return how many candidates a search tries in all [-]: the generation in which they run out is finished.

    Args:
        tried: candidates of the finished generations [-].
        evaluations: candidates that the search may try [-].
        population: candidates of a generation from now on [-].
    """
    return tried + population * ceil((evaluations - tried) / population)


def _with_generation(table: xr.Dataset, number: int) -> xr.Dataset:
    return table.assign(generation=("candidate", np.full(table.sizes["candidate"], number)))


def _generation(
    store: Store, number: int, candidates: np.ndarray, make: Callable[[np.ndarray], xr.Dataset]
) -> xr.Dataset:
    """Return one generation, from the store if it is there.

    Args:
        store: store of the generations.
        number: number of the generation.
        candidates: fractions of the ranges, shape (candidate, field).
        make: evaluates the candidates.
    """
    table = _stored_part(store, number, lambda: make(candidates))
    if not np.array_equal(table.share.values, candidates):
        raise IncompatibleRecord(
            f"{store.part(number)} holds other candidates than the search asks for; this machine or its libraries "
            "round differently: choose another place."
        )
    return table


def _stored_part(store: Store, number: int, make: Callable[[], xr.Dataset]) -> xr.Dataset:
    """Return a part of the store, made and stored if it is missing."""
    if not store.has(number):
        store.put(number, make())
    return store.get(number)


def write_runs(spec: Optimisation, runs: Sequence[Run], folder: Path) -> None:
    """Write each run's gait as ``LABEL.toml``, and the robot where it varies as ``LABEL_robot.toml``."""
    for run in runs:
        for name, value in zip(run_files(spec, run.label), (run.gait, run.robot), strict=False):
            blueprint.write(value, folder / name)


def run_files(spec: Optimisation, label: str) -> list[str]:
    """Return the files that ``write_runs`` writes for a run: its gait, and its robot if the robot varies."""
    varies = any(vary.field.startswith("robot.") for vary in spec.vary)
    return [f"{label}.toml", *[f"{label}_robot.toml"] * varies]


Evaluate = Callable[..., xr.Dataset]
"""Tries candidates; see ``evaluate.evaluate``."""
_RANGE_STEPS = (-0.1, -0.05, 0.0, 0.05, 0.1)  # of each range


@dataclass(frozen=True, slots=True)
class Condition:
    """One condition of a check, and how it differs from the search."""

    tells: str
    """Description of the condition."""
    friction_scale: float = 1.0
    """Factor on the friction [-]."""
    tolerance_seed: int | None = None
    """Seed of the errors of a robot that is built of the design, see ``land.Tolerances``; None as designed."""
    phase_shift: float = 0.0
    """Phase by which the walk begins later in its cycle [cycle]."""


CONDITIONS = (
    Condition("2 ms"),
    Condition("foot friction 0.5", friction_scale=0.625),
    Condition("foot friction 0.65", friction_scale=0.8125),
    Condition("foot friction 1.0", friction_scale=1.25),
    Condition("a robot as built, seed 1", tolerance_seed=1),
    Condition("a robot as built, seed 2", tolerance_seed=2),
    Condition("begun a quarter of a cycle later", phase_shift=0.25),
    Condition("begun 0.4 of a cycle later", phase_shift=0.4),
)
"""All with the robot's own time step, 2 ms for the caiman. Frictions are those of the caiman, whose feet have 0.8: a
rubber foot on floors from 0.5 to 1."""


def run_checks(spec: Optimisation, runs: Sequence[Run]) -> xr.Dataset:
    """Simulate the best candidates and the start under every condition, with the robot's own time step.

    Args:
        spec: the search, of one condition.
        runs: best candidates.

    Returns:
        ``aim_...`` and ``limit_...`` along ``run`` (the chosen, then ``start``) and ``condition``; NaN where it
        diverged.
    """
    checked_runs = [*runs, replace(spec.run, label="start")]
    batch = [_run_under_condition(run, condition) for run in checked_runs for condition in CONDITIONS]
    record = simulate(batch, duration=spec.duration, timestep=physics_step(spec.run.robot), sample_stride=2)
    shape = len(checked_runs), len(CONDITIONS)
    sound = record.cause.values == ""
    return xr.Dataset(
        {
            name: (("run", "condition"), np.where(sound, values, np.nan).reshape(shape))
            for name, values in measure(spec, batch, record).items()
        },
        coords={"run": [run.label for run in checked_runs], "condition": [c.tells for c in CONDITIONS]},
    )


def _run_under_condition(run: Run, condition: Condition) -> Run:
    """Return a run under one condition of a check: other friction, later phase, or a robot built with errors."""
    phases = tuple((phase + condition.phase_shift + 1.0) % 1.0 for phase in run.gait.limb_phases)
    gait = replace(run.gait, limb_phases=phases)
    changed_run = replace(run, gait=gait if condition.phase_shift else run.gait)
    changed_run = with_values(
        changed_run, {"ground.friction_scale": run.ground.friction_scale * condition.friction_scale}
    )
    return (
        changed_run
        if condition.tolerance_seed is None
        else Tolerances().draw_run(changed_run, condition.tolerance_seed)
    )


def vary_around_best(spec: Optimisation, best: np.ndarray, evaluate_candidates: Evaluate = evaluate) -> xr.Dataset:
    """Move each field alone to both sides of the best, by a twentieth and a tenth of its range.

    Args:
        spec: the search.
        best: fractions of the ranges at the best, shape (field,).
        evaluate_candidates: function that evaluates candidates.

    Returns:
        ``share``, ``aim_...``, ``limit_...``, ``status`` over ``moved`` (which field) and ``step``.
    """
    fields = [v.field for v in spec.vary]
    points = np.array([best] * (len(fields) * len(_RANGE_STEPS))).reshape(len(fields), len(_RANGE_STEPS), -1)
    for i in range(len(fields)):
        points[i, :, i] = np.clip(best[i] + np.array(_RANGE_STEPS), 0.0, 1.0)
    table = evaluate_candidates(spec, points.reshape(-1, len(fields)))
    shape = len(fields), len(_RANGE_STEPS)
    return xr.Dataset(
        {name: (("moved", "step"), table[name].values.reshape(shape)) for name in ("status", *columns(spec))}
        | {"at": (("moved", "step"), np.array([points[i, :, i] for i in range(len(fields))]))},
        coords={"moved": fields, "step": list(_RANGE_STEPS)},
    )

"""One batch of a study: from points to a table of results."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from suchus.core.errors import SuchusError
from suchus.core.progress import Progress, silent
from suchus.experiments.study.measures import measured, unit_of
from suchus.experiments.study.plan import Plan
from suchus.experiments.study.study import Study
from suchus.robot.design import unit_at
from suchus.robot.motion import check_limits
from suchus.sim.land import Run, simulate


def run_chunk(study: Study, number: int, progress: Progress = silent) -> xr.Dataset:
    """Run one batch of a study; it depends on nothing but the study and the number.

    A run that cannot be built, refuses to walk or diverges has NaN for numbers and says why in ``error``.

    Args:
        study: the study.
        number: number of the batch.
        progress: told the share that is done.

    Returns:
        A table along ``sample``: a column for each field that varies, one or more for each measure, ``seed``, ``arm``
        where there are conditions, ``error``.
    """
    plan = Plan(study)
    samples = plan.chunk(number)
    rows: dict[int, dict[str, float]] = {}
    errors: dict[int, str] = {}
    runs: dict[int, Run] = {}
    for sample in samples:
        try:
            run = plan.run(sample)
            check_limits(run.robot, run.gait)
            runs[sample] = run
        except SuchusError as error:
            errors[sample] = _say(error)
    _walk(study, runs, rows, errors, progress)
    return _table(study, [plan[s] for s in samples], samples, rows, errors)


def _walk(
    study: Study, runs: Mapping[int, Run], rows: dict[int, dict[str, float]], errors: dict[int, str], progress: Progress
) -> None:
    """Simulate runs in one batch, and halve the batch when it fails, until the failing run is alone.

    Args:
        study: the study.
        runs: runs by sample.
        rows: measured numbers by sample; filled in.
        errors: why a sample has no numbers; filled in.
        progress: called with the fraction that is done.

    Raises:
        MemoryError: there is no room even for a single run, which says nothing of the run.
    """
    if not runs:
        return
    try:
        record = simulate(
            list(runs.values()),
            duration=study.duration,
            timestep=study.timestep,
            sample_stride=study.every,
            progress=progress,
        )
    except (SuchusError, MemoryError) as error:
        if len(runs) == 1:
            if isinstance(error, MemoryError):
                raise
            errors[next(iter(runs))] = _say(error)
            return
        record = None
    if record is None:  # the error is gone by now, and with it what filled the memory
        middle, items = len(runs) // 2, list(runs.items())
        _walk(study, dict(items[:middle]), rows, errors, progress)
        _walk(study, dict(items[middle:]), rows, errors, progress)
        return
    sound = np.flatnonzero(record.cause.values == "")
    for i, sample in enumerate(runs):
        if i not in sound:
            failed_run = record.isel(run=i)
            errors[sample] = (
                f"Diverged: the simulation diverged at {float(failed_run.ended):.2f} s: {failed_run.cause.item()}"
            )
    if len(sound):
        _measure(study, record.isel(run=sound), [list(runs)[i] for i in sound], rows, errors)


def _measure(
    study: Study, record: xr.Dataset, samples: Sequence[int], rows: dict[int, dict[str, float]], errors: dict[int, str]
) -> None:
    """Measure runs together; every measure gives a run the same bytes in company as alone."""
    try:
        rows |= dict(zip(samples, measured(record, study.measure), strict=True))
    except SuchusError as error:
        if len(samples) == 1:
            errors[samples[0]] = _say(error)
            return
        for i, sample in enumerate(samples):
            _measure(study, record.isel(run=[i]), [sample], rows, errors)


def _table(
    study: Study,
    points: Sequence[Any],
    samples: range,
    rows: Mapping[int, Mapping[str, float]],
    errors: Mapping[int, str],
) -> xr.Dataset:
    """Return the results of a batch as a table along ``sample``.

    Args:
        study: the study.
        points: points of ``Plan``, one for each sample.
        samples: numbers of the samples.
        rows: measured numbers by sample and column; a missing one becomes NaN.
        errors: why a sample has no numbers, by sample.
    """
    columns: dict[str, Any] = {}
    for vary in study.vary:
        column = _column([point.values[vary.field] for point in points], vary.ends)
        units = _units(unit_at(study.run, vary.field)) if column.dtype == float else {}
        columns[vary.field] = ("sample", column, units)
    columns["seed"] = ("sample", np.array([point.seed for point in points], dtype=np.int64), _units("-"))
    if study.arms:
        columns["arm"] = ("sample", np.array([point.arm.name for point in points]))
    units_of = {measure: _units(unit_of(measure)) for measure in study.measure}
    for name in dict.fromkeys(name for row in rows.values() for name in row):
        measure = max((m for m in study.measure if name == m or name.startswith(f"{m}_")), key=len)
        numbers = np.array([rows.get(s, {}).get(name, np.nan) for s in samples])
        columns[name] = ("sample", numbers, units_of[measure])
    columns["error"] = ("sample", np.array([errors.get(s, "") for s in samples]))
    return xr.Dataset(columns, coords={"sample": np.asarray(samples, dtype=np.int64)})


def _units(unit: str) -> dict[str, str]:
    """Return a unit as records hold it, which write 1 where there is none."""
    return {"units": "1" if unit == "-" else unit}


def _column(values: Sequence[Any], possible: Sequence[Any]) -> np.ndarray:
    """Numbers where all possible values are numbers, else how they are called."""
    if all(isinstance(v, (int, float)) for v in possible):
        return np.array(values, dtype=float)
    return np.array([label_of(v) for v in values])


def label_of(value: Any) -> str:
    """Return what a value is called in a table: its name; for faults, what breaks; ``none`` for nothing."""
    if isinstance(value, tuple):
        return " + ".join(label_of(item) for item in value) or "none"
    name = getattr(value, "name", None)
    if isinstance(name, str):
        return name
    joint = getattr(value, "joint", None)
    return f"{type(value).__name__.lower()} {joint}" if joint else str(value)


def _say(error: SuchusError) -> str:
    return f"{type(error).__name__}: {' '.join(str(error).split())}"

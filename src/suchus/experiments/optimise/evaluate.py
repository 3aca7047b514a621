"""One generation: its candidates in one batch, their aims and limits, and their losses."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from suchus.core.errors import SuchusError
from suchus.core.progress import Progress, silent
from suchus.experiments.optimise.aims import AIMS, LIMITS, Kind
from suchus.experiments.optimise.spec import Limit, Optimisation
from suchus.robot.control import Runs
from suchus.robot.design import with_values
from suchus.robot.design.scale import control_period
from suchus.robot.motion import check_limits, excess
from suchus.sim.land import Run, simulate

STATUS_WALKED, STATUS_REFUSED, STATUS_DIVERGED = "walked", "refused", "diverged"
_SAMPLE_INTERVAL = 2  # control periods; 50 looks a second


def evaluate(
    spec: Optimisation, shares: np.ndarray, progress: Progress = silent, *, timestep: float | None = None
) -> xr.Dataset:
    """Evaluate candidates; all that can be built are simulated in one batch.

    Args:
        spec: the search, of one condition.
        shares: fractions of the ranges, from 0 to 1, shape (candidate, field).
        progress: called with the fraction that is done.
        timestep: time step of the physics [s]; that of the search if None.

    Returns:
        A table along ``candidate``: ``share`` over ``field``; ``aim_...`` and ``limit_...``, NaN where it did not walk;
        ``status``; ``beyond``, see ``suchus.robot.motion.excess``, infinite for a candidate that cannot be at all.
    """
    count = len(shares)
    status, limit_excess = np.full(count, STATUS_REFUSED, dtype="U16"), np.zeros(count)
    runs: dict[int, Run] = {}
    for i, point in enumerate(shares):
        try:
            run = spec.candidate({v.field: float(s) for v, s in zip(spec.vary, point, strict=True)})
            limit_excess[i] = excess(run.robot, run.gait)
            if limit_excess[i] == 0.0:
                check_limits(run.robot, run.gait)
                # raises if the control cannot steer this gait
                run.control.start(Runs.identical(run.control, run.robot, run.gait), control_period(run.robot))
                runs[i] = run
        except SuchusError:
            limit_excess[i] = np.inf
    table = {name: np.full(count, np.nan) for name in columns(spec)}
    results = _walk_candidates(spec, runs, progress, timestep or spec.timestep)
    limit_excess[[i for i in runs if i not in results]] = np.inf
    for i, numbers in results.items():
        status[i] = STATUS_DIVERGED if numbers is None else STATUS_WALKED
        for name, value in (numbers or {}).items():
            table[name][i] = value
    return xr.Dataset(
        {
            "share": (("candidate", "field"), np.asarray(shares, dtype=float)),
            "beyond": ("candidate", limit_excess),
            "status": ("candidate", status),
            **{name: ("candidate", values) for name, values in table.items()},
        },
        coords={"field": [v.field for v in spec.vary]},
    )


def columns(spec: Optimisation) -> dict[str, Kind]:
    """Return what is measured, by column: ``aim_displacement``, ``limit_slip``."""
    return {f"aim_{aim.name}": AIMS[aim.name] for aim in spec.aims} | {
        f"limit_{limit.name}": LIMITS[limit.name] for limit in spec.limits
    }


def _walk_candidates(
    spec: Optimisation, runs: Mapping[int, Run], progress: Progress, timestep: float
) -> dict[int, dict[str, float] | None]:
    """Return the quantities of each candidate by column, None for one that diverged.

    A candidate that the simulation refuses, as for a foot point between those that were looked at, has no row; the
    batch is halved until it is found.

    Args:
        spec: the search, of one condition.
        runs: runs by number of the candidate.
        progress: called with the fraction that is done.
        timestep: time step of the physics [s].
    """
    if not runs:
        return {}
    scales = spec.friction_scales
    ground_runs = [with_values(run, {"ground.friction_scale": scale}) for run in runs.values() for scale in scales]
    try:
        record = simulate(
            ground_runs, duration=spec.duration, timestep=timestep, sample_stride=_SAMPLE_INTERVAL, progress=progress
        )
    except SuchusError:
        if len(runs) == 1:
            return {}
        items = list(runs.items())
        halves = dict(items[: len(items) // 2]), dict(items[len(items) // 2 :])
        return {i: row for half in halves for i, row in _walk_candidates(spec, half, progress, timestep).items()}
    measured = measure(spec, ground_runs, record)
    broken = (record.cause.values != "").reshape(len(runs), -1).any(axis=1)
    measures_of: dict[int, dict[str, float] | None] = {}
    for row, i in enumerate(runs):
        rows = slice(row * len(scales), (row + 1) * len(scales))
        measures_of[i] = (
            None if broken[row] else {name: _joined(name, values[rows]) for name, values in measured.items()}
        )
    return measures_of


def measure(spec: Optimisation, runs: Sequence[Run], record: xr.Dataset) -> dict[str, np.ndarray]:
    """Return every aim and limit of some runs by column, each of shape (run,)."""
    values: dict[Any, np.ndarray] = {}
    for kind in columns(spec).values():
        if kind.measure not in values:
            values[kind.measure] = kind.measure(runs, record)
    return {name: values[kind.measure] for name, kind in columns(spec).items()}


def _joined(name: str, values: np.ndarray) -> float:
    """Return the value of a candidate over all grounds: the mean of an aim, the worst of a limit.

    Args:
        name: name of the column.
        values: values on each ground.
    """
    if name.startswith("aim_"):
        return float(values.mean())
    reduce = values.min if LIMITS[name.removeprefix("limit_")].good == "more" else values.max
    return float(reduce())


_PENALTY = 5.0  # loss for each limit that is exceeded by its own size, in units of the start's aim
_REFUSED_LOSS, _DIVERGED_LOSS, _IMPOSSIBLE_LOSS = (
    1e3,
    2e3,
    4e3,
)  # losses above those of all walks, less for candidates that nearly walk
ACTIVE = 0.03
"""Greatest relative margin at which a limit counts as active [-]."""


def excesses(spec: Optimisation, table: xr.Dataset) -> np.ndarray:
    """Return by which part of itself each limit is exceeded, negative where it is kept, shape (candidate, limit).

    Args:
        spec: the search.
        table: table of ``evaluate``.
    """
    rows = [relative_excess(limit, table[f"limit_{limit.name}"].values) for limit in spec.limits]
    return np.array(rows).T if rows else np.zeros((table.sizes["candidate"], 0))


def relative_excess(limit: Limit, values: np.ndarray) -> np.ndarray:
    """Return by which fraction of itself a limit is exceeded; negative where it is kept [-].

    Args:
        limit: the limit.
        values: values of the limited quantity, in its unit.
    """
    kind = LIMITS[limit.name]
    sign = 1.0 if kind.good == "less" else -1.0
    return np.asarray(sign * (values - limit.value) / max(abs(limit.value), 1e-9 if limit.value else kind.scale))


def is_allowed(spec: Optimisation, table: xr.Dataset) -> np.ndarray:
    """Return which candidates walked and kept every limit, shape (candidate,)."""
    has_walked = table.status.values == STATUS_WALKED
    return np.asarray(has_walked & (excesses(spec, table) <= 0.0).all(axis=1))


def units(spec: Optimisation, start: xr.Dataset) -> np.ndarray:
    """Return the unit of each aim: the size of the start's value, or 1 if the start has none, shape (aim,)."""
    values = np.array([abs(float(start[f"aim_{aim.name}"][0])) for aim in spec.aims])
    return np.where(np.isfinite(values) & (values > 1e-9), values, 1.0)


def losses(spec: Optimisation, table: xr.Dataset, parts: np.ndarray) -> np.ndarray:
    """Return each aim as a loss in units of the start's value, shape (candidate, aim).

    Limits that are exceeded make all aims worse; what cannot walk comes after everything that does.

    Args:
        spec: the search.
        table: table of ``evaluate``.
        parts: unit of each aim, of ``units``.
    """
    signs = np.array([-1.0 if AIMS[aim.name].good == "more" else 1.0 for aim in spec.aims])
    values = np.column_stack([table[f"aim_{aim.name}"].values for aim in spec.aims])
    penalty = _PENALTY * np.maximum(excesses(spec, table), 0.0).sum(axis=1)
    weighted = signs * values / parts + penalty[:, None]
    status, limit_excess = table.status.values, table.beyond.values
    failed_loss = np.where(
        status == STATUS_DIVERGED,
        _DIVERGED_LOSS,
        np.where(np.isfinite(limit_excess), _REFUSED_LOSS + np.minimum(limit_excess, 1e3), _IMPOSSIBLE_LOSS),
    )
    bad = (status != STATUS_WALKED) | ~np.isfinite(weighted).all(axis=1)
    return np.where(bad[:, None], failed_loss[:, None], weighted)


def score(spec: Optimisation, table: xr.Dataset, parts: np.ndarray) -> np.ndarray:
    """Return the weighted sum of all losses, shape (candidate,); the smallest is best."""
    weights = np.array([aim.weight for aim in spec.aims])
    return np.asarray(losses(spec, table, parts) @ weights)

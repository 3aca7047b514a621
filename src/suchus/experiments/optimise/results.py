"""What a search leaves: gait files, numbers, a record of the best, a page."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.core import files as records
from suchus.experiments.optimise.aims import AIMS, LIMITS
from suchus.experiments.optimise.conduct import write_runs
from suchus.experiments.optimise.pictures import draw_around, draw_convergence, draw_front, draw_gaits, label, scaled
from suchus.experiments.optimise.search import SearchResult
from suchus.experiments.optimise.spec import Optimisation
from suchus.experiments.study.result_table import ResultTable, Section, write_tables
from suchus.robot.design.scale import physics_step
from suchus.sim.land import Run, simulate
from suchus.visual.replay import replay

RESULT, OUTCOME, RECORD = "result", "outcome.json", "record.nc"
_MAX_NAMED_FIELDS = 5  # fields that the sentence names
_END = 0.02  # of its range; a field that is nearer to an end is at it


def write_results(spec: Optimisation, searches: Sequence[SearchResult], folder: str | Path) -> Path:
    """Write everything into ``folder/result``, which appears complete or not at all, and return that folder.

    Args:
        spec: the search.
        searches: searches of each condition.
        folder: folder of the search.

    Raises:
        Unwritable: the place cannot be written to.
    """
    folder = Path(folder)
    runs = [run for search in searches for run in search.runs]
    shown_runs = [_start(spec), *runs]
    record = simulate(shown_runs, duration=spec.duration, timestep=physics_step(spec.run.robot))
    numbers = outcome(spec, searches)
    with records.new_folder(folder / RESULT, lasting=True) as draft:
        for search in searches:
            write_runs(search.spec, search.runs, draft)
        records.save(record, draft / RECORD)
        for i, run in enumerate(shown_runs):
            if i:
                _write_replay(shown_runs, record, i, draft / f"{run.label}_replay.html")
        pictures = _pictures(spec, searches, shown_runs, record)
        sections = _sections(spec, searches, numbers, pictures)
        write_tables(draft, f"Optimised: {spec.name}", _lead(searches), sections, pictures)
        text = json.dumps(numbers, indent=2, ensure_ascii=False, allow_nan=False)
        (draft / OUTCOME).write_text(text + "\n", encoding="utf-8")
    return folder / RESULT


def _start(spec: Optimisation) -> Run:
    return replace(spec.run, label="start")


def _write_replay(shown_runs: Sequence[Run], record: xr.Dataset, i: int, path: Path) -> None:
    """Write the replay of run ``i``; the start is half transparent in it where the robot is the same."""
    run, same_robot = shown_runs[i], shown_runs[i].robot == shown_runs[0].robot
    page = replay(
        record.isel(run=i),
        run.robot,
        ghost=record.isel(run=0) if same_robot else None,
        labels=(label(run.label), "start"),
        title=f"{run.gait.name.replace('_', ' ')}, as found",
    )
    path.write_text(page, encoding="utf-8")


def outcome(spec: Optimisation, searches: Sequence[SearchResult]) -> dict[str, Any]:
    """Return every number of a search as JSON holds it; what is not finite becomes null."""
    return {
        "optimisation": spec.name,
        "robot": spec.run.robot.name,
        "gait": spec.run.gait.name,
        "aims": {aim.name: {"unit": AIMS[aim.name].unit, "better": AIMS[aim.name].good} for aim in spec.aims},
        "reasons": list(spec.reasons),
        "seed": spec.seed,
        "population": spec.population,
        "duration": spec.duration,
        "timestep": spec.timestep,
        "arms": {search.arm: _numbers_of(search) for search in searches},
        "versions": records.versions(),
    }


def _numbers_of(search: SearchResult) -> dict[str, Any]:
    """Return counts, start, best candidates and front of one search as JSON holds them."""
    return {
        "tried": search.history.sizes["candidate"] - 1,
        "walked": int((search.history.status == "walked").sum()),
        "start": {aim.name: _finite(search.start[f"aim_{aim.name}"][0]) for aim in search.spec.aims},
        "best": {name: _best(search, i) for i, name in enumerate(search.names)},
        "front": [
            [_finite(search.history[f"aim_{aim.name}"][i]) for aim in search.spec.aims]
            for i in (search.front if search.spec.pareto else ())
        ],
    }


def _best(search: SearchResult, index: int) -> dict[str, Any]:
    """Return aims, fields, limits and checks of one chosen candidate as JSON holds them."""
    assert search.checks is not None
    candidate, ranges = search.chosen_indices[index], {v.field: (v.low, v.high) for v in search.spec.vary}
    return {
        "sentence": sentence(search, index),
        "aims": {aim.name: _finite(search.history[f"aim_{aim.name}"][candidate]) for aim in search.spec.aims},
        "fields": {
            name: {"start": start, "best": best, "low": ranges[name][0], "high": ranges[name][1]}
            for name, (start, best) in search.values(index).items()
        },
        "limits": {
            name: {"limit": limit, "has": has, "active": active, "unit": LIMITS[name].unit}
            for name, (limit, has, active) in search.active(index).items()
        },
        "checks": {
            str(condition): {
                str(name): _finite(search.checks[name].sel(condition=condition).isel(run=index))
                for name in search.checks.data_vars
            }
            for condition in search.checks.condition.values
        },
    }


def _finite(value: Any) -> float | None:
    number = float(value)
    return number if np.isfinite(number) else None


def sentence(search: SearchResult, index: int) -> str:
    """Return which fields of a chosen gait differ most from the start, and which limits and ranges stop it.

    Args:
        search: search of one condition.
        index: index of the chosen candidate.
    """
    ranges = {
        v.field: (float(v.low), float(v.high)) for v in search.spec.vary if v.low is not None and v.high is not None
    }

    def relative_change(item: tuple[str, tuple[float, float]]) -> float:
        lower_bound, upper_bound = ranges[item[0]]
        return abs(item[1][1] - item[1][0]) / (upper_bound - lower_bound)

    changes = sorted(
        (item for item in search.values(index).items() if relative_change(item) > 0.0),
        key=relative_change,
        reverse=True,
    )
    phrases = []
    for field, (start, best) in changes[:_MAX_NAMED_FIELDS]:
        factor, unit = scaled(search.spec.run, field)
        unit_text = f" {unit}" if unit else ""
        phrases.append(f"{label(field)} {_round(best * factor)}{unit_text} instead of {_round(start * factor)}")
    stops = [label(name) for name, (_, _, active) in search.active(index).items() if active]
    limit_text = f" Limits that stop it: {', '.join(stops)}." if stops else " No limit stops it."
    ends = [label(name) for name, (_, best) in search.values(index).items() if _at_end(best, *ranges[name])]
    range_text = f" At the end of its range: {', '.join(ends)}." if ends else ""
    takes = f"It takes {'; '.join(phrases)}" if phrases else "It is the start itself"
    return f"{takes}.{limit_text}{range_text}"


def _at_end(best: float, lower_bound: float, upper_bound: float) -> bool:
    return min(best - lower_bound, upper_bound - best) < _END * (upper_bound - lower_bound)


def _round(value: float) -> str:
    return f"{value:.3g}"


def _pictures(
    spec: Optimisation, searches: Sequence[SearchResult], shown_runs: Sequence[Run], record: xr.Dataset
) -> dict[str, Figure]:
    """Return the figures of a search by name: gaits, convergence, fronts, neighbourhoods of the best."""
    values = [(AIMS[aim.name], AIMS[aim.name].measure(shown_runs, record)) for aim in spec.aims]
    aim_texts = [
        ", ".join(f"{value[i]:#.3g} {kind.unit}".removesuffix(" -") for kind, value in values)
        for i in range(len(shown_runs))
    ]
    pictures = {"gaits": draw_gaits(shown_runs, record, aim_texts)}
    if not spec.pareto:
        pictures["convergence"] = draw_convergence(searches)
    for search in searches:
        if search.spec.pareto:
            pictures[f"front_{search.arm}"] = draw_front(search)
        pictures[f"around_{search.arm}"] = draw_around(search)
    return pictures


def _lead(searches: Sequence[SearchResult]) -> str:
    """Return the first sentence of the page: by condition the first aim at the start and at the best."""
    phrases = []
    for search in searches:
        front = search.front if search.spec.pareto else []
        changes = []
        for aim in search.spec.aims if front else search.spec.aims[:1]:
            ends = (front[0], front[-1]) if front else (0, search.chosen_indices[0])
            start_value, end_value = (float(search.history[f"aim_{aim.name}"][i]) for i in ends)
            changes.append(
                f"{label(aim.name)} {start_value:.3g} to {end_value:.3g} {AIMS[aim.name].unit}".removesuffix(" -")
            )
        front_text = f"a front of {len(front)}, " if front else ""
        phrases.append(f"{label(search.arm)}: {front_text}{', '.join(changes)}")
    suffix = " each" if len(searches) > 1 else ""
    return f"{'; '.join(phrases)}; {searches[0].history.sizes['candidate'] - 1} candidates{suffix}."


def _sections(
    spec: Optimisation, searches: Sequence[SearchResult], numbers: Mapping[str, Any], pictures: Mapping[str, Figure]
) -> list[Section]:
    """Return the sections of the page: result, convergence, numbers, checks."""
    links = [
        (f"{name}_replay.html", f"Replay of {label(name)} beside the start")
        for search in searches
        for name in search.names
    ]
    links += [(f"{name}.toml", f"{name}.toml: the gait as a file") for search in searches for name in search.names]
    if any(vary.field.startswith("robot.") for vary in spec.vary):
        links += [
            (f"{n}_robot.toml", f"{n}_robot.toml: the robot as a file") for search in searches for n in search.names
        ]
    best = [(search, i) for search in searches for i in range(len(search.chosen_indices))]
    return [
        Section(title="What it found", texts=[*_best_said(numbers), *_control_note(spec)], links=links,
                figures=("gaits",)),
        Section(title="How it converged", texts=spec.reasons,
                figures=[name for name in pictures if name == "convergence" or name.startswith("front_")]),
        Section(title="The numbers", tables=[_fields(search, i) for search, i in best]
                + [_limits(search, i) for search, i in best if search.spec.limits]),
        Section(
            title="Is it an optimum?",
            texts=(
                f"The search ran with {1000 * spec.timestep:g} ms; here the best is run again with "
                f"{1000 * physics_step(spec.run.robot):g} ms, on other "
                "ground, as robots that are built of the design, and begun elsewhere in its cycle, beside the start.",
            ),
            figures=tuple(f"around_{search.arm}" for search in searches),
            tables=[_checks(search) for search in searches],
        ),
    ]  # fmt: skip


def _control_note(spec: Optimisation) -> list[str]:
    """Say what a gait file cannot hold."""
    if not any(vary.field.startswith("control.") for vary in spec.vary):
        return []
    return ["What is the control's is in the table below: a gait file holds the gait alone."]


def _best_said(numbers: Mapping[str, Any]) -> list[str]:
    best = [item for arm in numbers["arms"].values() for item in arm["best"].items()]
    return [f"{label(name).capitalize()}. {result['sentence']}" for name, result in best]


def _fields(search: SearchResult, index: int) -> ResultTable:
    """Return the table of the fields of one chosen candidate: start, best, range."""
    rows = []
    ends = {v.field: (v.low, v.high) for v in search.spec.vary}
    for name, (start, best) in search.values(index).items():
        factor, unit = scaled(search.spec.run, name)
        lower_bound, upper_bound = (float(e or 0.0) for e in ends[name])
        end_note = "at its end" if _at_end(best, lower_bound, upper_bound) else ""
        words = (label(name), unit, *(_round(factor * x) for x in (start, best)),
                 f"{_round(factor * lower_bound)} to {_round(factor * upper_bound)}", end_note)  # fmt: skip
        rows.append(words)
    return ResultTable(
        caption=f"{label(search.names[index])}: what the search changed",
        heads=("field", "unit", "start", "best", "range", ""),
        rows=rows,
        words=(0, 1, 5),
    )


def _limits(search: SearchResult, index: int) -> ResultTable:
    """Return the table of the limits of one chosen candidate: allowed value, reached value, whether active."""
    rows = [
        (
            label(name),
            LIMITS[name].tells,
            LIMITS[name].unit,
            f"{'at least' if LIMITS[name].good == 'more' else 'at most'} {limit:.3g}",
            f"{has:.3g}",
            "active" if active else "",
        )
        for name, (limit, has, active) in search.active(index).items()
    ]
    return ResultTable(
        caption=f"{label(search.names[index])}: limits; joint limits, reach and servo speeds hold besides",
        heads=("limit", "what it is", "unit", "allowed", "has", ""),
        rows=rows,
        words=(0, 1, 2, 5),
    )


def _checks(search: SearchResult) -> ResultTable:
    """Return the table of aims and limits of start and best under every condition of the checks."""
    assert search.checks is not None
    checks, names = search.checks, [str(run) for run in search.checks.run.values]
    columns = [(f"aim_{aim.name}", AIMS[aim.name]) for aim in search.spec.aims]
    columns += [(f"limit_{limit.name}", LIMITS[limit.name]) for limit in search.spec.limits]
    rows = []
    for i, run_name in enumerate(names):
        for condition in checks.condition.values:
            cells = [checks[name].sel(condition=condition).isel(run=i) for name, _ in columns]
            numbers = [f"{float(cell):.3g}" if np.isfinite(cell) else "diverged" for cell in cells]
            rows.append((f"{label(run_name)}, {condition}", *numbers))
    heads = [f"{label(name.partition('_')[2])} [{kind.unit}]" for name, kind in columns]
    return ResultTable(caption=f"{label(search.arm)}: under other conditions", heads=("condition", *heads), rows=rows)

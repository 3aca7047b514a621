"""An outcome as a folder: its numbers and verdicts, figures, record and tables, and its page."""

import json
import math
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from suchus.apps.report.outcome_page import write_outcome_page
from suchus.apps.report.result import OUTCOME, RECORD, content_hash
from suchus.article.verdict import Verdict, ladder
from suchus.core import files as record
from suchus.experiments import time_steps
from suchus.experiments.experiment import Experiment, Measure, Outcome
from suchus.visual import figures as pictures
from suchus.visual.pages import number


def check_place(folder: str | Path) -> None:
    """Refuse a place for results that cannot be written to or holds something else.

    Raises:
        Unwritable: no results can go there.
    """
    record.check_writable(folder)
    record.check_replaceable(folder)


def save_outcome(
    outcome: Outcome, figures: Mapping[str, Figure], experiment: Experiment, folder: str | Path, *, command: str
) -> Path:
    """Write an outcome as a folder, which appears complete or not at all, and return its path.

    Args:
        outcome: outcome of the experiment.
        figures: its figures by name.
        experiment: the question.
        folder: where; an earlier result there is replaced, with what nobody changed of it.
        command: what makes the same result again.

    Raises:
        Unwritable: the place cannot be written to, or is taken.
    """
    folder = Path(folder)
    with record.new_folder(folder, lasting=True) as draft:
        for name, figure in figures.items():
            pictures.save(figure, draft, name)
        for name, text in outcome.tables.items():
            (draft / name).write_text(text, encoding="utf-8")
        for name, film in outcome.films.items():
            (draft / name).write_bytes(film)
        for name, replay in outcome.replays.items():
            (draft / name).write_text(replay.html, encoding="utf-8")
        record.save(outcome.record, draft / RECORD)
        captions = {name: pictures.caption(figure) for name, figure in figures.items()}
        outcome_table = describe(outcome, experiment, captions, command)
        text = json.dumps(outcome_table, indent=2, ensure_ascii=False, allow_nan=False)
        (draft / OUTCOME).write_text(text + "\n", encoding="utf-8")
        write_outcome_page(draft)
    return folder


def describe(outcome: Outcome, experiment: Experiment, captions: Mapping[str, str], command: str) -> dict[str, Any]:
    """Return the contents of ``outcome.json``; numbers that are not finite become null."""
    contents = {
        "experiment": outcome.experiment,
        "title": experiment.title,
        "shows": experiment.shows,
        "decides": outcome.statement,
        "unjudged": outcome.unjudged,
        "too_short": outcome.too_short,
        "command": command,
        "settings": record.plain(outcome.settings),
        "differs": changed_settings(experiment),
        "answers": list(experiment.answers),
        "time_steps": time_steps.sentence(experiment),
        "measures": {name: _measure(measure) for name, measure in outcome.measures.items()},
        "verdicts": [_verdict(verdict) for verdict in outcome.verdicts],
        "figures": [{"name": name, "caption": text} for name, text in captions.items()],
        "tables": list(outcome.tables),
        "films": [{"name": name, "caption": pictures.film_caption(film)} for name, film in outcome.films.items()],
        "replays": [{"name": name, "caption": replay.caption} for name, replay in outcome.replays.items()],
    }
    provenance = record.provenance(outcome.settings, seconds=outcome.seconds)
    return contents | {"provenance": provenance | {"content_hash": content_hash(contents)}}


def changed_settings(experiment: Experiment) -> list[dict[str, str]]:
    """Return the fields in which a question differs from the one in the catalog, with both values in words."""
    shelf, rows = type(experiment)(), []
    for name in experiment.settings():
        setting, default = getattr(experiment, name), getattr(shelf, name)
        if setting != default:
            value, default_text = _setting_text(setting), _setting_text(default)
            text = f"another {value}" if value == default_text else value
            rows.append({"name": name, "value": text, "shelf": default_text})
    return rows


def _setting_text(value: Any) -> str:
    """Return a field's value in words: of a robot or a gait its name."""
    if isinstance(value, tuple):
        return ", ".join(_setting_text(element) for element in value) or "none"
    if isinstance(value, float):
        return number(value, 4)
    return str(getattr(value, "name", value))


def _measure(measure: Measure) -> dict[str, Any]:
    """Return a measure for ``outcome.json``; ``time_step`` where the time step changes it, null if unbounded."""
    described = {"value": _finite(measure.value), "unit": measure.unit}
    return described | ({"time_step": _finite(measure.step_change)} if measure.step_change else {})


def _verdict(verdict: Verdict) -> dict[str, Any]:
    """Return a verdict for ``outcome.json``: claim, rule, measured value and interval, and share of designs."""
    claim, rule, share = verdict.claim, verdict.rule, verdict.share
    return {
        "claim": claim.key,
        "quantity": claim.quantity,
        "statement": claim.sense,
        "quote": claim.quote,
        "where": claim.place,
        "of": claim.of,
        "printed": _finite(claim.value),
        "rounding": _finite(claim.rounding),
        "measure": rule.measure,
        "definition": rule.definition,
        "measured": _finite(verdict.measured),
        "low": _finite(verdict.low),
        "high": _finite(verdict.high),
        "repeats": rule.of,
        "unit": verdict.unit,
        "kind": rule.kind,
        "rule": [str(clause) for clause in rule.holds],
        "models": ladder.rows(verdict.voices, rule.form),
        "verdict": verdict.verdict,
        "fragile": verdict.fragile,
        "share": None if share is None else record.plain(asdict(share)),
        "unswept": rule.unswept,
        "too_few": "" if verdict.too_few is None else str(verdict.too_few),
        "time_step": verdict.time_step,
        "why": " ".join(verdict.why.split()),
    }


def _finite(value: Any) -> float | int | None:
    number = record.plain(value)
    return number if isinstance(number, (int, float)) and math.isfinite(number) else None

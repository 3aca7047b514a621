"""The page of one outcome, in its folder: question, answer, replay, figures, verdicts, numbers, settings and data.

It is one file that needs nothing else and no network; further replays and films stand beside it.
"""

import base64
import csv
import io
import re
from collections.abc import Iterator, Mapping, Sequence
from math import inf, isfinite, nan
from pathlib import Path
from typing import Any

from suchus.apps.report.result import Result, load_result
from suchus.article.paper import AUTHORS, TITLE
from suchus.core.errors import UnreadableFile
from suchus.core.files import read_text, write
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.experiment import Measure
from suchus.visual.pages import number, origin_text, quantity, render

PAGE = "index.html"
"""Name of the page in the folder of an outcome."""
MARKS = {
    "reproduced": "●",
    "same sense": "◐",
    "contradicted": "✕",
    "undecided": "◑",
    "models disagree": "≠",
    "depends on the reading": "±",
    "not testable": "○",
    "fitted": "◇",
    "by construction": "□",
}
"""Sign of each verdict, for those who do not see its colour."""
ANSWER_SENTENCES = 2
"""Sentences of an explanation that are the answer, beside the hero; the others are folded below the figures [-]."""
ARTICLE_ROBOTS = ("", "caiman", "floating_caiman")
"""Robots of the article, and none: pages of other robots name no part of the article."""
DIGEST_LENGTH = 16
"""Letters of the digest of the settings that pages show [-]."""
MAX_ANSWER_MEASURES = 6
"""Numbers that stand below an answer [-]."""
_LACKING: Mapping[str, Any] = {"fragile": False, "quote": "", "of": "", "rule": (), "models": (), "time_step": ""}
"""Defaults of entries that older outcomes lack."""
_WORDS = {"com": "centre of mass", "pp": "peak to peak", "p99": "99th percentile"}
"""Abbreviations in the names of measures, and their long forms."""
_HEAVY = 2 * 2**20
"""Size of a replay or a table [byte] beyond which it is linked and does not travel inside the page."""


def write_outcome_page(folder: str | Path) -> Path:
    """Write the page of an outcome into its folder and return its path.

    Args:
        folder: folder that ``save_outcome`` wrote.

    Raises:
        SuchusError: there is no outcome in it, or the place cannot be written to.
    """
    folder = Path(folder)
    text = render_outcome_page(load_result(folder))
    return write(folder / PAGE, text)


def render_outcome_page(result: Result) -> str:
    """Return the page of an outcome as text."""
    outcome = result.outcome
    sentences = _sentences(outcome["decides"])
    robot = _setting_name(outcome, "robot")
    measures = {
        name: Measure(nan if measure["value"] is None else measure["value"], measure["unit"], _step_change(measure))
        for name, measure in outcome["measures"].items()
    }
    first_replay = result.replays[0].file if result.replays else None
    is_embedded = first_replay is not None and first_replay.stat().st_size <= _HEAVY
    content = {
        "result": result,
        "outcome": outcome,
        "on_shelf": outcome["experiment"] in EXPERIMENTS,
        "lead": answer(outcome["decides"]),
        "more": sentences[ANSWER_SENTENCES:],
        "is_reduced": is_reduced(result),
        "robot": robot,
        "is_article_robot": robot in ARTICLE_ROBOTS,
        "citation": citation(outcome),
        "gait": _setting_name(outcome, "gait"),
        "verdicts": list(verdict_rows(result)),
        "step_changes": {name: step_change(measure) for name, measure in measures.items()},
        "carried": () if outcome.get("too_short") else answer_rows(outcome.get("answers", ()), measures),
        "differs": outcome.get("differs"),
        "replay": read_text(first_replay, 2 * _HEAVY) if first_replay is not None and is_embedded else "",
        "pictures": result.pictures[0 if is_embedded else 1 :],
        "beside": [*result.replays[1 if is_embedded else 0 :], *result.films],
        "origin": origin_text(*_origin(outcome)),
        "data": [_table("numbers.csv", _numbers(measures)), *_data(result)],
        "marks": MARKS,
    }
    return render("outcome.html", result.folder, **content)


def is_reduced(result: Result) -> bool:
    """Return whether what no verdict needs was left out of a run."""
    return "--for-verdicts" in result.outcome.get("command", "").split()


def verdict_rows(result: Result) -> Iterator[dict[str, Any]]:
    """Yield the verdicts of a result as pages show them: with their spread, and how many designs agree."""
    for verdict in result.outcome["verdicts"]:
        full_verdict = {**_LACKING, **verdict}
        yield {
            **full_verdict,
            "experiment": result.name,
            "of_designs": _share(full_verdict),
            "scatter": _scatter(full_verdict),
        }


def answer(decides: str) -> str:
    """Return the first two sentences of an outcome's explanation."""
    return " ".join(_sentences(decides)[:ANSWER_SENTENCES])


def _sentences(text: str) -> list[str]:
    """Return the sentences of a text."""
    return re.split(r"(?<=[.!?])\s+(?=[A-Z])", text.strip())


def citation(outcome: Mapping[str, Any]) -> str:
    """Return BibTeX entries for an outcome: of the software that made it, and of the article for the article's robot.

    The first has the version, the commit where suchus ran from a checkout, and the digests of code and settings.
    """
    robot, (version, commit, digests) = _setting_name(outcome, "robot"), _origin(outcome)
    note = "; ".join(
        [f"Experiment {outcome['experiment']}" + f", robot {robot}" * bool(robot)]
        + [f"{name} {value}" for name, value in ({"commit": commit} | digests).items() if value]
    )
    fields = {
        "author": "{The suchus developers}",
        "title": f"suchus: {outcome['title']}",
        "version": version,
        "note": note,
    }
    entries = [_entry("software", f"suchus_{outcome['experiment']}", fields)]
    if robot in ARTICLE_ROBOTS:
        entries.append(_entry("article", "crocodile_robot", {"author": " and ".join(AUTHORS), "title": TITLE}))
    return "\n\n".join(entries)


def _origin(outcome: Mapping[str, Any]) -> tuple[str, str, dict[str, str]]:
    """Return version and commit of the software that made an outcome, empty if unknown, and digests by name."""
    made_by = outcome["provenance"]
    digests = {"code": made_by.get("code") or "", "settings": made_by["config_hash"][:DIGEST_LENGTH]}
    return (made_by.get("versions") or {}).get("suchus", ""), made_by.get("commit") or "", digests


def _entry(kind: str, key: str, fields: Mapping[str, str]) -> str:
    """Return an entry of BibTeX, empty fields left out."""
    lines = [f"  {name} = {{{_tex(value)}}}" for name, value in fields.items() if value]
    return f"@{kind}{{{key},\n" + ",\n".join(lines) + "\n}"


def _tex(text: str) -> str:
    """Return a text in which the signs that LaTeX would take for commands are escaped; braces stay."""
    return re.sub(r"([&%$#_])", r"\\\1", text)


def step_change(measure: Measure) -> str:
    """Return how much a measure changes with smaller time steps, in words; empty where that is nothing or not known."""
    if not measure.step_change:
        return ""
    if not isfinite(measure.step_change):
        return "no number at some"
    return f"±{quantity(measure.step_change, measure.unit, 2)}"


def _step_change(measure: Mapping[str, Any]) -> float:
    """Return the change of a measure with smaller time steps, as ``Measure`` holds it."""
    change = measure.get("time_step", 0.0)
    return inf if change is None else change


def answer_rows(answers: Sequence[str], measures: Mapping[str, Measure]) -> list[tuple[str, str, str, str]]:
    """Return name, value, interval and change with the time step of the measures that carry an answer, in words.

    A measure that a run has not, as one of another gait, or that is no finite number is left out;
    ``MAX_ANSWER_MEASURES`` are taken.

    Args:
        answers: names of these measures; where there are none, the first are taken.
        measures: all of a run, by name.
    """
    finite = [name for name, measure in measures.items() if isfinite(measure.value)]
    ends = ("_low", "_high")
    rows = []
    names = [measure_name for measure_name in answers if measure_name in finite] or [
        measure_name for measure_name in finite if not measure_name.endswith(ends)
    ]
    for name in names[:MAX_ANSWER_MEASURES]:
        lower_bound, upper_bound = (measures.get(name + end) for end in ends)
        unit = measures[name].unit
        spread = ""
        if (
            lower_bound is not None and upper_bound is not None and lower_bound.value < upper_bound.value
        ):  # a single repeat has no interval
            spread = f"{number(lower_bound.value, 3)} to {quantity(upper_bound.value, unit, 3)}"
        rows.append(
            (
                " ".join(_WORDS.get(word, word) for word in name.split("_")),
                quantity(measures[name].value, unit, 3),
                spread,
                step_change(measures[name]),
            )
        )
    return rows


def _share(verdict: Mapping[str, Any]) -> str:
    """Return in a sentence how many plausible designs agree."""
    share = verdict.get("share")
    if not share:
        if shortage := str(verdict.get("too_few", "")):
            return shortage
        unswept = str(verdict.get("unswept", ""))
        return f"Not tried on other designs: {unswept}." if unswept else ""
    text = (
        f"The statement holds in {share['share']:.0%} ({share['low']:.0%} to {share['high']:.0%}) of "
        f"{share['designs']:,} plausible designs".replace(",", "\N{NO-BREAK SPACE}")
    )
    if share["turned_by"] and share["at"] is not None:
        side = "above" if share["above"] else "below"
        text += f"; best predicted by {share['turned_by']} {side} {number(share['at'], 3)}"
    return f"{text}."


def _scatter(verdict: Mapping[str, Any]) -> str:
    """Return the range of a measured number's repeats, empty if nothing was repeated."""
    lower_bound, upper_bound = verdict.get("low"), verdict.get("high")
    if lower_bound is None or upper_bound is None:
        return ""
    interval = f"{number(lower_bound, 3)} to {quantity(upper_bound, verdict['unit'], 3)}"
    return f"{interval} in {verdict.get('repeats', 'repeats')}"


def _setting_name(outcome: Mapping[str, Any], field: str) -> str:
    """Return the name of the robot or the gait of an outcome; empty where it has none."""
    settings = outcome.get("settings")
    value = settings.get(field) if isinstance(settings, Mapping) else None
    return str(value.get("name", "")) if isinstance(value, Mapping) else ""


def _numbers(measures: Mapping[str, Measure]) -> str:
    """Return all numbers as CSV, with nothing for one that is not finite."""
    text = io.StringIO()
    rows = (
        (name, repr(measure.value) if isfinite(measure.value) else "", measure.unit, _step_cell(measure.step_change))
        for name, measure in measures.items()
    )
    csv.writer(text).writerows([("measure", "value", "unit", "time_step"), *rows])
    return text.getvalue()


def _step_cell(change: float) -> str:
    """Return the change of a measure with the time step as a cell of CSV: nothing where it is none or not known."""
    return repr(change) if change else ""


def _data(result: Result) -> Iterator[dict[str, Any]]:
    """Yield the tables of a result: the numbers behind each figure, and what the experiment wrote beside them."""
    for picture in result.pictures:
        file = result.folder / f"{picture.name}.data.csv"
        if file.is_file():
            yield _table(file.name, _text_if_light(file), file)
    for name, text in result.tables.items():
        yield _table(name, text if len(text) <= _HEAVY else "", result.folder / name)


def _text_if_light(file: Path) -> str:
    """Return a text that travels inside the page; nothing of one that is too long."""
    try:
        return read_text(file, _HEAVY)
    except UnreadableFile:
        return ""


def _table(name: str, text: str, file: Path | None = None) -> dict[str, Any]:
    """Return a table with the address at which a browser finds it: in the page itself, or None to link its file."""
    coded = base64.b64encode(text.encode()).decode()
    return {"name": name, "file": file, "source": f"data:text/csv;base64,{coded}" if text else None}

"""Results become an index: the verdicts, and a link to the page of each result; it needs no network and no script."""

import re
import tempfile
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from suchus.apps.report.beside import compare_with_animals
from suchus.apps.report.outcome_page import MARKS, PAGE, is_reduced, verdict_rows, write_outcome_page
from suchus.apps.report.result import Failure, Result
from suchus.article.paper import AUTHORS, CLAIMS, ERRATA, TITLE
from suchus.core.errors import SuchusError
from suchus.core.files import versions, write
from suchus.experiments.claims import count_evidence, standings
from suchus.robot.blueprint import parse_robot
from suchus.robot.design import Assumption, Robot, tables_of, unit_at, value_at
from suchus.robot.design.meaning import meanings, unit
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.metrics.energy import METRES
from suchus.visual import figures
from suchus.visual.pages import embedded, number, quantity, render

_MIN_GIST_LENGTH = 60
"""Letters that say something [-]."""
_INPUT_STANDINGS = ("by construction", "fitted", "said twice")
"""Standings of what is no evidence though it may agree."""


HEADLINE = (
    "displacement_coordinated",
    "displacement_limbs_only",
    "displacement_ratio",
    "com_fluctuation",
    "fault_tolerance",
    "height_standing",
    "swim_tail_thrust",
)
"""Claims that the page begins with: what the article is about, in its order."""


def write_page(
    results: Sequence[Result], failures: Sequence[Failure], path: str | Path, *, left_out: Sequence[str] = ()
) -> Path:
    """Write the page, and those of outcomes that have none yet, and return its path.

    An earlier one stays until the new one is complete.

    Args:
        results: results in the order of the page.
        failures: what did not.
        path: file of the page.
        left_out: names of the experiments that were not run.

    Raises:
        Unwritable: the place cannot be written to.
    """
    path = Path(path)
    for result in results:
        if not (result.folder / PAGE).is_file():
            write_outcome_page(result.folder)
    text = render_page(results, failures, path.parent, left_out=left_out)
    return write(path, text)


def render_page(
    results: Sequence[Result],
    failures: Sequence[Failure],
    page_folder: str | Path | None = None,
    *,
    left_out: Sequence[str] = (),
) -> str:
    """Return the page as text.

    Args:
        results: results in the order of the page.
        failures: what did not.
        page_folder: the folder of the page, from which it links films and replays; None: the folder of the results.
        left_out: names of the experiments that were not run.
    """
    page_folder = None if page_folder is None else Path(page_folder)
    content = _content(results, failures)
    return render("report.html", page_folder, left_out=left_out, gist=_gist, **content)


def _gist(text: str) -> str:
    """Return the first sentences of a text, at least ``_MIN_GIST_LENGTH`` characters."""
    gist = ""
    for sentence in re.split(r"(?<=[.:;]) ", text):
        gist = f"{gist} {sentence}".strip()
        if len(gist) > _MIN_GIST_LENGTH and gist.endswith("."):
            break
    return gist


def _content(results: Sequence[Result], failures: Sequence[Failure]) -> dict[str, Any]:
    """Return the variables of the page's template."""
    order = {key: rank for rank, key in enumerate(CLAIMS)}
    results = sorted(results, key=lambda result: _place(result, order))
    robot, robot_counts = robot_of(results)
    is_article_robot = robot.name == ARTICLES  # the article's claims hold for the article's robot only
    all_verdicts = [verdict for result in results for verdict in verdict_rows(result)]
    verdicts = [verdict for verdict in all_verdicts if is_article_robot and verdict["claim"] in CLAIMS]
    own_verdicts = [verdict for verdict in all_verdicts if verdict["claim"] not in CLAIMS]
    verdicts.sort(key=lambda verdict: order.get(verdict["claim"], len(order)))
    verdict_by_claim = {str(verdict["claim"]): str(verdict["verdict"]) for verdict in verdicts}
    worth = standings(verdict_by_claim)
    answered = {result.name: result for result in results if not result.outcome.get("too_short")}
    own_choices = ROBOTS.beside(robot.name, "chosen", ()) if robot.name in ROBOTS else ()
    return {
        "results": results,
        "pages": {result.name: result.folder / PAGE for result in results},
        "reduced": [result.name for result in results if is_reduced(result)],
        "thumbnails": {result.name: result.pictures[0].thumbnail for result in results if result.pictures},
        "unjudged": {result.name: result.outcome.get("unjudged", "") for result in results},
        "title": TITLE,
        "authors": AUTHORS,
        "failures": failures,
        "judged": is_article_robot,
        "verdicts": verdicts,
        "headline": [verdict for verdict in verdicts if verdict["claim"] in HEADLINE],
        "departures": [verdict for verdict in verdicts if verdict["verdict"] == "contradicted"],
        "own_verdicts": own_verdicts,
        "stating": {verdict["experiment"] for verdict in own_verdicts},
        "marks": MARKS,
        "count": count_evidence(
            verdict_by_claim, [str(verdict["claim"]) for verdict in verdicts if verdict["fragile"]]
        ),
        "inputs": {name: [v for v in verdicts if worth[v["claim"]] == name] for name in _INPUT_STANDINGS},
        "tally": {result.name: _counts(v for v in verdicts if v["experiment"] == result.name) for result in results},
        "untouched": [c for c in CLAIMS.values() if is_article_robot and not c.of and c.key not in verdict_by_claim],
        "beside": compare_with_animals(robot, answered),
        "metres": metres(answered),
        "shown": max((result for result in results if result.replays), key=_headline_count, default=None),
        "robot": robot,
        "sized": robot.name if robot.name in ROBOTS else "FILE.toml",
        "others": robot_counts,
        "drawing": _drawing(robot),
        "parts": parts(tables_of(robot) or robot),
        "chosen": {robot.name: choices(robot, own_choices)}
        | {name: choices(gait, GAITS.beside(name, "chosen", ())) for name, gait in GAITS.items() if is_article_robot},
        "misprints": tuple(ERRATA.values()) if is_article_robot else (),
        "versions": versions(),
    }


def _headline_count(result: Result) -> int:
    """Return how many of the claims that the page begins with a result judges [-]."""
    return sum(verdict["claim"] in HEADLINE for verdict in result.outcome["verdicts"])


def _counts(verdicts: Iterable[Mapping[str, Any]]) -> dict[str, int]:
    """Return the number of verdicts by word, zero included."""
    count = Counter(str(verdict["verdict"]) for verdict in verdicts)
    return {word: count[word] for word in MARKS}


def _place(result: Result, order: Mapping[str, int]) -> int:
    """Return the rank of a result's last claim in the article; results without claims rank last."""
    return max((order.get(v["claim"], len(order)) for v in result.outcome["verdicts"]), default=len(order))


def _drawing(robot: Robot) -> dict[str, str]:
    figure = figures.dimension_drawing(robot)
    with tempfile.TemporaryDirectory() as folder:
        svg, png = figures.save(figure, Path(folder), "robot")
        return {"source": embedded(svg, png), "caption": figures.caption(figure)}


_MEASURES = ("speed", "work_per_metre", "net_cost_of_transport")


@dataclass(frozen=True, slots=True, kw_only=True)
class Metre:
    """A row of the table."""

    terrain: str
    """Place, in words."""
    experiment: str
    """Name of the experiment that measured them."""
    speed: str
    """Speed, with its unit."""
    work: str
    """Work of the servos over the distance, with its unit."""
    cost: str
    """Cost of transport: that work over the weight; empty where it was not measured."""


def metres(results: Mapping[str, Result]) -> list[Metre]:
    """Return the rows that the outcomes allow, in the order from land to depth."""
    rows = []
    for ending, terrain in METRES.items():
        for name, result in results.items():
            outcome = result.outcome["measures"]
            speed, work, cost = (_with_unit(outcome.get(f"{measure_name}_{ending}")) for measure_name in _MEASURES)
            if speed and work:
                rows.append(Metre(terrain=terrain, experiment=name, speed=speed, work=work, cost=cost))
    return rows


def _with_unit(measure: Mapping[str, object] | None) -> str:
    """Return a measure with its unit; empty where there is none, or no number."""
    if measure is None or not isinstance(measure["value"], (int, float)):
        return ""
    return quantity(float(measure["value"]), str(measure["unit"]), 3)


ARTICLES = "caiman"
"""Name of the article's robot, shown where no result names one; verdicts are shown of no other."""


def robot_of(results: Sequence[Result]) -> tuple[Robot, dict[str, int]]:
    """Return the robot of most results, and how many results each other robot has, by name.

    A robot that this version of suchus cannot build any more does not count.
    """
    robots = [robot for result in results if (robot := _robot(result.outcome.get("settings", {}))) is not None]
    if not robots:
        return ROBOTS[ARTICLES], {}
    (main_robot, _), *other_counts = Counter(robots).most_common()
    return main_robot, {robot.name: count for robot, count in other_counts}


def _robot(settings: Any) -> Robot | None:
    """Return the robot that the settings of an outcome describe; None if this version cannot build it."""
    values = settings.get("robot") if isinstance(settings, Mapping) else None
    try:
        return parse_robot(values) if isinstance(values, Mapping) else None
    except (ValidationError, SuchusError):
        return None


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """One field of a robot or gait."""

    field: str
    """Dotted path."""
    value: str
    """Value of the field, with its unit."""
    meaning: str
    """Meaning of the number, from the docstring of its field."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ChosenNumber:
    """One number that the article does not give."""

    field: str
    """Dotted path."""
    value: str
    """Our value with its unit."""
    lower_bound: str
    """Least plausible value."""
    upper_bound: str
    """Greatest plausible value."""
    reason: str
    """The reason."""


def parts(design: Any) -> dict[str, tuple[Row, ...]]:
    """Return the rows of each part of a robot, by the part's name."""
    field_meanings = meanings(type(design))
    tables: dict[str, tuple[Row, ...]] = {}
    for f in fields(design):
        section = getattr(design, f.name)
        if is_dataclass(section):
            meaning = field_meanings.get(f.name, "")
            title = f"{f.name.replace('_', ' ')}: {meaning[:1].lower()}{meaning[1:]}"
            tables[title] = tuple(rows(section, f.name))
    return tables


def rows(design: Any, path: str = "") -> Iterator[Row]:
    """Yield a row for every number below a frozen value."""
    field_meanings = meanings(type(design))
    for f in fields(design):
        value, meaning = getattr(design, f.name), field_meanings.get(f.name, "")
        field_path = f"{path}.{f.name}".lstrip(".")
        if is_dataclass(value):
            yield from rows(value, field_path)
        else:
            yield Row(field=field_path, value=_format_value(value, unit(meaning)), meaning=_plain(meaning))


def choices(design: Any, chosen_numbers: Sequence[Assumption]) -> tuple[ChosenNumber, ...]:
    """Return a row for every number that the article does not give."""
    return tuple(_choice(design, free) for free in chosen_numbers)


def _choice(design: Any, free_number: Assumption) -> ChosenNumber:
    """Return the row of one number that the article does not give."""
    value, unit = value_at(design, free_number.field), unit_at(design, free_number.field)
    return ChosenNumber(
        field=free_number.field,
        value=_format_value(value, unit),
        lower_bound=number(free_number.low),
        upper_bound=number(free_number.high),
        reason=free_number.why,
    )


def _format_value(value: Any, unit: str) -> str:
    """Return a value with its unit; a range as "a to b", a longer tuple as its elements."""
    if isinstance(value, tuple):
        return (
            " to ".join(_format_value(item, unit) for item in value) if len(value) == 2 else ", ".join(map(str, value))
        )
    return quantity(value, unit) if isinstance(value, (int, float)) else str(value)


def _plain(meaning: str) -> str:
    """A meaning without the brackets of its unit and the marks of its code words."""
    return re.sub(r"\s*\[[^\]]*\]", "", " ".join(meaning.split())).replace("``", "").removeprefix(".")

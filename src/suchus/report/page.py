"""Results become one HTML page that needs nothing else: no network, no script, no file beside it."""

import tempfile
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from suchus import figures
from suchus.gaits import GAITS
from suchus.paper import CLAIMS, ERRATA
from suchus.record import new_file, versions
from suchus.report.numbers import quantity, tied
from suchus.report.result import Failure, Result, data_uri
from suchus.report.tables import choices, parts
from suchus.robots import ROBOTS

ROBOT = "caiman"
"""The article's robot."""

_MARKS = {"reproduced": "●", "same sense": "◐", "contradicted": "✕", "not testable": "○"}


def write_page(results: Sequence[Result], failures: Sequence[Failure], path: Path) -> Path:
    """Write the page and return its path; an earlier one stays until the new one is complete.

    Raises:
        Unwritable: the place cannot be written to.
    """
    text = render_page(results, failures)
    with new_file(path) as draft:
        draft.write_text(text, encoding="utf-8")
    return path


def render_page(results: Sequence[Result], failures: Sequence[Failure]) -> str:
    """Return the page as text.

    Args:
        results: what came out, in the order of the page.
        failures: what did not.
    """
    environment = Environment(
        loader=PackageLoader("suchus.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"quantity": quantity, "tied": tied}
    style = Markup(environment.get_template("style.css").render())
    return environment.get_template("page.html").render(style=style, **_content(results, failures)) + "\n"


def _short(result: Result) -> bool:
    """Tell whether a result comes from the quick form of its question."""
    return str(result.told["command"]).endswith("--quick")


def _content(results: Sequence[Result], failures: Sequence[Failure]) -> dict[str, Any]:
    order = {key: place for place, key in enumerate(CLAIMS)}
    results = sorted(results, key=lambda result: _place(result, order))
    verdicts = [
        {**verdict, "experiment": result.name, "short": _short(result)}
        for result in results
        for verdict in result.told["verdicts"]
    ]
    verdicts.sort(key=lambda verdict: order.get(verdict["claim"], len(order)))
    count = Counter(str(verdict["verdict"]) for verdict in verdicts)
    robot = ROBOTS[ROBOT]
    return {
        "results": results,
        "short": {result.name: _short(result) for result in results},
        "failures": failures,
        "verdicts": verdicts,
        "marks": _MARKS,
        "counts": {word: count[word] for word in _MARKS},
        "untouched": [c for c in CLAIMS.values() if c.key not in {v["claim"] for v in verdicts}],
        "robot": robot,
        "drawing": _drawing(),
        "parts": parts(robot),
        "chosen": {ROBOT: choices(robot, ROBOTS.beside(ROBOT, "chosen", ()))}
        | {name: choices(gait, GAITS.beside(name, "chosen", ())) for name, gait in GAITS.items()},
        "misprints": tuple(ERRATA.values()),
        "versions": versions(),
    }


def _place(result: Result, order: Mapping[str, int]) -> int:
    """Where the article comes to the last claim of a result, its main one; what claims nothing comes last."""
    return max((order.get(v["claim"], len(order)) for v in result.told["verdicts"]), default=len(order))


def _drawing() -> dict[str, str]:
    figure = figures.dimension_drawing(ROBOTS[ROBOT])
    with tempfile.TemporaryDirectory() as folder:
        svg, _ = figures.save(figure, Path(folder), "robot")
        return {"source": data_uri(svg), "caption": figures.caption(figure)}

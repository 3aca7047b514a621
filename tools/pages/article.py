"""The article and the code, side by side: the paper map, the claims and the misprints."""

import re
from collections.abc import Iterable, Mapping
from typing import Any

from pages.code import PaperReference, papers
from pages.references import named
from pages.stated import kept, page
from suchus.article.paper import CLAIMS, ERRATA, Claim
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.claims import count_evidence
from suchus.experiments.experiment import Experiment

EQUATIONS = {
    1: "transform between neighbouring links",
    2: "leg, link 1",
    3: "leg, link 2",
    4: "leg, link 3",
    5: "leg, link 4",
    6: "product of the leg's transforms",
    7: "foot and its orientation",
    8: "foot in the plane of the leg",
    9: "leg yaw",
    10: "angle at the knee",
    11: "knee",
    12: "angle at the hip between the shank's end and the vertical",
    13: "leg pitch",
    14: "inverse kinematics of the leg",
    15: "end of the spine",
    16: "lengths of the tail's cords, exact",
    17: "lengths of the tail's cords, without the small term",
    18: "angle of the tail's servo",
    19: "places of the tail's joints",
    20: "body wave in water",
}
FIGURES = {
    1: "skeleton of an alligator (a drawing of the animal, nothing to compute)",
    2: "the whole robot",
    3: "the two leg structures",
    4: "trunk",
    5: "tail",
    6: "D-H frames of the hind leg",
    7: "hind leg in its plane",
    8: "D-H frames of the trunk",
    9: "plates and cords of the tail",
    10: "controllers and what they share",
    11: "angles of spine and tail, with their signs",
    12: "limb phases, spine and tail over two cycles",
    13: "the crawl in pictures",
    14: "stability at three instants",
    15: "height of the centre of mass",
    16: "displacement with and without spine and tail",
    17: "pressure around the swimming robot",
    18: "displacement, front yaw joint failed",
    19: "displacement, hind yaw joint failed",
    20: "displacement, front pitch joint failed",
    21: "displacement, hind pitch joint failed",
    22: "spine and tail while it stands up",
    23: "crawling and standing, from the side",
    24: "height reached while it stands up",
}
NAMED = (
    (
        "III.D",
        "jumping",
        "Named once, as a movement in which a robot observes its own parts, without a gait, a number or a picture.",
    ),
    (
        "I",
        "underwater rolling",
        "Named as a movement of crocodiles. [`death_roll`](questions.md#death_roll) rolls the robot's body, without "
        "ground and gravity.",
    ),
    (
        "IV.B",
        "movement of the body in water",
        "Judged by its two parts, the swing of the tail and that of the spine: [`swimming`](questions.md#swimming).",
    ),
    (
        "III.D",
        "frames of a film, by ScreenToGif",
        "The film is not public. `suchus capture FILM --digitise PAGE.html` makes a page on which the points of any "
        "film are clicked; [capture](capture.md) reads them.",
    ),
)
"""What the article names without a statement that can be judged: where, what, and what is done about it."""
TABLES = {"I": "D-H table of the hind leg", "II": "D-H table of the trunk"}


def items() -> dict[str, str]:
    """Return every table, equation and figure of the article by key, with what it shows."""
    return (
        {f"table {n}": text for n, text in TABLES.items()}
        | {f"eq {n}": text for n, text in EQUATIONS.items()}
        | {f"fig {n}": text for n, text in FIGURES.items()}
    )


def code_of(places: Iterable[PaperReference]) -> dict[str, list[PaperReference]]:
    """Return the docstrings that name an item, by item."""
    found: dict[str, list[PaperReference]] = {key: [] for key in items()}
    for one in places:
        for key in named(one.paper):
            found[key].append(one)
    return found


def questions_of(shelf: Mapping[str, Experiment]) -> dict[str, list[str]]:
    """Return the experiments that answer for an item: those that say so, and those that judge a claim made there."""
    found: dict[str, list[str]] = {key: [] for key in items()}
    for name, experiment in shelf.items():
        judged = [CLAIMS[key] for key in experiment.claims if key in CLAIMS]
        where = [experiment.shows, *(claim.where for claim in judged if not claim.of)]
        for key in dict.fromkeys(key for text in where for key in named(text)):
            found[key].append(name)
    return found


def paper_map() -> str:
    """Return the page that leads from the article to the code."""
    code, questions, flaws = code_of(papers()), questions_of(EXPERIMENTS), misprints_of()
    parts: dict[str, list[tuple[str, ...]]] = {}
    for title, kind in (("Tables", "table"), ("Equations", "eq"), ("Figures", "fig")):
        parts[title] = [
            (_label(key), text, _code(code[key]), _commands(questions[key]), _flaws(flaws[key]))
            for key, text in items().items()
            if key.startswith(f"{kind} ")
        ]
    judged = questions_by_claim()
    statements = [
        (claim.where, _plain(claim.sense), _value(claim), _commands(judged[key]))
        for key, claim in CLAIMS.items()
        if not claim.of
    ]
    return page("paper_map", parts=parts, statements=statements, named=NAMED)


def misprints_of() -> dict[str, list[str]]:
    """Return the keys of the misprints that concern an item."""
    return {item: [key for key, one in ERRATA.items() if item in named(one.where)] for item in items()}


def questions_by_claim() -> dict[str, list[str]]:
    """Return the experiments that judge a claim."""
    judged = {name: one.claims for name, one in EXPERIMENTS.items()}
    return {key: [name for name, claims in judged.items() if key in claims] for key in CLAIMS}


def misprints() -> str:
    """Return the page of the misprints."""
    shown = [
        {"key": one.key, "where": _sentence(one.where)}
        | {name: _plain(getattr(one, name)) for name in ("printed", "ours", "shows")}
        for one in ERRATA.values()
    ]
    return page("misprints", misprints=shown)


def verdicts(table: Mapping[str, Mapping[str, Any]] | None = None) -> str:
    """Return the page of the verdicts, with every table and equation, and what else is wrong as printed.

    Args:
        table: word and numbers of each claim; those that are kept if None.
    """
    flaws = misprints_of()
    rows = [
        (_label(key), text, flaws[key], _claims_at(key)) for key, text in items().items() if not key.startswith("fig ")
    ]
    shown = {key for _, _, found, _ in rows for key in found}
    rows += [(one.where, key.replace("_", " "), [key], []) for key, one in ERRATA.items() if key not in shown]
    return page("verdicts", audited=rows, root="", **front(kept("verdicts") if table is None else table))


def front(table: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Return what the first lines on the article state: the table of verdicts, its count, and measures.

    Args:
        table: word and numbers of each claim.
    """
    words = {claim: row["verdict"] for claim, row in table.items()}
    count = count_evidence(words, [claim for claim, row in table.items() if row["fragile"]])
    names = ("crawl_stability", "joint_faults", "servo_loads", "optimise_crawl")
    return {"verdicts": table, "count": count, **{name: kept(name) for name in names}}


def _claims_at(item: str) -> list[str]:
    return [key for key, claim in CLAIMS.items() if not claim.of and item in named(claim.where)]


def _value(claim: Claim) -> str:
    if claim.value is None:
        return ""
    unit = "" if claim.unit == "-" else f" {claim.unit}"
    return f"{claim.value:.3g}{unit}".replace("-", "−")


def _label(key: str) -> str:
    kind, number = key.split()
    shown = {"table": f"Table {number}", "eq": f"({number})", "fig": f"Fig. {number}"}[kind]
    return shown.replace(" ", "\N{NO-BREAK SPACE}")


def _code(places: Iterable[PaperReference]) -> str:
    return ", ".join(f"[`{one.shown}`][{one.name}]" for one in places)


def _commands(names: Iterable[str]) -> str:
    return ", ".join(f"[`{name}`](questions.md#{name})" for name in names)


def _flaws(keys: Iterable[str]) -> str:
    found = list(keys)
    return ", ".join(f"[{i + 1}](misprints.md#{key})" for i, key in enumerate(found))


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:]


def _plain(text: Any) -> str:
    """A text in which nothing is Markdown by accident, with its line breaks and bars taken out."""
    return re.sub(r"([*_`|<\[\]])", r"\\\1", " ".join(str(text).split()))

"""The page of the league: what to trust, what was within its interval, and what missed, with its cause."""

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from io import BytesIO
from math import ceil, inf
from pathlib import Path
from textwrap import fill
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.ticker import LogLocator, NullFormatter

from evidence.league.causes import cause_of
from evidence.league.contestant import Contestant, Interval, Value
from evidence.league.judging import NARROW, WIDEST, Judgement, Word, judged
from evidence.league.sealing import SEAL, Measured, Prediction, Seal, bound_value, opened, read_prediction, read_seal
from evidence.league.spans import Spans, read_spans
from evidence.league.spread import COVERED
from suchus.core.errors import IncompatibleRecord, UnreadableFile
from suchus.core.files import path_exists, read_json, write
from suchus.core.files.provenance import plain
from suchus.swimming.water.speed_range import DEFAULT_MODEL as RECOMMENDED
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

PAGE, OUTCOMES, FIGURE = "league.md", "league.json", "league.png"
"""Files of the page."""
_WIDTH = 118
SHOWN_SPANS = 5
"""Unknowns of a contestant in the table of what makes its interval wide [-]."""
AIM = 0.7
"""Share of the recommended model's judged predictions that should be within a narrow interval [-]."""
_NUMBERED = re.compile(r"\d+\. ")
_BOLD: Mapping[Word, str] = {
    "within": "within",
    "within, wide": "within, wide",
    "missed": "**missed**",
    "not a steady swim": "not a steady swim",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class LeagueEntry:
    """One contestant's prediction, its seal, and what was measured."""

    name: str
    """Name of the contestant."""
    title: str
    """Title for people."""
    explanation: str
    """Explanation in a sentence, for people."""
    words: Mapping[str, str]
    """What each quantity is."""
    units: Mapping[str, str]
    """Unit of each quantity."""
    prediction: Prediction
    """By quantity and rung."""
    seal: Seal
    """Seal of the prediction."""
    measured: Mapping[str, Measured]
    """By quantity; empty where nothing is public."""
    unsteadiness: str = ""
    """Why what was measured is no steady swim, in a phrase; empty where it can be one."""
    spans: Spans = field(default_factory=dict)
    """How far each unknown alone moves the recommended model's answer, see ``league.spans``; empty if not computed."""

    def judgements(self) -> list[tuple[str, str, Interval, Measured, Judgement]]:
        """Return quantity, rung, prediction, measurement and verdict of all that was measured."""
        return [
            (
                quantity,
                rung,
                one,
                self.measured[quantity],
                judged(one, self.measured[quantity], is_steady=not self.unsteadiness),
            )
            for quantity, rungs in self.prediction.items()
            if quantity in self.measured
            for rung, one in rungs.items()
        ]


def standing(contestant: Contestant, out: Path, measured: Path) -> LeagueEntry:
    """Return a sealed prediction beside its measurement, which is opened now.

    Args:
        contestant: who.
        out: folder of the league.
        measured: file of the measurement; none if it is not there.

    Raises:
        UnreadableFile: the prediction is not sealed, or the measurement says something else than is predicted.
    """
    folder = out / contestant.name
    truth = opened(folder, contestant.predicts, measured)
    find = contestant.find_unsteadiness
    return LeagueEntry(
        name=contestant.name,
        title=contestant.title,
        explanation=contestant.description,
        words={name: one.words for name, one in contestant.predicts.items()},
        units={name: one.unit for name, one in contestant.predicts.items()},
        prediction=read_prediction(folder),
        seal=read_seal(folder),
        measured=truth,
        unsteadiness=find({name: _first(one.value) for name, one in truth.items()}) if find and truth else "",
        spans=read_spans(folder),
    )


_STORED_KEYS = {"explanation": "about"}
"""Keys of the stored standings that differ from the fields' names."""
_LATER_FIELDS = ("unsteadiness", "spans")
"""Fields that older stored standings lack."""


def standing_text(standings: Sequence[LeagueEntry]) -> str:
    """Return standings as JSON, from which ``standings_of`` makes them again."""
    return json.dumps([_plain(one) for one in standings], indent=1) + "\n"


def _plain(one: LeagueEntry) -> Any:
    data: dict[str, Any] = {_STORED_KEYS.get(name, name): value for name, value in plain(one).items()}
    data["prediction"] = {
        quantity: {rung: {"value": at.value, "low": at.low, "high": at.high} for rung, at in rungs.items()}
        for quantity, rungs in one.prediction.items()
    }
    return data


def standings_of(path: str | Path) -> list[LeagueEntry]:
    """Return the standings that a file keeps.

    Raises:
        UnreadableFile: it is no such file.
    """
    path = Path(path)
    try:
        return [standing_of(data) for data in read_json(path)]
    except (TypeError, KeyError, ValueError, AttributeError) as error:
        raise UnreadableFile(
            f"{path} keeps no standings of the league; make it with python -m evidence.league."
        ) from error


def standing_of(data: Any) -> LeagueEntry:
    """Return a standing from the plain values that ``standing_text`` makes of it."""
    prediction = {
        quantity: {
            rung: Interval(*(bound_value(at[end]) for end in ("value", "low", "high"))) for rung, at in rungs.items()
        }
        for quantity, rungs in data["prediction"].items()
    }
    measured = {
        name: Measured(**(one | {end: bound_value(one[end]) for end in ("value", "low", "high")}))
        for name, one in data["measured"].items()
    }
    keys = {name: _STORED_KEYS.get(name, name) for name in LeagueEntry.__dataclass_fields__}
    fields = {name: data[key] for name, key in keys.items() if name not in _LATER_FIELDS or key in data}
    if "spans" in fields:
        fields["spans"] = {name: tuple(ends) for name, ends in fields["spans"].items()}
    return LeagueEntry(**(fields | {"prediction": prediction, "measured": measured, "seal": Seal(**data["seal"])}))


def all_standings(out: Path, contestants: Sequence[Contestant], measured: Mapping[str, Path]) -> list[LeagueEntry]:
    """Return the standings of those contestants whose predictions are sealed in a folder.

    Raises:
        IncompatibleRecord: there is none.
    """
    found = [standing(one, out, measured[one.name]) for one in contestants if path_exists(out / one.name / SEAL)]
    if not found:
        raise IncompatibleRecord(f"{out} holds no sealed prediction; run python -m evidence.league --out {out} first.")
    return found


def table(one: LeagueEntry) -> list[str]:
    """Return the rows of a contestant's table, in Markdown."""
    judgements = {(quantity, rung): judgement for quantity, rung, *_, judgement in one.judgements()}
    lines = ["| quantity | model | prediction | interval | measured | verdict |", "|---|---|---|---|---|---|"]
    for quantity, rungs in one.prediction.items():
        truth = one.measured.get(quantity)
        for i, (rung, at) in enumerate(rungs.items()):
            word = judgements.get((quantity, rung))
            lines.append(
                f"| {f'{one.words[quantity]} [{one.units[quantity]}]' if i == 0 else ''} | {rung} | "
                f"{shown(at.value)} | "
                f"{shown(at.low)} to {shown(at.high)} | "
                f"{(_truth(truth) if truth else 'kept back or not published') if i == 0 else ''} | "
                f"{_BOLD[word.word] + f', {word.ratio:.2g} times' if word else ''} |"
            )
    return lines


def _truth(truth: Measured) -> str:
    ends = f" ({shown(truth.low)} to {shown(truth.high)})" if truth.low != truth.high else ""
    return f"{shown(truth.value)}{ends}"


def shown(value: Value) -> str:
    """Return a number, or several in a row, as a table has it."""
    return ", ".join(shown(one) for one in value) if isinstance(value, tuple) else f"{value:.3g}"


def page(standings: Sequence[LeagueEntry], picture: str) -> str:
    """Return the page in Markdown.

    Args:
        standings: of all contestants.
        picture: path of the figure, as the page names it.
    """
    every = [(one, *row) for one in standings for row in one.judgements()]
    lines = [
        "# The league of predictions",
        "",
        "Real machines and animals, predicted by every model that can be asked before what was measured of them "
        "is opened.",
        "",
        "## What to trust",
        "",
        *_trust(every),
        "",
        *_unsteady(standings),
        f"![Predictions over what was measured, by model; the interval should reach across 1]({picture})",
        "",
        f"An interval covers {COVERED:.0%} of the answers to choices of all numbers that are not known, each drawn "
        "from a plausible range with a source or a reason. An expensive model is asked once or twice; its interval is "
        "that of its answers, widened as the sections' is, or as the widest of the others where sections have no word. "
        "*Within*: measurement and interval meet; *wide*: so, but the interval is wider than a factor of "
        f"{WIDEST:g}; *missed*: they do not meet. *Narrow* is an interval whose ends differ by less than a factor of "
        f"{NARROW:g}. The factor is prediction over measurement.",
        "",
        "Predict all of them with `python -m evidence.league`, and one with `make league NAME=...` or `python -m "
        "evidence.league NAME --out DIR`. That writes `DIR/NAME/prediction.json` and seals it in `seal.json` with its "
        "date, the state of the code and a digest. Only then the measurement is read, where there is one; nothing is "
        "fitted to a contestant's own result, and a sealed prediction is never replaced.",
        "",
        *_TRIALS,
        "",
        "## Hits",
        "",
        *_hits(every),
        "",
        "## Misses and their causes",
        "",
        *_misses(every),
        *_widths(standings),
        *_gap(every),
    ]
    for one in standings:
        seal = one.seal
        lines += [
            "",
            f"## {one.title}",
            "",
            f"{one.explanation} `python -m evidence.league {one.name}`; sealed {seal.date}, code {seal.code}.",
            "",
            *table(one),
        ]
        sources = dict.fromkeys(truth.source for truth in one.measured.values())
        if sources:
            lines += ["", f"Measured: {'; '.join(sources)}."]
        if seal.refused:
            lines += ["", *(f"* No word from {rung}: {why.rstrip('.')}." for rung, why in seal.refused.items())]
        about = f"The {len(seal.given)} numbers that this rests on, with their sources"
        lines += ["", f'<details markdown="1"><summary>{about}</summary>', "", *_given(seal), "", "</details>"]
    return "\n".join(filled(line) for line in [*lines, "", *_OWN]) + "\n"


def filled(line: str) -> str:
    """Return a paragraph or an item of a list in lines of a width, anything else as it is."""
    if line[:1] in ("|", "#", "<", "!", "{", "`"):
        return line
    hang = "  " if line.startswith("* ") else " " * len(number.group()) if (number := _NUMBERED.match(line)) else ""
    return fill(line, _WIDTH, subsequent_indent=hang, break_long_words=False, break_on_hyphens=False)


_TRIALS = (
    "Some measurements were open before the predictions that stand here were sealed. In a first round catsharks, "
    "salamander, Tunabot, the law and the alligator's slopes were judged; then the catshark's wavelength was taken as "
    "printed, animals were made to swing their tails as filmed, and a controller of the cadence was put on the "
    "slopes. The lampreys and the prickleback were measured by a program that showed frequency, wave and envelope "
    "alone, and their speeds were opened after a seal. The eel's speed was known. The round that stands here has new "
    "water: what tapers sheds, drag across by the body's proportions, friction by measured layers, and [the form of a "
    "body](water_evidence.md#the-form-of-a-body). All that was argued and kept in the history of the code before a "
    "prediction with it was computed; by then all public measurements were open, and it was known that sections had "
    "been too slow for long fish and too fast for the salamander. In the round before, 6 of the 11 predictions by "
    "sections met the measurement, 2 of them narrowly. Catsharks, alligators, the law and Salamandra have the "
    "predictions of earlier rounds, by the state of the code that stands beside them. What was measured of AmphiBot, "
    "and of the catshark at other speeds, is not in this repository and was not seen.",
    "",
    "The three lampreys were predicted once more. What made their intervals widest was the swing of the tail, which "
    "stood for all animals and waters by one film of one animal in water, with 25 to 35% to either side. The data set "
    "from which frequency and wavelength come also has the size of the first mode of all its swims, so that the "
    "swing is now that of the same animals in the same water, within 12 to 17%. Its rule was written before a "
    "prediction with it was computed, when the measured speeds were known; it moves the swing by +9% in water, +7% at "
    "10 times and -7% at 20 times the viscosity. Before, 4 of the 11 predictions by sections were within and narrow.",
    "",
    "The sections of this round are those of `suchus` with `Lake(form=design.BodyForm(...))`. Swims of `suchus` have "
    "no form unless it is asked for, drag 1.1 across and 3 times a plate's friction along: all their kept numbers "
    "were computed so. `suchus run swim_free` varies these coefficients, and its range is the answer.",
)
_OWN = (
    "## A measurement and a contestant of your own",
    "",
    "`python -m evidence.league NAME --measured FILE.json` judges by what you measured, which is "
    "opened after the seal:",
    "",
    "```json",
    '{"steady_speed": {"value": 0.4, "low": 0.38, "high": 0.42, "unit": "m/s", "source": "film of 3 May"}}',
    "```",
    "",
    "A contestant is one file in the folder `evidence/league/cases`: a `league.Contestant` with its "
    "numbers, each with a range and a source, what is predicted, and its models; `league.swims.rungs` are those of any "
    "swimmer. A number without a source, a unit that differs and a prediction that was changed are refused in a "
    "sentence. "
    "`--models resistive reactive sections` leaves out the flows, which take minutes each.",
)


def _unsteady(standings: Sequence[LeagueEntry]) -> list[str]:
    """Return which measurements are no steady swims, and why; nothing where all can be judged."""
    reasons = [f"* {one.name}: {one.unsteadiness}." for one in standings if one.unsteadiness]
    if not reasons:
        return []
    return ["Of these swims no prediction is judged: what was measured is not a steady swim.", "", *reasons, ""]


Row = tuple[LeagueEntry, str, str, Interval, Measured, Judgement]
"""Contestant, quantity, model, prediction, measurement and verdict."""


def _trust(every: Sequence[Row]) -> list[str]:
    """Return what the judged predictions say of each model, the recommended one first."""
    judged_rows = [row for row in every if row[-1].word != "not a steady swim"]
    models = sorted({row[2] for row in judged_rows}, key=lambda model: (model != RECOMMENDED, model))
    lines = [
        "| model | judged | within | of these narrow | within, wide | missed | median factor off |",
        "|---|---|---|---|---|---|---|",
    ]
    counts = {}
    for model in models:
        rows = [row for row in judged_rows if row[2] == model]
        words = [row[-1].word for row in rows]
        narrow = sum(row[-1].word == "within" and _is_narrow(row[3]) for row in rows)
        off = float(np.exp(np.median([abs(np.log(max(abs(row[-1].ratio), 1e-9))) for row in rows])))
        counts[model] = len(rows), words.count("within"), narrow
        name = f"**{model}**" if model == RECOMMENDED else model
        lines.append(
            f"| {name} | {len(rows)} | {words.count('within')} | {narrow} | {words.count('within, wide')} | "
            f"{words.count('missed')} | {off:.2g} |"
        )
    total = len(judged_rows)
    missed = sum(row[-1].word == "missed" for row in judged_rows)
    first = [f"Of {total} predictions that could be judged here {missed} missed."]
    if RECOMMENDED in counts:
        count, within, narrow = counts[RECOMMENDED]
        first = [
            f"Take {RECOMMENDED}, with the interval: {within} of its {count} predictions that could be judged met the "
            f"measurement, {narrow} of them with an interval narrower than a factor of {NARROW:g}, where the aim is "
            f"{AIM:.0%}. Of all {total} predictions that could be judged here {missed} missed."
        ]
    return [*first, "", *lines] if judged_rows else first


def _is_narrow(interval: Interval) -> bool:
    """Return whether the ends of an interval, of each of its numbers, differ by less than a factor of ``NARROW``."""
    lows, highs = np.atleast_1d(np.asarray(interval.low, float)), np.atleast_1d(np.asarray(interval.high, float))
    return bool(np.all((lows * highs > 0.0) & (np.abs(np.log(np.abs(highs / lows))) < np.log(NARROW))))


def _hits(every: Sequence[Row]) -> list[str]:
    """Return the table of predictions whose interval met the measurement."""
    hits = [row for row in every if row[-1].word in ("within", "within, wide")]
    if not hits:
        return ["None."]
    hits.sort(key=lambda row: (row[2] != RECOMMENDED, row[2], abs(np.log(max(abs(row[-1].ratio), 1e-9)))))
    lines = [
        "| contestant | quantity | model | prediction | measured | factor | interval |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in hits:
        width = "narrow" if _is_narrow(row[3]) else "wide" if row[-1].word == "within, wide" else ""
        lines.append(f"{_prediction_row(row)} {width} |")
    return lines


def _misses(every: Sequence[Row]) -> list[str]:
    """Return the table of predictions that missed, and below it the numbered causes, as far as they are known."""
    missed = [row for row in every if row[-1].word == "missed"]
    if not missed:
        return ["None."]
    missed.sort(key=lambda row: -abs(np.log(abs(row[-1].ratio))) if row[-1].ratio else -np.inf)
    lines = [
        "| contestant | quantity | model | prediction | measured | factor | cause |",
        "|---|---|---|---|---|---|---|",
    ]
    causes = list(dict.fromkeys(cause_of(row[0].name, row[2]) for row in missed))
    lines += [f"{_prediction_row(row)} {causes.index(cause_of(row[0].name, row[2])) + 1} |" for row in missed]
    return [
        *lines,
        "",
        "The causes, as far as they are known:",
        "",
        *(f"{i}. {one}." for i, one in enumerate(causes, 1)),
    ]


def _widths(standings: Sequence[LeagueEntry]) -> list[str]:
    """Return the unknowns that move the recommended model most, of each contestant; nothing where none is known."""
    rows = [one for one in standings if one.spans]
    if not rows:
        return []
    lines = [
        "",
        "## What makes the intervals wide",
        "",
        f"The {SHOWN_SPANS} numbers that move the answer of {RECOMMENDED} most: the answer with the number at its "
        "least and at its greatest value, all others as likely, over that with all as likely.",
        "",
        "| contestant | quantity | " + " | ".join(["number, answers"] * SHOWN_SPANS) + " |",
        "|---|---|" + "---|" * SHOWN_SPANS,
    ]
    for one in rows:
        cells = [f"{name}, {low:.2f} to {high:.2f}" for name, (low, high) in list(one.spans.items())[:SHOWN_SPANS]]
        cells += [""] * (SHOWN_SPANS - len(cells))
        lines.append(f"| {one.name} | {next(iter(one.words.values()))} | {' | '.join(cells)} |")
    return lines


def _gap(every: Sequence[Row]) -> list[str]:
    """Return what keeps the recommended model from the aim; nothing where it is met or nothing is judged."""
    rows = [row for row in every if row[2] == RECOMMENDED and row[-1].word != "not a steady swim"]
    met = [row for row in rows if row[-1].word == "within" and _is_narrow(row[3])]
    hardly = sum(_width(row[3]) > _NEARLY for row in met)
    needed = ceil(AIM * len(rows) - 1e-9)
    if len(met) >= needed:
        return []
    items = []
    for row in rows:
        width = f"{_width(row[3]):.3g}"
        where = f"{row[0].name}, {row[0].words[row[1]]}"
        if row[-1].word == "missed":
            items.append(
                f"* {where}: missed by a factor of {row[-1].ratio:.2g}, its interval a factor of {width} wide."
            )
        elif row not in met:
            items.append(f"* {where}: within, its interval a factor of {width} wide.")
    return [
        "",
        "## What keeps it from the aim",
        "",
        f"{len(met)} of the {len(rows)} judged predictions by {RECOMMENDED} are within and narrow, and {AIM:.0%} would "
        f"be {needed}. The interval of {hardly} of them is wider than a factor of "
        f"{_NEARLY:g}. The others:",
        "",
        *items,
        "",
        *_WHY_WIDE,
    ]


def _width(interval: Interval) -> float:
    """Return the ratio of the ends of an interval, of its first number; infinite where they differ in sign [-]."""
    low, high = _first(interval.low), _first(interval.high)
    return high / low if low * high > 0.0 else inf


_NEARLY = 1.9
"""Width from which an interval that counts as narrow is said to be hardly so [-]."""
_WHY_WIDE = (
    "All numbers are drawn independently, and the interval is that of the answers: no span is added to another. What "
    "is left of them has no narrower source. Drag across lies between a section in a steady stream and one that "
    "oscillates at rest, and friction between a laminar plate and what was measured on swimming fish; where between "
    "them a swimmer is, no measurement says that is not itself a swimmer's speed. The film of the prickleback has no "
    "scale, frequency and wave of the eel are from memory, and the frequency of the lampreys has the spread of five "
    "animals. The friction of a long cylinder for thick layers has a source, but was tried after the judgement, and "
    "is not taken up for that.",
)


def _prediction_row(row: Row) -> str:
    """Return the cells that hits and misses share, in Markdown."""
    one, quantity, rung, at, truth, word = row
    return (
        f"| {one.name} | {one.words[quantity]} [{one.units[quantity]}] | {rung} | {shown(at.value)} "
        f"({shown(at.low)} to {shown(at.high)}) | {_truth(truth)} | {word.ratio:.2g} |"
    )


def _given(seal: Seal) -> list[str]:
    lines = ["| number | value | range | source |", "|---|---|---|---|"]
    for name, one in seal.given.items():
        ends = "" if one["low"] == one["high"] else f"{one['low']:.3g} to {one['high']:.3g}"
        lines.append(f"| {name} [{one['unit']}] | {one['value']:.4g} | {ends} | {one['source']} |")
    return lines


def draw(standings: Sequence[LeagueEntry], path: Path) -> Path:
    """Draw every prediction over what was measured, its interval as a bar, one row for each quantity and contestant."""
    rows = [(one, quantity) for one in standings for quantity in one.prediction if quantity in one.measured]
    rungs = list(dict.fromkeys(rung for one, quantity in rows for rung in one.prediction[quantity]))
    palette = colormaps["tab20"]([*range(0, 20, 2), *range(1, 20, 2)])  # strong colours, then their pale ones
    with styled():
        figure, axes = panels(1, 1, width=8.0, height=1.6 + 0.42 * max(len(rows), 1))
        ax = axes[0, 0]
        ax.axvline(1.0, color=COLOURS["neutral"], linewidth=1.2)
        for y, (one, quantity) in enumerate(rows):
            truth = _first(one.measured[quantity].value)
            ax.axhspan(y - 0.5, y + 0.5, color="0.95" if y % 2 else "1.0", zorder=0)
            ends = [_first(one.measured[quantity].low) / truth, _first(one.measured[quantity].high) / truth]
            ax.plot(ends, [y, y], color=COLOURS["neutral"], linewidth=7.0, alpha=0.35, solid_capstyle="butt")
            for rung, at in one.prediction[quantity].items():
                k = rungs.index(rung)
                height = y + 0.34 - 0.68 * (k + 0.5) / len(rungs)
                low, value, high = (max(_first(end) / truth, 1e-3) for end in (at.low, at.value, at.high))
                ax.plot([low, high], [height, height], color=palette[k], linewidth=2.0)
                label = (
                    rung if y == next(i for i, row in enumerate(rows) if rung in row[0].prediction[row[1]]) else None
                )
                ax.plot([value], [height], "o", color=palette[k], markersize=4.0, label=label)
        ax.set_yticks(range(len(rows)), [f"{one.name}: {quantity}".replace("_", " ") for one, quantity in rows])
        ax.set(xscale="log", xlabel="prediction over what was measured [-]", ylim=(max(len(rows), 1) - 0.5, -0.5))
        ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        ax.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
        ax.xaxis.set_minor_formatter(NullFormatter())
        if rows:
            ax.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0))
    captioned(
        figure,
        "Every prediction of which a measurement is public, over that measurement: dots with the most likely "
        "numbers, bars "
        "the intervals; the broad grey bar is the measurement's own spread.",
    )
    drawn = BytesIO()
    figure.savefig(drawn, format="png")
    return write(path, drawn.getvalue())


def _first(value: Value) -> float:
    return value[0] if isinstance(value, tuple) else value


def write_page(standings: Sequence[LeagueEntry], out: Path) -> Path:
    """Write the page, its figure and the outcomes it is made of, and return the page's place."""
    draw(standings, out / FIGURE)
    write(out / OUTCOMES, standing_text(standings))
    return write(out / PAGE, page(standings, FIGURE))

"""What became of each claim, as rows: for the page, for a table, and for the table of shares that ships."""

import csv
import io
import json
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from suchus.article.verdict.judging import ROBUST, digest
from suchus.core.files import code_digest
from suchus.experiments.claims import RULES
from suchus.experiments.study.answers import Index, first_order, share_interval
from suchus.experiments.study.varied import LEAST
from suchus.visual.figures.sensitivity import spoken

_NAMED = 3  # parameters that a row names
_TOGETHER = 0.1  # of the variance of one parameter; another that explains more could pass for it [-]
_ANSWERED_BY = (
    "article",
    "experiments/claims",
    "sim/metrics/decisive.py",
    "experiments/study/answers.py",
    "experiments/study/claim_measures.py",
    "experiments/study/claims.py",
    "experiments/study/varied.py",
)


def claim_row(record: xr.Dataset, claim: str) -> dict[str, Any]:
    """Return what became of one claim: share, deciders with their intervals, border.

    Args:
        record: of ``claims.conduct_claims``.
        claim: its key.
    """
    one = record.sel(claim=claim)
    there = np.isfinite(one.number.values)
    number, holds = one.number.values, one.holds.values.astype(bool)
    count, true = int(there.sum()), int(holds[there].sum())
    index = first_order(record.value.values, number)
    at = int(one.border_of)
    low, middle, high = np.quantile(number[there], (0.05, 0.5, 0.95)) if count else (np.nan,) * 3
    return {
        "claim": claim,
        "samples": count,
        "words": dict(Counter(word for word in one.word.values.tolist() if word)) if "word" in one else {},
        "true": true / count if count else float("nan"),
        "interval": share_interval(true, count),
        "number": (float(low), float(middle), float(high)),
        "deciders": [
            {
                "parameter": str(record.parameter.values[i]),
                "decides": float(index.share[i]),
                "low": float(index.low[i]),
                "high": float(index.high[i]),
                "correlation": float(one.correlation.values[i]),
            }
            for i in deciders(record.value.values[there], index)
        ],
        "border": None
        if at < 0
        else {
            "parameter": str(record.parameter.values[at]),
            "unit": str(record.parameter_unit.values[at]),
            "at": float(one.border_at),
            "true": "above" if bool(one.border_above) else "below",
            "separation": float(one.border_separation),
        },
    }


def deciders(parameters: np.ndarray, index: Index) -> list[int]:
    """Return which parameters decide beyond chance, the strongest first, at most three.

    In few points of a Sobol sequence of many dimensions some go together, straight or bent: of 109 in 128 points, two
    were correlated by 0.84, in 2 048 by 0.09 at most. One that explains the values of a stronger one is left out.

    Args:
        parameters: shape (sample, parameter).
        index: of each parameter, see ``answers.first_order``.
    """
    named: list[int] = []
    for i in np.argsort(-index.share):
        if len(named) == _NAMED:
            break
        passes = (first_order(parameters[:, [i]], parameters[:, j]).share[0] > _TOGETHER for j in named)
        if index.low[i] > 0 and not any(passes):
            named.append(int(i))
    return named


def table(rows: Sequence[Mapping[str, Any]]) -> str:
    """Return the rows as CSV."""
    box = io.StringIO()
    writer = csv.writer(box, lineterminator="\n")
    writer.writerow(
        ["claim", "samples", "true", "true_low", "true_high", "number_5", "number_50", "number_95", "deciders",
         "border_parameter", "border_at", "border_true", "border_separation"]
    )  # fmt: skip
    for row in rows:
        deciders = "; ".join(
            f"{d['parameter']} {d['decides']:.2f} ({d['low']:.2f} to {d['high']:.2f})" for d in row["deciders"]
        )
        edge = row["border"] or {"parameter": "", "at": float("nan"), "true": "", "separation": float("nan")}
        numbers = (row["true"], *row["interval"], *row["number"])
        writer.writerow(
            [row["claim"], row["samples"], *(f"{x:.4g}" for x in numbers), deciders, edge["parameter"],
             f"{edge['at']:.4g}", edge["true"], f"{edge['separation']:.2f}"]
        )  # fmt: skip
    return box.getvalue()


def turned(rows: Sequence[Mapping[str, Any]]) -> dict[str, str]:
    """Return by claim where it holds, in a few words, for those that too few designs agree on."""
    found = {}
    for row in rows:
        edge = row["border"]
        if edge and max(row["true"], 1.0 - row["true"]) < ROBUST:
            found[row["claim"]] = f"{spoken(edge['parameter'])} {edge['true']} {edge['at']:.3g} {edge['unit']}"
    return found


def shares(rows: Sequence[Mapping[str, Any]], varied: Mapping[str, xr.Dataset]) -> dict[str, dict[str, Any]]:
    """Return the rows in the form of ``verdict.Share``, by claim, or of ``verdict.TooFew`` where few could judge it.

    Args:
        rows: of ``claim_row``.
        varied: of ``varied.conduct_varied``, by experiment.
    """
    of = {str(claim): name for name, one in varied.items() for claim in one.claim.values}
    found = {}
    for row in rows:
        if row["samples"] < LEAST:
            if row.get("words"):
                named = {"words": row["words"], "of": of[row["claim"]], "rule": RULES[row["claim"]].asked}
                found[row["claim"]] = named
        else:
            edge = row["border"]
            found[row["claim"]] = {
                "share": round(row["true"], 6),
                "low": round(row["interval"][0], 6),
                "high": round(row["interval"][1], 6),
                "designs": row["samples"],
                "turned_by": edge["parameter"] if edge else "",
                "at": float(f"{edge['at']:.6g}") if edge else None,
                "above": bool(edge and edge["true"] == "above"),
                "of": of.get(row["claim"], ""),
                "rule": RULES[row["claim"]].asked,
            }
    return found


def became(record: xr.Dataset) -> dict[str, int]:
    """Return how many samples of a record walked, were impossible, and so on."""
    return dict(sorted(Counter(record.status.values.tolist()).items()))


def shipped(record: xr.Dataset, rows: Sequence[Mapping[str, Any]], varied: Mapping[str, xr.Dataset]) -> str:
    """Return the table of shares that ``suchus.article.verdict`` ships: JSON, with its rows' digest and what made it.

    Args:
        record: of ``claims.conduct_claims``.
        rows: of ``claim_row``, of this record and of those that follow.
        varied: of ``varied.conduct_varied``, by experiment.
    """
    claims = shares(rows, varied)
    made_by = json.loads(record.attrs["made_by"])
    content = {
        "samples": record.sizes["sample"],
        "became": became(record),
        "varied": _varied(varied),
        "parameters": record.sizes["parameter"],
        "seed": int(record.attrs["seed"]),
        "cycles": int(record.attrs["cycles"]),
        "timestep": float(record.attrs["timestep"]),
        "agreement": finite(json.loads(record.attrs["agreed"])),
        "versions": {name: version for name, version in made_by.items() if name != "source"},
        "source": {"runs": made_by["source"], "answers": code_digest(*_ANSWERED_BY)[:12]},
    }
    return _table(content, claims)


def renewed(before: str, rows: Sequence[Mapping[str, Any]], varied: Mapping[str, xr.Dataset]) -> str:
    """Return a table of shares with the rows of some experiments anew; all other rows that today's rules ask stay.

    Args:
        before: the table, of ``shipped``.
        rows: of ``claim_row``, of the experiments.
        varied: of ``varied.conduct_varied``, by experiment.
    """
    content = json.loads(before)
    claims = {key: row for key, row in content["claims"].items() if key in RULES and row["rule"] == RULES[key].asked}
    answered = {claim for one in varied.values() for claim in one.claim.values.tolist()}
    claims = {key: row for key, row in claims.items() if key not in answered} | shares(rows, varied)
    content["varied"] = content.get("varied", {}) | _varied(varied)
    return _table(content, claims)


def _varied(varied: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    """Return by experiment how many designs became what, which source asked them, and which made the rows."""
    return {
        name: {
            "became": became(one),
            "samples": one.sizes["sample"],
            "source": {"runs": json.loads(one.attrs["made_by"])["source"], "answers": code_digest(*_ANSWERED_BY)[:12]},
        }
        for name, one in varied.items()
    }


def _table(content: Mapping[str, Any], claims: Mapping[str, Mapping[str, object]]) -> str:
    whole = {**content, "claims": claims, "digest": digest(claims)}
    return json.dumps(whole, indent=1, sort_keys=True, allow_nan=False) + "\n"


def finite(value: Any) -> Any:
    """Return a value for JSON: what is not finite becomes null."""
    if isinstance(value, float):
        return value if np.isfinite(value) else None
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(item) for item in value]
    return value

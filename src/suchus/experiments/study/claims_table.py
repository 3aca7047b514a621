"""Results of each claim as rows: for the page, for a table, and for the shipped table of fractions."""

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
from suchus.experiments.study.varied import MIN_POINTS
from suchus.visual.figures.sensitivity import parameter_label

_MAX_DECIDERS = 3  # most parameters that a row names
_MAX_SHARED_VARIANCE = 0.1  # largest fraction of a parameter's variance that a stronger one may explain [-]
_ANSWER_MODULES = (
    "article",
    "experiments/claims",
    "sim/metrics/decisive.py",
    "experiments/study/answers.py",
    "experiments/study/claim_measures.py",
    "experiments/study/claims.py",
    "experiments/study/varied.py",
)


def claim_row(record: xr.Dataset, claim: str) -> dict[str, Any]:
    """Return the result of one claim: fraction of designs, deciding parameters with intervals, border.

    Args:
        record: record of ``claims.conduct_claims``.
        claim: its key.
    """
    claim_record = record.sel(claim=claim)
    is_judged = np.isfinite(claim_record.number.values)
    number, holds = claim_record.number.values, claim_record.holds.values.astype(bool)
    count, true = int(is_judged.sum()), int(holds[is_judged].sum())
    index = first_order(record.value.values, number)
    border_index = int(claim_record.border_of)
    quantile_5, median, quantile_95 = np.quantile(number[is_judged], (0.05, 0.5, 0.95)) if count else (np.nan,) * 3
    return {
        "claim": claim,
        "samples": count,
        "words": dict(Counter(word for word in claim_record.word.values.tolist() if word))
        if "word" in claim_record
        else _words_of_walks(record, count, true),
        "true": true / count if count else float("nan"),
        "interval": share_interval(true, count),
        "number": (float(quantile_5), float(median), float(quantile_95)),
        "deciders": [
            {
                "parameter": str(record.parameter.values[i]),
                "decides": float(index.variance_fraction[i]),
                "low": float(index.low[i]),
                "high": float(index.high[i]),
                "correlation": float(claim_record.correlation.values[i]),
            }
            for i in deciders(record.value.values[is_judged], index)
        ],
        "border": None
        if border_index < 0
        else {
            "parameter": str(record.parameter.values[border_index]),
            "unit": str(record.parameter_unit.values[border_index]),
            "at": float(claim_record.border_at),
            "true": "above" if bool(claim_record.border_above) else "below",
            "separation": float(claim_record.border_separation),
        },
    }


def _words_of_walks(record: xr.Dataset, count: int, true: int) -> dict[str, int]:
    """Return how many of the designs that walk say what, where too few can judge a claim; else nothing.

    Args:
        record: record of ``claims.conduct_claims``.
        count: number of designs that can judge the claim [-].
        true: number of those for which it holds [-].
    """
    if count >= MIN_POINTS:
        return {}
    walked = int((record.status == "walked").sum())
    words = {"reproduced": true, "contradicted": count - true, "not testable": walked - count}
    return {word: number for word, number in words.items() if number}


def deciders(parameters: np.ndarray, index: Index) -> list[int]:
    """Return which parameters decide beyond chance, the strongest first, at most three.

    In few points of a Sobol sequence of many dimensions some go together, straight or bent: of 109 in 128 points, two
    were correlated by 0.84, in 2 048 by 0.09 at most. One that explains the values of a stronger one is left out.

    Args:
        parameters: shape (sample, parameter).
        index: index of each parameter, see ``answers.first_order``.
    """
    indices: list[int] = []
    for i in np.argsort(-index.variance_fraction):
        if len(indices) == _MAX_DECIDERS:
            break
        passes = (
            first_order(parameters[:, [i]], parameters[:, j]).variance_fraction[0] > _MAX_SHARED_VARIANCE
            for j in indices
        )
        if index.low[i] > 0 and not any(passes):
            indices.append(int(i))
    return indices


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


def border_texts(rows: Sequence[Mapping[str, Any]]) -> dict[str, str]:
    """Return by claim where it holds, in a few words, for those that too few designs agree on."""
    texts = {}
    for row in rows:
        edge = row["border"]
        if edge and max(row["true"], 1.0 - row["true"]) < ROBUST:
            texts[row["claim"]] = f"{parameter_label(edge['parameter'])} {edge['true']} {edge['at']:.3g} {edge['unit']}"
    return texts


def shares(rows: Sequence[Mapping[str, Any]], sweep_records: Mapping[str, xr.Dataset]) -> dict[str, dict[str, Any]]:
    """Return the rows by claim, as ``verdict.Share``, or as ``verdict.SparseShare`` where few designs could be judged.

    Args:
        rows: rows of ``claim_row``.
        sweep_records: records of ``varied.conduct_varied``, by experiment.
    """
    experiment_of_claim = {
        str(claim): name for name, claim_record in sweep_records.items() for claim in claim_record.claim.values
    }
    share_rows = {}
    for row in rows:
        if row["samples"] < MIN_POINTS:
            if row.get("words"):
                word_row = {
                    "words": row["words"],
                    "of": experiment_of_claim.get(row["claim"], ""),
                    "rule": RULES[row["claim"]].asked,
                }
                share_rows[row["claim"]] = word_row
        else:
            edge = row["border"]
            share_rows[row["claim"]] = {
                "share": round(row["true"], 6),
                "low": round(row["interval"][0], 6),
                "high": round(row["interval"][1], 6),
                "designs": row["samples"],
                "turned_by": edge["parameter"] if edge else "",
                "at": float(f"{edge['at']:.6g}") if edge else None,
                "above": bool(edge and edge["true"] == "above"),
                "of": experiment_of_claim.get(row["claim"], ""),
                "rule": RULES[row["claim"]].asked,
            }
    return share_rows


def count_statuses(record: xr.Dataset) -> dict[str, int]:
    """Return how many samples of a record walked, were impossible, and so on."""
    return dict(sorted(Counter(record.status.values.tolist()).items()))


def shipped_table(
    record: xr.Dataset, rows: Sequence[Mapping[str, Any]], sweep_records: Mapping[str, xr.Dataset]
) -> str:
    """Return the table of shares that ``suchus.article.verdict`` ships: JSON, with its rows' digest and what made it.

    Args:
        record: record of ``claims.conduct_claims``.
        rows: rows of ``claim_row``, of this record and of those that follow.
        sweep_records: records of ``varied.conduct_varied``, by experiment.
    """
    claims = shares(rows, sweep_records)
    provenance = json.loads(record.attrs["made_by"])
    content = {
        "samples": record.sizes["sample"],
        "became": count_statuses(record),
        "varied": _sweep_sources(sweep_records),
        "parameters": record.sizes["parameter"],
        "seed": int(record.attrs["seed"]),
        "cycles": int(record.attrs["cycles"]),
        "timestep": float(record.attrs["timestep"]),
        "agreement": finite(json.loads(record.attrs["agreed"])),
        "versions": {name: version for name, version in provenance.items() if name != "source"},
        "source": {"runs": provenance["source"], "answers": code_digest(*_ANSWER_MODULES)[:12]},
    }
    return _table(content, claims)


def renewed_table(shipped_text: str, rows: Sequence[Mapping[str, Any]], sweep_records: Mapping[str, xr.Dataset]) -> str:
    """Return a table of shares with the rows of some experiments anew; all other rows that today's rules ask stay.

    Args:
        shipped_text: the table, of ``shipped_table``.
        rows: rows of ``claim_row``, of the experiments.
        sweep_records: records of ``varied.conduct_varied``, by experiment.
    """
    content = json.loads(shipped_text)
    claims = {key: row for key, row in content["claims"].items() if key in RULES and row["rule"] == RULES[key].asked}
    answered_claims = {claim for claim_record in sweep_records.values() for claim in claim_record.claim.values.tolist()}
    claims = {key: row for key, row in claims.items() if key not in answered_claims} | shares(rows, sweep_records)
    content["varied"] = content.get("varied", {}) | _sweep_sources(sweep_records)
    return _table(content, claims)


def _sweep_sources(sweep_records: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    """Return by experiment the number of designs by status, and the hashes of the source code."""
    return {
        name: {
            "became": count_statuses(claim_record),
            "samples": claim_record.sizes["sample"],
            "source": {
                "runs": json.loads(claim_record.attrs["made_by"])["source"],
                "answers": code_digest(*_ANSWER_MODULES)[:12],
            },
        }
        for name, claim_record in sweep_records.items()
    }


def _table(content: Mapping[str, Any], claims: Mapping[str, Mapping[str, object]]) -> str:
    document = {**content, "claims": claims, "digest": digest(claims)}
    return json.dumps(document, indent=1, sort_keys=True, allow_nan=False) + "\n"


def finite(value: Any) -> Any:
    """Return a value for JSON: what is not finite becomes null."""
    if isinstance(value, float):
        return value if np.isfinite(value) else None
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(item) for item in value]
    return value

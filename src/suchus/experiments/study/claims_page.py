"""Files of the study of the claims: table, numbers, fractions that the verdicts quote, page."""

import json
from collections.abc import Mapping, Sequence
from importlib import resources
from pathlib import Path
from types import MappingProxyType
from typing import Any

import xarray as xr

from suchus.article.paper import CLAIMS
from suchus.article.verdict import listed
from suchus.core import files as records
from suchus.experiments.study.claims_table import (
    border_texts,
    claim_row,
    count_statuses,
    finite,
    renewed_table,
    shipped_table,
    table,
)
from suchus.experiments.study.result_table import ResultTable, Section, write_tables
from suchus.visual.figures.sensitivity import draw_claim, draw_shares, parameter_label

OUTCOME, TABLE, RECORD, SHARES = "outcome.json", "claims.csv", "claims.nc", "claims.json"


def write_claims(
    record: xr.Dataset, folder: Path, sweep_records: Mapping[str, xr.Dataset] = MappingProxyType({})
) -> Path:
    """Write table, numbers, shares, records and page into a folder, complete or not at all, and return it.

    Args:
        record: record of ``claims.conduct_claims``.
        folder: where.
        sweep_records: records of ``varied.conduct_varied``, by experiment.

    Raises:
        Unwritable: the place cannot be written to, or is taken.
    """
    of_claim = {
        str(claim): claim_record
        for claim_record in (record, *sweep_records.values())
        for claim in claim_record.claim.values
    }
    rows = [claim_row(claim_record, claim) for claim, claim_record in of_claim.items()]
    with records.new_folder(folder, lasting=True) as draft:
        (draft / TABLE).write_text(table(rows), encoding="utf-8")
        (draft / SHARES).write_text(shipped_table(record, rows, sweep_records), encoding="utf-8")
        records.save(record, draft / RECORD)
        for name, claim_record in sweep_records.items():
            records.save(claim_record, draft / f"claims_{name}.nc")
        pictures = {f"claim_{claim}": draw_claim(claim_record, claim) for claim, claim_record in of_claim.items()}
        pictures["shares"] = draw_shares(rows, border_texts(rows))
        sections = _sections(record, rows)
        write_tables(
            draft, "The article's claims over plausible designs", _lead(record, sweep_records), sections, pictures
        )
        text = json.dumps(outcome(record, rows, sweep_records), indent=2, ensure_ascii=False, allow_nan=False)
        (draft / OUTCOME).write_text(text + "\n", encoding="utf-8")
    return folder


def write_renewed(sweep_records: Mapping[str, xr.Dataset], folder: Path) -> Path:
    """Write the table of shares that ships with the rows of some experiments anew, and their records, and return where.

    Args:
        sweep_records: records of ``varied.conduct_varied``, by experiment.
        folder: where, complete or not at all.

    Raises:
        Unwritable: the place cannot be written to, or is taken.
    """
    rows = [
        claim_row(claim_record, str(claim))
        for claim_record in sweep_records.values()
        for claim in claim_record.claim.values
    ]
    shipped_text = (resources.files("suchus.article.verdict") / SHARES).read_text(encoding="utf-8")
    with records.new_folder(folder, lasting=True) as draft:
        (draft / TABLE).write_text(table(rows), encoding="utf-8")
        (draft / SHARES).write_text(renewed_table(shipped_text, rows, sweep_records), encoding="utf-8")
        for name, claim_record in sweep_records.items():
            records.save(claim_record, draft / f"claims_{name}.nc")
    return folder


def outcome(
    record: xr.Dataset, rows: Sequence[dict[str, Any]], sweep_records: Mapping[str, xr.Dataset]
) -> dict[str, Any]:
    """Return the numbers of the study as JSON holds them; what is not finite becomes null.

    Args:
        record: record of ``claims.conduct_claims``.
        rows: rows of ``claims_table.claim_row``.
        sweep_records: records of ``varied.conduct_varied``, by experiment.
    """
    return {
        "study": "claims",
        "timestep": float(record.attrs["timestep"]),
        "agreement": finite(agreements(record)),
        "samples": count_statuses(record),
        "varied": {name: count_statuses(claim_record) for name, claim_record in sweep_records.items()},
        "claims": [finite(row) for row in rows],
        "versions": records.versions(),
    }


def agreements(record: xr.Dataset) -> list[dict[str, Any]]:
    """Return the agreement of each compared time step with 2 ms, see ``answers.Agreement``."""
    agreement_rows: list[dict[str, Any]] = json.loads(record.attrs["agreed"])
    return agreement_rows


def _claim_label(claim: str) -> str:
    return claim.replace("_", " ")


def _lead(record: xr.Dataset, sweep_records: Mapping[str, xr.Dataset]) -> str:
    """Return the first sentences of the page: number of designs, what became of them, number of parameters."""
    parts = ", ".join(
        f"{number} {name}" for name, number in sorted(count_statuses(record).items(), key=lambda item: -item[1])
    )
    sweep_text = listed(
        [
            f"{name} of {claim_record.sizes['sample']} designs and settings"
            for name, claim_record in sweep_records.items()
        ]
    )
    sweep_note = f" Further claims are judged by asking their experiments again: {sweep_text}." if sweep_records else ""
    return (
        f"{record.sizes['sample']} designs and gaits ({parts}), each in six conditions of spine and tail, and with "
        f"each of four joints failed in two of them, over {record.sizes['parameter']} numbers that the article does "
        f"not give.{sweep_note}"
    )


def _sections(record: xr.Dataset, rows: Sequence[dict[str, Any]]) -> list[Section]:
    """Return the sections of the page: fraction true by claim, agreement of the time steps, each claim."""
    agreement_rows = [
        (f"{1000 * a['timestep']:g} ms", f"{100 * a['same']:.1f} %", f"{1000 * a['forward']:.1f} mm",
         f"{1000 * a['wide']:.0f} mm", f"{100 * a['shares']:.1f} points", _claim_label(a["claim"]),
         f"{a['chance']:.2g}")
        for a in agreements(record)
    ]  # fmt: skip
    agreed = ResultTable(
        caption="Coarser time steps beside 2 ms, on the first samples",
        heads=(
            "time step",
            "same truth",
            "displacement, median difference",
            "displacement, 95th percentile",
            "greatest change of a share",
            "of the claim",
            "by chance",
        ),
        rows=agreement_rows,
        words=(0, 5),
    )
    shares = ResultTable(
        caption="Each claim",
        heads=("claim", "samples", "true", "95 % interval", "number: 5, 50, 95 %", "what decides it", "border"),
        rows=[_row(row) for row in rows],
        words=(0, 5, 6),
    )
    decider_note = (
        "What decides: the share of the variance of the claim's number (of its ranks) that one parameter explains "
        "alone, with its 95 % interval, and whether the number rises or falls with it. Border: the value of the "
        "parameter that best predicts where the sentence is true, and how well (1: always)."
    )
    claim_sections = [
        Section(
            title=_claim_label(row["claim"]), texts=(CLAIMS[row["claim"]].sense,), figures=(f"claim_{row['claim']}",)
        )
        for row in rows
    ]
    return [
        Section(title="In which share each is true", texts=(decider_note,), figures=("shares",), tables=(shares,)),
        Section(
            title="Is the time step fine enough?",
            texts=(f"The study ran with {1000 * record.attrs['timestep']:g} ms.",),
            tables=(agreed,),
        ),
        *claim_sections,
    ]


def _row(row: dict[str, Any]) -> tuple[str, ...]:
    """Return one row of the table of claims as text."""
    lower_bound, upper_bound = row["interval"]
    deciders = [
        f"{parameter_label(d['parameter'])} {d['decides']:.2f} ({d['low']:.2f} to {d['high']:.2f}), "
        f"{'rises' if d['correlation'] > 0 else 'falls'}"
        for d in row["deciders"]
    ]
    edge = row["border"]
    told_border = ""
    if edge is not None:
        border_text = f"{edge['at']:.3g} {edge['unit']}"
        told_border = f"{parameter_label(edge['parameter'])} {edge['true']} {border_text} ({edge['separation']:.2f})"
    return (
        _claim_label(row["claim"]),
        str(row["samples"]),
        f"{100 * row['true']:.0f} %",
        f"{100 * lower_bound:.0f} to {100 * upper_bound:.0f} %",
        ", ".join(f"{x:.2g}" for x in row["number"]),
        "; ".join(deciders) or "none beyond chance",
        told_border,
    )

"""What the study of the claims leaves: a table, numbers, a page."""

import csv
import io
import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus import record as records
from suchus.figures import COLOURS, captioned, panels, styled
from suchus.figures.sensitivity import draw_claim
from suchus.paper import CLAIMS
from suchus.study.answers import Index, first_order, share_interval
from suchus.study.sheet import Section, Table, write_sheet

OUTCOME, TABLE, RECORD = "outcome.json", "claims.csv", "claims.nc"
_NAMED = 3  # parameters that a row names
_TOGETHER = 0.1  # of the variance of one parameter; another that explains more could pass for it [-]


def write_claims(record: xr.Dataset, folder: Path) -> Path:
    """Write table, numbers, record and page into a folder, which appears complete or not at all, and return it.

    Args:
        record: of ``claims.conduct_claims``.
        folder: where.

    Raises:
        Unwritable: the place cannot be written to, or is taken.
    """
    rows = [told(record, str(claim)) for claim in record.claim.values]
    with records.new_folder(folder, mark=OUTCOME) as draft:
        (draft / TABLE).write_text(table(rows), encoding="utf-8")
        records.save(record, draft / RECORD)
        pictures = {f"claim_{row['claim']}": draw_claim(record, row["claim"]) for row in rows}
        pictures["shares"] = draw_shares(rows)
        sections = _sections(record, rows)
        write_sheet(draft, "The article's claims over plausible designs", _lead(record), sections, pictures)
        text = json.dumps(outcome(record, rows), indent=2, ensure_ascii=False, allow_nan=False)
        (draft / OUTCOME).write_text(text + "\n", encoding="utf-8")
    return folder


def told(record: xr.Dataset, claim: str) -> dict[str, Any]:
    """Return what became of one claim: share, deciders with their intervals, border."""
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


def table(rows: Sequence[dict[str, Any]]) -> str:
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


def outcome(record: xr.Dataset, rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return everything as JSON holds it; what is not finite becomes null."""
    return {
        "study": "claims",
        "timestep": float(record.attrs["timestep"]),
        "agreement": _finite(agreements(record)),
        "samples": dict(sorted(Counter(record.status.values.tolist()).items())),
        "claims": [_finite(row) for row in rows],
        "versions": records.versions(),
    }


def agreements(record: xr.Dataset) -> list[dict[str, Any]]:
    """Return how each time step that was tried agreed with 2 ms, see ``answers.Agreement``."""
    tried: list[dict[str, Any]] = json.loads(record.attrs["agreed"])
    return tried


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if np.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    return value


def draw_shares(rows: Sequence[dict[str, Any]]) -> Figure:
    """Draw in which share of the samples each claim is true, with its interval."""
    with styled():
        figure, axes = panels(1, 1, width=9.0, height=0.9 + 0.4 * len(rows))
        ax = axes[0, 0]
        for i, row in enumerate(reversed(rows)):
            low, high = row["interval"]
            ax.barh(i, 100 * row["true"], color=COLOURS["ours"], height=0.6, alpha=0.8)
            ax.plot([100 * low, 100 * high], [i, i], color="black", linewidth=1.6)
        ax.set_yticks(range(len(rows)), [_short(row["claim"]) for row in reversed(rows)])
        ax.axvline(50, color=COLOURS["neutral"], linewidth=0.9, linestyle=(0, (2, 2)))
        ax.set_xlim(0, 100)
        ax.set_xlabel("designs and gaits in which the sentence is true [%]")
        ax.grid(False, axis="y")
    return captioned(
        figure, "In which share of the plausible designs and gaits each claim is true; lines: 95 % intervals."
    )


def _short(claim: str) -> str:
    return claim.replace("_", " ")


def _lead(record: xr.Dataset) -> str:
    count = Counter(record.status.values.tolist())
    parts = ", ".join(f"{number} {name}" for name, number in sorted(count.items(), key=lambda item: -item[1]))
    return (
        f"{record.sizes['sample']} designs and gaits ({parts}), each with spine and tail and with limbs only, whole "
        f"and with four joints lost, over {record.sizes['parameter']} numbers that the article does not give."
    )


def _sections(record: xr.Dataset, rows: Sequence[dict[str, Any]]) -> list[Section]:
    tried = [
        (f"{1000 * a['timestep']:g} ms", f"{100 * a['same']:.1f} %", f"{1000 * a['way']:.1f} mm",
         f"{1000 * a['wide']:.0f} mm", f"{100 * a['shares']:.1f} points", _short(a["claim"]), f"{a['chance']:.2g}")
        for a in agreements(record)
    ]  # fmt: skip
    agreed = Table(
        caption="Coarser time steps beside 2 ms, on the first samples",
        heads=(
            "time step",
            "same truth",
            "way, median difference",
            "way, 95th percentile",
            "greatest change of a share",
            "of the claim",
            "by chance",
        ),
        rows=tried,
        words=(0, 5),
    )
    shares = Table(
        caption="Each claim",
        heads=("claim", "samples", "true", "95 % interval", "number: 5, 50, 95 %", "what decides it", "border"),
        rows=[_row(row) for row in rows],
        words=(0, 5, 6),
    )
    how = (
        "What decides: the share of the variance of the claim's number (of its ranks) that one parameter explains "
        "alone, with its 95 % interval, and whether the number rises or falls with it. Border: the value of the "
        "parameter that best tells where the sentence is true, and how well (1: it tells everything)."
    )
    each = [
        Section(title=_short(row["claim"]), texts=(CLAIMS[row["claim"]].sense,), figures=(f"claim_{row['claim']}",))
        for row in rows
    ]
    return [
        Section(title="In which share each is true", texts=(how,), figures=("shares",), tables=(shares,)),
        Section(
            title="Is the time step fine enough?",
            texts=(f"The study ran with {1000 * record.attrs['timestep']:g} ms.",),
            tables=(agreed,),
        ),
        *each,
    ]


def _row(row: dict[str, Any]) -> tuple[str, ...]:
    low, high = row["interval"]
    deciders = [
        f"{_plain(d['parameter'])} {d['decides']:.2f} ({d['low']:.2f} to {d['high']:.2f}), "
        f"{'rises' if d['correlation'] > 0 else 'falls'}"
        for d in row["deciders"]
    ]
    edge = row["border"]
    told_border = ""
    if edge is not None:
        at = f"{edge['at']:.3g} {edge['unit']}"
        told_border = f"{_plain(edge['parameter'])} {edge['true']} {at} ({edge['separation']:.2f})"
    return (
        _short(row["claim"]),
        str(row["samples"]),
        f"{100 * row['true']:.0f} %",
        f"{100 * low:.0f} to {100 * high:.0f} %",
        ", ".join(f"{x:.2g}" for x in row["number"]),
        "; ".join(deciders) or "none beyond chance",
        told_border,
    )


def _plain(parameter: str) -> str:
    of, _, name = parameter.partition(".")
    words = name.replace("_", " ").replace(".", ", ")
    return words if of == "robot" else f"{words} (gait)"

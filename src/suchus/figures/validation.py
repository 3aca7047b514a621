"""Plots of the flow solver's validation, and the page that shows them beside its numbers."""

import json
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suchus.errors import IncompatibleRecord
from suchus.figures.style import COLOURS, styled
from suchus.figures.validation_page import UNKNOWN, Row, load_rows, merged, page
from suchus.record import new_file

_SMALL = {"fontsize": 10}
_LINE, _OTHER, _DATA = COLOURS["coordinated"], COLOURS["limbs_only"], COLOURS["printed"]


def _curves(rows: list[dict[str, Any]], case: str, part: str) -> dict[str, Any] | None:
    whole = re.compile(re.escape(part) + r"(?!\d)")  # Re 100 is not Re 1000
    found = [r["curves"] for r in rows if r["case"] == case and whole.search(r["quantity"]) and r["curves"]]
    return max(found, key=lambda curves: len(next(iter(curves.values())))) if found else None  # the fullest


def _draw_started(rows: list[dict[str, Any]]) -> Figure:
    figure = Figure(figsize=(8.0, 3.4), layout="constrained")
    for k, reynolds in enumerate((40, 550)):
        axes = figure.add_subplot(1, 2, k + 1)
        curves = _curves(rows, "impulsively started cylinder", f"Re {reynolds}")
        if curves:
            axes.plot(curves["t"], curves["cd"], color=_LINE, alpha=0.5, linewidth=4, label="from body to water")
            axes.plot(curves["t"], curves["box"], color=_OTHER, linestyle="--", linewidth=1.4, label="momentum box")
            axes.plot(curves["polar_t"], curves["polar_cd"], "k-", linewidth=0.8, label="polar coordinates")
            axes.plot(curves["data_t"], curves["data_cd"], "k.", label="Koumoutsakos and\nLeonard 1995")
            late = [c for t, c in zip(curves["t"], curves["cd"], strict=True) if t > 0.3]
            axes.set_ylim(0.8 * min(late), 1.15 * max(late))
            axes.set_xlim(0, max(curves["t"]))
            if k == 0:
                axes.legend(**_SMALL)
        axes.set_title(f"started cylinder, Re {reynolds}")
        axes.set_xlabel("t U / R [-]")
        axes.set_ylabel("drag coefficient [-]")
    return figure


def _draw_energy(rows: list[dict[str, Any]]) -> Figure:
    figure = Figure(figsize=(5.6, 3.6), layout="constrained")
    energy = figure.subplots()
    found = {r["quantity"]: r["curves"] for r in rows if r["case"] == "energy budget" and "share" in r["curves"]}
    base: np.ndarray = np.zeros(1)
    for quantity, part in found.items():
        share, places = np.array(part["share"]), np.arange(len(part["share"]))
        base = base if base.size == share.size else np.zeros(share.size)
        energy.bar(places, share, 0.6, bottom=base, label=quantity.removeprefix("share of the work: "))
        base = base + share
        energy.set_xticks(places, [str(n) for n in part["cells"]])
    energy.set(
        xlabel="cells per diameter [-]", ylabel="share of the work of the body [-]", title="energy budget in a box"
    )
    if found:
        energy.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), reverse=True, **_SMALL)
    return figure


def _slope(axes: Axes, size: np.ndarray, error: np.ndarray, order: int, label: str | None) -> None:
    dashes = "--" if order == 2 else ":"
    axes.loglog(size, 0.7 * error[-1] * (size[-1] / size) ** order, color="k", ls=dashes, lw=1.0, label=label)


def _draw_convergence(rows: list[dict[str, Any]]) -> Figure:
    figure = Figure(figsize=(9.6, 4.0), layout="constrained")
    fields, forces, swim = figure.subplots(1, 3)
    for k, (case, label) in enumerate((("Taylor-Green", "Taylor-Green"), ("turning cylinder", "turning cylinder"))):
        curves = _curves(rows, case, "order")
        if curves:
            fields.loglog(curves["size"], curves["error"], "os"[k] + "-", label=label)
            _slope(fields, np.array(curves["size"]), np.array(curves["error"]), 2, None if k else "order 2")
    fields.set(xlabel="cells per side or diameter [-]", ylabel="rms error of velocity [-]", title="velocity")
    for k, (case, part, sizes, values, exact, label) in enumerate(
        (
            ("DFG 2D-1", "Cd", "rows", "cd", 5.57953523384, "drag, DFG 2D-1"),
            ("turning cylinder", "order", "size", "torque", 0.0, "torque, turning cyl."),
        )
    ):
        curves = _curves(rows, case, part)
        if curves:
            size, value = np.array(curves[sizes]) / (4.1 if sizes == "rows" else 1.0), np.array(curves[values])
            error = np.abs(value / exact - 1) if exact else value
            forces.loglog(size, error, "os"[k] + "-", label=label)
            _slope(forces, size, error, 1, None if k else "order 1")
    forces.set(xlabel="cells per diameter [-]", ylabel="relative error of force [-]", title="force")
    for k, case in enumerate(sorted({r["case"] for r in rows if r["case"].startswith("free eel")})):
        curves = _curves(rows, case, "mean speed")
        if curves:
            swim.plot(curves["cells"], curves["speed"], "os^D"[k % 4] + "-", label=case.removeprefix("free eel, "))
    swim.set(xlabel="cells per body length [-]", ylabel="speed [body lengths per cycle]", title="free eel, last cycle")
    swim.set_ylim(0, 0.8)
    for axes, ticks in ((fields, (16, 32, 64, 128)), (forces, (8, 16, 32, 64, 128)), (swim, (128, 192, 288, 384))):
        axes.set_xticks(ticks, [str(n) for n in ticks])
        axes.tick_params(axis="x", which="minor", bottom=False, labelbottom=False)
        if axes.lines:
            axes.legend(loc="upper left", bbox_to_anchor=(0.0, -0.2), frameon=False, **_SMALL)
    return figure


DRAWN: Final[Mapping[str, Callable[[list[dict[str, Any]]], Figure]]] = MappingProxyType(
    {
        "started": _draw_started,
        "energy": _draw_energy,
        "convergence": _draw_convergence,
    }
)
"""The plots of the page by name: each is drawn from all rows."""


KEPT = "validation.json"
"""File beside the page with every row that stands on it, so that a part of the validation renews its rows alone."""


def kept_rows(docs: Path) -> list[Row]:
    """Return the rows of the page as it stands in ``docs``; none where there is no page.

    Raises:
        IncompatibleRecord: the file of the rows is damaged.
    """
    path = docs / KEPT
    if not path.exists():
        return []
    try:
        rows = json.loads(path.read_text(encoding="utf-8"))
        merged(rows, ())
    except (ValueError, KeyError, TypeError) as error:
        raise IncompatibleRecord(f"{path} holds no rows of the validation; take it from the last commit.") from error
    return list(rows)


def write_table(
    folder: Path, docs: Path, sources: Sequence[str] = (), *, whole: bool = False, tests: Collection[str] = ()
) -> None:
    """Write ``validation.md``, and its rows beside it, to ``docs``.

    Args:
        folder: where the validation kept its rows.
        docs: where the page stands.
        sources: sentences on where the published numbers come from.
        whole: whether these are all rows there are; else those of the page that are not computed anew stay on it.
        tests: names of the tests there are; rows of others do not stay.

    Raises:
        IncompatibleRecord: there are no rows, or those of the page are damaged.
    """
    rows = merged([] if whole else kept_rows(docs), load_rows(folder), tests)
    bare = [
        {name: value for name, value in row.items() if name != "curves"} for row in rows if row["theirs"] != UNKNOWN
    ]
    with new_file(docs / KEPT) as draft:
        draft.write_text("[\n" + ",\n".join(map(json.dumps, bare)) + "\n]\n", encoding="utf-8")
    with new_file(docs / "validation.md") as draft:
        draft.write_text(page(rows, sources), encoding="utf-8")


def write_validation(folder: Path, docs: Path, sources: Sequence[str] = ()) -> None:
    """Write ``validation.md``, see ``write_table``, and its plots, which are drawn from the rows in ``folder`` alone.

    Raises:
        IncompatibleRecord: there are no rows, or those of the page are damaged.
    """
    rows = load_rows(folder)
    pictures = docs / "pictures"
    pictures.mkdir(parents=True, exist_ok=True)
    for name, draw in DRAWN.items():
        with styled():
            draw(rows).savefig(pictures / f"flow_{name}.png")
    write_table(folder, docs, sources)

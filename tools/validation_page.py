"""The page of the flow solver's validation, its rows grouped by kind of case, each group with its plot."""

import json
import operator
import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evidence import renew, store
from suchus.core.errors import IncompatibleRecord, UnreadableFile
from suchus.core.files import new_file
from suchus.visual.figures.style import COLOURS, styled

UNKNOWN = "-"
"""Value of ``theirs`` in a row without anything to compare with: its curves are drawn, and it is in no table."""

Row = Mapping[str, Any]
"""One comparison: ``case``, ``quantity``, ``ours``, ``theirs``, ``grid``, ``domain``, ``source``, ``code``, ``curves``;
``code`` is how the hash of the solver's source began."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Group:
    """Cases that answer one question."""

    title: str
    """Heading on the page."""
    about: str
    """What the cases show, in one or two sentences."""
    cases: tuple[str, ...]
    """Prefixes of the names of its cases."""
    figures: tuple[tuple[str, str], ...] = ()
    """Name of each plot, and what it shows."""


GROUPS = (
    Group(
        title="Exact answers",
        about="Flows with a known exact solution, and budgets that must close. They show that the equations are "
        "solved, and with which order of accuracy.",
        cases=(
            "Taylor-Green",
            "turning cylinder",
            "oscillating cylinder",
            "added mass",
            "momentum budget",
            "energy budget",
        ),
        figures=(
            (
                "convergence",
                "Errors against the number of cells, for velocity and force, and the speed of the free eel",
            ),
            ("energy", "Energy budget: shares of the work of a body that oscillates in a box"),
        ),
    ),
    Group(
        title="Started cylinder",
        about="Drag of an impulsively started cylinder, beside an independent solver for the vorticity in polar "
        "coordinates, which shares no code with this one.",
        cases=("impulsively started cylinder",),
        figures=(("started", "Drag of an impulsively started cylinder over time"),),
    ),
    Group(
        title="Swimming bodies",
        about="The swimming eel of the literature, free or tethered. Force noise is the part of the force that changes "
        "from step to step.",
        cases=("free eel", "tethered eel", "held eel"),
    ),
    Group(
        title="Fine cells around a body alone",
        about="The same flow on a patch of fine cells nested in coarser ones, and on fine cells everywhere, which the "
        "column of exact numbers holds; and the section of a flying snake on a patch as fine as its source's grid.",
        cases=("patch", "flying snake"),
    ),
    Group(
        title="Robot and flow together",
        about="Bodies whose motion is solved together with the water: a hinge on a spring, the added mass of links "
        "near each other, flags behind a cylinder as chains of links, three links that swim as viscosity falls, and "
        "what robot and water owe each other, of a robot nearly as heavy as the water that it displaces and of "
        "lighter ones. Joints that are held straight, that follow their course or that nothing holds stand beside free "
        "bodies of the flow solver and free links.",
        cases=(
            "ellipse on a torsion spring",
            "three bent ellipses",
            "flag behind a cylinder",
            "three-link swimmer",
            "coupled swimmer",
            "robot whose joints",
            "robot on its servos",
            "robot without stiffness",
            "step of a robot",
        ),
        figures=(
            (
                "flag",
                "Way of a flag's tip across the channel by the number of its links, and the published range",
            ),
        ),
    ),
    Group(
        title="In three dimensions",
        about="Decaying vortices, spheres and spheroids against exact and published numbers, budgets of momentum. The "
        "robot of `suchus run swim_3d`, free in its own box of water and in a wide one: what the sides do.",
        cases=("box of Taylor-Green vortices", "sphere", "spheroid", "eel in space", "swimming robot"),
    ),
)
"""The groups of the page in their order; a case that none of them names is in a last group."""

_OTHERS = Group(title="Other cases", about="Cases that belong to none of the groups above.", cases=("",))
_MISSED = "**missed**"
_HEAD = ("quantity", "computed", "published or exact", "difference", "grid", "domain", "source", "code")
_SHARED = ("grid", "domain", "source", "code")


def load_rows(folder: Path) -> list[dict[str, Any]]:
    """Return the rows that a validation kept.

    Raises:
        IncompatibleRecord: there are none.
    """
    rows = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(folder.glob("*.json"))]
    if not rows:
        raise IncompatibleRecord(f"{folder} holds no validation rows; run `make validate` first.")
    return rows


def merged(kept: Sequence[Row], new: Sequence[Row], tests: Collection[str] = ()) -> list[Row]:
    """Return all rows in their order, those of a quantity that was computed anew in the place of the old ones.

    Args:
        kept: rows of before.
        new: rows of now.
        tests: names of the tests there are; rows of before that name another one are left out. None leaves all.
    """
    still = [row for row in kept if not (tests and row.get("test")) or _test_of(row) in tests]
    rows = {f"{row['case']} {row['quantity']}.": row for row in (*still, *new)}
    return [rows[key] for key in sorted(rows)]


def _test_of(row: Row) -> str:
    """Return the name of the test that made a row, without its parameters."""
    name: str = row["test"].rpartition("::")[2].partition("[")[0]
    return name


def page(rows: Sequence[Row], sources: Sequence[str] = ()) -> str:
    """Return the page as Markdown.

    Args:
        rows: every comparison, in any order.
        sources: sentences on where the published numbers come from.
    """
    shown = [row for row in rows if row["theirs"] != UNKNOWN]
    groups = [(group, grouped) for group, grouped in _grouped(shown) if grouped]
    contents = [f"- [{group.title}](#{_anchor(group.title)}): {_count(grouped)}" for group, grouped in groups]
    lines = [
        "# Validation of the flow solver", "",
        "Results of `suchus.flow` beside exact solutions, budgets that must close and required bounds. `make "
        "validate` runs every case (`tests/flow/test_validate_*.py`) and writes this page; every row is a run. Code "
        "is how the hash of the solver's source began in that run, `suchus.core.files.code_digest(\"flow\")`: cases "
        "that are run alone renew their own rows, and a row without a code is older than this rule. Comparisons with "
        "published data are in the [atlas](atlas.md). [Limits](flow_limits.md) says what the rows mean, and where the "
        "solver falls short: a required bound that is not kept is marked.", "",
        "Grids are given in cells per diameter D or body length L. Re is the Reynolds number, Cd and Ci are the "
        "coefficients of drag and inertia, KC is the Keulegan-Carpenter number.", "",
        *contents,
    ]  # fmt: skip
    for group, grouped in groups:
        lines += ["", f"## {group.title}", "", group.about]
        for name, text in group.figures:
            lines += ["", f"![{text}](pictures/flow_{name}.png)"]
        for case in dict.fromkeys(str(row["case"]) for row in grouped):
            lines += _table(case, [row for row in grouped if row["case"] == case])
    if sources:
        lines += ["", "## Sources", "", *(f"- {source}" for source in sources)]
    return "\n".join(lines) + "\n"


def _grouped(rows: Sequence[Row]) -> Iterator[tuple[Group, list[Row]]]:
    """Yield each group with its rows: in the order in which the group names its cases."""
    left = list(rows)
    for group in (*GROUPS, _OTHERS):
        found = [row for start in group.cases for row in left if str(row["case"]).startswith(start)]
        left = [row for row in left if row not in found]
        yield group, found


def _table(case: str, rows: Sequence[Row]) -> list[str]:
    """Return a case's heading, what all its rows have in common, and the table of the rest."""
    cells = [_cells(row) for row in rows]
    common = [name for name in _SHARED if len({cell[name] for cell in cells}) == 1]
    shared = [f"{name.capitalize()}: {cells[0][name]}." for name in common if cells[0][name] not in ("-", "")]
    columns = [name for name in _HEAD if name not in common and any(cell[name] for cell in cells)]
    lines = ["", f"### {case[:1].upper()}{case[1:]}", ""]
    lines += [" ".join(shared), ""] if shared else []
    lines += [f"| {' | '.join(columns)} |", "|" + "---|" * len(columns)]
    return lines + [f"| {' | '.join(cell[name] for name in columns)} |" for cell in cells]


def _cells(row: Row) -> dict[str, str]:
    theirs = row["theirs"]
    number = isinstance(theirs, int | float)
    return {
        "quantity": str(row["quantity"]),
        "computed": f"{row['ours']:.4g}",
        "published or exact": f"{theirs:.4g}" if number else str(theirs),
        "difference": _compared(float(row["ours"]), theirs),
        **{name: str(row.get(name, "")) for name in _SHARED},
    }


def _compared(ours: float, theirs: float | str) -> str:
    """Return the difference from a number in per cent, or whether a bound is kept; empty where neither can be said."""
    if isinstance(theirs, int | float):
        off = 100 * (ours / theirs - 1) if theirs else 0.0
        return f"{off:+.{1 if abs(off) >= 0.1 else 2}f} %" if theirs else ""
    bound = re.fullmatch(r"(at least|at most|below|above) ([\d.e+-]+)", theirs)
    if bound is None:
        return ""
    kept = {"at least": operator.ge, "at most": operator.le, "below": operator.lt, "above": operator.gt}[bound[1]]
    return "kept" if kept(ours, float(bound[2])) else _MISSED


def _anchor(title: str) -> str:
    return title.lower().replace(" ", "-")


def _count(rows: Sequence[Row]) -> str:
    cases, missed = len({row["case"] for row in rows}), sum(_cells(row)["difference"] == _MISSED for row in rows)
    bounds = f", {missed} bound{'s' * (missed > 1)} missed" if missed else ""
    return f"{cases} case{'s' * (cases > 1)}, {len(rows)} number{'s' * (len(rows) > 1)}{bounds}"


_SMALL = {"fontsize": 10}
_LINE, _OTHER = COLOURS["coordinated"], COLOURS["limbs_only"]


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


def _draw_flag(rows: list[dict[str, Any]]) -> Figure:
    figure = Figure(figsize=(9.6, 3.8), layout="constrained")
    for axes, name in zip(figure.subplots(1, 2), ("FSI2", "FSI3"), strict=True):
        for k, count in enumerate((7, 14, 28)):
            curves = _curves(rows, f"flag behind a cylinder, {name}, {count} links", "tip across")
            if not curves:
                continue
            time, tip = np.array(curves["t"]), np.array(curves["tip"])
            axes.plot(time - time[-1], tip, color=(_OTHER, "0.55", _LINE)[k], lw=1.0 + 0.4 * k, label=f"{count} links")
            if count == 28:
                middle, half = float(curves["middle"]), float(curves["half"])
                for edge, label in ((middle - half, "published range"), (middle + half, None)):
                    axes.axhline(edge, color="k", ls="--", lw=1.0, label=label)
        axes.set(xlabel="time from the end of the run [s]", ylabel="way of the tip across [mm]", title=name)
        if axes.lines:
            axes.legend(loc="upper left", bbox_to_anchor=(0.0, -0.2), ncols=2, frameon=False, **_SMALL)
    return figure


DRAWN: Final[Mapping[str, Callable[[list[dict[str, Any]]], Figure]]] = MappingProxyType(
    {
        "started": _draw_started,
        "energy": _draw_energy,
        "convergence": _draw_convergence,
        "flag": _draw_flag,
    }
)
"""The plots of the page by name: each is drawn from all rows."""


NAME = "validation"
"""Result with every row that stands on the page, so that a part of the validation renews its rows alone."""


def kept_rows(results: Path | None = None) -> list[Row]:
    """Return the rows of the page as it stands; none where there is no page.

    Args:
        results: folder of the results; that of the checkout if None.

    Raises:
        IncompatibleRecord: the file of the rows is damaged.
    """
    path = (results or store.RESULTS) / f"{NAME}.json"
    if not path.exists():
        return []
    try:
        rows = store.load(NAME, results).values
        merged(rows, ())
    except (UnreadableFile, KeyError, TypeError) as error:
        raise IncompatibleRecord(f"{path} holds no rows of the validation; take it from the last commit.") from error
    return list(rows)


def write_table(
    folder: Path,
    docs: Path,
    sources: Sequence[str] = (),
    *,
    whole: bool = False,
    tests: Collection[str] = (),
    results: Path | None = None,
) -> None:
    """Write ``validation.md`` to ``docs``, and keep its rows.

    Args:
        folder: where the validation kept its rows.
        docs: where the page stands.
        sources: sentences on where the published numbers come from.
        whole: whether these are all rows there are; else those of the page that are not computed anew stay on it.
        tests: names of the tests there are; rows of others do not stay.
        results: folder of the results; that of the checkout if None.

    Raises:
        IncompatibleRecord: there are no rows, or those of the page are damaged.
    """
    rows = merged([] if whole else kept_rows(results), load_rows(folder), tests)
    bare = [
        {name: value for name, value in row.items() if name != "curves"} for row in rows if row["theirs"] != UNKNOWN
    ]
    if whole and results is None:
        renew.store(NAME, bare)
    else:
        store.save_part(NAME, bare, results)
    with new_file(docs / "validation.md") as draft:
        draft.write_text(page(rows, sources), encoding="utf-8")


def write_validation(folder: Path, docs: Path, sources: Sequence[str] = (), *, results: Path | None = None) -> None:
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
    write_table(folder, docs, sources, results=results)

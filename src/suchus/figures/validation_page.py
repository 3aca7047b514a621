"""The page of the flow solver's validation: its rows grouped by kind of case, each group with its plot."""

import json
import operator
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from suchus.errors import IncompatibleRecord

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
        "is how the hash of the solver's source began in that run, `suchus.record.code_digest(\"flow\")`: cases that "
        "are run alone renew their own rows, and a row without a code is older than this rule. Comparisons with "
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
        return f"{100 * (ours / theirs - 1):+.1f} %" if theirs else ""
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

"""Run ``python -m evidence.water``: write the checks as data and the table of the page."""

import csv
import sys
from pathlib import Path

from evidence.water.cases import CASES, ISSUE, Check

ROOT = Path(__file__).parents[2]
DATA = Path(__file__).parent / "data" / "checks.csv"
"""The checks as data."""
PAGE = ROOT / "docs" / "water_in_mujoco.md"
"""The page that shows them."""
START, END = "<!-- water_checks: made by python -m evidence.water -->", "<!-- /water_checks -->"
"""Lines of the page between which the tables stand."""
FIELDS = ("group", "case", "quantity", "computed", "reference", "unit", "tolerance", "source")
"""Columns of the data."""


def compute() -> dict[str, list[Check]]:
    """Return the checks of every case, by the case's name."""
    return {name: case() for name, case in CASES.items()}


def write_data(checks: dict[str, list[Check]], path: Path) -> None:
    """Write checks as a table of comma-separated values.

    Args:
        checks: checks by the name of their case.
        path: file to write.
    """
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(FIELDS)
        for group, members in checks.items():
            for check in members:
                numbers = f"{check.computed:.9g}", f"{check.reference:.9g}", check.unit, f"{check.tolerance:.3g}"
                writer.writerow((group, check.case, check.quantity, *numbers, check.source))


def read_data(path: Path = DATA) -> list[dict[str, str]]:
    """Return the rows of the checks as data.

    Args:
        path: file that ``write_data`` wrote.
    """
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def tables(rows: list[dict[str, str]]) -> str:
    """Return the tables of the page: the rows of the issue, and what is farthest off in each group.

    Args:
        rows: the checks as data.
    """
    lines = ["| table of MuJoCo issue 3452 | here | physics |", "|---|---|---|"]
    for row in rows:
        if row["source"] == ISSUE or "issue 3452" in row["source"]:
            here, exact = float(row["computed"]), float(row["reference"])
            lines.append(
                f"| {row['case']}: {row['quantity']} | {_show(here)} {row['unit']} | {_show(exact)} {row['unit']} |"
            )
    lines += ["", "| group | checks | farthest off | accepted |", "|---|---|---|---|"]
    for group in dict.fromkeys(row["group"] for row in rows):
        members = [row for row in rows if row["group"] == group]
        worst = max(members, key=_used)
        off = abs(float(worst["computed"]) - float(worst["reference"]))
        accepted = f"{float(worst['tolerance']):.2g} {worst['unit']}"
        lines.append(f"| {group} | {len(members)} | {worst['case']}: {off:.1g} {worst['unit']} | {accepted} |")
    return "\n".join(lines)


def _used(row: dict[str, str]) -> float:
    """Return the difference of a check over what is accepted [-]."""
    tolerance = float(row["tolerance"])
    return abs(float(row["computed"]) - float(row["reference"])) / tolerance if tolerance else 0.0


def _show(value: float) -> str:
    """Return a number for a table; what is nothing but rounding is 0."""
    return "0" if abs(value) < 1e-9 else f"{value:.6g}"


def main() -> int:
    """Compute the checks, write data and tables, and return 1 if a check does not hold."""
    checks = compute()
    write_data(checks, DATA)
    before, _, rest = PAGE.read_text(encoding="utf-8").partition(START)
    after = rest.partition(END)[2]
    PAGE.write_text(f"{before}{START}\n{tables(read_data())}\n{END}{after}", encoding="utf-8")
    missed = [check for members in checks.values() for check in members if not check.holds]
    for check in missed:
        print(f"{check.case}: {check.quantity} is {check.computed:g} {check.unit}, wanted {check.reference:g}.")
    print(f"{sum(map(len, checks.values()))} checks, {len(missed)} do not hold; {DATA.relative_to(ROOT)}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())

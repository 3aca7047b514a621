"""Range checks of designs: all invalid fields of one part are reported in one error."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import inf, isfinite
from types import TracebackType
from typing import Any

from suchus.core.errors import InvalidDesign
from suchus.core.kinds import misfits, show
from suchus.core.printable import name_complaint

Schedule = float | tuple[tuple[float, float], ...]
"""A number, or a table of time since the beginning of the run [s] and number; straight between, steady beyond."""


@dataclass(frozen=True, slots=True)
class Complaint:
    """An invalid field, or a combination of fields that is invalid."""

    field: str
    """Name of the field; empty where the fault lies in several together."""
    text: str
    """What was found and what is allowed, ready to follow the field's name."""


class InvalidFields(InvalidDesign):
    """A part of a design with impossible fields.

    Attributes:
        complaints: one for each mistake.
    """

    def __init__(self, owner: str, complaints: tuple[Complaint, ...]) -> None:
        self.complaints = complaints
        super().__init__("; ".join(f"{owner}.{c.field} {c.text}" if c.field else c.text for c in complaints) + ".")


class Checks:
    """Collects the invalid fields of a frozen value and raises one error when the ``with`` block ends.

    Fields whose values do not match their declared types are reported too.

    Args:
        owner: what the value is called, for the message.
        design: the value whose fields are checked.

    Raises:
        InvalidFields: on leaving the block, if anything was wrong.
    """

    def __init__(self, owner: str, design: object) -> None:
        self._owner = owner
        self._design = design
        self._complaints: list[Complaint] = []

    def __enter__(self) -> "Checks":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Raise ``InvalidFields`` with all complaints; an error of a wrong type inside the block becomes its cause."""
        if error is None or isinstance(error, (TypeError, ValueError, AttributeError, OverflowError)):
            complained = {complaint.field.partition("[")[0] for complaint in self._complaints}
            self._complaints += [Complaint(*misfit) for misfit in misfits(self._design) if misfit[0] not in complained]
            if self._complaints:
                raise InvalidFields(self._owner, tuple(self._complaints)) from error

    def number(self, field: str, lower_bound: float, upper_bound: float, unit: str) -> None:
        """Refuse what is not a finite number of ``lower_bound`` to ``upper_bound``."""
        value = getattr(self._design, field)
        if not _is_within(value, lower_bound, upper_bound):
            limits = f"{_show(lower_bound)} to {_show(upper_bound, unit)}"
            self._complain(field, f"is {_show(value, unit)}; {limits} is allowed")

    def each(self, field: str, names: Sequence[str], lower_bound: float, upper_bound: float, unit: str) -> None:
        """Refuse a row that has not one finite number of ``lower_bound`` to ``upper_bound`` for each name.

        Args:
            field: name of the field.
            names: one for each number of the row.
            lower_bound: least allowed number.
            upper_bound: greatest allowed number.
            unit: unit of the numbers, for the message.
        """
        row = getattr(self._design, field)
        if not isinstance(row, (tuple, list)):
            return  # reported as a misfit
        if len(row) != len(names):
            self._complain(field, f"has {len(row)} numbers; {', '.join(names)} need one each")
            return
        for i, value in enumerate(row):
            if not _is_within(value, lower_bound, upper_bound):
                limits = f"{_show(lower_bound)} to {_show(upper_bound, unit)}"
                self._complain(f"{field}[{i}]", f"is {_show(value, unit)}; {limits} is allowed")

    def whole(self, field: str, lower_bound: int, upper_bound: int) -> None:
        """Refuse what is not a whole number of ``lower_bound`` to ``upper_bound``."""
        value = getattr(self._design, field)
        if not (isinstance(value, int) and _is_within(value, lower_bound, upper_bound)):
            self._complain(field, f"is {_show(value)}; a whole number of {lower_bound} to {upper_bound} is allowed")

    def range(self, field: str, lower_bound: float, upper_bound: float, unit: str) -> None:
        """Refuse what is not an increasing pair within ``lower_bound`` to ``upper_bound``.

        Args:
            field: name of the field.
            lower_bound: least allowed number.
            upper_bound: greatest allowed number.
            unit: unit of the numbers, for the message.
        """
        value = getattr(self._design, field)
        pair = (
            isinstance(value, tuple)
            and len(value) == 2
            and all(_is_within(end, lower_bound, upper_bound) for end in value)
        )
        if not (pair and value[0] < value[1]):
            limits = f"{_show(lower_bound)} to {_show(upper_bound, unit)}"
            self._complain(field, f"is {_show(value, unit)}; an increasing pair within {limits} is allowed")

    def rising(self, field: str, lower_bound: float, upper_bound: float, unit: str) -> None:
        """Refuse what is not a row of at least one number, each greater than the one before, within the bounds."""
        value = getattr(self._design, field)
        row = isinstance(value, tuple) and value and all(_is_within(item, lower_bound, upper_bound) for item in value)
        if not (row and all(a < b for a, b in pairwise(value))):
            limits = f"{_show(lower_bound)} to {_show(upper_bound, unit)}"
            self._complain(field, f"is {_show(value)}; increasing numbers within {limits} are needed, at least one")

    def course(
        self,
        field: str,
        lower_bound: float,
        upper_bound: float,
        unit: str,
        *,
        abscissa: str = "time",
        start: float = -inf,
    ) -> None:
        """Refuse a value that is neither a number within the bounds nor a table of increasing times and such numbers.

        Args:
            field: holds a ``Schedule``.
            lower_bound: least number.
            upper_bound: greatest number.
            unit: unit of the number.
            abscissa: noun for the first column of the table, in messages.
            start: least allowed time [s].
        """
        value = getattr(self._design, field)
        if isinstance(value, (int, float)):
            return self.number(field, lower_bound, upper_bound, unit)
        rows = value if isinstance(value, tuple) else ()
        pairs = bool(rows) and all(isinstance(row, tuple) and len(row) == 2 for row in rows)
        times = [row[0] for row in rows] if pairs else []
        is_valid = pairs and all(_is_within(time, start, inf) and isfinite(time) for time in times)
        is_valid = is_valid and all(_is_within(number, lower_bound, upper_bound) for _, number in rows)
        if not (is_valid and all(a < b for a, b in pairwise(times))):
            limits = f"{_show(lower_bound)} to {_show(upper_bound, unit)}"
            start_text = "" if start == -inf else f" from {start:g} on"
            self._complain(
                field,
                f"is {show(value)}; a number of {limits}, or pairs of a {abscissa} and such a number are allowed, the "
                f"{abscissa}s rising{start_text}",
            )
        return None

    def choice(self, field: str, names: Collection[str]) -> None:
        """Refuse a text that is none of some names."""
        value = getattr(self._design, field)
        if isinstance(value, str) and value not in names:
            self._complain(field, f"is {_show(value)}; {', '.join(names)} is allowed")

    def printable(self, names: Iterable[str]) -> None:
        """Refuse names with characters that steer a terminal or turn its writing round; the first one is named."""
        complaint = next((text for name in names if (text := name_complaint(name))), None)
        if complaint is not None:
            self._complain("", complaint)

    def that(self, holds: bool, text: str) -> None:
        """Refuse a combination of fields that does not hold, with a clause that says why."""
        if not holds:
            self._complain("", text)

    def _complain(self, field: str, text: str) -> None:
        self._complaints.append(Complaint(field, text))


def require(owner: str, field: str, value: float, lower_bound: float, upper_bound: float, unit: str) -> None:
    """Refuse a lone number outside its range, or one that is not a number.

    Args:
        owner: name of the design in the message.
        field: name of the field in the message.
        value: value of the field, in its unit.
        lower_bound: least allowed value.
        upper_bound: greatest allowed value.
        unit: unit of the value, for the message.

    Raises:
        InvalidFields: the value is not finite, below ``lower_bound`` or above ``upper_bound``.
    """
    if not _is_within(value, lower_bound, upper_bound):
        text = f"is {_show(value, unit)}; {_show(lower_bound)} to {_show(upper_bound, unit)} is allowed"
        raise InvalidFields(owner, (Complaint(field, text),))


def _is_within(value: Any, lower_bound: float, upper_bound: float) -> bool:
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return number and lower_bound <= value <= upper_bound  # no comparison holds for what is not a number


def _show(value: Any, unit: str = "") -> str:
    plain = f"{value:g}" if isinstance(value, float) else show(value)
    return f"{plain} {unit}".rstrip()

"""List the numbers of the documentation that neither the store of results nor ``docs/given_numbers.toml`` accounts for.

The pages are ``README.md`` and ``docs/*.md``. Pages that a program writes whole (``WRITERS``) are left out.

*Extraction.* In a page these spans are blanked first: comments and the passages between them (``<!-- stated: NAME -->``
to ``<!-- end -->``, ``<!-- NAME: made by PROGRAM -->`` to ``<!-- /NAME -->``), fenced code and fenced formulas, inline
code, inline formulas, targets of links, addresses, tags, markers of lists and the numbering of headings. Every run of
digits that remains is a number, with decimals, exponent and thousands (``2 048``), unless a letter stands before it
(``XM430``, ``CRC-16``). Numbers written as words are not found.

*Matching.* An entry of ``docs/given_numbers.toml`` is a text of a page, such as ``"4 s"`` or ``"two cycles of 4 s"``.
Each place where the page has this text, with any white space for a space, accounts for the numbers within it. A letter
or a digit at an end of an entry matches only where the word or the number of the page ends too: ``"4 s"`` is not found
in ``14 s`` or ``4 steps``. Take as many words as tell the number from a result that looks alike. An entry that accounts
for no number of its page is refused. The table of a page has its entries by the reason why no run can contradict them::

    [joint_loops]
    article = ["0.16 m"]
    setting = ["4 s after the load", "10°"]

Usage: python tools/prose_numbers.py [--list] [PAGE ...]

It prints what is neither stated nor given, and entries that account for nothing; the exit code is 1 if there are any.
``--list`` prints all numbers with their reasons. ``PAGE`` is the name of a page without its suffix: ``joint_loops``.
"""

import argparse
import re
import sys
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
GIVEN = ROOT / "docs" / "given_numbers.toml"
WRITERS: Mapping[str, str] = {
    "atlas": "tools/atlas_page.py",
    "league": "tools/league_page.py",
    "validation": "tools/validation_page.py",
    "verdicts": "tools/verdict_table.py",
}
"""Pages that a program writes whole, and the program."""
REASONS: Mapping[str, str] = {
    "article": "the article states it",
    "literature": "another publication or a maker's data sheet states it, which the page names",
    "setting": "a default, a range, a limit or an input of a command, an experiment or a design",
    "definition": "it follows from a definition, from arithmetic or geometry alone",
    "bound": "a test fails when a result is beyond it",
    "reference": "a number of an equation, a figure, a section, a standard, a protocol, a claim or an issue",
    "date": "a date or a year",
    "version": "a version of a program",
}
"""Reasons why no run can contradict a number."""

NUMBER = re.compile(r"(?<![\w.])(?<![A-Za-z]-)(?:\d{1,3}(?: \d{3})+(?!\d)|\d+)(?:\.\d+)*(?:e[-+]?\d+)?")
BLANK = re.compile(
    "|".join(
        (
            r"<!-- stated: \w+ -->.*?<!-- end -->",
            r"<!-- (?P<name>\w+): made by .*?<!-- /(?P=name) -->",
            r"<!--.*?-->",
            r"^[ \t]*(?P<fence>```+|~~~+).*?^[ \t]*(?P=fence)[ \t]*$",
            r"\$`.*?`\$",
            r"(?P<ticks>`+).*?(?P=ticks)",
            r"\$(?=\S)[^$\n]*\$",
            r"(?<=\])\([^()]*(?:\([^()]*\)[^()]*)*\)|(?<=\])\[[^\]]*\]|\[\^[^\]]*\]",
            r"https?://[^\s)>]+",
            r"</?[A-Za-z][^>]*>",
            r"^[ \t]*\d+[.)](?=[ \t])",
            r"^#+[ \t]+\d+(?:\.\d+)*[.)]?(?=[ \t])",
        )
    ),
    re.DOTALL | re.MULTILINE,
)
"""What is no prose: see the text above."""
CONTEXT = 40
"""Characters of a page that are shown on either side of a number."""


@dataclass(frozen=True)
class Number:
    """A number in the prose of a page."""

    text: str
    """The number as the page has it."""
    line: int
    """Line of the page, from 1."""
    start: int
    """Index of its first character in the page."""
    end: int
    """Index after its last character."""
    context: str
    """Words around it, in one line."""


def prose(page: str) -> str:
    """Return a page in which all that is no prose is blank; lines and places of characters stay."""
    return BLANK.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), page)


def numbers(page: str) -> Iterator[Number]:
    """Yield the numbers in the prose of a page, in order."""
    for match in NUMBER.finditer(prose(page)):
        start, end = match.span()
        context = " ".join(page[max(0, start - CONTEXT) : end + CONTEXT].split())
        yield Number(match[0], page.count("\n", 0, start) + 1, start, end, context)


def pattern(entry: str) -> re.Pattern[str]:
    """Return what finds an entry in a page.

    Args:
        entry: a text of a page, not empty.
    """
    words = r"\s+".join(re.escape(word) for word in entry.split())
    before = r"(?<![\w.])" if entry[0].isalnum() else ""
    after = r"(?!\w|\.\d)" if entry[-1].isalnum() else ""
    return re.compile(before + words + after)


def reasons(page: str, given: Mapping[str, Sequence[str]]) -> tuple[dict[Number, str | None], list[str]]:
    """Return why no run can contradict each number of a page, and the entries that account for no number.

    Args:
        page: the text of the page.
        given: entries by reason.

    Returns:
        The reason of each number, None if it has none; the entries that account for no number.
    """
    reason_of: dict[Number, str | None] = dict.fromkeys(numbers(page))
    idle = []
    for reason, entries in given.items():
        for entry in entries:
            spans = [match.span() for match in pattern(entry).finditer(page)]
            inside = [n for n in reason_of if any(start <= n.start and n.end <= end for start, end in spans)]
            reason_of |= dict.fromkeys(inside, reason)
            if not inside:
                idle.append(entry)
    return reason_of, idle


def pages() -> dict[str, Path]:
    """Return the pages with prose, by name."""
    paths = [*sorted((ROOT / "docs").glob("*.md")), ROOT / "README.md"]
    return {path.stem: path for path in paths if path.stem not in WRITERS}


def given_numbers() -> dict[str, dict[str, list[str]]]:
    """Return the entries of ``docs/given_numbers.toml`` by page and reason."""
    return tomllib.loads(GIVEN.read_text(encoding="utf-8"))


def report(names: Sequence[str] = (), *, every: bool = False) -> tuple[list[str], list[str]]:
    """Return lines on the numbers of pages, and lines on what is wrong with ``docs/given_numbers.toml``.

    Args:
        names: names of pages; all if empty.
        every: whether numbers with a reason are listed too.
    """
    given, paths = given_numbers(), pages()
    lines = []
    faults = [f"[{name}]: there is no such page with prose." for name in given if name not in paths]
    for name, table in given.items():
        unknown = ", ".join(reason for reason in table if reason not in REASONS)
        faults += [f"[{name}]: unknown reason {unknown}; allowed: {', '.join(REASONS)}."] if unknown else []
    for name in names or paths:
        text = paths[name].read_text(encoding="utf-8")
        reason_of, idle = reasons(text, given.get(name, {}))
        place = paths[name].relative_to(ROOT)
        for number, reason in reason_of.items():
            if every or reason is None:
                mark = f" [{reason or '-'}]" if every else ""
                lines.append(f"{place}:{number.line}:{mark} {number.text} | {number.context}")
        faults += [f"[{name}]: {entry!r} accounts for no number of {place}; take it out." for entry in idle]
    return lines, faults


def main() -> int:
    """Print the numbers, and return the exit code."""
    parser = argparse.ArgumentParser(description="List numbers in the prose of the documentation that nothing backs.")
    parser.add_argument("page", nargs="*", help="names of pages without suffix; all if there are none")
    parser.add_argument("--list", action="store_true", help="list all numbers with their reasons")
    options = parser.parse_args()
    if unknown := [name for name in options.page if name not in pages()]:
        parser.error(f"no page is called {', '.join(unknown)}; there are {', '.join(pages())}.")
    lines, faults = report(options.page, every=options.list)
    print("\n".join([*lines, *faults]))
    left = len(report(options.page)[0]) if options.list else len(lines)
    print(f"{left} numbers are neither stated nor given, {len(faults)} faults in {GIVEN.relative_to(ROOT)}.")
    return int(bool(left or faults))


if __name__ == "__main__":
    sys.exit(main())

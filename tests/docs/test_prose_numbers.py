"""Every number in the prose of the documentation is given by something that no run can contradict, or it is stated."""

import re

import pytest

import prose_numbers
from pages.passages import names
from pages.stated import made
from prose_numbers import ROOT, WRITERS, numbers, reasons, report

WRITTEN_BY_PROGRAMS = {
    "matrix": "tools/matrix.py",
    "batteries": "tools/reliability.py",
    "guided": "tools/reliability.py",
    "intervals": "tests/capture/intervals.py",
}
"""Passages whose words are not in ``docs/stated``, and the program that writes each."""


def texts(page: str) -> list[str]:
    return [number.text for number in numbers(page)]


def test_no_number_of_a_page_is_neither_stated_nor_given():
    """See ``python tools/prose_numbers.py``: state it, give it in docs/given_numbers.toml, or say it in words."""
    lines, _ = report()
    assert not lines, "\n".join(lines)


def test_every_entry_accounts_for_a_number_of_its_page():
    _, faults = report()
    assert not faults, "\n".join(faults)


def test_pages_and_passages_that_are_left_out_have_their_programs():
    pages = {path.stem: path.read_text(encoding="utf-8") for path in (ROOT / "docs").glob("*.md")}
    assert set(WRITERS) <= set(pages)
    assert all((ROOT / program).is_file() for program in [*WRITERS.values(), *WRITTEN_BY_PROGRAMS.values()])
    passages = {name for page in pages.values() for name in names(page)}
    assert passages - set(made()) <= set(WRITTEN_BY_PROGRAMS)
    programs = re.findall(r"<!-- \w+: made by (\S+) -->", "".join(pages.values()))
    assert programs
    assert all((ROOT / program).is_file() for program in programs)


@pytest.mark.parametrize(
    ("page", "expected"),
    [
        ("It walks 0.74 m in 2 cycles.", ["0.74", "2"]),
        ("2 048 runs, 1e-12 m, 3.11.4, -75 %, 16-bit, 1.2e+4", ["2 048", "1e-12", "3.11.4", "75", "16", "1.2e+4"]),
        ("from 20 to 50 ms, (14), Fig. 15", ["20", "50", "14", "15"]),
        ("1 234 567 and 1 2345", ["1 234 567", "1", "2345"]),
        ("an XM430-W350 with CRC-16 under Apache-2.0", []),
        ("`k = 3` and ``a ` 4`` and $`x = 5`$ and $y = 6$ but 7", ["7"]),
        ("costs 5 $ and 6", ["5", "6"]),
        ("see [page 1](page_2.md#3) and [servo 4][design.Servo5] and https://a.b/6 and ![7](8.png)", ["1", "4", "7"]),
        ("<!-- 1 -->2<!-- stated: speed -->\n3\n<!-- end -->4", ["2", "4"]),
        ("1\n<!-- table: made by tools/x.py -->\n2\n<!-- /table -->\n3", ["1", "3"]),
        ('<img width="3">4</img>', ["4"]),
        ("below 1 < 2 > 0", ["1", "2", "0"]),
        ("1\n```sh\n2\n```\n3\n   ```math\n4\n   ```\n5", ["1", "3", "5"]),
        ("````md\n```\n1\n```\n````\n2", ["2"]),
        ("# 1. Title 2\n\n1. item 3\n   12) item 4\n", ["2", "3", "4"]),
        ("In all there are\n12 of them", ["12"]),
        ("words[^1]\n\n[^1]: 5 of them", ["5"]),
    ],
)
def test_numbers_of_the_prose_are_extracted_and_no_others(page, expected):
    assert texts(page) == expected


def test_a_number_has_its_line_and_its_words():
    number = next(numbers("# Page\n\n`1`\nthe robot is 1 m\nlong"))
    assert (number.line, number.text, number.context) == (4, "1", "# Page `1` the robot is 1 m long")


@pytest.mark.parametrize(
    ("entry", "page", "covered"),
    [
        ("4 s", "for 4 s,", True),
        ("4 s", "for 4\n  s.", True),
        ("4 s", "for 14 s", False),
        ("4 s", "for 0.4 s", False),
        ("4 s", "for 4 steps", False),
        ("4", "for 4.5", False),
        ("4", "for 4.", True),
        ("Fig. 4", "(Fig. 4)", True),
        ("(4)", "by (4) and", True),
        ("+4 %", "by +4 % of", True),
        ("speed 1 to 4", "at speed 1 to 4 m/s", True),
    ],
)
def test_an_entry_accounts_for_the_numbers_within_its_text(entry, page, covered):
    reason_of, idle = reasons(page, {"setting": [entry]})
    assert set(reason_of.values()) == ({"setting"} if covered else {None})
    assert idle == ([] if covered else [entry])


def test_an_entry_accounts_for_no_number_beside_it():
    reason_of, idle = reasons("in 2 s it walks 4 m, in 3 s 4 m", {"setting": ["2 s"], "article": ["3 s"]})
    assert list(reason_of.values()) == ["setting", None, "article", None]
    assert idle == []


def test_an_entry_without_a_number_and_one_within_code_are_refused():
    assert reasons("the robot walks 4 m, `5 m`", {"setting": ["robot", "5 m"]})[1] == ["robot", "5 m"]


def test_a_table_of_no_page_and_an_unknown_reason_are_refused(monkeypatch, tmp_path):
    given = tmp_path / "given.toml"
    given.write_text('[no_page]\nsetting = ["1"]\n\n[lessons]\nhearsay = []\n')
    monkeypatch.setattr(prose_numbers, "GIVEN", given)
    faults = "\n".join(report(["lessons"])[1])
    assert "[no_page]" in faults
    assert "hearsay" in faults

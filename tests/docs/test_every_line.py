"""Every line of a shell and every block of Python in README and guide is carried out, or a table says why not."""

import contextlib
import io
import re
import shlex
import shutil
import sys
import tomllib
from importlib import import_module
from importlib.util import find_spec
from inspect import signature
from pathlib import Path
from typing import NoReturn

import pytest
from guide_lines import (
    ADDED,
    ASSUMED,
    CLUSTERS,
    COPIES,
    FOLLOWED,
    FRAGMENTS,
    LEFT_OUT,
    OTHER_PROGRAMS,
    PYTHON_ELSEWHERE,
    REMOVED,
    ROOT,
    SHELLS,
    SHORTER,
    TEXTS,
    UNTIL,
    Line,
    inline_lines,
    lines_of_block,
    page_text,
    shell_lines,
)
from test_guide import GUIDE

from pages.blocks import blocks
from suchus.apps.cli import main
from suchus.apps.cli.entry import COMMANDS

PAGES = ("README", *GUIDE)
EXTRAS = set(tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"])
MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")


class Started(Exception):
    """A command has read and checked its words, and would begin to compute."""


def start(*_args: object, **_options: object) -> NoReturn:
    """Stand for what computes or serves for long."""
    raise Started


@pytest.fixture
def reader(tmp_path, monkeypatch):
    """Go to an empty folder in which no command computes for long."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", ["", *sys.path])
    for places, _ in UNTIL.values():
        for place in places.split():
            module, _, name = place.partition(":")
            monkeypatch.setattr(import_module(module), name, start)


def give_file(name: str) -> None:
    """Write a file that a reader has into the working folder, unless an earlier line has written it."""
    path = Path(name)
    if path.exists():
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    if name in COPIES:
        shutil.copy(ROOT / COPIES[name], path)
    elif name in ("FILE.toml", "my_study.toml"):
        path.write_text(next(block.text for block in blocks(page_text("studies")) if block.title))
    else:
        path.write_text(TEXTS.get(name, ""))


def complaint(line: Line) -> str:
    """Carry out a line as far as the tables say, and return what is wrong with it, empty if nothing."""
    program, *words = line.words
    for name in {*words} & {*ASSUMED.get(line.page, "").split()}:
        give_file(name)
    if program == "python":
        return _python_complaint(words)
    if program == "make" and not re.search(rf"^(\.PHONY:.* )?{words[0]}\b", MAKEFILE, re.M):
        return f"the Makefile has no target {words[0]}"
    if program != "suchus":
        unknown = [name for word in words for name in re.findall(r"suchus\[(.*)\]", word)]
        unknown = [name for names in unknown for name in names.split(",") if name not in EXTRAS]
        if program not in OTHER_PROGRAMS:
            return f"{program} is neither run nor in OTHER_PROGRAMS"
        return f"there are no extras {unknown}" if unknown else ""
    if line.text in LEFT_OUT or not words:
        return ""
    command = words[0]
    if line.is_inline and (len(words) == 1 or command.startswith("-")):
        known = {"--help", "--version", *(command.name for command in COMMANDS)}
        return "" if command in known else f"no command {command}"
    if line.text in FRAGMENTS:
        return "" if words[-1] in _printed([*words[:-1], "--help"])[1] else f"no option {words[-1]}"
    if command in ("emulate", "drive"):
        words = shlex.split(re.sub("|".join(REMOVED), "", shlex.join(words)))
    words += ADDED.get(command, ("", ""))[0].split()
    code, printed = _printed(words)
    return "" if code in (0, None) else printed[-600:]


def _printed(words: list[str]) -> tuple[object, str]:
    """Return the exit code of a command, 0 where it would have computed, and what it printed."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
        try:
            code: object = main(words)
        except Started:
            code = 0
        except SystemExit as end:
            code = end.code
    return code, out.getvalue()


def _python_complaint(words: list[str]) -> str:
    """Run ``python -c CODE``; a file must be an example or a bench, which tests of their own run."""
    if words[0] == "-c":
        exec(compile(words[1], "line", "exec"), {"__name__": "__main__"})
        return ""
    if words[0] == "-m":
        return "" if find_spec(words[1]) else f"there is no module {words[1]}"
    path = ROOT / words[0]
    return "" if path.is_file() and path.parent.name in ("examples", "bench") else f"no test runs {words[0]}"


def shortened(code: str) -> str:
    """Return code that takes seconds at most."""
    for own, (short, _) in SHORTER.items():
        code = code.replace(own, short)
    return code


def complaints(page: str) -> list[str]:
    """Do what a page says, in the working folder, and return what is wrong."""
    for block in blocks(page_text(page)):
        if block.title and page not in FOLLOWED:  # a page may name a file before it shows it
            Path(block.title).write_text(block.text, encoding="utf-8")
    session: dict[str, object] = {"__name__": "__main__", "signature": signature}
    found = []
    for block in blocks(page_text(page)):
        if block.title:
            Path(block.title).parent.mkdir(parents=True, exist_ok=True)
            Path(block.title).write_text(block.text, encoding="utf-8")
        elif block.language == "python" and page not in PYTHON_ELSEWHERE and not block.text.startswith(CLUSTERS):
            code = compile(shortened(block.text), f"{page}.md", "exec")
            with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
                exec(code, session)
        elif block.language in SHELLS and not (page in FOLLOWED and block.language == "sh"):
            lines = lines_of_block(page, block.language, block.text)
            found += [f"{line.text}: {wrong}" for line in lines if (wrong := complaint(line))]
    return found + [f"{line.text}: {wrong}" for line in inline_lines(page) if (wrong := complaint(line))]


@pytest.mark.parametrize("page", PAGES)
def test_the_lines_of_a_page_are_carried_out(page, reader):
    assert complaints(page) == []


def test_a_wrong_line_is_noticed(reader):
    def wrong(text: str) -> str:
        return complaint(lines_of_block("page", "sh", text)[0])

    assert "no_such" in wrong("suchus run no_such  # a comment")
    assert "frition" in wrong("suchus run displacement --frition 2")
    assert "no_gait" in wrong("suchus drive no_gait")
    assert "neither run" in wrong("curl example.org")
    assert "viewr" in wrong("pip install 'suchus[viewr]'")
    assert "no test runs" in wrong("python nothing.py")
    assert wrong("suchus run displacement --quick") == ""


def test_no_line_hides_in_a_block_without_a_language():
    for page in PAGES:
        others = re.sub(r"^```\w+.*?^```$", "", page_text(page), flags=re.M | re.S)
        bare = re.findall(r"^```\n(.*?)^```$", others, re.M | re.S)
        assert not [text for text in bare if re.search(r"^(suchus|pip|python|make) ", text, re.M)], page


def test_every_entry_of_the_tables_stands_on_a_page_and_names_a_test_that_is_there():
    texts = [line.text for page in PAGES for line in shell_lines(page)]
    assert {*LEFT_OUT, *FRAGMENTS} <= set(texts)
    programs = {line.words[0] for page in PAGES for line in shell_lines(page)}
    assert set(OTHER_PROGRAMS) <= programs
    everything = "".join(page_text(page) for page in PAGES)
    assert [part for part in SHORTER if part not in everything] == []
    for command, (_, file) in UNTIL.items():
        assert re.search(rf"\b{command}\b", (ROOT / file).read_text(encoding="utf-8")), file
    assert all((ROOT / file).is_file() for file in PYTHON_ELSEWHERE.values())
    reasons = [*LEFT_OUT.values(), *OTHER_PROGRAMS.values()]
    named = {name for reason in reasons for name in re.findall(r"tests/[\w/]+\.py", reason)}
    assert [name for name in named if not (ROOT / name).is_file()] == []

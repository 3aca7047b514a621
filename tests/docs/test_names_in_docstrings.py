"""Classes and constants that docstrings and comments name are there: a renamed one leaves no old name behind."""

import io
import re
import tokenize
from pathlib import Path

SOURCE = Path(__file__).parents[2] / "src"
PLACEHOLDERS = {"NAME", "CONDITION", "CELL", "GROUP", "STATE", "MOTION", "MODEL", "MEASURE", "SUFFIX"}
"""Words that stand for a part of a name, as in ``NAME_low``."""
ELSEWHERE = {"MjsBody", "BROWSER", "Disabled", "NextStep", "SameStep"}
"""Names of MuJoCo, of Gymnasium and of the environment that docstrings give."""
JOINT = re.compile(r"[LR][FH]_[a-z]+")
"""A joint or a link of the robot."""
SYMBOLS = 2
"""Names of at most so many letters are symbols of formulas, as ``Ma`` [-]."""
NAMED = re.compile(r"``((?:\w+\.)*)(_?[A-Z]\w*)``")


def words_of(files):
    """Return the identifiers of sources with the words of their short strings, and the names in their long texts."""
    known, named = set(), []
    for file in files:
        with io.StringIO(file.read_text(encoding="utf-8")) as source:
            for token in tokenize.generate_tokens(source.readline):
                is_text = token.string.lstrip("rbfRBF").startswith('"""') or token.type == tokenize.COMMENT
                if token.type == tokenize.NAME:
                    known.add(token.string)
                elif is_text:
                    named += [(file, name) for _, name in NAMED.findall(token.string)]
                elif token.type == tokenize.STRING:
                    known |= {*re.findall(r"\w+", token.string)}
    return known, named


def missing(files):
    """Return the names in texts that are no identifiers, with their files."""
    known, named = words_of(files)
    return {
        (file.name, name)
        for file, name in named
        if name not in known | ELSEWHERE
        and not JOINT.fullmatch(name)
        and len(name) > SYMBOLS
        and not PLACEHOLDERS & {*name.split("_")}
    }


def test_every_class_and_constant_in_a_docstring_exists():
    assert missing(sorted(SOURCE.rglob("*.py"))) == set()


def test_an_old_name_in_a_docstring_is_found(tmp_path):
    (tmp_path / "a.py").write_text('MAX_TILT = 1.0\n"""Largest tilt, see ``FALLEN`` and ``MAX_TILT``."""\n')
    assert missing([tmp_path / "a.py"]) == {("a.py", "FALLEN")}

"""What a store says made its numbers covers all code that can change them."""

import grimp
import pytest

from suchus.jobs.made_by import FLOW, MADE_BY, deciding
from suchus.optimise.conduct import ROOMS
from suchus.record import code_digest
from suchus.record.provenance import deciding_source

HARMLESS = (
    "suchus.errors",
    "suchus.large",
    "suchus.machine",
    "suchus.threads",
    "suchus.progress",
    "suchus.kernel_cache",
    "suchus.writing",
)
"""Words, what is too large to begin with, how this machine computes, how many threads, how far something is, and where
and how things are kept."""


@pytest.fixture(scope="module")
def graph():
    return grimp.build_graph("suchus", cache_dir=None)


@pytest.mark.parametrize(
    ("begins", "places"),
    [("suchus.study.chunk", MADE_BY), ("suchus.optimise.evaluate", ROOMS), ("suchus.water.resolved", FLOW)],
)
def test_all_code_that_makes_a_part_is_in_the_digest(graph, begins, places):
    used = {begins} | set(graph.find_upstream_modules(begins))
    if begins == "suchus.optimise.evaluate":  # which takes two values from a room whose door imports all of it
        used -= set(graph.find_upstream_modules("suchus.study")) | graph.find_descendants("suchus.study")
        used |= {"suchus.study.measures"} | graph.find_upstream_modules("suchus.study.measures")
    rooms = tuple("suchus." + place.removesuffix(".py").replace("/", ".") for place in places)
    missing = [m for m in used if not any(m == r or m.startswith(f"{r}.") for r in (*rooms, *HARMLESS))]
    assert [m for m in missing if m.count(".") > 1 or not any(r.startswith(f"{m}.") for r in rooms)] == []
    assert len(used) > 20  # the graph is a graph


def test_another_source_has_another_digest():
    assert code_digest("design") == code_digest("design")
    assert code_digest("design") != code_digest("design", "motion") != code_digest("motion", "design")
    assert code_digest("study/claims.py") != code_digest("study/answers.py")
    assert deciding()["source"] == code_digest(*MADE_BY)[:12]


def test_the_numbers_of_the_motors_are_in_the_digest(tmp_path, monkeypatch):
    fresh = code_digest.__wrapped__  # what it said before is kept
    monkeypatch.setitem(fresh.__globals__, "_PACKAGE", tmp_path)
    (tmp_path / "motors").mkdir()
    digests = []
    for torque in (4.9, 5.0):
        (tmp_path / "motors" / "motors.toml").write_text(f"torque = {torque}\n")
        digests.append(fresh("motors"))
    assert digests[0] != digests[1]


def test_docstrings_are_in_no_digest_and_all_else_is():
    source = (
        '"""A room."""\nspeed = 1.0\n"""Of the body [m/s]."""\n'
        'def twice(x):\n    """Return it\n    twice."""\n    return 2 * x\n'
    )
    other = source.replace("A room", "Another").replace("Return it\n    twice", "Double").replace("[m/s]", "in\nm/s")
    assert deciding_source(source.encode()) == deciding_source(other.encode()) != source.encode()
    for old, new in [("1.0", "2.0"), ("2 * x", "3 * x"), ("twice(x)", "twice(y)"), ("\nspeed", "\n# a word\nspeed")]:
        assert deciding_source(source.replace(old, new, 1).encode()) != deciding_source(source.encode())


@pytest.mark.parametrize(
    "source", ['x = "told"\n', 'print("""a\nb""")\n', 'x = 1; "told"\n', '"told"; x = 1\n', 'f"told {x}"\n']
)
def test_texts_that_are_no_docstrings_stay_in_the_digest(source):
    assert deciding_source(source.encode()) == source.encode()

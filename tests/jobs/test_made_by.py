"""What a store says made its numbers covers all code that can change them."""

from copy import deepcopy

import grimp
import pytest

from suchus.core.files import code_digest
from suchus.core.files.provenance import syntax_of
from suchus.core.jobs.made_by import FLOW_SOURCES, LAND_SOURCES, source_versions
from suchus.experiments.optimise.conduct import SOURCE_FILES

HARMLESS = (
    "suchus.core.errors",
    "suchus.core.large",
    "suchus.core.machine",
    "suchus.core.threads",
    "suchus.core.progress",
    "suchus.core.kernel_cache",
    "suchus.core.printable",
    "suchus.core.writing",
)
"""Words, what is too large to begin with, how this machine computes, how many threads, how far something is, and where
and how things are kept."""


@pytest.fixture(scope="module")
def graph():
    return grimp.build_graph("suchus", cache_dir=None)


@pytest.mark.parametrize(
    ("begins", "places"),
    [
        ("suchus.experiments.study.chunk", LAND_SOURCES),
        ("suchus.experiments.optimise.evaluate", SOURCE_FILES),
        ("suchus.swimming.water.resolved", FLOW_SOURCES),
    ],
)
def test_all_code_that_makes_a_part_is_in_the_digest(graph, begins, places):
    if begins == "suchus.experiments.optimise.evaluate":  # its search takes two values from a file of studies alone
        graph = deepcopy(graph)
        studies = {"suchus.experiments.study", *graph.find_descendants("suchus.experiments.study")}
        for module in studies - {"suchus.experiments.study.measures"}:
            graph.remove_module(module)
    used = {begins} | set(graph.find_upstream_modules(begins))
    rooms = tuple("suchus." + place.removesuffix(".py").replace("/", ".") for place in places)
    missing = [m for m in used if not any(m == r or m.startswith(f"{r}.") for r in (*rooms, *HARMLESS))]
    assert [m for m in missing if not any(r.startswith(f"{m}.") for r in rooms)] == []
    assert len(used) > 20  # the graph is a graph


def test_another_source_has_another_digest():
    assert code_digest("robot/design") == code_digest("robot/design")
    assert code_digest("flow") != code_digest("flow", "sim") != code_digest("sim", "flow")
    assert code_digest("experiments/study/claims.py") != code_digest("experiments/study/answers.py")
    assert source_versions()["source"] == code_digest(*LAND_SOURCES)[:12]


def test_the_numbers_of_the_motors_are_in_the_digest(tmp_path, monkeypatch):
    fresh = code_digest.__wrapped__  # what it said before is kept
    monkeypatch.setitem(fresh.__globals__, "_PACKAGE", tmp_path)
    (tmp_path / "motors").mkdir()
    digests = []
    for torque in (4.9, 5.0):
        (tmp_path / "motors" / "motors.toml").write_text(f"torque = {torque}\n")
        digests.append(fresh("motors"))
    assert digests[0] != digests[1]


SOURCE = """'''A wing.'''
speed = 1.0
'''Of the body [m/s].'''
def twice(x):
    '''Return it
    twice.'''
    return 2 * x
"""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("A wing", "Another"),
        ("Return it\n    twice", "Double"),
        ("[m/s]", "in\nm/s"),
        ("= 1.0", "= 1.0  # a comment"),
        ("\nspeed", "\n# a comment\n\nspeed"),
        ("2 * x", "(2 *\n            x)"),
        ("'''Of the body [m/s].'''\n", ""),
    ],
)
def test_comments_docstrings_and_line_breaks_are_in_no_digest(old, new):
    assert old in SOURCE
    assert syntax_of(SOURCE.replace(old, new, 1).encode()) == syntax_of(SOURCE.encode())


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("1.0", "2.0"),
        ("2 * x", "3 * x"),
        ("twice(x)", "twice(y)"),
        ("return 2 * x", "return 2 * (x,)"),
        ("return 2", "return '2'"),
        ("\nspeed", "\nspin"),
    ],
)
def test_what_a_module_does_is_in_its_digest(old, new):
    assert old in SOURCE
    assert syntax_of(SOURCE.replace(old, new, 1).encode()) != syntax_of(SOURCE.encode())


def test_a_text_that_is_an_argument_stays_in_the_digest():
    assert syntax_of(b'print("""a\nb""")\n') != syntax_of(b'print("""a\nc""")\n')

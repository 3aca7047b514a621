"""What experiments say decided their outcomes: words beside the question, whose numbers are filled in by name."""

import re
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
from jinja2 import nodes

import suchus.experiments.catalog
from evidence import store
from suchus.core.errors import BrokenFile, InvalidDesign
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.experiment import EXPLANATION, Experiment, templates

"""Measures of full forms, by experiment: those of a question's options that no quick form takes among them."""
ASKED_FOR = {
    "swim_3d": {"misfit_tail_only_as_taken", "misfit_trunk_and_tail_as_taken", "speed_trunk_and_tail_as_taken"},
}
"""What is measured only when somebody asks for it, in minutes; test_swim_3d.py looks at it."""
FOLDERS = sorted(Path(suchus.experiments.catalog.__file__).parent.glob(f"*/{EXPLANATION}"))
DEFINED = {
    "feedback": {"90"},  # the quantile in per cent that cycles_to_converge is
    "spine_kinematics": {"60.5", "0.5"},  # of the printed equation (15)
    "swim_free": {"1", "95"},  # the radius with which that of the turn is compared [m]; the confidence in per cent
    "terrain": {"5"},  # per cent, within which switching_grounds_within_5_percent counts
}
"""Numbers in words that are no results: they define what is said."""


def named(folder: Path) -> set[str]:
    """Return the measures that words name, those that they only look for among them."""
    tree = templates(folder).parse((folder / EXPLANATION).read_text(encoding="utf-8"))
    looked_for = (
        compare.expr.value
        for compare in tree.find_all(nodes.Compare)
        if isinstance(compare.expr, nodes.Const) and getattr(compare.ops[0].expr, "name", "") == "m"
    )
    filled_in = (one.attr for one in tree.find_all(nodes.Getattr) if getattr(one.node, "name", "") == "m")
    return {*looked_for, *filled_in}


def frozen(folder: Path) -> set[str]:
    """Return the numbers that stand in the words themselves, those of equations like (14) and of names not counted."""
    tree = templates(folder).parse((folder / EXPLANATION).read_text(encoding="utf-8"))
    words = " ".join(text.data for text in tree.find_all(nodes.TemplateData))
    return set(re.findall(r"(?<![\w^.])\d+(?:\.\d+)?(?!\w)", re.sub(r"\(\d+\)", "", words)))


def test_every_question_of_a_folder_says_what_decided():
    assert [file.parent.name for file in FOLDERS] == sorted(EXPERIMENTS)


@pytest.mark.parametrize("folder", [file.parent for file in FOLDERS], ids=lambda folder: folder.name)
def test_no_result_stands_in_the_words(folder):
    assert frozen(folder) == DEFINED.get(folder.name, set())


@pytest.mark.parametrize("folder", [file.parent for file in FOLDERS], ids=lambda folder: folder.name)
def test_every_measure_that_the_words_name_is_measured(folder, quick_outcome):
    """Also in branches that a quick form does not take: a misspelt name that is looked for is never there."""
    full = [store.load(name).values for name in store.names() if name.startswith(folder.name)]
    known = set(quick_outcome(folder.name).measures).union(*full)
    assert named(folder) - known == ASKED_FOR.get(folder.name, set())


def test_names_in_all_branches_are_seen(tmp_path):
    (tmp_path / EXPLANATION).write_text("{% if 'a' in m %}{{ m.b:.2f }}{% else %}{{ n.c }}{{ m.d | abs }}{% endif %}")
    assert named(tmp_path) == {"a", "b", "d"}


def test_a_number_in_the_words_is_seen(tmp_path):
    (tmp_path / EXPLANATION).write_text("{% set n = 3 %}By (14) atan2 swims {{ m.speed:.2f }} m/s, 2.5 times f L^2.")
    assert frozen(tmp_path) == {"2.5"}


@dataclass(frozen=True)
class Asks(Experiment):
    """A question in a folder of its own."""

    robots: int = 2

    simulate = measure = draw = quick = None  # type: ignore[assignment]


@pytest.fixture
def explained(tmp_path, monkeypatch):
    monkeypatch.setattr(sys.modules[__name__], "__file__", str(tmp_path / "experiment.py"))

    def explain(words, **measures):
        (tmp_path / EXPLANATION).write_text(words)
        templates.cache_clear()
        return Asks().explain(measures)

    return explain


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ("{{ m.speed:.2f }} m/s", "0.25 m/s"),
        ("{{ m.speed:mm+.0f }} mm/s", "+250 mm/s"),
        ("{{ (m.speed / m.still):.0% }}", "-25000000%"),
        ("{{ m.still:.2f }}", "0.00"),
        ("{{ m.speed | write('.1f' if question.robots > 1 else '.2f') }}", "0.2"),
        ("{% if m.never is finite %}it stops{% else %}it goes on{% endif %}\n.", "it goes on."),
        ("{% for name in m %}\n{{ separator(loop) }} {{ name }}\n{% endfor %}\n.", "speed, still and never."),
        ("{% for name in ['a'] %}{{ separator(loop) }}{{ name }}{% endfor %}", "a"),
        ("{% filter sentence %}\n{{ 'one' if m.still > 0 }};\ntwo;\n{% endfilter %}", "Two."),
        ("a{% filter sentence %} {% endfilter %} b", "a b"),
    ],
)
def test_measures_are_filled_in_by_name(explained, words, text):
    assert explained(words, speed=0.25, still=-1e-6, never=float("inf")) == text


@pytest.mark.parametrize("words", ["{{ m.sped:.2f }}", "{{ speed:.2f }}", "{% if m.speed %}", "{{ m.speed | wrote }}"])
def test_words_that_name_what_there_is_not_are_refused_in_a_sentence(explained, words):
    with pytest.raises(BrokenFile, match=rf"{EXPLANATION} cannot be filled in: .* m\.NAME, are speed\."):
        explained(words, speed=0.25)


def test_a_question_without_words_is_refused_in_a_sentence(explained, tmp_path):
    explained("swims", speed=0.25)
    (tmp_path / EXPLANATION).unlink()
    templates.cache_clear()
    with pytest.raises(InvalidDesign, match=r"neither a method explain nor explanation\.md in the folder"):
        Asks().explain({})


def test_where_bending_costs_distance_it_is_said(quick_outcome):
    question = EXPERIMENTS["displacement"].quick()
    found = {name: measure.value for name, measure in quick_outcome("displacement").measures.items()}
    assert "bending costs" not in question.explain(found)
    less = {"forward_ratio": 0.8, "forward_ratio_low": 0.7, "forward_ratio_high": 0.9}
    assert "with the same legs alone" in question.explain(found | less)
    assert "bending costs it 20% of that distance" in question.explain(found | less)
    assert "bending costs" not in question.explain(found | less | {"forward_ratio_high": 1.1})  # it may be either way

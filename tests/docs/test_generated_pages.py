"""The pages that are made of the code say what the code says."""

from pathlib import Path

import pytest

pytest.importorskip("latex2mathml")

import suchus
from pages import article, gallery, laboratory, reference
from pages.code import exported, papers, rooms
from pages.mathml import Formulas
from pages.references import named
from pages.stated import page as stated_page
from suchus.apps.laboratory.engine import Engine, NoEngine
from suchus.article.paper import CLAIMS, ERRATA
from suchus.experiments.catalog import EXPERIMENTS

DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.parametrize(
    ("text", "keys"),
    [
        ("Eq. (14).", ("eq 14",)),
        ("Eqs (2) to (4), Fig. 7", ("eq 2", "eq 3", "eq 4", "fig 7")),
        ("III.A, eqs (9)-(11)", ("eq 9", "eq 10", "eq 11")),
        ("II.B, III.C, Figs 5, 9", ("fig 5", "fig 9")),
        ("IV.B, Fig. 17b, c", ("fig 17",)),
        ("Figs 22 to 24", ("fig 22", "fig 23", "fig 24")),
        ("eqs (9), (14)", ("eq 9", "eq 14")),
        ("Section III.A: Table I, eqs (1) to (2)", ("eq 1", "eq 2", "table I")),
        ("Tables I and II", ("table I", "table II")),
        ("Section IV.D", ()),
    ],
)
def test_references_are_understood(text, keys):
    assert named(text) == keys


def test_every_table_equation_and_figure_leads_to_code_or_to_a_command():
    code, shown = article.code_of(papers()), article.questions_of(EXPERIMENTS)
    assert [key for key in article.items() if not code[key] and not shown[key]] == []


def test_every_equation_stands_in_a_function():
    code = article.code_of(papers())
    assert [key for key in article.items() if key.startswith("eq") and not code[key]] == []


def test_no_docstring_names_what_the_article_does_not_have():
    for told in papers():
        assert set(named(told.paper)) <= set(article.items()), told


def test_the_map_holds_every_claim_and_every_experiment_that_judges_one():
    page = article.paper_map()
    ours = [key for key, claim in CLAIMS.items() if not claim.of]
    assert page.count("\n| ") > len(ours) + 46
    assert all(f"questions.md#{name}" in page for name, one in EXPERIMENTS.items() if set(one.claims) & set(ours))


def test_every_misprint_has_its_place():
    page = article.misprints()
    assert all(f"{{#{key}}}" in page for key in ERRATA)


def test_every_experiment_is_a_question_of_its_own():
    page = stated_page("questions")
    assert all(f"{{#{name}}}" in page and one.title in page for name, one in EXPERIMENTS.items())


def test_what_a_room_exports_is_what_its_reference_names():
    for room in rooms():
        found = {name.rpartition(".")[2] for name in reference.names(room)}
        assert set(exported(room)) <= found, room


def test_what_the_map_of_the_article_names_stands_in_the_reference():
    """By itself, or as a part of a class or a module that does; another name would be a dead link of the built site."""
    there = {name for room in rooms() for name in reference.names(room)} | {f"suchus.{room}" for room in rooms()}
    found = {one.name for places in article.code_of(papers()).values() for one in places}
    assert [name for name in sorted(found) if not {name, name.rpartition(".")[0]} & there] == []


def test_every_name_of_the_package_has_a_home():
    assert set(reference.top()) == set(suchus.__all__) - {"__version__"}


def test_every_example_is_shown_with_its_code():
    for one in gallery.examples():
        page = gallery.pages()[f"examples/{one.stem}.md"]
        assert one.title in page
        assert one.code in page
        assert "Usage:" not in page


def test_formulas_become_mathml_and_nothing_else_changes():
    formulas = Formulas()
    left = formulas.take("So $`a_0`$ and $5:\n\n```math\n\\frac{a}{b}\n```\n\n`x_1`\n")
    assert "frac" not in left
    assert "$5" in left
    html = formulas.put("<p>" + left.replace("\n\n", "</p>\n<p>") + "</p>")
    assert html.count("<math ") == 2
    assert "<mfrac>" in html
    assert 'alttext="\\frac{a}{b}"' in html


@pytest.fixture
def fresh_laboratory():
    laboratory.pages.cache_clear()
    yield
    laboratory.pages.cache_clear()


@pytest.mark.usefixtures("fresh_laboratory")
def test_the_site_leads_to_the_laboratory_only_where_it_has_one(monkeypatch, capsys):
    def absent(*_):
        raise NoEngine("there is none.")

    build = laboratory.laboratory_page
    monkeypatch.setattr(laboratory, "laboratory_page", absent)
    assert laboratory.pages() == {}
    assert "there is none." in capsys.readouterr().err
    assert laboratory.linked(f"a\n{laboratory.MARK}\nb") == "a\n\nb"
    laboratory.pages.cache_clear()
    monkeypatch.setattr(laboratory, "laboratory_page", lambda *given: build(*given, engine=Engine("", b"")))
    assert "caiman" in laboratory.pages()["laboratory.html"]
    assert "(laboratory.html)" in laboratory.linked(laboratory.MARK)
    for name in ("index", "page"):
        assert (DOCS / f"{name}.md").read_text(encoding="utf-8").count(f"\n{laboratory.MARK}\n") == 1

"""The page of the validation: no row is lost, each stands in its group, and its plots are drawn from the rows."""

import json
from types import SimpleNamespace

import pytest
from matplotlib.figure import Figure
from tests.flow.validation_rows import ROOT, SOURCES, is_whole

from suchus.core.errors import IncompatibleRecord
from validation_page import DRAWN, GROUPS, kept_rows, page, write_table, write_validation


def row(case, quantity="Cd", theirs=2.0, source="Someone 1990", **curves):
    return {"case": case, "quantity": quantity, "ours": 2.1, "theirs": theirs, "grid": "16 cells/D",
            "domain": "8 D x 6 D", "source": source, "curves": curves}  # fmt: skip


def test_every_row_stands_in_the_group_of_its_case_and_a_new_case_in_the_last():
    told = page(
        [row("free eel, thick water"), row("Taylor-Green"), row("a sphere"), row("impulsively started cylinder")]
    )
    order = [
        told.index(f"\n### {case}\n")
        for case in ("Taylor-Green", "Impulsively started cylinder", "Free eel, thick water")
    ]
    assert order == sorted(order)
    assert told.index("## Other cases") < told.index("### A sphere")


def test_groups_without_rows_are_left_out():
    assert "Swimming" in page([row("Taylor-Green"), row("free eel, thick water")])
    assert "Swimming" not in page([row("Taylor-Green")])


def test_rows_without_anything_to_compare_with_are_left_out_and_their_curves_drawn():
    told = page([row("Taylor-Green"), row("energy budget", "share of the work: viscous", theirs="-", share=[0.9])])
    assert "1 case, 1 number" in told
    assert "energy budget" not in told


def test_what_all_rows_of_a_case_share_is_said_once_and_the_rest_in_the_table():
    alike = page([row("DFG 2D-1", "Cd"), row("DFG 2D-1", "Cl", theirs="at least 1")])
    assert "Grid: 16 cells/D. Domain: 8 D x 6 D. Source: Someone 1990." in alike
    assert "| Cd | 2.1 | 2 | +5.0 % |" in alike
    assert "| Cl | 2.1 | at least 1 | kept |" in alike
    assert "| Cl | 2.1 | 2 | +5.0 % | Other 2000 |" in page(
        [row("DFG 2D-1"), row("DFG 2D-1", "Cl", source="Other 2000")]
    )


@pytest.mark.parametrize(
    ("bound", "word"),
    [("at least 2.1", "kept"), ("at least 2.2", "**missed**"), ("at most 2.1", "kept"), ("at most 2", "**missed**"),
     ("below 2.1", "**missed**"), ("below 1e1", "kept"), ("above 2.1", "**missed**"), ("above 2", "kept")],
)  # fmt: skip
def test_a_bound_says_whether_it_is_kept(bound, word):
    text = page([row("Taylor-Green", theirs=bound)])
    assert f"| Cd | 2.1 | {bound} | {word} |" in text
    assert ("1 number, 1 bound missed" in text) == (word != "kept")


def test_a_column_without_a_word_is_left_out():
    text = page([row("Taylor-Green", theirs=0.0)])
    assert "difference" not in text
    assert "| Cd | 2.1 | 0 |" in text


def test_each_plot_of_a_group_is_one_that_is_drawn():
    named = [name for group in GROUPS for name, _ in group.figures]
    assert sorted(named) == sorted(DRAWN)


def test_plots_are_drawn_from_rows_that_lack_most_of_their_curves():
    few = [row("Taylor-Green", "order", size=[16, 32], error=[1e-3, 3e-4])]
    assert all(isinstance(draw(few), Figure) for draw in DRAWN.values())


def test_without_rows_nothing_is_written(tmp_path):
    with pytest.raises(IncompatibleRecord, match="make validate"):
        write_table(tmp_path, tmp_path, results=tmp_path / "results")
    assert not (tmp_path / "validation.md").exists()


def test_page_and_plots_are_written(tmp_path):
    (tmp_path / "one.json").write_text(json.dumps(row("Taylor-Green", "order", size=[16, 32], error=[1e-3, 3e-4])))
    write_validation(tmp_path, tmp_path, ("Someone 1990: a paper.",), results=tmp_path / "results")
    assert "- Someone 1990: a paper." in (tmp_path / "validation.md").read_text()
    assert {path.stem for path in (tmp_path / "pictures").iterdir()} == {f"flow_{name}" for name in DRAWN}


@pytest.fixture
def run(tmp_path):
    """Do a part of a validation: rows into a folder, and the page from them."""
    folder, docs = tmp_path / "rows", tmp_path / "docs"
    docs.mkdir()

    def part(*rows, **how):
        folder.mkdir(exist_ok=True)
        for old in folder.iterdir():
            old.unlink()
        for i, one in enumerate(rows):
            (folder / f"{i}.json").write_text(json.dumps(one))
        write_table(folder, docs, results=tmp_path / "results", **how)
        return (docs / "validation.md").read_text()

    part.docs, part.results = docs, tmp_path / "results"
    return part


def test_a_part_of_the_validation_renews_its_own_rows_and_keeps_the_others_with_their_code(run):
    run(row("Taylor-Green") | {"code": "first"}, row("Taylor-Green", "order") | {"code": "first"}, row("a sphere"))
    text = run(row("Taylor-Green", "order") | {"code": "second", "ours": 1.9})
    assert "| Cd | 2.1 | 2 | +5.0 % | first |" in text
    assert "| order | 1.9 | 2 | -5.0 % | second |" in text
    assert "### A sphere" in text
    assert text.count("| order |") == 1


def test_rows_of_a_test_that_is_gone_leave_the_page(run):
    run(
        row("a sphere") | {"test": "tests/flow/a.py::test_gone[1]"},
        row("an eel") | {"test": "tests/flow/a.py::test_b[2]"},
    )
    text = run(row("Taylor-Green"), tests={"test_b"})
    assert "sphere" not in text
    assert "### An eel" in text
    assert "sphere" not in run(row("Taylor-Green"))


def test_the_whole_validation_leaves_no_row_of_before(run):
    run(row("a sphere"))
    assert "sphere" not in run(row("Taylor-Green"), whole=True)
    assert "sphere" not in run(row("Taylor-Green", "order"))


def test_rows_that_only_plots_need_stay_off_the_file_beside_the_page(run):
    run(row("Taylor-Green", size=[16]), row("energy budget", "share", theirs="-", share=[0.9]))
    assert [set(one) & {"case", "curves"} for one in kept_rows(run.results)] == [{"case"}]


@pytest.mark.parametrize("text", ["[{", '[{"case": "a"}]', "[1]", "3"])
def test_damaged_rows_of_the_page_are_refused_and_nothing_is_written(run, text):
    page_before = run(row("Taylor-Green"))
    (run.results / "validation.json").write_text(text)
    with pytest.raises(IncompatibleRecord, match=r"validation\.json holds no rows"):
        run(row("a sphere"))
    assert (run.docs / "validation.md").read_text() == page_before
    assert (run.results / "validation.json").read_text() == text


def test_the_page_is_what_its_rows_say():
    """By hand nothing is changed on it: a change would be lost when any part of the validation runs."""
    assert page(kept_rows(), SOURCES) == (ROOT / "docs" / "validation.md").read_text()


@pytest.mark.parametrize(
    ("changed", "whole"),
    [({}, True), ({"args": ["tests/flow"]}, True), ({"lf": None, "keyword": ""}, True),
     ({"keyword": "eel"}, False), ({"lf": True}, False),
     ({"args": ["tests/flow/test_validate_flow.py"]}, False), ({"args": ["tests/flow/a.py::test_b"]}, False),
     ({"deselect": ["tests/flow/a.py"]}, False), ({"ignore": ["tests/flow"]}, False)],
)  # fmt: skip
def test_a_part_is_known_by_how_it_is_asked_for(changed, whole):
    asked = {"args": ["tests"], "keyword": "", "deselect": None, "ignore": None} | changed
    args = asked.pop("args")
    assert is_whole(SimpleNamespace(args=args, option=SimpleNamespace(**asked))) == whole

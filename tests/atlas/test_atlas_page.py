"""The page of the atlas: made of the outcomes, so that others make another one; failures stay in and are marked."""

from dataclasses import replace

import numpy as np
import pytest

import atlas_page
from evidence import store
from evidence.atlas import CASES, ROWS, FlowOutcome, compare, digest_of, published, save_outcome
from evidence.atlas.comparison import points
from evidence.atlas.page import draw_group, draw_parity, entries, page, summary, write_atlas
from suchus.core.errors import IncompatibleRecord

ROW, NUMBERS, LOOP = ROWS["duetsch_force"], ROWS["re100_numbers"], ROWS["schneiders_drag"]


def outcome(row, factor=1.0, **changes):
    """An outcome whose curve is the published one times a factor."""
    table = published(row.data)
    if row.kind == "numbers":
        found = compare(row, {name: np.array(1.0) for name in table.columns["quantity"]})
        pairs = zip(table.columns["quantity"], found.published, strict=True)
        curves = {name: np.array(value * factor) for name, value in pairs}
    else:
        x, y = points(row, table)
        curves = {row.computed_curve: np.stack([x, factor * y])}
    told = {
        "case": row.case, "digest": digest_of(CASES[row.case], quick=False), "quick": False, "cells": 48,
        "seconds": 61.0, "curves": curves,
    }  # fmt: skip
    return FlowOutcome(**{**told, **changes})


def told(*outcomes, rows=(ROW, NUMBERS)):
    return entries(rows, {one.flow: one for one in outcomes})


def on_grids(row, *factors, cells=(48, 32, 24), **changes):
    """Outcomes on three grids, each the published curve times a factor."""
    return [
        outcome(row, factor, grid=k + 1, cells=n, **changes)
        for k, (factor, n) in enumerate(zip(factors, cells, strict=True))
    ]


def test_a_perfect_curve_agrees_and_a_worse_one_is_above_its_bound():
    good, bad = page(told(outcome(ROW))), page(told(outcome(ROW, 1.2)))
    (line,) = (line for line in good.splitlines() if line.startswith("| [duetsch_force](#duetsch_force) |"))
    cells = [cell.strip() for cell in line.strip("|").split("|")]
    assert cells[1:5] == ["0.0 %", "0.0 %", "8.0 %", "one source"]
    assert cells[6:] == ["none", "", "agrees", "48", "61 s"]
    assert "**above its bound**" in bad
    assert "above are duetsch_force" in bad
    assert good != bad


def test_a_row_on_each_side_of_its_bound():
    scale = compare(ROW, outcome(ROW, 2.0).curves).rms  # of a factor of 2
    for off, word in ((0.99, "agrees"), (1.01, "above its bound")):
        assert told(outcome(ROW, 1 + off * 0.08 / scale))[0].word == word


def test_numbers_stand_in_a_table_beside_the_published_ones():
    text = page(told(outcome(NUMBERS, 1.01)))
    assert "| mean drag | 1.34 | 1.327 | +1.0 % |" in text
    assert "Liu, Zheng and Sung 1998" in text


def test_what_was_not_computed_or_failed_stays_on_the_page():
    missing = page(told())
    assert missing.count("**Not computed.**") == 2
    assert "None of the 2 rows has been computed in full." in missing
    failed = page(told(outcome(ROW, failed="it diverged at t = 3 s.", curves={})))
    assert "**Failed:** it diverged at t = 3 s." in failed
    assert "| **failed** |" in failed
    short = page(told(outcome(ROW, curves={"force": np.array([[0.0], [1.0]])}), outcome(NUMBERS, curves={})))
    assert "**Failed:** the flow gave no mean drag" in short


def test_a_trial_is_drawn_and_not_judged():
    text = page(told(outcome(ROW, 1.5, quick=True)))
    assert "a trial, which is not judged" in text
    assert "above" not in text.partition("## Bodies")[2]
    assert "None of the 2 rows" in text


def test_an_outcome_of_other_code_says_so():
    assert "earlier state" not in page(told(outcome(ROW)))
    assert "earlier state" in page(told(outcome(ROW, digest="0")))


def test_three_grids_tell_an_uncertainty_or_why_there_is_none():
    good = page(told(*on_grids(ROW, 1.0, 1 + 0.02 * 1.25, 1.075)))
    assert "Its uncertainty from 48, 32, 24 cells is " in good
    assert ", observed order " in good
    assert "as much as the difference." in good
    assert "which finer cells would not remove." in page(told(*on_grids(ROW, 1.1, 1.101, 1.1025)))
    assert "| agrees | 48, 32, 24 | 183 s |" in good
    assert "Three grids converge for 1 of them" in good
    assert "turning back" not in good
    assert ", the change turning back at 100.0 % of the points: " in page(told(*on_grids(ROW, 1.0, 1.05, 0.9)))
    grows = page(told(*on_grids(ROW, 1.0, 1.05, 1.06)))
    assert "No uncertainty of its own from 3 grids: its change does not become smaller with the cells." in grows
    assert "Three grids converge" not in grows
    two = page(told(*on_grids(ROW, 1.0, 1.02, 1.05)[:2]))
    assert "2 of 3 grids are there" in two
    failed = on_grids(ROW, 1.0, 1.02, 1.05)
    failed[1] = replace(failed[1], failed="it diverged.", curves={})
    assert "32 cells failed" in page(told(*failed))


def test_the_next_grid_counts_where_the_finest_was_not_computed_and_the_page_says_so():
    every = on_grids(ROW, 1.0, 1.1, 1.3, cells=tuple(one.cells for one in CASES[ROW.case].grids))
    text = page(told(*every[1:], outcome(NUMBERS)))
    assert f"The finest of its grids, of {every[0].cells} cells, has not been computed: {every[1].cells} count." in text
    assert text.count("The finest grids of duetsch_force have not been computed, and the next ones count.") == 1
    assert "2 of 3 grids are there" in text
    assert f"| {every[1].cells}, {every[2].cells} | 122 s |" in text
    assert "Of 2 rows 2 were computed: the median" in text
    assert " The grids that were computed took 3 minutes of processor time." in text
    assert " All flows together took 3 minutes" in page(told(*every, rows=(ROW,)))
    whole = page(told(*every, outcome(NUMBERS)))
    assert "The finest" not in whole
    assert "Of 2 rows 2 were computed in full: the median" in whole


def test_the_range_and_the_source_s_own_error_stand_beside_the_peak():
    found = told(outcome(ROW, 1.1))[0].comparison
    assert found.over_range == pytest.approx(found.rms * np.abs(found.published).max() / np.ptp(found.published))
    assert found.over_range < found.rms  # a force to and fro
    text = page(told(outcome(NUMBERS, 1.1)))
    assert "| [re100_numbers](#re100_numbers) | 10.0 % |  | 3.0 % | 1.5 % |" in text


def test_the_summary_counts_what_was_judged():
    text = summary(told(outcome(ROW, 1.02), outcome(NUMBERS)))
    assert text.startswith("Of 2 rows 2 were computed in full: the median rms difference is 0.")
    assert " % of the peak (of curves 0." in text
    assert "of curves" not in summary(told(outcome(NUMBERS), rows=(NUMBERS,)))
    assert "(duetsch_force); 2 are within their bounds." in text


def test_what_is_read_along_the_skin_says_how_well():
    skin = ROWS["li_pressure_re40"]
    assert "the peak wall vorticity" in page(told(outcome(skin), rows=(skin,)))
    assert "the peak wall vorticity" not in page(told(outcome(ROW)))


def test_pictures_are_drawn_of_every_kind_of_row():
    some = told(outcome(ROW), outcome(NUMBERS, 1.1), outcome(LOOP), rows=(ROW, NUMBERS, LOOP, ROWS["taira_re40"]))
    assert len(draw_group(some).axes) == 6
    assert len(draw_parity(some).axes) == 2
    draw_parity(told())


def test_the_tool_writes_page_and_pictures_from_a_folder(tmp_path):
    save_outcome(outcome(ROW), tmp_path / "out")
    first = atlas_page.main(tmp_path / "out", tmp_path / "docs").read_text()
    assert {path.name for path in (tmp_path / "docs" / "pictures").glob("[!.]*")} == {
        "atlas_parity.png", "atlas_bodies_that_move_in_water_at_rest.png"
    }  # fmt: skip
    save_outcome(outcome(ROW, 1.3), tmp_path / "out")
    assert atlas_page.main(tmp_path / "out", tmp_path / "docs").read_text() != first


def test_the_tool_takes_neither_nothing_nor_trials(tmp_path):
    with pytest.raises(IncompatibleRecord, match="holds no outcomes of the atlas"):
        atlas_page.main(tmp_path, tmp_path)
    save_outcome(outcome(ROW, quick=True), tmp_path)
    with pytest.raises(IncompatibleRecord, match=r"in_line in .* are quick trials"):
        atlas_page.main(tmp_path, tmp_path)


def test_what_other_pages_state_is_of_the_rows_themselves():
    """One row that its grids explain, one that they do not, one without an index."""
    small, large = 0.001, 0.2
    near = on_grids(ROW, 1.0, 1.05, 1.12)
    far = on_grids(LOOP, 1 + large, 1 + large + small, 1 + large + 2.5 * small)
    told_of = atlas_page.stated(told(*near, *far, outcome(NUMBERS, 1.01), rows=(ROW, LOOP, NUMBERS)))
    assert told_of["converged"] == [ROW.name, LOOP.name]
    assert told_of["beyond"] == [LOOP.name]
    assert told_of["within"] == [ROW.name]
    assert told_of["refused"] == told_of["short"] == [NUMBERS.name]
    assert told_of["rows"][NUMBERS.name]["ours"]["mean drag"] == pytest.approx(9.286 / 7 * 1.01)
    assert told_of["rows"][ROW.name]["rms"] == 0
    assert told_of["minutes"] == pytest.approx(7 * 61 / 60)


def test_the_page_in_the_documentation_has_the_numbers_that_other_pages_state():
    kept = store.load("atlas").values
    lines = (atlas_page.DOCS / "atlas.md").read_text().splitlines()
    table = {line.partition("](#")[2].partition(")")[0]: line.split("|")[2] for line in lines if line[:3] == "| ["}
    assert {name: f" {100 * row['rms']:.1f} % " for name, row in kept["rows"].items()} == table


def test_only_the_rows_that_were_asked_for_are_on_the_page(tmp_path):
    text = write_atlas({ROW.case: outcome(ROW)}, tmp_path, (ROW,)).read_text()
    assert "duetsch_force" in text
    assert "re100_numbers" not in text


def test_replace_keeps_the_bound_out_of_reach():
    """The bound follows from the sources: a row has no field that could be tuned."""
    with pytest.raises(TypeError):
        replace(ROW, bound=0.5)

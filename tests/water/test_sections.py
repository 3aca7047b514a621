"""The table of what oscillating sections feel: exact answers, published ones, held-out points, and bad tables."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from evidence.atlas import sections
from evidence.atlas.outcome import FlowOutcome, compute
from evidence.atlas.sections import measured, points, write_table
from suchus.core.errors import InvalidDesign, UnreadableFile
from suchus.core.progress import silent
from suchus.robot.design.water import Water
from suchus.swimming.water.sections import (
    TABLE,
    attached_coefficients,
    coefficients,
    correction_factors,
    held_out_errors,
    table,
)


def test_where_the_flow_is_attached_the_round_section_is_that_of_stokes_and_wang():
    drag, added = coefficients(1.0, 1.0)
    exact = attached_coefficients(1.0)
    assert drag == pytest.approx(exact[0], rel=0.03)
    assert added == pytest.approx(exact[1], rel=0.03)
    assert coefficients(1.0, 10.0)[0] > 1.5 * attached_coefficients(10.0)[0]  # there it separates


def test_the_formula_of_stokes_and_wang_is_theirs():
    """Their leading terms: drag 3 pi^3 / 2 KC (pi beta)^-1/2, added mass 1 + 4 (pi beta)^-1/2."""
    assert attached_coefficients(2.0, 1e8)[0] == pytest.approx(1.5 * np.pi**3 / 2.0 / np.sqrt(np.pi * 1e8), rel=1e-4)
    assert attached_coefficients(1.0, 1e8)[1] - 1.0 == pytest.approx(4.0 / np.sqrt(np.pi * 1e8), rel=1e-4)


def test_the_round_section_is_that_of_the_published_experiment():
    """Dütsch, Durst, Becker and Lienhart 1998, J. Fluid Mech. 360, fig. 10, fitted as our forces are: KC 5, Re 100."""
    coarse, fine = (one for one in table() if (one.aspect, one.keulegan) == (1.0, 5.0))
    theirs = measured()
    assert fine.cells > coarse.cells
    assert (fine.drag, fine.added_mass) == pytest.approx(theirs, rel=0.03)
    assert (coarse.drag, coarse.added_mass) == pytest.approx(theirs, rel=0.06)


def test_the_fit_to_the_published_curve_does_not_hang_on_how_it_is_read():
    assert measured(100) == pytest.approx(measured(1000), rel=0.002)


def test_interpolation_is_near_the_points_that_were_held_out():
    errors = held_out_errors()
    assert errors.shape == (len(sections.HELD_OUT), 2)
    assert errors.max() <= 0.15
    assert errors.max() > 0.0  # none of them is a node
    for aspect, keulegan in sections.HELD_OUT:
        assert aspect not in sections.ASPECTS
        assert keulegan not in sections.KEULEGANS


def test_nodes_are_what_was_computed():
    for one in table()[: len(sections.ASPECTS) * len(sections.KEULEGANS)]:
        assert coefficients(one.aspect, one.keulegan) == pytest.approx((one.drag, one.added_mass), rel=1e-9)
        assert abs(one.drag / one.previous_drag - 1.0) < 0.08  # periods repeat
        assert abs(one.added_mass / one.previous_added_mass - 1.0) < 0.05


def test_the_page_says_how_the_swims_own_coefficients_compare():
    """Beyond the attached layer a round section has the model's drag, a high one more, a flat one less."""
    for keulegan in (10.0, 20.0):
        layer, model = attached_coefficients(keulegan)[0], Water().cross_drag
        assert coefficients(1.0, keulegan)[0] - layer == pytest.approx(model, rel=0.05)
        assert coefficients(2.0, keulegan)[0] - layer > 1.5 * model
        assert coefficients(4.0, keulegan)[0] - layer > 1.5 * model
        assert coefficients(0.5, keulegan)[0] - layer < 0.8 * model


@pytest.mark.parametrize(("aspect", "low", "high"), [(1.0, 0.9, 1.1), (4.0, 1.5, 3.0), (0.5, 0.3, 0.7)])
def test_a_high_section_widens_the_band_and_a_flat_one_too(aspect, low, high):
    """KC 10: the drag of a round section is the swims' own, that of a high one more, of a flat one less."""
    height = np.full(5, 0.05)
    drag, _ = correction_factors(height / aspect, height, 10.0 / np.pi * height)
    assert low < drag < high
    assert drag == pytest.approx((coefficients(aspect, 10.0)[0] - attached_coefficients(10.0)[0]) / Water().cross_drag)


def test_sections_count_as_much_as_they_swing():
    height, swing = np.array([0.05, 0.05]), np.array([0.16, 0.0016])
    both = correction_factors(np.array([0.05, 0.0125]), height, swing)
    first = correction_factors(np.array([0.05, 0.05]), height, swing)
    assert both == pytest.approx(first, rel=1e-2)
    assert correction_factors(np.array([0.0125, 0.05]), height, swing)[0] > 1.5 * first[0]
    assert correction_factors(np.array([0.0125, 0.05]), height, swing)[1] > 1.5 * first[1]
    pointed = correction_factors(
        np.array([0.05, 0.05, 0.0]), np.array([0.05, 0.05, 0.0]), np.array([0.16, 0.0016, 0.2])
    )
    assert pointed == pytest.approx(first)


@pytest.mark.parametrize(("aspect", "keulegan", "message"), [
    (0.2, 5.0, "aspect is 0.2; the table of sections holds 0.25 to 4"),
    (1.0, 21.0, "keulegan is 21; the table of sections holds 1 to 20"),
    (float("nan"), 5.0, "aspect is nan"),
])  # fmt: skip
def test_outside_the_table_there_is_nothing(aspect, keulegan, message):
    with pytest.raises(InvalidDesign, match=message):
        coefficients(aspect, keulegan)


def test_a_table_is_written_whole_or_not_at_all(tmp_path):
    rows = dict(zip(points(), table(), strict=True))
    outcomes = {
        name: FlowOutcome(
            case=name, digest=one.digest, quick=False, cells=one.cells, seconds=1.0,
            curves={"drag": np.array([[1.5, 2.5], [one.previous_drag, one.drag]]),
                    "added": np.array([[1.5, 2.5], [one.previous_added_mass, one.added_mass]]),
                    "left": np.array([[1.5, 2.5], [one.residual, one.residual]])},
        )
        for name, one in rows.items()
    }  # fmt: skip
    path = tmp_path / "sections.csv"
    assert "35 flows" in write_table(outcomes, path)
    assert path.read_text() == TABLE.read_text()
    name = next(iter(outcomes))
    for bad in ({**outcomes, name: replace(outcomes[name], failed="it burst")},
                {other: one for other, one in outcomes.items() if other != name}):  # fmt: skip
        with pytest.raises(InvalidDesign, match=f"lacks the flow {name}: it"):
            write_table(bad, tmp_path / "other.csv")
    assert not (tmp_path / "other.csv").exists()


@pytest.mark.parametrize("text", ["", "aspect,keulegan\n1,2\n"])
def test_another_file_is_no_table(tmp_path, text):
    path = tmp_path / "table.csv"
    path.write_text(text)
    if text:
        with pytest.raises(UnreadableFile, match="no table of sections"):
            table(path)
    with pytest.raises(UnreadableFile):
        table(Path(tmp_path / "none.csv"))


def test_a_flow_of_the_table_is_computed():
    (case,) = [one for one in sections.cases() if one.name == "section_1_1"]
    found = compute(case, quick=True, progress=silent)
    assert not found.failed
    assert found.curves["drag"][1, -1] == pytest.approx(attached_coefficients(1.0)[0], rel=0.25)
    assert found.curves["added"][1, -1] == pytest.approx(attached_coefficients(1.0)[1], rel=0.25)

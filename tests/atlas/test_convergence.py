"""The grid convergence index: exact answers, the published example, both sides of each refusal."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from evidence.atlas import ROWS, GridConvergence, grid_convergence, published, row_convergence
from evidence.atlas.comparison import points
from evidence.atlas.convergence import FORMAL, GRIDS, SAFETY

CELLS = (48.0, 32.0, 24.0)
NUMBERS, CURVE = ROWS["dfg_2d1"], ROWS["duetsch_force"]


def converging(limit, error, order, cells=CELLS):
    """Values whose error falls with a power of the cell."""
    return [np.atleast_1d(limit + np.asarray(error) * n**-order) for n in cells]


@settings(max_examples=25, deadline=None)
@given(st.floats(0.3, 4), st.floats(0.5, 50), st.sampled_from([CELLS, (64, 48, 32), (62, 47, 31)]))
def test_the_order_of_an_error_that_is_a_power_is_found_and_the_band_holds_the_limit(order, error, cells):
    values = converging(3.0, error, order, cells)
    found = grid_convergence(values, cells, 3.0)
    assert found.order == pytest.approx(order, rel=1e-3)
    left = abs(values[0][0] - 3.0) / 3.0
    if order <= FORMAL:
        assert found.uncertainty == pytest.approx(SAFETY * left, rel=1e-3)
    else:  # a higher order than the scheme's is not counted on
        assert found.uncertainty > SAFETY * left


def test_the_example_of_the_guideline():
    """Celik et al. 2008, table 1, first column: 18 000, 8 000 and 4 500 cells in the plane, 6.063, 5.972, 5.863."""
    found = grid_convergence([np.array([v]) for v in (6.063, 5.972, 5.863)], [1.5 * 4 / 3, 4 / 3, 1.0], 6.063)
    assert found.order == pytest.approx(1.53, abs=0.01)
    assert found.uncertainty == pytest.approx(0.022, abs=0.0005)


@pytest.mark.parametrize(
    ("values", "refused"),
    [
        ((1.0, 1.1, 1.3), ""),
        ((1.0, 1.1, 1.001), "does not become smaller"),  # back by less than there
        ((1.0, 1.1, 0.999), ""),  # by more: it closes in from both sides
        ((1.0, 1.1, 1.15), "does not become smaller"),  # it grows with finer cells
        ((1.0, 1.1, 1.1 + 0.1 * np.log(32 / 24) / np.log(48 / 32) * 0.999), "does not become smaller"),
        ((1.0, 1.1, 1.1 + 0.1 * np.log(32 / 24) / np.log(48 / 32) * 1.001), ""),  # just: of order nought
        ((1.0, 1.1), "2 of 3 grids"),
    ],
)
def test_what_does_not_converge_is_refused(values, refused):
    found = grid_convergence([np.array([value]) for value in values], CELLS[: len(values)], 1.0)
    assert refused in found.refusal
    assert bool(found.refusal) == bool(refused)
    assert (found.uncertainty is None) == bool(refused)


@settings(max_examples=25, deadline=None)
@given(st.floats(0.3, 4), st.floats(0.5, 50))
def test_the_order_of_an_error_that_changes_its_sign_from_grid_to_grid(order, error):
    """Celik et al. 2008, equation 3 with s = -1, put in: changes of opposite sign in the ratio that an order has."""
    r21, r32 = 48 / 32, 32 / 24
    ratio = r21**order * (r32**order + 1) / (r21**order + 1)
    found = grid_convergence([np.array([v]) for v in (0.0, error, error - ratio * error)], CELLS, 1.0)
    assert found.order == pytest.approx(order, rel=1e-3)
    assert found.turning == 1.0
    assert found.uncertainty == pytest.approx(SAFETY * error / (r21 ** min(order, FORMAL) - 1), rel=1e-2)


def test_the_points_at_which_a_curve_turns_back_are_counted():
    first = np.array([1.0, 1.0, 1.0, 1.0])
    for second, turning in ((2 * first, 0.0), (np.array([2.0, 2.0, 2.0, -1.0]), 0.25), (-2 * first, 1.0)):
        found = grid_convergence([np.zeros(4), first, first + second], CELLS, 1.0)
        assert found.turning == turning
        assert not found.refusal


def test_values_that_no_grid_changes_are_certain():
    assert grid_convergence([np.ones(3)] * GRIDS, CELLS, 1.0) == GridConvergence(uncertainty=0.0)


def numbers(*factors):
    """Three grids of the channel's numbers, each published value times a factor by its place."""
    table = published(NUMBERS.data)
    names, value = table.columns["quantity"], table.values("FeatFlow")
    return {
        k + 1: (round(cells), {name: np.array(v * f[k]) for name, v, f in zip(names, value, factors, strict=True)})
        for k, cells in enumerate(CELLS)
    }


def test_numbers_are_judged_one_by_one_and_the_row_has_their_mean_square():
    good = [1 + a * np.array(CELLS) ** -2.0 for a in (5.0, -20.0, 40.0)]
    found = row_convergence(NUMBERS, numbers(*good))
    assert found.order == pytest.approx(2.0, abs=0.01)
    assert found.uncertainty == pytest.approx(SAFETY * np.sqrt((25 + 400 + 1600) / 3) / 48**2, rel=0.01)
    bad = row_convergence(NUMBERS, numbers(good[0], np.array([1.0, 1.1, 1.01]), good[2]))
    assert bad.refusal == "lift: its change does not become smaller with the cells"
    short = numbers(*good)
    assert "2 of 3 grids" in row_convergence(NUMBERS, {k: v for k, v in short.items() if k < 3}).refusal
    short[2][1].pop("lift")
    assert "not all of the numbers" in row_convergence(NUMBERS, short).refusal


def test_a_curve_is_judged_at_the_points_that_all_grids_reach():
    x, y = points(CURVE, published(CURVE.data))
    row = replace(CURVE, period=None)
    grids = {k + 1: (round(n), {"force": np.stack([x, y * (1 + n**-1.0)])}) for k, n in enumerate(CELLS)}
    found = row_convergence(row, grids)
    assert found.order == pytest.approx(1.0, abs=0.01)
    part = np.sqrt(np.mean(y**2)) / np.abs(y).max()
    assert found.uncertainty == pytest.approx(SAFETY * part / 48, rel=0.01)
    for reach, said in ((0.6, ""), (0.4, "fewer than half")):
        few = x < np.quantile(x, reach)
        cut = {**grids, 2: (32, {"force": grids[2][1]["force"][:, few]})}
        assert said in row_convergence(row, cut).refusal
        assert bool(row_convergence(row, cut).refusal) == bool(said)
    assert "32 cells gave no such curve" in row_convergence(row, {**grids, 2: (32, {})}).refusal

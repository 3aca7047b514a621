"""How far curves and numbers are apart: exact answers, and both sides of every bound."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from evidence.atlas import AtlasRow, bound, compare, rms_over_peak
from evidence.atlas.case import FINEST, UNKNOWN_SCATTER, PublishedCurves
from suchus.core.errors import IncompatibleRecord

ROW = AtlasRow(name="one", title="One", case="cavity_re100", data="one", x="x", y="y", computed_curve="curve")


@pytest.fixture
def data(monkeypatch):
    """Hand out tables from a dictionary instead of from files."""
    known = {}
    monkeypatch.setattr("evidence.atlas.comparison.published", known.__getitem__)

    def put(name, **columns):
        known[name] = PublishedCurves(
            description=("A table.",), columns={k: tuple(map(str, v)) for k, v in columns.items()}
        )

    return put


def test_a_constant_offset_is_itself_over_the_peak(data):
    data("one", x=[0, 1, 2, 3], y=[0, 1, 2, -4])
    curve = np.array([[0, 1, 2, 3], [0.2, 1.2, 2.2, -3.8]])
    assert compare(ROW, {"curve": curve}).rms == pytest.approx(0.05)


def test_a_row_agrees_up_to_its_bound_and_not_beyond(data):
    data("one", x=[0, 1], y=[1, 1])
    for off, agrees in ((0.0799, True), (0.0801, False)):
        found = compare(ROW, {"curve": np.array([[0, 1], [1 + off, 1 + off]])})
        assert found.bound == UNKNOWN_SCATTER
        assert found.agrees is agrees


@pytest.mark.parametrize(
    ("scatter", "expected"),
    [
        (None, 0.08),
        (0.0, 0.02),
        (0.0099, 0.02),
        (0.011, 0.022),
        (0.039, 0.078),
        (0.041, 0.08),
        (0.079, 0.08),
        (0.3, 0.3),
    ],
)
def test_the_bound_is_twice_the_scatter_within_limits(scatter, expected):
    assert bound(scatter) == pytest.approx(expected)


@given(st.floats(0, 1), st.floats(0, 1))
def test_more_scatter_never_means_a_smaller_bound_nor_one_below_the_scatter(a, b):
    low, high = sorted((a, b))
    assert bound(low) <= bound(high)
    assert bound(high) >= max(high, FINEST)


@given(st.lists(st.floats(-10, 10), min_size=2, max_size=20), st.floats(0.1, 10))
def test_the_difference_scales_out(values, factor):
    a, b = np.array(values), np.linspace(1, 2, len(values))
    assert rms_over_peak(factor * a, factor * b) == pytest.approx(rms_over_peak(a, b))
    assert rms_over_peak(b, b) == 0


def test_scale_shift_and_window_act_on_the_published_points(data):
    data("one", x=[0, 2, 4, 6], y=[5, 6, 7, 100])
    row = replace(ROW, scale=(0.5, 2.0), shift=(1.0, -10.0), window=(1.0, 3.0))
    curve = np.array([[0, 5], [-2, 8]])  # 2 x - 2: 0, 2, 4 at 1, 2, 3
    found = compare(row, {"curve": curve})
    assert found.x.tolist() == [1, 2, 3]
    assert found.rms == 0


def test_points_near_a_multiple_of_a_spacing_can_be_left_out(data):
    data("one", x=[0.25, 0.49, 0.5, 0.53, 0.75], y=[1, 9, 9, 1, 1])
    row = replace(ROW, excluded_spacing=(0.5, 0.02))
    found = compare(row, {"curve": np.array([[0, 1], [1, 1]])})
    assert found.x.tolist() == [0.25, 0.53, 0.75]
    assert found.rms == 0


def test_an_angle_goes_round(data):
    data("one", x=[359, 0, 1], y=[1, 1, 1])
    curve = np.array([[10, 180, 350], [1.0, 5.0, 1.0]])
    assert compare(replace(ROW, period=360.0), {"curve": curve}).rms == 0


def test_a_curve_that_ends_too_early_is_refused(data):
    data("one", x=[0, 1, 2, 3], y=[1, 1, 1, 1])
    assert compare(ROW, {"curve": np.array([[0, 1.5], [1, 1]])}).x.size == 2
    with pytest.raises(IncompatibleRecord, match="reaches 1 of 4 published points"):
        compare(ROW, {"curve": np.array([[0, 0.5], [1, 1]])})


def test_a_curve_that_is_not_there_is_named(data):
    data("one", x=[0, 1], y=[1, 1])
    with pytest.raises(IncompatibleRecord, match="no curve named 'curve'"):
        compare(ROW, {"other": np.zeros((2, 3))})


def test_an_instant_is_compared_with_the_nearest_cycle_and_says_how_far_the_others_are(data):
    data("one", x=[0, 1], y=[1, 1])
    row = replace(ROW, any_cycle=True)
    cycles = {f"curve {k}": np.array([[0, 1], [1 + off, 1 + off]]) for k, off in ((2, 0.3), (3, -0.05), (10, 0.2))}
    found = compare(row, {**cycles, "curve": np.zeros((2, 2)), "curve of another": np.zeros((2, 2))})
    assert found.curve == "curve 3"
    assert found.rms == pytest.approx(0.05)
    assert found.cycles == pytest.approx((0.3, 0.05, 0.2))
    assert compare(ROW, {"curve": np.array([[0, 1], [1, 1]])}).cycles == ()
    with pytest.raises(IncompatibleRecord, match="no curve named 'curve 1'"):
        compare(row, {"other 1": np.zeros((2, 2))})


def test_a_row_takes_the_cycle_that_another_row_of_its_source_chose(data):
    data("one", x=[0, 1], y=[1, 1])
    data("two", x=[0, 1], y=[1, 1])
    here, there = np.array([[0, 1], [1.0, 1.0]]), np.array([[0, 1], [1.5, 1.5]])
    by = replace(ROW, any_cycle=True)
    row = replace(ROW, data="two", computed_curve="other", any_cycle=True, cycle_of=by)
    found = compare(row, {"curve 1": there, "curve 2": here, "other 1": here, "other 2": there})
    assert found.curve == "other 2"
    assert found.rms == pytest.approx(0.5)
    assert min(found.cycles) == 0


def test_a_loop_is_compared_with_its_nearer_branch(data):
    turn = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    circle = np.stack([np.cos(turn), np.sin(turn)])
    row = replace(ROW, kind="loop")
    data("one", x=[0.0, 0.0, 0.6, 0.6, 1.0], y=[1.0, -1.0, 0.8, -0.8, 0.0])
    assert compare(row, {"curve": circle}).rms == pytest.approx(0, abs=2e-4)
    data("one", x=[0.0, 0.0], y=[1.1, -1.1])
    assert compare(row, {"curve": circle}).rms == pytest.approx(0.1 / 1.1, abs=2e-4)


def test_a_loop_that_is_too_narrow_reaches_too_few_points(data):
    turn = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    data("one", x=[0.0, 0.9, -0.9], y=[0.5, 0.2, 0.2])
    with pytest.raises(IncompatibleRecord, match="reaches 1 of 3"):
        compare(replace(ROW, kind="loop"), {"curve": 0.5 * np.stack([np.cos(turn), np.sin(turn)])})


def test_numbers_are_compared_with_the_mean_of_their_sources(data):
    data("one", quantity=["drag", "lift"], a=[1.0, 4.0], b=[3.0, ""])
    row = replace(ROW, kind="numbers")
    found = compare(row, {"drag": np.array(2.2), "lift": np.array(4.0), "other": np.zeros(3)})
    assert found.published.tolist() == [2.0, 4.0]
    assert found.rms == pytest.approx(0.1 / 2**0.5)
    assert found.scatter == pytest.approx((0.5 / 3) ** 0.5)  # 1/2 twice and 0 once
    with pytest.raises(IncompatibleRecord, match="gave no lift"):
        compare(row, {"drag": np.array(2.2)})


def test_one_source_of_numbers_has_no_scatter(data):
    data("one", quantity=["drag"], a=[1.0])
    assert compare(replace(ROW, kind="numbers"), {"drag": np.array(1.0)}).scatter is None


def test_the_scatter_is_that_of_the_source_farthest_off(data):
    x = np.arange(10.0)
    data("one", x=x, y=np.full(10, 2.0))
    data("near", t=x, v=np.full(10, 2.1))
    data("far", t=2 * x, v=np.full(10, 1.8))
    data("short", t=x[:3], v=np.full(3, 9.0))  # three points say nothing
    row = replace(ROW, other_sources=(("near", "t", "v", 1.0), ("far", "t", "v", 0.5), ("short", "t", "v", 1.0)))
    assert compare(row, {"curve": np.stack([x, np.full(10, 2.0)])}).scatter == pytest.approx(0.1)
    only = replace(ROW, other_sources=(("short", "t", "v", 1.0),))
    assert compare(only, {"curve": np.stack([x, np.full(10, 2.0)])}).scatter is None


def test_another_source_is_shifted_as_the_row_is(data):
    x = np.arange(10.0)
    data("one", x=x, y=x)
    data("other", t=x, v=x + 1)
    row = replace(ROW, scale=(-1.0, 1.0), shift=(9.0, 0.0), other_sources=(("other", "t", "v", -1.0),))
    curve = np.stack([x, 9 - x])
    assert compare(row, {"curve": curve}).rms == 0
    assert compare(row, {"curve": curve}).scatter == pytest.approx(1 / 9)

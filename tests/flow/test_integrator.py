"""Integrators as objects: stages that add up, of the order that they are known for, with forces that balance."""

from math import log2

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from test_scheme import vortices

from suchus import flow
from suchus.core.errors import InvalidDesign
from suchus.flow.compiled import PAD

BY_ORDER = {1: flow.EULER, 2: flow.HEUN, 3: flow.SHU_OSHER}


def test_the_orders_are_the_known_ones():
    assert {order: one.order for order, one in BY_ORDER.items()} == {1: 1, 2: 2, 3: 3}
    midpoint = flow.Integrator((flow.Stage(0.0, 0.5), flow.Stage(0.0, 1.0)))
    assert midpoint.order == 2
    assert flow.Integrator((flow.Stage(0.0, 0.3), flow.Stage(0.0, 1.0))).order == 1


def test_weights_are_those_of_the_tables():
    np.testing.assert_allclose(flow.HEUN.weights, [1 / 2, 1 / 2])
    np.testing.assert_allclose(flow.SHU_OSHER.weights, [1 / 6, 1 / 2, 1 / 3])
    np.testing.assert_allclose(flow.SHU_OSHER.rates[-1], [1 / 6, 1 / 6, 2 / 3])  # Shu and Osher's


@given(st.lists(st.floats(0.0, 0.9), min_size=1, max_size=4), st.data())
def test_shares_add_up_whatever_the_stages(keeps, data):
    """The last stage's span is what makes the step whole."""
    keeps[0], spans = 0.0, [data.draw(st.floats(0.1, 1.0)) for _ in keeps]
    total = 0.0
    for keep, span in zip(keeps[:-1], spans[:-1], strict=True):
        total = keep * total + (1 - keep) * span
    missing = (1 - keeps[-1] * total) / (1 - keeps[-1]) if len(keeps) > 1 else 1.0
    stages = [flow.Stage(k, s) for k, s in zip(keeps, [*spans[:-1], missing], strict=True)]
    if missing <= 0:
        with pytest.raises(InvalidDesign):
            flow.Integrator(tuple(stages))
        return
    one = flow.Integrator(tuple(stages))
    assert one.order >= 1
    assert one.weights.sum() == pytest.approx(1)
    assert one.weights @ [s.span for s in stages] == pytest.approx(1)
    with pytest.raises(InvalidDesign, match="must add up to 1"):
        flow.Integrator((*stages[:-1], flow.Stage(stages[-1].keep, 1.1 * missing)))


@pytest.mark.parametrize(
    ("stages", "words"),
    [
        ((), "at least one stage"),
        ((flow.Stage(0.5, 1.0),), "the first keeps nothing"),
        ((flow.Stage(0.0, 1.0), flow.Stage(1.0, 1.0)), "keep is at least 0 and below 1"),
        ((flow.Stage(0.0, float("nan")),), "span is above 0"),
        ((flow.Stage(0.0, "whole"),), "a number is needed"),
    ],
)
def test_what_is_no_integrator_is_refused(stages, words):
    with pytest.raises(InvalidDesign, match=words):
        flow.Integrator(stages)


def after(step, one):
    sim = vortices(16, scheme=flow.CENTRAL, integrator=one, step=step)
    sim.run(0.8)
    return sim.water.velocity[:, PAD:-PAD, PAD:-PAD].copy()


@pytest.mark.slow("the second precision")
@pytest.mark.parametrize("order", BY_ORDER)
def test_halving_the_step_divides_what_is_off_by_two_to_the_order(order):
    """Against the same grid with sixteen times smaller steps; by central differences, in which no limiter switches."""
    exact = after(0.005, flow.SHU_OSHER)
    coarse, fine = (np.abs(after(step, BY_ORDER[order]) - exact).mean() for step in (0.16, 0.08))
    assert order - 0.35 < log2(coarse / fine) < order + 1.0


def test_the_force_on_a_body_is_the_same_by_all_that_are_exact_enough():
    grid = flow.Grid.covering((-1.5, 2.5), (-1.5, 1.5), cell=1 / 16)
    drag = {}
    for order, one in BY_ORDER.items():
        body = flow.Body(shape=flow.Cylinder(diameter=1.0))
        setup = flow.Setup(grid=grid, viscosity=1 / 40, stream=(1.0, 0.0), bodies=(body,), integrator=one, step=0.01)
        drag[order] = flow.Simulation(setup).run(1.0).force("body")[-10:, 0].mean()
    assert drag[3] == pytest.approx(drag[2], rel=3e-3)
    assert drag[1] == pytest.approx(drag[2], rel=3e-2)

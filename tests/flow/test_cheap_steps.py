"""What keeps a step of a small flow cheap does not change what it computes."""

import numpy as np
import pytest

from suchus import flow
from suchus.core import threads
from suchus.flow import border, farfield
from suchus.flow.compiled import PAD
from suchus.flow.pose import CachedMotion
from suchus.flow.simulation import MIN_THREAD_CELLS

SWING = flow.Oscillation(frequency=0.5, heave=(0.02, 0.1), pitch=0.3)


def setup_of(cells, motion=SWING):
    body = flow.Body(shape=flow.Ellipse(length=1.0, width=0.5), motion=motion)
    grid = flow.Grid(cells=cells, cell=4 / cells[1], origin=(-2.0, -2.0))
    return flow.Setup(grid=grid, viscosity=0.05, stream=(1.0, 0.0), bodies=(body,), coarse=True)


@pytest.mark.parametrize(("cells", "expected"), [((48, 32), 1), ((192, 128), 1), ((256, 128), 2), ((512, 256), 4)])
def test_a_small_flow_takes_one_thread_unless_more_are_asked_for(cells, expected, monkeypatch):
    monkeypatch.setattr(threads, "count", lambda: 4)
    assert cells[0] * cells[1] // MIN_THREAD_CELLS in (0, expected, 2 * expected)
    assert flow.Simulation(setup_of(cells))._threads == expected
    assert flow.Simulation(setup_of(cells), thread_count=3)._threads == 3


def test_a_motion_is_asked_once_for_each_time():
    times = []

    def motion(time):
        times.append(time)
        return SWING(time)

    sim = flow.Simulation(setup_of((48, 32), motion), thread_count=1)
    sim.advance()
    times.clear()
    for _ in range(8):
        sim.advance()
    assert 0 < len(times) <= 6 * 8  # three for the longest step, two for the rates, one for the end
    other = flow.Simulation(setup_of((48, 32)), thread_count=1)
    for _ in range(9):
        other.advance()
    np.testing.assert_array_equal(sim.water.velocity, other.water.velocity)


def test_a_motion_that_changes_is_asked_again():
    cached = CachedMotion(lambda time: flow.Pose(position=(offset[0] + time, 0.0)))
    offset = [1.0]
    assert cached(0.5).position[0] == 1.5
    offset[0] = 2.0
    assert cached(0.5).position[0] == 1.5
    cached.clear()
    assert cached(0.5).position[0] == 2.5
    for time in np.arange(2 * CachedMotion.MAX_CACHED_TIMES):
        cached(float(time))
    assert len(cached._poses) == CachedMotion.MAX_CACHED_TIMES


@pytest.mark.parametrize("cells", [(12, 8), (12, 8, 10)])
@pytest.mark.parametrize("axis", range(3))
def test_water_leaves_through_an_outflow_as_it_is_carried_there(cells, axis):
    ndim = len(cells)
    if axis >= ndim:
        pytest.skip("the plane has two axes")
    names = ("right", "top", "high")
    sides = flow.Sides.box().__class__(
        **{name: flow.Wall() for name in ("left", "right", "bottom", "top", "low", "high")}
        | {names[axis]: flow.Outflow()}
    )
    grid = flow.Grid(cells=cells, cell=1.0)
    edges = border.Border.for_grid(sides, grid, np.float64)
    random = np.random.default_rng(3)
    velocity = 1.0 + random.random((ndim, *(n + 2 * PAD for n in reversed(cells))))
    stream = tuple(float(d == axis) for d in range(ndim))
    edges.prepare(velocity, (PAD,) * (2 * ndim), 0.25, stream)
    edge = next(edge for edge in edges.edges if edge.name == names[axis])
    lines = np.moveaxis(velocity[axis], ndim - 1 - axis, 0)
    inside = (slice(PAD, -PAD),) * (ndim - 1)
    outer, inner = lines[PAD + cells[axis]][inside], lines[PAD + cells[axis] - 1][inside]
    carried = outer - min(outer.mean() * 0.25, 1.0) * (outer - inner)
    np.testing.assert_allclose(edge.prescribed, carried.mean() - carried, rtol=0, atol=1e-12)  # nothing comes in


def test_sources_of_a_wake_have_the_strength_of_its_defect():
    nx, ny = 64, 48
    velocity = np.ones((2, ny + 2 * PAD, nx + 2 * PAD))
    y = np.arange(ny + 2 * PAD) - PAD + 0.5
    velocity[1] = 0.0
    velocity[0] -= 0.2 * np.exp(-(((y - ny / 2) / 5.0) ** 2))[:, None]
    water = farfield.OpenWater((nx, ny))
    sides = water.inward(velocity, (PAD + 8, PAD + 16, PAD + 20, PAD + 28), [farfield.Fading(0, False, 1.0, 24.0)])
    defect = 0.2 * 5.0 * np.sqrt(np.pi)
    outflow = -sum(side.sum() for side in sides)
    assert outflow == pytest.approx(defect, rel=0.05)

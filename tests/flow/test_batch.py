"""A batch of flows gives each the bytes that it has alone, and says which one cannot be."""

from dataclasses import replace

import numpy as np
import pytest

from suchus import flow
from suchus.core.errors import InvalidDesign, OutsideLimits

GRID = flow.Grid(cells=(48, 32), cell=1 / 8, origin=(-2.0, -2.0))
STILL = flow.Setup(
    grid=GRID, viscosity=0.02, stream=(1.0, 0.0), bodies=(flow.Body(shape=flow.Cylinder(diameter=1.0)),), coarse=True
)


def setups():
    """Flows on equal cells that share little else: bodies, sides, water, size of the cells, contact."""
    swing = flow.Oscillation(frequency=0.5, heave=(0.0, 0.1), pitch=0.3)
    ellipse = flow.Body(shape=flow.Ellipse(length=1.0, width=0.5), motion=swing)
    disc = flow.FreeBody(shape=flow.Cylinder(diameter=1.0), start=(0.0, 0.2), density=1.5, gravity=(0.0, -1.0))
    floor = flow.Sides(bottom=flow.Wall())
    eel = flow.FreeBody(shape=flow.eel(2.4, stations=49), start=(-0.2, 0.0), name="eel")
    yield STILL
    yield replace(STILL, bodies=(ellipse,), viscosity=0.05)
    yield replace(
        STILL, bodies=(disc,), sides=floor, stream=(0.0, 0.0), contact=flow.BodyContact(gap=0.3, pressure=20.0)
    )
    yield replace(STILL, grid=replace(GRID, cell=1 / 9))
    yield replace(STILL, bodies=(eel,), stream=(0.0, 0.0), follow="eel")


def state(sim):
    """Return all that a flow leaves: time, fields and record."""
    return [np.array(sim.time), sim.water.velocity, sim.water.p, np.array(sim._log.rows)]


@pytest.mark.parametrize("thread_count", [1, 2])
def test_each_flow_of_a_batch_has_the_bytes_that_it_has_alone(thread_count):
    together = flow.batch(list(setups()), 0.35, thread_count=thread_count, progress=False)
    for setup, sim in zip(setups(), together, strict=True):
        alone = flow.Simulation(setup, thread_count=1)
        alone.run(0.35, progress=False)
        assert len(alone.record.time) > 2
        for mine, other in zip(state(sim), state(alone), strict=True):
            np.testing.assert_array_equal(mine, other)


def in_turn(sims, steps):
    """Advance flows in lockstep, each by one step after the other."""
    for _ in range(steps):
        for sim in sims:
            sim.advance()


def test_flows_that_take_turns_have_the_bytes_that_they_have_alone():
    sims = [flow.Simulation(setup, thread_count=1) for setup in setups()]
    in_turn(sims, 6)
    for setup, sim in zip(setups(), sims, strict=True):
        alone = flow.Simulation(setup, thread_count=1)
        in_turn([alone], 6)
        for mine, other in zip(state(sim), state(alone), strict=True):
            np.testing.assert_array_equal(mine, other)


def test_flows_that_share_their_sides_would_be_noticed():
    sims = [flow.Simulation(setup, thread_count=1) for setup in (STILL, replace(STILL, viscosity=0.05))]
    sims[1].water.border.induced = sims[0].water.border.induced
    in_turn(sims, 3)
    alone = flow.Simulation(STILL, thread_count=1)
    in_turn([alone], 3)
    assert np.abs(sims[0].water.velocity - alone.water.velocity).max() > 1e-4


def test_a_batch_can_be_continued_and_watched_flow_by_flow():
    seen = []
    batch = flow.batch(
        [STILL, replace(STILL, viscosity=0.05)], 0.4, watch=lambda index, sim: seen.append((index, sim.time)),
        watch_interval=0.2, thread_count=1, progress=False,
    )  # fmt: skip
    assert [index for index, _ in seen] == [0, 0, 1, 1]
    assert all(0.2 <= time < 0.4 for _, time in seen[::2])
    assert [time for _, time in seen[1::2]] == [0.4, 0.4]
    batch[1].run(0.6, progress=False)
    alone = flow.Simulation(replace(STILL, viscosity=0.05), thread_count=1)
    alone.run(0.4, progress=False)
    alone.run(0.6, progress=False)
    np.testing.assert_array_equal(batch[1].water.velocity, alone.water.velocity)


@pytest.mark.parametrize(
    ("other", "text"),
    [
        (
            replace(STILL, grid=replace(GRID, cells=(64, 32))),
            r"flow 1 of the batch has 64 x 32 cells in single precision, and flow 0 has 48 x 32 cells",
        ),
        (replace(STILL, precision="double"), r"flow 1 .* in double precision, and flow 0 .* in single precision"),
    ],
)
def test_flows_of_unequal_size_are_refused_before_anything_is_computed(other, text):
    with pytest.raises(InvalidDesign, match=text) as caught:
        flow.batch([STILL, other], 1.0)
    assert "Call batch once for each grid" in str(caught.value)


def test_no_flow_no_time_and_no_thread_are_refused():
    with pytest.raises(InvalidDesign, match="the batch has no flow"):
        flow.batch([], 1.0)
    for end_time in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(OutsideLimits, match="give a finite time above 0"):
            flow.batch([STILL], end_time)
    with pytest.raises(OutsideLimits, match="use 0 threads"):
        flow.batch([STILL], 1.0, thread_count=0)


@pytest.mark.parametrize("thread_count", [1, 2])
def test_the_flow_that_cannot_go_on_is_named(thread_count):
    leaving = flow.Body(shape=flow.Cylinder(diameter=1.0), motion=flow.Glide(start=(2.5, 0.0), velocity=(2.0, 0.0)))
    with pytest.raises(InvalidDesign, match=r"^flow 1 of the batch: at t = .*outside the grid"):
        flow.batch([STILL, replace(STILL, bodies=(leaving,))], 3.0, thread_count=thread_count, progress=False)
    outside = flow.Body(shape=flow.Cylinder(diameter=1.0), motion=flow.Pose(position=(9.0, 0.0)))
    with pytest.raises(InvalidDesign, match=r"^flow 1 of the batch: "):
        flow.batch([STILL, replace(STILL, bodies=(outside,))], 3.0, thread_count=thread_count, progress=False)

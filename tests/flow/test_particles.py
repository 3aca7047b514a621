"""Several free bodies: a pair that drafts, kisses and tumbles, and a bed of discs on a floor."""

from itertools import combinations

import numpy as np
import pytest

from suchus import flow

CELLS = 8
"""Cells a diameter [-]."""


def gaps(record, first, second, diameter):
    """Distance between the skins of two discs over time [cells]."""
    x, y = (record.column(axis, first) - record.column(axis, second) for axis in ("x", "y"))
    return (np.hypot(x, y) - diameter) * CELLS / diameter


def test_a_pair_drafts_kisses_and_tumbles():
    """Two discs one above the other, in cm, g and s; the pair of Feng and Michaelides 2004, J. Comput. Phys. 195."""
    diameter, density, gravity = 0.2, 1.01, 981.0
    cell, sides = diameter / CELLS, flow.Sides.box()
    grid = flow.Grid.covering((0.0, 2.0), (0.0, 8.0), cell=cell, sides=sides)
    discs = tuple(
        flow.FreeBody(shape=flow.Cylinder(diameter=diameter), start=start, density=density, gravity=(0.0, -gravity),
                      name=name)
        for name, start in (("upper", (0.999, 7.2)), ("lower", (1.0, 6.8)))
    )  # fmt: skip
    weight = (density - 1) * gravity * np.pi / 4 * diameter
    contact = flow.BodyContact(gap=2.5 * cell, pressure=20 * weight)
    setup = flow.Setup(grid=grid, viscosity=0.01, bodies=discs, sides=sides, contact=contact)
    record = flow.Simulation(setup).run(2.4, progress=False)
    time, gap = record.time, gaps(record, 0, 1, diameter)
    speeds = [-record.column("velocity_y", k) for k in (0, 1)]
    kiss = int(np.argmax(gap < 2.5))
    drafting = slice(int(np.searchsorted(time, 0.4)), kiss)
    assert 0.9 < time[kiss] < 1.2
    assert (speeds[0][drafting] > speeds[1][drafting]).all()  # in the wake of the lower one
    assert (np.diff(gap[drafting]) < 0).all()
    assert speeds[0][kiss] > 1.2 * speeds[1][kiss]
    together = gap[kiss : int(np.searchsorted(time, 2.0))]
    assert 1.0 < together.min() < together.max() < 2.5
    height = record.column("y", 0) - record.column("y", 1)
    assert height[kiss] > 0.9 * diameter
    assert height[-1] < 0.0  # it has come past the other
    assert gap[-1] > 2.5


@pytest.mark.slow("more than ten seconds: the fall of twenty discs")
def test_twenty_discs_make_a_bed_on_a_floor():
    sides, cell, generator = flow.Sides.box(), 1 / CELLS, np.random.default_rng(3)
    starts = [
        (0.9 + 1.4 * (k % 4) + 0.12 * generator.uniform(-1, 1), 2.0 + 1.75 * (k // 4) + 0.1 * generator.uniform(-1, 1))
        for k in range(20)
    ]
    discs = tuple(
        flow.FreeBody(shape=flow.Cylinder(diameter=1.0), start=start, density=2.0, gravity=(0.0, -1.0), name=f"{k}")
        for k, start in enumerate(starts)
    )
    setup = flow.Setup(
        grid=flow.Grid(cells=(48, 96), cell=cell), viscosity=0.02, bodies=discs, sides=sides, coarse=True,
        contact=flow.BodyContact(gap=2.5 * cell, pressure=30.0),
    )  # fmt: skip
    sim = flow.Simulation(setup)
    record = sim.run(45.0, progress=False)
    assert min(gaps(record, a, b, 1.0).min() for a, b in combinations(range(20), 2)) > 0.5
    heights, speeds = (
        np.array([record.column(name, k) for k in range(20)]) for name in ("y", "velocity_y")
    )  # fmt: skip
    assert (heights[:, -1] - 0.5).min() > 0.5 * cell
    assert heights[:, -1].max() < 5.5  # four or five in a row
    assert np.abs(speeds[:, -1]).max() < 0.2 * np.abs(speeds).max()

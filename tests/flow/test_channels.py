"""Long channels: as wide as asked for, and solved in as few iterations as short ones."""

import numpy as np
import pytest

from suchus import flow
from suchus.core.errors import InvalidDesign

WALLS = {"bottom": flow.Wall(), "top": flow.Wall()}


def channel(length):
    """Water that enters as it flows in a channel of width 1."""
    sides = flow.Sides(left=flow.Inflow(profile=lambda y: 6 * y * (1 - y)), right=flow.Outflow(), **WALLS)
    grid = flow.Grid.covering((0.0, length), (0.0, 1.0), cell=1 / 8)
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=0.1, sides=sides))
    sim.run(2.0, progress=False)  # friction takes 1 / (pi^2 viscosity) = 1 s
    return sim


@pytest.mark.parametrize("length", [3.0, 10.0, 40.0, 120.0])
def test_a_channel_is_as_wide_as_asked_for(length):
    grid = flow.Grid.covering((0.0, length), (0.0, 1.0), cell=1 / 32)
    assert grid.size[1] == pytest.approx(1.0)
    assert length <= grid.size[0] < 1.1 * length + 1.0


def test_pressure_falls_in_a_long_channel_as_in_a_short_one():
    """Poiseuille's 12 viscosity U / width^2 in the middle of the channel, and hardly more iterations."""
    slopes, cycles = [], []
    for length in (6.0, 40.0):
        sim = channel(length)
        middle = len(sim.setup.grid.x) // 2
        line = sim.pressure[:, middle - 8 : middle + 9].mean(axis=0)
        slopes.append(float(line[0] - line[-1]) / 2.0)
        cycles.append(float(sim.record.cycles[5:].mean()))
    assert slopes[1] == pytest.approx(slopes[0], rel=2e-3)
    assert slopes[1] == pytest.approx(1.2, rel=0.03)
    assert cycles[1] < 2 * cycles[0] + 1


@pytest.mark.parametrize("cells", [(100, 90), (501, 300), (34, 1030)])
def test_what_cannot_be_halved_and_is_no_channel_is_refused_with_cells_that_can(cells):
    with pytest.raises(InvalidDesign, match="cannot be halved down to 32 cells a side") as said:
        flow.Grid(cells=cells, cell=0.1)
    words = str(said.value).split("take ")[1].split(",")[0].split(" x ")
    fitting = flow.Grid(cells=tuple(int(word) for word in words), cell=0.1)
    assert all(np.array(fitting.cells) >= cells)


def test_a_channel_that_is_too_long_is_refused():
    flow.Grid(cells=(8 * 512, 32), cell=0.1)
    with pytest.raises(InvalidDesign, match="cannot be halved"):
        flow.Grid(cells=(8 * 520, 32), cell=0.1)

"""Going on with a flow on a finer grid."""

from dataclasses import replace

import numpy as np
import pytest

from suchus import flow
from suchus.atlas import refined
from suchus.errors import InvalidDesign
from suchus.flow.compiled import PAD


def setup(cells, height=2.0):
    return flow.Setup(grid=flow.Grid.covering((-1.0, 3.0), (-1.0, height - 1.0), cell=1 / cells), viscosity=0.1)


def test_a_linear_flow_stays_itself():
    coarse = flow.Simulation(setup(8))
    grid, (ny, nx) = coarse.setup.grid, coarse.water.u.shape
    rates = {"u": (0.3, -0.7), "v": (0.9, 0.2), "p": (-0.4, 0.6)}

    def linear(name, grid, shape):
        x = grid.faces(0, shape[1], 0) if name == "u" else grid.centres(0, shape[1], 0)
        y = grid.faces(0, shape[0], 1) if name == "v" else grid.centres(0, shape[0], 1)
        return 1 + rates[name][0] * x[None, :] + rates[name][1] * y[:, None]

    for name in rates:
        getattr(coarse.water, name)[:] = linear(name, grid, (ny, nx))
    fine = refined(coarse, setup(16))
    inner = np.s_[PAD:-PAD, PAD:-PAD]
    for name in rates:
        field = getattr(fine.water, name)
        assert field[inner] == pytest.approx(linear(name, fine.setup.grid, field.shape)[inner], abs=2e-6)
    assert fine.time == 0


def test_a_refined_flow_runs_on_from_where_the_other_was():
    stream = {"stream": (1.0, 0.0), "bodies": (flow.Body(shape=flow.Cylinder(diameter=0.5)),)}
    coarse = flow.Simulation(replace(setup(8), **stream))
    coarse.run(0.5, progress=False)
    fine = refined(coarse, replace(setup(16), **stream))
    fine.run(0.2, progress=False)
    behind = (1.0, 0.0)
    slowed = fine.probe(behind).velocity[0, 0]
    assert slowed == pytest.approx(coarse.probe(behind).velocity[0, 0], abs=0.15)
    assert slowed < 0.9


def test_grids_of_other_places_are_refused():
    with pytest.raises(InvalidDesign, match="give both the same corners"):
        refined(flow.Simulation(setup(8)), setup(16, height=4.0))

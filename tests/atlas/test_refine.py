"""Going on with a flow on a finer grid."""

from dataclasses import replace

import numpy as np
import pytest

from evidence.atlas import refined
from suchus import flow
from suchus.core.errors import InvalidDesign
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


def nested(ratio, near=((-0.5, 1.5), (-0.5, 0.5))):
    whole = flow.Grid.covering((-1.0, 3.0), (-1.0, 1.0), cell=1 / 16)
    return flow.Setup(grid=whole.patch(*near, ratio=ratio), coarse_grid=whole, viscosity=0.1)


def test_a_patch_begins_with_what_the_other_patch_holds_and_around_it_with_the_coarser_water():
    """Linear velocities, with a jump at the sides of the first patch that tells which of the two was read."""
    coarse = flow.Simulation(nested(2, ((-0.5, 0.5), (-0.5, 0.5))))
    for layer, jump in zip(coarse.water.layers, (1.0, 0.0), strict=True):
        x = layer.grid.faces(0, layer.u.shape[1], 0)
        layer.u[:] = 0.3 * x[None, :] + jump
    fine = refined(coarse, nested(4))
    patch, first = fine.water, coarse.water.grid
    x, y = patch.grid.faces(0, patch.u.shape[1], 0), patch.grid.centres(0, patch.u.shape[0], 1)
    ends = [(low, low + size) for low, size in zip(first.origin, first.size, strict=True)]
    inside = [(at > low + first.cell) & (at < high - first.cell) for at, (low, high) in zip((x, y), ends, strict=True)]
    outside = (x > ends[0][1] + first.cell) & (x < patch.grid.origin[0] + patch.grid.size[0])
    rows = (y > patch.grid.origin[1]) & (y < patch.grid.origin[1] + patch.grid.size[1])
    assert inside[0].sum() > 20
    assert outside.sum() > 20
    assert patch.u[np.ix_(inside[1], inside[0])] == pytest.approx(
        np.broadcast_to(0.3 * x[inside[0]] + 1.0, (inside[1].sum(), inside[0].sum())), abs=1e-5
    )
    assert patch.u[np.ix_(rows, outside)] == pytest.approx(
        np.broadcast_to(0.3 * x[outside], (rows.sum(), outside.sum())), abs=1e-5
    )

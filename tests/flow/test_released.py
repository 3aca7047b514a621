"""Bodies that are released, pushed or set in motion: how long their steps are, and how they begin to move."""

import numpy as np
import pytest

from suchus import flow
from suchus.core.errors import OutsideLimits
from suchus.flow.compiled import PAD

CELL = 1 / 12
PLANE = flow.Grid.covering((-2.0, 2.0), (-3.0, 2.0), cell=CELL)
SPACE = flow.Grid.covering((-1.2, 1.2), (-1.2, 1.2), (-1.2, 1.2), cell=0.1)
CIRCLE = flow.Cylinder(diameter=1.0)


def water(body, grid=PLANE, *, viscosity=1e-3, **options):
    return flow.Simulation(flow.Setup(grid=grid, viscosity=viscosity, bodies=(body,), coarse=True, **options))


def accelerations(record, column="velocity_y"):
    return np.diff(record.column(column), prepend=0.0) / record.step


@pytest.mark.parametrize(("density", "viscosity"), [(0.02, 1e-6), (0.5, 1e-4), (2.0, 1e-6), (7.8, 1e-3)])
def test_a_released_cylinder_begins_with_its_weight_over_its_mass_and_added_mass(density, viscosity):
    """Potential flow: the added mass of a circle is the mass of its water. No later step accelerates it more."""
    body = flow.FreeBody(shape=CIRCLE, density=density, gravity=(0.0, -1.0))
    sim = water(body, viscosity=viscosity)
    exact = -(density - 1) / (density + 1)
    for _ in range(6):
        sim.advance()
    gained = accelerations(sim.record) / exact
    assert gained[:2] == pytest.approx(1.0, abs=0.06)
    assert gained.max() < 1.02
    assert np.abs(sim.record.column("velocity_x")).max() < 1e-3 * np.abs(sim.record.column("velocity_y")).max()


@pytest.mark.parametrize(("density", "until"), [(0.02, 0.6), (2.0, 1.5)])
def test_a_long_run_of_a_released_body_moves_it(density, until):
    """Each of its first steps moves it by a cell at most; friction takes less than a quarter of the way."""
    sim = water(flow.FreeBody(shape=CIRCLE, density=density, gravity=(0.0, -1.0)), viscosity=1e-4)
    record = sim.run(until, progress=False)
    exact = -(density - 1) / (density + 1) * until**2 / 2
    assert 0.75 < record.column("y")[-1] / exact < 1.0
    assert np.abs(np.diff(record.column("y"), prepend=0.0)).max() < CELL
    assert np.abs(record.column("velocity_y") * record.step).max() < 0.81 * CELL


def test_a_sphere_begins_to_fall_with_half_of_its_water_in_space():
    body = flow.FreeBody(shape=flow.Sphere(diameter=1.0), density=2.0, gravity=(0.0, 0.0, -1.0))
    sim = water(body, SPACE, viscosity=1e-6)
    for _ in range(2):
        sim.advance()
    assert accelerations(sim.record, "velocity_z") == pytest.approx(-1 / 2.5, rel=0.02)


def test_a_body_that_is_pushed_later_takes_short_steps_then():
    """Still water allows a step of 2.8 s; the force begins after one."""
    body = flow.FreeBody(shape=CIRCLE, force=lambda time, state: (0.0, -float(time > 1.0), 0.0))
    sim = water(body, viscosity=1e-3)
    assert sim.next_step() < 1.0
    sim.run(1.8, progress=False)
    way = np.diff(sim.record.column("y"), prepend=0.0)
    assert np.abs(way).max() < CELL
    assert sim.record.column("y")[-1] == pytest.approx(-0.5 * 0.8**2 / (np.pi / 2), rel=0.25)


def late(time):
    """At rest for a second, then with an acceleration of 1 m/s^2."""
    rest = max(time - 1.0, 0.0)
    return flow.Pose(position=(0.0, -0.5 * rest**2), velocity=(0.0, -rest))


def test_a_given_motion_that_begins_later_takes_short_steps_then():
    sim = water(flow.Body(shape=CIRCLE, motion=late), viscosity=1e-3)
    record = sim.run(1.8, progress=False)
    assert np.abs(np.diff(record.column("y"), prepend=0.0)).max() <= CELL
    assert len(record.time) > 6


def test_links_that_begin_to_move_later_take_short_steps_then():
    def links(time):
        rest = max(time - 1.0, 0.0)
        matrix = np.stack([np.eye(3), flow.Pose(angle=rest**2).matrix])
        spin = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 2 * rest]])
        return flow.LinkStates(np.zeros((2, 3)), matrix, np.zeros((2, 3)), spin)

    rod = flow.Spherocylinder(length=0.5, radius=0.2)
    shape = flow.Linked(pieces=tuple(flow.LinkPiece(link=k, shape=rod) for k in range(2)), motion=links)
    sim = water(flow.Body(shape=shape), SPACE)
    for _ in range(3):
        sim.advance()
    assert sim.time > 1.0
    turned = max(sim.time - 1.0, 0.0) ** 2
    assert turned * shape.bounding_radii[1] <= SPACE.cell


def test_a_fixed_step_that_is_too_long_for_a_released_body_is_refused():
    body = flow.FreeBody(shape=CIRCLE, density=2.0, gravity=(0.0, -1.0))
    sim = water(body, step=1.5)
    with pytest.raises(OutsideLimits, match=r"a body accelerates so fast that it moves by more than a cell.*at most 0"):
        sim.advance()
    allowed = water(body, step=0.2)
    allowed.advance()
    assert allowed.time == 0.2


def test_a_light_body_that_nothing_pushes_stays():
    sim = water(flow.FreeBody(shape=CIRCLE, density=0.02))
    sim.advance()
    assert sim.record.column("y").tolist() == [0.0]


@pytest.mark.parametrize("grid", [flow.Grid(cells=(24, 24), cell=0.1), flow.Grid(cells=(24, 24, 24), cell=0.1)])
def test_a_body_as_near_as_it_may_be_to_the_low_sides_uses_no_undefined_numbers(grid):
    """The window reaches the sides, through which no flux of momentum is computed."""
    centre, shape = 1.05, CIRCLE if grid.ndim == 2 else flow.Sphere(diameter=1.0)
    body = flow.Body(shape=shape, motion=flow.Pose(position=(centre,) * grid.ndim))
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=0.01, stream=(1.0, 0.5), bodies=(body,), coarse=True))
    sim.advance()
    assert sim.water.window[::2] == (PAD,) * grid.ndim
    for axis, component in enumerate(sim.water._raw):
        assert (np.moveaxis(component, grid.ndim - 1 - axis, 0)[0] == 0).all()
        assert np.isfinite(component).all()

"""Bodies near walls and floors: added mass, mirror images, the film of water, contact, landing, and what is refused."""

import re

import numpy as np
import pytest

from suchus import flow
from suchus.core.errors import Doubtful, InvalidDesign
from suchus.flow import contact
from suchus.flow.sides import NAMES

CIRCLE = flow.Cylinder(diameter=1.0)


def beside(distance):
    """A pose in which a circle's surface is so far above y = 0 [m]."""
    return flow.Pose(position=(0.0, 0.5 + distance))


# --- water between a body and a wall ---------------------------------------------------------------------------


def images(height, radius=0.5):
    """Added mass of a circle beside a wall over that of its water: the series of image doublets."""
    place, strength, total = 0.0, 1.0, 1.0
    for _ in range(4000):
        distance = 2 * height - place
        place, strength = radius**2 / distance, strength * (radius / distance) ** 2
        total += 2 * strength
    return total


def test_the_series_of_images_is_that_of_a_circle_that_touches_the_wall():
    assert images(0.5) == pytest.approx(np.pi**2 / 3 - 1, rel=1e-3)


@pytest.mark.parametrize("side", ["bottom", "top", "left", "right"])
@pytest.mark.parametrize("gap", [4.0, 2.0])
def test_added_mass_beside_a_wall_is_that_of_the_images(side, gap):
    """On 16 cells a diameter, the gap in cells; the other sides are 4 diameters away."""
    cell, inward = 1 / 16, 1 if side in ("bottom", "left") else -1
    axis = 0 if side in ("left", "right") else 1
    ends = [(-4.0, 4.0), (-4.0, 4.0)]
    ends[axis] = (0.0, 6.0) if inward > 0 else (-6.0, 0.0)
    sides = flow.Sides(**{side: flow.Slip()})
    grid = flow.Grid.covering(*ends, cell=cell, sides=sides)
    position = [0.0, 0.0]
    position[axis] = inward * (0.5 + gap * cell)
    body = flow.Body(shape=CIRCLE, motion=flow.Pose(position=tuple(position)))
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1e-9, bodies=(body,), sides=sides, coarse=True))
    outline = CIRCLE.markers(0.0, body.motion, cell)
    mass = flow.added_mass(sim.water, outline, tuple(position), 1.0) / (np.pi / 4)
    exact = images(0.5 + gap * cell)
    assert np.diag(mass)[:2] == pytest.approx(exact, rel=0.03)
    assert abs(mass[0, 1]) < 1e-3


@pytest.mark.parametrize("gap", [3.0, 1.0])
def test_beside_a_wall_without_friction_there_is_the_flow_of_two_bodies(gap):
    """A body whose mirror image is a second body, in the plane: the half has the forces of the whole."""
    cell, end = 1 / 12, 2.5

    def moving(sense):
        def pose(time):
            swing, rate = 0.05 * np.sin(3 * time), 0.15 * np.cos(3 * time)
            height = 0.5 + gap * cell + 0.05
            return flow.Pose(
                position=(0.3 * time, sense * (height + swing)), velocity=(0.3, sense * rate), angle=sense * 0.4 * time,
                spin=sense * 0.4,
            )  # fmt: skip

        return pose

    shape = flow.Cylinder(diameter=1.0)
    open_sides = flow.Sides(**dict.fromkeys(NAMES, flow.Stream(unbounded=False)))
    half_sides = flow.Sides(**{**dict.fromkeys(NAMES, flow.Stream(unbounded=False)), "bottom": flow.Slip()})
    records = []
    for sides, low, senses in ((half_sides, 0.0, (1,)), (open_sides, -end, (1, -1))):
        grid = flow.Grid(cells=(48, round((end - low) / cell) // 2 * 2), cell=cell, origin=(-2.0, low))
        bodies = tuple(flow.Body(shape=shape, motion=moving(s), name=f"{s}") for s in senses)
        setup = flow.Setup(
            grid=grid, viscosity=0.01, bodies=bodies, sides=sides, coarse=True, step=0.05, tolerance=1e-6
        )  # fmt: skip
        records.append(flow.Simulation(setup).run(0.5, progress=False))
    half, whole = records
    for column in ("force_x", "force_y", "torque"):
        values = whole.column(column, "1")
        assert half.column(column, "1") == pytest.approx(values, abs=3e-3 * np.abs(values).max() + 1e-6), column


def squeezed(gap, *, cells=16, along=False):
    """Force on a circle that moves slowly to a wall, or along it, over the exact one of Stokes flow [-].

    Jeffrey and Onishi 1981, Q. J. Mech. Appl. Math. 34, 129-137. The gap is in cells.
    """
    cell, speed, viscosity = 1 / cells, 1e-3, 1.0
    height = 0.5 + gap * cell
    sides = flow.Sides(bottom=flow.Wall())
    grid = flow.Grid.covering((-2.0, 2.0), (0.0, 3.0), cell=cell, sides=sides)
    velocity = (speed, 0.0) if along else (0.0, -speed)

    def motion(time):
        return flow.Pose(position=(velocity[0] * time, height + velocity[1] * time), velocity=velocity)

    body = flow.Body(shape=CIRCLE, motion=motion)
    setup = flow.Setup(grid=grid, viscosity=viscosity, bodies=(body,), sides=sides, courant=1.0)
    record = flow.Simulation(setup).run(0.25, progress=False)
    alpha = np.arccosh(height / 0.5)
    exact = 4 * np.pi * viscosity * speed / (alpha if along else alpha - np.tanh(alpha))
    return float(np.hypot(*record.force()[-20:].mean(axis=0)) / exact)


def test_the_film_below_a_body_that_comes_down_is_resolved_down_to_two_cells():
    """Lubrication as the grid resolves it: the force on a circle that is moved towards a wall."""
    assert squeezed(4.0) == pytest.approx(1.0, abs=0.15)
    assert squeezed(2.0) == pytest.approx(1.0, abs=0.3)


# --- contact ---------------------------------------------------------------------------------------------------


def pushed(shape, pose, sides, grid, law):
    outline = shape.markers(0.0, pose, grid.cell)
    return contact.forces(law, [outline], [np.array(pose.position)], contact.wall_planes(sides, grid))[0]


def test_only_walls_push_and_each_pushes_into_the_water():
    law = flow.BodyContact(gap=0.2, pressure=10.0)
    grid = flow.Grid(cells=(20, 20), cell=0.1)
    sides = flow.Sides(left=flow.Wall(), right=flow.Slip(), bottom=flow.Wall())
    planes = contact.wall_planes(sides, grid)
    assert [plane.name for plane in planes] == ["left", "right", "bottom"]
    for position, sign in (((0.6, 1.0), (1, 0)), ((1.4, 1.0), (-1, 0)), ((1.0, 0.6), (0, 1)), ((1.0, 1.4), (0, 0))):
        force = pushed(CIRCLE, flow.Pose(position=position), sides, grid, law)
        assert np.sign(np.round(force[:2], 9)).tolist() == list(sign)
        assert abs(force[2]) < 1e-9
    assert (pushed(CIRCLE, flow.Pose(position=(1.0, 0.71)), sides, grid, law) == 0).all()


def test_a_plate_on_a_floor_feels_the_pressure_of_the_law_and_turns_where_one_end_is_lower():
    law = flow.BodyContact(gap=0.1, pressure=50.0)
    grid = flow.Grid(cells=(60, 20), cell=0.1, origin=(-3.0, 0.0))
    sides, plate = flow.Sides(bottom=flow.Wall()), flow.Plate(length=4.0, thick=0.4)
    force = pushed(plate, flow.Pose(position=(0.0, 0.25)), sides, grid, law)
    assert force[1] == pytest.approx(50.0 * 0.25 * 3.6, rel=0.06)
    tilted = pushed(plate, flow.Pose(position=(0.0, 0.24), angle=0.01), sides, grid, law)  # the right end is higher
    assert tilted[2] < -1.0


def test_bodies_in_space_are_pushed_alike_and_apart_and_by_a_floor():
    law, ball = flow.BodyContact(gap=0.2, pressure=10.0), flow.Sphere(diameter=1.0)
    direction = np.array([0.6, 0.0, 0.8])
    centres = [np.zeros(3), 1.1 * direction]
    outlines = [ball.markers(0.0, flow.Pose(position=tuple(centre)), 0.05) for centre in centres]
    one, other = contact.forces(law, outlines, centres)
    assert one[:3] == pytest.approx(-other[:3], abs=1e-9)
    # of two spheres: the integral of p (1 - d / gap)^2 over the cap, d = 0.1 + x^2 / (2 R) on each side of the middle
    assert other[:3] @ direction == pytest.approx(np.linalg.norm(other[:3]), rel=0.01)
    depth = 0.1 / 0.2
    assert np.linalg.norm(other[:3]) == pytest.approx(10.0 * 2 * np.pi * 0.25 * 0.2 * depth**3 / 3, rel=0.15)
    grid = flow.Grid(cells=(20, 20, 20), cell=0.1)
    floor = flow.Sides(low=flow.Wall())
    force = pushed(ball, flow.Pose(position=(1.0, 1.0, 0.6)), floor, grid, law)
    assert force[2] == pytest.approx(10.0 * 2 * np.pi * 0.5 * 0.2 * depth**3 / 3, rel=0.15)
    assert np.abs(np.delete(force, 2)).max() < 0.02 * force[2]


# --- landing ---------------------------------------------------------------------------------------------------


def landing(body, *, law, cell=1 / 8, until=4.0, viscosity=0.05, sides=None, width=2.0):
    sides = sides or flow.Sides(bottom=flow.Wall())
    grid = flow.Grid.covering((-width, width), (0.0, 3.0), cell=cell, sides=sides)
    setup = flow.Setup(grid=grid, viscosity=viscosity, bodies=(body,), sides=sides, contact=law, coarse=True)
    sim = flow.Simulation(setup)
    return sim, sim.run(until, progress=False)


def test_a_disc_lands_on_a_floor_and_rests_where_the_contact_bears_its_weight():
    law = flow.BodyContact(gap=0.3, pressure=20.0)
    body = flow.FreeBody(shape=CIRCLE, start=(0.0, 1.2), density=1.5, gravity=(0.0, -1.0))
    sim, record = landing(body, law=law, until=10.0, viscosity=0.2)
    height = record.column("y") - 0.5
    assert height.min() > 0.125  # one cell
    assert abs(record.column("velocity_y")[-1]) < 0.01
    assert np.abs(record.column("x")).max() < 0.02
    outline = CIRCLE.markers(0.0, sim.pose("body"), 1 / 64)
    force = contact.forces(law, [outline], [np.array(sim.pose("body").position)], sim._walls)[0]
    assert force[1] == pytest.approx(0.5 * np.pi / 4, rel=0.1)


def test_ground_effect_slows_a_body_before_it_touches():
    """Far from the contact's gap, the film of water brakes: the fall is slower than the same one without a floor."""
    body = flow.FreeBody(shape=flow.Ellipse(length=1.0, width=0.45), start=(0.0, 0.8), density=1.5, gravity=(0.0, -1.0))
    law = flow.BodyContact(gap=0.26, pressure=40.0)
    _, above = landing(body, law=law, until=1.6)
    deep = flow.FreeBody(shape=body.shape, start=(0.0, 2.0), density=1.5, gravity=(0.0, -1.0))
    _, free = landing(deep, law=law, until=1.6)
    k = int(np.searchsorted(above.column("y")[::-1], 0.6))
    time = above.time[::-1][k]
    speed, free_speed = (np.interp(time, r.time, -r.column("velocity_y")) for r in (above, free))
    assert speed < 0.95 * free_speed


# --- bad input -------------------------------------------------------------------------------------------------


def test_a_body_that_is_thrown_through_a_floor_is_refused_with_the_contact_that_holds_it():
    def thrown(law):
        body = flow.FreeBody(shape=CIRCLE, start=(0.0, 1.2), density=20.0, velocity=(0.0, -3.0), gravity=(0.0, -1.0))
        return landing(body, law=law, until=0.6)

    with pytest.warns(Doubtful, match=r"body is .* cells from the bottom side: nearer than one cell"):  # noqa: SIM117
        with pytest.raises(InvalidDesign, match=r"body lies .* m deep in the bottom side, a Wall at y = 0 m") as caught:
            thrown(None)
    text = str(caught.value)
    assert "\n" not in text
    gap, pressure = map(float, re.search(r"BodyContact\(gap=([\d.]+), pressure=([\d.e+]+)\)", text).groups())
    _, record = thrown(flow.BodyContact(gap=gap, pressure=pressure))
    assert record.column("velocity_y").max() > 0  # it has turned round
    with pytest.warns(Doubtful), pytest.raises(InvalidDesign, match=r"whose pressure is now 0\.1 Pa"):
        thrown(flow.BodyContact(gap=gap, pressure=0.1))


def test_a_body_that_begins_in_a_floor_or_is_moved_through_it_is_refused():
    sides = flow.Sides(bottom=flow.Wall())
    grid = flow.Grid.covering((-2.0, 2.0), (0.0, 3.0), cell=1 / 8, sides=sides)

    def run(motion):
        body = flow.Body(shape=CIRCLE, motion=motion)
        flow.Simulation(flow.Setup(grid=grid, viscosity=0.05, bodies=(body,), sides=sides, coarse=True)).run(
            1.0, progress=False
        )

    with pytest.raises(InvalidDesign, match=r"t = 0 s body lies 0\.09.* m deep in the bottom side.*give a motion"):
        run(beside(-0.1))
    with pytest.warns(Doubtful, match="nearer than one cell"), pytest.raises(InvalidDesign, match="give a motion"):
        run(flow.Glide(start=(0.0, 1.0), velocity=(0.0, -1.0)))
    with pytest.raises(InvalidDesign, match="outside the grid"):
        run(flow.Pose(position=(0.0, -0.6)))


def test_open_sides_keep_their_distance_and_the_sentence_says_which_sides_need_none():
    grid = flow.Grid.covering((-2.0, 2.0), (0.0, 3.0), cell=1 / 8)
    body = flow.Body(shape=CIRCLE, motion=beside(0.3))
    with pytest.raises(InvalidDesign, match=r"on each open side\).*make the side a Wall\(\) or a Slip\(\)"):
        flow.Simulation(flow.Setup(grid=grid, viscosity=0.05, bodies=(body,), coarse=True))

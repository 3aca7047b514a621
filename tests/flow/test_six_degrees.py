"""Six degrees of freedom in space: tops, attitudes, shapes in any attitude, and free bodies in the water."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from test_limbed import bending
from test_trunk import eel, egg

from suchus import flow
from suchus.core import rotation
from suchus.core.errors import InvalidDesign, OutsideLimits
from suchus.flow.added import added_mass
from suchus.flow.swimmer import Swimmer

BRICK = flow.Ellipsoid(length=1.0, width=0.7, height=0.45)
SPHEROID = flow.Ellipsoid(length=1.0, width=0.5, height=0.5)
DISC = flow.Ellipsoid(length=1.0, width=1.0, height=0.1)  # a cell thick
TURNED = flow.Pose(
    position=(0.05, -0.02, 0.03), angle=0.4, pitch=-0.7, roll=1.1, velocity=(0.3, 0.2, 0.1), spin_x=0.5, spin_y=-0.4,
    spin=0.7,
)  # fmt: skip
NOTHING = 1e-12  # density of water that does nothing [kg/m^3]


def alone(body, dt, count, *, added=None):
    """Rotation matrices and rates of a body in water that answers with an added mass at most, step by step."""
    swimmer, matrices, rates = Swimmer.from_body(body), [], []
    if added is not None:
        swimmer.added_mass = added
    for k in range(count):
        swimmer.advance(k * dt, dt, NOTHING)
        if added is not None:
            swimmer.load = -added @ swimmer.acceleration
        matrices.append(rotation.turn(swimmer.coordinates[3:]))
        rates.append(swimmer.rate)
    return np.array(matrices), np.array(rates)


def spun(shape, spins, **more):
    return flow.FreeBody(shape=shape, density=1.0, spin_x=spins[0], spin_y=spins[1], spin=spins[2], **more)


def test_a_symmetric_top_precesses_as_eulers_solution():
    """About its angular momentum with L over the moment across, while it turns about its axis; second order."""
    start, spins = rotation.from_angles(0.3, 0.2, 0.1), np.array([0.8, 1.0, 0.2])
    turn = rotation.matrix(start)
    moments = SPHEROID.mass(0.0).moments
    along, across = moments[0, 0], moments[1, 1]
    momentum = turn @ moments @ turn.T @ spins
    rolls = (turn.T @ spins)[0] * (1 - along / across)
    off = []
    for count in (50, 100):
        found, rates = alone(spun(SPHEROID, spins, angle=0.3, pitch=0.2, roll=0.1), 4.0 / count, count)
        exact = rotation.turn(4.0 * momentum / across) @ turn @ rotation.turn(np.array([4.0 * rolls, 0.0, 0.0]))
        off.append(np.abs(found[-1] - exact).max())
        kept = np.array([m @ moments @ m.T @ r[3:] for m, r in zip(found, rates, strict=True)])
        assert np.abs(kept - momentum).max() < 1e-13 * np.abs(momentum).max()
        assert np.abs(found @ found.transpose(0, 2, 1) - np.eye(3)).max() < 1e-13
        assert rates[:, :3] == pytest.approx(0.0)
    assert off[1] < 3e-3
    assert off[0] / off[1] == pytest.approx(4.0, rel=0.05)


def test_a_body_that_turns_about_its_middle_axis_flips_over():
    """Dzhanibekov's effect, against Euler's equations in the body's frame; the energy does not drift."""
    moments, spins, dt, count = BRICK.mass(0.0).moments, np.array([0.01, 3.0, 0.02]), 0.02, 400

    def euler(_, w):
        return np.linalg.solve(moments, -np.cross(w, moments @ w))

    exact = solve_ivp(euler, (0.0, dt * count), spins, rtol=1e-10, atol=1e-12).y[:, -1]
    found, rates = alone(spun(BRICK, spins), dt, count)
    own = np.einsum("kji,kj->ki", found, rates[:, 3:])
    assert own[:, 1].max() > 2.9
    assert own[:, 1].min() < -2.9
    assert own[-1] == pytest.approx(exact, abs=0.06)
    energy = np.einsum("ki,ij,kj->k", own, moments, own)
    assert np.ptp(energy) < 2e-3 * energy[0]
    assert abs(energy[-50:].mean() / energy[:50].mean() - 1) < 1e-3


def test_springs_about_unequal_axes_neither_gain_nor_lose():
    """Kinetic energy and that of the springs, half the stiffness times the rotation vector squared, far from rest."""
    stiffness = np.array([2.0, 3.0, 5.0]) * BRICK.mass(0.0).moments.max()
    springs = (0.0, 0.0, 4.0, *stiffness)
    body = spun(BRICK, (0.9, -0.6, 0.5), springs=springs, anchor=(0.0, 0.0, 0.1, 0.5, -0.4, 0.6))
    dt, count, moments = 0.02, 300, BRICK.mass(0.0).moments
    swimmer, energy = Swimmer.from_body(body), []
    anchor = Rotation.from_euler("ZYX", [0.5, -0.4, 0.6])
    for k in range(count):
        swimmer.advance(k * dt, dt, NOTHING)
        turn = Rotation.from_matrix(rotation.turn(swimmer.coordinates[3:])) * anchor.inv()
        m = rotation.turn(swimmer.coordinates[3:])
        rate = m.T @ swimmer.rate[3:]
        energy.append(rate @ moments @ rate + stiffness @ turn.as_rotvec() ** 2)
    assert np.ptp(energy) < 5e-3 * energy[-1]
    height = swimmer.coordinates[2]
    assert abs(height) > 0
    assert swimmer.coordinates[:2] == pytest.approx(0.0)


@pytest.mark.parametrize("axis", range(6))
def test_a_damper_takes_what_it_should_in_each_degree_of_freedom(axis):
    added = np.diag([0.7, 0.9, 0.8, 0.2, 0.3, 0.25])
    mass = BRICK.mass(0.0)
    inertia = ([mass.volume] * 3 + np.diag(mass.moments).tolist())[axis] + added[axis, axis]
    rates = np.eye(6)[axis]
    body = spun(BRICK, rates[3:], velocity=tuple(rates[:3]), dampers=tuple(0.5 * inertia * rates))
    found = alone(body, 0.02, 100, added=added)[1]
    assert np.log(found[99, axis] / found[49, axis]) / (50 * 0.02) == pytest.approx(-0.5, rel=1e-3)
    assert np.abs(np.delete(found, axis, axis=1)).max() < 1e-12


def test_a_locked_degree_of_six_stays_to_the_byte():
    body = flow.FreeBody(
        shape=BRICK, start=(0.1, 0.7, -0.2), angle=0.3, density=3.0, free=(False, True, True, False, False, True),
        gravity=(1.0, -9.81, 2.0), spin=0.4, force=lambda time, state: (1.0, 2.0, state.spin, 3.0, 4.0, np.sin(time)),
    )  # fmt: skip
    swimmer = Swimmer.from_body(body)
    for k in range(30):
        swimmer.advance(0.01 * k, 0.01, 1.0)
        swimmer.added_mass, swimmer.load = 0.1 * np.ones((6, 6)) + np.eye(6), np.array([1.0, 0.2, -0.4, 0.1, 0.2, 0.3])
    assert swimmer.coordinates[[0, 3, 4]].tobytes() == np.array([0.1, 0.0, 0.0]).tobytes()
    assert swimmer.rate[[0, 3, 4]].tobytes() == np.zeros(3).tobytes()
    assert (np.abs(swimmer.rate[[1, 2]]) > 0.1).all()
    assert abs(swimmer.rate[5] - 0.4) > 1e-3


@pytest.mark.parametrize("shape", [BRICK, flow.Cylinder(diameter=1.0)])
def test_a_body_whose_turning_is_locked_keeps_its_spin_in_its_pose(shape):
    body = flow.FreeBody(shape=shape, spin=0.4, free=(True, True, False))
    swimmer = Swimmer.from_body(body)
    swimmer.advance(0.0, 0.1, 1.0)
    pose = swimmer.pose(shape.mass(0.0))
    assert pose.spin == 0.4
    assert pose.angle == pytest.approx(0.04)


def test_whole_turns_about_z_are_counted_and_their_spring_pulls_back_over_them():
    body = spun(BRICK, (0.0, 0.0, 9.0), springs=(0.0, 0.0, 0.0, 0.0, 0.0, 1e-3))
    swimmer = Swimmer.from_body(body)
    for k in range(200):
        swimmer.advance(0.01 * k, 0.01, NOTHING)
    assert 6 * np.pi > swimmer.pose(BRICK.mass(0.0)).angle > 4 * np.pi
    assert -swimmer._spring_force(swimmer.coordinates, np.array([0, 0, 0, 0, 0, 1.0]))[5] == pytest.approx(
        -swimmer.coordinates[5]
    )


def near(shape, pose, h, count=40):
    """Points of the world within two cells of a shape's skin."""
    rng = np.random.default_rng(1)
    skin = shape.markers(0.4, pose, 2 * h).points
    return (skin[:, rng.integers(0, skin.shape[1], count)] + rng.uniform(-2 * h, 2 * h, (3, count))).T


SHAPES = {
    "ellipsoid": BRICK, "sphere": flow.Sphere(diameter=0.8), "egg": egg(1.0, 0.3, 0.5), "eel": eel(cuts=(0.4,)),
    "limbed": bending(),
}  # fmt: skip


@pytest.mark.parametrize("name", SHAPES)
def test_a_shape_in_any_attitude_is_the_upright_one_seen_from_another_side(name):
    shape, h = SHAPES[name], 1 / 40
    matrix, still = TURNED.matrix, flow.Pose(position=(0.0, 0.0, 0.0))
    reached = 0
    for point in near(shape, TURNED, h):
        here, there = ([np.array([at, at + h]) for at in p] for p in (point, TURNED.to_body(point)))
        found, wanted = shape.measure(here, 0.4, TURNED, 3 * h), shape.measure(there, 0.4, still, 3 * h)
        at = (0, 0, 0)
        distance = float(wanted.distance[at])
        if abs(distance) > 2.9 * h:
            continue
        reached += 1
        assert found.distance[at] == pytest.approx(distance, abs=1e-9)
        normal, drift = ([float(part[at]) for part in vector] for vector in (wanted.normal, wanted.velocity))
        assert [float(part[at]) for part in found.normal] == pytest.approx(matrix @ normal, abs=1e-6)
        rigid = np.array(TURNED.velocity_at(point))
        assert [float(part[at]) for part in found.velocity] == pytest.approx(matrix @ drift + rigid, abs=1e-9)
        assert found.thickness[at] == pytest.approx(wanted.thickness[at], rel=1e-6)
        if wanted.part_index is not None:
            assert found.part_index[at] == wanted.part_index[at]
    assert reached > 20


@pytest.mark.parametrize("name", SHAPES)
def test_a_skin_in_any_attitude_moves_as_it_says_and_fills_its_bounds(name):
    shape, time, dt = SHAPES[name], 0.4, 1e-5

    def pose(t):
        turn = rotation.from_vector(TURNED.spins * (t - time))
        yaw, pitch, roll = rotation.angles(rotation.multiply(turn, rotation.from_angles(0.4, -0.7, 1.1)))
        place = np.array(TURNED.position) + (t - time) * np.array(TURNED.velocity)
        return replace(TURNED, position=tuple(place.tolist()), angle=yaw, pitch=pitch, roll=roll)

    early, now, late = (shape.markers(t, pose(t), 0.02) for t in (time - dt, time, time + dt))
    assert now.velocities == pytest.approx((late.points - early.points) / (2 * dt), abs=5e-4)
    bounds = np.array(shape.bounds(time, TURNED)).reshape(3, 2)
    low, high = now.points.min(axis=1), now.points.max(axis=1)
    assert (bounds[:, 0] <= low + 1e-9).all()
    assert (bounds[:, 1] >= high - 1e-9).all()
    assert np.abs(bounds.T - [low, high]).max() < 0.02
    upright = shape.markers(time, flow.Pose(position=(0.0, 0.0, 0.0)), 0.02)
    assert now.weight == pytest.approx(upright.weight)


def test_a_trunk_that_hardly_tilts_is_painted_as_the_upright_one():
    """Two ways of painting, one of them for bodies that turn about z alone."""
    shape, h = eel(cuts=(0.4,)), 1 / 32
    window = [np.arange(low, high, h) for low, high in ((-0.2, 1.2), (-0.3, 0.3), (-0.15, 0.15))]
    upright = flow.Pose(position=(0.05, 0.0, 0.01), angle=0.3, velocity=(0.1, 0.2, 0.3), spin=0.5)
    one, other = (shape.measure(window, 0.4, pose, 4 * h) for pose in (upright, replace(upright, roll=1e-9)))
    reached = np.abs(one.distance) < 3.5 * h
    assert reached.sum() > 500
    assert np.abs(one.distance - other.distance)[reached].max() < 1e-7
    skin = np.abs(one.distance) < 0.9 * h
    for a, b in zip((*one.normal, *one.velocity), (*other.normal, *other.velocity), strict=True):
        assert np.quantile(np.abs(a - b)[skin], 0.99) < 1e-5


@settings(max_examples=30)
@given(st.floats(-3, 3), st.floats(-1.5, 1.5), st.floats(-3, 3), st.tuples(*[st.floats(-2, 2)] * 3))
def test_a_pose_sees_the_points_that_it_places(yaw, pitch, roll, point):
    pose = flow.Pose(position=(0.1, 0.2, 0.3), angle=yaw, pitch=pitch, roll=roll)
    assert pose.to_body(pose.to_world(point)) == pytest.approx(point, abs=1e-12)
    assert pose.matrix == pytest.approx(Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_matrix(), abs=1e-12)


@pytest.mark.parametrize("shape", [eel(taper=False), bending()])
def test_the_tensor_of_inertia_is_that_of_what_the_body_fills(shape):
    """Of an eel of 1.2 cm a side and its limbs, from the points inside it."""
    time, h = 0.9, 0.012
    low, high = np.array(shape.bounds(time, flow.Pose(position=(0.0, 0.0, 0.0)))).reshape(3, 2).T
    window = [np.arange(a - 0.05, b + 0.05, h) for a, b in zip(low, high, strict=True)]
    inside = shape.measure(window, time, flow.Pose(position=(0.0, 0.0, 0.0)), 2 * h).distance < 0
    z, y, x = np.meshgrid(*window[::-1], indexing="ij")
    points = np.stack([x[inside], y[inside], z[inside]])
    mass, middle = shape.mass(time), points.mean(axis=1)
    assert mass.centre == pytest.approx(middle, abs=2e-3)
    second = (points - middle[:, None]) @ (points - middle[:, None]).T * h**3
    exact = np.trace(second) * np.eye(3) - second
    scale = np.abs(exact).max()
    assert np.abs(mass.moments - exact).max() < 0.02 * scale
    assert abs(mass.moments[0, 1]) > 1e-3 * scale
    assert mass.moments[0, 0] == pytest.approx(exact[0, 0], rel=0.04)


def water(body, *, cells=24, steps=0, thread_count=1, **changes):
    """A body in a box of 3 m, or a free one from rest, after some steps."""
    h = 3 / cells
    settings_ = {
        "grid": flow.Grid(cells=(cells,) * 3, cell=h, origin=(-1.5,) * 3), "viscosity": 0.02, "step": 0.2 * h,
        "bodies": (body,), "tolerance": 1e-6, "coarse": True,
    }  # fmt: skip
    sim = flow.Simulation(flow.Setup(**{**settings_, **changes}), thread_count=thread_count)
    for _ in range(steps):
        sim.advance()
    return sim


def added(shape, pose, **changes):
    sim = water(flow.Body(shape=shape, motion=pose), **changes)
    return added_mass(sim.water, shape.markers(0.0, pose, 0.1), pose.position, 1.0)


def test_the_added_mass_of_a_turned_spheroid_is_turned():
    """Along each of the three axes to rounding; obliquely to what 12 cells across carry; symmetric in any case."""
    still = flow.Pose(position=(0.0, 0.0, 0.0))
    first = added(SPHEROID, still)
    assert np.diag(first)[[1, 2, 4, 5]] == pytest.approx(np.diag(first)[[2, 1, 5, 4]], rel=1e-4)
    assert np.diag(first)[0] < 0.5 * np.diag(first)[1]
    assert np.abs(np.diag(first)[3]) < 0.1 * np.diag(first)[4]
    order = [1, 2, 0, 4, 5, 3]  # what was along z is along x
    upright = added(SPHEROID, replace(still, pitch=-np.pi / 2))
    assert upright[np.ix_(order, order)][1, 1] == pytest.approx(first[0, 0], rel=1e-4)
    assert np.diag(upright) == pytest.approx(np.diag(first)[[1, 1, 0, 4, 4, 3]], rel=1e-3, abs=1e-6)
    oblique = replace(still, angle=0.5, pitch=0.6, roll=0.3)
    matrix, found = oblique.matrix, added(SPHEROID, oblique)
    assert np.abs(found - found.T).max() < 1e-3 * found.max()
    turn = np.kron(np.eye(2), matrix)
    assert np.abs(found - turn @ first @ turn.T).max() < 0.05 * first.max()


def test_what_is_not_wanted_of_the_added_mass_is_not_computed(monkeypatch):
    sim = water(flow.FreeBody(shape=SPHEROID, free=(True, True, True)), sides=HELD)
    solves, potential = [], sim.water.potential
    monkeypatch.setattr(sim.water, "potential", lambda *given: solves.append(1) or potential(*given))
    skin = SPHEROID.markers(0.0, flow.Pose(position=(0.0, 0.0, 0.0)), 0.1)
    whole = added_mass(sim.water, skin, (0.0, 0.0, 0.0), 1.0)
    assert len(solves) == 6
    some = added_mass(sim.water, skin, (0.0, 0.0, 0.0), 1.0, 0, sim.swimmers["body"].is_free)
    assert len(solves) == 9
    kept = ~np.isnan(some)
    assert kept.sum() == 9
    assert some[kept] == pytest.approx(whole[kept], abs=1e-9)


HELD = flow.Sides(**dict.fromkeys(("left", "right", "bottom", "top", "low", "high"), flow.Stream(unbounded=False)))
COLUMNS = ("force_x", "force_y", "force_z"), ("x", "y", "z"), ("velocity_x", "velocity_y", "velocity_z")
TURNS = ("torque_x", "torque_y", "torque"), ("spin_x", "spin_y", "spin")


def test_the_axes_of_the_world_are_alike():
    """The whole set-up turned so that x becomes y, y z and z x: the record has the same numbers in other columns."""
    swap = np.roll(np.eye(3), 1, axis=0)
    start, speed, spins, pull = np.array([(0.1, -0.05, 0.02), (0.3, 0.1, -0.2), (1.0, 2.0, -1.5), (0.0, 0.5, -2.0)])
    turn, records = rotation.matrix(rotation.from_angles(0.3, 0.5, -0.4)), []
    for frame in (np.eye(3), swap):
        q = Rotation.from_matrix(frame @ turn).as_quat(scalar_first=True)
        yaw, pitch, roll = rotation.angles(q)
        body = spun(
            BRICK, frame @ spins, start=tuple(frame @ start), velocity=tuple(frame @ speed),
            gravity=tuple(frame @ pull), angle=yaw, pitch=pitch, roll=roll,
        )  # fmt: skip
        records.append(water(replace(body, density=1.5), steps=10).record)
    one, other = records
    for names in (*COLUMNS, *TURNS):
        a, b = (np.stack([record.column(name) for name in names], axis=1) for record in records)
        assert np.abs(b - a @ swap.T).max() < 2e-4 * np.abs(a).max(), names
    assert np.abs(one.torque()).max() > 0.01
    turns = [Rotation.from_quat(record.attitude(), scalar_first=True).as_matrix() for record in records]
    assert np.abs(turns[1] - swap @ turns[0]).max() < 1e-5
    assert np.abs(turns[0][-1] - turns[0][0]).max() > 0.02
    assert other.column("power") == pytest.approx(one.column("power"), rel=1e-3)


def test_a_sphere_that_is_dropped_falls_straight():
    """Along its weight, oblique to the grid, with its weight over its mass and added mass; it does not turn."""
    pull = np.array([1.0, 2.0, -2.0])
    ball = flow.FreeBody(shape=flow.Sphere(diameter=1.0), density=2.0, gravity=tuple(pull.tolist()))
    sim = water(ball, steps=6, viscosity=1e-6, step=0.01)
    speed = np.stack([sim.record.column(name) for name in COLUMNS[2]], axis=1)
    gained = speed[1] / (2 * 0.01)  # the wall's friction grows from step to step
    mass = np.diag(sim.swimmers["body"].added_mass)[:3] / (np.pi / 6)
    assert mass == pytest.approx(0.5, abs=0.06)
    assert gained == pytest.approx(pull / (2.0 + mass), rel=0.02)
    turned = np.stack([sim.record.column(name) for name in TURNS[1]], axis=1)
    assert np.abs(turned).max() < 1e-3 * np.abs(speed).max()


FLAT = flow.Ellipsoid(length=0.45, width=1.0, height=1.0)


@pytest.mark.parametrize(("shape", "pitch"), [(SPHEROID, 0.7), (SPHEROID, -0.7), (FLAT, 0.8)])
def test_a_spheroid_that_falls_obliquely_turns_broadside(shape, pitch):
    """Munk's moment: a long one turns its axis across its path, a flat one along; see Lamb 1932, art. 124."""
    body = flow.FreeBody(shape=shape, density=1.5, gravity=(0.0, 0.0, -1.0), velocity=(0.0, 0.0, -1.0), pitch=pitch)
    sim = water(body, steps=12)
    long = shape.length > shape.width
    spin = sim.record.column("spin_y")[-1]
    assert spin * pitch < 0 if long else spin * pitch > 0
    assert abs(sim.record.column("pitch")[-1] - pitch) > 1e-3
    assert np.abs([sim.record.column(name)[-1] for name in ("spin_x", "spin")]).max() < 0.01 * abs(spin)
    glide = sim.record.column("velocity_x")[-1]
    assert glide * pitch > 0 if long else glide * pitch < 0  # to where its lower end or edge is


@pytest.mark.parametrize(
    ("shape", "velocity"), [(BRICK, (0.5, -0.3, 0.4)), (BRICK, (0.0, 0.0, 0.0)), (DISC, (0.5, -0.3, 0.4))]
)
def test_body_and_water_keep_momentum_and_angular_momentum(shape, velocity):
    """A free body that tumbles in a periodic box: what it has and is owed, and what the water has, is kept.

    Angular momentum only as long as nothing of the flow has come to the sides: of a body that does not move along.
    """
    body = spun(shape, (1.5, -1.0, 2.0), velocity=velocity, angle=0.3, pitch=0.4, roll=0.2)
    body = replace(body, density=2.0)
    sim = water(body, cells=32, sides=flow.Sides.periodic(), viscosity=0.01)
    grid, swimmer = sim.setup.grid, sim.swimmers["body"]

    def held():
        """Momentum and angular momentum about the origin of the water beside the body, and of the body."""
        h, axes = grid.cell, range(3)
        cells = sim.water.velocity[:, 2:-2, 2:-2, 2:-2].astype(float)
        total = np.zeros(6)
        for c in axes:
            x, y, z = (
                np.meshgrid(*[(grid.faces if c == d else grid.centres)(2, 2 + grid.cells[d], d) for d in (2, 1, 0)],
                            indexing="ij")[2 - d] for d in axes
            )  # fmt: skip
            moved = np.zeros((3, *cells[c].shape))
            moved[c] = cells[c]
            total[:3] += moved.sum(axis=(1, 2, 3))
            total[3:] += np.cross(np.stack([x, y, z]), moved, axis=0).sum(axis=(1, 2, 3))
        inside = sim._log.region_contents[0, :6].copy()  # about the grid's corner, in cells
        inside[3:] = h * inside[3:] + np.cross(grid.origin, inside[:3])
        water_has = (total - inside) * h**3
        state, matrix = swimmer.rate, rotation.turn(swimmer.coordinates[3:])
        inertia = 2.0 * shape.mass(0.0).inertia(matrix)
        own = inertia @ state
        late = swimmer.span * (swimmer.load + swimmer.applied) + swimmer.residual_impulse - (own - swimmer.momentum)
        own = own + late
        own[3:] += np.cross(swimmer.coordinates[:3], own[:3])
        return water_has, own

    sim.advance()
    start = sum(held())
    scale = np.abs(held()[1])
    for _ in range(24):
        sim.advance()
    now, (water_has, _) = sum(held()), held()
    print(f"change {now - start}, of the water {water_has}, of the body {scale} at first")
    if any(velocity):
        assert np.abs(water_has[:3]).max() > 0.1 * scale[:3].max()
        assert np.abs(now - start)[:3].max() < 1e-3 * scale[:3].max()
    else:
        assert np.abs(water_has[3:]).max() > 0.02 * scale[3:].max()
        assert np.abs(now - start)[3:].max() < 0.01 * scale[3:].max()


def test_what_a_mirror_would_break_is_locked():
    """A body that may do all there is, cut by a mirror, moves as one with three degrees of freedom."""
    grid = flow.Grid(cells=(24, 24, 12), cell=1 / 8, origin=(-1.5, -1.5, 0.0))
    body = flow.FreeBody(shape=BRICK, density=2.0, gravity=(0.3, -1.0), angle=0.4)
    cut = {"grid": grid, "sides": flow.Sides(low=flow.Mirror()), "steps": 6}
    every, three = (water(replace(body, free=free), **cut) for free in (None, (True, True, True)))
    assert every.swimmers["body"].is_free.tolist() == [True, True, False, False, False, True]
    assert every.record.bodies.tobytes() == three.record.bodies.tobytes()
    whole = water(body, steps=6)
    assert whole.swimmers["body"].is_free.all()
    for name in ("velocity_x", "velocity_y", "spin"):
        assert whole.record.column(name)[-1] == pytest.approx(every.record.column(name)[-1], rel=2e-3, abs=1e-5)
    assert np.abs([whole.record.column(name) for name in ("z", "pitch", "roll")]).max() < 1e-5
    with pytest.raises(InvalidDesign, match=r"gravity of body is .* a Mirror across z cuts it"):
        water(replace(body, gravity=(0.0, 0.0, -1.0)), **cut)
    with pytest.raises(InvalidDesign, match=r"pitch 0.2 and roll 0 rad.*needs one of its axes along z"):
        water(replace(body, pitch=0.2), **cut)


def test_a_tumbling_body_goes_on_from_its_checkpoint_and_on_two_threads_to_the_same_bytes(tmp_path):
    body = spun(BRICK, (1.0, -2.0, 1.5), angle=0.3, pitch=0.4, gravity=(0.0, 0.1, -1.0))
    body = replace(body, density=1.4)
    kept = {"checkpoint": tmp_path / "a.npz", "progress": False}
    grid = flow.Grid(cells=(32, 24, 24), cell=1 / 8, origin=(-2.0, -1.5, -1.5))
    water(body, grid=grid).run(0.1, **kept)
    resumed, straight, two = (water(body, grid=grid, thread_count=n) for n in (1, 1, 2))
    resumed.run(0.25, **kept)
    for sim in (straight, two):
        for until in (0.1, 0.25):
            sim.run(until, progress=False)
    for sim in (resumed, two):
        assert sim.water.velocity.tobytes() == straight.water.velocity.tobytes()
        assert sim.record.bodies.tobytes() == straight.record.bodies.tobytes()
    flow.save_vti(straight, tmp_path / "field.vti")
    assert (tmp_path / "field.vti").stat().st_size > 4 * 8 * np.prod(grid.cells)


def test_the_grid_follows_a_body_that_sinks_along_z():
    body = flow.FreeBody(shape=BRICK, density=3.0, gravity=(0.0, 0.0, -5.0), velocity=(0.0, 0.0, -0.5))
    sim = water(body, follow="body", follow_axes=(False, False, True), steps=6)
    assert sim.frame[0, 2] < -0.05
    assert sim.frame[0, 2] == pytest.approx(sim.record.column("z")[-1], abs=1e-3)
    assert (sim.frame[0, :2] == 0).all()
    still = water(body, steps=6)
    assert still.record.column("velocity_z")[-1] == pytest.approx(sim.record.column("velocity_z")[-1], rel=0.03)


def test_the_record_has_a_column_and_a_unit_for_everything():
    record = water(spun(BRICK, (0.1, 0.2, 0.3)), steps=1).record
    assert record.units["torque_x"] == record.units["torque"] == "N m"
    assert record.units["spin_y"] == "rad s-1"
    assert record.units["pitch"] == record.units["roll"] == record.units["angle"] == "rad"
    assert set(record.units) == set(record.columns)
    assert record.torque().shape == (1, 3)
    plane = flow.Simulation(flow.Setup(grid=flow.Grid(cells=(16, 16), cell=1.0), viscosity=1.0, bodies=())).record
    with pytest.raises(OutsideLimits, match="no attitude but its angle"):
        plane.attitude()


def tumbling(rate):
    """A motion that turns about an oblique axis, and says that it does so with this rate."""

    def motion(time):
        axis = np.array([0.6, 0.0, 0.8])
        yaw, pitch, roll = rotation.angles(rotation.from_vector(2.0 * time * axis))
        still, (p, _, r) = (0.0, 0.0, 0.0), (rate * axis).tolist()
        return flow.Pose(position=still, velocity=still, angle=yaw, pitch=pitch, roll=roll, spin_x=p, spin=r)

    return motion


def test_a_body_may_be_turned_about_any_axis_and_its_spins_are_watched():
    sim = water(flow.Body(shape=BRICK, motion=tumbling(2.0)), steps=3)
    torque = sim.record.torque()[-1]
    assert torque @ [0.6, 0.0, 0.8] < 0
    assert sim.record.column("power")[-1] > 0
    with pytest.raises(
        InvalidDesign, match=r"gives the spin \(1\.8, 0, 2\.4\) rad/s, and its attitude changes by \(1\.2"
    ):
        water(flow.Body(shape=BRICK, motion=tumbling(3.0)))


@pytest.mark.parametrize(("changes", "said"), [
    ({"pitch": float("nan")}, "pitch, roll, spin_x and spin_y of body are nan rad"),
    ({"springs": (0.0, 0.0, 0.0, 0.0, -1.0, 0.0)}, "springs of body is .*none may be negative"),
    ({"free": (True, True)}, "free is .*; a tuple of 3"),
    ({"anchor": (0.0, 0.0, 0.0, 0.0, float("inf"), 0.0)}, "anchor of body is .*finite"),
])  # fmt: skip
def test_a_body_that_cannot_be_is_refused(changes, said):
    with pytest.raises(InvalidDesign, match=said):
        flow.FreeBody(shape=BRICK, **changes)


@pytest.mark.parametrize(("changes", "said"), [
    ({"gravity": (0.0, 0.0, -1.0)}, r"gravity of body is \(0.0, 0.0, -1.0\), and the grid has two axes; give two"),
    ({"free": (True,) * 6}, "free of body is .*give three"),
    ({"spin_x": 0.1}, "spin_x of body is 0.1, and the grid has two axes; there a body turns about z alone"),
])  # fmt: skip
def test_what_only_space_has_is_refused_in_the_plane(changes, said):
    body = flow.FreeBody(shape=flow.Cylinder(diameter=1.0), **changes)
    with pytest.raises(InvalidDesign, match=said):
        flow.Setup(grid=flow.Grid(cells=(16, 16), cell=1.0), viscosity=1.0, bodies=(body,))
    turned = flow.Body(shape=flow.Cylinder(diameter=1.0), motion=flow.Pose(roll=0.1))
    with pytest.raises(InvalidDesign, match=r"roll 0.1 rad .* in the plane a body has an angle and a spin alone"):
        flow.Setup(
            grid=flow.Grid(cells=(64, 64), cell=0.1, origin=(-3.2, -3.2)), viscosity=1.0, bodies=(turned,)
        ).check_bodies()


def test_a_force_of_the_wrong_length_says_when():
    swimmer = Swimmer.from_body(flow.FreeBody(shape=BRICK, force=lambda time, state: (1.0, 2.0, 3.0, 4.0)))
    with pytest.raises(InvalidDesign, match=r"the force of body at t = 0\.5 s .* or six numbers"):
        swimmer.advance(0.5, 0.01, 1.0)

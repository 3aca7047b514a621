"""Pressure and friction over the skin, control volumes and probes, alike in the plane and in space."""

from dataclasses import replace

import numpy as np
import pytest
from test_limbed import bending, straight
from test_space import ball

from suchus import flow
from suchus.flow.force import boundary_flux, momentum, sample
from suchus.flow.resolution import SKIN_SPHERE

G = np.array([[0.3, -1.2, 0.4], [0.9, 0.2, -0.7], [-0.5, 1.1, -0.5]])
"""Gradient of a velocity that is linear and free of divergence: G[c, d] = du_c / dx_d [1/s]."""
DROP = np.array([7.0, -2.0, 11.0])
"""Gradient of a pressure over density [m/s^2]."""
POSE = flow.Pose(position=(-0.4, -0.05, 0.07), angle=0.4, pitch=0.3, roll=-0.6)
SHAPES = {
    "ellipsoid": flow.Ellipsoid(length=0.9, width=0.4, height=0.6),
    "trunk": straight(()),
    "trunk with limbs": straight(),
    "bending": bending(),
}
DENSITY = 2.0


def linear(axes=3, gradient=G):
    """Water in which velocity and pressure are linear, without bodies."""
    grid = flow.Grid(cells=(24,) * axes, cell=1 / 8, origin=(-1.5,) * axes)
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=0.02, density=DENSITY, precision="double"))

    def at(slope, faces=None):
        lines = [(grid.faces if d == faces else grid.centres)(0, sim.water.p.shape[0], d) for d in range(axes)]
        return np.einsum("d,d...->...", slope[:axes], np.stack(np.meshgrid(*lines, indexing="ij")).T.T).T

    for c in range(axes):
        sim.water.velocity[c] = at(gradient[c], c)
    sim.water.p[:] = at(DROP)
    return sim


@pytest.mark.parametrize("shape", SHAPES.values(), ids=list(SHAPES))
def test_a_skin_is_closed_and_faces_the_water(shape):
    skin = shape.markers(0.3, POSE, 0.01)
    facing = skin.weight * skin.normals
    np.testing.assert_allclose(np.linalg.norm(skin.normals, axis=0), 1.0, atol=1e-12)
    assert np.abs(facing.sum(axis=1)).max() < 0.01 * skin.weight.sum()
    assert (facing * skin.points).sum() / 3 == pytest.approx(shape.mass(0.3).volume, rel=0.02)  # Gauss


@pytest.mark.parametrize("shape", SHAPES.values(), ids=list(SHAPES))
def test_normals_turn_with_the_spin_of_the_skin(shape):
    time, step = 0.3, 1e-5
    moving = [replace(POSE, angle=POSE.angle + way * step * 0.7, spin=0.7) for way in (-1, 0, 1)]
    if shape.rigid:
        before, now, after = (shape.markers(time, pose, 0.02) for pose in moving)
    else:
        before, now, after = (
            shape.markers(time + way * step, pose, 0.02) for way, pose in zip((-1, 0, 1), moving, strict=True)
        )
    rate = (after.normals - before.normals) / (2 * step)
    sides = now.weight > 0
    np.testing.assert_allclose(rate[:, sides], np.cross(now.spins, now.normals, axis=0)[:, sides], atol=0.05)


@pytest.mark.parametrize("axes", [2, 3])
def test_a_probe_is_exact_where_the_fields_are_linear(axes):
    sim, points = linear(axes), np.random.default_rng(1).uniform(-1.5, 1.5, (50, axes))
    got = sim.probe(points)
    np.testing.assert_allclose(got.velocity, points @ G[:axes, :axes].T, atol=1e-12)
    np.testing.assert_allclose(got.pressure, DENSITY * points @ DROP[:axes], atol=1e-12)
    assert flow.line((0.0,) * axes, (1.0,) * axes, 5).shape == (5, axes)


@pytest.mark.parametrize("shape", SHAPES.values(), ids=list(SHAPES))
def test_on_a_skin_linear_fields_are_read_exactly(shape):
    water = linear().water
    skin = shape.markers(0.3, POSE, 0.05)
    found = sample(water, replace(skin, velocities=G @ skin.points, spins=0 * skin.spins), DENSITY)
    rise = G @ skin.normals
    exact = 0.02 * DENSITY * (rise - skin.normals * (rise * skin.normals).sum(axis=0))
    np.testing.assert_allclose(found.pressure, DENSITY * DROP @ skin.points, atol=1e-11)
    np.testing.assert_allclose(found.shear, exact, atol=1e-11)


def test_water_that_turns_with_a_body_does_not_rub_and_rubs_one_that_rests():
    spins = np.array([0.4, -0.9, 1.3])
    turning = np.cross(spins, np.eye(3)).T
    water = linear(gradient=turning).water
    turns = flow.Pose(position=(0.0,) * 3, spin_x=spins[0], spin_y=spins[1], spin=spins[2])
    skins = [SHAPES["ellipsoid"].markers(0.0, pose, 0.05) for pose in (turns, replace(turns, spin=0.0))]
    together, apart = (sample(water, skin, DENSITY).shear for skin in skins)
    assert np.abs(together).max() < 1e-12
    assert np.abs(apart).max() > 0.01


def test_a_body_under_a_pressure_that_rises_is_lifted_by_its_volume():
    shape, middle = SHAPES["ellipsoid"], (0.1, 0.2, 0.3)
    water = linear(gradient=0 * G).water
    load = sample(water, shape.markers(0.0, replace(POSE, position=middle), 0.02), DENSITY).load(middle)
    np.testing.assert_allclose(load.force, -DENSITY * shape.volume(0.0) * DROP, rtol=1e-3)
    np.testing.assert_allclose(load.moment, 0.0, atol=1e-3)
    off = sample(water, shape.markers(0.0, replace(POSE, position=middle), 0.02), DENSITY).load((0.0, 0.0, 0.0))
    np.testing.assert_allclose(off.moment, np.cross(middle, load.force), rtol=1e-3)
    assert off.torque == off.moment[2]


@pytest.mark.parametrize("axes", [2, 3])
def test_through_the_sides_of_a_box_come_pressure_and_friction_exactly(axes):
    box, sides = (6, 14, 7, 11, 9, 20)[: 2 * axes], np.array([8, 4, 11])[:axes]
    still, sheared = linear(axes, 0 * G).water, linear(axes).water
    h, cells = 1 / 8, np.prod(sides)
    flux = boundary_flux(still.velocity, still.p, 1.0, box)
    np.testing.assert_allclose(flux, [np.zeros(axes), -DROP[:axes] * h * cells], atol=1e-9)
    square = boundary_flux(sheared.velocity, 0 * sheared.p, 0.0, box)[0]
    rubbed = boundary_flux(sheared.velocity, 0 * sheared.p, 5.0, box)[0]
    np.testing.assert_allclose(rubbed, square, atol=1e-9)  # even friction on all sides is no force
    assert np.abs(square).max() > 1.0
    middle = [-1.5 + h * (0.5 * (box[2 * n] + box[2 * n + 1]) - 2) for n in reversed(range(axes))]
    np.testing.assert_allclose(momentum(sheared.velocity, box), cells * G[:axes, :axes] @ middle, atol=1e-9)


def test_three_accounts_of_the_force_on_a_sphere_agree():
    """What the body exchanges, what a box around it loses, and what its skin feels, which is low on coarse grids."""
    low = []
    for cells in (48, 24):
        sim = ball(steps=0, cells=cells, step=None)
        sim.control(0.4)
        sim.run(0.6, progress=False)
        force, box = (rows[-3:].mean(axis=0) for rows in (sim.record.force(), sim.control_forces))
        assert box[0] == pytest.approx(force[0], rel=0.01)
        assert np.abs(box[1:]).max() < 1e-3 * force[0]
        skin = sim.surface().load((0.0, 0.0, 0.0))
        assert skin.power == 0.0
        assert np.abs(skin.force[1:]).max() < 1e-3 * force[0]
        low.append(1.0 - skin.force[0] / force[0])
    assert low == pytest.approx(SKIN_SPHERE, abs=0.01)


def test_of_a_body_that_a_mirror_cuts_the_skin_inside_the_domain_is_read():
    whole, half = (ball(mirrors=(False, False, cut)).surface().load((0.0, 0.0, 0.0)) for cut in (False, True))
    assert 2 * half.force[0] == pytest.approx(whole.force[0], rel=0.01)

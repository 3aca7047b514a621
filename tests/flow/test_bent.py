"""Bodies that a map bends: they are where it says, move as it does, and feel what the same body feels otherwise."""

from math import cos, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from trimesh.creation import box, icosphere

from suchus import flow
from suchus.core.errors import InvalidDesign
from suchus.flow.pose import Pose

W = 2 * pi
PLATE = flow.from_outline(np.array([[-0.5, -0.1], [0.5, -0.1], [0.5, 0.1], [-0.5, 0.1]]))


def mesh_of(found):
    return flow.TriangleMesh(vertices=np.array(found.vertices), faces=np.array(found.faces))


def heaved(x, y, *rest):
    return (x, y - 0.1 * sin(W * rest[-1]), *rest[:-1])


def test_what_a_map_carries_feels_what_the_same_body_feels_that_is_carried():
    ellipse = flow.Ellipse(length=1.0, width=0.4)
    grid, force = flow.Grid.covering((-1.5, 1.5), (-1.5, 1.5), cell=1 / 24), []
    given_motion = flow.Body(shape=ellipse, motion=flow.Oscillation(frequency=1.0, heave=(0.0, 0.1)))
    for body in (given_motion, flow.Body(shape=flow.bend_shape(ellipse, heaved))):
        sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1 / 100, bodies=(body,), step=0.01))
        force.append(sim.run(0.15).force("body"))
    assert np.abs(force[0][5:]).max() > 1.0
    np.testing.assert_allclose(force[1], force[0], atol=1e-3 * np.abs(force[0]).max())


def test_in_space_too():
    ball = mesh_of(icosphere(subdivisions=2, radius=0.5))
    grid, force = flow.Grid(cells=(24, 24, 24), cell=0.125, origin=(-1.5, -1.5, -1.5)), []
    given_motion = flow.Body(shape=ball, motion=flow.Oscillation(frequency=1.0, heave=(0.0, 0.1, 0.0)))
    for body in (given_motion, flow.Body(shape=flow.bend_shape(ball, heaved))):
        sim = flow.Simulation(flow.Setup(grid=grid, viscosity=0.1, bodies=(body,), step=0.02, coarse=True))
        force.append(sim.run(0.06).force("body"))
    assert np.abs(force[0]).max() > 0.1
    np.testing.assert_allclose(force[1], force[0], atol=1e-4 * np.abs(force[0]).max())


def test_a_map_that_turns_a_shape_moves_it_as_a_pose_that_turns():
    rate, time, spacing = 3.0, 0.2, 0.03

    def turned(x, y, t):
        c, s = cos(rate * t), sin(rate * t)
        return c * x + s * y, -s * x + c * y

    by_map = flow.bend_shape(PLATE, turned).markers(time, Pose(), spacing)
    by_pose = PLATE.markers(time, Pose(angle=rate * time, spin=rate), spacing)
    np.testing.assert_allclose(by_map.points, by_pose.points, atol=1e-9)
    np.testing.assert_allclose(by_map.velocities, by_pose.velocities, atol=1e-6)
    np.testing.assert_allclose(by_map.spins, by_pose.spins, atol=1e-6)
    np.testing.assert_allclose(by_map.normals, by_pose.normals, atol=1e-9)


def test_shear_keeps_the_area_and_carries_the_momentum_that_it_must():
    """Of a rectangle: V = a x w cos(w t) along y, so that the angular momentum is that times the moment of x^2."""
    sheared = flow.bend_shape(PLATE, lambda x, y, t: (x, y - 0.3 * x * sin(W * t) - 0.2 * sin(W * t)))
    mass, rate = sheared.mass(0.1), W * cos(0.1 * W)
    assert mass.volume == pytest.approx(0.2, rel=1e-9)
    assert mass.centre == pytest.approx((0.0, 0.2 * sin(0.1 * W)), abs=1e-9)
    assert mass.centre_rate == pytest.approx((0.0, 0.2 * rate), abs=1e-6)
    assert mass.swirl[0] == pytest.approx(0.3 * rate * 0.2 / 12, rel=1e-6)
    assert PLATE.mass(0.0).swirl == (0.0,)


def test_a_mesh_that_swells_and_shears_has_its_volume_and_its_momentum():
    """Of a box: growth along x by g(t), and V along z of a y w cos(w t)."""
    still = mesh_of(box(extents=(1.0, 0.4, 0.2)))
    body = flow.bend_shape(still, lambda x, y, z, t: (x / (1 + 0.5 * t) - 0.1, y, z - 0.3 * y * sin(W * t)))
    mass, grown, rate = body.mass(0.1), 1.05, 0.3 * W * cos(0.1 * W)
    assert mass.volume == pytest.approx(0.08 * grown, rel=1e-9)
    assert mass.centre == pytest.approx((0.1 * grown, 0.0, 0.0), abs=1e-9)
    assert mass.centre_rate == pytest.approx((0.5 * 0.1, 0.0, 0.0), abs=1e-7)
    assert mass.swirl == pytest.approx((rate * mass.volume * 0.4**2 / 12, 0.0, 0.0), abs=1e-8)
    low, high = np.reshape(body.bounds(0.1, Pose()), (3, 2)).T
    np.testing.assert_allclose(high - low, [grown, 0.4, 0.2 + 0.4 * 0.3 * sin(0.1 * W)], rtol=1e-9)


@given(st.floats(0.0, 0.15), st.floats(-3.0, 3.0), st.floats(0.5, 4.0), st.floats(0.0, 1.0))
def test_velocities_are_the_rates_of_places_whatever_the_wave(high, wave, often, time):
    def waving(x, y, t):
        return x + 0.2 * high * np.sin(often * t) * y, y - high * np.sin(wave * x - often * t)

    body, step = flow.bend_shape(flow.Ellipse(length=1.0, width=0.3), waving), 1e-3
    here, before, after = (
        body.bend.map_to_bent(body.facets.still_corners, t) for t in (time, time - step, time + step)
    )
    seen, told = (after - before) / (2 * step), body.bend.velocity(here, time)
    np.testing.assert_allclose(told, seen, atol=1e-5 * (1 + often**3))
    np.testing.assert_allclose(body.bend(here, time), body.facets.still_corners, atol=1e-8)
    assert body.mass(time).volume == pytest.approx(pi * 0.5 * 0.15, rel=0.02)


def test_a_body_that_bends_is_watched_swims_and_goes_on_from_a_checkpoint(tmp_path):
    """A foil that a wave runs along, freed: it goes the other way than the wave, and its record is one to the byte."""

    def wave(x, y, t):
        return x, y - 0.1 * (x + 0.5) * np.sin(W * (1.2 * x - t)) * min(1.0, t)

    body = flow.FreeBody(shape=flow.bend_shape(flow.Ellipse(length=1.0, width=0.2), wave), start=(0.0, 0.0))
    grid = flow.Grid.covering((-1.2, 1.2), (-0.8, 0.8), cell=1 / 32)
    setup = flow.Setup(grid=grid, viscosity=1 / 400, bodies=(body,), step=0.02, coarse=True)
    through = flow.Simulation(setup)
    through.run(0.3)
    whole = through.run(0.6)
    kept = tmp_path / "kept.npz"
    flow.Simulation(setup).run(0.3, checkpoint=kept)
    again = flow.Simulation(setup).run(0.6, checkpoint=kept)
    assert whole.column("velocity_x", "body")[-1] < -1e-3
    np.testing.assert_array_equal(again.force("body"), whole.force("body"))


@pytest.mark.parametrize(
    ("shape", "back", "words"),
    [
        (PLATE, lambda x, y, t: (x, y - 3 * x**2, t), "gives 3 coordinates; 2 are needed"),
        (PLATE, lambda x, y, t: (np.where(x > 0.2, np.nan, x), y), r"gives no finite place for \(0\."),
        (PLATE, lambda x, y, t: (-x, y), "turns it inside out|no place was found"),
        (PLATE, lambda x, y, t: (x**2, y), "no place was found|inside out"),
        (flow.Sphere(diameter=1.0), lambda x, y, z, t: (x, y, z), "a Sphere cannot be bent by a map"),
    ],
)
def test_what_is_no_map_is_refused(shape, back, words):
    with pytest.raises(InvalidDesign, match=words):
        flow.bend_shape(shape, back)


def test_a_map_that_leaps_or_is_too_fast_for_its_tick_is_refused():
    def fast(x, y, t):
        return x, y - 0.01 * np.sin(3e4 * t)

    with pytest.raises(InvalidDesign, match=r"leaps, or is too fast .* shorter tick"):
        flow.bend_shape(PLATE, fast).markers(0.0, Pose(), 0.05)
    flow.bend_shape(PLATE, fast, tick=1e-6).markers(0.0, Pose(), 0.05)
    with pytest.raises(InvalidDesign, match="tick is 0 s"):
        flow.bend_shape(PLATE, fast, tick=0)

"""Rigid pieces with their own poses: the union's shape, motions of a rigid body, and loads that do the power's work."""

import numpy as np
import pytest

from suchus import flow
from suchus.core import rotation
from suchus.core.errors import InvalidDesign
from suchus.flow.linked import interpolate_links

HINGE = np.array([0.1, 0.02, 0.0])
ROD = flow.Spherocylinder(length=0.3, radius=0.05)
OFF = 0.03
"""How far the rod's middle is from the origin of its link [m]."""


def states(position, vector, velocity, spin):
    """The state of some links, their attitudes by rotation vectors."""
    rows = (np.atleast_2d(np.array(one, float)) for one in (position, vector, velocity, spin))
    position, vector, velocity, spin = rows
    return flow.LinkStates(position, rotation.turns(vector), velocity, spin)


def paddle(time, rate=2.0):
    """A link that turns about a hinge, beside one that rests."""
    angle, axis = 0.3 + rate * time, np.array([0.0, 0.6, 0.8])
    arm = rotation.turn(angle * axis) @ np.array([0.15 - OFF, 0.0, 0.0])
    return states([[0, 0, 0], HINGE + arm], [[0, 0, 0], angle * axis],
                  [[0, 0, 0], np.cross(rate * axis, arm)], [[0, 0, 0], rate * axis])  # fmt: skip


def paddler():
    """A ball with a rod that paddles beside it."""
    ball = flow.Ellipsoid(length=0.3, width=0.2, height=0.16)
    return flow.Linked(
        pieces=(flow.LinkPiece(link=0, shape=ball), flow.LinkPiece(link=1, shape=ROD, position=(OFF, 0.0, 0.0))),
        motion=paddle,
    )


def ellipsoid(points):
    """Whether points lie in the paddler's resting piece."""
    x, y, z = points
    return (x / 0.15) ** 2 + (y / 0.1) ** 2 + (z / 0.08) ** 2 < 1


def rod_holds(points, time=0.0):
    """Whether points lie in the rod that paddles, from its formula."""
    now = paddle(time)
    own = now.matrix[1].T @ (points - now.position[1][:, None])
    beyond = np.maximum(np.abs(own[0] - OFF) - 0.15, 0.0)
    return beyond**2 + own[1] ** 2 + own[2] ** 2 < 0.05**2


def inside(points, time=0.0):
    """Whether points lie in the paddler."""
    return ellipsoid(points) | rod_holds(points, time)


def test_volume_and_moments_are_those_of_random_points():
    rng = np.random.default_rng(2)
    low, high = np.array([-0.2, -0.2, -0.35]), np.array([0.55, 0.35, 0.2])
    points = rng.uniform(low, high, (300_000, 3)).T
    there, box = inside(points), float(np.prod(high - low))
    mass = paddler().mass(0.0)
    assert mass.volume == pytest.approx(box * there.mean(), rel=0.02)
    assert mass.centre == pytest.approx(points[:, there].mean(axis=1), abs=2e-3)
    rest = states([0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0])
    alone = flow.Linked(pieces=(flow.LinkPiece(link=0, shape=ROD),), motion=lambda _: rest)
    assert alone.mass(0.0).moments == pytest.approx(ROD.mass(0.0).moments, rel=0.04, abs=1e-9)
    own = (points - HINGE[:, None])[:, there & ~ellipsoid(points)]
    drift = np.cross(2.0 * np.array([0.0, 0.6, 0.8]), own.T).sum(axis=0) / there.sum()
    assert mass.centre_rate == pytest.approx(drift, abs=0.03 * np.abs(drift).max())


def test_a_piece_that_turns_about_its_joint_has_the_velocity_of_a_rigid_body():
    body, h, time = paddler(), 0.02, 0.2
    window = [np.arange(a, b, h) for a, b in ((-0.3, 0.7), (-0.3, 0.5), (-0.5, 0.3))]
    pose = flow.Pose(
        position=(0.05, -0.02, 0.01), angle=0.4, pitch=0.3, roll=-0.2, velocity=(0.1, 0.2, -0.3), spin_x=0.5,
        spin_y=-0.4, spin=0.3,
    )  # fmt: skip
    found = body.measure(window, time, pose, 4 * h)
    z, y, x = np.meshgrid(*window[::-1], indexing="ij")
    own = np.array(pose.to_body((x, y, z)))
    assert ((found.distance < 0) == inside(own.reshape(3, -1), time).reshape(x.shape)).all()
    rod = (found.part_index == 1) & (found.distance < 3 * h)
    assert rod.sum() > 100
    assert (~rod & (found.distance < 0)).sum() > 100
    axis = 2.0 * np.array([0.0, 0.6, 0.8])
    turning = np.cross(axis, np.moveaxis(own - HINGE[:, None, None, None], 0, -1))
    expected = np.array(pose.velocity_at((x, y, z))) + np.einsum("ij,...j->i...", pose.matrix, turning)
    assert np.array(found.velocity)[:, rod] == pytest.approx(expected[:, rod], abs=1e-12)
    ball = (found.part_index == 0) & (found.distance < 3 * h)
    assert np.array(found.velocity)[:, ball] == pytest.approx(np.array(pose.velocity_at((x, y, z)))[:, ball], abs=1e-12)
    skin = body.markers(time, pose, h)
    seen = np.array(pose.to_body(skin.points))
    turning = np.cross(axis, (seen - HINGE[:, None]).T).T
    expected = np.array(pose.velocity_at(skin.points)) + pose.matrix @ turning
    assert skin.velocities[:, skin.part_index == 1] == pytest.approx(expected[:, skin.part_index == 1], abs=1e-12)
    covered = np.where(skin.part_index == 0, rod_holds(seen, time), ellipsoid(seen))
    assert ((skin.weight == 0) == covered).all()
    assert 0 < (skin.weight == 0).sum() < 0.3 * skin.weight.size


def test_a_rod_of_a_link_is_the_capsule_of_a_trunk():
    wide = np.full(41, 0.04)
    s, none = np.linspace(0.0, 1.0, 41), np.zeros(41)
    spine = flow.MidlineState(x=s, y=none, heading=none, half_width=wide, x_rate=none, y_rate=none, heading_rate=none)
    limb = flow.Capsule(arc_position=0.5, start=(0.0, 0.2), end=(0.3, 0.2), radius=0.05)
    trunk = flow.Limbed(spine=lambda _: spine, half_height=wide, limbs=(limb,), deforms=False)
    one = flow.Linked(
        pieces=(flow.LinkPiece(link=0, shape=ROD, position=(0.05, 0.0, 0.0)),),
        motion=lambda _: states([0.6, 0.2, 0.0], [0, 0, 0], [0, 0, 0], [0, 0, 0]),
    )
    window = [np.arange(a, b, 0.02) for a, b in ((0.4, 0.95), (0.1, 0.3), (-0.1, 0.1))]
    both = [body.measure(window, 0.0, flow.Pose(), 0.08) for body in (trunk, one)]
    near = (both[1].distance < 0.06) & (both[1].distance > -0.049)
    assert near.sum() > 500
    for name in ("distance", "thickness"):
        assert getattr(both[1], name)[near] == pytest.approx(getattr(both[0], name)[near], abs=1e-12)
    assert np.array(both[1].normal)[:, near] == pytest.approx(np.array(both[0].normal)[:, near], abs=1e-12)


def test_between_two_states_rates_are_those_of_the_places():
    start, end = (states([[0.0, 0.1, 0.2]], [v], [u], [w]) for v, u, w in (
        ([0.1, -0.2, 0.3], [0.5, -0.1, 0.2], [1.0, 2.0, -1.0]), ([0.25, 0.1, 0.1], [0.4, 0.3, -0.2], [2.0, 1.0, 0.5])
    ))  # fmt: skip
    end = end._replace(position=end.position + np.array([0.05, 0.01, -0.02]))
    span = 0.1
    for at, near in ((0.0, start), (1.0, end)):
        for one, other in zip(interpolate_links(start, end, span, at), near, strict=True):
            assert one == pytest.approx(other, abs=1e-12)
        inner = interpolate_links(start, end, span, at + (1e-9 if at == 0 else -1e-9))
        for one, other in zip(inner, near, strict=True):
            assert one == pytest.approx(other, abs=1e-6)
    d = 1e-5
    for share in (-0.3, 0.2, 0.7, 1.4):
        here, before, after = (interpolate_links(start, end, span, share + way * d) for way in (0, -1, 1))
        assert (after.position - before.position) / (2 * d * span) == pytest.approx(here.velocity, abs=1e-7)
        turned = rotation.vectors(after.matrix @ np.swapaxes(before.matrix, 1, 2)) / (2 * d * span)
        assert turned == pytest.approx(here.spin, abs=1e-7)


def setup(body, steps=6):
    """A short run of one body in a small box."""
    grid = flow.Grid.covering((-0.45, 0.75), (-0.5, 0.55), (-0.6, 0.5), cell=0.04)
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=2e-3, bodies=(body,), step=0.01), thread_count=1)
    for _ in range(steps):
        sim.advance()
    return sim


def test_one_link_swims_as_its_piece_alone_does():
    ball = flow.Ellipsoid(length=0.4, width=0.25, height=0.2)

    def swing(time):
        w = 6.0
        return flow.Pose(position=(0.0, 0.05 * np.sin(w * time), 0.0), velocity=(0.0, 0.05 * w * np.cos(w * time), 0.0),
                         angle=0.1 * np.sin(w * time), spin=0.1 * w * np.cos(w * time))  # fmt: skip

    def link(time):
        one = swing(time)
        return states(one.position, [0, 0, one.angle], one.velocity, one.spins)

    alone = setup(flow.Body(shape=ball, motion=swing))
    linked = setup(flow.Body(shape=flow.Linked(pieces=(flow.LinkPiece(link=0, shape=ball),), motion=link)))
    one, other = alone.last_loads("body").total, linked.last_loads("body").total
    assert np.abs(one.force).max() > 0.01
    assert other.force == pytest.approx(one.force, abs=1e-4 * np.abs(one.force).max())
    assert float(other.power) == pytest.approx(float(one.power), rel=1e-4)


def test_loads_on_the_links_add_up_and_do_the_power_s_work():
    sim = setup(flow.Body(shape=paddler()), steps=8)
    loads, h = sim.last_loads("body"), 0.01
    assert loads.parts.force.sum(axis=0) == pytest.approx(loads.total.force, abs=1e-9)
    middle = paddle(sim.time - 0.5 * h)
    force, moment = loads.parts.force[1], loads.parts.moment[1]
    at = middle.position[1] - loads.reference_point
    own = moment - np.cross(at, force)
    work = float(force @ middle.velocity[1] + own @ middle.spin[1])
    assert work < 0.0
    assert -work == pytest.approx(float(loads.total.power), rel=1e-3)  # 4e-3 with the pressure inside the joint
    speed = middle.velocity[1] / np.linalg.norm(middle.velocity[1])
    assert force @ speed < 0.0  # the water pushes against the stroke


def test_links_whose_rates_are_not_those_of_their_places_are_refused():
    def wrong(time):
        now = paddle(time)
        return now._replace(spin=1.5 * now.spin)

    shape = flow.Linked(pieces=paddler().pieces, motion=wrong)
    with pytest.raises(InvalidDesign, match=r"body gives link 1 the spin .* rad/s along [yz], and its matrix"):
        setup(flow.Body(shape=shape))
    with pytest.raises(InvalidDesign, match=r"are on the links \[0, 2\], and its motion tells of 2"):
        flow.Linked(pieces=(*paddler().pieces[:1], flow.LinkPiece(link=2, shape=ROD)), motion=paddle)

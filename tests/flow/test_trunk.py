"""Trunks in space: their geometry, free swimming, and what the water does to their parts and joints."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from test_space import oblate

from suchus import flow
from suchus.core.errors import InvalidDesign, OutsideLimits, UnknownName
from suchus.flow import body as bodies
from suchus.flow.added import added_mass
from suchus.flow.immerse import MIN_FLUID_FRACTION, close_surface
from suchus.flow.sections import ellipse_foot
from suchus.flow.water import Fluid

STATIONS = 61


def rod(s, half_width, half_height, *, cuts=()):
    """A straight trunk along x with these half-axes at the stations."""
    zero = np.zeros(s.size)
    spine = flow.MidlineState(
        x=s, y=zero, heading=zero, half_width=half_width, x_rate=zero, y_rate=zero, heading_rate=zero
    )
    return flow.Trunk(spine=lambda _: spine, half_height=half_height, cuts=cuts, deforms=False)


def egg(length, width, height, **more):
    """An ellipsoid, as a trunk."""
    angle = np.linspace(0.0, np.pi, 4 * STATIONS)
    return rod(-0.5 * length * np.cos(angle), 0.5 * width * np.sin(angle), 0.5 * height * np.sin(angle), **more)


def eel(*, cuts=(), taper=True):
    """A swimmer of length 1 and period 1, its motion growing over the first half."""
    s = np.linspace(0.0, 1.0, STATIONS)
    along = np.sort(np.concatenate([s, 0.5 * (s[1:] + s[:-1])]))
    wide = 0.06 * np.sqrt(np.maximum(1.0 - (2.0 * s - 1.0) ** 2, 0.0)) if taper else np.full(s.size, 0.06)

    def summed(values):
        return np.concatenate([[0.0], np.cumsum(values)]) / (STATIONS - 1)

    def spine(time):
        grown = min(time / 0.5, 1.0)
        share, rate = grown**2 * (3 - 2 * grown), 12 * grown * (1 - grown)
        phase, size = 2 * np.pi * (along - time), 0.6 * (along + 0.1)
        a = share * size * np.cos(phase)
        b = size * (rate * np.cos(phase) + 2 * np.pi * share * np.sin(phase))
        (heading, turn), (middle, spin) = (a[::2], b[::2]), (a[1::2], b[1::2])
        return flow.MidlineState(
            x=summed(np.cos(middle)), y=summed(np.sin(middle)), heading=heading, half_width=wide,
            x_rate=summed(-np.sin(middle) * spin), y_rate=summed(np.cos(middle) * spin), heading_rate=turn,
        )  # fmt: skip

    return flow.Trunk(spine=spine, half_height=1.3 * wide, cuts=cuts)


def points(h, *half):
    """The lines of a window around the origin."""
    return [np.arange(-end, end, h) + 0.1 * h for end in half]


POSE = flow.Pose(position=(0.05, -0.02, 0.03), angle=0.4, velocity=(0.3, 0.2, 0.1), spin=0.7)


@pytest.mark.parametrize("axes", [(1.0, 1.0, 1.0), (2.0, 0.5, 0.5), (2.0, 0.4, 0.6)])
def test_a_trunk_with_the_sections_of_an_ellipsoid_is_one(axes):
    h, exact = 1 / 20, flow.Ellipsoid(length=axes[0], width=axes[1], height=axes[2])
    window = points(h, 1.3, 1.0, 0.7)
    ours, theirs = (shape.measure(window, 0.0, POSE, 4 * h) for shape in (egg(*axes), exact))
    near = (np.abs(theirs.distance) < 3 * h) & (theirs.distance > -h)
    round_ = axes[1] == axes[2]
    assert near.sum() > 1000
    assert np.abs(ours.distance - theirs.distance)[near].max() < (2e-3 if round_ else 0.08) * h
    for a, b in zip(ours.normal, theirs.normal, strict=True):
        assert np.abs(a - b)[near].max() < (0.02 if round_ else 0.3)
    for a, b in zip(ours.velocity, theirs.velocity, strict=True):
        assert np.abs(a - b)[near].max() < 1e-9
    assert (ours.distance[theirs.distance > 4 * h] > 3.9 * h).all()
    assert (ours.distance[theirs.distance < -h] < -0.9 * h).all()
    mass, wanted = egg(*axes).mass(0.0), exact.mass(0.0)
    assert mass.volume == pytest.approx(wanted.volume, rel=2e-4)
    assert np.diag(mass.moments) == pytest.approx(np.diag(wanted.moments), rel=4e-4)
    skins = [shape.markers(0.0, POSE, 0.5 * h).weight.sum() for shape in (egg(*axes), exact)]
    assert skins[0] == pytest.approx(skins[1], rel=2e-3)


@settings(max_examples=20, deadline=None)
@given(x=st.floats(-0.4, 1.4), y=st.floats(-0.5, 0.5), z=st.floats(-0.5, 0.5))
def test_a_trunk_of_constant_section_is_a_cylinder_with_flat_ends(x, y, z):
    radius, reach = 0.2, 0.25
    trunk = rod(np.linspace(0.0, 1.0, 41), np.full(41, radius), np.full(41, radius))
    lines = [np.array([at, at + 0.05]) for at in (x, y, z)]
    found = float(trunk.measure(lines, 0.0, flow.Pose(), reach).distance[0, 0, 0])
    out = np.array([np.hypot(y, z) - radius, abs(x - 0.5) - 0.5])
    exact = min(out.max(), 0.0) + np.hypot(*np.maximum(out, 0.0))
    if abs(exact) < reach:
        assert found == pytest.approx(exact, abs=1e-9)
    else:
        assert np.sign(found) == np.sign(exact)
        assert abs(found) >= reach - 1e-9
    assert trunk.volume(0.0) == pytest.approx(np.pi * radius**2)
    assert trunk.markers(0.0, flow.Pose(), 0.02).weight.sum() == pytest.approx(2 * np.pi * radius * 1.2, rel=5e-3)


def test_the_volume_of_a_bent_trunk_is_what_it_fills():
    trunk, time, h = eel(taper=False), 0.9, 0.01
    spine = trunk.spine(time)
    window = [np.arange(low - 0.1, high + 0.1, h) for low, high in
              ((spine.x.min(), spine.x.max()), (spine.y.min(), spine.y.max()), (0.0, 0.0))]  # fmt: skip
    inside = trunk.measure(window, time, flow.Pose(), 2 * h).distance < 0
    _, y, x = np.meshgrid(*window[::-1], indexing="ij")
    mass, filled = trunk.mass(time), inside.sum() * h**3
    centre = x[inside].mean(), y[inside].mean()
    assert mass.volume == pytest.approx(filled, rel=0.01)
    assert mass.centre == pytest.approx((*centre, 0.0), abs=1e-3)
    moment = ((x[inside] - centre[0]) ** 2 + (y[inside] - centre[1]) ** 2).sum() * h**3
    assert mass.moments[2, 2] == pytest.approx(moment, rel=0.01)


def test_the_wall_moves_with_the_velocity_that_it_tells():
    trunk, dt = eel(), 1e-5

    def pose(time):
        return flow.Pose(position=(0.3 * time, 0.1, 0.0), angle=0.5 * time, velocity=(0.3, 0.0, 0.0), spin=0.5)

    before, now, after = (trunk.markers(t, pose(t), 0.02) for t in (0.3 - dt, 0.3, 0.3 + dt))
    moved = (after.points - before.points) / (2 * dt)
    assert np.abs(now.velocities).max() > 0.5
    assert np.abs(now.velocities - moved).max() < 1e-6
    rate = np.subtract(trunk.mass(0.3 + dt).centre, trunk.mass(0.3 - dt).centre) / (2 * dt)
    assert trunk.mass(0.3).centre_rate == pytest.approx(rate, abs=2e-3)
    some = slice(40, None, 97)
    for point, velocity in zip(now.points.T[some], now.velocities.T[some], strict=True):
        window = [np.array([at, at + 0.02]) for at in point]
        field = trunk.measure(window, 0.3, pose(0.3), 0.1)
        assert abs(field.distance[0, 0, 0]) < 1e-3
        assert [part[0, 0, 0] for part in field.velocity] == pytest.approx(velocity, abs=2e-3)


def water(shape, *, half=True, free=True, cells=32, thread_count=1, **changes):
    """A swimmer of length 1 in a box, its upper half where a mirror is asked for."""
    h, high = 1 / cells, 8 * (cells // 32)
    grid = flow.Grid(
        cells=(2 * cells - cells // 2, cells - cells // 4, high if half else 2 * high), cell=h,
        origin=(-0.25, -0.375, 0.0 if half else -high * h),
    )  # fmt: skip
    sides = flow.Sides(low=flow.Mirror()) if half else flow.Sides()
    body = flow.FreeBody(shape=shape, start=(0.5, 0.0, 0.0)) if free else flow.Body(shape=shape)
    setup = flow.Setup(grid=grid, viscosity=2e-3, bodies=(body,), sides=sides, step=0.02, coarse=True)
    return flow.Simulation(replace(setup, **changes), thread_count=thread_count)


SPHERE = flow.Sphere(diameter=0.3)
UPPER = flow.Grid(cells=(48, 24, 24), cell=1 / 32, origin=(-0.75, 0.0, -0.375))
CUTS = (0.2, 0.45, 0.8)


@pytest.fixture(scope="module")
def swum():
    """Return a free swimmer that the grid travels with, after 20 steps."""
    sim = water(eel(cuts=CUTS, taper=False), follow="body")
    for until in (0.12, 0.4):
        sim.run(until, progress=False)
    return sim


def test_a_body_gets_the_momentum_that_the_water_gives(swum):
    record, volume = swum.record, swum.setup.bodies[0].shape.volume(0.0)
    given = np.cumsum(record.force()[:, :2] * record.step[:, None], axis=0)
    has = volume * np.column_stack([record.column("velocity_x"), record.column("velocity_y")])
    late = np.abs(record.force()[:, :2] * record.step[:, None]).max()  # a step's force comes a step late
    assert np.abs(has - given).max() < late < 0.3 * np.abs(given).max()
    speed = record.column("velocity_x")
    moved = (record.step * 0.5 * (speed + np.append(0.0, speed[:-1]))).sum()
    assert record.column("x")[-1] - 0.5 == pytest.approx(moved, abs=1e-9)
    assert (record.column("z") == 0).all()
    assert swum.frame[0, :2] == pytest.approx([record.column("x")[-1] - 0.5, record.column("y")[-1]], abs=1e-3)
    assert swum.frame[0, 2] == 0


def test_the_parts_make_the_whole(swum):
    record = swum.record
    for name in ("force_x", "force_y", "torque", "power"):
        whole, parts = record.column(name), record.part_series(name)
        assert parts.shape == (20, 4)
        assert np.abs(parts.sum(axis=1) - whole).max() < 1e-9 * np.abs(parts).max()
    shape, pose = swum.setup.bodies[0].shape, swum.pose("body")
    force = np.stack([record.part_series("force_x"), record.part_series("force_y")], axis=-1)[-1]
    about = np.array([record.column("x")[-1], record.column("y")[-1]])
    for k, joint in enumerate(shape.position_at(swum.time, pose, np.array([0.0, *CUTS]))[:, :2]):
        arm, behind = about - joint, force[k:].sum(axis=0)
        torque = record.part_series("torque")[-1, k:].sum() + arm[0] * behind[1] - arm[1] * behind[0]
        assert record.part_series("torque_behind")[-1, k] == pytest.approx(torque, abs=1e-9)
    assert record.select_after(0.13).part_series("power").shape == (14, 4)
    with pytest.raises(UnknownName):
        record.part_series("force_z")
    undivided = water(eel(taper=False))
    undivided.advance()
    with pytest.raises(OutsideLimits, match="is not divided"):
        undivided.record.part_series("power")


def test_a_divided_body_swims_as_an_undivided_one_on_any_number_of_threads(swum):
    other = water(eel(taper=False), follow="body", thread_count=2)
    other.run(0.12, progress=False)
    assert np.abs(other.record.bodies - swum.record.bodies[:6]).max() < 1e-6
    same = water(eel(cuts=CUTS, taper=False), follow="body", thread_count=2)
    for until in (0.12, 0.4):
        same.run(until, progress=False)
    assert same.water.velocity.tobytes() == swum.water.velocity.tobytes()
    assert same.record.parts.tobytes() == swum.record.parts.tobytes()


def test_a_swimmer_goes_on_from_its_checkpoint_to_the_same_bytes(swum, tmp_path):
    for until in (0.12, 0.4):
        sim = water(eel(cuts=CUTS, taper=False), follow="body")
        sim.run(until, progress=False, checkpoint=tmp_path / "swim")
    assert sim.water.velocity.tobytes() == swum.water.velocity.tobytes()
    assert sim.record.parts.tobytes() == swum.record.parts.tobytes()
    assert sim.record.bodies.tobytes() == swum.record.bodies.tobytes()


def test_half_a_swimmer_swims_as_the_whole_one():
    half, full = (water(eel(taper=False), half=cut, tolerance=1e-6) for cut in (True, False))
    for sim in (half, full):
        sim.run(0.2, progress=False)
    a, b = half.record, full.record
    for name, scale in (("velocity_x", 0.02), ("velocity_y", 0.02), ("angle", 0.05), ("power", 0.05)):
        assert np.abs(a.column(name) - b.column(name)).max() < scale * np.abs(b.column(name)).max()
    assert np.abs(b.column("angle")).max() > 0.01


def test_each_part_of_a_spheroid_that_starts_sideways_is_held_back_by_its_volume():
    """Its potential on the skin is proportional to the distance to the side, so the force of a slice to its area."""
    cuts = (0.5, 0.8, 1.0, 1.4)
    shape = egg(2.0, 0.5, 0.5, cuts=cuts)
    arc = shape.spine(0.0).arc
    assert arc[-1] == pytest.approx(2.0)

    def motion(time):
        return flow.Pose(position=(0.0, 0.5 * time**2), velocity=(0.0, time))

    grid = flow.Grid(cells=(80, 48, 24), cell=1 / 24, origin=(-5 / 3, -1.0, 0.0))
    sim = flow.Simulation(
        flow.Setup(
            grid=grid, viscosity=1e-6, bodies=(flow.Body(shape=shape, motion=motion),), step=0.01, coarse=True,
            sides=flow.Sides(low=flow.Mirror()),
        ),
        thread_count=1,
    )  # fmt: skip
    for _ in range(2):
        sim.advance()
    along = sim.record.part_series("force_y")[-1]
    ends = np.array([0.0, *cuts, 2.0]) - 1.0
    share = np.diff(ends - ends**3 / 3) / (4 / 3)
    assert along.sum() < 0
    assert along / along.sum() == pytest.approx(share, abs=0.02)


def test_a_heavy_sphere_begins_to_sink_with_its_mass_and_added_mass():
    ball = flow.FreeBody(
        shape=flow.Sphere(diameter=1.0),
        density=2.0,
        gravity=(-3.0, 0.0),
        start=(0.0, 0.0, 0.0),
        free=(True, True, True),
    )
    grid = flow.Grid(cells=(32, 32, 16), cell=1 / 8, origin=(-2.0, -2.0, 0.0))
    sim = flow.Simulation(
        flow.Setup(grid=grid, viscosity=1e-6, bodies=(ball,), step=0.01, coarse=True,
                   sides=flow.Sides(low=flow.Mirror())),
        thread_count=1,
    )  # fmt: skip
    for _ in range(6):
        sim.advance()
    speed = sim.record.column("velocity_x")
    push = speed[1] / (2 * 0.01)  # the friction of the wall grows from step to step
    added = float(sim.swimmers["body"].added_mass[0, 0]) / (np.pi / 6)
    assert added == pytest.approx(0.5, abs=0.06)
    assert push == pytest.approx(-3.0 / (2.0 + added), rel=0.02)
    assert np.abs(sim.record.column("velocity_y")).max() < 1e-4


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"half_height": np.zeros((3, 2))}, "shape"),
        ({"half_height": np.array([0.1, -0.1, 0.1])}, "none negative"),
        ({"half_height": np.array([0.1, np.nan, 0.1])}, "finite"),
        ({"cuts": (0.5, 0.5)}, "rising"),
        ({"cuts": (0.0, 0.5)}, "above 0"),
        ({"cuts": tuple(np.linspace(0.01, 0.9, 64))}, "64 cuts"),
    ],
)
def test_impossible_trunks_are_refused(changes, said):
    with pytest.raises(InvalidDesign, match=said):
        replace(egg(1.0, 0.5, 0.5), **changes)


def test_what_does_not_fit_is_refused_in_use():
    short = replace(egg(1.0, 0.5, 0.5), half_height=np.ones(5))
    with pytest.raises(InvalidDesign, match="244 stations at t = 0 s and there are 5"):
        short.volume(0.0)
    thin = rod(np.linspace(0.0, 0.8, 11), np.full(11, 0.04), np.full(11, 0.04))
    with pytest.raises(InvalidDesign, match=r"2.6 cells of 0.03125 m"):
        water(thin, free=False)
    with pytest.raises(InvalidDesign, match=r"takes .* million cells"):
        water(eel(taper=False), viscosity=1e-6, coarse=False).run(0.2, progress=False)
    across_y = flow.Sides(bottom=flow.Mirror())
    with pytest.raises(InvalidDesign, match="no images of each other"):
        water(egg(0.8, 0.3, 0.3), free=False, half=False, sides=across_y, grid=UPPER)
    assert water(SPHERE, free=False, half=False, sides=across_y, grid=UPPER).thin_fractions == {"body": 0.0}
    body = flow.FreeBody(shape=flow.Cylinder(diameter=0.3), start=(0.5, 0.0, 0.0))
    with pytest.raises(InvalidDesign, match=r"starts at \(0.5, 0.0, 0.0\) m, and the grid has two axes"):
        flow.Setup(grid=flow.Grid(cells=(32, 32), cell=1 / 16), viscosity=0.01, bodies=(body,))
    many = [flow.Body(shape=egg(1.0, 0.5, 0.5, cuts=tuple(np.linspace(0.01, 0.9, 60))), name=str(k)) for k in range(3)]
    assert len(bodies.rows_of(many[:2])) == 2
    with pytest.raises(InvalidDesign, match="183 parts"):
        bodies.rows_of(many)


@given(st.floats(-6.0, 6.0), st.floats(-6.0, 6.0), st.floats(-9.0, 0.5), st.booleans())
def test_the_foot_on_an_ellipse_is_square_to_it(y, z, thin, upright):
    """However thin the ellipse: with a bounded number of steps that suited a ratio of 6 a fin's edge was anywhere."""
    wide, high = (2.0, 2.0 * 10**thin)[:: 1 if upright else -1]
    c, s = ellipse_foot(y, z, wide, high)
    assert c * c + s * s == pytest.approx(1.0)
    foot = np.array([wide * c, high * s])
    away = np.array([y, z]) - foot
    along = np.array([-wide * s, high * c])
    assert abs(away @ along) <= 1e-5 * (np.hypot(y, z) + 2.0) * max(np.linalg.norm(along), 1e-9) + 1e-12
    angles = np.linspace(0.0, 2 * np.pi, 721)
    others = np.hypot(y - wide * np.cos(angles), z - high * np.sin(angles))
    assert np.linalg.norm(away) <= others.min() + 1e-6


def test_a_fin_that_ends_in_an_edge_is_painted_beside_itself_alone():
    """A tail that tapers to nothing across and is high: at its end the section is a line."""
    s = np.linspace(0.0, 1.0, STATIONS)
    shape, h = rod(s, 0.05 * (1 - s), np.full(s.size, 0.05)), 1 / 40
    x, y, z = points(h, 0.2, 0.5, 0.1)
    found = shape.measure((x + 0.98, y, z), 0.0, flow.Pose(position=(0.0, 0.0, 0.0)), 3 * h)
    beside = np.hypot(y[None, :, None], np.maximum(np.abs(z)[:, None, None] - 0.05, 0.0)) - 0.01
    far = np.broadcast_to(beside, found.distance.shape) > 3.2 * h
    assert far.sum() > 100
    assert found.distance[far].min() > 2.9 * h


@settings(max_examples=30, deadline=None)
@given(st.tuples(*[st.floats(-1.0, 1.0)] * 3), st.floats(-2.0, 2.0))
def test_no_path_from_cell_to_cell_crosses_a_closed_surface(normal, shift):
    """A plane wall: the faces between cells on both sides of it are closed, and no others."""
    n = np.array(normal)
    if np.linalg.norm(n) < 0.2:
        return
    n = n / np.linalg.norm(n)
    aside = np.linalg.svd(n[None])[2][1:]
    corners = np.array(
        [(shift + 0.01) * n + 20 * (a * aside[0] + b * aside[1]) for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
    )
    triangles = np.stack([corners[[0, 1, 2]], corners[[0, 2, 3]]], axis=2)
    size, first, h = 9, np.array([-4.0, -4.0, -4.0]), 1.0
    lines = first[:, None] + np.arange(-1, size)  # one more before the first cell
    z, y, x = np.meshgrid(*lines[::-1], indexing="ij")
    side = n[0] * x + n[1] * y + n[2] * z > shift + 0.01
    for c in range(3):
        passage = np.ones((size,) * 3, np.float32)
        close_surface(passage, c, triangles, first, h)
        axis, inner = 2 - c, (slice(1, None),) * 3
        before = [slice(1, None)] * 3
        before[axis] = slice(None, -1)
        apart = side[inner] != side[tuple(before)]
        assert np.array_equal(passage == np.float32(MIN_FLUID_FRACTION), apart)


@pytest.mark.parametrize("pose", [
    flow.Pose(position=(0.011, 0.007, 0.003)),
    flow.Pose(position=(0.011, 0.007, 0.003), angle=0.5),
    flow.Pose(position=(0.011, 0.007, 0.003), angle=0.5, roll=0.4),
])  # fmt: skip
def test_water_does_not_pass_through_a_disc_of_two_cells(pose):
    """An oblate spheroid 8 times as wide as thick: open to the pressure it had two thirds of its added mass."""
    shape, cells = egg(1.0, 0.125, 1.0), 16
    grid = flow.Grid(cells=(2 * cells,) * 3, cell=1 / cells, origin=(-1.0,) * 3)
    body = flow.Body(shape=shape, motion=pose)
    water = Fluid(grid, flow.Sides(), 1e-9, np.float32)
    water.place([body], [pose], 0.0)
    mass = added_mass(water, shape.markers(0.0, pose, 1 / cells), pose.position, 1.0)[:3, :3]
    across = pose.matrix[:, 1]
    assert across @ mass @ across == pytest.approx(oblate(0.125) * shape.volume(0.0), rel=0.06)


def test_the_middle_of_a_trunk_is_the_longer_axis_of_its_sections():
    """As far as they are slim: of half-axes a > b it reaches a (a^2 - b^2) / (a^2 + b^2); round ones have none."""
    s, here = np.linspace(0.0, 1.0, STATIONS), flow.Pose(position=(0.0, 0.0, 0.0))
    for wide, high, axis in ((0.02, 0.06, 2), (0.06, 0.02, 1)):
        found = rod(s, np.full(s.size, wide), np.full(s.size, high)).midsurface(0.0, here)
        assert np.abs(found[:, axis]).max() == pytest.approx(0.06 * 0.8)
        assert np.abs(found[:, 3 - axis]).max() == 0
        assert [found[:, 0].min(), found[:, 0].max()] == pytest.approx([1 / 30, 1 - 1 / 30])  # not its flat ends
    assert rod(s, np.full(s.size, 0.05), np.full(s.size, 0.05)).midsurface(0.0, here) is None

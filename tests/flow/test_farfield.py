"""Sides in space that move as in an unbounded domain: exact flows around them, and what the size of a box changes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from suchus import flow
from suchus.flow.added import added_mass
from suchus.flow.compiled import PAD
from suchus.flow.farfield import IMAGES, Fading, FarField

NONE = (0,) * 6
"""A window without bodies."""
CELL = 1 / 8


def on_faces(grid, field):
    """A field of three components of (3, ...) points on the faces before the cells, padded."""
    ends = [n + 2 * PAD for n in grid.cells]
    parts = []
    for c in range(3):
        lines = [(grid.faces if c == d else grid.centres)(0, ends[d], d) for d in range(3)]
        z, y, x = np.meshgrid(*reversed(lines), indexing="ij")
        parts.append(field(np.stack([x, y, z]))[c])
    return np.array(parts)


def pole(place, source, dipole):
    """The velocity that a source and a dipole at a place induce."""

    def field(points):
        r = points - np.reshape(place, (3, 1, 1, 1))
        square = (r * r).sum(axis=0)
        along = np.tensordot(dipole, r, 1) / square
        return ((source + 3 * along) * r - np.reshape(dipole, (3, 1, 1, 1))) / (4 * np.pi * square**1.5)

    return field


def imaged(field, mirrors, corner, count):
    """A field with its images in the mirrors at the low ends; between two mirrors ``count`` to each side."""
    lengths = np.array(GRID.cells) * CELL

    def whole(points):
        total = 0.0
        shifts = [range(-count, count + 1) if mirrors[2 * d] and mirrors[2 * d + 1] else (0,) for d in range(3)]
        for k in np.ndindex(*(len(s) for s in shifts)):
            shift = np.array([2 * s[n] * length for s, n, length in zip(shifts, k, lengths, strict=True)])
            for flips in np.ndindex(*(2 if mirrors[2 * d] else 1 for d in range(3))):
                sign = 1.0 - 2 * np.array(flips)
                middle = np.array(corner)
                seen = sign[:, None, None, None] * (points - (middle + shift)[:, None, None, None])
                total = total + sign[:, None, None, None] * field(seen + middle[:, None, None, None])
        return total

    return whole


GRID = flow.Grid(cells=(48, 32, 24), cell=CELL, origin=(-2.0, -1.0, 0.5))


def check(mirrors, field, *, within, fadings=()):
    """Sides that a field tells apart from its velocities on them, to a share of the fastest of them."""
    velocity = on_faces(GRID, field)
    sides = FarField(GRID, mirrors).inward(velocity, NONE, list(fadings))
    exact = []
    for k, side in enumerate(sides):
        axis, low = k // 2, k % 2 == 0
        here = [slice(PAD, -PAD)] * 3
        here[2 - axis] = PAD if low else PAD + GRID.cells[axis]
        exact.append((1 if low else -1) * velocity[axis][tuple(here)])
        assert side.shape == exact[-1].shape
    fastest = max(np.abs(e).max() for e, mirror in zip(exact, mirrors, strict=True) if not mirror)
    for side, e, mirror in zip(sides, exact, mirrors, strict=True):
        assert np.abs(side - (0 if mirror else e)).max() < within * fastest


@settings(max_examples=12, deadline=None)
@given(
    st.tuples(st.floats(0.0, 2.0), st.floats(0.7, 1.3), st.floats(1.8, 2.2)),
    st.floats(-1.0, 1.0),
    st.tuples(*[st.floats(-1.0, 1.0)] * 3),
)
def test_the_sides_move_as_sources_and_dipoles_move_them(place, source, dipole):
    if abs(source) + np.linalg.norm(dipole) < 0.1:
        return
    check((False,) * 6, pole(place, source, dipole), within=0.04)


@pytest.mark.parametrize("low", [(True, False, False), (False, True, False), (False, False, True), (True, True, True)])
def test_beyond_a_mirror_lies_the_image(low):
    corner, mirrors = GRID.origin, tuple(flag for one in low for flag in (one, False))
    field = imaged(pole((0.0, 0.9, 1.9), 0.7, (0.3, -0.5, 0.2)), mirrors, corner, 0)
    check(mirrors, field, within=0.08)  # with the images the domain is longer, and so are its panels


def test_between_two_mirrors_lie_many_images():
    mirrors = (False, False, False, False, True, True)
    field = imaged(pole((0.5, 1.0, 1.9), 0.7, (0.3, -0.5, 0.2)), mirrors, GRID.origin, IMAGES)
    check(mirrors, field, within=0.04)


def test_a_flow_that_comes_from_beyond_adds_nothing():
    """A stream, a strain and a source outside: without the exterior the sides would repeat what they impose."""
    strain = np.array([1.0, -0.4, -0.6])[:, None, None, None]
    beyond = pole((-4.0, 1.0, 1.0), 8.0, (0.0, 0.0, 0.0))
    for field in (np.ones_like, lambda points: strain * points, beyond):
        velocity = on_faces(GRID, field)
        sides = FarField(GRID, (False,) * 6).inward(velocity, NONE, [])
        assert max(np.abs(side).max() for side in sides) < 0.03 * np.abs(velocity).max()


@pytest.mark.parametrize("mirrors", [(False,) * 6, (False, False, False, False, True, False)])
def test_a_flat_domain_has_a_surface_too(mirrors):
    """The panels of a cube with as many cells would be longer than this one is high."""
    grid = flow.Grid(cells=(160, 160, 8), cell=CELL)
    far = FarField(grid, mirrors)
    for face in far.faces:
        assert all(0 <= a < b for a, b in face.spans)
    sides = far.inward(on_faces(grid, pole((10.0, 10.0, 0.0 if mirrors[4] else 0.5), 2.0, (0.0, 0.0, 0.0))), NONE, [])
    within = 1.0 if mirrors[4] else 2.0  # half of it lies beyond the mirror
    assert sum(side.sum() for side in sides) * CELL**2 == pytest.approx(-within, rel=0.15)


@pytest.mark.parametrize(("axis", "low"), [(0, False), (0, True), (1, False), (2, True)])
def test_a_wake_that_leaves_is_a_source(axis, low):
    """A source, and the flux that comes back to it along a tube: from afar, the source alone."""
    middle, flux, width = np.array([1.0, 1.0, 2.0]), 0.8, 0.22
    out = -1.0 if low else 1.0

    def field(points):
        r = points - middle[:, None, None, None]
        across = (r * r).sum(axis=0) - r[axis] ** 2
        both = pole(middle, flux, (0.0, 0.0, 0.0))(points)
        both[axis] -= out * flux / (np.pi * width**2) * np.exp(-across / width**2) * (out * r[axis] > 0)
        return both

    velocity = on_faces(GRID, field)
    far, exact = FarField(GRID, (False,) * 6), on_faces(GRID, pole(middle, flux, (0.0, 0.0, 0.0)))
    kept, left = (far.inward(velocity, NONE, [Fading(axis, low, share, 8.0)]) for share in (0.0, 1.0))
    assert sum(side.sum() for side in kept) * CELL**2 == pytest.approx(0.0, abs=0.05 * flux)
    assert sum(side.sum() for side in left) * CELL**2 == pytest.approx(-flux, rel=0.05)
    for k, side in enumerate(left):
        if k == 2 * axis + (not low):
            continue  # where the wake leaves no velocity is prescribed
        here = [slice(PAD, -PAD)] * 3
        here[2 - k // 2] = PAD if k % 2 == 0 else PAD + GRID.cells[k // 2]
        expected = (1 if k % 2 == 0 else -1) * exact[k // 2][tuple(here)]
        assert np.abs(side - expected).max() < 0.1 * np.abs(exact[:, PAD, PAD:-PAD, PAD:-PAD]).max() + 0.02 * flux


def ball(grid, *, stream=(1.0, 0.0, 0.0), mirrors=(), **changes):
    sides = flow.Sides(**dict.fromkeys(mirrors, flow.Mirror()))
    return flow.Simulation(
        flow.Setup(
            grid=grid, viscosity=0.01, stream=stream, sides=sides, density=1.0, tolerance=1e-5, coarse=True,
            bodies=(flow.Body(shape=flow.Sphere(diameter=1.0)),), **changes,
        )
    )  # fmt: skip


@pytest.mark.parametrize("axis", range(3))
def test_no_vorticity_comes_in_from_the_sides(axis):
    """It was 3 % of the stream's speed over the diameter when velocities along the sides were those inside them."""
    stream, cells, origin = np.eye(3)[axis], [24] * 3, [-1.5] * 3
    cells[axis], origin[axis] = 32, -2.0
    sim = ball(flow.Grid(cells=tuple(cells), cell=CELL, origin=tuple(origin)), stream=tuple(stream.tolist()))
    for _ in range(12):
        sim.advance()
    a = sim.water.velocity.astype(float)
    curl = []
    for c, d in ((0, 1), (1, 2), (2, 0)):
        rise = np.roll(a[d], 1, axis=2 - c) - np.roll(a[c], 1, axis=2 - d)
        curl.append((a[d] - a[c] - rise) / CELL)
    near = [slice(PAD + 1, -PAD)] * 3
    for first in (PAD, PAD + 2):  # on the side itself, and two cells downstream of it
        near[2 - axis] = first
        assert max(np.abs(part[tuple(near)]).max() for part in curl) < 1e-3


def test_the_size_of_the_box_changes_the_drag_by_less_than_a_hundredth():
    """A sphere at Re 100 from its start, in boxes 3 and 6 diameters wide, a quarter of each."""
    drag = []
    for wide in (12, 24):
        grid = flow.Grid(cells=(48, wide, wide), cell=CELL, origin=(-2.0, 0.0, 0.0))
        sim = ball(grid, mirrors=("bottom", "low"))
        sim.run(2.0, progress=False)
        drag.append(float(sim.record.force()[-20:, 0].mean()))
    assert drag[0] == pytest.approx(drag[1], rel=0.01)


def test_the_added_mass_of_a_long_body_does_not_depend_on_the_box():
    shape = flow.Ellipsoid(length=4.0, width=1.0, height=1.0)
    found = []
    for long, wide in ((6, 3), (8, 6)):
        grid = flow.Grid(cells=(8 * long, 8 * wide, 4 * wide), cell=CELL, origin=(-long / 2, -wide / 2, 0.0))
        sim = flow.Simulation(
            flow.Setup(
                grid=grid, viscosity=0.01, bodies=(flow.Body(shape=shape),), coarse=True,
                sides=flow.Sides(low=flow.Mirror()),
            )
        )  # fmt: skip
        pose = flow.Pose(position=(0.0,) * 3)
        sim.water.place(list(sim.setup.bodies), [pose], 0.0)
        mass = added_mass(sim.water, shape.markers(0.0, pose, CELL), (0.0,) * 3, 1.0)
        found.append(np.diag(mass)[:2] / shape.volume(0.0))
    assert found[0] == pytest.approx(found[1], rel=3e-3)  # one dipole in its middle had 7 and 1.2 %

"""Vortices in space and the surfaces around them, against exact answers."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from suchus import flow

H = 0.1


def nodes(n=12, h=H):
    """x, y, z of a cube of nodes around the origin, arrays of shape (z, y, x)."""
    line = h * (np.arange(n) - 0.5 * (n - 1))
    z, y, x = np.meshgrid(line, line, line, indexing="ij")
    return x, y, z


def linear(slope):
    """The velocity with a gradient, (component, direction)."""
    return np.einsum("ij,j...->i...", np.asarray(slope, float), np.stack(nodes()))


@settings(max_examples=30, deadline=None)
@given(st.lists(st.floats(-5.0, 5.0), min_size=9, max_size=9))
def test_the_gradient_of_a_linear_velocity_is_exact(numbers):
    slope = np.array(numbers).reshape(3, 3)
    found = flow.velocity_gradient(linear(slope), H)
    assert np.allclose(found, slope[:, :, None, None, None], atol=1e-9)
    strain, spin = 0.5 * (slope + slope.T), 0.5 * (slope - slope.T)
    q = 0.5 * ((spin**2).sum() - (strain**2).sum())
    assert np.allclose(flow.second_invariant(linear(slope), H), q, atol=1e-7)
    wanted = np.linalg.eigvalsh(strain @ strain + spin @ spin)[1]
    assert np.allclose(flow.lambda2(linear(slope), H), wanted, atol=1e-6)


@pytest.mark.parametrize("axis", range(3))
def test_solid_rotation_is_a_vortex_pure_strain_is_none_and_shear_lies_between(axis):
    rate = 3.0
    one, other = (axis + 1) % 3, (axis + 2) % 3
    turning, strained, sheared = (np.zeros((3, 3)) for _ in range(3))
    turning[one, other], turning[other, one] = -rate, rate
    strained[one, one], strained[other, other] = rate, -rate
    sheared[one, other] = rate
    for slope, q, second in ((turning, rate**2, -(rate**2)), (strained, -(rate**2), rate**2), (sheared, 0.0, 0.0)):
        assert np.allclose(flow.second_invariant(linear(slope), H), q)
        assert np.allclose(flow.lambda2(linear(slope), H), second)


def test_the_core_of_a_lamb_oseen_vortex_is_found_where_it_is():
    """In a plane flow without divergence both are the product of the two slopes, v/r and dv/dr."""
    h, core, strength = 0.02, 0.3, 2.0
    x, y, z = nodes(64, h)
    z, y, x = z[:5], y[:5], x[:5]
    r = np.hypot(x, y)
    share = np.exp(-((r / core) ** 2))
    speed = strength / (2 * np.pi * r) * (1 - share)
    velocity = np.stack([-speed * y / r, speed * x / r, np.zeros_like(x)])
    rise = strength / (2 * np.pi) * (2 * share / core**2 - (1 - share) / r**2)
    exact = speed / r * rise
    inner = np.s_[2, 2:-2, 2:-2]
    largest = (strength / (2 * np.pi * core**2)) ** 2  # in the middle
    assert np.abs(flow.second_invariant(velocity, h) - exact)[inner].max() < 0.01 * largest
    assert np.abs(flow.lambda2(velocity, h) + exact)[inner].max() < 0.01 * largest
    edge = 1.1209 * core  # where the speed is greatest and both change their sign
    inside = flow.second_invariant(velocity, h)[inner] > 0
    assert np.pi * edge**2 == pytest.approx(inside.sum() * h**2, rel=0.02)


def areas(surface):
    a, b, c = (surface.points[surface.faces[:, k]] for k in range(3))
    return 0.5 * np.cross(b - a, c - a), (a + b + c) / 3


def edges(faces):
    """How often each edge is passed, in its direction."""
    directed = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return np.unique(directed, axis=0, return_counts=True)


def ball(n=24, radius=0.7):
    h = 2.0 / n
    x, y, z = nodes(n, h)
    return flow.isosurface(radius - np.sqrt(x**2 + y**2 + z**2), 0.0, (x[0, 0, 0], y[0, 0, 0], z[0, 0, 0]), h)


def test_the_surface_of_a_ball_is_closed_has_its_area_and_volume_and_faces_outward():
    errors = []
    for n in (16, 32, 64):
        surface = ball(n)
        normal, middle = areas(surface)
        area, volume = np.linalg.norm(normal, axis=1).sum(), (normal * middle).sum() / 3
        errors.append((abs(area / (4 * np.pi * 0.7**2) - 1), abs(volume / (4 / 3 * np.pi * 0.7**3) - 1)))
        assert volume > 0
        assert ((normal * middle).sum(axis=1) > 0).all()
        passed, count = edges(surface.faces)
        assert (count == 1).all()
        assert {tuple(edge) for edge in passed} == {tuple(edge[::-1]) for edge in passed}
        corners, kept, triangles = len(surface.points), len(passed) // 2, len(surface.faces)
        assert corners - kept + triangles == 2
    assert errors[-1][0] < 0.003
    assert errors[-1][1] < 0.003
    assert all(later < earlier / 3 for part in zip(*errors, strict=True) for earlier, later in pairwise(part))


def test_the_surface_of_a_linear_field_is_a_plane():
    x, y, z = nodes()
    normal = np.array([0.3, -0.5, 0.8]) / np.linalg.norm([0.3, -0.5, 0.8])
    field = normal[0] * x + normal[1] * y + normal[2] * z
    surface = flow.isosurface(field, 0.05, (x[0, 0, 0], y[0, 0, 0], z[0, 0, 0]), H)
    assert surface.points @ normal == pytest.approx(0.05)
    facing, _ = areas(surface)
    assert facing @ -normal == pytest.approx(np.linalg.norm(facing, axis=1))  # from high to low
    at = surface.places * H + [z[0, 0, 0], y[0, 0, 0], x[0, 0, 0]]
    assert at[:, ::-1] == pytest.approx(surface.points)


def test_a_field_that_has_the_value_nowhere_has_no_surface():
    surface = flow.isosurface(np.zeros((4, 5, 6)), 1.0, (0.0, 0.0, 0.0), H)
    assert surface.points.shape == surface.places.shape == (0, 3)
    assert surface.faces.shape == (0, 3)

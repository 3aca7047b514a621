"""Surfaces around vortices, and pictures of surfaces in space."""

from io import BytesIO

import numpy as np
import pytest
from PIL import Image
from tests.wakes import CORE, RADIUS, ringed

from suchus.visual.figures import caption, vortices
from suchus.visual.figures.vortices import Viewpoint, picture
from suchus.visual.skin.mesh import Mesh


def square(x, colour, size=1.0):
    """A square across the x axis that faces along it."""
    corners = 0.5 * size * np.array([[0, -1, -1], [0, 1, -1], [0, 1, 1], [0, -1, 1]]) + [x, 0, 0]
    return Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]]), np.tile(np.array(colour, float), (4, 1)))


NOTHING = Mesh(np.zeros((0, 3)), np.zeros((0, 3), int), np.zeros((0, 3)))
AHEAD = Viewpoint(azimuth=0.0, elevation=0.0, distance=10.0, target=(0.0, 0.0, 0.0), width=4.0)


def test_a_square_is_seen_where_and_as_large_as_perspective_says():
    at, depth = AHEAD.project(np.array([[0.0, 1.0, 0.5], [5.0, 1.0, 0.5]]), (400, 200))
    assert at == pytest.approx(np.array([[300.0, 150.0], [400.0, 200.0]]))
    assert depth == pytest.approx([10.0, 5.0])
    shown = picture(square(0.0, (0, 0, 0)), NOTHING, AHEAD, (400, 200))
    assert (shown < 128).any(axis=2).sum() == pytest.approx(100 * 100, rel=0.01)
    edge_on = picture(square(0.0, (0, 0, 0)), NOTHING, AHEAD._replace(azimuth=np.pi / 2), (80, 40))
    assert (edge_on < 128).any(axis=2).sum() <= 25


def test_what_is_near_hides_what_is_far_and_clear_surfaces_let_solids_through():
    red, green = (1, 0, 0), (0, 1, 0)

    def middle(solid, clear):
        return picture(solid, clear, AHEAD, (80, 40))[20, 40].astype(int)

    near, far = square(1.0, red), square(-1.0, green)
    front = middle(near, far)
    assert front[0] > 150 > 20 > front[1] - front[2]  # the solid in front is red alone
    through = middle(far, near)
    assert through[0] > 3 * through[1] > 3 * through[2]  # the clear one lets a fifth of the green through
    assert through[1] - through[2] == pytest.approx(0.2 * middle(far, NOTHING)[1], rel=0.1)


def test_the_surface_around_a_ring_vortex_has_its_area_and_is_closed_by_its_image():
    record = ringed()
    found, spin = vortices.surface(record, 0)
    a, b, c = (found.points[found.faces[:, k]] for k in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
    assert area == pytest.approx(2 * np.pi**2 * RADIUS * CORE, rel=0.02)  # half of a torus
    assert found.points[:, 2].min() == pytest.approx(0.0, abs=1e-9)
    assert np.sign(spin[found.points[:, 1] > 0.05]).min() == 1
    assert np.abs(spin).max() == pytest.approx(10.0)
    coarse, _ = vortices.surface(record, 0, coarse=2)
    assert len(coarse.faces) < len(found.faces) / 3
    assert np.ptp(coarse.points, axis=0) == pytest.approx(np.ptp(found.points, axis=0), abs=0.03)
    moved, _ = vortices.surface(record, 1)
    assert (moved.points.mean(axis=0) - found.points.mean(axis=0))[0] == pytest.approx(0.1, abs=1e-3)


def test_the_body_is_as_wide_and_high_as_its_sections():
    mesh = vortices.body(ringed(), 0)
    assert np.ptp(mesh.vertices, axis=0) == pytest.approx([1.0, 0.1, 0.08], rel=1e-3)


def test_figure_and_film_show_both():
    record = ringed()
    figure = vortices.draw_vortices(record)
    assert "on 64 cells a length at f L² / ν = 7000" in caption(figure)
    assert "Q = 4 1/s²" in caption(figure)
    shown = vortices.still_picture(record, 0)
    ink = shown.astype(int)
    red, blue = ((ink[..., k] - ink[..., 2 - k] > 40).sum() for k in (0, 2))
    assert min(red, blue) > 1000
    told = []
    data = vortices.film_vortices(record, lambda _, share: told.append(share))
    assert told == pytest.approx([1 / 3, 2 / 3, 1.0])
    with Image.open(BytesIO(data)) as film:
        assert film.n_frames == 3
        assert film.size == (720, 400)

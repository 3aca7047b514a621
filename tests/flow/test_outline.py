"""Shapes from outlines and from distances, against those that are known."""

import sys
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from suchus import flow
from suchus.core.errors import InvalidDesign, UnreadableFile
from suchus.flow import paint

ELLIPSE = flow.Ellipse(length=2.0, width=0.7)
SQUARE = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
BOX = (-1.2, 1.2, -0.6, 0.6)
POINTS = np.random.default_rng(2).uniform(-1.4, 1.4, (2, 400))


def round_corners(count=240):
    return np.stack(ELLIPSE.outline(count), axis=1)


MAKERS = {
    "square": lambda: flow.Polygon(corners=SQUARE),
    "outline": lambda: flow.from_outline(round_corners()[::-1]),
    "distance": lambda: flow.from_sdf(lambda x, y: ELLIPSE.distance(x, y)[0], BOX),
    "union": lambda: flow.union(flow.Cylinder(diameter=0.8), flow.Plate(length=1.5, thick=0.3)),
    "difference": lambda: flow.difference(
        flow.Cylinder(diameter=1.0), flow.Polygon(corners=SQUARE + np.array([0.75, 0.0]))
    ),
    "scaled": lambda: flow.scaled(ELLIPSE, 0.5),
}


@cache
def shape_of(name):
    """An outline is searched for a second: when a test wants it, not when the tests are collected."""
    return MAKERS[name]()


@pytest.fixture
def shape(request):
    return shape_of(request.param)


@pytest.mark.parametrize("shape", MAKERS, indirect=True)
def test_distance_is_that_to_the_nearest_marker_and_the_normal_its_slope(shape):
    m = shape.markers(0.0, flow.Pose(), 0.004)
    x, y = POINTS[:, :200]
    d, nx, ny = shape.distance(x, y)
    nearest = np.sqrt(((x[:, None] - m.x) ** 2 + (y[:, None] - m.y) ** 2).min(axis=1))
    assert np.hypot(nx, ny) == pytest.approx(1, abs=1e-6)
    near = (nearest < 0.15) & (nearest > 0.02)
    assert np.abs(d)[near] == pytest.approx(nearest[near], abs=0.06 if "Implicit" in type(shape).__name__ else 0.01)
    e = 1e-3
    ahead = shape.distance(x + e * nx, y + e * ny)[0]
    assert np.median((ahead - d)[near] / e) == pytest.approx(1, abs=1e-3)


@pytest.mark.parametrize("shape", MAKERS, indirect=True)
def test_markers_close_and_enclose_the_area(shape):
    m = shape.markers(0.0, flow.Pose(), 0.01)
    assert abs((m.normals[0] * m.weight).sum()) < 1e-9
    area = 0.5 * ((m.x * m.normals[0] + m.y * m.normals[1]) * m.weight).sum()
    assert area == pytest.approx(shape.mass(0.0).volume, rel=0.01)
    grid = np.linspace(-1.4, 1.4, 141)
    inside = shape.distance(*np.meshgrid(grid, grid))[0] < 0
    assert inside.sum() * (grid[1] - grid[0]) ** 2 == pytest.approx(area, rel=0.03)


def test_the_distance_to_a_square_is_exact():
    x, y = POINTS
    over = np.stack([np.abs(x) - 0.5, np.abs(y) - 0.5])
    exact = np.hypot(*np.maximum(over, 0)) + np.minimum(over.max(axis=0), 0)
    assert shape_of("square").distance(x, y)[0] == pytest.approx(exact, abs=1e-12)
    assert shape_of("square").thickness(0.0)[1][0] == pytest.approx(1.0, abs=0.02)
    assert shape_of("square").mass(0.0).moments[0, 0] == pytest.approx(1 / 6, rel=1e-3)


@pytest.mark.parametrize("shape", ["outline", "distance"], indirect=True)
def test_an_ellipse_by_its_outline_or_its_distance_is_the_ellipse(shape):
    x, y = POINTS
    right, got = ELLIPSE.distance(x, y), shape.distance(x, y)
    near = np.abs(right[0]) < 0.3
    assert got[0][near] == pytest.approx(right[0][near], abs=1e-3)
    clear = near & (np.abs(right[0]) > 0.05)
    assert (got[1] * right[1] + got[2] * right[2])[clear].min() > 0.99
    assert shape.mass(0.0).moments[0, 0] == pytest.approx(ELLIPSE.mass(0.0).moments[0, 0], rel=1e-3)
    assert shape.thickness(0.0)[1][0] == pytest.approx(0.7, abs=0.02)


def plainly(corners, x, y):
    """Distance and foot point of a polygon, edge by edge, as it is written in words."""
    nearest, foot, inside = np.full(x.shape, np.inf), np.zeros((2, *x.shape)), np.zeros(x.shape, bool)
    for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        share = np.clip(((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / ((bx - ax) ** 2 + (by - ay) ** 2), 0, 1)
        at = np.stack([ax + share * (bx - ax), ay + share * (by - ay)])
        gap = np.hypot(x - at[0], y - at[1])
        nearest, foot = np.where(gap < nearest, gap, nearest), np.where(gap < nearest, at, foot)
        if ay != by:
            inside ^= ((ay <= y) != (by <= y)) & (x < ax + (y - ay) / (by - ay) * (bx - ax))
    return np.where(inside, -nearest, nearest), foot


TURNS = np.linspace(0, 2 * np.pi, 24, endpoint=False)
STAR = np.stack([np.cos(TURNS), np.sin(TURNS)], axis=1) * np.tile([1.0, 0.4], 12)[:, None]


@given(st.integers(0, 10**6), st.floats(-3.2, 3.2), st.floats(-2, 2))
@settings(max_examples=25, deadline=None)
def test_what_is_painted_of_an_outline_is_its_distance(seed, angle, across):
    """Any polygon in any pose: distance, foot point and velocity to 1e-12 within reach; beyond it, no nearer."""
    corners = STAR * np.random.default_rng(seed).uniform(0.7, 1.4, (24, 1))
    shape, h = flow.Polygon(corners=corners), 0.037
    pose = flow.Pose(position=(across, 0.3), angle=angle, velocity=(0.1, 0.2), spin=0.3)
    x, y = across + h * np.arange(-44, 45), 0.3 + h * np.arange(-40, 41)
    found, points = shape.measure((x, y), 0.0, pose, 4 * h), np.meshgrid(x, y)
    distance, foot = plainly(shape.corners, *pose.to_body(points))
    foot = np.stack(pose.to_world(foot))
    near = np.abs(distance) < 3.99 * h
    assert np.abs(found.distance - distance)[near].max() < 1e-12
    assert np.abs(found.distance - np.clip(distance, -4 * h, 4 * h)).max() < 1e-12
    back = np.stack(points) - found.distance * np.stack(found.normal)
    off = np.hypot(*(back - foot))[near]
    assert (np.abs(off) < 1e-12).mean() > 0.99  # but for points as near to two edges
    assert np.abs(shape.distance(*pose.to_body(back))[0][near]).max() < 1e-12
    assert all(np.array_equal(a, b) for a, b in zip(found.velocity, pose.velocity_at(points), strict=True))
    assert np.isinf(found.thickness).all()


def test_a_moving_outline_is_placed_by_the_points_near_each_edge(monkeypatch):
    """Not by a loop over its corners in Python, and not by its distance from every point: 20 times slower, once."""
    monkeypatch.setattr(flow.Polygon, "distance", None)
    x, reach, calls = np.linspace(-1.3, 1.3, 260), 0.04, []
    for count in (24, 240):
        shape, events = flow.from_outline(round_corners(count)), []
        shape.measure((x, x), 0.0, flow.Pose(angle=0.2), reach)
        sys.setprofile(lambda frame, event, _, events=events: events.append(event))
        shape.measure((x, x), 0.0, flow.Pose(angle=0.2), reach)
        sys.setprofile(None)
        calls.append(len(events))
    assert calls[0] == calls[1]
    pairs, distance = [], paint.distance_to_edge.py_func
    monkeypatch.setattr(paint, "distance_to_edge", lambda *given: pairs.append(given) or distance(*given))
    square, edge, outline = np.full((x.size, x.size), reach**2), np.full((x.size, x.size), -1), round_corners().T
    paint._paint_edges(square, edge, np.zeros(square.shape), (0, x.size), outline, x[0], x[0], x[1] - x[0], reach)
    near = np.count_nonzero(edge >= 0)
    assert near > 1000
    assert near <= len(pairs) < 20 * near < 0.01 * square.size * outline.shape[1]


@pytest.mark.parametrize(("factor", "angle"), [(0.4, 1.1), (2.5, -2.0)])
def test_scaling_and_turning_do_what_they_say(factor, angle):
    shape = flow.scaled(ELLIPSE, factor)
    assert shape.mass(0.0).volume == pytest.approx(factor**2 * ELLIPSE.mass(0.0).volume, rel=1e-3)
    pose = flow.Pose(position=(0.3, -0.2), angle=angle)
    m, n = shape.markers(0.0, pose, 0.05), shape.markers(0.0, flow.Pose(), 0.05)
    assert (m.x, m.y) == tuple(pytest.approx(a) for a in pose.to_world(n.points))


def test_a_union_and_an_enlarged_solid_in_space_have_their_volume():
    """Of a rod with round ends and a ball in its middle, thicker than the rod; the formula is that of the cap."""
    rod, ball, r, big = flow.Spherocylinder(length=1.0, radius=0.1), flow.Sphere(diameter=0.5), 0.1, 0.25
    half = np.sqrt(big**2 - r**2)  # where the rod leaves the ball
    cap = big - half
    shared = np.pi * r**2 * 2 * half + 2 * np.pi * cap**2 * (3 * big - cap) / 3
    both = flow.union(rod, ball)
    assert both.volume(0.0) == pytest.approx(rod.volume(0.0) + ball.volume(0.0) - shared, rel=5e-3)
    twice = flow.scaled(ball, 2.0)
    assert twice.volume(0.0) == pytest.approx(8 * ball.volume(0.0), rel=2e-3)


@pytest.mark.parametrize("shape", [flow.Sphere(diameter=0.7), flow.Ellipsoid(length=0.9, width=0.6, height=0.3)])
def test_an_ellipsoid_has_the_same_distance_at_points_as_on_a_window(shape):
    lines = [np.linspace(-0.7, 0.6, n) for n in (14, 15, 16)]
    still = flow.Pose(position=(0.0, 0.0, 0.0))
    found = shape.measure(lines, 0.0, still, 9.0)
    points = np.meshgrid(*lines[::-1], indexing="ij")[::-1]
    distance, *normal = shape.distance(*points)
    np.testing.assert_allclose(distance, found.distance, atol=1e-12)
    np.testing.assert_allclose(normal, found.normal, atol=1e-9)


@pytest.mark.parametrize(
    ("make", "part"),
    [
        (lambda: flow.union(flow.Cylinder(diameter=1.0), flow.Sphere(diameter=1.0)), "Cylinder and Sphere cannot be"),
        (lambda: flow.union(flow.Sphere(diameter=1.0), flow.eel_in_space(1.0)), "are Sphere and Trunk; give a Solid"),
        (lambda: flow.scaled(flow.foil(1.0, thickness=0.2), 2.0), "Midline; give a Solid"),
    ],
)
def test_shapes_that_cannot_be_joined_are_refused(make, part):
    with pytest.raises(InvalidDesign, match=part):
        make()


@pytest.mark.parametrize("function", [
    lambda x, y: 10 * ELLIPSE.distance(x, y)[0],
    lambda x, y: (x / 1.0) ** 2 + (y / 0.35) ** 2 - 1,
    lambda x, y: 1e-4 * (np.hypot(x, y / 0.35) - 1),
    lambda x, y: np.tanh(ELLIPSE.distance(x, y)[0] / 0.2),
])  # fmt: skip
def test_what_is_no_distance_is_divided_by_its_gradient(function):
    """Near the surface: within a twentieth of the body's width to the first order."""
    shape, (x, y) = flow.from_sdf(function, BOX), np.random.default_rng(3).uniform(-1.1, 1.1, (2, 4000))
    right, got = ELLIPSE.distance(x, y), shape.distance(x, y)
    near = np.abs(right[0]) < 0.03
    assert got[0][near] == pytest.approx(right[0][near], rel=0.15, abs=1e-4)
    assert (got[1] * right[1] + got[2] * right[2])[near].min() > 0.97
    inside, far = right[0] < -0.03, right[0] > 0.03
    assert shape.thickness(0.0)[1][0] == pytest.approx(0.7, abs=0.02)
    assert got[0][inside].max() < -0.02
    assert got[0][far].min() > 0.02


@pytest.mark.parametrize(("gradient", "kept"), [(1.015, True), (0.985, True), (1.03, False), (0.97, False)])
def test_a_distance_is_left_as_it_is(gradient, kept):
    """Also one that has corners, as unions do, and lines on which it has no gradient."""
    circle, plate = flow.Cylinder(diameter=0.8), flow.Plate(length=1.5, thick=0.3)

    def both(x, y):
        return gradient * np.minimum(circle.distance(x, y)[0], plate.distance(x, y)[0])

    shape = flow.from_sdf(both, BOX)
    assert np.array_equal(shape.distance(*POINTS)[0], both(*POINTS)) == kept


@pytest.mark.parametrize("text", [
    "-0.5 -0.5\n0.5 -0.5\n0.5 0.5\n-0.5 0.5\n",
    "4\n-0.5 -0.5\n0.5 -0.5\n0.5 0.5\n-0.5 0.5\n",
    "a square\n  4\n-0.5 -0.5\n0.5 -0.5\n0.5 0.5\n-0.5 0.5\n",
    "x,y\n-0.5,-0.5\n0.5,-0.5  # a corner\n\n0.5,0.5\n-0.5,0.5\n-0.5,-0.5\n",
])  # fmt: skip
def test_an_outline_from_a_file(text, tmp_path):
    path = tmp_path / "a square.csv"
    path.write_text(text)
    assert np.array_equal(flow.from_outline(path).corners, SQUARE)
    assert np.array_equal(flow.from_outline(str(path)).corners, SQUARE)


def test_an_outline_of_two_surfaces_begins_with_two_counts(tmp_path):
    """As collections of aerofoils have it: both from the nose on, the nose in both or in one."""
    upper, lower = "0 0\n0.5 0.1\n1 0\n", "0 0\n0.4 -0.1\n1 -0.01\n"
    for text in (f"FOIL\n3. 3.\n\n{upper}\n{lower}", f"3 2\n{upper}{lower.removeprefix('0 0' + chr(10))}"):
        path = tmp_path / "foil.dat"
        path.write_text(text)
        assert flow.from_outline(path).corners.tolist() == [[1, 0], [0.5, 0.1], [0, 0], [0.4, -0.1], [1, -0.01]]


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("5\n-0.5 -0.5\n0.5 -0.5\n0.5 0.5\n-0.5 0.5\n", "the row '5'; .* the count of rows after it, here 4"),
        ("0 0\n1 0\n1\n", "the row '1'.$"),
        ("3\n", "the row '3'; a single number at the beginning is the count of rows after it, here 0"),
        ("nan\n1 0\n0 1\n", "the row 'nan'"),
        ("1 2 3\n4 5 6\n7 8 9\n", "two columns"),
        ("", "two columns"),
        ("1 2\n3 four\n5 6\n", "two columns"),
        (None, "cannot be read"),
    ],
)
def test_a_file_that_is_no_outline_is_refused(text, part, tmp_path):
    path = tmp_path / "outline.txt"
    if text is not None:
        path.write_text(text)
    with pytest.raises(UnreadableFile, match=part):
        flow.from_outline(path)


@pytest.mark.parametrize(("make", "part"), [
    (lambda: flow.Polygon(corners=SQUARE[[0, 2, 1, 3]]), "crosses itself: edge 0 .* edge 2"),
    (lambda: flow.Polygon(corners=SQUARE[:2]), "at least 3"),
    (lambda: flow.Polygon(corners=np.full((4, 2), np.nan)), "two finite numbers"),
    (lambda: flow.from_sdf(lambda x, y: np.hypot(x, y) + 1, BOX), "nowhere negative"),
    (lambda: flow.from_sdf(lambda x, y: np.hypot(x, y) - 1, BOX), "larger box"),
    (lambda: flow.from_sdf(lambda x, y: x * np.nan, BOX), "not a finite number"),
    (lambda: flow.scaled(ELLIPSE, -1.0), "factor is -1.0"),
])  # fmt: skip
def test_outlines_that_cannot_be_are_refused(make, part):
    with pytest.raises(InvalidDesign, match=part):
        make()


def test_an_oscillation_about_a_mean_angle():
    motion = flow.Oscillation(frequency=0.5, pitch=0.2, mean_angle=0.6)
    assert motion(0.0).angle == pytest.approx(0.6)
    assert motion(0.5).angle == pytest.approx(0.8)
    assert motion(0.0).spin == pytest.approx(0.2 * np.pi)

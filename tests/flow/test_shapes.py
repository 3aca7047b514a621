from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from suchus import flow
from suchus.core.errors import InvalidDesign
from suchus.flow.midline import CachedMidline

STILL = flow.Pose()
SHAPES = [
    flow.Cylinder(diameter=1.0),
    flow.Ellipse(length=2.0, width=0.7),
    flow.Plate(length=2.0, thick=0.3),
    flow.foil(2.0, thickness=0.2),
    flow.foil(2.0, thickness=0.2, camber=0.04),
]


def test_distance_to_a_circle_is_exact():
    axis = np.linspace(-1, 1, 21)
    field = SHAPES[0].measure((axis, axis), 0.0, STILL, 1.0)
    assert field.distance == pytest.approx(np.hypot(axis[None, :], axis[:, None]) - 0.5, abs=1e-12)


@pytest.mark.parametrize("shape", SHAPES)
def test_distance_is_that_to_the_nearest_marker(shape):
    pose = flow.Pose(position=(0.3, -0.1), angle=0.4)
    x, y = np.arange(-2, 3, 0.08), np.arange(-2, 2, 0.08)
    field = shape.measure((x, y), 0.0, pose, 0.5)
    m = shape.markers(0.0, pose, 0.004)
    gx, gy = np.meshgrid(x, y)
    nearest = np.sqrt(((gx[..., None] - m.x) ** 2 + (gy[..., None] - m.y) ** 2).min(axis=-1))
    near = nearest < 0.4
    assert np.abs(np.abs(field.distance) - nearest)[near].max() < 0.01
    assert np.hypot(*field.normal)[near & (nearest > 1e-3)] == pytest.approx(1, abs=1e-6)


@pytest.mark.parametrize("shape", SHAPES)
def test_normals_close_and_markers_enclose_the_area(shape):
    m = shape.markers(0.0, STILL, 0.01)
    assert abs((m.normals[0] * m.weight).sum()) < 1e-9
    assert abs((m.normals[1] * m.weight).sum()) < 1e-9
    area = 0.5 * ((m.x * m.normals[0] + m.y * m.normals[1]) * m.weight).sum()
    assert area == pytest.approx(shape.mass(0.0).volume, rel=0.01)
    assert area > 0


def test_mass_of_circle_and_ellipse():
    mass = flow.Cylinder(diameter=1.0).mass(0.0)
    assert (mass.volume, mass.moments[0, 0]) == pytest.approx((np.pi / 4, np.pi / 32), rel=1e-4)
    mass = flow.Ellipse(length=2.0, width=1.0).mass(0.0)
    assert mass.moments[0, 0] == pytest.approx(np.pi * 1.0 * 0.5 * (1 + 0.25) / 4, rel=1e-4)


def _eel(time):
    return flow.eel(1.0).spine(time)


def test_rates_of_the_eel_are_the_derivatives():
    t, dt = 0.37, 1e-6
    before, now, after = _eel(t - dt), _eel(t), _eel(t + dt)
    for name in ("x", "y", "heading"):
        rate = (getattr(after, name) - getattr(before, name)) / (2 * dt)
        assert getattr(now, f"{name}_rate") == pytest.approx(rate, abs=1e-7)


def test_a_remembered_midline_is_the_midline_whatever_becomes_of_what_was_given():
    """As where a user's function writes into arrays that it has from the start."""
    asked, room = [], np.zeros(5)

    def spine(time):
        asked.append(time)
        room[:] = time * np.arange(5)
        still = np.zeros(5)
        return flow.MidlineState(
            x=np.arange(5.0), y=room, heading=still, half_width=still + 0.1, x_rate=still, y_rate=np.arange(5.0),
            heading_rate=still,
        )  # fmt: skip

    kept = CachedMidline(spine)
    for time in (0.1, 0.2, 0.1, 0.3, 0.4, 0.1, 0.2):
        assert np.array_equal(kept(time).y, time * np.arange(5))
    assert asked == [0.1, 0.2, 0.3, 0.4]
    assert kept(0.5) is kept(0.5)
    kept(0.1)
    assert asked == [0.1, 0.2, 0.3, 0.4, 0.5, 0.1]


def test_a_remembered_midline_is_where_it_is_asked_for_and_anew_once_it_is_forgotten():
    spine, eel = flow.eel(1.0, stations=33).spine, {"size": 1.0}
    kept = CachedMidline(lambda time: replace(spine(time), half_width=eel["size"] * spine(time).half_width))
    here, there = flow.Pose(position=(0.1, 0.2), angle=0.3), flow.Pose(position=(0.1, 0.2), angle=0.4)
    for time, pose in ((0.1, here), (0.1, there), (0.2, there), (0.1, here)):
        placed = kept.in_world(time, pose)
        np.testing.assert_array_equal(placed.rows, kept(time).in_world(pose).rows)
        assert kept.in_world(time, replace(pose)) is placed
    eel["size"] = 0.5
    kept.clear()
    np.testing.assert_array_equal(kept.in_world(0.1, here).half_width, 0.5 * spine(0.1).half_width)


def test_a_step_makes_a_midline_once():
    """At its end; once in eight steps, when its rates are compared, near its start too."""
    asked, eel = [], flow.eel(1.0, stations=65)
    body = flow.Body(shape=flow.Midline(spine=lambda time: asked.append(time) or eel.spine(time)))
    grid = flow.Grid(cells=(96, 64), cell=1 / 48, origin=(-0.5, -0.65))
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1e-3, bodies=(body,), coarse=True, step=0.004))
    sim.advance()
    del asked[:]
    for _ in range(7):
        sim.advance()
    assert len(asked) == 7


def test_centre_rate_of_the_eel_is_nearly_the_derivative_of_its_centre():
    shape, t, dt = flow.eel(1.0), 0.2, 1e-5
    a, b = shape.mass(t - dt), shape.mass(t + dt)
    rate = (np.array(b.centre) - np.array(a.centre)) / (2 * dt)
    assert shape.mass(t).centre_rate == pytest.approx(rate, abs=0.02)


def test_velocity_is_continuous_across_the_midline():
    spine = _eel(0.1)
    k = 150
    nx, ny = -np.sin(spine.heading[k]), np.cos(spine.heading[k])
    x = spine.x[k] + np.array([-1e-6, 1e-6]) * nx
    y = spine.y[k] + np.array([-1e-6, 1e-6]) * ny
    out = []
    for px, py in zip(x, y, strict=True):
        f = flow.eel(1.0).measure((np.array([px, px + 0.01]), np.array([py, py + 0.01])), 0.1, STILL, 0.05)
        out.append((f.velocity[0][0, 0], f.velocity[1][0, 0]))
    assert out[0] == pytest.approx(out[1], abs=1e-4)
    assert out[0][1] == pytest.approx(spine.y_rate[k], abs=1e-3)


@settings(max_examples=20, deadline=None)
@given(st.floats(-3, 3), st.floats(-1, 1), st.floats(-1, 1))
def test_a_turned_midline_is_the_turned_field(angle, px, py):
    pose = flow.Pose(position=(px, py), angle=angle, velocity=(0.3, 0.1), spin=0.7)
    shape = flow.eel(1.0, stations=65)
    m, n = shape.markers(0.2, STILL, 0.05), shape.markers(0.2, pose, 0.05)
    wx, wy = pose.to_world(m.points)
    assert (n.x, n.y) == (pytest.approx(wx), pytest.approx(wy))
    vx, vy = pose.rotate(m.velocities)
    cx, cy = pose.velocity_at((wx, wy))
    assert n.velocities[0] == pytest.approx(vx + cx, abs=1e-9)
    assert n.velocities[1] == pytest.approx(vy + cy, abs=1e-9)


def test_a_blunted_eel_keeps_its_head_and_gets_a_round_tail():
    sharp = _eel(0.3)
    blunt = sharp.thickened(0.01)
    assert (blunt.half_width[:100] == sharp.half_width[:100]).all()
    left = sharp.arc[-1] - sharp.arc
    assert blunt.half_width[(left > 0.01) & (sharp.arc > 0.5) & (sharp.half_width < 0.01)] == pytest.approx(0.01)
    end = left < 0.01
    assert np.hypot(blunt.half_width, 0.01 - left)[end] == pytest.approx(0.01)
    assert (blunt.half_width >= sharp.half_width).all()


def line(shape, time):
    """The line in the middle of a thin shape, from its pieces."""
    start, end = shape.midsurface(time, STILL)
    assert np.array_equal(start[:, 1:], end[:, :-1])
    return np.concatenate([start, end[:, -1:]], axis=1)


def test_the_middle_of_a_tail_ends_where_its_tip_is_round():
    """It goes on to a sharp tip; in a round one it would close faces that the kernel leaves open."""
    arc, x = _eel(0.3).arc, line(flow.eel(1.0), 0.3)[0]
    assert arc[-1] - np.interp(x[-1], _eel(0.3).x, arc) < 1e-3
    assert x[0] > 0.04  # the head is round
    least = 0.02
    blunt = flow.Midline(spine=lambda t: _eel(t).thickened(least))
    spine, x = blunt.spine(0.3), line(blunt, 0.3)[0]
    assert spine.arc[-1] - np.interp(x[-1], spine.x, spine.arc) == pytest.approx(least, abs=2e-3)
    assert flow.Cylinder(diameter=1.0).midsurface(0.0, STILL) is None
    ellipse = flow.Ellipse(length=2.0, width=0.4)
    (_, reach), _ = line(ellipse, 0.0)
    assert 0.2 * np.sqrt(1 - reach**2) == pytest.approx(1 - reach, abs=1e-9)  # as wide there as far from the tip


def test_naca_0012_is_twelve_percent_thick():
    _, thickness = flow.foil(1.0, thickness=0.12).thickness(0.0)
    assert thickness.max() == pytest.approx(0.12, rel=1e-3)
    assert thickness[-1] == pytest.approx(0, abs=1e-3)


@pytest.mark.parametrize(
    ("make", "part"),
    [
        (lambda: flow.Cylinder(diameter=-1.0), "diameter is -1.0 m"),
        (lambda: flow.Plate(length=0.1, thick=0.2), "0.2 m thick"),
        (lambda: flow.foil(1.0, thickness=0.9), "thickness 0.9"),
        (
            lambda: flow.MidlineState(
                x=np.zeros(3),
                y=np.zeros(4),
                heading=np.zeros(3),
                half_width=np.zeros(3),
                x_rate=np.zeros(3),
                y_rate=np.zeros(3),
                heading_rate=np.zeros(3),
            ),
            "y of the midline",
        ),
    ],
)
def test_impossible_shapes_are_refused(make, part):
    with pytest.raises(InvalidDesign, match=part):
        make()


@pytest.mark.parametrize("time", [0.0, 1.0, 2.0])
def test_a_row_through_nose_and_tail_is_outside_beyond_them(time):
    x = np.arange(-40, 260) / 128
    y = -0.25 + np.arange(64) / 128  # one row lies on the eel's nose and tail tip
    field = flow.eel(1.0).measure((x, y), time, STILL, 0.03)
    assert (field.distance[:, x > 1.01] > 0).all()
    assert (field.distance[:, x < -0.01] > 0).all()
    assert (field.distance < 0).sum() / 128**2 == pytest.approx(flow.eel(1.0).mass(time).volume, rel=0.03)

"""Inputs that are possible and probably not meant end in a sentence; inputs beside them do not."""

import warnings
from dataclasses import replace

import numpy as np
import pytest

from suchus import flow
from suchus.core.errors import Doubtful, InvalidDesign
from suchus.flow.compiled import PAD
from suchus.flow.consistency import DOUBTFUL_RATE_TOLERANCE

CIRCLE = flow.Cylinder(diameter=1.0)
PLANE = flow.Grid.covering((-1.5, 1.5), (-1.5, 1.5), cell=1 / 8)
SPACE = flow.Grid.covering((-1.2, 1.2), (-1.2, 1.2), (-1.2, 1.2), cell=0.1)
BALL = flow.Sphere(diameter=1.0)


def simulation(*bodies, grid=PLANE, **options):
    return flow.Simulation(flow.Setup(**{"grid": grid, "viscosity": 0.02, "bodies": bodies, "coarse": True} | options))


def silent(*bodies, steps=1, **options):
    """Take steps in which no warning may be issued."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sim = simulation(*bodies, **options)
        for _ in range(steps):
            sim.advance()
    return sim


@pytest.mark.parametrize(("body", "name"), [
    (flow.Body(shape=flow.Ellipse(length=1.0, width=0.6), motion=flow.Pose(angle=30.0)), "angle"),
    (flow.FreeBody(shape=CIRCLE, angle=-90.0), "angle"),
])  # fmt: skip
def test_an_angle_in_degrees_is_said(body, name):
    with pytest.warns(Doubtful, match=rf"the {name} of body at the start is -?\d+ rad.* degrees are -?\d\.\d+ rad"):
        simulation(body)
    silent(flow.Body(shape=CIRCLE, motion=flow.Pose(angle=6.0)))


def test_a_yaw_in_degrees_is_said_in_space_and_a_stream_angle_too():
    with pytest.warns(Doubtful, match=r"the pitch of body at the start is 30 rad"):
        simulation(flow.FreeBody(shape=BALL, pitch=30.0), grid=SPACE)
    record = silent(flow.Body(shape=CIRCLE), stream=(1.0, 0.0)).record
    with pytest.warns(Doubtful, match="stream_angle is 30 rad"):
        record.coefficients(length=1.0, speed=1.0, stream_angle=30.0)


@pytest.mark.parametrize(("density", "water"), [(1.0, 1000.0), (1.05, 1000.0), (2000.0, 1.0)])
def test_a_density_in_another_unit_than_the_waters_is_said(density, water):
    with pytest.warns(Doubtful, match=r"body has a density of .* Densities are absolute: give"):
        simulation(flow.FreeBody(shape=CIRCLE, density=density), density=water)


@pytest.mark.parametrize(("density", "water"), [(1050.0, 1000.0), (0.02, 1.0), (7.8, 1.0)])
def test_densities_of_one_unit_are_not(density, water):
    silent(flow.FreeBody(shape=CIRCLE, density=density), density=water)


def test_gravity_of_two_numbers_in_space_and_gravity_along_a_locked_axis_are_said():
    with pytest.warns(Doubtful, match=r"gravity of body is \(0\.0, -1\.0\) m/s2, along x and y alone"):
        simulation(flow.FreeBody(shape=BALL, density=2.0, gravity=(0.0, -1.0)), grid=SPACE)
    locked = flow.FreeBody(shape=BALL, density=2.0, gravity=(0.0, 0.0, -1.0), free=(True, True, True))
    with pytest.warns(Doubtful, match=r"locks its motion along z: of three numbers the third is the turn about z"):
        simulation(locked, grid=SPACE)
    silent(replace(locked, free=None), grid=SPACE)


def test_a_force_of_three_numbers_in_space_is_said_where_the_third_could_be_one_along_z():
    def force(time, state):
        return 0.0, 0.0, 1.0

    sim = simulation(flow.FreeBody(shape=BALL, force=force), grid=SPACE)
    with pytest.warns(Doubtful, match=r"of three numbers in space the third is the torque about z\. Give six"):
        sim.advance()
    silent(flow.FreeBody(shape=BALL, force=force, free=(True, True, True)), grid=SPACE)


@pytest.mark.parametrize(("sides", "stream", "name"), [
    (flow.Sides.box(), (1.0, 0.0), "left side is a Wall"),
    (flow.Sides(bottom=flow.Slip(), top=flow.Slip()), (1.0, 0.1), "bottom side is a Slip"),
])  # fmt: skip
def test_a_stream_through_a_closed_side_is_refused(sides, stream, name):
    with pytest.raises(InvalidDesign, match=rf"stream has .* m/s along .*, and the {name}, through which no water"):
        flow.Setup(grid=PLANE, viscosity=0.02, sides=sides, stream=stream)
    flow.Setup(grid=PLANE, viscosity=0.02, sides=flow.Sides(bottom=flow.Slip(), top=flow.Slip()), stream=(1.0, 0.0))
    flow.Setup(grid=PLANE, viscosity=0.02, sides=flow.Sides.periodic(), stream=(1.0, 0.3))


def test_a_stream_through_a_mirror_is_refused():
    with pytest.raises(InvalidDesign, match="along z, and the low side is a Mirror"):
        flow.Setup(grid=SPACE, viscosity=0.02, sides=flow.Sides(low=flow.Mirror()), stream=(1.0, 0.0, 0.2))


def test_a_channel_that_the_grid_has_widened_is_said():
    walls = flow.Sides(bottom=flow.Wall(), top=flow.Wall())
    pairs = (0.0, 8.0), (0.0, 1.03)
    wide = flow.Grid.covering(*pairs, cell=1 / 16)
    assert wide.size[1] > 1.03
    with pytest.warns(Doubtful, match=r"the bottom side is a Wall at y = -\d.* 0 m was asked for.*Give sides="):
        simulation(grid=wide, sides=walls, stream=(1.0, 0.0))
    silent(grid=flow.Grid.covering((0.0, 8.0), (0.0, 1.0), cell=1 / 16, sides=walls), sides=walls, stream=(1.0, 0.0))
    silent(grid=wide, stream=(1.0, 0.0))  # open sides may lie anywhere


def test_an_inflow_that_differs_from_the_stream_is_said():
    def sides(speed):
        return flow.Sides(left=flow.Inflow(profile=lambda y: speed + 0 * y), right=flow.Outflow())

    with pytest.warns(Doubtful, match=r"the mean inflow through the left side is 2 m/s and the stream has 1 m/s"):
        simulation(sides=sides(2.0), stream=(1.0, 0.0))
    silent(sides=sides(1.05), stream=(1.0, 0.0))
    silent(sides=sides(2.0))


def test_a_motion_that_returns_nothing_is_refused():
    with pytest.raises(InvalidDesign, match=r"the motion of body gives None at t = 0 s; a motion returns a Pose"):
        simulation(flow.Body(shape=CIRCLE, motion=lambda time: None))


def fish(heading_error, curve=0.3):
    """A rigid curved midline whose headings are off by an angle."""
    s = np.linspace(0.0, 1.0, 41)
    heading, zero = curve * s, np.zeros(s.size)
    x, y = np.sin(heading) / curve, (1 - np.cos(heading)) / curve
    spine = flow.MidlineState(
        x=x, y=y, heading=heading + heading_error, half_width=0.2 + zero, x_rate=zero, y_rate=zero, heading_rate=zero
    )
    return flow.Body(shape=flow.Midline(spine=lambda _: spine, deforms=False), motion=flow.Pose(position=(-0.5, 0.0)))


def test_headings_that_are_not_the_direction_of_the_midline_are_said():
    with pytest.warns(Doubtful, match=r"headings of body differ by 0\.2 rad in the mean from the direction"):
        simulation(fish(0.2))
    silent(fish(0.05))


def test_rates_that_are_some_percent_wrong_are_said():
    def moving(factor):
        return flow.Body(
            shape=CIRCLE, motion=lambda t: flow.Pose(position=(0.2 * t, 0.0), velocity=(0.2 * factor, 0.0))
        )

    with pytest.warns(Doubtful, match=r"velocity"):
        simulation(moving(1.08))
    silent(moving(1.0 + DOUBTFUL_RATE_TOLERANCE), steps=4)


def test_the_control_volume_has_a_force_in_its_first_step():
    sim = silent(flow.Body(shape=CIRCLE), stream=(1.0, 0.0), steps=0)
    for _ in range(12):
        sim.advance()
    sim.control(0.2)
    for _ in range(3):
        sim.advance()
    drag = sim.control_forces[:, 0]
    assert drag[0] == pytest.approx(drag[1], rel=0.05)  # it was not a number
    assert drag == pytest.approx(sim.record.force()[-3:, 0], rel=0.2)


def test_the_estimated_error_counts_the_thin_layer_of_a_sudden_start():
    sim = silent(flow.Body(shape=CIRCLE), stream=(1.0, 0.0), steps=12)
    error = sim.record.column("layer_error")
    assert error[0] > 2 * error[-1]
    assert (np.diff(error) <= 0).all()
    moved = silent(flow.Body(shape=CIRCLE, motion=flow.Oscillation(frequency=0.2, heave=(0.2, 0.0))), steps=2)
    assert moved.record.column("layer_error")[0] < error[0]


def test_a_wake_that_is_still_symmetric_is_said_and_a_disturbance_breaks_it():
    grid = flow.Grid.covering((-2.0, 8.0), (-2.0, 2.0), cell=1 / 8)
    options = {"grid": grid, "viscosity": 0.01, "stream": (1.0, 0.0), "tolerance": 1e-6}
    with pytest.warns(Doubtful, match=r"the wake at Reynolds number 1\d\d is still its mirror image"):
        simulation(flow.Body(shape=CIRCLE), **options).run(21.0, progress=False)
    with warnings.catch_warnings():
        warnings.filterwarnings("error", message=".*mirror image")
        record = simulation(flow.Body(shape=CIRCLE), perturb=0.3, **options).run(21.0, progress=False)
    assert np.abs(record.force()[-60:, 1]).max() > 0.02


@pytest.mark.parametrize("stream", [(1.0, 0.0), (0.0, 2.0), (-0.6, 0.8)])
def test_the_disturbance_is_a_gust_across_the_stream_behind_the_body(stream):
    grid = flow.Grid.covering((-4.0, 4.0), (-4.0, 4.0), cell=1 / 8)
    calm, gusty = (
        simulation(flow.Body(shape=CIRCLE), grid=grid, stream=stream, perturb=perturb).water.velocity
        for perturb in (0.0, 0.25)
    )
    gust = (gusty - calm)[:, PAD:-PAD, PAD:-PAD]
    size, direction = np.hypot(*gust), np.array(stream) / np.hypot(*stream)
    assert size.max() == pytest.approx(0.25 * np.hypot(*stream), rel=0.05)
    assert np.abs(np.tensordot(direction, gust, 1)).max() < 0.1 * size.max()
    row, column = np.unravel_index(size.argmax(), size.shape)
    assert (grid.x[column], grid.y[row]) == pytest.approx(tuple(1.5 * direction), abs=0.2)


@pytest.mark.parametrize(("changes", "part"), [
    ({"perturb": 2.0, "stream": (1.0, 0.0)}, "perturb is 2.0; give -1 to 1"),
    ({"perturb": 0.2}, "no body or no far stream"),
])  # fmt: skip
def test_a_disturbance_that_cannot_be_is_refused(changes, part):
    with pytest.raises(InvalidDesign, match=part):
        flow.Setup(grid=PLANE, viscosity=0.02, bodies=(flow.Body(shape=CIRCLE),), **changes)

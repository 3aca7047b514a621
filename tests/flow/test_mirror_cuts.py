"""A mirror that cuts a body gives the forces of the whole body, with a grid that travels and with one that does not."""

import numpy as np
import pytest
from test_trunk import eel

from suchus import flow

CUTS = [("bottom",), ("top",), ("low",), ("high",), ("bottom", "low"), ("top", "high"), ("top", "low")]


def whole_or_cut(body, mirrors, *, follow, half=1.5, cell=1 / 8, steps=3, x=(-1.5, 1.5), viscosity=0.01):
    """The record of a body in a box, or in the part of the box that the mirrors leave of it."""
    sides = {name: flow.Slip() for name in ("bottom", "top", "low", "high")} | {m: flow.Mirror() for m in mirrors}
    ends = [
        (0.0 if low in mirrors else -half, 0.0 if high in mirrors else half)
        for low, high in (("bottom", "top"), ("low", "high"))
    ]
    sides = flow.Sides(**sides)
    grid = flow.Grid.covering(x, *ends, cell=cell, sides=sides)
    sim = flow.Simulation(
        flow.Setup(
            grid=grid, viscosity=viscosity, bodies=(body,), sides=sides, follow="body" if follow else None,
            follow_axes=(True, False, False), step=0.02, coarse=True, tolerance=1e-6,
        ),
        thread_count=1,
    )  # fmt: skip
    for _ in range(steps):
        sim.advance()
    return sim.record


def speeding(time):
    """A motion with an acceleration of 2 m/s^2 along x."""
    return flow.Pose(position=(0.1 * time + time**2, 0.0, 0.0), velocity=(0.1 + 2 * time, 0.0, 0.0))


@pytest.mark.parametrize("follow", [False, True])
@pytest.mark.parametrize("shape", [flow.Sphere(diameter=1.0), flow.Ellipsoid(length=1.0, width=0.8, height=0.6)])
def test_a_cut_body_that_speeds_up_has_the_force_of_the_whole_one(shape, follow):
    body = flow.Body(shape=shape, motion=speeding)
    whole = whole_or_cut(body, (), follow=follow)
    assert whole.force()[-1, 0] < -1e-3
    for mirrors in CUTS:
        cut = whole_or_cut(body, mirrors, follow=follow)
        assert cut.force()[:, 0] == pytest.approx(whole.force()[:, 0], rel=1e-5)
        assert cut.column("power") == pytest.approx(whole.column("power"), rel=1e-5)


def test_a_cut_body_that_falls_free_falls_as_the_whole_one():
    body = flow.FreeBody(shape=flow.Sphere(diameter=1.0), density=2.0, gravity=(1.0, 0.0, 0.0))
    whole, cut = (whole_or_cut(body, mirrors, follow=True) for mirrors in ((), ("bottom", "high")))
    assert cut.column("velocity_x") == pytest.approx(whole.column("velocity_x"), rel=1e-5)
    assert whole.column("velocity_x")[-1] == pytest.approx(0.06 / 2.5, rel=0.1)


@pytest.mark.parametrize("mirror", ["low", "high"])
def test_a_cut_swimmer_has_the_forces_of_the_whole_one(mirror):
    """A trunk that bends and begins to swim by itself: forces on the whole and on its parts, and its motion."""
    body = flow.FreeBody(shape=eel(taper=False, cuts=(0.4,)))
    box = {"follow": True, "half": 0.5, "cell": 1 / 32, "x": (-1.0, 1.0), "viscosity": 1e-3}
    whole, cut = (whole_or_cut(body, mirrors, **box) for mirrors in ((), (mirror,)))
    size = np.abs(whole.force()).max()
    assert np.abs(cut.force() - whole.force()).max() < 1e-4 * size
    for name in ("force_x", "force_y", "torque"):
        parts = whole.part_series(name)
        assert np.abs(cut.part_series(name) - parts).max() < 1e-4 * np.abs(parts).max()
    assert np.abs(cut.column("velocity_y") - whole.column("velocity_y")).max() < 1e-4 * whole.column("velocity_y").max()

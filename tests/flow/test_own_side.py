"""Sides of a user's own, that change with time: a wall that swings in its plane, and a piston."""

from dataclasses import dataclass
from math import cos, exp, log2, pi, sin, sqrt

import numpy as np
import pytest

from suchus import flow
from suchus.core.errors import InvalidDesign
from suchus.flow.compiled import PAD


@dataclass(frozen=True)
class Swinging(flow.Side):
    speed: float
    rate: float
    travels = False, False

    def wall_velocity(self, time, ndim):
        return (self.speed * cos(self.rate * time), *(0.0,) * (ndim - 2))


@dataclass(frozen=True)
class Piston(flow.Side):
    speed: float
    rate: float
    is_permeable = True

    def inflow_velocity(self, time, *places):
        return self.speed * sin(self.rate * time)


def off_stokes(cells):
    """Return by how much the water over a swinging wall is off Stokes' second problem [m/s]."""
    rate, nu, h = 2 * pi, 0.05, 2 / cells
    k = sqrt(rate / (2 * nu))
    sides = flow.Sides(left=flow.Periodic(), right=flow.Periodic(), bottom=Swinging(1.0, rate), top=flow.Slip())
    sim = flow.Simulation(
        flow.Setup(grid=flow.Grid(cells=(8, cells), cell=h), viscosity=nu, sides=sides, coarse=True, precision="double")
    )
    sim.run(3.25)
    y = (np.arange(cells) + 0.5) * h
    exact = np.exp(-k * y) * np.cos(rate * sim.time - k * y)
    assert np.abs(exact).max() > 0.2
    assert exp(-2 * k) < 1e-4  # the lid is far enough away
    return np.abs(sim.water.u[PAD:-PAD, PAD + 4] - exact).max()


@pytest.mark.slow("the second precision")
def test_over_a_swinging_wall_the_water_swings_as_stokes_says_at_second_order():
    coarse, fine = off_stokes(32), off_stokes(64)
    assert fine < 0.02
    assert 1.6 < log2(coarse / fine) < 2.4


@pytest.mark.parametrize("axes", [2, 3])
def test_a_piston_moves_the_water_as_it_moves(axes):
    sides = flow.Sides(
        left=Piston(0.5, 4.0), right=flow.Outflow(), bottom=flow.Slip(), top=flow.Slip(), low=flow.Slip(),
        high=flow.Slip(),
    )  # fmt: skip
    sim = flow.Simulation(
        flow.Setup(grid=flow.Grid(cells=(16, 8, 8)[:axes], cell=0.1), viscosity=0.01, sides=sides, step=0.02)
    )
    for until in (0.2, 0.5, 1.0):
        sim.run(until)
        inside = sim.water.velocity[0][(slice(PAD, -PAD),) * axes]
        np.testing.assert_allclose(inside, 0.5 * sin(4.0 * sim.time), atol=2e-4)


def test_a_piston_in_a_closed_box_is_refused_when_it_begins_to_push():
    sim = flow.Simulation(
        flow.Setup(
            grid=flow.Grid(cells=(16, 8), cell=0.1), viscosity=0.01,
            sides=flow.Sides(left=Piston(0.5, 4.0), right=flow.Wall(), bottom=flow.Wall(), top=flow.Wall()),
        )
    )  # fmt: skip
    with pytest.raises(InvalidDesign, match=r"100 % of the water that passes the domain's sides \(left\) enters and"):
        sim.run(0.1)


def test_two_pistons_that_move_as_one_may_close_a_box():
    sides = flow.Sides(left=Piston(0.5, 4.0), right=Piston(-0.5, 4.0), bottom=flow.Slip(), top=flow.Slip())
    sim = flow.Simulation(
        flow.Setup(grid=flow.Grid(cells=(16, 8), cell=0.1), viscosity=0.01, sides=sides, step=0.02)
    )  # fmt: skip
    sim.run(0.3)
    np.testing.assert_allclose(sim.water.u[PAD:-PAD, PAD:-PAD], 0.5 * sin(4.0 * sim.time), atol=2e-4)


class Wrong(flow.Side):
    is_permeable = True

    def __init__(self, given, slides=None):
        self.given, self.slides = given, slides

    def inflow_velocity(self, time, *places):
        return self.given

    def wall_velocity(self, time, ndim):
        return self.slides


@pytest.mark.parametrize(
    ("side", "words"),
    [
        (Wrong(np.zeros(3)), r"through the left side, a Wrong, are .*as many as there are places, shape \(8,\)"),
        (Wrong(float("nan")), "one finite number"),
        (Wrong(0.0, (float("inf"),)), "moves along itself at"),
        (Wrong(0.0, (1.0, 2.0)), "a plane grid needs one number"),
    ],
)
def test_what_a_side_says_that_is_no_velocity_is_refused(side, words):
    with pytest.raises(InvalidDesign, match=words):
        flow.Simulation(
            flow.Setup(grid=flow.Grid(cells=(16, 8), cell=0.1), viscosity=0.01, sides=flow.Sides(left=side))
        )


def test_a_side_that_may_not_travel_is_not_taken_along():
    body = flow.Body(
        shape=flow.Cylinder(diameter=0.5), motion=flow.Glide(start=(0.5, 0.5), velocity=(0.1, 0.0)), name="it"
    )
    with pytest.raises(InvalidDesign, match="kind Swinging is fixed"):
        flow.Setup(
            grid=flow.Grid(cells=(16, 16), cell=0.1), viscosity=1.0, bodies=(body,), follow="it",
            sides=flow.Sides(bottom=Swinging(1.0, 1.0)),
        )  # fmt: skip

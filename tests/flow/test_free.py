"""Free bodies with weight, springs, dampers, locks and other forces: alone, and in the water."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import kv

from suchus import flow
from suchus.core.errors import InvalidDesign
from suchus.flow.swimmer import Swimmer

CIRCLE = flow.Cylinder(diameter=1.0)
AREA = CIRCLE.mass(0.0).volume
ADDED = np.diag([0.7, 0.9, 0.2])


def inviscid(body, dt, count, *, added=ADDED):
    """Places and rates of a body in water that answers with an added mass and nothing else, shape (count, 6)."""
    swimmer, rows = Swimmer.from_body(body), []
    swimmer.added_mass = added
    for k in range(count):
        swimmer.advance(k * dt, dt, 1.0)
        swimmer.load = -added @ swimmer.acceleration
        rows.append([*swimmer.coordinates, *swimmer.rate])
    return np.array(rows)


@settings(max_examples=9)
@given(stiffness=st.floats(1.0, 60.0), steps=st.integers(25, 60), axis=st.integers(0, 2))
def test_a_spring_rings_with_mass_and_added_mass_and_neither_gains_nor_loses(stiffness, steps, axis):
    inertia = [2 * AREA, 2 * AREA, 2 * CIRCLE.mass(0.0).moments[0, 0]][axis] + ADDED[axis, axis]
    rate, push = np.sqrt(stiffness / inertia), np.eye(3)[axis]
    dt, anchor = 2 * np.pi / rate / steps, tuple(0.1 * push)
    body = flow.FreeBody(shape=CIRCLE, density=2.0, springs=tuple(stiffness * push), anchor=anchor)
    rows = inviscid(body, dt, 6 * steps)
    swing = rows[:, axis] - anchor[axis]
    energy = 0.5 * inertia * rows[:, 3 + axis] ** 2 + 0.5 * stiffness * swing**2
    assert np.ptp(energy) < 1e-9 * energy[-1]
    rises = np.flatnonzero((swing[:-1] < 0) & (swing[1:] >= 0))
    at = rises - swing[rises] / (swing[rises + 1] - swing[rises])
    assert (at[-1] - at[0]) / (len(at) - 1) / steps == pytest.approx(1.0, abs=0.006)  # (rate dt)^2 / 12 for 25 steps
    others = [k for k in range(6) if k % 3 != axis]
    assert (rows[:, others] == 0).all()


def test_a_damper_takes_what_it_should():
    inertia = 2 * AREA + ADDED[0, 0]
    body = flow.FreeBody(shape=CIRCLE, density=2.0, velocity=(1.0, 0.0), dampers=(0.5 * inertia, 0.0, 0.0))
    rows = inviscid(body, 0.02, 200)
    decay = np.log(rows[100, 3] / rows[50, 3]) / (50 * 0.02)
    assert decay == pytest.approx(-0.5, rel=1e-4)


def test_a_locked_degree_stays_to_the_byte():
    def force(time, state):
        return np.sin(time), 1.0 + state.velocity[1], 0.3

    body = flow.FreeBody(
        shape=CIRCLE, start=(0.1, 0.7), angle=0.3, density=3.0, free=(False, True, False), gravity=(1.0, -9.81),
        springs=(1.0, 2.0, 3.0), anchor=(0.0, 0.0, 0.0), force=force,
    )  # fmt: skip
    swimmer = Swimmer.from_body(body)
    for k in range(50):
        swimmer.advance(0.01 * k, 0.01, 1.0)
        swimmer.added_mass, swimmer.load = np.full((3, 3), 0.1) + ADDED, np.array([1.0, 0.2, -0.4])
    start = np.array([0.1, 0.7, 0.3])
    assert swimmer.coordinates[[0, 2]].tobytes() == start[[0, 2]].tobytes()
    assert swimmer.rate[[0, 2]].tobytes() == np.zeros(2).tobytes()
    assert abs(swimmer.rate[1]) > 0.1


def test_a_force_of_time_gives_its_impulse():
    body = flow.FreeBody(shape=CIRCLE, density=2.0, force=lambda time, state: (0.0, np.cos(time), 0.0))
    rows = inviscid(body, 0.01, 300)
    gained = np.sin(0.01 * np.arange(1, 301)) / (2 * AREA + ADDED[1, 1])
    assert rows[:, 4] == pytest.approx(gained, abs=1e-4)


@pytest.mark.parametrize(("changes", "part"), [
    ({"springs": (1.0, -1.0, 0.0)}, "springs of body is .*none may be negative"),
    ({"dampers": (-1.0, 0.0, 0.0)}, "dampers of body is .*none may be negative"),
    ({"gravity": (0.0, float("nan"))}, "gravity of body is .*finite"),
    ({"angle": float("inf")}, "angle and spin of body are inf rad"),
    ({"springs": 3.0}, "springs is 3.0; a tuple of 3"),
    ({"density": -1.0}, "density of body is -1.0 kg/m3; a positive"),
])  # fmt: skip
def test_a_free_body_that_cannot_be_is_refused(changes, part):
    with pytest.raises(InvalidDesign, match=part):
        flow.FreeBody(shape=CIRCLE, **changes)


@pytest.mark.parametrize("given", [(1.0, 2.0), (0.0, float("nan"), 0.0)])
def test_a_force_that_is_none_says_when(given):
    swimmer = Swimmer.from_body(flow.FreeBody(shape=CIRCLE, force=lambda time, state: given))
    with pytest.raises(InvalidDesign, match=r"the force of body at t = 0\.5 s is .*; give three finite numbers"):
        swimmer.advance(0.5, 0.01, 1.0)


def ringing(stiffness, mass, viscosity):
    """Complex rate of a spring-mounted cylinder of diameter 1 in still water of density 1 [1/s].

    Source: Stokes 1851, the force of an unsteady viscous flow around a circle,
    ``-pi a^2 s^2 [1 + 4 K1(z) / (z K0(z))]`` with ``z = a sqrt(s / viscosity)``.
    """
    s = 1j * np.sqrt(stiffness / (mass + np.pi / 4))
    for _ in range(50):
        z = 0.5 * np.sqrt(s / viscosity)
        s = 1j * np.sqrt(stiffness / (mass + np.pi / 4 * (1 + 4 * kv(1, z) / (z * kv(0, z)))))
    return s


def test_a_spring_mounted_cylinder_rings_as_stokes_says():
    viscosity, stiffness, density = 0.02, 80.0, 2.0
    exact = ringing(stiffness, density * np.pi / 4, viscosity)
    body = flow.FreeBody(
        shape=CIRCLE, density=density, springs=(0.0, stiffness, 0.0), anchor=(0.0, 0.02, 0.0), free=(False, True, False)
    )
    grid = flow.Grid.covering((-1.5, 1.5), (-1.5, 1.5), cell=1 / 16)
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=viscosity, bodies=(body,), step=0.02))
    record = sim.run(2.9 * 2 * np.pi / exact.imag, progress=False)
    swing = record.column("y") - 0.02
    assert (record.column("x") == 0).all()
    falls = np.flatnonzero((swing[:-1] > 0) & (swing[1:] <= 0))
    at = record.time[falls] + swing[falls] / (swing[falls] - swing[falls + 1]) * record.step[falls + 1]
    assert 2 * np.pi / np.diff(at).mean() == pytest.approx(exact.imag, rel=0.02)
    tops = [np.abs(swing[a:b]).max() for a, b in pairwise(falls)]
    assert np.log(tops[1] / tops[0]) / np.diff(at)[0] == pytest.approx(exact.real, rel=0.3)


def test_a_heavy_ellipse_begins_to_sink_with_its_weight_over_mass_and_added_mass():
    body = flow.FreeBody(shape=flow.Ellipse(length=1.0, width=0.5), density=3.0, gravity=(0.0, -10.0))
    grid = flow.Grid.covering((-1.0, 1.0), (-1.0, 1.0), cell=1 / 32)
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=1e-4, bodies=(body,), step=1e-3, coarse=True))
    for _ in range(2):
        sim.advance()
    area = np.pi / 8
    exact = -(3.0 - 1.0) * area * 10.0 / (3.0 * area + np.pi / 4)
    fall = sim.record.column("velocity_y")
    assert (fall[1] - fall[0]) / 1e-3 == pytest.approx(exact, rel=0.01)
    assert abs(sim.record.column("velocity_x")[1]) < 1e-3 * abs(fall[1])


def test_a_body_as_heavy_as_the_water_does_not_sink():
    body = flow.FreeBody(shape=CIRCLE, gravity=(0.0, -9.81))
    assert (inviscid(body, 0.01, 20) == 0).all()

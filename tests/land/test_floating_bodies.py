"""The forces of the water on lone bodies, beside exact answers."""

from dataclasses import replace
from math import pi

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from suchus.core.water_table import (
    ADDED_MASS_FACTOR,
    CROSS_DRAG,
    DENSITY,
    FORCE,
    POWER,
    SUBMERGED_VOLUME,
    column,
    pack_table,
    unpack_table,
)
from suchus.experiments.catalog.floating import cases
from suchus.robot.design.pieces import pieces
from suchus.robot.design.scale import physics_step
from suchus.robot.robots import ROBOTS
from suchus.sim.immersion import wetting
from suchus.sim.land import Lake, Wave
from suchus.sim.land.float_body import FloatBody, FloatTank
from suchus.sim.model.wet import wet_model


@pytest.mark.parametrize("one", cases.drafts(), ids=lambda one: one.name)
def test_drafts_are_exact(one):
    assert cases.draft_of(one.body) == pytest.approx(one.exact_draft, abs=1e-9)


@pytest.mark.parametrize("added", [0.0, 0.6])
def test_the_period_of_heave_is_exact_with_and_without_added_mass(added):
    watched, exact = cases.simulate_heave(added, 0.002, 3, 0.002)
    assert cases.heave_period(watched) == pytest.approx(exact, rel=1e-4)


def test_momentum_is_kept_in_ideal_water():
    assert cases.relative_momentum_drift(cases.simulate_drift("RK4", 0.002)) < 1e-9
    # the couples of the water are what keeps it: without Munk's, or with another sign, it is lost
    assert cases.relative_momentum_drift(cases.simulate_drift("implicitfast", 0.001)) > 1e-6


def test_a_rocking_box_gains_no_energy():
    assert cases.relative_energy_gain(cases.simulate_rocking(4.0, "RK4", 0.002)) < 1e-5
    assert cases.relative_energy_gain(cases.simulate_rocking(4.0, "implicitfast", 0.002)) < 0.02


@pytest.mark.parametrize("kind", ["disc", "ball", "slab"])
def test_volumes_under_water_are_those_of_counted_points(kind):
    body = cases.bodies_by_piece()[kind]
    assert cases.volume_errors(body, 6, 2**17).max() < 1e-3
    assert cases.volume_errors(replace(body, half=(0.25, 0.1, 0.061)), 6, 2**17).max() < 1e-3


def test_the_public_table_of_what_mujoco_does_not_have():
    found = cases.public_table()
    assert found["neutral"] == pytest.approx(0.0, abs=1e-9)
    assert found["ballast"] == pytest.approx(-29.43, rel=1e-6)
    assert found["keel"] == pytest.approx(1.1187, rel=1e-4)


def test_a_box_heels_to_its_angle_of_loll():
    """Wall-sided: tan^2 of the angle is -2 GM / BM."""
    half, share = (0.3, 0.15, 0.075), 0.5
    bm = half[1] ** 2 / (3 * 2 * share * half[2])
    height = bm - half[2] * (1 - share) + 0.004  # of the centre of mass over the middle, GM is -4 mm
    body = FloatBody(
        shape="box", half=half, mass=500 * 8 * np.prod(half), inertia=(1, 1, 1), centre=(0, 0, height), parts=24
    )
    pool = FloatTank(body, cases.SURFACE_LAKE)
    exact = np.arctan(np.sqrt(2 * 0.004 / bm))

    def moment(angle):
        pool.set_pose((0, 0, 0), np.array([np.cos(angle / 2), np.sin(angle / 2), 0, 0]))
        arm = pool.statics()[1:4] / pool.statics()[0] - pool.data.xipos[1]
        return arm[1]

    low, high = 0.6 * exact, 1.4 * exact
    assert moment(low) * moment(high) < 0
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if moment(middle) * moment(low) > 0 else (low, middle)
    assert low == pytest.approx(exact, rel=0.01)


def test_a_current_carries_the_frame_of_the_water_along():
    """What moves with the current moves as in still water."""
    body = replace(cases.SPHEROID, mass=0.8 * cases.SPHEROID.mass)
    found = []
    for current in ((0.0, 0.0), (0.7, -0.4)):
        pool = FloatTank(body, Lake(level=20.0, current=current), integrator="RK4")
        pool.set_pose((0, 0, 0), velocity=(0.3 + current[0], 0.1 + current[1], 0.0), spin=(0.5, -0.4, 0.8))
        pool.step(500)
        found.append(pool.centre - [*(np.array(current) * pool.data.time), 0.0])
    assert found[1] == pytest.approx(found[0], abs=1e-8)


def test_a_small_neutral_body_goes_around_with_the_water_of_a_wave():
    wave = Wave(height=0.001, length=2.0, phase=0.25)
    deep = 0.3
    speed = 0.5 * wave.height * 2 * pi * wave.frequency * np.exp(-2 * pi * deep / wave.length)
    body = FloatBody(shape="ellipsoid", half=3 * (0.005,), mass=1000 * 4 / 3 * pi * 0.005**3, inertia=3 * (1e-8,),
                     added_mass_ratio=3 * (0.5,))  # fmt: skip
    pool = FloatTank(body, Lake(level=0.0, wave=wave), timestep=0.002)
    pool.set_pose((0.0, 0.0, -deep), velocity=(0.0, 0.0, speed))
    path = pool.watch(1 / wave.frequency, 0.01).middle.values - [0, 0, -deep]
    radius = speed / (2 * pi * wave.frequency)
    assert np.ptp(path[:, 0]) == pytest.approx(2 * radius, rel=0.02)
    assert np.ptp(path[:, 2]) == pytest.approx(2 * radius, rel=0.02)
    assert np.abs(path[-1]).max() < 0.1 * radius


def test_a_float_follows_long_waves():
    """Up and down, and along the surface: it is not moved at the crest of the wave's own height alone."""
    wave = Wave(height=0.05, length=20.0)
    body = replace(cases.BOX, centre=(0, 0, -0.02), added_mass_ratio=(0.0, 0.0, 0.0))
    pool = FloatTank(body, Lake(level=0.0, wave=wave))
    pool.set_pose((0.0, 0.0, 0.025))
    watched = pool.watch(1 / wave.frequency, 0.02)
    surface = 0.025 * np.cos(2 * pi * wave.frequency * watched.time.values)
    assert watched.middle.values[:, 2] == pytest.approx(surface, abs=0.004)


@settings(max_examples=20)
@given(speed=st.floats(0.05, 2.0), angle=st.floats(0.0, 6.28))
def test_drag_is_against_the_motion_and_takes_energy(speed, angle):
    body = FloatBody(shape="cylinder", half=(0.3, 0.05, 0.1), mass=3.0, inertia=(1, 1, 1))
    pool = _dragged(body)
    pool.set_pose((0, 0, 0), velocity=(0.0, speed * np.cos(angle), speed * np.sin(angle)))
    force = pool.data.userdata[FORCE : FORCE + 3] - [0, 0, 1000 * 9.81 * body.volume]
    assert force @ pool.data.qvel[:3] < 0
    across = np.array([speed * np.cos(angle) * 2 * 0.1, speed * np.sin(angle) * 2 * 0.05])
    assert force[1:] == pytest.approx(-0.5 * 1000 * 1.1 * 0.6 * speed * across, rel=1e-9, abs=1e-9)


def _dragged(body):
    """Return a deep body with the drag of a section."""
    pool = FloatTank(body, Lake(level=10.0, added_mass=0.0))
    _write(pool, area=(0.6 * 2 * body.half[2], 0.6 * 2 * body.half[1]))
    assert pool.data.userdata[CROSS_DRAG] == 1.1
    return pool


def _write(pool, **columns):
    """Change columns of the table that a model carries."""
    numbers = pool.model.numeric_data
    rows = unpack_table(numbers)
    for name, values in columns.items():
        column(rows, name)[:] = values
    numbers[:] = pack_table(rows, numbers[2])


def test_what_is_shed_pushes_forward_and_takes_what_lighthill_says():
    body = FloatBody(
        shape="cylinder", half=(0.1, 0.02, 0.05), mass=1.0, inertia=(1, 1, 1), added_mass_ratio=(0.0, 1.0, 1.0)
    )
    pool = FloatTank(body, Lake(level=10.0))
    side = pi * 0.05**2
    _write(pool, shed=(side, pi * 0.02**2), shed_at=-0.1)
    u, w = 0.6, 0.2
    for forward, expected in ((u, 0.5 * 1000 * side * w**2), (-u, 0.0)):
        pool.set_pose((0, 0, 0), velocity=(forward, w, 0.0))
        pool.data.qacc[:] = 0.0
        passive = np.array(pool.data.qfrc_passive)
        assert passive[0] == pytest.approx(expected, rel=1e-9, abs=1e-9)
        lateral = -u * 1000 * side * w if forward > 0 else 0.0
        assert passive[1] == pytest.approx(lateral, rel=1e-9, abs=1e-9)


def test_the_water_says_what_it_did():
    body = replace(cases.SPHEROID, mass=0.5 * cases.SPHEROID.mass)
    pool = FloatTank(body, cases.DEEP_LAKE)
    pool.set_pose((0, 0, 0), velocity=(0.0, 0.0, 0.1))
    for _ in range(50):
        pool.step()
    told = pool.data.userdata
    assert told[SUBMERGED_VOLUME] == pytest.approx(body.volume)
    assert told[DENSITY] == 1000.0
    # Newton: what pulls and the water together accelerate the mass; one step late
    data = pool.data
    centre = data.qacc[:3] + np.cross(data.xmat[1].reshape(3, 3) @ data.qacc[3:6], data.xipos[1] - data.xpos[1])
    weight = np.array([0, 0, -9.81 * body.mass])
    assert told[FORCE : FORCE + 3] + weight == pytest.approx(body.mass * centre, abs=0.02 * 9.81 * body.mass)
    assert told[POWER] == pytest.approx(told[FORCE + 2] * data.qvel[2], rel=0.05)


@pytest.mark.parametrize("name", list(ROBOTS))
def test_every_robot_on_the_shelf_is_carried_by_what_it_displaces(name):
    robot = ROBOTS[name]
    wetting.install()
    model = wet_model(robot, physics_step(robot), None, len(pieces(robot)) + 2, acting=True)
    data = mujoco.MjData(model)
    data.userdata[:] = Lake(level=5.0, added_mass=0.0).numbers(np.array([0.0, 0.0, 1.0]))
    mujoco.mj_forward(model, data)
    volume = column(pieces(robot), "volume").sum()
    assert data.userdata[SUBMERGED_VOLUME] == pytest.approx(volume)
    assert data.userdata[FORCE : FORCE + 3] == pytest.approx([0.0, 0.0, 9.81e3 * volume], abs=1e-9)
    moved = np.zeros((2, model.nv))
    sideways = np.eye(model.nv)[1]
    for i, added in enumerate((0.0, 1.0)):
        data.userdata[ADDED_MASS_FACTOR] = added
        mujoco.mj_forward(model, data)
        mujoco.mj_mulM(model, data, moved[i], sideways)
    table = pieces(robot)
    to_the_side = sum(column(table, "added")[:, k] * column(table, axis)[:, 1] ** 2
                      for k, axis in enumerate(("across", "upward", "forward")))  # fmt: skip
    assert (moved[1] - moved[0])[1] == pytest.approx(1000 * to_the_side.sum(), rel=1e-9)

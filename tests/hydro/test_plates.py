"""Granular ground: the law of the stress against its source, and plates and bodies that move through grains."""

from math import cos, pi, radians, sin

import mujoco
import numpy as np
import pytest
from scipy.integrate import quad
from tests.bodies import CAIMAN, six

from suchus.core.errors import InvalidDesign
from suchus.core.plate_table import PLATE_LOADS, pack_plates, user_numbers
from suchus.core.water_table import FORCE, POWER
from suchus.robot.design.ground import Grains
from suchus.robot.robots import ROBOTS
from suchus.sim.hydro.plates import generic_stress
from suchus.sim.immersion import wetting
from suchus.sim.immersion.attachment import GRAINS_ON_PLATES, attach_table
from suchus.sim.immersion.grains import attach_grains, plates_of
from suchus.sim.model.granular import granular_model

STRENGTH, AREA = 0.3e6, 4e-4
SPHERE, CAPSULE, ELLIPSOID = (
    int(getattr(mujoco.mjtGeom, f"mjGEOM_{name}")) for name in ("SPHERE", "CAPSULE", "ELLIPSOID")
)
LOOSE_POPPY_SEEDS = (0.051, 0.047, 0.053, 0.083, 0.020, -0.026, 0.057, 0.0, 0.025)
"""Fourier coefficients that Li, Zhang and Goldman (2013) fitted to loosely packed poppy seeds [N/cm3]."""


def generic(beta, gamma):
    """Return the generic stress against forward motion and upward for an attack and an intrusion angle [rad]."""
    forward, up = generic_stress.py_func(sin(beta), -cos(beta), cos(gamma), -sin(gamma))
    return -forward, up


def fitted(coefficients, beta, gamma):
    """Return the same as the double Fourier series of the source."""
    a00, a10, b11, b01, bm11, c11, c01, cm11, d10 = coefficients
    forward = c11 * cos(2 * beta + gamma) + c01 * cos(gamma) + cm11 * cos(-2 * beta + gamma) + d10 * sin(2 * beta)
    up = a00 + a10 * cos(2 * beta) + b11 * sin(2 * beta + gamma) + b01 * sin(gamma) + bm11 * sin(-2 * beta + gamma)
    return forward, up


def test_a_level_plate_has_the_stresses_of_the_source():
    assert generic(0.0, pi / 2) == pytest.approx((0.0, 1.0), abs=1e-12)
    assert generic(0.0, -pi / 2) == pytest.approx((0.0, -0.25), abs=1e-12)
    assert generic(0.0, 0.0) == pytest.approx((0.136, 0.375), abs=1e-12)
    assert generic(pi / 2, 0.0)[0] == pytest.approx(0.370, abs=1e-12)


def test_the_law_is_that_of_poppy_seeds_but_for_one_factor():
    angles = np.radians(np.arange(-90, 91, 15))
    measured = np.array([fitted(LOOSE_POPPY_SEEDS, beta, gamma) for beta in angles for gamma in angles])
    computed = np.array([generic(beta, gamma) for beta in angles for gamma in angles])
    assert measured.max() == pytest.approx(Grains().strength / 1e6, abs=0.005)
    assert np.abs(measured - Grains().strength / 1e6 * computed).max() < 0.035
    assert np.corrcoef(measured.ravel(), computed.ravel())[0, 1] > 0.98


def plate(normal, depth, creep_speed=1e-9):
    """Return the model and data of a light free body that is one plate at a depth."""
    spec = mujoco.MjSpec()
    spec.option.gravity = [0.0, 0.0, 0.0]
    body = spec.worldbody.add_body(pos=[0, 0, -depth])
    body.add_freejoint()
    body.add_geom(size=[0.01, 0, 0], pos=[0.02, 0, 0], mass=0.1, contype=0, conaffinity=0)
    wetting.install(GRAINS_ON_PLATES)
    row = np.array([[0.0, 0.0, 0.0, *normal, AREA]])
    attach_table(spec, pack_plates(np.array([1.0]), [row], STRENGTH, creep_speed), user_numbers(1), GRAINS_ON_PLATES)
    model = spec.compile()
    return model, mujoco.MjData(model)


def force_on_plate(normal, velocity, depth=0.02, creep_speed=1e-9):
    model, data = plate(normal, depth, creep_speed)
    data.qvel[:3] = velocity
    mujoco.mj_forward(model, data)
    assert data.userdata[FORCE : FORCE + 3] == pytest.approx(data.userdata[PLATE_LOADS : PLATE_LOADS + 3])
    assert data.userdata[POWER] == pytest.approx(data.userdata[FORCE : FORCE + 3] @ np.array(velocity))
    assert data.qfrc_passive[:3] == pytest.approx(data.userdata[FORCE : FORCE + 3])
    return np.array(data.userdata[FORCE : FORCE + 3])


@pytest.mark.parametrize(("beta", "gamma"), [(0, 90), (30, 90), (30, 40), (70, 10), (-20, 80), (90, 0), (0, 50)])
@pytest.mark.parametrize("heading", [0.0, 2.0])
def test_a_plate_that_is_pushed_in_feels_the_stress_of_the_source(beta, gamma, heading):
    beta, gamma = radians(beta), radians(gamma)
    ahead = np.array([cos(heading), sin(heading), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    velocity = 0.1 * (cos(gamma) * ahead - sin(gamma) * up)
    forward, upward = generic(beta, gamma)
    expected = STRENGTH * 0.02 * AREA * (-forward * ahead + upward * up)
    assert force_on_plate(sin(beta) * ahead - cos(beta) * up, velocity) == pytest.approx(expected, abs=1e-7)


def test_the_force_grows_with_depth_and_not_with_speed():
    down = np.array([0.0, 0.0, -0.1])
    force = force_on_plate((0, 0, -1), down)[2]
    assert force == pytest.approx(STRENGTH * 0.02 * AREA)
    assert force_on_plate((0, 0, -1), down, depth=0.04)[2] == pytest.approx(2 * force)
    assert force_on_plate((0, 0, -1), 5 * down)[2] == pytest.approx(force, rel=1e-6)
    assert force_on_plate((0, 0, -1), down, creep_speed=0.1)[2] == pytest.approx(force / 2)
    assert (force_on_plate((0, 0, -1), -down) == 0.0).all()
    assert (force_on_plate((0, 0, -1), down, depth=-0.001) == 0.0).all()


def test_across_the_plane_of_the_plate_only_shear_acts():
    """A vertical plate that moves edge on along the ground."""
    force = force_on_plate((1.0, 0.0, 0.0), (1e-6, 0.1, 0.0), creep_speed=1e-12)
    assert force[1] == pytest.approx(-0.136 * STRENGTH * 0.02 * AREA, rel=1e-3)
    assert abs(force[0]) < 0.01 * abs(force[1])


@pytest.mark.parametrize(
    ("kind", "size", "area"),
    [
        (SPHERE, (0.02, 0, 0), 4 * pi * 0.02**2),
        (CAPSULE, (0.01, 0.05, 0), 4 * pi * 0.01**2 + 2 * pi * 0.01 * 0.1),
        (ELLIPSOID, (0.06, 0.05, 0.04), None),
    ],
)
def test_plates_close_the_surface_of_a_geom(kind, size, area):
    plates = plates_of(kind, size)
    normals, areas = plates[:, 3:6], plates[:, 6]
    assert np.linalg.norm(normals, axis=1) == pytest.approx(1.0)
    assert areas @ normals == pytest.approx(0.0, abs=1e-12)
    volume = (areas * (plates[:, :3] * normals).sum(axis=1)).sum() / 3
    if area is None:
        assert volume == pytest.approx(4 / 3 * pi * np.prod(size))
    else:
        assert areas.sum() == pytest.approx(area)
    shadow = {SPHERE: pi * 0.02**2, CAPSULE: pi * 0.01**2, ELLIPSOID: pi * 0.06 * 0.05}[kind]
    assert areas @ np.maximum(normals[:, 2], 0.0) == pytest.approx(shadow)
    for direction in np.random.default_rng(0).normal(size=(20, 3)):
        ahead = direction / np.linalg.norm(direction)
        assert areas @ np.maximum(normals @ ahead, 0.0) == pytest.approx(_shadow(kind, size, ahead), rel=0.03)


def _shadow(kind, size, ahead):
    """Return the area of the shadow of a geom in a direction [m2]."""
    if kind == ELLIPSOID:
        return pi * np.prod(size) * np.linalg.norm(ahead / size)
    return pi * size[0] ** 2 + 4 * size[0] * size[1] * np.hypot(*ahead[:2]) * (kind == CAPSULE)


def ball(radius=0.03, creep_speed=1e-3, strength=STRENGTH, timestep=0.002):
    spec = mujoco.MjSpec()
    spec.option.timestep, spec.option.integrator = timestep, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    body = spec.worldbody.add_body(pos=[0, 0, radius])
    body.add_freejoint()
    body.add_geom(size=[radius, 0, 0], mass=0.5)
    attach_grains(spec, strength, creep_speed)
    model = spec.compile()
    return model, mujoco.MjData(model)


def test_a_ball_that_is_pushed_down_feels_the_integral_over_its_lower_half():
    radius, depth = 0.03, 0.05
    model, data = ball(radius, 1e-9)
    data.qpos[2], data.qvel[2] = -depth, -0.1
    mujoco.mj_forward(model, data)

    def of_belt(beta):
        """Return the upward force on a belt over the attack angle; its normal leans outward by that angle."""
        return STRENGTH * (depth + radius * cos(beta)) * generic(beta, pi / 2)[1] * 2 * pi * radius**2 * sin(beta)

    assert data.userdata[FORCE + 2] == pytest.approx(quad(of_belt, 0.0, pi / 2)[0], rel=0.01)


def test_the_load_is_the_impulse_of_the_step():
    """Under strong resistance the force at the beginning of a step is far from that which acts in it."""
    model, data = ball(timestep=0.005)
    model.opt.gravity[:] = 0.0
    data.qpos[2], data.qvel[:3] = -0.02, (0.5, 0.2, -3.0)
    mujoco.mj_forward(model, data)
    for _ in range(5):
        before, law = np.array(data.qvel[:3]), np.array(data.userdata[FORCE : FORCE + 3])
        mujoco.mj_step(model, data)
        mujoco.mj_forward(model, data)
        mujoco.mj_forward(model, data)
        impulse = 0.5 * (data.qvel[:3] - before)
        assert 0.005 * data.userdata[PLATE_LOADS : PLATE_LOADS + 3] == pytest.approx(impulse, rel=1e-3, abs=1e-6)
    assert 0.005 * law != pytest.approx(impulse, rel=0.02)


def test_grains_carry_a_weight_by_intrusion():
    """A heavier ball rests deeper, at a depth at which the grains hold no less than its weight."""
    depths = []
    for gravity in (9.81, 4 * 9.81):
        model, data = ball()
        model.opt.gravity[2] = -gravity
        mujoco.mj_step(model, data, 1000)
        assert data.userdata[FORCE + 2] == pytest.approx(0.5 * gravity, rel=0.01)
        assert -1e-3 < data.qvel[2] < 0.0
        depths.append(-float(data.qpos[2]))
    assert depths[0] > -0.03
    assert depths[1] > depths[0] + 0.01


@pytest.mark.parametrize("timestep", [0.0005, 0.005])
@pytest.mark.parametrize("creep_speed", [1e-5, 1e-2])
def test_energy_never_rises_in_grains(timestep, creep_speed):
    model, data = ball(creep_speed=creep_speed, timestep=timestep)
    model.opt.gravity[:] = 0.0
    data.qpos[2] = -0.01
    data.qvel[:] = 1.0, 0.5, -2.0, 20.0, -10.0, 5.0
    inertia = np.concatenate([np.full(3, 0.5), model.body_inertia[1]])
    energies = []
    for _ in range(200):
        energies.append(0.5 * (inertia * data.qvel**2).sum())
        mujoco.mj_step(model, data)
        assert data.userdata[POWER] <= 0.0
    assert np.diff(energies).max() <= 1e-12
    assert energies[-1] < 0.05 * energies[0]


@pytest.mark.parametrize("robot", [CAIMAN, six(), ROBOTS["strider"], ROBOTS["swimmer"]], ids=lambda robot: robot.name)
def test_the_matrix_grows_by_the_damping_of_the_same_force(robot):
    """With the damping C the force is -C v and the matrix M + h C, for any body that moves anyhow."""
    model = granular_model(robot, 0.002, Grains())
    data, dry = mujoco.MjData(model), mujoco.MjData(model)
    rng = np.random.default_rng(2)
    data.qpos[2] = 0.01
    data.qpos[7:] += rng.normal(size=model.nq - 7, scale=0.2)
    data.qvel[:] = rng.normal(size=model.nv)
    data.qvel[2] = -1.0
    dry.qpos[:] = data.qpos
    dry.qvel[:] = 0.0
    resisted = []
    for state in (data, dry):
        mujoco.mj_fwdPosition(model, state)
        mujoco.mj_fwdVelocity(model, state)
        products = np.zeros(model.nv)
        mujoco.mj_mulM(model, state, products, data.qvel)
        resisted.append(products)
    grains = np.array(data.qfrc_passive)
    springs = mujoco.MjData(model)
    springs.qpos[:], springs.qvel[:] = data.qpos, data.qvel
    model.numeric_data[2] = 1e-300
    try:
        mujoco.mj_fwdPosition(model, springs)
        mujoco.mj_fwdVelocity(model, springs)
    finally:
        model.numeric_data[2] = Grains().strength
    grains -= springs.qfrc_passive
    assert np.abs(grains).max() > 1.0
    assert resisted[0] - resisted[1] == pytest.approx(-0.002 * grains, rel=1e-9, abs=1e-9 * np.abs(grains).max())
    assert grains @ data.qvel == pytest.approx(data.userdata[POWER])


def test_a_box_is_refused_in_a_sentence():
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body()
    body.add_freejoint()
    body.add_geom(name="crate", type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.1, 0.1, 0.1])
    with pytest.raises(InvalidDesign, match=r"'crate' is a box, and grains act on spheres, capsules and ellipsoids"):
        attach_grains(spec, STRENGTH, 1e-3)


def test_plates_within_another_geom_are_left_out():
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body()
    body.add_freejoint()
    body.add_geom(size=[0.05, 0, 0])
    body.add_geom(size=[0.02, 0, 0])
    attach_grains(spec, STRENGTH, 1e-3)
    model = spec.compile()
    assert model.numeric_data[1] == 2
    assert model.numeric_data[4 + 4 + 2] == 0
    assert model.numeric_data[4 + 2] == len(plates_of(SPHERE, (0.05, 0, 0)))

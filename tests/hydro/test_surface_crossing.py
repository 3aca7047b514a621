"""Robots that fall into water and heave at its surface, without drag: body and water together gain no energy."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from tests.bodies import six

from suchus.core.water_table import unpack_table
from suchus.robot.design import GRAVITY
from suchus.robot.design.pieces import pieces
from suchus.robot.design.water import Water
from suchus.robot.robots import ROBOTS
from suchus.sim.hydro.forces import hydrostatic
from suchus.sim.immersion import wetting
from suchus.sim.land import Lake
from suchus.sim.model.wet import wet_model

UP = np.array([0.0, 0.0, 1.0])
IDEAL = replace(Water(), cross_drag=0.0, thickening=0.0)
TIMESTEP = 0.001
BODIES = {"floating_caiman": ROBOTS["floating_caiman"], "swimmer": ROBOTS["swimmer"], "hexapod": six()}


def free_in_water(robot, splash):
    """Return the model of a robot whose joints move freely and its state above ideal water, moving."""
    wetting.install()
    model = wet_model(robot, TIMESTEP, None, len(pieces(robot)), acting=True)
    off = mujoco.mjtDisableBit
    model.opt.disableflags |= int(off.mjDSBL_CONTACT | off.mjDSBL_ACTUATION | off.mjDSBL_LIMIT)
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    model.opt.gravity[:] = -GRAVITY * UP
    model.dof_damping[:] = model.dof_frictionloss[:] = 0.0
    data, rng = mujoco.MjData(model), np.random.default_rng(1)
    data.qpos[2] = 0.3 * robot.length
    data.qvel[3:6], data.qvel[6:] = rng.normal(size=3), rng.normal(size=model.nv - 6, scale=0.3)
    data.userdata[:] = Lake(level=0.0, water=IDEAL, shedding=0.0, splash=splash).numbers(UP)
    return model, data


def energy(model, data):
    """Return the energy of body and water [J]."""
    mujoco.mj_forward(model, data)
    mujoco.mj_energyPos(model, data)
    momentum = np.zeros(model.nv)
    mujoco.mj_mulM(model, data, momentum, data.qvel)
    table = unpack_table(model.numeric_data)
    submerged = hydrostatic(table, data.xpos, data.xmat, UP, 0.0, (1.0, 1.0))
    return 0.5 * data.qvel @ momentum + data.energy[0] + Water().density * GRAVITY * submerged[4]


def heaving_energies(robot, splash):
    """Return the energy above that at the beginning, over that of the fall, through the first 1.2 s [-]."""
    model, data = free_in_water(robot, splash)
    energies = [energy(model, data)]
    for _ in range(60):
        mujoco.mj_step(model, data, 20)
        energies.append(energy(model, data))
    fall = robot.mass * GRAVITY * 0.3 * robot.length
    return (np.array(energies) - energies[0]) / fall


@pytest.mark.parametrize("name", BODIES)
def test_energy_is_kept_without_a_splash(name):
    energies = heaving_energies(BODIES[name], 0.0)
    assert np.abs(energies).max() < 0.01
    assert energies.max() < 1e-4


@pytest.mark.parametrize("name", BODIES)
def test_a_splash_takes_energy_and_never_gives_any(name):
    energies = heaving_energies(BODIES[name], 1.0)
    assert np.diff(energies).max() < 1e-6
    assert energies[-1] < -0.1

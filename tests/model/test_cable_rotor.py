"""The rotor behind a cable turns with the cords, not with each hinge."""

from copy import copy

import mujoco
import numpy as np
import pytest

from suchus.robot.robots import ROBOTS
from suchus.sim.model import compile_model


def kinetic_energy(model, rates):
    """Return the kinetic energy of a robot at rest but for the hinges of its tail [J]."""
    data = mujoco.MjData(model)
    for name, rate in rates.items():
        data.qvel[int(model.joint(name).dofadr[0])] = rate
    mujoco.mj_forward(model, data)
    mujoco.mj_energyVel(model, data)
    return float(data.energy[1])


@pytest.mark.parametrize("name", ["caiman", "floating_caiman", "long_tail"])
def test_its_energy_is_that_of_the_pulley(name):
    robot = ROBOTS[name]
    (cable,) = robot.cables
    model = compile_model(robot)
    free = copy(model)
    free.tendon_armature[:] = 0.0
    rates = np.linspace(-1.0, 2.0, len(cable.hinges))
    for bends in (rates, np.ones_like(rates), rates - rates.mean()):
        motion = dict(zip(cable.hinges, bends, strict=True))
        rotor = kinetic_energy(model, motion) - kinetic_energy(free, motion)
        pulley_rate = bends.sum() * cable.cord_spacing / 2 / cable.pulley
        assert rotor == pytest.approx(0.5 * cable.turning.armature * pulley_rate**2, abs=1e-12)


def test_a_heavier_rotor_does_not_stiffen_a_wave_that_moves_no_cord():
    """With the hinges' angles adding up to zero, the rotor rests."""
    robot = ROBOTS["caiman"]
    (cable,) = robot.cables
    model = compile_model(robot)
    dofs = [int(model.joint(name).dofadr[0]) for name in cable.hinges]
    assert model.dof_armature[dofs].max() < 0.01 * cable.turning.armature

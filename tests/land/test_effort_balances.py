"""Effort of many robots: balances of energy in plain MuJoCo, work at three time steps, and heat.

The robots are sampled designs of the study of the claims, and foreign bodies with other feet and shanks.
"""

import numpy as np
import pytest

from evidence.complete_loads import foreign_bodies, sampled_designs
from evidence.replay_check import replay
from suchus.robot.design.scale import coarse_step, physics_step
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim import metrics
from suchus.sim.land import Run, simulate

DURATION = 2.5
ENERGY_TOLERANCE = 0.02
"""Greatest part of the energy that is turned over and that servos, springs, dampers and contacts leave open [-]."""
WORK_TOLERANCES = {"usual": 0.03, "coarse": 0.07}
"""Greatest change of the work to a quarter of the usual step, over the absolute work [-].

It is the walk itself that changes, not its measurement: a control period has two coarse steps, and the small salamander
walks a little differently at its usual step too.
"""
MOST_WORK_TOLERANCE = 0.02
"""The same at the usual step for nine robots in ten [-]."""
HEAT_TOLERANCE = 0.03
"""Greatest difference of the heat by torque from that by temperature: what the torque changes within a step [-]."""


def record_of(run, timestep=None):
    return simulate([run], duration=DURATION, timestep=timestep).isel(run=0)


def open_energy(run):
    """Return the part of the energy turned over that nothing explains [-]."""
    return replay(record_of(run), run.robot).energy_error


def work_changes(run):
    """Return how far the work and the net work at two time steps are from those at a quarter of the usual one [-]."""
    robot = run.robot
    steps = {"coarse": coarse_step(robot), "usual": physics_step(robot), "fine": physics_step(robot) / 4}
    records = {name: record_of(run, step) for name, step in steps.items()}
    scale = float(metrics.work(records["fine"]))
    return {
        name: max(
            abs(float(work(records[name]) - work(records["fine"]))) / scale for work in (metrics.work, metrics.net_work)
        )
        for name in WORK_TOLERANCES
    }


def heats(run, timestep=0.0005):
    """Return the heat of all windings by their temperature, which MuJoCo computes, and by the torque [J]."""
    record, robot = record_of(run, timestep), run.robot
    by_temperature = by_torque = 0.0
    for name in map(str, record.servo.values):
        servo, winding = robot.servo(name), robot.servo(name).winding
        warming = record.servo_temperature.sel(servo=name) - winding.heat.ambient
        by_temperature += winding.heat.capacity * float(warming[-1] - warming[0])
        by_temperature += float(warming.integrate("time") / winding.heat.resistance)
        square = float(metrics.rms_torque(record, 0.0).sel(servo=name)) ** 2 * float(record.time[-1])
        by_torque += winding.volts * winding.stall_current * square / servo.torque**2
    return by_temperature, by_torque


def few():
    return [*list(sampled_designs(4)), *list(foreign_bodies(60))[5::20]]


def assert_balanced(runs):
    assert {run.label: found for run in runs if (found := open_energy(run)) > ENERGY_TOLERANCE} == {}


def assert_work_of_any_step(runs):
    changes = {run.label: work_changes(run) for run in runs}
    for name, bound in WORK_TOLERANCES.items():
        assert {label: found[name] for label, found in changes.items() if found[name] > bound} == {}, name
    assert np.quantile([found["usual"] for found in changes.values()], 0.9, method="lower") < MOST_WORK_TOLERANCE


def test_the_energy_of_designs_and_foreign_bodies_is_balanced():
    assert_balanced(few())


def test_the_work_of_designs_and_foreign_bodies_hardly_depends_on_the_time_step():
    assert_work_of_any_step(few())


def test_servos_heat_by_their_torque():
    """The temperature follows from the torque at the start of each step; the effort from that at its end."""
    runs = [Run(robot=ROBOTS["caiman"], gait=GAITS["semi_erect"]), *sampled_designs(2)]
    for run in runs:
        by_temperature, by_torque = heats(run)
        assert by_torque == pytest.approx(by_temperature, rel=HEAT_TOLERANCE), run.label


MANY = pytest.mark.slow("a hundred designs and thirty foreign bodies: more than ten seconds")


def many():
    return [*sampled_designs(100), *list(foreign_bodies(60))[::2]]


@MANY
def test_the_energy_of_a_hundred_designs_is_balanced():
    assert_balanced(many())


@MANY
def test_the_work_of_a_hundred_designs_hardly_depends_on_the_time_step():
    assert_work_of_any_step(many())


@MANY
def test_the_servos_of_a_hundred_designs_heat_by_their_torque():
    found = np.array([heats(run) for run in sampled_designs(100)])
    assert np.abs(found[:, 1] / found[:, 0] - 1.0).max() < HEAT_TOLERANCE

"""Means over a control period of what water and servos do."""

import numpy as np
import pytest

from suchus.robot.design import water_table as hydro
from suchus.sim.land.batch import Meter


def test_power_is_torque_times_the_mean_of_the_speeds_before_and_after():
    water, sensors = np.zeros((2, hydro.NUMBERS)), np.zeros((2, 5))
    meter = Meter(water, sensors, slice(0, 2), slice(3, 5), 2)
    sensors[:] = [[1.0, 2.0, 9.0, 7.0, 7.0], [0.0, 0.0, 9.0, 7.0, 7.0]]
    meter.begin()
    for step, (force, speed, torque) in enumerate(((4.0, 3.0, 10.0), (8.0, 5.0, 20.0))):
        water[:, hydro.FORCE] = force
        sensors[0, 0], sensors[0, 3] = speed, torque
        meter.record_step(step)
    out = np.full((2, 5), -1.0)
    meter.mean(out, np.array([True, False]))
    first = 10.0 * (1.0 + 3.0) / 2 + 7.0 * 2.0
    second = 20.0 * (3.0 + 5.0) / 2 + 7.0 * 2.0
    assert out[0] == pytest.approx([6.0, 0.0, 0.0, 0.0, (first + second) / 2])
    assert (out[1] == -1.0).all()

"""Chatter and the energy from the supply, against signals and servos whose answers are known exactly."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import Doubtful, IncompatibleRecord
from suchus.robot.design import GRAVITY, LINE, layout, with_named_servos
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.land.chatter_check import MAX_CHATTER, check_chatter
from suchus.sim.land.readings import thin
from suchus.sim.metrics import chatter, displacement, electrical_cost_of_transport, electrical_work, speed_chatter

CAIMAN, CRAWL = ROBOTS["caiman"], GAITS["low_crawl"]


def signals(mean, within=0.0, period=2.0):
    """Return a record of servos with given mean torques and a power within samples; speeds are the same numbers."""
    time = 0.01 * np.arange(len(mean))
    dims = ("time", "servo")
    return xr.Dataset(
        {
            "servo_mean_torque": (dims, mean), "servo_mean_square_torque": (dims, mean**2 + within),
            "servo_velocity": (dims, mean), "period": period,
        },
        coords={"time": time, "servo": [f"s{i}" for i in range(mean.shape[1])]},
    )  # fmt: skip


TIME = 0.01 * np.arange(1101)
SLOW, FAST = np.sin(2 * np.pi * 1.0 * TIME), np.sin(2 * np.pi * 20.0 * TIME)


@pytest.mark.parametrize("amplitude", [0.0, 0.1, 1.0, 3.0])
def test_the_fraction_is_that_of_the_power_of_a_fast_sine_beside_a_slow_one(amplitude):
    record = signals((2.0 + SLOW + amplitude * FAST)[:, None])
    expected = amplitude**2 / (1.0 + amplitude**2)
    assert float(chatter(record)) == pytest.approx(expected, abs=1e-3)
    assert float(speed_chatter(record)) == pytest.approx(expected, abs=1e-3)


def test_the_limit_is_ten_times_the_frequency_of_the_gait():
    record = signals((SLOW + np.sin(2 * np.pi * 6.0 * TIME))[:, None])
    assert float(chatter(record.assign(period=2.0))) == pytest.approx(0.5, abs=0.01)  # 6 Hz is above 5 Hz
    assert float(chatter(record.assign(period=1.0))) == pytest.approx(0.0, abs=0.01)  # and below 10 Hz


def test_servos_count_by_their_power_and_what_is_within_a_sample_counts():
    strong_and_calm = signals(np.column_stack([3.0 * SLOW, FAST]))
    assert float(chatter(strong_and_calm)) == pytest.approx(0.1, abs=1e-3)
    within = signals(SLOW[:, None], within=0.5)
    assert float(chatter(within)) == pytest.approx(0.5, abs=2e-3)
    assert float(speed_chatter(within)) == pytest.approx(0.0, abs=1e-3)


def test_what_cannot_be_seen_is_not_a_number():
    record = signals(SLOW[:, None])
    assert np.isnan(chatter(record.assign(period=20.0)))  # less than a cycle
    assert np.isnan(chatter(record.assign(period=0.1)))  # 100 Hz is not in 100 samples a second
    assert np.isnan(chatter(signals(0.0 * SLOW[:, None])))
    with pytest.raises(IncompatibleRecord, match="servo_mean_torque"):
        chatter(record.drop_vars("servo_mean_torque"))


@pytest.fixture(scope="module")
def calm_and_chattering():
    """Return the crawl of the caiman, and of one whose legs are fifty times as stiff with hardly any damping."""
    legs = [name for limb in layout(CAIMAN).limbs for name in layout(CAIMAN).servos[limb.servos]]
    stiff = {
        name: replace(CAIMAN.servo(name), kp=50.0 * CAIMAN.servo(name).kp, kd=1e-3, armature=0.02) for name in legs
    }
    runs = [Run(robot=CAIMAN, gait=CRAWL), Run(robot=with_named_servos(CAIMAN, stiff), gait=CRAWL, label="stiff")]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        record = simulate(runs, duration=4.0)
    return record, runs, [str(each.message) for each in caught if isinstance(each.message, Doubtful)]


def test_a_run_warns_of_servos_that_chatter_and_not_of_others(calm_and_chattering):
    record, runs, said = calm_and_chattering
    calm, stiff = chatter(record).values
    assert calm < 0.1 < MAX_CHATTER < stiff
    (text,) = [text for text in said if "chatter" in text]
    assert "run 1, 'stiff', chatter" in text
    assert "1 of 2 runs" in text
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_chatter(record.isel(run=[0]), runs[:1])


def test_energy_from_the_supply_is_copper_idle_and_driving(calm_and_chattering):
    record, _, _ = calm_and_chattering
    record = record.isel(run=0)
    window = record.sel(time=slice(1.0 - 1e-9, None)).isel(time=slice(1, None))
    expected = 0.0
    for name in layout(CAIMAN).servos:
        servo = CAIMAN.servo(name)
        each = window.sel(servo=name)
        current_square = each.servo_mean_square_torque * (servo.winding.stall_current / servo.torque) ** 2
        driving = (each.servo_power + each.servo_absolute_power) / 2
        idle = servo.winding.volts * servo.winding.idle_current
        expected += 3.0 * float((servo.winding.resistance * current_square + driving).mean()) + 3.0 * idle
    assert float(electrical_work(record)) == pytest.approx(expected, rel=1e-9)
    forward = displacement(record)
    distance = float(np.hypot(*forward.sel(xyz=["x", "y"])))
    cost = float(electrical_work(record)) / (CAIMAN.mass * GRAVITY * distance)
    assert float(electrical_cost_of_transport(record)) == pytest.approx(cost, rel=1e-9)
    assert np.isnan(electrical_work(record.drop_vars("servo_electrical_power")))


def test_a_thinned_record_has_the_same_energy(calm_and_chattering):
    record = calm_and_chattering[0].isel(run=0)
    assert float(electrical_work(thin(record, 4))) == pytest.approx(float(electrical_work(record)), rel=1e-9)


def test_a_servo_that_stands_still_takes_its_idle_current_and_half_the_supply_half_of_it():
    idle = replace(LINE, volts=12.0, stall_current=2.0, idle_current=0.1)
    servos = {name: replace(CAIMAN.servo(name), winding=idle) for name in layout(CAIMAN).servos}
    robot = with_named_servos(CAIMAN, servos)
    runs = [Run(robot=robot, gait=CRAWL, supply=supply) for supply in (1.0, 0.5)]
    record = simulate(runs, duration=1.5)
    losses = record.servo_electrical_power.isel(time=slice(1, None))
    servo = robot.servo("LF_yaw")
    torque = record.servo_mean_square_torque.sel(servo="LF_yaw").isel(time=slice(1, None))
    driving = 0.5 * (record.servo_power + record.servo_absolute_power).sel(servo="LF_yaw").isel(time=slice(1, None))
    rest = losses.sel(servo="LF_yaw") - 24.0 / servo.torque**2 * torque - driving
    np.testing.assert_allclose(rest.isel(run=0), 1.2, rtol=1e-6)
    np.testing.assert_allclose(rest.isel(run=1), 0.6, rtol=1e-6)

"""What servos and water do over a control period, from all its physics steps."""

import numpy as np
import pytest

from suchus import GAITS, ROBOTS
from suchus.core import water_table as hydro
from suchus.core.errors import IncompatibleRecord
from suchus.robot.control import Swimming
from suchus.sim import metrics
from suchus.sim.land import Lake, Limp, Run, simulate
from suchus.sim.land.loop import Loop
from suchus.sim.land.meter import Meter, ServoLaws, joint_effort, servo_effort
from suchus.sim.model import compile_model
from suchus.sim.record import EFFORT


def laws(robot, **values):
    """Return the laws of one run's servos, with other values for all of them."""
    model = compile_model(robot)
    result = ServoLaws(model, [robot])
    result.read(0, model.actuator_gainprm, model.actuator_biasprm, model.actuator_forcerange)
    for name, value in values.items():
        getattr(result, name)[:] = value
    return result


def column(effort, name):
    return effort[..., list(EFFORT).index(name)]


def test_effort_is_that_of_the_torque_with_the_speed_at_the_end_of_each_step(robot):
    """Two steps by hand: 2 - 0.5 * (3 - 1) = 1 N m, then 4 N m at the limit, which stays."""
    torque, start, end = (np.array(values)[:, None, None] for values in ([2.0, 4.0], [1.0, 3.0], [3.0, 2.0]))
    one = laws(robot, damping=0.5, limit=4.0, supplied_torque=8.0, falling_torque=1.0)
    effort = servo_effort(*(np.repeat(values, 19, axis=2) for values in (torque, start, end)), one)[0, 0]
    assert effort == pytest.approx([2.5, (1 + 16) / 2, (1 * 2 + 4 * 2.5) / 2, (2 + 10) / 2, 4.0, 1.0])


def test_a_servo_with_its_full_supply_loses_torque_as_its_motor_does_and_not_as_its_loop(robot):
    """2 N m at 2 rad/s are 4 N m at standstill, the full supply: at 3 rad/s the motor gives 1 N m, the loop would 1.5.

    Dragged at 5 rad/s by the load, it brakes by 1 N m, and by 2 N m at 6 rad/s.
    """
    torque, start, end = (np.array(values)[:, None, None] for values in ([2.0, -1.0], [2.0, 5.0], [3.0, 6.0]))
    one = laws(robot, damping=0.5, full_supply_damping=1.0, limit=4.0, supplied_torque=4.0, falling_torque=1.0)
    effort = servo_effort(*(np.repeat(values, 19, axis=2) for values in (torque, start, end)), one)[0, 0]
    assert column(effort, "servo_mean_torque") == pytest.approx((1.0 - 2.0) / 2)
    assert column(effort, "servo_mean_square_torque") == pytest.approx((1.0 + 4.0) / 2)


def test_braking_is_negative_power_and_counts_as_much_as_driving_in_absolute_power(robot):
    torque = np.stack([np.full((1, 19), 1.0), np.full((1, 19), -1.0)])
    speed = np.full((2, 1, 19), 2.0)
    effort = servo_effort(torque, speed, speed, laws(robot))[0, 0]
    assert column(effort, "servo_power") == pytest.approx(0.0)
    assert column(effort, "servo_absolute_power") == pytest.approx(2.0)


def test_a_meter_writes_the_chosen_runs_alone(robot):
    water, sensors = np.zeros((2, hydro.NUMBERS)), np.zeros((2, 38))
    model = compile_model(robot)
    two = ServoLaws(model, [robot, robot])
    meter = Meter(water, sensors, slice(0, 19), slice(19, 38), two, 2)
    meter.begin(sensors)
    for step, force in enumerate((4.0, 8.0)):
        water[:, hydro.FORCE] = force
        meter.record_step(step)
    means, effort = np.full((2, 4), -1.0), np.full((2, 19, 6), -1.0)
    meter.finish(means, effort, np.array([True, False]))
    assert means[0] == pytest.approx([6.0, 0.0, 0.0, 0.0])
    assert (means[1] == -1.0).all()
    assert (effort[1] == -1.0).all()


def test_two_intervals_join_by_their_durations(robot):
    """One period of six steps is two of four and two steps."""
    rng = np.random.default_rng(0)
    torque, start, end = rng.normal(size=(3, 6, 1, 19))
    numbers = laws(robot)
    whole = servo_effort(torque, start, end, numbers)
    parts = [servo_effort(torque[span], start[span], end[span], numbers) for span in (slice(4), slice(4, None))]
    assert joint_effort(parts, [4 / 6, 2 / 6]) == pytest.approx(whole)


def test_a_thinned_record_holds_the_work_of_all_periods(robot, crawl_gait):
    run = Run(robot=robot, gait=crawl_gait)
    full, thinned = (simulate([run], duration=2.0, timestep=0.005, sample_stride=stride) for stride in (1, 10))
    assert thinned.sizes["time"] == 21
    for name in ("work", "net_work", "peak_torque", "rms_torque"):
        values = [getattr(metrics, name)(record).values for record in (full, thinned)]
        assert values[1] == pytest.approx(values[0]), name


def test_a_record_without_effort_is_refused_by_name(robot, crawl_gait):
    record = simulate([Run(robot=robot, gait=crawl_gait)], duration=1.5, timestep=0.005, effort=False)
    assert not set(EFFORT) & set(record)
    with pytest.raises(IncompatibleRecord, match=r"holds no servo_absolute_power.*Displacement.*can still be measured"):
        metrics.cost_of_transport(record)
    assert np.isfinite(metrics.displacement(record)).all()


def test_an_unpowered_servo_does_no_work(robot, crawl_gait):
    run = Run(robot=robot, gait=crawl_gait, faults=(Limp("LF_pitch", 0.5),))
    effort = simulate([run], duration=1.5, timestep=0.005).sel(servo="LF_pitch", time=slice(0.52, None))
    for name in ("servo_peak_torque", "servo_absolute_power", "servo_mean_square_torque"):
        assert float(abs(effort[name]).max()) == 0.0
    assert float(abs(effort.servo_velocity).max()) > 0.01


@pytest.mark.parametrize("gait", ["high_walk", "semi_erect", "low_crawl"])
def test_work_and_heat_hardly_depend_on_the_time_step(robot, gait):
    """The sampled torque makes the work of the high walk a quarter too small; that of each step's start too great.

    A control period of 10 ms has two steps at 5 ms: there the motion itself is another, and work differs by up to 4 %.
    """
    run = Run(robot=robot, gait=GAITS[gait])
    coarse, usual, fine = (simulate([run], duration=3.0, timestep=step).isel(run=0) for step in (0.005, 0.002, 0.0005))
    for work in (metrics.work, metrics.net_work):
        assert float(work(usual)) == pytest.approx(float(work(fine)), rel=0.02)
        assert float(work(coarse)) == pytest.approx(float(work(fine)), rel=0.05)
    heats = [float((metrics.rms_torque(record) ** 2).sum()) for record in (usual, fine)]
    assert heats[0] == pytest.approx(heats[1], rel=0.03)


def test_power_in_a_lake_is_torque_times_speed(robot):
    """One advance over five steps meters the same as five advances of one step, which an outsider can multiply."""
    floating = ROBOTS["floating_caiman"]
    run = Run(robot=floating, gait=GAITS["belly_crawl"], lake=Lake(level=1.0), control=Swimming())
    loop, single = (Loop([run], 0.002, ticks=80) for _ in range(2))
    for tick in range(60):
        for own in (loop, single):
            own.decide()
        loop.advance()
        batch, power = single.batch, 0.0
        for _ in range(single.steps):
            start = batch.sensors[:, batch.velocities].copy()
            batch.advance(single.command.targets, 1, single.time)
            end, torque = batch.sensors[:, batch.velocities], batch.sensors[:, batch.torques]
            applied = torque - batch.laws.damping * (np.abs(torque) < batch.laws.limit) * (end - start)
            power = power + applied * (start + end) / 2 / single.steps
        single.skip(1)
        assert column(loop.batch.effort, "servo_power") == pytest.approx(power, rel=1e-9, abs=1e-12), tick
    assert float(np.abs(power).sum()) > 0.01

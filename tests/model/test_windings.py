"""The motor of a servo in MuJoCo: torque over speed, supply and heat, against its data sheet."""

import copy
from dataclasses import replace

import mujoco
import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import InvalidDesign
from suchus.robot.design import LINE, Servo, with_servos, with_speed_lines
from suchus.robot.design.motor import COPPER, ROOM_TEMPERATURE
from suchus.robot.gaits import GAITS
from suchus.robot.motors import motor
from suchus.sim.land import Backlash, Limp, Run, Slow, Weak, crawl, simulate
from suchus.sim.land.batch import Beginning
from suchus.sim.land.loop import Loop
from suchus.sim.model import activations, compile_model, warming
from suchus.sim.model.export.mjcf import mjcf

COARSE = 0.005
STS = motor("STS3250")


@pytest.fixture(scope="module")
def robot(former):
    return former


@pytest.fixture(scope="module")
def bought(robot):
    return with_servos(robot, lambda servo: Servo.from_motor(STS, template=servo))


def torque_at(robot, speed, *, supply=1.0, warmer=0.0, sign=1.0, joint="RH_knee"):
    """Return what a joint's servo gives when it is asked for more than it has, at a speed of its shaft [N m]."""
    model = copy.copy(compile_model(robot))
    model.actuator_gainprm[:, 7] *= supply
    data = mujoco.MjData(model)
    number = model.actuator(joint).id
    data.act[:] = activations(model, np.zeros(model.nu))
    data.act[model.actuator_actadr[number]] = sign * 3.0  # the angle that it aims at
    warm = warming(model, robot)[number]
    if warm >= 0:
        data.act[warm] = warmer
    data.qvel[model.joint(joint).dofadr[0]] = speed
    data.ctrl[:] = data.act[model.actuator_actadr]
    mujoco.mj_forward(model, data)
    assert data.qfrc_actuator[model.joint(joint).dofadr[0]] == data.actuator_force[number]
    return float(data.actuator_force[number])


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("share", [0.0, 0.25, 0.5, 0.9, 1.0])
def test_the_torque_falls_in_a_straight_line_to_what_the_gear_takes_at_the_speed_without_load(bought, share, sign):
    servo = bought.servo("RH_knee")
    idle = servo.friction + servo.damping * servo.speed
    given = sign * torque_at(bought, sign * share * servo.speed, sign=sign)
    assert given == pytest.approx(servo.torque - share * (servo.torque - idle))
    assert given == pytest.approx(float(servo.available_torque(np.array(share * servo.speed))))


def test_a_gear_that_eats_the_torque_is_refused(robot):
    with pytest.raises(InvalidDesign, match=r"take 4\.75 N m at 7\.873 rad/s, of a torque of 4\.903 N m"):
        Servo.from_motor(STS, template=replace(robot.servo("RH_knee"), damping=0.6))


def test_a_servo_that_is_driven_backwards_gives_no_more_than_at_standstill(bought):
    servo = bought.servo("RH_knee")
    assert torque_at(bought, -0.5 * servo.speed) == servo.torque


def test_the_torque_falls_with_the_supply_and_with_heat(bought):
    servo = bought.servo("RH_knee")
    assert torque_at(bought, 0.0, supply=0.75) == pytest.approx(0.75 * servo.torque)
    assert torque_at(bought, 0.0, warmer=40.0) == pytest.approx(servo.torque / (1.0 + COPPER * 40.0))


def test_a_servo_without_a_winding_gives_all_its_torque_at_any_speed(robot):
    assert torque_at(robot, 20.0) == robot.servo("RH_knee").torque
    lined = with_speed_lines(robot)
    servo = lined.servo("RH_knee")
    assert torque_at(lined, servo.speed) == pytest.approx(servo.friction)
    assert torque_at(lined, servo.speed / 2) == pytest.approx((servo.torque + servo.friction) / 2)
    assert with_speed_lines(lined) == lined
    assert (servo.winding, servo.damping) == (LINE, 0.0)


@pytest.mark.parametrize("volts", [12.0, 9.0])
def test_at_its_continuous_torque_the_winding_stays_at_its_limit(robot, volts):
    """Whatever the supply: the heat goes with the torque."""
    bought = with_servos(robot, lambda servo: Servo.from_motor(STS, volts, template=servo))
    model = compile_model(bought)
    data = mujoco.MjData(model)
    number, heat = model.actuator("RH_knee").id, STS.heat
    warm = warming(model, bought)[number]
    held = STS.continuous_torque / bought.servo("RH_knee").kp
    hot = 1.0 + COPPER * (
        heat.limit - ROOM_TEMPERATURE
    )  # the drive's voltage is that for a cold winding, which resists less
    for more, sign in ((0.9, -1), (1.0, 0), (1.1, 1)):
        data.act[:] = 0.0
        data.act[model.actuator_actadr[number]] = more * held * hot
        data.act[warm] = heat.limit - heat.ambient
        data.ctrl[:] = data.act[model.actuator_actadr]
        mujoco.mj_forward(model, data)
        rate = float(data.act_dot[warm])
        assert data.actuator_force[number] == pytest.approx(more * STS.continuous_torque)
        assert np.sign(round(rate, 9)) == sign
    cold = STS.volts * STS.stall_current * (STS.continuous_torque / STS.stall_torque) ** 2
    data.act[model.actuator_actadr[number]], data.act[warm] = held, 0.0
    data.ctrl[:] = data.act[model.actuator_actadr]
    mujoco.mj_forward(model, data)
    assert float(data.act_dot[warm]) == pytest.approx(cold / heat.capacity)
    assert heat.ambient == ROOM_TEMPERATURE


def test_a_record_knows_how_warm_the_servos_are(bought, robot):
    record = crawl(bought, "belly_crawl", duration=0.8, timestep=COARSE)
    warm = record.servo_temperature
    assert warm.attrs["units"] == "degC"
    assert (warm.isel(time=0) == ROOM_TEMPERATURE).all()
    assert (warm.diff("time") >= -1e-6).all()  # a minute would be needed to cool visibly
    current = (record.servo_torque / STS.stall_torque) ** 2
    heated = STS.volts * STS.stall_current * current.sum("time") * 0.01 / STS.heat.capacity
    np.testing.assert_allclose(warm.isel(time=-1) - ROOM_TEMPERATURE, heated, rtol=0.05, atol=2e-3)
    assert "servo_temperature" not in crawl(robot, "belly_crawl", duration=0.1)
    mixed = with_servos(robot, lambda servo: Servo.from_motor(STS, template=servo) if servo.torque == 3.0 else servo)
    record = crawl(mixed, "belly_crawl", duration=0.1)
    assert bool(record.servo_temperature.sel(servo="tail_cable").isnull().all())
    assert bool(record.servo_temperature.sel(servo="LF_yaw").notnull().all())


def test_windings_heat_and_supply_go_with_runs_that_are_copied(bought):
    run = Run(robot=bought, gait=GAITS["belly_crawl"])
    runs = [
        run,
        replace(run, faults=(Limp("LF_yaw", at=0.3),)),
        replace(run, faults=(Weak("LF_pitch", 0.1, at=0.2), Slow("LF_knee", 0.5, at=0.2), Backlash("RH_knee", at=0.2))),
        replace(run, supply=0.8),
        run,
    ]
    together = simulate(runs, duration=0.5, timestep=COARSE)
    for i, one in enumerate(runs):
        alone = simulate([one], duration=0.5, timestep=COARSE)
        xr.testing.assert_identical(together.isel(run=[i]).assign_coords(run=[0]), alone)
    warm = together.servo_temperature.isel(time=-1)
    assert not warm.isel(run=0).equals(warm.isel(run=1))
    limp = together.servo_torque.sel(run=1, servo="LF_yaw").isel(time=slice(32, None))
    assert (limp == 0.0).all()


def test_a_robot_that_begins_anew_is_as_cold_as_its_beginning_says(bought):
    run = Run(robot=bought, gait=GAITS["belly_crawl"])
    loop = Loop([run, run], COARSE, ticks=60)
    first = np.array(loop.batch.activations[0])
    start = Beginning(
        np.array(loop.batch.qpos[0]), np.array(loop.batch.qvel[0]), first, np.array(loop.controller.rest()[0])
    )
    for _ in range(30):
        loop.decide()
        loop.advance()
    warm = warming(loop.batch.model, bought)
    heated = np.array(loop.batch.activations[0])
    assert (heated[warm] > first[warm]).all()
    loop.restart(0, start)
    np.testing.assert_array_equal(loop.batch.activations[0], first)
    np.testing.assert_array_equal(loop.batch.activations[1], heated)


def test_a_slower_supply_makes_a_servo_slower_and_one_without_a_motor_does_not_feel_it(bought, robot):
    def knees(body, supply):
        record = simulate([Run(robot=body, gait=GAITS["high_walk"], supply=supply)], duration=1.2, timestep=COARSE)
        return float(abs(record.servo_velocity.sel(servo="LF_knee")).max())

    assert knees(bought, 0.5) < 0.5 * 1.1 * STS.no_load_speed < knees(bought, 1.0)
    assert knees(robot, 0.5) == knees(robot, 1.0)
    with pytest.raises(InvalidDesign, match=r"run\.supply is 0; 0\.01 to 2"):
        Run(robot=robot, gait=GAITS["high_walk"], supply=0.0)


def test_what_is_written_for_mujoco_compiles_to_the_same_motors(bought, tmp_path):
    body, scene = mjcf(bought, GAITS["belly_crawl"])
    (tmp_path / f"{bought.name}.xml").write_text(body)
    (tmp_path / "scene.xml").write_text(scene)
    again, own = mujoco.MjModel.from_xml_path(str(tmp_path / "scene.xml")), compile_model(bought)
    for name in ("actuator_gainprm", "actuator_dynprm", "actuator_biasprm", "actuator_forcerange", "actuator_actnum"):
        np.testing.assert_array_equal(getattr(again, name), getattr(own, name))


def test_robots_share_a_batch_only_if_their_servos_have_equal_states(bought, robot):
    lined = with_speed_lines(robot)
    gait = GAITS["belly_crawl"]
    simulate([Run(robot=robot, gait=gait), Run(robot=lined, gait=gait)], duration=0.05)
    with pytest.raises(InvalidDesign, match="warm up"):
        simulate([Run(robot=robot, gait=gait), Run(robot=bought, gait=gait)], duration=0.05)

"""A joint on a stand does what its servo's law says."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.core.errors import InvalidDesign, UnknownName
from suchus.robot.design.servos import with_servos
from suchus.sim.land.stand import on_stand

ONE_SECOND = 500


def still(**changes):
    none = np.zeros(ONE_SECOND)
    return {"target": none, "load": none, "gripped": none.astype(bool)} | changes


def with_integral(robot, ki, limit=10.0):
    return with_servos(robot, lambda servo: replace(servo, ki=ki, integral_limit=limit))


def test_nothing_moves_a_joint_that_nothing_asks(robot):
    response = on_stand(robot, "LH_pitch", **still())
    assert response.angle == pytest.approx(0.0, abs=1e-9)
    assert response.time[[0, -1]] == pytest.approx([0.002, 1.0])


@pytest.mark.parametrize("load", [0.5, -1.0])
def test_without_an_integral_a_joint_sags_by_load_over_gain(robot, load):
    response = on_stand(robot, "LH_pitch", **still(load=np.full(ONE_SECOND, load)))
    servo = robot.servo("LH_pitch")
    assert response.angle[-1] == pytest.approx(load / servo.kp, abs=servo.friction / servo.kp)
    assert response.torque[-1] == pytest.approx(-load, abs=servo.friction)


def test_an_integral_carries_the_load_up_to_its_limit(robot):
    load, servo = np.full(2 * ONE_SECOND, 1.0), robot.servo("LH_pitch")
    none = np.zeros(2 * ONE_SECOND)
    free, short = (
        on_stand(with_integral(robot, 80.0, limit), "LH_pitch", target=none, load=load, gripped=none > 0).angle[-1]
        for limit in (10.0, 0.25)
    )
    assert abs(free) < 0.05 / servo.kp  # after four time constants kp/ki less than a fiftieth of the droop is left
    assert short == pytest.approx((1.0 - 0.25) / servo.kp, abs=servo.friction / servo.kp)


def test_a_step_arrives_and_no_faster_than_the_servo_turns(robot):
    response = on_stand(robot, "LH_pitch", **still(target=np.full(ONE_SECOND, 0.5)))
    assert response.angle[-1] == pytest.approx(0.5, abs=robot.servo("LH_pitch").friction / robot.servo("LH_pitch").kp)
    assert response.time[np.argmax(response.angle > 0.45)] > 0.45 / robot.servo("LH_pitch").speed


def test_a_grip_holds_and_lets_go(robot):
    held = np.arange(ONE_SECOND) < ONE_SECOND // 2
    response = on_stand(robot, "LH_pitch", **still(target=np.full(ONE_SECOND, 0.2), gripped=held))
    assert np.abs(response.angle[held][-1]) < 0.02
    assert response.angle[-1] == pytest.approx(0.2, abs=0.002)


def test_what_cannot_be_tested_is_refused(robot):
    with pytest.raises(UnknownName, match="LH_toe"):
        on_stand(robot, "LH_toe", **still())
    with pytest.raises(InvalidDesign, match="turns no joint of its own"):
        on_stand(robot, "tail_cable", **still())
    with pytest.raises(InvalidDesign, match="500, 3 and 500 samples"):
        on_stand(robot, "LH_pitch", **still(load=np.zeros(3)))

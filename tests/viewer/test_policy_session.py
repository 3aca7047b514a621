"""A live walk that a policy leads: two sliders command it."""

import numpy as np
import pytest
from tests.control.test_learned import network_policy, table_policy

from suchus.apps.viewer import Session
from suchus.apps.viewer.session import plain_knobs
from suchus.core.errors import UnsuitedRobot
from suchus.robot.control import Learned
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Live, Run

STRIDER = ROBOTS["strider"]
NEUTRAL, STILL = (1.0, 1.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0)
LEFT = (1.0, 1.0, 1.0, 0.0)
WALK = table_policy(STRIDER, table=((STILL, LEFT), (NEUTRAL, LEFT)))


def test_the_sliders_command_speed_and_turning_rate():
    session = Session(STRIDER, WALK.gait, policy=WALK)
    assert session.settings.forward == 0.05
    assert set(plain_knobs(STRIDER, WALK)) - set(plain_knobs(STRIDER)) == {"forward", "turn"}
    assert session.set_number("forward", 0.1) == ""
    session.advance(2.5)
    walked = session.instant().forward
    assert walked > 0.05
    assert session.set_number("forward", 0.0) == ""
    session.advance(1.5)
    stood = session.instant().forward
    session.advance(1.0)
    assert abs(session.instant().forward - stood) < 0.01
    assert "is outside 0 to 0.1 m/s" in session.set_number("forward", 7.0)
    assert session.set_number("turn", 0.4) == ""
    session.advance(2.0)
    w, _, _, z = np.moveaxis(session.instant().state["orientation"], -1, 0)
    assert 2 * np.arctan2(z, w) > 0.1
    assert session.walk_count == 1


def test_a_change_of_command_does_not_jolt_the_servos():
    """The clock and the parameters go on from where they were."""
    session = Session(STRIDER, WALK.gait, policy=WALK)
    session.advance(2.0)
    before = session.instant().state["servo_target"].copy()
    session.set_number("turn", 0.4)
    session.advance(0.01)
    assert np.abs(session.instant().state["servo_target"] - before).max() < 0.1


def test_a_policy_that_is_told_hears_of_a_broken_joint():
    policy = network_policy(STRIDER, readings=("clock", "failure"), actions=("stroke", "limb_stroke"))
    session = Session(STRIDER, policy.gait, policy=policy)
    assert session.break_part("LF_yaw", "limp") == ""
    control = session.settings.control
    assert isinstance(control, Learned)
    assert control.failures == ((0.0, "LF_yaw"),)
    session.repair_part()
    assert session.settings.control.failures == ()


def test_a_policy_of_another_robot_is_refused():
    with pytest.raises(UnsuitedRobot, match="has 4"):
        Session(ROBOTS["caiman"], WALK.gait, policy=WALK)


def test_a_live_policy_walks_as_in_a_batch():
    control = Learned(policy=WALK, forward=0.1)
    live = Live(Run(robot=STRIDER, gait=WALK.gait, control=control), timestep=0.005)
    for _ in range(200):
        live.step()
    assert live.current_sample["centre_of_mass"][0] > 0.02

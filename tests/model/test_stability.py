"""The longest step that holds a robot's joints: of which size it is, and that longer ones do not hold them."""

import numpy as np
import pytest

from body_files import giant
from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot.design import with_servos, with_values
from suchus.robot.design.scale import physics_step, rescale, swim_servo_for
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import VACUUM, Run, simulate
from suchus.sim.model import longest_step


def test_the_longest_step_is_a_time_of_the_body():
    robot = ROBOTS["caiman"]
    assert longest_step(rescale(robot, length_factor=0.25)) == pytest.approx(longest_step(robot) / 2, rel=1e-6)


def test_shorter_steps_hold_the_joints_and_longer_ones_do_not():
    robot = giant()
    asked = EXPERIMENTS["death_roll"].quick().for_robot(robot)
    run = asked._floating_run(asked._roll(), "trunk", "vacuum")
    longest = longest_step(robot)
    assert 0.0005 < longest < 0.001
    for step, holds in ((0.0005, True), (0.001, False)):
        record = simulate([run], duration=0.06, timestep=step)
        assert np.isfinite(record.servo_velocity.values).all() == holds
    assert max(*asked.timesteps, asked.coarse_timestep, asked.timestep) < longest


def test_a_robot_that_is_nearly_as_stiff_rolls_in_the_same_steps():
    asked = EXPERIMENTS["death_roll"].quick()
    assert asked.for_robot(ROBOTS["long_tail"]).timesteps == asked.timesteps


def test_a_run_without_ground_that_is_asked_for_no_step_takes_one_that_holds_it():
    """Its steps are explicit, where those on ground are not: a servo of strong dampers needs shorter ones."""
    shelved, gait = ROBOTS["swimmer"], GAITS["undulation"]
    swimmer = with_servos(shelved, lambda _: swim_servo_for(shelved.mass, shelved.length))
    dampers = {f"axis[{i}].hinges[0].drive.kd": 4 * part.hinges[0].drive.kd for i, part in enumerate(swimmer.axis[:-1])}
    stiff = with_values(swimmer, dampers)
    fastest = {}
    for robot, step in ((swimmer, None), (stiff, None), (stiff, physics_step(stiff))):
        record = simulate([Run(robot=robot, gait=gait, afloat=VACUUM)], duration=1.1, timestep=step)
        fastest[record.attrs["timestep"]] = float(np.abs(record.servo_velocity).max())
        assert step or record.attrs["timestep"] <= longest_step(robot)
    assert min(fastest) < 0.3 * physics_step(swimmer)
    assert fastest[min(fastest)] < 15.0 < 30.0 < fastest[physics_step(swimmer)]  # the joints rattle


def test_a_servo_with_a_motor_is_as_stiff_as_one_without(robot, former):
    """Torque that falls with speed moves nothing at rest."""
    assert longest_step(robot) == pytest.approx(longest_step(former), rel=1e-6)

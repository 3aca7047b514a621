"""Walks and swims in the engine of the page are those of MuJoCo on this machine."""

import numpy as np
import pytest
from tests.laboratory.page_modules import needs_engine, needs_node, run
from tests.model.hinge_trees import quadruped

from suchus.apps.laboratory.description import facts
from suchus.apps.laboratory.page import swims_by_default
from suchus.robot.control import OpenLoop, Swimming
from suchus.robot.design.ground import Ground
from suchus.robot.design.scale import control_period
from suchus.robot.gaits import control_group, default_gait
from suchus.robot.motion import START
from suchus.robot.robots import ROBOTS
from suchus.sim.faults import Limp, Locked, Weak
from suchus.sim.land import Lake, Push, Run, simulate
from suchus.sim.metrics.contact import limb_load
from suchus.sim.model.importing import import_robot

pytestmark = [needs_node, needs_engine]
MILLIMETRE = 1e-3


def both(robot, gait, *, cycles=2.0, faults=(), push=None, **world):
    """Return the record of a run, and that of the page: its displacement and everything that is measured."""
    swims, period = swims_by_default(robot, gait), control_period(robot)
    duration = START + cycles * gait.period
    ticks = round(duration / period)
    native = simulate(
        [
            Run(
                robot=robot,
                gait=gait,
                faults=tuple(faults),
                pushes=() if push is None else (push,),
                ground=Ground(uphill=world.get("uphill", 0.0), friction_scale=world.get("friction", 1.0)),
                lake=None if world.get("level") is None else Lake(level=world["level"]),
                control=Swimming() if swims else OpenLoop(),
            )
        ],
        duration=ticks * period,
    ).isel(run=0)
    given = facts(robot, gait, swims=swims)
    case = {
        "facts": given,
        "settings": world,
        "ticks": ticks,
        "faults": [
            {
                "at": round(fault.at / period),
                "servo": given["robot"]["servos"].index(fault.joint),
                "kind": fault.kind(),
                "fraction": getattr(fault, "fraction", 1.0),
            }
            for fault in faults
        ],
    }
    if push is not None:
        case["push"] = {
            "at": round(push.at / period),
            "body": push.body,
            "force": push.force,
            "duration": push.duration,
        }
    page = run("walk", cases=[case])[0]
    assert page["cause"] == ""
    return native, page


def forward(path):
    return np.asarray(path)[-1] - np.asarray(path)[0]


@pytest.mark.parametrize("name", [*ROBOTS])
def test_two_cycles_end_within_a_millimetre(name):
    robot = ROBOTS[name]
    gait = default_gait(robot)
    level = 0.5 * robot.length if swims_by_default(robot, gait) else None
    native, page = both(robot, gait, level=level)
    assert np.abs(forward(page["record"]["com"])[:2] - forward(native.centre_of_mass.values)[:2]).max() < MILLIMETRE
    assert np.abs(forward(native.centre_of_mass.values)[0]) > 20 * MILLIMETRE * robot.length


def test_the_control_group_loads_and_powers_agree_too():
    robot = ROBOTS["strider"]
    native, page = both(robot, control_group(default_gait(robot)))
    assert np.abs(np.array(page["record"]["com"]) - native.centre_of_mass.values).max() < 1e-6
    load = limb_load(native).sel(xyz="z").transpose("time", "leg").values
    assert np.abs(np.array(page["record"]["load"])[1:] - load[1:]).max() < 1e-3 * load.max()
    power = native.servo_absolute_power.sum("servo").values
    assert np.array(page["record"]["power"])[1:] == pytest.approx(power[1:], rel=1e-6, abs=1e-6)


def test_slope_and_friction_act_alike():
    robot = ROBOTS["salamandra"]
    native, page = both(robot, default_gait(robot), uphill=0.08, friction=0.6)
    assert np.abs(forward(page["record"]["com"]) - forward(native.centre_of_mass.values)).max() < MILLIMETRE


@pytest.mark.parametrize("fault", [Limp("LF_yaw", at=1.2), Weak("LH_pitch", 0.05, at=1.2), Locked("RH_yaw", at=1.2)])
def test_faults_act_alike(fault):
    robot = ROBOTS["strider"]
    native, page = both(robot, default_gait(robot), cycles=1.0, faults=[fault])
    whole, _ = both(robot, default_gait(robot), cycles=1.0)
    assert np.abs(np.array(page["record"]["com"]) - native.centre_of_mass.values).max() < 1e-6
    moved = np.abs(whole.centre_of_mass.values - native.centre_of_mass.values).max()
    assert moved > 1e-5, "the fault does nothing"


def test_a_push_acts_alike():
    robot = ROBOTS["strider"]
    push = Push(body=robot.root, force=(0.0, 12.0, 0.0), at=1.1, duration=0.25)
    native, page = both(robot, default_gait(robot), cycles=0.5, push=push)
    assert np.abs(np.array(page["record"]["com"]) - native.centre_of_mass.values).max() < 1e-6


def test_a_floating_body_rests_at_the_surface_and_a_walker_wades():
    robot = ROBOTS["floating_caiman"]
    for level in (0.6, 0.05):
        native, page = both(robot, default_gait(robot), cycles=0.25, level=level)
        assert np.abs(np.array(page["record"]["com"]) - native.centre_of_mass.values).max() < 1e-4


def test_an_imported_quadruped_walks_alike(tmp_path):
    file = tmp_path / "dog.urdf"
    file.write_text(quadruped())
    robot = import_robot(file, name="dog").robot
    native, page = both(robot, default_gait(robot))
    assert np.abs(forward(page["record"]["com"]) - forward(native.centre_of_mass.values)).max() < MILLIMETRE

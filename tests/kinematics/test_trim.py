"""Air in two chambers for a robot that hovers level: the moment by hand, and MuJoCo's centre of mass."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from suchus.core.errors import InvalidDesign, UnknownName
from suchus.core.water_table import column, unpack_table
from suchus.robot.control.holding import neutral_air_fraction
from suchus.robot.design import Chamber, Hull, layout
from suchus.robot.design.flotation import float_hull
from suchus.robot.design.pieces import SOLID, chambers, masses, pieces, volumes
from suchus.robot.kinematics.tree import centre_of_mass
from suchus.robot.kinematics.trim import level_chambers, spare_volume
from suchus.robot.motion import cycle_targets, limbs_back, straight_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.model.build import TIMESTEP, joint_addresses
from suchus.sim.model.hydrostatics import hydrostatics
from suchus.sim.model.wet import wet_model

BARE, ROBOT = ROBOTS["caiman"], ROBOTS["floating_caiman"]
BACK = cycle_targets(ROBOT, straight_gait(ROBOT), np.zeros(1))[0]
IN_FOAM = replace(ROBOT, hull=replace(ROBOT.hull, chambers=()))


def posed(robot, angles):
    model = wet_model(robot, TIMESTEP, None, len(pieces(robot)))
    data = mujoco.MjData(model)
    data.qpos[:3] = 0.0
    data.qpos[joint_addresses(model, layout(robot).hinges)] = angles
    mujoco.mj_fwdPosition(model, data)
    return model, data


@pytest.mark.parametrize("name", ["floating_caiman", "salamander", "strider"])
def test_the_centre_of_mass_counts_the_foam(name):
    robot = ROBOTS[name]
    angles = np.random.default_rng(1).uniform(-0.3, 0.3, len(layout(robot).hinges))
    _, data = posed(robot, angles)
    assert centre_of_mass(robot, angles) == pytest.approx(data.subtree_com[1], abs=1e-9)


def test_what_hovers_is_displaced_where_the_mass_is():
    model, data = posed(ROBOT, limbs_back(ROBOT))
    table = unpack_table(model.numeric_data)
    ids = table[:, 0].astype(int)
    at = data.xpos[ids] + np.einsum("nij,nj->ni", data.xmat[ids].reshape(-1, 3, 3), column(table, "at"))
    kept = column(table, "volume")[:, 0] - (1.0 - neutral_air_fraction(ROBOT)) * column(table, "air").sum(axis=1)
    assert kept.sum() * 1000.0 == pytest.approx(ROBOT.mass, rel=1e-9)
    assert (kept @ at / kept.sum())[0] == pytest.approx(data.subtree_com[1][0], abs=1e-9)


def test_it_hovers_level_and_with_the_air_in_its_foam_it_did_not():
    air_fraction = neutral_air_fraction(ROBOT)
    level, steep = (hydrostatics(one, BACK, air_fraction=air_fraction, heel_count=3) for one in (ROBOT, IN_FOAM))
    assert abs(level.trim_submerged) < 1e-6
    assert np.degrees(steep.trim_submerged) < -30.0  # nose up
    assert level.metacentric_height > 0.004


def test_air_that_moves_ahead_raises_the_nose():
    air_fraction, (front, rear) = neutral_air_fraction(ROBOT), chambers(ROBOT)
    for moved in (2e-5, -2e-5):
        found = hydrostatics(
            ROBOT, BACK, air_fraction=(air_fraction + moved / front, air_fraction - moved / rear), heel_count=3
        )
        assert found.volume * 1000.0 == pytest.approx(ROBOT.mass)
        assert np.sign(found.trim_submerged) == -np.sign(moved)
        assert abs(found.trim_submerged) > 0.2


def test_chambers_change_nothing_as_long_as_all_the_air_is_kept():
    for name in ("at", "half", "volume", "added", "area"):
        assert np.array_equal(column(pieces(ROBOT), name), column(pieces(IN_FOAM), name))
    assert sum(chambers(ROBOT)) == pytest.approx(sum(chambers(IN_FOAM)), rel=1e-12)


def test_air_ahead_of_the_root_is_front_air():
    table, place = pieces(ROBOT), layout(ROBOT)
    names = np.array([body.name for body in place.bodies])[table[:, 0].astype(int)]
    front, rear = column(table, "air").T
    assert set(names[front > 0]) == {"thorax"}
    assert set(names[rear > 0]) == {"pelvis"}
    share = {chamber.body: chamber.share for chamber in ROBOT.hull.chambers}
    assert chambers(ROBOT) == pytest.approx([share["thorax"] * ROBOT.hull.air, share["pelvis"] * ROBOT.hull.air])
    assert chambers(BARE) == (0.0, 0.0)


def test_a_robot_lets_out_what_it_displaces_beyond_its_weight():
    assert spare_volume(ROBOT) == pytest.approx(sum(volumes(ROBOT).values()) - ROBOT.mass / 1000.0)


def hulled(**fields):
    return replace(BARE, hull=replace(float_hull(BARE, foam_offset=0.016, air=4e-4), **fields))


def split(front, rear):
    return (Chamber(body="thorax", share=front), Chamber(body="pelvis", share=rear))


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda: level_chambers(BARE, limbs_back(BARE), front="thorax", rear="pelvis"), InvalidDesign, "has 0 l"),
        (
            lambda: level_chambers(IN_FOAM, limbs_back(BARE), front="pelvis", rear="tail_1"),
            InvalidDesign,
            "choose chambers before and behind",
        ),
        (
            lambda: level_chambers(IN_FOAM, limbs_back(BARE), front="thorax", rear="wing"),
            UnknownName,
            "wing",
        ),
        (lambda: Chamber(body="thorax", share=1.5), InvalidDesign, "share is 1.5; 0 to 1"),
        (lambda: Hull(foam=(), chambers=split(0.5, 0.4)), InvalidDesign, "add up to 0.9"),
        (
            lambda: Hull(foam=(), chambers=(*split(0.5, 0.25), Chamber(body="pelvis", share=0.25))),
            InvalidDesign,
            "more than once",
        ),
        (lambda: pieces(hulled(chambers=split(1.0, 0.0))), InvalidDesign, "the chamber in thorax .* make the chamber"),
        (
            lambda: pieces(hulled(chambers=(Chamber(body="LF_femur", share=1.0),))),
            InvalidDesign,
            "the axis of robot 'caiman' has no such body",
        ),
    ],
)
def test_chambers_that_cannot_be_are_refused(make, error, message):
    with pytest.raises(error, match=message):
        make()


def test_a_chamber_may_be_as_large_as_the_hollow_of_its_body_and_no_larger():
    robot = hulled(air=1e-4, chambers=split(0.5, 0.5))
    hollow = volumes(robot)["pelvis"] - masses(robot)["pelvis"] / SOLID
    assert sum(chambers(hulled(air=0.999 * hollow, chambers=split(0.0, 1.0)))) == pytest.approx(0.999 * hollow)
    with pytest.raises(InvalidDesign, match="at most"):
        pieces(hulled(air=1.001 * hollow, chambers=split(0.0, 1.0)))

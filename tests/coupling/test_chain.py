"""The midline over a robot's joints: where its ends are, its derivatives, and what a force asks of the joints."""

import mujoco
import numpy as np
import pytest

from suchus import flow
from suchus.flow.momentum import Reaction
from suchus.robot.robots import ROBOTS
from suchus.sim.model import compile_model, joint_addresses
from suchus.swimming.coupling.chain import ChainPath, ChainState, MidlineChain
from suchus.swimming.water import Outline

NAMES = ("floating_caiman", "swimmer", "salamander")


def chain(name, cells=80):
    return MidlineChain(Outline(ROBOTS[name], cells + 1), 45)


def bent(one, size=0.15):
    rng = np.random.default_rng(3)
    return np.array([0.3, -0.2, 0.4, *size * rng.uniform(-1, 1, len(one.joints))])


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("size", "off"), [(0.0, 1e-9), (0.1, 0.03)])  # bends are smeared, and so cut corners
def test_the_ends_of_the_midline_are_where_the_robot_has_them(name, size, off):
    one = chain(name)
    model = compile_model(one.outline.robot)
    data = mujoco.MjData(model)
    place = bent(one, size)
    data.qpos[:3], data.qpos[3], data.qpos[6] = (-place[0], -place[1], 0.0), np.cos(place[2] / 2), np.sin(place[2] / 2)
    data.qpos[joint_addresses(model, one.joints)] = place[3:]
    mujoco.mj_kinematics(model, data)
    line = one.midline(place).position
    for end, site in ((0, "snout"), (-1, "tail_tip")):
        assert line[:, end] == pytest.approx(-data.site(site).xpos[:2], abs=off * one.outline.robot.length)


@pytest.mark.parametrize("name", NAMES)
def test_derivatives_are_those_of_the_places(name):
    one = chain(name)
    place, step = bent(one), 1e-6
    for points in (one.midline, one.centres):
        here = points(place)
        for k, unit in enumerate(np.eye(one.size)):
            ahead, behind = points(place + step * unit), points(place - step * unit)
            assert here.jacobian[:, :, k] == pytest.approx((ahead.position - behind.position) / (2 * step), abs=1e-8)
            assert here.turning[:, k] == pytest.approx((ahead.heading - behind.heading) / (2 * step), abs=1e-8)


@pytest.mark.parametrize("name", NAMES)
def test_a_force_spread_along_a_part_works_by_the_mean_of_its_velocity(name):
    one = chain(name)
    place, fine = bent(one, 0.5), 400
    line, points = one.midline(place), one.centres(place)
    for part, (a, b) in enumerate(zip(one.ends[:-1], one.ends[1:], strict=True)):
        s = a + (b - a) * (np.arange(fine) + 0.5) / fine
        for mean, values in (
            (points.position[:, part], line.position),
            (points.jacobian[:, part, 3], line.jacobian[:, :, 3]),
        ):
            exact = [np.interp(s, one.outline.s, row).mean() for row in values]
            assert mean == pytest.approx(exact, abs=1e-6)


def test_the_work_of_a_force_is_that_of_its_parts():
    one, rng = chain("floating_caiman"), np.random.default_rng(1)
    place, rate = bent(one), rng.normal(size=one.size)
    origin, about = np.array([0.1, -0.3]), np.array([0.4, 0.2])
    count = len(one.ends) - 1
    pull, own = rng.normal(size=(count, 2)), rng.normal(size=count)
    points = one.centres(place)
    off = points.position.T - origin - about
    moments = own + off[:, 0] * pull[:, 1] - off[:, 1] * pull[:, 0]
    parts = Reaction(force=pull, moment=moments[:, None], power=np.zeros(count))
    loads = flow.FlowLoads(reference_point=about, total=parts, parts=parts, internal_pressure=np.zeros((count, 3)))
    moved = one.twists(place, rate, origin, 2)
    work = (pull * moved.linear).sum() + (own * moved.angular[:, 0]).sum()
    assert one.force(place, loads, origin) @ rate == pytest.approx(work, rel=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_parts_that_press_on_each_other_work_on_each_joint_by_the_moment_of_a_section(name):
    """Wherever the body is: of a pressure's moment that is the same in all sections each joint feels it once."""
    one, moment, level = chain(name), 0.7, 3.0
    straight = np.array([0.4, -0.1, 0.6, *np.zeros(len(one.joints))])
    origin, about, long = np.array([0.2, 0.1]), np.array([-0.3, 0.5]), np.diff(one.ends)
    points = one.centres(straight)
    aside = np.stack([-np.sin(points.heading), np.cos(points.heading)])
    first = moment * long * aside + level * long * (points.position - (origin + about)[:, None])
    pressed = np.column_stack([level * long, *first])
    count = len(long)
    still = Reaction(force=np.zeros((count, 2)), moment=np.zeros((count, 1)), power=np.zeros(count))
    loads = flow.FlowLoads(reference_point=about, total=still, parts=still, internal_pressure=pressed)
    turning = one.midline(straight).turning
    signs = turning[-1] - turning[0]  # by how much each coordinate turns the tail against the head
    assert np.abs(signs) == pytest.approx([0.0] * 3 + [1.0] * len(one.joints), abs=1e-12)
    assert one.force(straight, loads, origin) == pytest.approx(moment * signs, abs=1e-12)


def test_a_path_has_the_places_and_rates_of_both_ends():
    start, end = (
        ChainState(np.array([0.0, 1.0]), np.array([2.0, -1.0])),
        ChainState(np.array([0.3, 0.7]), np.array([1.0, 0.5])),
    )
    path = ChainPath(0.0, start)
    path.go(1.0, start, 1.2, end)
    for time, posture in ((1.0, start), (1.2, end)):
        assert path.posture_at(time).position == pytest.approx(posture.position)
        assert path.posture_at(time).rate == pytest.approx(posture.rate)
    ahead, behind = path.posture_at(1.07 + 1e-6), path.posture_at(1.07 - 1e-6)
    assert path.posture_at(1.07).rate == pytest.approx((ahead.position - behind.position) / 2e-6, abs=1e-6)

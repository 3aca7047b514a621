from dataclasses import replace

import mujoco
import numpy as np
import pytest
import xarray as xr

import suchus
from suchus.robot.control.standing import Standing
from suchus.robot.design import crocodile
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import lead, longest_hold, reach, static_margin
from suchus.sim.model import compile_model

CAIMAN, CRAWL = suchus.ROBOTS["caiman"], suchus.GAITS["belly_crawl"]


@pytest.fixture(scope="module")
def rising():
    """Two robots that get up, one of them shaking."""
    standing = Standing(at=0.2, hold=1.0)
    runs = [Run(robot=CAIMAN, gait=CRAWL, control=standing, noise=noise) for noise in (0.0, 0.05)]
    return simulate(runs, duration=10.0, timestep=0.005, sample_stride=25)


def highest_vertex(robot, now):
    """Return the highest point of trunk and head, from the vertices of MuJoCo's geoms [m]."""
    model = compile_model(robot)
    data = mujoco.MjData(model)
    data.qpos[:3], data.qpos[3:7] = now.position, now.orientation
    for name, angle in zip(now.joint.values, now.joint_angle.values, strict=True):
        data.joint(str(name)).qpos[0] = angle
    mujoco.mj_kinematics(model, data)
    tops = []
    a, b = np.meshgrid(np.linspace(0, np.pi, 721), np.linspace(0, 2 * np.pi, 721))
    ball = np.stack([np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)], axis=-1)
    for name in ("pelvis", "spine_1", "spine_2", "spine_3", "spine_4", "thorax", "head"):
        geom, size = data.geom(name), model.geom(name).size
        up = geom.xmat.reshape(3, 3)[2]
        if model.geom(name).type == mujoco.mjtGeom.mjGEOM_ELLIPSOID:
            tops.append(geom.xpos[2] + np.max((ball * size) @ up))
        else:
            tops.append(geom.xpos[2] + size[1] * abs(up[2]) + size[0])
    return max(tops)


def test_reach_is_the_highest_point_of_mujocos_shapes(rising):
    heights = reach(CAIMAN, rising)
    assert heights.dims == ("run", "time")
    for run, time in ((0, 0.0), (1, 2.5), (0, 5.0), (1, 7.5), (0, 10.0)):
        now = rising.isel(run=run).sel(time=time, method="nearest")
        assert float(heights.isel(run=run).sel(time=time, method="nearest")) == pytest.approx(
            highest_vertex(CAIMAN, now), abs=2e-6
        )


def triangle(com, tail=(-0.4, 0.0), turn=0.0, at=(0.0, 0.0)):
    """Return a record of a robot on two hind feet 0.2 m apart, turned and moved on the ground."""
    c, s = np.cos(turn), np.sin(turn)
    place = lambda p: [c * p[0] - s * p[1] + at[0], s * p[0] + c * p[1] + at[1], 0.0]  # noqa: E731
    feet = np.array([place((0.3, 0.1)), place((0.3, -0.1)), place((0.0, 0.1)), place((0.0, -0.1))])
    coords = {"xyz": list("xyz"), "leg": ["LF", "RF", "LH", "RH"], "time": [0.0]}
    return xr.Dataset(
        {
            "foot_position": (("time", "leg", "xyz"), feet[None]),
            "centre_of_mass": (("time", "xyz"), [place(com)]),
            "tail_tip": (("time", "xyz"), [place(tail)]),
        },
        coords=coords,
    )


@pytest.mark.parametrize("turn", [0.0, 0.7, 3.0])
def test_margin_and_lead_of_a_triangle(turn):
    where = {"turn": turn, "at": (1.0, -2.0)}
    behind = triangle((-0.05, 0.0), **where)
    assert float(lead(behind)[0]) == pytest.approx(0.05)
    assert float(static_margin(behind)[0]) == pytest.approx(0.05)
    aside = triangle((-0.2, 0.0), **where)  # the slanting sides are nearer
    assert float(static_margin(aside)[0]) == pytest.approx(0.1 * 0.2 / np.hypot(0.4, 0.1))
    ahead = triangle((0.02, 0.0), **where)
    assert float(lead(ahead)[0]) == pytest.approx(-0.02)
    assert float(static_margin(ahead)[0]) == pytest.approx(-0.02)


def test_a_standing_robot_has_its_mass_behind_its_feet_and_a_crawling_one_ahead(rising):
    found = lead(rising)
    assert float(found.isel(time=0, run=0)) < -0.05
    assert float(found.isel(time=-1, run=0)) > 0.03


def test_held_is_the_longest_time_without_a_break():
    height = xr.DataArray([0, 1, 1, 1, 0, 1, 1, 0], dims="time", coords={"time": 0.5 * np.arange(8)})
    assert float(longest_hold(height, 0.5)) == pytest.approx(1.0)
    assert float(longest_hold(height, 2.0)) == 0.0
    both = xr.concat([height, height * 0 + 1], "run")
    assert longest_hold(both, 0.5).values == pytest.approx([1.0, 3.5])


def test_a_taller_head_reaches_higher(rising):
    tall = crocodile(replace(CAIMAN.tables, head=replace(CAIMAN.tables.head, snout=CAIMAN.head.snout + 0.05)))
    gain = reach(tall, rising).isel(run=0, time=-1) - reach(CAIMAN, rising).isel(run=0, time=-1)
    assert 0.045 < float(gain) <= 0.05

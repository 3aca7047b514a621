from dataclasses import replace

import mujoco
import numpy as np
import pytest

from suchus.design import cable_joints, joint_names
from suchus.errors import InvalidDesign, OutsideLimits
from suchus.kinematics import body
from suchus.model import compile_model
from suchus.motion import Bends, Swim, bends, check_swim, swim_targets
from suchus.water import Base, Outline, silhouette

SWIM = Swim(name="wave", frequency=0.8, yaw=(0.5, 0.4, 0.2), yaw_lag=(0.3, 0.1, 0.0), tail=1.1, tail_lag=0.6)
TIME = np.linspace(0.0, 1.25, 41)


def base(time: np.ndarray) -> Base:
    """Return a snout that swings as well."""
    return Base(
        -0.3 * time, 0.05 * np.cos(5 * time), 0.3 * np.sin(4 * time),
        np.full_like(time, -0.3), -0.25 * np.sin(5 * time), 1.2 * np.cos(4 * time),
    )  # fmt: skip


def test_the_midline_keeps_its_length(robot, long_tail):
    for who in (robot, long_tail):
        curve = Outline(who).curve(bends(SWIM, TIME), base(TIME))
        length = np.hypot(np.diff(curve.x, axis=-1), np.diff(curve.y, axis=-1)).sum(axis=-1)
        np.testing.assert_allclose(length, who.length, rtol=0, atol=1e-9)


def test_velocities_are_the_derivatives_of_positions(robot):
    outline, h = Outline(robot), 1e-5
    now = outline.curve(bends(SWIM, TIME), base(TIME))
    before, after = (outline.curve(bends(SWIM, t), base(t)) for t in (TIME - h, TIME + h))
    for name in ("x", "y", "heading"):
        difference = (getattr(after, name) - getattr(before, name)) / (2 * h)
        np.testing.assert_allclose(getattr(now, f"{name}_rate"), difference, atol=1e-7)


def test_straight_joints_make_a_straight_line(robot):
    still = Bends(np.zeros(3), np.zeros(()), np.zeros(3), np.zeros(()))
    curve = Outline(robot).curve(still)
    np.testing.assert_allclose(curve.x, Outline(robot).s, atol=1e-12)
    assert np.all(curve.y == 0.0)
    assert np.all(curve.x_rate == 0.0)
    assert np.all(curve.y_rate == 0.0)


def test_mirrored_angles_make_the_mirrored_curve(robot):
    now = bends(SWIM, TIME)
    curve, mirrored = (Outline(robot).curve(some) for some in (now, Bends(*(-values for values in now))))
    np.testing.assert_allclose(curve.x, mirrored.x, atol=1e-12)
    np.testing.assert_allclose(curve.y, -mirrored.y, atol=1e-12)


def test_ends_stand_where_the_joints_of_the_robot_put_them(robot):
    yaw, tail = np.array([0.3, -0.2, 0.25]), 0.6
    curve = Outline(robot, stations=1025).curve(Bends(yaw, np.array(tail), np.zeros(3), np.zeros(())))
    angles = np.zeros(len(joint_names(robot)))
    angles[[12, 14, 16]] = yaw
    angles[18 : 18 + len(cable_joints(robot))] = tail / len(cable_joints(robot))
    found = body.landmarks(robot, angles)
    apart = np.hypot(curve.x[-1] - curve.x[0], curve.y[-1] - curve.y[0])
    assert apart == pytest.approx(np.linalg.norm(found.snout - found.tail), abs=0.01)  # smeared bends cut corners
    turn = curve.heading[-1] - curve.heading[0]
    assert turn == pytest.approx(tail - yaw.sum(), abs=1e-9)


def test_a_smeared_bend_is_even_where_joints_bend_alike(robot):
    outline = Outline(robot, stations=2049)
    cable = outline.places[3 : 3 + len(cable_joints(robot))]
    inside = (outline.s > cable[1]) & (outline.s < cable[-2])
    curvature = np.gradient(outline.bending_at(outline.s)[:, 3], outline.s)[inside]
    assert curvature.max() == pytest.approx(curvature.min(), rel=1e-3)
    assert curvature.mean() == pytest.approx(1 / (len(cable) * robot.tail.pitch), rel=1e-3)


def test_the_silhouette_is_that_of_the_model(robot, long_tail):
    for who in (robot, long_tail):
        s = np.linspace(0.0, who.length, 211)
        found = silhouette(who, s)
        wide, high = _sliced(who, s)
        np.testing.assert_allclose(found.half_width, wide, atol=1e-9)
        np.testing.assert_allclose(found.half_height, high, atol=1e-9)


def _sliced(robot, s):
    """Return half widths and heights of the model's geoms at zero posture, without legs."""
    model = compile_model(robot)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    snout = data.site("snout").xpos[0]
    wide, high = np.zeros_like(s), np.zeros_like(s)
    for i in range(model.ngeom):
        name, kind, size = model.geom(i).name, model.geom_type[i], model.geom_size[i]
        if name == "ground" or name[:2] in ("LF", "RF", "LH", "RH"):
            continue
        away = s - (snout - data.geom_xpos[i, 0])
        if kind == mujoco.mjtGeom.mjGEOM_ELLIPSOID:
            part = np.sqrt(np.clip(1 - (away / size[0]) ** 2, 0, None))
            w, h = size[1] * part, size[2] * part
        else:
            beyond = np.maximum(np.abs(away) - size[1], 0.0)
            w = h = np.sqrt(np.clip(size[0] ** 2 - beyond**2, 0, None))
        wide, high = np.maximum(wide, w), np.maximum(high, h)
    return wide, high


def test_too_few_stations_are_refused(robot):
    with pytest.raises(InvalidDesign, match="at least 33"):
        Outline(robot, stations=9)


def test_targets_are_the_bends(robot):
    targets = swim_targets(robot, SWIM, TIME)
    np.testing.assert_allclose(targets[:, [12, 14, 16]], bends(SWIM, TIME).yaw)
    assert np.all(targets[:, [13, 15, 17]] == 0.0)


def test_reversed_is_time_reversed():
    forth, back = bends(SWIM.reversed(), TIME), bends(SWIM, -TIME)
    np.testing.assert_allclose(forth.yaw, back.yaw, atol=1e-12)
    np.testing.assert_allclose(forth.tail, back.tail, atol=1e-12)
    np.testing.assert_allclose(forth.tail_rate, -back.tail_rate, atol=1e-12)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"yaw": (0.9, 0.1, 0.1)}, ["spine_yaw_1", "0.115 rad more"]),
        ({"tail": 1.7}, ["tail_cable", "1.571"]),
        ({"frequency": 5.0, "yaw": (0.2, 0.2, 0.2), "tail": 0.5}, ["tail_cable", "7.00 rad/s", "lower the frequency"]),
    ],
)
def test_a_motion_that_the_robot_cannot_follow_is_refused(robot, changes, said):
    with pytest.raises(OutsideLimits) as refused:
        check_swim(robot, replace(SWIM, **changes))
    assert all(word in str(refused.value) for word in said)

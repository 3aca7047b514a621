import mujoco
import numpy as np
import pytest
from tests.swims import crocodile_swim

from suchus.core.errors import InvalidDesign, OutsideLimits
from suchus.robot.design import cable_joints, layout
from suchus.robot.kinematics import landmarks
from suchus.robot.kinematics import tail as tail_kinematics
from suchus.robot.motion import check_limits, cycle_targets, lateral_servos, straight_gait, swimming_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.model import compile_model
from suchus.swimming.water import Outline, silhouette, swim, undulation

TIME = np.linspace(0.0, 1.25, 41)
SWAY, TURN = 0.05 + 0.02j, 0.3 - 0.1j
BODIES = ("caiman", "long_tail", "swimmer", "salamander", "pleurobot", "strider")


def wave(robot, frequency=0.8):
    """Return a gait in which every lateral servo bends, each by its own."""
    servos = lateral_servos(robot)
    lags = [0.9 * i / len(servos) - 0.4 for i in range(len(servos))]
    sizes = [0.3 / (1.0 + i) for i in range(len(servos))]
    return swimming_gait(robot, name="wave", frequency=frequency, amplitude=sizes, lag=lags)


def midline(robot, time, stations=257):
    """Return the midline in that gait, the snout swinging as well."""
    return undulation(Outline(robot, stations), wave(robot)).with_head_motion(SWAY, TURN).curve(time)


@pytest.mark.parametrize("name", BODIES)
def test_the_midline_keeps_its_length(name):
    curve = midline(ROBOTS[name], TIME)
    length = np.hypot(np.diff(curve.x, axis=-1), np.diff(curve.y, axis=-1)).sum(axis=-1)
    np.testing.assert_allclose(length, ROBOTS[name].length, rtol=0, atol=1e-9)


@pytest.mark.parametrize("name", BODIES)
def test_velocities_are_the_derivatives_of_positions(name):
    h = 1e-5
    before, now, after = (midline(ROBOTS[name], TIME + step, 65) for step in (-h, 0.0, h))
    for field in ("x", "y", "heading"):
        difference = (getattr(after, field) - getattr(before, field)) / (2 * h)
        np.testing.assert_allclose(getattr(now, f"{field}_rate"), difference, atol=1e-6)


def test_straight_joints_make_a_straight_line(robot):
    curve = undulation(Outline(robot), straight_gait(robot)).curve(np.zeros(()))
    np.testing.assert_allclose(curve.x, Outline(robot).s, atol=1e-12)
    assert np.all(curve.y == 0.0)
    assert np.all(curve.x_rate == 0.0)
    assert np.all(curve.y_rate == 0.0)


@pytest.mark.parametrize("name", BODIES)
def test_half_a_cycle_later_the_curve_is_the_mirrored_one(name):
    outline, gait = Outline(ROBOTS[name]), wave(ROBOTS[name])
    curve, mirrored = (undulation(outline, some).curve(TIME) for some in (gait, gait.lagged(0.5)))
    np.testing.assert_allclose(curve.x, mirrored.x, atol=1e-12)
    np.testing.assert_allclose(curve.y, -mirrored.y, atol=1e-12)
    assert np.abs(curve.y).max() > 0.02 * ROBOTS[name].length


@pytest.mark.parametrize("name", BODIES)
def test_ends_stand_where_the_joints_of_the_robot_put_them(name):
    robot = ROBOTS[name]
    place, gait = layout(robot), wave(robot)
    curve = undulation(Outline(robot, stations=1025), gait).curve(np.zeros(()))
    angles, targets = np.zeros(len(place.hinges)), cycle_targets(robot, gait, np.zeros(1))[0]
    for servo, hinge in enumerate(place.servo_hinges):
        if hinge >= 0:
            angles[hinge] = targets[servo]
    for servo in place.cables:
        cable = place.cable(servo)
        bend = tail_kinematics.bend_of_servo(cable, targets[servo])
        angles[[place.hinges.index(hinge) for hinge in cable.hinges]] = bend / cable.joints
    marks = landmarks(robot, angles)
    apart = np.hypot(curve.x[-1] - curve.x[0], curve.y[-1] - curve.y[0])
    assert apart == pytest.approx(np.linalg.norm(marks.snout - marks.tail), abs=0.01 * robot.length)  # corners are cut
    outline = Outline(robot)
    signs = np.where(np.arange(len(outline.joints)) < outline.joint_count_ahead, -1.0, 1.0)
    bends = [angles[place.hinges.index(joint)] for joint in outline.joints]
    assert curve.heading[-1] - curve.heading[0] == pytest.approx(float(signs @ bends), abs=1e-9)


def test_a_smeared_bend_is_even_where_joints_bend_alike(robot):
    outline = Outline(robot, stations=2049)
    cable = outline.joint_positions[3 : 3 + len(cable_joints(robot))]
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


@pytest.mark.parametrize("name", BODIES)
def test_every_lateral_servo_bends_by_its_own_cosine(name):
    robot, place = ROBOTS[name], layout(ROBOTS[name])
    gait, servos = wave(robot), lateral_servos(robot)
    targets = cycle_targets(robot, gait, 0.8 * TIME)
    for i, servo in enumerate(servos):
        number = place.servos.index(servo)
        bend = 0.3 / (1.0 + i) * np.cos(2 * np.pi * (0.8 * TIME - 0.9 * i / len(servos) + 0.4))
        if number in place.cables:
            expected = tail_kinematics.servo_angle(place.cable(number), -bend)  # positive is the tip to the right
        else:
            expected = bend if place.servo_hinges[number] in range(*place.forward_hinges.indices(999)) else -bend
        np.testing.assert_allclose(targets[:, number], expected, atol=1e-12)
    others = [i for i, servo in enumerate(place.servos) if servo not in servos]
    assert np.ptp(targets[:, others], axis=0).max(initial=0.0) == 0.0


@pytest.mark.parametrize("name", BODIES)
def test_reversed_is_time_reversed(name):
    robot, gait = ROBOTS[name], wave(ROBOTS[name])
    forth, back = cycle_targets(robot, gait.reversed(), TIME), cycle_targets(robot, gait, -TIME)
    np.testing.assert_allclose(forth, back, atol=1e-12)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"yaw": (0.9, 0.1, 0.1)}, ["spine_yaw_1", "0.900 rad", "0.785 rad is allowed"]),
        ({"tail": 1.7}, ["tail_cable", "1.571"]),
        ({"frequency": 5.0, "yaw": (0.2, 0.2, 0.2), "tail": 0.5}, ["tail_cable", "7.87 rad/s", "make the period"]),
    ],
)
def test_a_motion_that_the_robot_cannot_follow_is_refused(robot, changes, said):
    with pytest.raises(OutsideLimits) as refused:
        swim(robot, crocodile_swim(**changes))
    assert all(word in str(refused.value) for word in said)
    swim(robot, crocodile_swim(), stations=33)


def test_a_joint_may_bend_to_its_limit_and_no_farther_whatever_its_phase(robot):
    """Instants at which limits are looked at may miss the peak of a wave."""
    most = robot.spine.yaw_range[1]
    for lag in (0.0, 0.0123, 0.3039):
        check_limits(robot, crocodile_swim(yaw=(most, 0.0, 0.0), yaw_lag=(lag, 0.0, 0.0)))
        with pytest.raises(OutsideLimits, match="spine_yaw_1"):
            check_limits(robot, crocodile_swim(yaw=(most + 1e-6, 0.0, 0.0), yaw_lag=(lag, 0.0, 0.0)))


def test_numbers_for_other_servos_are_refused():
    with pytest.raises(InvalidDesign, match=r"swim.amplitude has 4 numbers; robot 'strider' has \d+ lateral servos"):
        swimming_gait(ROBOTS["strider"], name="w", frequency=1.0, amplitude=(0.1,) * 4, lag=(0.0,) * 4)
    with pytest.raises(InvalidDesign, match=r"swim.lag of spine_yaw_2 is 2 cycle"):
        crocodile_swim(yaw_lag=(0.0, 2.0, 0.0))

"""What holds for every robot on the shelf."""

from dataclasses import fields, is_dataclass

import mujoco
import numpy as np
import pytest

from suchus.core.physics import WATER_DENSITY
from suchus.robot.design import GRAVITY, joint_names, layout, leg_joints, servo_names, spine_joints
from suchus.robot.design.pieces import masses, volumes
from suchus.robot.design.scale import gravity_time, physics_step
from suchus.robot.gaits import default_gait, suits
from suchus.robot.robots import ROBOTS
from suchus.sim.model import build, compile_model, force_sensors, joint_addresses, sensor_names

FROM_THE_ARTICLE = {
    "hind_leg.hip_offset",
    "hind_leg.femur",
    "hind_leg.tibia",
    "spine.base",
    "spine.link",
}
COUNTS = {"tail.fin_segments", "tail.joints", "spine.joints"}  # whole numbers, part of the topology
SIZED = {"contact.torsion", "contact.rolling", "contact.depth"}  # MuJoCo's own numbers


def numbers(value, path=""):
    """Yield the dotted path and value of every number of a design."""
    if is_dataclass(value):
        for field in (field for field in fields(value) if field.init):
            yield from numbers(getattr(value, field.name), f"{path}.{field.name}".lstrip("."))
    elif isinstance(value, tuple):
        for i, part in enumerate(value):
            yield from numbers(part, f"{path}[{i}]")
    elif isinstance(value, (int, float)):
        yield path, value


@pytest.fixture(params=list(ROBOTS))
def shelved(request):
    return ROBOTS[request.param]


def test_it_is_called_by_its_file_name(shelved):
    assert ROBOTS[shelved.name] is shelved


def test_every_number_not_from_the_article_has_a_range_and_a_reason(shelved):
    if ROBOTS.sources()[shelved.name].module == "":
        pytest.skip("a file of data has no reasons")
    chosen = {entry.field: entry for entry in ROBOTS.beside(shelved.name, "chosen", ())}
    values = dict(numbers(shelved.tables or shelved))
    if shelved.tables is not None:
        article = dict(numbers(ROBOTS["caiman"].tables))
        same = {path for path in FROM_THE_ARTICLE if values[path] == article[path]}
        sold = {path for path in values if ".winding." in path}  # each has its source in the shelf of motors
        assert set(chosen) == set(values) - same - COUNTS - SIZED - sold
    else:
        assert set(chosen) < set(values)
    for path, entry in chosen.items():
        assert entry.low <= values[path] <= entry.high, path
        assert len(entry.why) > 10


def test_a_gait_of_the_shelf_is_its_own(shelved):
    assert suits(shelved, default_gait(shelved))


def test_mass_and_dimensions_arrive_in_the_model(shelved):
    model = compile_model(shelved)
    assert shelved.mass == pytest.approx(model.body_mass.sum(), rel=1e-12)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    nose, tip = data.site("snout").xpos, data.site("tail_tip").xpos
    assert shelved.length == pytest.approx(np.linalg.norm(nose - tip), rel=1e-9)


def test_it_has_its_servos_with_their_limits(shelved):
    model = compile_model(shelved)
    if shelved.tables is not None:
        assert servo_names(shelved) == servo_names()
        assert model.nu == 19
    assert model.nu == len(servo_names(shelved))
    for i, name in enumerate(servo_names(shelved)):
        assert model.actuator(i).name == name
        limit = shelved.servo(name).torque
        assert tuple(model.actuator(i).forcerange) == (-limit, limit)
        if shelved.servo(name).winding is None:  # else its voltage, see tests/model/test_windings.py
            assert model.actuator(i).biasprm[1] == -shelved.servo(name).kp


def test_sensors_stand_in_the_order_that_readers_rely_on(shelved):
    model = compile_model(shelved)
    assert tuple(model.sensor(i).name for i in range(model.nsensor)) == sensor_names(shelved)


def test_the_jacobian_is_sparse_and_the_robot_takes_friction_precedence(shelved):
    model = compile_model(shelved)
    assert model.opt.jacobian == mujoco.mjtJacobian.mjJAC_SPARSE
    assert set(model.geom_priority[1:]) == {1}
    for limb in layout(shelved).limb_names:
        assert model.geom(f"{limb}_foot").friction[0] == shelved.contact.foot_friction
    assert model.geom(shelved.axis[0].shapes[0].name).friction[0] == shelved.contact.skin_friction


def test_standing_forces_sum_to_its_weight(shelved):
    model = compile_model(shelved, physics_step(shelved))
    data = mujoco.MjData(model)
    data.qpos[2] = 0.1 * shelved.length
    for _ in range(round(13 * gravity_time(shelved.length) / model.opt.timestep)):
        mujoco.mj_step(model, data)
    feet = {f"{limb}_force" for limb in layout(shelved).limb_names}  # their limbs count them
    force = -sum(data.sensor(name).data for name in force_sensors(shelved) if name not in feet)
    assert force[2] == pytest.approx(shelved.mass * GRAVITY, rel=1e-3)
    assert np.abs(force[:2]).max() < 0.02 * shelved.mass * GRAVITY


def test_shaking_raises_no_warning(shelved):
    model = compile_model(shelved, physics_step(shelved))
    data = mujoco.MjData(model)
    data.qpos[2] = 0.15 * shelved.length
    rng = np.random.default_rng(0)
    for _ in range(100):
        data.ctrl[:] = rng.uniform(-1.5, 1.5, model.nu)
        for _ in range(5):
            mujoco.mj_step(model, data)
    assert not any(int(warning.number) for warning in data.warning)
    assert np.isfinite(data.qpos).all()


def test_the_model_survives_a_round_trip_through_mjcf(shelved):
    spec = build(shelved)
    spec.compile()
    again = mujoco.MjSpec.from_string(spec.to_xml()).compile()
    assert compile_model(shelved).nv == again.nv
    assert compile_model(shelved).body_mass == pytest.approx(again.body_mass, rel=1e-5)


@pytest.mark.parametrize(
    ("joint", "site", "axis"),
    [
        ("LF_yaw", "LF_foot", 0),  # forward
        ("RF_yaw", "RF_foot", 0),
        ("LH_yaw", "LH_foot", 0),
        ("RH_yaw", "RH_foot", 0),
        ("LF_pitch", "LF_foot", -2),  # down
        ("RH_pitch", "RH_foot", -2),
        ("RF_knee", "RF_foot", -2),
        ("spine_yaw_1", "snout", 1),  # left
        ("spine_pitch_1", "snout", -2),  # down
        ("tail_pitch", "tail_tip", -2),  # down
        ("tail_yaw_1", "tail_tip", -1),  # right
        ("fin_yaw_1", "tail_tip", -1),
        ("fin_pitch_1", "tail_tip", -2),
    ],
)
def test_a_positive_angle_moves_as_the_conventions_say(robot, joint, site, axis):
    model = compile_model(robot)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    before = data.site(site).xpos.copy()
    data.joint(joint).qpos = 0.1
    mujoco.mj_kinematics(model, data)
    moved = data.site(site).xpos - before
    assert (moved[abs(axis)] if axis >= 0 else -moved[abs(axis)]) > 0.002


def test_joint_addresses_follow_names_not_order(robot):
    model = compile_model(robot)
    names = joint_names(robot)
    data = mujoco.MjData(model)
    data.qpos[joint_addresses(model, names)] = np.arange(len(names))
    assert [float(data.joint(name).qpos[0]) for name in names] == list(range(len(names)))
    assert len(leg_joints()) == 12
    assert len(spine_joints()) == 5


def test_the_swimmer_floats_with_a_twentieth_of_its_volume_above_the_water():
    robot = ROBOTS["swimmer"]
    assert sum(masses(robot).values()) == pytest.approx(0.95 * WATER_DENSITY * sum(volumes(robot).values()), rel=1e-12)

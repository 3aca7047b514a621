"""What is written for other tools is the same robot."""

import warnings
from dataclasses import replace
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest

from suchus import blueprint
from suchus.design import Crocodile, joint_names
from suchus.errors import InvalidDesign, Unwritable
from suchus.model import SITES, compile_model, joint_addresses
from suchus.model.export import MARK, ball, export, unsaid
from suchus.model.export.urdf import _roll_pitch_yaw
from suchus.robots import ROBOTS

NOT_PHYSICS = ("key", "name", "tex", "mat", "skin", "vis", "nnames", "nbuffer", "nkey", "ntex", "signature")


@pytest.fixture(params=["caiman", "odd"])
def any_robot(request, robot, long_tail):
    """The article's, and one whose every number has many digits and whose servos have integral action."""
    if request.param == "caiman":
        return robot
    odd = replace(robot.spine.yaw_servo, ki=1 / 3, kp=100 / 3, speed=22 / 3)
    leg = replace(robot.hind_leg, femur=0.086 + 1e-9 / 3, servo=odd)
    return replace(long_tail, name="odd one", hind_leg=leg)


def poses(model, robot, count=5):
    """Return random postures within the limits, the free body anywhere."""
    random = np.random.default_rng(8)
    names = joint_names(robot)
    low, high = np.array([model.joint(n).range for n in names]).T
    for _ in range(count):
        angles = random.uniform(low, high)
        data = mujoco.MjData(model)
        data.qpos[:3] = random.normal(size=3)
        quat = random.normal(size=4)
        data.qpos[3:7] = quat / np.linalg.norm(quat)
        data.qpos[joint_addresses(model, names)] = angles
        mujoco.mj_kinematics(model, data)
        turn = data.xmat[1].reshape(3, 3)
        sites = {s: turn.T @ (data.site(s).xpos - data.xpos[1]) for s in (*SITES, "imu")}
        yield dict(zip(names, angles, strict=True)), sites


def test_the_mjcf_scene_compiles_to_the_same_bits(any_robot, crawl_gait, tmp_path):
    folder = export(any_robot, crawl_gait, tmp_path / "m", "mjcf", timestep=0.01 / 3)
    model = mujoco.MjModel.from_xml_path(str(folder / "scene.xml"))
    ours = compile_model(any_robot, 0.01 / 3)
    for name in dir(ours):
        value = getattr(ours, name)
        if name.startswith(("_", *NOT_PHYSICS)) or not isinstance(value, (int, float, np.ndarray)):
            continue
        there = getattr(model, name)
        if name == "site_size":  # a ball has one radius; the compiler fills in the rest
            value, there = value[:, 0], there[:, 0]
        np.testing.assert_array_equal(there, value, err_msg=name)
    for name in dir(ours.opt):
        if not name.startswith("_"):
            np.testing.assert_array_equal(getattr(model.opt, name), getattr(ours.opt, name), err_msg=name)


def test_the_robot_stands_in_its_home_posture(any_robot, crawl_gait, tmp_path):
    folder = export(any_robot, crawl_gait, tmp_path / "m", "mjcf")
    model = mujoco.MjModel.from_xml_path(str(folder / "scene.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    mujoco.mj_forward(model, data)
    assert abs(min((c.dist for c in data.contact), default=0.0)) < 1e-12
    start = data.qpos.copy()
    for _ in range(500):
        mujoco.mj_step(model, data)
    assert abs(data.qpos[:2] - start[:2]).max() < 0.002
    assert start[2] - 0.04 < data.qpos[2] < start[2] + 1e-3  # servos sag, and the tail that props the long one up bends
    assert abs(data.qvel).max() < 0.05


def test_the_robot_alone_is_a_model_without_a_ground(robot, crawl_gait, tmp_path):
    folder = export(robot, crawl_gait, tmp_path / "m", "mjcf")
    model = mujoco.MjModel.from_xml_path(str(folder / "caiman.xml"))
    assert model.nv == compile_model(robot).nv
    assert model.ngeom == compile_model(robot).ngeom - 1


def chain(root):
    """Return the joints of a URDF by child link."""
    return {j.find("child").get("link"): j for j in root.iter("joint")}


def placed(root, angles, link):
    """Return the place of a link in the root link by the definition of URDF, with nobody's library."""
    joints = chain(root)
    place = np.eye(4)
    while link in joints:
        joint = joints[link]
        origin = joint.find("origin")
        r, p, y = map(float, origin.get("rpy").split())
        step = np.eye(4)
        step[:3, :3] = about((0, 0, 1), y) @ about((0, 1, 0), p) @ about((1, 0, 0), r)
        step[:3, 3] = [float(v) for v in origin.get("xyz").split()]
        if joint.get("type") == "revolute":
            axis = [float(v) for v in joint.find("axis").get("xyz").split()]
            turn = np.eye(4)
            turn[:3, :3] = about(axis, angles[joint.get("name")])
            step = step @ turn
        place = step @ place
        link = joint.find("parent").get("link")
    return place


def about(axis, angle):
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def test_the_urdf_has_the_same_points_masses_and_limits(any_robot, crawl_gait, tmp_path):
    folder = export(any_robot, crawl_gait, tmp_path / "u", "urdf")
    root = ElementTree.parse(folder / f"{any_robot.name}.urdf").getroot()
    model = compile_model(any_robot)
    for angles, sites in poses(model, any_robot):
        for site, place in sites.items():
            np.testing.assert_allclose(placed(root, angles, site)[:3, 3], place, atol=1e-12, err_msg=site)
    masses = [float(m.get("value")) for m in root.iter("mass")]
    assert sum(masses) == pytest.approx(any_robot.mass, abs=1e-12)
    turning = {j.get("name"): j for j in root.iter("joint") if j.get("type") == "revolute"}
    assert set(turning) == set(joint_names(any_robot))
    for name, joint in turning.items():
        limit = joint.find("limit")
        assert [float(limit.get("lower")), float(limit.get("upper"))] == model.joint(name).range.tolist()
    assert float(turning["LH_yaw"].find("limit").get("effort")) == any_robot.hind_leg.servo.torque
    assert float(turning["fin_yaw_1"].find("limit").get("effort")) == 0.0


def test_every_shape_of_the_urdf_lies_where_it_is_in_the_model(robot, crawl_gait, tmp_path):
    folder = export(robot, crawl_gait, tmp_path / "u", "urdf")
    root = ElementTree.parse(folder / "caiman.urdf").getroot()
    for link in root.iter("link"):
        rods = [c for c in link.iter("collision") if c.find("geometry/cylinder") is not None]
        for rod in rods:
            origin = rod.find("origin")
            r, p, y = map(float, origin.get("rpy").split())
            along = about((0, 0, 1), y) @ about((0, 1, 0), p) @ about((1, 0, 0), r) @ [0, 0, 1]
            half = float(rod.find("geometry/cylinder").get("length")) / 2
            middle = np.array([float(v) for v in origin.get("xyz").split()])
            balls = [
                np.array([float(v) for v in c.find("origin").get("xyz").split()])
                for c in link.iter("collision")
                if c.find("geometry/sphere") is not None
            ]
            for end in (middle + half * along, middle - half * along):
                assert min(np.linalg.norm(end - b) for b in balls) < 1e-12


def test_roll_pitch_yaw_give_the_rotation_back_also_where_roll_and_yaw_fall_together():
    half = np.sqrt(0.5)
    random = np.random.default_rng(3).normal(size=(20, 4))
    for quat in [(half, 0, half, 0), (half, 0, -half, 0), (0.5, 0.5, 0.5, -0.5), (1, 0, 0, 0), *random]:
        turn = np.empty(9)
        mujoco.mju_quat2Mat(turn, np.array(quat, dtype=float) / np.linalg.norm(quat))
        roll, pitch, yaw = _roll_pitch_yaw(np.array(quat, dtype=float))
        ours = about((0, 0, 1), yaw) @ about((0, 1, 0), pitch) @ about((1, 0, 0), roll)
        np.testing.assert_allclose(ours, turn.reshape(3, 3), atol=1e-12)


def test_every_link_of_the_urdf_has_the_inertia_of_its_body(any_robot, crawl_gait, tmp_path):
    folder = export(any_robot, crawl_gait, tmp_path / "u", "urdf")
    model = compile_model(any_robot)
    links = {
        link.get("name"): link.find("inertial")
        for link in ElementTree.parse(folder / f"{any_robot.name}.urdf").iter("link")
    }
    for body in range(1, model.nbody):
        inertial = links[model.body(body).name]
        assert float(inertial.find("mass").get("value")) == model.body_mass[body]
        place = [float(v) for v in inertial.find("origin").get("xyz").split()]
        np.testing.assert_array_equal(place, model.body_ipos[body])
        r, p, y = map(float, inertial.find("origin").get("rpy").split())
        turn = about((0, 0, 1), y) @ about((0, 1, 0), p) @ about((1, 0, 0), r)
        moments = np.diag([float(inertial.find("inertia").get(k)) for k in ("ixx", "iyy", "izz")])
        theirs = np.empty(9)
        mujoco.mju_quat2Mat(theirs, model.body_iquat[body])
        theirs = theirs.reshape(3, 3)
        expected = theirs @ np.diag(model.body_inertia[body]) @ theirs.T
        np.testing.assert_allclose(turn @ moments @ turn.T, expected, atol=1e-15)


def test_the_ball_is_closed_round_and_faces_outward():
    corners = np.array([[float(v) for v in line.split()[1:]] for line in ball().splitlines() if line.startswith("v ")])
    faces = np.array([[int(v) for v in line.split()[1:]] for line in ball().splitlines() if line.startswith("f ")]) - 1
    np.testing.assert_allclose(np.linalg.norm(corners, axis=1), 1.0, atol=1e-8)
    edges = [(a, b) for face in faces for a, b in zip(face, np.roll(face, -1), strict=True)]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)
    a, b, c = corners[faces].transpose(1, 0, 2)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert volume == pytest.approx(4 * np.pi / 3, rel=0.01)


@pytest.mark.parametrize("kind", ["mjcf", "urdf"])
def test_a_folder_says_whose_it_is_and_what_is_missing(kind, robot, crawl_gait, tmp_path):
    folder = export(robot, crawl_gait, tmp_path / "it", kind)
    assert blueprint.read(folder / "robot.toml", Crocodile, ROBOTS) == robot
    readme = (folder / "README.md").read_text()
    for file in folder.rglob("*"):
        if file.is_file() and file.name != "README.md":
            assert f"`{file.relative_to(folder)}`" in readme
    if kind == "urdf":
        assert all(text in readme for text in unsaid(robot))
    for word in {"mjcf": ["gait", "pulley"], "urdf": ["tendon", "Springs", "PID", "friction", "armature"]}[kind]:
        assert word in readme.partition("does not say")[2]
    assert (folder / "LICENSE").is_file()


def test_the_same_export_gives_the_same_bytes_and_replaces_only_its_own(robot, crawl_gait, tmp_path):
    one, two = (export(robot, crawl_gait, tmp_path / name, "urdf") for name in ("one", "two"))
    for file in one.rglob("*.*"):
        assert file.read_bytes() == (two / file.relative_to(one)).read_bytes()
    (one / "stale").write_text("x")
    export(robot, crawl_gait, one, "urdf")
    assert not (one / "stale").exists()
    (two / MARK).unlink()
    with pytest.raises(Unwritable, match="was not written by suchus"):
        export(robot, crawl_gait, two, "urdf")
    with pytest.raises(InvalidDesign, match="makes no file name"):
        export(replace(robot, name="../up"), crawl_gait, tmp_path / "x", "mjcf")


def test_pinocchio_agrees_on_the_feet(robot, crawl_gait, tmp_path):
    pin = pytest.importorskip("pinocchio", reason="pinocchio is not installed: pip install suchus[export]")
    folder = export(robot, crawl_gait, tmp_path / "u", "urdf")
    theirs = pin.buildModelFromUrdf(str(folder / "caiman.urdf"))
    data = theirs.createData()
    assert pin.computeTotalMass(theirs) + theirs.inertias[0].mass == pytest.approx(robot.mass, abs=1e-9)
    for angles, sites in poses(compile_model(robot), robot):
        q = np.zeros(theirs.nq)
        for name, angle in angles.items():
            q[theirs.joints[theirs.getJointId(name)].idx_q] = angle
        pin.framesForwardKinematics(theirs, data, q)
        for site, place in sites.items():
            np.testing.assert_allclose(data.oMf[theirs.getFrameId(site)].translation, place, atol=1e-9)


def test_yourdfpy_agrees_on_the_feet_and_finds_the_meshes(robot, crawl_gait, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yourdfpy = pytest.importorskip("yourdfpy", reason="yourdfpy is not installed: pip install suchus[export]")
        folder = export(robot, crawl_gait, tmp_path / "u", "urdf")
        theirs = yourdfpy.URDF.load(str(folder / "caiman.urdf"), mesh_dir=str(folder))
    assert theirs.validate()
    pelvis = next(theirs.scene.geometry[name] for name in theirs.scene.graph.nodes_geometry if "geometry_0" in name)
    np.testing.assert_allclose(
        pelvis.extents, [robot.pelvis.length, robot.pelvis.width, robot.pelvis.height], rtol=1e-6
    )
    for angles, sites in poses(compile_model(robot), robot):
        theirs.update_cfg(angles)
        for site, place in sites.items():
            np.testing.assert_allclose(theirs.get_transform(site, "pelvis")[:3, 3], place, atol=1e-9)

"""What is written for other tools is the same robot."""

import sys
import warnings
from dataclasses import replace
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest

from suchus.core.errors import InvalidDesign, OutsideLimits, UnknownName, Unwritable
from suchus.core.writing import MANIFEST
from suchus.robot import blueprint
from suchus.robot.design import GRAVITY, Robot, crocodile, joint_names
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import check_limits
from suchus.robot.robots import ROBOTS
from suchus.sim.model import compile_model, joint_addresses
from suchus.sim.model import sites as sensed
from suchus.sim.model.export import NoUsd, ball, export, unsaid, unsaid_in_usd
from suchus.sim.model.export.urdf import _roll_pitch_yaw
from suchus.sim.model.export.usd import prim_name

NOT_PHYSICS = ("key", "name", "tex", "mat", "skin", "vis", "nnames", "nbuffer", "nkey", "ntex", "signature")


@pytest.fixture(params=["caiman", "odd"])
def any_robot(request, robot, long_tail):
    """The article's, and one whose every number has many digits and whose servos have integral action."""
    if request.param == "caiman":
        return robot
    odd = replace(robot.spine.yaw_servo, ki=1 / 3, kp=100 / 3, speed=22 / 3)
    leg = replace(robot.tables.hind_leg, femur=0.086 + 1e-9 / 3, servo=odd)
    return crocodile(replace(long_tail.tables, name="odd one", hind_leg=leg))


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
        sites = {s: turn.T @ (data.site(s).xpos - data.xpos[1]) for s in (*sensed(robot), "imu")}
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


@pytest.mark.parametrize("kind", ["mjcf", "urdf", "usd"])
def test_a_folder_says_whose_it_is_and_what_is_missing(kind, robot, crawl_gait, tmp_path):
    if kind == "usd":
        pytest.importorskip("pxr")
    folder = export(robot, crawl_gait, tmp_path / "it", kind)
    assert blueprint.read_design(folder / "robot.toml", Robot, ROBOTS) == robot
    readme = (folder / "README.md").read_text()
    assert "A crocodile-like robot of 3.52 kg and 1.01 m" in readme
    for file in folder.rglob("*"):
        if file.is_file() and file.name not in ("README.md", MANIFEST):
            assert f"`{file.relative_to(folder)}`" in readme
    if kind != "mjcf":
        left_out = {"urdf": unsaid, "usd": unsaid_in_usd}[kind]
        assert all(text in readme for text in left_out(robot))
        stiffer = crocodile(replace(robot.tables, tail=replace(robot.tables.tail, joint_stiffness=0.123)))
        assert "0.123 N m/rad" in "".join(left_out(stiffer))
    words = {
        "mjcf": ["gait", "pulley"],
        "urdf": ["tendon", "Springs", "PID", "friction", "armature"],
        "usd": ["tendon", "Springs", "integral", "friction", "armature"],
    }
    for word in words[kind]:
        assert word in readme.partition("does not say")[2]
    assert (folder / "LICENSE").is_file()


def test_a_body_that_no_tables_make_is_called_a_robot(tmp_path):
    strider = ROBOTS["strider"]
    folder = export(strider, default_gait(strider), tmp_path / "it", "mjcf")
    assert "A robot of 3.00 kg and 0.60 m" in (folder / "README.md").read_text()


def test_the_same_export_gives_the_same_bytes_and_replaces_only_its_own(robot, crawl_gait, tmp_path):
    one, two = (export(robot, crawl_gait, tmp_path / name, "urdf") for name in ("one", "two"))
    for file in one.rglob("*.*"):
        assert file.read_bytes() == (two / file.relative_to(one)).read_bytes()
    (one / "notes").write_text("x")
    export(robot, crawl_gait, one, "urdf")
    assert (one / "notes").read_text() == "x"
    (two / MANIFEST).unlink()
    with pytest.raises(Unwritable, match="nothing says that suchus wrote it"):
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


def usd_stage(folder, name):
    pxr = pytest.importorskip("pxr", reason="usd-core is not installed: pip install suchus[usd]")
    from pxr import Usd, UsdGeom, UsdPhysics, UsdShade  # noqa: F401, PLC0415  they load on import

    return pxr, pxr.Usd.Stage.Open(str(folder / name))


def usd_places(pxr, stage, root, angles):
    """Return the place of every body at some joint angles, from the stage's transforms and the joints' frames."""
    cache = pxr.UsdGeom.XformCache()

    def at(path):  # USD's rows are our columns
        return np.array(cache.GetLocalToWorldTransform(stage.GetPrimAtPath(path))).T

    def frame(quat):
        turn = np.empty(9)
        mujoco.mju_quat2Mat(turn, np.array([quat.GetReal(), *quat.GetImaginary()], dtype=float))
        return turn.reshape(3, 3)

    places = {f"{root}/pelvis": np.eye(4)}
    joints = [pxr.UsdPhysics.RevoluteJoint(p) for p in stage.GetPrimAtPath(f"{root}/joints").GetChildren()]
    for joint in joints:
        (parent,), (child,) = (str(p) for p in joint.GetBody0Rel().GetTargets()), joint.GetBody1Rel().GetTargets()
        step = np.linalg.inv(at(parent)) @ at(child)
        axis = np.eye(3)["XYZ".index(joint.GetAxisAttr().Get())]
        before, after = (frame(a.Get()) for a in (joint.GetLocalRot0Attr(), joint.GetLocalRot1Attr()))
        step[:3, :3] = before @ about(axis, angles[joint.GetPrim().GetName()]) @ after.T
        assert tuple(joint.GetLocalPos1Attr().Get()) == (0, 0, 0)
        np.testing.assert_allclose(joint.GetLocalPos0Attr().Get(), step[:3, 3], atol=1e-8)
        places[str(child)] = places[parent] @ step
    return {path: (place, np.linalg.inv(at(path))) for path, place in places.items()}, at


def test_the_usd_has_the_same_points_in_every_posture(any_robot, crawl_gait, tmp_path):
    folder = export(any_robot, crawl_gait, tmp_path / "u", "usd")
    pxr, stage = usd_stage(folder, f"{any_robot.name}.usda")
    root = str(stage.GetDefaultPrim().GetPath())
    bodies = {
        site: next(
            str(body.GetPath())
            for body in stage.GetDefaultPrim().GetChildren()
            if stage.GetPrimAtPath(body.GetPath().AppendChild(site))
        )
        for site in (*sensed(any_robot), "imu")
    }
    for angles, sites in poses(compile_model(any_robot), any_robot):
        places, at = usd_places(pxr, stage, root, angles)
        for site, place in sites.items():
            body, back = places[bodies[site]]
            found = body @ back @ at(f"{bodies[site]}/{site}")
            np.testing.assert_allclose(found[:3, 3], place, atol=1e-12, err_msg=site)


def test_the_usd_has_the_masses_limits_drives_and_shapes_of_the_model(any_robot, crawl_gait, tmp_path):
    folder = export(any_robot, crawl_gait, tmp_path / "u", "usd")
    pxr, stage = usd_stage(folder, f"{any_robot.name}.usda")
    model, root = compile_model(any_robot), stage.GetDefaultPrim()
    masses = {p.GetName(): pxr.UsdPhysics.MassAPI(p) for p in root.GetChildren() if p.HasAPI(pxr.UsdPhysics.MassAPI)}
    for body in range(1, model.nbody):
        held = masses.pop(model.body(body).name)
        assert held.GetMassAttr().Get() == np.float32(model.body_mass[body])
        np.testing.assert_array_equal(held.GetDiagonalInertiaAttr().Get(), model.body_inertia[body].astype(np.float32))
        np.testing.assert_array_equal(held.GetCenterOfMassAttr().Get(), model.body_ipos[body].astype(np.float32))
        quat = held.GetPrincipalAxesAttr().Get()
        np.testing.assert_array_equal([quat.GetReal(), *quat.GetImaginary()], model.body_iquat[body].astype(np.float32))
    assert all(name.endswith("_link") and mass.GetMassAttr().Get() < 2e-6 for name, mass in masses.items())
    joints = {p.GetName(): p for p in stage.GetPrimAtPath(f"{root.GetPath()}/joints").GetChildren()}
    assert set(joints) == set(joint_names(any_robot))
    for name, prim in joints.items():
        joint, drive = pxr.UsdPhysics.RevoluteJoint(prim), pxr.UsdPhysics.DriveAPI(prim, "angular")
        limits = np.radians([joint.GetLowerLimitAttr().Get(), joint.GetUpperLimitAttr().Get()])
        np.testing.assert_allclose(limits, model.joint(name).range, rtol=1e-6)
        stiffness = np.degrees(drive.GetStiffnessAttr().Get())
        spring = float(np.ravel(model.joint(name).stiffness)[0])
        assert stiffness == pytest.approx(spring or any_robot.servo(name).kp, rel=1e-6)
    assert pxr.UsdPhysics.DriveAPI(joints["LH_yaw"], "angular").GetMaxForceAttr().Get() == np.float32(
        any_robot.hind_leg.servo.torque
    )
    solid = [p for p in stage.Traverse() if p.HasAPI(pxr.UsdPhysics.CollisionAPI)]
    assert len(solid) == model.ngeom - 1
    for prim in solid:
        material, _ = pxr.UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial("physics")
        rough = pxr.UsdPhysics.MaterialAPI(material.GetPrim()).GetDynamicFrictionAttr().Get()
        geom = prim.GetName().removesuffix("_shape").removesuffix("_hull")
        assert rough == np.float32(model.geom(geom).friction[0])


def test_the_usd_scene_opens_in_metres_with_the_robot_on_its_ground(any_robot, crawl_gait, tmp_path):
    folder = export(any_robot, crawl_gait, tmp_path / "u", "usd")
    pxr, stage = usd_stage(folder, "scene.usda")
    assert pxr.UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    assert pxr.UsdGeom.GetStageUpAxis(stage) == "Z"
    physics = stage.GetPrimAtPath("/World/physics")
    assert physics.GetTypeName() == "PhysicsScene"
    assert physics.GetAttribute("physics:gravityMagnitude").Get() == pytest.approx(GRAVITY)
    robots = [p for p in stage.Traverse() if p.HasAPI(pxr.UsdPhysics.ArticulationRootAPI)]
    assert len(robots) == 1
    box = pxr.UsdGeom.BBoxCache(pxr.Usd.TimeCode.Default(), ["default"])
    reach = box.ComputeWorldBound(robots[0]).ComputeAlignedRange()
    assert reach.GetMin()[2] == pytest.approx(0.0, abs=1e-3)
    assert reach.GetMax()[0] - reach.GetMin()[0] == pytest.approx(any_robot.length, rel=0.02)


def test_usd_without_its_library_says_what_to_install(robot, crawl_gait, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pxr", None)
    with pytest.raises(NoUsd, match=r"pip install 'suchus\[usd\]'"):
        export(robot, crawl_gait, tmp_path / "u", "usd")
    assert list(tmp_path.iterdir()) == []


def test_a_robot_s_name_becomes_one_that_usd_allows(robot):
    assert prim_name(replace(robot, name="odd one")) == "odd_one"
    assert prim_name(replace(robot, name="2nd")) == "_2nd"


def test_an_unknown_format_is_told_with_those_near_it(robot, crawl_gait, tmp_path):
    with pytest.raises(UnknownName, match="Did you mean 'urdf'"):
        export(robot, crawl_gait, tmp_path / "x", "udrf")


@pytest.mark.parametrize("file", ["caiman.usda", "scene.usda"])
def test_usd_s_own_validators_find_nothing_wrong(file, robot, crawl_gait, tmp_path):
    pytest.importorskip("pxr", reason="usd-core is not installed: pip install suchus[usd]")
    validation = pytest.importorskip("pxr.UsdValidation")
    folder = export(robot, crawl_gait, tmp_path / "u", "usd")
    _, stage = usd_stage(folder, file)
    validators = validation.ValidationRegistry().GetOrLoadAllValidators()
    assert any("Physics" in v.GetMetadata().name for v in validators)
    errors = validation.ValidationContext(validators).Validate(stage)
    assert [f"{e.GetName()}: {e.GetMessage()}" for e in errors] == []


OWN = {"salamandra": "salamandra_walk", "strider": "tripod", "swimmer": "undulation"}
"""Bodies with welded links and cranks, without a tail, and without limbs."""


@pytest.mark.parametrize("name", OWN)
def test_any_body_is_exported_with_its_frames(name, tmp_path):
    own, gait = ROBOTS[name], GAITS[OWN[name]]
    folder = export(own, gait, tmp_path / "m", "mjcf")
    ours, theirs = compile_model(own), mujoco.MjModel.from_xml_path(str(folder / "scene.xml"))
    np.testing.assert_array_equal(ours.body_mass, theirs.body_mass)
    np.testing.assert_array_equal(ours.jnt_range, theirs.jnt_range)
    assert theirs.key_qpos.shape == (1, ours.nq)
    root = ElementTree.parse(export(own, gait, tmp_path / "u", "urdf") / f"{name}.urdf").getroot()
    for angles, found in poses(ours, own):
        for site, place in found.items():
            np.testing.assert_allclose(placed(root, angles, site)[:3, 3], place, atol=1e-9, err_msg=site)
    kinds = {joint.get("name"): joint.get("type") for joint in root.iter("joint")}
    assert all((kind == "continuous") == label.endswith("_crank") for label, kind in kinds.items())
    told = "".join(unsaid(own))
    assert "The cable." not in told
    assert "Springs" not in told


@pytest.mark.parametrize("name", OWN)
def test_any_body_is_written_as_usd(name, tmp_path):
    pytest.importorskip("pxr")
    own = ROBOTS[name]
    folder = export(own, GAITS[OWN[name]], tmp_path / "u", "usd")
    pxr, stage = usd_stage(folder, f"{name}.usda")
    root = str(stage.GetDefaultPrim().GetPath())
    names = {prim.GetName() for prim in stage.GetPrimAtPath(f"{root}/joints").GetChildren()}
    assert set(joint_names(own)) <= names
    mass = sum(
        pxr.UsdPhysics.MassAPI(prim).GetMassAttr().Get() or 0.0
        for prim in stage.GetDefaultPrim().GetChildren()
        if prim.HasAPI(pxr.UsdPhysics.MassAPI)
    )
    assert mass == pytest.approx(own.mass, rel=1e-4)


@pytest.mark.parametrize("name", list(ROBOTS))
def test_the_urdf_loads_in_mujoco_with_every_body_and_joint_where_it_is(name, tmp_path):
    robot = ROBOTS[name]
    gait = next(gait for gait in GAITS.values() if fits(robot, gait))
    folder = export(robot, gait, tmp_path / name, "urdf")
    ours, theirs = compile_model(robot), mujoco.MjModel.from_xml_path(str(folder / f"{name}.urdf"))
    assert theirs.body(ours.body(1).name).parentid[0] == 0
    assert theirs.njnt == ours.njnt - 1
    assert theirs.body_mass.sum() == pytest.approx(ours.body_mass.sum(), rel=1e-6)
    bodies = [ours.body(i).name for i in range(1, ours.nbody)]
    hinges = [ours.joint(i).name for i in range(1, ours.njnt)]
    one, two = mujoco.MjData(ours), mujoco.MjData(theirs)
    rng = np.random.default_rng(1)
    for _ in range(5):
        angles = rng.uniform(-0.8, 0.8, len(hinges))
        one.qpos[joint_addresses(ours, hinges)] = angles
        two.qpos[joint_addresses(theirs, hinges)] = angles
        mujoco.mj_kinematics(ours, one)
        mujoco.mj_kinematics(theirs, two)
        here = np.array([one.body(body).xpos - one.body(1).xpos for body in bodies])
        there = np.array([two.body(body).xpos - two.body(bodies[0]).xpos for body in bodies])
        assert there == pytest.approx(here, abs=1e-9)


def fits(robot, gait):
    try:
        check_limits(robot, gait)
    except (OutsideLimits, UnknownName):
        return False
    return True

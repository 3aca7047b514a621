"""A tree of hinges from another tool becomes a robot: exact where the file says it, told where it does not."""

import re
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest
import trimesh
from hinge_trees import FOOT, QUADRUPED, joint, link, pendulum, quadruped, shape, skewed, urdf
from hypothesis import given, settings
from hypothesis import strategies as st

import suchus
from suchus.core.errors import OutsideLimits, UnknownName, UnreadableFile
from suchus.robot import blueprint
from suchus.robot.design import Crank, Inertia, Robot, Servo, Spring, layout
from suchus.robot.design.scale import coarse_step
from suchus.robot.design.segment import combine_inertias
from suchus.robot.gaits import GAITS
from suchus.robot.kinematics import limb as limb_kinematics
from suchus.robot.motion import check_limits, cycle_targets, draft_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.metrics import displacement
from suchus.sim.model import compile_model, joint_addresses
from suchus.sim.model.export import export
from suchus.sim.model.importing import Words, import_robot, meshes

PLACES = 1e-9  # m
BOX = shape('<box size="1 1 0.1"/>')


def read(text, tmp_path, name="it", **words):
    file = tmp_path / f"{name}.xml"
    file.write_text(text)
    return import_robot(file, name=name, words=Words(**words))


def told(draft):
    return " ".join(draft.remarks)


def positions(model, matches, angles, ours):
    """Return the anchors of the matched hinges in the order of the matches, and the feet, in the world [m]."""
    data = mujoco.MjData(model)
    names = [match.hinge if ours else match.file_hinge for match in matches]
    values = angles if ours else [m.sign * angle + m.zero for m, angle in zip(matches, angles, strict=True)]
    data.qpos[joint_addresses(model, names)] = values
    mujoco.mj_kinematics(model, data)
    return np.array([data.joint(name).xanchor for name in names]), np.array([data.joint(name).xaxis for name in names])


def gaps(points):
    return np.linalg.norm(points[:, None] - points[None], axis=-1)


def assert_same_places(draft, theirs, count=5, seed=0):
    """Compare all distances between hinges, and the angles between all axes, over random postures."""
    ours = compile_model(draft.robot)
    rng = np.random.default_rng(seed)
    for _ in range(count):
        angles = rng.uniform(-0.8, 0.8, len(draft.matches))
        (here, axes), (there, lines) = (
            positions(m, draft.matches, angles, o) for m, o in ((ours, True), (theirs, False))
        )
        np.testing.assert_allclose(gaps(here), gaps(there), atol=PLACES)
        np.testing.assert_allclose(np.abs(axes @ axes.T), np.abs(lines @ lines.T), atol=PLACES)
    return ours


def fits(robot, gait):
    try:
        check_limits(robot, gait)
    except (OutsideLimits, UnknownName):
        return False
    return True


@pytest.fixture(scope="module", params=[(name, kind) for name in ROBOTS for kind in ("mjcf", "urdf")], ids="-".join)
def shelf(request, tmp_path_factory):
    """A robot of the shelf, and what is read from its own export."""
    name, kind = request.param
    robot = ROBOTS[name]
    gait = next(gait for gait in GAITS.values() if fits(robot, gait))
    folder = export(robot, gait, tmp_path_factory.mktemp("export") / name, kind)
    file = folder / (f"{name}.urdf" if kind == "urdf" else "scene.xml")
    return robot, import_robot(file, name=name), kind


def test_our_own_exports_come_back_with_every_joint_where_it_was(shelf):
    robot, draft, _ = shelf
    theirs = compile_model(robot)
    assert_same_places(draft, theirs)
    assert {match.file_hinge for match in draft.matches} == set(layout(robot).hinges)
    assert layout(draft.robot).hinges == layout(robot).hinges
    assert all(match.hinge == match.file_hinge and match.sign == 1.0 and match.zero == 0.0 for match in draft.matches)
    assert draft.robot.root == robot.root


def test_our_own_exports_come_back_with_feet_masses_and_ranges(shelf):
    robot, draft, _ = shelf
    here, there = compile_model(draft.robot), compile_model(robot)
    assert draft.robot.mass == pytest.approx(robot.mass, rel=1e-9)
    for one, two in zip(draft.robot.girdles, robot.girdles, strict=True):
        assert one.name == two.name
        assert one.limb.foot.radius == pytest.approx(two.limb.foot.radius, abs=PLACES)
        ends = [np.sum([link.end for link in limb.links], axis=0) for limb in (one.limb, two.limb)]
        assert ends[0] == pytest.approx(ends[1], abs=PLACES)
        if robot.hull is None:  # foam around a limb comes back as a part of it
            assert one.limb.mass == pytest.approx(two.limb.mass)
    for name in layout(robot).hinges:
        assert here.joint(name).range == pytest.approx(there.joint(name).range, abs=1e-6)
        assert np.allclose(here.joint(name).axis, there.joint(name).axis)


def test_the_draft_says_what_becomes_of_a_cable(shelf):
    robot, draft, kind = shelf
    cables = robot.cables
    if kind == "urdf":
        assert "holds no cables" in told(draft)
    assert (kind == "mjcf" and "pulls a tendon over tail_yaw_1" in told(draft)) == (kind == "mjcf" and bool(cables))
    if kind == "mjcf":
        drives = {h.name: h.drive for h in draft.robot.axis_hinges}
        for cable in cables:
            assert all(isinstance(drives[name], Spring) for name in cable.hinges)


def test_the_written_file_is_the_draft_and_it_walks_with_its_own_gait(shelf, tmp_path):
    _, draft, kind = shelf
    file = blueprint.write(draft.robot, tmp_path / "it.toml", notes=draft.notes, head=draft.remarks)
    assert blueprint.read_design(file, Robot, ROBOTS) == draft.robot
    if kind == "mjcf" or not draft.robot.girdles:
        return
    gait = draft_gait(draft.robot, "it_walk")
    record = suchus.crawl(draft.robot, gait, duration=1.0 + gait.period)
    ahead, aside, _ = displacement(record).values / draft.robot.length
    assert ahead > 0.05
    assert abs(aside) < 0.3 * ahead


def test_a_chain_of_pendulums_is_an_axis_of_segments(tmp_path):
    draft = read(pendulum(count=4, length=0.2), tmp_path, front="rod_0")
    body = draft.robot
    assert [segment.name for segment in body.axis] == ["rod_0", "rod_1", "rod_2", "rod_3"]
    assert [segment.rear for segment in body.axis[1:3]] == pytest.approx([0.2, 0.2], abs=1e-12)
    assert [hinge.turn for hinge in body.axis_hinges] == ["yaw"] * 3
    assert body.girdles == ()
    assert body.mass == pytest.approx(2.0)
    # the file's head carries the chain, our root is the same segment: the tail end turns right with a positive angle
    assert [h.range for h in body.axis_hinges] == [pytest.approx((-0.5 * i, 0.25 * i)) for i in (1, 2, 3)]


def test_a_chain_read_from_its_other_end_turns_the_other_way(tmp_path):
    one = read(pendulum(), tmp_path, front="rod_0")
    two = read(pendulum(), tmp_path, front="rod_3")
    assert [s.name for s in two.robot.axis] == [s.name for s in reversed(one.robot.axis)]
    assert two.robot.root == one.robot.root == "rod_0"
    file = tmp_path / "it.xml"
    theirs = mujoco.MjModel.from_xml_string(file.read_text().replace("<robot", "<robot"))
    for draft in (one, two):
        assert_same_places(draft, theirs)


def test_pitch_hinges_of_a_chain_turn_down_where_ours_do(tmp_path):
    draft = read(pendulum(axis="0 1 0"), tmp_path, front="rod_0")
    # about +y the rear end of a rod goes up; ours go down
    assert [match.sign for match in draft.matches] == [-1.0] * 3
    assert [h.range for h in draft.robot.axis_hinges] == [pytest.approx((-0.25 * i, 0.5 * i)) for i in (1, 2, 3)]


def test_a_quadruped_of_today_is_two_girdles_on_one_segment_and_walks(tmp_path):
    draft = read(quadruped(), tmp_path)
    robot = draft.robot
    assert [girdle.name for girdle in robot.girdles] == ["F", "H"]
    assert [len(robot.axis), robot.root] == [1, "base"]
    limb = robot.girdles[0].limb
    assert [hinge.turn for hinge in limb.hinges] == ["pitch", "roll", "roll"]
    assert [link.end for link in limb.links] == [(0, pytest.approx(0.08), 0)] + 2 * [(0, 0, pytest.approx(-0.21))]
    assert limb.foot.radius == FOOT
    assert robot.mass == pytest.approx(8.0 + 4 * 1.95)
    by_name = {match.file_hinge: match for match in draft.matches}
    assert by_name["FL_abduction"].hinge == "LF_pitch"
    assert by_name["FL_abduction"].sign == -1.0  # about +x a left leg goes up and out, ours goes down
    assert by_name["FR_abduction"].sign == 1.0
    servo = limb.hinges[0].servo
    assert (servo.torque, servo.speed) == (30.0, 15.0)
    gait = draft_gait(robot, "walk")
    record = suchus.crawl(robot, gait, duration=1.0 + gait.period)
    ahead, aside, _ = displacement(record).values
    # two strokes of 0.2 reaches of 0.5 m each cycle; feet slip and the body rolls
    assert 0.5 < ahead / (2 * 0.2 * limb.reach) < 1.5
    assert abs(aside) < 0.5 * ahead


@settings(max_examples=6)
@given(heading=st.sampled_from([0, 30, 45, 90, 180, 270]))
def test_the_heading_of_the_file_does_not_matter(heading, tmp_path_factory):
    c, s = np.cos(np.radians(heading)), np.sin(np.radians(heading))
    text = quadruped(lambda x, y: (float(c * x - s * y), float(s * x + c * y)), (f"{c} {s} 0", f"{-s} {c} 0"))
    draft = read(text, tmp_path_factory.mktemp("it"))
    straight = read(quadruped(), tmp_path_factory.mktemp("it"))
    for one, two in zip(draft.robot.girdles, straight.robot.girdles, strict=True):
        assert (one.at - draft.robot.girdles[-1].at) == pytest.approx(two.at - straight.robot.girdles[-1].at, abs=1e-9)
        assert [link.end for link in one.limb.links] == [pytest.approx(link.end, abs=1e-9) for link in two.limb.links]
    assert [m.file_hinge for m in draft.matches] == [m.file_hinge for m in straight.matches]


@settings(max_examples=10)
@given(seed=st.integers(0, 10_000))
def test_trees_with_any_mirrored_limbs_come_back(seed, tmp_path_factory):
    """Random spines and limbs: lengths, turns and signs of the axes as they fall; left and right mirror each other."""
    rng = np.random.default_rng(seed)
    parts, count = [link("trunk_0", 1.0, shape('<sphere radius="0.03"/>'))], int(rng.integers(1, 4))
    for i in range(1, count + 1):
        parts.append(link(f"trunk_{i}", 1.0, shape('<sphere radius="0.03"/>', "0.1 0 0"), "0.1 0 0"))
        axis = ("0 0 1", "0 0 -1", "0 1 0", "0 -1 0", "1 0 0")[rng.integers(5)]
        parts.append(joint(f"bend_{i}", f"trunk_{i - 1}", f"trunk_{i}", (0.2 if i > 1 else 0.05, 0.0, 0.0), axis))
    for where in (0, count):
        before = f"trunk_{where}"
        lengths = rng.uniform(0.05, 0.1, 3).tolist()
        axes = [("0 0 1", "0 0 -1", "1 0 0", "-1 0 0", "0 1 0")[k] for k in rng.integers(5, size=2)]
        for side, y in (("L", 1), ("R", -1)):
            turn = rng.choice([-1, 1], size=2) if side == "R" else [1, 1]
            mine = [" ".join(str(int(v) * t) for v in axis.split()) for axis, t in zip(axes, turn, strict=True)]
            upper, lower = f"{side}{where}_upper", f"{side}{where}_lower"
            parts += [
                link(upper, 0.1, at=f"0 {0.05 * y} 0"),
                link(lower, 0.1, shape('<sphere radius="0.01"/>', f"0 {lengths[1] * y!r} {-lengths[2]!r}")),
                joint(f"{side}{where}_one", before, upper, (0.0, 0.04 * y, 0.0), mine[0]),
                joint(f"{side}{where}_two", upper, lower, (0.0, lengths[0] * y, -0.02), mine[1]),
            ]
    text = urdf(*parts)
    # where the file's root is the front end, ours is the other end: every hinge of the axis is read backward
    draft = read(text, tmp_path_factory.mktemp("it"), heading=180.0 * (seed % 2))
    assert len(draft.robot.girdles) == 2
    extra = '<robot name="it"><mujoco><compiler fusestatic="false"/></mujoco>'
    theirs = mujoco.MjModel.from_xml_string(text.replace('<robot name="it">', extra))
    assert len(draft.matches) == theirs.njnt
    assert_same_places(draft, theirs, count=3)


def test_limbs_that_are_drawn_askew_get_a_zero_at_which_their_hinges_are_straight(tmp_path):
    draft = read(skewed(), tmp_path)
    assert [hinge.turn for hinge in draft.robot.girdles[0].limb.hinges] == ["yaw", "pitch", "pitch"]
    zeros = {match.file_hinge: match.zero for match in draft.matches}
    assert [zeros[f"{limb}_hip"] for limb in ("LF", "RF", "LH", "RH")] == pytest.approx(
        np.pi / 4 * np.array([1, -1, -1, 1])
    )
    assert "drawn askew" in told(draft)
    assert_same_places(draft, mujoco.MjModel.from_xml_path(str(tmp_path / "it.xml")))
    gait = draft_gait(draft.robot, "walk")
    assert (
        displacement(suchus.crawl(draft.robot, gait, duration=1.0 + gait.period)).values[0] > 0.1 * draft.robot.length
    )


def test_the_front_is_said_by_names_by_an_option_or_guessed(tmp_path):
    assert read(quadruped(), tmp_path).robot.girdles[0].limb.hinges
    blind = {f"leg{i}": place for i, place in enumerate(QUADRUPED.values())}
    guessed = read(quadruped(legs=blind), tmp_path)
    assert "Guess: the front is along the file's x axis" in told(guessed)
    asked = read(quadruped(legs=blind), tmp_path, front="leg2_hip")
    assert "Front: against the file's x axis, as names or options say" in told(asked)
    assert asked.matches[0].file_hinge != guessed.matches[0].file_hinge
    assert read(quadruped(legs=blind), tmp_path, heading=180.0).matches == asked.matches
    with pytest.raises(UnknownName, match="Did you mean 'leg2_hip'"):
        read(quadruped(legs=blind), tmp_path, front="leg2_hipp")


def test_arms_and_what_is_left_out_lend_their_mass(tmp_path):
    arms = "".join(
        link(f"{side}_arm", 0.4, shape('<sphere radius="0.01"/>', f"0 {0.1 * y} 0.1"))
        + joint(f"{side}_shoulder", "base", f"{side}_arm", (0.1, 0.09 * y, 0.06), "0 0 1")
        for side, y in (("left", 1), ("right", -1))
    )
    text = quadruped().replace("</robot>", arms + "</robot>")
    draft = read(text, tmp_path)
    assert len(draft.robot.girdles) == 2
    assert draft.robot.mass == pytest.approx(8.0 + 4 * 1.95 + 0.8)
    assert "they are arms or fins and were left out" in told(draft)
    fewer = read(text, tmp_path, leave=("RL_hip", "RR_hip"))
    assert [girdle.limb.hinges[0].name for girdle in fewer.robot.girdles] == ["pitch"]
    assert fewer.robot.mass == pytest.approx(draft.robot.mass)
    assert "Left out as asked" in told(fewer)


def test_a_forked_axis_takes_the_longer_branch_or_the_one_that_is_named(tmp_path):
    branches = (
        link("jaw", 0.1, shape('<sphere radius="0.02"/>', "0.1 0 -0.03"), "0.1 0 -0.03")
        + link("skull", 0.3, shape('<sphere radius="0.03"/>', "0.15 0 0"), "0.1 0 0")
        + joint("bite", "base", "jaw", (0.22, 0.0, 0.0), "0 1 0")
        + joint("nod", "base", "skull", (0.22, 0.0, 0.0), "0 1 0")
    )
    text = quadruped().replace("</robot>", branches + "</robot>")
    one, two = read(text, tmp_path), read(text, tmp_path, neck="jaw")
    assert [[s.name for s in draft.robot.axis] for draft in (one, two)] == [["skull", "base"], ["jaw", "base"]]
    assert "jaw was left out" in told(one)
    assert one.robot.mass == pytest.approx(two.robot.mass)


def test_drives_and_ranges_are_those_of_the_file(tmp_path):
    text = quadruped().replace('type="revolute"><parent link="FL_thigh"', 'type="continuous"><parent link="FL_thigh"')
    draft = read(text, tmp_path)
    knee = draft.robot.girdles[0].limb.hinges[2]
    assert knee.range == pytest.approx((-np.pi, np.pi), abs=1e-3)
    assert isinstance(knee.drive, Servo)
    slack = read(quadruped().replace('upper="-0.9" effort="30.0"', 'upper="-0.9" effort="0"'), tmp_path)
    assert isinstance(slack.robot.girdles[0].limb.hinges[2].drive, Spring)
    unsaid = read(quadruped().replace('effort="30.0"', 'effort="0"'), tmp_path)
    assert isinstance(unsaid.robot.girdles[0].limb.hinges[2].drive, Servo)
    assert not any(isinstance(h.drive, Crank) for h in draft.robot.girdles[0].limb.hinges)


def test_the_right_side_is_compared_with_the_left_one(tmp_path):
    assert "another range" not in told(read(quadruped(), tmp_path))
    head, knee, rest = quadruped().partition('<joint name="FR_knee"')
    draft = read(head + knee + rest.replace('upper="-0.9"', 'upper="-1.2"', 1), tmp_path)
    assert "FR_knee has another range than FL_knee" in told(draft)


def test_every_guess_is_a_comment_beside_its_number(tmp_path):
    draft = read(quadruped(), tmp_path, foot_radius=0.03)
    text = blueprint.render(draft.robot, notes=draft.notes, head=draft.remarks)
    lines = text.splitlines()
    guesses = [note for note in draft.notes.values() if note.startswith("guess")]
    assert sum("Guess:" in line for line in lines if not line.startswith("#")) == len(guesses) > 10
    assert any(line.startswith("radius = 0.03") and "--foot-radius" in line for line in lines)
    assert any(line.startswith('name = "pitch"') and "FL_abduction, turning the other way" in line for line in lines)
    assert any(line.startswith("torque = 30.0") and "Of the file." in line for line in lines)
    places = {place.split(".")[0].split("[")[0] for place in draft.notes}
    assert places <= {"axis", "girdles", "contact", "root"}
    assert blueprint.render(draft.robot) == blueprint.render(replace(draft.robot))


def test_meshes_in_the_folder_give_shapes_and_others_are_told(tmp_path):
    corners = "\n".join(f"v {x} {y} {z}" for x in (-0.2, 0.2) for y in (-0.05, 0.05) for z in (-0.04, 0.04))
    corners_of = (123, 243, 576, 678, 152, 256, 347, 487, 135, 375, 264, 468)
    faces = "\n".join(f"f {n // 100} {n // 10 % 10} {n % 10}" for n in corners_of)
    (tmp_path / "box.obj").write_text(f"{corners}\n{faces}\n")
    box = '<box size="0.4 0.18 0.12"/>'
    inside = read(quadruped().replace(box, '<mesh filename="box.obj"/>'), tmp_path)
    assert inside.robot.axis[0].shapes[0].half == pytest.approx((0.2, 0.05, 0.04), abs=1e-6)
    named = quadruped().replace(box, '<mesh filename="../box.obj"/>')
    with pytest.raises(UnreadableFile, match=r"the shape of link base is a mesh that was not read: .*lies outside"):
        read(named, tmp_path)
    outside = read(named, tmp_path, without_meshes=True)
    assert "1 mesh was not read" in told(outside)
    assert "base has no shape that is read" in told(outside)


def test_meshes_of_packages_are_read_from_the_folders_that_are_named(tmp_path):
    mesh = tmp_path / "ros" / "dog" / "meshes" / "trunk.ply"
    mesh.parent.mkdir(parents=True)
    trimesh.creation.box((0.4, 0.1, 0.08)).export(mesh)
    (tmp_path / "urdf").mkdir()
    named = '<mesh filename="package://dog/meshes/trunk.ply"/>'
    text = quadruped().replace('<box size="0.4 0.18 0.12"/>', named)
    for folder in (tmp_path / "ros", tmp_path / "ros" / "dog"):
        trunk = read(text, tmp_path / "urdf", packages=(folder,)).robot.axis[0].shapes[0]
        assert trunk.half == pytest.approx((0.2, 0.05, 0.04), abs=1e-6)
    for folders in ((), (tmp_path / "urdf",)):
        with pytest.raises(UnreadableFile, match=r"none of them is dog. Say --packages FOLDER"):
            read(text, tmp_path / "urdf", packages=folders)
    with pytest.raises(UnreadableFile, match="is in none"):  # a name that leads out of the package's folder
        read(text.replace("dog/meshes", "../ros/dog/meshes"), tmp_path / "urdf", packages=(mesh.parent,))
    mesh.write_text("ply\nno mesh\n")
    with pytest.raises(UnreadableFile, match=r"trunk\.ply is no mesh"):
        read(text, tmp_path / "urdf", packages=(tmp_path / "ros",))


def stiff(model, root):
    """Return mass [kg], centre of mass [m] and tensor of inertia about it [kg m2] of a body and what is fixed to it.

    Places are those of the world at zero posture, from the origin of the body.
    """
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    those = [root]
    for body in range(root + 1, model.nbody):
        if model.body_parentid[body] in those and model.body_jntnum[body] == 0:
            those.append(body)
    turns = data.ximat.reshape(-1, 3, 3)
    return combine_inertias(
        [
            (
                model.body_mass[i],
                data.xipos[i] - data.xpos[root],
                turns[i] @ np.diag(model.body_inertia[i]) @ turns[i].T,
            )
            for i in those
        ]
    )


def test_our_own_exports_come_back_with_mass_centre_and_inertia_of_every_body(shelf):
    robot, draft, _ = shelf
    here, there = compile_model(draft.robot), compile_model(robot)
    for hinge in layout(robot).hinges:
        ours, theirs = (stiff(model, int(model.joint(hinge).bodyid[0])) for model in (here, there))
        assert ours[0] == pytest.approx(theirs[0], rel=1e-9)
        np.testing.assert_allclose(ours[1], theirs[1], atol=1e-9 * robot.length)
        np.testing.assert_allclose(ours[2], theirs[2], atol=1e-8 * np.abs(theirs[2]).max())
    # the root's origin lies elsewhere: its centre is compared with the first hinge, which stays in its place
    (mass, centre, about), (other, place, around) = (stiff(model, 1) for model in (here, there))
    assert mass == pytest.approx(other, rel=1e-9)
    np.testing.assert_allclose(about, around, atol=1e-8 * np.abs(around).max())
    hinge = layout(robot).hinges[0]
    np.testing.assert_allclose(
        from_root(here, hinge) - centre, from_root(there, hinge) - place, atol=1e-9 * robot.length
    )


def from_root(model, hinge):
    """Return where a hinge is from the origin of the root at zero posture [m]."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return data.joint(hinge).xanchor - data.xpos[1]


L_PRISM = ((0.0, 0.0), (0.3, 0.0), (0.3, 0.1), (0.1, 0.1), (0.1, 0.3), (0.0, 0.3))


def l_prism():
    """Return an L of two bars of 0.1 m, 0.3 m long, 0.1 m high, as a mesh."""
    corners = [(x, y, z) for z in (0.0, 0.1) for x, y in L_PRISM]
    floor = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)]
    sides = [face for i in range(6) for k in [(i + 1) % 6] for face in ((i, k, k + 6), (i, k + 6, i + 6))]
    faces = [(a, c, b) for a, b, c in floor] + [(a + 6, b + 6, c + 6) for a, b, c in floor] + sides
    return trimesh.Trimesh(corners, faces)


def box_about(mass, x, y, z, off):
    """Return the tensor of a box about a point that lies ``off`` its centre [kg m2]."""
    own = mass / 12 * np.diag([y * y + z * z, x * x + z * z, x * x + y * y])
    return own + mass * (np.dot(off, off) * np.eye(3) - np.outer(off, off))


SOLIDS = {
    "box": ('<box size="0.4 0.18 0.12"/>', 8.64, np.zeros(3), box_about(8.64, 0.4, 0.18, 0.12, np.zeros(3))),
    "cylinder": (
        '<cylinder radius="0.1" length="0.3"/>', 1000 * np.pi * 0.003, np.zeros(3),
        1000 * np.pi * 0.003 * np.diag([0.0025 + 0.0075, 0.0025 + 0.0075, 0.005]),
    ),
    "mesh": (
        '<mesh filename="l.stl"/>', 5.0, np.array([0.11, 0.11, 0.05]),
        box_about(3.0, 0.3, 0.1, 0.1, np.array([0.04, -0.06, 0.0]))
        + box_about(2.0, 0.1, 0.2, 0.1, np.array([-0.06, 0.09, 0.0])),
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", SOLIDS)
def test_a_solid_without_inertial_has_the_inertia_of_its_shape_at_the_density_of_water(kind, tmp_path):
    geometry, mass, centre, about = SOLIDS[kind]
    l_prism().export(tmp_path / "l.stl")
    text = quadruped().replace('<box size="0.4 0.18 0.12"/>', geometry)
    whole = re.search(r'<link name="base">(<inertial>.*?</inertial>)', text)[1]
    robot = read(text.replace(whole, "", 1), tmp_path).robot
    trunk = robot.axis[0]
    single = 1e-6 if kind == "mesh" else 1e-12  # MuJoCo keeps meshes in single precision
    assert sum(shape.mass for shape in trunk.shapes) == pytest.approx(mass, rel=single)
    hips = robot.girdles[0].at - 0.19, 0.0, 0.0  # of the file's origin in the frame of the segment
    np.testing.assert_allclose(np.subtract(trunk.inertia.centre, hips), centre, atol=single)
    np.testing.assert_allclose(trunk.inertia.tensor, about, rtol=single, atol=single * about.max())
    assert stiff(compile_model(robot), 1)[2] == pytest.approx(trunk.inertia.tensor, rel=1e-9, abs=1e-12)


def test_what_a_file_says_of_inertia_is_kept_and_comes_out_of_the_export_again(tmp_path):
    text = quadruped()
    stated = '<inertia ixx="0.02" iyy="0.09" izz="0.1" ixy="0.003" ixz="-0.002" iyz="0.001"/>'
    whole = re.search(r'<link name="base"><inertial>.*?(<inertia [^>]*>)', text)[1]
    robot = read(text.replace(whole, stated, 1).replace('xyz="0 0 0"', 'xyz="0.03 0 0.01"', 1), tmp_path).robot
    inertia = robot.axis[0].inertia
    np.testing.assert_allclose(
        [*inertia.moments, *inertia.products], [0.02, 0.09, 0.1, 0.003, -0.002, 0.001], atol=1e-12
    )
    file = blueprint.write(robot, tmp_path / "it.toml")
    assert blueprint.read_design(file, Robot, ROBOTS) == robot
    gait = draft_gait(robot, "walk")
    for kind, name in (("mjcf", "scene.xml"), ("urdf", "it.urdf")):
        folder = export(robot, gait, tmp_path / kind, kind)
        again = import_robot(folder / name, name="it").robot.axis[0].inertia
        np.testing.assert_allclose(again.tensor, inertia.tensor, atol=1e-12)
        np.testing.assert_allclose(again.centre, inertia.centre, atol=1e-12)


def test_foam_adds_its_mass_to_a_stated_inertia_as_it_does_to_shapes():
    robot = ROBOTS["floating_caiman"]
    plain, bare = compile_model(robot), compile_model(replace(robot, hull=None))
    root = robot.root_index
    _, centre, about = stiff(bare, 1)
    own = Inertia(centre=tuple(centre), moments=tuple(np.diag(about)), products=tuple(about[[0, 0, 1], [1, 2, 2]]))
    axis = tuple(replace(one, inertia=own) if i == root else one for i, one in enumerate(robot.axis))
    stated = compile_model(replace(robot, axis=axis))
    assert plain.body_mass[1] > bare.body_mass[1]
    for one, two in zip(stiff(stated, 1), stiff(plain, 1), strict=True):
        np.testing.assert_allclose(one, two, rtol=1e-9, atol=1e-15)


def test_an_inertia_that_no_body_has_is_mended_and_said(tmp_path):
    text = re.sub(r'(<link name="base"><inertial>.*?)ixx="[^"]*"', r'\1ixx="0.2"', quadruped(), count=1)
    draft = read(text, tmp_path)
    assert "The inertia of base is none that a body can have" in told(draft)
    assert np.ptp(draft.robot.axis[0].inertia.moments) < 1e-12


def test_a_floating_joint_that_carries_the_robot_is_the_freedom_that_it_has_anyway(tmp_path):
    world = link("world", 0) + joint("afloat", "world", "base", (0.0, 0.0, 0.3), "0 0 1", kind="floating")
    free = read(quadruped().replace("</robot>", world + "</robot>"), tmp_path)
    assert replace(free.robot, name="it") == read(quadruped(), tmp_path).robot
    table = link("table", 9.0, BOX) + joint("stand", "world", "table", (0.0, 0.0, -1.0), "0 0 1", kind="fixed")
    beside = read(quadruped().replace("</robot>", world + table + "</robot>"), tmp_path)
    assert beside.robot == free.robot
    assert "Beside the robot the file holds table" in told(beside)


def test_a_file_of_nothing_but_what_stands_is_refused(tmp_path):
    with pytest.raises(UnreadableFile, match="no hinge"):
        read(urdf(link("a"), link("b"), joint("ab", "a", "b", (0, 0, 0), "1 0 0", kind="fixed")), tmp_path)
    assert not list(Path(tmp_path).glob("*.toml"))


def two_hinges(kind, second=(-1.0, 1.0)):
    """Return a quadruped whose limbs have two hinges: hip swung by yaw and lifted by pitch, or two in one plane."""
    axes = {"sprawled": ("0 0 1", "1 0 0"), "upright": ("0 1 0", "0 1 0"), "flat": ("0 0 1", "0 0 1")}[kind]
    parts = [link("base", 3.0, shape('<box size="0.5 0.12 0.06"/>'))]
    for name, (x, y) in {"FL": (0.2, 1), "FR": (0.2, -1), "RL": (-0.2, 1), "RR": (-0.2, -1)}.items():
        out = (0.0, 0.12 * y, 0.0) if kind != "upright" else (0.0, 0.0, -0.12)
        tip = (0.0, 0.10 * y, -0.10) if kind != "upright" else (0.0, 0.0, -0.12)
        knee = (0.0, 0.0, 0.0) if kind == "sprawled" else out
        foot = tuple(a + b for a, b in zip(out, tip, strict=True)) if kind == "sprawled" else tip
        parts += [
            link(f"{name}_upper", 0.05, at=" ".join(str(part / 2) for part in knee)),
            link(f"{name}_lower", 0.05, shape('<sphere radius="0.015"/>', " ".join(map(str, foot)))),
            joint(f"{name}_one", "base", f"{name}_upper", (x, 0.07 * y, 0.0), axes[0]),
            joint(f"{name}_two", f"{name}_upper", f"{name}_lower", knee, axes[1], low=second[0], high=second[1]),
        ]
    return urdf(*parts)


@pytest.mark.parametrize("knee", [(-1.0, 1.0), (-2.5, -0.3)], ids=["either", "forward"])
def test_upright_limbs_of_hip_and_knee_trot_with_their_feet_below_the_hips(knee, tmp_path):
    robot = read(two_hinges("upright", knee), tmp_path, heading=0.0).robot
    gait = draft_gait(robot, "walk")
    check_limits(robot, gait)
    front = layout(robot).limbs[0]
    feet = limb_kinematics.forward(front.girdle.limb, cycle_targets(robot, gait, np.arange(24) / 24)[:, front.servos])
    assert abs((feet[:, 0].max() + feet[:, 0].min()) / 2) < 0.03 * front.girdle.limb.reach
    record = suchus.crawl(robot, gait, duration=1.0 + 3 * gait.period, timestep=coarse_step(robot))
    ahead, aside, _ = displacement(record).values / robot.length
    assert ahead > 0.2  # measured 0.5 to 1.1; with the feet where the hinges are near their middles -0.2
    assert abs(aside) < 0.5 * ahead


def test_limbs_of_two_hinges_get_a_gait_that_walks(tmp_path):
    robot = read(two_hinges("sprawled"), tmp_path, heading=0.0).robot
    assert [len(girdle.limb.hinges) for girdle in robot.girdles] == [2, 2]
    gait = draft_gait(robot, "walk")
    assert gait.curves
    assert not gait.limbs
    check_limits(robot, gait)
    record = suchus.crawl(robot, gait, duration=1.0 + 2 * gait.period, timestep=coarse_step(robot))
    ahead, aside, _ = displacement(record).values / robot.length
    assert ahead > 0.05
    assert abs(aside) < 0.5 * ahead


@pytest.mark.parametrize(
    ("kind", "why"), [("flat", "turn by yaw, and none lifts the foot"), ("one", "have 1 driven hinges")]
)
def test_limbs_that_cannot_walk_are_told_in_a_sentence_what_to_do(kind, why, tmp_path):
    robot = read(two_hinges("flat" if kind == "flat" else "sprawled"), tmp_path, heading=0.0).robot
    if kind == "one":
        robot = replace(robot, girdles=tuple(with_one_hinge(girdle) for girdle in robot.girdles))
    with pytest.raises(OutsideLimits, match=why) as told:
        draft_gait(robot, "walk")
    assert "write a gait of its own" in str(told.value)


def with_one_hinge(girdle):
    """Return a girdle whose limbs keep their first hinge."""
    first, *others = girdle.limb.links
    links = (replace(first, hinges=first.hinges[:1]), *(replace(one, hinges=()) for one in others))
    kept = tuple(one for one in links if one.hinges)
    return replace(girdle, limb=replace(girdle.limb, links=kept))


def test_the_mass_is_that_of_the_file_where_the_sides_differ(tmp_path):
    """A battery or a sensor may hang at one leg; the left limb is the pattern of both."""
    head, calf, rest = quadruped().partition('<link name="FR_calf">')
    heavier = head + calf + rest.replace('mass value="0.2"', 'mass value="0.25"', 1)
    draft, even = read(heavier, tmp_path), read(quadruped(), tmp_path)
    assert draft.robot.mass == pytest.approx(even.robot.mass + 0.05, rel=1e-12)
    assert "the draft has the mean on both sides" in told(draft)
    assert "the draft has the mean" not in told(even)
    assert "The draft weighs" not in told(draft)


def test_a_mesh_of_very_many_faces_is_read_as_its_hull(tmp_path, monkeypatch):
    """MuJoCo reads at most 200 000 faces from STL."""
    monkeypatch.setattr(meshes, "_MAX_FACES", 100)
    trimesh.creation.icosphere(subdivisions=3, radius=0.1).export(tmp_path / "ball.stl")
    text = quadruped().replace('<box size="0.4 0.18 0.12"/>', '<mesh filename="ball.stl"/>')
    draft = read(text, tmp_path)
    assert "more than 200 000 faces" in told(draft)
    (shell,) = draft.robot.axis[0].shapes
    assert shell.half == pytest.approx((0.1, 0.1, 0.1), rel=0.02)

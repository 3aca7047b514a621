"""What a robot is built of: masses that add up, frames of the article, plates, cords, wires, foam, and ROS."""

import io
from itertools import pairwise
from math import pi
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest

from suchus.apps.report.building_sheet import floating_sentence, mass_sentences, printed_parts, tables
from suchus.article.paper.tables import LEG_CHAIN, SPINE_CHAIN
from suchus.hardware import commands, straight, trajectory_text
from suchus.hardware.outlines import CORD_HOLE, plates_dxf, stl, top_dxf
from suchus.hardware.parts import area, sheet
from suchus.hardware.ros import PLUGIN, controllers, note, ros_urdf
from suchus.robot.design import Servo, layout, with_servos
from suchus.robot.kinematics.tail import cable_changes
from suchus.robot.motors import motor
from suchus.robot.robots import ROBOTS
from suchus.sim.model import compile_model

NAMES = ["caiman", "floating_caiman", "strider", "salamandra", "swimmer"]


@pytest.fixture(scope="module")
def bought(robot):
    return with_servos(robot, lambda servo: Servo.from_motor(motor("STS3250"), template=servo))


@pytest.mark.parametrize("name", NAMES)
def test_masses_and_centre_are_those_of_the_simulation(name):
    body = ROBOTS[name]
    found = sheet(body)
    assert sum(one.simulated for one in found.bodies) == pytest.approx(body.mass)
    known = sum(part.mass for part in found.parts if part.kind != "servo")
    assert known == pytest.approx(body.mass)
    model = compile_model(body)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    root = model.body(body.root).id
    assert found.centre == pytest.approx(data.subtree_com[root] - data.xpos[root], abs=1e-9)
    for joint in found.joints:
        assert joint.at == pytest.approx(data.xanchor[model.joint(joint.name).id] - data.xpos[root], abs=1e-9)


def test_servos_sit_on_the_body_ahead_of_their_hinge_and_weigh_what_they_are_bought_for(bought, former):
    found = sheet(bought)
    assert sum(one.servos for one in found.bodies) == pytest.approx(19 * motor("STS3250").mass)
    seats = {part.name: part.body for part in found.parts if part.kind == "servo"}
    assert (seats["LH_yaw"], seats["LH_knee"], seats["spine_yaw_1"]) == ("pelvis", "LH_femur", "pelvis")
    assert (seats["tail_pitch"], seats["tail_cable"]) == ("pelvis", "pelvis")
    pelvis = next(one for one in found.bodies if one.name == "pelvis")
    assert pelvis.servos == pytest.approx(7 * motor("STS3250").mass)  # four of the hips, three of the axis
    assert pelvis.rest == pytest.approx(pelvis.simulated - pelvis.servos - pelvis.printed)
    said = mass_sentences(found)
    assert f"{19 * motor('STS3250').mass:.2f} kg are servos" in said[0]
    assert not any("Heavier" in one for one in said)
    thick = sheet(bought, wall=0.006)
    heavy = [one for one in thick.bodies if one.rest < 0.0]
    assert heavy
    assert all(f"{one.name} by {-1000 * one.rest:.0f} g" in mass_sentences(thick)[-1] for one in heavy)
    assert "suchus size chooses some" in mass_sentences(sheet(former))[0]
    unknown = sheet(former).bodies[0]
    assert np.isnan(unknown.servos)
    assert np.isnan(unknown.rest)


def test_surfaces_are_exact_for_rods_and_balls_and_near_for_ellipsoids():
    assert area("foot", (0.02, 0.02, 0.02)) == pytest.approx(pi * 0.02**2)
    assert area("rod", (0.1, 0.02, 0.02)) == pytest.approx(pi * 0.02 * 0.08 + pi * 0.02**2)
    trimesh = pytest.importorskip("trimesh", reason="trimesh is not installed")
    ball = trimesh.creation.icosphere(subdivisions=5)
    ball.apply_scale([0.1, 0.05, 0.03])
    assert area("shell", (0.2, 0.1, 0.06)) == pytest.approx(ball.area, rel=0.012)


def test_frames_are_those_of_the_articles_tables(robot):
    links = sheet(robot).links
    for chain, printed_chain in (("hind leg", LEG_CHAIN), ("spine", SPINE_CHAIN)):
        mine = [link for link in links if link.chain == chain]
        assert [link.a for link in mine] == pytest.approx(list(printed_chain.a))
        assert [link.alpha for link in mine] == pytest.approx(list(printed_chain.alpha))
        assert [link.number for link in mine] == list(range(1, len(mine) + 1))
    assert sheet(ROBOTS["strider"]).plates == ()


def test_plates_and_cords_are_those_of_the_tail(robot):
    found = sheet(robot)
    tail = robot.tail
    assert len(found.plates) == tail.joints
    for plate in found.plates:
        (left, _), (right, _) = plate.holes
        assert right - left == pytest.approx(tail.cord_spacing)
        assert right < plate.radius
        assert plate.thickness == pytest.approx(tail.plate)
    (cord,) = found.cords
    assert cord.section == pytest.approx(tail.joints * tail.pitch)
    bend, _, toward, away = cord.table[-1]
    assert bend == pytest.approx(tail.bend_limit)
    assert (toward, away) == pytest.approx([float(one) for one in cable_changes(tail, bend)])
    assert cord.travel == -toward


@pytest.mark.parametrize("name", NAMES)
def test_every_servo_hangs_on_a_bus_by_a_wire_and_has_a_number_of_its_own(name):
    found = sheet(ROBOTS[name])
    assert sorted(wire.servo for wire in found.wires) == sorted(layout(ROBOTS[name]).servos)
    assert len({(wire.bus, wire.number) for wire in found.wires}) == len(found.wires)
    wired = {"controller"}
    for wire in found.wires:
        assert wire.after in wired
        assert wire.length >= 0.05
        wired.add(wire.servo)


def test_what_floats_is_told_from_what_sinks():
    afloat, sinks = sheet(ROBOTS["floating_caiman"]), sheet(ROBOTS["caiman"])
    whole = afloat.floating.bare + sum(volume for _, volume, _ in afloat.floating.foam)
    assert -afloat.floating.lacking == pytest.approx(0.05 * whole)  # as it is designed
    assert floating_sentence(afloat).startswith(f"It floats with {50000 * whole:.0f} cm³")
    assert sinks.floating.lacking > 0.0
    assert floating_sentence(sinks).startswith("It sinks: ")
    raised = {body: up for body, _, up in afloat.floating.foam}
    assert raised["thorax"] > 0.0


@pytest.mark.parametrize("name", ["caiman", "strider"])
def test_the_urdf_has_a_joint_for_each_servo_and_a_block_that_counts_them(name):
    body = ROBOTS[name]
    servos = layout(body).servos
    root = ElementTree.fromstring(ros_urdf(body, numbers=range(11, 11 + len(servos))))
    joints = {joint.get("name"): joint for joint in root.findall("joint")}
    assert set(servos) <= set(joints)
    block = root.find("ros2_control")
    assert block.find("hardware/plugin").text == PLUGIN
    told = {one.get("name"): one.text for one in block.findall("hardware/param")}
    assert told["number_of_joints"] == told["number_of_transmissions"] == str(len(servos))
    matrix = np.array([float(one) for one in told["transmission_to_joint_matrix"].split()])
    np.testing.assert_array_equal(matrix.reshape(len(servos), -1), np.eye(len(servos)))
    assert tuple(joint.get("name") for joint in block.findall("joint")) == servos
    assert not root.findall(".//mimic")
    assert [gpio.get("name") for gpio in block.findall("gpio")] == [f"dxl{11 + i}" for i in range(len(servos))]
    for joint in block.findall("joint"):
        limits = {one.get("name"): float(one.text) for one in joint.findall("command_interface/param")}
        stated = joints[joint.get("name")].find("limit")
        if limits:
            assert (limits["min"], limits["max"]) == (float(stated.get("lower")), float(stated.get("upper")))
    links = {link.get("name") for link in root.findall("link")}
    for joint in joints.values():
        assert {joint.find("parent").get("link"), joint.find("child").get("link")} <= links
    assert all(f"- {one}\n" in controllers(body) for one in servos)
    assert ("mimic" in note(body).lower()) == bool(body.cables)


def test_the_trajectory_of_the_virtual_joints_is_that_of_the_servos(robot, crawl_gait):
    samples = commands(robot, crawl_gait, straight(robot))
    text = trajectory_text(robot, samples, virtual=True)
    assert f"joint_names: [{', '.join(layout(robot).servos)}]" in text
    rows = [line for line in text.splitlines() if line.startswith("- positions")]
    first = [float(one) for one in rows[3].partition("[")[2].rstrip("]").split(",")]
    assert first == pytest.approx(samples.angles[3].tolist(), abs=1e-9)


def test_outlines_have_the_lengths_of_the_parts(bought):
    trimesh = pytest.importorskip("trimesh", reason="trimesh is not installed")
    ezdxf = pytest.importorskip("ezdxf", reason="ezdxf is not installed")
    found = sheet(bought)
    names = {part.name for part in printed_parts(found)}
    assert {"LF_femur", "pelvis", "tail_root"} <= names
    assert not any(name.startswith(("RF_", "RH_")) for name in names)
    for name in ("LF_femur", "pelvis", "LF_foot"):
        part = next(one for one in found.parts if one.name == name)
        mesh = trimesh.load(io.BytesIO(stl(part)), file_type="stl")
        wanted = part.size if part.kind != "rod" else (part.size[1], part.size[2], part.size[0])
        assert mesh.extents == pytest.approx([1000 * side for side in wanted], rel=5e-3)
        assert mesh.is_watertight
    drawing = ezdxf.read(io.StringIO(plates_dxf(found.plates)))
    holes = [one for one in drawing.modelspace().query("CIRCLE") if one.dxf.layer == "DRILL"]
    rims = [one for one in drawing.modelspace().query("CIRCLE") if one.dxf.layer == "CUT"]
    assert (len(holes), len(rims)) == (2 * len(found.plates), len(found.plates))
    assert holes[1].dxf.center.x - holes[0].dxf.center.x == pytest.approx(1000 * bought.tail.cord_spacing)
    assert holes[0].dxf.radius == pytest.approx(1000 * CORD_HOLE / 2)
    apart = [b.dxf.center.x - b.dxf.radius - a.dxf.center.x - a.dxf.radius for a, b in pairwise(rims)]
    assert min(apart) > 0.0
    top = ezdxf.read(io.StringIO(top_dxf(found)))
    lines = [one for one in top.modelspace().query("LINE") if one.dxf.layer == "JOINTS"]
    assert len(lines) == 2 * len(found.joints)
    feet = [one for one in top.modelspace().query("ELLIPSE") if one.dxf.layer == "LF_tibia"]
    leg = bought.leg("LF")
    assert feet[0].dxf.center.y == pytest.approx(1000 * (leg.hip_offset + leg.femur + leg.tibia))


def test_tables_hold_what_the_sheet_holds(bought):
    found = tables(sheet(bought))
    assert {"parts.csv", "bodies.csv", "frames.csv", "wiring.csv", "plates.csv", "tail_cable.csv"} <= set(found)
    assert len(found["wiring.csv"].splitlines()) == 20
    assert "STS3250" in found["wiring.csv"]
    thick = tables(sheet(bought, wall=0.0024))["bodies.csv"]
    assert thick != found["bodies.csv"]

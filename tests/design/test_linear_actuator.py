"""The tail by the linear actuator of the article's sections II.B and III.D, beside its servo with a pulley."""

import csv
import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from suchus.apps.report.building_sheet import write_parts
from suchus.core.errors import InvalidDesign, OutsideLimits, UnsuitedRobot
from suchus.experiments.catalog.tail_bending import figure as pictures
from suchus.experiments.catalog.tail_bending.experiment import TailBending, _cords
from suchus.hardware import check_commands, commands, csv_text, ros, straight
from suchus.hardware.bus import BusPlace
from suchus.hardware.bus import straight as wired
from suchus.hardware.limits import overloaded
from suchus.hardware.loads import ServoLoad
from suchus.hardware.parts import sheet
from suchus.hardware.sizing import places
from suchus.robot import blueprint
from suchus.robot.blueprint import MistakenFile
from suchus.robot.design import (
    LinearActuator,
    Robot,
    crocodile,
    servo_ranges,
    tables_of,
    with_full_torque,
    with_named_servos,
    with_servos,
)
from suchus.robot.design.scale import rescale
from suchus.robot.gaits import GAITS
from suchus.robot.kinematics.tail import bend_of_servo, servo_angle
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.model.export.folder import _mjcf
from suchus.sim.model.export.urdf import unsaid

CAIMAN = ROBOTS["caiman"]
EXAMPLE = Path(__file__).parents[2] / "examples" / "linear_tail.toml"
CRAWL = GAITS["belly_crawl"]


def with_tail(**changes: object) -> Robot:
    return crocodile(replace(CAIMAN.tables, tail=replace(CAIMAN.tables.tail, **changes)))


@pytest.fixture(scope="module")
def ideal() -> Robot:
    """The caiman with the actuator that gives its cords what its servo gives them."""
    return with_tail(drive="linear_actuator")


@pytest.fixture(scope="module")
def bought() -> Robot:
    """The robot of the example, with an actuator that is sold."""
    return blueprint.read_design(EXAMPLE, Robot, dict(ROBOTS))


def actuator(robot: Robot) -> LinearActuator:
    linear = robot.cables[0].linear
    assert linear is not None
    return linear


@given(radius=st.floats(0.001, 0.5), travel=st.floats(0.001, 0.5))
def test_a_servo_on_a_pulley_and_an_actuator_are_the_same_drive(radius, travel):
    servo = CAIMAN.servo("tail_cable")
    linear = LinearActuator.from_servo(servo, radius, travel)
    assert linear.travel == travel
    assert linear.force * radius == pytest.approx(servo.torque)  # by the lever
    assert linear.speed == pytest.approx(servo.speed * radius)
    assert linear.kp * radius == pytest.approx(servo.kp / radius)  # a metre is 1 / radius, and so is a newton metre
    back = linear.equivalent_servo(radius)
    for name in ("kp", "kd", "torque", "speed", "armature", "friction", "damping", "integral_limit"):
        assert getattr(back, name) == pytest.approx(getattr(servo, name)), name
    assert back.winding == servo.winding


def test_with_the_ideal_actuator_of_equal_travel_the_tail_bends_the_same(ideal):
    slower = with_tail(drive="linear_actuator", actuator=replace(actuator(ideal), speed=0.01))
    wide = with_tail(drive="linear_actuator", pulley=0.020, cable_servo=CAIMAN.servo("tail_cable"))
    asked = CAIMAN.cables[0].bend_limit
    assert actuator(ideal).travel == pytest.approx(CAIMAN.cables[0].pulley * servo_angle(CAIMAN.cables[0], asked))
    gait = replace(GAITS["tail_drag"], period=1.5)
    walks = [simulate([Run(robot=one, gait=gait)], duration=1.8) for one in (CAIMAN, ideal, slower, wide)]
    joints = [f"tail_yaw_{i}" for i in range(1, 7)]
    bends = [walk.joint_angle.sel(joint=joints).sum("joint").values.ravel() for walk in walks]
    assert np.ptp(bends[0]) > np.radians(30)  # it swings
    np.testing.assert_allclose(bends[1], bends[0], atol=1e-9)
    assert np.abs(bends[2] - bends[0]).max() > np.radians(5)  # a slow one lags
    assert np.abs(bends[3] - bends[0]).max() < np.radians(
        1
    )  # of another pulley, whose servo has other gains at the cords


def test_travel_must_do_for_the_bend():
    least = actuator(with_tail(drive="linear_actuator")).travel
    short = LinearActuator.from_servo(CAIMAN.servo("tail_cable"), 0.025, 0.99 * least)
    with pytest.raises(InvalidDesign, match=r"bends up to 1\.571 rad.*move 0\.03916 m.*travel is 0\.03877 m"):
        with_tail(drive="linear_actuator", actuator=short)
    with_tail(drive="linear_actuator", actuator=short, bend_limit=1.5)  # it bends less
    with pytest.raises(InvalidDesign, match="drive is 'cable'"):
        with_tail(actuator=short)
    with pytest.raises(InvalidDesign, match=r"travel is -1 m.*force is 0 N"):
        replace(short, travel=-1.0, force=0.0)
    with pytest.raises(InvalidDesign, match="cannot reach that speed"):
        replace(short, friction=0.95 * short.force)
    with pytest.raises(InvalidDesign, match="pulley"):
        replace(CAIMAN.cables[0], pulley=0.0)  # a servo needs one


def test_its_files_read_back_equal_whether_tables_make_it_or_not(ideal, bought, tmp_path):
    for robot in (ideal, bought, replace(bought)):
        path = blueprint.write(robot, tmp_path / "robot.toml")
        assert blueprint.read_design(path, Robot, dict(ROBOTS)) == robot
    assert tables_of(replace(bought)) is not None  # its measures alone
    assert actuator(bought).winding is not None
    path.write_text('base = "caiman"\n[tail]\ndrive = "linear_actuator"\n[tail.actuator]\ntravel = 0.05\nforze = 3.0\n')
    with pytest.raises(MistakenFile, match=r"actuator\.forze is not known \(did you mean tail\.actuator\.force\?\)"):
        blueprint.read_design(path, Robot, dict(ROBOTS))
    path.write_text('base = "caiman"\n[tail]\ndrive = "linear_actuator"\n')
    assert blueprint.read_design(path, Robot, dict(ROBOTS)).cables == ideal.cables


def test_servos_are_changed_in_it_as_elsewhere(ideal):
    weaker = with_servos(ideal, lambda servo: replace(servo, torque=0.5 * servo.torque))
    assert actuator(weaker).force == pytest.approx(0.5 * actuator(ideal).force)
    assert weaker.tables is not None
    assert actuator(with_servos(ideal, with_full_torque)).winding is None
    assert with_servos(ideal, lambda servo: servo) == ideal
    own = ideal.servo("tail_cable")
    named = with_named_servos(ideal, {"tail_cable": replace(own, kp=2 * own.kp)})
    assert actuator(named).kp == pytest.approx(2 * actuator(ideal).kp)
    assert actuator(named).travel == actuator(ideal).travel


@settings(max_examples=20)
@given(factor=st.floats(0.1, 5.0))
def test_in_another_size_it_is_the_actuator_of_the_servo_in_that_size(factor):
    cable = with_tail(drive="linear_actuator").cables[0]
    there, servo = rescale(cable, length_factor=factor), rescale(cable.turning, length_factor=factor)
    for name in ("kp", "kd", "torque", "speed", "armature", "friction", "damping"):
        assert getattr(there.turning, name) == pytest.approx(getattr(servo, name)), name
    assert there.linear is not None
    assert there.linear.travel == pytest.approx(factor * actuator(with_tail(drive="linear_actuator")).travel)


def test_its_commands_are_the_cords_travel_in_metres_and_pulses_within_its_stroke(bought):
    servo_map = straight(bought)
    made = commands(bought, CRAWL, servo_map)
    rows = list(csv.DictReader(io.StringIO(csv_text(made))))
    cable = bought.cables[0]
    for row, bend in zip(rows[::20], bend_of_servo(cable, made.angles[::20, -1]), strict=True):
        x = cable.joints * cable.cord_spacing * np.sin(bend / (2 * cable.joints))  # (17) times N
        assert float(row["tail_cable_m"]) == pytest.approx(x, abs=1e-6)
        assert float(row["tail_cable_us"]) == pytest.approx(1500 + 500 * x / 0.050, abs=0.1)
    assert "tail_cable_m" not in csv_text(commands(CAIMAN, CRAWL, straight(CAIMAN)))
    check_commands(bought, CRAWL, servo_map, made)  # 30.8 of 32 mm/s
    hasty = replace(CRAWL, period=0.8 * CRAWL.period)
    with pytest.raises(OutsideLimits, match=r"moves tail_cable .* at 38\.5 mm/s .* up to 32 mm/s"):
        check_commands(bought, hasty, servo_map, commands(bought, hasty, servo_map))
    assert servo_ranges(bought)[-1, 1] * cable.pulley == pytest.approx(cable.cord_travel(cable.bend_limit))


def test_what_only_servos_that_turn_can_do_is_refused_in_a_sentence(bought):
    with pytest.raises(UnsuitedRobot, match=r"tail_cable by a linear actuator.*suchus export-commands"):
        wired(bought, [BusPlace(port="/dev/ttyUSB0", protocol="feetech")], "STS3250")
    with pytest.raises(UnsuitedRobot, match=r"tail_cable by a linear actuator.*plain URDF"):
        ros.ros_urdf(bought)
    assert ("tail_cable",) in places(CAIMAN)
    assert ("tail_cable",) not in places(bought)  # no family of servos is tried there


def test_sheets_exports_and_pictures_speak_of_it(bought, tmp_path):
    found = sheet(bought)
    (part,) = [part for part in found.parts if part.name == "tail_cable"]
    assert part.description == "linear actuator of 131 N, 32 mm/s and 100.0 mm stroke"
    assert "tail_cable" not in found.bought
    bend, place, toward, _ = found.cords[0].table[-1]
    assert found.cords[0].linear
    assert place == pytest.approx(bought.cables[0].cord_travel(bend))
    assert place < -toward  # the cord towards the bend is drawn in a little further, (16)
    assert "one linear actuator moves two cords" in unsaid(bought)[0]
    assert "one servo turns a pulley" in unsaid(CAIMAN)[0]
    readme = _mjcf(bought, CRAWL, 0.002)["README.md"]
    assert "the control of tail_cable is its travel over 0.025 m" in readme
    write_parts(found, tmp_path, gait=CRAWL, samples=commands(bought, CRAWL, straight(bought)), outlines=False)
    assert not (tmp_path / "ros2").exists()
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert "take the plain URDF" in page
    assert "ros2/" not in page
    assert '<td class="number" data-label="Actuator">39.16 mm</td>' in page
    load = ServoLoad(torque=3.0, limit=3.275, at_limit=0.2, first=0.5, off=0.1, needed=4.0, radius=0.025)
    (said,) = overloaded({"tail_cable": load})
    assert "force limit of 131 N for 20 %" in said
    assert "2.5 mm from its commanded place; a stronger linear actuator" in said


def test_the_experiment_draws_how_far_it_moves(bought):
    bends, labels = np.linspace(0.0, 2.0, 5), []
    for robot in (CAIMAN, bought):
        record = _cords(robot.tail, bends, TailBending(robot=robot).linear)
        labels.append(pictures.tail_cords(record).axes[1].get_ylabel())
    assert labels == ["pulley angle [deg]", "travel to one side [mm]"]
    assert float(record.servo[-1]) == pytest.approx(bought.cables[0].cord_travel(2.0))

"""A gait becomes pulses that the servos can follow, or a sentence."""

import copy
import csv
import io
import re
from dataclasses import replace
from math import pi
from xml.etree import ElementTree

import numpy as np
import pytest
import xarray as xr

from suchus.core.errors import InvalidDesign, OutsideLimits
from suchus.hardware import (
    ServoLoad,
    check_commands,
    check_loads,
    commands,
    csv_text,
    loads,
    overloaded,
    read_map,
    share_at_limit,
    straight,
    trajectory_text,
    write_map,
)
from suchus.robot.blueprint import MistakenFile
from suchus.robot.design import Servo, cable_joints, crocodile, layout, servo_names, with_named_servos
from suchus.robot.gaits import default_gait
from suchus.robot.kinematics.tail import servo_angle
from suchus.robot.motion import START, intended
from suchus.robot.motors import motor
from suchus.robot.robots import ROBOTS
from suchus.sim.model.export.urdf import urdf

STRAIGHT = straight(ROBOTS["caiman"])


def remapped(**lines):
    """The straight map with some servos changed."""
    return replace(STRAIGHT, servos=tuple(replace(s, **lines.get(s.name, {})) for s in STRAIGHT.servos))


def test_angles_are_the_gaits_own_and_the_last_sample_is_the_first(robot, crawl_gait):
    told = commands(robot, crawl_gait, STRAIGHT, cycles=2)
    assert told.time[-1] == pytest.approx(2 * crawl_gait.period, abs=1e-12)
    np.testing.assert_array_equal(told.angles[-1], told.angles[0])
    asked = intended(robot, crawl_gait, START + told.time[:-1]).targets
    np.testing.assert_allclose(told.angles[:-1], asked, atol=1e-12)
    assert np.diff(told.time) == pytest.approx(1 / STRAIGHT.rate)


def test_a_rate_that_does_not_divide_the_cycle_still_closes_it(robot, crawl_gait):
    told = commands(robot, replace(crawl_gait, period=3.333), replace(STRAIGHT, rate=47.0))
    assert told.time[-1] == pytest.approx(3.333, abs=1e-12)
    np.testing.assert_array_equal(told.pulses[-1], told.pulses[0])


def test_the_cable_follows_the_articles_equation_18(robot, crawl_gait):
    told = commands(robot, crawl_gait, STRAIGHT)
    tail, bend = robot.tail, crawl_gait.number("tail_bend")
    widest = tail.joints * tail.cord_spacing * np.sin(bend / (2 * tail.joints)) / tail.pulley
    assert abs(told.angles[:, servo_names().index("tail_cable")]).max() == pytest.approx(widest, rel=1e-3)


def test_a_pulse_knows_centre_scale_direction_and_offset(robot, crawl_gait):
    servo_map = remapped(LF_knee={"direction": -1, "offset": 0.5, "pulse_centre": 1400.0, "pulse_per_radian": 300.0})
    told, plain = commands(robot, crawl_gait, servo_map), commands(robot, crawl_gait, STRAIGHT)
    knee = servo_names().index("LF_knee")
    np.testing.assert_allclose(told.pulses[:, knee], 1400 + 300 * (0.5 - told.angles[:, knee]))
    others = [i for i in range(19) if i != knee]
    np.testing.assert_array_equal(told.pulses[:, others], plain.pulses[:, others])
    np.testing.assert_allclose(plain.pulses[:, 0], 1500 + 2000 / (1.5 * pi) * plain.angles[:, 0], rtol=1e-6)


def test_the_order_of_a_map_does_not_matter(robot, crawl_gait):
    servo_map = remapped(LF_yaw={"direction": -1}, RH_knee={"offset": 0.2})
    backward = replace(servo_map, servos=servo_map.servos[::-1])
    np.testing.assert_array_equal(
        commands(robot, crawl_gait, backward).pulses, commands(robot, crawl_gait, servo_map).pulses
    )


def test_speeds_are_the_derivative_of_the_angles(robot, limbs_gait):
    told = commands(robot, limbs_gait, replace(STRAIGHT, rate=400.0), cycles=2)
    middle = (told.angles[2:] - told.angles[:-2]) / (told.time[2:] - told.time[:-2])[:, None]
    np.testing.assert_allclose(told.speeds[1:-1], middle, atol=1e-9)
    np.testing.assert_array_equal(told.speeds[0], told.speeds[-1])


def test_too_fast_a_gait_is_refused_with_servo_speed_and_limit(robot, crawl_gait):
    hasty = replace(crawl_gait, period=0.3)
    servo_map = replace(STRAIGHT, rate=200.0)
    with pytest.raises(
        OutsideLimits, match=r"turns \w+ of robot 'caiman' at [\d.]+ rad/s .* up to 7\.873 rad/s is allowed"
    ):
        check_commands(robot, hasty, servo_map, commands(robot, hasty, servo_map))
    check_commands(robot, crawl_gait, STRAIGHT, commands(robot, crawl_gait, STRAIGHT))


def test_a_pulse_outside_the_map_is_refused(robot, crawl_gait):
    servo_map = remapped(RH_knee={"offset": 1.0})
    with pytest.raises(OutsideLimits, match=r"RH_knee at .* 500 to 2500 us"):
        check_commands(robot, crawl_gait, servo_map, commands(robot, crawl_gait, servo_map))


def test_a_servo_too_weak_for_the_walk_is_named_with_its_share(robot, limbs_gait):
    quick = replace(limbs_gait, period=1.6)
    borne = loads(robot, quick)
    check_loads(robot, quick, borne)
    assert overloaded(borne) == []
    assert 0.2 < borne["LH_pitch"].torque < robot.hind_leg.servo.torque
    weak = crocodile(
        replace(robot.tables, hind_leg=replace(robot.tables.hind_leg, servo=replace(robot.hind_leg.servo, torque=0.5)))
    )
    borne = loads(weak, quick)
    load = borne["LH_pitch"]
    assert load.torque == pytest.approx(0.5)
    assert load.at_limit > 0.02
    assert load.off > 0.02
    assert load.needed > 0.5
    (said,) = [sentence for sentence in overloaded(borne) if sentence.startswith("LH_pitch")]
    assert f"torque limit of 0.5 N m for {100 * load.at_limit:.0f} % of the walk" in said
    assert said.endswith("none of the servos that suchus knows would do.")  # nobody has looked for one
    with pytest.raises(OutsideLimits, match=r"cannot follow gait .*LH_pitch is at its torque limit of 0\.5 N m"):
        check_loads(weak, quick, borne, tracking=0.01)


def load(**changes):
    return ServoLoad(
        **({"torque": 3.0, "limit": 3.0, "at_limit": 0.1, "first": 0.4, "off": 0.2, "needed": 3.2} | changes)
    )


def test_other_servos_are_put_in_their_places_in_an_equal_robot_too(robot):
    again = crocodile(copy.deepcopy(robot.tables))
    other = Servo.from_motor(motor("XM540-W270"), template=robot.servo("spine_yaw_1"))
    for one in (robot, again, copy.deepcopy(robot)):
        made = with_named_servos(one, {"spine_yaw_1": other, "RH_knee": other, "tail_cable": other})
        changed = {name for name in servo_names() if made.servo(name) != one.servo(name)}
        assert changed == {"spine_yaw_1", "LH_knee", "RH_knee", "tail_cable"}
        assert made.servo("LH_knee") == other
    stronger = replace(other, torque=other.torque + 1.0)
    assert with_named_servos(robot, {"LF_yaw": other, "RF_yaw": stronger}).servo("LF_yaw") == stronger
    cranked = ROBOTS["salamandra"]
    made = with_named_servos(cranked, {"LF_crank": other})
    assert made.servo("RF_crank") == other
    assert with_named_servos(cranked, {}) == cranked


def test_the_sentence_on_a_servo_at_its_limit_names_one_that_would_do_or_says_that_none_does():
    (one,) = overloaded({"LF_yaw": load(other="STS3250", other_torque=4.903)})
    assert one.endswith("; STS3250 (4.9 N m) would do.")
    (none,) = overloaded({"LF_yaw": load(needed=99.0)})
    assert none.endswith("; none of the servos that suchus knows would do.")


def test_the_allowed_share_and_the_allowed_error_are_thresholds(robot, crawl_gait):
    borne = {"LF_yaw": load()}
    check_loads(robot, crawl_gait, borne, 0.1, 0.1)
    check_loads(robot, crawl_gait, borne, 0.09, 0.2)
    with pytest.raises(OutsideLimits, match="10 % of the walk"):
        check_loads(robot, crawl_gait, borne, 0.09, 0.19)
    assert overloaded(borne, 0.1) == []
    assert len(overloaded(borne, 0.09)) == 1


def test_the_share_at_the_limit_counts_samples_of_each_servo(robot):
    use = np.zeros((2, 4, 19))
    use[0, 1, 0] = use[1, :3, 18] = 1.0
    use[1, 3, 18] = 0.5
    coords = {"servo": list(servo_names()), "time": 0.01 * np.arange(4)}
    record = xr.Dataset({"servo_torque_use": (("run", "time", "servo"), use)}, coords=coords)
    share = share_at_limit(robot, record)
    assert share.sizes == {"run": 2, "servo": 19}
    assert share.sel(run=0, servo="LF_yaw") == 0.25
    assert share.sel(run=1, servo="tail_cable") == 0.75
    assert float(share.sum()) == 1.0


def test_nineteen_servos_hang_on_two_boards_of_sixteen_channels():
    places = [(line.board, line.channel) for line in STRAIGHT.servos]
    assert places == [(0, i) for i in range(16)] + [(1, i) for i in range(3)]
    assert replace(STRAIGHT.servos[0], board=1).board == 1
    with pytest.raises(InvalidDesign, match="LF_yaw, spine_yaw_3 on channel 0 of board 0"):
        remapped(spine_yaw_3={"board": 0, "channel": 0})


def test_a_map_reads_back_equal_from_a_file_with_a_line_for_each_servo(tmp_path):
    servo_map = remapped(RF_yaw={"direction": -1, "offset": 1 / 3})
    path = write_map(servo_map, tmp_path / "map.toml")
    assert read_map(path, ROBOTS["caiman"]) == servo_map
    assert sum(line.startswith("  {name") for line in path.read_text().splitlines()) == 19


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (('name = "LF_yaw"', 'name = "LF_yam"'), r"lacks LF_yaw; it has unknown LF_yam"),
        (("channel = 3,", "channel = 4,"), r"RF_yaw, RF_pitch on channel 4 of board 0"),
        (("channel = 3, direction = 1", "channel = 3, direction = 2"), r"direction is 2; 1 or -1"),
        (("pulse_min = 500.0", "pulse_min = 2600.0"), r"must increase"),
        (("rate = 50.0", "rate = 0.0"), r"rate is 0"),
        (("offset = 0.0", 'offset = "much"'), r"a number is needed"),
    ],
)
def test_mistakes_in_a_map_are_named(change, said, tmp_path):
    path = write_map(STRAIGHT, tmp_path / "map.toml")
    path.write_text(path.read_text().replace(*change, 1))
    with pytest.raises((MistakenFile, InvalidDesign), match=said):
        read_map(path, ROBOTS["caiman"])


def test_the_table_holds_what_is_commanded(robot, crawl_gait):
    told = commands(robot, crawl_gait, STRAIGHT)
    rows = list(csv.DictReader(io.StringIO(csv_text(told))))
    assert len(rows) == len(told.time)
    assert float(rows[7]["time_s"]) == pytest.approx(told.time[7])
    for i, name in enumerate(servo_names()):
        assert float(rows[7][f"{name}_rad"]) == pytest.approx(told.angles[7, i], abs=1e-6)
        assert float(rows[7][f"{name}_us"]) == pytest.approx(told.pulses[7, i], abs=0.06)


def test_the_trajectory_has_the_fields_of_the_ros_message_and_the_joints_of_the_urdf(robot, crawl_gait):
    told = commands(robot, crawl_gait, STRAIGHT)
    text = trajectory_text(robot, told)
    assert text.startswith("header:\n  stamp: {sec: 0, nanosec: 0}\n  frame_id: ''\njoint_names: [LF_yaw, ")
    names = re.search(r"joint_names: \[(.*)\]", text).group(1).split(", ")
    hinges = {joint.get("name") for joint in ElementTree.fromstring(urdf(robot)).iter("joint")}
    assert set(names) <= hinges
    assert set(names) >= {*servo_names()[:-1], *cable_joints(robot)}
    times = [int(s) + 1e-9 * int(n) for s, n in re.findall(r"time_from_start: \{sec: (\d+), nanosec: (\d+)\}", text)]
    assert times == pytest.approx(told.time.tolist(), abs=1e-9)
    assert (np.diff(times) > 0).all()
    places, speeds = (
        np.array([[float(v) for v in row.split(",")] for row in re.findall(rf"{word}: \[(.*)\]", text)])
        for word in ("positions", "velocities")
    )
    np.testing.assert_allclose(places[:, :18], told.angles[:, :18], atol=1e-9)
    np.testing.assert_allclose(speeds[:, :18], told.speeds[:, :18], atol=1e-9)
    bend = places[:, 18:].sum(axis=1)
    np.testing.assert_allclose(bend.max(), crawl_gait.number("tail_bend"), rtol=1e-3)
    np.testing.assert_allclose(servo_angle(robot.tail, bend), told.angles[:, 18], atol=1e-8)
    np.testing.assert_allclose(places[:, 18:], places[:, 18:19].repeat(robot.tail.joints, axis=1), atol=1e-12)
    slope = (bend[2:] - bend[:-2]) / (told.time[2:] - told.time[:-2])
    np.testing.assert_allclose(speeds[1:-1, 18:].sum(axis=1), slope, atol=2e-7)  # places are written to 1e-9 rad
    np.testing.assert_allclose(speeds[0], speeds[-1], atol=1e-9)
    yaml = pytest.importorskip("yaml", reason="PyYAML is not installed; the text was read by hand above")
    message = yaml.safe_load(text)
    assert set(message) == {"header", "joint_names", "points"}
    assert message["joint_names"] == names
    keys = {"positions", "velocities", "accelerations", "effort", "time_from_start"}
    assert all(set(point) == keys for point in message["points"])


@pytest.mark.parametrize("name", ["strider", "salamander", "salamandra"])
def test_any_robot_gets_its_commands_and_they_can_be_repeated(name):
    body = ROBOTS[name]
    gait, servos = default_gait(body), layout(body).servos
    told = commands(body, gait, straight(body), cycles=2)
    assert told.servos == servos
    assert told.angles.shape == told.pulses.shape == (len(told.time), len(servos))
    rows = told.angles[[0, len(told.time) // 2, -1]]
    cranks = np.array([name.endswith("crank") for name in servos])
    assert rows[2][~cranks] == pytest.approx(rows[0][~cranks], abs=1e-9)
    assert np.diff(rows, axis=0)[:, cranks] == pytest.approx(-2 * pi)  # a crank goes on
    rates = np.gradient(told.angles, told.time, axis=0)[2:-2]
    assert told.speeds[2:-2] == pytest.approx(rates, abs=0.05 * abs(rates).max())
    assert csv_text(told).splitlines()[0].startswith(f"time_s,{servos[0]}_rad")
    assert f"joint_names: [{servos[0]}" in trajectory_text(body, told)


def test_a_map_for_another_robot_is_refused():
    with pytest.raises(InvalidDesign, match=r"lacks LF_elbow, RF_elbow, LM_yaw.*robot 'strider'"):
        commands(ROBOTS["strider"], default_gait(ROBOTS["strider"]), STRAIGHT)

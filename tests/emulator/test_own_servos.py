"""An emulated robot has the servos of its own file, on the buses that they speak."""

from collections import Counter

import pytest

from suchus.apps.cli import main
from suchus.apps.cli.emulate import servo_models
from suchus.hardware import read_wiring
from suchus.hardware.bus import BusPlace, own_models, straight
from suchus.robot.design import Servo, layout
from suchus.robot.design.servos import with_named_servos, with_servos
from suchus.robot.motors import motor
from suchus.robot.robots import ROBOTS

CAIMAN = ROBOTS["caiman"]


def with_motor(robot, name):
    return with_servos(robot, lambda servo: Servo.from_motor(motor(name), template=servo))


def test_the_caiman_is_emulated_with_the_servos_that_its_file_names(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["emulate", "caiman", "--seconds", "0.02"]) == 0
    assert "the servos of caiman, 19 STS3250 (feetech), wired as hardware.toml says" in capsys.readouterr().out
    made = read_wiring(tmp_path / "hardware.toml", CAIMAN)
    assert {servo.model for servo in made.servo} == {"STS3250"}
    assert [bus.protocol for bus in made.bus] == ["feetech"]
    monkeypatch.chdir(tmp_path)
    assert main(["emulate", "caiman", "--protocol", "dynamixel", "--hardware", "x.toml", "--seconds", "0.02"]) == 0
    assert {servo.model for servo in read_wiring(tmp_path / "x.toml", CAIMAN).servo} == {"XM430-W350"}


@pytest.mark.parametrize("name", ["XW540-T260", "XL430-W250", "STS3215-12V", "STS3250"])
def test_own_servos_are_taken_and_another_protocol_takes_its_default(name):
    robot = with_motor(CAIMAN, name)
    assert set(own_models(robot).values()) == {name}
    assert set(servo_models(robot, None).values()) == {name}
    other = "feetech" if motor(name).protocol == "dynamixel" else "dynamixel"
    assert name not in servo_models(robot, other).values()
    assert set(servo_models(robot, motor(name).protocol).values()) == {name}


def test_servos_of_two_protocols_hang_on_two_buses():
    legs = Servo.from_motor(motor("XM430-W350"))
    robot = with_named_servos(CAIMAN, {name: legs for name in layout(CAIMAN).servos if name[:2] in ("LF", "LH")})
    models = servo_models(robot, None)
    assert Counter(models.values()) == {"XM430-W350": 12, "STS3250": 7}
    places = [BusPlace(port="a", protocol="dynamixel"), BusPlace(port="b", protocol="feetech")]
    made = straight(robot, places, models)
    assert {(servo.bus, servo.model) for servo in made.servo} == {(0, "XM430-W350"), (1, "STS3250")}
    for number in (0, 1):
        ids = [servo.id for servo in made.servo if servo.bus == number]
        assert ids == list(range(1, len(ids) + 1))


def test_a_robot_whose_file_names_no_servos_takes_the_default():
    robot = with_servos(CAIMAN, lambda servo: Servo.from_motor(motor("DS3225"), template=servo))
    assert set(servo_models(robot, None).values()) <= {"DS3225", "XM430-W350"}

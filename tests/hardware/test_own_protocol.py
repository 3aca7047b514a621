"""A servo protocol of one's own, one file in a project folder: found, wired, emulated, driven; or refused."""

import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from tests.hardware.test_drive import GAIT, REST, ROBOT
from tests.wires import Obedient

import suchus
from pages.blocks import blocks
from suchus.apps.cli import main
from suchus.core import sources
from suchus.core.errors import AmbiguousName, BrokenFile, InvalidDesign, SuchusError
from suchus.hardware import BusClock, DriveSettings, Rig, drive, read_wiring, write_wiring
from suchus.hardware.bus import Bus, BusPlace, Instruction, Packet, straight
from suchus.hardware.calibrate import find_zeros
from suchus.hardware.emulator import Emulator, MemoryPort
from suchus.hardware.protocols import PROTOCOLS, bus_protocol, bus_protocols, servo_tables
from suchus.robot.blueprint import read_motors, write
from suchus.robot.design import Servo, with_servos
from suchus.robot.motion import intended

PAGE = Path(__file__).parents[2] / "docs" / "extending.md"
COBS = next(block.text for block in blocks(PAGE.read_text(encoding="utf-8")) if block.title == "protocols/cobs.py")
MODULE = "suchus.hardware.protocols.cobs"


@pytest.fixture
def lab(tmp_path, monkeypatch):
    """A project with the protocol of the page, and a robot of its servos."""
    monkeypatch.delenv(sources.VARIABLE, raising=False)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "protocols").mkdir()
    (tmp_path / "robots").mkdir()
    (tmp_path / "suchus.toml").write_text("")
    (tmp_path / "protocols/cobs.py").write_text(COBS)
    suchus.project(tmp_path)
    (motor,) = PROTOCOLS["cobs"].motors
    robot = with_servos(ROBOT, lambda servo: Servo.from_motor(motor, template=servo))
    write(replace(robot, name="lab_caiman"), tmp_path / "robots/lab_caiman.toml")
    yield tmp_path
    os.environ.pop(sources.VARIABLE, None)
    sys.modules.pop(MODULE, None)


def rewritten(lab, *changes):
    """Rewrite the protocol's file, and forget its module."""
    text = COBS
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (lab / "protocols/cobs.py").write_text(text)
    shutil.rmtree(lab / "protocols/__pycache__", ignore_errors=True)  # else a change of the same second is not seen
    sys.modules.pop(MODULE, None)


@pytest.mark.parametrize(
    ("data", "frame"),
    [  # S. Cheshire, M. Baker, "Consistent overhead byte stuffing", and the examples that are made of it everywhere
        ("00", "01 01"),
        ("00 00", "01 01 01"),
        ("11 22 00 33", "03 11 22 02 33"),
        ("11 22 33 44", "05 11 22 33 44"),
        ("11 00 00 00", "02 11 01 01 01"),
        (bytes(range(1, 255)).hex(), (b"\xff" + bytes(range(1, 255))).hex()),
        ((bytes(range(2, 256)) + b"\0").hex(), (b"\xff" + bytes(range(2, 256)) + b"\x01\x01").hex()),
    ],
)
def test_the_frames_of_the_page_are_those_of_cobs(lab, data, frame):
    module = sys.modules[type(PROTOCOLS["cobs"]).__module__]
    assert module.stuffed(bytes.fromhex(data)) == bytes.fromhex(frame)
    assert module.unstuffed(bytes.fromhex(frame)) == bytes.fromhex(data)


def test_one_file_is_a_protocol_with_packets_servos_and_an_emulated_robot(lab):
    assert type(PROTOCOLS["cobs"]).__module__ == MODULE
    robot = suchus.ROBOTS["lab_caiman"]
    assert robot.servo("LF_yaw").winding.motor == "LAB-1"
    table = servo_tables()["LAB-1"]
    wiring = straight(robot, [BusPlace(port="memory", protocol="cobs")], "LAB-1", boards=True)
    assert {servo.zero for servo in wiring.servo} == {8192}
    path = write_wiring(wiring, lab / "hardware.toml")
    assert "times the model's step: 0.000383495197 rad for LAB-1" in path.read_text(encoding="utf-8")
    assert replace(read_wiring(path, robot), bus=wiring.bus) == wiring
    body = Obedient(robot)
    body.angles[:] = body.goals[:] = REST
    emulator = Emulator(wiring, body, has_clock=True)
    bus = Bus(MemoryPort(emulator), bus_protocol("cobs"), has_clock=True)
    assert bus.read(1, table["model_number"]) == 1
    assert bus.ask(bus.protocol.write(1, 99, b"\0"), 1).code == 7
    emulator.servos[0].fail("overheated")
    assert bus.ping(1) == Packet(1, 0x80)
    bus.ask(bus.protocol.reboot(1), 1)
    assert bus.ping(1) == Packet(1, 0)
    rig = Rig(robot, wiring, [MemoryPort(emulator)], has_clock=True)
    log = drive(rig, GAIT, settings=DriveSettings(duration=0.2), clock=BusClock(rig))
    expected = intended(robot, GAIT, log.time.values).targets
    moving = log.time.values >= 0.0
    half_step = np.pi / 16384
    assert np.abs(log.servo_target.values - expected)[moving].max() <= half_step + 1e-12
    assert np.abs(log.servo_target.values - expected)[moving].max() > 0.9 * half_step
    assert log.servo_heard.values.all()
    assert not body.powered.any()


def test_zeros_are_found_in_steps_of_its_encoder(lab):
    robot = suchus.ROBOTS["lab_caiman"]
    wiring = straight(robot, [BusPlace(port="memory", protocol="cobs")], "LAB-1")
    built = replace(wiring, servo=tuple(replace(servo, zero=servo.zero + 100) for servo in wiring.servo))
    rig = Rig(robot, wiring, [MemoryPort(Emulator(built, Obedient(robot), has_clock=True))], has_clock=True)
    zeroed, errors = find_zeros(rig, np.zeros(len(rig.servos)))
    assert {servo.zero for servo in zeroed.servo} == {8292}
    assert errors == pytest.approx(np.full(len(rig.servos), 100 * 2 * np.pi / 16384))


def test_the_commands_emulate_and_drive_it_by_its_name(lab, capsys):
    assert main(["list"]) == 0
    assert "for gear motors with an encoder of 14 bits. [protocols/cobs.py]" in " ".join(
        capsys.readouterr().out.split()
    )
    assert main(["emulate", "lab_caiman", "--protocol", "cobs", "--socket", "--seconds", "0.02"]) == 0
    assert 'protocol = "cobs"' in (lab / "hardware.toml").read_text(encoding="utf-8")
    capsys.readouterr()
    assert main(["drive", "belly_crawl", "--robot", "lab_caiman", "--dry-run", "--seconds", "0.03"]) == 0
    lines = capsys.readouterr().out.splitlines()
    sent = bytes.fromhex(lines[lines.index("write goal_position, 19 of LF_yaw, LF_pitch, LF_knee ...") + 1])
    (packet,) = PROTOCOLS["cobs"].requests().feed(sent)
    assert (packet.code, packet.data[:4]) == (Instruction.SYNC_WRITE, bytes([16, 0, 2, 0]))
    with xr.open_dataset(lab / "out/drive_belly_crawl/record.nc") as record:
        goal = record.servo_target.sel(servo="LF_yaw").values[0]
        assert packet.data[5:7] == round(8192 + goal / (2 * np.pi / 16384)).to_bytes(2, "little")


def test_a_motor_of_a_file_names_it_and_an_unknown_one_is_refused_with_all_names(lab):
    file = lab / "motors.toml"
    numbers = (
        'maker = "me"\nfamily = "LAB"\nmodel_number = 0\nvolts = 6.0\nvolts_range = [5.0, 7.0]\nstall_torque = 1.0\n'
        "no_load_speed = 6.0\nstall_current = 2.0\nidle_current = 0.1\ncontinuous_torque = 0.3\nplay = 0.01\n"
        "temperature_limit = 70.0\nsteps = 1000\nturn = 3.0\nmass = 0.05\nsize = [0.04, 0.02, 0.04]\n"
        "price = [9.0, 10.0]\n"
    )
    file.write_text(f'[mine]\nprotocol = "cobs"\n{numbers}')
    assert read_motors(file)["mine"].protocol == "cobs"
    names = "cobs, dynamixel, dynamixel1, feetech, line, pca9685, pwm is allowed"
    file.write_text(f'[mine]\nprotocol = "cobbs"\n{numbers}')
    with pytest.raises(SuchusError, match=rf"mine\.protocol is 'cobbs'; {names}"):
        read_motors(file)
    with pytest.raises(InvalidDesign, match=rf"bus\.protocol is 'can'; {names}"):
        BusPlace(port="x", protocol="can")
    suchus.project(None)
    file.write_text(f'[mine]\nprotocol = "cobs"\n{numbers}')
    with pytest.raises(SuchusError, match=r"mine\.protocol is 'cobs'; dynamixel, "):
        read_motors(file)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ([("word = 2", "word = ")], r"^protocols/cobs.py, line \d+, cannot be loaded: SyntaxError"),
        (
            [("    def reply(self, packet)", "    def answer(self, packet)")],
            r"^protocols/cobs.py, line \d+, cannot be loaded: TypeError: .* abstract .*reply",
        ),
        ([('protocol="cobs", model', 'protocol="cob", model')], r"LAB-1\.protocol is 'cob'; cobs, dynamixel, "),
        (
            [('                Register(name="torque_enable", address=12, size=1, writable=True, span=(0, 1)),\n', "")],
            r"^protocols/cobs.py cannot be used: the register table of LAB-1 .* it has no torque_enable, which a drive",
        ),
        ([("address=14", "address=13")], "torque_limit begins before bus_watchdog ends"),
        ([('felt=("present_position"', 'felt=("present_velocity"')], "read at every tick, holds no present_position"),
        (
            [('default_model = "LAB-1"', 'default_model = "LAB-2"')],
            "default model 'LAB-2', of which it has no .* LAB-1",
        ),
        (
            [("step, cold, hot = 2 * pi", "step, cold, hot = pie")],
            "cannot be used: NameError: name 'pie' is not defined",
        ),
    ],
)
def test_a_damaged_protocol_is_refused_in_a_sentence_and_the_rest_works(lab, changes, message, capsys):
    rewritten(lab, *changes)
    with pytest.raises(BrokenFile, match=message) as caught:
        bus_protocol("cobs")
    assert "\n" not in str(caught.value)
    assert main(["emulate", "lab_caiman", "--protocol", "cobs", "--socket", "--seconds", "0.02"]) == 2
    assert capsys.readouterr().err == f"suchus: {caught.value}\n"
    assert not (lab / "hardware.toml").exists()
    assert list(bus_protocols()) == ["dynamixel", "feetech", "line"]
    assert "LAB-1" not in servo_tables()
    assert straight(ROBOT, [BusPlace(port="x")], "XM430-W350").servo[0].table.model == "XM430-W350"


def test_the_design_of_a_motor_reads_names_of_protocols_and_imports_none():
    code = (
        "import sys\nfrom suchus.robot.motors import motors\n"
        "print(len(motors()) > 10, [name for name in sys.modules if name.startswith('suchus.hardware')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "True []\n"


def test_names_and_models_stand_once(lab, capsys):
    (lab / "protocols/other.py").write_text(COBS)
    with pytest.raises(InvalidDesign, match=r"protocols/other.py declares the protocol 'cobs', .* 'other'"):
        PROTOCOLS["other"]
    sys.modules.pop("suchus.hardware.protocols.other")
    (lab / "protocols/other.py").write_text(COBS.replace('"cobs"', '"other"'))
    with pytest.raises(InvalidDesign, match=r"'cobs' and 'other' both have a .* of the model 'LAB-1'; give"):
        servo_tables()
    sys.modules.pop("suchus.hardware.protocols.other")
    (lab / "protocols/other.py").unlink()
    (lab / "protocols/feetech.py").write_text(COBS.replace('"cobs"', '"feetech"'))
    with pytest.raises(AmbiguousName, match="two modules named 'feetech'"):
        list(PROTOCOLS)
    assert main(["list"]) == 2
    assert "give one of them another name" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("cobbs", "there is no protocol named 'cobbs'; there is cobs, dynamixel, .* Did you mean 'cobs'?"),
        ("pwm", "no bus speaks the protocol 'pwm', which has no packets; buses speak cobs, dynamixel, feetech, line."),
    ],
)
def test_a_protocol_that_no_bus_speaks_is_refused_and_nothing_written(lab, name, message, capsys):
    assert main(["emulate", "lab_caiman", "--protocol", name, "--hardware", "other.toml"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert re.search(message, line)
    assert not (lab / "other.toml").exists()

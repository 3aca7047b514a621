"""Hobby servos on PCA9685 boards: bytes as the data sheet has them, and a robot that tells nothing."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.core.errors import BusFailure, InvalidDesign, UnsuitedRobot
from suchus.experiments.catalog._driven import Driven
from suchus.hardware import BlindRig, DriveSettings, drive, fix_in_place, straight
from suchus.hardware.protocols.pca9685 import Pulses, open_wires
from suchus.robot.control import Coordinated
from suchus.robot.gaits import GAITS
from suchus.robot.motion import intended
from suchus.robot.robots import ROBOTS

ROBOT, GAIT = ROBOTS["caiman"], GAITS["belly_crawl"]


class Wires:
    """An I2C bus that keeps what is written."""

    def __init__(self):
        self.written, self.closed = [], False
        self.registers = {}

    def write_i2c_block_data(self, address, register, data):
        assert len(data) <= 32
        self.written.append((address, register, list(data)))
        self.registers.update({(address, register + i): byte for i, byte in enumerate(data)})

    def close(self):
        self.closed = True


class Instant:
    """A clock on which every tick comes at once."""

    def begin(self):
        pass

    def wait(self, tick):
        return tick

    def late(self, tick):
        return 0.0


def blind():
    wires = Wires()
    made = straight(ROBOT)
    return wires, BlindRig(ROBOT, made, Pulses(wires, (0, 1), made.rate))


def test_boards_are_set_up_and_channels_written_as_the_data_sheet_says():
    wires = Wires()
    pulses = Pulses(wires, (0,), 50.0)
    assert wires.written == [(0x40, 0x00, [0x30]), (0x40, 0xFE, [121]), (0x40, 0x00, [0x20])]
    wires.written.clear()
    pulses.send({(0, 0): 1500.0, (0, 2): 1000.0, (0, 15): 2500.0})
    assert wires.written == [
        (0x40, 0x06, [0, 0, 0x33, 0x01, 0, 0, 0, 0x10, 0, 0, 0xCD, 0x00]),  # 307 and 205 of 4096 steps of 20 ms
        (0x40, 0x06 + 60, [0, 0, 0x00, 0x02]),
    ]
    pulses.off()
    assert wires.written[-1] == (0x40, 0xFD, [0x10])


def test_rates_and_boards_that_are_not_there_are_refused(tmp_path):
    with pytest.raises(InvalidDesign, match="24 to 1526 Hz"):
        Pulses(Wires(), (0,), 10.0)

    class Broken(Wires):
        def write_i2c_block_data(self, address, register, data):
            raise OSError(121, "Remote I/O error")

    with pytest.raises(BusFailure, match="board 1 at address 0x41 does not answer"):
        Pulses(Broken(), (1,), 50.0)
    pytest.importorskip("smbus2", reason="the extra hardware is not installed")
    with pytest.raises(BusFailure, match="there is no I2C bus"):
        open_wires(str(tmp_path / "i2c-7"))


def test_it_is_driven_blind_and_switched_off_in_the_end():
    wires, rig = blind()
    said = []
    log = drive(rig, GAIT, settings=DriveSettings(duration=0.2), clock=Instant(), say=said.append)
    wanted = intended(ROBOT, GAIT, log.time.values).targets
    step = 1e6 / 50.0 / 4096 / 424.413
    assert np.abs(log.servo_target.values - wanted).max() <= step / 2 + 1e-12
    assert np.isnan(log.servo_angle).all()
    assert not log.servo_heard.any()
    assert "tell nothing" in said[0]
    assert wires.written[-1][1] == 0xFD
    outcome = Driven(robot=ROBOT, gait=GAIT).tell(log, 0.0)
    assert "they tell nothing of it" in outcome.decides
    assert np.isfinite(fix_in_place(log, ROBOT).position).all()
    rig.close()
    assert wires.closed


def test_a_rule_that_must_sense_is_refused():
    with pytest.raises(UnsuitedRobot, match="must sense servo position and servo torque and foot pressure"):
        drive(blind()[1], GAIT, Coordinated(), clock=Instant())


def test_pulses_beyond_the_map_are_refused():
    made = straight(ROBOT)
    narrow = replace(made, servos=(replace(made.servos[0], pulse_min=1450.0, pulse_max=1550.0), *made.servos[1:]))
    with pytest.raises(ValueError, match="turns LF_yaw from"):
        drive(BlindRig(ROBOT, narrow, Pulses(Wires(), (0, 1), 50.0)), GAIT, clock=Instant())

"""Registers of an emulated servo mean what its maker says, and what the emulator does not know is said."""

import numpy as np
import pytest
from tests.wires import Obedient, emulated, wiring

from suchus.core.errors import BusFailure
from suchus.hardware.bus import Instruction, Packet
from suchus.hardware.emulator import Emulator
from suchus.hardware.protocols import PROTOCOLS

STEP = 2 * np.pi / 4096


def write(emulator, bus, servo, **values):
    for name, value in values.items():
        bus.write(servo, emulator.servos[servo - 1].table[name], value)


def path(emulator, bus, servo, ticks):
    start = emulator.body.tick
    angles = []
    for tick in range(start + 1, start + 1 + ticks):
        bus.pass_until(tick)
        angles.append(emulator.body.angles[servo - 1])
    return np.array(angles)


@pytest.mark.parametrize(
    ("protocol", "profile", "speed", "acceleration"),
    [
        ("dynamixel", {"profile_velocity": 50}, 50 * 0.229 * 2 * np.pi / 60, np.inf),
        ("dynamixel", {"profile_velocity": 50, "profile_acceleration": 10}, 50 * 0.229 * 2 * np.pi / 60,
         10 * 214.577 * 2 * np.pi / 3600),
        ("feetech", {"goal_velocity": 1000}, 1000 * STEP, np.inf),
        ("feetech", {"goal_velocity": 1000, "acceleration": 50}, 1000 * STEP, 5000 * STEP),
    ],
)  # fmt: skip
def test_a_profile_limits_speed_and_acceleration_and_ends_at_the_goal(protocol, profile, speed, acceleration):
    emulator, bus = emulated(protocol)
    write(emulator, bus, 3, **profile, torque_enable=1, goal_position=2448)
    angles = path(emulator, bus, 3, 200)
    speeds = np.diff(angles, prepend=0.0) / 0.01
    assert speeds.max() == pytest.approx(speed, rel=0.02)
    assert np.abs(np.diff(speeds)).max() <= (acceleration if np.isfinite(acceleration) else speed / 0.01) * 0.01 * 1.3
    assert angles[-1] == pytest.approx(400 * STEP, abs=1e-9)
    assert angles.max() <= 400 * STEP + 1e-9
    if not np.isfinite(acceleration):
        assert speeds[0] == pytest.approx(speed, rel=1e-6)
    else:
        assert speeds[0] == pytest.approx(acceleration * 0.01, rel=1e-6)


def test_without_a_profile_a_goal_acts_at_once():
    emulator, bus = emulated()
    write(emulator, bus, 3, torque_enable=1, goal_position=2448)
    assert path(emulator, bus, 3, 1)[0] == pytest.approx(400 * STEP)


@pytest.mark.parametrize(("protocol", "unit"), [("dynamixel", 0.229 * 2 * np.pi / 60), ("feetech", STEP)])
def test_in_the_mode_for_speeds_a_servo_turns_at_its_speed(protocol, unit):
    emulator, bus = emulated(protocol)
    if protocol == "feetech":
        write(emulator, bus, 3, lock=0)
    write(emulator, bus, 3, operating_mode=1, torque_enable=1, goal_velocity=-40)
    angles = path(emulator, bus, 3, 10)
    np.testing.assert_allclose(np.diff(angles), -40 * unit * 0.01, rtol=1e-6)


def test_a_mode_that_is_not_simulated_leaves_the_joint_limp_and_is_said():
    sentences = []
    emulator, bus = spoken(sentences)
    write(emulator, bus, 1, operating_mode=0, torque_enable=1)
    bus.pass_until(1)
    assert emulator.body.powered[0] == 0.0
    assert "number 1 is in operating mode 0, control of current, which is not simulated" in sentences[-1]
    with pytest.raises(BusFailure, match="operating_mode = 7"):
        write(emulator, bus, 2, operating_mode=7)


def spoken(sentences, protocol="dynamixel"):
    emulator, bus = emulated(protocol)
    emulator._say = sentences.append
    return emulator, bus


@pytest.mark.parametrize(("protocol", "address", "name"), [
    ("dynamixel", 170, "indirect_address, which is not emulated"), ("dynamixel", 300, "where it has no register"),
    ("feetech", 81, "factory parameters, which is not emulated"),
])  # fmt: skip
def test_an_unknown_register_is_said_once_with_its_name_or_address(protocol, address, name):
    sentences = []
    emulator, bus = spoken(sentences, protocol)
    for _ in range(2):
        bus.ask(bus.protocol.read(1, address, 2), 1)
        bus.ask(bus.protocol.write(1, address, b"\1\2"), 1)
    assert len(sentences) == 1
    assert (
        f"number 1, a {emulator.servos[0].table.model}, was asked for 2 bytes at address {address}, {name}"
        in (sentences[0])
    )
    bus.read(1, emulator.servos[0].table["present_position"])
    assert len(sentences) == 1


def test_a_register_without_an_effect_is_kept_and_said():
    sentences = []
    emulator, bus = spoken(sentences)
    write(emulator, bus, 4, position_p_gain=800)  # as it comes from the maker
    assert not sentences
    write(emulator, bus, 4, position_p_gain=400)
    assert bus.read(4, emulator.servos[3].table["position_p_gain"]) == 400
    assert "keeps position_p_gain = 400 (address 84)" in sentences[0]


def test_limits_of_speed_voltage_and_current_bind_the_goals():
    emulator, bus = emulated()
    write(emulator, bus, 1, velocity_limit=100, voltage_limit=400, current_limit=300)
    for name, limit in (("goal_velocity", 100), ("torque_limit", 400), ("goal_current", 300)):
        write(emulator, bus, 1, **{name: limit})
        with pytest.raises(BusFailure, match="outside the limits"):
            write(emulator, bus, 1, **{name: -limit - 1})


def test_the_homing_offset_turns_goals_too_and_a_large_one_acts_beyond_a_turn_only():
    emulator, bus = emulated()
    position = emulator.servos[0].table["present_position"]
    write(emulator, bus, 1, homing_offset=-500, torque_enable=1, goal_position=2048)
    bus.pass_until(1)
    assert emulator.body.angles[0] == pytest.approx(500 * STEP)
    assert bus.read(1, position) == 2048
    write(emulator, bus, 2, homing_offset=3000)
    assert bus.read(2, position) == 2048
    write(emulator, bus, 2, operating_mode=4)
    assert bus.read(2, position) == 5048


def test_the_status_level_silences_writes_and_the_shutdown_mask_decides_what_an_alert_does():
    emulator, bus = emulated()
    table = emulator.servos[0].table
    write(emulator, bus, 2, shutdown=0, torque_enable=1)
    emulator.servos[1].fail("overheated")
    assert emulator.servos[1].share == 1.0
    write(emulator, bus, 3, torque_enable=1)
    emulator.servos[2].fail("overheated")
    assert emulator.servos[2].share == 0.0
    request = bus.protocol.write(1, table["status_level"].address, b"\1")
    assert emulator.hear(0, request) == []
    assert emulator.hear(0, bus.protocol.read(1, 132, 4)) != []
    assert emulator.hear(0, bus.protocol.ping(1)) != []


def test_a_number_that_another_servo_has_is_not_taken():
    sentences = []
    emulator, bus = spoken(sentences)
    write(emulator, bus, 5, id=6)
    assert bus.read(5, emulator.servos[4].table["id"]) == 5
    assert "number 5 was to become number 6, which another one has" in sentences[0]


def test_a_servo_that_was_given_another_rate_answers_at_that_rate_only():
    made = wiring()
    emulator = Emulator(made, Obedient(), has_clock=True)
    protocol = PROTOCOLS["dynamixel"]
    assert emulator.hear(0, protocol.write(1, 8, b"\4"), 1_000_000)
    assert not emulator.hear(0, protocol.ping(1), 1_000_000)
    assert emulator.hear(0, protocol.ping(1), 2_000_000)
    assert not emulator.hear(0, protocol.ping(2), 2_000_000)


def test_feetech_knows_no_bulk_read():
    emulator, bus = emulated("feetech")
    request = bus.protocol.request(Packet(254, Instruction.BULK_READ, bytes([1, 56, 2, 2, 56, 2])))
    assert emulator.hear(0, request) == []

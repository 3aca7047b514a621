"""What holds for every servo protocol on the shelf: packets through noise, register tables, an emulated drive."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.wires import Obedient

from suchus.core.errors import InvalidDesign
from suchus.hardware import BlindRig, BusClock, DriveSettings, Rig, drive, straight
from suchus.hardware.bus import BusPlace, BusProtocol, ChannelProtocol, Packet, Refusal
from suchus.hardware.bus import straight as straight_wiring
from suchus.hardware.emulator import Emulator, MemoryPort, Trouble
from suchus.hardware.protocols import PROTOCOLS, bus_protocol, bus_protocols, channel_protocol, servo_tables
from suchus.robot.gaits import GAITS
from suchus.robot.motion import intended
from suchus.robot.robots import ROBOTS

ROBOT, GAIT = ROBOTS["caiman"], GAITS["belly_crawl"]
REGISTERS = st.lists(st.integers(0, 2**16 - 1), min_size=1, max_size=4).map(
    lambda numbers: b"".join(number.to_bytes(2, "little") for number in numbers)
)
SERVOS = st.lists(st.integers(0, 249), min_size=2, max_size=6, unique=True)
ADDRESSES = st.integers(0, 100).map(lambda register: 2 * register)
NAMED = pytest.mark.parametrize("name", list(PROTOCOLS))


def spoken(name):
    """Return a protocol of packets; a test of it is skipped for any other."""
    protocol = PROTOCOLS[name]
    if not isinstance(protocol, BusProtocol):
        pytest.skip("it has no packets")
    return protocol


@st.composite
def requests(draw, protocol):
    """Draw the bytes of any request."""
    servo, address, row = draw(st.integers(0, 249)), draw(ADDRESSES), draw(REGISTERS)
    servos, length = draw(SERVOS), draw(ADDRESSES)
    return draw(
        st.sampled_from(
            [
                protocol.ping(servo),
                protocol.reboot(servo),
                protocol.read(servo, address, length),
                protocol.write(servo, address, row),
                protocol.sync_read(servos, address, length),
                protocol.sync_write(address, dict.fromkeys(servos, row)),
            ]
        )
    )


@st.composite
def replies(draw, protocol):
    """Draw a reply of any device."""
    code = protocol.reply_code(draw(st.sampled_from(Refusal)), draw(st.integers(0, 127)))
    return Packet(draw(st.integers(0, 249)), code, draw(REGISTERS))


@NAMED
def test_it_is_called_as_its_file_and_says_its_families(name):
    protocol = PROTOCOLS[name]
    assert protocol.name == name
    assert protocol.families
    assert all(isinstance(family, str) and family for family in protocol.families)
    assert isinstance(protocol, BusProtocol) == (name in bus_protocols())


@NAMED
@given(data=st.data(), portion=st.integers(1, 40))
def test_requests_and_replies_come_back_whatever_portions_they_arrive_in(name, data, portion):
    protocol = spoken(name)
    lines = data.draw(st.lists(requests(protocol), min_size=1, max_size=4))
    packets = [packet for line in lines for packet in protocol.requests().feed(line)]
    assert [protocol.request(packet) for packet in packets] == lines
    answers = data.draw(st.lists(replies(protocol), min_size=1, max_size=4))
    for wire, decoder, sent in (
        (b"".join(lines), protocol.requests(), packets),
        (b"".join(map(protocol.reply, answers)), protocol.replies(), answers),
    ):
        heard = [packet for i in range(0, len(wire), portion) for packet in decoder.feed(wire[i : i + portion])]
        assert heard == sent
        assert (decoder.dropped, decoder.broken) == (0, 0)


@NAMED
@given(data=st.data(), noise=st.binary(max_size=30), place=st.integers(0, 200), bit=st.integers(0, 7))
def test_noise_and_a_flipped_bit_make_no_packet_of_their_own(name, data, noise, place, bit):
    protocol = spoken(name)
    packet = data.draw(replies(protocol))
    heard = protocol.replies().feed(noise + 150 * protocol.reply(packet))
    assert heard[-1] == packet
    assert heard.count(packet) > 20
    spoilt = bytearray(protocol.reply(packet))
    spoilt[place % len(spoilt)] ^= 1 << bit
    assert all(other == packet for other in protocol.replies().feed(bytes(spoilt)))


@NAMED
def test_what_an_emulated_servo_answers_is_read_as_it_is_meant(name):
    protocol = spoken(name)
    for refusal in Refusal:
        for alerts in (0, 1, 0x24):
            code = protocol.reply_code(refusal, alerts)
            assert protocol.alert(code) == bool(alerts)
            assert not protocol.refusal(code) or refusal != Refusal.NONE
            assert isinstance(protocol.refusal(code), str)


@NAMED
def test_its_tables_hold_every_number_that_their_registers_take(name):
    protocol = spoken(name)
    tables = [table for table in servo_tables().values() if table.protocol == name]
    assert protocol.default_model in [table.model for table in tables]
    assert protocol.default_baud in protocol.bauds.values()
    for table in tables:
        assert table.motor.family.startswith(protocol.families)
        assert table.motor.protocol == (protocol.servo_protocol or name)
        assert table.bauds == protocol.bauds
        for register in table.registers:
            lowest, highest = register.span or (0, 1)
            for value in (lowest, highest, register.initial):
                data = register.encode(value)
                assert len(data) == register.size
                assert register.decode(data) == value, register


@NAMED
def test_an_emulated_robot_goes_where_its_gait_sends_it_and_ends_limp(name):
    protocol = spoken(name)
    place = BusPlace(port="memory", protocol=name, baud=protocol.default_baud)
    wiring = straight_wiring(ROBOT, [place], protocol.default_model, boards=True)
    start = intended(ROBOT, GAIT, np.zeros(1)).targets[0]
    for trouble in (Trouble(), Trouble(lost=0.02, corrupt=0.02, seed=1)):
        body = Obedient()
        body.angles[:] = body.goals[:] = start
        emulator = Emulator(wiring, body, trouble, has_clock=True)
        rig = Rig(ROBOT, wiring, [MemoryPort(emulator)], has_clock=True)
        log = drive(rig, GAIT, settings=DriveSettings(duration=0.2), clock=BusClock(rig))
        expected = intended(ROBOT, GAIT, log.time.values).targets
        moving = log.time.values >= 0.0
        step = servo_tables()[protocol.default_model].step
        assert np.abs(log.servo_target.values - expected)[moving].max() <= step / 2 + 1e-9
        heard = log.servo_heard.values[moving].astype(bool)
        assert heard.all() if trouble == Trouble() else heard.mean() > 0.8
        reported = log.servo_angle.values[moving][heard]
        assert np.ptp(reported) > 0.5
        assert np.abs(reported).max() < pi
        assert not body.powered.any()


@NAMED
def test_boards_of_channels_get_the_pulses_of_a_map(name):
    protocol = PROTOCOLS[name]
    if not isinstance(protocol, ChannelProtocol):
        pytest.skip("it has no channels")
    lines, servo_map = [], replace(straight(ROBOT), protocol=name)
    assert channel_protocol(servo_map.protocol) is protocol
    boards = sorted({line.board for line in servo_map.servos})
    rig = BlindRig(ROBOT, servo_map, protocol.open_printing(lines.append, boards, servo_map.rate))
    goals = intended(ROBOT, GAIT, np.zeros(1)).targets[0]
    assert np.abs(rig.aim(goals) - goals).max() <= rig.step / 2 + 1e-12
    assert lines
    rig.close()


@NAMED
def test_a_protocol_without_packets_is_refused_on_a_bus(name):
    if isinstance(PROTOCOLS[name], BusProtocol):
        assert bus_protocol(name) is PROTOCOLS[name]
        with pytest.raises(InvalidDesign, match=f"'{name}' is no protocol of boards that give pulses; there is "):
            channel_protocol(name)
    else:
        with pytest.raises(InvalidDesign, match=f"no bus speaks the protocol '{name}', which has no packets; buses "):
            BusPlace(port="memory", protocol=name)

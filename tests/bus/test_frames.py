"""Frames byte for byte as the makers print them, and decoders that survive what a wire does."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.bus import BROADCAST, FRAMINGS, Instruction, Packet
from suchus.bus.dynamixel import crc
from suchus.bus.feetech import checksum

DYNAMIXEL, FEETECH = FRAMINGS["dynamixel"], FRAMINGS["feetech"]
PACKETS = st.builds(
    Packet,
    st.integers(0, 252),
    st.sampled_from([i.value for i in Instruction]),
    st.lists(st.sampled_from([0xFF, 0xFD, 0x00, 0x55, 0x01, 0x80]), max_size=60).map(bytes),
)


def test_frames_are_those_of_the_protocol_manual_of_dynamixel():
    assert DYNAMIXEL.ping(1) == bytes.fromhex("FFFFFD0001030001194E")
    assert DYNAMIXEL.read(1, 132, 4) == bytes.fromhex("FFFFFD00010700028400040 01D15".replace(" ", ""))
    assert DYNAMIXEL.write(1, 116, (512).to_bytes(4, "little")) == bytes.fromhex(
        "FFFFFD000109000374000002 0000CA89".replace(" ", "")
    )
    assert DYNAMIXEL.reboot(1) == bytes.fromhex("FFFFFD0001030008 2F4E".replace(" ", ""))
    assert DYNAMIXEL.sync_read((1, 2), 132, 4) == bytes.fromhex("FFFFFD00FE090082840004000102CEFA")
    goals = {1: (150).to_bytes(4, "little"), 2: (170).to_bytes(4, "little")}
    assert DYNAMIXEL.sync_write(116, goals) == bytes.fromhex(
        "FFFFFD00FE110083740004000196000000 02AA00000082 87".replace(" ", "")
    )


def test_a_reply_is_read_as_the_manual_of_dynamixel_explains_it():
    data = bytes.fromhex("FFFFFD000108005500A600 00008CC0".replace(" ", ""))
    assert DYNAMIXEL.replies().feed(data) == [Packet(1, 0, (166).to_bytes(4, "little"))]


def test_frames_are_those_of_feetechs_manual():
    assert FEETECH.ping(1) == bytes.fromhex("FFFF010201FB")
    assert FEETECH.read(1, 0x38, 2) == bytes.fromhex("FFFF0104023802BE")
    assert FEETECH.replies().feed(bytes.fromhex("FFFF010400180 5DD".replace(" ", ""))) == [Packet(1, 0, b"\x18\x05")]


def test_the_checksum_of_dynamixel_is_a_crc_of_polynomial_8005():
    assert crc(b"") == 0
    assert crc(b"\x01") == 0x8005  # one bit is the polynomial itself
    a, b = b"\x12\x34\x56", b"\x9a\x00\xff"
    assert crc(a) ^ crc(b) == crc(bytes(x ^ y for x, y in zip(a, b, strict=True)))  # begun with 0, it is linear


def test_bytes_that_look_like_a_header_are_stuffed_before_the_crc():
    data = b"\xff\xff\xfd\x00\xff\xff\xfd"
    frame = DYNAMIXEL.request(Packet(1, Instruction.WRITE, data))
    assert frame[8:-2] == b"\xff\xff\xfd\xfd\x00\xff\xff\xfd\xfd"
    assert int.from_bytes(frame[5:7], "little") == len(frame) - 7  # the stuffing counts
    assert DYNAMIXEL.requests().feed(frame) == [Packet(1, Instruction.WRITE, data)]


def test_the_checksum_of_feetech_is_the_complement_of_the_sum():
    assert checksum(b"\x01\x02\x01") == 0xFB
    assert (sum(b"\x01\x02\x01") + checksum(b"\x01\x02\x01")) & 0xFF == 0xFF


@pytest.mark.parametrize("name", FRAMINGS)
@given(packets=st.lists(PACKETS, min_size=1, max_size=4), cut=st.integers(1, 40))
def test_packets_come_back_whatever_portions_they_arrive_in(name, packets, cut):
    framing = FRAMINGS[name]
    for encode, decoder in ((framing.request, framing.requests()), (framing.reply, framing.replies())):
        wire, found = b"".join(map(encode, packets)), []
        for i in range(0, len(wire), cut):
            found += decoder.feed(wire[i : i + cut])
        assert found == packets
        assert (decoder.dropped, decoder.broken) == (0, 0)


@pytest.mark.parametrize("name", FRAMINGS)
@given(noise=st.binary(max_size=30).filter(lambda b: not b.endswith(b"\xff")), packet=PACKETS)
def test_noise_before_a_packet_costs_no_more_than_itself(name, noise, packet):
    framing = FRAMINGS[name]
    decoder = framing.replies()
    # noise that looks like the head of a long packet swallows what follows until it is complete, not for ever
    found = decoder.feed(noise + 150 * framing.reply(packet))
    assert found[-1] == packet
    assert found.count(packet) > 20


@pytest.mark.parametrize("name", FRAMINGS)
@given(packet=PACKETS, place=st.integers(0, 200), bit=st.integers(0, 7))
def test_a_flipped_bit_gives_no_other_packet(name, packet, place, bit):
    framing = FRAMINGS[name]
    data = bytearray(framing.reply(packet))
    data[place % len(data)] ^= 1 << bit
    found = framing.replies().feed(bytes(data))
    assert all(p == packet for p in found)  # where the flip made the same packet appear again inside


@pytest.mark.parametrize("name", FRAMINGS)
def test_a_broken_frame_is_counted_and_the_next_is_read(name):
    framing = FRAMINGS[name]
    good, decoder = framing.reply(Packet(3, 0, b"\x11\x22")), framing.replies()
    bad = bytearray(good)
    bad[-1] ^= 1
    assert decoder.feed(bytes(bad) + good) == [Packet(3, 0, b"\x11\x22")]
    assert decoder.broken == 1
    assert decoder.dropped == len(bad)


def test_the_echo_of_a_request_is_no_reply():
    decoder = DYNAMIXEL.replies()
    assert decoder.feed(DYNAMIXEL.sync_read((1, 2), 132, 4)) == []
    assert decoder.broken == 0


def test_errors_of_replies_are_told_apart():
    assert DYNAMIXEL.alert(0x80)
    assert not DYNAMIXEL.alert(0x07)
    assert "torque" in DYNAMIXEL.refusal(0x87)
    assert DYNAMIXEL.refusal(0x80) == ""
    assert FEETECH.alert(0x20)
    assert not FEETECH.alert(0)


def test_a_broadcast_is_no_servo():
    assert DYNAMIXEL.sync_write(64, {1: b"\1"})[4] == BROADCAST

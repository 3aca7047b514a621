"""Frames byte for byte as the makers print them, and decoders that survive what a wire does."""

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from suchus.hardware.bus import BROADCAST, Instruction, Packet
from suchus.hardware.protocols import PROTOCOLS
from suchus.hardware.protocols.dynamixel import crc
from suchus.hardware.protocols.feetech import checksum

SPOKEN = ("dynamixel", "feetech", "line")
DYNAMIXEL, FEETECH, LINE = (PROTOCOLS[name] for name in SPOKEN)
PACKETS = st.builds(
    Packet,
    st.integers(0, 252),
    st.sampled_from([i.value for i in Instruction]),
    st.lists(st.sampled_from([0xFF, 0xFD, 0x00, 0x55, 0x01, 0x80]), max_size=60).map(bytes),
)
REGISTERS = st.lists(st.integers(0, 2**16 - 1), min_size=1, max_size=4).map(
    lambda numbers: b"".join(one.to_bytes(2, "little") for one in numbers)
)
SERVOS = st.lists(st.integers(0, 252), min_size=2, max_size=6, unique=True)
ADDRESSES = st.integers(0, 500).map(lambda register: 2 * register)
REQUESTS = {
    "line": st.one_of(  # every request that its lines can say
        st.builds(LINE.ping, st.integers(0, 252)),
        st.builds(LINE.reboot, st.integers(0, 252)),
        st.builds(LINE.read, st.integers(0, 252), ADDRESSES, ADDRESSES),
        st.builds(LINE.write, st.integers(0, 252), ADDRESSES, REGISTERS),
        st.builds(LINE.sync_read, SERVOS, ADDRESSES, ADDRESSES),
        st.builds(lambda ids, at, row: LINE.sync_write(at, dict.fromkeys(ids, row)), SERVOS, ADDRESSES, REGISTERS),
    ).map(lambda line: LINE.requests().feed(line)[0])
}
REPLIES = {"line": st.builds(Packet, st.integers(0, 252), st.integers(0, 255), REGISTERS)}


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


def test_lines_are_what_the_page_says():
    def line(text):
        return text + b"*%04X\n" % crc(text)

    assert LINE.ping(1) == b"p 1*4665\n"
    assert LINE.ping(3) == line(b"p 3")
    assert LINE.read(3, 30, 4) == line(b"r 3 15 2")
    assert LINE.sync_read((1, 2, 3), 30, 4) == line(b"r 1,2,3 15 2")
    assert LINE.write(3, 28, (-100).to_bytes(2, "little", signed=True)) == line(b"w 3 14 -100")
    goals = {1: (2048).to_bytes(2, "little"), 2: (2100).to_bytes(2, "little")}
    assert LINE.sync_write(28, goals) == line(b"w 1,2 14 2048,2100")
    assert LINE.reboot(252) == line(b"b 252")
    assert LINE.reply(Packet(3, 128, b"\x00\x08\xf4\xff")) == line(b"3 128 2048 -12")
    assert LINE.replies().feed(line(b"3 0 2048 -12")) == [Packet(3, 0, b"\x00\x08\xf4\xff")]
    page = (Path(__file__).parents[2] / "docs" / "hardware_bus.md").read_text(encoding="utf-8")
    shown = re.findall(r"(?:^| )([pbrw] [\d,]+(?: \d+ [\d,]+)?|\d+ \d+(?: -?\d+)*)\*([0-9A-F]{4})", page, re.MULTILINE)
    assert len(shown) == 10
    assert all(line(text.encode()) == f"{text}*{told}\n".encode() for text, told in shown)
    assert LINE.replies().feed(line(b"3 0")[:-1] + b"\r\n") == [Packet(3, 0)]  # as a terminal ends a line


@pytest.mark.parametrize(
    "text",
    [b"", b"p", b"p x", b"p 300", b"p 1,2", b"q 1", b"r 1 2", b"r 1 2 3 4", b"w 1 2 99999", b"w 1,2 3 1,2,3", b"1 0",
     b"r 1 40000 1", b"p \xff"],
)  # fmt: skip
def test_a_line_that_makes_no_sense_is_dropped_though_its_checksum_is_right(text):
    decoder = LINE.requests()
    wrong = text + b"*%04X\n" % crc(text)
    assert decoder.feed(wrong + LINE.ping(7)) == [Packet(7, Instruction.PING)]
    assert (decoder.dropped, decoder.broken) == (len(wrong), 0)


def test_a_line_that_is_spoilt_in_the_middle_or_at_its_end_costs_no_other():
    good = LINE.reply(Packet(3, 0, b"\x11\x22"))
    for place in range(len(good)):
        bad = bytearray(good)
        bad[place] ^= 1
        for spoilt in (bytes(bad), good[:place] + good[place + 1 :]):
            assert LINE.replies().feed(good + spoilt + good).count(Packet(3, 0, b"\x11\x22")) >= 2, (place, spoilt)
    assert LINE.replies().feed(5000 * b"x" + b"\n" + good) == [Packet(3, 0, b"\x11\x22")]


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


@pytest.mark.parametrize("name", SPOKEN)
@given(data=st.data(), cut=st.integers(1, 40))
def test_packets_come_back_whatever_portions_they_arrive_in(name, data, cut):
    framing = PROTOCOLS[name]
    for encode, decoder, kind in (
        (framing.request, framing.requests(), REQUESTS), (framing.reply, framing.replies(), REPLIES)
    ):  # fmt: skip
        packets = data.draw(st.lists(kind.get(name, PACKETS), min_size=1, max_size=4))
        wire, found = b"".join(map(encode, packets)), []
        for i in range(0, len(wire), cut):
            found += decoder.feed(wire[i : i + cut])
        assert found == packets
        assert (decoder.dropped, decoder.broken) == (0, 0)


@pytest.mark.parametrize("name", SPOKEN)
@given(noise=st.binary(max_size=30).filter(lambda b: not b.endswith(b"\xff")), data=st.data())
def test_noise_before_a_packet_costs_no_more_than_itself(name, noise, data):
    framing, packet = PROTOCOLS[name], data.draw(REPLIES.get(name, PACKETS))
    decoder = framing.replies()
    # noise that looks like the head of a long packet swallows what follows until it is complete, not for ever
    found = decoder.feed(noise + 150 * framing.reply(packet))
    assert found[-1] == packet
    assert found.count(packet) > 20


@pytest.mark.parametrize("name", SPOKEN)
@given(drawn=st.data(), place=st.integers(0, 200), bit=st.integers(0, 7))
def test_a_flipped_bit_gives_no_other_packet(name, drawn, place, bit):
    framing, packet = PROTOCOLS[name], drawn.draw(REPLIES.get(name, PACKETS))
    data = bytearray(framing.reply(packet))
    data[place % len(data)] ^= 1 << bit
    found = framing.replies().feed(bytes(data))
    assert all(p == packet for p in found)  # where the flip made the same packet appear again inside


@pytest.mark.parametrize("name", SPOKEN)
def test_a_broken_frame_is_counted_and_the_next_is_read(name):
    framing = PROTOCOLS[name]
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
    assert LINE.alert(128)
    assert not LINE.alert(7)
    assert "torque" in LINE.refusal(7)
    assert FEETECH.alert(0x20)
    assert not FEETECH.alert(0)


def test_a_broadcast_is_no_servo():
    assert DYNAMIXEL.sync_write(64, {1: b"\1"})[4] == BROADCAST

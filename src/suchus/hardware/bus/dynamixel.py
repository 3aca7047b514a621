"""Dynamixel 2.0: ``FF FF FD 00 | id | length | instruction | parameters | CRC-16``.

Source: ROBOTIS e-manual, "DYNAMIXEL Protocol 2.0".
"""

from suchus.hardware.bus.packets import Decoder, Framing, Packet

_HEADER = b"\xff\xff\xfd\x00"
_STUFFED, _PLAIN = b"\xff\xff\xfd\xfd", b"\xff\xff\xfd"
_STATUS = 0x55
ALERT = 0x80
"""Bit of a reply's error that says that ``hardware_error`` is not zero."""
REFUSALS = {
    1: "it could not do it",
    2: "it does not know the instruction",
    3: "the checksum was wrong",
    4: "the value is out of its range",
    5: "the value is too short",
    6: "the value is outside the limits that are set in it",
    7: "the register cannot be written, or not while torque is on",
}
"""What the number in a reply's error means."""
_MAX_FRAME_LENGTH = 1024
"""Greatest length that a frame may name [byte]; a longer one is noise that looks like a header."""


def _table() -> tuple[int, ...]:
    """Return the 256 values of the table by which the CRC-16 of the protocol is computed."""
    rows = []
    for byte in range(256):
        value = byte << 8
        for _ in range(8):
            value = (value << 1) ^ (0x8005 if value & 0x8000 else 0)
        rows.append(value & 0xFFFF)
    return tuple(rows)


_CRC = _table()


def crc(data: bytes) -> int:
    """Return the CRC-16 of bytes: polynomial 0x8005, begun with 0, not reflected."""
    value = 0
    for byte in data:
        value = ((value << 8) ^ _CRC[(value >> 8) ^ byte]) & 0xFFFF
    return value


def _framed(servo: int, body: bytes) -> bytes:
    """Return a frame around instruction and parameters, with a byte after each run that looks like a header."""
    body = body.replace(_PLAIN, _STUFFED)
    head = _HEADER + bytes([servo]) + (len(body) + 2).to_bytes(2, "little")
    return head + body + crc(head + body).to_bytes(2, "little")


class _DynamixelFrames(Decoder):
    """Takes frames of either direction; a reply is one whose instruction is 0x55."""

    def __init__(self, *, replies: bool) -> None:
        super().__init__()
        self._replies = replies

    def _next_packet(self, data: bytes) -> tuple[int, Packet | None] | None:
        """Return the number of bytes used and their packet, None for noise; None if a frame is not complete."""
        start = data.find(_HEADER)
        if start < 0:
            header_length = next((n for n in (3, 2, 1) if data.endswith(_HEADER[:n])), 0)
            return (len(data) - header_length, None) if len(data) > header_length else None
        if start > 0:
            return start, None
        if len(data) < 7:
            return None
        length = int.from_bytes(data[5:7], "little")
        if not 3 <= length <= _MAX_FRAME_LENGTH:
            return 1, None
        if len(data) < 7 + length:
            return None
        frame = data[: 7 + length]
        if int.from_bytes(frame[-2:], "little") != crc(frame[:-2]):
            self.broken += 1
            return 1, None
        body = frame[7:-2].replace(_STUFFED, _PLAIN)
        if (body[0] == _STATUS) != self._replies or (self._replies and len(body) < 2):
            return len(frame), None  # the echo of our own request, or what a servo says to somebody else
        packet = Packet(frame[4], body[1], body[2:]) if self._replies else Packet(frame[4], body[0], body[1:])
        return len(frame), packet


class NumberedErrors(Framing):
    """Framing whose errors have a bit for an alert and a number for the reason of a refusal."""

    def alert(self, code: int) -> bool:
        """Return whether the alert bit is set."""
        return bool(code & ALERT)

    def refusal(self, code: int) -> str:
        """Return what the number in the error says."""
        number = code & ~ALERT
        return REFUSALS.get(number, f"error {number}") if number else ""


class Dynamixel(NumberedErrors):
    """The protocol of ROBOTIS's X series."""

    name = "dynamixel"
    word = 2

    def request(self, packet: Packet) -> bytes:
        """Return the bytes of a request."""
        return _framed(packet.id, bytes([packet.code]) + packet.data)

    def reply(self, packet: Packet) -> bytes:
        """Return the bytes of a reply."""
        return _framed(packet.id, bytes([_STATUS, packet.code]) + packet.data)

    def requests(self) -> Decoder:
        """Return a decoder of what the host says."""
        return _DynamixelFrames(replies=False)

    def replies(self) -> Decoder:
        """Return a decoder of what the servos say; the host's own echo is passed over."""
        return _DynamixelFrames(replies=True)

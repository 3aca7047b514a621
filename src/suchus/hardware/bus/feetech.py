"""The protocol of Feetech's STS servos: ``FF FF | id | length | instruction or error | parameters | ~sum``.

The sum has 8 bits, so that one in 256 wrong frames passes: what is read must be plausible too. Source: Feetech's
protocol manual; registers as LeRobot's tables (Apache-2.0) name them.
"""

from suchus.hardware.bus.packets import Decoder, Framing, Packet

_HEADER = b"\xff\xff"


def checksum(data: bytes) -> int:
    """Return the complement of the sum of id, length, instruction and parameters."""
    return ~sum(data) & 0xFF


class _FeetechFrames(Decoder):
    """Takes frames of either direction, which look alike."""

    def _next_packet(self, data: bytes) -> tuple[int, Packet | None] | None:
        """Return the number of bytes used and their packet, None for noise; None if a frame is not complete."""
        start = data.find(_HEADER)
        if start < 0:
            header_length = int(data.endswith(b"\xff"))
            return (len(data) - header_length, None) if len(data) > header_length else None
        if start > 0:
            return start, None
        if len(data) < 4:
            return None
        if data[2] == 0xFF or data[3] < 2:
            return 1, None
        if len(data) < 4 + data[3]:
            return None
        frame = data[: 4 + data[3]]
        if frame[-1] != checksum(frame[2:-1]):
            self.broken += 1
            return 1, None
        return len(frame), Packet(frame[2], frame[4], frame[5:-1])


class Feetech(Framing):
    """The protocol of Feetech's STS servos."""

    name = "feetech"
    word = 1

    def request(self, packet: Packet) -> bytes:
        """Return the bytes of a request."""
        body = bytes([packet.id, len(packet.data) + 2, packet.code]) + packet.data
        return _HEADER + body + bytes([checksum(body)])

    def reply(self, packet: Packet) -> bytes:
        """Return the bytes of a reply."""
        return self.request(packet)

    def alert(self, code: int) -> bool:
        """Return whether any bit of the error is set: all of them are alerts."""
        return code != 0

    def refusal(self, code: int) -> str:
        """Say nothing: this protocol does not say why."""
        del code
        return ""

    def requests(self) -> Decoder:
        """Return a decoder of what the host says."""
        return _FeetechFrames()

    def replies(self) -> Decoder:
        """Return a decoder of what the servos say."""
        return _FeetechFrames()

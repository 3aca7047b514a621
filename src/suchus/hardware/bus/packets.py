"""What the packets of servo buses have in common: a request or a reply, and a decoder that survives what a wire does.

Three protocols are spoken: Dynamixel 2.0 (``dynamixel``), Feetech's for STS servos (``feetech``), and lines of text for
boards of one's own (``line``). They share their instructions and differ in their frames, checksums and the width of
addresses and lengths.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from enum import IntEnum
from typing import NamedTuple

BROADCAST = 0xFE
"""Identifier that all listen to and none answers, but for a ping [-]."""
LAST_ID = 252
"""Greatest identifier of a servo [-]."""


class Instruction(IntEnum):
    """What a request asks for; the numbers are those of both protocols."""

    PING = 0x01
    READ = 0x02
    WRITE = 0x03
    REBOOT = 0x08
    SYNC_READ = 0x82
    SYNC_WRITE = 0x83


class Packet(NamedTuple):
    """A request or a reply without its frame."""

    id: int
    """Of the servo that is asked, or that answers [-]."""
    code: int
    """Of a request the instruction; of a reply the error, 0 for none [-]."""
    data: bytes = b""
    """What follows."""


class Decoder(ABC):
    """Finds packets in bytes that come in any portions, with noise before, between and within them."""

    def __init__(self) -> None:
        """Begin with an empty buffer and counters at zero."""
        self._buffer = bytearray()
        self.dropped = 0
        """Bytes that belonged to no packet [-]."""
        self.broken = 0
        """Frames whose checksum was wrong [-]."""

    def feed(self, data: bytes) -> list[Packet]:
        """Add received bytes, and return the packets that are now complete, in order."""
        self._buffer += data
        packets: list[Packet] = []
        while (step := self._next_packet(bytes(self._buffer))) is not None:
            length, packet = step
            if packet is None:
                self.dropped += length
            else:
                packets.append(packet)
            del self._buffer[:length]
        return packets

    def clear(self) -> None:
        """Discard an incomplete packet."""
        self.dropped += len(self._buffer)
        self._buffer.clear()

    @abstractmethod
    def _next_packet(self, data: bytes) -> tuple[int, Packet | None] | None:
        """Return the number of bytes used and their packet, None for noise; None if more bytes must come."""


class Framing(ABC):
    """One protocol: how a packet becomes bytes."""

    name: str
    """As ``hardware.toml`` calls it."""
    word: int
    """Width of addresses and of lengths in parameters [byte]."""

    @abstractmethod
    def request(self, packet: Packet) -> bytes:
        """Return the bytes of a request."""

    @abstractmethod
    def reply(self, packet: Packet) -> bytes:
        """Return the bytes of a reply."""

    @abstractmethod
    def requests(self) -> Decoder:
        """Return a decoder of what the host says."""

    @abstractmethod
    def replies(self) -> Decoder:
        """Return a decoder of what the servos say."""

    @abstractmethod
    def alert(self, code: int) -> bool:
        """Return whether the error of a reply contains an alert."""

    @abstractmethod
    def refusal(self, code: int) -> str:
        """Return why a servo refused a request, by the error of its reply; empty if it did not."""

    def number(self, value: int) -> bytes:
        """Return an address or a length as it stands in parameters."""
        return value.to_bytes(self.word, "little")

    def read(self, servo: int, address: int, length: int) -> bytes:
        """Return the request for bytes of one servo from an address on."""
        return self.request(Packet(servo, Instruction.READ, self.number(address) + self.number(length)))

    def write(self, servo: int, address: int, data: bytes) -> bytes:
        """Return the request that writes bytes from an address on."""
        return self.request(Packet(servo, Instruction.WRITE, self.number(address) + data))

    def ping(self, servo: int) -> bytes:
        """Return the request to which a servo answers that it is there."""
        return self.request(Packet(servo, Instruction.PING))

    def reboot(self, servo: int) -> bytes:
        """Return the request that reboots a servo, which ends an alert."""
        return self.request(Packet(servo, Instruction.REBOOT))

    def sync_read(self, servos: Sequence[int], address: int, length: int) -> bytes:
        """Return the request that asks several servos for the same bytes; they answer in the order asked."""
        data = self.number(address) + self.number(length) + bytes(servos)
        return self.request(Packet(BROADCAST, Instruction.SYNC_READ, data))

    def sync_write(self, address: int, values: Mapping[int, bytes]) -> bytes:
        """Return the request that writes to several servos at once; none answers.

        Args:
            address: of the first byte.
            values: bytes by servo, all of one length.
        """
        length = len(next(iter(values.values())))
        data = b"".join(bytes([servo]) + value for servo, value in values.items())
        return self.request(
            Packet(BROADCAST, Instruction.SYNC_WRITE, self.number(address) + self.number(length) + data)
        )

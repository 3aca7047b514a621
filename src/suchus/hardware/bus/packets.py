"""What the packets of servo buses have in common: a request or a reply, and a decoder that survives what a wire does.

All protocols of ``suchus.hardware.protocols`` share these instructions. They differ in their frames, their checksums
and the width of addresses and lengths.
"""

from abc import ABC, abstractmethod
from enum import IntEnum
from typing import NamedTuple

BROADCAST = 0xFE
"""Identifier that all listen to and none answers, but for a ping [-]."""
LAST_ID = 252
"""Greatest identifier of a servo [-]."""


class Instruction(IntEnum):
    """What a request asks for; the numbers are those of Dynamixel and Feetech."""

    PING = 0x01
    READ = 0x02
    WRITE = 0x03
    REG_WRITE = 0x04
    ACTION = 0x05
    REBOOT = 0x08
    SYNC_READ = 0x82
    SYNC_WRITE = 0x83
    FAST_SYNC_READ = 0x8A
    BULK_READ = 0x92
    BULK_WRITE = 0x93
    FAST_BULK_READ = 0x9A


class Refusal(IntEnum):
    """Why an emulated device refuses a request; the numbers are those of Dynamixel 2.0."""

    NONE = 0
    INSTRUCTION = 2
    RANGE = 4
    LENGTH = 5
    LIMIT = 6
    ACCESS = 7


class Packet(NamedTuple):
    """A request or a reply without its frame."""

    id: int
    """Number of the servo that is asked, or that answers [-]."""
    code: int
    """Instruction of a request, or error of a reply, 0 for none [-]."""
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

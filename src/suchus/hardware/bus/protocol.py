"""What a protocol of servos declares: how it is found, how its packets look, its servos and what they answer."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Protocol

from suchus.hardware.bus.packets import BROADCAST, Decoder, Instruction, Packet, Refusal
from suchus.hardware.bus.tables import Table
from suchus.robot.design import Motor

DEFAULT_BAUD = 1_000_000
"""Bit rate of an emulated bus, where its protocol says no other [1/s]."""


BASIC_INSTRUCTIONS = frozenset({
    Instruction.PING, Instruction.READ, Instruction.WRITE, Instruction.REBOOT, Instruction.SYNC_READ,
    Instruction.SYNC_WRITE,
})  # fmt: skip
"""Instructions that a drive needs, and that the servos of every protocol know."""


class ServoProtocol:
    """How a servo is spoken to.

    A protocol that is no more than this can be named by a motor, and is spoken by nobody here.
    """

    name: str = ""
    """Name of the protocol and of its module, as ``motors.toml`` and ``hardware.toml`` call it."""
    families: tuple[str, ...] = ()
    """How the names of the servos' families begin (``Motor.family``)."""
    motors: tuple[Motor, ...] = ()
    """Servos with this protocol that are not among those of ``suchus.robot.motors``."""

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.name!r})"


class BusProtocol(ServoProtocol, ABC):
    """A protocol of packets: all servos hang on one bus, and each answers to its identifier."""

    word: int
    """Width of addresses and of lengths in the data of a ``Packet`` [byte]."""
    servo_protocol: str = ""
    """Protocol of the servos behind a board that speaks this one; empty where the servos speak it themselves."""
    bauds: Mapping[int, int] = MappingProxyType({})
    """Bit rates by the value of the register ``baud_rate`` [1/s]."""
    instructions: frozenset[Instruction] = BASIC_INSTRUCTIONS
    """Instructions that its servos know."""
    default_model: str = ""
    """Model of the servos of an emulated robot that names no servo with this protocol."""
    default_baud: int = DEFAULT_BAUD
    """Bit rate of such a robot's bus [1/s]."""

    # --- how a packet is built and read -------------------------------------------------------------------------------

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

    @abstractmethod
    def table(self, motor: Motor) -> Table:
        """Return the register table of a servo."""

    # --- what an emulated device answers ------------------------------------------------------------------------------

    @abstractmethod
    def reply_code(self, refusal: Refusal, alerts: int) -> int:
        """Return the error of a reply, which ``alert`` and ``refusal`` read.

        Args:
            refusal: why the device refuses the request.
            alerts: bits of its ``hardware_error``.
        """

    def ping_data(self, model_number: int, firmware: int) -> bytes:
        """Return the data of a reply to a ping; nothing in most protocols.

        Args:
            model_number: number of the device's model.
            firmware: version of its firmware; 0 for a sensor board.
        """
        del model_number, firmware
        return b""

    def joined_reply(self, replies: Sequence[Packet]) -> bytes:
        """Return the bytes of the one reply that several servos make together, as to a fast read.

        Args:
            replies: of the servos, in the order in which they were asked; at least one.

        Raises:
            NotImplementedError: the protocol has no such reply.
        """
        raise NotImplementedError(f"the protocol {self.name!r} has no reply of several servos")

    # --- requests -----------------------------------------------------------------------------------------------------

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


class PulseBoards(Protocol):
    """The open boards that give the pulses of one robot."""

    rate: float
    """Rate of the pulses [Hz]."""
    step: float
    """Step of a pulse's width [us]."""

    def send(self, pulses: Mapping[tuple[int, int], float]) -> None:
        """Set the pulse widths of channels [us], by board and channel."""

    def off(self) -> None:
        """Switch all channels off."""

    def close(self) -> None:
        """Let go of the boards."""


class ChannelProtocol(ServoProtocol, ABC):
    """A protocol of boards that give pulses: each servo hangs on a channel of a board, and answers nothing."""

    channels: int
    """Channels of a board [-]."""
    default_port: str
    """Port of the boards where none is named."""

    @abstractmethod
    def open(self, port: str, boards: Sequence[int], rate: float) -> PulseBoards:
        """Open the boards of a robot.

        Args:
            port: to them.
            boards: their numbers, from 0.
            rate: rate of pulses [Hz].

        Raises:
            BusFailure: there is no such port, or a board does not answer.
            InvalidDesign: a rate that the boards cannot give, or a package that is not installed.
        """

    @abstractmethod
    def open_printing(self, say: Callable[[str], None], boards: Sequence[int], rate: float) -> PulseBoards:
        """Return stand-ins of the boards for a dry run, which say what would be written.

        Args:
            say: takes a line of text.
            boards: their numbers, from 0.
            rate: rate of pulses [Hz].

        Raises:
            InvalidDesign: a rate that the boards cannot give.
        """

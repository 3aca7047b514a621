"""One bus at the host: requests, replies with deadlines, and counters of errors."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from time import monotonic

from suchus.core.errors import BusFailure
from suchus.hardware.bus.packets import Packet
from suchus.hardware.bus.ports import Port
from suchus.hardware.bus.protocol import BusProtocol
from suchus.hardware.bus.tables import Register
from suchus.hardware.bus.wiring import CLOCK

WAIT = 0.008
"""How long replies are waited for [s]; the bytes of a tick come on top."""
_FIRST_ANSWER = 1.0
"""How long a busy computer may take to say that its emulator has a clock [s]."""
_STEPPING = 60.0
"""How long an emulator may take for the ticks that its clock is told to let pass [s]."""


class NoAnswer(BusFailure):
    """A servo gave no reply, or none that can be decoded."""


@dataclass(slots=True)
class Counts:
    """Counters of errors on a bus."""

    missing: int = 0
    """Replies that did not come in time [-]."""
    stale: int = 0
    """Replies that came to a question that was no longer asked, or of the wrong length [-]."""


class Bus:
    """One bus.

    No protocol numbers its packets: a reply that comes late looks like one to the next question. So after a reply
    is missing, nothing else is asked (``settled``) until the bus has been silent for twice the wait. The same question
    may be asked again: a late reply to it is at worst older.

    Args:
        port: to it.
        protocol: what is spoken.
        wait: for replies [s].
        has_clock: whether an emulator's clock says when all have answered, so that nothing needs to be waited for.
    """

    def __init__(self, port: Port, protocol: BusProtocol, *, wait: float = WAIT, has_clock: bool = False) -> None:
        """Take an open port and the protocol that is spoken on it."""
        self.port, self.protocol, self.wait, self.clocked = port, protocol, wait, has_clock
        self.counts = Counts()
        self._decoder = protocol.replies()
        self._quiet_from = 0.0
        self._requested_lengths: dict[int, int] = {}  # whom ``begin`` asked for how many bytes
        self._late_replies: dict[int, Packet] = {}  # replies to that which came too late
        self.late: frozenset[int] = frozenset()
        """Whose replies of the last ``end`` were late ones to the question before."""

    @property
    def broken(self) -> int:
        """Replies whose checksum was wrong [-]."""
        return self._decoder.broken

    @property
    def dropped(self) -> int:
        """Bytes that belonged to no reply [-]."""
        return self._decoder.dropped

    @property
    def settled(self) -> bool:
        """Whether no late reply can come any more."""
        return self.clocked or monotonic() >= self._quiet_from

    def settle(self) -> None:
        """Read late replies until the bus has been silent for twice the wait."""
        while not self.settled:
            if self.port.receive(max(self._quiet_from - monotonic(), 0.0)):
                self.counts.stale += 1
                self._quiet_from = monotonic() + 2 * self.wait
        self._decoder.clear()

    def send(self, data: bytes) -> None:
        """Send a request without a reply."""
        self.port.send(data, max(self.wait, 0.05))

    def ask(self, request: bytes, servo: int, length: int | None = None, wait: float | None = None) -> Packet:
        """Send a request to one servo and return its reply.

        Args:
            request: the bytes.
            servo: servo whose reply it is.
            length: length of the data in it; None for any [byte].
            wait: for it; that of the bus if None [s].

        Raises:
            NoAnswer: it did not come in time.
        """
        self.settle()
        self.send(request)
        replies = self._collect((servo,), length, self.wait if wait is None else wait)
        if servo not in replies:
            raise NoAnswer(f"number {servo} on {self.port.name} does not answer.")
        return replies[servo]

    def begin(self, servos: Collection[int], address: int, length: int) -> None:
        """Request the same bytes of several servos; ``end`` returns the replies."""
        if not self.clocked:
            for packet in self._decoder.feed(self.port.receive(0.0)):
                self._keep(packet)
        self._requested_lengths |= dict.fromkeys(servos, length)
        servo_ids = [*servos, CLOCK] if self.clocked else [*servos]
        self.send(self.protocol.sync_read(servo_ids, address, length))

    def end(self, servos: Collection[int], length: int, wait: float | None = None) -> dict[int, Packet]:
        """Return the replies to ``begin`` that come in time, by servo.

        A missing reply is replaced by a late reply to the same question, if there is one.

        Args:
            servos: servos that were asked.
            length: length of what they were asked for [byte].
            wait: for them; that of the bus if None [s].
        """
        wait = self.wait if wait is None else wait
        replies = self._collect(servos, length, _STEPPING if self.clocked else wait, has_end_marker=self.clocked)
        late_replies = {servo: self._late_replies.pop(servo) for servo in servos if servo in self._late_replies}
        self.late = frozenset(late_replies) - frozenset(replies)
        return late_replies | replies

    def _keep(self, packet: Packet) -> None:
        """Store a late reply, if it can only be a reply to ``begin``."""
        if self._requested_lengths.get(packet.id) == len(packet.data):
            self._late_replies[packet.id] = packet
        else:
            self.counts.stale += 1

    def _collect(
        self, servos: Collection[int], length: int | None, wait: float, *, has_end_marker: bool = False
    ) -> dict[int, Packet]:
        """Return replies by servo, until all have come, the deadline, or the end marker.

        Args:
            servos: servos that were asked.
            length: length of the data in each reply; None for any [byte].
            wait: time until the deadline [s].
            has_end_marker: whether the clock of an emulator marks the end of the replies.
        """
        replies: dict[int, Packet] = {}
        end = monotonic() + wait
        while has_end_marker or len(replies) < len(servos):
            data = self.port.receive(max(end - monotonic(), 0.0))
            for packet in self._decoder.feed(data):
                if has_end_marker and packet.id == CLOCK:
                    self.counts.missing += len(servos) - len(replies)
                    return replies
                if packet.id in servos and length in (None, len(packet.data)):
                    replies[packet.id] = packet
                else:
                    self._keep(packet)
            if not data:
                break
        if len(replies) < len(servos):
            self.counts.missing += len(servos) - len(replies)
            self._quiet_from = monotonic() + 2 * self.wait
        return replies

    def ping(self, servo: int) -> Packet | None:
        """Return the reply of a servo to the question whether it is there; None if none comes."""
        try:
            return self.ask(self.protocol.ping(servo), servo)
        except NoAnswer:
            return None

    def read(self, servo: int, register: Register) -> int:
        """Return the value of a register of a servo.

        Raises:
            NoAnswer: it did not come in time.
        """
        request = self.protocol.read(servo, register.address, register.size)
        return register.decode(self.ask(request, servo, register.size).data)

    def write(self, servo: int, register: Register, value: int) -> Packet:
        """Write a register of a servo and return its reply.

        Raises:
            NoAnswer: the reply did not come in time.
            BusFailure: the servo refused it.
        """
        reply = self.ask(self.protocol.write(servo, register.address, register.encode(value)), servo)
        refusal = self.protocol.refusal(reply.code)
        if refusal:
            raise BusFailure(f"number {servo} on {self.port.name} refused {register.name} = {value}: {refusal}.")
        return reply

    def write_all(self, register: Register, values: Mapping[int, int]) -> None:
        """Write a register of several servos at once; none answers."""
        if values:
            self.send(
                self.protocol.sync_write(register.address, {servo: register.encode(v) for servo, v in values.items()})
            )

    def pass_until(self, tick: int) -> None:
        """Let the robot of an emulator move until a tick, counted from the start of the emulator.

        Raises:
            NoAnswer: there is no such clock on the bus, or the robot cannot go on.
        """
        request = self.protocol.write(CLOCK, 0, tick.to_bytes(4, "little"))
        try:
            reply = self.ask(request, CLOCK, wait=_STEPPING)
        except NoAnswer as error:
            raise NoAnswer(
                f"no clock answers on {self.port.name}: only an emulator has one, started with --clock bus; a robot is "
                "driven with --clock wall."
            ) from error
        if reply.code:
            raise BusFailure("the emulated robot cannot go on: its simulation diverged.")

    def clock(self) -> int | None:
        """Return the tick of an emulator's clock; None where there is none."""
        try:
            reply = self.ask(self.protocol.read(CLOCK, 0, 4), CLOCK, 4, wait=max(self.wait, _FIRST_ANSWER))
        except NoAnswer:
            return None
        return int.from_bytes(reply.data, "little")

    def close(self) -> None:
        """Let go of the port."""
        self.port.close()

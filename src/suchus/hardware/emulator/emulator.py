"""Buses of an emulated robot: bytes in, bytes out, with the delays of a real bus."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from random import Random

import numpy as np

from suchus.core.errors import Diverged
from suchus.hardware.bus import (
    BROADCAST,
    CLOCK,
    BusGone,
    BusProtocol,
    Decoder,
    Instruction,
    Packet,
    Refusal,
    Wiring,
    register_label,
)
from suchus.hardware.emulator.body import EmulatedBody
from suchus.hardware.emulator.devices import WITHOUT_EFFECT, Board, Device, EmulatedServo
from suchus.hardware.emulator.trouble import Trouble
from suchus.hardware.protocols import bus_protocol
from suchus.robot.control import Sensed

BITS = 10
"""Bits that a byte takes on the wire, start and stop bit included [-]."""
_SOAKED = 2.0  # [s]; after so long in water a servo is silent
_FAST_READS = (Instruction.FAST_SYNC_READ, Instruction.FAST_BULK_READ)
_FAST_HEAD = 8  # bytes before the first servo's part of a joined reply
_GARBLED = 0.5  # share of the bytes of two replies that collide which arrive wrong [-]


@dataclass(slots=True)
class _Line:
    """One bus."""

    protocol: BusProtocol
    decoder: Decoder
    devices: dict[int, Device]
    baud: int
    heard_baud: int = 0
    """Bit rate of the host's last bytes [1/s]."""
    registered: dict[int, tuple[int, bytes]] = field(default_factory=dict)
    """What servos write at the instruction to act: address and bytes by servo."""


class Emulator:
    """The buses of one robot.

    Args:
        wiring: how it is built; a host that believes something else finds out.
        body: the robot behind it.
        trouble: what goes wrong.
        has_clock: whether its time passes when its clock is told to, and not by itself.
        say: is given sentences on what a host asks and no servo has, each once.
    """

    def __init__(
        self,
        wiring: Wiring,
        body: EmulatedBody,
        trouble: Trouble | None = None,
        *,
        has_clock: bool = False,
        say: Callable[[str], None] = lambda _: None,
    ) -> None:
        """Connect emulated servos and boards to the buses of a wiring."""
        self._say, self._remarks = say, set[str]()
        self.body, self.clocked, self.trouble = body, has_clock, trouble or Trouble()
        self.wiring = wiring
        self.diverged: Diverged | None = None
        """Why the robot cannot go on; None as long as it can."""
        self._random = Random(self.trouble.seed)
        self._noise = np.random.default_rng([self.trouble.seed, 1])
        protocols = [bus_protocol(bus.protocol) for bus in wiring.bus]
        self.lines = [
            _Line(protocol, protocol.requests(), {}, bus.baud)
            for protocol, bus in zip(protocols, wiring.bus, strict=True)
        ]
        self.servos = []
        for number, place in enumerate(wiring.ordered(body.robot)):
            servo = EmulatedServo(place, wiring.bus[place.bus].baud, number)
            self.servos.append(servo)
            self.lines[place.bus].devices[place.id] = servo
        self._boards = []
        for board_place in wiring.board:
            board = Board(wiring.tables(board_place, body.robot))
            self._boards.append((board_place.kind, board))
            self.lines[board_place.bus].devices[board_place.id] = board
        self._delayed_readings: list[Sensed] = []
        self._delay_ticks = int(np.ceil(self.trouble.latency / body.period - 1e-9)) if has_clock else 0
        self._sagged = 0.0
        self._power()
        self._feel()

    def hear(self, number: int, data: bytes, baud: int | None = None) -> list[tuple[float, bytes]]:
        """Process bytes from a bus, and return the replies, each with its delay [s].

        Args:
            number: number of the bus.
            data: the bytes.
            baud: bit rate at which they were sent, where that can be known: servos hear nothing else [1/s].
        """
        line, replies, arrival_time = self.lines[number], list[tuple[float, bytes]](), 0.0
        line.heard_baud = line.baud if baud is None else baud
        if all(line.heard_baud != rate for rate in (line.baud, *self._rates(line))):
            return []
        for packet in line.decoder.feed(data):
            if packet.code in _FAST_READS and packet.code in line.protocol.instructions:
                joined = self._joined(line, packet)
                arrival_time += len(joined) * BITS / line.heard_baud
                if joined and self._random.random() >= self.trouble.lost:
                    replies.append((arrival_time, joined))
                continue
            clock = packet.id == CLOCK or (packet.code == Instruction.SYNC_READ and CLOCK in packet.data)
            if not clock and self._random.random() < self.trouble.lost:
                continue
            for servo, reply in self._answers(line, packet):
                data = line.protocol.reply(reply) if servo is None else self._spoilt(line, reply)
                delay = servo.reply_delay if isinstance(servo, EmulatedServo) else 0.0
                arrival_time += delay + len(line.protocol.reply(reply)) * BITS / line.heard_baud
                if data:
                    replies.append((arrival_time, data))
        return replies

    def pass_until(self, tick: int) -> None:
        """Let the robot move until a tick; nothing happens where that is past, or where it has diverged."""
        while self.body.tick < tick and self.diverged is None:
            self.step()

    def step(self) -> None:
        """Let one control period pass."""
        self._power()
        for servo in self.servos:
            setpoint = servo.advance(self.body.period)
            if setpoint is not None:
                self.body.aim({servo.number: self._rounded(setpoint)})
        try:
            self.body.step()
        except Diverged as error:
            self.diverged = error
            return
        self._age_servos()
        self._feel()

    # --- what is answered ---------------------------------------------------------------------------------------------

    def _answers(self, line: _Line, packet: Packet) -> list[tuple[Device | None, Packet]]:
        """Return the replies to a packet with their devices; None for the clock."""
        word, data = line.protocol.word, packet.data
        if packet.code == Instruction.SYNC_READ and len(data) >= 2 * word:
            address, length = _number(data, word), _number(data[word:], word)
            answers: list[tuple[Device | None, Packet]] = []
            for servo in data[2 * word :]:
                if servo == CLOCK and self.clocked:
                    answers.append((None, Packet(CLOCK, 0, self.body.tick.to_bytes(4, "little").ljust(length, b"\0"))))
                elif (device := self._listening(line, servo)) is not None:
                    answers.append((device, self._read(line, servo, device, address, length)))
            return answers
        if packet.code == Instruction.SYNC_WRITE and len(data) > 2 * word:
            address, length = _number(data, word), _number(data[word:], word)
            payload = data[2 * word :]
            for start in range(0, len(payload) - length, length + 1):
                target = self._listening(line, payload[start])
                if target is not None:
                    self._write(line, target, address, payload[start + 1 : start + 1 + length])
            return []
        if packet.code not in line.protocol.instructions and packet.id == BROADCAST:
            return []
        if packet.code == Instruction.BULK_READ:
            return [
                (device, self._read(line, servo, device, address, length))
                for servo, address, length in _bulk_rows(data, word)
                if (device := self._listening(line, servo)) is not None
            ]
        if packet.code == Instruction.BULK_WRITE:
            self._write_bulk(line, data)
            return []
        if packet.code == Instruction.ACTION:
            self._act(line)
            return []
        if packet.id == CLOCK:
            return [(None, self._of_clock(packet, word))] if self.clocked else []
        if packet.id == BROADCAST:
            everybody = sorted(line.devices) if packet.code == Instruction.PING else ()
            return [answer for servo in everybody for answer in self._device_answers(line, packet._replace(id=servo))]
        return self._device_answers(line, packet)

    def _of_clock(self, packet: Packet, word: int) -> Packet:
        if packet.code == Instruction.WRITE:
            self.pass_until(int.from_bytes(packet.data[word : word + 4], "little"))
            return Packet(CLOCK, int(self.diverged is not None))
        return Packet(CLOCK, 0, self.body.tick.to_bytes(4, "little"))

    def _device_answers(self, line: _Line, packet: Packet) -> list[tuple[Device | None, Packet]]:
        """Return the reply of the device that a packet names; empty if it does not answer."""
        device, word = self._listening(line, packet.id), line.protocol.word
        if device is None:
            return []
        data, refusal = packet.data, Refusal.NONE
        answer = b""
        if packet.code == Instruction.PING:
            firmware = device.get("firmware") if "firmware" in device.table else 0
            answer = line.protocol.ping_data(device.get("model_number"), firmware)
        elif packet.code == Instruction.READ and len(data) == 2 * word:
            return [(device, self._read(line, packet.id, device, _number(data, word), _number(data[word:], word)))]
        elif packet.code == Instruction.REG_WRITE and packet.code in line.protocol.instructions and len(data) > word:
            line.registered[packet.id] = _number(data, word), data[word:]
        elif packet.code == Instruction.WRITE and len(data) > word:
            refusal = self._write(line, device, _number(data, word), data[word:])
        elif packet.code == Instruction.REBOOT and isinstance(device, EmulatedServo):
            device.reboot()
        else:
            refusal = Refusal.INSTRUCTION
        if packet.code != Instruction.PING and self._is_mute(device):
            return []
        return [(device, Packet(packet.id, line.protocol.reply_code(refusal, device.alerts), answer))]

    def _read(self, line: _Line, servo: int, device: Device, address: int, length: int) -> Packet:
        """Return the reply of a device to a read: its bytes, or a refusal of what it cannot hold.

        Args:
            line: its bus.
            servo: its number.
            device: that is read.
            address: of the first byte.
            length: how many bytes.
        """
        if not device.holds(address, length):
            self._remark(
                f"length {servo} {address}",
                f"number {servo}, a {device.table.model}, was asked for {length} bytes from address {address} on; it "
                f"has {device.extent}: it refuses.",
            )
            return Packet(servo, line.protocol.reply_code(Refusal.LENGTH, device.alerts))
        self._remark_unknown(servo, device, address, length, "was asked for", "it answers zeros")
        return Packet(servo, line.protocol.reply_code(Refusal.NONE, device.alerts), device.read(address, length))

    def _remark_unknown(
        self, servo: int, device: Device, address: int, length: int, verb: str, consequence: str
    ) -> None:
        """Say once that bytes hold no register that the emulator knows, with their address and their maker's name."""
        registers = device.table.registers
        if any(r.address < address + length and address < r.address + r.size for r in registers):
            return
        label = register_label(device.table, address)
        reason = f"{label}, which is not emulated" if label else "where it has no register"
        self._remark(
            f"unknown {servo} {address}",
            f"number {servo}, a {device.table.model}, {verb} {length} bytes at address {address}, {reason}: "
            f"{consequence}.",
        )

    def _remark(self, key: str, sentence: str) -> None:
        """Say a sentence, once for each key."""
        if key not in self._remarks:
            self._remarks.add(key)
            self._say(sentence)

    def _joined(self, line: _Line, packet: Packet) -> bytes:
        """Return the one reply of several servos to a fast read; it breaks off before the first that is silent."""
        word, data = line.protocol.word, packet.data
        if packet.code == Instruction.FAST_BULK_READ:
            rows = _bulk_rows(data, word)
        else:
            address, length = _number(data, word), _number(data[word:], word)
            rows = [(servo, address, length) for servo in data[2 * word :]]
        replies: list[Packet] = []
        for servo, address, length in rows:
            device = self._listening(line, servo)
            if device is None:
                whole = [*replies, *(Packet(other, 0, bytes(size)) for other, _, size in rows[len(replies) :])]
                present = sum(4 + len(reply.data) for reply in replies)
                return line.protocol.joined_reply(whole)[: _FAST_HEAD + present] if replies else b""
            replies.append(self._read(line, servo, device, address, length))
        return line.protocol.joined_reply(replies) if replies else b""

    def _write_bulk(self, line: _Line, data: bytes) -> None:
        """Write different registers of several servos, none of which answers."""
        word = line.protocol.word
        while len(data) > 2 * word:
            servo, address, length = data[0], _number(data[1:], word), _number(data[1 + word :], word)
            payload, data = data[1 + 2 * word :][:length], data[1 + 2 * word + length :]
            device = self._listening(line, servo)
            if device is not None and len(payload) == length:
                self._write(line, device, address, payload)

    def _act(self, line: _Line) -> None:
        """Write what registered writes hold."""
        for servo, (address, payload) in line.registered.items():
            device = self._listening(line, servo)
            if device is not None:
                self._write(line, device, address, payload)
        line.registered.clear()

    @staticmethod
    def _is_mute(device: Device) -> bool:
        """Return whether a servo is set to answer less than this request, which was no ping and no read."""
        if not isinstance(device, EmulatedServo) or "status_level" not in device.table:
            return False
        return device.get("status_level") < device.table["status_level"].initial

    @staticmethod
    def _rates(line: _Line) -> list[int]:
        """Return the bit rates at which servos of a bus listen [1/s]."""
        return [device.baud for device in line.devices.values() if isinstance(device, EmulatedServo)]

    def _listening(self, line: _Line, servo: int) -> Device | None:
        """Return a device, or None if it does not answer."""
        device = line.devices.get(servo)
        has_trouble = self.body.time >= self.trouble.at
        if device is None or (has_trouble and servo in self.trouble.mute):
            return None
        if servo in self.trouble.wet and self.body.time >= self.trouble.at + _SOAKED:
            return None
        if isinstance(device, EmulatedServo):
            if device.baud != line.heard_baud:
                return None
            device.heard_at = self.body.time
        return device

    def _write(self, line: _Line, device: Device, address: int, data: bytes) -> Refusal:
        """Write registers of a device, pass new goals and torque limits to the robot, and return the refusal.

        Args:
            line: its bus.
            device: that is written.
            address: of the first byte.
            data: the bytes.
        """
        if not isinstance(device, EmulatedServo):
            return device.write(address, data)
        servo = device.get("id")
        refusal = device.write(address, data)
        self._remark_unknown(servo, device, address, len(data), "was sent", "it refuses them")
        if refusal != Refusal.NONE:
            return refusal
        if device.get("id") != servo:
            self._renumber(line, device, servo)
        goal = device.table["goal_position"]
        if address <= goal.address < address + len(data) and not device.has_profile:
            self.body.aim({device.number: self._rounded(device.goal)})
        if device.share != self.body.powered[device.number]:
            self._power()
        self._remark_without_effect(servo, device, address, len(data))
        return refusal

    def _renumber(self, line: _Line, device: EmulatedServo, former: int) -> None:
        """Let a servo listen to its new number; where another has it, the number stays as it was."""
        new = device.get("id")
        if new in line.devices:
            device.put("id", former)
            self._remark(
                f"twin {new}",
                f"number {former} was to become number {new}, which another one has: on a real bus both would "
                "answer at once. It stays as it is.",
            )
            return
        line.devices[new] = line.devices.pop(former)

    def _remark_without_effect(self, servo: int, device: EmulatedServo, address: int, length: int) -> None:
        """Say once what a servo keeps without an effect on the simulated robot."""
        for register in device.table.registers:
            is_written = address <= register.address < address + length
            if is_written and register.name in WITHOUT_EFFECT and device.get(register.name) != register.initial:
                self._remark(
                    f"effect {register.name}",
                    f"number {servo} keeps {register.name} = {device.get(register.name)} (address "
                    f"{register.address}), and the simulated robot moves as before: its servos have the gains of its "
                    "own file.",
                )
        if device.mode in ("current", "voltage", "step"):
            self._remark(
                f"mode {device.mode}",
                f"number {servo} is in operating mode {device.get('operating_mode')}, control of {device.mode}, which "
                "is not simulated: its joint is limp.",
            )

    def _spoilt(self, line: _Line, reply: Packet) -> bytes:
        """Return the bytes of a reply as they arrive; empty if it is lost."""
        random, trouble = self._random, self.trouble
        data = bytearray(line.protocol.reply(reply))
        if reply.id in trouble.twin:  # two replies at once
            for i in range(4, len(data)):
                if random.random() < _GARBLED:
                    data[i] = random.randrange(256)
        if random.random() < trouble.lost:
            return b""
        if random.random() < trouble.corrupt:
            place = random.randrange(len(data))
            data[place] ^= 1 << random.randrange(8)
        if random.random() < trouble.dropped:
            del data[random.randrange(len(data))]
        return bytes(data)

    # --- what happens in the servos -----------------------------------------------------------------------------------

    def _power(self) -> None:
        for servo in self.servos:
            self.body.power(servo.number, servo.share)

    def _age_servos(self) -> None:
        """Advance the servos by a control period: heat them and apply water, heat and voltage drop of ``Trouble``."""
        trouble, time, period = self.trouble, self.body.time, self.body.period
        has_trouble = time >= trouble.at
        if has_trouble:
            self._sagged += trouble.sag * period
        for servo in self.servos:
            heating = trouble.heating if has_trouble and servo.place.id in trouble.hot else 0.0
            servo.age(period, heating, max(servo.supply - self._sagged, 0.0), time)
            if has_trouble and servo.place.id in trouble.wet:
                servo.soak()

    def _feel(self) -> None:
        """Write the robot's sensor readings to servos and boards, delayed by the latency."""
        self._delayed_readings.append(self.body.sensed())
        sensed = self._delayed_readings[0]
        if len(self._delayed_readings) > self._delay_ticks:
            self._delayed_readings.pop(0)
        angles = sensed.servo_position[0]
        if self.trouble.noise > 0.0:
            angles = angles + self.trouble.noise * self._noise.standard_normal(len(angles))
        for servo in self.servos:
            i = servo.number
            servo.feel(self._rounded(float(angles[i])), float(sensed.servo_velocity[0, i]),
                       float(sensed.servo_torque[0, i]))  # fmt: skip
        for kind, board in self._boards:
            board.feel(kind, sensed)

    def _rounded(self, angle: float) -> float:
        step = self.trouble.resolution
        return round(angle / step) * step if step > 0.0 else angle


def _bulk_rows(data: bytes, word: int) -> list[tuple[int, int, int]]:
    """Return number, address and length of each servo that a bulk read asks."""
    size = 1 + 2 * word
    rows = [data[start : start + size] for start in range(0, len(data) - size + 1, size)]
    return [(row[0], _number(row[1:], word), _number(row[1 + word :], word)) for row in rows]


def _number(data: Sequence[int], word: int) -> int:
    return int.from_bytes(bytes(data[:word]), "little")


class MemoryPort:
    """A port to an emulator in the same process, without delays.

    Args:
        emulator: emulator with a clock of its own.
        number: number of the bus.
    """

    def __init__(self, emulator: Emulator, number: int = 0) -> None:
        """Connect to a bus of an emulator in the same process."""
        self.name = f"emulated bus {number}"
        self._emulator, self._number, self._coming = emulator, number, bytearray()
        self.gone = False
        """Whether the other end is gone; set it to pull the plug."""
        self.deaf = False
        """Whether the other end reads no more."""

    def send(self, data: bytes, timeout: float) -> None:
        """Let the emulator take bytes; it answers at once."""
        if self.gone or self.deaf:
            cause = "is gone" if self.gone else f"took no bytes for {timeout:.3g} s"
            raise BusGone(f"the bus {self.name} {cause}.")
        for _, reply in self._emulator.hear(self._number, data):
            self._coming += reply

    def receive(self, timeout: float) -> bytes:
        """Return what has been answered; nothing comes later."""
        del timeout
        if self.gone:
            raise BusGone(f"the bus {self.name} is gone.")
        data = bytes(self._coming)
        self._coming.clear()
        return data

    def close(self) -> None:
        """Let go of it."""

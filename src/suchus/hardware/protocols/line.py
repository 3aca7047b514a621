"""A plain line protocol for boards of one's own: lines of text with whole numbers, which a terminal can type and read.

A board holds, for each of its servos, a row of 16-bit registers, as ``PlainLine.table`` lists them. A line is what it
says, a star, the CRC-16 of what stands before the star (as of Dynamixel 2.0, four hexadecimal digits), and a line feed:

* ``p 3``: is number 3 there? It answers ``3 0``: its number, and its error.
* ``r 3 15 2``: read two registers of it from register 15 on; it answers ``3 0 2048 -12``. With several numbers, as in
  ``r 1,2,3 15 2``, each answers in the order asked.
* ``w 3 14 2100``: write from register 14 on; it answers ``3 0``. With several numbers, ``w 1,2,3 14 2048,2100,1990``,
  and none answers.
* ``b 3``: begin anew, which ends an alert; it answers.

An error is 0 or the number of Dynamixel 2.0 for it, and 128 more while there is an alert. The host waits for no answer;
a line whose CRC is wrong is dropped by either side, and the next one counts.
"""

from collections.abc import Iterator, Sequence
from types import MappingProxyType

from suchus.hardware.bus.packets import BROADCAST, Decoder, Instruction, Packet
from suchus.hardware.bus.tables import STEP, STEPS, Register, Sign, Table
from suchus.hardware.protocols.dynamixel import NumberedErrors, crc
from suchus.robot.design import Motor

_MAX_LINE_LENGTH = 4096  # bytes of a line; what is longer is noise
_TAIL = 5  # bytes of the star and the CRC
_WORDS = {Instruction.PING: "p", Instruction.READ: "r", Instruction.WRITE: "w", Instruction.REBOOT: "b"}
_INSTRUCTIONS = {word: instruction for instruction, word in _WORDS.items()}
_SEVERAL = {Instruction.READ: Instruction.SYNC_READ, Instruction.WRITE: Instruction.SYNC_WRITE}


def _line(text: str) -> bytes:
    """Return a text with its checksum and a line feed, as bytes."""
    payload = text.encode("ascii")
    return payload + f"*{crc(payload):04X}\n".encode("ascii")


def _numbers(data: bytes) -> list[int]:
    """Return bytes as registers."""
    return [int.from_bytes(data[i : i + 2], "little", signed=True) for i in range(0, len(data), 2)]


def _bytes(numbers: Sequence[int]) -> bytes:
    """Return registers as bytes.

    Raises:
        OverflowError: one does not fit 16 bits.
    """
    return b"".join(number.to_bytes(2, "little", signed=True) for number in numbers)


def _integers(text: str) -> list[int]:
    return [int(token) for token in text.split(",")]


def _address(number: int) -> bytes:
    return (2 * number).to_bytes(2, "little")


def _request(text: str) -> Packet:
    """Return the request that a line makes.

    Raises:
        ValueError: it makes none.
        KeyError: the same.
        OverflowError: the same.
    """
    word, ids, *arguments = text.split(" ")
    instruction, servos = _INSTRUCTIONS[word], _integers(ids)
    if not all(0 <= servo_id <= BROADCAST for servo_id in servos) or (len(servos) > 1 and instruction not in _SEVERAL):
        raise ValueError(text)
    if instruction in (Instruction.PING, Instruction.REBOOT):
        () = arguments
        return Packet(servos[0], instruction)
    start, values = arguments
    if instruction == Instruction.READ:
        data = _address(int(start)) + _address(int(values))
        if len(servos) == 1:
            return Packet(servos[0], instruction, data)
        return Packet(BROADCAST, Instruction.SYNC_READ, data + bytes(servos))
    numbers = _integers(values)
    if len(servos) == 1:
        return Packet(servos[0], instruction, _address(int(start)) + _bytes(numbers))
    register_count = len(numbers) // len(servos)
    if register_count * len(servos) != len(numbers):
        raise ValueError(text)
    data = _address(int(start)) + _address(register_count)
    for i, servo in enumerate(servos):
        data += bytes([servo]) + _bytes(numbers[i * register_count : (i + 1) * register_count])
    return Packet(BROADCAST, Instruction.SYNC_WRITE, data)


def _reply(text: str) -> Packet:
    """Return the reply that a line is.

    Raises:
        ValueError: it is none.
        OverflowError: the same.
    """
    servo, error, *values = (int(token) for token in text.split(" "))
    if not (0 <= servo <= BROADCAST and 0 <= error <= 255):
        raise ValueError(text)
    return Packet(servo, error, _bytes(values))


class _Lines(Decoder):
    """Takes the lines of one direction; those of the other are an echo and passed over."""

    def __init__(self, *, replies: bool) -> None:
        super().__init__()
        self._replies = replies

    def _next_packet(self, data: bytes) -> tuple[int, Packet | None] | None:
        """Return the number of bytes used and their packet, None for noise; None if a line is not complete."""
        end = data.find(b"\n")
        if end < 0:
            return (len(data), None) if len(data) > _MAX_LINE_LENGTH else None
        payload, star, checksum = data[:end].removesuffix(b"\r").rpartition(b"*")
        length = end + 1
        if not star or not payload:
            return length, None
        if checksum.upper() != f"{crc(payload):04X}".encode("ascii"):
            self.broken += 1
            inner = payload.find(b"*")  # a line feed that was lost or spoilt joined two lines: the second may be whole
            if inner < 0:
                return length, None
            resume_index = inner + _TAIL
            return (resume_index if data[resume_index : resume_index + 1].isalnum() else resume_index + 1), None
        try:
            text = payload.decode("ascii")
            return length, _reply(text) if self._replies else _request(text)
        except (ValueError, KeyError, OverflowError):
            return length, None


class PlainLine(NumberedErrors):
    """Lines of text, for boards of one's own."""

    name = "line"
    families = ("hobby servos",)
    word = 2
    servo_protocol = "pwm"
    bauds = MappingProxyType(dict(enumerate((1_000_000, 500_000, 250_000, 115_200, 57_600, 2_000_000, 3_000_000))))
    default_model = "DS3225"
    default_baud = 2_000_000  # numbers that are written out are longer

    def request(self, packet: Packet) -> bytes:
        """Return the bytes of a request."""
        return _line(" ".join(_request_words(packet)))

    def reply(self, packet: Packet) -> bytes:
        """Return the bytes of a reply."""
        return _line(" ".join(str(number) for number in (packet.id, packet.code, *_numbers(packet.data))))

    def requests(self) -> Decoder:
        """Return a decoder of what the host says."""
        return _Lines(replies=False)

    def replies(self) -> Decoder:
        """Return a decoder of what boards say; the host's own echo is passed over."""
        return _Lines(replies=True)

    def table(self, motor: Motor) -> Table:
        """Return the table of a hobby servo behind a board of one's own; register n is at 2 n."""
        hottest = round(motor.temperature_limit)
        min_voltage = round(100 * motor.volts_range[0])
        two: Sign = "two"
        rows = (
            Register(name="model_number", address=0, size=2, initial=motor.model_number),
            Register(name="firmware", address=2, size=2, initial=1),
            Register(name="id", address=4, size=2, initial=1),
            Register(name="baud_rate", address=6, size=2),
            Register(name="return_delay", address=8, size=2, unit=1e-6, writable=True, span=(0, 10_000)),
            Register(name="operating_mode", address=10, size=2, writable=True, initial=3, span=(0, 16)),
            Register(name="temperature_limit", address=12, size=2, writable=True, initial=hottest, span=(0, 200)),
            Register(name="voltage_low", address=14, size=2, unit=0.01, writable=True, initial=min_voltage),
            Register(name="position_low", address=16, size=2, unit=STEP, sign=two, writable=True),
            Register(name="position_high", address=18, size=2, unit=STEP, sign=two, writable=True, initial=STEPS - 1),
            Register(name="bus_watchdog", address=20, size=2, unit=0.02, sign=two, writable=True, span=(0, 127)),
            Register(name="torque_enable", address=22, size=2, writable=True, span=(0, 1)),
            Register(name="torque_limit", address=24, size=2, sign=two, writable=True, initial=1000, span=(0, 1000)),
            Register(name="goal_position", address=28, size=2, unit=STEP, sign=two, writable=True, initial=2048),
            Register(name="present_position", address=30, size=2, unit=STEP, sign=two, initial=2048),
            Register(name="present_velocity", address=32, size=2, unit=1e-3, sign=two),
            Register(name="present_current", address=34, size=2, unit=1e-3, sign=two),
            Register(name="present_voltage", address=36, size=2, unit=0.01, initial=round(100 * motor.volts)),
            Register(name="present_temperature", address=38, size=2, sign=two, initial=25),
            Register(name="hardware_error", address=40, size=2),
        )
        return Table(
            model=motor.name,
            number=motor.model_number,
            protocol=self.name,
            registers=rows,
            motor=motor,
            felt=("present_position", "hardware_error"),
            bauds=self.bauds,
            alerts=((0, "input voltage"), (2, "overheated"), (3, "encoder"), (4, "electrical shock"), (5, "overload")),
        )


def _request_words(packet: Packet) -> Iterator[str]:
    """Yield the parts of a request's line."""
    data = packet.data
    if packet.code not in (Instruction.SYNC_READ, Instruction.SYNC_WRITE):
        yield from (_WORDS[Instruction(packet.code)], str(packet.id))
        if packet.code == Instruction.READ:
            yield from (str(number // 2) for number in _numbers(data))
        elif packet.code == Instruction.WRITE:
            yield from (str(_numbers(data)[0] // 2), ",".join(str(number) for number in _numbers(data[2:])))
        return
    start, length = _numbers(data[:4])
    rows = data[4:]
    if packet.code == Instruction.SYNC_READ:
        yield from (
            _WORDS[Instruction.READ],
            ",".join(str(number) for number in rows),
            str(start // 2),
            str(length // 2),
        )
        return
    size = length + 1
    yield _WORDS[Instruction.WRITE]
    yield ",".join(str(rows[i]) for i in range(0, len(rows), size))
    yield str(start // 2)
    yield ",".join(str(number) for i in range(0, len(rows), size) for number in _numbers(rows[i + 1 : i + size]))


protocol = PlainLine()

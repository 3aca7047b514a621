"""Dynamixel protocol 2.0 of ROBOTIS's X series.

A frame is ``FF FF FD 00 | id | length | instruction | parameters | CRC-16``. Sources: ROBOTIS e-manual, "DYNAMIXEL
Protocol 2.0", and the tables of its SDK (Apache-2.0).
"""

from collections.abc import Mapping, Sequence
from math import pi
from types import MappingProxyType

from suchus.hardware.bus.packets import BROADCAST, Decoder, Instruction, Packet, Refusal
from suchus.hardware.bus.protocol import BASIC_INSTRUCTIONS, BusProtocol
from suchus.hardware.bus.tables import STEP, STEPS, Mode, Register, Sign, Table
from suchus.robot.design import Motor

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
_RPM = 2 * pi / 60
_AMPERES = {"XM": 2.69e-3, "XW": 2.69e-3, "XC330": 1e-3}
"""What a step of ``present_current`` is, by how the name of a model begins [A]; others tell a load only."""
_MODES: Mapping[int, Mode] = {1: "velocity", 3: "position", 4: "multi-turn", 16: "voltage"}
_CURRENT_MODES: Mapping[int, Mode] = {**_MODES, 0: "current", 5: "multi-turn"}


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


class NumberedErrors(BusProtocol):
    """A protocol whose replies hold a number that says why a request is refused, and a bit for an alert."""

    def alert(self, code: int) -> bool:
        """Return whether the alert bit is set."""
        return bool(code & ALERT)

    def refusal(self, code: int) -> str:
        """Return what the number in the error says."""
        number = code & ~ALERT
        return REFUSALS.get(number, f"error {number}") if number else ""

    def reply_code(self, refusal: Refusal, alerts: int) -> int:
        """Return the number of the refusal, with the alert bit where there is an alert."""
        return refusal | (ALERT if alerts else 0)


class Dynamixel(NumberedErrors):
    """The protocol of ROBOTIS's X series."""

    name = "dynamixel"
    families = ("Dynamixel X",)
    word = 2
    bauds = MappingProxyType({0: 9600, 1: 57600, 2: 115200, 3: 1_000_000, 4: 2_000_000, 5: 3_000_000, 6: 4_000_000})
    default_model = "XM430-W350"
    instructions = BASIC_INSTRUCTIONS | {
        Instruction.REG_WRITE, Instruction.ACTION, Instruction.BULK_READ, Instruction.BULK_WRITE,
        Instruction.FAST_SYNC_READ, Instruction.FAST_BULK_READ,
    }  # fmt: skip

    def request(self, packet: Packet) -> bytes:
        """Return the bytes of a request."""
        return _framed(packet.id, bytes([packet.code]) + packet.data)

    def reply(self, packet: Packet) -> bytes:
        """Return the bytes of a reply."""
        return _framed(packet.id, bytes([_STATUS, packet.code]) + packet.data)

    def joined_reply(self, replies: Sequence[Packet]) -> bytes:
        """Return the one reply of several servos to a fast read.

        Each servo adds its error, its number, its data and the CRC of all that was sent until then. Nothing is stuffed.
        Source: ROBOTIS e-manual, "Fast Sync Read".
        """
        length = 1 + sum(4 + len(reply.data) for reply in replies)
        frame = _HEADER + bytes([BROADCAST]) + length.to_bytes(2, "little") + bytes([_STATUS])
        for reply in replies:
            frame += bytes([reply.code, reply.id]) + reply.data
            frame += crc(frame).to_bytes(2, "little")
        return frame

    def requests(self) -> Decoder:
        """Return a decoder of what the host says."""
        return _DynamixelFrames(replies=False)

    def replies(self) -> Decoder:
        """Return a decoder of what the servos say; the host's own echo is passed over."""
        return _DynamixelFrames(replies=True)

    def ping_data(self, model_number: int, firmware: int) -> bytes:
        """Return model number and firmware, as the reply to a ping holds them."""
        return model_number.to_bytes(2, "little") + bytes([firmware])

    def table(self, motor: Motor) -> Table:
        """Return the table of an X servo."""
        max_current = 2047 if "540" in motor.name else 1193
        max_velocity = min(round(1.2 * motor.no_load_speed / (0.229 * _RPM)), 1023)
        current = next((step for start, step in _AMPERES.items() if motor.name.startswith(start)), 0.0)
        min_voltage, max_voltage = (round(10 * end) for end in motor.volts_range)
        hottest = round(motor.temperature_limit)
        two: Sign = "two"
        return Table(
            model=motor.name,
            number=motor.model_number,
            protocol=self.name,
            motor=motor,
            registers=(
                Register(name="model_number", address=0, size=2, initial=motor.model_number),
                Register(name="firmware", address=6, size=1, initial=48),
                Register(name="id", address=7, size=1, writable=True, initial=1, span=(0, 252)),
                Register(name="baud_rate", address=8, size=1, writable=True, initial=1, span=(0, 7)),
                Register(name="return_delay", address=9, size=1, unit=2e-6, writable=True, initial=250, span=(0, 254)),
                Register(name="drive_mode", address=10, size=1, writable=True, span=(0, 13)),
                Register(name="operating_mode", address=11, size=1, writable=True, initial=3, span=(0, 16)),
                Register(name="secondary_id", address=12, size=1, writable=True, initial=255, span=(0, 255)),
                Register(name="protocol_type", address=13, size=1, writable=True, initial=2, span=(1, 22)),
                Register(name="homing_offset", address=20, size=4, unit=STEP, sign=two, writable=True,
                         span=(-1_044_479, 1_044_479)),
                Register(name="moving_threshold", address=24, size=4, unit=0.229 * _RPM, writable=True, initial=10,
                         span=(0, 1023)),
                Register(name="temperature_limit", address=31, size=1, writable=True, initial=hottest, span=(0, 100)),
                Register(name="voltage_high", address=32, size=2, unit=0.1, writable=True, initial=max_voltage),
                Register(name="voltage_low", address=34, size=2, unit=0.1, writable=True, initial=min_voltage),
                Register(name="voltage_limit", address=36, size=2, writable=True, initial=885, span=(0, 885)),
                *(
                    (Register(name="current_limit", address=38, size=2, unit=current, writable=True,
                              initial=max_current, span=(0, max_current)),)
                    if current
                    else ()
                ),
                Register(name="velocity_limit", address=44, size=4, unit=0.229 * _RPM, writable=True,
                         initial=max_velocity, span=(0, 1023)),
                Register(name="position_high", address=48, size=4, unit=STEP, writable=True, initial=STEPS - 1,
                         span=(0, STEPS - 1)),
                Register(name="position_low", address=52, size=4, unit=STEP, writable=True, span=(0, STEPS - 1)),
                Register(name="startup_configuration", address=60, size=1, writable=True, span=(0, 3)),
                Register(name="shutdown", address=63, size=1, writable=True, initial=52),
                Register(name="torque_enable", address=64, size=1, writable=True, span=(0, 1)),
                Register(name="led", address=65, size=1, writable=True, span=(0, 1)),
                Register(name="status_level", address=68, size=1, writable=True, initial=2, span=(0, 2)),
                Register(name="registered_instruction", address=69, size=1),
                Register(name="hardware_error", address=70, size=1),
                Register(name="velocity_i_gain", address=76, size=2, writable=True, initial=1920, span=(0, 16383)),
                Register(name="velocity_p_gain", address=78, size=2, writable=True, initial=100, span=(0, 16383)),
                Register(name="position_d_gain", address=80, size=2, writable=True, span=(0, 16383)),
                Register(name="position_i_gain", address=82, size=2, writable=True, span=(0, 16383)),
                Register(name="position_p_gain", address=84, size=2, writable=True, initial=800, span=(0, 16383)),
                Register(name="feedforward_2nd_gain", address=88, size=2, writable=True, span=(0, 16383)),
                Register(name="feedforward_1st_gain", address=90, size=2, writable=True, span=(0, 16383)),
                Register(name="bus_watchdog", address=98, size=1, unit=0.02, sign=two, writable=True, span=(0, 127)),
                Register(name="torque_limit", address=100, size=2, sign=two, writable=True, initial=885,
                         span=(-885, 885)),
                *(
                    (Register(name="goal_current", address=102, size=2, unit=current, sign=two, writable=True,
                              initial=max_current, span=(-max_current, max_current)),)
                    if current
                    else ()
                ),
                Register(name="goal_velocity", address=104, size=4, unit=0.229 * _RPM, sign=two, writable=True,
                         span=(-1023, 1023)),
                Register(name="profile_acceleration", address=108, size=4, unit=214.577 * _RPM / 60, writable=True,
                         span=(0, 32767)),
                Register(name="profile_velocity", address=112, size=4, unit=0.229 * _RPM, writable=True,
                         span=(0, 32767)),
                Register(name="goal_position", address=116, size=4, unit=STEP, sign=two, writable=True, initial=2048),
                Register(name="realtime_tick", address=120, size=2, unit=1e-3),
                Register(name="moving", address=122, size=1),
                Register(name="moving_status", address=123, size=1),
                Register(name="present_voltage_fraction", address=124, size=2, unit=1 / 885, sign=two),
                Register(name="present_current" if current else "present_load", address=126, size=2,
                         unit=current or 1e-3, sign=two),
                Register(name="present_velocity", address=128, size=4, unit=0.229 * _RPM, sign=two),
                Register(name="present_position", address=132, size=4, unit=STEP, sign=two, initial=2048),
                Register(name="velocity_trajectory", address=136, size=4, unit=0.229 * _RPM, sign=two),
                Register(name="position_trajectory", address=140, size=4, unit=STEP, sign=two, initial=2048),
                Register(name="present_voltage", address=144, size=2, unit=0.1, initial=120),
                Register(name="present_temperature", address=146, size=1, initial=25),
            ),
            felt=("present_current" if current else "present_load", "present_position"),
            health=("present_voltage", "present_temperature"),
            bauds=self.bauds,
            watches_from=38,
            persistent=64,
            full=885,
            modes=_CURRENT_MODES if current else _MODES,
            max_position_offset=1024,
            extent=662,
            other_registers=((147, 148, "backup_ready"), (168, 224, "indirect_address"), (224, 252, "indirect_data"),
                             (578, 634, "indirect_address"), (634, 662, "indirect_data")),
            alerts=(
                (0, "input voltage"), (2, "overheated"), (3, "encoder"), (4, "electrical shock"), (5, "overload"),
            ),
        )  # fmt: skip


protocol = Dynamixel()

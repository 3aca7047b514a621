"""The protocol of Feetech's STS servos.

A frame is ``FF FF | id | length | instruction or error | parameters | ~sum``. The sum has 8 bits, so that one in 256
wrong frames passes: what is read must be plausible too. Source: Feetech's protocol manual; registers as LeRobot's
tables (Apache-2.0) name them.
"""

from types import MappingProxyType

from suchus.hardware.bus.packets import Decoder, Instruction, Packet, Refusal
from suchus.hardware.bus.protocol import BASIC_INSTRUCTIONS, BusProtocol
from suchus.hardware.bus.tables import STEP, STEPS, Register, Table
from suchus.robot.design import Motor

_HEADER = b"\xff\xff"
_CENTERING = 128  # value of torque_enable by which the present position becomes 2048


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


class Feetech(BusProtocol):
    """The protocol of Feetech's STS servos."""

    name = "feetech"
    families = ("Feetech STS",)
    word = 1
    bauds = MappingProxyType(
        {0: 1_000_000, 1: 500_000, 2: 250_000, 3: 128_000, 4: 115_200, 5: 76_800, 6: 57_600, 7: 38_400}
    )
    default_model = "STS3250"
    instructions = BASIC_INSTRUCTIONS | {Instruction.REG_WRITE, Instruction.ACTION}

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

    def reply_code(self, refusal: Refusal, alerts: int) -> int:
        """Return the bits of the alerts: this protocol does not say why a servo refused."""
        del refusal
        return alerts

    def table(self, motor: Motor) -> Table:
        """Return the table of an STS servo: without a watchdog, it holds its last goal when the host is gone."""
        hottest = round(motor.temperature_limit)
        min_voltage, max_voltage = (round(10 * end) for end in motor.volts_range)
        return Table(
            model=motor.name,
            number=motor.model_number,
            protocol=self.name,
            motor=motor,
            registers=(
                Register(name="firmware", address=0, size=1, initial=3),
                Register(name="model_number", address=3, size=2, initial=motor.model_number),
                Register(name="id", address=5, size=1, writable=True, initial=1, span=(0, 253)),
                Register(name="baud_rate", address=6, size=1, writable=True, span=(0, 7)),
                Register(name="return_delay", address=7, size=1, unit=2e-6, writable=True, span=(0, 254)),
                Register(name="status_level", address=8, size=1, writable=True, initial=1, span=(0, 1)),
                Register(name="position_low", address=9, size=2, unit=STEP, writable=True, span=(0, STEPS - 1)),
                Register(name="position_high", address=11, size=2, unit=STEP, writable=True, initial=STEPS - 1,
                         span=(0, STEPS - 1)),
                Register(name="temperature_limit", address=13, size=1, writable=True, initial=hottest, span=(0, 100)),
                Register(name="voltage_high", address=14, size=1, unit=0.1, writable=True, initial=max_voltage),
                Register(name="voltage_low", address=15, size=1, unit=0.1, writable=True, initial=min_voltage),
                Register(name="max_torque", address=16, size=2, writable=True, initial=1000, span=(0, 1000)),
                Register(name="phase", address=18, size=1, writable=True, initial=12),
                Register(name="shutdown", address=19, size=1, writable=True, initial=44),
                Register(name="led_alarm", address=20, size=1, writable=True, initial=47),
                Register(name="position_p_gain", address=21, size=1, writable=True, initial=32, span=(0, 254)),
                Register(name="position_d_gain", address=22, size=1, writable=True, initial=32, span=(0, 254)),
                Register(name="position_i_gain", address=23, size=1, writable=True, span=(0, 254)),
                Register(name="min_startup_force", address=24, size=2, writable=True, initial=16, span=(0, 1000)),
                Register(name="clockwise_dead_zone", address=26, size=1, writable=True, initial=1, span=(0, 32)),
                Register(name="counterclockwise_dead_zone", address=27, size=1, writable=True, initial=1,
                         span=(0, 32)),
                Register(name="protection_current", address=28, size=2, unit=6.5e-3, writable=True, initial=310,
                         span=(0, 511)),
                Register(name="angular_resolution", address=30, size=1, writable=True, initial=1, span=(1, 3)),
                Register(name="homing_offset", address=31, size=2, unit=STEP, sign="bit", sign_bit=11, writable=True),
                Register(name="operating_mode", address=33, size=1, writable=True, span=(0, 3)),
                Register(name="protective_torque", address=34, size=1, writable=True, initial=20, span=(0, 100)),
                Register(name="protection_time", address=35, size=1, unit=0.01, writable=True, initial=200,
                         span=(0, 254)),
                Register(name="overload_torque", address=36, size=1, writable=True, initial=80, span=(0, 100)),
                Register(name="velocity_p_gain", address=37, size=1, writable=True, initial=10, span=(0, 254)),
                Register(name="overcurrent_time", address=38, size=1, unit=0.01, writable=True, initial=200,
                         span=(0, 254)),
                Register(name="velocity_i_gain", address=39, size=1, writable=True, initial=10, span=(0, 254)),
                Register(name="torque_enable", address=40, size=1, writable=True, span=(0, 128)),
                Register(name="acceleration", address=41, size=1, unit=100 * STEP, writable=True, span=(0, 254)),
                Register(name="goal_position", address=42, size=2, unit=STEP, sign="bit", writable=True, initial=2048),
                Register(name="goal_time", address=44, size=2, writable=True),
                Register(name="goal_velocity", address=46, size=2, unit=STEP, sign="bit", writable=True),
                Register(name="torque_limit", address=48, size=2, writable=True, initial=1000, span=(0, 1000)),
                Register(name="lock", address=55, size=1, writable=True, initial=1, span=(0, 1)),
                Register(name="present_position", address=56, size=2, unit=STEP, sign="bit", initial=2048),
                Register(name="present_velocity", address=58, size=2, unit=STEP, sign="bit"),
                Register(name="present_load", address=60, size=2, unit=1e-3, sign="bit", sign_bit=10),
                Register(name="present_voltage", address=62, size=1, unit=0.1, initial=120),
                Register(name="present_temperature", address=63, size=1, initial=25),
                Register(name="registered_instruction", address=64, size=1),
                Register(name="hardware_error", address=65, size=1),
                Register(name="moving", address=66, size=1),
                Register(name="present_current", address=69, size=2, unit=6.5e-3, sign="bit"),
            ),
            felt=("present_position", "present_current"),
            bauds=self.bauds,
            persistent=40,
            modes={0: "position", 1: "velocity", 2: "voltage", 3: "step"},
            offset_sign=-1,
            centering=_CENTERING,
            extent=87,
            other_registers=((80, 87, "factory parameters"),),
            alerts=((0, "input voltage"), (1, "encoder"), (2, "overheated"), (3, "current"), (5, "overload")),
        )  # fmt: skip


protocol = Feetech()

"""The makers' own software speaks with our emulator: what it reads and writes is what we do."""

# ruff: noqa: N802, N815 - the names are those of the makers' software

import pytest
from tests.wires import emulated

from suchus.hardware.protocols import servo_table

dynamixel = pytest.importorskip("dynamixel_sdk", reason="the maker's software, a judge only, is not installed")
feetech = pytest.importorskip("scservo_sdk", reason="the maker's software, a judge only, is not installed")


class Handler:
    """A port of the makers' software over a bus in memory."""

    def __init__(self, port):
        self._port, self._bytes = port, bytearray()
        self.is_using, self._empty = False, 0
        self.sent = []

    def clearPort(self):
        self._bytes += self._port.receive(0.0)
        self._bytes.clear()

    def writePort(self, packet):
        self.sent.append(bytes(packet))
        self._port.send(self.sent[-1], 1.0)
        self._empty = 0
        return len(packet)

    def readPort(self, length):
        self._bytes += self._port.receive(0.0)
        data, self._bytes = list(self._bytes[:length]), self._bytes[length:]
        self._empty += not data
        return data

    def setPacketTimeout(self, length):
        pass

    setPacketTimeoutMillis = setPacketTimeout

    def isPacketTimeout(self):
        return self._empty > 3

    def getBaudRate(self):
        return 1_000_000


def judge(protocol, trouble=None):
    emulator, bus = emulated(protocol, trouble)
    theirs = Handler(bus.port)
    if protocol == "dynamixel":
        return emulator, bus, theirs, dynamixel.PacketHandler(2.0), dynamixel
    return emulator, bus, theirs, feetech.PacketHandler(0), feetech


@pytest.mark.parametrize("protocol", ["dynamixel", "feetech"])
def test_the_makers_software_pings_reads_and_writes(protocol):
    emulator, bus, port, handler, sdk = judge(protocol)
    table = emulator.servos[0].table
    number, result, error = handler.ping(port, 5)
    assert (number, result, error) == (table.number, sdk.COMM_SUCCESS, 0)
    goal, enable = table["goal_position"], table["torque_enable"]
    write, read = (
        (handler.write4ByteTxRx, handler.read4ByteTxRx)
        if goal.size == 4
        else (handler.write2ByteTxRx, handler.read2ByteTxRx)
    )
    assert handler.write1ByteTxRx(port, 5, enable.address, 1) == (sdk.COMM_SUCCESS, 0)
    assert write(port, 5, goal.address, 2345) == (sdk.COMM_SUCCESS, 0)
    assert bus.read(5, goal) == 2345
    assert read(port, 5, goal.address)[:2] == (2345, sdk.COMM_SUCCESS)
    bus.pass_until(1)
    assert read(port, 5, table["present_position"].address)[0] == 2345
    assert handler.ping(port, 77)[1] == sdk.COMM_RX_TIMEOUT


@pytest.mark.parametrize("protocol", ["dynamixel", "feetech"])
def test_requests_of_the_makers_software_are_ours_byte_for_byte(protocol):
    emulator, bus, port, handler, sdk = judge(protocol)
    table, framing = emulator.servos[0].table, bus.protocol
    goal, felt = table["goal_position"], table.block(table.felt)
    handler.ping(port, 3)
    assert port.sent[0] == framing.ping(3)
    values = {1: 0xFDFF, 2: 2048, 19: 4095}
    group = sdk.GroupSyncWrite(port, handler, goal.address, goal.size)
    for servo, value in values.items():
        group.addParam(servo, list(value.to_bytes(goal.size, "little")))
    group.txPacket()
    assert port.sent[-1] == framing.sync_write(
        goal.address, {s: v.to_bytes(goal.size, "little") for s, v in values.items()}
    )
    group = sdk.GroupSyncRead(port, handler, *felt)
    for servo in (1, 2, 19):
        group.addParam(servo)
    assert group.txRxPacket() == sdk.COMM_SUCCESS
    assert port.sent[-1] == framing.sync_read((1, 2, 19), *felt)
    position = table["present_position"]
    assert [group.getData(servo, position.address, position.size) for servo in (1, 2, 19)] == [2048] * 3


def test_what_we_stuff_the_makers_software_unstuffs():
    """It loses the stuffing of what it sends itself (version 4.1.0), so that only this way round can be compared."""
    emulator, _, port, handler, sdk = judge("dynamixel")
    emulator.servos[0].memory[132:136] = b"\xff\xff\xfd\x00"
    assert handler.read4ByteTxRx(port, 1, 132) == (0xFDFFFF, sdk.COMM_SUCCESS, 0)


def test_the_alert_and_the_refusals_of_an_emulated_servo_are_read_by_the_makers_software():
    emulator, bus, port, handler, sdk = judge("dynamixel")
    table = servo_table("XM430-W350")
    handler.write1ByteTxRx(port, 1, 64, 1)
    assert handler.write1ByteTxRx(port, 1, table["return_delay"].address, 0)[1] == sdk.ERRNUM_ACCESS
    assert handler.write4ByteTxRx(port, 1, 116, 5000)[1] == sdk.ERRNUM_DATA_LIMIT
    assert bus.read(1, table["goal_position"]) == 2048  # the old goal stays
    emulator.servos[0].fail("overheated")
    assert handler.ping(port, 1)[2] == sdk.ERRBIT_ALERT
    assert handler.read1ByteTxRx(port, 1, 70)[0] == 1 << 2
    handler.reboot(port, 1)
    assert handler.ping(port, 1)[2] == 0


def test_feetech_refuses_its_memory_until_it_is_unlocked():
    _, bus, port, handler, _ = judge("feetech")
    table = servo_table("STS3250")
    handler.write1ByteTxRx(port, 1, table["return_delay"].address, 9)
    assert bus.read(1, table["return_delay"]) == 0
    handler.write1ByteTxRx(port, 1, table["lock"].address, 0)
    handler.write1ByteTxRx(port, 1, table["return_delay"].address, 9)
    assert bus.read(1, table["return_delay"]) == 9

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


def test_a_bulk_read_of_the_makers_software_is_answered():
    """Case bus_bulk: different registers of several servos in one request, which nobody answered."""
    emulator, _, port, handler, sdk = judge("dynamixel")
    bulk = sdk.GroupBulkRead(port, handler)
    bulk.addParam(1, 132, 4)
    bulk.addParam(2, 126, 2)
    bulk.addParam(19, 146, 1)
    assert bulk.txRxPacket() == sdk.COMM_SUCCESS
    assert bulk.getData(1, 132, 4) == 2048
    assert bulk.getData(2, 126, 2) == emulator.servos[1].get("present_current")
    assert bulk.getData(19, 146, 1) == 25
    bulk.addParam(77, 132, 4)
    assert bulk.txRxPacket() == sdk.COMM_RX_TIMEOUT
    write = sdk.GroupBulkWrite(port, handler)
    write.addParam(1, 64, 1, [1])
    write.addParam(3, 116, 4, list((2300).to_bytes(4, "little")))
    write.txPacket()
    assert [emulator.servos[0].get("torque_enable"), emulator.servos[2].get("goal_position")] == [1, 2300]


@pytest.mark.parametrize("kind", ["sync", "bulk"])
def test_fast_reads_of_the_makers_software_are_answered_in_one_packet(kind):
    emulator, _, port, handler, sdk = judge("dynamixel")
    emulator.servos[1].put("present_position", 0x00FDFFFF)  # bytes that would be stuffed in another reply
    if kind == "sync":
        group = sdk.GroupSyncRead(port, handler, 132, 4)
        for servo in (1, 2, 19):
            group.addParam(servo)
        assert group.fastSyncRead() == sdk.COMM_SUCCESS
    else:
        group = sdk.GroupBulkRead(port, handler)
        for servo in (1, 2, 19):
            group.addParam(servo, 132, 4)
        assert group.fastBulkRead() == sdk.COMM_SUCCESS
    assert [group.getData(servo, 132, 4) for servo in (1, 2, 19)] == [2048, 0x00FDFFFF, 2048]
    group.addParam(*((77,) if kind == "sync" else (77, 132, 4)))
    assert (group.fastSyncRead() if kind == "sync" else group.fastBulkRead()) != sdk.COMM_SUCCESS


def test_homing_offset_and_turns_beyond_one_are_as_the_makers_software_expects():
    """Case bus_offset: the position moves by the homing offset, and mode 4 takes a goal beyond a turn."""
    emulator, bus, port, handler, sdk = judge("dynamixel")
    before = handler.read4ByteTxRx(port, 1, 132)[0]
    assert handler.write4ByteTxRx(port, 1, 20, 300) == (sdk.COMM_SUCCESS, 0)
    assert handler.read4ByteTxRx(port, 1, 132)[0] == before + 300
    bus.pass_until(2)
    assert handler.read4ByteTxRx(port, 1, 132)[0] == before + 300
    assert handler.write1ByteTxRx(port, 1, 11, 4) == (sdk.COMM_SUCCESS, 0)
    assert handler.write4ByteTxRx(port, 1, 116, 5000) == (sdk.COMM_SUCCESS, 0)
    assert handler.write1ByteTxRx(port, 1, 64, 1) == (sdk.COMM_SUCCESS, 0)
    assert handler.write4ByteTxRx(port, 1, 20, 0)[1] == sdk.ERRNUM_ACCESS  # torque is on
    assert handler.write4ByteTxRx(port, 2, 116, 5000)[1] == sdk.ERRNUM_DATA_LIMIT  # in mode 3
    bus.pass_until(3)
    assert emulator.body.goals[0] == pytest.approx((5000 - 300 - 2048) * 2 * 3.141592653589793 / 4096)


def test_a_read_that_no_servo_can_answer_is_refused():
    _, _, port, handler, sdk = judge("dynamixel")
    assert handler.readTxRx(port, 1, 0, 62960)[1:] == (sdk.COMM_SUCCESS, sdk.ERRNUM_DATA_LENGTH)
    assert handler.readTxRx(port, 1, 0, 147)[1:] == (sdk.COMM_SUCCESS, 0)


def test_the_configuration_of_a_new_dynamixel_by_its_makers_software():
    """As set-up programs do: a new number, no delay, a mode, limits, gains and a profile; then a registered write."""
    emulator, bus, port, handler, sdk = judge("dynamixel")
    ok = (sdk.COMM_SUCCESS, 0)
    del emulator.lines[0].devices[19]  # so that its number is free
    assert handler.write1ByteTxRx(port, 5, 7, 19) == ok
    assert handler.ping(port, 5)[1] == sdk.COMM_RX_TIMEOUT
    assert handler.ping(port, 19)[0] == 1020
    for size, address, value in (
        (1, 9, 0), (1, 11, 3), (4, 48, 3000), (4, 52, 1000), (1, 63, 53), (2, 84, 400), (4, 108, 20), (4, 112, 50),
        (1, 64, 1),
    ):  # fmt: skip
        write = {1: handler.write1ByteTxRx, 2: handler.write2ByteTxRx, 4: handler.write4ByteTxRx}[size]
        assert write(port, 19, address, value) == ok, address
    assert handler.write4ByteTxRx(port, 19, 116, 3001)[1] == sdk.ERRNUM_DATA_LIMIT
    assert handler.regWriteTxRx(port, 19, 116, 4, list((2500).to_bytes(4, "little"))) == ok
    assert bus.read(19, emulator.servos[4].table["goal_position"]) == 2048
    handler.action(port, 0xFE)
    assert bus.read(19, emulator.servos[4].table["goal_position"]) == 2500


def test_the_calibration_of_a_feetech_servo_by_its_makers_software():
    """As LeRobot does it: unlock, mode, offset of zero, middle, limits, gains, acceleration, lock."""
    emulator, bus, port, handler, sdk = judge("feetech")
    ok, i = (sdk.COMM_SUCCESS, 0), 2
    emulator.body.angles[i] = 0.7
    bus.pass_until(1)
    assert handler.read2ByteTxRx(port, 3, 56)[0] == 2048 + round(0.7 * 4096 / 6.283185307179586)
    for address, value in ((55, 0), (33, 0), (40, 0)):
        assert handler.write1ByteTxRx(port, 3, address, value) == ok
    assert handler.write1ByteTxRx(port, 3, 40, 128) == ok
    assert handler.read2ByteTxRx(port, 3, 56)[0] == 2048
    assert handler.read1ByteTxRx(port, 3, 40)[0] == 0  # the command is no state
    assert handler.read2ByteTxRx(port, 3, 31)[0] == round(0.7 * 4096 / 6.283185307179586)
    bus.pass_until(2)
    assert handler.read2ByteTxRx(port, 3, 56)[0] == 2048
    for address, value in ((21, 16), (22, 32), (23, 0), (41, 254)):
        assert handler.write1ByteTxRx(port, 3, address, value) == ok
        assert handler.read1ByteTxRx(port, 3, address)[0] == value
    assert handler.write1ByteTxRx(port, 3, 41, 0) == ok
    assert handler.write1ByteTxRx(port, 3, 40, 1) == ok
    assert handler.write2ByteTxRx(port, 3, 42, 2148) == ok
    bus.pass_until(4)
    assert handler.read2ByteTxRx(port, 3, 56)[0] == 2148
    assert emulator.body.angles[i] == pytest.approx(0.7 + 100 * 6.283185307179586 / 4096, abs=0.002)


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

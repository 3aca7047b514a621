"""Servo buses: packets, control tables, ports, and the wiring of servos."""

from suchus.hardware.bus.bus import WAIT, Bus, Counts, NoAnswer
from suchus.hardware.bus.packets import BROADCAST, Decoder, Framing, Instruction, Packet
from suchus.hardware.bus.ports import BusGone, FilePort, Port, bit_rate, latency_timer, open_port
from suchus.hardware.bus.tables import STEPS, TABLES, BusProtocol, Register, Table
from suchus.hardware.bus.wiring import (
    CLOCK,
    FRAMINGS,
    BoardPlace,
    BusPlace,
    ServoPlace,
    Steps,
    Wiring,
    board_table,
    check_names,
    duplicates,
    fingerprint,
    straight,
)

__all__ = [
    "BROADCAST",
    "CLOCK",
    "FRAMINGS",
    "STEPS",
    "TABLES",
    "WAIT",
    "BoardPlace",
    "Bus",
    "BusGone",
    "BusPlace",
    "BusProtocol",
    "Counts",
    "Decoder",
    "FilePort",
    "Framing",
    "Instruction",
    "NoAnswer",
    "Packet",
    "Port",
    "Register",
    "ServoPlace",
    "Steps",
    "Table",
    "Wiring",
    "bit_rate",
    "board_table",
    "check_names",
    "duplicates",
    "fingerprint",
    "latency_timer",
    "open_port",
    "straight",
]

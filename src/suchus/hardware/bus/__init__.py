"""Servo buses: packets, register tables, ports, and the wiring of servos."""

from suchus.hardware.bus.bus import WAIT, Bus, Counts, NoAnswer
from suchus.hardware.bus.packets import BROADCAST, Decoder, Instruction, Packet, Refusal
from suchus.hardware.bus.ports import BusGone, FilePort, Port, bit_rate, latency_timer, open_port, port_holders
from suchus.hardware.bus.protocol import BusProtocol, ChannelProtocol, PulseBoards, ServoProtocol
from suchus.hardware.bus.tables import STEP, STEPS, Mode, Register, Sign, Table, register_label
from suchus.hardware.bus.wiring import (
    CLOCK,
    BoardPlace,
    BusPlace,
    ServoPlace,
    Steps,
    Wiring,
    board_table,
    check_names,
    duplicates,
    fingerprint,
    own_models,
    straight,
)

__all__ = [
    "BROADCAST",
    "CLOCK",
    "STEP",
    "STEPS",
    "WAIT",
    "BoardPlace",
    "Bus",
    "BusGone",
    "BusPlace",
    "BusProtocol",
    "ChannelProtocol",
    "Counts",
    "Decoder",
    "FilePort",
    "Instruction",
    "Mode",
    "NoAnswer",
    "Packet",
    "Port",
    "PulseBoards",
    "Refusal",
    "Register",
    "ServoPlace",
    "ServoProtocol",
    "Sign",
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
    "own_models",
    "port_holders",
    "register_label",
    "straight",
]

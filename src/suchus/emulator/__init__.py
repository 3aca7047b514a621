"""Servos that are not there: buses with control tables, and behind them the simulated robot, on land or in the lake."""

from suchus.emulator.body import Commanded, EmulatedBody
from suchus.emulator.devices import USUAL, Board, Device, EmulatedServo
from suchus.emulator.emulator import Emulator, MemoryPort
from suchus.emulator.server import Server
from suchus.emulator.trouble import Trouble

__all__ = [
    "USUAL",
    "Board",
    "Commanded",
    "Device",
    "EmulatedBody",
    "EmulatedServo",
    "Emulator",
    "MemoryPort",
    "Server",
    "Trouble",
]

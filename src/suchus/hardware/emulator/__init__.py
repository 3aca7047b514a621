"""Emulated servos: buses with control tables, and behind them the simulated robot, on land or in the lake."""

from suchus.hardware.emulator.body import Commanded, EmulatedBody
from suchus.hardware.emulator.devices import Board, Device, EmulatedServo
from suchus.hardware.emulator.emulator import Emulator, MemoryPort
from suchus.hardware.emulator.server import Server
from suchus.hardware.emulator.trouble import Trouble

__all__ = [
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

"""PCA9685: a board of 16 channels of pulses for hobby servos, on an I2C bus; it answers nothing about the servos.

Source: NXP, "PCA9685, 16-channel, 12-bit PWM Fm+ I2C-bus LED controller", rev. 4.
"""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from suchus.core.errors import BusFailure, InvalidDesign
from suchus.hardware.bus.protocol import ChannelProtocol

MODE, PRESCALE, FIRST_CHANNEL, ALL_CHANNELS_OFF = 0x00, 0xFE, 0x06, 0xFD
"""Addresses: mode, prescaler, the first channel, and the byte that switches all channels off."""
ADDRESS = 0x40
"""Address of the first board; the next ones follow."""
_SLEEP, _INCREMENT, _FULL_OFF = 0x10, 0x20, 0x10
_CLOCK, _STEPS = 25e6, 4096  # [Hz] of its oscillator; steps of a period
_BLOCK = 8  # channels of a write of 32 bytes, the most that SMBus carries
MIN_RATE, MAX_RATE = 24.0, 1526.0
"""Rates of pulses that its prescaler can give [Hz]."""
CHANNELS = 16
"""Channels of a board [-]."""
_MAX_PRINTED_WRITES = 24  # writes that a dry run prints


class Wires(Protocol):
    """An I2C bus."""

    def write_i2c_block_data(self, i2c_addr: int, register: int, data: Sequence[int]) -> None:
        """Write bytes from a register of a chip on."""

    def close(self) -> None:
        """Let go of it."""


def open_wires(name: str) -> Wires:
    """Open an I2C bus, such as ``/dev/i2c-1``.

    Raises:
        BusFailure: there is none, or it may not be opened.
        InvalidDesign: the package for it is not installed.
    """
    try:
        import smbus2  # noqa: PLC0415  an optional extra, needed here only
    except ModuleNotFoundError as error:
        raise InvalidDesign(
            "an I2C bus needs the package smbus2, which is not installed: pip install 'suchus[hardware]' on Linux."
        ) from error
    if not Path(name).exists():
        bus_names = (
            ", ".join(map(str, sorted(Path("/dev").glob("i2c-*")))) or "none; switch I2C on, on a Pi by raspi-config"
        )
        raise BusFailure(f"there is no I2C bus {name}; there is {bus_names}.")
    try:
        opened: Any = smbus2.SMBus(name)
    except OSError as error:
        raise BusFailure(f"{name} cannot be opened as an I2C bus ({error.strerror or error}).") from error
    return opened


class Pulses:
    """The boards of one robot.

    Args:
        wires: the bus.
        boards: their numbers, from 0.
        rate: rate of pulses [Hz].

    Raises:
        InvalidDesign: a rate that the boards cannot give.
        BusFailure: a board does not answer.
    """

    def __init__(self, wires: Wires, boards: Sequence[int], rate: float) -> None:
        """Set the rate of pulses on all boards."""
        if not MIN_RATE <= rate <= MAX_RATE:
            raise InvalidDesign(
                f"the rate of pulses is {rate:g} Hz; {MIN_RATE:g} to {MAX_RATE:g} Hz is what the boards give."
            )
        self._wires, self.boards, self.rate = wires, tuple(boards), rate
        self.step = 1e6 / rate / _STEPS
        """Step of a pulse's width [us]."""
        for board in self.boards:
            self._write(board, MODE, [_SLEEP | _INCREMENT])  # its prescaler is only taken asleep
            self._write(board, PRESCALE, [round(_CLOCK / _STEPS / rate) - 1])
            self._write(board, MODE, [_INCREMENT])

    def send(self, pulses: Mapping[tuple[int, int], float]) -> None:
        """Set the pulse widths of channels.

        Args:
            pulses: widths by board and channel [us].
        """
        for board in self.boards:
            board_widths = {
                channel: width for (channel_board, channel), width in pulses.items() if channel_board == board
            }
            for start in range(0, CHANNELS, _BLOCK):
                self._block(board, {c: board_widths[c] for c in range(start, start + _BLOCK) if c in board_widths})

    def _block(self, board: int, widths: Mapping[int, float]) -> None:
        """Write successive channels at once; channels between them without a width are switched off."""
        if not widths:
            return
        first_channel, last_channel = min(widths), max(widths)
        data: list[int] = []
        for channel in range(first_channel, last_channel + 1):
            if channel in widths:
                data += [0, 0, *round(widths[channel] * 1e-6 * self.rate * _STEPS).to_bytes(2, "little")]
            else:
                data += [0, 0, 0, _FULL_OFF]
        self._write(board, FIRST_CHANNEL + 4 * first_channel, data)

    def off(self) -> None:
        """Switch all channels off: servos that get no pulses give no torque."""
        for board in self.boards:
            self._write(board, ALL_CHANNELS_OFF, [_FULL_OFF])

    def close(self) -> None:
        """Let go of the bus."""
        self._wires.close()

    def _write(self, board: int, register: int, data: Sequence[int]) -> None:
        """Write successive registers of a board, and refuse a board that does not answer."""
        try:
            self._wires.write_i2c_block_data(ADDRESS + board, register, list(data))
        except OSError as error:
            raise BusFailure(
                f"board {board} at address {ADDRESS + board:#x} does not answer ({error.strerror or error}): look at "
                "its "
                "power, its plug and the bridges of its address."
            ) from error


class PrintingWires:
    """A stand-in for an I2C bus, which tells the first writes.

    Args:
        say: takes a line of text.
    """

    def __init__(self, say: Callable[[str], None]) -> None:
        self._say, self._remaining_writes = say, _MAX_PRINTED_WRITES

    def write_i2c_block_data(self, i2c_addr: int, register: int, data: Sequence[int]) -> None:
        """Tell what would be written."""
        self._remaining_writes -= 1
        if self._remaining_writes >= 0:
            self._say(f"write {i2c_addr:#04x} {register:#04x}  {bytes(data).hex(' ')}")

    def close(self) -> None:
        """Do nothing."""


class Pca9685(ChannelProtocol):
    """PCA9685 boards on an I2C bus."""

    name = "pca9685"
    families = ("hobby servos",)
    channels = CHANNELS
    default_port = "/dev/i2c-1"

    def open(self, port: str, boards: Sequence[int], rate: float) -> Pulses:
        """Open an I2C bus, and set the rate of pulses on its boards."""
        return Pulses(open_wires(port), boards, rate)

    def open_printing(self, say: Callable[[str], None], boards: Sequence[int], rate: float) -> Pulses:
        """Return boards whose writes are told and not made."""
        return Pulses(PrintingWires(say), boards, rate)


protocol = Pca9685()

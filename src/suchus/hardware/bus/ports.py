"""Ports of a bus: serial port or socket; no call blocks for longer than its deadline."""

import errno
import os
import select
import socket
import termios
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from time import monotonic
from typing import Any, Protocol
from urllib.parse import urlsplit

from suchus.core.errors import BusFailure, InvalidDesign

LOOPBACK = ("127.0.0.1", "localhost", "::1")
"""Names of this computer that no other one reaches."""
ADAPTERS = Path("/sys/bus/usb-serial/devices")
"""Where Linux says how long an adapter keeps bytes back."""
_CHUNK = 4096  # bytes of a read
_GONE_ERRORS = (errno.EIO, errno.ENXIO, errno.ENODEV, errno.EPIPE, errno.ECONNRESET, errno.EBADF)


class BusGone(BusFailure):
    """The other end of a bus is gone."""


class Port(Protocol):
    """A connection to a bus."""

    name: str
    """As the user named it."""

    def send(self, data: bytes, timeout: float) -> None:
        """Send all of some bytes.

        Args:
            data: what to send.
            timeout: how long it may take [s].

        Raises:
            BusGone: the other end is gone, or takes nothing for so long.
        """

    def receive(self, timeout: float) -> bytes:
        """Return what has arrived; nothing if nothing does for so long [s].

        Raises:
            BusGone: the other end is gone.
        """

    def close(self) -> None:
        """Let go of it; it may be called twice."""


class FilePort:
    """A port over a file descriptor that does not block.

    Args:
        name: name of the port, for messages.
        descriptor: descriptor that is read and written; it stays the owner's.
        owner: what is closed at the end.
    """

    def __init__(self, name: str, descriptor: int, owner: Any) -> None:
        self.name, self._fd, self._owner = name, descriptor, owner
        os.set_blocking(descriptor, False)

    def send(self, data: bytes, timeout: float) -> None:
        """Send all of some bytes, see ``Port``."""
        end, remainder = monotonic() + timeout, memoryview(data)
        with self._noticing():
            while remainder:
                _, ready, _ = select.select((), (self._fd,), (), max(end - monotonic(), 0.0))
                if not ready:
                    raise BusGone(
                        f"the bus {self.name} took {len(data) - len(remainder)} of {len(data)} bytes and then none for "
                        f"{timeout:.3g} s: what is at its other end does not read; look at the adapter and its cable."
                    )
                with suppress(BlockingIOError):
                    remainder = remainder[os.write(self._fd, remainder) :]

    def receive(self, timeout: float) -> bytes:
        """Return the received bytes, see ``Port``; empty after a time without any."""
        with self._noticing():
            ready, _, _ = select.select((self._fd,), (), (), max(timeout, 0.0))
            if not ready:
                return b""
            try:
                data = os.read(self._fd, _CHUNK)
            except BlockingIOError:
                return b""
        if not data:
            raise BusGone(f"the bus {self.name} has ended: its adapter was unplugged, or the emulator ended.")
        return data

    def close(self) -> None:
        """Let go of it."""
        with suppress(OSError, termios.error):
            self._owner.close()

    @contextmanager
    def _noticing(self) -> Iterator[None]:
        """Turn the errors of a port that is gone into ``BusGone``."""
        try:
            yield
        except (OSError, ValueError) as error:  # a descriptor that was closed is -1
            if isinstance(error, BusFailure) or getattr(error, "errno", errno.EBADF) not in _GONE_ERRORS:
                raise
            raise BusGone(
                f"the bus {self.name} is gone ({getattr(error, 'strerror', None) or error}): its adapter was "
                "unplugged, or the emulator ended."
            ) from error


def open_port(name: str, baud: int) -> Port:
    """Open a port: the path of a serial port, or ``socket://127.0.0.1:PORT`` of an emulator.

    Args:
        name: name of the port.
        baud: bit rate of a serial port [1/s].

    Raises:
        BusFailure: there is no such port, it is none, or another process holds it.
        InvalidDesign: a socket on another computer: whoever hears one can move the robot.
    """
    return _socket(name) if name.startswith("socket://") else _serial(name, baud)


def _socket(name: str) -> Port:
    """Return a port that is a socket of an emulator on this computer."""
    address = urlsplit(name)
    try:
        port = address.port
    except ValueError:
        port = None
    if address.hostname not in LOOPBACK or port is None:
        raise InvalidDesign(
            f"the port is {name!r}; a socket is socket://127.0.0.1:PORT of an emulator on this computer, since nothing "
            "on the way is encrypted."
        )
    try:
        connection = socket.create_connection((address.hostname, port), timeout=2.0)
    except OSError as error:
        raise BusFailure(
            f"nobody listens at {name} ({error.strerror or error}): start suchus emulate first, which prints its port."
        ) from error
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return FilePort(name, connection.fileno(), connection)


def _serial(name: str, baud: int) -> Port:
    """Return a serial port, open for this process alone."""
    try:
        import serial  # noqa: PLC0415  an optional extra, needed here only
    except ModuleNotFoundError as error:
        raise InvalidDesign(
            "a serial port needs the package pyserial, which is not installed: pip install 'suchus[hardware]'."
        ) from error
    path = Path(name)
    if not path.exists():
        if not str(path.absolute()).startswith("/dev/"):
            raise BusFailure(
                f"there is no port {name}, and no adapter has such a name: start suchus emulate for this robot first, "
                "in another terminal, which makes it; a robot's own port begins with /dev/."
            )
        raise BusFailure(f"there is no port {name}; {_ports_text()}")
    if not path.is_char_device():
        raise BusFailure(f"{name} is no serial port but a {'folder' if path.is_dir() else 'file'}; {_ports_text()}")
    try:
        device = serial.Serial(name, baudrate=baud, timeout=0, write_timeout=0, exclusive=True)
    except (serial.SerialException, OSError, ValueError, termios.error) as error:
        busy = isinstance(error, OSError) and error.errno in (errno.EAGAIN, errno.EWOULDBLOCK, errno.EBUSY)
        if busy or "lock" in str(error).lower():
            raise BusFailure(f"{name} is held by another process: end that first.") from error
        if isinstance(error, OSError) and error.errno == errno.EACCES:
            raise BusFailure(
                f"{name} may not be opened by you: join the group that owns it, often dialout, and log in again."
            ) from error
        raise BusFailure(f"{name} cannot be opened at {baud} baud as a serial port: {error}.") from error
    others = port_holders(name)
    if others:
        device.close()
        raise BusFailure(
            f"{name} is open in another program too, process {others[0]}: a bus bears one host. End that one first."
        )
    _lower_latency(device)
    return FilePort(name, device.fileno(), device)


def port_holders(name: str) -> list[int]:
    """Return the processes, other than this one, that have a serial port open, as far as Linux shows them to us.

    Args:
        name: of the port, or of a link to it.
    """
    device = os.path.realpath(name)
    holders = []
    for folder in Path("/proc").glob("[0-9]*/fd"):
        process = int(folder.parent.name)
        if process == os.getpid():
            continue
        with suppress(OSError):
            targets = {str(entry.readlink()) for entry in folder.iterdir()}
            if device in targets and "/dev/ptmx" not in targets and "/dev/pts/ptmx" not in targets:
                holders.append(process)
    return sorted(holders)


def _ports_text() -> str:
    """Return a sentence that names the serial ports of this computer."""
    adapters = sorted(Path("/dev/serial/by-id").glob("*")) or sorted(Path("/dev").glob("tty[UA][SC][BM]*"))
    if adapters:
        return f"there is {', '.join(map(str, adapters))}."
    return (
        "no adapter is plugged in, or none that this computer has a driver for: plug it in, or start suchus emulate, "
        "which prints the port of an emulated robot."
    )


def _lower_latency(device: Any) -> None:
    """Set an adapter to pass bytes on without delay, where its driver allows it."""
    with suppress(OSError, ValueError, AttributeError, NotImplementedError):
        device.set_low_latency_mode(True)


def latency_timer(name: str) -> int | None:
    """Return how long an FTDI adapter keeps bytes back [ms]; None for other ports."""
    place = ADAPTERS / Path(os.path.realpath(name)).name / "latency_timer"
    try:
        return int(place.read_text(encoding="ascii"))
    except (OSError, ValueError):
        return None


def bit_rate(descriptor: int) -> int | None:
    """Return the bit rate that whoever opened the other end of a pseudo-terminal has set [1/s]; None if unreadable."""
    try:
        code = termios.tcgetattr(descriptor)[5]
    except termios.error:
        return None
    rates = {getattr(termios, name): int(name[1:]) for name in dir(termios) if name[:1] == "B" and name[1:].isdigit()}
    return rates.get(code)

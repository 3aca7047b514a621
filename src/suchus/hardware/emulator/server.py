"""An emulated robot behind ports that other processes open: pseudo-terminals, or sockets where there are none."""

import heapq
import os
import select
import socket
from collections.abc import Callable, Sequence
from contextlib import suppress
from itertools import count
from pathlib import Path
from threading import Event, Thread
from time import monotonic
from typing import Any

from suchus.core.errors import Unwritable
from suchus.hardware.bus import bit_rate, port_holders
from suchus.hardware.emulator.emulator import BITS, Emulator

try:
    import pty
    import tty
except ImportError:  # pragma: no cover - Windows
    pty = None  # type: ignore[assignment]

_CHUNK = 4096  # bytes of a read
_LOOK_INTERVAL = 1.0  # [s]; between two looks for a second host
_MAX_LAG = 0.25  # [s]; a machine that falls behind by more lets the robot's time wait


class Server:
    """Serves the buses of an emulator until it is told to stop.

    With a clock of its own the robot moves as a real one does, while time passes, and replies come when a wire would
    have brought them. An emulator whose clock is told the time answers at once.

    Args:
        emulator: what is served.
        links: paths at which the pseudo-terminals can be found, one for each bus; they are links, and go at the end.
        sockets: whether to listen on sockets of this computer instead of pseudo-terminals.
        say: is given a sentence where a second host is on a bus.

    Raises:
        Unwritable: a link cannot be made.
    """

    def __init__(
        self,
        emulator: Emulator,
        links: Sequence[str | Path] = (),
        *,
        sockets: bool = False,
        say: Callable[[str], None] = lambda _: None,
    ) -> None:
        """Open a port for each bus of an emulator."""
        self._say, self._seen_hosts = say, set[tuple[int, ...]]()
        self._emulator = emulator
        sockets = sockets or pty is None
        self._ends: list[Any] = []
        self._linked: list[Path] = []
        for number in range(len(emulator.lines)):
            self._ends.append(_Socket(say) if sockets else _Terminal())
            if not sockets and links:
                self._link(Path(links[number]), self._ends[-1].name)
        self.ports: tuple[str, ...] = tuple(str(path) for path in self._linked) or tuple(e.name for e in self._ends)
        """Names under which the buses are opened."""
        self._due: list[tuple[float, int, int, bytes, bool]] = []
        self._order = count()

    def serve(
        self, should_stop: Callable[[], bool] = lambda: False, after_period: Callable[[], None] = lambda: None
    ) -> None:
        """Serve until told to stop, or the robot can move no more.

        Args:
            should_stop: asked now and then whether to stop.
            after_period: called after each control period.

        Raises:
            Diverged: the simulation diverged.
        """
        end_event = Event()
        Thread(target=self._watch_hosts, args=(end_event,), daemon=True).start()
        try:
            self._serve(should_stop, after_period)
        finally:
            end_event.set()

    def _serve(self, should_stop: Callable[[], bool], after_period: Callable[[], None]) -> None:
        """Serve until told to stop, see ``serve``."""
        emulator, period = self._emulator, self._emulator.body.period
        due, last_tick = monotonic() + period, emulator.body.tick
        while not should_stop():
            clock_time = monotonic()
            wait = 0.1
            if not emulator.clocked:
                if clock_time >= due:  # one at a time: who waits for an answer waits for no more than one
                    emulator.step()
                    after_period()
                    clock_time = monotonic()
                    due = max(due + period, clock_time - _MAX_LAG)
                wait = min(wait, due - clock_time)
            if self._due:
                wait = min(wait, self._due[0][0] - clock_time)
            self._listen(max(wait, 0.0))
            self._deliver()
            if emulator.clocked and emulator.body.tick != last_tick:
                last_tick = emulator.body.tick
                after_period()
            if emulator.diverged is not None:
                raise emulator.diverged

    def _watch_hosts(self, end_event: Event) -> None:
        """Look for a second host now and then, beside the loop, which nothing may delay."""
        while not end_event.wait(_LOOK_INTERVAL):
            self.look_for_hosts()

    def look_for_hosts(self) -> None:
        """Say where several programs have the port of a bus open, once for each company of them."""
        for number, end in enumerate(self._ends):
            if not isinstance(end, _Terminal):
                continue
            hosts = tuple(port_holders(end.name))
            if len(hosts) > 1 and hosts not in self._seen_hosts:
                self._seen_hosts.add(hosts)
                self._say(
                    f"{len(hosts)} programs have {self.ports[number]} open, processes "
                    f"{' and '.join(str(host) for host in hosts)}: a bus bears one host, since replies do not say "
                    "whose they are. End the others."
                )

    def close(self) -> None:
        """Close the ports and take the links away."""
        for path in self._linked:
            with suppress(OSError):
                path.unlink()
        for end in self._ends:
            end.close()

    def _listen(self, wait: float) -> None:
        """Receive requests for at most some time [s], and pass them to the emulator or queue them."""
        by_file = {file: number for number, end in enumerate(self._ends) for file in end.files}
        ready, _, _ = select.select(list(by_file), (), (), wait)
        clock_time, latency = monotonic(), self._emulator.trouble.latency
        for file in ready:
            number = by_file[file]
            data = self._ends[number].receive(file)
            if not data:
                continue
            if self._emulator.clocked:
                self._hear(number, data, clock_time)
            else:
                transit_time = latency + len(data) * BITS / self._emulator.lines[number].baud
                heapq.heappush(self._due, (clock_time + transit_time, next(self._order), number, data, True))

    def _deliver(self) -> None:
        """Let requests and replies arrive that are due."""
        while self._due and self._due[0][0] <= monotonic():
            arrival_time, _, number, data, request = heapq.heappop(self._due)
            if request:
                self._hear(number, data, arrival_time)
            else:
                self._ends[number].send(data)

    def _hear(self, number: int, data: bytes, arrival_time: float) -> None:
        """Pass a request to the emulator, and queue its replies with the delays of the bus."""
        emulator = self._emulator
        for delay, reply in emulator.hear(number, data, self._ends[number].baud):
            if emulator.clocked:
                self._ends[number].send(reply)
            else:
                arrives = arrival_time + delay + emulator.trouble.latency
                heapq.heappush(self._due, (arrives, next(self._order), number, reply, False))

    def _link(self, path: Path, name: str) -> None:
        """Make a symbolic link to a port, in place of one that a killed emulator left."""
        try:
            if path.is_symlink() and not path.exists() and str(path.readlink()).startswith("/dev/"):
                path.unlink()  # of an emulator that was killed
            path.parent.mkdir(parents=True, exist_ok=True)
            path.symlink_to(name)
        except OSError as error:
            self.close()
            raise Unwritable(
                f"the port cannot be linked as {path} ({error.strerror or error}): end the emulator that serves it, "
                "take away what is there, or let --hardware name another port."
            ) from error
        self._linked.append(path)


class _Terminal:
    """A pseudo-terminal: whoever opens its name is the host."""

    def __init__(self) -> None:
        """Open a pseudo-terminal, whose name hosts open as a serial port."""
        self._controller_fd, self._terminal_fd = pty.openpty()
        tty.setraw(self._terminal_fd)  # it stays open, else a host that leaves would end it for all
        os.set_blocking(self._controller_fd, False)
        self.name = os.ttyname(self._terminal_fd)
        self.files = [self._controller_fd]

    @property
    def baud(self) -> int | None:
        """Bit rate that the host has set [1/s]; None if it cannot be told."""
        return bit_rate(self._controller_fd)

    def receive(self, file: int) -> bytes:
        """Return what has come."""
        try:
            return os.read(file, _CHUNK)
        except OSError:
            return b""

    def send(self, data: bytes) -> None:
        """Send bytes; what a host that does not read leaves lying about is lost."""
        with suppress(OSError):
            os.write(self._controller_fd, data)

    def close(self) -> None:
        """Close both ends."""
        for file in (self._controller_fd, self._terminal_fd):
            with suppress(OSError):
                os.close(file)


class _Socket:
    """A socket of this computer, for one host at a time; its bit rate is always right."""

    baud = None

    def __init__(self, say: Callable[[str], None]) -> None:
        self._say = say
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._listener.setblocking(False)
        self._host: socket.socket | None = None
        self.name = f"socket://127.0.0.1:{self._listener.getsockname()[1]}"

    @property
    def files(self) -> list[int]:
        """What to listen to."""
        return [self._listener.fileno(), *([] if self._host is None else [self._host.fileno()])]

    def receive(self, file: int) -> bytes:
        """Return what has come; take a host, or refuse it while there is another one."""
        if file == self._listener.fileno():
            with suppress(OSError):
                host, address = self._listener.accept()
                if self._is_busy():
                    host.close()
                    self._say(
                        f"a second host (port {address[1]} of this computer) wanted {self.name}, which another one "
                        "has: it was refused."
                    )
                    return b""
                host.setblocking(False)
                host.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self._leave()
                self._host = host
            return b""
        try:
            data = self._host.recv(_CHUNK) if self._host is not None else b""
        except BlockingIOError:
            return b""
        except OSError:
            data = b""
        if not data:
            self._leave()
        return data

    def send(self, data: bytes) -> None:
        """Send bytes to the host."""
        if self._host is not None:
            with suppress(OSError):
                self._host.sendall(data)

    def close(self) -> None:
        """Close all."""
        self._leave()
        self._listener.close()

    def _is_busy(self) -> bool:
        """Return whether there is a host that has not closed its end."""
        if self._host is None:
            return False
        try:
            return self._host.recv(1, socket.MSG_PEEK) != b""
        except BlockingIOError:
            return True
        except OSError:
            return False

    def _leave(self) -> None:
        if self._host is not None:
            self._host.close()
            self._host = None

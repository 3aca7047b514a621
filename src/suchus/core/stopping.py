"""Requests to stop: SIGTERM and SIGHUP end a command as Ctrl-C does, and workers end with whom they work for."""

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from multiprocessing import parent_process
from multiprocessing.connection import wait
from threading import Event, Thread, current_thread, main_thread
from time import monotonic
from types import FrameType

STOP_TIMEOUT = 1.5
"""Time after which a process that was told to stop ends, whatever it is at [s]."""
CUT_MESSAGE = (
    "suchus: stopped while it was busy; what was finished is kept, the next run takes away what is half-written.\n"
)
"""What is said where that time was too short."""
_POLL_INTERVAL = 0.1  # [s]; between two looks whether it has ended by itself
_finishing_times: list[float] = []  # what ``finishing`` asks for


class StopSignal(KeyboardInterrupt):
    """A signal asked the process to stop.

    Attributes:
        number: of the signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__()
        self.number = number


@contextmanager
def stopping() -> Iterator[None]:
    """While the block runs, let SIGTERM and SIGHUP raise ``StopSignal``.

    After ``STOP_TIMEOUT`` the process ends all the same.

    What compiled code does in between hears no signal. A signal that is ignored, as under nohup, or that somebody else
    handles, stays so.
    """
    if current_thread() is not main_thread():
        yield
        return
    stop_event, end_event, number = Event(), Event(), [signal.SIGTERM]

    def stop(signum: int, frame: FrameType | None) -> None:
        del frame
        number[0] = signal.Signals(signum)
        stop_event.set()
        raise StopSignal(signum)

    def see_to_it() -> None:
        """End the process if it still runs a time after the stop signal."""
        stop_event.wait()
        since = monotonic()
        while not end_event.wait(_POLL_INTERVAL):
            if monotonic() - since > max((STOP_TIMEOUT, *_finishing_times)):
                with suppress(OSError):  # nobody may read it
                    os.write(2, CUT_MESSAGE.encode())
                os._exit(128 + number[0])

    handled_signals = [s for s in (signal.SIGTERM, signal.SIGHUP) if signal.getsignal(s) == signal.SIG_DFL]
    for handled_signal in handled_signals:
        signal.signal(handled_signal, stop)
    Thread(target=see_to_it, daemon=True).start()
    try:
        yield
    finally:
        end_event.set()
        stop_event.set()
        for handled_signal in handled_signals:
            signal.signal(handled_signal, signal.SIG_DFL)


@contextmanager
def finishing(seconds: float) -> Iterator[None]:
    """While the block runs, a process that is told to stop may take longer: a robot is let down, and its log written.

    Args:
        seconds: after which it ends all the same [s].
    """
    _finishing_times.append(seconds)
    try:
        yield
    finally:
        _finishing_times.remove(seconds)


@contextmanager
def deferred_signals() -> Iterator[None]:
    """While the block runs, hold Ctrl-C, SIGTERM and SIGHUP back; they act when the block has ended.

    It is for a short block that must not be cut, such as writing what was measured once and cannot be computed again.
    Outside the main thread, to which signals do not come, it does nothing.
    """
    if current_thread() is not main_thread():
        yield
        return
    pending: list[int] = []

    def note(signum: int, frame: FrameType | None) -> None:
        del frame
        pending.append(signum)

    handlers = {}
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) not in (signal.SIG_IGN, None):
            handlers[number] = signal.signal(number, note)
    try:
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
        for signum in dict.fromkeys(pending):
            signal.raise_signal(signum)


def end_with_parent() -> None:
    """Let this process end as soon as the one that started it has, whatever it is at and however that one ended."""
    parent = parent_process()
    if parent is not None:
        Thread(target=lambda: (wait([parent.sentinel]), os._exit(1)), daemon=True).start()

"""Whether a thread that a test began computes on after the tests: it would take the processor time of all others."""

import threading
import time

LOOKS = 10
"""How often one looks before one says so: a thread may be about to end [-]."""
INTERVAL = 0.1
"""How long a look takes [s]."""
MAX_BUSY_FRACTION = 0.5
"""Fraction of a processor that the process may take while its first thread sleeps [-]."""


def busy_threads() -> list[str]:
    """Return the names of all threads but this one, if they compute while this one sleeps; empty if they rest."""
    for _ in range(LOOKS):
        before = time.process_time()
        time.sleep(INTERVAL)
        if time.process_time() - before < MAX_BUSY_FRACTION * INTERVAL:
            return []
    return [thread.name for thread in threading.enumerate() if thread is not threading.current_thread()]

"""How many threads suchus uses: the one place that decides.

Set ``SUCHUS_THREADS`` to choose another number than the cores this process may run on.
"""

import os

from suchus.errors import OutsideLimits

os.environ.setdefault("OMP_WAIT_POLICY", "passive")  # threads that spin on and on starve their neighbours
# ... but to fall asleep and be woken costs 40 to 80 us at every parallel loop, as much as a small loop's own work. A
# short spin first makes it 2 us, and two threads of the flow solver 1.7 instead of 1.3 times one; a longer one (20 000,
# about 1 ms) gains nothing and burns the time of others where more threads want to run than there are cores.
os.environ.setdefault("GOMP_SPINCOUNT", "1000")


def count() -> int:
    """Return the number of threads to use.

    Raises:
        OutsideLimits: ``SUCHUS_THREADS`` is not a positive whole number.
    """
    asked = os.environ.get("SUCHUS_THREADS")
    if asked is None:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if not asked.isdecimal() or int(asked) < 1:
        raise OutsideLimits(f"SUCHUS_THREADS is {asked!r}; a whole number of at least 1 is needed.")
    return int(asked)

"""How many threads suchus uses: the one place that decides.

Set ``SUCHUS_THREADS`` to choose another number than the cores this process may run on.
"""

import os

from suchus.errors import OutsideLimits

os.environ.setdefault("OMP_WAIT_POLICY", "passive")  # spinning OpenMP threads starve their neighbours


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

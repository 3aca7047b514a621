"""The form in which a bench runs: the full one, or with ``SUCHUS_BENCH=short`` one of about a second, for the tests."""

import os
from typing import TypeVar

SHORT = os.environ.get("SUCHUS_BENCH") == "short"
"""Whether every bench runs in its short form, whose times say nothing."""

Size = TypeVar("Size")


def in_form(full: Size, short: Size) -> Size:
    """Return the size of what is timed in the form that is asked for."""
    return short if SHORT else full

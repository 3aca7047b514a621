"""How far something is: the one kind of callback with which everything in suchus tells it."""

from collections.abc import Callable

Progress = Callable[[str, float], None]
"""Called with what is being done and the share of it that is done, 0 to 1."""


def silent(stage: str, fraction: float) -> None:
    """Show no progress."""
    del stage, fraction


def staged(progress: Progress, stage: str, start: float, end: float) -> Progress:
    """Return the progress of what fills the part from ``start`` to ``end`` of the whole.

    Args:
        progress: progress of the whole.
        stage: name under which all of the part is told; empty for the names of its own stages.
        start: share of the whole at which the part begins [-].
        end: share at which it ends [-].
    """
    return lambda inner, fraction: progress(stage or inner, start + fraction * (end - start))


def portion(progress: Progress, number: int, count: int) -> Progress:
    """Return the progress of one part of several equal ones, counted from 0."""
    return staged(progress, "", number / count, (number + 1) / count)

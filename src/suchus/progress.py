"""How far something is: the one kind of callback with which everything in suchus tells it."""

from collections.abc import Callable

Progress = Callable[[str, float], None]
"""Called with what is being done and the share of it that is done, 0 to 1."""


def silent(stage: str, share: float) -> None:
    """Show no progress."""
    del stage, share


def staged(progress: Progress, stage: str, start: float, end: float) -> Progress:
    """Return the progress of one stage that fills the part from ``start`` to ``end`` of the whole, under its name."""
    return lambda _, share: progress(stage, start + share * (end - start))


def portion(progress: Progress, number: int, count: int) -> Progress:
    """Return the progress of one part of several equal ones, counted from 0."""
    return lambda stage, share: progress(stage, (number + share) / count)

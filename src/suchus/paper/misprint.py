"""One place where the article says something else than it means."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Misprint:
    """A misprint, a missing definition or a contradiction."""

    key: str
    """Its name here."""
    where: str
    """Section, equation, table or figure."""
    printed: str
    """What is printed."""
    ours: str
    """What suchus uses instead."""
    shows: str
    """What shows that the printed form fails."""

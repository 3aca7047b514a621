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
    """The formula or the words as printed."""
    ours: str
    """The form that suchus uses instead."""
    shows: str
    """Evidence that the printed form fails."""

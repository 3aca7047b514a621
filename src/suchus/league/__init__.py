"""The league: predictions of real machines and animals by every model, sealed before any measurement is opened."""

from suchus.league.contestant import (
    Contestant,
    Entrant,
    Family,
    Found,
    Given,
    Interval,
    Numbers,
    Quantity,
    Rung,
    Single,
    every,
    find,
    known,
)

__all__ = [
    "Contestant",
    "Entrant",
    "Family",
    "Found",
    "Given",
    "Interval",
    "Numbers",
    "Quantity",
    "Rung",
    "Single",
    "every",
    "find",
    "known",
]

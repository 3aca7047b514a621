"""The league: predictions of real machines and animals by every model, sealed before any measurement is opened."""

from evidence.league.contestant import (
    Contestant,
    ContestantFamily,
    Entrant,
    Found,
    Given,
    Interval,
    Numbers,
    Predictor,
    Quantity,
    SingleContestant,
    every,
    find,
    known,
)

__all__ = [
    "Contestant",
    "ContestantFamily",
    "Entrant",
    "Found",
    "Given",
    "Interval",
    "Numbers",
    "Predictor",
    "Quantity",
    "SingleContestant",
    "every",
    "find",
    "known",
]

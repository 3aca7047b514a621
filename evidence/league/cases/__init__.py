"""The catalog of contestants: one file, one machine or animal whose runs are predicted before anyone looks.

What was measured of them stands in ``measured``; nothing but ``league.sealing`` reads it, once a prediction is sealed.
"""

from operator import attrgetter
from pathlib import Path

from evidence.league import Entrant
from suchus.core.catalog import Catalog

CONTESTANTS: Catalog[Entrant] = Catalog(
    "contestant", "evidence.league.cases", "evidence.league:Entrant", name_of=attrgetter("name")
)
"""Contestants by name; those of a family have a number behind it, as ``catshark_2.5``."""


def measured_file(name: str) -> Path:
    """Return where what was measured of a contestant stands, if it is public; the file is not read here."""
    return Path(__file__).parent / "measured" / f"{name}.json"


__all__ = ["CONTESTANTS", "measured_file"]

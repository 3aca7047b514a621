"""In how many plausible designs each claim holds: the table that a run of ``suchus study claims`` left."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import resources
from types import MappingProxyType

ROBUST = 0.9
"""A verdict is fragile if fewer plausible designs than this share agree with it [-].

Nine in ten, set before the study was run: one design in ten drawn from our own ranges may disagree before a reader
should be warned.
"""
_FILE = "claims.json"


@dataclass(frozen=True, slots=True, kw_only=True)
class Share:
    """In how many plausible designs the statement of a claim holds."""

    claim: str
    """Its key."""
    share: float
    """Share of the designs that could be judged in which it holds [-]."""
    low: float
    """Lower end of the 95 % interval, after Wilson [-]."""
    high: float
    """Upper end [-]."""
    designs: int
    """Number of designs that could be judged [-]."""
    turned_by: str
    """The free number whose value best predicts where it holds; empty where none does beyond chance."""
    at: float | None
    """Its value there, in its own unit."""
    above: bool
    """Whether the statement rather holds above that value."""

    def robust(self, held: bool) -> bool:
        """Return whether enough designs agree with a verdict.

        Args:
            held: whether the statement held in the run that was judged.
        """
        return (self.share if held else 1.0 - self.share) >= ROBUST


def _shipped() -> Mapping[str, Share]:
    """Return the table that stands beside this module, empty where none was made yet."""
    file = resources.files("suchus.verdict") / _FILE
    if not file.is_file():
        return MappingProxyType({})
    table = json.loads(file.read_text(encoding="utf-8"))
    return MappingProxyType({key: Share(claim=key, **row) for key, row in table["claims"].items()})


def digest(claims: Mapping[str, Mapping[str, object]]) -> str:
    """Return the SHA-256 of a table's rows, which stands in the table beside them."""
    return hashlib.sha256(json.dumps(claims, sort_keys=True).encode()).hexdigest()


SHARES: Mapping[str, Share] = _shipped()
"""By claim."""

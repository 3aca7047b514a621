"""An arm, a condition of a comparison: the fields that it sets differently from all others."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from suchus.core.checks import Checks


@dataclass(frozen=True, slots=True, kw_only=True)
class Arm:
    """One side of a comparison; every sample is run with each of them."""

    name: str
    """Name in tables and folders."""
    values: Mapping[str, Any] = field(default_factory=dict)
    """Values that it sets, by field, after everything else; they win over what varies."""

    def __post_init__(self) -> None:
        with Checks("arm", self) as check:
            plain = bool(self.name) and all(c.isalnum() or c in "_-" for c in self.name)
            check.that(plain, f"arm.name is {self.name!r}; letters, digits, _ and - are allowed, at least one")

"""The shelf of gaits: one file, one gait, declared as ``gait`` with its ``chosen`` numbers."""

from typing import Any

from suchus.catalog import Catalog
from suchus.gaits._conditions import CONDITIONS, conditions

GAITS: Catalog[Any] = Catalog("gait", "suchus.gaits", "suchus.motion:AnyGait")
"""Of either kind; who needs one of them says so by the type of its field."""

__all__ = ["CONDITIONS", "GAITS", "conditions"]

"""The shelf of gaits: one file, one gait, declared as ``gait`` with its ``chosen`` numbers."""

from suchus.catalog import Catalog
from suchus.gaits._conditions import CONDITIONS, conditions
from suchus.motion import Gait

GAITS: Catalog[Gait] = Catalog("gait", "suchus.gaits", "suchus.motion:Gait")

__all__ = ["CONDITIONS", "GAITS", "conditions"]

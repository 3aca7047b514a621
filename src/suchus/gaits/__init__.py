"""The shelf of gaits: one file, one gait, declared as ``gait`` with its ``chosen`` numbers."""

from suchus.catalog import Catalog
from suchus.motion import AnyGait

GAITS: Catalog[AnyGait] = Catalog("gait", "suchus.gaits", "suchus.motion:AnyGait")

__all__ = ["GAITS"]

"""The shelf of experiments: one file, one question, declared as ``experiment``."""

from suchus.catalog import Catalog
from suchus.experiment import Experiment

EXPERIMENTS: Catalog[Experiment] = Catalog("experiment", "suchus.experiments", "suchus.experiment:Experiment")

__all__ = ["EXPERIMENTS"]

"""The shelf of experiments: one folder or one file, one question.

A folder holds ``experiment.py``, which declares ``experiment``, and beside it what belongs to the question alone: its
``rules``, its ``figure``, the words of what decided in ``explanation.md``, tables that it needs. Importing the shelf
imports none of them.
"""

from operator import methodcaller
from typing import TYPE_CHECKING

from suchus.core.catalog import Catalog

if TYPE_CHECKING:
    from suchus.experiments.experiment import Experiment

EXPERIMENTS: "Catalog[Experiment]" = Catalog(
    "experiment", "suchus.experiments.catalog", "suchus.experiments.experiment:Experiment", named=methodcaller("name")
)

__all__ = ["EXPERIMENTS"]

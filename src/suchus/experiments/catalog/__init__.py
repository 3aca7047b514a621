"""The catalog of experiments: each folder or file answers one question.

A folder holds ``experiment.py``, which declares ``experiment``. Its other files belong to this question alone: the
``rules``, the ``figure``, the text ``explanation.md`` on what decided, and tables. Importing the catalog imports no
experiment.
"""

from operator import methodcaller
from typing import TYPE_CHECKING

from suchus.core.catalog import Catalog

if TYPE_CHECKING:
    from suchus.experiments.experiment import Experiment

EXPERIMENTS: "Catalog[Experiment]" = Catalog(
    "experiment", "suchus.experiments.catalog", "suchus.experiments.experiment:Experiment", name_of=methodcaller("name")
)

__all__ = ["EXPERIMENTS"]

"""Every misprint of the article, by key.

The printed formulas can be run: they stand in ``suchus.kinematics.printed``, and tests set each beside ours.
"""

from collections.abc import Mapping
from types import MappingProxyType

from suchus.paper.errata_formulas import FORMULAS
from suchus.paper.errata_words import WORDS
from suchus.paper.misprint import Misprint

ERRATA: Mapping[str, Misprint] = MappingProxyType({m.key: m for m in (*FORMULAS, *WORDS)})
"""All misprints: tables and equations first, then signs, units, numbers and names."""

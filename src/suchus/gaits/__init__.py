"""The shelf of gaits: one file, one gait, declared as ``gait`` with its ``chosen`` numbers."""

from suchus.catalog import Catalog
from suchus.design import AnyRobot
from suchus.gaits._animal_swim import ANIMAL_SWIM
from suchus.gaits._conditions import CONDITIONS, conditions_of
from suchus.gaits._own import gait_of
from suchus.motion import Gait, suits

GAITS: Catalog[Gait] = Catalog("gait", "suchus.gaits", "suchus.motion:Gait")
"""The gaits of the shelf."""


def own_gait(robot: AnyRobot) -> Gait:
    """Return the gait in which a robot walks unless another one is asked for; see ``made_for`` in the gaits' files.

    Raises:
        UnsuitedRobot: no gait of the shelf suits it.
    """
    return gait_of(GAITS, robot)


__all__ = ["ANIMAL_SWIM", "CONDITIONS", "GAITS", "conditions_of", "own_gait", "suits"]

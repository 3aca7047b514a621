"""The shelf of gaits: one file, one gait, declared as ``gait`` with its ``chosen`` numbers."""

from operator import attrgetter
from pathlib import Path
from typing import Any

from suchus.catalog import Catalog
from suchus.design import AnyRobot
from suchus.gaits._animal_swim import ANIMAL_SWIM
from suchus.gaits._conditions import CONDITIONS, conditions, conditions_of
from suchus.gaits._own import gait_of, suits
from suchus.motion import AnyGait


def _read(path: Path) -> AnyGait:
    from suchus import blueprint  # noqa: PLC0415  half of the time of an import that reads no file

    gait: AnyGait = blueprint.read(path, AnyGait, GAITS)
    return gait


GAITS: Catalog[Any] = Catalog("gait", "suchus.gaits", "suchus.motion:AnyGait", named=attrgetter("name"), read=_read)
"""Of either kind; who needs one of them says so by the type of its field."""


def own_gait(robot: AnyRobot) -> AnyGait:
    """Return the gait in which a robot walks unless another one is asked for; see ``made_for`` in the gaits' files.

    Raises:
        UnsuitedRobot: no gait of the shelf suits it.
    """
    return gait_of(GAITS, robot)


__all__ = ["ANIMAL_SWIM", "CONDITIONS", "GAITS", "conditions", "conditions_of", "own_gait", "suits"]

"""The shelf of gaits: one file, one gait, declared as ``gait`` with its ``chosen`` numbers."""

from operator import attrgetter
from pathlib import Path

from suchus.catalog import Catalog
from suchus.design import Robot
from suchus.errors import UnreadableFile
from suchus.gaits._animal_swim import ANIMAL_SWIM
from suchus.gaits._conditions import CONDITIONS, conditions_of
from suchus.gaits._own import gait_of
from suchus.motion import Gait, form_of, suits
from suchus.record import read_toml
from suchus.robots import ROBOTS


def _read(path: Path) -> Gait:
    from suchus import blueprint  # noqa: PLC0415  half of the time of an import that reads no file

    data = read_toml(path)
    base = data.get("base")
    made_for = GAITS.beside(base, "made_for", ()) if isinstance(base, str) and base in GAITS else ()
    if form_of(data) is not None and not made_for:
        raise UnreadableFile(
            f"{path.name} gives metres or places along the body, which are those of a robot: start it from a gait that "
            "is made for one (base), give the file's path with its robot, or write the gait in limbs and axis, whose "
            "lengths are shares of the limbs' reach."
        )
    return blueprint.read_gait(path, ROBOTS[made_for[0] if made_for else "caiman"], GAITS)


GAITS: Catalog[Gait] = Catalog("gait", "suchus.gaits", "suchus.motion:Gait", named=attrgetter("name"), read=_read)
"""The gaits of the shelf."""


def own_gait(robot: Robot) -> Gait:
    """Return the gait in which a robot walks unless another one is asked for; see ``made_for`` in the gaits' files.

    Raises:
        UnsuitedRobot: no gait of the shelf suits it.
    """
    return gait_of(GAITS, robot)


__all__ = ["ANIMAL_SWIM", "CONDITIONS", "GAITS", "conditions_of", "own_gait", "suits"]

"""Gaits that ``suchus optimise fault`` found: one for each failed joint, and one for the intact robot."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from suchus.core.errors import UnreadableFile, UnsuitedRobot
from suchus.core.files import read_json
from suchus.robot.design import Robot, with_values
from suchus.robot.gaits import control_group
from suchus.robot.motion import Gait

KEPT_SEARCHES = Path(__file__).with_name("searches.json")
"""The outcome of the search for ``caiman``; ``tools/fault_gaits.py`` writes it."""
INTACT = "intact"
"""Name of the gait that was searched without a fault."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchedGaits:
    """The gaits of one search, and what made them."""

    seed: int
    """Seed of the search."""
    evaluations: int
    """Number of candidates that each condition tried [-]."""
    gaits: Mapping[str, Gait]
    """Gaits by condition: ``JOINT_GROUP`` and ``intact_GROUP``."""

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints for whose failure there is a gait, in the order of the search."""
        names = [name.removesuffix("_coordinated") for name in self.gaits if name.endswith("_coordinated")]
        return tuple(name for name in names if name != INTACT)


def read_searches(path: str | Path, robot: Robot, gait: Gait) -> SearchedGaits:
    """Return the gaits of a search from the ``outcome.json`` that it left.

    Args:
        path: of the file; empty for the search that is kept for ``caiman``.
        robot: robot that is to walk in them.
        gait: gait with which the search began; its control group was the beginning with limbs only.

    Raises:
        UnreadableFile: the file cannot be read, or is of another search.
        UnsuitedRobot: the gaits were searched for another robot, or from another gait.
    """
    file = Path(path) if str(path) else KEPT_SEARCHES
    outcome = read_json(file)
    is_search = isinstance(outcome, dict) and str(outcome.get("optimisation", "")).startswith("fault")
    if not is_search or not isinstance(outcome.get("arms"), dict) or "robot" not in outcome:
        raise UnreadableFile(
            f"{file} is no outcome of a search for failed joints; name the outcome.json of suchus optimise fault."
        )
    if (outcome["robot"], outcome["gait"]) != (robot.name, gait.name):
        raise UnsuitedRobot(
            f"the gaits of {file.name} were searched for robot {outcome['robot']!r} in the gait {outcome['gait']!r}, "
            f"and robot {robot.name!r} walks in {gait.name!r}; search its own with suchus optimise fault --robot "
            f"{robot.name}, and name the file with --searches out/optimise/fault_{robot.name}/result/outcome.json."
        )
    return SearchedGaits(
        seed=outcome["seed"],
        evaluations=max(arm["tried"] for arm in outcome["arms"].values()),
        gaits={name: _gait(name, arm, gait, file) for name, arm in outcome["arms"].items()},
    )


def _gait(name: str, arm: Mapping[str, Any], gait: Gait, file: Path) -> Gait:
    """Return the best gait of one condition of a search.

    Args:
        name: name of the condition.
        arm: what the outcome says of it.
        gait: gait with spine and tail with which the search began.
        file: file of the outcome, for the error.
    """
    start = control_group(gait) if name.endswith("_limbs_only") else gait
    try:
        fields = arm["best"][name]["fields"]
        values = {field.removeprefix("gait."): number["best"] for field, number in fields.items()}
    except (KeyError, TypeError, AttributeError) as error:
        raise UnreadableFile(
            f"{file} lacks the best gait of the condition {name!r}; name the outcome.json of suchus optimise fault."
        ) from error
    return with_values(start, {**values, "name": f"{name}_gait"})

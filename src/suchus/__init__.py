"""suchus: the open laboratory for crocodile-like robots.

Names are loaded when they are first asked for, so that ``import suchus`` costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from suchus.catalog import Catalog as Catalog
    from suchus.control import CONTROLLERS as CONTROLLERS
    from suchus.control import Coordinated as Coordinated
    from suchus.control import HeadingRule as HeadingRule
    from suchus.design import Robot as Robot
    from suchus.errors import Diverged as Diverged
    from suchus.errors import IncompatibleRecord as IncompatibleRecord
    from suchus.errors import InvalidDesign as InvalidDesign
    from suchus.errors import NotConverged as NotConverged
    from suchus.errors import OutsideLimits as OutsideLimits
    from suchus.errors import SuchusError as SuchusError
    from suchus.errors import UnknownName as UnknownName
    from suchus.errors import Unreachable as Unreachable
    from suchus.errors import UnreadableFile as UnreadableFile
    from suchus.experiment import Experiment as Experiment
    from suchus.experiment import Outcome as Outcome
    from suchus.experiments import EXPERIMENTS as EXPERIMENTS
    from suchus.fault import Fault as Fault
    from suchus.faults import FAULTS as FAULTS
    from suchus.faults import Backlash as Backlash
    from suchus.faults import Deaf as Deaf
    from suchus.faults import Limp as Limp
    from suchus.faults import Locked as Locked
    from suchus.faults import LostFoot as LostFoot
    from suchus.faults import Offset as Offset
    from suchus.faults import Slow as Slow
    from suchus.faults import Weak as Weak
    from suchus.gaits import GAITS as GAITS
    from suchus.land import Ground as Ground
    from suchus.land import Live as Live
    from suchus.land import Push as Push
    from suchus.land import Run as Run
    from suchus.land import crawl as crawl
    from suchus.land import simulate as simulate
    from suchus.motion import Gait as Gait
    from suchus.motion import swimming_gait as swimming_gait
    from suchus.robots import ROBOTS as ROBOTS
    from suchus.samples import sample as sample
    from suchus.sources import project as project
    from suchus.study import MEASURES as MEASURES
    from suchus.water import swim as swim

    __version__: str

_HOMES = {
    "Catalog": "suchus.catalog",
    **dict.fromkeys(("CONTROLLERS", "Coordinated", "HeadingRule"), "suchus.control"),
    "MEASURES": "suchus.study",
    "Robot": "suchus.design",
    **dict.fromkeys(
        (
            "Diverged",
            "IncompatibleRecord",
            "InvalidDesign",
            "NotConverged",
            "OutsideLimits",
            "SuchusError",
            "UnknownName",
            "Unreachable",
            "UnreadableFile",
        ),
        "suchus.errors",
    ),
    **dict.fromkeys(("Experiment", "Outcome"), "suchus.experiment"),
    "EXPERIMENTS": "suchus.experiments",
    "GAITS": "suchus.gaits",
    "ROBOTS": "suchus.robots",
    "Gait": "suchus.motion",
    "swimming_gait": "suchus.motion",
    "project": "suchus.sources",
    "sample": "suchus.samples",
    "swim": "suchus.water",
    **dict.fromkeys(("Ground", "Live", "Push", "Run", "crawl", "simulate"), "suchus.land"),
    "Fault": "suchus.fault",
    **dict.fromkeys(
        ("FAULTS", "Backlash", "Deaf", "Limp", "Locked", "LostFoot", "Offset", "Slow", "Weak"), "suchus.faults"
    ),
}
__all__ = ["__version__", *_HOMES]  # noqa: PLE0604 - the names are strings


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module("importlib.metadata").version("suchus")
    if name not in _HOMES:
        raise AttributeError(f"suchus has no {name!r}; it has {', '.join(sorted(_HOMES))}.")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)

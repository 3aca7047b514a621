"""suchus: the open laboratory for crocodile-like robots.

Names are loaded when they are first asked for, so that ``import suchus`` costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from suchus.core.catalog import Catalog as Catalog
    from suchus.core.errors import Diverged as Diverged
    from suchus.core.errors import IncompatibleRecord as IncompatibleRecord
    from suchus.core.errors import InvalidDesign as InvalidDesign
    from suchus.core.errors import NotConverged as NotConverged
    from suchus.core.errors import OutsideLimits as OutsideLimits
    from suchus.core.errors import SuchusError as SuchusError
    from suchus.core.errors import UnknownName as UnknownName
    from suchus.core.errors import Unreachable as Unreachable
    from suchus.core.errors import UnreadableFile as UnreadableFile
    from suchus.core.samples import sample as sample
    from suchus.core.sources import project as project
    from suchus.experiments.catalog import EXPERIMENTS as EXPERIMENTS
    from suchus.experiments.experiment import Experiment as Experiment
    from suchus.experiments.experiment import Outcome as Outcome
    from suchus.experiments.study import MEASURES as MEASURES
    from suchus.hardware.protocols import PROTOCOLS as PROTOCOLS
    from suchus.robot.control import CONTROLLERS as CONTROLLERS
    from suchus.robot.control import Coordinated as Coordinated
    from suchus.robot.control import HeadingRule as HeadingRule
    from suchus.robot.control import Learned as Learned
    from suchus.robot.design import Robot as Robot
    from suchus.robot.gaits import GAITS as GAITS
    from suchus.robot.motion import Gait as Gait
    from suchus.robot.motion import swimming_gait as swimming_gait
    from suchus.robot.policies import POLICIES as POLICIES
    from suchus.robot.robots import ROBOTS as ROBOTS
    from suchus.sim.fault import Fault as Fault
    from suchus.sim.faults import FAULTS as FAULTS
    from suchus.sim.faults import Backlash as Backlash
    from suchus.sim.faults import Deaf as Deaf
    from suchus.sim.faults import Delayed as Delayed
    from suchus.sim.faults import Frozen as Frozen
    from suchus.sim.faults import Limp as Limp
    from suchus.sim.faults import Locked as Locked
    from suchus.sim.faults import LostFoot as LostFoot
    from suchus.sim.faults import Offset as Offset
    from suchus.sim.faults import Slow as Slow
    from suchus.sim.faults import Weak as Weak
    from suchus.sim.immersion import water_loads as water_loads
    from suchus.sim.immersion import wet as wet
    from suchus.sim.land import Ground as Ground
    from suchus.sim.land import Live as Live
    from suchus.sim.land import Push as Push
    from suchus.sim.land import Run as Run
    from suchus.sim.land import crawl as crawl
    from suchus.sim.land import simulate as simulate
    from suchus.sim.persistence import Persistence as Persistence
    from suchus.swimming.water import swim as swim

    __version__: str

_HOMES = {
    "Catalog": "suchus.core.catalog",
    **dict.fromkeys(("CONTROLLERS", "Coordinated", "HeadingRule", "Learned"), "suchus.robot.control"),
    "MEASURES": "suchus.experiments.study",
    "POLICIES": "suchus.robot.policies",
    "PROTOCOLS": "suchus.hardware.protocols",
    "Robot": "suchus.robot.design",
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
        "suchus.core.errors",
    ),
    **dict.fromkeys(("Experiment", "Outcome"), "suchus.experiments.experiment"),
    "EXPERIMENTS": "suchus.experiments.catalog",
    "GAITS": "suchus.robot.gaits",
    "ROBOTS": "suchus.robot.robots",
    "Gait": "suchus.robot.motion",
    "swimming_gait": "suchus.robot.motion",
    "project": "suchus.core.sources",
    "sample": "suchus.core.samples",
    "swim": "suchus.swimming.water",
    **dict.fromkeys(("water_loads", "wet"), "suchus.sim.immersion"),
    **dict.fromkeys(("Ground", "Live", "Push", "Run", "crawl", "simulate"), "suchus.sim.land"),
    "Fault": "suchus.sim.fault",
    "Persistence": "suchus.sim.persistence",
    **dict.fromkeys(
        ("FAULTS", "Backlash", "Deaf", "Delayed", "Frozen", "Limp", "Locked", "LostFoot", "Offset", "Slow", "Weak"),
        "suchus.sim.faults",
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

"""A search as a TOML file that people write."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from types import MappingProxyType
from typing import Literal

from suchus import blueprint
from suchus.control import Control, OpenLoop, Standing, Walking
from suchus.design import Robot
from suchus.land import Ground, Run
from suchus.optimise.spec import Aim, Optimisation, Search
from suchus.robots import ROBOTS
from suchus.study import Vary
from suchus.study.page import find, find_gait

Task = Literal["crawl", "turn", "stand"]
TASKS: Mapping[str, Control] = MappingProxyType(
    {
        "crawl": OpenLoop(),
        "turn": Walking(bend=0.4, asymmetry=0.5),
        "stand": Standing(at=1.1, hold=3.0),
    }
)
"""How the gait is carried out: as it is; with a curvature offset and unequal strokes, ``control.bend`` and
``control.asymmetry``; standing up after it, for ``control.hold``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchFile(Search):
    """The contents of the file of a search."""

    robot: str = "caiman"
    """Name on the shelf, or path of a TOML file beside this one."""
    gait: str = "belly_crawl"
    """Name on the shelf, or path of a TOML file beside this one."""
    task: Task = "crawl"
    """Task: ``crawl``, ``turn`` or ``stand``."""
    ground: Ground = field(default_factory=Ground)
    """Ground: its friction scale, slopes and relief."""


EXAMPLE = SearchFile(
    name="example",
    vary=(Vary(field="gait.stroke", low=0.0, high=0.5),),
    aims=(Aim(name="displacement"),),
)
"""What a file's mistakes are mended with while the others are looked for."""


def read_optimisation(path: Path) -> Optimisation:
    """Read a search from a TOML file.

    Raises:
        UnreadableFile: the file is missing or no TOML.
        MistakenFile: values are missing, unknown, of the wrong kind or impossible; it names all of them.
        UnknownName: a field, an aim, a limit, a robot or a gait that does not exist.
        InvalidDesign: a range that cannot be, or that the start is not in.
    """
    page = blueprint.read(path, SearchFile, {EXAMPLE.name: EXAMPLE})
    robot = find(page.robot, path.parent, Robot, ROBOTS)
    run = Run(
        robot=robot,
        gait=find_gait(page.gait, path.parent, robot),
        ground=page.ground,
        control=TASKS[page.task],
    )
    return Optimisation(run=run, **{f.name: getattr(page, f.name) for f in fields(Search)})

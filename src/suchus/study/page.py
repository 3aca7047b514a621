"""A study as a TOML file that people write."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from suchus import blueprint
from suchus.catalog import Catalog
from suchus.design import Crocodile
from suchus.errors import InvalidDesign
from suchus.fault import Fault
from suchus.faults import from_table
from suchus.gaits import GAITS
from suchus.land import Ground, Run
from suchus.motion import Gait
from suchus.robots import ROBOTS
from suchus.study.arm import Arm
from suchus.study.study import Design, Study, Vary


@dataclass(frozen=True, slots=True, kw_only=True)
class Page:
    """What a study file can say; see ``Study``."""

    name: str
    """How it is called."""
    vary: tuple[Vary, ...]
    """What differs."""
    measure: tuple[str, ...]
    """Names of ``suchus.metrics``."""
    robot: str = "caiman"
    """Name on the shelf, or path of a TOML file beside this one."""
    gait: str = "belly_crawl"
    """Name on the shelf, or path of a TOML file beside this one."""
    ground: Ground = field(default_factory=Ground)
    """On what."""
    faults: tuple[dict[str, Any], ...] = ()
    """What breaks, see ``faults.from_table``."""
    noise: float = 0.0
    """Standard deviation of noise on every servo angle commanded [rad]."""
    design: Design = "factorial"
    """How values are put together."""
    samples: int | None = None
    """How many points a Sobol sequence or a Latin hypercube has [-]."""
    seed: int = 0
    """Of the sampling, and of the first run's noise [-]."""
    seeds: int = 1
    """How many runs each point gets [-]."""
    duration: float = 9.0
    """Of each run [s]."""
    timestep: float = 0.005
    """Of the physics [s]."""
    chunk: int = 32
    """How many runs are simulated together [-]."""
    arms: tuple[Arm, ...] = ()
    """Sides of a comparison."""
    every: int = 1
    """Measures look at one sample of so many control periods [-]."""
    reasons: tuple[str, ...] = ()
    """Why these fields and ranges."""


EXAMPLE = Page(
    name="example",
    vary=(Vary(field="gait.stroke", low=0.0, high=0.08, steps=9),),
    measure=("displacement",),
)
"""Nine strokes of the article's crawl: what a file's mistakes are mended with while the others are looked for."""


def read_study(path: Path) -> Study:
    """Read a study from a TOML file.

    Raises:
        UnreadableFile: the file is missing or no TOML.
        MistakenFile: values are missing, unknown, of the wrong kind or impossible; it names all of them.
        UnknownName: a field, a measure, a robot or a gait that does not exist.
        InvalidDesign: a field cannot take one of its values.
    """
    page = blueprint.read(path, Page, {EXAMPLE.name: EXAMPLE})
    run = Run(
        robot=find(page.robot, path.parent, Crocodile, ROBOTS),
        gait=find(page.gait, path.parent, Gait, GAITS),
        ground=page.ground,
        faults=tuple(from_table(table) for table in page.faults),
        noise=page.noise,
    )
    return Study(
        run=run,
        vary=tuple(_resolved(vary, path.parent) for vary in page.vary),
        **{f.name: getattr(page, f.name) for f in fields(Study) if f.name not in ("run", "vary")},
    )


def _resolved(vary: Vary, place: Path) -> Vary:
    """Return a field with the things that its values name."""
    if vary.values is None:
        return vary
    values: list[Any] = []
    for value in vary.values:
        if vary.field == "robot" and isinstance(value, str):
            values.append(find(value, place, Crocodile, ROBOTS))
        elif vary.field == "gait" and isinstance(value, str):
            values.append(find(value, place, Gait, GAITS))
        elif vary.field == "faults":
            values.append(_faults(value))
        else:
            values.append(tuple(value) if isinstance(value, list) else value)
    return replace(vary, values=tuple(values))


def _faults(value: Any) -> tuple[Fault, ...]:
    if not isinstance(value, list) or not all(isinstance(item, Mapping) for item in value):
        raise InvalidDesign(
            f"faults take lists of tables, as [[], [{{kind = 'limp', joint = 'LF_yaw'}}]]; one of them is {value!r}."
        )
    return tuple(from_table(item) for item in value)


def find(name: str, place: Path, kind: type, shelf: Catalog[Any]) -> Any:
    """Return what a file names: something on a shelf, or described by a TOML file beside it.

    Raises:
        UnknownName: it is not on the shelf.
        UnreadableFile: there is no such file, or it is no TOML.
        MistakenFile: the file describes nothing that can be.
    """
    return blueprint.read(place / name, kind, shelf) if name.endswith(".toml") else shelf[name]

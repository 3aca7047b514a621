"""A study as a TOML file that people write."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from suchus.core.errors import InvalidDesign
from suchus.core.kinds import show
from suchus.experiments.study.arm import Arm
from suchus.experiments.study.study import Design, Study, Vary
from suchus.robot import blueprint
from suchus.robot.control import CONTROLLERS, Control
from suchus.robot.design import Robot
from suchus.robot.gaits import gait_of
from suchus.robot.robots import ROBOTS
from suchus.sim.fault import Fault
from suchus.sim.faults import from_table
from suchus.sim.land import Ground, Run


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyFile:
    """The contents of a study file; see ``Study``."""

    name: str
    """Name, as messages, tables and files show it."""
    vary: tuple[Vary, ...]
    """Fields that vary, and over which values."""
    measure: tuple[str, ...]
    """Names of ``suchus.sim.metrics``."""
    robot: str = "caiman"
    """Name in the catalog, or path of a TOML file beside this one."""
    gait: str | None = None
    """Name in the catalog, or path of a TOML file beside this one; by default the robot's own."""
    ground: Ground = field(default_factory=Ground)
    """Ground: its friction scale, slopes and relief."""
    faults: tuple[dict[str, Any], ...] = ()
    """Faults as tables, see ``faults.from_table``."""
    control: dict[str, Any] = field(default_factory=lambda: {"kind": "open_loop"})
    """Controller as a table: its kind, a name in the catalog of controllers, and its fields."""
    noise: float = 0.0
    """Standard deviation of noise on every servo angle commanded [rad]."""
    design: Design = "factorial"
    """Sampling of the values."""
    samples: int | None = None
    """Number of points of a Sobol sequence or a Latin hypercube [-]."""
    seed: int = 0
    """Seed of the sampling, and of the first run's noise [-]."""
    seeds: int = 1
    """Number of runs at each point [-]."""
    duration: float = 9.0
    """Duration of each run [s]."""
    timestep: float = 0.005
    """Time step of the physics [s]."""
    chunk: int = 32
    """Number of runs that are simulated in one batch [-]."""
    arms: tuple[Arm, ...] = ()
    """Conditions of a comparison."""
    every: int = 1
    """Measures look at one sample of so many control periods [-]."""
    reasons: tuple[str, ...] = ()
    """Why these fields and ranges."""


EXAMPLE = StudyFile(
    name="example",
    vary=(Vary(field="gait.stroke", low=0.0, high=0.48, steps=9),),
    measure=("displacement",),
)
"""Nine strokes of the article's crawl: what a file's mistakes are mended with while the others are looked for."""


def read_study(path: str | Path) -> Study:
    """Read a study from a TOML file.

    Raises:
        UnreadableFile: the file is missing or no TOML.
        MistakenFile: values are missing, unknown, of the wrong kind or impossible; it names all of them.
        UnknownName: a field, a measure, a robot or a gait that does not exist.
        InvalidDesign: a field cannot take one of its values.
    """
    path = Path(path)
    page = blueprint.read_design(path, StudyFile, {EXAMPLE.name: EXAMPLE})
    robot = ROBOTS.resolve(page.robot, path.parent)
    run = Run(
        robot=robot,
        gait=gait_of(robot, page.gait, path.parent),
        ground=page.ground,
        faults=tuple(from_table(table) for table in page.faults),
        control=_control(page.control),
        noise=page.noise,
    )
    return Study(
        run=run,
        vary=tuple(_resolved(vary, path.parent, robot) for vary in page.vary),
        arms=tuple(resolved_arm(arm, path.parent, robot) for arm in page.arms),
        **{f.name: getattr(page, f.name) for f in fields(Study) if f.name not in ("run", "vary", "arms")},
    )


def _control(table: Mapping[str, Any]) -> Control:
    """Return the control that a table describes, as ``{kind = "pattern_generator", drive = 2.0}``.

    Raises:
        UnknownName: there is no controller of this kind.
        InvalidDesign: it has no kind.
        MistakenFile: a field is missing, unknown or impossible.
    """
    kind = table.get("kind")
    if not isinstance(kind, str):
        raise InvalidDesign(f"a control needs a kind ({', '.join(CONTROLLERS)}); {show(dict(table))} has none.")
    fields = {key: value for key, value in table.items() if key != "kind"}
    control: Control = blueprint.parse_table(fields, CONTROLLERS[kind[:60]], f"the controller {kind}")
    return control


def resolved_arm(arm: Arm, place: Path, robot: Robot) -> Arm:
    """Return an arm with the robots, gaits and faults that its values name.

    Args:
        arm: as a file says it.
        place: the folder of that file.
        robot: robot of the study, for which gaits are read.

    Raises:
        SuchusError: it names nothing that is there.
    """
    return replace(
        arm, values={field: _resolve_value(field, value, place, robot) for field, value in arm.values.items()}
    )


def _resolved(vary: Vary, place: Path, robot: Robot) -> Vary:
    """Return a field with the things that its values name."""
    if vary.values is None:
        return vary
    return replace(vary, values=tuple(_resolve_value(vary.field, value, place, robot) for value in vary.values))


def _resolve_value(field: str, value: Any, place: Path, robot: Robot) -> Any:
    """Return what a value of a file stands for: robots and gaits have names, faults are tables, lists are tuples."""
    if field == "robot" and isinstance(value, str):
        return ROBOTS.resolve(value, place)
    if field == "gait" and isinstance(value, str):
        return gait_of(robot, value, place)
    if field == "faults":
        return _faults(value)
    return tuple(value) if isinstance(value, list) else value


def _faults(value: Any) -> tuple[Fault, ...]:
    """Return the faults that a list of tables describes."""
    if not isinstance(value, list) or not all(isinstance(item, Mapping) for item in value):
        raise InvalidDesign(
            "faults take lists of tables, as [[], [{kind = 'limp', joint = 'LF_yaw'}]]; one of them is "
            f"{show(value)}."
        )
    return tuple(from_table(item) for item in value)

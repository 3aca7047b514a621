"""``wet``: water for any MuJoCo model, in MuJoCo's own step."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np
from jaxtyping import Float

from suchus.core import water_table
from suchus.core.checks import Checks, Schedule
from suchus.core.errors import InvalidDesign, UnreadableFile, UnsuitedRobot
from suchus.core.water_table import LOAD_WIDTH, NUMBERS, SHAPE_MAGIC
from suchus.sim.immersion import wetting
from suchus.sim.immersion.attachment import NUMERIC, WATER_ON_SHAPES
from suchus.sim.immersion.coefficients import GeomCoefficients
from suchus.sim.immersion.sea import DEEPEST, Current, Wave, level_axes, wave_rows
from suchus.sim.immersion.shapes import shape_table, wet_geoms

_PGS = int(mujoco.mjtSolver.mjSOL_PGS)
_NO_SPRING, _NO_DAMPER, _NO_GRAVITY = (
    int(getattr(mujoco.mjtDisableBit, f"mjDSBL_{word}")) for word in ("SPRING", "DAMPER", "GRAVITY")
)
_ROOM = "water_room"
"""Name of the empty bodies that give the mass matrix room, before their numbers."""
_NO_COEFFICIENTS: Mapping[str, GeomCoefficients] = {}


@dataclass(frozen=True, slots=True, kw_only=True)
class Medium:
    """Water whose surface is level but for waves."""

    level: Schedule
    """Level of the surface above the world's origin, against gravity [m]."""
    density: float
    """[kg/m3]."""
    viscosity: float
    """Dynamic viscosity, for the drag of slow motion [Pa s]."""
    waves: tuple[Wave, ...]
    """Waves on the surface; none where it is flat."""
    current: Current
    """The current."""
    added_mass: float
    """Factor on all added mass [-]."""
    splash: float
    """Fraction of what the change of added mass moves that is lost [-]."""
    lift: float
    """Slope of the lift coefficient of flat geoms [1/rad]."""
    gravity: tuple[float, float, float] = field(default=(0.0, 0.0, -9.81))
    """Gravity of the model [m/s2]."""

    def __post_init__(self) -> None:
        """Refuse numbers outside their ranges, and waves without gravity."""
        with Checks("water", self) as check:
            check.course("level", -DEEPEST, DEEPEST, "m")
            check.number("density", 1e-3, 2e4, "kg/m3")
            check.number("viscosity", 0.0, 1e4, "Pa s")
            check.number("added_mass", 0.0, 10.0, "")
            check.number("splash", 0.0, 1.0, "")
            check.number("lift", 0.0, 20.0, "1/rad")
            check.that(
                not self.waves or any(self.gravity),
                "the model has no gravity, and waves need it: leave the waves out, or set the model's option gravity",
            )

    @property
    def up_axis(self) -> Float[np.ndarray, "3"]:
        """Unit vector against gravity, z without gravity."""
        size = float(np.linalg.norm(self.gravity))
        return -np.array(self.gravity) / size if size else np.array([0.0, 0.0, 1.0])


class WaterLoads(NamedTuple):
    """What the water does to each body of a model, at the last evaluation of the passive forces."""

    force: Float[np.ndarray, "body 3"]
    """Force, that of added mass included [N]."""
    torque: Float[np.ndarray, "body 3"]
    """Torque about the body's origin [N m]."""
    volume: Float[np.ndarray, " body"]
    """Volume under water [m3]."""


def wet(
    source: Any,
    *,
    level: Schedule = 0.0,
    density: float = 1000.0,
    viscosity: float = 1e-3,
    waves: Wave | Iterable[Wave] = (),
    current: Current | tuple[float, float] = (0.0, 0.0),
    coefficients: Mapping[str, GeomCoefficients] = _NO_COEFFICIENTS,
    dry: str | Collection[str] = (),
    added_mass: float = 1.0,
    splash: float = 1.0,
    lift: float = 0.0,
) -> Any:
    """Return a copy of a MuJoCo specification on whose geoms water acts, in MuJoCo's own step.

    ``mujoco.mj_step``, ``mujoco.rollout`` and viewers run what ``compile()`` makes of it. Each geom with a volume on a
    body that can move has buoyancy at the centre of what is exactly under water, added mass in the mass matrix, drag,
    and lift if asked for. Where some geoms of a body collide, its others count as pictures. Overlapping geoms displace
    their water twice: set ``GeomCoefficients.volume``. Do it after all other edits: the table knows bodies by number.

    Args:
        source: a ``mujoco.MjSpec``, the path of an MJCF or URDF file, or MJCF as text.
        level: level of the surface above the world's origin against gravity, or pairs of time [s] and level [m].
        density: density of the water [kg/m3].
        viscosity: dynamic viscosity, for the drag of slow motion [Pa s].
        waves: a wave, or several, as ``sea`` makes them.
        current: a ``Current``, or its velocity forward and to the left [m/s].
        coefficients: coefficients of geoms by their names, where they are not to follow from the shape.
        dry: names of geoms, or of bodies with all their geoms, on which no water acts.
        added_mass: factor on all added mass [-].
        splash: fraction of what the change of added mass moves that is lost at the surface [-]: with 0 body and water
            keep their energy, with 1 a body that enters keeps its momentum (von Karman 1929).
        lift: slope of the lift coefficient of flat geoms [1/rad]; 0 for none.

    Raises:
        InvalidDesign: a number outside its range, a model in which water cannot act, or a geom without a volume.
        UnknownName: a name that is of no geom or body.
        UnreadableFile: MuJoCo cannot read the file.
    """
    spec = _specification(source)
    _check_coefficients(coefficients)
    pull = spec.option.gravity
    medium = Medium(
        level=_tuples(level), density=density, viscosity=viscosity,
        waves=tuple(waves) if isinstance(waves, Iterable) else (waves,),
        current=current if isinstance(current, Current) else Current(velocity=current),
        added_mass=added_mass, splash=splash, lift=lift, gravity=(float(pull[0]), float(pull[1]), float(pull[2])),
    )  # fmt: skip
    _check_options(spec)
    wetting.install(WATER_ON_SHAPES)
    model = with_full_matrix(spec)
    geoms = wet_geoms(model, coefficients, (dry,) if isinstance(dry, str) else dry)
    table, triangles = shape_table(model, geoms, coefficients, viscosity, lift)
    start = int(model.nuserdata)
    numbers = _numbers(medium, table, triangles, start, int(model.nbody))
    numeric = spec.add_numeric(name=NUMERIC, size=len(numbers))
    numeric.data = numbers
    spec.nuserdata = start + NUMBERS + LOAD_WIDTH * int(model.nbody)
    spec.activate_plugin(WATER_ON_SHAPES)
    spec.add_plugin(name=NUMERIC, plugin_name=WATER_ON_SHAPES, active=True)
    return spec


def water_loads(model: Any, data: Any) -> WaterLoads:
    """Return what the water does to each body, as the last evaluation of the passive forces left it; views.

    The added mass counts with the accelerations of the step before. ``mujoco.mj_forward`` makes it anew.

    Args:
        model: a ``mujoco.MjModel`` of what ``wet`` returned.
        data: its ``mujoco.MjData``.

    Raises:
        UnsuitedRobot: the model has no water.
    """
    for i in range(model.nnumeric):
        numbers = model.numeric_data[model.numeric_adr[i] :][: model.numeric_size[i]]
        if len(numbers) and numbers[0] == SHAPE_MAGIC:
            first = int(numbers[water_table.USERDATA_START]) + NUMBERS
            rows = data.userdata[first : first + LOAD_WIDTH * model.nbody].reshape(model.nbody, LOAD_WIDTH)
            return WaterLoads(rows[:, :3], rows[:, 3:6], rows[:, 6])
    raise UnsuitedRobot("this model has no water: compile what suchus.wet returns.")


def _specification(source: Any) -> Any:
    """Return the copy of a specification, or that in a file or text."""
    if isinstance(source, mujoco.MjSpec):
        return source.copy()
    if isinstance(source, str) and source.lstrip().startswith("<"):
        try:
            return mujoco.MjSpec.from_string(source)
        except ValueError as error:
            raise UnreadableFile(f"MuJoCo cannot read the model: {error}") from error
    if not isinstance(source, (str, PathLike)):
        raise InvalidDesign(
            f"water needs a mujoco.MjSpec, the path of an MJCF or URDF file, or MJCF as text, and got a "
            f"{type(source).__name__}; of a compiled mujoco.MjModel the specification is needed."
        )
    path = Path(source)
    if not path.is_file():
        raise UnreadableFile(f"{path}: there is no such file; give the path of an MJCF or URDF file.")
    try:
        return mujoco.MjSpec.from_file(str(path))
    except ValueError as error:
        raise UnreadableFile(f"{path}: MuJoCo cannot read it: {error}") from error


def _check_options(spec: Any) -> None:
    """Refuse a specification whose options leave no place for water.

    Raises:
        InvalidDesign: it is wet already, has MuJoCo's own fluid, or a solver that knows the dry mass matrix alone.
    """
    option = spec.option
    if any(numeric.name == NUMERIC for numeric in spec.numerics):
        raise InvalidDesign(
            f"this model has a custom number {NUMERIC!r}: it is wet already; call wet once, on the dry one."
        )
    if option.density > 0.0 or option.viscosity > 0.0 or any(option.wind):
        raise InvalidDesign(
            f"this model has a fluid of MuJoCo's own (option density {option.density:g}, viscosity "
            f"{option.viscosity:g}, wind {' '.join(f'{speed:g}' for speed in option.wind)}), which would act too: "
            "set these options to 0."
        )
    if option.solver == _PGS or option.noslip_iterations > 0:
        raise InvalidDesign(
            "this model solves contacts by PGS or the noslip iterations, which take the mass matrix without the added "
            "mass of the water: set option solver to Newton or CG, and noslip_iterations to 0."
        )
    if option.disableflags & _NO_SPRING and option.disableflags & _NO_DAMPER:
        raise InvalidDesign(
            "this model has no passive forces (option flags spring and damper are both disabled), and water is one: "
            "enable one of the flags."
        )
    if option.disableflags & _NO_GRAVITY:
        raise InvalidDesign(
            "this model's gravity is off by the option flag gravity, and buoyancy would stay: enable the flag, or set "
            "the option gravity to 0 0 0."
        )
    if option.enableflags & int(mujoco.mjtEnableBit.mjENBL_SLEEP):
        raise InvalidDesign("this model lets bodies sleep (option flag sleep), and water wakes none: disable the flag.")


def with_full_matrix(spec: Any) -> Any:
    """Compile a specification so that the mass matrix has room for the added mass of each body; return the model.

    MuJoCo keeps a diagonal matrix for a body whose frame is that of its mass, unless it has a child: such a body gets
    an empty one, which an exclusion from contacts keeps from being fused with it (compiler option ``fusestatic``).

    Raises:
        InvalidDesign: MuJoCo cannot compile it, or empty bodies would not stay without mass.
    """
    model = _compiled(spec)
    has_room = (model.body_simple == 0) | (model.body_dofnum == 0) | (model.body_geomnum == 0)
    crowded = [body for body in spec.bodies if not has_room[body.id]]
    if not crowded:
        return model
    _check_empty_bodies(spec)
    for i, body in enumerate(crowded):
        room = f"{_ROOM}_{i}"
        body.add_body(name=room)
        spec.add_exclude(bodyname1=room, bodyname2="world")
    return _compiled(spec)


def _compiled(spec: Any) -> Any:
    """Return the model of a specification.

    Raises:
        InvalidDesign: MuJoCo cannot compile it.
    """
    try:
        return spec.compile()
    except ValueError as error:
        raise InvalidDesign(f"MuJoCo cannot compile this model: {error}") from error


def _check_empty_bodies(spec: Any) -> None:
    """Refuse a specification whose compiler gives empty bodies a mass.

    Raises:
        InvalidDesign: it does.
    """
    compiler = spec.compiler
    if compiler.boundmass > 0.0 or compiler.boundinertia > 0.0:
        raise InvalidDesign(
            f"this model gives every body a least mass (compiler boundmass {compiler.boundmass:g}, boundinertia "
            f"{compiler.boundinertia:g}), those too that make room for added mass: give its bodies their masses, and "
            "set both to 0."
        )


def _check_coefficients(coefficients: Any) -> None:
    """Refuse what is no mapping of names to coefficients.

    Raises:
        InvalidDesign: it is none.
    """
    is_mapping = isinstance(coefficients, Mapping)
    if not is_mapping or not all(isinstance(value, GeomCoefficients) for value in coefficients.values()):
        raise InvalidDesign(
            f"coefficients is {coefficients!r}; names of geoms with their coefficients are needed, as "
            "{'fin': GeomCoefficients(drag=1.5)}."
        )


def _tuples(level: Any) -> Any:
    """Return lists and arrays of pairs of time and level as tuples, and anything else as it is."""
    pairs = level.tolist() if isinstance(level, np.ndarray) else level
    is_pairs = isinstance(pairs, (list, tuple)) and all(isinstance(pair, (list, tuple)) for pair in pairs)
    return tuple(tuple(pair) for pair in pairs) if is_pairs else pairs


def _numbers(
    medium: Medium,
    table: Float[np.ndarray, "shape column"],
    triangles: Float[np.ndarray, "triangle 9"],
    start: int,
    bodies: int,
) -> Float[np.ndarray, " n"]:
    """Return the row of numbers that a wet model carries.

    Args:
        medium: the water.
        table: table of shapes.
        triangles: triangles of all polyhedra [m].
        start: first number of the water in the user data.
        bodies: number of bodies of the model.
    """
    up_axis = medium.up_axis
    forward, leftward = level_axes(up_axis)
    current = medium.current
    water = np.zeros(NUMBERS)
    water[water_table.DENSITY], water[water_table.VISCOSITY] = medium.density, medium.viscosity / medium.density
    water[water_table.AIR_FRACTION : water_table.AIR_FRACTION + 2] = 1.0
    water[water_table.ADDED_MASS_FACTOR], water[water_table.SPLASH] = medium.added_mass, medium.splash
    velocity, shear = (pair[0] * forward + pair[1] * leftward for pair in (current.velocity, current.shear))
    water[water_table.CURRENT : water_table.CURRENT + 3] = velocity
    header: dict[int, float] = {water_table.USERDATA_START: start, water_table.BODY_COUNT: bodies}
    header |= {water_table.SHEAR + i: float(shear[i]) for i in range(3)}
    schedules = _rows(medium.level), _rows(current.factor)
    waves = wave_rows(medium.waves, up_axis, float(np.linalg.norm(medium.gravity)))
    return water_table.pack_shapes(table, triangles, water, schedules, waves, header)


def _rows(schedule: Schedule) -> Float[np.ndarray, "row 2"]:
    """Return a schedule as rows of time [s] and value."""
    return np.array(((0.0, schedule),) if isinstance(schedule, (int, float)) else schedule, float)

"""The water of a run: where its surface is, how heavy it is, how it moves; some of it may change while the run goes.

A ``Lake`` is the frozen value of one run; ``Waters`` are those of a batch, in the memory that the physics reads.
"""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from math import cos, pi, sin, tau
from typing import Any

import numpy as np
from jaxtyping import Float

from suchus.core import water_table as hydro
from suchus.core.checks import Checks, Schedule
from suchus.core.errors import InvalidDesign
from suchus.robot.design import GRAVITY, Robot, layout
from suchus.robot.design.correction import SectionCorrection
from suchus.robot.design.form import BodyForm
from suchus.robot.design.ground import Ground
from suchus.robot.design.water import Water
from suchus.sim.immersion.sea import DEEPEST, FASTEST, Wave, level_axes
from suchus.sim.land.corrected import SectionChange


@dataclass(frozen=True, slots=True, kw_only=True)
class Lake:
    """Water with a level surface. Where the ground slopes, the surface is level and the slope is the shore.

    Level and air fraction may be courses over time, as ``((0.0, 0.1), (5.0, 0.3))``.
    """

    level: Schedule
    """Level of the surface above the world's origin, against gravity [m]; the ground passes through the origin."""
    water: Water = field(default_factory=Water)
    """Density, viscosity, and what sections of a body feel."""
    current: tuple[float, float] = (0.0, 0.0)
    """Velocity of the water, forward and to the left [m/s]."""
    wave: Wave | None = None
    """Waves on the surface; None where it is flat."""
    air_fraction: Schedule = 1.0
    """Share of the air of the robot's hull that is kept, 0 to 1, alike in all its chambers [-]."""
    heel: float = 0.0
    """Roll with which a robot that floats is put on the water, right side down positive [rad]."""
    added_mass: float = 1.0
    """Factor on the added mass of all pieces [-]."""
    shedding: float = 1.0
    """Factor on the momentum that is shed at the end of the tail [-]."""
    splash: float = 1.0
    """Fraction of what the change of added mass moves that is lost at the surface [-]: with 0 body and water keep
    their energy, with 1 a body that enters keeps its momentum (von Karman 1929)."""
    correction: SectionCorrection | None = None
    """Factors on what each link's sections feel, as a flow found them at one Reynolds number; None leaves all as they
    are. ``coupling.earned_correction`` makes one."""
    form: BodyForm | None = None
    """Drag of nose, blunt end and folded limbs, and what the tail sheds, by coefficients; None leaves the nose of the
    pieces, and the last strip to shed alone."""

    def __post_init__(self) -> None:
        """Refuse currents, levels, air fractions and factors outside their ranges."""
        with Checks("lake", self) as check:
            check.each("current", ("forward", "left"), -FASTEST, FASTEST, "m/s")
            check.number("heel", -pi, pi, "rad")
            check.number("added_mass", 0.0, 10.0, "")
            check.number("shedding", 0.0, 10.0, "")
            check.number("splash", 0.0, 1.0, "")
            check.course("level", -DEEPEST, DEEPEST, "m")
            check.course("air_fraction", 0.0, 1.0, "")

    @property
    def section_change(self) -> SectionChange | None:
        """What it changes of the robot's pieces; None for nothing."""
        if self.form is None and self.correction is None:
            return None
        return SectionChange(form=self.form, correction=self.correction)

    def state_at(self, time: float) -> tuple[float, float]:
        """Return level [m] and air fraction [-] at a time [s]."""
        return _value_at(self.level, time), _value_at(self.air_fraction, time)

    def shore(self, uphill: float) -> float:
        """Return where the level at time 0 meets ground that rises by ``uphill`` [rad], ahead along the ground [m]."""
        return self.state_at(0.0)[0] / sin(uphill)

    def changes(self) -> bool:
        """Return whether level or air fraction change while the run goes."""
        return not isinstance(self.level, (int, float)) or not isinstance(self.air_fraction, (int, float))

    def numbers(self, up_axis: Float[np.ndarray, "3"], time: float = 0.0) -> Float[np.ndarray, " n"]:
        """Return the parameters of the lake as one array, indexed by the constants of ``hydro``.

        Args:
            up_axis: unit vector against gravity.
            time: [s].
        """
        row = np.zeros(hydro.NUMBERS)
        row[hydro.LEVEL], row[hydro.AIR_FRACTION : hydro.AIR_FRACTION + 2] = self.state_at(time)
        row[hydro.DENSITY], row[hydro.VISCOSITY] = self.water.density, self.water.viscosity
        row[hydro.CROSS_DRAG], row[hydro.THICKENING] = self.water.cross_drag, self.water.thickening
        row[hydro.ADDED_MASS_FACTOR], row[hydro.SHEDDING] = self.added_mass, self.shedding
        row[hydro.SPLASH] = self.splash
        forward, leftward = level_axes(up_axis)
        row[hydro.CURRENT : hydro.CURRENT + 3] = self.current[0] * forward + self.current[1] * leftward
        if self.wave is not None:
            number = tau / self.wave.length
            heading = cos(self.wave.heading) * forward + sin(self.wave.heading) * leftward
            numbers = [self.wave.height / 2, *(number * heading), tau * self.wave.frequency, tau * self.wave.phase]
            row[hydro.WAVE : hydro.WAVE + len(numbers)] = numbers
        return row


def lake_text(lake: Lake | None) -> str:
    """Return a lake as JSON text; the empty one stands for none."""
    lake_fields = {} if lake is None else asdict(lake)
    for name in ("correction", "form"):  # records made before these have neither
        if lake_fields.get(name, 0) is None:
            del lake_fields[name]
    return json.dumps(lake_fields, sort_keys=True) if lake_fields else ""


def check_lake(robot: Robot, lake: Lake) -> None:
    """Refuse an air fraction below 1 for a hull without air, and a correction made for another robot.

    Raises:
        InvalidDesign: air is let out, and the robot has no hull with air; or it lacks a body that is corrected.
    """
    if lake.correction is not None:
        lake.correction.check(tuple(body.name for body in layout(robot).bodies), robot.name)
    hull = robot.hull
    if (hull is None or hull.air == 0.0) and lake.air_fraction != 1.0:
        raise InvalidDesign(
            f"lake.air_fraction is {str(lake.air_fraction)[:60]}, and robot {robot.name!r} has no air that it could "
            "let out: leave air_fraction at 1, or give the robot a design.Hull with air."
        )


def _value_at(course: Schedule, time: float) -> float:
    if isinstance(course, (int, float)):
        return float(course)
    return float(np.interp(time, [instant for instant, _ in course], [value for _, value in course]))


_AIR_FRACTION = slice(hydro.AIR_FRACTION, hydro.AIR_FRACTION + 2)


class Waters:
    """The numbers of the water of every run, in the memory that the physics reads and writes.

    Args:
        lakes: lakes of the runs of a batch; None for those on dry land.
        grounds: grounds of the runs.
        physics: the ``mujoco.batch.Batch``.
    """

    def __init__(self, lakes: Sequence[Lake | None], grounds: Sequence[Ground], physics: Any) -> None:
        """Bind the physics' memory and write the water of each run into it."""
        self._lakes = {sim: lake for sim, lake in enumerate(lakes) if lake is not None}
        self._changing = {sim: lake for sim, lake in self._lakes.items() if lake.changes()}
        self._ups = np.array([up_direction(ground) for ground in grounds])
        self.rows: Float[np.ndarray, "run number"] = (
            physics.bind("userdata") if self._lakes else np.zeros((len(grounds), 0))
        )
        """See ``hydro.table``; without columns where all is dry."""
        for sim in self._lakes:
            self.refill(sim)

    def __bool__(self) -> bool:
        return bool(self._lakes)

    def flood(self, time: float, air_fraction: Float[np.ndarray, "run chamber"] | None = None) -> None:
        """Update level and air fraction of the lakes to a time, where they change or are commanded.

        Args:
            time: [s].
            air_fraction: what controllers command of front and rear chambers, NaN where they leave it to the lake [-];
                None for all.
        """
        for sim, lake in self._changing.items():
            self.rows[sim, hydro.LEVEL], self.rows[sim, _AIR_FRACTION] = lake.state_at(time)
        if air_fraction is not None and self._lakes:
            commanded = np.isfinite(air_fraction).all(axis=1)
            self.rows[commanded, _AIR_FRACTION] = air_fraction[commanded]

    def fill(self, sim: int, lake: Lake, time: float) -> None:
        """Replace the water of a run; the last forces and power of the water stay readable.

        Args:
            sim: a run that has a lake.
            lake: the new water.
            time: [s].
        """
        self._lakes[sim] = lake
        self._changing = {run: water for run, water in self._lakes.items() if water.changes()}
        self.rows[sim, : hydro.FORCE] = lake.numbers(self._ups[sim], time)[: hydro.FORCE]

    def refill(self, sim: int) -> None:
        """Write the initial water of a run; a reset of the physics had removed it."""
        if sim in self._lakes:
            self.rows[sim] = self._lakes[sim].numbers(self._ups[sim])

    def tilt(self, sim: int, ground: Ground) -> None:
        """Change the slope of a run's ground; the surface of the water stays level."""
        if sim in self._lakes:
            self._ups[sim] = up_direction(ground)

    def depths(self, roots: Float[np.ndarray, "run 3"]) -> Float[np.ndarray, " run"] | None:
        """Return the depth of the roots below the water level, 0 above it [m]; None without water.

        Args:
            roots: their places in the world [m].
        """
        if not self._lakes:
            return None
        height = np.einsum("ij,ij->i", roots, self._ups)
        return np.asarray(np.maximum(self.rows[:, hydro.LEVEL] - height, 0.0))

    def acts(self) -> Float[np.ndarray, "run 4"]:
        """Return force [N] and power [W] of the water, as the physics left them; a view."""
        return self.rows[:, hydro.FORCE : hydro.FORCE + 4]


def up_direction(ground: Ground) -> Float[np.ndarray, "3"]:
    """Return the direction against gravity in the frame of a tilted ground, a unit vector."""
    return -gravity(ground) / GRAVITY


def gravity(ground: Ground) -> Float[np.ndarray, "3"]:
    """Return gravity in the frame of a tilted ground [m/s2]."""
    down = np.array([-np.sin(ground.uphill), 0.0, -np.cos(ground.uphill)])
    c, s = np.cos(ground.sideways), np.sin(ground.sideways)
    return GRAVITY * np.array([down[0], down[2] * s, down[2] * c])

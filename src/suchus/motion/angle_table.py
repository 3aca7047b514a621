"""A movement as a table: the angle of each servo at equal steps of one cycle."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from suchus.design import AnyRobot, layout
from suchus.design.checks import Checks
from suchus.errors import OutsideLimits, UnknownName

MOST_ANGLES = 1000
"""Samples of a curve at most."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """The angle of one servo over one cycle."""

    servo: str
    """Name of the servo, as ``suchus.design.layout(robot).servos`` has it."""
    angles: tuple[float, ...]
    """Angles at equal steps of the cycle; after the last one the first follows again [rad]."""

    def __post_init__(self) -> None:
        with Checks(f"curve {self.servo}", self) as check:
            check.that(
                1 <= len(self.angles) <= MOST_ANGLES,
                f"curve {self.servo} has {len(self.angles)} angles; 1 to {MOST_ANGLES} are allowed",
            )
            wrong = next((one for one in self.angles if not abs(one) <= 2 * np.pi), None)
            check.that(wrong is None, f"curve {self.servo} has an angle of {wrong} rad; -6.28 to 6.28 rad is allowed")

    def at(self, clock: Float[np.ndarray, "*batch"]) -> Float[np.ndarray, "*batch"]:
        """Return the angle at times in cycles, on the smoothest periodic curve through the samples [rad].

        It is the trigonometric interpolation, which has the fewest harmonics: 13 samples give six of them exactly.
        """
        count = len(self.angles)
        harmonics = np.fft.rfft(self.angles) / count
        harmonics[1 : (count + 1) // 2] *= 2.0
        turn = np.exp(2j * np.pi * np.multiply.outer(np.asarray(clock, dtype=float), np.arange(len(harmonics))))
        return np.asarray((turn @ harmonics).real)


@dataclass(frozen=True, slots=True, kw_only=True)
class AngleTable:
    """A periodic movement given by servo angles, as they were measured on an animal; servos without a curve stay at 0.

    Nothing in it follows from feet or bends, so that any hinge can be moved, up and down as well as sideways.
    """

    name: str
    """Name, as messages, tables and files show it."""
    period: float
    """Period of one cycle [s]."""
    duty_factor: float
    """Share of the cycle in which a foot stands [-]; it moves nothing, measures and diagrams read it."""
    limb_phases: tuple[float, ...]
    """Phase of each limb when the movement begins, 0 where its swing begins [cycle]; it moves nothing either."""
    curves: tuple[Curve, ...]
    """One for every servo that moves."""

    def __post_init__(self) -> None:
        with Checks("angle_table", self) as check:
            check.number("period", 1e-3, 3600.0, "s")
            check.number("duty_factor", 0.05, 0.95, "")
            names = [curve.servo for curve in self.curves]
            twice = next((name for name in names if names.count(name) > 1), "")
            check.that(bool(names), f"table {self.name} has no curve; give it one for each servo that moves")
            check.that(not twice, f"table {self.name} has two curves for {twice}; leave one")
            check.that(
                all(-1.0 <= phase <= 1.0 for phase in self.limb_phases),
                f"angle_table.limb_phases is {self.limb_phases}; -1 to 1 cycle is allowed",
            )


def check_table(robot: AnyRobot, gait: AngleTable) -> None:
    """Refuse a table for another robot.

    Raises:
        OutsideLimits: it has phases for another number of limbs.
        UnknownName: a curve is for a servo that the robot lacks.
    """
    place = layout(robot)
    if len(gait.limb_phases) != len(place.limbs):
        raise OutsideLimits(
            f"gait {gait.name!r} has phases for {len(gait.limb_phases)} limbs; robot {robot.name!r} has "
            f"{len(place.limbs)}: choose a gait made for it."
        )
    for curve in gait.curves:
        if curve.servo not in place.servos:
            raise UnknownName(f"servo of robot {robot.name!r}", curve.servo, place.servos)


def table_targets(
    robot: AnyRobot, gait: AngleTable, clock: Float[np.ndarray, "*batch"]
) -> Float[np.ndarray, "*batch servo"]:
    """Return the servo angles of a table [rad].

    Args:
        robot: the design, for which the table is.
        gait: the table.
        clock: since the movement began [cycle].
    """
    servos = layout(robot).servos
    targets = np.zeros((*np.shape(clock), len(servos)))
    for curve in gait.curves:
        targets[..., servos.index(curve.servo)] = curve.at(clock)
    return targets


def table_limbs(
    robot: AnyRobot, gait: AngleTable, phase: Float[np.ndarray, "*batch limb"]
) -> Float[np.ndarray, "*batch servo"]:
    """Return the servo angles of limbs at phases of their own; the axis is straight [rad].

    Args:
        robot: the design, for which the table is.
        gait: the table.
        phase: of the limbs, 0 where a swing begins [cycle].
    """
    place = layout(robot)
    found = np.zeros((*phase.shape[:-1], len(place.servos)))
    for i, limb in enumerate(place.limbs):
        found[..., limb.servos] = table_targets(robot, gait, phase[..., i] - gait.limb_phases[i])[..., limb.servos]
    return found


def table_middle(robot: AnyRobot, gait: AngleTable) -> Float[np.ndarray, " servo"]:
    """Return the servo angles in the middle of each limb's stance, with a straight axis [rad]."""
    return table_limbs(robot, gait, np.full(len(gait.limb_phases), 1.0 - gait.duty_factor / 2))

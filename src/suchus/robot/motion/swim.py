"""Swimming gaits: a wave of lateral bends along the axis of any body, its limbs held back."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from suchus.core.checks import require
from suchus.core.errors import InvalidDesign
from suchus.robot.design import Limb, Robot, layout
from suchus.robot.motion.axis import yaw_hinges
from suchus.robot.motion.gait import Gait
from suchus.robot.motion.parts import AxisRegion, Bend, FixedLimbs

LIMBS_BACK = (-np.pi / 2, -0.15)
"""Yaw, forward positive, and pitch, down positive, of limbs that lie back along the body as it swims [rad]."""
LIMBS_UP = (-np.pi / 2, -0.3)
"""Those of limbs that point up to the surface: foam on them keeps the body upright [rad]."""
_PARTS: tuple[AxisRegion, ...] = ("neck", "trunk", "tail")


def lateral_servos(robot: Robot) -> tuple[str, ...]:
    """Return the servos that bend a robot sideways, in the order of ``design.layout(robot).servos``."""
    place = layout(robot)
    return tuple(place.servos[i] for i in sorted((*place.axial_yaw, *place.cables)))


def limbs_back(robot: Robot) -> Float[np.ndarray, " joint"]:
    """Return the angles of all hinges of a straight body whose limbs lie back along it [rad]."""
    place = layout(robot)
    angles = np.zeros(len(place.hinges))
    for limb in place.limbs:
        back = hold_limb(limb.girdle.limb, LIMBS_BACK).angles
        angles[limb.hinges.start : limb.hinges.start + len(back)] = back
    return angles


def swimming_gait(
    robot: Robot,
    *,
    name: str,
    frequency: float,
    amplitude: Sequence[float],
    lag: Sequence[float],
    limbs: tuple[float, float] = LIMBS_BACK,
) -> Gait:
    """Return the gait in which every lateral servo bends by ``amplitude cos(2 pi (f t - lag))``, concave left positive.

    Args:
        robot: the design, with any axis and any limbs.
        name: name of the gait.
        frequency: f [Hz], 0.01 to 20.
        amplitude: amplitude of each of ``lateral_servos(robot)``; that of a cable is the bend of all its hinges
            together [rad], 0 to pi.
        lag: phase lag of each of them behind f t [cycle], -1 to 1.
        limbs: yaw and pitch at which limbs that have such joints are held [rad]; other joints of limbs are held as near
            0 as they go.

    Raises:
        InvalidDesign: not one amplitude and lag for each lateral servo, or a number is out of range.
    """
    servos = lateral_servos(robot)
    require("swim", "frequency", frequency, 0.01, 20.0, "Hz")
    for field, values, lower_bound, upper_bound, unit in (
        ("amplitude", amplitude, 0.0, 3.1416, "rad"),
        ("lag", lag, -1.0, 1.0, "cycle"),
    ):
        if len(values) != len(servos):
            raise InvalidDesign(
                f"swim.{field} has {len(values)} numbers; robot {robot.name!r} has {len(servos)} lateral servos "
                f"({', '.join(servos) or 'none'}), and each needs one."
            )
        for servo, value in zip(servos, values, strict=True):
            require("swim", f"{field} of {servo}", value, lower_bound, upper_bound, unit)
    hinges, place = yaw_hinges(robot), layout(robot)
    number = {place.servos.index(servo): i for i, servo in enumerate(servos)}
    count = {servo: hinges.servos.count(servo) for servo in number}
    axis = []
    for region in _PARTS:
        region_servos = [hinges.servos[k] for k in hinges.indices_in(region)]
        if region_servos:
            sizes = tuple(
                len(region_servos) / count[servo] * float(amplitude[number[servo]]) for servo in region_servos
            )
            lags = tuple(float(lag[number[servo]]) for servo in region_servos)
            axis.append(Bend(part=region, amplitude=_knots(sizes), lag=_knots(lags)))
    return Gait(
        name=name,
        period=1.0 / frequency,
        limb_phases=(0.0,) * len(place.limbs),
        limbs=tuple(hold_limb(girdle.limb, limbs) for girdle in robot.girdles),
        axis=tuple(axis),
    )


def straight_gait(robot: Robot, *, frequency: float = 1.0, limbs: tuple[float, float] = LIMBS_BACK) -> Gait:
    """Return the swimming gait that is none: a straight axis, limbs held back; see ``swimming_gait``."""
    zeros = (0.0,) * len(lateral_servos(robot))
    return swimming_gait(robot, name="still", frequency=frequency, amplitude=zeros, lag=zeros, limbs=limbs)


def with_limbs(robot: Robot, gait: Gait, limbs: tuple[float, float]) -> Gait:
    """Return a gait whose limbs are held at other angles, yaw and pitch as in ``swimming_gait`` [rad]."""
    return replace(gait, limbs=tuple(hold_limb(girdle.limb, limbs) for girdle in robot.girdles))


def _knots(values: tuple[float, ...]) -> tuple[float, ...]:
    return values[:1] if len({*values}) == 1 else values


def hold_limb(limb: Limb, angles: tuple[float, float]) -> FixedLimbs:
    """Return a limb held at a yaw and a pitch within its ranges, all other joints as near to 0 as they go [rad].

    Args:
        limb: the design.
        angles: yaw, forward positive, and pitch, down positive [rad].
    """
    driven_hinges = [hinge for hinge in limb.hinges if hinge.servo is not None]
    turns, row = [hinge.turn for hinge in driven_hinges], [0.0] * len(driven_hinges)
    for turn, angle in zip(("yaw", "pitch"), angles, strict=True):
        if turn in turns:
            row[turns.index(turn)] = angle
    ranges = [hinge.range or (-np.pi, np.pi) for hinge in driven_hinges]
    return FixedLimbs(
        angles=tuple(
            float(min(max(angle, lower_bound), upper_bound))
            for angle, (lower_bound, upper_bound) in zip(row, ranges, strict=True)
        )
    )

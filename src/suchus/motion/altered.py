"""The same movement with one thing changed: a part of the axis held straight, other strokes, other bends, another lag.

What gaits of every kind have in common can so be compared on every body.
"""

from dataclasses import replace

import numpy as np

from suchus.design import AnyRobot, layout
from suchus.errors import InvalidDesign, OutsideLimits
from suchus.motion.angle_table import AngleTable, Curve
from suchus.motion.any_body import AnyGait, check_limits
from suchus.motion.gait import Gait
from suchus.motion.pattern import FootPath, Held, Pattern, Sweep
from suchus.motion.targets import longest_stroke as longest_of_legs

_MOST, _NEAR = 8.0, 1e-3  # greatest factor on strokes that is tried, and how near to the greatest possible one it ends


def straightened(robot: AnyRobot, gait: AnyGait, *, trunk: bool = True, tail: bool = True, name: str = "") -> AnyGait:
    """Return a movement whose axis is held straight ahead of the root, behind it, or both; a steady bend stays.

    Args:
        robot: the design, for which the movement is.
        gait: the movement.
        trunk: whether what lies ahead of the root is held straight.
        tail: whether what lies behind the root is held straight.
        name: of the movement that is returned; that of ``gait`` if empty.
    """
    name = name or gait.name
    if isinstance(gait, Gait):
        still = {field: 0.0 for field, on in (("trunk_bend", trunk), ("tail_bend", tail)) if on}
        return replace(gait, name=name, **still)  # type: ignore[arg-type]
    place = layout(robot)
    behind = {*place.tail_yaw, *place.tail_pitch, *place.cables}
    held = {i for i in (*place.axial_yaw, *place.axial_pitch, *place.cables) if (tail if i in behind else trunk)}
    if isinstance(gait, AngleTable):
        kept = tuple(curve for curve in gait.curves if place.servos.index(curve.servo) not in held)
        return replace(gait, name=name, curves=kept or (Curve(servo=place.servos[0], angles=(0.0,)),))
    bent = [(at, i) for i, at in zip(place.axial_yaw, place.axial_place, strict=True)]
    bent += [(at, i) for i in place.cables for at in place.cable_places(i)]
    places, angles = zip(*gait.wave.amplitude, strict=True)
    knots = {at: 0.0 if i in held else float(np.interp(at, places, angles)) for at, i in sorted(bent)}
    return replace(gait, name=name, wave=replace(gait.wave, amplitude=tuple(knots.items()) or ((0.0, 0.0),)))


def with_strokes(gait: AnyGait, share: float) -> AnyGait:
    """Return a movement whose limbs stride by a share of what they do [-]; held limbs and tables stay as they are."""
    if isinstance(gait, Gait):
        return replace(gait, stroke=share * gait.stroke)
    if isinstance(gait, AngleTable):
        return gait
    return replace(gait, girdles=tuple(_strode(does, share) for does in gait.girdles))


def with_bends(robot: AnyRobot, gait: AnyGait, share: float) -> AnyGait:
    """Return a movement whose axis bends sideways by a share of what it does [-]."""
    if isinstance(gait, Gait):
        return replace(gait, trunk_bend=share * gait.trunk_bend, tail_bend=share * gait.tail_bend)
    if isinstance(gait, Pattern):
        bent = tuple((at, share * angle) for at, angle in gait.wave.amplitude)
        return replace(gait, wave=replace(gait.wave, amplitude=bent))
    axial = _axial(robot)
    curves = [
        replace(curve, angles=tuple(share * angle for angle in curve.angles)) if curve.servo in axial else curve
        for curve in gait.curves
    ]
    return replace(gait, curves=tuple(curves))


def with_axis_lag(robot: AnyRobot, gait: AnyGait, lag: float) -> AnyGait:
    """Return a movement whose axis lags the limbs by so much more than it does now [cycle]."""
    if isinstance(gait, Gait):
        return replace(gait, spine_phase=_wrapped(gait.spine_phase + lag))
    if isinstance(gait, Pattern):
        return replace(gait, wave=replace(gait.wave, phase=_wrapped(gait.wave.phase + lag)))
    axial = _axial(robot)
    curves = []
    for curve in gait.curves:
        count = len(curve.angles)
        shifted = tuple(float(angle) for angle in curve.at(np.arange(count) / count - lag))
        curves.append(replace(curve, angles=shifted) if curve.servo in axial else curve)
    return replace(gait, curves=tuple(curves))


def strides(gait: AnyGait) -> bool:
    """Return whether a movement has strokes that can be changed."""
    if isinstance(gait, Gait):
        return gait.stroke != 0.0
    if not isinstance(gait, Pattern):
        return False
    return any(isinstance(does, Sweep) or (isinstance(does, FootPath) and does.stroke != 0.0) for does in gait.girdles)


def longest_strokes(robot: AnyRobot, gait: AnyGait) -> float:
    """Return the greatest share of its strokes that a robot's limbs can follow, up to eight times [-]."""
    if isinstance(gait, Gait):
        return longest_of_legs(robot, gait) / abs(gait.stroke) if gait.stroke else 1.0
    if not strides(gait):
        return 1.0
    low, high = 1.0, _MOST
    while high - low > _NEAR:
        middle = 0.5 * (low + high)
        if _possible(robot, gait, middle):
            low = middle
        else:
            high = middle
    return low


def _possible(robot: AnyRobot, gait: AnyGait, share: float) -> bool:
    try:
        check_limits(robot, with_strokes(gait, share))
    except (InvalidDesign, OutsideLimits):
        return False
    return True


def _strode(does: FootPath | Sweep | Held, share: float) -> FootPath | Sweep | Held:
    if isinstance(does, FootPath):
        return replace(does, stroke=share * does.stroke)
    if isinstance(does, Sweep):
        return replace(does, stance=share * does.stance)
    return does


def _axial(robot: AnyRobot) -> set[str]:
    place = layout(robot)
    return {place.servos[i] for i in (*place.axial_yaw, *place.axial_pitch, *place.cables)}


def _wrapped(lag: float) -> float:
    """Return a lag between minus half and half a cycle."""
    return (lag + 0.5) % 1.0 - 0.5 if abs(lag) > 1.0 else lag

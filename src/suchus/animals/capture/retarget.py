"""From what was seen of an animal to the gait of any robot: by feet and bends, or joint by joint as it was measured."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import degrees, floor
from typing import Literal, NamedTuple

import numpy as np

from suchus.animals.capture.angles import STANDING
from suchus.animals.capture.table import AngleCycle
from suchus.animals.capture.tracks import UnusableTracks
from suchus.animals.capture.walk import UNSURE, Walk
from suchus.core.errors import InvalidDesign, OutsideLimits, UnknownName
from suchus.robot.design import LEGS, Layout, LimbPlace, Robot, check_needs, hips_ahead, layout, servo_ranges
from suchus.robot.kinematics import limb as limb_kinematics
from suchus.robot.motion import (
    Bend,
    Curve,
    FootPath,
    Gait,
    check_limits,
    cycle_targets,
    servo_parts,
    servo_range,
    shortest_period,
    suits,
)
from suchus.robot.motion.axis import yaw_hinges

Duty = Literal["retraction", "contact"]
"""Share of the cycle that becomes the duty factor: feet going back along the body, or feet at rest on the ground.

A gait commands the first. On a film of our own crawl, which commands 0.5, feet go back for 0.47 of the cycle but rest
for 0.61, because the body sags onto feet that should have left the ground.
"""
Girdles = Literal["alike", "apart"]
"""Whether all limbs get their mean stroke and lift, or each girdle's limbs their own.

On a film of our own crawl, which commands 27 mm for all, slipping lets front feet stroke by 26 and hind feet by 30 mm.
"""
Time = Literal["froude", "own"]
"""Whether time goes with the square root of length, as at equal Froude number, or stays the animal's."""
NEEDED = ("four_limbs", "foot_paths")
"""What the walk of a four-limbed animal requires of a robot: names of ``design.NEEDS``."""
_PAIRS = (LEGS[:2], LEGS[2:])
_STILL = np.radians(1.0)  # a bend below this has no phase
_AXIS = re.compile(r"^axis (\d+)$", re.IGNORECASE)
_LIMB = re.compile(r"^(left|right) (shoulder|hip)-(yaw|pitch|roll)$|^(left|right) (elbow|knee)$", re.IGNORECASE)
_FRONT = ("shoulder", "elbow")
_STEPS = 200  # of the cycle, to see when a foot goes forward


@dataclass(frozen=True, slots=True, kw_only=True)
class Captured:
    """A gait read from a walk."""

    gait: Gait
    """The gait for the robot."""
    timing: str
    """How the animal's time became the robot's, a sentence."""
    notes: tuple[str, ...]
    """Sentences on what was measured and is not in the gait, what is in it without a measurement, and what was
    changed."""


class _Feet(NamedTuple):
    """Where the feet of a girdle go, in its frame [m]."""

    stroke: float
    lift: float
    outward: float
    ahead: float


def to_gait(
    walk: Walk,
    robot: Robot,
    base: Gait,
    *,
    name: str,
    duty: Duty = "retraction",
    girdles: Girdles = "alike",
    time: Time = "froude",
    trunk: float | None = None,
) -> Captured:
    """Return the gait by which a robot walks as was measured.

    Phases and angles are taken as they are, lengths in proportion to the trunk from hip to shoulder. Trunk and tail
    bend by their first harmonics, each shared evenly by its hinges. Quantities that were not measured are the base's.
    What the robot's limits refuse is changed as little as needed.

    Args:
        walk: the measured walk.
        robot: the robot that shall walk, with four limbs whose feet can be put on a path.
        base: gait of foot paths, from which quantities that were not measured are taken.
        name: name of the new gait.
        duty: which share of the cycle becomes its duty factor.
        girdles: whether front and hind limbs share their stroke and lift.
        time: whether the period goes with the square root of the length, or is the animal's own.
        trunk: the animal's length from hip to shoulder, where the film does not show it [m].

    Raises:
        UnsuitedRobot: the robot lacks four limbs with foot paths.
        UnusableTracks: the walk was measured without keypoints that a gait is read from.
        OutsideLimits: the base has no foot paths, or the robot cannot follow even with the base's posture and a small
            stroke.
    """
    check_needs(robot, NEEDED, "a captured walk")
    if walk.lacks:
        why = [note for note in walk.notes if note.partition(" ")[0] in (*walk.lacks, "neck", "snout")]
        raise UnusableTracks(
            f"{walk.source} lacks the keypoint{'s' * (len(walk.lacks) > 1)} {', '.join(walk.lacks)} that a gait is "
            f"read from{''.join(f'; {note}' for note in why)}: rename with --names THEIRS=OURS, or track them; suchus "
            "capture --tables DIR measures what the others show."
        )
    if not {"spine_lateral", "tail_lateral"} <= set(walk.bends):
        raise UnusableTracks(
            f"{walk.source} does not show how trunk and tail bend to the sides, which a gait is read from: film from "
            "above; suchus capture --tables DIR measures what it shows."
        )
    check_limits(robot, base)
    if not base.limbs or not all(isinstance(limb, FootPath) for limb in base.limbs):
        raise OutsideLimits(
            f"a captured walk takes what was not measured from a gait of foot paths; gait {base.name!r} has measured "
            "curves, holds limbs or turns cranks: name another one with --base."
        )
    notes: list[str] = []
    factor, timing = time_scale(walk, robot, time, trunk)
    gait = _timed(walk, replace(base, name=name, curves=(), coupling=()), duty, factor, notes)
    gait = _bent(walk, robot, gait, notes)
    gait = _stepping(walk, robot, gait, base, girdles, notes)
    gait = _slowed(robot, gait, notes)
    return Captured(gait=gait, timing=timing, notes=(*walk.notes, *notes, *_unheld(walk)))


def driven_share(robot: Robot) -> float:
    """Return where along its tail, from its first joint, a robot's last driven segment has its middle [-].

    The end beyond it is passive: it follows by itself, and no command holds it. It is 1 without such an end.
    """
    place = layout(robot)
    driven = {place.servos[i] for i in place.tail_yaw}
    driven |= {name for servo in place.cables for name in place.cable(servo).hinges}
    behind = robot.axis[robot.root_place :]
    bent = [i for i, segment in enumerate(behind) if any(hinge.name in driven for hinge in segment.hinges)]
    lengths = [segment.front + segment.rear for segment in behind[1:]]
    if not bent or bent[-1] + 1 >= len(lengths):
        return 1.0
    return (sum(lengths[: bent[-1]]) + lengths[bent[-1]] / 2) / sum(lengths)


def mean_of(walk: Walk, stem: str, legs: tuple[str, ...] = LEGS) -> float:
    """Return the mean of a number over legs, leaving out duty factors that are not sure."""
    known = [leg for leg in legs if stem != "duty" or not walk.numbers[f"duty_{leg}"].error > UNSURE]
    return float(np.mean([walk.value(f"{stem}_{leg}") for leg in known or legs]))


def time_scale(walk: Walk, robot: Robot, time: Time, trunk: float | None) -> tuple[float, str]:
    """Return by what the robot's period is longer than the animal's, and a sentence that says why [-].

    Bodies of different size walk alike at equal Froude number, where time goes with the square root of length.

    Args:
        walk: the measured walk.
        robot: the robot that shall walk.
        time: see ``to_gait``.
        trunk: see ``to_gait``.

    Raises:
        UnusableTracks: the length that was given is none.
    """
    if trunk is not None and not 0.0 < trunk < np.inf:
        raise UnusableTracks(f"the animal's trunk is {trunk:g} m long; a length above 0 is needed.")
    own, long = walk.value("period"), walk.numbers.get("trunk_length")
    animal = trunk if trunk is not None else long.value if long is not None and long.unit == "m" else None
    if time == "own":
        return 1.0, f"time: the animal's own, a cycle of {own:.3f} s"
    if animal is None:
        return 1.0, (
            f"time: the animal's own, a cycle of {own:.3f} s, since a film in pixels does not show how long the animal "
            "is; with --trunk METRES, its length from hip to shoulder, time goes with the square root of length"
        )
    ours = hips_ahead(robot, 0)
    factor = float(np.sqrt(ours / animal))
    return factor, (
        f"time: scaled by {factor:.3f}, the square root of lengths ({ours:.3f} m of {robot.name}, {animal:.3f} m of "
        f"the animal, hip to shoulder): the cycle of {own:.3f} s becomes {factor * own:.3f} s; --time own keeps it"
    )


def _timed(walk: Walk, gait: Gait, duty: Duty, factor: float, notes: list[str]) -> Gait:
    stem = "duty" if duty == "contact" else "retraction"
    share = mean_of(walk, stem)
    other = mean_of(walk, "retraction" if duty == "contact" else "duty")
    if abs(share - other) > 0.05:
        notes.append(
            f"feet rest on the ground for {mean_of(walk, 'duty'):.2f} of the cycle and go back along the body for "
            f"{mean_of(walk, 'retraction'):.2f} of it; a gait has one duty factor, the {duty} share was taken"
        )
    apart = {leg: walk.value(f"{stem}_{leg}") for leg in LEGS}
    if np.ptp(list(apart.values())) > 0.05:
        shares = ", ".join(f"{leg} {value:.2f}" for leg, value in apart.items())
        notes.append(f"the legs' {duty} shares differ ({shares}); the gait holds their mean")
    phases = tuple(_rounded((walk.value(f"phase_{leg}") + 0.05) % 1.0 - 0.05) for leg in LEGS)
    return replace(
        gait, period=_rounded(factor * walk.value("period")), duty_factor=_rounded(share), limb_phases=phases
    )


def _bent(walk: Walk, robot: Robot, gait: Gait, notes: list[str]) -> Gait:
    """Give trunk and tail the first harmonics that were measured; steady bends up and down stay the base's."""
    # both clocks have LF's mid-stance in common: the gait's begins half the difference of the duty factors off
    clock = np.exp(1j * np.pi * (gait.duty_factor - mean_of(walk, "duty")))
    touch_down = 0.75 - gait.duty_factor / 2
    bends = [bend for bend in gait.axis if bend.turn == "pitch"]
    parts: tuple[tuple[Literal["trunk", "tail"], str], ...] = (("trunk", "spine"), ("tail", "tail"))
    for part, word in parts:
        seen = clock * walk.bends[f"{word}_lateral"]
        most = _most(robot, part)
        if not most:
            notes.append(f"robot {robot.name} has no {part} that bends; {degrees(abs(seen)):.0f} degrees were seen")
            continue
        straight = walk.value(f"{word}_lateral") < _STILL
        if straight:
            notes.append(f"the {word} hardly bends ({degrees(abs(seen)):.1f} degrees): its phase has no meaning")
        # concave on the right by |seen| cos 2 pi (phase of LF - its delay), which is what a bend says of the left
        lag = 0.0 if straight else _within_half(-float(np.angle(seen)) / (2 * np.pi) - touch_down)
        amplitude_seen = _rounded(abs(seen))
        limits = [floor(1e4 * len(most) * limit) / 1e4 for limit in most]
        if min(limits) < amplitude_seen:
            notes.append(
                f"the {part} would bend by {degrees(amplitude_seen):.0f} degrees, more than its joints' ranges: of "
                f"{len(limits)} joints, those that cannot follow bend as far as they can"
            )
        amplitude = tuple(min(amplitude_seen, limit) for limit in limits)
        bends.append(
            Bend(part=part, amplitude=amplitude if len(set(amplitude)) > 1 else amplitude[:1], lag=(_rounded(lag),))
        )
    return replace(gait, axis=tuple(bends))


def _most(robot: Robot, part: Literal["trunk", "tail"]) -> list[float]:
    """Return how far each hinge that bends a part sideways can bend it to either side [rad]."""
    place, ranges, hinges = layout(robot), np.abs(servo_ranges(robot)).min(axis=1), yaw_hinges(robot)
    cables = {servo: place.cable(servo).bend_limit / place.cable(servo).joints for servo in place.cables}
    return [cables.get(hinges.servos[k], float(ranges[hinges.servos[k]])) for k in hinges.within(part)]


def _stepping(walk: Walk, robot: Robot, gait: Gait, base: Gait, girdles: Girdles, notes: list[str]) -> Gait:
    """Give the feet the measured paths in proportion to the trunk; what the limbs cannot follow becomes the base's."""
    reaches = [girdle.limb.reach for girdle in robot.girdles]
    lent = [_feet_of(limb, reach) for limb, reach in zip(base.limbs, reaches, strict=True)]
    feet = _feet(walk, robot, lent, girdles, notes)
    if walk.upright:
        notes.append(f"markers lie on the skin, so that height is that of {base.name}")
        if layout(robot).tail_pitch:
            low, high = np.sum([servo_range(robot, layout(robot).servos[i]) for i in layout(robot).tail_pitch], axis=0)
            pitch = float(np.clip(_rounded(walk.value("tail_vertical_steady")), low, high))
            gait = gait.with_numbers(tail_pitch=pitch)
    else:
        notes.append(f"heights were not seen: lift, height and tail_pitch are those of {base.name}")
    whole = _placed(robot, gait, feet)
    if whole is not None:
        return whole
    notes.append(f"the limbs of {robot.name} do not reach the feet's places: those and the lift are {base.name}'s")
    strokes = [one.stroke for one in feet]
    for share in np.linspace(1.0, 0.1, 19):
        shorter = [one._replace(stroke=share * stroke) for one, stroke in zip(lent, strokes, strict=True)]
        placed = _placed(robot, gait, shorter)
        if placed is not None:
            if share < 1.0:
                said = " and ".join(f"{1000 * stroke:.0f} mm" for stroke in dict.fromkeys(strokes))
                taken = " and ".join(f"{1000 * share * stroke:.0f} mm" for stroke in dict.fromkeys(strokes))
                notes.append(f"half strokes of {said} are beyond the limbs; {taken} was taken")
            return placed
    still = replace(gait, limbs=base.limbs)
    check_limits(robot, still)
    raise OutsideLimits(
        f"robot {robot.name!r} cannot follow a tenth of the strokes that were seen, {1000 * max(strokes):.0f} mm at "
        f"its size, in the posture of gait {base.name!r}: name another one with --base."
    )


def _feet(walk: Walk, robot: Robot, lent: Sequence[_Feet], girdles: Girdles, notes: list[str]) -> list[_Feet]:
    """Return the measured paths of the feet at the robot's size."""
    trunk, sides = hips_ahead(robot, 0), [girdle.aside for girdle in robot.girdles]
    strokes, stroke = [trunk * mean_of(walk, "stroke", legs) for legs in _PAIRS], trunk * mean_of(walk, "stroke")
    if girdles == "alike" and abs(strokes[0] - strokes[1]) > 0.1 * stroke:
        notes.append(
            f"the feet's half strokes differ, front {1000 * strokes[0]:.0f} mm and hind {1000 * strokes[1]:.0f} mm at "
            "the robot's size; the gait holds their mean"
        )
    feet = []
    for i, legs in enumerate(_PAIRS):
        among = LEGS if girdles == "alike" else legs
        feet.append(
            _Feet(
                stroke=stroke if girdles == "alike" else strokes[i],
                lift=abs(trunk * mean_of(walk, "lift", among)) if walk.upright else lent[i].lift,
                outward=trunk * mean_of(walk, "outward", legs) - sides[i],
                ahead=trunk * mean_of(walk, "ahead", legs),
            )
        )
    return feet


def _feet_of(limb: object, reach: float) -> _Feet:
    """Return the foot path of a gait for a limb of some length [m]."""
    assert isinstance(limb, FootPath)
    return _Feet(*(reach * getattr(limb, field) for field in _Feet._fields))


def _placed(robot: Robot, gait: Gait, feet: Sequence[_Feet]) -> Gait | None:
    """Return the gait with these paths of the feet; None where the robot cannot follow it."""
    reaches = [girdle.limb.reach for girdle in robot.girdles]
    try:
        limbs = tuple(
            replace(limb, **{field: _rounded(metres / reach) for field, metres in path._asdict().items()})  # type: ignore[arg-type]
            for limb, path, reach in zip(gait.limbs, feet, reaches, strict=True)
        )
    except InvalidDesign:  # a path longer than the limb
        return None
    placed = replace(gait, limbs=limbs)
    return placed if suits(robot, placed) else None


def _slowed(robot: Robot, gait: Gait, notes: list[str]) -> Gait:
    """Return the gait with a period in which no servo has to turn faster than it can."""
    needed, slow = shortest_period(robot, gait)
    if needed <= gait.period:
        return gait
    notes.append(
        f"in a cycle of {gait.period:.4g} s {slow} would have to turn faster than its servo can; the period is "
        f"{needed:.4g} s"
    )
    return replace(gait, period=round(needed + 5e-5, 4))  # never rounded to below what is needed


def _unheld(walk: Walk) -> list[str]:
    """Note what was measured and is not in the gait."""
    notes = []
    for part in ("trunk", "tail"):
        index = walk.value(f"standing_{part}")
        if index < STANDING:
            notes.append(
                f"the {part} bends as a travelling wave (standing index {index:.2f}); the gait bends it all at once"
            )
    for part in ("spine", "tail"):
        steady, beyond = walk.value(f"{part}_lateral_steady"), walk.value(f"{part}_lateral_overtones")
        if abs(steady) > np.radians(3.0):
            side = "right" if steady > 0 else "left"
            notes.append(
                f"the {part} is bent {abs(degrees(steady)):.0f} degrees to the {side} on average; in the gait it is not"
            )
        if beyond > 0.2 and walk.value(f"{part}_lateral") > _STILL:
            notes.append(
                f"the {part}'s overtones are {100 * beyond:.0f} % of its swing; in the gait it swings as a cosine"
            )
        name = f"{part}_vertical"
        if name in walk.numbers and walk.value(name) > np.radians(3.0):
            notes.append(
                f"the {part} swings up and down by {degrees(walk.value(name)):.0f} degrees; in the gait it does not"
            )
    return notes


def to_curves(cycle: AngleCycle, robot: Robot, *, name: str, period: float) -> Gait:
    """Return the gait that plays measured joint angles on a robot; nothing is fitted.

    A column is called after the robot's servo, or as in tables of animals: ``Axis 3``, the third lateral hinge from
    the head, positive where the body is concave on its right; ``Left Shoulder-yaw``, ``-pitch``, ``-roll`` and ``Left
    Elbow`` of a fore limb, ``Hip`` and ``Knee`` of a hind limb, positive as the hinges of a limb are: forward, down,
    the lower limb forward, bent. A limb swings while its foot goes forward in its girdle's frame.

    Args:
        cycle: the angles, as ``read_angles`` returns them.
        robot: who plays them.
        name: of the gait.
        period: of its cycle [s].

    Raises:
        UnknownName: a column belongs to no servo of the robot.
        OutsideLimits: two columns belong to the same servo.
    """
    place, parts = layout(robot), servo_parts(robot)
    columns = [_servo(place, joint) for joint in cycle.joints]
    numbers = [number for number, _ in columns]
    twice = next((number for number in numbers if numbers.count(number) > 1), None)
    if twice is not None:
        raise OutsideLimits(f"{cycle.source} has two columns for servo {place.servos[twice]}; leave one of them.")
    count = 2 * cycle.harmonics.shape[1] - 1  # as many samples as the harmonics have numbers
    angles = cycle.at(np.arange(count) / count)
    curves = tuple(
        Curve(
            servo=place.servos[number],
            part=parts[place.servos[number]],
            angles=tuple(round(float(angle), 3) for angle in sign * angles[:, i]),
        )
        for i, (number, sign) in enumerate(columns)
    )
    played = Gait(name=name, period=period, limb_phases=(0.0,) * len(place.limbs), curves=curves)
    swings = [_swing(robot, played, limb) for limb in place.limbs]
    duty = 1.0 - float(np.mean([share for _, share in swings])) if swings else 0.5
    return replace(
        played,
        duty_factor=round(min(max(duty, 0.05), 0.95), 3),
        limb_phases=tuple(round((1.0 - start) % 1.0, 3) for start, _ in swings),
    )


def _servo(place: Layout, joint: str) -> tuple[int, float]:
    """Return the number of the servo that a column belongs to, and the sign of its angle."""
    word = " ".join(joint.split())
    if word in place.servos:
        return place.servos.index(word), 1.0
    axis, limb = _AXIS.match(word), _LIMB.match(word)
    if axis and 1 <= int(axis[1]) <= len(place.axial_yaw):
        number = int(axis[1]) - 1
        return place.axial_yaw[number], -place.axial_left[number]
    if limb and place.limbs:
        side, part, turn = limb[1] or limb[4], limb[2] or limb[5], limb[3]
        girdle = 0 if part.lower() in _FRONT else place.limbs[-1].number
        mine = next(leg for leg in place.limbs if leg.number == girdle and (leg.side > 0) == (side.lower() == "left"))
        hinges = mine.girdle.limb.hinges
        names = [hinge.name for hinge in hinges if turn is None or hinge.turn == turn.lower()]
        wanted = f"{mine.name}_{names[0] if turn else names[-1]}" if names else ""
        if wanted in place.servos:
            return place.servos.index(wanted), 1.0
    raise UnknownName(f"joint of robot {place.robot.name!r}", joint, (*place.servos, *_spelled(place)))


def _spelled(place: Layout) -> tuple[str, ...]:
    """Return further names of columns that a robot could play, as an example of each kind."""
    axis = (f"Axis 1 to {len(place.axial_yaw)}",) if place.axial_yaw else ()
    return (*axis, *(("Left Shoulder-yaw", "Left Hip-yaw", "Left Elbow", "Left Knee") if place.limbs else ()))


def _swing(robot: Robot, gait: Gait, limb: LimbPlace) -> tuple[float, float]:
    """Return when the foot of a limb begins to go forward, and for which share of the cycle it does [cycle]."""
    clock = np.arange(_STEPS) / _STEPS
    design, place = limb.girdle.limb, layout(robot)
    targets, angles = cycle_targets(robot, gait, clock), np.zeros((_STEPS, len(design.hinges)))
    for i, hinge in enumerate(design.hinges):
        if hinge.servo is not None:
            angles[:, i] = targets[:, place.servos.index(f"{limb.name}_{hinge.name}")]
    ahead = limb_kinematics.forward(design, angles)[:, 0]
    start, end = int(np.argmin(ahead)), int(np.argmax(ahead))
    return start / _STEPS, ((end - start) % _STEPS) / _STEPS


def _within_half(cycles: float) -> float:
    return (cycles + 0.5) % 1.0 - 0.5


def _rounded(value: float) -> float:
    return round(float(value), 4)

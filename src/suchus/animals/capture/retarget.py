"""From a measured walk to the gait of any robot: by feet and bends, or by the measured angle of each joint."""

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
    min_gait_period,
    servo_parts,
    servo_range,
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
ROBOT_NEEDS = ("four_limbs", "foot_paths")
"""What the walk of a four-limbed animal requires of a robot: names of ``design.NEEDS``."""
_PAIRS = (LEGS[:2], LEGS[2:])
_MIN_BEND = np.radians(1.0)  # a bend below this has no phase
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


class _FootPathLengths(NamedTuple):
    """The path of a girdle's feet in lengths, from the hip; fields are named as those of ``FootPath``."""

    stroke: float
    """Half of the path's length [m]."""
    lift: float
    """Height of the swing [m]."""
    outward: float
    """Distance of the path outside the hip [m]."""
    ahead: float
    """Distance of the middle of the path ahead of the hip [m]."""


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
    """Return the gait by which a robot walks as the animal was measured.

    Phases and angles are taken as they are, lengths in proportion to the trunk from hip to shoulder. Trunk and tail
    bend by their first harmonics, and all hinges of a region bend equally. Quantities that were not measured are those
    of the base gait. Quantities beyond the robot's limits are changed as little as possible.

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
    check_needs(robot, ROBOT_NEEDS, "a captured walk")
    if walk.lacks:
        lacking_notes = [note for note in walk.notes if note.partition(" ")[0] in (*walk.lacks, "neck", "snout")]
        raise UnusableTracks(
            f"{walk.source} lacks the keypoint{'s' * (len(walk.lacks) > 1)} {', '.join(walk.lacks)} that a gait is "
            f"read from{''.join(f'; {note}' for note in lacking_notes)}: rename with --names THEIRS=OURS, or track "
            "them; suchus capture --tables DIR measures what the others show."
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
    gait = _with_timing(walk, replace(base, name=name, curves=(), coupling=()), duty, factor, notes)
    gait = _with_bends(walk, robot, gait, notes)
    gait = _with_steps(walk, robot, gait, base, girdles, notes)
    gait = _with_feasible_period(robot, gait, notes)
    return Captured(gait=gait, timing=timing, notes=(*walk.notes, *notes, *_unrepresented_notes(walk)))


def driven_fraction(robot: Robot) -> float:
    """Return the position of the middle of the last driven tail segment, as a fraction of the tail's length [-].

    The segments behind it are passive: no command holds them. The fraction is 1 if all segments are driven.
    """
    place = layout(robot)
    driven_names = {place.servos[i] for i in place.tail_yaw}
    driven_names |= {name for servo in place.cables for name in place.cable(servo).hinges}
    tail_segments = robot.axis[robot.root_index :]
    driven_indices = [
        i for i, segment in enumerate(tail_segments) if any(hinge.name in driven_names for hinge in segment.hinges)
    ]
    lengths = [segment.front + segment.rear for segment in tail_segments[1:]]
    if not driven_indices or driven_indices[-1] + 1 >= len(lengths):
        return 1.0
    return (sum(lengths[: driven_indices[-1]]) + lengths[driven_indices[-1]] / 2) / sum(lengths)


def mean_of(walk: Walk, stem: str, legs: tuple[str, ...] = LEGS) -> float:
    """Return the mean of a number over legs; uncertain duty factors are left out."""
    reliable_legs = [leg for leg in legs if stem != "duty" or not walk.numbers[f"duty_{leg}"].error > UNSURE]
    return float(np.mean([walk.value(f"{stem}_{leg}") for leg in reliable_legs or legs]))


def time_scale(walk: Walk, robot: Robot, time: Time, trunk: float | None) -> tuple[float, str]:
    """Return the period of the robot over that of the animal [-], and a sentence that gives the reason.

    Bodies of different size walk alike at equal Froude number: time is proportional to the square root of length.

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
    animal_period, trunk_number = walk.value("period"), walk.numbers.get("trunk_length")
    animal = (
        trunk
        if trunk is not None
        else trunk_number.value
        if trunk_number is not None and trunk_number.unit == "m"
        else None
    )
    if time == "own":
        return 1.0, f"time: the animal's own, a cycle of {animal_period:.3f} s"
    if animal is None:
        return 1.0, (
            f"time: the animal's own, a cycle of {animal_period:.3f} s, since a film in pixels does not show how "
            "long the animal "
            "is; with --trunk METRES, its length from hip to shoulder, time goes with the square root of length"
        )
    robot_trunk = hips_ahead(robot, 0)
    factor = float(np.sqrt(robot_trunk / animal))
    return factor, (
        f"time: scaled by {factor:.3f}, the square root of lengths ({robot_trunk:.3f} m of {robot.name}, "
        f"{animal:.3f} m of "
        f"the animal, hip to shoulder): the cycle of {animal_period:.3f} s becomes {factor * animal_period:.3f} s; "
        "--time own keeps it"
    )


def _with_timing(walk: Walk, gait: Gait, duty: Duty, factor: float, notes: list[str]) -> Gait:
    """Return the gait with the period, the duty factor and the limb phases of the walk.

    Args:
        walk: the measured walk.
        gait: gait whose other fields are kept.
        duty: fraction that becomes the duty factor, see ``Duty``.
        factor: period of the robot over that of the animal [-].
        notes: sentences for the user, to which this function appends.
    """
    stem = "duty" if duty == "contact" else "retraction"
    duty_fraction = mean_of(walk, stem)
    other_duty = mean_of(walk, "retraction" if duty == "contact" else "duty")
    if abs(duty_fraction - other_duty) > 0.05:
        notes.append(
            f"feet rest on the ground for {mean_of(walk, 'duty'):.2f} of the cycle and go back along the body for "
            f"{mean_of(walk, 'retraction'):.2f} of it; a gait has one duty factor, the {duty} share was taken"
        )
    leg_duties = {leg: walk.value(f"{stem}_{leg}") for leg in LEGS}
    if np.ptp(list(leg_duties.values())) > 0.05:
        shares = ", ".join(f"{leg} {value:.2f}" for leg, value in leg_duties.items())
        notes.append(f"the legs' {duty} shares differ ({shares}); the gait holds their mean")
    phases = tuple(_rounded((walk.value(f"phase_{leg}") + 0.05) % 1.0 - 0.05) for leg in LEGS)
    return replace(
        gait, period=_rounded(factor * walk.value("period")), duty_factor=_rounded(duty_fraction), limb_phases=phases
    )


def _with_bends(walk: Walk, robot: Robot, gait: Gait, notes: list[str]) -> Gait:
    """Return the gait with the first harmonics of the measured bends; vertical bends stay those of the base."""
    # both clocks have LF's mid-stance in common: the gait's begins half the difference of the duty factors off
    clock = np.exp(1j * np.pi * (gait.duty_factor - mean_of(walk, "duty")))
    touch_down = 0.75 - gait.duty_factor / 2
    bends = [bend for bend in gait.axis if bend.turn == "pitch"]
    parts: tuple[tuple[Literal["trunk", "tail"], str], ...] = (("trunk", "spine"), ("tail", "tail"))
    for region, word in parts:
        bend_harmonic = clock * walk.bends[f"{word}_lateral"]
        hinge_limits = _bend_limits(robot, region)
        if not hinge_limits:
            notes.append(
                f"robot {robot.name} has no {region} that bends; {degrees(abs(bend_harmonic)):.0f} degrees were seen"
            )
            continue
        straight = walk.value(f"{word}_lateral") < _MIN_BEND
        if straight:
            notes.append(
                f"the {word} hardly bends ({degrees(abs(bend_harmonic)):.1f} degrees): its phase has no meaning"
            )
        # concave on the right by |seen| cos 2 pi (phase of LF - its delay), which is what a bend says of the left
        lag = 0.0 if straight else _within_half(-float(np.angle(bend_harmonic)) / (2 * np.pi) - touch_down)
        amplitude_seen = _rounded(abs(bend_harmonic))
        limits = [floor(1e4 * len(hinge_limits) * limit) / 1e4 for limit in hinge_limits]
        if min(limits) < amplitude_seen:
            notes.append(
                f"the {region} would bend by {degrees(amplitude_seen):.0f} degrees, more than its joints' ranges: of "
                f"{len(limits)} joints, those that cannot follow bend as far as they can"
            )
        amplitude = tuple(min(amplitude_seen, limit) for limit in limits)
        bends.append(
            Bend(part=region, amplitude=amplitude if len(set(amplitude)) > 1 else amplitude[:1], lag=(_rounded(lag),))
        )
    return replace(gait, axis=tuple(bends))


def _bend_limits(robot: Robot, region: Literal["trunk", "tail"]) -> list[float]:
    """Return the greatest lateral bend of each hinge of trunk or tail, to either side [rad]."""
    place, ranges, hinges = layout(robot), np.abs(servo_ranges(robot)).min(axis=1), yaw_hinges(robot)
    cables = {servo: place.cable(servo).bend_limit / place.cable(servo).joints for servo in place.cables}
    return [cables.get(hinges.servos[k], float(ranges[hinges.servos[k]])) for k in hinges.indices_in(region)]


def _with_steps(walk: Walk, robot: Robot, gait: Gait, base: Gait, girdle_mode: Girdles, notes: list[str]) -> Gait:
    """Return the gait with the measured foot paths, scaled by the length of the trunk.

    Paths that the limbs cannot follow are replaced by those of the base gait, with strokes as long as possible.
    """
    reaches = [girdle.limb.reach for girdle in robot.girdles]
    base_paths = [_foot_path_lengths(limb, reach) for limb, reach in zip(base.limbs, reaches, strict=True)]
    foot_paths = _scaled_foot_paths(walk, robot, base_paths, girdle_mode, notes)
    if walk.has_heights:
        notes.append(f"markers lie on the skin, so that height is that of {base.name}")
        if layout(robot).tail_pitch:
            lower_bound, upper_bound = np.sum(
                [servo_range(robot, layout(robot).servos[i]) for i in layout(robot).tail_pitch], axis=0
            )
            pitch = float(np.clip(_rounded(walk.value("tail_vertical_steady")), lower_bound, upper_bound))
            gait = gait.with_numbers(tail_pitch=pitch)
    else:
        notes.append(f"heights were not seen: lift, height and tail_pitch are those of {base.name}")
    full_gait = _with_feet(robot, gait, foot_paths)
    if full_gait is not None:
        return full_gait
    notes.append(f"the limbs of {robot.name} do not reach the feet's places: those and the lift are {base.name}'s")
    half_strokes = [foot.stroke for foot in foot_paths]
    for fraction in np.linspace(1.0, 0.1, 19):
        shorter = [
            foot._replace(stroke=fraction * stroke) for foot, stroke in zip(base_paths, half_strokes, strict=True)
        ]
        shorter_gait = _with_feet(robot, gait, shorter)
        if shorter_gait is not None:
            if fraction < 1.0:
                requested_text = " and ".join(f"{1000 * stroke:.0f} mm" for stroke in dict.fromkeys(half_strokes))
                applied_text = " and ".join(
                    f"{1000 * fraction * stroke:.0f} mm" for stroke in dict.fromkeys(half_strokes)
                )
                notes.append(f"half strokes of {requested_text} are beyond the limbs; {applied_text} was taken")
            return shorter_gait
    standing_gait = replace(gait, limbs=base.limbs)
    check_limits(robot, standing_gait)
    raise OutsideLimits(
        f"robot {robot.name!r} cannot follow a tenth of the strokes that were seen, {1000 * max(half_strokes):.0f} mm "
        f"at its size, in the posture of gait {base.name!r}: name another one with --base."
    )


def _scaled_foot_paths(
    walk: Walk, robot: Robot, base_paths: Sequence[_FootPathLengths], girdle_mode: Girdles, notes: list[str]
) -> list[_FootPathLengths]:
    """Return the measured foot paths of front and hind feet, scaled to the robot by the length of its trunk [m].

    Args:
        walk: the measured walk.
        robot: the robot that shall walk, with two girdles.
        base_paths: paths of the base gait, whose lift is taken if no heights were measured.
        girdle_mode: ``alike`` for the mean stroke and lift of all feet, ``apart`` for those of each girdle.
        notes: sentences for the user, to which this function appends.
    """
    trunk_length, hip_offsets = hips_ahead(robot, 0), [girdle.aside for girdle in robot.girdles]
    half_strokes, mean_half_stroke = (
        [trunk_length * mean_of(walk, "stroke", legs) for legs in _PAIRS],
        trunk_length * mean_of(walk, "stroke"),
    )
    if girdle_mode == "alike" and abs(half_strokes[0] - half_strokes[1]) > 0.1 * mean_half_stroke:
        notes.append(
            f"the feet's half strokes differ, front {1000 * half_strokes[0]:.0f} mm and hind "
            f"{1000 * half_strokes[1]:.0f} mm at the robot's size; the gait holds their mean"
        )
    foot_paths = []
    for i, legs in enumerate(_PAIRS):
        pooled_legs = LEGS if girdle_mode == "alike" else legs
        foot_paths.append(
            _FootPathLengths(
                stroke=mean_half_stroke if girdle_mode == "alike" else half_strokes[i],
                lift=abs(trunk_length * mean_of(walk, "lift", pooled_legs)) if walk.has_heights else base_paths[i].lift,
                outward=trunk_length * mean_of(walk, "outward", legs) - hip_offsets[i],
                ahead=trunk_length * mean_of(walk, "ahead", legs),
            )
        )
    return foot_paths


def _foot_path_lengths(limb: object, reach: float) -> _FootPathLengths:
    """Return the foot path of a gait for a limb of some length [m]."""
    assert isinstance(limb, FootPath)
    return _FootPathLengths(*(reach * getattr(limb, field) for field in _FootPathLengths._fields))


def _with_feet(robot: Robot, gait: Gait, feet: Sequence[_FootPathLengths]) -> Gait | None:
    """Return the gait with these foot paths, or None where the robot cannot follow it."""
    reaches = [girdle.limb.reach for girdle in robot.girdles]
    try:
        limbs = tuple(
            replace(limb, **{field: _rounded(metres / reach) for field, metres in path._asdict().items()})  # type: ignore[arg-type]
            for limb, path, reach in zip(gait.limbs, feet, reaches, strict=True)
        )
    except InvalidDesign:  # a path longer than the limb
        return None
    candidate = replace(gait, limbs=limbs)
    return candidate if suits(robot, candidate) else None


def _with_feasible_period(robot: Robot, gait: Gait, notes: list[str]) -> Gait:
    """Return the gait with a period in which no servo exceeds its speed."""
    min_period, slowest_joint = min_gait_period(robot, gait)
    if min_period <= gait.period:
        return gait
    notes.append(
        f"in a cycle of {gait.period:.4g} s {slowest_joint} would have to turn faster than its servo can; the period "
        f"is {min_period:.4g} s"
    )
    return replace(gait, period=round(min_period + 5e-5, 4))  # never rounded to below what is needed


def _unrepresented_notes(walk: Walk) -> list[str]:
    """Return a sentence for each measured quantity that the gait cannot represent."""
    notes = []
    for region in ("trunk", "tail"):
        index = walk.value(f"standing_{region}")
        if index < STANDING:
            notes.append(
                f"the {region} bends as a travelling wave (standing index {index:.2f}); the gait bends it all at once"
            )
    for region in ("spine", "tail"):
        steady, overtone_ratio = walk.value(f"{region}_lateral_steady"), walk.value(f"{region}_lateral_overtones")
        if abs(steady) > np.radians(3.0):
            side = "right" if steady > 0 else "left"
            notes.append(
                f"the {region} is bent {abs(degrees(steady)):.0f} degrees to the {side} on average; in the gait it "
                "is not"
            )
        if overtone_ratio > 0.2 and walk.value(f"{region}_lateral") > _MIN_BEND:
            notes.append(
                f"the {region}'s overtones are {100 * overtone_ratio:.0f} % of its swing; in the gait it swings as a "
                "cosine"
            )
        name = f"{region}_vertical"
        if name in walk.numbers and walk.value(name) > np.radians(3.0):
            notes.append(
                f"the {region} swings up and down by {degrees(walk.value(name)):.0f} degrees; in the gait it does not"
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
        robot: robot that plays them.
        name: name of the gait.
        period: period of its cycle [s].

    Raises:
        UnknownName: a column belongs to no servo of the robot.
        OutsideLimits: two columns belong to the same servo.
    """
    place, parts = layout(robot), servo_parts(robot)
    columns = [_servo(place, joint) for joint in cycle.joints]
    servo_indices = [servo_index for servo_index, _ in columns]
    duplicate = next((servo_index for servo_index in servo_indices if servo_indices.count(servo_index) > 1), None)
    if duplicate is not None:
        raise OutsideLimits(f"{cycle.source} has two columns for servo {place.servos[duplicate]}; leave one of them.")
    count = 2 * cycle.harmonics.shape[1] - 1  # as many samples as the harmonics have numbers
    angles = cycle.at(np.arange(count) / count)
    curves = tuple(
        Curve(
            servo=place.servos[servo_index],
            part=parts[place.servos[servo_index]],
            angles=tuple(round(float(angle), 3) for angle in sign * angles[:, i]),
        )
        for i, (servo_index, sign) in enumerate(columns)
    )
    gait = Gait(name=name, period=period, limb_phases=(0.0,) * len(place.limbs), curves=curves)
    swings = [_swing(robot, gait, limb) for limb in place.limbs]
    duty = 1.0 - float(np.mean([share for _, share in swings])) if swings else 0.5
    return replace(
        gait,
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
        side, joint_name, turn = limb[1] or limb[4], limb[2] or limb[5], limb[3]
        girdle = 0 if joint_name.lower() in _FRONT else place.limbs[-1].number
        leg_place = next(
            leg for leg in place.limbs if leg.number == girdle and (leg.side > 0) == (side.lower() == "left")
        )
        hinges = leg_place.girdle.limb.hinges
        names = [hinge.name for hinge in hinges if turn is None or hinge.turn == turn.lower()]
        servo_name = f"{leg_place.name}_{names[0] if turn else names[-1]}" if names else ""
        if servo_name in place.servos:
            return place.servos.index(servo_name), 1.0
    raise UnknownName(f"joint of robot {place.robot.name!r}", joint, (*place.servos, *_spelled(place)))


def _spelled(place: Layout) -> tuple[str, ...]:
    """Return further names of columns that a robot could play, as an example of each kind."""
    axis = (f"Axis 1 to {len(place.axial_yaw)}",) if place.axial_yaw else ()
    return (*axis, *(("Left Shoulder-yaw", "Left Hip-yaw", "Left Elbow", "Left Knee") if place.limbs else ()))


def _swing(robot: Robot, gait: Gait, limb: LimbPlace) -> tuple[float, float]:
    """Return the phase at which a foot begins its swing, and the duration of the swing [cycle]."""
    clock = np.arange(_STEPS) / _STEPS
    design, place = limb.girdle.limb, layout(robot)
    targets, angles = cycle_targets(robot, gait, clock), np.zeros((_STEPS, len(design.hinges)))
    for i, hinge in enumerate(design.hinges):
        if hinge.servo is not None:
            angles[:, i] = targets[:, place.servos.index(f"{limb.name}_{hinge.name}")]
    forward_position = limb_kinematics.forward(design, angles)[:, 0]
    start, end = int(np.argmin(forward_position)), int(np.argmax(forward_position))
    return start / _STEPS, ((end - start) % _STEPS) / _STEPS


def _within_half(cycles: float) -> float:
    return (cycles + 0.5) % 1.0 - 0.5


def _rounded(value: float) -> float:
    return round(float(value), 4)

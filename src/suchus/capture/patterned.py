"""From a measured walk to a pattern that any body with four limbs and foot paths can walk."""

from dataclasses import replace
from math import degrees

import numpy as np

from suchus.capture.retarget import Captured, Duty, mean_of
from suchus.capture.slowed import within_speed
from suchus.capture.walk import Walk
from suchus.design import LEGS, Robot, check_needs, hips_ahead, layout, servo_ranges
from suchus.errors import InvalidDesign, NotConverged, OutsideLimits, Unreachable
from suchus.motion import AxialWave, FootPath, Pattern, check_limits

NEEDED = ("four_limbs", "foot_paths")
"""What the walk of a four-limbed animal requires of a robot: names of ``design.NEEDS``."""
_PAIRS = (LEGS[:2], LEGS[2:])


def to_pattern(walk: Walk, robot: Robot, base: Pattern, *, name: str, duty: Duty = "retraction") -> Captured:
    """Return the pattern by which a robot walks as was measured.

    Phases and angles are taken as they are, lengths in proportion to the trunk from hip to shoulder. The bend of the
    trunk is shared evenly among its joints, that of the tail among the tail's; the lag between the two makes the wave.
    Quantities that were not measured are the base's, and what the robot's limits forbid is changed as little as needed.

    Args:
        walk: the measured walk.
        robot: the robot that shall walk.
        base: pattern of foot paths, from which quantities that were not measured are taken.
        name: name of the new pattern.
        duty: which share of the cycle becomes its duty factor.

    Raises:
        UnsuitedRobot: the robot lacks four limbs with foot paths.
        OutsideLimits: the base has no foot paths, or the robot cannot follow even with the base's paths.
    """
    check_needs(robot, NEEDED, "a captured walk")
    check_limits(robot, base)
    if not all(isinstance(does, FootPath) for does in base.girdles):
        raise OutsideLimits(
            f"a captured walk takes what was not measured from a pattern of foot paths; gait {base.name!r} holds limbs "
            "or turns cranks: name another one with --base."
        )
    notes: list[str] = []
    share = mean_of(walk, "duty" if duty == "contact" else "retraction")
    stem = "duty" if duty == "contact" else "retraction"
    phases = tuple(_rounded((walk.value(f"phase_{leg}") + 0.05) % 1.0 - 0.05) for leg in LEGS)
    gait = replace(
        base,
        name=name,
        period=_rounded(walk.value("period")),
        duty_factor=_rounded(share),
        limb_phases=phases,
        wave=_bent(walk, robot, share, notes),
    )
    if abs(mean_of(walk, "duty") - mean_of(walk, "retraction")) > 0.05:
        notes.append(f"feet rest for {mean_of(walk, 'duty'):.2f} of the cycle; the {stem} share was taken")
    gait = _shaped(walk, robot, gait, base, notes)
    gait = _within_limits(robot, gait, base, notes)
    return Captured(gait=within_speed(robot, gait, notes), notes=(*walk.notes, *notes))


def _bent(walk: Walk, robot: Robot, duty: float, notes: list[str]) -> AxialWave:
    """Return the wave whose first harmonics at trunk and tail are the measured ones.

    A hinge at s bends the body to the left by -a cos 2 pi (p - c - phase - waves s) at phase p of the first limb, with
    c = 0.75 - duty / 2; the article's signs are right positive.
    """
    place, ranges = layout(robot), np.abs(servo_ranges(robot)).min(axis=1)
    clock = np.exp(1j * np.pi * (duty - mean_of(walk, "duty")))
    at = dict(zip(place.axial_yaw, place.axial_place, strict=True))
    parts = {"spine": [(at[i], float(ranges[i])) for i in place.trunk_yaw]}
    parts["tail"] = [(at[i], float(ranges[i])) for i in place.tail_yaw]
    parts["tail"] += [
        (where, place.cable(i).bend_limit / place.cable(i).joints)
        for i in place.cables
        for where in place.cable_places(i)
    ]
    seen = {part: clock * walk.bends[f"{part}_lateral"] for part in parts}
    bent = {part: hinges for part, hinges in parts.items() if hinges}
    notes += [
        f"robot {robot.name} has no {part} that bends; {degrees(abs(seen[part])):.0f} degrees were seen"
        for part in parts
        if part not in bent
    ]
    middle = {part: float(np.mean([where for where, _ in hinges])) for part, hinges in bent.items()}
    late = {part: _within_half(-float(np.angle(seen[part])) / (2 * np.pi) - (0.75 - duty / 2)) for part in bent}
    sign, waves = dict.fromkeys(bent, 1.0), 0.0
    if len(late) > 1:
        lag = _within_half(late["tail"] - late["spine"])
        if abs(lag) > 0.25:  # a standing wave with a node, and what is left of the lag travels
            lag, sign["tail"] = _within_half(lag + 0.5), -1.0
        waves = lag / (middle["tail"] - middle["spine"])
    knots = dict.fromkeys(at.values(), 0.0)
    for part, hinges in bent.items():
        turns = [np.exp(2j * np.pi * waves * (where - middle[part])) for where, _ in hinges]
        asked = abs(seen[part]) / max(abs(sum(turns)), 1e-9)  # joints that bend one after the other cancel a little
        knots |= {where: sign[part] * min(asked, most) for where, most in hinges}
        if asked > min(most for _, most in hinges):
            bend = degrees(abs(seen[part]))
            notes.append(f"the {part} would bend by {bend:.0f} degrees; its joints' ranges were taken")
    first = next(iter(late), "")
    phase = _within_half(late[first] - waves * middle[first]) if first else 0.0
    shape = tuple((where, _rounded(angle)) for where, angle in sorted(knots.items())) or ((0.0, 0.0),)
    return AxialWave(amplitude=shape, waves=_rounded(waves), phase=_rounded(phase))


def _shaped(walk: Walk, robot: Robot, gait: Pattern, base: Pattern, notes: list[str]) -> Pattern:
    """Scale lengths in proportion to the trunk, and take from the base what was not measured."""
    trunk = hips_ahead(robot, 0)
    paths = []
    for legs, girdle, does in zip(_PAIRS, layout(robot).robot.girdles, base.girdles, strict=True):
        if not isinstance(does, FootPath):
            continue
        reach = girdle.limb.reach
        seen = {stem: trunk * mean_of(walk, stem, legs) for stem in ("stroke", "outward", "ahead")}
        placed = replace(
            does,
            stroke=_share(seen["stroke"], reach),
            outward=_share(seen["outward"] - girdle.aside, reach),
            ahead=_share(seen["ahead"], reach),
        )
        lift = abs(_share(trunk * mean_of(walk, "lift", legs), reach)) if walk.upright else does.lift
        paths.append(replace(placed, lift=lift))
    unseen = "markers lie on the skin, so that height is" if walk.upright else "lift and height were not seen and are"
    notes.append(f"{unseen} that of {base.name}")
    return replace(gait, girdles=tuple(paths))


def _share(length: float, reach: float) -> float:
    """Return a length as a share of a limb's reach, at most 1 [-]."""
    return _rounded(float(np.clip(length / reach, -1.0, 1.0)))


def _within_limits(robot: Robot, gait: Pattern, base: Pattern, notes: list[str]) -> Pattern:
    """Change as little as needed: the base's places of the feet, then shorter strokes."""
    if _fits(robot, gait):
        return gait
    notes.append(f"the limbs of {robot.name} do not reach the feet's places: those and the lift are {base.name}'s")
    strokes = [does.stroke for does in gait.girdles if isinstance(does, FootPath)]
    shares = np.linspace(1.0, 0.1, 19)
    for share in shares:
        paths = [
            replace(does, stroke=_rounded(share * stroke))
            for does, stroke in zip(base.girdles, strokes, strict=True)
            if isinstance(does, FootPath)
        ]
        shorter = replace(gait, girdles=tuple(paths))
        if _fits(robot, shorter):
            if share < 1.0:
                notes.append(f"the measured strokes are beyond the limbs' reach; {share:.2f} of them was taken")
            return shorter
    check_limits(robot, shorter)
    return shorter


def _fits(robot: Robot, gait: Pattern) -> bool:
    try:
        check_limits(robot, gait)
    except (InvalidDesign, NotConverged, OutsideLimits, Unreachable):
        return False
    return True


def _within_half(cycles: float) -> float:
    return (cycles + 0.5) % 1.0 - 0.5


def _rounded(value: float) -> float:
    return float(f"{value:.4g}")

"""From a measured walk to a gait that a robot can walk, with a note on everything that the gait cannot keep."""

from dataclasses import dataclass, replace
from math import degrees
from typing import Literal

import numpy as np

from suchus.capture.slowed import within_speed
from suchus.capture.walk import UNSURE, Walk
from suchus.capture.wave import STANDING
from suchus.design import LEGS, Robot, crocodile_like, layout
from suchus.errors import OutsideLimits, UnsuitedRobot
from suchus.motion import Gait, Pattern, check_limits, tail_bend, trunk_bend

Duty = Literal["retraction", "contact"]
"""Share of the cycle that becomes the duty factor: feet going back along the body, or feet at rest on the ground.

A gait commands the first. On a film of our own crawl, which commands 0.5, feet go back for 0.47 of the cycle but rest
for 0.61, because the body sags onto feet that should have left the ground.
"""

_HOLDS = 0.2  # least share of a bend that the gait's law can carry in a footfall; below, its pulls cancel
_STILL = np.radians(1.0)  # a bend below this has no phase
_STEPS = 200  # of the phase, where a gait is looked at over a cycle


@dataclass(frozen=True, slots=True, kw_only=True)
class Captured:
    """A gait read from a walk."""

    gait: Gait | Pattern
    """The gait for the robot."""
    notes: tuple[str, ...]
    """Sentences on what was measured and is not in the gait, what is in it without a measurement, and what was
    changed."""


def to_gait(walk: Walk, robot: Robot, base: Gait, *, name: str, duty: Duty = "retraction") -> Captured:
    """Return the gait by which a robot walks as was measured.

    Phases and angles are taken as they are, lengths in proportion to the trunk from hip to shoulder. The bends are
    first harmonics, so that their amplitudes and phases are those of the gait's cosines. Quantities that were not
    measured are the base's. What the robot's limits refuse is changed as little as needed.

    Args:
        walk: the measured walk.
        robot: the robot that shall walk.
        base: gait from which quantities that were not measured are taken.
        name: name of the new gait.
        duty: which share of the cycle becomes its duty factor.

    Raises:
        OutsideLimits: the robot cannot follow even with the base's posture and a small stroke.
    """
    if not crocodile_like(robot):
        raise UnsuitedRobot(f"robot {robot.name!r} walks by a pattern; a captured gait of legs needs a crocodile's.")
    notes: list[str] = []
    gait = _timed(walk, replace(base, name=name), duty, notes)
    gait = _bent(walk, gait, notes)
    gait = _shaped(walk, robot, gait, base, notes)
    gait = _within_limits(robot, gait, base, notes)
    gait = within_speed(robot, gait, notes)
    return Captured(gait=gait, notes=(*walk.notes, *notes, *_unheld(walk)))


def driven_share(robot: Robot) -> float:
    """Return where along its tail, from the pitch joint, a robot's last driven plate has its middle [-].

    The end beyond it is passive: it follows by itself, and no command holds it.
    """
    cable = robot.tail.root + robot.tail.joints * robot.tail.pitch
    return (cable - robot.tail.pitch / 4) / (cable + robot.tail.fin_length)


def mean_of(walk: Walk, stem: str, legs: tuple[str, ...] = LEGS) -> float:
    """Return the mean of a number over legs, leaving out duty factors that are not sure."""
    known = [leg for leg in legs if stem != "duty" or not walk.numbers[f"duty_{leg}"].error > UNSURE]
    return float(np.mean([walk.value(f"{stem}_{leg}") for leg in known or legs]))


def _timed(walk: Walk, gait: Gait, duty: Duty, notes: list[str]) -> Gait:
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
        gait,
        period=_rounded(walk.value("period")),
        duty_factor=_rounded(share),
        limb_phases=phases,  # type: ignore[arg-type]
    )


def _bent(walk: Walk, gait: Gait, notes: list[str]) -> Gait:
    """Set the bends so that the gait's own law gives the measured first harmonics."""
    # both clocks have LF's mid-stance in common: the gait's begins half the difference of the duty factors off
    clock = np.exp(1j * np.pi * (gait.duty_factor - mean_of(walk, "duty")))
    unit = replace(gait, trunk_bend=1.0, tail_bend=1.0, spine_phase=0.0, tail_phase=0.0)
    # the gait's laws give joint angles; the measured bends have the article's signs
    spine, lag = _solve(-clock * walk.bends["spine_lateral"], _harmonic(unit, "trunk"))
    tail, tail_lag = _solve(clock * walk.bends["tail_lateral"], _harmonic(unit, "tail"))
    carried = abs(_harmonic(unit, "trunk"))
    if carried < _HOLDS:
        seen = degrees(walk.value("spine_lateral")), degrees(walk.value("tail_lateral"))
        notes.append(
            f"in this footfall the pulls of the limbs on trunk and tail cancel ({carried:.2f} is left of 1); the "
            f"bends that were measured, trunk {seen[0]:.0f} and tail {seen[1]:.0f} degrees, cannot be followed and "
            "are set to zero"
        )
        return replace(gait, trunk_bend=0.0, tail_bend=0.0, spine_phase=0.0, tail_phase=0.0)
    for part, amplitude in (("spine", walk.value("spine_lateral")), ("tail", walk.value("tail_lateral"))):
        if amplitude < _STILL:
            notes.append(f"the {part} hardly bends ({degrees(amplitude):.1f} degrees): its phase has no meaning")
    lag = lag if walk.value("spine_lateral") >= _STILL else 0.0
    tail_phase = _within_half(tail_lag - lag) if walk.value("tail_lateral") >= _STILL else 0.0
    return replace(
        gait,
        trunk_bend=_rounded(spine),
        tail_bend=_rounded(tail),
        spine_phase=_rounded(lag),
        tail_phase=_rounded(tail_phase),
    )


def _harmonic(gait: Gait, part: str) -> complex:
    """First harmonic of a gait's bend over the phase of LF [rad]."""
    phase = np.arange(_STEPS) / _STEPS
    law = trunk_bend if part == "trunk" else tail_bend
    bend = law(gait, phase[:, None] + np.array(gait.limb_phases))
    return complex(2 * np.mean(bend * np.exp(-2j * np.pi * phase)))


def _solve(seen: complex, unit: complex) -> tuple[float, float]:
    """Return the amplitude [rad] and phase lag [cycle] from the law's unit response to the measured bend."""
    return abs(seen) / max(abs(unit), 1e-9), _within_half(float(np.angle(unit / seen)) / (2 * np.pi)) if seen else 0.0


def _shaped(walk: Walk, robot: Robot, gait: Gait, base: Gait, notes: list[str]) -> Gait:
    """Scale lengths in proportion to the trunk, and take from the base what was not measured."""
    trunk = robot.spine.length + robot.thorax.shoulder
    stroke = trunk * mean_of(walk, "stroke")
    sides = (("front", LEGS[:2]), ("hind", LEGS[2:]))
    pairs = {girdle: trunk * mean_of(walk, "stroke", legs) for girdle, legs in sides}
    if abs(pairs["front"] - pairs["hind"]) > 0.1 * stroke:
        strokes = " and ".join(f"{girdle} {1000 * value:.0f} mm" for girdle, value in pairs.items())
        notes.append(f"the feet's half strokes differ, {strokes} at the robot's size; the gait holds their mean")
    if not walk.upright:
        notes.append(f"heights were not seen: lift, hip_height and tail_pitch are those of {base.name}")
    else:
        notes.append(f"markers lie on the skin, so that hip_height is that of {base.name}")
        gait = replace(
            gait,
            lift=_rounded(trunk * mean_of(walk, "lift")),
            tail_pitch=_rounded(walk.value("tail_vertical_steady")),
        )
    return replace(
        gait,
        stroke=_rounded(stroke),
        front_reach=_rounded(trunk * mean_of(walk, "outward", LEGS[:2]) - robot.front_leg.hip_offset),
        hind_reach=_rounded(trunk * mean_of(walk, "outward", LEGS[2:]) - robot.hind_leg.hip_offset),
        front_ahead=_rounded(trunk * mean_of(walk, "ahead", LEGS[:2])),
        hind_ahead=_rounded(trunk * mean_of(walk, "ahead", LEGS[2:])),
    )


def _within_limits(robot: Robot, gait: Gait, base: Gait, notes: list[str]) -> Gait:
    """Change as little as needed: bends to their limits, then the base's posture, then a shorter stroke."""
    trunk_most = len(layout(robot).trunk_yaw) * min(abs(end) for end in robot.spine.yaw_range)
    for field, asked, most in (
        ("trunk_bend", gait.trunk_bend, trunk_most),
        ("tail_bend", gait.tail_bend, robot.tail.bend_limit),
    ):
        if asked > most:
            notes.append(f"{field} would be {degrees(asked):.0f} degrees; {degrees(most):.0f}, the limit, was taken")
    gait = replace(
        gait, trunk_bend=min(gait.trunk_bend, trunk_most), tail_bend=min(gait.tail_bend, robot.tail.bend_limit)
    )
    if _fits(robot, gait):
        return gait
    notes.append(f"the legs of {robot.name} do not reach the feet's places: reaches and lift are those of {base.name}")
    gait = replace(
        gait,
        front_reach=base.front_reach,
        hind_reach=base.hind_reach,
        front_ahead=base.front_ahead,
        hind_ahead=base.hind_ahead,
        lift=base.lift,
        tail_pitch=float(np.clip(gait.tail_pitch, *robot.tail.pitch_range)),
    )
    asked = gait.stroke
    for share in np.linspace(1.0, 0.1, 19):
        shorter = replace(gait, stroke=_rounded(share * asked))
        if _fits(robot, shorter):
            if share < 1.0:
                notes.append(
                    f"a half stroke of {1000 * asked:.0f} mm is beyond the legs; {1000 * shorter.stroke:.0f} mm "
                    "was taken"
                )
            return shorter
    check_limits(robot, gait)
    return gait


def _fits(robot: Robot, gait: Gait) -> bool:
    try:
        check_limits(robot, gait)
    except OutsideLimits:
        return False
    return True


def _unheld(walk: Walk) -> list[str]:
    """Note what was measured and no gait of this kind can have."""
    notes = []
    for part in ("trunk", "tail"):
        index = walk.value(f"standing_{part}")
        if index < STANDING:
            notes.append(
                f"the {part} bends as a travelling wave (standing index {index:.2f}); a gait bends it all at once"
            )
    for part in ("spine", "tail"):
        steady, beyond = walk.value(f"{part}_lateral_steady"), walk.value(f"{part}_lateral_overtones")
        if abs(steady) > np.radians(3.0):
            side = "right" if steady > 0 else "left"
            notes.append(
                f"the {part} is bent {abs(degrees(steady)):.0f} degrees to the {side} on average; a gait is not"
            )
        if beyond > 0.2 and walk.value(f"{part}_lateral") > _STILL:
            notes.append(f"the {part}'s overtones are {100 * beyond:.0f} % of its swing; a gait swings as a cosine")
        name = f"{part}_vertical"
        if name in walk.numbers and walk.value(name) > np.radians(3.0):
            notes.append(f"the {part} swings up and down by {degrees(walk.value(name)):.0f} degrees; a gait does not")
    return notes


def _within_half(cycles: float) -> float:
    return (cycles + 0.5) % 1.0 - 0.5


def _rounded(value: float) -> float:
    return round(float(value), 4)

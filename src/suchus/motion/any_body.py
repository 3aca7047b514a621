"""The intended posture of any body in a movement over time."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.design import AnyRobot, Crank, LimbPlace, layout, servo_ranges
from suchus.errors import OutsideLimits, Unreachable
from suchus.kinematics import limb as limb_kinematics
from suchus.kinematics import tail as tail_kinematics
from suchus.motion.angle_table import AngleTable, check_table, table_limbs, table_middle, table_targets
from suchus.motion.gait import Gait
from suchus.motion.pattern import AxialWave, FootPath, Held, Pattern, Sweep
from suchus.motion.phase import limb_phase
from suchus.motion.targets import check_limits as check_gait
from suchus.motion.targets import servo_targets
from suchus.motion.timing import START

AnyGait = Gait | Pattern | AngleTable
"""A periodic movement: the article's kind of gait, one of any body, or a table of servo angles."""
_SAMPLES = 128  # of a cycle, to check it
_SPEED_SAMPLES = 200  # of a cycle, to see how fast servos turn in it


class Intended(NamedTuple):
    """Intended motion over time."""

    phase: Float[np.ndarray, "*batch limb"]
    """Phase of each limb, without wrapping [cycle]."""
    targets: Float[np.ndarray, "*batch servo"]
    """Servo angles [rad]."""


def intended(robot: AnyRobot, gait: AnyGait, time: Float[np.ndarray, "*batch"]) -> Intended:
    """Return phases and servo angles of a movement at some times; before the walk begins the phases stand still.

    Args:
        robot: the design.
        gait: the movement.
        time: since the beginning of the run [s].

    Raises:
        OutsideLimits: the gait is for other limbs, or asks for what they cannot reach.
    """
    if isinstance(gait, Gait):
        phase = limb_phase(gait, time)
        return Intended(phase, servo_targets(robot, gait, phase))
    check_limbs(robot, gait)
    clock = np.maximum(time - START, 0.0) / gait.period
    phase = clock[..., None] + np.array(gait.limb_phases)
    return Intended(phase, pattern_targets(robot, gait, clock))


def cycle_targets(
    robot: AnyRobot, gait: AnyGait, clock: Float[np.ndarray, "*batch"]
) -> Float[np.ndarray, "*batch servo"]:
    """Return the servo angles of a movement that has begun [rad].

    Args:
        robot: the design, whose limbs the movement is for.
        gait: the movement.
        clock: since it began [cycle].

    Raises:
        OutsideLimits: a foot's path is out of reach.
    """
    if isinstance(gait, Gait):
        return servo_targets(robot, gait, np.asarray(clock)[..., None] + np.array(gait.limb_phases))
    return pattern_targets(robot, gait, clock)


def shortest_period(robot: AnyRobot, gait: AnyGait) -> tuple[float, str]:
    """Return the period below which a servo would have to turn faster than it can [s], and which servo that is.

    Args:
        robot: the design, whose limbs the movement is for.
        gait: the movement; its own period is not looked at.
    """
    targets = cycle_targets(robot, gait, np.arange(_SPEED_SAMPLES + 1) / _SPEED_SAMPLES)
    turns = np.abs(np.diff(targets, axis=0)).max(axis=0) * _SPEED_SAMPLES  # [rad/cycle]
    servos = layout(robot).servos
    needed = turns / np.array([layout(robot).robot.servo(servo).speed for servo in servos])
    slowest = int(np.argmax(needed))
    return float(needed[slowest]), servos[slowest]


def hip_height(robot: AnyRobot, gait: AnyGait) -> float:
    """Return how high the root's axis is above the ground in a movement [m]."""
    if isinstance(gait, Gait):
        return gait.hip_height
    if isinstance(gait, AngleTable):
        return 0.0  # not said: it is put down as low as its feet and belly let it be
    girdles = layout(robot).robot.girdles
    return gait.height * girdles[-1].limb.reach - girdles[-1].above if girdles else 0.0


def middle_stance(robot: AnyRobot, gait: AnyGait) -> Float[np.ndarray, " servo"]:
    """Return the servo angles in which all feet stand in the middle of their path and the axis is straight [rad].

    Of a robot without limbs, or with limbs that are held, it is those with a straight axis.
    """
    middle = 1.0 - gait.duty_factor / 2
    if isinstance(gait, Gait):
        phase = np.full((1, len(gait.limb_phases)), middle)
        return np.asarray(servo_targets(robot, gait, phase, trunk=np.zeros(1), tail=np.zeros(1))[0])
    check_limbs(robot, gait)
    if isinstance(gait, AngleTable):
        return table_middle(robot, gait)
    still = replace(
        gait,
        limb_phases=(middle,) * len(gait.limb_phases),
        wave=AxialWave(amplitude=((0.0, 0.0),), waves=0.0, phase=0.0),
    )
    return np.asarray(pattern_targets(robot, still, np.zeros(1))[0])


def check_limits(robot: AnyRobot, gait: AnyGait) -> None:
    """Refuse a movement that a robot's joints cannot follow.

    Raises:
        OutsideLimits: the gait is for other limbs, or a joint would have to leave its range; the message names it.
    """
    if isinstance(gait, Gait):
        check_gait(robot, gait)
        return
    check_limbs(robot, gait)
    targets = pattern_targets(robot, gait, np.arange(_SAMPLES) / _SAMPLES)
    for name, column, (low, high) in zip(layout(robot).servos, targets.T, servo_ranges(robot), strict=True):
        worst = column[np.argmax(np.maximum(low - column, column - high))]
        if not low <= worst <= high:
            raise OutsideLimits(
                f"gait {gait.name!r} asks {name} of robot {robot.name!r} for {worst:.3f} rad; "
                f"{low:.3f} to {high:.3f} rad is allowed."
            )


def check_limbs(robot: AnyRobot, gait: Pattern | AngleTable) -> None:
    """Refuse a movement for other limbs than a robot has.

    Raises:
        OutsideLimits: another number of girdles, or limbs that cannot do what is asked of them.
        UnknownName: a table moves a servo that the robot lacks.
    """
    if isinstance(gait, AngleTable):
        check_table(robot, gait)
        return
    place = layout(robot)
    if len(gait.girdles) != len(place.robot.girdles):
        raise OutsideLimits(
            f"gait {gait.name!r} is for {len(gait.girdles)} pairs of limbs; robot {robot.name!r} has "
            f"{len(place.robot.girdles)}: choose a gait made for it."
        )
    for girdle, does in zip(place.robot.girdles, gait.girdles, strict=True):
        drives = [hinge.drive for hinge in girdle.limb.hinges]
        cranks = len(drives) == 1 and isinstance(drives[0], Crank)
        if cranks != isinstance(does, Sweep) and not isinstance(does, Held):
            raise OutsideLimits(
                f"gait {gait.name!r} wants girdle {girdle.name} of robot {robot.name!r} to follow a "
                f"{type(does).__name__}, but its limbs {'are' if cranks else 'are not'} cranks: choose a gait for it."
            )
        driven = sum(hinge.servo is not None for hinge in girdle.limb.hinges)
        if isinstance(does, Held) and len(does.angles) != driven:
            raise OutsideLimits(
                f"gait {gait.name!r} holds {len(does.angles)} angles of girdle {girdle.name}; its limbs have {driven} "
                "servos: give one for each."
            )


def pattern_targets(
    robot: AnyRobot, gait: Pattern | AngleTable, clock: Float[np.ndarray, "*batch"]
) -> Float[np.ndarray, "*batch servo"]:
    """Return the servo angles of a movement [rad].

    Args:
        robot: the design, whose limbs the movement is for.
        gait: the movement.
        clock: since it began [cycle].

    Raises:
        OutsideLimits: a foot's path is out of reach.
    """
    if isinstance(gait, AngleTable):
        return table_targets(robot, gait, clock)
    place = layout(robot)
    targets = limb_targets(robot, gait, np.asarray(clock)[..., None] + np.array(gait.limb_phases))
    first = gait.limb_phases[0] if gait.limb_phases else 0.0
    since = np.asarray(clock) + first - (0.75 - gait.duty_factor / 2)
    for i, left, at in zip(place.axial_yaw, place.axial_left, place.axial_place, strict=True):
        targets[..., i] = left * bend(gait, at, since)
    for i in place.cables:
        cable = place.cable(i)
        whole = sum((bend(gait, at, since) for at in place.cable_places(i)), np.zeros(()))
        targets[..., i] = tail_kinematics.servo_angle(cable, np.clip(-whole, -cable.bend_limit, cable.bend_limit))
    return targets


def limb_targets(
    robot: AnyRobot, gait: AnyGait, phase: Float[np.ndarray, "*batch limb"]
) -> Float[np.ndarray, "*batch servo"]:
    """Return the servo angles of limbs at phases of their own; the axis is straight [rad].

    Args:
        robot: the design, whose limbs the movement is for.
        gait: the movement.
        phase: of the limbs, not wrapped [cycle].

    Raises:
        OutsideLimits: a foot's path is out of reach.
    """
    if isinstance(gait, Gait):
        straight = np.zeros(phase.shape[:-1])
        return servo_targets(robot, gait, phase, trunk=straight, tail=straight)
    if isinstance(gait, AngleTable):
        return table_limbs(robot, gait, phase)
    place = layout(robot)
    targets = np.zeros((*phase.shape[:-1], len(place.servos)))
    for i, limb in enumerate(place.limbs):
        does = gait.girdles[limb.number]
        if isinstance(does, Held):
            targets[..., limb.servos] = does.angles
        elif isinstance(does, Sweep):
            targets[..., limb.servos] = crank(gait, does, phase[..., i], np.asarray(does.stance))[..., None]
        else:
            targets[..., limb.servos] = _on_path(robot, gait, does, limb, phase[..., i])
    return targets


def bend(gait: Pattern, place: float, since: Float[np.ndarray, "*batch"]) -> Float[np.ndarray, "*batch"]:
    """Return how far a hinge bends the body, concave on the left positive [rad].

    Args:
        gait: the movement.
        place: of the hinge along the body [-].
        since: the clock from the time at which the wave is concave on the right [cycle].
    """
    wave = gait.wave
    amplitude = np.interp(place, *_knots(gait))
    return np.asarray(wave.offset - amplitude * np.cos(2 * np.pi * (since - wave.phase - wave.waves * place)))


def path(gait: Pattern, does: FootPath, phase: Float[np.ndarray, "*batch"]) -> Float[np.ndarray, "*batch 2"]:
    """Return how far a foot is ahead of the middle of its path, and how high it is lifted [limb reach]."""
    cycle = np.mod(phase, 1.0)
    swing = 1.0 - gait.duty_factor
    s = np.clip(cycle / swing, 0.0, 1.0)
    ahead = np.where(cycle < swing, -np.cos(np.pi * s), 1.0 - 2.0 * (cycle - swing) / gait.duty_factor)
    lifted = np.where(cycle < swing, np.sin(np.pi * s) ** 2, 0.0)
    return np.stack([does.ahead + does.stroke * ahead, does.lift * lifted], axis=-1)


def _on_path(robot: AnyRobot, gait: Pattern, does: FootPath, limb: LimbPlace, phase: np.ndarray) -> np.ndarray:
    design, girdle = limb.girdle.limb, limb.girdle
    ahead, lifted = np.moveaxis(path(gait, does, phase), -1, 0) * design.reach
    down = hip_height(robot, gait) + girdle.above - design.foot.radius
    foot = np.stack([ahead, np.full_like(ahead, does.outward * design.reach), lifted - down], axis=-1)
    try:
        return limb_kinematics.inverse(design, foot, plane=does.plane)
    except Unreachable as error:
        raise OutsideLimits(
            f"gait {gait.name!r} asks {limb.name} of robot {robot.name!r} for a foot path outside its reach: {error} "
            "Lower stroke, outward or height."
        ) from error


def crank(gait: Pattern, does: Sweep, phase: np.ndarray, stance: np.ndarray) -> np.ndarray:
    """Return the angle of a crank, which grows by a whole turn a cycle: the foot goes back below and forward above.

    Args:
        gait: the movement.
        does: what its girdle does.
        phase: not wrapped [cycle].
        stance: angle that it turns through in stance [rad].
    """
    swing = 1.0 - gait.duty_factor
    turns, cycle = np.floor(phase), np.mod(phase, 1.0)
    half = stance / 2
    standing = -half + stance * (cycle - swing) / gait.duty_factor
    returning = half - 2 * np.pi + (2 * np.pi - stance) * cycle / swing
    return np.asarray(does.down - (2 * np.pi * turns + np.where(cycle < swing, returning, standing)))


def _knots(gait: Pattern) -> tuple[list[float], list[float]]:
    places, angles = zip(*gait.wave.amplitude, strict=True)
    return list(places), list(angles)

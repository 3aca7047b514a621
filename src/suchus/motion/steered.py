"""The posture at phases that each limb has for itself, with strokes, heights and a steady bend that steer it."""

import numpy as np
from jaxtyping import Float

from suchus.design import AnyRobot, layout, servo_ranges
from suchus.errors import OutsideLimits
from suchus.kinematics import limb as limb_kinematics
from suchus.kinematics import tail as tail_kinematics
from suchus.motion.any_body import AnyGait, crank, hip_height, path
from suchus.motion.gait import Gait
from suchus.motion.pattern import Held, Pattern, Sweep
from suchus.motion.phase import tail_bend, trunk_bend
from suchus.motion.targets import servo_targets

_LEAST, _MOST = 0.02, 2 * np.pi - 0.02  # [rad]; of the angle that a crank turns through in stance


def bends(
    robot: AnyRobot, gait: Gait | Pattern, phase: Float[np.ndarray, "*batch limb"]
) -> tuple[Float[np.ndarray, "*batch"], Float[np.ndarray, "*batch"]]:
    """Return how trunk (left positive) and tail (tip to the right positive) bend with limbs at these phases [rad].

    Args:
        robot: the design.
        gait: the movement.
        phase: of the limbs [cycle].
    """
    if isinstance(gait, Gait):
        return trunk_bend(gait, phase), tail_bend(gait, phase)
    place, still = layout(robot), np.zeros(phase.shape[:-1])
    waves = _Wave(gait, phase)
    at = dict(zip(place.axial_yaw, place.axial_place, strict=True))
    trunk = sum((waves.at(at[i]) for i in place.trunk_yaw), still)
    tail = sum((waves.at(at[i]) for i in place.tail_yaw), still)
    tail = tail + sum((waves.at(one) for i in place.cables for one in place.cable_places(i)), still)
    return trunk, -tail


def trunk_amplitude(robot: AnyRobot, gait: Gait | Pattern) -> float:
    """Return the most that a movement bends the trunk sideways [rad]."""
    if isinstance(gait, Gait):
        return gait.trunk_bend
    place = layout(robot)
    at = dict(zip(place.axial_yaw, place.axial_place, strict=True))
    places, angles = zip(*gait.wave.amplitude, strict=True)
    return float(sum(abs(np.interp(at[i], places, angles)) + abs(gait.wave.offset) for i in place.trunk_yaw))


def steered(
    robot: AnyRobot,
    gait: Gait | Pattern,
    phase: Float[np.ndarray, "*batch limb"],
    *,
    trunk: Float[np.ndarray, "*batch"],
    size: Float[np.ndarray, "*batch"],
    stroke: Float[np.ndarray, "*batch limb"],
    lower: Float[np.ndarray, "*batch limb"],
) -> Float[np.ndarray, "*batch servo"]:
    """Return the servo angles, feet drawn into what their limbs reach and angles into their ranges [rad].

    Args:
        robot: the design, whose limbs the movement is for.
        gait: the movement.
        phase: of the limbs, not wrapped [cycle].
        trunk: steady bend of the trunk besides that of the movement, left positive [rad].
        size: factor on bends and strokes, 0 where it stands [-].
        stroke: factor on the stroke of each limb [-].
        lower: how much lower than the movement says each foot is [m].
    """
    if isinstance(gait, Gait):
        return servo_targets(
            robot,
            gait,
            phase,
            trunk=size * trunk_bend(gait, phase) + trunk,
            tail=size * tail_bend(gait, phase),
            stroke=gait.stroke * size[..., None] * stroke,
            lower=lower,
            clip=True,
        )
    place = layout(robot)
    targets = np.zeros((*phase.shape[:-1], len(place.servos)))
    for i, limb in enumerate(place.limbs):
        does, design = gait.girdles[limb.number], limb.girdle.limb
        share = size * stroke[..., i]
        if isinstance(does, Held):
            targets[..., limb.servos] = does.angles
        elif isinstance(does, Sweep):
            stance = np.clip(share * does.stance, _LEAST, _MOST)
            targets[..., limb.servos] = crank(gait, does, phase[..., i], stance)[..., None]
        else:
            ahead, lifted = np.moveaxis(path(gait, does, phase[..., i]), -1, 0) * design.reach
            ahead = does.ahead * design.reach + share * (ahead - does.ahead * design.reach)
            down = hip_height(robot, gait) + limb.girdle.above - design.foot.radius + lower[..., i]
            foot = np.stack([ahead, np.full_like(ahead, does.outward * design.reach), lifted - down], axis=-1)
            near = limb_kinematics.within_reach(design, foot)
            targets[..., limb.servos] = limb_kinematics.inverse(design, near, plane=does.plane)
    waves = _Wave(gait, phase)
    for servo, left, at in zip(place.axial_yaw, place.axial_left, place.axial_place, strict=True):
        targets[..., servo] = left * (gait.wave.offset + size * (waves.at(at) - gait.wave.offset))
    for servo in place.trunk_yaw:
        targets[..., servo] += trunk / len(place.trunk_yaw)
    for servo in place.cables:
        cable = place.cable(servo)
        whole = size * sum((waves.at(at) for at in place.cable_places(servo)), np.zeros(phase.shape[:-1]))
        targets[..., servo] = tail_kinematics.servo_angle(cable, np.clip(-whole, -cable.bend_limit, cable.bend_limit))
    low, high = servo_ranges(robot).T
    return np.clip(targets, low, high)


def steerable(gait: AnyGait, what: str) -> Gait | Pattern:
    """Return a gait whose strokes, heights and bends can be changed while it goes.

    Args:
        gait: of any kind.
        what: needs it, as the beginning of a sentence.

    Raises:
        OutsideLimits: it is a table of angles.
    """
    if isinstance(gait, Gait | Pattern):
        return gait
    raise OutsideLimits(
        f"{what} needs a gait of foot paths and bends; gait {gait.name!r} is a table of angles: choose another gait, "
        "as 'salamander_walk', or walk it in open loop."
    )


class _Wave:
    """The wave along the axis by the limbs' phases: each limb gives a value of the clock, and their mean counts."""

    def __init__(self, gait: Pattern, phase: np.ndarray) -> None:
        self._gait = gait
        first = gait.limb_phases[0] if gait.limb_phases else 0.0
        since = np.exp(2j * np.pi * (phase - np.array(gait.limb_phases) + first - (0.75 - gait.duty_factor / 2)))
        # without limbs nothing gives the clock: what the axis does is the table's, and here it is none
        self._turn = since.mean(axis=-1) if since.shape[-1] else np.zeros(since.shape[:-1])
        self._places, self._angles = (np.array(column) for column in zip(*gait.wave.amplitude, strict=True))

    def at(self, place: float) -> np.ndarray:
        """Return how far a hinge at a place bends the body, concave on the left positive [rad]."""
        wave = self._gait.wave
        lag = np.exp(-2j * np.pi * (wave.phase + wave.waves * place))
        return np.asarray(wave.offset - np.interp(place, self._places, self._angles) * (self._turn * lag).real)

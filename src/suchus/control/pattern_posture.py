"""From oscillators to servo angles: which part of the axis each stands for, and how limbs follow theirs."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi, radians

import numpy as np
from jaxtyping import Float

from suchus.control.oscillators import AxisPart
from suchus.design import AnyRobot, Crank, Layout, hips_behind_snout, layout, servo_ranges
from suchus.errors import OutsideLimits, UnsuitedRobot
from suchus.kinematics import tail as tail_kinematics
from suchus.motion import AngleTable, AnyGait, Gait, Held, Pattern, Sweep, limb_targets, middle_stance

_FOLDED = radians(-85)  # yaw of a folded limb, backward along the body, as a swimming salamander holds them


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisSegment:
    """A yaw hinge of the axis, driven by a servo of its own or by a cable over several."""

    place: float
    """Along the body, 0 at the snout, 1 at the tip of the tail [-]."""
    servo: int
    """Index of the servo that bends it [-]."""
    left: float
    """1 where a positive angle of the servo bends to the left, -1 where to the right [-]."""
    amplitude: float
    """Amplitude of its bend in the gait [rad]."""
    part: AxisPart
    """The limbs that drive it, and its phase lag behind them."""
    steers: bool
    """Whether an offset on it turns the robot: it lies ahead of the hindmost limbs, or there are none."""


def axis_segments(robot: AnyRobot, gait: AnyGait) -> tuple[AxisSegment, ...]:
    """Return the segments of a robot's axis from head to tail.

    Each girdle drives the axis from itself to the next girdle, the first one also what is ahead of it: fore limbs the
    trunk, hind limbs the tail.

    Raises:
        UnsuitedRobot: nothing bends its axis sideways.
    """
    place, gait = layout(robot), _followed(gait)
    girdles = range(len(place.robot.girdles))
    hips = [hips_behind_snout(robot, number) / place.robot.length for number in girdles]
    found = []

    def add(at: float, servo: int, left: float) -> None:
        behind = [number for number, hip in enumerate(hips) if hip <= at]
        amplitude, lag = _wave(place, gait, at, servo)
        part = AxisPart(-1 if not hips else behind[-1] if behind else 0, lag)
        steers = not hips or at < hips[-1]
        found.append(AxisSegment(place=at, servo=servo, left=left, amplitude=amplitude, part=part, steers=steers))

    for servo, left, at in zip(place.axial_yaw, place.axial_left, place.axial_place, strict=True):
        add(at, servo, left)
    for servo in place.cables:
        for at in place.cable_places(servo):
            add(at, servo, -1.0)
    if not found:
        raise UnsuitedRobot(
            f"a pattern generator needs an axis that bends sideways; robot {robot.name!r} has no yaw hinge with a "
            "servo or a cable on its axis: let it walk in open loop."
        )
    return tuple(sorted(found, key=lambda one: one.place))


class PatternPosture:
    """How a robot's servos follow oscillators in a gait.

    Args:
        robot: the design.
        gait: whose bends and foot paths are followed.
        standing: whether silent limbs stand in the middle of their path; else they fold back along the body.
    """

    def __init__(self, robot: AnyRobot, gait: AnyGait, *, standing: bool) -> None:
        gait = _followed(gait)
        self.segments = axis_segments(robot, gait)
        self.shift = 0.25 - gait.duty_factor / 2
        """What a limb's phase is ahead of its oscillator: a left oscillator bends the body to the left [cycle]."""
        self._robot, self._gait, self._place = robot, gait, layout(robot)
        self._limb_servos = [i for limb in self._place.limbs for i in range(limb.servos.start, limb.servos.stop)]
        owner = [n for n, limb in enumerate(self._place.limbs) for _ in range(limb.servos.start, limb.servos.stop)]
        self._owner = np.array(owner, dtype=int)
        middle = middle_stance(robot, gait)
        self._rest = (middle if standing else _folded(self._place, gait, middle))[self._limb_servos]
        self._turns = np.array([_cranked(self._place, gait, limb) for limb in owner], dtype=bool)
        self._low, self._high = servo_ranges(robot).T
        self._steady = middle if isinstance(gait, Gait) else np.zeros_like(middle)
        self._offset = 0.0 if isinstance(gait, Gait) else gait.wave.offset

    def targets(
        self,
        phase: Float[np.ndarray, "run limb"],
        share: Float[np.ndarray, "run limb"],
        wave: Float[np.ndarray, "run segment"],
        offset: Float[np.ndarray, "run segment"],
    ) -> Float[np.ndarray, "run servo"]:
        """Return the servo angles, those of the axis within their ranges [rad].

        Args:
            phase: of the limbs in the gait, not wrapped [cycle].
            share: how far each limb follows its path; 0 at rest, 1 in full [-].
            wave: of each segment, 1 where it bends to the left by the gait's amplitude [-].
            offset: steady bend of each segment to the left [rad].
        """
        targets = np.tile(self._steady, (len(phase), 1))
        if self._limb_servos:
            path = limb_targets(self._robot, self._gait, phase)[:, self._limb_servos]
            follows = np.where(self._turns, 1.0, share[:, self._owner])
            targets[:, self._limb_servos] = self._rest + follows * (path - self._rest)
        amplitude = np.array([one.amplitude for one in self.segments])
        bend = amplitude * wave + self._offset + offset
        for servo in {one.servo for one in self.segments}:
            mine = [i for i, one in enumerate(self.segments) if one.servo == servo]
            whole = self.segments[mine[0]].left * bend[:, mine].sum(axis=1)
            if servo in self._place.cables:
                cable = self._place.cable(servo)
                whole = tail_kinematics.servo_angle(cable, np.clip(whole, -cable.bend_limit, cable.bend_limit))
            targets[:, servo] = np.clip(whole, self._low[servo], self._high[servo])
        return targets


def _followed(gait: AnyGait) -> Gait | Pattern:
    """Return a gait that oscillators can follow."""
    if isinstance(gait, AngleTable):
        raise OutsideLimits(
            f"gait {gait.name!r} is a table of angles, whose axis has no wave for oscillators to follow: choose a "
            "gait with bends, as 'salamander_walk'."
        )
    return gait


def _wave(place: Layout, gait: Gait | Pattern, at: float, servo: int) -> tuple[float, float]:
    """Return the amplitude [rad] and the phase lag [cycle] with which a gait bends a hinge of the axis."""
    if not isinstance(gait, Gait):
        places, angles = zip(*gait.wave.amplitude, strict=True)
        return abs(float(np.interp(at, places, angles))), gait.wave.phase
    if servo in place.trunk_yaw:
        return gait.trunk_bend / len(place.trunk_yaw), gait.spine_phase
    lag = gait.spine_phase + gait.tail_phase
    if servo in place.tail_yaw:
        return gait.tail_bend / len(place.tail_yaw), lag
    return (gait.tail_bend / place.cable(servo).joints, lag) if servo in place.cables else (0.0, 0.0)


def _folded(place: Layout, gait: Gait | Pattern, middle: np.ndarray) -> np.ndarray:
    """Return the angles with every limb straight back along the body, as far as its joints go; held limbs as held."""
    folded, ranges = middle.copy(), servo_ranges(place.robot)
    for limb in place.limbs:
        if not isinstance(gait, Gait) and isinstance(gait.girdles[limb.number], Held):
            continue
        driven = [hinge for hinge in limb.girdle.limb.hinges if hinge.servo is not None]
        yaws = [i for i, hinge in enumerate(driven) if hinge.turn == "yaw"]
        for i, hinge in enumerate(driven):
            if not isinstance(hinge.drive, Crank):
                servo = limb.servos.start + i
                folded[servo] = np.clip(_FOLDED if yaws and i == yaws[0] else 0.0, *ranges[servo])
    return folded


def _cranked(place: Layout, gait: Gait | Pattern, limb: int) -> bool:
    """Return whether a limb turns all round, so that it stops where it is."""
    return not isinstance(gait, Gait) and isinstance(gait.girdles[place.limbs[limb].number], Sweep)


def waves(
    left: Float[np.ndarray, "run segment"], right: Float[np.ndarray, "run segment"], full: Sequence[float]
) -> Float[np.ndarray, "run segment"]:
    """Return how far each segment bends to the left, from the outputs of its two sides [-].

    Args:
        left: outputs of the left oscillators [-].
        right: outputs of the right oscillators [-].
        full: of each run, the amplitude at which a gait's own bend is reached [-].
    """
    return np.asarray((left - right) / (2.0 * np.asarray(full)[:, None]))


def initial_phases(
    segments: Sequence[AxisSegment], limbs: Sequence[float], lag: float, *, driven: bool
) -> Float[np.ndarray, " oscillator"]:
    """Return phases in which nothing pulls on anything much: the axis with its limbs, or a wave along it [rad].

    Args:
        segments: of the axis.
        limbs: phases of the limbs' oscillators [cycle].
        lag: of each segment behind the one ahead of it [cycle].
        driven: whether the limbs are active.
    """
    if driven and limbs:
        sides = [[limbs[2 * one.part.girdle + side] - one.part.phase_lag for one in segments] for side in (0, 1)]
    else:
        first = limbs[0] if limbs else 0.0
        sides = [[first - lag * k + 0.5 * side for k in range(len(segments))] for side in (0, 1)]
    return 2 * pi * np.array([*sides[0], *sides[1], *limbs])

"""From oscillators to servo angles: the segments of the axis that oscillators drive, and the limbs' paths."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi, radians

import numpy as np
from jaxtyping import Float

from suchus.core.errors import UnsuitedRobot
from suchus.robot.control.oscillators import LimbCoupling
from suchus.robot.design import Crank, Layout, Robot, hips_behind_snout, layout, servo_ranges
from suchus.robot.kinematics import tail as tail_kinematics
from suchus.robot.motion import FixedLimbs, Gait, Sweep, limb_movement, middle_stance, movement

_FOLDED = radians(-85)  # yaw of a folded limb, backward along the body, as a swimming salamander holds them

_PACE = 0.5
"""Share of a servo's speed at which limbs fold and the axis is bent to steer [-]; the walk itself needs the rest."""
_PATH_SAMPLES = 32  # phases of a path at which its distance from the folded limb is taken


@dataclass(frozen=True, slots=True, kw_only=True)
class AxisSegment:
    """A yaw hinge of the axis, driven by a servo of its own or by a cable over several."""

    axial_position: float
    """Along the body, 0 at the snout, 1 at the tip of the tail [-]."""
    servo: int
    """Index of the servo that bends it [-]."""
    sign: float
    """1 where a positive angle of the servo bends to the left, -1 where to the right [-]."""
    amplitude: float
    """Amplitude of its bend in the gait [rad]."""
    offset: float
    """Steady bend of it in the gait, left positive [rad]."""
    limb_coupling: LimbCoupling
    """The limbs that drive it, and its phase lag behind them."""
    steers: bool
    """Whether an offset on it turns the robot: it lies ahead of the hindmost limbs, or there are none."""


def axis_segments(robot: Robot, gait: Gait) -> tuple[AxisSegment, ...]:
    """Return the segments of a robot's axis from head to tail.

    Each girdle drives the axis from itself to the next girdle, the first one also what is ahead of it: fore limbs the
    trunk, hind limbs the tail.

    Raises:
        UnsuitedRobot: nothing bends its axis sideways.
    """
    gait.needs_steering("a pattern generator")
    place, yaw = layout(robot), movement(robot, gait).yaw
    hips = [hips_behind_snout(robot, number) / place.robot.length for number in range(len(place.robot.girdles))]
    if not yaw.hinges.servos:
        raise UnsuitedRobot(
            f"a pattern generator needs an axis that bends sideways; robot {robot.name!r} has no yaw hinge with a "
            "servo or a cable on its axis: let it walk in open loop."
        )
    steady, amplitude = (yaw.offset / yaw.hinge_counts)[0], yaw.amplitude()[0]
    segments = []
    for k, (servo, sign, position) in enumerate(
        zip(yaw.hinges.servos, yaw.hinges.signs, yaw.hinges.axial_positions, strict=True)
    ):
        girdles_ahead = [number for number, hip in enumerate(hips) if hip <= position]
        girdle = -1 if not hips else girdles_ahead[-1] if girdles_ahead else 0
        segments.append(
            AxisSegment(
                axial_position=position,
                servo=servo,
                sign=sign,
                amplitude=float(amplitude[k]),
                offset=float(steady[k]),
                limb_coupling=LimbCoupling(girdle, _lag(gait, complex(yaw.swing[0, k]), girdle)),
                steers=not hips or position < hips[-1],
            )
        )
    return tuple(segments)


class PatternPosture:
    """How a robot's servos follow oscillators in a gait.

    Args:
        robot: the design.
        gait: gait whose bends and foot paths are followed.
        standing: whether silent limbs stand in the middle of their path; else they fold back along the body.
    """

    def __init__(self, robot: Robot, gait: Gait, *, standing: bool) -> None:
        self.segments = axis_segments(robot, gait)
        self.shift = 0.25 - gait.duty_factor / 2
        """What a limb's phase is ahead of its oscillator: a left oscillator bends the body to the left [cycle]."""
        self._limbs, self._layout = limb_movement(robot, gait), layout(robot)
        self._limb_servos = [i for limb in self._layout.limbs for i in range(limb.servos.start, limb.servos.stop)]
        owner = [n for n, limb in enumerate(self._layout.limbs) for _ in range(limb.servos.start, limb.servos.stop)]
        self._owner = np.array(owner, dtype=int)
        center = middle_stance(robot, gait)
        self._silent_angles = (center if standing else _folded(self._layout, gait, center))[self._limb_servos]
        self._turns = np.array([_cranked(self._layout, gait, limb) for limb in owner], dtype=bool)
        self._lower_bound, self._upper_bound = servo_ranges(robot).T
        self._steady = center
        self._speeds = np.array([robot.servo(servo).speed for servo in self._layout.servos])

    def fold_rate(self) -> float:
        """Return the rate at which limbs may leave their path, so that no servo turns at more than ``_PACE`` [1/s]."""
        if not self._limb_servos:
            return np.inf
        phases = np.arange(_PATH_SAMPLES)[:, None] / _PATH_SAMPLES + np.zeros(len(self._layout.limbs))
        path = self._limbs.targets(phases, np.zeros(len(phases), dtype=complex))[:, self._limb_servos]
        folds = np.where(self._turns, 0.0, np.abs(path - self._silent_angles).max(axis=0))
        return _PACE / max(float((folds / self._speeds[self._limb_servos]).max()), 1e-9)

    def bend_rate(self) -> float:
        """Return the rate at which a steady bend may change, so that no servo turns at more than ``_PACE`` [rad/s]."""
        return _PACE * min(float(self._speeds[segment.servo]) for segment in self.segments)

    def targets(
        self,
        phase: Float[np.ndarray, "run limb"],
        fraction: Float[np.ndarray, "run limb"],
        wave: Float[np.ndarray, "run segment"],
        offset: Float[np.ndarray, "run segment"],
    ) -> Float[np.ndarray, "run servo"]:
        """Return the servo angles, those of the axis within their ranges [rad].

        Args:
            phase: phase of the limbs in the gait, not wrapped [cycle].
            fraction: how far each limb follows its path; 0 at rest, 1 in full [-].
            wave: of each segment, 1 where it bends to the left by the gait's amplitude [-].
            offset: steady bend of each segment to the left [rad].
        """
        targets = np.tile(self._steady, (len(phase), 1))
        if self._limb_servos:
            path = self._limbs.targets(phase, np.zeros(len(phase), dtype=complex))[:, self._limb_servos]
            follows = np.where(self._turns, 1.0, fraction[:, self._owner])
            targets[:, self._limb_servos] = self._silent_angles + follows * (path - self._silent_angles)
        amplitude, steady = np.array([(segment.amplitude, segment.offset) for segment in self.segments]).T
        bend = amplitude * wave + steady + offset
        for servo in {segment.servo for segment in self.segments}:
            segment_indices = [i for i, segment in enumerate(self.segments) if segment.servo == servo]
            angle = self.segments[segment_indices[0]].sign * bend[:, segment_indices].sum(axis=1)
            if servo in self._layout.cables:
                cable = self._layout.cable(servo)
                angle = tail_kinematics.servo_angle(cable, np.clip(angle, -cable.bend_limit, cable.bend_limit))
            targets[:, servo] = np.clip(angle, self._lower_bound[servo], self._upper_bound[servo])
        return targets


def _lag(gait: Gait, swing: complex, girdle: int) -> float:
    """Return the phase lag of a hinge behind the limbs of a girdle, -1/2 to 1/2; 0 where nothing drives it [cycle].

    Args:
        gait: gait whose limb phases count.
        swing: complex amplitude of the hinge's bend [rad].
        girdle: number of the girdle that drives the hinge; -1 for none.
    """
    if girdle < 0 or not swing:
        return 0.0
    pulls = gait.coupling or tuple(phase - gait.limb_phases[0] for phase in gait.limb_phases)
    # a hinge bends by -amplitude cos(phase - lag); limbs that pull later see it bend earlier
    lag = -float(np.angle(-swing)) / (2 * pi) + pulls[2 * girdle]
    return lag - round(lag)


def _folded(place: Layout, gait: Gait, center: np.ndarray) -> np.ndarray:
    """Return the servo angles with every limb straight back along the body, within its ranges; held limbs stay held.

    Args:
        place: layout of the robot.
        gait: gait that says which limbs are held.
        center: servo angles in the middle of the stance, shape (servo,) [rad].
    """
    folded, ranges = center.copy(), servo_ranges(place.robot)
    for limb in place.limbs:
        if isinstance(gait.limbs[limb.number], FixedLimbs):
            continue
        driven_hinges = [hinge for hinge in limb.girdle.limb.hinges if hinge.servo is not None]
        yaws = [i for i, hinge in enumerate(driven_hinges) if hinge.turn == "yaw"]
        for i, hinge in enumerate(driven_hinges):
            if not isinstance(hinge.drive, Crank):
                servo = limb.servos.start + i
                folded[servo] = np.clip(_FOLDED if yaws and i == yaws[0] else 0.0, *ranges[servo])
    return folded


def _cranked(place: Layout, gait: Gait, limb: int) -> bool:
    """Return whether a limb is a crank; a silent crank stops at its present angle."""
    return isinstance(gait.limbs[place.limbs[limb].number], Sweep)


def waves(
    left_output: Float[np.ndarray, "run segment"], right_output: Float[np.ndarray, "run segment"], full: Sequence[float]
) -> Float[np.ndarray, "run segment"]:
    """Return how far each segment bends to the left, from the outputs of its two sides [-].

    Args:
        left_output: outputs of the left oscillators [-].
        right_output: outputs of the right oscillators [-].
        full: of each run, the amplitude at which a gait's own bend is reached [-].
    """
    return np.asarray((left_output - right_output) / (2.0 * np.asarray(full)[:, None]))


def initial_phases(
    segments: Sequence[AxisSegment], limbs: Sequence[float], lag: float, *, has_active_limbs: bool
) -> Float[np.ndarray, " oscillator"]:
    """Return first phases near equilibrium: the axis in phase with its limbs, or a wave along the axis [rad].

    Args:
        segments: segments of the axis.
        limbs: phases of the limbs' oscillators [cycle].
        lag: phase lag of each segment behind the one ahead of it [cycle].
        has_active_limbs: whether the limbs are active.
    """
    if has_active_limbs and limbs:
        sides = [
            [limbs[2 * segment.limb_coupling.girdle + side] - segment.limb_coupling.phase_lag for segment in segments]
            for side in (0, 1)
        ]
    else:
        first_phase = limbs[0] if limbs else 0.0
        sides = [[first_phase - lag * k + 0.5 * side for k in range(len(segments))] for side in (0, 1)]
    return 2 * pi * np.array([*sides[0], *sides[1], *limbs])

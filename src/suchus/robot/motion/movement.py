"""From phase to posture: what every servo of a robot does in a gait, for many runs at once.

``Movement`` works gaits of one structure out for one robot, so that their numbers are arrays over runs: that is done
once, and then asked at every control period. Open loop, feedback, limits and swims all read it.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Complex, Float

from suchus.article.paper import CRAWL_START
from suchus.robot.design import Layout, Robot, layout, servo_ranges
from suchus.robot.design.skeleton import skeleton
from suchus.robot.kinematics import limb as limb_kinematics
from suchus.robot.kinematics import tail as tail_kinematics
from suchus.robot.motion.axis import Waves, pitch_hinges, yaw_hinges
from suchus.robot.motion.gait import Gait
from suchus.robot.motion.limbs import LimbMotion, Steer, bounded, check_limbs, in_steps, is_number, limb_groups, quarter
from suchus.robot.motion.parts import AxisRegion, FootPath

START = CRAWL_START
"""A robot stands still until then, so that it has settled on the ground [s]."""


_BEND_TOLERANCE = 1e-9  # [rad]; smaller swings count as none


class SwingRatio(NamedTuple):
    """How far one part of each run swings for the swing of another."""

    values: Complex[np.ndarray, " run"]
    """Swing of the one over that of the other [-]; NaN where the other does not swing."""
    are_finite: bool
    """Whether the other swings in every run."""


class Intended(NamedTuple):
    """Intended motion over time."""

    phase: Float[np.ndarray, "*batch limb"]
    """Phase of each limb, without wrapping [cycle]."""
    targets: Float[np.ndarray, "*batch servo"]
    """Servo angles [rad]."""


class Movement:
    """Gaits of one structure worked out for one robot: every number is an array over runs.

    Args:
        robot: the design.
        gaits: gaits of each run; ``structure`` must be the same for all.

    Raises:
        OutsideLimits: a gait is for other limbs.
        UnknownName: a curve is for a servo that the robot lacks.
    """

    def __init__(self, robot: Robot, gaits: Sequence[Gait]) -> None:
        for gait in gaits:
            check_limbs(robot, gait)
        self.robot, self.gaits, self.layout = robot, tuple(gaits), layout(robot)
        self.yaw, self.pitch = Waves(yaw_hinges(robot), "yaw", gaits), Waves(pitch_hinges(robot), "pitch", gaits)
        self._duty = np.array([gait.duty_factor for gait in gaits])
        self._phases = np.array([gait.limb_phases for gait in gaits], dtype=float)
        self._touch_down = 0.75 - self._duty / 2  # a quarter of a cycle before mid-stance
        self._limb_touch_down = self._touch_down[:, None]
        self._signs, self._phase_remainder = _references(gaits)
        servos, cables = self.yaw.hinges.servos, self.layout.cables
        self._direct = np.array([k for k, servo in enumerate(servos) if servo not in cables], dtype=int)
        self._direct_servos = in_steps([servos[k] for k in self._direct])
        self._direct_signs = np.array(self.yaw.hinges.signs)[self._direct]
        self._direct_counts = self.yaw.hinge_counts[:, self._direct]
        self._direct_hinges = in_steps(self._direct.tolist())
        self._trunk_yaw = in_steps(self.layout.trunk_yaw)
        self._cables = [
            (servo, self.layout.cable(servo), tuple(k for k, hinge_servo in enumerate(servos) if hinge_servo == servo))
            for servo in cables
        ]
        self._limbs = [LimbMotion(robot, gaits, limb_indices) for limb_indices in limb_groups(self.layout, gaits[0])]
        self._curves = [_Measured(self.layout, gaits, i) for i in range(len(gaits[0].curves))]
        self._lower_bound, self._upper_bound = servo_ranges(robot).T
        self._hinges_of: dict[AxisRegion, tuple[int, ...]] = {}

    def axis_phase(self, limbs: Float[np.ndarray, "*batch limb"]) -> Complex[np.ndarray, "*batch"]:
        """Return the order parameter of the limbs, which the axis follows: their mean on the unit circle [-].

        Its angle is the phase of the axis; it is 1 in size where all limbs agree and 0 where their pulls cancel.

        Args:
            limbs: phases of the limbs [cycle].
        """
        angle = 2 * np.pi * (limbs - self._limb_touch_down - self._phase_remainder)
        pulls = np.empty((2, *angle.shape))
        np.cos(angle, out=pulls[0])
        np.sin(angle, out=pulls[1])
        forward, sideways = self._mean(pulls)
        return np.asarray(forward + 1j * sideways)

    def _mean(self, pulls: np.ndarray) -> np.ndarray:
        """Return the signed mean over the limbs, summed in a fixed order so that the batch size changes no bit."""
        terms = pulls * self._signs
        count = len(self._signs)
        while count > 1:
            half = (count + 1) // 2
            terms[..., : count - half] += terms[..., half:count]
            count = half
        return np.asarray(terms[..., 0] / len(self._signs))

    def axis_of_clock(self, clock: Float[np.ndarray, "*batch"]) -> Complex[np.ndarray, "*batch"]:
        """Return the order parameter that the axis follows at times since the beginning [cycle]."""
        if len(self._signs):
            return self.axis_phase(np.asarray(clock)[..., None] + self._phases)
        return np.asarray(np.exp(2j * np.pi * (np.asarray(clock) - self._touch_down)))

    def targets(
        self,
        limbs: Float[np.ndarray, "*batch limb"],
        axis: Complex[np.ndarray, "*batch"],
        steer: Steer | None = None,
        *,
        draw: bool = False,
    ) -> Float[np.ndarray, "*batch servo"]:
        """Return the servo angles [rad].

        Args:
            limbs: phases of the limbs, not wrapped; the last axis of the batch is that of the runs, or stands for the
                only one [cycle].
            axis: what the axis follows, as ``axis_phase`` returns it [-].
            steer: what is asked besides; then feet are drawn into what limbs reach, and angles into their ranges.
            draw: draw feet into what limbs reach, whether anything is steered or not.

        Raises:
            OutsideLimits: a foot's path is out of reach, and it is not drawn into it.
        """
        batch = np.shape(axis)
        if batch != limbs.shape[:-1]:
            batch = np.broadcast_shapes(limbs.shape[:-1], batch)
        targets = np.zeros((*batch, len(self.layout.servos)))
        for group in self._limbs:
            for i, of_limb in zip(
                group.limb_indices, group.angles(limbs, steer, draw=draw or steer is not None), strict=False
            ):
                limb = self.layout.limbs[i]
                targets[..., limb.servos] = of_limb[..., limb.driven_hinges]
        self._bend(targets, axis, steer)
        self._curve(targets, limbs, axis)
        return bounded(targets, self._lower_bound, self._upper_bound) if steer is not None else targets

    def harmonics(self) -> Complex[np.ndarray, "run hinge"]:
        """Return h of the hinges that bend sideways, whose angles are a mean plus ``Re(h exp(2 pi i clock))`` [rad].

        Positive is concave to the left; measured curves are left aside.
        """
        start = self.axis_of_clock(np.zeros(len(self.gaits)))
        return np.asarray(self.yaw.swing * start[:, None] / self.yaw.hinge_counts)

    def bend_of(self, region: AxisRegion, axis: Complex[np.ndarray, "*batch"]) -> Float[np.ndarray, "*batch"]:
        """Return how far a part bends sideways, left positive, measured curves aside [rad]."""
        if region not in self._hinges_of:
            self._hinges_of[region] = tuple(self.yaw.hinges.indices_in(region))
        return self.yaw.total_bend(self._hinges_of[region], self.yaw.bends(axis))

    def out_of_reach(self, limbs: Float[np.ndarray, "*batch limb"]) -> Float[np.ndarray, "*batch limb"]:
        """Return how far each foot's place lies outside what its limb reaches; 0 without a foot path [m]."""
        reach_error = np.zeros(np.broadcast_shapes(limbs.shape, (1, len(self.layout.limbs))))
        for group in self._limbs:
            if group.has_paths:
                for i, distance in zip(group.limb_indices, np.linalg.norm(group.feet(limbs), axis=0), strict=True):
                    min_reach, max_reach = limb_kinematics.reach(self.layout.limbs[i].girdle.limb)
                    reach_error[..., i] = np.maximum(np.maximum(min_reach - distance, distance - max_reach), 0.0)
        return reach_error

    def foot_positions(self, limbs: Float[np.ndarray, "*batch limb"]) -> Float[np.ndarray, "*batch limb 3"]:
        """Return the intended foot centres, each in the D-H base frame of its limb (outward, forward, down) [m].

        Args:
            limbs: phases of the limbs [cycle].

        Raises:
            OutsideLimits: a gait has limbs without a foot path.
        """
        places: dict[int, np.ndarray] = {}
        for group in self._limbs:
            forward, outward, down = group.feet(limbs)
            for k, i in enumerate(group.limb_indices):
                aside = self.layout.limbs[i].girdle.aside + outward[k]
                places[i] = np.stack([aside, forward[k], down[k]], axis=-1)
        return np.stack([places[i] for i in range(len(places))], axis=-2)

    def _bend(self, targets: np.ndarray, axis: np.ndarray, steer: Steer | None) -> None:
        """Write the servo angles of the axis that its bends ask for.

        Args:
            targets: servo angles, written to [rad].
            axis: what the axis follows, as ``axis_phase`` returns it [-].
            steer: what is asked besides.
        """
        size = None if steer is None or is_number(steer.size, 1.0) else steer.size
        tail = 0.0 if steer is None else steer.tail
        bends_tail = not is_number(tail, 0.0) and bool(np.any(tail))
        if self.yaw.moves or bends_tail:
            bends = self.yaw.bends(axis, size)
            if bends_tail:
                bends = bends + self._of_tail(tail)
            servo_angles = self._direct_signs * bends[..., self._direct_hinges] / self._direct_counts
            targets[..., self._direct_servos] = servo_angles
            for servo, cable, hinge_indices in self._cables:
                total_bend = self.yaw.hinges.signs[hinge_indices[0]] * self.yaw.total_bend(hinge_indices, bends)
                if steer is not None:
                    total_bend = bounded(total_bend, -cable.bend_limit, cable.bend_limit)
                targets[..., servo] = tail_kinematics.servo_angle(cable, total_bend)
        if self.pitch.moves:
            targets[..., list(self.pitch.hinges.servos)] = self.pitch.bends(axis, size) / self.pitch.hinge_counts
        if steer is not None and self.layout.trunk_yaw and not is_number(steer.bend, 0.0):
            targets[..., self._trunk_yaw] += (np.asarray(steer.bend) / len(self.layout.trunk_yaw))[..., None]

    def _of_tail(self, bend: np.ndarray | float) -> np.ndarray:
        """Return what a steady bend of the tail adds to ``Waves.bends`` at all hinges [rad]."""
        tail_hinges = self.yaw.hinges.indices_in("tail")
        weights = np.zeros(len(self.yaw.hinges.servos))
        weights[tail_hinges] = 1.0 / max(len(tail_hinges), 1)
        return np.asarray(np.asarray(bend)[..., None] * weights * self.yaw.hinge_counts)

    def _curve(self, targets: np.ndarray, limbs: np.ndarray, axis: np.ndarray) -> None:
        """Write the servo angles of the measured curves.

        Args:
            targets: servo angles, written to [rad].
            limbs: phases of the limbs [cycle].
            axis: what the axis follows, as ``axis_phase`` returns it [-].
        """
        if not self._curves:
            return
        first_phase = self._phases[:, 0] if self._phases.shape[1] else 0.0
        axis_clock = np.angle(axis) / (2 * np.pi) + self._touch_down - first_phase
        for curve in self._curves:
            clock = axis_clock if curve.limb is None else limbs[..., curve.limb] - self._phases[:, curve.limb]
            turns = np.exp(2j * np.pi * np.asarray(clock)[..., None] * np.arange(curve.harmonics.shape[1]))
            targets[..., curve.servo] = (turns * curve.harmonics).sum(axis=-1).real


def trunk_amplitude(robot: Robot, gait: Gait) -> float:
    """Return the most that a gait bends the trunk sideways [rad]."""
    yaw = movement(robot, gait).yaw
    trunk_hinges = yaw.hinges.indices_in("trunk")
    steady = np.abs(yaw.offset / yaw.hinge_counts)
    return float((yaw.amplitude() + steady)[0, trunk_hinges].sum())


class Batch:
    """The gaits of a batch, grouped by skeleton and structure; each group is computed in one call.

    Robots that are built of one design have one skeleton, so that a batch of them is one kind.

    Args:
        robots: the design of each run; all have the same layout.
        gaits: the gait of each run.
    """

    def __init__(self, robots: Sequence[Robot], gaits: Sequence[Gait]) -> None:
        """Work out each group of runs with one skeleton and one structure of gait.

        Args:
            robots: the design of each run.
            gaits: the gait of each run.
        """
        members: dict[Any, list[int]] = {}
        for run, (robot, gait) in enumerate(zip(robots, gaits, strict=True)):
            members.setdefault((skeleton(robot), structure(gait)), []).append(run)
        self.groups = [
            (Movement(robots[runs[0]], [gaits[run] for run in runs]), np.array(runs)) for runs in members.values()
        ]
        self.phases = np.array([gait.limb_phases for gait in gaits], dtype=float).reshape(len(gaits), -1)
        self.periods = np.array([gait.period for gait in gaits])
        self._servos = len(layout(robots[0]).servos)
        self._only = self.groups[0][0] if len(self.groups) == 1 else None  # most batches: nothing to sort
        self._swings: dict[AxisRegion, tuple[np.ndarray, np.ndarray]] = {}
        self._swing_ratios: dict[tuple[AxisRegion, AxisRegion], SwingRatio] = {}

    def axis_phase(self, limbs: Float[np.ndarray, "run limb"], clock: Float[np.ndarray, " run"]) -> np.ndarray:
        """Return the order parameter of each run's axis: of its limbs, or of its clock without limbs [-]."""
        if self._only is not None:
            return self._only.axis_phase(limbs) if limbs.shape[1] else self._only.axis_of_clock(clock)
        z = np.zeros(len(limbs), dtype=complex)
        for movement, runs in self.groups:
            z[runs] = movement.axis_phase(limbs[runs]) if limbs.shape[1] else movement.axis_of_clock(clock[runs])
        return z

    def targets(
        self, limbs: Float[np.ndarray, "run limb"], axis: Complex[np.ndarray, " run"], steer: Steer | None = None
    ) -> Float[np.ndarray, "run servo"]:
        """Return the servo angles of every run; see ``Movement.targets`` [rad].

        Args:
            limbs: phases of the limbs [cycle].
            axis: what the axis follows [-].
            steer: what is asked besides.
        """
        if self._only is not None:
            return self._only.targets(limbs, axis, steer)
        targets = np.zeros((len(limbs), self._servos))
        for movement, runs in self.groups:
            run_steer = None if steer is None else Steer(*(_of_runs(field, runs) for field in steer))
            targets[runs] = movement.targets(limbs[runs], axis[runs], run_steer)
        return targets

    def bend_of(self, region: AxisRegion, axis: Complex[np.ndarray, " run"]) -> Float[np.ndarray, " run"]:
        """Return how far a part of each run bends sideways, left positive [rad]."""
        if self._only is not None:
            return self._only.bend_of(region, axis)
        bend = np.zeros(len(axis))
        for movement, runs in self.groups:
            bend[runs] = movement.bend_of(region, axis[runs])
        return bend

    def swing_and_offset(self, region: AxisRegion) -> tuple[Complex[np.ndarray, " run"], Float[np.ndarray, " run"]]:
        """Return swing and steady bend of a part of each run: its bend is ``steady + Re(swing z)`` [rad]."""
        if region not in self._swings:
            swing, steady = np.zeros(len(self.periods), dtype=complex), np.zeros(len(self.periods))
            for movement, runs in self.groups:
                yaw = movement.yaw
                swing[runs], steady[runs] = yaw.swing_and_offset(yaw.hinges.indices_in(region))
            swing.flags.writeable = steady.flags.writeable = False
            self._swings[region] = swing, steady
        return self._swings[region]

    def swing_ratio(self, region: AxisRegion, over: AxisRegion) -> SwingRatio:
        """Return the swing of one part of each run over that of another."""
        if (region, over) not in self._swing_ratios:
            (swing, _), (other, _) = self.swing_and_offset(region), self.swing_and_offset(over)
            swings, values = np.abs(other) > _BEND_TOLERANCE, np.full(len(self.periods), np.nan, dtype=complex)
            values[swings] = swing[swings] / other[swings]
            values.flags.writeable = False
            self._swing_ratios[region, over] = SwingRatio(values, bool(swings.all()))
        return self._swing_ratios[region, over]


def structure(gait: Gait) -> Any:
    """Return a key that is equal for gaits that differ in plain numbers only."""
    limbs = tuple((type(limb), quarter(limb.swivel) if isinstance(limb, FootPath) else 0) for limb in gait.limbs)
    signs = tuple(_references([gait])[0])
    return limbs, signs, tuple((curve.servo, len(curve.angles)) for curve in gait.curves)


@lru_cache(maxsize=256)
def movement(robot: Robot, gait: Gait) -> Movement:
    """Return the movement of one gait on a robot; cached."""
    return Movement(robot, [gait])


def intended(
    robot: Robot, gait: Gait, time: Float[np.ndarray, "*batch"], *, begin: float = START, ramp: float = 0.0
) -> Intended:
    """Return phases and servo angles of a gait at some times; before it begins the phases stand still.

    Args:
        robot: the design.
        gait: the gait.
        time: time since the beginning of the run [s].
        begin: time at which the gait begins [s].
        ramp: duration from then on over which strokes and bends grow from zero, as 3 x^2 - 2 x^3 [s].

    Raises:
        OutsideLimits: the gait is for other limbs, or asks for what they cannot reach.
    """
    since = np.asarray(np.maximum(np.asarray(time, dtype=float) - begin, 0.0))
    growth = np.minimum(since / ramp, 1.0) if ramp > 0.0 else None
    size = None if growth is None else np.asarray(growth**2 * (3.0 - 2.0 * growth))
    clock = np.asarray(since / gait.period)
    return Intended(clock[..., None] + np.array(gait.limb_phases), cycle_targets(robot, gait, clock, size))


def cycle_targets(
    robot: Robot, gait: Gait, clock: Float[np.ndarray, "*batch"], size: Float[np.ndarray, "*batch"] | None = None
) -> Float[np.ndarray, "*batch servo"]:
    """Return the servo angles of a gait that has begun [rad].

    Args:
        robot: the design.
        gait: the gait.
        clock: since it began [cycle].
        size: factor on strokes and bends [-]; None for 1.

    Raises:
        OutsideLimits: the gait is for other limbs, or asks for what they cannot reach.
    """
    gait_movement, clock = movement(robot, gait), np.asarray(clock, dtype=float)
    clocks = np.atleast_1d(clock)
    steer = None if size is None else Steer(size=np.atleast_1d(size))
    targets = gait_movement.targets(
        clocks[..., None] + np.array(gait.limb_phases), gait_movement.axis_of_clock(clocks), steer
    )
    return targets.reshape(*clock.shape, -1)


def limb_targets(
    robot: Robot, gait: Gait, phase: Float[np.ndarray, "*batch limb"]
) -> Float[np.ndarray, "*batch servo"]:
    """Return the servo angles of limbs at phases of their own; the axis is not bent sideways [rad].

    Args:
        robot: the design.
        gait: the gait.
        phase: phase of the limbs, not wrapped [cycle].

    Raises:
        OutsideLimits: the gait is for other limbs, or asks for what they cannot reach.
    """
    phases = np.atleast_2d(phase)
    targets = limb_movement(robot, gait).targets(phases, np.zeros(phases.shape[:-1], dtype=complex))
    return targets.reshape(*np.shape(phase)[:-1], -1)


@lru_cache(maxsize=256)
def limb_movement(robot: Robot, gait: Gait) -> Movement:
    """Return a gait's limbs alone, worked out for a robot: its axis is not bent sideways, and not waved up and down."""
    straight_gait = gait.straightened()
    return Movement(
        robot, [replace(straight_gait, axis=tuple(bend for bend in straight_gait.axis if bend.turn == "pitch"))]
    )


def middle_stance(robot: Robot, gait: Gait) -> Float[np.ndarray, " servo"]:
    """Return the servo angles in which all feet stand in the middle of their path and the axis is straight [rad].

    Of a robot without limbs, or with limbs that are held, it is those with a straight axis.
    """
    return limb_targets(robot, gait, np.full(len(gait.limb_phases), 1.0 - gait.duty_factor / 2))


def _references(gaits: Sequence[Gait]) -> tuple[np.ndarray, np.ndarray]:
    """Return the sign with which each limb pulls on the axis [-], and the remaining phase of its pull [cycle].

    Args:
        gaits: gait of each run.
    """
    pulls = [gait.coupling or tuple(phase - gait.limb_phases[0] for phase in gait.limb_phases) for gait in gaits]
    reference = np.array(pulls, dtype=float)
    half = np.round(2.0 * reference)
    return (1.0 - 2.0 * np.mod(half, 2.0))[0], reference - half / 2.0


class _Measured:
    """The curves of one servo, over runs."""

    def __init__(self, place: Layout, gaits: Sequence[Gait], number: int) -> None:
        self.servo = place.servos.index(gaits[0].curves[number].servo)
        moved_limbs = [i for i, limb in enumerate(place.limbs) if limb.servos.start <= self.servo < limb.servos.stop]
        self.limb = moved_limbs[0] if moved_limbs else None  # whose phase it follows; None: that of the axis
        self.harmonics = np.array([gait.curves[number].harmonics for gait in gaits])


def _of_runs(field: np.ndarray | float, runs: np.ndarray) -> np.ndarray:
    """Return a field of a ``Steer`` for some runs."""
    return np.asarray(field)[runs] if np.ndim(field) else np.asarray(field)

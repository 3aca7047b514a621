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

from suchus.design import Crank, Layout, Robot, layout, servo_ranges
from suchus.errors import OutsideLimits, UnknownName, Unreachable
from suchus.kinematics import leg as leg_kinematics
from suchus.kinematics import limb as limb_kinematics
from suchus.kinematics import tail as tail_kinematics
from suchus.kinematics.limb import PlainLeg
from suchus.motion.axis import Waves, pitch_hinges, yaw_hinges
from suchus.motion.gait import FootPath, Gait, Held, Limbs, Part, Sweep
from suchus.paper import CRAWL_START

START = CRAWL_START
"""A robot stands still until then, so that it has settled on the ground [s]."""
_PICOMETRE = 12  # digits of a metre to which lengths of a gait are rounded: a share of a reach of 0.175 m gives 0.027 m
_INSIDE = 1e-6  # how far inside its reach a foot that is drawn into it stays: [m] for a leg, [reach] for other limbs
_LEAST, _MOST = 0.02, 2 * np.pi - 0.02  # [rad]; of the angle that a crank turns through in stance
_SIDEWAYS = 2 / np.pi  # quarter turns of swivel a radian


class Steer(NamedTuple):
    """What is asked of a gait besides; every field broadcasts over runs, and limbs where it has them."""

    size: Float[np.ndarray, "*batch"] | float = 1.0
    """Factor on strokes and bends, 0 where a robot stands [-]."""
    stroke: Float[np.ndarray, "*batch limb"] | float = 1.0
    """Factor on the stroke of each limb [-]."""
    lower: Float[np.ndarray, "*batch limb"] | float = 0.0
    """How much lower than the gait says each foot is [m]."""
    bend: Float[np.ndarray, "*batch"] | float = 0.0
    """Steady bend of the trunk besides that of the gait, left positive [rad]."""
    tail: Float[np.ndarray, "*batch"] | float = 0.0
    """Steady lateral bend of the tail besides that of the gait, left positive [rad]."""


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
        gaits: of each run; ``structure`` must be the same for all.

    Raises:
        OutsideLimits: a gait is for other limbs.
        UnknownName: a curve is for a servo that the robot lacks.
    """

    def __init__(self, robot: Robot, gaits: Sequence[Gait]) -> None:
        for gait in gaits:
            check_limbs(robot, gait)
        self.robot, self.gaits, self.place = robot, tuple(gaits), layout(robot)
        self.yaw, self.pitch = Waves(yaw_hinges(robot), "yaw", gaits), Waves(pitch_hinges(robot), "pitch", gaits)
        self._duty = np.array([gait.duty_factor for gait in gaits])
        self._phases = np.array([gait.limb_phases for gait in gaits], dtype=float)
        self._touch_down = 0.75 - self._duty / 2  # a quarter of a cycle before mid-stance
        self._signs, self._behind = _references(gaits)
        servos, cables = self.yaw.hinges.servos, self.place.cables
        self._direct = [k for k, servo in enumerate(servos) if servo not in cables]
        self._girdles = _girdles(self.place)
        self._paths = [_path_numbers(robot, gaits, self.place.limbs[limbs[0]].number) for limbs in self._girdles]
        self._curves = [_Measured(self.place, gaits, i) for i in range(len(gaits[0].curves))]
        self._low, self._high = servo_ranges(robot).T

    def axis_phase(self, limbs: Float[np.ndarray, "*batch limb"]) -> Complex[np.ndarray, "*batch"]:
        """Return the order parameter of the limbs, which the axis follows: their mean on the unit circle [-].

        Its angle is the phase of the axis; it is 1 in size where all limbs agree and 0 where their pulls cancel.

        Args:
            limbs: phases of the limbs [cycle].
        """
        angle = 2 * np.pi * (limbs - self._touch_down[:, None] - self._behind)
        return np.asarray(self._mean(np.cos(angle)) + 1j * self._mean(np.sin(angle)))

    def _mean(self, pulls: np.ndarray) -> np.ndarray:
        """Return the mean over the limbs with their signs, summed in one order so that no batch changes a bit."""
        terms = [pulls[..., i] * sign for i, sign in enumerate(self._signs)]
        while len(terms) > 1:
            half = (len(terms) + 1) // 2
            terms = [sum(terms[i + half : i + half + 1], terms[i]) for i in range(half)]
        return np.asarray(terms[0] / len(self._signs))

    def axis_of_clock(self, clock: Float[np.ndarray, "*batch"]) -> Complex[np.ndarray, "*batch"]:
        """Return what the axis follows at times since the beginning [cycle], without asking the limbs."""
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
        targets = np.zeros((*np.broadcast_shapes(np.shape(limbs)[:-1], np.shape(axis)), len(self.place.servos)))
        for among, numbers in zip(self._girdles, self._paths, strict=True):
            if numbers is not None:
                phase = _limbs_first(limbs, among)
                angles = self._limbs(among, numbers, phase, steer, draw=draw or steer is not None)
                for i, of_limb in zip(among, angles, strict=True):
                    targets[..., self.place.limbs[i].servos] = of_limb
        self._bend(targets, axis, steer)
        self._curve(targets, limbs, axis)
        return np.clip(targets, self._low, self._high) if steer is not None else targets

    def harmonics(self) -> Complex[np.ndarray, "run hinge"]:
        """Return h of the hinges that bend sideways, whose angles are a mean plus ``Re(h exp(2 pi i clock))`` [rad].

        Positive is concave to the left; measured curves are left aside.
        """
        start = self.axis_of_clock(np.zeros(len(self.gaits)))
        return np.asarray(self.yaw.swing * start[:, None] / self.yaw.share)

    def bend_of(self, part: Part, axis: Complex[np.ndarray, "*batch"]) -> Float[np.ndarray, "*batch"]:
        """Return how far a part bends sideways, left positive, measured curves aside [rad]."""
        return self.yaw.whole(self.yaw.hinges.within(part), self.yaw.bends(axis))

    def out_of_reach(self, limbs: Float[np.ndarray, "*batch limb"]) -> Float[np.ndarray, "*batch limb"]:
        """Return how far each foot's place lies outside what its limb reaches; 0 without a foot path [m]."""
        away = np.zeros(np.broadcast_shapes(limbs.shape, (1, len(self.place.limbs))))
        for among, numbers in zip(self._girdles, self._paths, strict=True):
            if isinstance(numbers, _Path):
                foot = np.stack(self._foot(among, numbers, _limbs_first(limbs, among), None), axis=-1)
                near, most = limb_kinematics.reach(self.place.limbs[among[0]].girdle.limb)
                for i, far in zip(among, np.linalg.norm(foot, axis=-1), strict=True):
                    away[..., i] = np.maximum(np.maximum(near - far, far - most), 0.0)
        return away

    def foot_places(self, limbs: Float[np.ndarray, "*batch limb"]) -> Float[np.ndarray, "*batch limb 3"]:
        """Return the intended foot centres, each in the D-H base frame of its limb (outward, forward, down) [m].

        Args:
            limbs: phases of the limbs [cycle].

        Raises:
            OutsideLimits: a gait has limbs without a foot path.
        """
        places: dict[int, np.ndarray] = {}
        for among, numbers in zip(self._girdles, self._paths, strict=True):
            limb = self.place.limbs[among[0]]
            if not isinstance(numbers, _Path):
                raise OutsideLimits(
                    f"gait {self.gaits[0].name!r} has no path for the foot of {limb.name}: choose a gait of foot paths."
                )
            ahead, outward, down = self._foot(among, numbers, _limbs_first(limbs, among), None)
            places |= zip(among, np.stack([limb.girdle.aside + outward, ahead, down], axis=-1), strict=True)
        return np.stack([places[i] for i in range(len(places))], axis=-2)

    def _foot(
        self, among: Sequence[int], numbers: "_Path", phase: np.ndarray, steer: Steer | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return how far feet are ahead of their hips, outside them and below them, shape (limb, *batch) [m]."""
        forward, lifted = foot_path(phase, self._duty)
        stroke, lower = numbers.stroke, np.zeros(())
        if steer is not None:
            stroke = stroke * np.asarray(steer.size) * _of_limbs(steer.stroke, among)
            lower = _of_limbs(steer.lower, among)
        ahead = numbers.ahead + stroke * forward
        return ahead, np.broadcast_to(numbers.outward, ahead.shape), numbers.down + lower - numbers.lift * lifted

    def _limbs(
        self,
        among: Sequence[int],
        numbers: "_Path | _Crank | np.ndarray",
        phase: np.ndarray,
        steer: Steer | None,
        *,
        draw: bool,
    ) -> np.ndarray:
        """Return the servo angles of some limbs of a girdle, shape (limb, *batch, servo) [rad]."""
        if isinstance(numbers, np.ndarray):  # held
            return np.broadcast_to(numbers, (len(among), *numbers.shape))
        if isinstance(numbers, _Crank):
            stance = numbers.stance
            if steer is not None:
                stance = np.clip(np.asarray(steer.size) * _of_limbs(steer.stroke, among) * stance, _LEAST, _MOST)
            return self._turned(phase, stance, numbers.down)[..., None]
        limb = self.place.limbs[among[0]]
        ahead, outward, down = self._foot(among, numbers, phase, steer)
        try:
            if numbers.leg is not None:
                foot = np.stack([numbers.leg.hip_offset + outward, ahead, down], axis=-1)
                return _leg_angles(numbers.leg, numbers.side, foot, draw=draw)
            foot = np.stack([ahead, outward, -down], axis=-1)
            if draw:
                near, far = limb_kinematics.reach(limb.girdle.limb)
                foot = _drawn(foot, np.zeros(3), (near + _INSIDE * far, far - _INSIDE * far))
            swivel = np.broadcast_to(numbers.swivel, ahead.shape)
            return limb_kinematics.inverse(limb.girdle.limb, foot, plane=swivel)
        except Unreachable as error:
            if len(among) > 1:  # say it of the first limb that it is true of
                for i, of_limb in zip(among, phase, strict=True):
                    self._limbs([i], numbers, of_limb[None], steer, draw=draw)
            names = ", ".join(dict.fromkeys(repr(gait.name) for gait in self.gaits))
            raise OutsideLimits(
                f"gait {names} asks {limb.name} of robot {self.robot.name!r} for a foot path outside its reach: "
                f"{error} Lower stroke, outward or height."
            ) from error

    def _turned(self, phase: np.ndarray, stance: np.ndarray, down: np.ndarray) -> np.ndarray:
        """Return the angle of a crank, which grows by a whole turn a cycle: the foot goes back below, forward above."""
        swing = 1.0 - self._duty
        turns, cycle = np.floor(phase), np.mod(phase, 1.0)
        half = stance / 2
        standing = -half + stance * (cycle - swing) / self._duty
        returning = half - 2 * np.pi + (2 * np.pi - stance) * cycle / swing
        return np.asarray(down - (2 * np.pi * turns + np.where(cycle < swing, returning, standing)))

    def _bend(self, targets: np.ndarray, axis: np.ndarray, steer: Steer | None) -> None:
        size = None if steer is None else steer.size
        tail = 0.0 if steer is None else steer.tail
        if self.yaw.moves or np.any(tail):
            hinges, bends, direct = self.yaw.hinges, self.yaw.bends(axis, size), self._direct
            if np.any(tail):
                bends = bends + self._of_tail(tail)
            turned = np.array(hinges.signs)[direct] * bends[..., direct] / self.yaw.share[:, direct]
            targets[..., np.array(hinges.servos, dtype=int)[direct]] = turned
            for servo in self.place.cables:
                among = [k for k, mine in enumerate(hinges.servos) if mine == servo]
                most = self.place.cable(servo).bend_limit
                whole = hinges.signs[among[0]] * self.yaw.whole(among, bends)
                if steer is not None:
                    whole = np.clip(whole, -most, most)
                targets[..., servo] = tail_kinematics.servo_angle(self.place.cable(servo), whole)
        if self.pitch.moves:
            targets[..., list(self.pitch.hinges.servos)] = self.pitch.bends(axis, size) / self.pitch.share
        if steer is not None and self.place.trunk_yaw:
            targets[..., list(self.place.trunk_yaw)] += (np.asarray(steer.bend) / len(self.place.trunk_yaw))[..., None]

    def _of_tail(self, bend: np.ndarray | float) -> np.ndarray:
        """Return what a steady bend of the tail adds to the bends of all hinges, as ``Waves.bends`` has them [rad]."""
        within = self.yaw.hinges.within("tail")
        each = np.zeros(len(self.yaw.hinges.servos))
        each[within] = 1.0 / max(len(within), 1)
        return np.asarray(np.asarray(bend)[..., None] * each * self.yaw.share)

    def _curve(self, targets: np.ndarray, limbs: np.ndarray, axis: np.ndarray) -> None:
        if not self._curves:
            return
        first = self._phases[:, 0] if self._phases.shape[1] else 0.0
        along = np.angle(axis) / (2 * np.pi) + self._touch_down - first
        for curve in self._curves:
            clock = along if curve.limb is None else limbs[..., curve.limb] - self._phases[:, curve.limb]
            turns = np.exp(2j * np.pi * np.asarray(clock)[..., None] * np.arange(curve.harmonics.shape[1]))
            targets[..., curve.servo] = (turns * curve.harmonics).sum(axis=-1).real


def trunk_amplitude(robot: Robot, gait: Gait) -> float:
    """Return the most that a gait bends the trunk sideways [rad]."""
    yaw = movement(robot, gait).yaw
    among = yaw.hinges.within("trunk")
    steady = np.abs(yaw.offset / yaw.share)
    return float((yaw.amplitude() + steady)[0, among].sum())


class Batch:
    """The gaits of the runs of a batch, gathered by robot and structure, so that each kind is worked out in one call.

    Args:
        robots: the design of each run; all have the same layout.
        gaits: the gait of each run.
    """

    def __init__(self, robots: Sequence[Robot], gaits: Sequence[Gait]) -> None:
        members: dict[Any, list[int]] = {}
        for run, (robot, gait) in enumerate(zip(robots, gaits, strict=True)):
            members.setdefault((robot, structure(gait)), []).append(run)
        self.groups = [
            (Movement(robots[runs[0]], [gaits[run] for run in runs]), np.array(runs)) for runs in members.values()
        ]
        self.phases = np.array([gait.limb_phases for gait in gaits], dtype=float).reshape(len(gaits), -1)
        self.periods = np.array([gait.period for gait in gaits])
        self._servos = len(layout(robots[0]).servos)

    def axis_phase(self, limbs: Float[np.ndarray, "run limb"], clock: Float[np.ndarray, " run"]) -> np.ndarray:
        """Return what the axis of each run follows: its limbs, or its clock where it has none [-]."""
        z = np.zeros(len(limbs), dtype=complex)
        for movement, runs in self.groups:
            z[runs] = movement.axis_phase(limbs[runs]) if limbs.shape[1] else movement.axis_of_clock(clock[runs])
        return z

    def targets(
        self, limbs: Float[np.ndarray, "run limb"], axis: Complex[np.ndarray, " run"], steer: Steer | None = None
    ) -> Float[np.ndarray, "run servo"]:
        """Return the servo angles of every run; see ``Movement.targets`` [rad]."""
        targets = np.zeros((len(limbs), self._servos))
        for movement, runs in self.groups:
            mine = None if steer is None else Steer(*(_of_runs(field, runs) for field in steer))
            targets[runs] = movement.targets(limbs[runs], axis[runs], mine)
        return targets

    def bend_of(self, part: Part, axis: Complex[np.ndarray, " run"]) -> Float[np.ndarray, " run"]:
        """Return how far a part of each run bends sideways, left positive [rad]."""
        bend = np.zeros(len(axis))
        for movement, runs in self.groups:
            bend[runs] = movement.bend_of(part, axis[runs])
        return bend

    def together(self, part: Part) -> tuple[Complex[np.ndarray, " run"], Float[np.ndarray, " run"]]:
        """Return swing and steady bend of a part of each run: its bend is ``steady + Re(swing z)`` [rad]."""
        swing, steady = np.zeros(len(self.periods), dtype=complex), np.zeros(len(self.periods))
        for movement, runs in self.groups:
            yaw = movement.yaw
            swing[runs], steady[runs] = yaw.together(yaw.hinges.within(part))
        return swing, steady


def structure(gait: Gait) -> Any:
    """Return what gaits must have in common to be worked out together: all that is no plain number."""
    limbs = tuple((type(limb), _quarter(limb.swivel) if isinstance(limb, FootPath) else 0) for limb in gait.limbs)
    signs = tuple(_references([gait])[0])
    return limbs, signs, tuple((curve.servo, len(curve.angles)) for curve in gait.curves)


@lru_cache(maxsize=256)
def movement(robot: Robot, gait: Gait) -> Movement:
    """Return one gait worked out for a robot."""
    return Movement(robot, [gait])


def intended(
    robot: Robot, gait: Gait, time: Float[np.ndarray, "*batch"], *, begin: float = START, ramp: float = 0.0
) -> Intended:
    """Return phases and servo angles of a gait at some times; before it begins the phases stand still.

    Args:
        robot: the design.
        gait: the gait.
        time: since the beginning of the run [s].
        begin: time at which the gait begins [s].
        ramp: duration from then on over which strokes and bends grow from zero, as 3 x^2 - 2 x^3 [s].

    Raises:
        OutsideLimits: the gait is for other limbs, or asks for what they cannot reach.
    """
    since = np.asarray(np.maximum(np.asarray(time, dtype=float) - begin, 0.0))
    grown = np.minimum(since / ramp, 1.0) if ramp > 0.0 else None
    size = None if grown is None else np.asarray(grown**2 * (3.0 - 2.0 * grown))
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
    here, clock = movement(robot, gait), np.asarray(clock, dtype=float)
    many = np.atleast_1d(clock)
    steer = None if size is None else Steer(size=np.atleast_1d(size))
    found = here.targets(many[..., None] + np.array(gait.limb_phases), here.axis_of_clock(many), steer)
    return found.reshape(*clock.shape, -1)


def limb_targets(
    robot: Robot, gait: Gait, phase: Float[np.ndarray, "*batch limb"]
) -> Float[np.ndarray, "*batch servo"]:
    """Return the servo angles of limbs at phases of their own; the axis is not bent sideways [rad].

    Args:
        robot: the design.
        gait: the gait.
        phase: of the limbs, not wrapped [cycle].

    Raises:
        OutsideLimits: the gait is for other limbs, or asks for what they cannot reach.
    """
    many = np.atleast_2d(phase)
    targets = limb_movement(robot, gait).targets(many, np.zeros(many.shape[:-1], dtype=complex))
    return targets.reshape(*np.shape(phase)[:-1], -1)


@lru_cache(maxsize=256)
def limb_movement(robot: Robot, gait: Gait) -> Movement:
    """Return a gait's limbs alone, worked out for a robot: its axis is not bent sideways, and not waved up and down."""
    still = gait.straightened()
    return Movement(robot, [replace(still, axis=tuple(bend for bend in still.axis if bend.turn == "pitch"))])


def middle_stance(robot: Robot, gait: Gait) -> Float[np.ndarray, " servo"]:
    """Return the servo angles in which all feet stand in the middle of their path and the axis is straight [rad].

    Of a robot without limbs, or with limbs that are held, it is those with a straight axis.
    """
    return limb_targets(robot, gait, np.full(len(gait.limb_phases), 1.0 - gait.duty_factor / 2))


def hip_height(robot: Robot, gait: Gait) -> float:
    """Return how high the root's axis is above the ground in a gait [m]; 0 where the gait does not say."""
    girdles = robot.girdles
    return _metres(gait.height, girdles[-1].limb.reach) - girdles[-1].above if girdles and gait.limbs else 0.0


def _metres(share: float, reach: float) -> float:
    return round(share * reach, _PICOMETRE)


def _references(gaits: Sequence[Gait]) -> tuple[np.ndarray, np.ndarray]:
    """Return by which sign each limb pulls on the axis [-], and the rest of the phase at which it does [cycle]."""
    pulls = [gait.coupling or tuple(phase - gait.limb_phases[0] for phase in gait.limb_phases) for gait in gaits]
    reference = np.array(pulls, dtype=float)
    half = np.round(2.0 * reference)
    return (1.0 - 2.0 * np.mod(half, 2.0))[0], reference - half / 2.0


def foot_path(phase: Float[np.ndarray, "*batch"], duty: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return how far a foot is along its path, -1 to 1 forward, and how far it is lifted, 0 to 1 [-].

    Args:
        phase: of the limb [cycle].
        duty: share of the cycle in which it stands [-].
    """
    cycle, swing = np.mod(phase, 1.0), 1.0 - duty
    s = np.clip(cycle / swing, 0.0, 1.0)
    forward = np.where(cycle < swing, -np.cos(np.pi * s), 1.0 - 2.0 * ((cycle - swing) / duty))
    return forward, np.where(cycle < swing, np.sin(np.pi * s) ** 2, 0.0)


class _Path(NamedTuple):
    """The numbers of the foot paths of one limb, over runs [m]; those of a limb of yaw, pitch and knee have a leg."""

    stroke: np.ndarray
    lift: np.ndarray
    outward: np.ndarray
    ahead: np.ndarray
    down: np.ndarray
    swivel: np.ndarray
    leg: PlainLeg | None
    side: int  # quarter turns of the swivel of a leg: 0 sprawled, 1 knee ahead, -1 elbow behind


class _Crank(NamedTuple):
    """The numbers of the cranks of one limb, over runs [rad]."""

    stance: np.ndarray
    down: np.ndarray


class _Measured:
    """The curves of one servo, over runs."""

    def __init__(self, place: Layout, gaits: Sequence[Gait], number: int) -> None:
        self.servo = place.servos.index(gaits[0].curves[number].servo)
        moved = [i for i, limb in enumerate(place.limbs) if limb.servos.start <= self.servo < limb.servos.stop]
        self.limb = moved[0] if moved else None  # whose phase it follows; None: that of the axis
        self.harmonics = np.array([gait.curves[number].harmonics for gait in gaits])


def _path_numbers(robot: Robot, gaits: Sequence[Gait], number: int) -> "_Path | _Crank | np.ndarray | None":
    """Return what the gaits say of the limbs of a girdle."""
    if not gaits[0].limbs:
        return None
    limbs: list[Any] = [gait.limbs[number] for gait in gaits]
    girdle = robot.girdles[number]
    if isinstance(limbs[0], Held):
        servos = sum(hinge.servo is not None for hinge in girdle.limb.hinges)
        return np.array([(*limb.angles, *(0.0,) * (servos - len(limb.angles))) for limb in limbs])
    if isinstance(limbs[0], Sweep):
        return _Crank(*(np.array([getattr(limb, name) for limb in limbs]) for name in ("stance", "down")))
    design, leg = girdle.limb, limb_kinematics.kind(girdle.limb) == "leg"
    metres = {
        name: np.array([_metres(getattr(limb, name), design.reach) for limb in limbs])
        for name in ("stroke", "lift", "outward", "ahead")
    }
    return _Path(
        **metres,
        down=np.array([hip_height(robot, gait) for gait in gaits]) + girdle.above - design.foot.radius,
        swivel=np.array([limb.swivel for limb in limbs]),
        leg=limb_kinematics.plain(girdle) if leg else None,
        side=_quarter(limbs[0].swivel),
    )


def _quarter(swivel: float) -> int:
    """Return the nearest of a quarter turn back, none, and a quarter turn forward: -1, 0, 1."""
    return round(min(max(swivel * _SIDEWAYS, -1.0), 1.0))


def _of_runs(field: np.ndarray | float, runs: np.ndarray) -> np.ndarray:
    """Return what a field of a ``Steer`` says of some runs."""
    return np.asarray(field)[runs] if np.ndim(field) else np.asarray(field)


def _girdles(place: Layout) -> list[list[int]]:
    """Return the limbs that are worked out together: those of a girdle, where its chain has a closed form."""
    groups: dict[tuple[int, int], list[int]] = {}
    for i, limb in enumerate(place.limbs):
        alone = i if limb_kinematics.kind(limb.girdle.limb) == "other" else -1
        groups.setdefault((limb.number, alone), []).append(i)
    return list(groups.values())


def _limbs_first(values: Float[np.ndarray, "*batch limb"], among: Sequence[int]) -> np.ndarray:
    """Return what is said of some limbs, shape (limb, *batch)."""
    return np.stack([values[..., i] for i in among])


def _of_limbs(field: np.ndarray | float, among: Sequence[int]) -> np.ndarray:
    """Return what a field of a ``Steer`` says of some limbs, shape (limb, *batch), or () where it is one number."""
    return _limbs_first(np.asarray(field), among) if np.ndim(field) else np.asarray(field)


def _leg_angles(leg: PlainLeg, side: int, foot: np.ndarray, *, draw: bool) -> np.ndarray:
    """Return yaw, pitch and knee that bring a foot to its place, sprawled or erect [rad]."""
    if draw:
        near, far = leg.reach
        foot = _drawn(foot, np.array([leg.hip_offset, 0.0, 0.0]), (near + _INSIDE, far - _INSIDE))
    if side == 0:
        return leg_kinematics.inverse(leg, foot)
    # the plane of an erect leg faces back or forward; in it the foot may lie to either side of the hip
    along = float(side) * foot[..., 1]
    flat = np.stack([leg.hip_offset + along, np.zeros_like(along), foot[..., 2]], axis=-1)
    angles = np.where(
        along[..., None] < 0.0, leg_kinematics.inverse(leg, flat, side=-1), leg_kinematics.inverse(leg, flat)
    )
    angles[..., 0] = float(side) * np.pi / 2
    return angles


def _drawn(foot: np.ndarray, hip: np.ndarray, reach: tuple[float, float]) -> np.ndarray:
    """Return foot points drawn along the line to the hip into what a limb reaches; others stay as they are [m]."""
    away, (near, far) = foot - hip, reach
    length = np.linalg.norm(away, axis=-1, keepdims=True)
    moved = hip + away * np.clip(length, near, far) / np.maximum(length, _INSIDE)
    return np.asarray(np.where((length < near) | (length > far), moved, foot))


def check_limbs(robot: Robot, gait: Gait) -> None:
    """Refuse a gait for other limbs or servos than a robot has.

    Raises:
        OutsideLimits: it has phases or movements for another number of limbs, or moves them as they cannot move.
        UnknownName: a curve is for a servo that the robot lacks.
    """
    place = layout(robot)
    if len(gait.limb_phases) != len(place.limbs):
        raise OutsideLimits(
            f"gait {gait.name!r} has phases for {len(gait.limb_phases)} limbs; robot {robot.name!r} has "
            f"{len(place.limbs)}: choose a gait made for it."
        )
    for curve in gait.curves:
        if curve.servo not in place.servos:
            raise UnknownName(f"servo of robot {robot.name!r}", curve.servo, place.servos)
    for girdle, limb in zip(place.robot.girdles, gait.limbs, strict=False):
        _check_girdle(place, gait, girdle, limb)


def _check_girdle(place: Layout, gait: Gait, girdle: Any, limb: Limbs) -> None:
    robot = place.robot
    drives = [hinge.drive for hinge in girdle.limb.hinges]
    cranks = len(drives) == 1 and isinstance(drives[0], Crank)
    if cranks != isinstance(limb, Sweep) and not isinstance(limb, Held):
        raise OutsideLimits(
            f"gait {gait.name!r} wants girdle {girdle.name} of robot {robot.name!r} to follow a "
            f"{type(limb).__name__}, but its limbs {'are' if cranks else 'are not'} cranks: choose a gait for it."
        )
    driven = sum(hinge.servo is not None for hinge in girdle.limb.hinges)
    if isinstance(limb, Held) and len(limb.angles) > driven:
        raise OutsideLimits(
            f"gait {gait.name!r} holds {len(limb.angles)} angles of girdle {girdle.name}; its limbs have {driven} "
            "servos: give one for each."
        )
    outside = isinstance(limb, FootPath) and _quarter(limb.swivel) != 0 and limb.outward
    if outside and limb_kinematics.kind(girdle.limb) == "leg":
        raise OutsideLimits(
            f"gait {gait.name!r} stands the limbs of girdle {girdle.name} of robot {robot.name!r} erect and "
            f"{outside:g} of their reach outside their hips; legs of yaw, pitch and knee that stand erect stand "
            "below their hips: set outward to 0, or swivel."
        )

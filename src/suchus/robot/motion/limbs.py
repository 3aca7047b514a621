"""What limbs do at a phase: from foot paths, sweeps and held angles to servo angles, for many runs at once.

``LimbMotion`` works out limbs that move alike, so that the numbers of their gaits are arrays over limbs and runs.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.core.errors import OutsideLimits, UnknownName, Unreachable
from suchus.robot.design import Crank, Girdle, Layout, Robot, layout
from suchus.robot.kinematics import leg as leg_kinematics
from suchus.robot.kinematics import limb as limb_kinematics
from suchus.robot.kinematics.leg_solution import Lengths, solve
from suchus.robot.kinematics.limb import PlainLeg
from suchus.robot.motion.gait import Gait
from suchus.robot.motion.parts import FixedLimbs, FootPath, Limbs, Sweep

_PICOMETRE = 12  # decimals of a metre to which lengths are rounded, so that fractions of a reach give round numbers
# distance inside its reach to which a foot is drawn: [m] for a leg, [reach] for other limbs
_REACH_MARGIN = 1e-6
# bounds of the angle that a crank turns through in stance [rad]
_MIN_STANCE_ANGLE, _MAX_STANCE_ANGLE = 0.02, 2 * np.pi - 0.02
_SIDEWAYS = 2 / np.pi  # quarter turns of swivel a radian


class Steer(NamedTuple):
    """Changes of a gait while it runs; every field broadcasts over runs, and over limbs where it has them."""

    size: Float[np.ndarray, "*batch"] | float = 1.0
    """Factor on strokes and bends, 0 where a robot stands [-]."""
    stroke: Float[np.ndarray, "*batch limb"] | float = 1.0
    """Factor on the stroke of each limb [-]."""
    lowering: Float[np.ndarray, "*batch limb"] | float = 0.0
    """How much lower than the gait says each foot is [m]."""
    bend: Float[np.ndarray, "*batch"] | float = 0.0
    """Steady bend of the trunk besides that of the gait, left positive [rad]."""
    tail: Float[np.ndarray, "*batch"] | float = 0.0
    """Steady lateral bend of the tail besides that of the gait, left positive [rad]."""

    @property
    def keeps_paths(self) -> bool:
        """Whether the feet keep the paths of the gait."""
        return is_number(self.size, 1.0) and is_number(self.stroke, 1.0) and is_number(self.lowering, 0.0)


class LimbMotion:
    """Limbs of one girdle, or legs of several, in gaits of one structure: every number is an array over runs.

    Args:
        robot: the design.
        gaits: gaits of each run; ``structure`` of ``suchus.robot.motion.movement`` must be the same for all.
        limb_indices: the limbs, in the order of the robot's.
    """

    def __init__(self, robot: Robot, gaits: Sequence[Gait], limb_indices: Sequence[int]) -> None:
        self.robot, self.gaits, self.limb_indices = robot, tuple(gaits), tuple(limb_indices)
        limbs = layout(robot).limbs
        self.limb = limbs[limb_indices[0]]
        self._duty = np.array([gait.duty_factor for gait in gaits])
        self._numbers = _numbers(robot, gaits, [limbs[i].number for i in limb_indices])
        self._all = len(limb_indices) == len(limbs)

    @property
    def has_paths(self) -> bool:
        """Whether the feet follow paths."""
        return isinstance(self._numbers, _Path)

    def angles(
        self, limbs: Float[np.ndarray, "*batch limb"], steer: Steer | None, *, draw: bool
    ) -> list[Float[np.ndarray, "*batch servo"]]:
        """Return the servo angles of each of the limbs [rad]; an empty list for gaits without limb movements.

        Args:
            limbs: phases of all limbs of the robot [cycle].
            steer: what is asked besides.
            draw: draw feet into what limbs reach.

        Raises:
            OutsideLimits: a foot's path is out of reach, and it is not drawn into it.
        """
        parameters = self._numbers
        if parameters is None:
            return []
        phase = self._of_limbs(limbs)
        if isinstance(parameters, np.ndarray):  # held
            return [parameters] * len(self.limb_indices)
        if isinstance(parameters, _Crank):
            stance = parameters.stance
            if steer is not None:
                stance = np.clip(
                    np.asarray(steer.size) * self._of_limbs(steer.stroke) * stance,
                    _MIN_STANCE_ANGLE,
                    _MAX_STANCE_ANGLE,
                )
            return list(self._crank_angle(phase, stance, parameters.down)[..., None])
        draw = draw and not (parameters.lies_within_reach and (steer is None or steer.keeps_paths))
        try:
            return list(self._angles_at(parameters, *self._feet(parameters, phase, steer), draw=draw))
        except Unreachable as error:
            if len(self.limb_indices) > 1:  # name the first limb that fails
                for i in self.limb_indices:
                    LimbMotion(self.robot, self.gaits, [i]).angles(limbs, steer, draw=draw)
            names = ", ".join(dict.fromkeys(repr(gait.name) for gait in self.gaits))
            raise OutsideLimits(
                f"gait {names} asks {self.limb.name} of robot {self.robot.name!r} for a foot path outside its reach: "
                f"{error} Lower stroke, outward or height."
            ) from error

    def feet(self, limbs: Float[np.ndarray, "*batch limb"]) -> Float[np.ndarray, "3 limb *batch"]:
        """Return how far feet are ahead of their hips, outside them and below them [m].

        Args:
            limbs: phases of all limbs of the robot [cycle].

        Raises:
            OutsideLimits: a gait has limbs without a foot path.
        """
        if not isinstance(self._numbers, _Path):
            raise OutsideLimits(
                f"gait {self.gaits[0].name!r} has no path for the foot of {self.limb.name}: choose a gait of foot "
                "paths."
            )
        forward, outward, down = self._feet(self._numbers, self._of_limbs(limbs), None)
        return np.stack([forward, np.broadcast_to(outward, forward.shape), down])

    def _feet(
        self, parameters: "_Path", phase: np.ndarray, steer: Steer | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return how far feet are ahead of their hips, outside them and below them [m].

        The first and the last have the shape (limb, *batch); the other broadcasts to it.
        """
        forward, lifted = foot_path(phase, self._duty)
        stroke, lift, outward, ahead, down = (_over_batch(numbers, phase.ndim) for numbers in parameters.metres)
        if steer is not None:
            if not is_number(steer.size, 1.0):
                stroke = stroke * np.asarray(steer.size)
            if not is_number(steer.stroke, 1.0):
                stroke = stroke * self._of_limbs(steer.stroke)
            if not is_number(steer.lowering, 0.0):
                down = down + self._of_limbs(steer.lowering)
        return ahead + stroke * forward, outward, down - lift * lifted

    def _angles_at(
        self, parameters: "_Path", forward: np.ndarray, outward: np.ndarray, down: np.ndarray, *, draw: bool
    ) -> np.ndarray:
        """Return the servo angles that bring feet to their places, shape (limb, *batch, servo) [rad].

        Args:
            parameters: parameters of the foot paths.
            forward: distance of the feet forward from their hips [m].
            outward: distance of the feet outward from their hips [m].
            down: distance of the feet below their hips [m].
            draw: draw feet into what limbs reach.
        """
        if parameters.legs is not None:
            foot = np.empty((*forward.shape, 3))
            aside = _over_batch(parameters.legs.hip_offsets, forward.ndim) + outward
            foot[..., 0], foot[..., 1], foot[..., 2] = aside, forward, down
            return parameters.legs.angles(foot, draw=draw)
        foot = np.stack([forward, np.broadcast_to(outward, forward.shape), -down], axis=-1)
        limb = self.limb.girdle.limb
        if draw:
            min_reach, max_reach = limb_kinematics.reach(limb)
            foot = _clip_to_reach(
                foot, np.zeros(3), (min_reach + _REACH_MARGIN * max_reach, max_reach - _REACH_MARGIN * max_reach)
            )
        return limb_kinematics.inverse(limb, foot, swivel=np.broadcast_to(parameters.swivel, forward.shape))

    def _of_limbs(self, field: np.ndarray | float) -> np.ndarray:
        """Return phases, or a field of a ``Steer``, of these limbs, shape (limb, *batch), or () where it is one number.

        Args:
            field: of all limbs of the robot, shape (*batch, limb), or one number.
        """
        values = np.asarray(field)
        if not values.ndim:
            return values
        selected = values if self._all else values[..., list(self.limb_indices)]
        return selected.transpose(selected.ndim - 1, *range(selected.ndim - 1))

    def _crank_angle(self, phase: np.ndarray, stance: np.ndarray, down: np.ndarray) -> np.ndarray:
        """Return the angle of a crank, which grows by a whole turn a cycle: the foot goes back below, forward above.

        Args:
            phase: phase of the limbs, shape (limb, *batch) [cycle].
            stance: angle turned through in stance [rad].
            down: angle at which the foot points straight down [rad].
        """
        swing = 1.0 - self._duty
        turns, cycle = np.floor(phase), np.mod(phase, 1.0)
        half = stance / 2
        standing = -half + stance * (cycle - swing) / self._duty
        returning = half - 2 * np.pi + (2 * np.pi - stance) * cycle / swing
        return np.asarray(down - (2 * np.pi * turns + np.where(cycle < swing, returning, standing)))


def hip_height(robot: Robot, gait: Gait) -> float:
    """Return the height of the root's axis above the ground in a gait [m]; 0 if the gait has none."""
    girdles = robot.girdles
    return _metres(gait.height, girdles[-1].limb.reach) - girdles[-1].above if girdles and gait.limbs else 0.0


def _metres(fraction: float, reach: float) -> float:
    return round(fraction * reach, _PICOMETRE)


def foot_path(phase: Float[np.ndarray, "*batch"], duty: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return how far a foot is along its path, -1 to 1 forward, and how far it is lifted, 0 to 1 [-].

    Args:
        phase: phase of the limb [cycle].
        duty: share of the cycle in which it stands [-].
    """
    cycle, swing = np.mod(phase, 1.0), 1.0 - duty
    angle, swings = np.pi * bounded(cycle / swing, 0.0, 1.0), cycle < swing
    forward = np.where(swings, -np.cos(angle), 1.0 - 2.0 * ((cycle - swing) / duty))
    return forward, np.where(swings, np.sin(angle) ** 2, 0.0)


def bounded(values: Any, lower_bound: Any, upper_bound: Any) -> np.ndarray:
    """Return numbers within bounds, as ``numpy.clip`` does, in a third of its time for the few numbers of one run."""
    return np.asarray(np.minimum(np.maximum(values, lower_bound), upper_bound))


def in_steps(indices: Sequence[int]) -> Any:
    """Return a slice with which an array gives the values at some indices, where these are evenly spaced, else them.

    A slice takes a third of the time for the few numbers of one run.
    """
    places = [int(i) for i in indices]
    step = places[1] - places[0] if len(places) > 1 else 1
    if not places or step == 0 or places != list(range(places[0], places[-1] + (1 if step > 0 else -1), step)):
        return np.array(places, dtype=int)
    stop = places[-1] + (1 if step > 0 else -1)
    return slice(places[0], None if stop < 0 else stop, step)


def limb_groups(place: Layout, gait: Gait) -> list[list[int]]:
    """Return the limbs that are worked out together.

    They are all legs of yaw, pitch and knee whose feet follow paths with the knees to one side, else the limbs of a
    girdle where its chain has a closed form, else each limb.

    Args:
        place: layout of the robot.
        gait: one of the gaits of one structure.
    """
    groups: dict[tuple[str, int], list[int]] = {}
    for i, limb in enumerate(place.limbs):
        kind, limb_movement = limb_kinematics.kind(limb.girdle.limb), gait.limbs[limb.number] if gait.limbs else None
        if kind == "leg" and isinstance(limb_movement, FootPath):
            key = "legs", quarter(limb_movement.swivel)
        else:
            key = ("limb", i) if kind == "other" else ("girdle", limb.number)
        groups.setdefault(key, []).append(i)
    return list(groups.values())


def quarter(swivel: float) -> int:
    """Return the nearest of a quarter turn back, none, and a quarter turn forward: -1, 0, 1."""
    return round(min(max(swivel * _SIDEWAYS, -1.0), 1.0))


def check_limbs(robot: Robot, gait: Gait) -> None:
    """Refuse a gait for other limbs or servos than a robot has.

    Raises:
        OutsideLimits: it has phases or movements for another number of limbs, or moves them as they cannot move.
        UnknownName: a curve is for a servo that the robot lacks.
    """
    place = layout(robot)
    if len(gait.limb_phases) != len(place.limbs):
        limb_list = f" ({', '.join(place.limb_names)})" if place.limbs else ""
        raise OutsideLimits(
            f"gait {gait.name!r} has phases for {len(gait.limb_phases)} limbs; robot {robot.name!r} has "
            f"{len(place.limbs)}{limb_list}: choose a gait made for it, or leave the gait out for the robot's own."
        )
    for curve in gait.curves:
        if curve.servo not in place.servos:
            raise UnknownName(f"servo of robot {robot.name!r}", curve.servo, place.servos)
    for girdle, limb in zip(place.robot.girdles, gait.limbs, strict=False):
        _check_girdle(place, gait, girdle, limb)


_MOVES: dict[type, str] = {FootPath: "leads feet along a path", Sweep: "turns limbs as cranks"}


def _check_girdle(place: Layout, gait: Gait, girdle: Girdle, limb: Limbs) -> None:
    """Refuse a movement that the limbs of a girdle cannot do.

    Args:
        place: layout of the robot.
        gait: to which the movement belongs.
        girdle: girdle that carries the limbs.
        limb: the movement.
    """
    robot = place.robot
    drives = [hinge.drive for hinge in girdle.limb.hinges]
    cranks = len(drives) == 1 and isinstance(drives[0], Crank)
    if cranks != isinstance(limb, Sweep) and not isinstance(limb, FixedLimbs):
        raise OutsideLimits(
            f"gait {gait.name!r} {_MOVES[type(limb)]}; limbs L{girdle.name} and R{girdle.name} of robot {robot.name!r} "
            f"{'are' if cranks else 'are not'} cranks: choose a gait made for it, or leave the gait out for the "
            "robot's own."
        )
    servo_count = sum(hinge.servo is not None for hinge in girdle.limb.hinges)
    if isinstance(limb, FixedLimbs) and len(limb.angles) > servo_count:
        raise OutsideLimits(
            f"gait {gait.name!r} holds {len(limb.angles)} angles of girdle {girdle.name}; its limbs have {servo_count} "
            "servos: give one for each."
        )
    outward = isinstance(limb, FootPath) and quarter(limb.swivel) != 0 and limb.outward
    if outward and limb_kinematics.kind(girdle.limb) == "leg":
        raise OutsideLimits(
            f"gait {gait.name!r} stands the limbs of girdle {girdle.name} of robot {robot.name!r} erect and "
            f"{outward:g} of their reach outside their hips; legs of yaw, pitch and knee that stand erect stand "
            "below their hips: set outward to 0, or swivel."
        )


class _Path(NamedTuple):
    """The numbers of the foot paths of some limbs; those of limbs of yaw, pitch and knee have legs."""

    metres: tuple[np.ndarray, ...]
    """Stroke, lift, distance outside, ahead and below, each of shape (limb, run) [m]."""
    swivel: np.ndarray
    """Swivel over runs, of limbs of one girdle [rad]."""
    legs: "_Legs | None"
    """The legs, if they are such."""
    lies_within_reach: bool
    """Whether it is known that a leg reaches every place of its foot's path, so that none needs to be drawn into it."""


class _Legs:
    """Legs of yaw, pitch and knee that stand alike.

    Args:
        legs: lengths of the leg of each limb.
        side: 0 sprawled, 1 erect with the knee ahead, -1 erect with the elbow behind.
    """

    def __init__(self, legs: Sequence[PlainLeg], side: int) -> None:
        self._legs, self._side = tuple(legs), side
        self.hip_offsets = np.array([[leg.hip_offset] for leg in legs])
        """Distance of each yaw axis from the midline, shape (limb, 1) [m]."""
        self._hips = np.array([[[leg.hip_offset, 0.0, 0.0]] for leg in legs])
        least, most = np.array([leg.reach for leg in legs]).T
        self._reach = (least + _REACH_MARGIN)[:, None, None], (most - _REACH_MARGIN)[:, None, None]
        self._count, self._lengths = 1, Lengths.of(legs)

    def reach_all_of(
        self, stroke: np.ndarray, lift: np.ndarray, outward: np.ndarray, ahead: np.ndarray, down: np.ndarray
    ) -> bool:
        """Return whether the legs reach all of the boxes in which the paths of their feet lie.

        Args:
            stroke: half of the length of each box, shape (limb, run) [m].
            lift: height of each box [m].
            outward: distance of the boxes from the hips outward [m].
            ahead: distance of their middles forward [m].
            down: distance of their undersides below the hips [m].
        """
        length, height = np.abs(stroke), np.abs(lift)
        farthest = np.sqrt(outward**2 + (np.abs(ahead) + length) ** 2 + (np.abs(down) + height) ** 2)
        level, below = np.maximum(np.abs(ahead) - length, 0.0), np.maximum(np.abs(down) - height, 0.0)
        nearest = np.sqrt(outward**2 + level**2 + below**2)
        least, most = (bound[..., 0] for bound in self._reach)
        return bool(((least + _REACH_MARGIN < nearest) & (farthest < most - _REACH_MARGIN)).all())

    def angles(self, foot: Float[np.ndarray, "limb *batch 3"], *, draw: bool) -> np.ndarray:
        """Return yaw, pitch and knee that bring feet to their places, shape (limb, *batch, 3) [rad].

        Args:
            foot: outward, forward, down in the base frame of each leg [m].
            draw: draw feet into what legs reach.

        Raises:
            Unreachable: a foot is out of reach, and it is not drawn into it.
        """
        if draw:
            flat_foot = foot.reshape(len(foot), -1, 3)
            foot = _clip_to_reach(flat_foot, self._hips, self._reach).reshape(foot.shape)
        if self._side == 0:
            return self._inverse(foot)
        # the plane of an erect leg faces back or forward; in it the foot may lie to either side of the hip
        in_plane = float(self._side) * foot[..., 1]
        flat = np.empty_like(foot)
        flat[..., 0] = _over_batch(self.hip_offsets, in_plane.ndim) + in_plane
        flat[..., 1], flat[..., 2] = 0.0, foot[..., 2]
        angles = np.where(in_plane[..., None] < 0.0, self._inverse(flat, side=-1), self._inverse(flat))
        angles[..., 0] = float(self._side) * np.pi / 2
        return angles

    def _inverse(self, foot: np.ndarray, *, side: int = 1) -> np.ndarray:
        """Return the angles of ``leg_kinematics.inverse``."""
        points = foot.reshape(-1, 3)
        count = len(points) // len(self._legs)
        if count != self._count:  # of a batch each control period has the same number
            self._count, self._lengths = count, Lengths.of(self._legs, count)
        angles, is_reachable = solve(self._lengths, points, side=side)
        if not is_reachable:
            for leg, places in zip(self._legs, foot, strict=True):
                leg_kinematics.inverse(leg, places, side=side)
        return angles.reshape(foot.shape)


class _Crank(NamedTuple):
    """The numbers of the cranks of one limb, over runs [rad]."""

    stance: np.ndarray
    down: np.ndarray


def _numbers(robot: Robot, gaits: Sequence[Gait], numbers: Sequence[int]) -> "_Path | _Crank | np.ndarray | None":
    """Return the movement of some limbs in all gaits as arrays over runs; None without limb movements.

    Args:
        robot: the design.
        gaits: gaits of each run.
        numbers: number of the girdle of each limb; several girdles have legs on paths.
    """
    if not gaits[0].limbs:
        return None
    limbs: list[Any] = [gait.limbs[numbers[0]] for gait in gaits]
    girdle = robot.girdles[numbers[0]]
    if isinstance(limbs[0], FixedLimbs):
        servos = sum(hinge.servo is not None for hinge in girdle.limb.hinges)
        return np.array([(*limb.angles, *(0.0,) * (servos - len(limb.angles))) for limb in limbs])
    if isinstance(limbs[0], Sweep):
        return _Crank(*(np.array([getattr(limb, name) for limb in limbs]) for name in ("stance", "down")))
    is_leg, heights = limb_kinematics.kind(girdle.limb) == "leg", np.array([hip_height(robot, gait) for gait in gaits])
    metres: list[list[np.ndarray]] = []
    for number in numbers:
        carrier, paths = robot.girdles[number], [gait.limbs[number] for gait in gaits]
        stroke, lift, outward, ahead = (
            np.array([_metres(getattr(path, name), carrier.limb.reach) for path in paths])
            for name in ("stroke", "lift", "outward", "ahead")
        )
        down = heights + carrier.above - carrier.limb.foot.radius
        metres.append([stroke, lift, outward, ahead, down])
    legs = None
    if is_leg:
        legs = _Legs([limb_kinematics.plain(robot.girdles[number]) for number in numbers], quarter(limbs[0].swivel))
    arrays = tuple(np.array(rows) for rows in zip(*metres, strict=True))
    swivel = np.array([limb.swivel for limb in limbs])
    return _Path(arrays, swivel, legs, legs is not None and legs.reach_all_of(*arrays))


def is_number(field: np.ndarray | float, number: float) -> bool:
    """Return whether a field of a ``Steer`` is one number, which changes nothing."""
    return isinstance(field, float) and field == number


def _over_batch(values: Float[np.ndarray, "limb run"], dimensions: int) -> np.ndarray:
    """Return numbers of limbs and runs so that they broadcast to an array of shape (limb, *batch).

    Args:
        values: the numbers.
        dimensions: number of dimensions of that array.
    """
    if dimensions == 2:
        return values
    return values.reshape(len(values), *(1,) * (dimensions - 2), -1) if dimensions > 2 else values[:, 0]


def _clip_to_reach(foot: np.ndarray, hip: np.ndarray, reach: tuple[Any, Any]) -> np.ndarray:
    """Return foot points moved along the line to the hip into the reach of a limb; others stay as they are [m].

    Args:
        foot: shape (*batch, 3) [m].
        hip: shape (3,), or broadcasts to that of the feet [m].
        reach: nearest and farthest distance of the foot from the hip, numbers or arrays that broadcast to
            (*batch, 1) [m].
    """
    offset, (min_reach, max_reach) = foot - hip, reach
    length = np.sqrt(np.add.reduce(offset * offset, axis=-1, keepdims=True))
    is_outside = (length < min_reach) | (length > max_reach)
    if not is_outside.any():
        return foot
    clipped = hip + offset * bounded(length, min_reach, max_reach) / np.maximum(length, _REACH_MARGIN)
    return np.asarray(np.where(is_outside, clipped, foot))

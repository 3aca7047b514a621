"""Keyed postures: symmetric postures on planted hind feet, solved for their servo angles.

A posture says where the body is over the hind feet, not what each joint does: how high the hips are, how far the
pelvis is pitched up, and how far the centre of mass lies behind the hind feet. Inverse kinematics finds the rest, so
that the feet stay where they are while one posture turns into the next.
"""

from dataclasses import dataclass, fields, replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.design import ARTICLE_BODY, Robot, check_needs, joint_names, layout, servo_names
from suchus.design.checks import Checks
from suchus.design.measures import LegMeasures
from suchus.errors import InvalidDesign, OutsideLimits, Unreachable
from suchus.kinematics import leg as leg_kinematics
from suchus.kinematics.body import tail_points
from suchus.kinematics.mass import centre_of_mass
from suchus.motion.limits import servo_range

SETTLING = 12
"""Rounds that bring the centre of mass to its place [-]; each leaves a tenth of the error, since the legs are light."""
_INSIDE = 1e-6  # [m]; how far inside its reach a clipped leg stays


@dataclass(frozen=True, slots=True, kw_only=True)
class Posture:
    """A posture with left and right alike, the trunk straight from above, and both hind feet side by side."""

    hip_height: float
    """Height of the hind girdle's axis above the ground [m]."""
    pelvis_pitch: float
    """Pitch of the pelvis against the level, front end up positive [rad]."""
    lead: float
    """Distance by which the centre of mass lies behind the centres of the hind feet [m]."""
    stance: float
    """Distance by which a hind foot stands outside its hip [m]."""
    lift: float
    """Height of the hind feet above the ground [m]; zero where they are planted."""
    trunk_first: float
    """Angle by which the trunk's first pitch joint bends the front end up [rad]."""
    trunk_second: float
    """Angle of the second one [rad]."""
    tail_press: float
    """Depth below the ground at which the tip of the straight tail is commanded [m]: its servo then presses it down."""
    arm_yaw: float
    """Yaw of the front legs, forward positive [rad]."""
    arm_pitch: float
    """Pitch of the front legs, foot down positive [rad]."""
    arm_knee: float
    """Knee angle of the front legs, shank down positive [rad]."""

    def __post_init__(self) -> None:
        with Checks("posture", self) as check:
            check.number("hip_height", 0.01, 2.0, "m")
            check.number("pelvis_pitch", -1.6, 1.6, "rad")
            check.number("lead", -1.0, 1.0, "m")
            check.number("stance", 0.0, 1.0, "m")
            check.number("lift", 0.0, 0.5, "m")
            for field in ("trunk_first", "trunk_second", "arm_yaw", "arm_pitch", "arm_knee"):
                check.number(field, -3.1416, 3.1416, "rad")
            check.number("tail_press", -0.5, 0.5, "m")


FIELDS = tuple(field.name for field in fields(Posture))
"""The numbers of a posture, in order."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Keyed:
    """A sequence of postures with their times; each turns into the next without a jolt."""

    name: str
    """Name, as messages, tables and files show it."""
    times: tuple[float, ...]
    """Time at which each posture is reached, from the beginning of the sequence, increasing from zero [s]."""
    postures: tuple[Posture, ...]
    """The postures."""

    def __post_init__(self) -> None:
        if len(self.times) != len(self.postures) or len(self.times) < 1:
            raise InvalidDesign(
                f"sequence {self.name!r} has {len(self.times)} times for {len(self.postures)} postures; "
                "each posture needs one."
            )
        increasing = all(a < b for a, b in zip(self.times, self.times[1:], strict=False))
        if self.times[0] != 0.0 or not increasing or not np.isfinite(self.times).all():
            raise InvalidDesign(f"sequence {self.name!r} has the times {self.times}; they must increase from 0 s.")

    @property
    def duration(self) -> float:
        """Of the whole sequence [s]."""
        return self.times[-1]

    def reversed(self, name: str, *, slower: float = 1.0) -> "Keyed":
        """Return the course back, ``slower`` times as long."""
        times = tuple(slower * (self.duration - t) for t in reversed(self.times))
        return replace(self, name=name, times=times, postures=tuple(reversed(self.postures)))


class Planned(NamedTuple):
    """A sequence over time: servo angles, and where the body is over the hind feet."""

    targets: Float[np.ndarray, "*batch servo"]
    """Servo angles in the order of ``design.servo_names()`` [rad]."""
    pitch: Float[np.ndarray, "*batch"]
    """Pitch of the pelvis, front end up positive [rad]."""
    feet: Float[np.ndarray, "*batch 3"]
    """Centre of the left hind foot from its hip in the world: outward, forward, down [m]."""
    lead: Float[np.ndarray, "*batch"]
    """Distance by which the centre of mass lies behind the centres of the hind feet [m]."""
    tail: Float[np.ndarray, "*batch"]
    """Distance by which the tip of the tail lies behind the centres of the hind feet [m]."""


def plan(robot: Robot, sequence: Keyed, time: Float[np.ndarray, "*batch"]) -> Planned:
    """Return a sequence at some times.

    In every key the hips are where the centre of mass lies ``lead`` behind the feet. Between two keys they and every
    other number of the posture follow half a cosine, so that the body rests in every key; before the first key and
    after the last one it keeps their postures.

    Args:
        robot: the design.
        sequence: the keys.
        time: since the beginning of the sequence [s].

    Raises:
        OutsideLimits: a hind foot or a joint cannot get there; the message names it.
    """
    check_needs(robot, ARTICLE_BODY, "a sequence of keyed postures")
    keys = np.array([[getattr(p, name) for name in FIELDS] for p in sequence.postures])
    behind = _balance(robot, keys)
    numbers = _eased(np.array(sequence.times), np.column_stack([keys, behind]), time)
    given = _named(numbers)
    angles = _angles(robot, given, numbers[..., -1])
    targets = angles[..., : len(servo_names())].copy()
    targets[..., -1] = 0.0  # the tail is straight, so its cable is
    _check_ranges(robot, targets)
    pitch, behind = given["pelvis_pitch"], numbers[..., -1]
    tip = tail_points(robot, angles[..., layout(robot).behind])[..., -1, :]
    return Planned(
        targets=targets,
        pitch=pitch,
        feet=_feet(robot, given, behind),
        lead=behind - _ahead(pitch, centre_of_mass(robot, angles)),
        tail=behind - _ahead(pitch, tip),
    )


def mass_ahead(robot: Robot, posture: Posture, feet_ahead: float) -> float:
    """Return how far the centre of mass lies ahead of the hips in a posture [m], whatever its own ``lead``.

    Args:
        robot: the design.
        posture: the posture.
        feet_ahead: how far the hind feet are ahead of the hips [m]; a leg that is too short points to its foot.
    """
    given = {name: np.array(getattr(posture, name)) for name in FIELDS}
    angles = _angles(robot, given, np.array(feet_ahead), clip=True)
    return float(_ahead(given["pelvis_pitch"], centre_of_mass(robot, angles)))


def hind_leg(
    leg: LegMeasures, feet: Float[np.ndarray, "*batch 3"], pitch: Float[np.ndarray, "*batch"], *, clip: bool = False
) -> Float[np.ndarray, "*batch 3"]:
    """Return the angles of a hind leg that bring its foot to a point that does not turn with the pelvis.

    Args:
        leg: the hind leg.
        feet: centre of the foot from the hip in the world: outward, forward, down [m].
        pitch: of the pelvis, front end up positive [rad].
        clip: let a leg that is too short point to its foot.

    Raises:
        Unreachable: a foot is out of reach, and ``clip`` is false.
    """
    s, c = np.sin(pitch), np.cos(pitch)
    out, forward, down = np.moveaxis(feet, -1, 0)
    point = np.stack([out, c * forward - s * down, c * down + s * forward], axis=-1)
    if clip:
        far = np.linalg.norm(point, axis=-1, keepdims=True)
        near, most = leg.reach
        point = point * np.clip(far, near + _INSIDE, most - _INSIDE) / np.maximum(far, _INSIDE)
    point[..., 0] += leg.hip_offset
    return leg_kinematics.inverse(leg, point)


def _eased(times: np.ndarray, keys: np.ndarray, time: np.ndarray) -> np.ndarray:
    if len(times) == 1:
        return np.broadcast_to(keys[0], (*time.shape, keys.shape[1]))
    i = np.clip(np.searchsorted(times, time, side="right") - 1, 0, len(times) - 2)
    share = np.clip((time - times[i]) / (times[i + 1] - times[i]), 0.0, 1.0)
    return np.asarray(keys[i] + ((1.0 - np.cos(np.pi * share)) / 2.0)[..., None] * (keys[i + 1] - keys[i]))


def _ahead(pitch: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Return how far a point of the pelvis' frame lies ahead of the hips in the world [m]."""
    return np.asarray(np.cos(pitch) * point[..., 0] - np.sin(pitch) * point[..., 2])


def _balance(robot: Robot, keys: np.ndarray) -> np.ndarray:
    """Return how far behind the feet the hips bring the centre of mass to its place in each key [m].

    The centre of mass moves a little with the hind legs, and the hind legs follow from it: a few rounds agree.
    """
    behind = keys[:, FIELDS.index("lead")]
    for _ in range(SETTLING):
        com = centre_of_mass(robot, _angles(robot, _named(keys), behind, clip=True))
        behind = _ahead(keys[:, FIELDS.index("pelvis_pitch")], com) + keys[:, FIELDS.index("lead")]
    return np.asarray(behind)


def _named(numbers: np.ndarray) -> dict[str, np.ndarray]:
    return dict(zip(FIELDS, np.moveaxis(numbers, -1, 0), strict=False))


def _angles(robot: Robot, given: dict[str, np.ndarray], behind: np.ndarray, *, clip: bool = False) -> np.ndarray:
    """Return the angles of every hinge."""
    angles = np.zeros((*behind.shape, len(joint_names(robot))))
    place = layout(robot)
    for limb in place.limbs[:2]:
        for i, name in enumerate(("arm_yaw", "arm_pitch", "arm_knee")):
            angles[..., limb.hinges.start + i] = given[name]
    try:
        hind = hind_leg(robot.hind_leg, _feet(robot, given, behind), given["pelvis_pitch"], clip=clip)
    except Unreachable as error:
        raise OutsideLimits(
            f"the hind feet of robot {robot.name!r} cannot stay where they are planted: {error} "
            "Lower hip_height, lead or stance."
        ) from error
    for limb in place.limbs[2:]:
        angles[..., limb.hinges] = hind
    for servo, name in zip(place.trunk_pitch, ("trunk_first", "trunk_second"), strict=True):
        angles[..., place.servo_hinges[servo]] = -given[name]
    angles[..., place.behind.start] = np.clip(_tail_pitch(robot, given), *robot.tail.pitch_range)
    return angles


def _feet(robot: Robot, given: dict[str, np.ndarray], behind: np.ndarray) -> np.ndarray:
    down = given["hip_height"] - robot.hind_leg.foot_radius - given["lift"]
    return np.stack([given["stance"], behind, down], axis=-1)


def _tail_pitch(robot: Robot, given: dict[str, np.ndarray]) -> np.ndarray:
    """Return the pitch that brings the tip of a straight tail to its depth [rad]."""
    tail, theta = robot.tail, given["pelvis_pitch"]
    root = given["hip_height"] - tail.offset * np.sin(theta)
    drop = root - tail.radius_tip + given["tail_press"]
    return np.asarray(np.arcsin(np.clip(drop / (tail.length - tail.offset), -1.0, 1.0)) - theta)


def _check_ranges(robot: Robot, targets: np.ndarray) -> None:
    for i, name in enumerate(servo_names()[:-1]):
        low, high = servo_range(robot, name)
        worst = targets[..., i].ravel()[np.argmax(np.maximum(low - targets[..., i], targets[..., i] - high))]
        if not low - 1e-9 <= worst <= high + 1e-9:
            raise OutsideLimits(
                f"a posture asks {name} of robot {robot.name!r} for {worst:.3f} rad; "
                f"{low:.3f} to {high:.3f} rad is allowed."
            )

"""Keyed postures: symmetric postures on planted hind feet, solved for their servo angles.

A posture says where the body is over the hind feet, not what each joint does: how high the hips are, how far the
pelvis is pitched up, and how far the centre of mass lies behind the hind feet. Inverse kinematics finds the rest, so
that the feet stay where they are while one posture turns into the next.
"""

from dataclasses import dataclass, fields, replace
from functools import lru_cache
from math import fsum
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign, OutsideLimits, Unreachable
from suchus.robot.design import STANDING, Hinge, Robot, Rod, Shell, check_needs, layout, servo_ranges
from suchus.robot.design.measures import LegMeasures, leg_of
from suchus.robot.kinematics import leg as leg_kinematics
from suchus.robot.kinematics.tree import centre_of_mass

BALANCE_ITERATIONS = 12
"""Rounds that bring the centre of mass to its place [-]; each leaves a tenth of the error, since the legs are light."""
_REACH_MARGIN = 1e-6  # [m]; distance inside its reach to which a leg is clipped


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
    """Angle by which the trunk's first pitch joint from the root bends the front end up [rad]."""
    trunk_second: float
    """Angle of all others together, evenly shared [rad]; a trunk of one pitch joint bends by both."""
    tail_press: float
    """Depth below the ground at which the tip of the straight tail is commanded [m]: its servo then presses it down."""
    arm_yaw: float
    """Yaw of all limbs but the hind legs, forward positive [rad]."""
    arm_pitch: float
    """Pitch of those limbs, foot down positive [rad]."""
    arm_knee: float
    """Angle of their last pitch joint, elbow or knee, shank down positive [rad]."""

    def __post_init__(self) -> None:
        with Checks("posture", self) as check:
            check.number("hip_height", 1e-4, 100.0, "m")
            check.number("pelvis_pitch", -1.6, 1.6, "rad")
            check.number("lead", -100.0, 100.0, "m")
            check.number("stance", 0.0, 100.0, "m")
            check.number("lift", 0.0, 100.0, "m")
            for field in ("trunk_first", "trunk_second", "arm_yaw", "arm_pitch", "arm_knee"):
                check.number(field, -3.1416, 3.1416, "rad")
            check.number("tail_press", -100.0, 100.0, "m")


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
        """Duration of the whole sequence [s]."""
        return self.times[-1]

    def reversed(self, name: str, *, slower: float = 1.0) -> "Keyed":
        """Return the course back, ``slower`` times as long."""
        times = tuple(slower * (self.duration - t) for t in reversed(self.times))
        return replace(self, name=name, times=times, postures=tuple(reversed(self.postures)))


class PostureSamples(NamedTuple):
    """Postures at some times: servo angles, and where the body is over the hind feet."""

    targets: Float[np.ndarray, "*batch servo"]
    """Servo angles in the order of the layout [rad]."""
    pitch: Float[np.ndarray, "*batch"]
    """Pitch of the pelvis, front end up positive [rad]."""
    feet: Float[np.ndarray, "*batch 3"]
    """Centre of the left hind foot from its hip in the world: outward, forward, down [m]."""
    lead: Float[np.ndarray, "*batch"]
    """Distance by which the centre of mass lies behind the centres of the hind feet [m]."""


class Upright(NamedTuple):
    """The chains of a body that stand, bend and balance when it stands up; places among its hinges."""

    leg: LegMeasures
    """Legs that stand."""
    hips: tuple[float, float, float]
    """Middle of their hips in the frame of the root [m]."""
    standing: tuple[slice, ...]
    """Their hinges."""
    arms: tuple[tuple[int, ...], ...]
    """Yaw, pitch and knee of each other limb, as far as it has them."""
    trunk: tuple[int, ...]
    """Hinges that pitch the trunk, from the root forward."""
    tail: int
    """Hinge that pitches the tail at its root."""
    tail_root: float
    """Distance from the hips back to that hinge [m]."""
    tail_length: float
    """Distance from that hinge to the tip of the straight tail [m]."""
    tail_radius: float
    """Half of the tail's height at its tip, to which its taper is carried on [m]."""
    tail_range: tuple[float, float]
    """Range of that hinge [rad]."""


@lru_cache(maxsize=256)
def upright(robot: Robot) -> Upright:
    """Return the chains by which a body stands up.

    Raises:
        UnsuitedRobot: it lacks one of them.
    """
    check_needs(robot, STANDING, "standing up on hind legs and tail")
    place, hind, root = layout(robot), robot.girdles[-1], robot.axis[robot.root_index]
    leg = leg_of(hind)
    assert leg is not None
    pitching = next(hinge for hinge in root.hinges if hinge.turn == "pitch" and hinge.servo is not None)
    tail_segments = robot.axis[robot.root_index + 1 :]
    lengths = [segment.front + segment.rear for segment in tail_segments]
    radii = [max(_half_height(shape) for shape in segment.shapes) for segment in tail_segments]
    centers = [fsum(lengths[:i]) + length / 2 for i, length in enumerate(lengths)]
    taper = (radii[-1] - radii[0]) / (centers[-1] - centers[0]) if len(tail_segments) > 1 else 0.0
    number = place.hinges.index(pitching.name)
    return Upright(
        leg=leg,
        hips=(hind.at, 0.0, hind.above),
        standing=tuple(limb.hinges for limb in place.limbs[-2:]),
        arms=tuple(_arm(limb.hinges.start, limb.girdle.limb.hinges) for limb in place.limbs[:-2]),
        trunk=tuple(place.servo_hinges[servo] for servo in place.trunk_pitch),
        tail=number,
        tail_root=root.rear + hind.at,
        tail_length=fsum(lengths),
        tail_radius=max(radii[-1] + taper * lengths[-1] / 2, 0.0),
        tail_range=pitching.range or (-np.inf, np.inf),
    )


def belly(robot: Robot) -> float:
    """Return the depth of the lowest point of the trunk below the hips [m].

    The trunk is what lies behind the front girdle's segment, up to the root and with it.
    """
    names = [segment.name for segment in robot.axis]
    trunk = robot.axis[names.index(robot.girdles[0].segment) + 1 : robot.root_index + 1] or (
        robot.axis[robot.root_index],
    )
    return max(shape.bottom for segment in trunk for shape in segment.shapes) + robot.girdles[-1].above


def _half_height(shape: Rod | Shell) -> float:
    return shape.radius if isinstance(shape, Rod) else shape.half[2]


def _arm(first_index: int, hinges: tuple[Hinge, ...]) -> tuple[int, ...]:
    """Return where the first yaw, the first pitch and the last other pitch hinge of a limb are among all hinges."""
    yaws, pitches = (
        [first_index + i for i, hinge in enumerate(hinges) if hinge.turn == turn] for turn in ("yaw", "pitch")
    )
    return (yaws[0], pitches[0], pitches[-1]) if yaws and len(pitches) > 1 else ()


def sample_postures(robot: Robot, sequence: Keyed, time: Float[np.ndarray, "*batch"]) -> PostureSamples:
    """Return the postures of a sequence at some times, solved for their servo angles.

    At each keyed posture the hips are where the centre of mass lies ``Posture.lead`` behind the feet. Between two
    of them every number follows half a cosine, so that the body rests in each; before the first and after the last
    one it keeps their postures.

    Args:
        robot: the design.
        sequence: keyed postures with their times.
        time: time since the beginning of the sequence, any shape [s].

    Raises:
        OutsideLimits: a hind foot or a joint cannot get there; the message names it.
    """
    chains, robot_layout = upright(robot), layout(robot)
    keys = np.array([[getattr(posture, name) for name in FIELDS] for posture in sequence.postures])
    interpolated = _interpolate(
        np.array(sequence.times), np.column_stack([keys, _balanced_feet_forward(robot, keys)]), time
    )
    fields_by_name, feet_forward = _fields_by_name(interpolated), interpolated[..., -1]
    hinge_angles = _angles(robot, fields_by_name, feet_forward)
    targets = np.zeros((*hinge_angles.shape[:-1], len(robot_layout.servos)))  # the tail is straight, and so are cables
    direct_servos = [servo for servo, hinge in enumerate(robot_layout.servo_hinges) if hinge >= 0]
    targets[..., direct_servos] = hinge_angles[..., [robot_layout.servo_hinges[servo] for servo in direct_servos]]
    _check_ranges(robot, targets)
    pitch = fields_by_name["pelvis_pitch"]
    return PostureSamples(
        targets=targets,
        pitch=pitch,
        feet=_feet(chains.leg, fields_by_name, feet_forward),
        lead=feet_forward - _forward_in_world(pitch, centre_of_mass_from_hips(robot, hinge_angles)),
    )


def centre_of_mass_forward_of_hips(robot: Robot, posture: Posture, feet_ahead: float) -> float:
    """Return how far the centre of mass lies ahead of the hips in a posture [m], whatever its own ``lead``.

    Args:
        robot: the design.
        posture: the posture.
        feet_ahead: how far the hind feet are ahead of the hips [m]; a leg that is too short points to its foot.
    """
    parameters = {name: np.array(getattr(posture, name)) for name in FIELDS}
    angles = _angles(robot, parameters, np.array(feet_ahead), clip=True)
    return float(_forward_in_world(parameters["pelvis_pitch"], centre_of_mass_from_hips(robot, angles)))


def hind_leg(
    leg: LegMeasures, feet: Float[np.ndarray, "*batch 3"], pitch: Float[np.ndarray, "*batch"], *, clip: bool = False
) -> Float[np.ndarray, "*batch 3"]:
    """Return the angles of a hind leg that bring its foot to a point that does not turn with the pelvis.

    Args:
        leg: the hind leg.
        feet: centre of the foot from the hip in the world: outward, forward, down [m].
        pitch: pitch angle of the pelvis, front end up positive [rad].
        clip: let a leg that is too short point to its foot.

    Raises:
        Unreachable: a foot is out of reach, and ``clip`` is false.
    """
    s, c = np.sin(pitch), np.cos(pitch)
    outward, forward, down = np.moveaxis(feet, -1, 0)
    point = np.stack([outward, c * forward - s * down, c * down + s * forward], axis=-1)
    if clip:
        distance = np.linalg.norm(point, axis=-1, keepdims=True)
        min_reach, max_reach = leg.reach
        point = (
            point
            * np.clip(distance, min_reach + _REACH_MARGIN, max_reach - _REACH_MARGIN)
            / np.maximum(distance, _REACH_MARGIN)
        )
    point[..., 0] += leg.hip_offset
    return leg_kinematics.inverse(leg, point)


def _interpolate(times: np.ndarray, keys: np.ndarray, time: np.ndarray) -> np.ndarray:
    """Return the numbers of a sequence at some times, half a cosine from each key to the next, shape (*batch, number).

    Args:
        times: times of the keys [s].
        keys: numbers of the posture at each key, shape (key, number).
        time: time since the beginning of the sequence [s].
    """
    if len(times) == 1:
        return np.broadcast_to(keys[0], (*time.shape, keys.shape[1]))
    i = np.clip(np.searchsorted(times, time, side="right") - 1, 0, len(times) - 2)
    fraction = np.clip((time - times[i]) / (times[i + 1] - times[i]), 0.0, 1.0)
    return np.asarray(keys[i] + ((1.0 - np.cos(np.pi * fraction)) / 2.0)[..., None] * (keys[i + 1] - keys[i]))


def centre_of_mass_from_hips(robot: Robot, angles: Float[np.ndarray, "*batch hinge"]) -> Float[np.ndarray, "*batch 3"]:
    """Return the centre of mass from the middle of the hips, in the frame of the root [m]."""
    return centre_of_mass(robot, angles) - np.array(upright(robot).hips)


def _forward_in_world(pitch: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Return how far a point of the root's frame, from the hips, lies ahead of them in the world [m]."""
    return np.asarray(np.cos(pitch) * point[..., 0] - np.sin(pitch) * point[..., 2])


def _balanced_feet_forward(robot: Robot, keys: np.ndarray) -> np.ndarray:
    """Return how far ahead of the hips the feet must be at each key for its ``Posture.lead``, shape (key,) [m].

    The centre of mass moves a little with the hind legs, and the hind legs follow from it: a few rounds agree.

    Args:
        robot: the design.
        keys: numbers of the posture at each key, shape (key, number).
    """
    feet_forward = keys[:, FIELDS.index("lead")]
    for _ in range(BALANCE_ITERATIONS):
        com = centre_of_mass_from_hips(robot, _angles(robot, _fields_by_name(keys), feet_forward, clip=True))
        feet_forward = _forward_in_world(keys[:, FIELDS.index("pelvis_pitch")], com) + keys[:, FIELDS.index("lead")]
    return np.asarray(feet_forward)


def _fields_by_name(parameters: np.ndarray) -> dict[str, np.ndarray]:
    return dict(zip(FIELDS, np.moveaxis(parameters, -1, 0), strict=False))


def _angles(
    robot: Robot, parameters: dict[str, np.ndarray], feet_forward: np.ndarray, *, clip: bool = False
) -> np.ndarray:
    """Return the angles of every hinge, shape (*batch, hinge) [rad].

    Args:
        robot: the design.
        parameters: numbers of the posture by name, see ``Posture``.
        feet_forward: how far the hind feet are ahead of the hips [m].
        clip: let a leg that is too short point to its foot.
    """
    chains = upright(robot)
    angles = np.zeros((*feet_forward.shape, len(layout(robot).hinges)))
    for arm in chains.arms:
        for hinge, name in zip(arm, ("arm_yaw", "arm_pitch", "arm_knee"), strict=False):
            angles[..., hinge] = parameters[name]
    try:
        legs = hind_leg(chains.leg, _feet(chains.leg, parameters, feet_forward), parameters["pelvis_pitch"], clip=clip)
    except Unreachable as error:
        raise OutsideLimits(
            f"the hind feet of robot {robot.name!r} cannot stay where they are planted: {error} "
            "Lower hip_height, lead or stance."
        ) from error
    for hinges in chains.standing:
        angles[..., hinges] = legs
    angles[..., list(chains.trunk)] = trunk_angles(chains, parameters["trunk_first"], parameters["trunk_second"])
    angles[..., chains.tail] = np.clip(
        tail_down(chains, parameters["hip_height"], parameters["pelvis_pitch"], parameters["tail_press"]),
        *chains.tail_range,
    )
    return angles


def trunk_angles(
    chains: Upright, first_angle: Float[np.ndarray, "*batch"], second_angle: Float[np.ndarray, "*batch"]
) -> Float[np.ndarray, "*batch hinge"]:
    """Return the angles of the trunk's pitch hinges, from the root forward [rad]; see ``Posture.trunk_second``.

    Args:
        chains: chains of the body.
        first_angle: angle of the first hinge, front end up positive [rad].
        second_angle: angle of all other hinges together, front end up positive [rad].
    """
    other_count = len(chains.trunk) - 1
    return np.stack(
        [-first_angle, *other_count * [-second_angle / other_count]] if other_count else [-first_angle - second_angle],
        axis=-1,
    )


def tail_down(
    chains: Upright,
    height: Float[np.ndarray, "*batch"],
    pitch: Float[np.ndarray, "*batch"],
    press: Float[np.ndarray, "*batch"] | float,
) -> Float[np.ndarray, "*batch"]:
    """Return the pitch of a straight tail that brings its tip to a depth below the ground [rad].

    Args:
        chains: chains of the body.
        height: height of the hips above the ground [m].
        pitch: pitch angle of the pelvis, front end up positive [rad].
        press: the depth [m].
    """
    root = height - chains.tail_root * np.sin(pitch) - chains.hips[2] * np.cos(pitch)
    drop = root - chains.tail_radius + press
    return np.asarray(np.arcsin(np.clip(drop / chains.tail_length, -1.0, 1.0)) - pitch)


def _feet(leg: LegMeasures, parameters: dict[str, np.ndarray], feet_forward: np.ndarray) -> np.ndarray:
    down = parameters["hip_height"] - leg.foot_radius - parameters["lift"]
    return np.stack([parameters["stance"], feet_forward, down], axis=-1)


def _check_ranges(robot: Robot, targets: np.ndarray) -> None:
    """Refuse servo angles outside the range of a joint."""
    for i, (name, (lower_bound, upper_bound)) in enumerate(zip(layout(robot).servos, servo_ranges(robot), strict=True)):
        worst_angle = targets[..., i].ravel()[
            np.argmax(np.maximum(lower_bound - targets[..., i], targets[..., i] - upper_bound))
        ]
        if not lower_bound - 1e-9 <= worst_angle <= upper_bound + 1e-9:
            raise OutsideLimits(
                f"a posture asks {name} of robot {robot.name!r} for {worst_angle:.3f} rad; "
                f"{lower_bound:.3f} to {upper_bound:.3f} rad is allowed."
            )

"""Gaits that a search found for the limit study of galloping; they are not in the catalog of gaits."""

from dataclasses import dataclass, replace
from typing import Any

from suchus.core.checks import Checks
from suchus.robot.gaits.belly_crawl import LIMBS
from suchus.robot.motion import Bend, Gait, GaitInMetres, as_table
from suchus.robot.robots import ROBOTS

_SAMPLES = 32  # [-]; samples of a cycle in the search


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchedGait:
    """A gait that a search found for one kind of servo."""

    servo_speed: float
    """No-load speed of the servos with which it was searched [rad/s]."""
    gait: Gait
    """The gait."""

    def __post_init__(self) -> None:
        with Checks("searched", self) as check:
            check.number("servo_speed", 0.1, 1e3, "rad/s")


def _searched_gait(
    servo_speed: float,
    name: str,
    *,
    foot_offsets: tuple[float, float],
    trunk: tuple[float, float, float],
    yaw: tuple[float, float],
    **feet: Any,
) -> SearchedGait:
    """Return a gait whose trunk also bends vertically; its other joints follow smooth curves, as in the search.

    Args:
        servo_speed: no-load speed of the servos with which it was searched [rad/s].
        name: name of the gait.
        foot_offsets: offsets of the front and the hind feet ahead of their hips [m].
        trunk: mean [rad] and amplitude [rad] of the trunk's vertical bend, down positive, and the phase in the cycle at
            which it is bent down most [cycle].
        yaw: amplitude [rad] and phase [cycle] of its lateral bend.
        **feet: further arguments of ``GaitInMetres`` for the feet and the tail.
    """
    metres = GaitInMetres(
        name=name,
        front_reach=0.0,
        hind_reach=0.0,
        front_ahead=foot_offsets[0],
        hind_ahead=foot_offsets[1],
        legs="erect",
        trunk_bend=yaw[0],
        spine_phase=yaw[1],
        tail_bend=0.0,
        tail_phase=0.0,
        **feet,
    )
    mean, amplitude, down_phase = trunk
    lag = down_phase + 0.5 - (0.75 - metres.duty_factor / 2)  # the phase of the axis counts from before mid-stance
    vertical = Bend(part="trunk", turn="pitch", amplitude=(amplitude,), lag=(lag,), offset=mean)
    # in a bound left and right cancel in the article's coupling law, so the trunk follows the gait's own phases
    curves = as_table(ROBOTS["caiman"], metres.gait(LIMBS), _SAMPLES)
    gait = replace(curves, axis=(vertical,), coupling=() if amplitude else curves.coupling)
    return SearchedGait(servo_speed=servo_speed, gait=gait)


BOUNDS = (
    _searched_gait(
        7.0,
        "bound",
        period=0.1896,
        duty_factor=0.3416,
        limb_phases=(0.0, 0.0, 0.5393, 0.5393),
        stroke=0.0409,
        lift=0.0466,
        foot_offsets=(-0.0079, -0.0065),
        hip_height=0.1448,
        tail_pitch=0.145,
        trunk=(0.069, 0.4674, -0.1018),
        yaw=(0.0, 0.0),
    ),
    _searched_gait(
        60.0,
        "bound",
        period=0.2002,
        duty_factor=0.4359,
        limb_phases=(0.0, 0.0, 0.4196, 0.4196),
        stroke=0.0497,
        lift=0.0442,
        foot_offsets=(0.0094, -0.0045),
        hip_height=0.1307,
        tail_pitch=0.0617,
        trunk=(0.3, 0.3691, -0.0255),
        yaw=(0.0, 0.0),
    ),
)
"""Bounds with flight, for servos of 7 and 60 rad/s: some 400 gaits were tried for each, 24 in a generation."""
TROTS = (
    _searched_gait(
        7.0,
        "trot",
        period=0.1805,
        duty_factor=0.3615,
        limb_phases=(0.0, 0.5, 0.4742, -0.0258),
        stroke=0.0465,
        lift=0.0292,
        foot_offsets=(-0.0183, -0.0175),
        hip_height=0.1401,
        tail_pitch=0.5,
        trunk=(-0.0894, 0.0, 0.0),
        yaw=(0.6177, -0.1095),
    ),
    _searched_gait(
        60.0,
        "trot",
        period=0.185,
        duty_factor=0.3728,
        limb_phases=(0.0, 0.5, 0.4638, -0.0362),
        stroke=0.0545,
        lift=0.0209,
        foot_offsets=(-0.0374, -0.0111),
        hip_height=0.1337,
        tail_pitch=0.3551,
        trunk=(0.0937, 0.0, 0.0),
        yaw=(0.0237, 0.1875),
    ),
)
"""Trots that bend the trunk sideways, for servos of 7 and 60 rad/s, found by the same search."""

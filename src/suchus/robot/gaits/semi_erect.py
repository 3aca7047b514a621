"""The semi-erect walk: feet half under the body, hips that yaw and lift, a trunk that swings along."""

from math import radians

from suchus.robot.design import Assumption
from suchus.robot.gaits.belly_crawl import FRONT, HIND, LIMBS
from suchus.robot.motion import GaitInMetres

gait = GaitInMetres(
    name="semi_erect",
    period=1.0,
    duty_factor=0.6,
    limb_phases=(0.0, 0.5, 0.44, -0.06),
    stroke=0.042,
    lift=0.040,
    front_reach=0.055,
    hind_reach=0.060,
    front_ahead=-0.035,
    hind_ahead=0.020,
    legs="sprawled",
    hip_height=0.118,
    trunk_bend=radians(30),
    spine_phase=0.0,
    tail_bend=radians(13),
    tail_phase=0.0,
    tail_pitch=0.38,
).gait(LIMBS)
"""A walking trot between crawl and high walk."""
trunk_steering = {"caiman": 0.44}
"""Change of heading per cycle over a curvature offset of the trunk, by robot [rad/rad]."""

_HIND_LAG_REASON = (
    "after its diagonal front foot, a trot within an eighth of a cycle; 0.19 earlier costs a quarter of the speed"
)
_ROWS: tuple[tuple[str, float, float, str], ...] = (
    ("period", 0.9, 2.0, "0.24 m/s at 1 s, 0.12 m/s at 2 s; in shorter ones knees reach what their servos can give"),
    ("limb_phases[0]", 0.0, 0.0, "phases count from the left front foot"),
    ("limb_phases[1]", 0.5, 0.5, "left and right alternate, as in the article's diagonal gait"),
    ("limb_phases[2]", 0.375, 0.5, _HIND_LAG_REASON),
    ("limb_phases[3]", -0.125, 0.0, _HIND_LAG_REASON),
    ("duty_factor", 0.55, 0.65, "a walk without flight whose swing stays within 7 rad/s"),
    ("stroke", 0.033 / FRONT, 0.045 / FRONT, "longer ones ask more speed of the knee than its servo has"),
    (
        "lift",
        0.02 / FRONT,
        0.05 / FRONT,
        "lifting by 40 mm keeps the distance on bumps; on even ground it costs power alone",
    ),
    (
        "limbs[0].outward",
        0.035 / FRONT,
        0.06 / FRONT,
        "a track of 0.24 m: wide enough not to roll, narrow enough to carry the body high",
    ),
    (
        "limbs[1].outward",
        0.045 / HIND,
        0.07 / HIND,
        "a track of 0.26 m: wide enough not to roll, narrow enough to carry the body high",
    ),
    ("limbs[0].ahead", -0.05 / FRONT, -0.02 / FRONT, "behind the hip, which turns the elbow back"),
    ("limbs[1].ahead", 0.02 / HIND, 0.05 / HIND, "ahead of the hip, which turns the knee forward"),
    ("height", 0.11 / HIND, 0.13 / HIND, "70 mm of clearance below the belly"),
    ("trunk_bend", 0.17, 0.7, "more bend adds stride; with much the heading wanders"),
    ("axis_lag", -0.15, 0.15, "zero carries each girdle's swing foot farthest ahead at touch-down"),
    ("tail_bend", 0.0, 0.52, "it changes speed by less than 2 %"),
    ("tail_lag", 0.5, 1.0, "against the trunk, which keeps the heading best"),
    ("tail_pitch", 0.3, 0.4, "the tail carries some weight and keeps the body from rolling"),
)
chosen = tuple(
    Assumption(field=field, low=lower_bound, high=upper_bound, why=reason)
    for field, lower_bound, upper_bound, reason in _ROWS
)
"""The article gives no number of it: every number with its plausible range and the reason."""

"""The article's crawl: a diagonal gait whose trunk swings with the legs and whose tail drags and swings."""

from math import radians

from suchus.article.paper import CYCLE_PERIOD
from suchus.robot.design import Assumption
from suchus.robot.motion import GaitInMetres

LIMBS = (0.1575, 0.175)
"""Lengths of the front and hind limbs for which the metres of the crawls are, those of the robot ``caiman`` [m]."""
FRONT, HIND = LIMBS

metres = GaitInMetres(
    name="belly_crawl",
    period=CYCLE_PERIOD,
    duty_factor=0.5,
    limb_phases=(0.0, 0.5, 0.5, 0.0),
    stroke=0.027,
    lift=0.025,
    front_reach=0.085,
    hind_reach=0.100,
    front_ahead=0.0,
    hind_ahead=0.0,
    legs="sprawled",
    hip_height=0.090,
    trunk_bend=radians(70),
    spine_phase=0.0,
    tail_bend=radians(45),
    tail_phase=0.0,
    tail_pitch=0.2,
)
"""The crawl in metres."""
gait = metres.gait(LIMBS)
"""Spine and tail take part."""
made_for = ("caiman", "floating_caiman", "long_tail")
"""Robots of the catalog whose gait it is."""
trunk_steering = {"caiman": 0.08, "floating_caiman": 0.08, "long_tail": 0.34}
"""Change of heading per cycle over a curvature offset of the trunk, by robot [rad/rad]."""

_FIT_REASON = (
    "leg stroke and trunk bend are the two numbers chosen so that both displacements come out as printed, "
    "all else being equal; the map of their ratio shows what other values give"
)
_MISSING_FIGURE = "Fig. 12 is lost; "
_ROWS: tuple[tuple[str, float, float, str], ...] = (
    ("duty_factor", 0.5, 0.75, "a diagonal walk without flight"),
    ("stroke", 0.0, 0.1 / FRONT, _FIT_REASON),
    ("trunk_bend", 0.0, 1.75, _FIT_REASON),
    (
        "axis_lag",
        -0.15,
        0.15,
        _MISSING_FIGURE + "zero carries each girdle's swing foot farthest ahead at touch-down",
    ),
    ("lift", 0.015 / FRONT, 0.05 / FRONT, "clears the sag of the diagonal pair under load"),
    ("limbs[0].outward", 0.07 / FRONT, 0.11 / FRONT, "the shank stands upright in mid-stance"),
    ("limbs[1].outward", 0.08 / HIND, 0.12 / HIND, "the shank stands upright in mid-stance; the hind leg is longer"),
    ("limbs[0].ahead", -0.03 / FRONT, 0.03 / FRONT, "the foot's path is centred on the hip"),
    ("limbs[1].ahead", -0.03 / HIND, 0.03 / HIND, "the foot's path is centred on the hip"),
    ("height", 0.07 / HIND, 0.12 / HIND, "level femur and upright shank, the sprawl of the article's Fig. 3a"),
    ("tail_bend", 0.0, 1.2, _MISSING_FIGURE + "it changes the displacement by less than 0.03 m"),
    ("tail_lag", 0.5, 1.0, _MISSING_FIGURE + "against the trunk, which keeps the heading best"),
    ("tail_pitch", 0.1, 0.3, "the tail drags without lifting the hind feet"),
)
chosen = tuple(
    Assumption(field=field, low=lower_bound, high=upper_bound, why=reason)
    for field, lower_bound, upper_bound, reason in _ROWS
)
"""Every number of the gait that the article does not give, with its plausible range and the reason."""

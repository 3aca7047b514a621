"""The high walk: erect legs under the body, elbows behind and knees ahead, the tail dragging as a third leg."""

from math import radians

from suchus.robot.design import Assumption
from suchus.robot.gaits.belly_crawl import FRONT, HIND, LIMBS
from suchus.robot.motion import GaitInMetres

gait = GaitInMetres(
    name="high_walk",
    period=1.4,
    duty_factor=0.68,
    limb_phases=(0.0, 0.5, 0.44, -0.06),
    stroke=0.040,
    lift=0.040,
    front_reach=0.0,
    hind_reach=0.0,
    front_ahead=-0.035,
    hind_ahead=-0.015,
    legs="erect",
    hip_height=0.142,
    trunk_bend=radians(10),
    spine_phase=0.0,
    tail_bend=radians(21),
    tail_phase=0.0,
    tail_pitch=0.40,
).gait(LIMBS)
"""A walking trot, each hind foot a little after its diagonal front foot."""
trunk_steering = {"caiman": 0.45}
"""Change of heading per cycle over a curvature offset of the trunk, by robot [rad/rad]."""

_HIND_LAG_REASON = "after its diagonal front foot, a trot within an eighth of a cycle: the body rolls less"
_ROWS: tuple[tuple[str, float, float, str], ...] = (
    (
        "period",
        1.3,
        2.4,
        "0.11 m/s at 1.4 s, 0.06 m/s at 2.4 s; in shorter ones knees reach what their servos can give",
    ),
    ("limb_phases[0]", 0.0, 0.0, "phases count from the left front foot"),
    ("limb_phases[1]", 0.5, 0.5, "left and right alternate, as in the article's diagonal gait"),
    ("limb_phases[2]", 0.375, 0.5, _HIND_LAG_REASON),
    ("limb_phases[3]", -0.125, 0.0, _HIND_LAG_REASON),
    ("duty_factor", 0.65, 0.72, "with less the body rolls more; longer stance asks for faster swings"),
    ("stroke", 0.033 / FRONT, 0.045 / FRONT, "longer ones ask more speed of the knee than its servo has"),
    ("lift", 0.022 / FRONT, 0.045 / FRONT, "clears bumps of 40 mm up and down; on even ground it costs power alone"),
    ("limbs[0].outward", 0.0, 0.0, "erect feet stand below their hips"),
    ("limbs[1].outward", 0.0, 0.0, "erect feet stand below their hips"),
    (
        "limbs[0].ahead",
        -0.04 / FRONT,
        -0.016 / FRONT,
        "feet a little behind the hips, so that the body rolls less",
    ),
    ("limbs[1].ahead", -0.03 / HIND, -0.012 / HIND, "feet a little behind the hips"),
    (
        "height",
        0.135 / HIND,
        0.147 / HIND,
        "the front leg, which is shorter, reaches all of its stroke with a bent knee",
    ),
    ("trunk_bend", 0.0, 0.35, "an alligator's trunk bends little in the high walk; more bend adds little speed"),
    ("axis_lag", -0.15, 0.15, "zero carries each girdle's swing foot farthest ahead at touch-down"),
    ("tail_bend", 0.0, 0.4, "against the trunk, which keeps the heading best"),
    ("tail_lag", 0.5, 1.0, "against the trunk, which keeps the heading best"),
    (
        "tail_pitch",
        0.35,
        0.45,
        "the tail carries some weight: lifted, the body rolls more and loses speed",
    ),
)
chosen = tuple(
    Assumption(field=field, low=lower_bound, high=upper_bound, why=reason)
    for field, lower_bound, upper_bound, reason in _ROWS
)
"""The article shows the posture and gives no number: every number with its plausible range and the reason."""

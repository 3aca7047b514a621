"""A crawl with the belly just above the ground, twice as fast as the article's: sprawled legs, a swinging trunk."""

from dataclasses import replace

from suchus.robot.design import Assumption
from suchus.robot.gaits import belly_crawl
from suchus.robot.gaits.belly_crawl import FRONT, HIND, LIMBS

gait = replace(belly_crawl.metres, name="low_crawl", period=2.0, stroke=0.050, lift=0.030, hip_height=0.055).gait(LIMBS)
"""Between belly and ground are 20 mm."""
trunk_steering = {"caiman": 0.31}
"""Change of heading per cycle over a curvature offset of the trunk, by robot [rad/rad]."""

_OWN_RANGES = {
    "period": (1.2, 3.0, "0.35 m/s at 1.2 s, 0.14 m/s at 3 s; the body rolls by 8 degrees throughout"),
    "stroke": (0.03 / FRONT, 0.06 / FRONT, "long enough for 0.2 m/s, short enough to stay within reach"),
    "lift": (0.02 / FRONT, 0.05 / FRONT, "clears the sag of the diagonal pair under load"),
    "height": (
        0.05 / HIND,
        0.07 / HIND,
        "the belly clears even ground and touches bumps: what a crocodile's crawl looks like",
    ),
}
chosen = (
    *(
        Assumption(field=field, low=lower_bound, high=upper_bound, why=reason)
        for field, (lower_bound, upper_bound, reason) in _OWN_RANGES.items()
    ),
    *(entry for entry in belly_crawl.chosen if entry.field not in _OWN_RANGES),
)
"""Every number of the gait that the article does not give, with its plausible range and the reason."""

"""A crawl with the belly just above the ground, twice as fast as the article's: sprawled legs, a swinging trunk."""

from dataclasses import replace

from suchus.design import Chosen
from suchus.gaits import belly_crawl

gait = replace(belly_crawl.gait, name="low_crawl", period=2.0, stroke=0.050, lift=0.030, hip_height=0.055)
"""Between belly and ground are 20 mm."""

_OWN = {
    "stroke": (0.03, 0.06, "long enough for 0.2 m/s, short enough to stay within reach"),
    "lift": (0.02, 0.05, "clears the sag of the diagonal pair under load"),
    "hip_height": (0.05, 0.07, "the belly clears even ground and touches bumps: what a crocodile's crawl looks like"),
}
chosen = tuple(
    Chosen(field=c.field, low=_OWN[c.field][0], high=_OWN[c.field][1], why=_OWN[c.field][2]) if c.field in _OWN else c
    for c in belly_crawl.chosen
)
"""Every number of the gait that the article does not give, with its plausible range and the reason."""

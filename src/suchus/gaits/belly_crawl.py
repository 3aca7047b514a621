"""The article's crawl: a diagonal gait whose trunk swings with the legs and whose tail drags and swings."""

from math import radians

from suchus.design import Chosen
from suchus.motion import Gait
from suchus.paper import CYCLE_PERIOD

gait = Gait(
    name="belly_crawl",
    period=CYCLE_PERIOD,
    duty_factor=0.5,
    limb_phases=(0.0, 0.5, 0.5, 0.0),
    stroke=0.025,
    lift=0.025,
    front_reach=0.085,
    hind_reach=0.100,
    hip_height=0.090,
    trunk_bend=radians(65),
    spine_phase=0.0,
    tail_bend=radians(60),
    tail_phase=0.5,
    tail_pitch=0.2,
)
"""Spine and tail take part."""

chosen: tuple[Chosen, ...] = ()

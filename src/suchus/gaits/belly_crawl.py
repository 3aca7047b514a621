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
    stroke=0.027,
    lift=0.025,
    front_reach=0.085,
    hind_reach=0.100,
    hip_height=0.090,
    trunk_bend=radians(70),
    spine_phase=0.0,
    tail_bend=radians(45),
    tail_phase=0.0,
    tail_pitch=0.2,
)
"""Spine and tail take part."""

_FITTED = (
    "Not in the paper; leg stroke and trunk bend are the two numbers that were chosen so that the two displacements come "
    "out as printed, with everything else the same in both. The map of the ratio shows what other values give."
)
chosen: tuple[Chosen, ...] = (
    Chosen(field="duty_factor", low=0.5, high=0.75, why="Not in the paper; a diagonal walk with no flight."),
    Chosen(field="stroke", low=0.0, high=0.1, why=_FITTED),
    Chosen(field="trunk_bend", low=0.0, high=1.75, why=_FITTED),
    Chosen(
        field="spine_phase",
        low=-0.15,
        high=0.15,
        why="Not in the paper (Fig. 12 is lost); zero carries each girdle's swing foot farthest ahead at touch-down.",
    ),
    Chosen(field="lift", low=0.015, high=0.05, why="Not in the paper; clears the sag of the diagonal pair's load."),
    Chosen(field="front_reach", low=0.07, high=0.11, why="Not in the paper; the shank stands upright in mid-stance."),
    Chosen(field="hind_reach", low=0.08, high=0.12, why="Not in the paper; wider than in front, as the hip is higher up."),
    Chosen(
        field="hip_height",
        low=0.07,
        high=0.12,
        why="Not in the paper; the femur is level and the shank upright, the sprawl of the article's Fig. 3a.",
    ),
    Chosen(
        field="tail_bend",
        low=0.0,
        high=1.2,
        why="Not in the paper (Fig. 12 is lost); changes the displacement by less than 0.03 m.",
    ),
    Chosen(
        field="tail_phase",
        low=0.0,
        high=0.5,
        why="Not in the paper (Fig. 12 is lost); against the trunk, which keeps the heading best.",
    ),
    Chosen(
        field="tail_pitch",
        low=0.1,
        high=0.3,
        why="Not in the paper; the tail drags without lifting the hind feet (prototype: best at 0.2 to 0.3 rad).",
    ),
)
"""Every number of the gait that the article does not give."""

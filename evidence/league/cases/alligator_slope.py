"""An alligator on slopes of 15 degrees: does the same walk go as fast uphill and downhill, and how is it pushed?"""

from collections.abc import Sequence
from functools import lru_cache, partial
from math import radians

import numpy as np

from evidence.league import Contestant, Found, Given, Numbers, Predictor, Quantity, SingleContestant
from suchus.core.progress import Progress, portion
from suchus.robot.design import GRAVITY, Robot, with_values
from suchus.robot.design.ground import Ground
from suchus.robot.design.scale import rescale
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import ground_force, speed, time_window

_SLOPE = radians(15.0)
_CYCLES = 4


@lru_cache(maxsize=64)
def _body(length: float, friction: float) -> Robot:
    caiman = with_values(ROBOTS["caiman"], {"contact.foot_friction": friction})
    return rescale(caiman, length_factor=length / caiman.length)


def walked(gait: str, choices: Sequence[Numbers], progress: Progress) -> list[Found]:
    """Return speeds uphill and downhill over that on the level, and the pushes along the slope over the weight."""
    return [_walk(gait, one, portion(progress, i, len(choices))) for i, one in enumerate(choices)]


def _walk(gait: str, numbers: Numbers, progress: Progress) -> Found:
    robot = _body(numbers["length"], numbers["friction"])
    walk = rescale(GAITS[gait], length_factor=numbers["length"] / ROBOTS["caiman"].length)
    runs = [
        Run(robot=robot, gait=walk, ground=Ground(uphill=slope), label=f"{slope:g} rad")
        for slope in (0.0, _SLOPE, -_SLOPE)
    ]
    start = START * walk.period / GAITS[gait].period
    end = start + _CYCLES * walk.period
    record = simulate(runs, duration=end + 0.1 * walk.period, progress=progress)
    speeds, part = speed(record, start, end).values, time_window(record, start, end)
    along = ground_force(part)
    pushes = along.sel(xyz="x").mean("time").values / (robot.mass * GRAVITY)
    if not (np.isfinite(speeds).all() and speeds[0] > 0.0):
        return {}
    return {
        "speed_up": float(speeds[1] / speeds[0]), "speed_down": float(speeds[2] / speeds[0]),
        "push_up": float(pushes[1]), "push_down": float(pushes[2]),
    }  # fmt: skip


contestant = SingleContestant(
    Contestant(
        name="alligator_slope",
        title="An alligator walks up and down 15 degrees",
        description="The article's robot, whose length and mass are those of a young alligator, in its high walk and "
        "its belly "
        "crawl on an even slope of 15 degrees, up, down and level, with the same motion of all joints.",
        inputs={
            "length": Given(
                value=1.0,
                low=0.46,
                high=1.27,
                unit="m",
                source="total length 0.46 to 1.27 m, mass 0.3 to 5.6 kg (JEB 224, jeb242990, abstract): the "
                "robot of 1 m "
                "and 3.5 kg with the cube of its length",
            ),
            "friction": Given(
                value=0.8,
                low=0.5,
                high=1.1,
                unit="-",
                source="feet on the trackway: not published; dry skin and claws on a rough board",
            ),
        },
        predicts={
            "speed_up": Quantity(unit="-", words="speed uphill over that on the level"),
            "speed_down": Quantity(unit="-", words="speed downhill over that on the level"),
            "push_up": Quantity(unit="-", words="mean push of the ground along the slope, uphill, over the weight"),
            "push_down": Quantity(unit="-", words="the same downhill, forward positive"),
        },
        rungs={
            gait: Predictor(words=f"rigid bodies with contacts, {words}", work=partial(walked, gait), draws=12)
            for gait, words in (("high_walk", "the high walk"), ("belly_crawl", "the belly crawl"))
        },
        excluded_models={"theories of swimming, slice, space": "it walks"},
    )
)

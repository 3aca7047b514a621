"""An alligator on slopes of 15 degrees: at which cadence does it hold its speed, and how is it pushed?"""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache, partial
from math import radians

import numpy as np

from evidence.league import Contestant, Found, Given, Numbers, Predictor, Quantity, SingleContestant
from suchus.core.progress import Progress, portion
from suchus.robot.design import GRAVITY, Robot, with_values
from suchus.robot.design.ground import Ground
from suchus.robot.design.scale import rescale
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START, Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import ground_force, speed, time_window

_SLOPE = radians(15.0)
_CYCLES = 4
_TRIES, _HELD, _ALLOWED = 5, 0.03, 0.1  # of the cadence; errors of the speed at which the search ends, and is heard [-]
_CADENCES = (0.3, 3.0)  # factors on the cadence that are tried [-]


@lru_cache(maxsize=64)
def _body(length: float, friction: float) -> Robot:
    caiman = with_values(ROBOTS["caiman"], {"contact.foot_friction": friction})
    return rescale(caiman, length_factor=length / caiman.length)


def walked(gait: str, choices: Sequence[Numbers], progress: Progress) -> list[Found]:
    """Return cadences that hold the speed of the level, and the pushes along the slope over the weight."""
    return [_walk(gait, one, portion(progress, i, len(choices))) for i, one in enumerate(choices)]


def _walk(gait: str, numbers: Numbers, progress: Progress) -> Found:
    """Return what one choice of the numbers says; nothing where no cadence holds the speed.

    A controller of the cadence holds the speed: the cadence is changed until uphill and downhill it is that of the
    level, as an animal's was.
    """
    robot = _body(numbers["length"], numbers["friction"])
    walk = rescale(GAITS[gait], length_factor=numbers["length"] / ROBOTS["caiman"].length)
    settle = START / GAITS[gait].period
    (level,), _ = _walks(robot, [(walk, 0.0)], settle, progress)
    if not (np.isfinite(level) and level > 0.0):
        return {}
    factors = np.ones(2)
    for _ in range(_TRIES):
        paced = [replace(walk, period=walk.period / factor) for factor in factors]
        speeds, pushes = _walks(robot, list(zip(paced, (_SLOPE, -_SLOPE), strict=True)), settle, progress)
        if not np.isfinite(speeds).all():
            return {}
        if (np.abs(speeds / level - 1.0) < _HELD).all():
            break
        factors = np.clip(factors * np.clip(level / np.maximum(speeds, 1e-6), 0.5, 2.0), *_CADENCES)
    found = {"push_up": float(pushes[0]), "push_down": float(pushes[1])}
    for name, factor, speed_ratio in zip(("cadence_up", "cadence_down"), factors, speeds / level, strict=True):
        if abs(speed_ratio - 1.0) < _ALLOWED:
            found[name] = float(factor)
    return found


def _walks(
    robot: Robot, walks: Sequence[tuple[Gait, float]], settle: float, progress: Progress
) -> tuple[np.ndarray, np.ndarray]:
    """Return speeds [m/s] and mean pushes along the slope over the weight [-] of walks.

    Args:
        robot: who walks.
        walks: gait and slope of each [rad].
        settle: cycles before the speed is read [-].
        progress: told the share that is done.
    """
    runs = [Run(robot=robot, gait=gait, ground=Ground(uphill=slope), label=f"{slope:g} rad") for gait, slope in walks]
    longest = max(gait.period for gait, _ in walks)
    record = simulate(runs, duration=(settle + _CYCLES + 0.1) * longest, progress=progress)
    speeds, pushes = [], []
    for i, (gait, _) in enumerate(walks):
        start, end = settle * gait.period, (settle + _CYCLES) * gait.period
        one = record.isel(run=[i])
        speeds.append(float(speed(one, start, end).values[0]))
        along = ground_force(time_window(one, start, end)).sel(xyz="x").mean("time").values[0]
        pushes.append(float(along) / (robot.mass * GRAVITY))
    return np.array(speeds), np.array(pushes)


contestant = SingleContestant(
    Contestant(
        name="alligator_slope",
        title="An alligator walks up and down 15 degrees",
        description="The article's robot, whose length and mass are those of a young alligator, in its high walk and "
        "its belly "
        "crawl on an even slope of 15 degrees, up, down and level. A controller changes the cadence until the speed is "
        "that of the level, as the animals held theirs.",
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
            "cadence_up": Quantity(unit="-", words="cadence uphill over that on the level, at one speed"),
            "cadence_down": Quantity(unit="-", words="cadence downhill over that on the level, at one speed"),
            "push_up": Quantity(unit="-", words="mean push of the ground along the slope, uphill, over the weight"),
            "push_down": Quantity(unit="-", words="the same downhill, forward positive"),
        },
        rungs={
            gait: Predictor(words=f"rigid bodies with contacts, {words}", work=partial(walked, gait), draws=4)
            for gait, words in (("high_walk", "the high walk"), ("belly_crawl", "the belly crawl"))
        },
        excluded_models={"theories of swimming, slice, space": "it walks"},
    )
)

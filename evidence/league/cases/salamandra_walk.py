"""Salamandra robotica walks: how fast, at which frequency of its cranks."""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from evidence.league import Contestant, Found, Given, Numbers, Predictor, Quantity, SingleContestant
from suchus.core.progress import Progress, portion
from suchus.robot.design import Robot, with_values
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import speed

FREQUENCIES = (0.4, 0.67, 1.0)
"""Of the walk [Hz]."""
_CYCLES = 4


@lru_cache(maxsize=64)
def _body(friction: float, skin: float) -> Robot:
    return with_values(ROBOTS["salamandra"], {"contact.foot_friction": friction, "contact.skin_friction": skin})


def walked(choices: Sequence[Numbers], progress: Progress) -> list[Found]:
    """Return speeds over the frequency, in body lengths."""
    return [_walk(one, portion(progress, i, len(choices))) for i, one in enumerate(choices)]


def _walk(numbers: Numbers, progress: Progress) -> Found:
    robot, found = _body(numbers["friction"], numbers["skin_friction"]), []
    for i, frequency in enumerate(FREQUENCIES):
        gait = replace(GAITS["salamandra_walk"].bent(numbers["bend"]), period=1.0 / frequency)
        end = START + _CYCLES * gait.period
        record = simulate(
            [Run(robot=robot, gait=gait, label="walk")], duration=end, progress=portion(progress, i, len(FREQUENCIES))
        )
        found.append(float(speed(record, START, end).values[0]) / robot.length)
    return {"speeds": tuple(found), "stride": found[1] / FREQUENCIES[1]} if np.isfinite(found).all() else {}


contestant = SingleContestant(
    Contestant(
        name="salamandra_walk",
        title="Salamandra robotica walks",
        description="The salamander robot of the EPFL with four cranks for legs, 0.85 m long, on even ground, the "
        "standing wave of "
        "the walking animal on its axis. Its dimensions are those of the public model; a table of its speeds "
        "could not be "
        "read here, so that the prediction stands sealed without a measurement.",
        inputs={
            "friction": Given(
                value=0.8, low=0.5, high=1.0, unit="-", source="rubber feet on a floor: not published, range of rubber"
            ),
            "skin_friction": Given(
                value=0.3, low=0.15, high=0.5, unit="-", source="plastic bodies on a floor: not published"
            ),
            "bend": Given(
                value=1.0,
                low=0.7,
                high=1.4,
                unit="-",
                source="factor on the bends of the axis, which are those of the animal; the robot's own are a "
                "table of its "
                "oscillators that could not be read here (Ijspeert et al. 2007, Science 315, 1416)",
            ),
        },
        predicts={
            "speeds": Quantity(unit="body length/s", words="speed at 0.4, 0.67 and 1 Hz"),
            "stride": Quantity(unit="body length", words="stride at 0.67 Hz"),
        },
        rungs={"contacts": Predictor(words="rigid bodies with contacts", work=walked, draws=10)},
        excluded_models={"theories of swimming, slice, space": "it walks"},
    )
)

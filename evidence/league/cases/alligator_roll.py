"""A young alligator's death roll: how fast does a body turn that bends as the animal was filmed?"""

from collections.abc import Sequence
from functools import lru_cache, partial
from math import pi, radians

from evidence.league import Contestant, Found, Given, Numbers, Predictor, Quantity, SingleContestant, known
from suchus.core.errors import OutsideLimits
from suchus.core.progress import Progress, portion
from suchus.robot.control import OpenLoop
from suchus.robot.design import Robot
from suchus.robot.design.scale import rescale
from suchus.robot.motion import roll
from suchus.robot.robots import ROBOTS
from suchus.sim.land import VACUUM, WATER, Afloat, Run, simulate
from suchus.sim.metrics import roll_rate

_FISH = "Fish et al. 2007, J. Exp. Biol. 210, 2811 (abstract)"
_CYCLES = 3


@lru_cache(maxsize=8)
def _body(length: float) -> Robot:
    return rescale(ROBOTS["caiman"], length_factor=length / ROBOTS["caiman"].length)


def rolled(afloat: Afloat, choices: Sequence[Numbers], progress: Progress) -> list[Found]:
    """Return the rates of roll, and the turns for each cycle of the bends."""
    return [_roll(afloat, one, portion(progress, i, len(choices))) for i, one in enumerate(choices)]


def _roll(afloat: Afloat, numbers: Numbers, progress: Progress) -> Found:
    robot, period = _body(numbers["length"]), 1.0 / numbers["frequency"]
    try:
        gait = roll(robot, period=period, trunk=(numbers["trunk"],) * 2, tail=(numbers["tail"], numbers["tail_pitch"]))
    except OutsideLimits:
        return {}
    run = Run(robot=robot, gait=gait, control=OpenLoop(begin=0.0, ramp=period), afloat=afloat, label="roll")
    record = simulate([run], duration=_CYCLES * period, progress=progress)
    rate = abs(float(roll_rate(record, period).values[0])) / (2.0 * pi)
    return {"rate": rate, "turns": rate * period}


contestant = SingleContestant(
    Contestant(
        name="alligator_roll",
        title="The death roll of an alligator of 0.29 m",
        description="The article's robot at the length of a young alligator, limbs folded back, without ground and "
        "gravity. Trunk "
        "and tail bend around the body once in a cycle, as far as the animal's head and tail do or the robot's joints "
        "allow; what turns it is that the angular momentum stays zero.",
        inputs={
            "length": known(0.29, "m", _FISH),
            "trunk": Given(
                value=radians(49.2),
                low=radians(40.0),
                high=radians(60.0),
                unit="rad",
                source=f"head bent by 49.2 degrees: {_FISH}; a robot without a neck joint bends its trunk so far",
            ),
            "tail": Given(
                value=radians(55.0),
                low=radians(35.0),
                high=radians(60.0),
                unit="rad",
                source=f"tail bent by 103.3 degrees ({_FISH}); the robot's bends by 64 at most",
            ),
            "tail_pitch": Given(
                value=radians(38.0),
                low=radians(25.0),
                high=radians(40.0),
                unit="rad",
                source="the same tail; the robot's pitches by 40 degrees at most",
            ),
            "frequency": Given(
                value=1.8,
                low=1.0,
                high=2.5,
                unit="Hz",
                source="of the bends around the body: not in what could be read; young alligators swim with 1 to 2.5 "
                "beats a second (Fish 1984, Copeia 1984, 839 [memory])",
            ),
        },
        predicts={
            "rate": Quantity(unit="Hz", words="rate of roll"),
            "turns": Quantity(unit="-", words="turns of the body for each cycle of its bends"),
        },
        rungs={
            "vacuum": Predictor(
                words="rigid bodies, nothing acts from outside", work=partial(rolled, VACUUM), draws=10
            ),
            "ellipsoids": Predictor(
                words="rigid bodies in water, MuJoCo's drag of ellipsoids", work=partial(rolled, WATER), draws=10
            ),
        },
        excluded_models={"sections, slice, space": "they know no roll of a body that bends around itself"},
    )
)

"""A salamander at its own size and density swims as it was filmed: how far it comes in a cycle."""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache, partial

import numpy as np

from evidence.league import Contestant, Found, Given, Numbers, Quantity, SingleContestant
from evidence.league.cases._water import KnownSwim, form_of, fresh
from evidence.league.swims import (
    ModelSwimmer,
    SwimPrediction,
    SwimTask,
    held_swim,
    rungs,
    steady_swims,
    theory,
    waters,
)
from suchus.core.errors import NotConverged
from suchus.core.progress import Progress, portion
from suchus.robot.design import Robot
from suchus.robot.gaits import ANIMAL_SWIM
from suchus.robot.motion import Curve, Gait, servo_parts
from suchus.robot.robots._animals import pleurodeles
from suchus.swimming.water import resistive
from suchus.swimming.water.slender import Model

FREQUENCIES = (2.6, 2.9, 3.4, 3.8)
"""At which the animal was filmed [Hz]."""
_FILMED = (
    "Pleurodeles waltl; Karakasiliotis, Schilling, Cabelguen and Ijspeert 2013, Biol. Cybern. 107, 529, public data of "
    "SalamandraSNN (MIT)"
)
SWING = 0.26
"""Way of the tail's tip from side to side that was filmed [body length]."""
_MEAN_FREQUENCY = float(np.mean(FREQUENCIES))
_WAVELENGTH = 0.9  # [body length, memory]; friction alone asks for it
_TAIL_ASPECT = (1.0, 4.0)  # the model's tail is round, the animal's flat, with a fin as high as its trunk [memory]
_FOLDED = float(np.radians(-85.0))


_animal = lru_cache(maxsize=128)(partial(pleurodeles, beat=FREQUENCIES[-1]))


def _motion(numbers: Numbers, often: float) -> tuple[Robot, Gait]:
    """Return the animal and its filmed joints at a frequency [Hz]."""
    robot = _animal(numbers["length"], numbers["mass"], numbers["own_density"], numbers["keel"])
    parts = servo_parts(robot)
    angles = dict(ANIMAL_SWIM) | {f"{side}_yaw": (_FOLDED,) for side in ("LF", "RF", "LH", "RH")}
    gait = Gait(
        name=f"animal_swim_{often:.3g}", period=1.0 / often, limb_phases=(0.0,) * 4,
        curves=tuple(Curve(servo=name, part=parts[name], angles=curve) for name, curve in angles.items()),
    )  # fmt: skip
    return robot, gait


def build(numbers: Numbers, frequency: float | None) -> ModelSwimmer:
    """Return the animal with its filmed joints at a frequency [Hz]; the mean of the filmed ones if None."""
    robot, gait = _motion(numbers, frequency or _MEAN_FREQUENCY)
    return ModelSwimmer(
        robot=robot, gait=gait, water=waters(numbers), form=form_of(numbers), added_mass=numbers["added_mass"],
        ramp=0.0,
    )  # fmt: skip


def read(numbers: Numbers, swimmer: ModelSwimmer, swum: SwimPrediction) -> Found:
    """Return the stride of one swim."""
    del numbers
    return {"stride": swum.speed / swum.frequency / swimmer.robot.length}


def filmed_swing(numbers: Numbers) -> float:
    """Return the filmed way of the tail's tip from side to side [m]."""
    return numbers["swing"] * numbers["length"]


def _build_at(often: float, numbers: Numbers, frequency: float | None) -> ModelSwimmer:
    """Return the animal at a filmed frequency [Hz]."""
    del frequency
    return build(numbers, often)


def _task(often: float) -> SwimTask:
    """Return the task to swim at a filmed frequency [Hz] with the filmed swing of the tail."""
    return SwimTask(build=partial(_build_at, often), read_quantities=read, cycles=12, filmed_swing=filmed_swing)


def by_theory(model: Model, choices: Sequence[Numbers], progress: Progress) -> list[Found]:
    """Return strides over the frequency, and their mean, by a theory."""
    found: list[Found] = []
    for i, numbers in enumerate(choices):
        progress("choices of the numbers", i / len(choices))
        try:
            swums = [held_swim(_task(often), numbers, partial(theory, model))[1] for often in FREQUENCIES]
            found.append(_strides(numbers, swums))
        except NotConverged:
            found.append({})
    return found


def by_sections(choices: Sequence[Numbers], progress: Progress) -> list[Found]:
    """Return the same in six degrees of freedom.

    Raises:
        OutsideLimits: the swims with the most likely numbers are not steady, or not as filmed.
    """
    count = len(FREQUENCIES)
    swims = [steady_swims(_task(often), choices, portion(progress, i, count)) for i, often in enumerate(FREQUENCIES)]
    found: list[Found] = []
    for numbers, *row in zip(choices, *swims, strict=True):
        steady = [swum for swum in row if swum is not None]
        found.append(_strides(numbers, steady) if len(steady) == count else {})
    return found


def _strides(numbers: Numbers, swums: Sequence[SwimPrediction]) -> Found:
    strides = tuple(swum.speed / swum.frequency / numbers["length"] for swum in swums)
    speed = float(np.mean([swum.speed for swum in swums])) / numbers["length"]
    return {"stride": float(np.mean(strides)), "strides": strides, "speed": speed}


_GIVEN = {
    "swing": Given(
        value=SWING, low=0.24, high=0.28, unit="body length",
        source=f"way of the tail's tip from side to side, twice its lateral displacement of 13 % of the length: "
        f"{_FILMED}",
    ),
    "length": Given(value=0.176, low=0.170, high=0.182, unit="m", source=f"{_FILMED}: body length"),
    "mass": Given(
        value=0.0163, low=0.013, high=0.021, unit="kg",
        source="3.0 g at 0.10 m of the model used with SalamandraSNN (MIT), with the cube of the length; the "
        "animals were "
        "not weighed there",
    ),
    "own_density": Given(
        value=900.0, low=880.0, high=995.0, unit="kg/m3",
        source="900 kg/m3 of the same model, lungs filled; with emptied lungs an amphibian is nearly neutral",
    ),
    "keel": Given(
        value=0.25, low=0.1, high=0.4, unit="-", source="lungs lie above the bones: by how much is not published"
    ),
}  # fmt: skip
_LIKELY = _motion({name: number.value for name, number in _GIVEN.items()}, _MEAN_FREQUENCY)
_KNOWN = KnownSwim(robot=_LIKELY[0], gait=_LIKELY[1], wavelength=_WAVELENGTH, swing=SWING, tail_aspect=_TAIL_ASPECT)
_TASK = SwimTask(build=build, read_quantities=read, filmed_swing=filmed_swing)
_ASKED = {name: rung for name, rung in rungs(_TASK).items() if name != "reactive"}
contestant = SingleContestant(
    Contestant(
        name="salamander",
        title="A salamander swims at 2.6 to 3.8 Hz",
        description="Pleurodeles waltl at its own length, mass and volume, limbs folded back, in fresh water; the "
        "angles of its "
        "axial joints are the mean cycle that was filmed, scaled so that its tail swings as far as the animal's did.",
        inputs=_GIVEN | fresh(_KNOWN),
        predicts={
            "stride": Quantity(unit="body length", words="stride, the mean over the frequencies"),
            "strides": Quantity(unit="body length", words="stride at 2.6, 2.9, 3.4 and 3.8 Hz"),
            "speed": Quantity(unit="body length/s", words="mean speed"),
        },
        rungs=_ASKED
        | {
            "resistive": replace(_ASKED["resistive"], work=partial(by_theory, resistive), draws=16),
            "sections": replace(_ASKED["sections"], work=by_sections, draws=12),
        },
        excluded_models={"reactive": "the model's tail ends in a point, at which nothing is shed"},
    )
)

"""A salamander at its own size and density swims as it was filmed: how far it comes in a cycle."""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache, partial

import numpy as np

from evidence.league import Contestant, Found, Given, Numbers, Quantity, SingleContestant
from evidence.league.cases._water import fresh
from evidence.league.swims import ModelSwimmer, SwimPrediction, SwimTask, rungs, sections, theory, waters
from suchus.core.errors import NotConverged
from suchus.core.progress import Progress
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
_FOLDED = float(np.radians(-85.0))


_animal = lru_cache(maxsize=128)(partial(pleurodeles, beat=FREQUENCIES[-1]))


def build(numbers: Numbers, frequency: float | None) -> ModelSwimmer:
    """Return the animal with its filmed joints at a frequency [Hz]; the mean of the filmed ones if None."""
    robot = _animal(numbers["length"], numbers["mass"], numbers["own_density"], numbers["keel"])
    parts, often = servo_parts(robot), frequency or float(np.mean(FREQUENCIES))
    angles = dict(ANIMAL_SWIM) | {f"{side}_yaw": (_FOLDED,) for side in ("LF", "RF", "LH", "RH")}
    gait = Gait(
        name=f"animal_swim_{often:.3g}", period=1.0 / often, limb_phases=(0.0,) * 4,
        curves=tuple(Curve(servo=name, part=parts[name], angles=curve) for name, curve in angles.items()),
    )  # fmt: skip
    return ModelSwimmer(
        robot=robot, gait=gait, water=waters(numbers), shedding=numbers["shedding"], added_mass=numbers["added_mass"],
        ramp=0.0,
    )  # fmt: skip


def read(numbers: Numbers, swimmer: ModelSwimmer, swum: SwimPrediction) -> Found:
    """Return the stride of one swim."""
    del numbers
    return {"stride": swum.speed / swum.frequency / swimmer.robot.length}


def by_theory(model: Model, choices: Sequence[Numbers], progress: Progress) -> list[Found]:
    """Return strides over the frequency, and their mean, by a theory."""
    found: list[Found] = []
    for i, numbers in enumerate(choices):
        progress("choices of the numbers", i / len(choices))
        try:
            found.append(_strides(numbers, [theory(model, build(numbers, one)) for one in FREQUENCIES]))
        except NotConverged:
            found.append({})
    return found


def by_sections(choices: Sequence[Numbers], progress: Progress) -> list[Found]:
    """Return the same in six degrees of freedom."""
    swimmers = [build(numbers, one) for numbers in choices for one in FREQUENCIES]
    swums = sections(swimmers, cycles=12, progress=progress)
    count = len(FREQUENCIES)
    return [_strides(numbers, swums[count * i : count * (i + 1)]) for i, numbers in enumerate(choices)]


def _strides(numbers: Numbers, swums: Sequence[SwimPrediction]) -> Found:
    strides = tuple(swum.speed / swum.frequency / numbers["length"] for swum in swums)
    speed = float(np.mean([swum.speed for swum in swums])) / numbers["length"]
    return {"stride": float(np.mean(strides)), "strides": strides, "speed": speed}


_GIVEN = {
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
_ASKED = {name: rung for name, rung in rungs(SwimTask(build=build, read_quantities=read)).items() if name != "reactive"}
contestant = SingleContestant(
    Contestant(
        name="salamander",
        title="A salamander swims at 2.6 to 3.8 Hz",
        description="Pleurodeles waltl at its own length, mass and volume, limbs folded back, in fresh water; the "
        "angles of its "
        "axial joints are the mean cycle that was filmed.",
        inputs=_GIVEN
        | fresh(
            drag=(1.1, 0.8, 1.8),
            rub=(1.5, 1.0, 3.0),
            shed=(0.7, 0.3, 1.2),
            why_drag="ellipses across, Hoerner 1965; a tail with a fin and oscillation raise it (docs/amphibious.md)",
            why_rub="1 is a plate; 1.1 to 1.9 on swimming fish (Anderson, McGillis and Grosenbaugh 2001, J. Exp. Biol. "
            "204, 81 [memory]); folded limbs add to it",
            why_shed="the model's tail is round and ends in a point; the animal's is flat and has a fin as high as its "
            "trunk, which sheds ahead of the tip",
        ),
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

"""Tunabot, a robot fish whose tail beats at up to 15 Hz: how fast that drives it."""

from collections.abc import Mapping
from functools import lru_cache
from itertools import pairwise

from evidence.league import Contestant, Found, Given, Numbers, Quantity, SingleContestant, known
from evidence.league.cases._films import filmed_swing
from evidence.league.cases._water import DENSITY, KnownSwim, form_of, fresh
from evidence.league.swims import ModelSwimmer, SwimPrediction, SwimTask, rungs, waters
from suchus.robot.design import Robot
from suchus.robot.design.drawing import Drawing
from suchus.robot.design.scale import swim_servo_for
from suchus.robot.motion import Gait
from suchus.swimming.water import FilmedWave, fit

_ZHU = "Zhu et al. 2019, Sci. Robot. 4, eaax4615 (abstract)"
_JOINTS = (0.62, 0.76, 0.88)
_TUNA = (
    "49 mm wide and 68 mm high (Zhu et al. 2019, text [memory]), the outline between drawn after yellowfin tuna, from "
    "memory: the article's drawing could not be read here"
)
_WIDE, _HIGH = 0.0961, 0.1333  # half of 49 and of 68 mm [body length]


@lru_cache(maxsize=128)
def _body(length: float, wide: float, fin: float, density: float) -> Robot:
    places = (0.0, 0.06, 0.15, 0.30, 0.45, 0.60, 0.75, 0.86, 0.93, 1.0)
    width = (0.015, 0.045, 0.075, 0.095, 0.090, 0.070, 0.038, 0.016, 0.010, 0.008)
    height = (0.018, 0.055, 0.095, 0.125, 0.120, 0.095, 0.055, 0.025, fin, fin)
    half_width = tuple(_WIDE / max(width) * wide * value for value in width)
    half_height = tuple(value if value == fin else _HIGH / 0.125 * value for value in height)
    area = sum(
        0.5 * (b - a) * (half_width[i] * half_height[i] + half_width[i + 1] * half_height[i + 1])
        for i, (a, b) in enumerate(pairwise(places))
    )
    mass = density * 3.1416 * area * length**3
    drawing = Drawing(
        name="tunabot", length=length, mass=mass, density=density, stations=places, half_width=half_width,
        half_height=half_height, joints=_JOINTS, keel=0.4,
    )  # fmt: skip
    return drawing.robot(swim_servo_for(mass, length, 15.0))


def _motion(numbers: Numbers, frequency: float) -> tuple[Robot, Gait]:
    """Return the robot and a tail that beats at a frequency [Hz]."""
    length = numbers["length"]
    robot = _body(length, numbers["wide"], numbers["fin"], 0.9995 * numbers["density"])
    wave = FilmedWave(
        length=length, frequency=frequency, wavelength=numbers["wavelength"], head=0.01,
        tail=0.5 * numbers["tail"],
    )  # fmt: skip
    return robot, fit(robot, wave, name="tunabot", max_misfit=1.0).gait


def build(numbers: Numbers, frequency: float | None) -> ModelSwimmer:
    """Return the robot with a tail that beats at a frequency [Hz], at 15 Hz if None."""
    robot, gait = _motion(numbers, frequency or numbers["frequency"])
    return ModelSwimmer(
        robot=robot, gait=gait, water=waters(numbers), form=form_of(numbers), added_mass=numbers["added_mass"],
        ramp=1.0,
    )  # fmt: skip


def read(numbers: Numbers, swimmer: ModelSwimmer, swum: SwimPrediction) -> Found:
    """Return speed in lengths and power of a swim."""
    del numbers
    return {"speed": swum.speed / swimmer.robot.length, "power": swum.power}


def _water(given: Mapping[str, Given]) -> dict[str, Given]:
    """Return the numbers of its water, from those of body and gait."""
    numbers = {name: number.value for name, number in given.items()} | {"density": DENSITY}
    robot, gait = _motion(numbers, numbers["frequency"])
    return fresh(KnownSwim(robot=robot, gait=gait, wavelength=numbers["wavelength"], swing=numbers["tail"]))


_GIVEN = {
    "length": known(0.255, "m", _ZHU),
    "frequency": known(15.0, "Hz", _ZHU),
    "wide": Given(value=1.0, low=0.85, high=1.15, unit="-", source=f"factor on the width, {_TUNA}"),
    "fin": Given(
        value=0.11, low=0.08, high=0.14, unit="body length", source=f"half of the caudal fin's span, {_TUNA}"
    ),
    "tail": Given(
        value=0.15, low=0.08, high=0.20, unit="body length",
        source="way of the tail from side to side: 0.15 to 0.2 body lengths is what fish of this kind do "
        "(Bainbridge 1958, J. Exp. Biol. 35, 109), and a motor's link gives way at its highest frequency",
    ),
    "wavelength": Given(
        value=1.2, low=0.9, high=1.6, unit="body length",
        source="of fish of the tuna's kind: 1.0 to 1.3 (Di Santo et al. 2021, PNAS 118, e2113206118 [memory])",
    ),
}  # fmt: skip
contestant = SingleContestant(
    Contestant(
        name="tunabot",
        title="Tunabot at 15 Hz",
        description="A robot fish of 0.255 m that swims freely, its tail beating at 15 Hz. Length and frequency are "
        "published; "
        "outline and amplitude are not in what could be read, and have wide ranges.",
        inputs=_GIVEN | _water(_GIVEN),
        predicts={
            "speed": Quantity(unit="body length/s", words="speed at 15 Hz"),
            "power": Quantity(unit="W", words="mean power of the body on the water"),
        },
        rungs=rungs(
            SwimTask(build=build, read_quantities=read, cycles=16, resolved_cycles=6, filmed_swing=filmed_swing)
        ),
    )
)  # fmt: skip

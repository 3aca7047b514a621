"""Small-spotted catsharks that hold a speed: with which tail beat, Strouhal number and power."""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache, partial
from importlib import resources

import numpy as np

from evidence.league import Contestant, ContestantFamily, Found, Given, Numbers, Predictor, Quantity, known
from evidence.league.cases._films import filmed_swing
from evidence.league.cases._water import DENSITY, KnownSwim, form_of, fresh
from evidence.league.judging import unsteady_wave
from evidence.league.swims import ModelSwimmer, SwimPrediction, SwimTask, rungs, waters
from suchus.core.progress import Progress
from suchus.robot.design import Robot
from suchus.robot.motion import Gait
from suchus.robot.robots._animals import catshark
from suchus.swimming.water import FilmedWave, fit

_FILM = "catshark_midlines.csv"
_TABLE = (
    "fberio/scanicula_steady_swimming (MIT), midlines of 5 animals at four speeds, means and standard deviations, as "
    f"contestants/data/{_FILM}"
)
_FAO = (
    "proportions of Scyliorhinus canicula, from memory of the drawing in Compagno 1984, FAO Species Catalogue 4: not "
    "measured here, so that the range is wide"
)
_SECTION_DRAWS = 12  # of the numbers in sections, each of which holds a speed and a swing
_BEAT = 6.0  # [Hz]; for which the joints are stiff enough to follow the film


def _film() -> dict[str, np.ndarray]:
    text = (resources.files("evidence.league.cases") / "data" / _FILM).read_text(encoding="utf-8")
    rows = list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def _read(film: dict[str, np.ndarray], name: str, speed: float, factor: float, source: str) -> Given:
    """Return an amplitude at a speed, between those of the film in proportion; two standard errors of 5 animals."""
    value = factor * float(np.interp(speed, film["speed_BL_s"], film[f"{name}_mean"]))
    error = 2.0 * factor * float(np.interp(speed, film["speed_BL_s"], film[f"{name}_sd"])) / 5.0**0.5
    return Given(
        value=value, low=max(value - error, 0.2 * value), high=value + error, unit="body length", source=source
    )


_body = lru_cache(maxsize=256)(partial(catshark, beat=_BEAT))


def _motion(numbers: Numbers, often: float) -> tuple[Robot, Gait]:
    """Return the animal and its filmed midline at a frequency [Hz]."""
    length = numbers["length"]
    robot = _body(
        length, numbers["mass"] * length**3, 0.9995 * numbers["density"], numbers["wide"], numbers["tail_height"]
    )
    gait = _gait(robot, numbers["wavelength"], 0.5 * numbers["head"], 0.5 * numbers["tail"])
    return robot, replace(gait, period=1.0 / often)


def build(numbers: Numbers, frequency: float | None) -> ModelSwimmer:
    """Return the animal with its filmed midline at a frequency [Hz]."""
    robot, gait = _motion(numbers, frequency or 2.0)
    return ModelSwimmer(
        robot=robot, gait=gait, water=waters(numbers), form=form_of(numbers), added_mass=numbers["added_mass"], ramp=1.0
    )


@lru_cache(maxsize=256)
def _gait(robot: Robot, wavelength: float, head: float, tail: float) -> Gait:
    wave = FilmedWave(length=robot.length, frequency=1.0, wavelength=wavelength, head=head, tail=tail)
    return fit(robot, wave, name="catshark_film", max_misfit=0.4).gait


def _water(given: Mapping[str, Given]) -> dict[str, Given]:
    """Return the numbers of its water, from those of body and gait, at the tail beat with which a search begins."""
    numbers = {name: number.value for name, number in given.items()} | {"density": DENSITY}
    robot, gait = _motion(numbers, _start(numbers["speed"]))
    return fresh(KnownSwim(robot=robot, gait=gait, wavelength=numbers["wavelength"], swing=numbers["tail"]))


def held(numbers: Numbers) -> float:
    """Return the speed that the animal holds [m/s]."""
    return numbers["speed"] * numbers["length"]


def read(numbers: Numbers, swimmer: ModelSwimmer, swum: SwimPrediction) -> Found:
    """Return tail beat, Strouhal number and power of a swim at that speed."""
    del swimmer
    swing = swum.swing if swum.swing == swum.swing else numbers["tail"] * numbers["length"]
    return {"tailbeat": swum.frequency, "strouhal": swum.frequency * swing / swum.speed, "power": swum.power}


def by_law(choices: Sequence[Numbers], progress: Progress) -> list[Found]:
    """Return the tail beat by the Strouhal number of animals that cruise, with the amplitude of the film."""
    progress("the law", 1.0)
    return [
        {"tailbeat": one["cruising_strouhal"] * one["speed"] / one["tail"], "strouhal": one["cruising_strouhal"]}
        for one in choices
    ]


def at(speed: float) -> Contestant:
    """Return the animal that holds a speed.

    Args:
        speed: 0.5 to 6 [body lengths a second].
    """
    film = _film()
    given = {
        "speed": known(speed, "body length/s", "asked"),
        "length": Given(
            value=0.165, low=0.158, high=0.178, unit="m",
            source="speed in m/s over that in body lengths, and Reynolds number over speed, of the same table",
        ),
        "mass": Given(
            value=3.3, low=2.8, high=4.2, unit="kg/m3",
            source="mass over the cube of the length: 0.0031 g (L / 1 cm)^3.03 of FishBase [memory] is 3.3 "
            "kg/m3 at 0.17 m",
        ),
        "tail": _read(film, "tailAmplitude", speed, 1.0, f"{_TABLE}: way of the tail from side to side"),
        "head": _read(film, "headAmplitude", speed, 1.0, f"{_TABLE}: way of the snout from side to side"),
        "wavelength": _read(film, "wavelength", speed, 1.0, f"{_TABLE}: length of a whole wave, as printed"),
        "wide": Given(value=1.0, low=0.85, high=1.2, unit="-", source=f"factor on the drawn width: {_FAO}"),
        "tail_height": Given(value=1.0, low=0.7, high=1.5, unit="-", source=f"factor on the caudal fin's "
                                                                            f"height: {_FAO}"),
    }  # fmt: skip
    given["cruising_strouhal"] = Given(
        value=0.3, low=0.2, high=0.4, unit="-",
        source="of cruising fish, cetaceans, birds and bats (Taylor, Nudds and Thomas 2003, Nature 425, 707)",
    )  # fmt: skip
    given |= _water(given)
    return Contestant(
        name=f"catshark_{speed:g}",
        title=f"A catshark holds {speed:g} body lengths a second",
        description="Young small-spotted catsharks (Scyliorhinus canicula) of some 0.17 m in a flume. Amplitudes and "
        "wavelength of "
        "their midlines are those filmed; between and beyond the four filmed speeds they are interpolated, and kept. "
        "The frequency is the one at which each model swims that fast.",
        inputs=given,
        predicts={
            "tailbeat": Quantity(unit="Hz", words="frequency of the tail's beat that holds the speed"),
            "strouhal": Quantity(unit="-", words="frequency times the tail's way from side to side over the speed"),
            "power": Quantity(unit="W", words="mean power of the body on the water"),
        },
        rungs={"law": _LAW}
        | rungs(
            SwimTask(
                build=build,
                read_quantities=read,
                cycles=12,
                resolved_cycles=6,
                target_speed=held,
                start=_start(speed),
                filmed_swing=filmed_swing,
            ),
            section_draws=_SECTION_DRAWS,
        ),
        find_unsteadiness=partial(_unsteadiness, speed),
    )


_LAW = Predictor(words="the Strouhal number of animals that cruise", work=by_law, draws=200)


def _start(speed: float) -> float:
    """Return a frequency to begin with: half a body length a beat [Hz]."""
    return 2.0 * speed


def _unsteadiness(speed: float, measured: Mapping[str, float]) -> str:
    """Return why what was measured at a speed is no steady swim; empty if it can be one.

    Args:
        speed: speed of the swim [body length/s].
        measured: values by quantity.
    """
    film = _film()
    wavelength = float(np.interp(speed, film["speed_BL_s"], film["wavelength_mean"]))
    return unsteady_wave(speed, measured["tailbeat"] * wavelength) if "tailbeat" in measured else ""


contestant = ContestantFamily(
    name="catshark",
    default_parameters=(1.25, 2.0, 3.0, 5.0),
    low=0.5,
    high=6.0,
    parameter_label="body lengths a second",
    create=partial(at),
)

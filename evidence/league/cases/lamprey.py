"""A young sea lamprey in water 1, 10 and 20 times as viscous as water: how far it swims in a beat."""

from collections.abc import Mapping
from functools import partial
from math import hypot, sqrt

from evidence.league import Contestant, ContestantFamily, Found, Given, Numbers, Quantity
from evidence.league.cases._films import FilmedSwim, LongBody, filmed_swing
from evidence.league.cases._water import Estimate
from evidence.league.judging import unsteady_wave
from evidence.league.swims import ModelSwimmer, SwimPrediction, SwimTask, rungs
from suchus.core.errors import InvalidDesign

_DATA = (
    "public midlines of 5 freely swimming young sea lampreys (Petromyzon marinus), github.com/tytell/Viscosity, table "
    "Data/coddata.csv, first mode: mean over the animals and two standard errors [read]"
)
_SIZES = (
    "mean and standard deviation over the swims of the first complex orthogonal value, in the picture of cell 21 of "
    "Lamprey_COD-Part_II_Initial_COD.ipynb of the same repository, by its share at the tail's tip in the table; range "
    "as if all swims of an animal were alike, two standard errors of five animals, with 2 % for the reading and 5 % "
    "for what is not the first mode, as independent errors [computed here]"
)
_FILM = (
    "public midlines of one such lamprey, github.com/tytell/fishmechr, lampreydata (CC BY 4.0): amplitudes about its "
    "curved path at the frequency of the beat [computed here]"
)
_DRAWING = (
    "widths of the lamprey in fishwidth of the same package, read as halves: read as whole widths a lamprey of 0.143 m "
    "would weigh 1.8 g, and animals of this length weigh 3 to 4.5 g [memory]; height 8 mm in show_viscosity_kinematics "
    "of the first repository; outline of the fins from memory"
)
POSITIONS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
SHAPE = (0.20, 0.13, 0.20, 0.37, 0.50, 0.59, 0.66, 0.73, 0.79, 0.86, 1.0)
"""Where the envelope was filmed [body length], and amplitude there over that of the tail\'s tip [-]."""
BODY = LongBody(
    name="lamprey",
    stations=(0.0, 0.05, 0.10, 0.30, 0.50, 0.60, 0.70, 0.80, 0.90, 0.97, 1.0),
    half_width=(0.012, 0.0169, 0.0177, 0.0186, 0.0163, 0.0143, 0.0123, 0.0095, 0.0059, 0.003, 0.002),
    half_height=(0.012, 0.022, 0.026, 0.028, 0.028, 0.028, 0.028, 0.027, 0.025, 0.018, 0.012),
)
"""Outline of the lamprey."""
SWIM = FilmedSwim(body=BODY, positions=POSITIONS, shape=SHAPE)
"""Lamprey and the shape of its filmed wave."""
VISCOSITIES = {1.0: (2.88, 0.764, 0.143), 10.0: (2.82, 0.723, 0.148), 20.0: (2.18, 0.684, 0.150)}
"""Frequency [Hz], wavelength [body length] and length [m] that were filmed, by viscosity over that of water."""
_ERRORS = {1.0: (0.30, 0.021, 0.0033), 10.0: (0.51, 0.040, 0.0074), 20.0: (0.31, 0.053, 0.0064)}
_VALUES = {1.0: (1745.0, 586.0, 0.3525), 10.0: (1716.0, 586.0, 0.3620), 20.0: (1341.0, 316.0, 0.3555)}
"""First complex orthogonal value, the sum over 20 points of the mean square of the amplitude: mean and standard
deviation over the swims [mm2]; and amplitude of its mode of length 1 at the tail's tip, mean over the swims [-]."""
_ANIMALS, _READING, _OTHER_MODES = 5, 0.02, 0.05


def _tail(viscosity: float) -> Estimate:
    """Return the way of the tail from side to side of the mean swim, with its range [body length].

    The value at the tip is the mean square of the amplitude there; the mean of the amplitude is less by its spread.

    Args:
        viscosity: over that of water [-].
    """
    mean, deviation, tip = _VALUES[viscosity]
    spread = 0.5 * deviation / mean  # of the amplitude, relative
    length = VISCOSITIES[viscosity][2]
    way = 2.0 * tip * 1e-3 * sqrt(mean * (1.0 - spread**2)) / length
    error = hypot(2.0 * spread / sqrt(_ANIMALS), _READING, _OTHER_MODES)
    return Estimate(way, (1.0 - error) * way, (1.0 + error) * way)


def build(numbers: Numbers, frequency: float | None) -> ModelSwimmer:
    """Return the lamprey with its filmed wave."""
    del frequency
    return SWIM.swimmer(numbers)


def read(numbers: Numbers, swimmer: ModelSwimmer, swum: SwimPrediction) -> Found:
    """Return stride and speed of a swim."""
    del numbers
    length = swimmer.robot.length
    return {"stride": swum.speed / swum.frequency / length, "speed": swum.speed / length}


def in_viscosity(viscosity: float) -> Contestant:
    """Return the lamprey in water of a viscosity.

    Args:
        viscosity: 1, 10 or 20 times that of water [-].

    Raises:
        InvalidDesign: in no other water it was filmed.
    """
    if viscosity not in VISCOSITIES:
        raise InvalidDesign(
            f"contestant 'lamprey' was filmed in water {', '.join(f'{v:g}' for v in VISCOSITIES)} times as viscous as "
            f"water, and not in {viscosity:g} times."
        )
    frequency, wavelength, length = VISCOSITIES[viscosity]
    errors = _ERRORS[viscosity]
    tail = _tail(viscosity)
    given = {
        name: Given(value=value, low=value - error, high=value + error, unit=unit, source=f"{_DATA}{what}")
        for name, value, error, unit, what in (
            ("frequency", frequency, errors[0], "Hz", ""),
            ("wavelength", wavelength, errors[1], "body length", ": one over the number of waves on the body"),
            ("length", length, errors[2], "m", ": wavelength times the number of waves on the body"),
        )
    }
    given["tail"] = Given(
        value=tail.value, low=tail.low, high=tail.high, unit="body length",
        source=f"way of the tail from side to side, of the same animals in the same water: {_SIZES}; shape of the "
        f"envelope: {_FILM}",
    )  # fmt: skip
    given["wide"] = Given(value=0.8, low=0.6, high=1.0, unit="-", source=f"factor on the drawn width: {_DRAWING}")
    given["high"] = Given(value=1.0, low=0.85, high=1.15, unit="-", source=f"factor on the drawn height: {_DRAWING}")
    water = SWIM.water(given, 1e-6 * viscosity)
    thick = {
        "viscosity": Given(
            value=1e-6 * viscosity, low=0.9e-6 * viscosity, high=1.15e-6 * viscosity, unit="m2/s",
            source=f"{viscosity:g} times that of fresh water, github.com/tytell/Viscosity [read]",
        )
    }  # fmt: skip
    return Contestant(
        name=f"lamprey_{viscosity:g}",
        title=f"A lamprey in water {viscosity:g} times as viscous",
        description="Young sea lampreys (Petromyzon marinus) of some 0.15 m that swim freely in a tank, in water whose "
        "viscosity was raised. Frequency, wavelength and swing of the tail are means of all swims, the shape of the "
        "envelope that of one film.",
        inputs=given | water | thick,
        predicts={
            "stride": Quantity(unit="body length", words="stride, the way in a beat"),
            "speed": Quantity(unit="body length/s", words="mean speed"),
        },
        rungs=rungs(SwimTask(build=build, read_quantities=read, cycles=10, filmed_swing=filmed_swing)),
        find_unsteadiness=partial(_unsteadiness, frequency, wavelength),
    )


def _unsteadiness(frequency: float, wavelength: float, measured: Mapping[str, float]) -> str:
    """Return why what was measured is no steady swim; empty if it can be one.

    Args:
        frequency: filmed beat [Hz].
        wavelength: filmed length of a wave [body length].
        measured: values by quantity.
    """
    return unsteady_wave(measured["stride"] * frequency, frequency * wavelength) if "stride" in measured else ""


contestant = ContestantFamily(
    name="lamprey",
    default_parameters=tuple(VISCOSITIES),
    low=1.0,
    high=20.0,
    parameter_label="times the viscosity of water",
    create=in_viscosity,
)

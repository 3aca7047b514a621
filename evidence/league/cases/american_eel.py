"""An American eel of 0.2 m with the wave of a publication: how fast does it swim."""

from collections.abc import Mapping

from evidence.league import Contestant, Found, Given, Numbers, Quantity, SingleContestant
from evidence.league.cases._films import FilmedSwim, LongBody, filmed_swing
from evidence.league.judging import unsteady_wave
from evidence.league.swims import ModelSwimmer, SwimPrediction, SwimTask, rungs

_EEL = "Tytell and Lauder 2004, J. Exp. Biol. 207, 1825"
_DRAWING = (
    "widths of the eel in fishwidth of github.com/tytell/fishmechr (CC BY 4.0) [read]; heights with fins from "
    "memory of the animal"
)
_POSITIONS = (0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 1.0)
_SHAPE = (0.10, 0.11, 0.20, 0.37, 0.64, 0.80, 1.0)
FREQUENCY, WAVELENGTH = 3.1, 0.60
"""Published beat [Hz] and length of a whole wave [body length], both from memory."""
_BODY = LongBody(
    name="american_eel",
    stations=(0.0, 0.05, 0.10, 0.20, 0.35, 0.50, 0.65, 0.80, 0.90, 0.97, 1.0),
    half_width=(0.010, 0.018, 0.020, 0.019, 0.020, 0.019, 0.017, 0.013, 0.010, 0.006, 0.004),
    half_height=(0.010, 0.020, 0.024, 0.026, 0.034, 0.036, 0.036, 0.034, 0.030, 0.020, 0.012),
)
_SWIM = FilmedSwim(body=_BODY, positions=_POSITIONS, shape=_SHAPE)


def build(numbers: Numbers, frequency: float | None) -> ModelSwimmer:
    """Return the eel with its published wave."""
    del frequency
    return _SWIM.swimmer(numbers)


def read(numbers: Numbers, swimmer: ModelSwimmer, swum: SwimPrediction) -> Found:
    """Return the speed of a swim."""
    del numbers
    return {"speed": swum.speed / swimmer.robot.length}


def _unsteadiness(measured: Mapping[str, float]) -> str:
    """Return why what was measured is no steady swim; empty if it can be one."""
    return unsteady_wave(measured["speed"], FREQUENCY * WAVELENGTH) if "speed" in measured else ""


_GIVEN = {
    "length": Given(value=0.20, low=0.18, high=0.24, unit="m", source=f"{_EEL} [memory]"),
    "frequency": Given(value=FREQUENCY, low=2.9, high=3.3, unit="Hz", source=f"{_EEL} [memory]"),
    "wavelength": Given(value=WAVELENGTH, low=0.56, high=0.64, unit="body length", source=f"{_EEL} [memory]"),
    "tail": Given(
        value=0.138, low=0.124, high=0.152, unit="body length",
        source=f"twice the amplitude of 0.069 of the tail's tip; its growth along the body is exponential: "
        f"{_EEL} [memory]",
    ),
    "wide": Given(value=1.0, low=0.85, high=1.15, unit="-", source=f"factor on the drawn width: {_DRAWING}"),
    "high": Given(value=1.0, low=0.8, high=1.25, unit="-", source=f"factor on the drawn height: {_DRAWING}"),
}  # fmt: skip
contestant = SingleContestant(
    Contestant(
        name="american_eel",
        title="An American eel",
        description="American eels (Anguilla rostrata) of some 0.2 m hold a speed in a flume. The speed is published "
        "in the abstract; frequency, wavelength and amplitude are from memory of the article, and have ranges for it.",
        inputs=_GIVEN | _SWIM.water(_GIVEN),
        predicts={"speed": Quantity(unit="body length/s", words="mean speed")},
        rungs=rungs(SwimTask(build=build, read_quantities=read, cycles=10, filmed_swing=filmed_swing)),
        find_unsteadiness=_unsteadiness,
    )
)  # fmt: skip

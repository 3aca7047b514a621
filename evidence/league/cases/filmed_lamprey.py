"""One film of one sea lamprey, with its own wave and envelope: how far it swims in a beat."""

from collections.abc import Mapping

from evidence.league import Contestant, Found, Given, Numbers, Quantity, SingleContestant
from evidence.league.cases._films import filmed_swing
from evidence.league.cases.lamprey import SWIM
from evidence.league.judging import unsteady_wave
from evidence.league.swims import ModelSwimmer, SwimPrediction, SwimTask, rungs

_FILM = (
    "public midlines of a freely swimming sea lamprey (Petromyzon marinus), 78 frames of 0.02 s, "
    "github.com/tytell/fishmechr, lampreydata (CC BY 4.0) [computed here]"
)
_DRAWING = "as for the lampreys of lamprey_1"
FREQUENCY, WAVELENGTH = 3.81, 0.665
"""Filmed beat [Hz] and length of a whole wave [body length]."""


def build(numbers: Numbers, frequency: float | None) -> ModelSwimmer:
    """Return the lamprey with its filmed wave."""
    del frequency
    return SWIM.swimmer(numbers)


def read(numbers: Numbers, swimmer: ModelSwimmer, swum: SwimPrediction) -> Found:
    """Return the stride of a swim."""
    del numbers
    return {"stride": swum.speed / swum.frequency / swimmer.robot.length}


def _unsteadiness(measured: Mapping[str, float]) -> str:
    """Return why what was measured is no steady swim; empty if it can be one."""
    return unsteady_wave(measured["stride"] * FREQUENCY, FREQUENCY * WAVELENGTH) if "stride" in measured else ""


_GIVEN = {
    "length": Given(value=0.1546, low=0.152, high=0.157, unit="m", source=f"length of the midline: {_FILM}"),
    "frequency": Given(value=FREQUENCY, low=3.65, high=3.95, unit="Hz", source=_FILM),
    "wavelength": Given(
        value=WAVELENGTH, low=0.62, high=0.72, unit="body length",
        source=f"phase of the lateral motion behind the first quarter: {_FILM}",
    ),
    "tail": Given(
        value=0.186, low=0.165, high=0.205, unit="body length",
        source=f"way of the tail from side to side: {_FILM}; between first harmonic and root mean "
        "square",
    ),
    "wide": Given(value=0.8, low=0.6, high=1.0, unit="-", source=f"factor on the drawn width, {_DRAWING}"),
    "high": Given(value=1.0, low=0.85, high=1.15, unit="-", source=f"factor on the drawn height, {_DRAWING}"),
}  # fmt: skip
contestant = SingleContestant(
    Contestant(
        name="filmed_lamprey",
        title="One film of a lamprey",
        description="A sea lamprey of 0.155 m swims freely in a tank, some four beats in a slight curve. Frequency, "
        "wavelength and envelope are those of the film.",
        inputs=_GIVEN | SWIM.water(_GIVEN),
        predicts={"stride": Quantity(unit="body length", words="stride, the way in a beat")},
        rungs=rungs(SwimTask(build=build, read_quantities=read, cycles=10, filmed_swing=filmed_swing)),
        find_unsteadiness=_unsteadiness,
    )
)  # fmt: skip

"""A rock prickleback, an eel-like fish of the shore, swims slowly: how far it comes in a beat."""

from collections.abc import Mapping

from evidence.league import Contestant, Found, Given, Numbers, Quantity, SingleContestant
from evidence.league.cases._films import FilmedSwim, LongBody, filmed_swing
from evidence.league.judging import unsteady_wave
from evidence.league.swims import ModelSwimmer, SwimPrediction, SwimTask, rungs

_FILM = (
    "public key points of a swimming rock prickleback (Xiphister mucosus), trial XMUC02, 711 frames, "
    "github.com/tytell/fishmechr, xmucosusdata (CC BY 4.0) [computed here]"
)
_DRAWING = (
    "widths of the eel in fishwidth of the same package, which its vignette takes for this fish; height a tenth of the "
    "length, with one fin from the trunk round the tail, from memory of the animal"
)
_POSITIONS = (0.0, 0.197, 0.332, 0.486, 0.628, 0.745, 0.863, 1.0)
_SHAPE = (0.26, 0.21, 0.25, 0.35, 0.41, 0.55, 0.71, 1.0)
FREQUENCY, WAVELENGTH = 0.44, 0.905
"""Filmed beat [Hz] and length of a whole wave [body length]."""
_BODY = LongBody(
    name="prickleback",
    stations=(0.0, 0.05, 0.10, 0.20, 0.30, 0.50, 0.70, 0.80, 0.90, 0.96, 1.0),
    half_width=(0.010, 0.020, 0.024, 0.019, 0.020, 0.019, 0.016, 0.013, 0.011, 0.006, 0.004),
    half_height=(0.014, 0.030, 0.040, 0.046, 0.048, 0.047, 0.042, 0.037, 0.030, 0.026, 0.020),
)
_SWIM = FilmedSwim(body=_BODY, positions=_POSITIONS, shape=_SHAPE)


def build(numbers: Numbers, frequency: float | None) -> ModelSwimmer:
    """Return the fish with its filmed wave."""
    del frequency
    return _SWIM.swimmer(numbers)


def read(numbers: Numbers, swimmer: ModelSwimmer, swum: SwimPrediction) -> Found:
    """Return the stride of a swim."""
    del numbers
    return {"stride": swum.speed / swum.frequency / swimmer.robot.length}


def _unsteadiness(measured: Mapping[str, float]) -> str:
    """Return why what was measured is no steady swim; empty if it can be one."""
    return unsteady_wave(measured["stride"] * FREQUENCY, FREQUENCY * WAVELENGTH) if "stride" in measured else ""


_GIVEN = {
    "length": Given(
        value=0.22, low=0.12, high=0.40, unit="m",
        source="key points in pixels without a scale; fish of this kind in laboratories have 0.12 to 0.4 m "
        "[memory]",
    ),
    "frequency": Given(
        value=FREQUENCY, low=0.40, high=0.90, unit="Hz",
        source=f"{_FILM}: at 60 frames a second, as the vignette of the package has it; up to twice as many",
    ),
    "wavelength": Given(
        value=WAVELENGTH, low=0.82, high=0.98, unit="body length",
        source=f"phase of the lateral motion behind the first quarter: {_FILM}",
    ),
    "tail": Given(
        value=0.28, low=0.24, high=0.32, unit="body length",
        source=f"way of the tail from side to side: {_FILM}",
    ),
    "wide": Given(value=1.0, low=0.8, high=1.3, unit="-", source=f"factor on the drawn width: {_DRAWING}"),
    "high": Given(value=1.0, low=0.75, high=1.2, unit="-", source=f"factor on the drawn height: {_DRAWING}"),
}  # fmt: skip
contestant = SingleContestant(
    Contestant(
        name="prickleback",
        title="A rock prickleback",
        description="A rock prickleback (Xiphister mucosus) swims freely and slowly, five beats in a slight curve. "
        "Wavelength and envelope are those of the film; its scale and its frequency are not known, and matter through "
        "friction only.",
        inputs=_GIVEN | _SWIM.water(_GIVEN),
        predicts={"stride": Quantity(unit="body length", words="stride, the way in a beat")},
        rungs=rungs(SwimTask(build=build, read_quantities=read, cycles=10, filmed_swing=filmed_swing)),
        find_unsteadiness=_unsteadiness,
    )
)  # fmt: skip

"""How fast a robot swims in real water: one sentence with the range over the models that apply to it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite

from suchus.core.checks import Checks

DEFAULT_MODEL = "sections"
"""Model whose speed is the answer: forces section by section, at the robot's own Reynolds number."""
_FLOW_RANGE = 2.0
"""Ratio of Reynolds numbers up to which the speed of a computed flow is a speed of the robot [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WaterModel:
    """A model of the water, and where it applies."""

    label: str
    """Name of the model in a sentence."""
    omission: str
    """What the model leaves out."""
    min_reynolds: float = 0.0
    """Least frequency times length squared over viscosity at which it applies [-]."""
    max_reynolds: float = inf
    """Greatest such number [-]."""
    needs_forward_speed: bool = False
    """Whether it is invalid for a body that swims tail first."""


MIN_DRAG_REYNOLDS, MAX_DRAG_REYNOLDS = 5e3, 3e6
"""Range of frequency times length squared over viscosity in which a section's drag coefficient is nearly constant [-].

The Reynolds number of its sway is then 3e2 to 2e5, with a sway and a height of a tenth of the length (Hoerner 1965,
Fluid-Dynamic Drag, chapter 3).
"""
WATER_MODELS: Mapping[str, WaterModel] = {
    "sections": WaterModel(
        label="sections", omission="the wake along the body and the form drag of limbs and head",
        min_reynolds=MIN_DRAG_REYNOLDS, max_reynolds=MAX_DRAG_REYNOLDS,
    ),
    "resistive": WaterModel(
        label="resistive theory", omission="added mass, the surface and the compliance of the axis",
        min_reynolds=MIN_DRAG_REYNOLDS, max_reynolds=MAX_DRAG_REYNOLDS,
    ),
    "reactive": WaterModel(
        label="reactive theory", omission="drag across the body, the surface and the compliance of the axis",
        min_reynolds=MIN_DRAG_REYNOLDS, needs_forward_speed=True,
    ),
    "slice": WaterModel(label="the flow in the plane", omission="the water over and under the body"),
    "space": WaterModel(label="the flow in space", omission="the surface"),
}  # fmt: skip
"""Models of the water by name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SpeedEstimate:
    """The speed of a swim by one model of the water."""

    model: str
    """Name of the model, a key of ``WATER_MODELS``."""
    speed: float
    """Mean speed, forward positive [m/s]."""
    low: float
    """Least speed over the coefficients of the model; the speed itself where they were not varied [m/s]."""
    high: float
    """Greatest speed over them [m/s]."""
    reynolds: float
    """Frequency times length squared over viscosity of the water that the model computed [-]."""

    def __post_init__(self) -> None:
        """Refuse an unknown model and a speed outside its own range."""
        with Checks("speed_estimate", self) as check:
            check.that(
                self.model in WATER_MODELS,
                f"speed_estimate.model is {self.model!r}; there is {', '.join(WATER_MODELS)}",
            )
            check.that(
                not isfinite(self.speed) or self.low <= self.speed <= self.high,
                f"speed_estimate.speed is {self.speed:g} m/s, and its range is {self.low:g} to {self.high:g} m/s; the "
                "speed must lie in it",
            )

    def applies(self, reynolds: float) -> bool:
        """Return whether the model gives a speed of the robot in real water.

        Args:
            reynolds: frequency times length squared over the viscosity of real water [-].
        """
        model = WATER_MODELS[self.model]
        is_same_water = reynolds / _FLOW_RANGE <= self.reynolds <= reynolds * _FLOW_RANGE
        is_valid = model.min_reynolds <= self.reynolds <= model.max_reynolds
        is_forward = self.speed > 0.0 or not model.needs_forward_speed
        return isfinite(self.speed) and is_same_water and is_valid and is_forward


@dataclass(frozen=True, slots=True, kw_only=True)
class RealWaterSpeed:
    """The answer of ``real_water_speed``."""

    reynolds: float
    """Frequency times length squared over the viscosity of real water [-]."""
    estimates: tuple[SpeedEstimate, ...]
    """Estimates of the models that apply, the default model first."""
    other_waters: tuple[SpeedEstimate, ...]
    """Estimates in water of another Reynolds number."""

    @property
    def speed(self) -> float:
        """Speed by the default model; NaN where it does not apply or was not asked [m/s]."""
        speeds = [estimate.speed for estimate in self.estimates if estimate.model == DEFAULT_MODEL]
        return speeds[0] if speeds else float("nan")

    @property
    def low(self) -> float:
        """Least speed by a model that applies; NaN without one [m/s]."""
        return min((estimate.low for estimate in self.estimates), default=float("nan"))

    @property
    def high(self) -> float:
        """Greatest speed by a model that applies; NaN without one [m/s]."""
        return max((estimate.high for estimate in self.estimates), default=float("nan"))

    @property
    def answer(self) -> str:
        """The speed by the default model and the range over the models that apply, in a sentence."""
        number = f"f L²/ν = {self.reynolds:.1e}"
        if not self.estimates:
            return f"How fast it swims in real water is not answered: no model of the water applies at {number}."
        default = self.estimates[0]
        speed = f"{default.speed:.3f} m/s by {WATER_MODELS[default.model].label}"
        if self.low < self.high:
            span = f"{self.low:.3f} to {self.high:.3f} m/s over the models that apply"
            speed = f"{speed}, {span}" if default.model == DEFAULT_MODEL else span
        return f"In real water, at {number}, it swims at {speed}."

    @property
    def omissions(self) -> str:
        """What each model that applies leaves out; empty without one."""
        return "; ".join(
            f"{WATER_MODELS[estimate.model].label} leave{'' if estimate.model == DEFAULT_MODEL else 's'} out "
            f"{WATER_MODELS[estimate.model].omission}"
            for estimate in self.estimates
        )

    @property
    def sentence(self) -> str:
        """The answer, with what each model leaves out."""
        return f"{self.answer.removesuffix('.')} ({self.omissions})." if self.estimates else self.answer

    @property
    def other_waters_sentence(self) -> str:
        """What the speeds in water of another Reynolds number are worth; empty without one."""
        if not self.other_waters:
            return ""
        speeds = " and ".join(
            f"{estimate.speed:.3f} m/s by {WATER_MODELS[estimate.model].label} at {estimate.reynolds:.0f}"
            for estimate in self.other_waters
        )
        return f"In thicker water it is {speeds}: this explains mechanisms and is no speed of the robot."


def real_water_speed(estimates: Sequence[SpeedEstimate], reynolds: float) -> RealWaterSpeed:
    """Return how fast a robot swims in real water, over the models that apply at its Reynolds number.

    A flow applies where it is of water within a factor of two of the robot's Reynolds number; sections and resistive
    theory where the drag coefficient of a section is constant; reactive theory for a body that swims head first.

    Args:
        estimates: speeds of one swim by models of the water.
        reynolds: frequency times length squared over the viscosity of real water [-].
    """
    order = list(WATER_MODELS)
    valid = sorted(
        (estimate for estimate in estimates if estimate.applies(reynolds)),
        key=lambda estimate: order.index(estimate.model),
    )
    thicker = [
        estimate for estimate in estimates if isfinite(estimate.speed) and estimate.reynolds < reynolds / _FLOW_RANGE
    ]
    return RealWaterSpeed(reynolds=reynolds, estimates=tuple(valid), other_waters=tuple(thicker))

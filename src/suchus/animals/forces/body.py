"""The animal's body, what of it and of its world a film does not show, and choices of all that is not known."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np
import xarray as xr
from scipy.stats import norm, qmc

from suchus.animals.capture import Measurement, UnusableTracks, Walk
from suchus.core.checks import Checks
from suchus.robot.design import Robot, Rod, Segment, Shell
from suchus.robot.design.pieces import volumes
from suchus.robot.design.scale import rescale

Rung = Literal["sections", "slice", "space"]
"""Models of the water: forces section by section, a plane flow as deep as the body, the flow around the body."""
RUNGS: tuple[Rung, ...] = get_args(Rung)
"""All of them."""
DRAWS = 39
"""Choices beside the most likely one [-]: whatever their distribution, a fortieth answer lies between the least and the
greatest of 39 in 95 of 100 cases."""
_Z_95 = float(norm.ppf(0.975))  # standard errors in half a 95 % interval
_POSITIVE = ("stride", "stride_length", "period", "trunk_length", "lift", "stroke", "spine_lateral", "tail_lateral")
_SHARES = ("duty", "retraction")
_REQUIRED_NUMBERS, _REQUIRED_FOOT_NUMBERS = ("period", "speed"), ("duty", "phase")  # numbers that must have an interval
_SEED = 35


@dataclass(frozen=True, slots=True, kw_only=True)
class Unknown:
    """What a film does not show, each as the ends of its range; a choice is drawn evenly from it."""

    mass: tuple[float, float] | None = None
    """Mass of the animal [kg]; None: 0.7 to 1.4 times what the named body weighs at the animal's length."""
    friction: tuple[float, float] = (0.4, 1.0)
    """Coefficient of friction between feet and ground [-]: rubber or claws on wood, stone and soil. A film whose
    feet do not slip shows only that there was enough of it."""
    lift: tuple[float, float] = (0.5, 1.5)
    """How high feet are lifted where no heights were seen, over what the gait does that lends it [-]."""
    height: tuple[float, float] = (0.95, 1.05)
    """Height of the hips over what that gait has [-]: markers lie on the skin."""
    cross_drag: tuple[float, float] = (0.8, 1.8)
    """Drag coefficient of a section that moves sideways [-]: ellipses across, and what fins and oscillation add
    (Hoerner 1965; docs/amphibious.md)."""
    thickening: tuple[float, float] = (1.0, 3.0)
    """Friction over that of a flat plate [-]: 1.1 to 1.9 on swimming fish (Anderson, McGillis and Grosenbaugh 2001)."""
    added_mass: tuple[float, float] = (0.7, 1.3)
    """Added mass of sections over that of ideal water [-]."""
    shedding: tuple[float, float] = (0.3, 1.2)
    """Share of Lighthill's momentum that is shed at the end of the tail [-]."""
    viscosity: tuple[float, float] = (0.9e-6, 1.15e-6)
    """Kinematic viscosity of fresh water at 15 to 25 C [m2/s]."""
    draws: int = DRAWS
    """Choices beside the most likely one [-]; see ``DRAWS``."""

    def __post_init__(self) -> None:
        """Refuse ranges out of bounds or in the wrong order."""
        with Checks("unknown", self) as check:
            check.whole("draws", 3, 10_000)
            for name, lower_bound, upper_bound in (
                ("mass", 1e-6, 1e5), ("friction", 0.01, 5.0), ("lift", 0.0, 5.0), ("height", 0.2, 3.0),
                ("cross_drag", 0.0, 10.0), ("thickening", 0.0, 100.0), ("added_mass", 0.0, 10.0),
                ("shedding", 0.0, 10.0), ("viscosity", 1e-9, 1.0),
            ):  # fmt: skip
                bounds = getattr(self, name)
                check.that(
                    bounds is None or (len(bounds) == 2 and lower_bound <= bounds[0] <= bounds[1] <= upper_bound),
                    f"unknown.{name} is {bounds}; a range is two numbers from {lower_bound:g} to {upper_bound:g}, "
                    "the lower one first",
                )

    def masses(self, body: Robot) -> tuple[float, float]:
        """Return the range of the mass of an animal, the named body at its length [kg]."""
        return self.mass or (0.7 * body.mass, 1.4 * body.mass)


def middle(ends: tuple[float, float]) -> float:
    """Return the most likely value of a range."""
    return 0.5 * (ends[0] + ends[1])


def interpolate_bounds(ends: tuple[float, float], fraction: float) -> float:
    """Return the value at a fraction of a range, 0 to 1."""
    return float(ends[0] + fraction * (ends[1] - ends[0]))


def choices(names: Sequence[str], count: int) -> list[dict[str, float]]:
    """Return choices of what is not known, each number a share of its distribution, by a Latin hypercube.

    Args:
        names: names of what is not known.
        count: choices.
    """
    shares = qmc.LatinHypercube(d=len(names), rng=np.random.default_rng(_SEED)).random(count)
    return [{name: float(share) for name, share in zip(names, row, strict=True)} for row in shares]


def errors(share: float) -> float:
    """Return the deviation at a quantile of the normal distribution, in half widths of a 95 % interval [-]."""
    return float(norm.ppf(np.clip(share, 1e-6, 1 - 1e-6))) / _Z_95


def names_with_interval(walk: Walk) -> tuple[str, ...]:
    """Return the names of the numbers of a walk that have an interval, and refuse a walk without the required ones.

    Names of quantities of a leg end in that leg, as in ``duty_LF``.

    Raises:
        UnusableTracks: a number that the forces depend on has no interval, because too few cycles were seen.
    """
    with_interval = tuple(name for name, measurement in walk.numbers.items() if np.isfinite(measurement.error))
    required = [
        name for name in walk.numbers if name in _REQUIRED_NUMBERS or name.partition("_")[0] in _REQUIRED_FOOT_NUMBERS
    ]
    lacking = [name for name in required if name not in with_interval]
    if lacking:
        raise UnusableTracks(
            f"{walk.source} shows {walk.cycles:.1f} cycles, by which {' and '.join(lacking)} "
            f"ha{'ve' if len(lacking) > 1 else 's'} no interval, and so no force has one: film one more cycle."
        )
    return with_interval


def sample_walk(walk: Walk, shares: Mapping[str, float]) -> Walk:
    """Return a possible walk: each number is at a quantile of its distribution.

    Args:
        walk: the measured walk.
        shares: quantile of each of ``names_with_interval(walk)`` in its distribution, 0 to 1 [-].
    """
    numbers = dict(walk.numbers)
    for name, measurement in walk.numbers.items():
        if name in shares and np.isfinite(measurement.error):
            numbers[name] = measurement._replace(value=_deviate(name, measurement, errors(shares[name])))
    bends = dict(walk.bends)
    for region in ("spine", "tail"):
        name = f"{region}_lateral"
        if name in bends and name in numbers and abs(bends[name]) > 0.0:
            turn = bends[name] / abs(bends[name])
            turn *= np.exp(-2j * np.pi * _change(walk, numbers, "spine_rightmost"))
            turn *= np.exp(-2j * np.pi * _change(walk, numbers, "tail_lag")) if region == "tail" else 1.0
            bends[name] = complex(numbers[name].value * turn)
    return replace(walk, numbers=numbers, bends=bends)


def _change(walk: Walk, numbers: Mapping[str, Measurement], name: str) -> float:
    return numbers[name].value - walk.numbers[name].value if name in numbers else 0.0


def _deviate(name: str, measurement: Measurement, deviation: float) -> float:
    """Return a possible value of a measured number, within the range that its quantity allows.

    Fractions of the cycle stay within 0.05 and 0.95. Positive quantities stay above 2 % of the measured value.

    Args:
        name: name of the number, as in ``Walk.numbers``.
        measurement: measured value with the half width of its 95 % interval.
        deviation: deviation from the measured value [half width of the interval].
    """
    value, stem = measurement.value + deviation * measurement.error, name.partition("_")[0]
    if stem in _SHARES:
        return float(np.clip(value, 0.05, 0.95))
    if stem in _POSITIVE or name in _POSITIVE:
        return float(max(value, 0.02 * measurement.value))
    return float(value)


def resize_body(robot: Robot, length: float, mass: float | None = None) -> Robot:
    """Return a body scaled in length, and in mass.

    Args:
        robot: the body.
        length: factor on its lengths [-].
        mass: mass of the whole body [kg]; in proportion to the cube of the length if None.
    """
    is_unchanged = abs(length - 1.0) < 1e-12 and mass is None
    return robot if is_unchanged else rescale(robot, length_factor=length, mass_factor=mass and mass / robot.mass)


def widen_body(robot: Robot, volume: float) -> Robot:
    """Return a body with a given volume and the same length; width and height of its axis are scaled.

    Args:
        robot: the body.
        volume: volume of the whole body [m3].
    """
    for _ in range(30):
        current_volume = sum(volumes(robot).values())
        if abs(current_volume / volume - 1.0) < 1e-9:
            break
        factor = (volume / current_volume) ** 0.5
        robot = replace(robot, axis=tuple(_wider(segment, factor) for segment in robot.axis))
    return robot


def _wider(segment: Segment, factor: float) -> Segment:
    """Return a segment whose sections are larger by a factor and whose length is the same."""

    def scale_section(place: tuple[float, float, float]) -> tuple[float, float, float]:
        return place[0], factor * place[1], factor * place[2]

    shapes: list[Rod | Shell] = []
    for shape in segment.shapes:
        if isinstance(shape, Shell):
            half = shape.half[0], factor * shape.half[1], factor * shape.half[2]
            shapes.append(replace(shape, at=scale_section(shape.at), half=half))
        else:
            shapes.append(
                replace(
                    shape, start=scale_section(shape.start), end=scale_section(shape.end), radius=factor * shape.radius
                )
            )
    return replace(segment, shapes=tuple(shapes))


def add_with_interval(
    data: xr.Dataset,
    name: str,
    dims: tuple[str, ...],
    answers: np.ndarray,
    description: tuple[str, str],
) -> None:
    """Add the first of several results to a dataset, with the least and the greatest as ends of its interval.

    Args:
        data: the dataset.
        name: name of the variable.
        dims: dimensions of a value.
        answers: each as ``dims`` say, the most likely one first.
        description: its unit and what it is.
    """
    unit, meaning = description
    ends = {"": answers[0], "_low": np.min(answers, axis=0), "_high": np.max(answers, axis=0)}
    ending = {"": "", "_low": ", lower end of the 95 % interval", "_high": ", upper end of the 95 % interval"}
    for end, value in ends.items():
        data[f"{name}{end}"] = (dims, value, {"units": unit, "long_name": f"{meaning}{ending[end]}"})


class Quantities:
    """Quantities with their intervals, a row each."""

    def __init__(self) -> None:
        self._rows: list[tuple[str, float, float, float, str, str, float, float, str]] = []

    def add(
        self, name: str, answers: Sequence[float], unit: str, meaning: str,
        published: tuple[float, float, str] = (np.nan, np.nan, ""),
    ) -> None:  # fmt: skip
        """Add a quantity.

        Args:
            name: of it.
            answers: the most likely one first.
            unit: of it.
            meaning: what it is.
            published: of animals, its standard deviation over trials, and the source.
        """
        finite_answers = np.asarray(answers, dtype=float)
        finite_answers = finite_answers if np.isfinite(finite_answers).any() else np.zeros(1) * np.nan
        lower_bound, upper_bound = (
            (float(np.nanmin(finite_answers)), float(np.nanmax(finite_answers)))
            if np.isfinite(finite_answers).any()
            else (np.nan,) * 2
        )
        self._rows.append((name, float(finite_answers[0]), lower_bound, upper_bound, unit, meaning, *published))

    def dataset(self) -> xr.Dataset:
        """Return the rows, over ``quantity``."""
        columns = list(zip(*self._rows, strict=True))
        data = xr.Dataset(coords={"quantity": ("quantity", list(columns[0]))})
        meanings = {
            "value": "with the most likely numbers",
            "low": "lower end of the 95 % interval",
            "high": "upper end of the 95 % interval",
            "unit": "unit of the quantity",
            "meaning": "what it is",
            "animals": "the same of animals, as published",
            "animals_spread": "its standard deviation over trials",
            "source": "where that is published",
        }
        for (name, meaning), column in zip(meanings.items(), columns[1:], strict=True):
            values = list(column) if isinstance(column[0], str) else np.array(column, dtype=float)
            data[name] = ("quantity", values, {"long_name": meaning})
        return data

"""Article, ours and animal side by side."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from suchus.apps.report.result import Result
from suchus.article.paper import CLAIMS, CRAWL_END, CRAWL_START
from suchus.article.paper.animals import ANIMALS, Animal
from suchus.robot.design import LEGS, Robot, behind_hips, lacking
from suchus.visual.pages import number, quantity


@dataclass(frozen=True, slots=True, kw_only=True)
class ComparisonRow:
    """One row of the comparison."""

    animal: Animal
    """The animal's quantity, with its range."""
    article: str
    """Value in the article, as text; empty if it gives none."""
    robot_text: str
    """Value of the robot, as text."""
    animal_text: str
    """Value or range of the animal, as text."""
    experiment: str
    """Experiment that measured the robot's value; empty if it follows from the design."""


Results = Mapping[str, Result]
_TAIL = ("limbs", "tail_yaw")  # needed of a robot whose tail is compared: a tail behind the hips that bends
_DURATION = CRAWL_END - CRAWL_START
_COORDINATED, _LIMBS_ONLY = CLAIMS["displacement_coordinated"].value, CLAIMS["displacement_limbs_only"].value


def compare_with_animals(robot: Robot, results: Results) -> tuple[ComparisonRow, ...]:
    """Return the rows whose experiment was run.

    Args:
        robot: the robot of the page.
        results: results by experiment.
    """
    rows = (_row(animal, robot, results) for animal in ANIMALS)
    return tuple(row for row in rows if row is not None)


def _row(animal: Animal, robot: Robot, results: Results) -> ComparisonRow | None:
    """Return the row of one animal's number; None if the robot or the results give no value for it."""
    experiment, measure, article_value = _COMPARISONS[animal.key]
    value = measure(robot, results)
    if value is None:
        return None
    return ComparisonRow(
        animal=animal,
        article=quantity(article_value, animal.unit, 2),
        robot_text=quantity(value, animal.unit, 2),
        animal_text=_range(animal),
        experiment=experiment,
    )


def _range(animal: Animal) -> str:
    if animal.low == animal.high:
        return quantity(animal.low, animal.unit, 3)
    return f"{number(animal.low, 2)} to {quantity(animal.high, animal.unit, 3)}"


def _measured(results: Results, experiment: str, *names: str) -> list[float] | None:
    """Return values of measures of an experiment; None if the experiment or one of the values is missing."""
    if experiment not in results:
        return None
    outcome = results[experiment].outcome["measures"]
    values = [outcome.get(name, {}).get("value") for name in names]
    return None if any(value is None for value in values) else values


def _tail_length(robot: Robot, _: Results) -> float | None:
    return None if lacking(robot, _TAIL) else behind_hips(robot) / robot.length


def _tail_mass(robot: Robot, _: Results) -> float | None:
    if lacking(robot, _TAIL):
        return None
    tail_segments = robot.axis[robot.root_index + 1 :]
    return sum(shape.mass for segment in tail_segments for shape in segment.shapes) / robot.mass


def _mass(robot: Robot, _: Results) -> float | None:
    return robot.mass if 0.46 <= robot.length <= 1.27 else None


def _speed(_: Robot, results: Results) -> float | None:
    distances = _measured(results, "displacement", "forward_coordinated")
    return distances[0] / _DURATION if distances else None


def _high_walk_speed(_: Robot, results: Results) -> float | None:
    speeds = _measured(results, "speed_range", "speed_high_walk")
    return speeds[0] if speeds else None


def _stride_share(_: Robot, results: Results) -> float | None:
    distances = _measured(results, "displacement", "forward_coordinated", "forward_limbs_only")
    return 1.0 - distances[1] / distances[0] if distances else None


def _duty_factor(_: Robot, results: Results) -> float | None:
    duty_factors = _measured(results, "gait_diagram", *(f"duty_factor_{leg}" for leg in LEGS))
    return sum(duty_factors) / len(duty_factors) if duty_factors else None


def _death_roll(_: Robot, results: Results) -> float | None:
    roll_rates = _measured(results, "death_roll", "rate_c_shape_water")
    return abs(roll_rates[0]) if roll_rates else None


_Measured = Callable[[Robot, Results], float | None]
_COMPARISONS: Mapping[str, tuple[str, _Measured, float | None]] = MappingProxyType(
    {
        "tail_length": ("", _tail_length, CLAIMS["tail_share"].value),
        "tail_mass": ("", _tail_mass, None),
        "mass": ("", _mass, None),
        "speed": ("displacement", _speed, _COORDINATED / _DURATION if _COORDINATED else None),
        "high_walk_speed": ("speed_range", _high_walk_speed, CLAIMS["high_walk_speed_low"].value),
        "stride_share": (
            "displacement",
            _stride_share,
            1.0 - _LIMBS_ONLY / _COORDINATED if _COORDINATED and _LIMBS_ONLY else None,
        ),
        "duty_factor": ("gait_diagram", _duty_factor, None),
        "death_roll": ("death_roll", _death_roll, None),
    }
)

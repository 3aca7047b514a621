"""When do spine and tail pay, each gait at its own best?"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import degrees, radians
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from suchus.article.verdict import listed
from suchus.core.checks import Checks
from suchus.core.intervals import median_interval
from suchus.experiments.catalog.spine_and_tail_map.cells import (
    ARMS,
    FREE,
    STILL,
    Cell,
    arm_searches,
    on_fields_of_their_own,
    search_in_cell,
    with_tail_size,
)
from suchus.experiments.catalog.spine_and_tail_map.figure import draw_map
from suchus.experiments.experiment import (
    Experiment,
    Measure,
    Measures,
    Outcome,
    Progress,
    SimulationResult,
    silent,
    staged,
)
from suchus.experiments.optimise.ready import search_gait
from suchus.robot.design import GRAVITY, Robot
from suchus.robot.design.ground import BUMPS_START, Bumps
from suchus.robot.design.scale import coarse_step
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START, Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Grains, Ground, Run, Tolerances, simulate
from suchus.sim.metrics import (
    cost_of_transport,
    displacement,
    duty_factor,
    electrical_cost_of_transport,
    limb_load,
    slip,
    support_distance,
    tail_load_share,
    time_window,
)
from suchus.visual.figures import captioned

QUANTITIES = (
    ("gain", "farther per cycle [m]", 0.0),
    ("cost_ratio", "mechanical cost, ratio [-]", 1.0),
    ("electrical_ratio", "electrical cost, ratio [-]", 1.0),
    ("margin_change", "stability margin [m]", 0.0),
)
"""What the map shows: name in the measures, label with unit, and the value at which both groups are equal."""
_LESS_IS_BETTER = ("cost_ratio", "electrical_ratio")
_EXPLAINING = ("slip", "stance_share", "limb_share", "tail_share")
_UNITS = {"forward": "m", "speed": "m/s", "cost": "1", "electrical": "1", "margin": "m"} | dict.fromkeys(
    _EXPLAINING, "1"
)
_FIRST_SIGMA, _NEXT_SIGMA = 0.2, 0.1  # spread of the first search, and of those that start from its best
_MAX_LISTED = 2  # conditions that a sentence names
_MARGIN_SAMPLES = 8  # instants of the last cycle at which the support is looked at


@dataclass(frozen=True, slots=True, kw_only=True)
class SpineAndTailMap(Experiment):
    """Spine and tail free against a still axis, each with the best gait that a search finds for it, over conditions.

    Both groups search with the same budget, from the same legs, in the same ranges. The search at the base point comes
    first; in each other condition, one axis at a time, both go on from their best there. Then robots as built walk in
    both gaits, and what spine and tail change is that between the two gaits of the same robot. All of it is done with
    several seeds, since a short search may find another gait that is as fast: an interval holds the intervals over
    robots of every search.
    """

    title = "When do spine and tail pay, each gait at its own best?"
    shows = "Beyond the article"
    answers = ("paying_share", "saving_share", "steadier_share", "gain_base", "cost_ratio_base", "margin_change_base")
    needs = ("foot_paths", "axis")
    reproduces = False
    answer_minima: ClassVar[Mapping[str, float]] = {
        "repeats": 6, "searches": 2, "cycles": 2, "base_evaluations": 96, "evaluations": 32,
    }  # fmt: skip

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that crawls."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """Gait from which both groups search, and whose period is that of the base."""
    period_factors: tuple[float, ...] = (0.5, 1.5)
    """Periods over that of the gait [-]."""
    slopes: tuple[float, ...] = (radians(-8.0), radians(8.0))
    """Slopes of the ground along the walk, up positive [rad]."""
    frictions: tuple[float, ...] = (0.5, 1.5)
    """Factors on the friction of all surfaces [-]."""
    bump_heights: tuple[float, ...] = (0.02, 0.04)
    """Heights of bumps [m]; each robot as built walks on a field of its own."""
    correlation: float = 0.06
    """Correlation length of the bumps, about the length of a foot [m]."""
    tail_sizes: tuple[float, ...] = (0.7, 1.4)
    """Factors on width and height of the tail, and so on its area [-]."""
    strengths: tuple[float, ...] = (0.464e6, 2e6)
    """Strengths of grains: closely packed poppy seeds, and firm sand [N/m3]."""
    base_evaluations: int = 96
    """Gaits that each group may try at the base point [-]."""
    evaluations: int = 32
    """Gaits that each group may try in each other condition [-]."""
    searches: int = 2
    """Searches with seeds of their own; what is decided is decided by each of them [-]."""
    population: int = 8
    """Gaits of a generation [-]."""
    search_cycles: int = 1
    """Cycles of each walk of the search [-]."""
    cycles: int = 2
    """Cycles that are measured of the robots as built [-]."""
    repeats: int = 6
    """Robots built of the design that walk in each condition; six at least give an interval [-]."""
    tolerances: Tolerances = field(default_factory=Tolerances)
    """By how much they and their grounds differ from the design."""
    seed: int = 0
    """Seed of the first search and of the errors of its robots; the next search has the next one [-]."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.whole("base_evaluations", 1, 100_000)
            check.whole("evaluations", 1, 100_000)
            check.whole("population", 4, 1000)
            check.whole("searches", 1, 100)
            check.whole("search_cycles", 1, 100)
            check.whole("cycles", 1, 100)
            check.whole("repeats", 1, 1000)
            check.whole("seed", 0, 2**31)
            check.number("correlation", 1e-4, 10.0, "m")
            for name, low, high, unit in (
                ("period_factors", 0.05, 20.0, ""), ("slopes", -1.0, 1.0, "rad"), ("frictions", 0.01, 10.0, ""),
                ("bump_heights", 1e-5, 0.5, "m"), ("tail_sizes", 0.1, 10.0, ""), ("strengths", 1e3, 1e9, "N/m3"),
            ):  # fmt: skip
                values = getattr(self, name)
                check.that(
                    all(low <= value <= high for value in values) and len(set(values)) == len(values),
                    f"{self.name()}.{name} is {values}; each value must be from {low:g} to {high:g} {unit}, and once",
                )

    def quick(self) -> "SpineAndTailMap":
        """Return the base and half the friction, a few gaits each, and two robots as built."""
        return replace(
            self, period_factors=(), slopes=(), frictions=(0.5,), bump_heights=(), tail_sizes=(), strengths=(),
            base_evaluations=6, evaluations=6, population=4, searches=1, cycles=1, repeats=2,
        )  # fmt: skip

    def gaits_for_robot(self, robot: Robot) -> dict[str, Any]:
        """Return the gait from which both groups of another robot search; grains stay what they are.

        Raises:
            UnsuitedRobot: its limbs follow no paths.
        """
        return {"gait": search_gait(robot), "strengths": self.strengths}

    @property
    def has_tail(self) -> bool:
        """Whether the robot has a tail."""
        return self.robot.root_index < len(self.robot.axis) - 1

    @property
    def axis_name(self) -> str:
        """Name of what bends, for sentences."""
        return "spine and tail" if self.has_tail else "a bending trunk"

    def cells(self) -> list[Cell]:
        """Return the conditions, the base first; those of the tail's size only for a robot with a tail."""
        robot, period = self.robot, self.gait.period
        size = round(robot.length / ROBOTS["caiman"].length, 9)
        bumps = [
            Ground(
                relief=Bumps(height=height, correlation=self.correlation, start=BUMPS_START * size, seed=0, scale=size)
            )
            for height in self.bump_heights
        ]
        sloping = [(value, Ground(uphill=value)) for value in self.slopes]
        return [
            Cell("base", "base", "base", robot, Ground(), period),
            *(
                Cell(_name("period", factor), "period", f"period x {factor:g}", robot, Ground(), factor * period)
                for factor in self.period_factors
            ),
            *(
                Cell(_name("slope", degrees(value)), "slope", f"slope {degrees(value):+.3g} deg", robot, ground, period)
                for value, ground in sloping
            ),
            *(
                Cell(
                    _name("friction", factor),
                    "friction",
                    f"friction x {factor:g}",
                    robot,
                    Ground(friction_scale=factor),
                    period,
                )
                for factor in self.frictions
            ),
            *(
                Cell(_name("bumps", 1e3 * height), "roughness", f"bumps {1e3 * height:.3g} mm", robot, ground, period)
                for height, ground in zip(self.bump_heights, bumps, strict=True)
            ),
            *(
                Cell(
                    _name("tail", size), "tail", f"tail area x {size:g}", with_tail_size(robot, size), Ground(), period
                )
                for size in (self.tail_sizes if self.has_tail else ())
            ),
            *(
                Cell(
                    _name("grains", strength / 1e6),
                    "grains",
                    f"grains {strength / 1e6:.3g} N/cm3",
                    robot,
                    Ground(grains=Grains(strength=strength)),
                    period,
                )
                for strength in self.strengths
            ),
        ]

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Search the best gait of each group in each condition, and let robots as built walk in both."""
        parts = [
            self._searched(self.seed + i, staged(progress, f"search {i + 1}", i / self.searches, 1 / self.searches))
            for i in range(self.searches)
        ]
        record = xr.concat([record for record, _ in parts], "search")
        lines = [f"search {i + 1}, {line}" for i, (_, gaits) in enumerate(parts) for line in gaits]
        return SimulationResult(
            record=record.assign_attrs(cycles=self.cycles), tables={"best_gaits.txt": "\n".join(lines) + "\n"}
        )

    def _searched(self, seed: int, progress: Progress) -> tuple[xr.Dataset, list[str]]:
        """Return numbers of robots as built over ``cell``, ``arm`` and ``repeat``, and the gaits that were found.

        Args:
            seed: seed of the search and of the robots' errors.
            progress: told the share that is done.
        """
        cells, searches = self.cells(), arm_searches(self.robot, self.gait, seed)
        best: dict[str, Gait] = {}
        tables: list[xr.Dataset] = []
        gaits: list[str] = []
        for number, cell in enumerate(cells):
            stage = staged(progress, cell.label, number / len(cells), 0.8 / len(cells))
            pair, kept = {}, {}
            for arm, spec in searches.items():
                pair[arm], kept[arm] = search_in_cell(
                    spec,
                    cell,
                    best.get(arm, spec.run.gait),
                    evaluations=self.evaluations if best else self.base_evaluations,
                    population=self.population,
                    cycles=self.search_cycles,
                    sigma=_NEXT_SIGMA if best else _FIRST_SIGMA,
                    progress=stage,
                )
            tables.append(
                self._walked(cell, pair, seed).assign(keeps_limits=("arm", [kept[arm] for arm in ARMS], {"units": "1"}))
            )
            gaits += [f"{cell.label}, {arm}: {pair[arm]!r}" for arm in ARMS]
            best = best or pair
        record = xr.concat(tables, "cell").assign_coords(
            cell=[cell.name for cell in cells], label=("cell", [cell.label for cell in cells])
        )
        return record, gaits

    def _walked(self, cell: Cell, gaits: Mapping[str, Gait], seed: int) -> xr.Dataset:
        """Return numbers of robots as built that walk in the gait of each group, over ``arm`` and ``repeat``."""
        designed = [Run(robot=cell.robot, gait=gaits[arm], ground=cell.ground, label=arm) for arm in ARMS]
        runs = on_fields_of_their_own(self.tolerances.repeats(designed, self.repeats, seed), self.repeats)
        record = simulate(
            runs,
            duration=round(START + self.cycles * cell.period, 2),
            timestep=coarse_step(cell.robot),
            sample_stride=2,
        )
        forward = displacement(record).sel(xyz="x") / self.cycles
        loads = limb_load(time_window(record, START)).sel(xyz="z").sum("leg").mean("time")
        numbers = {
            "forward": forward,
            "speed": forward / cell.period,
            "cost": cost_of_transport(record),
            "electrical": electrical_cost_of_transport(record),
            "margin": _margin(record, cell.period),
            "slip": slip(record),
            "stance_share": duty_factor(record).mean("leg"),
            "limb_share": loads / (record.mass * GRAVITY),
            "tail_share": tail_load_share(record),
        }
        shape = (len(ARMS), self.repeats)
        return xr.Dataset(
            {
                name: (("arm", "repeat"), np.asarray(values, float).reshape(shape), {"units": _UNITS[name]})
                for name, values in numbers.items()
            },
            coords={"arm": list(ARMS)},
        )

    def measure(self, record: xr.Dataset) -> Measures:
        """Return what spine and tail change in each condition, with intervals, and in how many they pay."""
        measures = Measures()
        free, still = (record.sel(arm=arm) for arm in (FREE, STILL))
        moves = (free.forward > 0.0) & (still.forward > 0.0)  # who does not get on has no cost of transport
        changes = {
            "gain": (free.forward - still.forward, "m"),
            "cost_ratio": ((free.cost / still.cost).where(moves), "-"),
            "electrical_ratio": ((free.electrical / still.electrical).where(moves), "-"),
            "margin_change": (free.margin - still.margin, "m"),
        }
        for cell in record.cell.values:
            for name, (values, unit) in changes.items():
                measures |= _over_searches(f"{name}_{cell}", values.sel(cell=cell).values, unit)
            for arm, of_arm in ((FREE, free), (STILL, still)):
                for name in ("forward", "speed", "cost", *_EXPLAINING):
                    unit = _UNITS[name].replace("1", "-")
                    middle = float(of_arm[name].sel(cell=cell).median())
                    measures[f"{name}_{arm}_{cell}"] = Measure(middle, unit)
        words = words_of(measures)
        for share, quantity in (
            ("paying", "gain"), ("saving", "cost_ratio"), ("saving_electrical", "electrical_ratio"),
            ("steadier", "margin_change"),
        ):  # fmt: skip
            of_quantity = [words[f"{quantity}_{cell}"] for cell in record.cell.values]
            measures[f"{share}_share"] = Measure(of_quantity.count("pays") / len(of_quantity), "-")
        measures["limits_kept_share"] = Measure(float(record.keeps_limits.mean()), "-")
        return measures

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say where spine and tail pay, what they cost, and why, in three sentences."""
        labels = {cell.name: cell.label for cell in self.cells()}
        numbers = Measures((name, Measure(value, "-")) for name, value in measures.items())
        words = words_of(numbers)
        gains = {cell: measures[f"gain_{cell}"] for cell in labels}
        most, least = max(gains, key=gains.__getitem__), min(gains, key=gains.__getitem__)
        return self.render_explanation(
            measures,
            axis=self.axis_name,
            reach=listed_words(words, "gain", labels, ("farther", "less far")),
            work=listed_words(words, "cost_ratio", labels, ("less work", "more")),
            supply=listed_words(words, "electrical_ratio", labels, ("less energy", "more")),
            steady=listed_words(words, "margin_change", labels, ("a larger margin", "a smaller one")),
            most=labels[most],
            least=labels[least],
            largest_gain=gains[most],
            smallest_gain=gains[least],
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the map: what spine and tail change in each condition, with intervals."""
        record = outcome.record
        labels = dict(zip(record.cell.values.tolist(), record.label.values.tolist(), strict=True))
        measures = self.measure(record)
        figure = captioned(
            draw_map(labels, QUANTITIES, words_of(measures), measures),
            f"What {self.axis_name} {'change' if self.has_tail else 'changes'} against a still axis, each with the "
            "best gait of a search of equal budget, over conditions that differ from the base in one thing each. "
            "Points are medians over robots as built, lines hold their 95 % intervals in every search. Ratios below "
            f"one and differences above zero favour {self.axis_name}.",
        )
        return {"spine_and_tail_map": figure}


def words_of(measures: Mapping[str, Measure]) -> dict[str, str]:
    """Return for each difference of the map whether spine and tail pay, cost, or neither is decided."""
    words = {}
    for quantity, _, equal in QUANTITIES:
        for name in measures:
            if name.startswith(f"{quantity}_") and f"{name}_low" in measures:
                low, high = measures[f"{name}_low"].value - equal, measures[f"{name}_high"].value - equal
                if quantity in _LESS_IS_BETTER:
                    low, high = -high, -low
                words[name] = "pays" if low > 0.0 else "costs" if high < 0.0 else "undecided"
    return words


def listed_words(
    words: Mapping[str, str], quantity: str, labels: Mapping[str, str], comparatives: tuple[str, str]
) -> str:
    """Return in how many conditions spine and tail pay, cost and are undecided, as a clause; few of them by name.

    Args:
        words: word of each measure.
        quantity: name of the quantity.
        labels: labels of the conditions, by name.
        comparatives: words for a difference in favour of spine and tail, and for one against them.
    """
    of_word = {
        word: [label for cell, label in labels.items() if words[f"{quantity}_{cell}"] == word]
        for word in ("pays", "costs", "undecided")
    }
    favour, against = comparatives
    text = f"{favour} in {len(of_word['pays'])} of {len(labels)}"
    for word, said in (("costs", against), ("undecided", "undecided")):
        cells = of_word[word]
        text += f", {said} in {len(cells)}" * bool(cells)
        text += f" ({listed(cells)})" * (0 < len(cells) <= _MAX_LISTED)
    return text


def _over_searches(name: str, values: np.ndarray, unit: str) -> Measures:
    """Return the median of some searches, and the least interval that holds that of each search.

    Args:
        name: name of the measure.
        values: number of each robot, shape (search, repeat).
        unit: its unit.
    """
    lows, highs = np.transpose([median_interval(of_search) for of_search in values])
    numbers = {name: np.median(values), f"{name}_low": lows.min(), f"{name}_high": highs.max()}
    return Measures({key: Measure(float(value), unit) for key, value in numbers.items()})


def _margin(record: xr.Dataset, period: float) -> np.ndarray:
    """Return how far the projected centre of mass lies within the support by feet and tail, on average [m].

    It is the mean over instants of the last cycle; negative outside, and NaN where nothing carries.

    Args:
        record: record of several runs.
        period: period of the gaits [s].
    """
    end = float(record.time[-1])
    times = end - period * (np.arange(_MARGIN_SAMPLES) + 0.5) / _MARGIN_SAMPLES
    distances = [
        [support_distance(record.isel(run=run), float(time)) for time in times] for run in range(record.sizes["run"])
    ]
    return -np.asarray(distances).mean(axis=1)


def _name(axis: str, value: float) -> str:
    """Return the name of a condition; the names of measures have letters, digits and underscores only."""
    return f"{axis}_{value:.3g}".replace("-", "minus_").replace(".", "_")


experiment = SpineAndTailMap()

"""The law of swimming: Reynolds number over swimming number, over all swimmers of the shelf."""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache, partial
from math import pi

import numpy as np

from evidence.league import Contestant, Found, Given, Numbers, Predictor, Quantity, SingleContestant
from suchus.core.errors import SuchusError
from suchus.core.progress import Progress
from suchus.robot.design import Robot
from suchus.robot.design.needs import lacking
from suchus.robot.design.water import Water
from suchus.robot.gaits import default_gait
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS
from suchus.swimming.water import Outline, cruise, cycle, reactive, resistive, swim_of
from suchus.swimming.water.slender import Model

_STATIONS = 65
_FREQUENCIES = (0.5, 1.0, 2.0)
_GAZZOLA = "Gazzola, Argentina and Mahadevan 2014, Nature Physics 10, 758"


@lru_cache(maxsize=1)
def swimmers() -> tuple[tuple[Robot, Gait], ...]:
    """Return every robot of the shelf whose axis makes the wave of (20), or its own gait, and that swim."""
    found = []
    for _, robot in ROBOTS.sound():
        if lacking(robot, ["axis"]) or robot.hull is not None:
            continue
        try:
            found.append((robot, swim_of(robot)))
        except SuchusError:
            gait = default_gait(robot)
            if not robot.girdles:
                found.append((robot, gait))
    return tuple(found)


def law(model: Model, choices: Sequence[Numbers], progress: Progress) -> list[Found]:
    """Return exponents and prefactor of the law by a theory; laminar in thick water, turbulent in thin."""
    found: list[Found] = []
    for i, numbers in enumerate(choices):
        progress("choices of the numbers", i / len(choices))
        water = Water(cross_drag=numbers["cross_drag"], thickening=numbers["thickening"])
        laminar = resampled(_points(model, replace(water, viscosity=numbers["thick"])), numbers["sample"])
        turbulent = resampled(_points(model, replace(water, viscosity=numbers["thin"])), numbers["sample"])
        slope, prefactor = _fitted(turbulent)
        found.append({"laminar": _fitted(laminar)[0], "turbulent": slope, "prefactor": prefactor})
    return found


def resampled(points: np.ndarray, sample: float) -> np.ndarray:
    """Return the points of as many swimmers, drawn with replacement; of every swimmer once where ``sample`` is 0.

    The swimmers of the shelf stand for all swimmers, so that a law over them is as uncertain as their choice. At least
    two different swimmers are drawn.

    Args:
        points: number of the swimmer, and logarithms of Sw and Re, shape (point, 3).
        sample: which sample is drawn, 0 to 1 [-].

    Source: Efron 1979, Annals of Statistics 7, 1 (bootstrap).
    """
    numbers = np.unique(points[:, 0])
    if sample == 0.0 or len(numbers) < 2:
        return points
    generator, drawn = np.random.default_rng(round(1e6 * sample)), numbers[:1]
    while len(np.unique(drawn)) < 2:
        drawn = generator.choice(numbers, len(numbers))
    return np.concatenate([points[points[:, 0] == number] for number in drawn])


def _points(model: Model, water: Water) -> np.ndarray:
    """Return each swimmer that swims forward, at several frequencies: its number, and the logarithms of Sw and Re."""
    rows = []
    for number, (robot, gait) in enumerate(swimmers()):
        outline = Outline(robot, _STATIONS)
        for factor in _FREQUENCIES:
            motion = replace(gait, period=gait.period / factor)
            try:
                free = cruise(outline, motion, model, water)
            except SuchusError:
                continue
            if free.speed <= 0.0:
                continue
            swing = float(np.ptp(cycle(outline, motion, free.sway, free.turn).y[:, -1]))
            swimming = 2.0 * pi * motion.frequency * swing * robot.length / water.viscosity
            rows.append((number, np.log10(swimming), np.log10(free.speed * robot.length / water.viscosity)))
    return np.array(rows)


def _fitted(points: np.ndarray) -> tuple[float, float]:
    """Return exponent and prefactor of Re = prefactor Sw^exponent, by least squares of logarithms."""
    slope, start = np.polyfit(points[:, 1], points[:, 2], 1)
    return float(slope), float(10.0**start)


contestant = SingleContestant(
    Contestant(
        name="swimming_law",
        title="The law of swimming over all swimmers of the shelf",
        description="Re = U L / nu over Sw = omega A L / nu, A the way of the tail from side to side, of every robot "
        "of the shelf "
        "that swims, at half, once and twice its frequency, by each theory in thin and in thick water.",
        inputs={
            "cross_drag": Given(value=1.1, low=0.8, high=1.8, unit="-", source="ellipses across, Hoerner 1965"),
            "thickening": Given(value=3.0, low=1.0, high=5.0, unit="-", source="range of docs/water.md"),
            "thick": Given(
                value=1e-4,
                low=3e-5,
                high=3e-4,
                unit="m2/s",
                source=f"water in which Sw is 1e2 to 1e4, the laminar range of {_GAZZOLA}",
            ),
            "thin": Given(
                value=1e-7,
                low=3e-8,
                high=3e-7,
                unit="m2/s",
                source=f"water in which Re is beyond 1e5, the turbulent range of {_GAZZOLA}",
            ),
            "sample": Given(
                value=0.0,
                low=0.0,
                high=1.0,
                unit="-",
                source="which swimmers stand for all: 0 takes each of the shelf once, others draw as many with "
                "replacement (Efron 1979, Annals of Statistics 7, 1)",
            ),
        },
        predicts={
            "laminar": Quantity(unit="-", words="exponent of Re over Sw in thick water"),
            "turbulent": Quantity(unit="-", words="exponent of Re over Sw in thin water"),
            "prefactor": Quantity(unit="-", words="prefactor in thin water"),
        },
        rungs={
            "resistive": Predictor(words="resistive theory (Taylor 1952)", work=partial(law, resistive), draws=24),
            "reactive": Predictor(words="reactive theory (Lighthill 1971)", work=partial(law, reactive), draws=24),
        },
        excluded_models={
            "sections": "many bodies of many sizes at many frequencies, whose servos and trim differ",
            "slice, space": "a range of Reynolds numbers that no grid carries",
        },
    )
)

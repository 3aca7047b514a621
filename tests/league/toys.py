"""A contestant whose answers are known: a stone that falls."""

from functools import partial

from evidence.league import Contestant, Given, Predictor, Quantity

GRAVITY = 9.81


def fell(choices, progress):
    progress("falling", 1.0)
    return [
        {"speed": (2.0 * GRAVITY * one["height"]) ** 0.5, "times": (one["height"], 2.0 * one["height"])}
        for one in choices
    ]


def slow(choices, progress):
    return [{"speed": 3.0}, {"speed": 2.0}]


def silent(choices, progress):
    return [{} for _ in choices]


def broken(error, choices, progress):
    raise error


def stone(name="stone", height=(1.0, 0.5, 1.5), source="a ruler", rungs=None) -> Contestant:
    return Contestant(
        name=name,
        title="A stone falls",
        description="From a table.",
        inputs={"height": Given(value=height[0], low=height[1], high=height[2], unit="m", source=source)},
        predicts={
            "speed": Quantity(unit="m/s", words="speed at the ground"),
            "times": Quantity(unit="m", words="heights"),
        },
        rungs=rungs
        or {
            "formula": Predictor(words="a formula", work=fell, draws=200),
            "film": Predictor(words="a film", work=slow, draws=0, interval_source="formula"),
        },
    )


def failing(error) -> Contestant:
    return stone(
        rungs={
            "formula": Predictor(words="a formula", work=fell, draws=20),
            "other": Predictor(words="breaks", work=partial(broken, error), draws=2),
        }
    )

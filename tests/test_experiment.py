import pickle
from dataclasses import dataclass, replace
from typing import ClassVar

import pytest
import xarray as xr

from suchus.article.verdict import Clause, Rule
from suchus.core.errors import AmbiguousName, IncompatibleRecord, InvalidDesign
from suchus.core.progress import portion
from suchus.experiments.experiment import (
    Experiment,
    Measure,
    Measures,
    SimulationResult,
    estimated,
    ranged,
    silent,
    staged,
)
from suchus.robot.motion import Gait


@dataclass(frozen=True)
class Drop(Experiment):
    title = "How far does it fall?"
    shows = "Beyond the article"
    judged_settings = ("ground",)
    judged_minima: ClassVar = {"repeats": 4, "heights": 2}

    ground: str = "floor"
    repeats: int = 4
    heights: tuple[float, ...] = (1.0, 2.0)
    name_of_measure: str = "depth"
    named: tuple[str | Gait, ...] = ()

    @classmethod
    def rules(cls):
        return (
            Rule(
                claim="tail_swing",
                experiment="drop",
                measure="depth",
                holds=(Clause("depth", ">", 0.0, "down is down"),),
                why="It fell by {depth:mm.0f} mm.",
            ),
        )

    def simulate(self, progress=silent):
        return SimulationResult(record=xr.Dataset({"y": ("time", [0.0, -1.0])}))

    def measure(self, record):
        return {self.name_of_measure: Measure(float(-record.y[-1]), "m")}

    def explain(self, measures):
        return f"Gravity: {sum(measures.values()):.1f}   m."

    def draw(self, outcome):
        return {}

    def quick(self):
        return replace(self, repeats=1)


def test_a_run_measures_judges_and_explains_from_its_record():
    outcome = Drop().run()
    assert outcome.measures["depth"].value == 1.0
    (verdict,) = outcome.verdicts
    assert (verdict.verdict, verdict.why) == ("reproduced", "It fell by 1000 mm.")
    assert outcome.decides == "Gravity: 1.0 m."
    assert outcome.unjudged == ""


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ({"ground": "sea"}, "Not judged: ground is sea, and its claims are judged with floor."),
        ({"repeats": 3}, "Not judged: repeats is 3, and 4 at least are needed to meet what is judged."),
        ({"heights": (1.0,)}, "Not judged: heights has 1 values, and 2 at least are needed to meet what is judged."),
        ({"repeats": 5, "heights": (1.0, 2.0, 3.0)}, ""),
    ],
)
def test_what_cannot_answer_is_not_judged(fields, sentence):
    outcome = replace(Drop(), **fields).run()
    assert outcome.unjudged == sentence
    assert bool(outcome.verdicts) == (sentence == "")
    assert outcome.measures


def test_a_measure_that_a_rule_lacks_is_named():
    with pytest.raises(IncompatibleRecord, match="tail_swing needs depth, which drop did not measure"):
        Drop(name_of_measure="width").run()


def test_progress_of_a_stage_fills_its_part():
    seen = []
    report = staged(lambda stage, share: seen.append((stage, share)), "middle", 0.25, 0.75)
    report("its own", 0.0)
    report("its own", 0.5)
    report("its own", 1.0)
    assert seen == [("middle", 0.25), ("middle", 0.5), ("middle", 0.75)]


def test_progress_of_one_part_of_several_keeps_the_names_of_its_stages():
    seen = []
    report = portion(lambda stage, share: seen.append((stage, share)), 1, 4)
    report("begun", 0.0)
    report("done", 1.0)
    assert seen == [("begun", 0.25), ("done", 0.5)]


def test_two_things_of_one_name_are_refused_before_anything_runs():
    crawl = Gait(name="crawl", period=4.0)
    for named in (("on", "off", "on"), (crawl, replace(crawl, period=9.0)), ("crawl", crawl)):
        with pytest.raises(InvalidDesign, match=r"\.named has '(on|crawl)' more than once; leave one out, or give it"):
            replace(Drop(), named=named).run()
    assert replace(Drop(), named=("on", "off", crawl)).run().measures


SPEED, SLOWER, POWER = Measure(0.2, "m/s"), Measure(0.1, "m/s"), Measure(3.0, "W")


def extended(measures, other):
    measures |= other
    return measures


@pytest.mark.parametrize(
    "merge",
    [
        lambda one, other: one | other,
        lambda one, other: dict(one) | Measures(other),
        Measures,
        lambda one, other: Measures(one, other.items()),
        extended,
        lambda one, other: one.update(other),
        lambda one, other: one.update(**other),
        lambda one, other: [one.__setitem__(name, measure) for name, measure in other.items()],
    ],
)
def test_a_second_measure_of_a_name_is_refused_and_never_overwrites_the_first(merge):
    one = Measures({"speed": SPEED})
    with pytest.raises(AmbiguousName, match=r"two measures named 'speed': 0\.2 m/s and 0\.1 m/s; give one of them"):
        merge(one, {"speed": SLOWER})
    assert one == {"speed": SPEED}
    both = merge(one, {"power": POWER})
    assert (both if isinstance(both, Measures) else one) == {"speed": SPEED, "power": POWER}


def test_measures_are_still_such_after_they_were_merged_or_stored():
    merged = {"power": POWER} | Measures({"speed": SPEED}) | estimated("way", [1.0, 2.0], "m")
    for measures in (merged, pickle.loads(pickle.dumps(merged)), ranged("x", 1.0, [0.5, 2.0], "m")):
        assert isinstance(measures, Measures)
        with pytest.raises(AmbiguousName):
            extended(measures, dict(measures))
    assert list(merged) == ["power", "speed", "way", "way_low", "way_high"]

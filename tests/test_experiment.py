from dataclasses import dataclass, replace
from typing import ClassVar

import pytest
import xarray as xr

from suchus.errors import IncompatibleRecord
from suchus.experiment import Experiment, Measure, Simulated, silent, staged
from suchus.progress import portion
from suchus.verdict import Clause, Rule


@dataclass(frozen=True)
class Drop(Experiment):
    title = "How far does it fall?"
    shows = "Beyond the article"
    judged_with = ("ground",)
    judged_from: ClassVar = {"repeats": 4, "heights": 2}

    ground: str = "floor"
    repeats: int = 4
    heights: tuple[float, ...] = (1.0, 2.0)
    name_of_measure: str = "depth"

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
        return Simulated(record=xr.Dataset({"y": ("time", [0.0, -1.0])}))

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
        ({"ground": "sea"}, "Not judged: ground is sea, and the article's claims are judged with floor."),
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

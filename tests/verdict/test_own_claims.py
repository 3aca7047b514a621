"""Claims that an experiment states itself: declared in its file, judged as the article's are, and counted apart."""

import json
import re
import shutil
import sys
from dataclasses import replace

import pytest

import suchus
from suchus.apps.cli import main
from suchus.apps.report import load_result
from suchus.apps.report.page import render_page
from suchus.article.paper import CLAIMS, Claim
from suchus.article.verdict import judge
from suchus.core import sources
from suchus.core.errors import IncompatibleRecord, InvalidDesign, UnknownName
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.claims import RULES, claims_of, known_claims, rules_of

QUESTION = '''"""How long is the robot?"""

from dataclasses import dataclass, field

import xarray as xr

from suchus.article.paper import Claim
from suchus.article.verdict import Clause, Rule
from suchus.experiments.experiment import Experiment, Measure, Measures, SimulationResult, silent
from suchus.robot.design import Robot
from suchus.robot.robots import ROBOTS
from suchus.visual.figures import captioned, panels

CLAIMS = (
    Claim(
        key="length_of_a_metre",
        of="our drawing of May",
        where="sheet 2",
        quantity="length of the robot",
        value=1.2,
        unit="m",
        rounding=0.05,
        sense="The robot is at least half a metre long.",
        quote="about 1.2 m",
    ),
)
RULES = (
    Rule(
        claim="length_of_a_metre",
        experiment="length",
        measure="length",
        holds=(Clause("length", ">=", 0.5, "half a metre is what the case takes"),),
        why="The robot measures {length:.2f} m from snout to tail.",
    ),
)
EXAMPLES = {"length_of_a_metre": [({"length": 0.5}, "same sense"), ({"length": 0.49}, "contradicted")]}


@dataclass(frozen=True, slots=True, kw_only=True)
class Length(Experiment):
    """The length of a robot."""

    title = "How long is the robot?"
    shows = "Beyond the article"

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot."""

    def simulate(self, progress=silent):
        open("simulated", "w").close()
        return SimulationResult(record=xr.Dataset({"length": ((), self.robot.length, {"units": "m"})}))

    def measure(self, record):
        return Measures({"length": Measure(float(record.length), "m")})

    def explain(self, measures):
        return "The length is the sum of the lengths of the segments of the axis."

    def draw(self, outcome):
        figure, axes = panels()
        axes[0, 0].bar(["robot"], [float(outcome.record.length)])
        axes[0, 0].set(ylabel="length [m]")
        return {"length": captioned(figure, "Length of the robot as a bar.")}

    def quick(self):
        return self


experiment = Length()
'''
KEY = "length_of_a_metre"


@pytest.fixture
def lab(tmp_path, monkeypatch):
    """A project whose one file is an experiment that states a claim and judges it; it is the working folder."""
    monkeypatch.setenv(sources.VARIABLE, str(tmp_path))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")
    (tmp_path / "experiments").mkdir()
    (tmp_path / "experiments/length.py").write_text(QUESTION)
    yield tmp_path
    sys.modules.pop("suchus.experiments.catalog.length", None)


def changed(lab, old, new):
    """Change the experiment's file, which is then read anew."""
    text = QUESTION.replace(old, new)
    assert text != QUESTION
    (lab / "experiments/length.py").write_text(text)
    shutil.rmtree(lab / "experiments/__pycache__", ignore_errors=True)  # else a change of the same second is not seen
    sys.modules.pop("suchus.experiments.catalog.length", None)


def test_a_run_judges_the_claim_by_its_rule(lab):
    (verdict,) = EXPERIMENTS["length"].run().verdicts
    length = suchus.ROBOTS["caiman"].length
    assert verdict.claim == claims_of("length")[KEY]
    assert verdict.measured == length
    assert verdict.verdict == "same sense"  # neither the printed number nor less than half a metre
    assert verdict.why == f"The robot measures {length:.2f} m from snout to tail."
    changed(lab, "value=1.2,", f"value={length:.1f},")
    assert EXPERIMENTS["length"].run().verdicts[0].verdict == "reproduced"
    changed(lab, '">=", 0.5', '">=", 1.5')
    assert EXPERIMENTS["length"].run().verdicts[0].verdict == "contradicted"


def test_it_stands_in_the_outcome_on_the_page_in_the_terminal_and_in_the_list(lab, capsys):
    assert main(["run", "length"]) == 0
    terminal = capsys.readouterr().out
    assert "length of the robot (our drawing of May, sheet 2)" in terminal
    assert "same sense" in terminal
    (row,) = json.loads((lab / "out/length/outcome.json").read_text())["verdicts"]
    stated = {
        name: row[name] for name in ("claim", "of", "quote", "statement", "printed", "rounding", "unit", "verdict")
    }
    assert stated == {
        "claim": KEY, "of": "our drawing of May", "quote": "about 1.2 m", "printed": 1.2, "rounding": 0.05, "unit": "m",
        "statement": "The robot is at least half a metre long.", "verdict": "same sense",
    }  # fmt: skip
    page = (lab / "out/length/index.html").read_text()
    assert "our drawing of May: <q>about 1.2 m</q>" in page
    assert "The article:" not in page
    assert main(["list"]) == 0
    listed = " ".join(capsys.readouterr().out.split())
    assert f"length How long is the robot? (claims {KEY}) [experiments/length.py]" in listed


def test_a_hypothesis_without_a_quotation_shows_its_statement(lab):
    changed(lab, '        quote="about 1.2 m",\n', "")
    assert main(["run", "length"]) == 0
    page = (lab / "out/length/index.html").read_text()
    assert "our drawing of May: The robot is at least half a metre long." in page


def test_it_never_counts_as_the_article_s(lab):
    assert main(["run", "length"]) == 0
    own = load_result(lab / "out/length")
    page = render_page([own], [])
    assert "1 experiment, 0 verdicts" in page
    assert "Claims that experiments state themselves: 1, none of them the article" in page
    assert "on claims of its own" in page
    assert "Of 1 claim of the article" not in page
    assert KEY not in RULES
    assert KEY not in CLAIMS
    article = replace(own, outcome={**own.outcome, "verdicts": [{**own.outcome["verdicts"][0], "claim": "tail_swing"}]})
    assert "Of 1 claim of the article" in render_page([article], [])  # the same verdict on the article counts


def test_an_experiment_of_the_package_that_states_a_claim_changes_no_count(lab, monkeypatch):
    monkeypatch.setenv(sources.VARIABLE, "")
    monkeypatch.setattr(
        "suchus.experiments.catalog.__path__", [*suchus.experiments.catalog.__path__, str(lab / "experiments")]
    )
    assert EXPERIMENTS.sources()["length"].shipped
    assert KEY not in type(RULES)()
    assert set(type(RULES)()) == set(RULES)
    assert KEY in known_claims("length")
    assert KEY not in known_claims("displacement")


def test_a_rule_on_a_claim_that_nobody_states_is_refused_before_the_run(lab, capsys):
    changed(lab, f'claim="{KEY}"', 'claim="length_of_a_meter"')
    assert main(["run", "length"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err == (
        "suchus: a rule of length, on the measure 'length', judges the claim 'length_of_a_meter', which neither the "
        "article nor CLAIMS of length states. Add a Claim with this key to CLAIMS beside RULES, or correct the rule. "
        "Did you mean 'length_of_a_metre'?\n"
    )
    assert not (lab / "simulated").exists()
    assert not (lab / "out/length").exists()
    assert main(["list"]) == 0
    assert "[broken: a rule of length" in " ".join(capsys.readouterr().out.split())
    assert main(["run", "gait_diagram", "--help-me"]) == 2  # others are not harmed
    assert "--help-me" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (f'key="{KEY}"', 'key="height_crawl"', "the claim 'height_crawl' of length has the key of a claim of the arti"),
        (f'key="{KEY}"', 'key="Length!"', "needs another key: small letters, digits and underscores are allowed"),
        (f'key="{KEY}"', "key=3", "the claim 3 of length.key is 3; a text is needed"),
        ('of="our drawing of May"', 'of=""', "lacks `of`, who states it"),
        ('sense="The robot is at least half a metre long."', 'sense=""', "lacks `sense`, the statement"),
        ('quantity="length of the robot"', 'quantity=""', "lacks `quantity`"),
        ("value=1.2", 'value="1.2"', "value is '1.2'; a number or nothing is needed"),
        ("rounding=0.05", "rounding=-0.05", "rounding is -0.05 m; 0 to inf m is allowed"),
        (
            "CLAIMS = (\n",
            "CLAIMS = (\n    'x',\n",
            "CLAIMS of length has 'x', which is no Claim of suchus.article.paper",
        ),
        ("RULES = (", "CLAIMS = 2 * CLAIMS\nRULES = (", f"CLAIMS of length has two claims '{KEY}'"),
        ("RULES = (", "CLAIMS = CLAIMS[0]\nRULES = (", "a tuple of Claim is needed"),
    ],
)
def test_a_claim_that_cannot_be_judged_is_refused_in_a_sentence(lab, capsys, old, new, words):
    changed(lab, old, new)
    with pytest.raises(InvalidDesign, match=re.escape(words)) as caught:
        rules_of("length")
    assert "\n" not in str(caught.value)
    assert main(["run", "length"]) == 2
    assert not (lab / "simulated").exists()


def test_a_file_that_only_reads_the_article_s_claims_states_none(lab):
    changed(lab, "from suchus.article.paper import Claim\n", "from suchus.article.paper import CLAIMS\n")
    text = (lab / "experiments/length.py").read_text()
    start, end = text.index("CLAIMS = ("), text.index("RULES = (")
    (lab / "experiments/length.py").write_text((text[:start] + text[end:]).replace(KEY, "height_crawl"))
    assert claims_of("length") == {}
    assert [rule.claim for rule in rules_of("length")] == ["height_crawl"]


def test_claims_stand_beside_the_rules_of_a_folder(lab):
    """As the rules of an experiment that has outgrown its file, they are read without the experiment."""
    (lab / "experiments/length.py").unlink()
    folder = lab / "experiments/length"
    folder.mkdir()
    start, end = QUESTION.index("CLAIMS = ("), QUESTION.index("EXAMPLES = ")
    (folder / "__init__.py").write_text("")
    (folder / "experiment.py").write_text("raise RuntimeError('the experiment was imported')\n")
    imports = "from suchus.article.paper import Claim\nfrom suchus.article.verdict import Clause, Rule\n"
    (folder / "rules.py").write_text(imports + QUESTION[start:end])
    try:
        assert list(claims_of("length")) == [KEY]
        assert [rule.claim for rule in rules_of("length")] == [KEY]
    finally:
        sys.modules.pop("suchus.experiments.catalog.length.rules", None)


def test_judging_by_hand_names_a_claim_or_a_measure_that_is_missing(lab):
    (rule,) = rules_of("length")
    with pytest.raises(UnknownName, match=f"there is no claim named '{KEY}'"):
        judge(rule, {"length": 1.0})
    claims = known_claims("length")
    assert judge(rule, {"length": 1.2}, claims=claims).verdict == "reproduced"
    spoken = replace(rule, why="{length:.2f} m, of which the tail {tail:.2f} m")
    with pytest.raises(IncompatibleRecord, match="needs tail, which length did not measure"):
        judge(spoken, {"length": 1.0}, claims=claims)


def test_a_claim_needs_no_number_and_no_quotation():
    claim = Claim(key="a", of="ours", where="1", quantity="x", sense="X is.")
    assert (claim.value, claim.unit, claim.rounding, claim.quote) == (None, "-", 0.0, "")
    assert str(claim) == "x (ours, 1)"

"""How rules judge; what holds for those of every experiment is in ``tests/shelves/test_every_rule.py``."""

import subprocess
import sys
from dataclasses import replace
from math import nan

import pytest

import suchus.experiments
from suchus.errors import IncompatibleRecord, InvalidDesign
from suchus.verdict import RULES, Clause, Share, examples_of, judge, rules_of
from suchus.verdict.judging import ROBUST

SWINGS = examples_of("displacement")["tail_swing"]
SHARE = Share(claim="tail_swing", share=0.95, low=0.9, high=0.97, designs=100, turned_by="", at=None, above=False)


def test_a_measure_that_is_missing_is_named():
    with pytest.raises(IncompatibleRecord, match="needs gain_tail_swing_low, which displacement did not measure"):
        judge(RULES["tail_swing"], {"gain_tail_swing": 0.1, "gain_tail_swing_high": 0.2})


def test_a_number_that_is_none_holds_nothing():
    for relation in ("<", "<=", ">", ">="):
        assert not Clause("x", relation, 0.0, "why").holds({"x": nan})
        assert not Clause("x", relation, "y", "why").holds({"x": 1.0, "y": nan})


@pytest.mark.parametrize(
    ("relation", "below", "at", "above"),
    [("<", True, False, False), ("<=", True, True, False), (">", False, False, True), (">=", False, True, True)],
)
def test_a_clause_compares(relation, below, at, above):
    clause = Clause("x", relation, 2.0, "why")
    assert [clause.holds({"x": x}) for x in (1.9, 2.0, 2.1)] == [below, at, above]
    other = Clause("x", relation, "y", "why")
    assert [other.holds({"x": x, "y": 2.0}) for x in (1.9, 2.0, 2.1)] == [below, at, above]


def test_a_verdict_is_fragile_where_other_designs_say_otherwise():
    measures = SWINGS[0][0]  # reproduced
    for share, held in ((ROBUST + 0.01, False), (ROBUST - 0.01, True)):
        verdict = judge(RULES["tail_swing"], measures, {"tail_swing": replace(SHARE, share=share)})
        assert verdict.fragile is held
    contradicted = SWINGS[1][0]
    for share, held in ((1 - ROBUST - 0.01, False), (1 - ROBUST + 0.01, True)):
        verdict = judge(RULES["tail_swing"], contradicted, {"tail_swing": replace(SHARE, share=share)})
        assert verdict.fragile is held
    assert not judge(RULES["tail_swing"], measures, {}).fragile


def test_what_was_built_in_is_not_fragile():
    measures = examples_of(RULES["spine_sinusoidal"].experiment)["spine_sinusoidal"][0][0]
    share = replace(SHARE, claim="spine_sinusoidal", share=0.1)
    assert not judge(RULES["spine_sinusoidal"], measures, {"spine_sinusoidal": share}).fragile


def test_rules_are_read_without_their_experiments():
    code = "import sys; from suchus.verdict import RULES; [*RULES]; print({'numpy', 'mujoco'} & {*sys.modules})"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_a_rule_beside_another_experiment_is_refused(tmp_path, monkeypatch):
    """And one file can hold a question, its rules and their examples."""
    text = "from suchus.verdict import Rule\nRULES = ({},)\n{}\n"
    rule = 'Rule(claim="joint_pid", experiment={!r}, measure="x", why="because")'
    examples = "EXAMPLES = {'joint_pid': [({'x': 1.0}, 'reproduced')]}"
    (tmp_path / "strange.py").write_text(text.format(rule.format("displacement"), examples))
    (tmp_path / "whole.py").write_text(text.format(rule.format("whole"), examples))
    monkeypatch.setattr(suchus.experiments, "__path__", [*suchus.experiments.__path__, str(tmp_path)])
    with pytest.raises(InvalidDesign, match=r"RULES of strange hold Rule.*no Rule of this experiment"):
        rules_of("strange")
    assert [rule.claim for rule in rules_of("whole")] == ["joint_pid"]
    assert examples_of("whole") == {"joint_pid": [({"x": 1.0}, "reproduced")]}
    for name in ("strange", "whole"):
        monkeypatch.delitem(sys.modules, f"suchus.experiments.{name}")


def test_an_experiment_without_rules_has_none():
    assert rules_of("turning") == ()
    assert rules_of("of no shelf") == ()

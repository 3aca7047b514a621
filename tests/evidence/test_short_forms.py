"""The words of `suchus reproduce` beside those of whole runs, as they are kept, and how a difference is found."""

import json

import pytest

from evidence import short_forms, store
from suchus.core.errors import IncompatibleRecord
from suchus.experiments.claims import RULES


@pytest.fixture
def folders(tmp_path):
    """Return folders of a short and a whole run of every experiment that judges a claim, each claim reproduced."""
    for form, flags in (("short", " --for-verdicts"), ("whole", "")):
        for name in {rule.experiment for rule in RULES.values()}:
            verdicts = [
                {"claim": claim, "verdict": "reproduced"} for claim, rule in RULES.items() if rule.experiment == name
            ]
            outcome = {"command": f"suchus run {name}{flags}", "measures": {"number": 1.0}, "verdicts": verdicts}
            (tmp_path / form / name).mkdir(parents=True)
            (tmp_path / form / name / "outcome.json").write_text(json.dumps(outcome), encoding="utf-8")
    return tmp_path / "short", tmp_path / "whole"


def change(folder, name, **changes):
    file = folder / name / "outcome.json"
    file.write_text(json.dumps(json.loads(file.read_text(encoding="utf-8")) | changes), encoding="utf-8")


def test_every_claim_has_the_same_word_in_both_forms_as_kept():
    kept = store.load(short_forms.NAME).values
    assert {claim for entry in kept.values() for claim in entry["words"]} == set(RULES)
    assert short_forms.differing(kept) == []
    assert any(short < whole for short, whole in (entry["measures"] for entry in kept.values()))


def test_another_word_is_found(folders):
    assert short_forms.differing(short_forms.compared(*folders)) == []
    change(folders[0], "working_space", verdicts=[{"claim": "working_space", "verdict": "undecided"}])
    assert short_forms.differing(short_forms.compared(*folders)) == ["working_space"]


def test_what_cannot_be_compared_is_refused(folders):
    short, whole = folders
    change(whole, "gallop_limits", command="suchus run gallop_limits --for-verdicts")
    with pytest.raises(IncompatibleRecord, match="gallop_limits was run in the short form; run suchus run"):
        short_forms.compared(short, whole)
    change(whole, "gallop_limits", command="suchus run gallop_limits")
    change(short, "working_space", verdicts=[])
    with pytest.raises(IncompatibleRecord, match="working_space has no word on working_space"):
        short_forms.compared(short, whole)
    (short / "working_space" / "outcome.json").write_text("{", encoding="utf-8")
    with pytest.raises(IncompatibleRecord, match="is damaged"):
        short_forms.compared(short, whole)
    (short / "working_space" / "outcome.json").unlink()
    with pytest.raises(IncompatibleRecord, match="run its experiment first"):
        short_forms.compared(short, whole)


def test_the_command_says_what_cannot_be_compared_and_keeps_nothing(folders, monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["short_forms", str(folders[0]), "nowhere"])
    monkeypatch.setattr("evidence.renew.store", lambda *_: pytest.fail("a result was kept"))
    assert short_forms.main() == 2
    assert "there is no nowhere" in capsys.readouterr().err


def test_the_command_names_a_claim_whose_word_differs(folders, monkeypatch, capsys):
    change(folders[0], "working_space", verdicts=[{"claim": "working_space", "verdict": "undecided"}])
    monkeypatch.setattr("sys.argv", ["short_forms", *map(str, folders)])
    monkeypatch.setattr("evidence.renew.store", lambda *_: None)
    assert short_forms.main() == 1
    assert capsys.readouterr().out == "working_space: another word in the short form\n"

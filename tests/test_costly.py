"""What ``make test`` leaves to ``make test-all`` because of its cost is what was measured, and what stays is named."""

import json

import pytest

import costly
from left_out import COLLECTED


class Case:
    def __init__(self, nodeid, *marks):
        self.nodeid, self.marks, self.user_properties = nodeid, list(marks), []

    def get_closest_marker(self, name):
        return next((m for m in self.marks if m.name == name), None)

    def add_marker(self, mark):
        self.marks.append(mark)


class Told:
    def __init__(self, case):
        self.nodeid, self.when, self.user_properties = case.nodeid, "teardown", case.user_properties


class Ended:
    class config:  # noqa: N801
        pass


def metered(monkeypatch, tmp_path, cases):
    """Return what is listed after tests that took so much, each (name, own time [s], {quick form: time [s]})."""
    monkeypatch.setattr(costly, "FILE", tmp_path / "costly.json")
    clock, meter = [0.0], costly.Meter()
    monkeypatch.setattr(meter, "spent", lambda: clock[0])
    for name, own, forms in cases:
        case, around = Case(name), meter.pytest_runtest_protocol()
        next(around)
        for form, took in forms.items():
            clock[0] += took
            meter.asked(form, took)
        clock[0] += own
        meter.pytest_runtest_makereport(case, type("Call", (), {"when": "teardown"}))
        meter.pytest_runtest_logreport(Told(case))
    meter.pytest_sessionfinish(Ended)
    return json.loads(costly.FILE.read_text(encoding="utf-8"))


def test_the_dear_are_listed_and_the_cheap_are_not(monkeypatch, tmp_path):
    dear, cheap = costly.LIMIT + 0.1, 0.5 * costly.LIMIT
    assert metered(monkeypatch, tmp_path, [("a::dear", dear, {}), ("a::cheap", cheap, {})]) == {
        "a::dear": round(dear, 2)
    }


def test_a_quick_form_counts_for_all_that_ask_for_it_where_it_is_too_dear(monkeypatch, tmp_path):
    cases = [
        ("a::first", 0.5 * costly.LIMIT, {"long": costly.QUICK_LIMIT + 1}),
        ("a::second", 0.5 * costly.LIMIT, {"long": 0.0}),
        ("a::third", 0.5 * costly.LIMIT, {"short": costly.QUICK_LIMIT - 1}),
    ]
    assert set(metered(monkeypatch, tmp_path, cases)) == {"a::first", "a::second"}


def test_what_is_kept_stays_whatever_it_costs_but_for_a_quick_form(monkeypatch, tmp_path):
    kept = next(iter(costly.KEPT))
    cases = [(f"{kept}[a]", 9.0, {}), (f"{kept}[b]", 0.1, {"long": costly.QUICK_LIMIT + 1})]
    assert set(metered(monkeypatch, tmp_path, cases)) == {f"{kept}[b]"}


def test_what_is_listed_is_marked_once_and_nothing_else(monkeypatch):
    monkeypatch.setattr(costly, "_WRITES", False)
    monkeypatch.setattr(costly, "costly", lambda: {"a::dear": 3.0, "a::slow": 3.0})
    cases = dear, cheap, slow = (
        Case("a::dear"),
        Case("a::cheap"),
        Case("a::slow", pytest.mark.slow("a process dies").mark),
    )
    costly.mark(cases)
    assert [m.name for m in dear.marks] == ["slow"]
    assert not cheap.marks
    assert len(slow.marks) == 1


def test_the_list_names_tests_that_there_are(request):
    there = {item.nodeid for item in request.config.stash[COLLECTED]}
    files = {name.partition("::")[0] for name in there}
    named = {*costly.costly()}
    assert [name for name in named if name.partition("::")[0] in files and name not in there] == []
    functions = {name.partition("[")[0] for name in there}
    assert [name for name in costly.KEPT if name.partition("::")[0] in files and name not in functions] == []
    assert not {name for name in named if name.partition("[")[0] in costly.KEPT and "[" not in name}

"""A built page says below a passage which of its results is not current, and nothing below one that is."""

import json

import pytest

from evidence import stale
from evidence.stale import Status
from pages import age
from pages.stated import made, sources

PASSAGE = next(name for name in made() if sources(name) == ("turning",))
PAGE = f"# A page\n\n<!-- stated: {PASSAGE} -->\nwords\n<!-- end -->\n\nMore words.\n"


@pytest.fixture
def known(monkeypatch):
    """Let the code alone say a state, and return a function that sets it."""
    age.state.cache_clear()
    age._answers.cache_clear()

    def become(state, code="abc"):
        answer = Status(name="turning", state=state, reason="", seconds=1.0, renew="", code=code)
        monkeypatch.setattr(stale, "status", lambda kept, **how: answer)

    yield become
    age.state.cache_clear()
    age._answers.cache_clear()


@pytest.mark.parametrize(
    ("state", "words"),
    [
        ("old", "*turning: Old: computed with suchus 0.2.0 ("),
        ("possibly old", "the code has changed since, not checked here.*"),
        ("not checked here", "; not checked here.*"),
    ],
)
def test_what_is_not_current_is_marked_below_its_passage(known, state, words):
    known(state)
    text = age.marked(PAGE)
    assert words in text
    assert text.index("<!-- end -->") < text.index("*turning: ") < text.index("More words.")


def test_a_result_that_was_never_computed_is_named_and_the_page_is_built(known, monkeypatch):
    known("current")
    monkeypatch.setattr(age, "names", lambda: ["another"])
    assert f"*turning: {age.MISSING}*" in age.marked(PAGE)


def test_what_is_current_is_not_marked(known):
    known("current")
    assert age.marked(PAGE) == PAGE


@pytest.mark.parametrize(("code", "state"), [("abc", "old"), ("of before", "possibly old")])
def test_the_last_look_counts_while_the_code_is_the_same(known, monkeypatch, tmp_path, code, state):
    known("possibly old", code="abc")
    file = tmp_path / "stale.json"
    file.write_text(json.dumps({"turning": {"state": "old", "code": code}}))
    monkeypatch.setattr(stale, "ANSWERS", file)
    assert age.state("turning") == state


def test_a_damaged_file_of_the_last_look_counts_for_nothing(known, monkeypatch, tmp_path):
    known("possibly old")
    (tmp_path / "stale.json").write_text("{")
    monkeypatch.setattr(stale, "ANSWERS", tmp_path / "stale.json")
    assert age.state("turning") == "possibly old"

"""Lessons: what is right is what was measured, and each page plays offline on a phone."""

import re
import shutil
from dataclasses import replace

import pytest

from suchus.apps.cli import main
from suchus.apps.report import lessons
from suchus.apps.report.lessons import Lesson, write_lessons

FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


def short(lesson: Lesson) -> Lesson:
    return replace(lesson, runs=lesson.runs[::2][:2], cycles=0.3)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("lessons")
    return write_lessons(folder, [short(one) for one in lessons.lessons()[:2]])


def measured(page):
    """What the page says of each run, and which it holds to be right."""
    rows = re.findall(r"<tr><td>(.+?)</td><td>(.+?) m</td></tr>", page)
    right = re.search(r"<strong>(.+)\.</strong>", page)[1]
    return {label: float(number.replace("−", "-")) for label, number in rows}, right


def test_a_page_has_its_runs_a_slider_and_a_question_whose_answer_was_measured(written):
    index, first, second = (path.read_text(encoding="utf-8") for path in written)
    found, right = measured(first)
    assert list(found) == ["0% of its crawl", "50% of its crawl"]
    assert found[right] == max(found.values())
    assert 'id="chosen" type="range" min="0" max="1"' in first
    assert 'href="timing.html"' in first
    assert "Next:" not in second
    assert index.count(".html") == 2


@pytest.mark.parametrize(
    ("right", "far", "which"),
    [
        (lessons._index_of_farthest, [0.1, 0.3, 0.2], 1),
        (lessons._index_of_nearest, [0.1, 0.3, -0.2], 2),
        (lessons._index_of_backward, [0.1, -0.1, -0.2], 1),
        (lessons._index_of_backward, [0.3, 0.1, 0.2], 1),
    ],
)
def test_what_is_right_follows_from_the_distances(right, far, which):
    assert right(far) == which


@pytest.mark.parametrize("words", [["--out", "taken"], ["--robot", "caiman"], ["now"]])
def test_bad_words_are_refused_before_anything_is_computed(words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "taken").write_text("")
    monkeypatch.setattr(lessons, "simulate", lambda *_, **__: pytest.fail("computed"))
    assert main(["lessons", *words]) == 2
    assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.slow("a browser plays 25 whole walks and swims")
def test_all_lessons_play_offline_on_a_phone_and_their_explanations_hold(tmp_path):
    playwright = pytest.importorskip("playwright.sync_api")
    if (browser := shutil.which("chromium")) is None:
        pytest.skip("no chromium is installed")
    assert main(["lessons", "--out", str(tmp_path)]) == 0
    with playwright.sync_playwright() as started:
        opened = started.chromium.launch(executable_path=browser, args=FLAGS)
        for lesson in lessons.lessons():
            plays(opened, (tmp_path / f"{lesson.name}.html").as_uri())
        opened.close()
    far = {
        one.name: list(measured((tmp_path / f"{one.name}.html").read_text())[0].values()) for one in lessons.lessons()
    }
    assert far["bending"] == sorted(far["bending"])
    assert max(far["timing"]) == far["timing"][0] > 0.0 > far["timing"][-1]
    assert min(far["joints"]) < 0.5 * max(far["joints"])
    assert far["friction"].index(min(far["friction"])) > 0
    assert far["waves"][0] < 0.0 < min(far["waves"][2:])


def plays(opened, address):
    from tests.replay.test_player import until  # noqa: PLC0415  the rest of this file needs no browser

    page, asked, said = opened.new_page(viewport={"width": 390, "height": 844}), [], []
    page.on("request", lambda request: asked.append(request.url))
    page.on("console", lambda message: said.append(message.text))
    page.goto(address + "#t=5")
    until(page, "window.suchus && window.suchus.mass() !== null")
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    first = page.locator("#told").inner_text()
    page.locator("#chosen").fill("1")
    until(page, f"document.getElementById('told').textContent !== {first!r}")
    right = page.evaluate("document.querySelector('#answer strong').textContent").removesuffix(".")
    page.get_by_role("radio", name=right, exact=True).check()
    assert page.locator("#answer").get_attribute("open") is not None
    assert page.locator("#said").inner_text() == "That is what was measured."
    assert (asked, said) == ([address], [])
    page.close()

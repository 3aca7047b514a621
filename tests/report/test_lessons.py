"""Lessons: what is right is what was measured, and each page plays offline on a phone."""

import http.client
import json
import re
import shutil
import socket
import threading
from dataclasses import replace
from urllib.parse import parse_qsl

import numpy as np
import pytest

from suchus.apps.cli import main
from suchus.apps.laboratory import page as laboratory
from suchus.apps.laboratory.engine import Engine, NoEngine
from suchus.apps.laboratory.link import constant_level, page_settings
from suchus.apps.report import lesson_server, lessons
from suchus.apps.report.lesson_server import LessonServer
from suchus.apps.report.lessons import Lesson, write_lessons
from suchus.apps.viewer.knobs import GAIT_KNOBS
from suchus.robot.design.ground import Ground
from suchus.robot.motion.movement import cycle_targets
from suchus.sim.land import Lake, Run

FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


def short(lesson: Lesson) -> Lesson:
    return replace(lesson, runs=lesson.runs[::2][:2], cycles=0.3)


ADDRESS = "http://192.0.2.7:8080/"


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("lessons")
    with pytest.MonkeyPatch.context() as patch:
        for module in (lessons, laboratory):
            patch.setattr(module, "read_engine", lambda: Engine("", b""))
        return write_lessons(folder, [short(one) for one in lessons.lessons()[:2]], address=ADDRESS)


def measured(page):
    """What the page says of each run, and which it holds to be right."""
    rows = re.findall(r"<tr><td>(.+?)</td><td>(.+?) m</td></tr>", page)
    right = re.search(r"<strong>(.+)\.</strong>", page)[1]
    return {label: float(number.replace("−", "-")) for label, number in rows}, right


def test_a_page_has_its_runs_a_slider_and_a_question_whose_answer_was_measured(written):
    index, first, second = (path.read_text(encoding="utf-8") for path in written[:3])
    found, right = measured(first)
    assert list(found) == ["0% of its crawl", "50% of its crawl"]
    assert found[right] == max(found.values())
    assert 'id="chosen" type="range" min="0" max="1"' in first
    assert 'href="timing.html"' in first
    assert "Next:" not in second
    assert index.count(".html") == 4


def test_the_sheet_names_address_question_and_choices_of_each_lesson(written):
    sheet = written[3].read_text(encoding="utf-8")
    assert written[3].name == "sheet.html"
    for lesson in map(short, lessons.lessons()[:2]):
        assert f"<code>{ADDRESS}{lesson.name}.html</code>" in sheet
        assert lesson.question in sheet
        assert all(run.label in sheet for run in lesson.runs)
    assert sheet.count("I expect:") == 2


def test_list_and_sheet_have_codes_to_scan_where_there_is_an_address(written, tmp_path):
    pytest.importorskip("segno")
    index, sheet = (written[i].read_text(encoding="utf-8") for i in (0, 3))
    titles = re.findall(r"<title>QR code of (.+?)</title>", sheet)
    assert titles == [ADDRESS, f"{ADDRESS}bending.html", f"{ADDRESS}timing.html"]
    assert re.findall(r"<title>QR code of (.+?)</title>", index) == [ADDRESS]
    assert ADDRESS in re.sub("<.+?>", "", index)
    assert "Scan the code, or type:" in sheet


def test_the_sheet_names_the_files_where_there_is_no_address(tmp_path, monkeypatch):
    monkeypatch.setattr(lessons, "page", lambda *_: "")
    monkeypatch.setattr(lessons, "read_engine", absent)
    pages = write_lessons(tmp_path, [lessons.lessons()[0]])
    index, sheet = (pages[i].read_text(encoding="utf-8") for i in (0, 2))
    assert "QR code" not in index + sheet
    assert "<p>Type: <code>bending.html</code></p>" in sheet
    assert "Phones in this room" not in index


def absent():
    raise NoEngine("there is none.")


def test_each_run_leads_to_the_laboratory_with_its_settings(written):
    assert [path.name for path in written[4:]] == ["laboratory_caiman_belly_crawl.html"]
    first, second = (path.read_text(encoding="utf-8") for path in written[1:3])
    name = written[4].name
    assert addresses(first) == [f"{name}#trunk_bend=0&tail_bend=0", f"{name}#trunk_bend=35&tail_bend=22.5"]
    assert addresses(second) == [name, f"{name}#axis_lag=0.25"]
    assert first.index('id="question"') < first.index('id="scene"') < first.index("Answer below")


def addresses(page):
    return json.loads(re.search(r'<script id="addresses" type="application/json">(.*?)</script>', page)[1])


@pytest.mark.parametrize("lesson", lessons.lessons(), ids=lambda lesson: lesson.name)
def test_the_settings_of_a_link_make_the_run(lesson):
    """Sliders stop at the end of their range, so that each value lies in it; the numbers make the run's gait."""
    clocks = np.linspace(0.0, 1.5, 50)
    robot, start = lesson.runs[0].robot, lesson.laboratory
    for run in lesson.runs:
        settings = dict(parse_qsl(page_settings(run, start, start_level=constant_level(lesson.runs[0]))))
        shown = {name: float(text) for name, text in settings.items() if name in GAIT_KNOBS}
        assert all(GAIT_KNOBS[name].low <= value <= GAIT_KNOBS[name].high for name, value in shown.items())
        gait = start.with_numbers(**{name: value * GAIT_KNOBS[name].scale for name, value in shown.items()})
        assert np.abs(cycle_targets(robot, gait, clocks) - cycle_targets(robot, run.gait, clocks)).max() < 1e-9
        assert float(settings.get("friction", 1.0)) == run.ground.friction_scale
        assert settings.get("faults", "") == ",".join(f"{fault.joint}:limp" for fault in run.faults)
        assert "level" not in settings


def test_a_link_sets_water_and_slope():
    lesson = lessons.lessons()[0]
    run = Run(
        robot=lesson.runs[0].robot, gait=lesson.laboratory, lake=Lake(level=0.25), ground=Ground(uphill=np.radians(6.0))
    )
    assert page_settings(run, lesson.laboratory) == "uphill=6&level=250"
    dry = replace(run, lake=None, ground=Ground())
    assert page_settings(dry, lesson.laboratory, start_level=0.3) == "level=none"


def test_without_the_engine_the_lessons_have_no_laboratory(tmp_path, monkeypatch):
    monkeypatch.setattr(lessons, "read_engine", absent)
    index, first, _ = write_lessons(tmp_path, [short(lessons.lessons()[0])])
    assert "laboratory_" not in index.read_text()
    assert "laboratory_" not in first.read_text()
    assert lessons.laboratory_absence() == "there is none."


def answer(server, path, method="GET"):
    connection = http.client.HTTPConnection("127.0.0.1", server._server.server_port, timeout=60.0)
    connection.request(method, path)
    response = connection.getresponse()
    body = response.read()
    connection.close()
    return response.status, response.headers["Content-Type"], body


def test_the_server_gives_the_pages_and_nothing_else(tmp_path):
    index, other, secret = (tmp_path / name for name in ("index.html", "a.html", "letter.txt"))
    for file in (index, secret):
        file.write_text(file.name)
    with LessonServer([index, other], 0) as server:
        server.start()
        assert re.fullmatch(r"http://[\d.]+:\d+/", server.address)
        assert answer(server, "/") == (200, "text/html; charset=utf-8", b"index.html")
        assert answer(server, "/index.html?x") == answer(server, "/")
        assert answer(server, "/index.html", "HEAD")[::2] == (200, b"")
        for path in ("/letter.txt", "/a.html", "/../letter.txt", "/%2e%2e/letter.txt", str(secret), "/lessons/"):
            assert answer(server, path)[:2] == (404, "text/plain; charset=utf-8"), path
        assert answer(server, "/", "POST")[0] == 501
        other.write_text("later")
        assert answer(server, "/a.html")[2] == b"later"
    assert not [thread for thread in threading.enumerate() if "serve_forever" in thread.name]  # it would spin


def test_a_computer_without_a_network_names_itself(monkeypatch):
    monkeypatch.setattr(lesson_server, "_UNROUTED", ("no address", 9))
    assert lesson_server.network_address() == "127.0.0.1"


def test_a_taken_port_is_said_before_anything_is_computed(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(lessons, "simulate", lambda *_, **__: pytest.fail("computed"))
    with socket.socket() as taken:
        taken.bind(("", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        assert main(["lessons", "--serve", "--port", port, "--out", str(tmp_path / "new")]) == 2
    assert f"on port {port}" in capsys.readouterr().err
    assert not (tmp_path / "new").exists()


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


@pytest.mark.parametrize("words", [["--out", "taken"], ["--robot", "caiman"], ["now"], ["--port", "-1"]])
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
    assert page.locator("#chosen").is_disabled()
    page.locator("#expected").select_option(index=2)
    expected = page.locator("#expected").input_value()
    page.locator("#chosen").fill("1")
    until(page, f"document.getElementById('told').textContent !== {first!r}")
    right = page.evaluate("document.querySelector('#answer strong').textContent").removesuffix(".")
    page.get_by_role("radio", name=right, exact=True).check()
    assert page.locator("#answer").get_attribute("open") is not None
    guess = "You expected it." if expected == right else f"You expected: {expected}."
    assert page.locator("#said").inner_text() == f"That is what was measured. {guess}"
    if page.locator("#laboratory").count():
        assert ".html#" in page.locator("#laboratory").get_attribute("href")
    assert (asked, said) == ([address], [])
    page.close()

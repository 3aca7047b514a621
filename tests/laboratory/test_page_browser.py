"""The page in a real browser, from a file, offline: on a phone's screen and on a desk's."""

import shutil
from dataclasses import replace

import pytest
from tests.laboratory.page_modules import needs_engine

import suchus
from suchus.apps.laboratory.page import laboratory_page
from suchus.robot import blueprint
from suchus.robot.gaits import GAITS, control_group
from suchus.robot.motion import START, suits
from suchus.robot.robots import ROBOTS
from suchus.sim.metrics import cost_of_transport, displacement, duty_factor
from suchus.sim.metrics.stability import height_peak_to_peak

playwright = pytest.importorskip("playwright.sync_api")
BROWSER = shutil.which("chromium") or shutil.which("chromium-browser")
FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic"]
SMALL = {"width": 80, "height": 60}  # of a page whose picture nobody looks at: every pixel is drawn in software
PATIENCE = 120_000  # [ms]; a busy machine without a graphics card draws a picture every few seconds
ROBOT, GAIT = ROBOTS["caiman"], replace(GAITS["belly_crawl"], name="quick_crawl", period=1.5)
pytestmark = [
    needs_engine,
    pytest.mark.skipif(BROWSER is None, reason="no chromium is installed: the page is not tried in one"),
]


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as started:
        opened = started.chromium.launch(executable_path=BROWSER, args=FLAGS)
        yield opened
        opened.close()


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    file = tmp_path_factory.mktemp("page") / "caiman.html"
    file.write_text(laboratory_page(ROBOT, GAIT))
    return file.as_uri()


@pytest.fixture(scope="module")
def phone(browser, address):
    """The page on a phone, at rest, with everything that it complained of or asked for."""
    context = browser.new_context(viewport={"width": 390, "height": 500}, has_touch=True, reduced_motion="reduce")
    shown = context.new_page()
    shown.set_default_timeout(PATIENCE)
    shown.complaints, shown.asked = [], []
    shown.on("console", lambda message: shown.complaints.append(message.text))
    shown.on("pageerror", lambda error: shown.complaints.append(str(error)))
    shown.on("request", lambda request: shown.asked.append(request.url))
    shown.goto(address)
    shown.wait_for_function("document.body.dataset.live === 'ready'")
    yield shown
    context.close()


SIMULATE = """(time) => {
  let before = -1, reached = 0;
  while (reached < time - 1e-6 && reached > before) {
    before = reached;
    reached = laboratory.page.advance(time);
  }
  laboratory.state.time = reached;
  laboratory.redraw();
}"""
KNEE = """() => {
  const page = laboratory.page, box = document.getElementById("scene").getBoundingClientRect();
  const knee = page.walks[0].hingePlaces()[page.robot.hinges.indexOf("LH_knee")], [x, y] = laboratory.project(knee);
  return [x + box.left, y + box.top, page.jointAt(x, y)];
}"""
RIGHT = """() => Math.max(document.documentElement.scrollWidth,
  ...[...document.querySelectorAll("#panel *, footer *, header *")]
    .map((part) => part.getBoundingClientRect().right))"""


def go_on(shown, time):
    """Simulate until a time without drawing every picture."""
    shown.evaluate(SIMULATE, time)


def text(shown, name):
    return shown.locator(f"#{name}").text_content().strip()


def test_it_rests_where_motion_is_not_wanted_and_asks_for_nothing(phone, address):
    assert not phone.evaluate("laboratory.state.playing")
    assert phone.complaints == []
    assert [url for url in phone.asked if not url.startswith("blob:")] == [address]


def test_after_two_cycles_it_says_what_python_says(phone):
    phone.evaluate("laboratory.page.begin()")
    go_on(phone, START + 2 * GAIT.period + 0.1)
    assert "After 2 cycles the robot in your gait is" in text(phone, "verdict-text")
    for i, gait in enumerate((GAIT, control_group(GAIT))):
        record = suchus.crawl(ROBOT, gait, cycles=2)
        assert text(phone, f"forward-{i}") == f"{float(displacement(record)[0]):.2f} m".replace("-", "−")
        assert text(phone, f"sideways-{i}") == f"{float(displacement(record)[1]):.2f} m".replace("-", "−")
        assert text(phone, f"height-{i}") == f"{1000 * float(height_peak_to_peak(record)):.0f} mm"
        assert float(text(phone, f"cost-{i}")) == pytest.approx(float(cost_of_transport(record)), rel=0.06)
        duty = text(phone, f"duty-{i}").split()
        assert duty[::2] == [*record.leg.values]
        assert [float(word) for word in duty[1::2]] == pytest.approx(duty_factor(record).values, abs=0.0051)


def test_a_tap_on_a_joint_offers_to_break_it(phone):
    phone.evaluate("laboratory.page.begin(); laboratory.state.follow = false; scrollTo(0, 0)")
    x, y, joint = phone.evaluate(KNEE)
    phone.touchscreen.tap(x, y)
    assert phone.locator("#menu").is_visible()
    assert text(phone, "menu-name") == joint.replace("_", " ")
    phone.locator("#menu").get_by_role("button", name="limp").evaluate("button => button.click()")
    assert f"{joint.replace('_', ' ')} limp" in text(phone, "broken")
    assert phone.evaluate("laboratory.page.walks.map((walk) => [...walk.faults.values()][0].kind)") == ["limp", "limp"]
    assert f"faults={joint}%3Alimp" in phone.evaluate("location.hash")
    phone.evaluate("document.getElementById('mend-all').click()")
    assert phone.evaluate("laboratory.page.walks[0].faults.size") == 0


def test_a_slider_stops_where_the_joints_do_and_says_so(phone):
    phone.evaluate("laboratory.page.change('height', 115)")
    assert "hip height: the joints cannot follow 115 % of reach; it is" in text(phone, "notice")
    assert "out of reach" in text(phone, "notice")
    reached = phone.evaluate("laboratory.page.gait.height")
    assert GAIT.height < reached < 1.15
    assert suits(ROBOT, GAIT.with_numbers(height=reached))
    assert not suits(ROBOT, GAIT.with_numbers(height=reached + 0.005))
    phone.evaluate("document.getElementById('defaults').click()")
    assert phone.evaluate("laboratory.page.gait.height") == GAIT.height


def test_the_file_and_the_link_hold_what_was_set(phone, browser, tmp_path):
    phone.evaluate("laboratory.page.change('stroke', 20); laboratory.page.change('friction', 0.5)")
    with phone.expect_download() as download:
        phone.evaluate("document.getElementById('save').click()")
    assert download.value.suggested_filename == "my_gait.toml"
    download.value.save_as(tmp_path / "my_gait.toml")
    gait = blueprint.read_gait(tmp_path / "my_gait.toml", ROBOT, GAITS)
    assert gait.number("stroke") == pytest.approx(0.2, abs=1e-12)
    other = browser.new_page(viewport=SMALL, reduced_motion="reduce")
    other.set_default_timeout(PATIENCE)
    other.goto(phone.evaluate("document.getElementById('link').value") + "&lift=nonsense&tail=3")
    other.wait_for_function("document.body.dataset.live === 'ready'")
    assert other.evaluate("laboratory.page.settings.friction") == 0.5
    assert other.evaluate("laboratory.page.toml('my_gait')") == (tmp_path / "my_gait.toml").read_text()
    said = text(other, "notice")
    assert "lift=nonsense is no number" in said
    assert "tail is no number of this page" in said
    other.close()


@pytest.mark.parametrize(("wide", "high"), [(390, 760), (844, 390), (1280, 800)])
def test_it_fits_the_screen_with_every_part_open(phone, wide, high):
    phone.set_viewport_size({"width": wide, "height": high})
    phone.evaluate("for (const part of document.querySelectorAll('details')) part.open = true")
    assert phone.evaluate(RIGHT) <= wide


def test_controls_are_named_and_the_keyboard_reaches_them(phone):
    for role, name in (
        ("slider", "limb stroke"),
        ("combobox", "Joint"),
        ("button", "Push both"),
        ("button", "Start again"),
        ("textbox", "Link"),
        ("checkbox", "water up to this level"),
    ):
        assert phone.get_by_role(role, name=name).count() == 1, name
    phone.evaluate("document.getElementById('slide-stroke').focus()")
    before = phone.evaluate("laboratory.page.gait.limbs[0].stroke")
    phone.keyboard.press("ArrowRight")
    phone.wait_for_function(f"laboratory.page.gait.limbs[0].stroke > {before}")


def test_water_floats_a_body_and_a_simulation_that_diverges_is_said(phone):
    phone.evaluate("laboratory.page.fill(true)")
    assert phone.evaluate("laboratory.page.walks[0].water.level") > 0.0
    phone.evaluate("laboratory.page.fill(false); laboratory.page.begin(); laboratory.state.playing = true")
    phone.evaluate("laboratory.page.walks[0].d.qvel[0] = 1e5")
    phone.evaluate("laboratory.page.advance(0.5)")
    assert "your gait: the simulation diverged" in text(phone, "notice")
    phone.evaluate("document.getElementById('again').click()")
    go_on(phone, 0.2)
    assert phone.evaluate("laboratory.page.walks[0].cause") == ""


@pytest.mark.parametrize(
    ("removed", "said"), [("WebAssembly", "no WebAssembly"), ("DecompressionStream", "cannot unpack")]
)
def test_an_old_browser_is_told_what_it_lacks(browser, address, removed, said):
    shown = browser.new_page(viewport=SMALL, reduced_motion="reduce")
    shown.set_default_timeout(PATIENCE)
    shown.add_init_script(f"delete window.{removed}")
    shown.goto(address)
    shown.wait_for_function("document.querySelector('.refused') !== null")
    assert said in text(shown, "verdict-text")
    shown.close()

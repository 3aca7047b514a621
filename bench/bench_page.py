"""The laboratory in one page, in Chromium: its start, its pictures a second, and the physics of both robots.

Each is measured twice: on the processor as it is, and slowed six times, as a stand-in for a phone. The slowing acts on
the page's own thread, in which the physics runs; without a graphics card the pictures are drawn by other threads.
"""

import shutil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from form import in_form
from suchus.apps.laboratory.engine import NoEngine
from suchus.apps.laboratory.page import laboratory_page
from suchus.robot.gaits import default_gait
from suchus.robot.robots import ROBOTS

ROBOT = ROBOTS["caiman"]
SLOWDOWN = in_form(6, 2)  # of the processor [-]
SCREEN = in_form({"width": 390, "height": 760}, {"width": 60, "height": 60})  # every pixel is drawn in software
WATCHED = in_form(10.0, 0.3)  # wall time in which pictures are counted [s]
SIMULATED = in_form(6.0, 0.2)  # time of the robots whose computing is timed [s]
PATIENCE = 300_000  # [ms]
FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
NOTE_START = """
window.noted = {};
(function note() {
  requestAnimationFrame(() => {
    if (!noted.picture && window.suchus && suchus.mass() !== null)
      requestAnimationFrame(() => { noted.picture = performance.now() / 1000; });
    if (document.body && document.body.dataset.live === "ready") noted.engine = performance.now() / 1000;
    if (!noted.picture || !noted.engine) note();
  });
})();
"""
COUNT_PICTURES = """(seconds) => new Promise((done) => {
  const { state } = laboratory, first = state.time, began = performance.now();
  let pictures = 0, shown = first;
  laboratory.play(true);
  (function count() {
    requestAnimationFrame(() => {
      if (state.time !== shown) { pictures += 1; shown = state.time; }
      const passed = (performance.now() - began) / 1000;
      if (passed < seconds) return count();
      laboratory.play(false);
      done({ rate: pictures / passed, pace: (state.time - first) / passed });
    });
  })();
})"""
TIME_PHYSICS = """(seconds) => {
  const { page } = laboratory, began = performance.now();
  page.begin();
  for (let reached = 0, before = -1; reached < seconds - 1e-6 && reached > before;) {
    before = reached;
    reached = page.advance(seconds);
  }
  return (performance.now() - began) / 1000 / seconds;
}"""


def measure(browser: Any, address: str, slowdown: int) -> dict[str, float]:
    """Return the start of the page [s], pictures a second, and times relative to those of the robots.

    Args:
        browser: an opened Chromium.
        address: address of the page.
        slowdown: factor by which the processor is slowed.
    """
    context = browser.new_context(viewport=SCREEN, reduced_motion="reduce")
    page = context.new_page()
    page.set_default_timeout(PATIENCE)
    context.new_cdp_session(page).send("Emulation.setCPUThrottlingRate", {"rate": slowdown})
    page.add_init_script(NOTE_START)
    page.goto(address)
    page.wait_for_function("window.noted.picture && window.noted.engine")
    start = page.evaluate("noted")
    physics = page.evaluate(TIME_PHYSICS, SIMULATED)
    page.evaluate("laboratory.page.begin()")
    shown = page.evaluate(COUNT_PICTURES, WATCHED)
    context.close()
    return {**start, **shown, "physics": physics}


def main() -> None:
    """Measure and print, or say what is missing."""
    try:
        from playwright.sync_api import sync_playwright  # noqa: PLC0415  a tool of the tests, which may be absent
    except ModuleNotFoundError:
        print("playwright is not installed: the page is not timed.")
        return
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        print("There is no chromium on this machine: the page is not timed.")
        return
    try:
        text = laboratory_page(ROBOT, default_gait(ROBOT))
    except NoEngine as error:
        print(f"The page is not timed: {error}")
        return
    with TemporaryDirectory() as folder, sync_playwright() as started:
        file = Path(folder) / "caiman.html"
        file.write_text(text, encoding="utf-8")
        browser = started.chromium.launch(executable_path=chromium, args=FLAGS)
        results = {slowdown: measure(browser, file.as_uri(), slowdown) for slowdown in (1, SLOWDOWN)}
        browser.close()
    for slowdown, result in results.items():
        print(
            f"slowed {slowdown} times: first picture after {result['picture']:.2f} s, engine after "
            f"{result['engine']:.2f} s; {result['rate']:.1f} pictures a second at {result['pace']:.2f} of real time; "
            f"physics of two robots {result['physics']:.3f} of real time"
        )
    slowed = results[SLOWDOWN]["physics"] / results[1]["physics"]
    print(f"physics on a processor slowed {SLOWDOWN} times over that at full speed: ratio {slowed:.2f}")


if __name__ == "__main__":
    main()

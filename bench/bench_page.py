"""The laboratory in one page, in Chromium: its start, its pictures a second, and the physics of both robots.

Each is measured twice: on the processor as it is, and slowed six times, as a stand-in for a phone. The slowing acts on
the page's own thread, in which the physics runs; without a graphics card the pictures are drawn by other threads.
Pictures are counted after the page has found out how finely it can draw them. ``--keep`` states the results on the page
of the documentation.
"""

import os
import shutil
import sys
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from form import SHORT, in_form
from suchus.apps.laboratory.engine import NoEngine
from suchus.apps.laboratory.page import laboratory_page
from suchus.robot.gaits import default_gait
from suchus.robot.robots import ROBOTS

ROBOT = ROBOTS["caiman"]
SLOWDOWN = in_form(6, 2)  # of the processor [-]
SCREEN = in_form({"width": 390, "height": 760}, {"width": 60, "height": 60})  # every pixel is drawn in software
SETTLING = in_form(5.0, 0.2)  # wall time in which the page adapts before pictures are counted [s]
WATCHED = in_form(6.0, 0.3)  # wall time in which pictures are counted [s]
DRAWN = in_form(30, 3)  # pictures whose processor time is taken
SIMULATED = in_form(4.0, 0.2)  # time of the robots whose computing is timed [s]
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
COUNT_PICTURES = """([settling, seconds]) => new Promise((done) => {
  const { state } = laboratory;
  laboratory.play(true);
  setTimeout(() => {
    const first = state.time, began = performance.now();
    let pictures = 0, shown = first;
    (function count() {
      requestAnimationFrame(() => {
        if (state.time !== shown) { pictures += 1; shown = state.time; }
        const passed = (performance.now() - began) / 1000;
        if (passed < seconds) return count();
        const level = suchus.pace.level;
        laboratory.play(false);
        done({ rate: pictures / passed, pace: (state.time - first) / passed, level });
      });
    })();
  }, 1000 * settling);
})"""
DRAW_PICTURES = """(count) => new Promise((done) => {
  const gl = document.getElementById("scene").getContext("webgl2"), pixel = new Uint8Array(4);
  laboratory.attach((time) => time);
  (function draw() {
    requestAnimationFrame(() => {
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // waits until the last picture is drawn
      if (count-- > 0) { laboratory.redraw(); return draw(); }
      laboratory.play(false);
      done();
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
    """Return the start of the page [s], pictures a second, their coarseness and processor time [s], and relative times.

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
    shown = page.evaluate(COUNT_PICTURES, [SETTLING, WATCHED])
    page.evaluate(f"suchus.pace.level = {shown['level']}; laboratory.state.playing = true")
    before = processor_time(browser, "GPU")
    page.evaluate(DRAW_PICTURES, DRAWN)
    drawing = (processor_time(browser, "GPU") - before) / DRAWN
    context.close()
    return {**start, **shown, "physics": physics, "drawing": drawing}


def processor_time(browser: Any, kind: str) -> float:
    """Return the processor time that all processes of a kind have taken in a Chromium [s].

    Args:
        browser: the opened Chromium.
        kind: ``GPU``, ``renderer`` or another type of Chromium's processes.
    """
    processes = browser.new_browser_cdp_session().send("SystemInfo.getProcessInfo")["processInfo"]
    return float(sum(process["cpuTime"] for process in processes if process["type"] == kind))


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
            f"{result['engine']:.2f} s; {result['rate']:.1f} pictures a second at {result['pace']:.2f} of real time, "
            f"{result['level']} levels below the finest, {1000 * result['drawing']:.0f} ms of processor time each; "
            f"physics of two robots {result['physics']:.3f} of real time"
        )
    slowed = results[SLOWDOWN]["physics"] / results[1]["physics"]
    print(f"physics on a processor slowed {SLOWDOWN} times over that at full speed: ratio {slowed:.2f}")
    if "--keep" in sys.argv[1:] and not SHORT:
        keep(results)


def keep(results: Mapping[int, Mapping[str, float]]) -> None:
    """Put the results of each slowdown into the store, and state them on the page."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))
    from pages import stated  # noqa: PLC0415  a tool of the documentation

    names = {1: "full_speed", SLOWDOWN: "slowed"}
    values = {
        f"{names[slowdown]}_{name}": value for slowdown, result in results.items() for name, value in result.items()
    }
    stated.keep("bench_page", values | {"slowdown": SLOWDOWN, "load": os.getloadavg()[0]})
    stated.main()


if __name__ == "__main__":
    main()

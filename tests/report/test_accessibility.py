"""The page can be read by everybody: contrast, headings, texts; axe-core where a browser and axe are at hand."""

import os
import re
import shutil
from dataclasses import dataclass
from html.parser import HTMLParser
from importlib.resources import files
from itertools import pairwise, product
from pathlib import Path

import pytest
import xarray as xr

from suchus.apps.report import Failure, load_result, render_outcome_page, render_page, save_outcome
from suchus.article.paper import CLAIMS
from suchus.article.verdict import Rule, Verdict
from suchus.experiments.experiment import Experiment, Measure, Outcome, silent
from suchus.visual.figures import captioned, panels

AXE = Path(os.environ.get("SUCHUS_AXE", Path(__file__).parents[2] / "node_modules" / "axe-core" / "axe.min.js"))
BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
PAIRS = [
    *((ink, ground) for ink in ("ink", "soft", "accent") for ground in ("paper", "card", "tint")),
    *((word, f"{word}-tint") for word in ("good", "near", "bad", "none")),
]


def said(key, measured, why, word):
    """A verdict that was put in."""
    rule = Rule(claim=key, experiment="question", measure="way", why=why)
    return Verdict(
        claim=CLAIMS[key], rule=rule, measured=measured, low=None, high=None, verdict=word, why=why, share=None
    )


@dataclass(frozen=True)
class Question(Experiment):
    title = "How far?"
    shows = "Fig. 16"

    def run(self, progress=silent):
        return Outcome(
            experiment="displacement",
            measures={
                "forward_coordinated": Measure(0.5, "m"),
                "forward_limbs_only": Measure(0.1, "m"),
            },
            verdicts=(
                said("displacement_coordinated", 0.5, "So.", "same sense"),
                said("height_standing", None, "Not tried.", "not testable"),
            ),
            decides="The stroke decides.",
            record=xr.Dataset({"x": ("time", [0.0, 1.0])}),
            settings={},
            tables={"rows.txt": "a\n"},
        )

    def simulate(self, progress=silent):
        raise NotImplementedError  # its outcome is put in

    measure = explain = simulate

    def draw(self, outcome):
        return {"first": captioned(panels()[0], "A figure of nothing much.")}

    def quick(self):
        return self


@pytest.fixture(scope="module", params=["report", "outcome"])
def page(request, tmp_path_factory):
    question, folder = Question(), tmp_path_factory.mktemp("page") / "displacement"
    outcome = question.run()
    save_outcome(outcome, question.draw(outcome), question, folder, command="suchus run displacement")
    if request.param == "outcome":
        return render_outcome_page(load_result(folder))
    return render_page([load_result(folder)], [Failure(name="other", sentence="It broke.", trace="Traceback")])


def colours(scheme):
    style = files("suchus.visual.pages").joinpath("templates/style.css").read_text()
    dark, light = re.search(r"set dark %\}(.*?)\{%", style, re.S)[1], re.search(r":root \{(.*?)\}", style, re.S)[1]
    return dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6});", light if scheme == "light" else dark))


def luminance(colour):
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    r, g, b = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts)
    return 0.2126 * r + 0.7152 * g + 0.0722 * b


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize(("ink", "ground"), PAIRS)
def test_every_text_stands_out_from_its_ground(scheme, ink, ground):
    shades = colours(scheme)
    dark, light = sorted((luminance(shades[ink]), luminance(shades[ground])))
    assert (light + 0.05) / (dark + 0.05) >= 4.5  # WCAG 2.2, level AA


class Outline(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.tags = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))


def test_headings_go_down_one_step_at_a_time(page):
    levels = [int(tag[1]) for tag, _ in Outline(page).tags if re.fullmatch(r"h[1-6]", tag)]
    assert levels[0] == 1
    assert all(after <= before + 1 for before, after in pairwise(levels))


def test_every_region_has_a_name_of_its_own(page):
    labels = [attrs["aria-label"] for _, attrs in Outline(page).tags if "aria-label" in attrs]
    assert len(labels) == len(set(labels))
    assert not {label for label in labels if f">{label}</h2>" in page}


def test_every_picture_has_a_text(page):
    assert all(len(attrs.get("alt", "")) > 10 for tag, attrs in Outline(page).tags if tag == "img")


def test_axe_finds_nothing(page, tmp_path):
    sync = pytest.importorskip("playwright.sync_api")
    if BROWSER is None or not AXE.is_file():
        pytest.skip("no chromium, or no axe-core: npm install --no-save axe-core, or SUCHUS_AXE=axe.min.js")
    (tmp_path / "page.html").write_text(page)
    found, too_wide = {}, {}
    with sync.sync_playwright() as play:
        browser = play.chromium.launch(executable_path=BROWSER, args=["--no-sandbox", "--disable-gpu"])
        for scheme, width in product(("light", "dark"), (1280, 390)):
            view = browser.new_page(color_scheme=scheme, viewport={"width": width, "height": 800})
            view.goto((tmp_path / "page.html").as_uri())
            view.add_script_tag(path=AXE)
            found[scheme, width] = view.evaluate(
                "axe.run().then(result => result.violations.map(v => v.id + ': ' + v.nodes[0].html))"
            )
            too_wide[scheme, width] = view.evaluate("document.documentElement.scrollWidth") > width
            view.close()
        browser.close()
    assert len(found) == 4
    assert not any(found.values()), found
    assert not any(too_wide.values()), too_wide

"""What strangers see first: every link arrives, unbuilt, built and on the package index; pictures are light."""

import json
import re
import shlex
import tomllib
from functools import cache
from pathlib import Path

import pytest
from PIL import Image

from pages import gallery, links, reference
from pages.blocks import blocks
from suchus.apps.cli.entry import COMMANDS
from suchus.experiments.catalog import EXPERIMENTS

ROOT = Path(__file__).parents[2]
PAGES = sorted(
    path.relative_to(ROOT).as_posix()
    for path in (ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "tests/README.md", *(ROOT / "docs").glob("*.md"))
)
LIGHT = 1_500_000


@cache
def made():
    """Return the pages that the build makes; to find them reads all sources, so not while tests are collected."""
    return {"questions.md", "paper_map.md", "misprints.md", *reference.pages(), *gallery.pages()}


def marks(path):
    """The places of a file that a link can name: headings of a page as slugs, keys of a table."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".json":
        return set(json.loads(text)["values"])
    named = set(re.findall(r"(?<=\{#)[\w-]+(?=\})|(?<=\bid=\")[\w-]+", text))
    headings = re.findall(r"^#+ (.+)$", re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S), re.M)
    return named | {re.sub(r"[\s_-]+", "-", re.sub(r"[^\w\s-]", "", heading.lower()).strip()) for heading in headings}


def dead(page, text):
    """The links of a page in the repository that lead nowhere."""
    lost = []
    for link in links.found(text):
        path, _, mark = link.partition("#")
        place = (ROOT / page).parent / path if path else ROOT / page
        if not place.exists() or (mark and mark not in marks(place)):
            lost.append(link)
    return lost


@pytest.mark.parametrize("page", PAGES)
def test_every_link_arrives_without_a_build(page):
    assert dead(page, (ROOT / page).read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("page", [page for page in PAGES if page.startswith("docs/")])
def test_every_link_arrives_in_the_built_site(page):
    there = {path.relative_to(ROOT / "docs").as_posix() for path in (ROOT / "docs").rglob("*")} | made()
    built = links.found(links.built((ROOT / page).read_text(encoding="utf-8")))
    assert [link for link in built if link.partition("#")[0] not in there | {""}] == []


def test_a_dead_link_is_noticed():
    verdict = "verdicts.md#flight"
    text = f"[a](nowhere.md) [b](index.md#nowhere) [c](index.md#start) [d]({verdict}) `[e](no.md)` [f](x:y)"
    assert dead("docs/index.md", text) == ["nowhere.md", "index.md#nowhere", verdict]


def test_what_the_site_makes_pages_of_is_led_to_them():
    page = "[a](../src/suchus/article/paper/errata.py) [b](../examples/04_kinematics.py) [c](../src/suchus/sim/metrics)"
    assert links.built(page) == "[a](misprints.md) [b](examples/04_kinematics.md) [c](api/sim.metrics.md)"
    assert {page.partition("#")[0] for page in links.MADE.values()} <= made()
    assert all((ROOT / "docs" / source).exists() for source in links.MADE)


def for_the_index(readme):
    """The README as the package index gets it: as the hook of the build makes it."""
    hook = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["hatch"]["metadata"]["hooks"]
    for one in hook["fancy-pypi-readme"]["substitutions"]:
        readme = re.sub(one["pattern"], one["replacement"], readme)
    return readme


def test_no_link_of_the_package_index_is_relative():
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    shown = for_the_index(readme)
    assert links.found(readme)
    assert links.found(shown) == []
    assert "| want to see it walk | getting started, the laboratory in one page |" in shown
    assert "![" not in shown
    assert for_the_index("[a](https://b.c/d)\n\n![e](https://f.g/h.png)\n\n") == (
        "[a](https://b.c/d)\n\n![e](https://f.g/h.png)\n\n"
    )


def test_the_readme_begins_with_what_one_gets_a_picture_that_moves_and_how_to_install():
    first = (ROOT / "README.md").read_text(encoding="utf-8").partition("\n## ")[0]
    words, _, rest = first.partition("![")
    assert not re.search(r"\d", words)
    assert len(re.findall(r"[.:](?=\s)", words)) <= 5
    picture = ROOT / "README.md", re.search(r"\]\((docs/pictures/\w+\.webp)\)", rest)[1]
    path = picture[0].parent / picture[1]
    assert path.stat().st_size < LIGHT
    with Image.open(path) as film:
        assert film.n_frames > 20
        assert film.info["loop"] == 0
    assert rest.index("pip install .") < rest.index("package index")


@pytest.mark.parametrize("page", ["README.md", "docs/index.md", "docs/command_line.md", "docs/lessons.md"])
def test_commands_are_ones_that_there_are(page):
    text = (ROOT / page).read_text(encoding="utf-8")
    lines = [line for block in blocks(text) if block.language == "sh" for line in block.text.splitlines()]
    lines += re.findall(r"`(suchus [^`]+)`", text)
    asked = [words for line in lines if (words := shlex.split(line, comments=True))[:1] == ["suchus"] and words[1:]]
    assert asked
    assert {words[1] for words in asked if not words[1].startswith("-")} <= {one.name for one in COMMANDS} | {"COMMAND"}
    assert {words[2] for words in asked if words[1] == "run" and words[2:]} <= {*EXPERIMENTS, "NAME", "EXPERIMENT"}

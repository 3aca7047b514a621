"""The guide can be read in an afternoon: few pages, few words, and each begins with what one can do there."""

import re
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[2]
MAX_PAGES = 26
MAX_WORDS = 35_000
MAX_WORDS_OF_A_PAGE = 3_000
QUERIES = {"cite": "index", "own URDF": "index", "Feetech": "hardware_bus", "DeepLabCut": "capture"}
"""What readers look for, and the page that answers."""


def menu():
    """Return the menu of the site: the pages of each tab, those that the build makes left out."""
    text = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
    nav = yaml.safe_load(text[text.index("\nnav:") :])["nav"]
    return {title: list(paths(below)) for tab in nav for title, below in tab.items()}


def paths(entry):
    """Yield the pages of an entry of the menu and of all entries below it."""
    match entry:
        case str():
            if entry.endswith(".md"):
                yield entry.removesuffix(".md")
        case dict():
            for below in entry.values():
                yield from paths(below)
        case list():
            for below in entry:
                yield from paths(below)


def page(name):
    return (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")


def words(text):
    """Return how many words a page has: code, comments and the targets of links left out."""
    text = re.sub(r"<!--.*?-->", " ", text, flags=re.DOTALL)
    text = re.sub(r"^( *)(`{3,}).*?^\1\2`*\s*$", " ", text, flags=re.DOTALL | re.MULTILINE)
    text = re.sub(r"(?<=\])(?:\([^()\s]*\)|\[[^\]]*\])", "", text)
    return sum(1 for word in text.split() if re.search(r"[A-Za-z]", word))


def first_screen(text):
    """Return the lines of a page up to its second heading of the second level."""
    return "\n## ".join(text.split("\n## ")[:2])


def lacks(text):
    """Return what the first screen of a page lacks: a sentence, a picture or a result, something that runs."""
    start = first_screen(text)
    after_title = start.partition("\n")[2].lstrip()
    found = {
        "a sentence": re.match(r"[A-Z`].*?[.:?]", after_title, re.DOTALL),
        "a picture or a result": re.search(r"!\[|```text|^\|", start, re.MULTILINE),
        "what runs": re.search(r"^```(?:sh|bash|python|toml)?\n", start, re.MULTILINE),
    }
    return [name for name, match in found.items() if not match]


GUIDE = menu()["Guide"]
EVIDENCE = [name for name in menu()["Evidence"] if name.endswith("_evidence")]


def test_the_guide_has_few_pages_and_every_page_has_its_tab():
    tabs = menu()
    assert list(tabs) == ["Guide", "Examples", "Reference", "Evidence", "Developers"]
    assert len(GUIDE) <= MAX_PAGES
    listed = [name for pages in tabs.values() for name in pages]
    assert len(listed) == len(set(listed))
    assert {path.stem for path in (ROOT / "docs").glob("*.md")} <= set(listed)


@pytest.mark.parametrize("name", GUIDE)
def test_a_page_begins_with_what_one_can_do_a_picture_and_a_command(name):
    assert lacks(page(name)) == []


@pytest.mark.parametrize("name", EVIDENCE)
def test_a_page_of_evidence_begins_with_what_was_asked_and_found(name):
    start = page(name).partition("\n## ")[0]
    assert re.search(r"^\*\*Asked\.\*\* .*?^\*\*Found\.\*\*\s+\S", start, re.MULTILINE | re.DOTALL)
    assert "```sh\n" in start


def test_a_page_that_begins_otherwise_is_noticed():
    assert lacks("# A\n\n## B\n") == ["a sentence", "a picture or a result", "what runs"]
    assert lacks("# A\n\nDo this.\n\n![b](c.png)\n\n## B\n\n```sh\nd\n```\n\n## E\n") == []
    assert lacks("# A\n\nDo this.\n\n## B\n\n![b](c.png)\n\n## C\n\n```sh\nd\n```\n") == ["what runs"]


def test_the_guide_is_read_in_an_afternoon():
    counts = {name: words(page(name)) for name in GUIDE}
    assert {name: count for name, count in counts.items() if count > MAX_WORDS_OF_A_PAGE} == {}
    assert sum(counts.values()) <= MAX_WORDS


def test_words_are_counted_without_code_and_addresses():
    assert words("# A title\n\nTwo [words](page.md#here) and `code`, 12 | <!-- no\nno -->\n\n```sh\nno no\n```\n") == 6


@pytest.mark.parametrize("query", QUERIES)
def test_a_search_finds_the_page(query):
    assert all(re.search(rf"\b{word}\b", page(QUERIES[query]), re.IGNORECASE) for word in query.split())


def test_the_glossary_is_in_alphabetical_order():
    glossary = page("conventions").partition("\n## Glossary\n")[2]
    terms = re.findall(r"^\*\*(.+?)\*\*\n:", glossary, re.MULTILINE)
    assert len(terms) > 20
    assert terms == sorted(terms, key=str.lower)

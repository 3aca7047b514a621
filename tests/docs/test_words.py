"""Words that only suchus used stay in one table: the sources, help, docs and figures have the field's words."""

import io
import re
import tokenize
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

OLD = {
    r"\bways? forward\b": "distance, displacement",
    r"\b(?:length|curvature|speed|rest|end|half|part|harmonics?) of (?:the|its|a|each|their) ways?\b": "path, distance",
    r"\bhow late\b": "phase lag",
    r"\b(?:yaw|tail)_late\b": "yaw_lag, tail_lag",
    r"\b(?:servos?|joints?|angles?|feet|limbs?) (?:is|are|was|were) told\b": "commanded",
    r"\bdoes not tell\b(?! .{0,20}apart)": "does not say, give or show",
    r"\bTell whether\b": "Return whether",
    r"\b(?:came|comes?) of (?:it|each|an|the)\b": "result",
    r"\bwhat came out\b": "result",
    r"\b(?:came|comes?) apart\b": "diverge",
    r"\bgrips?\b": "friction scale; a joint is clamped",
    r"\blost joints?\b|\bjoints? (?:is |are )?lost\b": "failed joint",
    r"\blasting bend\b": "curvature offset",
    r"\bwhereto\b": "in which direction, heading",
    r"\bcheap(?:er|est)? models?\b": "slender-body models",
    r"\b(?:held|endless) (?:body|swim|swimmer|eel|head|water)\b": "tethered; unbounded",
    r"\bresolved flows?\b": "CFD",
    r"\bendless\b|\bwithout end\b": "unbounded",
    r"\bshaken\b": "oscillated transversely",
    r"\bblunted\b": "with a minimum thickness",
    r"\bhardest work(?:ed|ing)\b|\bworks hardest\b": "highest-loaded",
    r"\bshare of standing\b": "duty factor",
    r"\bhalf erect\b": "semi-erect",
    r"\b(?:each|every|both|this|one) arms?\b": "condition",
    r"\bhaste\b": "action rate",
    r"\bastray\b": "lateral drift",
    r"\bshoves?\b": "push",
    r"\bcrews?\b": "processes",
    r"\bswelling\b": "what it is",
    r'"""(?:Who walks|How|On what|Which|What it is|What|When|Where|Whose)(?: \[s\])?\."""': "quantity, unit, range",
}
"""What a stranger would not find in a textbook, and what stands there instead."""

_ENDLESS = r"\bendless\b|\bwithout end\b"
_HELD = r"\b(?:held|endless) (?:body|swim|swimmer|eel|head|water)\b"
_GRIP, _APART, _LOST = r"\bgrips?\b", r"\b(?:came|comes?) apart\b", r"\blost joints?\b|\bjoints? (?:is |are )?lost\b"
MEANT = {
    "docs/architecture.md": tuple(OLD),
    "docs/conventions.md": (_LOST,),
    "docs/terrain.md": (_GRIP,),
    "src/suchus/experiments/catalog/spine_and_tail_map/explanation.md": (_GRIP,),
    "src/suchus/experiments/catalog/sensitivity/experiment.py": (_APART,),
    "src/suchus/experiments/catalog/shore/experiment.py": (_GRIP,),
    "src/suchus/experiments/catalog/shore/figure.py": (_GRIP,),
    "tools/validation_page.py": (_HELD,),
    "src/suchus/article/paper/claims_land.py": (_LOST,),
    "src/suchus/article/paper/errata.py": (_LOST,),
    "src/suchus/sim/record/schema.py": (_GRIP,),
    "src/suchus/experiments/study/claims.py": (_APART,),
}
"""Where an old word is meant: a table explains it; others hold the article's own words, or names in files."""


def prose(path: Path) -> str:
    """Return what people read of a file: of a module its strings and comments, each on a line of its own."""
    text = path.read_text(encoding="utf-8")
    if path.suffix != ".py":
        return text
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    return "\n".join(t.string for t in tokens if t.type in (tokenize.STRING, tokenize.COMMENT))


def found(text: str, allowed: tuple[str, ...] = ()) -> list[str]:
    """Return each old word in a text that is not allowed there, and what to write."""
    flat = re.sub(r"[ \t]*\n[ \t#]*", " ", text)  # a phrase may go over the end of a line
    return [
        f"{hit[0]!r} (write: {new})"
        for old, new in OLD.items()
        if old not in allowed
        for hit in [re.search(old, flat)]
        if hit
    ]


def pages() -> list[str]:
    """Return every source, example, tool and page but that of the article's own words, as a path from the root."""
    files = [ROOT / "README.md", *(page for page in (ROOT / "docs").glob("*.md") if page.name != "verdicts.md")]
    for folder in ("src/suchus", "examples", "tools"):
        files += [path for ending in ("py", "html", "js", "md") for path in (ROOT / folder).rglob(f"*.{ending}")]
    return sorted(str(path.relative_to(ROOT)) for path in files if "__pycache__" not in path.parts)


@pytest.mark.parametrize(
    "sentence",
    [
        "The way forward in two cycles.", "it says how late the tail bends", "the angles that servos are told to make",
        "the physics came apart at 3 s", "the ground's grip", "what lost joints cost", "a lasting\n    bend turns it",
        "whereto it faces", "both cheap models", "around the held body", "hardest worked: LF_yaw", "half erect legs",
        '"""Who walks."""', '"""On what."""', '"""Tell whether it is."""', "with each arm",
    ],
)  # fmt: skip
def test_an_old_word_is_found(sentence):
    assert found(sentence)


@pytest.mark.parametrize(
    "sentence",
    [
        "either way", "in the same way", "the fastest way to move on land", "colours that people can tell apart",
        "it does not tell the two apart", "lost points", "the arm of the balance", "it is held straight", "gripper",
        "the simulation diverged", "two feet apart",
    ],
)  # fmt: skip
def test_plain_english_is_not(sentence):
    assert not found(sentence)


def left(page: Path, allowed: tuple[str, ...] = ()) -> list[str]:
    """Return each old word in the prose of a file; only where its text has one are strings and comments told apart."""
    return found(page.read_text(encoding="utf-8"), allowed) and found(prose(page), allowed)


def test_no_old_word_comes_back():
    assert {page: words for page in pages() if (words := left(ROOT / page, MEANT.get(page, ())))} == {}


def test_an_old_word_is_seen_where_it_is_prose(tmp_path):
    page = tmp_path / "page.py"
    page.write_text("grip = 1.0\n")
    assert left(page) == []
    page.write_text("grip = 1.0  # what a lost\n# joint costs\n")
    assert len(left(page)) == 1


@pytest.mark.parametrize("page", MEANT)
def test_where_an_old_word_is_meant_it_stands(page):
    text = prose(ROOT / page)
    assert all(re.search(old, re.sub(r"\s+", " ", text)) for old in MEANT[page]) or page.endswith(".md")
    assert set(MEANT[page]) <= set(OLD)


def test_a_table_has_every_old_word_that_is_looked_for():
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    assert len(found(text)) >= 15

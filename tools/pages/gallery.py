"""The numbered scripts as pages: what they say of themselves, their code, their pictures."""

import ast
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
PICTURES = ROOT / "docs" / "pictures"
_WIDE = "---\nhide: [toc]\n---"
_SHARED = {
    "01_crawl": ("crawling.png",),
    "05_cylinder_wake": ("flow_wake.png",),
    "06_eel": ("flow_eel.png",),
    "14_heaving_foil": ("flow_foil.png",),
    "16_falling_ellipse": ("flow_falling.png",),
    "18_flutter": ("flow_flutter.png",),
    "21_patch_of_fine_cells": ("flow_patch.png",),
    "26_coin_on_a_floor": ("flow_coin.png",),
    "09_replay": ("replay.png",),
    "10_optimise": ("optimised_crawl.png",),
}
"""Pictures that other pages show too."""


@dataclass(frozen=True, slots=True)
class Example:
    """One numbered script."""

    stem: str
    """Its file's name without the ending."""
    title: str
    """First line of its docstring."""
    text: str
    """What else the docstring says."""
    code: str
    """What follows the docstring."""
    pictures: tuple[str, ...]
    """File names of its pictures."""

    @property
    def short(self) -> str:
        """Its name in the menu."""
        number, _, words = self.stem.partition("_")
        return f"{number} {words.replace('_', ' ')}"


@cache
def examples() -> list[Example]:
    """Return the scripts in the order of their numbers."""
    return [_read(path) for path in sorted((ROOT / "examples").glob("[0-9][0-9]_*.py"))]


def pages() -> dict[str, str]:
    """Return every page of the gallery by its path."""
    found = {f"examples/{one.stem}.md": _page(one) for one in examples()}
    return {"examples/index.md": _index(), **found}


def _read(path: Path) -> Example:
    source = path.read_text(encoding="utf-8")
    tree = ast.parse(source)
    text_of = ast.get_docstring(tree) or path.stem
    title, _, text = text_of.partition("\n")
    code = "\n".join(source.splitlines()[tree.body[0].end_lineno :]).strip()
    text = re.sub(r"^Usage: (.*)$", r"```sh\n\1\n```", text.strip(), flags=re.M)
    shared = [PICTURES / name for name in _SHARED.get(path.stem, ())]
    pictures = tuple(p.name for p in [*shared, *sorted(PICTURES.glob(f"example_{path.stem[:2]}*.png"))])
    return Example(stem=path.stem, title=title.rstrip("."), text=text, code=code, pictures=pictures)


def _page(one: Example) -> str:
    shown = [f"![{one.title}](../pictures/{name})" for name in one.pictures]
    code = f'```python title="examples/{one.stem}.py"\n{one.code}\n```'
    return "\n\n".join([_WIDE, f"# {one.title}", one.text, code, *shown, ""])


def _index() -> str:
    lines = [
        "# Examples",
        "",
        "Short scripts; the tests run each of them as it stands. Their pictures are made by",
        "`python tools/example_pictures.py`.",
        "",
        '<div class="gallery" markdown>',
    ]
    for one in examples():
        picture = f"![](../pictures/{one.pictures[0]})" if one.pictures else ""
        lines += ["", f"<div markdown>\n\n{picture}\n\n[{one.title}]({one.stem}.md)\n\n</div>"]
    return "\n".join([*lines, "", "</div>", ""])

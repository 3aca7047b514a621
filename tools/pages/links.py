"""Links of the pages: in the repository they lead to what stands there, in the built site to the pages made of it.

A page links to ``../src/suchus/article/paper/errata.py``, ``../examples/04_kinematics.py`` or
``../src/suchus/sim/metrics``. A reader of the unbuilt page can open them all; the site has a page made of each.
"""

import re

MADE = {
    "../src/suchus/experiments/catalog": "questions.md",
    "../src/suchus/article/paper": "paper_map.md",
    "../src/suchus/article/paper/claims.py": "paper_map.md#statements",
    "../src/suchus/article/paper/errata.py": "misprints.md",
    "../examples": "examples/index.md",
    "../src/suchus": "api/index.md",
}
"""The page of the site that is made of a file or a folder, as a page in ``docs`` links to them."""
_LINK = re.compile(r"(?<=\]\()([^()\s]+)(?=\))")


def found(markdown: str) -> list[str]:
    """Return where the links and pictures of a page lead, those to addresses of the network and in code left out."""
    plain = re.sub(r"^```.*?^```$|`[^`\n]*`", "", markdown, flags=re.M | re.S)
    return [link for link in _LINK.findall(plain) if not re.match(r"[a-z]+:", link)]


def made(link: str) -> str:
    """Return where a link leads in the built site."""
    path, mark, place = link.partition("#")
    if path in MADE:
        return MADE[path] + mark + place
    if script := re.fullmatch(r"\.\./examples/(\w+)\.py", path):
        return f"examples/{script[1]}.md"
    if room := re.fullmatch(r"\.\./src/suchus/([\w/]+)", path):
        return f"api/{room[1].replace('/', '.')}.md"
    return link


def built(markdown: str) -> str:
    """Return a page of ``docs`` with its links as the built site has them."""
    return _LINK.sub(lambda link: made(link[0]), markdown)

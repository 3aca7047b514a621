"""Pins: each version of a ``constraints.txt`` with the SHA-256 of every file that its release has, into ``pins.txt``.

``make pins``, after a version has changed. A file holds names, versions and digests and no address, so that any index
serves whose files are the same; pip refuses others, and packages that stand in no pins. uv finds the digests.
"""

import sys
import tempfile
from pathlib import Path

from release.environment import PINNED, ROOT, Environment, run

PLACES = (ROOT, PINNED.parent)
"""Folders that have both files: what the make targets install, and what builds and checks a release."""
_FROM = "3.11.5"  # mkdocs-material asks for it
_HEAD = "# Made of constraints.txt by `make pins`: the digests that pip compares before it installs anything.\n"


def pinned(constraints: Path, uv: Path) -> str:
    """Return the versions of a file with the digests of their files, in pip's format.

    Args:
        constraints: a version a line.
        uv: the program.
    """
    words = ["--universal", "--python-version", _FROM, "--no-deps", "--generate-hashes", "--no-header", "--no-annotate"]
    printed = run([uv, "pip", "compile", "--quiet", *words, constraints], cwd=constraints.parent)
    return _HEAD + printed


def main() -> int:
    """Write both files."""
    with tempfile.TemporaryDirectory(prefix="suchus-pins-") as folder:
        tools = Environment(Path(folder) / "tools").make()
        if not tools.pip_if_served("uv"):
            print("uv is not to be had, so the pins stay as they are.", file=sys.stderr)
            return 1
        for place in PLACES:
            text = pinned(place / "constraints.txt", tools.bin / "uv")
            (place / "pins.txt").write_text(text, encoding="utf-8")
            print(place.joinpath("pins.txt").relative_to(ROOT), text.count("--hash="), "digests")
    return 0


if __name__ == "__main__":
    sys.exit(main())

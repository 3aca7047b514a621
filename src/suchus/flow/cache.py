"""Where the machine code of the kernels is kept between runs.

numba alone keeps it beside the sources, or in a folder of its own in the user's cache where those cannot be written,
and asks of a kernel that it loads only whether the kernel's own file has changed. An upgraded package, or an edit of a
kernel that others call, would leave them as they were. So there is a folder for each state of the sources.
"""

import hashlib
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

_HERE = Path(__file__).parent
_PREFIX = "kernels-"
_KEPT = 4
"""States of the sources whose code is kept [-]."""
_MAKERS = re.compile(
    r"^from suchus\.flow\.compiled import .*\b(?:compiled|threaded|part|ordered_part|threaded_part)\b", re.M
)
_OWN = ("compiled.py", "linking.py")


def folder() -> Path | None:
    """Return where the code of these sources is kept; None where no place can be written to.

    That is below ``NUMBA_CACHE_DIR`` if it is set; else beside the sources; else in the user's cache folder.
    """
    return first_writable(place / f"{_PREFIX}{sources()}" for place in places())


def places() -> list[Path]:
    """Return the folders that are tried, in their order."""
    if asked := os.environ.get("NUMBA_CACHE_DIR"):
        return [Path(asked)]
    return [_HERE / "__pycache__", user_cache()]


def user_cache() -> Path:
    """Return the user's folder for what can be made anew, ``suchus`` in it."""
    if asked := os.environ.get("XDG_CACHE_HOME"):
        return Path(asked) / "suchus"
    home = Path(os.path.expanduser("~"))  # noqa: PTH111  Path.home raises where there is none
    return home / ("Library/Caches" if sys.platform == "darwin" else ".cache") / "suchus"


def kernel_files() -> list[Path]:
    """Return the files of this room that hold kernels or parts of them, and those that say how they are compiled."""
    files = sorted(_HERE.glob("*.py"))
    return [file for file in files if file.name in _OWN or _MAKERS.search(file.read_text(encoding="utf-8"))]


def sources() -> str:
    """Return a digest of all kernels' sources, since any of them may be a part of any other."""
    text = hashlib.sha256()
    for file in kernel_files():
        text.update(file.name.encode() + b"\0" + file.read_bytes() + b"\0")
    return text.hexdigest()[:12]


def first_writable(folders: Iterable[Path]) -> Path | None:
    """Return the first folder that can be made and written to; those before it are left as they were."""
    for one in folders:
        with suppress(OSError):
            one.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=one):
                pass
            _forget(one)
            return one
    return None


def _forget(current: Path) -> None:
    """Remove the code of sources that are long gone, all but the latest few."""
    with suppress(OSError):
        others = [one for one in current.parent.glob(f"{_PREFIX}*") if one != current]
        others.sort(key=lambda one: one.stat().st_mtime, reverse=True)
        for old in others[_KEPT - 1 :]:
            shutil.rmtree(old, ignore_errors=True)

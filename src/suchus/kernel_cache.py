"""Where the machine code of compiled kernels is kept between runs.

numba alone keeps it beside the sources, or in a folder of its own in the user's cache where those cannot be written,
and asks of a kernel that it loads only whether the kernel's own file has changed. An upgraded package, or an edit of a
kernel that others call, would leave them as they were. So there is a folder for each state of the sources.
"""

import hashlib
import os
import shutil
import sys
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

KEPT = 4
"""States of the sources whose code is kept [-]."""


def folder(home: Path, files: Iterable[Path], prefix: str) -> Path | None:
    """Return where the code of some sources is kept; None where no place can be written to.

    That is below ``NUMBA_CACHE_DIR`` if it is set; else beside the sources; else in the user's cache folder.

    Args:
        home: folder of the sources.
        files: the sources, any of which may be a part of any other.
        prefix: how the names of their folders begin.
    """
    return _first_writable([place / f"{prefix}{digest(files)}" for place in places(home)], prefix)


def places(home: Path) -> list[Path]:
    """Return the folders that are tried, in their order."""
    if asked := os.environ.get("NUMBA_CACHE_DIR"):
        return [Path(asked)]
    return [home / "__pycache__", user_cache()]


def user_cache() -> Path:
    """Return the user's folder for what can be made anew, ``suchus`` in it."""
    if asked := os.environ.get("XDG_CACHE_HOME"):
        return Path(asked) / "suchus"
    home = Path(os.path.expanduser("~"))  # noqa: PTH111  Path.home raises where there is none
    return home / ("Library/Caches" if sys.platform == "darwin" else ".cache") / "suchus"


def digest(files: Iterable[Path]) -> str:
    """Return the first 12 digits of the SHA-256 of the names and bytes of some files."""
    text = hashlib.sha256()
    for file in files:
        text.update(file.name.encode() + b"\0" + file.read_bytes() + b"\0")
    return text.hexdigest()[:12]


@contextmanager
def kept_in(config: Any, place: Path) -> Iterator[None]:
    """Let numba keep the kernels that are made meanwhile in a folder.

    Args:
        config: ``numba.config``, which is read when a kernel is made, for it alone.
        place: the folder.
    """
    asked, config.CACHE_DIR = config.CACHE_DIR, str(place)
    try:
        yield
    finally:
        config.CACHE_DIR = asked


def _first_writable(folders: Iterable[Path], prefix: str) -> Path | None:
    """Return the first folder that can be made and written to; those before it are left as they were."""
    for one in folders:
        with suppress(OSError):
            one.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=one):
                pass
            _forget(one, prefix)
            return one
    return None


def _forget(current: Path, prefix: str) -> None:
    """Remove the code of sources that are long gone, all but the latest few."""
    with suppress(OSError):
        others = [one for one in current.parent.glob(f"{prefix}*") if one != current]
        others.sort(key=lambda one: one.stat().st_mtime, reverse=True)
        for old in others[KEPT - 1 :]:
            shutil.rmtree(old, ignore_errors=True)

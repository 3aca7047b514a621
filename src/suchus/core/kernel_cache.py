"""Where the machine code of compiled kernels is kept between runs.

numba alone keeps it beside the sources, or in a folder of its own in the user's cache where those cannot be written,
and asks of a kernel that it loads only whether the kernel's own file has changed. An upgraded package, or an edit of a
kernel that others call, would leave them as they were. So there is a folder for each state of the sources.

What numba keeps are pickles of machine code, and a flipped bit in them is any error, or the end of the process. So each
file begins with a digest of the rest, of its name and of numba's version: nothing is unpickled that was damaged or is
another's, and it is compiled anew. numba numbers the files of a kernel's signatures, so that a number may come to mean
another signature while two processes write, or after a kill: each file says of which it is. What cannot be kept is
compiled each time, and one sentence says so.
"""

import hashlib
import os
import pickle
import shutil
import sys
import tempfile
from collections.abc import Iterable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

from numba.core import config
from numba.core.caching import FunctionCache, IndexDataCacheFile

from suchus.core.writing import new_file

MAX_SOURCE_STATES = 4
"""States of the sources whose code is kept [-]."""


def folder(home: Path, files: Iterable[Path], prefix: str) -> Path | None:
    """Return where the code of some sources is kept; None where no place can be written to, and then we say so.

    That is below ``NUMBA_CACHE_DIR`` if it is set; else beside the sources; else in the user's cache folder.

    Args:
        home: folder of the sources.
        files: the sources, any of which may be a part of any other.
        prefix: how the names of their folders begin.
    """
    cache_folder = _first_writable([parent / f"{prefix}{digest(files)}" for parent in places(home)], prefix)
    if cache_folder is None:
        _say_unkept("no folder for it can be written to, and NUMBA_CACHE_DIR may name another")
    return cache_folder


def places(home: Path) -> list[Path]:
    """Return the folders that are tried, in their order."""
    if cache_dir := os.environ.get("NUMBA_CACHE_DIR"):
        return [Path(cache_dir)]
    return [home / "__pycache__", user_cache()]


def user_cache() -> Path:
    """Return the user's folder for what can be made anew, ``suchus`` in it."""
    if cache_home := os.environ.get("XDG_CACHE_HOME"):
        return Path(cache_home) / "suchus"
    home = Path(os.path.expanduser("~"))  # noqa: PTH111  Path.home raises where there is none
    return home / ("Library/Caches" if sys.platform == "darwin" else ".cache") / "suchus"


def digest(files: Iterable[Path]) -> str:
    """Return the first 12 digits of the SHA-256 of the names and bytes of some files."""
    text = hashlib.sha256()
    for file in files:
        text.update(file.name.encode() + b"\0" + file.read_bytes() + b"\0")
    return text.hexdigest()[:12]


def keep(kernel: Any, cache_folder: Path) -> None:
    """Let the machine code of a kernel be kept in a folder; see ``numba.core.dispatcher.Dispatcher.enable_caching``.

    Args:
        kernel: kernel that ``numba.njit`` made, without ``cache``.
        cache_folder: the folder.
    """
    default_dir, config.CACHE_DIR = (
        config.CACHE_DIR,
        str(cache_folder),
    )  # which is read when a cache is made, for it alone
    try:
        kernel._cache = _SealedCache(kernel.py_func)
    finally:
        config.CACHE_DIR = default_dir


class _SealedCache(FunctionCache):  # type: ignore[misc]
    """numba's cache of a kernel, in files whose digests are right."""

    def __init__(self, function: Any) -> None:
        super().__init__(function)
        stamp = self._impl.locator.get_source_stamp()
        self._cache_file = SealedFiles(self._cache_path, self._impl.filename_base, stamp)

    def save_overload(self, signature: Any, code: Any) -> None:
        """Keep the code of a signature where that can be."""
        try:
            super().save_overload(signature, code)
        except OSError as error:
            _say_unkept(str(error))


_SEAL = b"suchus kernel 2\n"


class SealedFiles(IndexDataCacheFile):  # type: ignore[misc]
    """An index of a kernel's signatures and a file for each of them, as numba has them, each with its digest."""

    def save(self, key: Any, data: Any) -> None:
        """Keep the code of a signature; the file says of which."""
        super().save(key, (key, data))

    def load(self, key: Any) -> Any:
        """Return the code of a signature; None where there is none, or that of another in its place."""
        stored_key, data = super().load(key) or (None, None)
        return data if stored_key == key else None

    def _load_index(self) -> dict[Any, str]:
        version, stamp, names = self._read(self._index_name) or ("", None, {})
        return names if (version, stamp) == (self._version, self._source_stamp) else {}

    def _save_index(self, overloads: dict[Any, str]) -> None:
        self._write(self._index_name, (self._version, self._source_stamp, overloads))

    def _load_data(self, name: str) -> Any:
        return self._read(name)

    def _save_data(self, name: str, data: Any) -> None:
        self._write(name, data)

    def _read(self, name: str) -> Any:
        """Return what a file holds; None if it is missing, its digest is wrong, or its classes cannot be imported."""
        try:
            data = Path(self._cache_path, name).read_bytes()
        except OSError:
            return None
        content = data[len(_SEAL) + 32 :]
        try:
            return pickle.loads(content) if data == self.sealed(name, content) else None
        except (ImportError, AttributeError):
            return None

    def _write(self, name: str, value: Any) -> None:
        with new_file(Path(self._cache_path, name)) as draft:
            draft.write_bytes(self.sealed(name, self._dump(value)))

    def sealed(self, name: str, content: bytes) -> bytes:
        """Return the content of a file of this name with its digest."""
        identity = f"{name} of numba {self._version}\0".encode()
        return _SEAL + hashlib.sha256(identity + content).digest() + content


@cache
def _say_unkept(reason: str) -> None:
    print(f"suchus: compiled code is not kept, and will be compiled again: {reason}", file=sys.stderr, flush=True)


def _first_writable(folders: Iterable[Path], prefix: str) -> Path | None:
    """Return the first folder that can be made and written to; those before it are left as they were."""
    for candidate in folders:
        with suppress(OSError):
            candidate.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=candidate):
                pass
            _forget(candidate, prefix)
            return candidate
    return None


def _forget(current: Path, prefix: str) -> None:
    """Remove the code of sources that are long gone, all but the latest few."""
    with suppress(OSError):
        other_folders = [cache_folder for cache_folder in current.parent.glob(f"{prefix}*") if cache_folder != current]
        other_folders.sort(key=lambda cache_folder: cache_folder.stat().st_mtime, reverse=True)
        for old in other_folders[MAX_SOURCE_STATES - 1 :]:
            shutil.rmtree(old, ignore_errors=True)

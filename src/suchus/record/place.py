"""Places on disk: a file or folder appears complete or not at all."""

import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from suchus.errors import Unwritable


def check_writable(folder: Path) -> None:
    """Refuse a folder that could not be made or written to, without leaving anything behind.

    Raises:
        Unwritable: it lies below a file, on a read-only disk, or permission is missing.
    """
    there = folder
    while not there.exists() and there != there.parent:
        there = there.parent
    try:
        with tempfile.TemporaryDirectory(dir=there, prefix=".suchus-"):
            pass
    except OSError as error:
        raise _unwritable(folder, error) from error


@contextmanager
def new_file(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside ``path`` that takes its place when the block ends well.

    Raises:
        Unwritable: the place cannot be written to.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=f".{path.name}-") as folder:
            draft = Path(folder) / path.name
            yield draft
            draft.replace(path)
    except OSError as error:
        raise _unwritable(path, error) from error


@contextmanager
def new_folder(path: Path, *, mark: str) -> Iterator[Path]:
    """Yield a temporary folder beside ``path`` that takes its place when the block ends well.

    Until then an older folder stays as it was; if the block ends badly, or by Ctrl-C, it stays for good.

    Args:
        path: where the folder shall be.
        mark: name of a file that tells our folders from others; one without it is never replaced.

    Raises:
        Unwritable: the place cannot be written to, or is taken by something else.
    """
    check_replaceable(path, mark=mark)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=f".{path.name}-") as shelter:
            draft = Path(shelter) / "new"
            draft.mkdir()
            yield draft
            _swap(draft, path, Path(shelter) / "old")
    except OSError as error:
        raise _unwritable(path, error) from error


def check_replaceable(path: Path, *, mark: str) -> None:
    """Refuse a place that holds something other than an empty folder or one that we wrote.

    Raises:
        Unwritable: the place is taken.
    """
    if not path.exists() or (path.is_dir() and ((path / mark).is_file() or not any(path.iterdir()))):
        return
    raise Unwritable(f"{path} exists and was not written by suchus; choose another place or move it away.")


def sweep(path: Path) -> None:
    """Remove what a process that died in ``new_folder`` has left beside ``path``; an older folder comes back."""
    for shelter in path.parent.glob(f".{path.name}-*"):
        old = shelter / "old"
        if old.exists() and not path.exists():
            old.rename(path)
        shutil.rmtree(shelter, ignore_errors=True)


def _swap(draft: Path, path: Path, old: Path) -> None:
    if path.exists():
        path.rename(old)
    try:
        draft.rename(path)
    except BaseException:
        if old.exists() and not path.exists():
            old.rename(path)
        raise
    shutil.rmtree(old, ignore_errors=True)


def _unwritable(path: Path, error: OSError) -> Unwritable:
    if isinstance(error, Unwritable):
        return error
    return Unwritable(f"{path} cannot be written: {(error.strerror or str(error)).lower()}.")

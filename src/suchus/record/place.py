"""Places on disk: a file or folder appears complete or not at all, and what a kill left behind is taken away."""

import fcntl
import glob
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from suchus.errors import InvalidDesign, Unwritable
from suchus.reading import there

_LONGEST = 200  # bytes of a name, so that a draft's name, which is longer, is a name too


def check_name(name: str, what: str) -> None:
    """Refuse a name that makes no folder of its own in another folder.

    Args:
        name: such as that of a study.
        what: what is called so.

    Raises:
        InvalidDesign: the name is empty, means another folder, or cannot be a name on disk.
    """
    odd = not name.strip() or name in (".", "..") or not name.isprintable() or any(c in name for c in "/\\")
    if odd or len(name.encode(errors="replace")) > _LONGEST:
        raise InvalidDesign(
            f"the {what} is named {name!r}, which makes no folder; choose a name of up to {_LONGEST} bytes without "
            "slashes, or say --out DIR."
        )


def check_writable(folder: Path) -> None:
    """Refuse a folder that could not be made or written to, without leaving anything behind.

    Raises:
        Unwritable: it lies below a file, on a read-only disk, or permission is missing.
    """
    above = folder
    while not there(above) and above != above.parent:
        above = above.parent
    try:
        _check_names(folder)
        with tempfile.TemporaryDirectory(dir=above, prefix=".suchus-"):
            pass
    except (OSError, ValueError) as error:
        raise _unwritable(folder, error) from error


@contextmanager
def new_file(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside ``path`` that takes its place when the block ends well.

    Raises:
        Unwritable: the place cannot be written to.
    """
    try:
        _check_names(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        with _shelter(path) as folder:
            draft = folder / path.name
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
        mark: name of a file that marks our folders; one without it is never replaced.

    Raises:
        Unwritable: the place cannot be written to, or is taken by something else.
    """
    check_replaceable(path, mark=mark)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with _shelter(path) as shelter:
            draft = shelter / "new"
            draft.mkdir()
            yield draft
            _swap(draft, path, shelter / "old")
    except OSError as error:
        raise _unwritable(path, error) from error


def check_replaceable(path: Path, *, mark: str) -> None:
    """Refuse a place that holds something other than an empty folder or one that we wrote.

    Raises:
        Unwritable: the place is taken, or cannot be looked at.
    """
    try:
        _check_names(path)
        if not path.exists() or (path.is_dir() and ((path / mark).is_file() or not any(path.iterdir()))):
            return
    except OSError as error:
        raise _unwritable(path, error) from error
    raise Unwritable(f"{path} exists and was not written by suchus; choose another place or move it away.")


def sweep(path: Path) -> None:
    """Remove what processes that died while they wrote ``path`` have left beside it; an older folder comes back.

    What a living process is at stays: it holds a lock on its draft.
    """
    with suppress(OSError):
        for shelter in path.parent.glob(f".{glob.escape(path.name)}-*"):
            with _locked(shelter) as ours:
                if not ours:
                    continue
                old = shelter / "old"
                if old.exists() and not path.exists():
                    old.rename(path)
                shutil.rmtree(shelter, ignore_errors=True)


@contextmanager
def _shelter(path: Path) -> Iterator[Path]:
    """Yield a temporary folder beside a path, locked as long as we live, after those of the dead are taken away."""
    sweep(path)
    for _ in range(100):
        with (
            tempfile.TemporaryDirectory(dir=path.parent, prefix=f".{path.name}-", ignore_cleanup_errors=True) as folder,
            _locked(Path(folder)) as ours,
        ):
            if (
                ours is not False and Path(folder).exists()
            ):  # else another process took it for a dead one's before it was locked
                yield Path(folder)
                return
    raise Unwritable(f"{path} cannot be written: other processes keep taking away what is begun there.")


@contextmanager
def _locked(folder: Path) -> Iterator[bool | None]:
    """Hold a folder and return whether we do: not where another has it or it is gone; None on a disk without locks."""
    try:
        held = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    except OSError:
        yield False
        return
    try:
        try:
            fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            yield False
            return
        except OSError:
            yield None
            return
        yield True
    finally:
        os.close(held)


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


def _check_names(path: Path) -> None:
    """Refuse a path that the system takes for no path at all."""
    if "\0" in str(path):
        raise Unwritable(f"{str(path)!r} is no name that a file can have.")


def _unwritable(path: Path, error: OSError | ValueError) -> Unwritable:
    if isinstance(error, Unwritable):
        return error
    reason = error.strerror if isinstance(error, OSError) else None
    return Unwritable(f"{path} cannot be written: {(reason or str(error)).lower()}.")

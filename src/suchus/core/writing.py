"""Files that suchus writes: each appears whole or not at all, and what a user wrote or changed stays.

Everything is written beside its place and renamed. What costs more than a second of work is on the disk by then, and
not only in memory (``lasting``). A file ``.suchus-written`` in each folder of results holds the digests of what suchus
wrote there, as ``sha256sum`` lists them: what is there in one of these states may be replaced, and nothing else, unless
``replacing`` is asked for, which keeps a backup. What a kill left behind is taken away by who writes there next.
"""

import fcntl
import glob
import hashlib
import logging
import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path
from urllib.parse import quote_from_bytes, unquote

from suchus.core.errors import InvalidDesign, Unwritable
from suchus.core.reading import path_exists

MANIFEST = ".suchus-written"
"""File that says what suchus wrote into its folder: a line for each state, its digest and the name."""
_MAX_NAME_BYTES = 200  # bytes of a name, so that a draft's name, which is longer, is a name too
_LOG = logging.getLogger(__name__)
_replacing: ContextVar[bool] = ContextVar("replacing", default=False)
_drafts: set[Path] = set()  # folders that are being written, whose files nobody else knows yet


def check_name(name: str, kind: str) -> None:
    """Refuse a name that makes no folder of its own in another folder.

    Args:
        name: such as that of a study.
        kind: noun for what has the name, as ``study``.

    Raises:
        InvalidDesign: the name is empty, means another folder, or cannot be a name on disk.
    """
    odd = not name.strip() or name in (".", "..") or not name.isprintable() or any(c in name for c in "/\\")
    if odd or len(name.encode(errors="replace")) > _MAX_NAME_BYTES:
        raise InvalidDesign(
            f"the {kind} is named {name!r}, which makes no folder; choose a name of up to {_MAX_NAME_BYTES} bytes "
            "without slashes, or say --out DIR."
        )


def check_writable(folder: str | Path) -> None:
    """Refuse a folder that could not be made or written to, without leaving anything behind.

    Raises:
        Unwritable: it lies below a file, on a read-only disk, or permission is missing.
    """
    folder = Path(folder)
    ancestor = folder
    while not path_exists(ancestor) and ancestor != ancestor.parent:
        ancestor = ancestor.parent
    try:
        _check_names(folder)
        with tempfile.TemporaryDirectory(dir=ancestor, prefix=".suchus-"):
            pass
    except (OSError, ValueError) as error:
        raise _unwritable(folder, error) from error


@contextmanager
def new_file(path: str | Path, *, lasting: bool = False) -> Iterator[Path]:
    """Yield a temporary path beside ``path`` that takes its place when the block ends well.

    It is for what suchus keeps for itself, and replaces whatever is there; a file for a user is written by ``write``.

    Args:
        path: path of the file.
        lasting: whether it is on the disk when this ends, so that it outlives a loss of power.

    Raises:
        Unwritable: the place cannot be written to.
    """
    path = Path(path)
    try:
        _check_names(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        with _shelter(path) as folder:
            draft = folder / path.name
            yield draft
            if lasting:
                _to_disk(draft)
            draft.replace(path)
        if lasting:
            _to_disk(path.parent)
    except OSError as error:
        raise _unwritable(path, error) from error


def keep(path: str | Path, data: bytes) -> None:
    """Write a file that suchus keeps for itself, such as a checkpoint, onto the disk; what is there is replaced.

    Raises:
        Unwritable: the place cannot be written to.
    """
    path = Path(path)
    if _is_draft(path):
        path.write_bytes(data)
        return
    with new_file(path, lasting=True) as draft:
        draft.write_bytes(data)


def write(path: str | Path, content: str | bytes) -> Path:
    """Write a file for a user and return its path; what the user wrote or changed there is not replaced.

    Args:
        path: path of the file; in a folder that ``new_folder`` yields it is simply written.
        content: bytes, or a text, which becomes UTF-8.

    Raises:
        Unwritable: the place cannot be written to, or is taken by something that suchus did not write.
    """
    path = Path(path)
    try:
        data = content.encode() if isinstance(content, str) else content
    except UnicodeEncodeError as error:
        odd = error.object[error.start : error.end]
        raise Unwritable(f"{path} cannot be written: it would hold {odd!r}, which is no text in UTF-8.") from error
    if _is_draft(path):
        path.write_bytes(data)
        return path
    with new_file(path) as draft:
        draft.write_bytes(data)
        if not (path.is_file() and path.read_bytes() == data):
            check_replaceable(path)
            if _is_users(path):
                _copy(path, _backup(path))
        _note(path.parent, {path.name: _digest(draft)})
    return path


@contextmanager
def new_folder(path: str | Path, *, lasting: bool = False) -> Iterator[Path]:
    """Yield a temporary folder beside ``path`` that takes its place when the block ends well.

    Until then an older folder stays as it was; if the block ends badly, or by Ctrl-C, it stays for good. Files of the
    user's in it stay where they are.

    Args:
        path: where the folder shall be.
        lasting: whether it is on the disk when this ends, so that it outlives a loss of power.

    Raises:
        Unwritable: the place cannot be written to, or is taken by something that suchus did not write.
    """
    path = Path(path)
    check_replaceable(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with _shelter(path) as shelter:
            draft = shelter / "new"
            draft.mkdir()
            _drafts.add(draft)
            try:
                yield draft
            finally:
                _drafts.discard(draft)
            _sign(draft)
            check_replaceable(path)  # once more: it may have changed meanwhile
            is_complete = _carry_user_files(path, draft)
            if not is_complete and not _replacing.get():  # another process was faster since the check above
                raise Unwritable(f"{path} was changed while it was to be replaced; {_REMEDY}")
            if lasting:
                for file in (*draft.rglob("*"), draft):
                    _to_disk(file)
            _swap(draft, path, shelter / "old" if is_complete else _backup(path))
            if is_complete:
                shutil.rmtree(shelter / "old", ignore_errors=True)
        if lasting:
            _to_disk(path.parent)
    except OSError as error:
        raise _unwritable(path, error) from error


def remove_leftovers(path: str | Path) -> None:
    """Remove what processes that died while they wrote ``path`` have left beside it; an older folder comes back.

    What a living process is at stays: it holds a lock on its draft.
    """
    path = Path(path)
    with suppress(OSError):
        for shelter in path.parent.glob(f".{glob.escape(path.name)}-*"):
            with _locked(shelter) as is_locked:
                if not is_locked:
                    continue
                old = shelter / "old"
                if old.exists() and not path.exists():
                    old.rename(path)
                shutil.rmtree(shelter, ignore_errors=True)


@contextmanager
def _shelter(path: Path) -> Iterator[Path]:
    """Yield a temporary folder beside a path, locked as long as we live, after those of the dead are taken away."""
    remove_leftovers(path)
    for _ in range(100):
        with (
            tempfile.TemporaryDirectory(dir=path.parent, prefix=f".{path.name}-", ignore_cleanup_errors=True) as folder,
            _locked(Path(folder)) as is_locked,
        ):
            if (
                is_locked is not False and Path(folder).exists()
            ):  # else another process took it for a dead one's before it was locked
                yield Path(folder)
                return
    raise Unwritable(f"{path} cannot be written: other processes keep taking away what is begun there.")


@contextmanager
def _locked(folder: Path) -> Iterator[bool | None]:
    """Hold a folder and return whether we do: not where another has it or it is gone; None on a disk without locks."""
    try:
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    except OSError:
        yield False
        return
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            yield False
            return
        except OSError:
            yield None
            return
        yield True
    finally:
        os.close(descriptor)


def _swap(draft: Path, path: Path, old: Path) -> None:
    """Rename a draft to its path and what was there to ``old``; on an error the old state is restored."""
    if path.exists():
        path.rename(old)
    try:
        draft.rename(path)
    except BaseException:
        if old.exists() and not path.exists():
            old.rename(path)
        raise


def _to_disk(path: Path) -> None:
    """Wait until a file, or the list of a folder's files, is on the disk."""
    if path.is_symlink():
        return
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _check_names(path: Path) -> None:
    """Refuse a path that the system takes for no path at all."""
    if "\0" in str(path) or not is_text(str(path)):
        raise Unwritable(f"{str(path)!r} is no name that a file of suchus's can have: it is to be a text in UTF-8.")


def is_text(name: str) -> bool:
    """Return whether a name can stand in a text; one with bytes that are no UTF-8 cannot."""
    try:
        name.encode()
    except UnicodeEncodeError:
        return False
    return True


def _unwritable(path: Path, error: OSError | ValueError) -> Unwritable:
    if isinstance(error, Unwritable):
        return error
    reason = error.strerror if isinstance(error, OSError) else None
    return Unwritable(f"{path} cannot be written: {(reason or str(error)).lower()}.")


# --- whose is it? ---------------------------------------------------------------------------------------------------


@contextmanager
def replacing(is_replacing: bool = True) -> Iterator[None]:
    """While the block runs, let what a user wrote or changed be replaced; a backup is kept beside it, and we say so."""
    token = _replacing.set(is_replacing)
    try:
        yield
    finally:
        _replacing.reset(token)


def asked_to_replace() -> bool:
    """Return whether ``replacing`` is asked for, so that it can be told to other processes."""
    return _replacing.get()


def check_replaceable(path: str | Path) -> None:
    """Refuse a place that is taken by what suchus did not write, or by what was changed since.

    Free are a place where nothing is, an empty file, an empty folder, and what stands there as suchus wrote it. Beside
    that a folder that suchus wrote may hold files of the user's.

    Raises:
        Unwritable: the place is taken, and nobody asked for ``replacing``; or it cannot be looked at.
    """
    path = Path(path)
    try:
        _check_names(path)
        if _replacing.get() or not path_exists(path):
            return
        if path.is_dir():
            changed_files = [file for file, is_unchanged in _states(path) if is_unchanged is False]
            if changed_files:
                raise Unwritable(f"{changed_files[0]} was changed since suchus wrote it; {_REMEDY}")
            if any(path.iterdir()) and not (path / MANIFEST).is_file():
                raise Unwritable(f"{path} exists, and nothing says that suchus wrote it; {_REMEDY}")
        elif _is_users(path):
            is_recorded = path.name in _recorded_digests(path.parent)
            reason = (
                " was changed since suchus wrote it"
                if is_recorded
                else " exists, and nothing says that suchus wrote it"
            )
            raise Unwritable(f"{path}{reason}; {_REMEDY}")
    except (OSError, ValueError) as error:
        raise _unwritable(path, error) from error


_REMEDY = "choose another place, move it away, or say --replace, which keeps a backup."


def _is_users(path: Path) -> bool:
    """Return whether what is at a path holds something, and not what suchus wrote there."""
    return path_exists(path) and not (
        path.is_file()
        and (path.stat().st_size == 0 or _digest(path) in _recorded_digests(path.parent).get(path.name, ()))
    )


def _states(folder: Path) -> Iterator[tuple[Path, bool | None]]:
    """Yield each file in a folder and below, and whether it is as suchus wrote it; None where suchus did not."""
    for subfolder, _, names in os.walk(folder):
        digests_by_name = _recorded_digests(Path(subfolder))
        for name in names:
            file = Path(subfolder, name)
            if name != MANIFEST:
                yield (
                    file,
                    (name in digests_by_name or None)
                    and not file.is_symlink()
                    and _digest(file) in digests_by_name[name],
                )


def _carry_user_files(path: Path, draft: Path) -> bool:
    """Copy the user's files of an old folder into its draft, and return whether the draft then replaces all of the old.

    Raises:
        Unwritable: one of them stands where a file of suchus's is to be.
    """
    if not path.is_dir():
        return not _is_users(path)
    states = list(_states(path))
    user_files = [file.relative_to(path) for file, is_unchanged in states if is_unchanged is None]
    clash = [file for file in user_files if os.path.lexists(draft / file)]
    if clash and not _replacing.get():
        raise Unwritable(f"{path / clash[0]} stands where a file of suchus's is to be; {_REMEDY}")
    if (
        clash
        or any(is_unchanged is False for _, is_unchanged in states)
        or (user_files and not (path / MANIFEST).is_file())
    ):
        return False
    for file in user_files:
        (draft / file).parent.mkdir(parents=True, exist_ok=True)
        _copy(path / file, draft / file)
        manifest = file.parent / MANIFEST  # whose the folder is stays known, though nothing of ours may be left in it
        if (path / manifest).is_file() and not (draft / manifest).exists():
            _copy(path / manifest, draft / manifest)
    return True


def _copy(file: Path, target: Path) -> None:
    """Link or copy a file to another path; a folder is moved."""
    if file.is_dir() and not file.is_symlink():
        file.rename(target)
        return
    try:
        os.link(file, target, follow_symlinks=False)
    except OSError:  # a disk without links
        shutil.copy2(file, target, follow_symlinks=False)


def _backup(path: Path) -> Path:
    """Return a free name beside a path, for what is there, and say so."""
    number = 1
    while os.path.lexists(backup := path.with_name(f"{path.name}.backup{number}")):
        number += 1
    _LOG.warning("suchus: what was at %s is kept as %s.", path, backup)
    return backup


def _is_draft(path: Path) -> bool:
    return any(folder in _drafts for folder in path.parents)


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _sign(folder: Path) -> None:
    """Note all files of a folder and below, each in its own folder."""
    for subfolder, _, names in list(os.walk(folder)):
        _note(Path(subfolder), {name: _digest(Path(subfolder, name)) for name in names if name != MANIFEST})


def _note(folder: Path, digests: Mapping[str, str]) -> None:
    """Add states of files to what suchus wrote into a folder; whatever happens then, the file is one of ours."""
    digests_by_name = _recorded_digests(folder)
    new = {name: digest for name, digest in digests.items() if digest not in digests_by_name.get(name, ())}
    if new:
        lines = "".join(f"{digest}  {_plain(name)}\n" for name, digest in new.items())
        with (folder / MANIFEST).open("a", encoding="ascii") as file:
            file.write(lines)


def _recorded_digests(folder: Path) -> dict[str, set[str]]:
    """Return the digests of what suchus wrote into a folder, by name; a line that was cut off says nothing."""
    digests_by_name: dict[str, set[str]] = {}
    manifest = folder / MANIFEST
    if manifest.is_file():
        for line in manifest.read_text(encoding="ascii", errors="replace").splitlines():
            digest, _, name = line.partition("  ")
            digests_by_name.setdefault(unquote(name, errors="surrogateescape"), set()).add(digest)
    return digests_by_name


def _plain(name: str) -> str:
    return quote_from_bytes(os.fsencode(name), safe=" !#$&'()+,;=@[]{}~")

"""Files from outside: read whole and up to a size, or refused in one sentence."""

import io
import json
import stat
import tomllib
from pathlib import Path
from typing import Any

from suchus.core.errors import UnreadableFile
from suchus.core.printable import check_content

MAX_FILE_SIZE = 64 * 2**20
"""Size of a file that is read [byte]."""
MESHES = (".stl", ".obj", ".ply", ".off", ".glb")
"""Formats of meshes that trimesh reads without further packages, each in one file."""


class NoMeshes(UnreadableFile):
    """Trimesh, which reads meshes, is not installed."""


def path_exists(path: str | Path) -> bool:
    """Return whether something is at a path, or would be if its folder let us look; never raises."""
    path = Path(path)
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError, ValueError):
        return False
    except OSError:
        return True
    return True


def check_file(path: str | Path) -> None:
    """Refuse what is no ordinary file: a pipe or a device may never end.

    Raises:
        UnreadableFile: it is missing, a folder, a pipe, a socket or a device, or lies where we may not look.
    """
    path = Path(path)
    try:
        mode = path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        raise UnreadableFile(f"there is no file {path}.") from None
    except (OSError, ValueError) as error:
        raise unreadable(path, error) from error
    if stat.S_ISDIR(mode):
        raise UnreadableFile(f"{path} is a folder; a file is needed.")
    if not stat.S_ISREG(mode):
        raise UnreadableFile(f"{path} is a pipe, a socket or a device; write its content to an ordinary file first.")


def unreadable(path: str | Path, error: OSError | ValueError) -> UnreadableFile:
    """Return what to raise where the system does not let us read a file."""
    if isinstance(error, OSError):
        return UnreadableFile(f"{path} cannot be read: {(error.strerror or str(error)).lower()}.")
    return UnreadableFile(f"{str(path)!r} is no name that a file can have.")


def read_bytes(path: str | Path, max_size: int = MAX_FILE_SIZE) -> bytes:
    """Return the content of a file.

    Args:
        path: the file.
        max_size: greatest size that is accepted [byte].

    Raises:
        UnreadableFile: the file is no ordinary file, cannot be read, or is larger than ``max_size``.
    """
    path = Path(path)
    check_file(path)
    try:
        with path.open("rb") as file:
            data = file.read(max_size + 1)
    except (OSError, ValueError) as error:
        raise unreadable(path, error) from error
    if len(data) > max_size:
        raise UnreadableFile(f"{path} is larger than {max_size / 2**20:g} MiB, more than such a file can need.")
    return data


def read_mesh(path: str | Path, data: bytes | None = None) -> Any:
    """Return the mesh of a file as trimesh has it, equal corners made one; nothing that it names is opened.

    Args:
        path: the file, whose ending says its format.
        data: what it holds, if that is read already.

    Raises:
        NoMeshes: trimesh is not installed.
        UnreadableFile: it is of none of the ``MESHES``, cannot be read, or holds no faces.
    """
    path = Path(path)
    if path.suffix.lower() not in MESHES:
        raise UnreadableFile(
            f"{path.name} is no mesh of a format that is read ({', '.join(MESHES)}); convert it, as with Blender."
        )
    data = read_bytes(path) if data is None else data
    try:
        import trimesh  # noqa: PLC0415  an optional extra
    except ImportError as error:
        raise NoMeshes("meshes need trimesh; install it with: pip install 'suchus[meshes]'.") from error
    try:
        mesh = trimesh.load_mesh(io.BytesIO(data), file_type=path.suffix.lower().removeprefix("."))
        count = len(mesh.faces)
    except Exception as error:  # whatever trimesh and its readers raise for a file that is no mesh
        raise UnreadableFile(
            f"{path.name} is no mesh that can be read: it is damaged, cut, or of another format than its ending says; "
            "export it again."
        ) from error
    if not count:
        raise UnreadableFile(f"{path.name} is a mesh without faces.")
    return mesh


def read_text(path: str | Path, max_size: int = MAX_FILE_SIZE) -> str:
    """Return the text of a file.

    Args:
        path: the file; UTF-8, with or without a byte order mark.
        max_size: its greatest size [byte].

    Raises:
        UnreadableFile: it is no ordinary file, cannot be read, is larger, or is no text in UTF-8.
    """
    data = read_bytes(path, max_size)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise no_text(path, data) from error


def no_text(path: str | Path, data: bytes) -> UnreadableFile:
    """Return what to raise where a file is no text in UTF-8.

    Args:
        path: the file.
        data: its first bytes, at least two.
    """
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return UnreadableFile(f"{path} is not a text file in UTF-8, but in UTF-16: save it as UTF-8.")
    return UnreadableFile(f"{path} is not a text file in UTF-8; if it is a text, save it as UTF-8.")


def read_toml(path: str | Path) -> dict[str, Any]:
    """Return what a TOML file says.

    Raises:
        UnreadableFile: it cannot be read, is no TOML, nests too deeply, or holds texts that must not be printed.
    """
    text = read_text(path)
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise UnreadableFile(f"{path} is not valid TOML: {error}.") from error
    except (ValueError, RecursionError) as error:
        raise _nesting_error(path, error) from error
    check_content(path, tables)
    return tables


def read_json(path: str | Path) -> Any:
    """Return what a JSON file says.

    Raises:
        UnreadableFile: it cannot be read, is no JSON, or nests too deeply.
    """
    text = read_text(path)
    try:
        content = json.loads(text)
    except json.JSONDecodeError as error:
        raise UnreadableFile(f"{path} is not valid JSON: {error}.") from error
    except (ValueError, RecursionError) as error:
        raise _nesting_error(path, error) from error
    check_content(path, content, check_texts=False)
    return content


def _nesting_error(path: str | Path, error: ValueError | RecursionError) -> UnreadableFile:
    is_nested = isinstance(error, RecursionError)
    content_text = "brackets or tables nested more deeply" if is_nested else "a number or a date of more digits"
    return UnreadableFile(f"{path} holds {content_text} than can be read.")

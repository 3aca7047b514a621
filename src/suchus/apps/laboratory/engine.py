"""The engine of the page: the official build of MuJoCo in WebAssembly, its version and digests pinned.

It is no part of the source tree. ``make page`` (``tools/fetch_engine.py``) fetches it with npm into the user's cache;
a wheel carries it in the folder ``engine`` of this package.
"""

import gzip
import hashlib
import io
import tarfile
from base64 import b64encode
from pathlib import Path
from typing import NamedTuple

from suchus.core.errors import SuchusError
from suchus.core.kernel_cache import user_cache
from suchus.core.writing import new_file

PACKAGE = "@mujoco/mujoco"
"""Name of the package on npm's registry; Apache-2.0, by the developers of MuJoCo."""
VERSION = "3.14.0"
"""Version of the engine."""
INTEGRITY = "sha512-WPUYidu4Fx8+uM4hQv80SOA0ifpWGrsNJguKs8JBV8SCTxjKQ2/rqsh880nUH0/Vwa8vuefghvCQkkoed3bkUg=="
"""Digest of the packed package, as npm states it."""
SCRIPT, BINARY = "mujoco.mjs", "mujoco.wasm.gz"
"""Files of the engine: its interface in JavaScript, and its code, compressed."""
_MEMBERS = {SCRIPT: "package/mujoco.js", BINARY: "package/mujoco.wasm"}
_SHA256 = {
    SCRIPT: "bc6980e4bc5ee5f809a6cabde0743798637e113d333f9e85124714d42be1ccae",
    BINARY: "2d380f1070a556c3003b4a7c7c10c98a5f61db4e91815de1075ec478e9487e76",
}
"""Digests of the files, uncompressed."""


class NoEngine(SuchusError):
    """The engine of the page is not on this machine, or it is damaged."""


class Engine(NamedTuple):
    """The engine as it goes into a page."""

    script: str
    """Its interface, a module in JavaScript."""
    binary: bytes
    """Its code in WebAssembly, compressed with gzip."""


def engine_folders() -> list[Path]:
    """Return the folders in which the engine may lie: that of a wheel, then that in the user's cache."""
    return [Path(__file__).parent / "engine", user_cache() / f"engine-{VERSION}"]


def read_engine() -> Engine:
    """Return the engine.

    Raises:
        NoEngine: it is nowhere, or a file of it is not the pinned one.
    """
    folder = next((place for place in engine_folders() if all((place / name).is_file() for name in _SHA256)), None)
    if folder is None:
        raise NoEngine(
            f"the page needs the engine {PACKAGE} {VERSION}, which is not here: run make page in a checkout, which "
            "fetches it with npm, or install suchus from a wheel, which carries it."
        )
    contents = {name: (folder / name).read_bytes() for name in _SHA256}
    for name, content in contents.items():
        if _digest(name, content) != _SHA256[name]:
            raise NoEngine(
                f"{folder / name} is not that of {PACKAGE} {VERSION}: delete the folder {folder.name} there, and run "
                "make page."
            )
    return Engine(contents[SCRIPT].decode(), contents[BINARY])


def unpack_engine(package: bytes, folder: Path) -> Path:
    """Write the engine from its package into a folder and return the folder.

    Args:
        package: the file that ``npm pack`` writes, a compressed archive.
        folder: made where it is not there.

    Raises:
        NoEngine: the package is not the pinned one.
    """
    digest = f"sha512-{b64encode(hashlib.sha512(package).digest()).decode()}"
    if digest != INTEGRITY:
        raise NoEngine(f"the package {PACKAGE} that was fetched has the digest {digest}; {INTEGRITY} is pinned.")
    folder.mkdir(parents=True, exist_ok=True)
    with tarfile.open(fileobj=io.BytesIO(package)) as archive:
        for name, member in _MEMBERS.items():
            source = archive.extractfile(member)
            assert source is not None
            content = source.read()
            with new_file(folder / name) as temporary:
                temporary.write_bytes(gzip.compress(content, 9, mtime=0) if name == BINARY else content)
    return folder


def licence_text() -> str:
    """Return who made the engine and under which licence, for a page that carries it."""
    return (
        f"This page carries MuJoCo {VERSION} in WebAssembly ({PACKAGE}), copyright DeepMind Technologies Limited, "
        "under the Apache License 2.0: https://www.apache.org/licenses/LICENSE-2.0"
    )


def _digest(name: str, content: bytes) -> str:
    """Return the SHA-256 of a file, uncompressed; empty where it cannot be uncompressed."""
    try:
        return hashlib.sha256(gzip.decompress(content) if name == BINARY else content).hexdigest()
    except (OSError, EOFError):
        return ""

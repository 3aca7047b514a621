"""Fetch the engine of `suchus page`, MuJoCo in WebAssembly, with npm. ``make page`` calls it.

Usage: python tools/fetch_engine.py [--wheel]. npm packs the pinned package from the registry that it is set to. It is
checked by its digest and unpacked into the user's cache; with ``--wheel`` into the folder that a wheel takes.
"""

import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from suchus.apps.laboratory.engine import PACKAGE, VERSION, NoEngine, engine_folders, read_engine, unpack_engine

_SECONDS = 300.0  # of npm at most


def fetch(folder: Path) -> Path:
    """Fetch the engine into a folder and return the folder.

    Raises:
        NoEngine: npm is missing or fails, or what it fetched is not the pinned package.
    """
    npm = shutil.which("npm")
    if npm is None:
        raise NoEngine(f"npm is needed to fetch {PACKAGE} {VERSION}, and it is not installed.")
    with TemporaryDirectory() as place:
        words = [npm, "pack", f"{PACKAGE}@{VERSION}", "--silent", "--ignore-scripts"]
        packed = subprocess.run(words, cwd=place, capture_output=True, text=True, timeout=_SECONDS, check=False)
        files = list(Path(place).glob("*.tgz"))
        if packed.returncode or len(files) != 1:
            reason = (packed.stderr.strip().splitlines() or ["it says nothing"])[-1]
            raise NoEngine(f"npm could not fetch {PACKAGE} {VERSION}: {reason}")
        return unpack_engine(files[0].read_bytes(), folder)


def main(words: list[str]) -> int:
    """Fetch the engine where it is not there yet, and return the exit code."""
    wheel, cache = engine_folders()
    try:
        if "--wheel" in words:
            print(fetch(wheel))
            return 0
        try:
            read_engine()
        except NoEngine:
            print(fetch(cache))
    except NoEngine as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))

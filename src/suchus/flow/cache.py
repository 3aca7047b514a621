"""Where the machine code of the flow kernels is kept between runs; see ``suchus.kernel_cache``."""

import re
from pathlib import Path

from suchus import kernel_cache

_HERE = Path(__file__).parent
_MAKERS = re.compile(
    r"^from suchus\.flow\.compiled import .*\b(?:compiled|threaded|part|ordered_part|threaded_part)\b", re.M
)
_OWN = ("compiled.py", "linking.py")


def folder() -> Path | None:
    """Return where the code of these sources is kept; None where no place can be written to."""
    return kernel_cache.folder(_HERE, kernel_files(), "kernels-")


def kernel_files() -> list[Path]:
    """Return the files of this room that hold kernels or parts of them, and those that say how they are compiled."""
    files = sorted(_HERE.glob("*.py"))
    return [file for file in files if file.name in _OWN or _MAKERS.search(file.read_text(encoding="utf-8"))]

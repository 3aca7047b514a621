"""``suchus lessons``: five lessons of ten minutes for a class, one page each that plays offline."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from suchus.apps.cli.options import parse
from suchus.apps.cli.terminal import working
from suchus.apps.report.lessons import lesson_files, write_lessons
from suchus.core.files import check_replaceable, check_writable


@dataclass(frozen=True, slots=True, kw_only=True)
class LessonsOptions:
    """Options of ``suchus lessons``."""

    out: Annotated[Path, tyro.conf.arg(help="Folder for the pages.")] = Path("lessons")


def lessons(words: Sequence[str]) -> int:
    """Write the lessons, say where they are, and return 0.

    Raises:
        SuchusError: the words make no sense, or the place cannot be written to.
    """
    description = (
        "Five lessons of ten minutes: each a page with a replay, a slider and a question, which plays offline."
    )
    options = parse(LessonsOptions, "suchus lessons", words, description)
    check_writable(options.out)
    for file in lesson_files(options.out):
        check_replaceable(file)
    with working() as bars:
        start_page, *pages = write_lessons(options.out, progress=bars.reporter("lessons"))
    for path in pages:
        print(f"{path}, {path.stat().st_size / 1e6:.1f} MB")
    print(f"begin with {start_page}: it needs no network, so send the folder to the class")
    return 0

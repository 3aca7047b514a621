"""``suchus lessons``: five lessons of ten minutes for a class, one page each that plays offline."""

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from suchus.apps.cli.options import parse
from suchus.apps.cli.terminal import print_code, working
from suchus.apps.report.lesson_server import LessonServer
from suchus.apps.report.lessons import laboratory_absence, lesson_files, write_lessons
from suchus.apps.report.qr_code import qr_text
from suchus.core.checks import require
from suchus.core.files import check_replaceable, check_writable


@dataclass(frozen=True, slots=True, kw_only=True)
class LessonsOptions:
    """Options of ``suchus lessons``."""

    out: Annotated[Path, tyro.conf.arg(help="Folder for the pages.")] = Path("lessons")
    serve: Annotated[bool, tyro.conf.arg(help="Serve the pages to phones in the room until Ctrl-C.")] = False
    port: Annotated[int, tyro.conf.arg(help="Port to serve on; 0 for any that is free.")] = 8080

    def __post_init__(self) -> None:
        require("lessons", "port", self.port, 0, 65535, "")


def lessons(words: Sequence[str]) -> int:
    """Write the lessons, say where they are, serve them if asked for, and return 0.

    Raises:
        SuchusError: the words make no sense, the place cannot be written to, or the port is taken.
    """
    description = (
        "Five lessons of ten minutes: each a page with a question, a replay and a slider, which plays offline. Each "
        "leads to the laboratory, where the physics runs on the device."
    )
    options = parse(LessonsOptions, "suchus lessons", words, description)
    check_writable(options.out)
    files = lesson_files(options.out)
    for file in files:
        check_replaceable(file)
    with ExitStack() as stack:
        server = stack.enter_context(LessonServer(files, options.port)) if options.serve else None
        with working() as bars:
            progress = bars.reporter("lessons")
            start_page, *pages = write_lessons(options.out, progress=progress, address=server.address if server else "")
        for path in pages:
            print(f"{path}, {path.stat().st_size / 1e6:.1f} MB")
        if reason := laboratory_absence():
            print(f"the laboratory is left out: {reason}")
        print(f"begin with {start_page}: it needs no network, so send the folder to the class")
        if server is not None:
            print_code(qr_text(server.address))
            print(f"phones in this network open {server.address} (the sheet names it); Ctrl-C ends it.", flush=True)
            server.wait()
            print("ended.")
    return 0

"""``suchus study FILE.toml``: many runs, their results into a folder that a kill cannot spoil."""

import time
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Annotated, Any

import tyro

from suchus.cli.commands import BadCommand
from suchus.cli.options import parse
from suchus.cli.terminal import Bars, working
from suchus.study import Told, conduct, connected, read_study
from suchus.study.store import RESULTS, TABLE

_EVERY = 10.0  # [s]; between lines where there is no terminal for a bar


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """What can be said after ``suchus study``."""

    file: Annotated[Path, tyro.conf.Positional]
    """The study, a TOML file; see docs/studies.md."""
    scheduler: str | None = None
    """Address of a Dask scheduler whose workers run it, as tcp://127.0.0.1:8786; the same bytes."""
    out: Path | None = None
    """The store; by default out/studies/NAME. One that this study began is finished, anything else is refused."""


def study(words: Sequence[str]) -> int:
    """Conduct a study, or finish it, say what came of it, and return 0.

    Raises:
        SuchusError: the words or the file make no sense, or the store cannot be written to.
    """
    about = "Run many variants of one run, and keep what is measured. Started again it goes on where it stopped."
    options: Options = parse(Options, "suchus study", words, about, [f.name for f in fields(Options)])
    asked = read_study(options.file)
    if options.out is None and any(c in asked.name for c in "/\\\0"):
        raise BadCommand(f"the study is named {asked.name!r}, which makes no folder; say --out DIR.")
    folder = options.out or Path("out") / "studies" / asked.name
    cluster: AbstractContextManager[Any] = nullcontext() if options.scheduler is None else connected(options.scheduler)
    with cluster as client, working() as bars:
        results = conduct(asked, folder, progress=_shown(bars, asked.name), client=client)
    failed = {sample: str(error) for sample, error in enumerate(results.error.values) if error}
    print(f"{results.sizes['sample']} runs, {len(failed)} failed: {folder / RESULTS}, {folder / TABLE}")
    for sample, error in list(failed.items())[:1]:
        print(f"the first that failed is sample {sample}: {error}")
    return 0


def _shown(bars: Bars, name: str) -> Callable[[Told], None]:
    """Return what moves a bar, or says a line now and then where there is no terminal."""
    move = bars.task(name)
    last = time.monotonic()

    def show(told: Told) -> None:
        nonlocal last
        move(str(told), told.done / told.total)
        if not bars.seen and time.monotonic() - last > _EVERY:
            last = time.monotonic()
            bars.say(f"{name}: {told}")

    return show

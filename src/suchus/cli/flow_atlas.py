"""``suchus flow-atlas``: published data of flows beside what the flow solver makes of them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Annotated

import tyro

from suchus import threads
from suchus.atlas import CASES, LONGEST, FlowProgress, Outcome, chosen, compute_all
from suchus.cli.commands import BadCommand
from suchus.cli.options import parse
from suchus.cli.terminal import Bars, working
from suchus.figures.atlas import write_atlas
from suchus.figures.atlas_page import entries, summary
from suchus.record import check_writable


@dataclass(frozen=True, slots=True, kw_only=True)
class AtlasOptions:
    """Options of ``suchus flow-atlas``."""

    rows: Annotated[tuple[str, ...], tyro.conf.Positional] = ()
    """Names of rows; all if there are none. They are the headings of docs/atlas.md."""
    out: Path = Path("out") / "atlas"
    """Folder of the outcomes and of the page, atlas.md. What is finished there is kept."""
    jobs: int | None = None
    """Number of flows at a time, which share the threads; by default one for each thread."""
    quick: Annotated[
        bool,
        tyro.conf.FlagCreatePairsOff,
        tyro.conf.arg(help="A coarse and short trial of each flow, which is drawn and not judged."),
    ] = False


def flow_atlas(words: Sequence[str]) -> int:
    """Compute the flows that are not there yet, write the page, print its path; return 1 if a flow failed, else 0.

    Raises:
        SuchusError: the words make no sense, or nothing can be written.
    """
    about = (
        "Compute flows around bodies that others have published, and draw ours beside theirs. Started again it goes on "
        "where it stopped."
    )
    options: AtlasOptions = parse(
        AtlasOptions, "suchus flow-atlas", words, about, [f.name for f in fields(AtlasOptions)]
    )
    rows = chosen(options.rows)
    jobs = threads.count() if options.jobs is None else options.jobs
    if jobs < 1:
        raise BadCommand(f"--jobs is {jobs}; at least 1 flow at a time is needed.")
    check_writable(options.out)
    wanted = {row.case for row in rows}
    cases = [CASES[name] for name in dict.fromkeys((*LONGEST, *CASES)) if name in wanted]
    with working() as bars:
        teller = _Teller(bars, len(cases))
        outcomes = compute_all(cases, options.out, jobs=jobs, quick=options.quick, tell=teller)
    print(summary(entries(rows, outcomes)))
    print(write_atlas(outcomes, options.out, rows))
    return 1 if any(outcome.failed for outcome in outcomes.values()) else 0


class _Teller:
    """Moves a bar for each flow, and says a line when one is finished."""

    def __init__(self, bars: Bars, count: int) -> None:
        self._bars, self._count, self._done = bars, count, 0
        self._moved = dict[str, Callable[[object, float], None]]()

    def __call__(self, progress: FlowProgress) -> None:
        if progress.case not in self._moved:
            self._moved[progress.case] = self._bars.reporter(progress.case)
        if progress.outcome is None:
            self._moved[progress.case](f"{progress.share:.0%}", progress.share)
            return
        self._done += 1
        self._bars.say(f"{self._done} of {self._count}: {_line(progress.outcome)}")


def _line(outcome: Outcome) -> str:
    ended = f"failed: {outcome.failed}" if outcome.failed else "done"
    return f"{outcome.case}, {ended} ({outcome.seconds:.0f} s of processor time)"

"""``suchus flow-atlas``: published data of flows beside what the flow solver makes of them."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Annotated

import tyro

from suchus import threads
from suchus.atlas import CASES, LONGEST, FlowOutcome, chosen, compute_all
from suchus.cli.entry import BadCommand
from suchus.cli.options import SCHEDULER, parse
from suchus.cli.terminal import working
from suchus.figures.atlas import atlas_files, entries, summary, write_atlas
from suchus.jobs import at_scheduler
from suchus.record import check_replaceable, check_writable


@dataclass(frozen=True, slots=True, kw_only=True)
class AtlasOptions:
    """Options of ``suchus flow-atlas``."""

    rows: Annotated[tuple[str, ...], tyro.conf.Positional] = ()
    """Names of rows; all if there are none. They are the headings of docs/atlas.md."""
    out: Path = Path("out") / "atlas"
    """Folder of the outcomes and of the page, atlas.md. What is finished there is kept."""
    jobs: int | None = None
    """Number of flows at a time, which share the threads; by default one for each thread."""
    scheduler: SCHEDULER = None
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
    options = parse(AtlasOptions, "suchus flow-atlas", words, about)
    rows = chosen(options.rows)
    if options.jobs is not None and options.jobs < 1:
        raise BadCommand(f"--jobs is {options.jobs}; at least 1 flow at a time is needed.")
    jobs = options.jobs or (threads.count() if options.scheduler is None else 1)
    check_writable(options.out)
    for file in atlas_files(options.out, rows):
        check_replaceable(file)
    wanted = {row.case for row in rows}
    cases = [CASES[name] for name in dict.fromkeys((*LONGEST, *CASES)) if name in wanted]
    number = count(1)
    with at_scheduler(options.scheduler) as client, working() as bars:
        outcomes = compute_all(
            cases,
            options.out,
            jobs=jobs,
            quick=options.quick,
            client=client,
            each=bars.reporter,
            finished=lambda outcome: bars.say(f"{next(number)} of {len(cases)}: {_line(outcome)}"),
        )
    print(summary(entries(rows, outcomes)))
    print(write_atlas(outcomes, options.out, rows))
    return 1 if any(outcome.failed for outcome in outcomes.values()) else 0


def _line(outcome: FlowOutcome) -> str:
    ended = f"failed: {outcome.failed}" if outcome.failed else "done"
    return f"{outcome.case}, {ended} ({outcome.seconds:.0f} s of processor time)"

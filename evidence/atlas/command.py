"""``python -m evidence.atlas``: published data of flows beside what the flow solver makes of them."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Annotated

import tyro

from evidence.atlas import CASES, GRIDS, LONGEST, Case, FlowOutcome, chosen, compute_all, finished_outcome
from evidence.atlas.page import atlas_files, entries, summary, write_atlas
from suchus.apps.cli.entry import BadCommand, Subcommand
from suchus.apps.cli.entry import main as run_command
from suchus.apps.cli.options import SCHEDULER, parse
from suchus.apps.cli.terminal import working
from suchus.core import threads
from suchus.core.files import check_replaceable, check_writable
from suchus.core.jobs import at_scheduler


@dataclass(frozen=True, slots=True, kw_only=True)
class AtlasOptions:
    """Options of ``python -m evidence.atlas``."""

    rows: Annotated[tuple[str, ...], tyro.conf.Positional] = ()
    """Names of rows; all if there are none. They are the headings of docs/atlas.md."""
    out: Path = Path("out") / "atlas"
    """Folder of the outcomes and of the page, atlas.md. What is finished there is kept."""
    grids: tuple[int, ...] = tuple(range(1, GRIDS + 1))
    """Which grids of each flow, 1 for the finest, whose curves are compared; all three tell a row's uncertainty."""
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
    options = parse(AtlasOptions, "python -m evidence.atlas", words, about)
    rows = chosen(options.rows)
    if options.jobs is not None and options.jobs < 1:
        raise BadCommand(f"--jobs is {options.jobs}; at least 1 flow at a time is needed.")
    if not options.grids or not set(options.grids) <= set(range(1, GRIDS + 1)):
        raise BadCommand(f"--grids is {' '.join(map(str, options.grids)) or 'empty'}; give some of 1 to {GRIDS}.")
    jobs = options.jobs or (threads.count() if options.scheduler is None else 1)
    check_writable(options.out)
    for file in atlas_files(options.out, rows):
        check_replaceable(file)
    wanted = {row.case for row in rows}
    cases = [CASES[name] for name in dict.fromkeys((*LONGEST, *CASES)) if name in wanted]
    number = count(1)
    grids = (1,) if options.quick else tuple(sorted(set(options.grids)))
    pieces = sum(grid <= len(case.grids) for case in cases for grid in grids)
    with at_scheduler(options.scheduler) as client, working() as bars:
        outcomes = compute_all(
            cases,
            options.out,
            jobs=jobs,
            quick=options.quick,
            grids=grids,
            client=client,
            each=bars.reporter,
            finished=lambda outcome: bars.say(f"{next(number)} of {pieces}: {_line(outcome)}"),
        )
    if not options.quick:  # what other starts left of the grids that were not asked for here
        outcomes = {**other_outcomes(options.out, cases), **outcomes}
    print(summary(entries(rows, outcomes)))
    print(write_atlas(outcomes, options.out, rows))
    return 1 if any(outcome.failed for outcome in outcomes.values()) else 0


def other_outcomes(folder: Path, cases: Sequence[Case]) -> dict[str, FlowOutcome]:
    """Return the outcomes in a folder that are of the present set-up and code and of no trial."""
    every = ((case, grid) for case in cases for grid in range(1, len(case.grids) + 1))
    found = (finished_outcome(case, folder, quick=False, grid=grid) for case, grid in every)
    return {outcome.flow: outcome for outcome in found if outcome is not None}


def _line(outcome: FlowOutcome) -> str:
    ended = f"failed: {outcome.failed}" if outcome.failed else "done"
    return f"{outcome.flow}, {ended} ({outcome.seconds:.0f} s of processor time)"


COMMAND = Subcommand(
    "flow-atlas",
    "[ROW ...] [--out DIR] [--jobs N | --scheduler ADDRESS]",
    "compute published flows and draw ours beside theirs",
    "evidence.atlas.command:flow_atlas",
)
"""The command, with the exit codes of every command of suchus."""


def main(words: Sequence[str] | None = None) -> int:
    """Carry the command out and return the exit code, as ``suchus.apps.cli.main`` does.

    Args:
        words: what follows ``python -m evidence.atlas``; by default those of this process.
    """
    return run_command([COMMAND.name, *(sys.argv[1:] if words is None else words)], (COMMAND,))

"""``suchus reproduce``: every experiment, then the page."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from suchus import threads
from suchus.cli.attempt import Job, JobResult, attempt, kept
from suchus.cli.commands import BadCommand
from suchus.cli.options import OUT, QUICK, parse
from suchus.cli.processes import side_by_side
from suchus.cli.terminal import Bars, working
from suchus.experiments import EXPERIMENTS
from suchus.record import check_writable
from suchus.report import Failure, Result, check_place, write_page

_MOST = 4
"""Experiments at a time unless more are asked for [-]; beyond, the longest one alone decides, and each takes memory."""
_LONG = (
    "swimming",
    "feedback",
    "terrain",
    "bipedal_reach",
    "joint_faults",
    "turning",
    "speed_range",
    "displacement",
)
"""What takes longest is begun first, so that no process idles in the end."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReproduceOptions:
    """Options of ``suchus reproduce``."""

    out: OUT = Path("out")
    quick: QUICK = False
    jobs: Annotated[
        int | None, tyro.conf.arg(help=f"Experiments at a time; by default one for each core, {_MOST} at most.")
    ] = None
    anew: Annotated[
        bool,
        tyro.conf.FlagCreatePairsOff,
        tyro.conf.arg(help="Run every experiment again. Otherwise results of the same code and settings are kept."),
    ] = False


def reproduce(words: Sequence[str]) -> int:
    """Run every experiment of the article, write the page, print its path; return 1 if an experiment failed, else 0.

    Started again it goes on where it stopped: what is there of the same settings, code and versions is kept.

    Raises:
        SuchusError: the words make no sense, or the results cannot be saved.
    """
    about = "Run every experiment and write one page with all results, DIR/report.html."
    options: ReproduceOptions = parse(
        ReproduceOptions, "suchus reproduce", words, about, ("out", "quick", "jobs", "anew")
    )
    tasks = [
        Job(name=name, out=options.out, quick=options.quick) for name, one in EXPERIMENTS.items() if one.reproduces
    ]
    if not tasks:
        raise BadCommand("there is no experiment on the shelf.")
    if options.jobs is not None and options.jobs < 1:
        raise BadCommand(f"--jobs is {options.jobs}; at least 1 experiment at a time is needed.")
    check_writable(options.out)
    for task in tasks:
        check_place(options.out / task.name)
    jobs = min(threads.count(), _MOST) if options.jobs is None else options.jobs
    with working() as bars:
        done = {} if options.anew else {task.name: one for task in tasks if (one := kept(task)) is not None}
        for one in done.values():
            bars.say(one.summary)
        done |= _run([task for task in tasks if task.name not in done], jobs, bars)
        outcomes = [done[task.name].result for task in tasks]
        results = [one for one in outcomes if isinstance(one, Result)]
        failures = [one for one in outcomes if isinstance(one, Failure)]
        page = write_page(results, failures, options.out / "report.html")
    print(page)
    return 1 if failures else 0


def _run(tasks: Sequence[Job], jobs: int, bars: Bars) -> dict[str, JobResult]:
    """Return the result of each task by name; the longest are begun first."""
    tasks = sorted(tasks, key=_place)
    if min(jobs, len(tasks)) > 1:
        return side_by_side(tasks, min(jobs, len(tasks)), bars)
    done = {}
    for task in tasks:
        done[task.name] = attempt(task, bars.task(task.name))
        bars.say(done[task.name].summary)
    return done


def _place(task: Job) -> int:
    return _LONG.index(task.name) if task.name in _LONG else len(_LONG)

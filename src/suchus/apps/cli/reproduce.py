"""``suchus reproduce``: every experiment, then the page."""

import sys
import traceback
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated

import tyro

import suchus
import suchus.experiments.catalog
from suchus.apps.cli.entry import BadCommand
from suchus.apps.cli.options import FOR_VERDICTS, QUICK_FLAG, RESULTS_FOLDER_OPTION, parse
from suchus.apps.cli.run import perform
from suchus.apps.cli.terminal import Bars, working
from suchus.apps.report import Failure, Result, check_place, has_all_files, is_unchanged, load_result, write_page
from suchus.core import threads
from suchus.core.errors import SuchusError
from suchus.core.files import check_replaceable, check_writable, has_same_provenance, remove_leftovers
from suchus.core.jobs import Job, finish, place_for
from suchus.core.progress import Progress
from suchus.core.writing import asked_to_replace, replacing
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.experiment import Experiment


@dataclass(frozen=True, slots=True, kw_only=True)
class ExperimentTask:
    """An experiment that is to be run again."""

    name: str
    """Name of the experiment in the catalog."""
    out: Path
    """The folder for results."""
    quick: bool
    """Whether its quick form is asked for, whatever it is."""
    whole: bool = False
    """Whether what no verdict needs is asked for too."""
    replace: bool = False
    """Whether what a user wrote or changed may be replaced."""

    @property
    def experiment(self) -> Experiment:
        """The question in the form that is asked for."""
        experiment = EXPERIMENTS[self.name]
        if self.quick:
            return experiment.quick()
        return experiment if self.whole else experiment.for_verdicts()

    @property
    def command(self) -> str:
        """Command that makes the same result again."""
        if self.quick:
            return f"suchus run {self.name} --quick"
        is_whole = self.experiment == EXPERIMENTS[self.name]
        return f"suchus run {self.name}{'' if is_whole else f' {FOR_VERDICTS}'}"


@dataclass(frozen=True, slots=True, kw_only=True)
class TaskResult:
    """Result of an experiment, or the reason why it failed."""

    result: Result | Failure
    """Result or failure, for the page."""
    summary: str
    """Summary of the result in one line."""


def attempt(task: ExperimentTask, progress: Progress) -> TaskResult:
    """Run an experiment into its folder and read the result back.

    Args:
        task: which and where.
        progress: called with the share that is done, 0 to 1.
    """
    try:
        with replacing(task.replace):
            saved_run = perform(task.experiment, task.name, task.out, progress, task.command)
        result = load_result(saved_run.folder)
    except SuchusError as error:
        return failed(task.name, str(error))
    except Exception as error:
        return failed(task.name, f"{type(error).__name__}: {error}", traceback.format_exc())
    page = saved_run.folder / "index.html"
    return TaskResult(result=result, summary=f"{_summary(result)} ({saved_run.seconds:.1f} s): {page}")


def reusable_result(task: ExperimentTask) -> TaskResult | None:
    """Return the stored result of an earlier run, if it is complete and a new run would give the same.

    That is so if the settings, the files of suchus and the versions of libraries are the same. An experiment that is no
    part of suchus itself is always run again, since its own code is in no digest.
    """
    try:
        experiment = task.experiment
        result = load_result(task.out / task.name)
        is_same = has_same_provenance(result.outcome["provenance"], experiment.settings())
    except SuchusError:
        return None
    if not (
        is_same
        and is_unchanged(result)
        and has_all_files(result)
        and result.outcome["command"] == task.command
        and _is_shipped(experiment)
    ):
        return None
    return TaskResult(result=result, summary=f"{_summary(result)} (kept from an earlier run)")


def _is_shipped(experiment: Experiment) -> bool:
    file = sys.modules[type(experiment).__module__].__file__
    return file is not None and Path(file).is_relative_to(Path(suchus.__file__).parent)


def _summary(result: Result) -> str:
    verdicts = [verdict["verdict"] for verdict in result.outcome["verdicts"]]
    counts = [f"{verdicts.count(verdict)} {verdict}" for verdict in dict.fromkeys(verdicts)]
    return f"{result.name}: {', '.join(counts) or 'no verdict'}"


def failed(name: str, sentence: str, trace: str = "") -> TaskResult:
    """Return the result of an experiment that failed.

    Args:
        name: name of the experiment.
        sentence: what went wrong.
        trace: where in the code, if it was none of our own errors.
    """
    return TaskResult(result=Failure(name=name, sentence=sentence, trace=trace), summary=f"{name}: failed: {sentence}")


REPORT = "report.html"
"""Name of the page of all experiments."""
_MAX_DEFAULT_JOBS = 4
"""Experiments at a time unless more are asked for [-]; beyond, the longest one alone decides, and each takes memory."""
_THREADS_PER_EXPERIMENT = 1
"""Threads of each of several experiments [-]: two would end the flow's small loops little sooner, for twice the
processor time."""
_FIRST_EXPERIMENTS = (
    "displacement",
    "swimming",
    "feedback",
    "joint_faults",
    "bipedal_reach",
    "terrain",
    "swim_free",
)
"""Experiments that are started first: what most readers ask, so that its answer is there within a minute, and then the
slowest, so that no process idles at the end."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ReproduceOptions:
    """Options of ``suchus reproduce``."""

    out: RESULTS_FOLDER_OPTION = Path("out")
    quick: QUICK_FLAG = False
    all: Annotated[
        bool,
        tyro.conf.FlagCreatePairsOff,
        tyro.conf.arg(
            help="Run every experiment, and each in full. Otherwise what no verdict on the article needs is left out.",
        ),
    ] = False
    jobs: Annotated[
        int | None,
        tyro.conf.arg(help=f"Experiments at a time; by default one for each core, {_MAX_DEFAULT_JOBS} at most."),
    ] = None
    anew: Annotated[
        bool,
        tyro.conf.FlagCreatePairsOff,
        tyro.conf.arg(help="Run every experiment again. Otherwise results of the same code and settings are kept."),
    ] = False


def reproduce(words: Sequence[str]) -> int:
    """Run every experiment of the article, write the page, print its path; return 1 if an experiment failed, else 0.

    Without ``--all`` what no verdict needs is left out, and the page and the error stream say what that is.

    Started again it goes on where it stopped: what is there of the same settings, code and versions is kept.

    Raises:
        SuchusError: the words make no sense, or the results cannot be saved.
    """
    description = "Run what the verdicts on the article need and write one page with all results, DIR/report.html."
    options = parse(ReproduceOptions, "suchus reproduce", words, description)
    sound = dict(EXPERIMENTS.items())  # broken experiments are attempted too, and their errors are reported
    left_out = [] if options.all else [name for name in sound if not sound[name].reproduces]
    tasks = [
        ExperimentTask(name=name, out=options.out, quick=options.quick, whole=options.all, replace=asked_to_replace())
        for name in EXPERIMENTS
        if name not in left_out
    ]
    if not tasks:
        raise BadCommand("there is no experiment in the catalog.")
    if options.jobs is not None and options.jobs < 1:
        raise BadCommand(f"--jobs is {options.jobs}; at least 1 experiment at a time is needed.")
    check_writable(options.out)
    for task in tasks:
        check_place(options.out / task.name)
    check_replaceable(options.out / REPORT)
    jobs = min(threads.count(), _MAX_DEFAULT_JOBS) if options.jobs is None else options.jobs
    with working() as bars:
        outcomes = [reproduced.result for reproduced in _run_tasks(tasks, bars, jobs=jobs, anew=options.anew)]
        results = [outcome for outcome in outcomes if isinstance(outcome, Result)]
        failures = [outcome for outcome in outcomes if isinstance(outcome, Failure)]
        if left_out:
            bars.say(
                f"not run, since they judge no claim of the article: {', '.join(left_out)}; suchus reproduce --all does"
            )
        page = write_page(results, failures, options.out / REPORT, left_out=left_out)
    print(page)
    return 1 if failures else 0


def _run_tasks(tasks: Sequence[ExperimentTask], bars: Bars, *, jobs: int, anew: bool) -> list[TaskResult]:
    """Return the result of each task; ``_FIRST_EXPERIMENTS`` are begun first.

    A process that dies takes its experiment with it and nothing else. When this one is stopped, by Ctrl-C or an error,
    the others end too, and leave nothing half-written.
    """
    order = sorted(tasks, key=_rank)
    results = _Results(order, anew)
    for number in range(len(order)):
        if results.has(number):
            bars.say(results.get(number).summary)
    job = Job(
        name="reproduce",
        kind="reproduction",
        piece="experiment",
        unit="experiments",
        work=partial(_attempt_with_shelf, shelf=list(suchus.experiments.catalog.__path__)),
        items=order,
        tries=1,  # a second try would need the same memory again
        died=_report_crash,
    )
    side_by_side = min(jobs, sum(not results.has(n) for n in range(len(order))) or 1)
    try:
        finish(
            job,
            results,
            place=place_for("reproduce", jobs=side_by_side, threads_per_process=_THREADS_PER_EXPERIMENT),
            progress_of=lambda number: bars.task(order[number].name),
            finished=lambda _, reproduced: bars.say(reproduced.summary),
        )
    finally:
        for number, task in enumerate(order):
            if not results.has(number):
                remove_leftovers(task.out / task.name)
    return [results.get(order.index(task)) for task in tasks]


class _Results:
    """Results of experiments, each a folder that the run itself writes; those of a run that would repeat them stay."""

    def __init__(self, tasks: Sequence[ExperimentTask], anew: bool) -> None:
        stored = {} if anew else {number: reusable_result(task) for number, task in enumerate(tasks)}
        self._results = {number: result for number, result in stored.items() if result is not None}

    def has(self, number: int) -> bool:
        """Return whether a result is there."""
        return number in self._results

    def get(self, number: int) -> TaskResult:
        """Return a result that is there."""
        return self._results[number]

    def put(self, number: int, result: TaskResult) -> None:
        """Store a result whose folder is written."""
        self._results[number] = result


def _attempt_with_shelf(task: ExperimentTask, progress: Progress, shelf: list[str]) -> TaskResult:
    """Attempt an experiment, also in a process of its own, which knows the same catalog."""
    suchus.experiments.catalog.__path__[:] = shelf
    return attempt(task, progress)


def _report_crash(task: ExperimentTask, exit_code: int | None) -> TaskResult:
    remove_leftovers(task.out / task.name)
    return failed(
        task.name, f"its process ended with exit code {exit_code}; where memory was short, --jobs 1 takes less of it."
    )


def _rank(task: ExperimentTask) -> int:
    return _FIRST_EXPERIMENTS.index(task.name) if task.name in _FIRST_EXPERIMENTS else len(_FIRST_EXPERIMENTS)

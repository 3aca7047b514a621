"""One experiment of many: whatever goes wrong in it is reported, and must not stop the others."""

import traceback
from dataclasses import dataclass
from pathlib import Path

from suchus.cli.perform import perform
from suchus.errors import SuchusError
from suchus.experiment import Progress
from suchus.experiments import EXPERIMENTS
from suchus.report import Failure, Result, load_result


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """An experiment that is to be run."""

    name: str
    """On the shelf."""
    out: Path
    """The folder for results."""
    quick: bool
    """Whether its quick form is asked for, whatever it is."""


@dataclass(frozen=True, slots=True, kw_only=True)
class JobResult:
    """Result of an experiment, or the reason why it failed."""

    result: Result | Failure
    """For the page."""
    summary: str
    """The same in a line."""


def attempt(task: Job, progress: Progress) -> JobResult:
    """Run an experiment into its folder and read the result back.

    Args:
        task: which and where.
        progress: called with the share that is done, 0 to 1.
    """
    try:
        experiment = EXPERIMENTS[task.name]
        command = f"suchus run {task.name}{' --quick' * task.quick}"
        done = perform(experiment.quick() if task.quick else experiment, task.name, task.out, progress, command)
        result = load_result(done.folder)
    except SuchusError as error:
        return failed(task.name, str(error))
    except Exception as error:
        return failed(task.name, f"{type(error).__name__}: {error}", traceback.format_exc())
    words = [verdict["verdict"] for verdict in result.outcome["verdicts"]]
    counts = ", ".join(f"{words.count(word)} {word}" for word in dict.fromkeys(words)) or "no verdict"
    return JobResult(result=result, summary=f"{task.name}: {counts} ({done.seconds:.1f} s)")


def failed(name: str, sentence: str, trace: str = "") -> JobResult:
    """Return what is reported of an experiment that failed.

    Args:
        name: of the experiment.
        sentence: what went wrong.
        trace: where in the code, if it was none of our own errors.
    """
    return JobResult(result=Failure(name=name, sentence=sentence, trace=trace), summary=f"{name}: failed: {sentence}")

"""One experiment of many: whatever goes wrong in it is reported, and must not stop the others."""

import sys
import traceback
from dataclasses import dataclass
from pathlib import Path

import suchus
from suchus.cli.perform import perform
from suchus.errors import SuchusError
from suchus.experiment import Experiment
from suchus.experiments import EXPERIMENTS
from suchus.progress import Progress
from suchus.record import made_alike
from suchus.report import Failure, Result, load_result, whole


@dataclass(frozen=True, slots=True, kw_only=True)
class Reproduction:
    """An experiment that is to be run again."""

    name: str
    """On the shelf."""
    out: Path
    """The folder for results."""
    quick: bool
    """Whether its quick form is asked for, whatever it is."""

    @property
    def experiment(self) -> Experiment:
        """The question in the form that is asked for."""
        experiment = EXPERIMENTS[self.name]
        return experiment.quick() if self.quick else experiment

    @property
    def command(self) -> str:
        """What makes the same result again."""
        return f"suchus run {self.name}{' --quick' * self.quick}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Reproduced:
    """Result of an experiment, or the reason why it failed."""

    result: Result | Failure
    """For the page."""
    summary: str
    """The same in a line."""


def attempt(task: Reproduction, progress: Progress) -> Reproduced:
    """Run an experiment into its folder and read the result back.

    Args:
        task: which and where.
        progress: called with the share that is done, 0 to 1.
    """
    try:
        done = perform(task.experiment, task.name, task.out, progress, task.command)
        result = load_result(done.folder)
    except SuchusError as error:
        return failed(task.name, str(error))
    except Exception as error:
        return failed(task.name, f"{type(error).__name__}: {error}", traceback.format_exc())
    return Reproduced(result=result, summary=f"{_summary(result)} ({done.seconds:.1f} s)")


def kept(task: Reproduction) -> Reproduced | None:
    """Return the result that an earlier run left, if it is whole and a run would give the same again.

    That is so if the settings, the files of suchus and the versions of libraries are the same. An experiment that is no
    part of suchus itself is always run again, since its own code is in no digest.
    """
    try:
        experiment = task.experiment
        result = load_result(task.out / task.name)
        same = made_alike(result.outcome["provenance"], experiment.settings())
    except SuchusError:
        return None
    if not (same and whole(result) and result.outcome["command"] == task.command and _is_ours(experiment)):
        return None
    return Reproduced(result=result, summary=f"{_summary(result)} (kept from an earlier run)")


def _is_ours(experiment: Experiment) -> bool:
    file = sys.modules[type(experiment).__module__].__file__
    return file is not None and Path(file).is_relative_to(Path(suchus.__file__).parent)


def _summary(result: Result) -> str:
    words = [verdict["verdict"] for verdict in result.outcome["verdicts"]]
    return f"{result.name}: {', '.join(f'{words.count(word)} {word}' for word in dict.fromkeys(words)) or 'no verdict'}"


def failed(name: str, sentence: str, trace: str = "") -> Reproduced:
    """Return what is reported of an experiment that failed.

    Args:
        name: of the experiment.
        sentence: what went wrong.
        trace: where in the code, if it was none of our own errors.
    """
    return Reproduced(result=Failure(name=name, sentence=sentence, trace=trace), summary=f"{name}: failed: {sentence}")

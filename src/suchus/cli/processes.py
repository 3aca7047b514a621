"""Experiments side by side, in a few processes that take one after the other."""

from collections.abc import Sequence
from contextlib import closing
from functools import partial

import suchus.experiments
from suchus import workers
from suchus.cli.attempt import Job, JobResult, attempt, failed
from suchus.cli.terminal import Bars
from suchus.experiment import Progress
from suchus.record import sweep


def side_by_side(tasks: Sequence[Job], jobs: int, bars: Bars) -> dict[str, JobResult]:
    """Run experiments in ``jobs`` processes, which share the threads, and return the result of each by name.

    They are begun in the order given. A process that dies takes its experiment with it and nothing else. When this
    one is stopped, by Ctrl-C or an error, the others end too, and leave nothing half-written.

    Args:
        tasks: the experiments.
        jobs: number of processes.
        bars: where progress is shown.
    """
    results, moves = dict[str, JobResult](), dict[int, Progress]()
    work = partial(_attempted, shelf=list(suchus.experiments.__path__))
    try:
        with closing(workers.side_by_side(work, tasks, jobs)) as heard:
            for number, said in heard:
                name = tasks[number].name
                if isinstance(said, workers.Begun):
                    moves[number] = bars.task(name)
                elif isinstance(said, workers.Far):
                    moves[number](*said)
                else:
                    results[name] = said.value if isinstance(said, workers.Done) else _died(tasks[number], said)
                    bars.say(results[name].summary)
    finally:
        for number in moves:
            if tasks[number].name not in results:
                sweep(tasks[number].out / tasks[number].name)
    return results


def _died(task: Job, said: workers.Died) -> JobResult:
    sweep(task.out / task.name)
    return failed(
        task.name,
        f"its process ended with exit code {said.exit_code}; where memory was short, --jobs 1 takes less of it.",
    )


def _attempted(task: Job, tell: workers.Tell, shelf: list[str]) -> JobResult:
    """Attempt an experiment in a process of its own, which knows the same shelf."""
    suchus.experiments.__path__[:] = shelf
    return attempt(task, tell)

"""The engine of jobs: it computes each piece that is not in the store yet, and stores each result at once."""

import time
from collections.abc import Callable
from contextlib import closing

from suchus.core.errors import SuchusError
from suchus.core.jobs.job import Item, Job, PieceCrash, Result, ResultStore
from suchus.core.jobs.places import IN_PROCESS, Place
from suchus.core.progress import Progress, silent


class ProcessCrash(SuchusError, ChildProcessError):
    """A piece of a job whose processes died again and again."""


def finish(
    job: Job[Item, Result],
    store: ResultStore[Result],
    *,
    place: Place = IN_PROCESS,
    progress: Progress = silent,
    progress_of: Callable[[int], Progress] | None = None,
    finished: Callable[[int, Result], None] | None = None,
) -> None:
    """Compute every piece of a job that is not in its store yet, and store each result as soon as it is finished.

    If the program stops, by Ctrl-C or a kill too, only the pieces in progress are lost; the next start continues. The
    results are the same bytes wherever the pieces are computed, and however many at once.

    Args:
        job: what is to be done.
        store: where the results are stored.
        place: where the pieces are computed, and how many at once.
        progress: called with the finished fraction of the whole job.
        progress_of: called with the number of a piece when it starts; returns the callback for the progress of that
            piece.
        finished: called with the number of a piece and its result, when that is kept.

    Raises:
        SuchusError: what the work of a piece raised.
        Unwritable: a result cannot be kept.
        ProcessDied: the processes at a piece died as often as it was begun.
        NoCluster: the cluster was lost.
        IncompatibleRecord: a worker has other versions, so that its bytes could differ.
    """
    numbers = range(len(job.items))
    missing = [number for number in numbers if not store.has(number)]
    stored_numbers = sorted(set(numbers) - set(missing))
    tally = Tally(
        sum(job.size(number) for number in numbers),
        job.unit,
        progress,
        done_units=sum(job.size(number) for number in stored_numbers),
        failed=0 if job.failures is None else sum(job.failed(store.get(number)) for number in stored_numbers),
    )

    def start_piece(i: int) -> Progress:
        """Return the callback that forwards the progress of the i-th missing piece to its observer and to the tally."""
        number = missing[i]
        report = silent if progress_of is None else progress_of(number)

        def tell(stage: str, fraction: float) -> None:
            report(stage, fraction)
            tally.under_way(number, fraction * job.size(number))

        return tell

    with closing(place.results(job, [job.items[number] for number in missing], start_piece)) as results:
        for i, outcome in results:
            number = missing[i]
            result = _result_after_crash(job, number, outcome) if isinstance(outcome, PieceCrash) else outcome
            store.put(number, result)
            tally.finished(number, job.size(number), failed=job.failed(result))
            if finished is not None:
                finished(number, result)


def _result_after_crash(job: Job[Item, Result], number: int, crash: PieceCrash) -> Result:
    """Return the substitute that the job defines for a piece whose processes crashed.

    Raises:
        ProcessDied: the job has none.
    """
    if job.died is not None:
        return job.died(job.items[number], crash.exit_code)
    raise ProcessCrash(
        f"the process at {job.piece} {number} of {job.kind} {job.name!r} ended with exit code {crash.exit_code}, "
        f"{job.tries} times; what was finished is kept: where memory was short, fewer processes (--jobs) or smaller "
        "pieces take less of it."
    )


class Tally:
    """Counts the finished units of a job, those of earlier starts included, and estimates the remaining time.

    Args:
        total: units of the whole job [-].
        unit: name of a unit, as ``runs``.
        progress: called when the count changes, with the count, the rate and the remaining time as a stage, and with
            the finished fraction of the total.
        done_units: units that earlier starts finished [-].
        failed: number of those units that failed [-].
    """

    def __init__(
        self, total: float, unit: str, progress: Progress = silent, *, done_units: float = 0.0, failed: int = 0
    ) -> None:
        """Start the clock; ``done`` units of earlier starts do not count in the rate."""
        self.done, self.failed = done_units, failed
        self.note = ""
        """What else is told, behind the count."""
        self.total = total
        """Units of the whole job, which may become more while it goes on [-]."""
        self._unit, self._progress = unit, progress
        self._earlier_units, self._start = done_units, time.perf_counter()
        self._open_units: dict[int, float] = {}

    def under_way(self, number: int, units: float) -> None:
        """Report the finished units of a piece in progress [-]; several pieces may be in progress at once."""
        self._open_units[number] = units
        self._report()

    def finished(self, number: int, units: float, *, failed: int = 0, fresh: bool = True) -> None:
        """Count a finished piece.

        Args:
            number: number of the piece.
            units: all that it has [-].
            failed: how many of them failed [-].
            fresh: whether this start computed it; pieces of earlier starts do not count in the rate.
        """
        self._open_units.pop(number, None)
        self.done += units
        self.failed += failed
        self._earlier_units += 0.0 if fresh else units
        self._report()

    def _report(self) -> None:
        """Report the count, the rate and the remaining time of the whole job."""
        done_units = self.done + sum(self._open_units.values())
        seconds = time.perf_counter() - self._start
        rate = (done_units - self._earlier_units) / seconds if seconds > 0 else 0.0
        words = [f"{int(done_units)} of {self.total:g} {self._unit}"]
        if rate > 0:
            words.append(f"{rate:.1f}/s" if rate >= 0.1 else f"{3600 * rate:.1f}/h")
            words.append(f"{_duration(max(self.total - done_units, 0.0) / rate)} left")
        if self.failed:
            words.append(f"{self.failed} failed")
        if self.note:
            words.append(self.note)
        self._progress(", ".join(words), min(done_units / self.total, 1.0))


def _duration(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"

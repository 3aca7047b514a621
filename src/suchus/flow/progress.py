"""A progress bar for long runs: time reached, cells per second, remaining time."""

from time import monotonic
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeRemainingColumn

_QUIET = 2.0
"""Wall-clock time before the bar appears [s]."""


class Bar:
    """Shows a run's progress on the error stream, once it has lasted two seconds."""

    def __init__(self, start: float, end_time: float, cells: int, *, show: bool) -> None:
        """Prepare the progress bar.

        Args:
            start: time at the start of the run [s].
            end_time: time at its end [s].
            cells: cells of the grid [-].
            show: whether the bar is shown at all.
        """
        self._start, self._end_time, self._cells, self._show = start, end_time, cells, show
        self._opened, self._began, self._steps = monotonic(), 0.0, -1
        self._progress: Progress | None = None
        self._task = TaskID(0)

    def __enter__(self) -> "Bar":
        """Start the clock."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop the progress bar and leave its last line on the screen."""
        if self._progress is not None:
            self._progress.stop()

    def move(self, time: float) -> None:
        """Update the progress bar after a step that ended at a time [s]."""
        self._steps += 1
        if self._steps == 0:  # the first step may have had kernels compiled
            self._began = monotonic()
        if not self._show or monotonic() - self._opened < _QUIET:
            return
        if self._progress is None:
            self._progress = Progress(
                TextColumn("t = {task.completed:.3g} of {task.total:.3g} s"), BarColumn(),
                TextColumn("{task.fields[speed]:.1f} M cells/s"), TimeRemainingColumn(),
                console=Console(stderr=True), refresh_per_second=4,
            )  # fmt: skip
            self._progress.start()
            self._task = self._progress.add_task("", total=self._end_time, speed=0.0)
        speed = self._steps * self._cells / max(monotonic() - self._began, 1e-9) / 1e6
        self._progress.update(self._task, completed=time, speed=speed)

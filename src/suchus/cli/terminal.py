"""What people see in the terminal: bars while it works, then a table of verdicts."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from rich import progress as rich_progress
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, TaskID, TextColumn, TimeElapsedColumn
from rich.table import Table

from suchus import experiment as contract
from suchus.cli.perform import Performed
from suchus.progress import Progress
from suchus.report import quantity

_EVERY = 10.0  # [s]; between lines where there is no terminal for a bar
_COLOURS = {
    "reproduced": "green",
    "same sense": "yellow",
    "contradicted": "red",
    "not testable": "dim",
    "by construction": "cyan",
    "fitted": "cyan",
}


@dataclass(frozen=True, slots=True)
class Bars:
    """Progress bars on standard error; nothing where that is no terminal."""

    _progress: rich_progress.Progress

    def task(self, name: str) -> Progress:
        """Add a bar and return what moves it."""
        task: TaskID = self._progress.add_task(name, total=1.0, stage="")

        def move(stage: str, share: float) -> None:
            self._progress.update(task, completed=share, stage=stage)

        return move

    @property
    def seen(self) -> bool:
        """Whether there is a terminal to show them on."""
        return self._progress.console.is_terminal

    def reporter(self, name: str) -> Progress:
        """Add a bar and return what moves it, or says a line now and then where there is no terminal."""
        move, last = self.task(name), time.monotonic()

        def tell(stage: str, share: float) -> None:
            nonlocal last
            move(stage, share)
            if not self.seen and time.monotonic() - last > _EVERY:
                last = time.monotonic()
                self.say(f"{name}: {stage}, {share:.0%}")

        return tell

    def say(self, text: str) -> None:
        """Print a line above the bars."""
        self._progress.console.print(escape(text), highlight=False, soft_wrap=True)


@contextmanager
def working() -> Iterator[Bars]:
    """Show progress while the block runs."""
    console = Console(stderr=True)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TimeElapsedColumn(),
        TextColumn("[dim]{task.fields[stage]}"),
    )
    with rich_progress.Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress:
        yield Bars(progress)


def show_outcome(question: contract.Experiment, done: Performed) -> None:
    """Print the verdicts, and where everything else is."""
    console = Console(highlight=False)
    console.print(f"[bold]{escape(question.title)}[/]")
    if done.outcome.verdicts:
        table = Table(box=None, padding=(0, 2, 0, 0))
        for heading, side in (
            ("claim", "left"),
            ("printed", "right"),
            ("measured", "right"),
            ("verdict", "left"),
        ):
            table.add_column(heading, justify=side, style=None)  # type: ignore[arg-type]
        for verdict in done.outcome.verdicts:
            claim = verdict.claim
            table.add_row(
                escape(f"{claim.quantity} ({claim.where})"),
                quantity(claim.value, claim.unit, 3),
                quantity(verdict.measured, claim.unit, 3) if claim.value is not None else "",
                f"[{_COLOURS[verdict.verdict]}]{verdict.verdict}[/]{', fragile' if verdict.fragile else ''}",
            )
        console.print(table)
    if done.outcome.unjudged:
        console.print(escape(done.outcome.unjudged), soft_wrap=True)
    console.print(f"{done.seconds:.1f} s; everything is in {escape(str(done.folder))}", soft_wrap=True)

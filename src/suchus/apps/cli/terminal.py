"""What people see in the terminal while a command works: bars, or a line now and then."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from rich import progress as rich_progress
from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, TaskID, TextColumn, TimeElapsedColumn

from suchus.core.progress import Progress

_LINE_INTERVAL = 10.0  # [s]; between lines where there is no terminal for a bar


@dataclass(frozen=True, slots=True)
class Bars:
    """Progress bars on standard error; nothing where that is no terminal."""

    _progress: rich_progress.Progress

    def task(self, name: str) -> Progress:
        """Add a bar and return the function that moves it."""
        task: TaskID = self._progress.add_task(name, total=1.0, stage="")

        def move(stage: str, fraction: float) -> None:
            self._progress.update(task, completed=fraction, stage=stage)

        return move

    @property
    def is_terminal(self) -> bool:
        """Whether standard error is a terminal, which shows the bars."""
        return self._progress.console.is_terminal

    def reporter(self, name: str) -> Progress:
        """Add a bar and return the function that moves it; without a terminal the function prints lines."""
        move, last_time = self.task(name), time.monotonic()

        def tell(stage: str, fraction: float) -> None:
            """Move the bar; without a terminal print a line every ten seconds."""
            nonlocal last_time
            move(stage, fraction)
            if not self.is_terminal and time.monotonic() - last_time > _LINE_INTERVAL:
                last_time = time.monotonic()
                self.say(f"{name}: {stage}, {fraction:.0%}")

        return tell

    def say(self, text: str) -> None:
        """Print a line above the bars."""
        self._progress.console.print(escape(text), highlight=False, soft_wrap=True)


def print_code(text: str) -> None:
    """Print a QR code made of characters, dark on light; nothing where output is no terminal that has them."""
    console = Console(highlight=False)
    if text and console.is_terminal and console.encoding.startswith("utf"):
        console.print(escape(text), style="black on bright_white", soft_wrap=True)


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

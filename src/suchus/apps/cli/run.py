"""``suchus run NAME``: one experiment, its results into a folder."""

import shlex
import time
from collections.abc import Sequence
from contextlib import AbstractContextManager, suppress
from dataclasses import dataclass, fields
from pathlib import Path

import xarray as xr
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from suchus.apps.cli.entry import PROJECT
from suchus.apps.cli.options import TABLES, choose
from suchus.apps.cli.shelves import entry, title
from suchus.apps.cli.terminal import working
from suchus.apps.report import OUTCOME, PAGE, answer, answer_rows, check_place, quantity, save_outcome
from suchus.article.verdict import listed
from suchus.core.errors import plain_warnings
from suchus.core.files import check_writable, write_tables
from suchus.core.progress import Progress
from suchus.core.sources import current
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.experiment import Experiment, Outcome
from suchus.robot.design import Robot, lacking
from suchus.robot.gaits import DRAFTED, GAITS
from suchus.visual.figures import styled

_COLOURS = {
    "reproduced": "green",
    "same sense": "yellow",
    "contradicted": "red",
    "undecided": "magenta",
    "models disagree": "magenta",
    "depends on the reading": "magenta",
    "not testable": "dim",
    "by construction": "cyan",
    "fitted": "cyan",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class SavedRun:
    """An experiment that was run and saved."""

    outcome: Outcome
    """Outcome of the experiment."""
    folder: Path
    """Folder of its files."""
    seconds: float
    """Duration of running and drawing [s]."""


def perform(experiment: Experiment, name: str, results_folder: Path, progress: Progress, command: str) -> SavedRun:
    """Run an experiment, draw its figures and save all of it in ``out / name``.

    Args:
        experiment: the question.
        name: its name in the catalog.
        results_folder: the folder for results.
        progress: called with the share that is done, 0 to 1.
        command: what makes the same result again.

    Raises:
        Unwritable: the results cannot be saved; reported before the run where it can be known.
    """
    start = time.perf_counter()
    check_place(results_folder / name)
    options = [f"--{setting.name.replace('_', '-')}" for setting in fields(experiment)]  # type: ignore[arg-type]
    with _plain_sums(), plain_warnings(name, options=options):
        outcome = experiment.run(progress)
        progress("drawing", 1.0)
        with styled():
            figures = {} if outcome.too_short else experiment.draw(outcome)
        progress("saving", 1.0)
        folder = save_outcome(outcome, figures, experiment, results_folder / name, command=command)
    for path in outcome.checkpoint_files:
        with suppress(OSError):  # a file that cannot be removed does not spoil the result
            path.unlink()
    return SavedRun(outcome=outcome, folder=folder, seconds=time.perf_counter() - start)


def _plain_sums() -> AbstractContextManager[object]:
    """Make xarray use NumPy's sums and medians, whatever other libraries are installed.

    Those of ``numbagg``, which comes with the extra ``capture``, round otherwise, so that equal runs would not give
    equal bytes everywhere; and they compile for up to half a minute in every process.
    """
    return xr.set_options(use_numbagg=False, use_bottleneck=False)  # type: ignore[no-untyped-call]


def show_outcome(question: Experiment, saved_run: SavedRun) -> None:
    """Print the answer, the numbers that carry it, the verdicts, and where everything else is."""
    console = Console(highlight=False)
    console.print(f"[bold]{escape(question.title)}[/]")
    for line in gait_sentence(question):
        console.print(escape(line))
    console.print(escape(answer(saved_run.outcome.statement)))
    rows = [] if saved_run.outcome.too_short else answer_rows(question.answers, saved_run.outcome.measures)
    shown = [place for place in range(4) if place < 2 or any(row[place] for row in rows)]
    headings = ("measure", "value", "interval", "time step")
    numbers = Table(*(headings[place] for place in shown), box=None, padding=(0, 2, 0, 0))
    for row in rows:
        numbers.add_row(*(escape(row[place]) for place in shown))
    if rows:
        console.print(numbers)
    if saved_run.outcome.verdicts:
        table = Table(box=None, padding=(0, 2, 0, 0))
        for heading, side in (
            ("claim", "left"),
            ("printed", "right"),
            ("measured", "right"),
            ("verdict", "left"),
        ):
            table.add_column(heading, justify=side, style=None)  # type: ignore[arg-type]
        for verdict in saved_run.outcome.verdicts:
            claim = verdict.claim
            table.add_row(
                escape(f"{claim.quantity} ({claim.place})"),
                quantity(claim.value, claim.unit, 3),
                quantity(verdict.measured, verdict.unit, 3),
                f"[{_COLOURS[verdict.verdict]}]{verdict.verdict}[/]{', fragile' if verdict.fragile else ''}",
            )
        console.print(table)
    if saved_run.outcome.unjudged:
        console.print(escape(saved_run.outcome.unjudged), soft_wrap=True)
    console.print(
        f"{saved_run.seconds:.1f} s; the page with all of it: {escape(str(saved_run.folder / PAGE))}", soft_wrap=True
    )


def gait_sentence(question: Experiment) -> list[str]:
    """Return a sentence that names the gaits, if the robot is not the experiment's own robot."""
    robot = getattr(question, "robot", None)
    single_gait = getattr(question, "gait", None)
    gaits = getattr(question, "gaits", ()) if single_gait is None else (single_gait,)
    if not gaits or robot is None or robot == getattr(type(question)(), "robot", None):
        return []
    if gaits[0].name == DRAFTED:
        return [f"No gait in the catalog suits {robot.name}: it moves in one that was drafted for it."]
    gait_texts = []
    for gait in gaits:
        shelf = GAITS.get(gait.name, gait)
        period_note = f" (a cycle in {gait.period:.3g} s; {shelf.period:.3g} s in the catalog)"
        gait_texts.append(gait.name + (period_note if gait.period != shelf.period else ""))
    return [f"{robot.name} moves in the gait{'s' * (len(gait_texts) > 1)} {listed(gait_texts)}."]


def run(words: Sequence[str]) -> int:
    """Run one experiment and return 0.

    Args:
        words: the name of the experiment, which ``word_checks`` found in the catalog, and options.

    Raises:
        SuchusError: the words make no sense, or the run failed.
    """
    if words[:1] in (["-h"], ["--help"]):
        print(_help())
        return 0
    name, *options = words
    choice = choose(EXPERIMENTS[name], name, options)
    check_writable(choice.out)
    with working() as bar:
        saved_run = perform(choice.experiment, name, choice.out, bar.task(name), _repeat_command(words))
    tables = write_tables(saved_run.outcome.record, saved_run.folder / TABLES) if choice.csv else None
    if choice.json:
        print((saved_run.folder / OUTCOME).read_text(encoding="utf-8"), end="")
        return 0
    show_outcome(choice.experiment, saved_run)
    if tables is not None:
        print(f"the record as CSV: {tables}")
    return 0


def run_command_lines(robot: Robot, robot_word: str, gait: Path, experiment_name: str = "displacement") -> list[str]:
    """Return the command that runs a gait on a robot; of a body without limbs the command that floats it.

    Args:
        robot: the robot.
        robot_word: its name or its file; empty for the robot of the catalog that is taken where none is named.
        gait: the file of the gait.
        experiment_name: the question to ask where the robot suits it, before how far it walks and how fast.
    """
    for name, option in ((experiment_name, "--gait"), ("displacement", "--gait"), ("speed_range", "--gaits")):
        if not lacking(robot, EXPERIMENTS[name].needs):
            robot_option = ("--robot", robot_word) if robot_word else ()
            return [f"run it: {shlex.join(['suchus', 'run', name, *robot_option, option, str(gait)])}"]
    return floating_command_lines(robot_word)


def floating_command_lines(robot_word: str) -> list[str]:
    """Return the command that any body answers: whether and how it floats.

    Args:
        robot_word: the robot or its file; empty for the default robot.
    """
    robot_option = ("--robot", robot_word) if robot_word else ()
    return [f"run it: {shlex.join(['suchus', 'run', 'floating', *robot_option])}"]


def _repeat_command(words: Sequence[str]) -> str:
    """Return the command that makes the same result again, from any folder."""
    project = current()
    return shlex.join(["suchus", "run", *words, *((PROJECT, str(project.folder)) if project else ())])


def _help() -> str:
    """Return the help of ``suchus run``: its options and every experiment with its title."""
    shelf = EXPERIMENTS.sources()
    width = max((len(name) for name in shelf), default=0)
    return "\n".join(
        (
            "usage: suchus run NAME [--quick] [--for-verdicts] [--out DIR] [--csv] [--json] [--FIELD VALUE ...]",
            "",
            "Run one experiment. Its numbers, verdicts, figures and record go into DIR/NAME.",
            "",
            "experiments:",
            *(entry(name, title(source), width) for name, source in shelf.items()),
            "",
            "suchus run NAME --help lists what can be changed about an experiment.",
        )
    )

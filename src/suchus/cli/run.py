"""``suchus run NAME``: one experiment, its results into a folder."""

import shlex
from collections.abc import Sequence

from suchus.cli.commands import PROJECT, BadCommand
from suchus.cli.options import TABLES, choose
from suchus.cli.perform import perform
from suchus.cli.shelves import entry, title
from suchus.cli.terminal import show_outcome, working
from suchus.experiments import EXPERIMENTS
from suchus.record import check_writable, write_tables
from suchus.sources import current


def run(words: Sequence[str]) -> int:
    """Run one experiment and return 0.

    Raises:
        SuchusError: the words make no sense, or the run failed.
    """
    if words[:1] in (["-h"], ["--help"]):
        print(_help())
        return 0
    if not words or words[0].startswith("-"):
        there = ", ".join(EXPERIMENTS)
        raise BadCommand(f"the name of the experiment comes first, as in suchus run NAME --quick; there is {there}.")
    name, *options = words
    choice = choose(EXPERIMENTS[name], name, options)
    check_writable(choice.out)
    with working() as bar:
        done = perform(choice.experiment, name, choice.out, bar.task(name), _again(words))
    show_outcome(choice.experiment, done)
    if choice.csv:
        print(f"the record as CSV: {write_tables(done.outcome.record, done.folder / TABLES)}")
    return 0


def _again(words: Sequence[str]) -> str:
    """Return the command that makes the same result again, from any folder."""
    project = current()
    return shlex.join(["suchus", "run", *words, *((PROJECT, str(project.folder)) if project else ())])


def _help() -> str:
    shelf = EXPERIMENTS.sources()
    width = max((len(name) for name in shelf), default=0)
    return "\n".join(
        (
            "usage: suchus run NAME [--quick] [--out DIR] [--csv] [--FIELD VALUE ...]",
            "",
            "Run one experiment. Its numbers, verdicts, figures and record go into DIR/NAME.",
            "",
            "experiments:",
            *(entry(name, title(source), width) for name, source in shelf.items()),
            "",
            "suchus run NAME --help lists what can be changed about an experiment.",
        )
    )

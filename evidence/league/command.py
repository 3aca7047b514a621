"""``python -m evidence.league``: real machines and animals, predicted and sealed before what was measured is opened."""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from evidence.league import every, find
from evidence.league.cases import CONTESTANTS, measured_file
from evidence.league.page import FIGURE, OUTCOMES, PAGE, LeagueEntry, all_standings, shown, standing, write_page
from evidence.league.sealing import check_measured, sealed_prediction
from suchus.apps.cli.entry import BadCommand, Subcommand
from suchus.apps.cli.entry import main as run_command
from suchus.apps.cli.options import parse
from suchus.apps.cli.terminal import working
from suchus.core import threads
from suchus.core.errors import UnreadableFile
from suchus.core.files import check_replaceable, check_writable, path_exists


@dataclass(frozen=True, slots=True, kw_only=True)
class LeagueOptions:
    """Options of ``python -m evidence.league``."""

    names: Annotated[tuple[str, ...], tyro.conf.Positional] = ()
    """Contestants; all if there are none. One of a family has a number behind its name, as catshark_2.5."""
    out: Path = Path("out") / "league"
    """Folder of the predictions, a folder for each contestant, and of the page. What is sealed there is kept."""
    jobs: int | None = None
    """Models that are asked side by side; by default one for each thread."""
    models: tuple[str, ...] = ()
    """Models that are asked, as resistive reactive sections; all if there are none. The page names the others."""
    measured: Path | None = None
    """What was measured of a single contestant, a JSON file: {quantity: {value, low, high, unit, source}}."""


def league(words: Sequence[str]) -> int:
    """Predict, seal, open what was measured, print verdicts, and write the page; return 0.

    Raises:
        SuchusError: the words make no sense, or nothing can be written.
    """
    about = (
        "Predict real machines and animals by every model, seal the predictions with their date and the state of the "
        "code, and only then open what was measured. Started again it goes on where it stopped."
    )
    options = parse(LeagueOptions, "python -m evidence.league", words, about)
    names = list(dict.fromkeys(options.names)) or list(every(CONTESTANTS))
    contestants = [find(CONTESTANTS, name).asking(options.models) for name in names]
    if options.jobs is not None and options.jobs < 1:
        raise BadCommand(f"--jobs is {options.jobs}; at least 1 model at a time is needed.")
    if options.measured is not None and len(names) != 1:
        raise BadCommand(f"--measured is of one contestant, and {len(names)} are asked for: name one.")
    if options.measured is not None and not path_exists(options.measured):
        raise UnreadableFile(f"{options.measured} is not there; --measured names what was measured.")
    if options.measured is not None:
        check_measured(contestants[0].predicts, options.measured)
    check_writable(options.out)
    for name in (PAGE, FIGURE, OUTCOMES):
        check_replaceable(options.out / name)
    measured = {name: options.measured or measured_file(name) for name in names}
    with working() as bars:
        for number, one in enumerate(contestants, start=1):
            seal = sealed_prediction(
                one, options.out, progress=bars.reporter(one.name), jobs=options.jobs or threads.count()
            )
            bars.say(f"{number} of {len(contestants)}: {one.name}, sealed {seal.date}")
            for line in _lines(standing(one, options.out, measured[one.name])):
                print(line)
    print(write_page(all_standings(options.out, contestants, measured), options.out))
    return 0


def _lines(one: LeagueEntry) -> list[str]:
    """Return what the terminal shows of a contestant."""
    words = {(quantity, rung): word for quantity, rung, *_, word in one.judgements()}
    lines = [one.title]
    for quantity, rungs in one.prediction.items():
        lines.append(f"  {one.words[quantity]} [{one.units[quantity]}]")
        if quantity in one.measured:
            lines.append(f"    {'measured':<12}{shown(one.measured[quantity].value)}")
        for rung, at in rungs.items():
            word = words.get((quantity, rung))
            verdict = f"  {word.word}, {word.ratio:.2g} times" if word else ""
            lines.append(f"    {rung:<12}{shown(at.value)} ({shown(at.low)} to {shown(at.high)}){verdict}")
    return lines + [f"  no word from {rung}: {why}" for rung, why in one.seal.refused.items()]


COMMAND = Subcommand(
    "league",
    "[NAME ...] [--out DIR]",
    "predict real machines and animals, sealed before what was measured is opened",
    "evidence.league.command:league",
)
"""The command, with the exit codes of every command of suchus."""


def main(words: Sequence[str] | None = None) -> int:
    """Carry the command out and return the exit code, as ``suchus.apps.cli.main`` does.

    Args:
        words: what follows ``python -m evidence.league``; by default those of this process.
    """
    return run_command([COMMAND.name, *(sys.argv[1:] if words is None else words)], (COMMAND,))

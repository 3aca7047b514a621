"""``suchus reproduce``: every experiment, then the page."""

import traceback
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from suchus.cli.commands import BadCommand
from suchus.cli.options import OUT, QUICK, parse
from suchus.cli.perform import perform
from suchus.cli.terminal import Bars, working
from suchus.errors import SuchusError
from suchus.experiments import EXPERIMENTS
from suchus.record import check_writable
from suchus.report import Failure, Result, check_place, load_result, write_page


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """What can be said after ``suchus reproduce``."""

    out: OUT = Path("out")
    quick: QUICK = False


def reproduce(words: Sequence[str]) -> int:
    """Run every experiment, write the page, print its path; return 1 if an experiment failed, else 0.

    Raises:
        SuchusError: the words make no sense, or the results cannot be saved.
    """
    told = "Run every experiment and write one page with everything that came out, DIR/report.html."
    options: Options = parse(Options, "suchus reproduce", words, told, ("out", "quick"))
    if not len(EXPERIMENTS):
        raise BadCommand("there is no experiment on the shelf.")
    check_writable(options.out)
    for name in EXPERIMENTS:
        check_place(options.out / name)
    with working() as bars:
        came = [_attempt(name, options, bars) for name in EXPERIMENTS]
        results = [one for one in came if isinstance(one, Result)]
        failures = [one for one in came if isinstance(one, Failure)]
        page = write_page(results, failures, options.out / "report.html")
    print(page)
    return 1 if failures else 0


def _attempt(name: str, options: Options, bars: Bars) -> Result | Failure:
    """Run one experiment; whatever goes wrong in it must not stop the others."""
    try:
        experiment = EXPERIMENTS[name]
        quick = options.quick or not experiment.in_reproduce
        command = f"suchus run {name}{' --quick' * quick}"
        done = perform(experiment.quick() if quick else experiment, name, options.out, bars.task(name), command)
        result = load_result(done.folder)
    except SuchusError as error:
        bars.say(f"{name}: failed: {error}")
        return Failure(name=name, sentence=str(error))
    except Exception as error:
        bars.say(f"{name}: failed: {type(error).__name__}: {error}")
        return Failure(name=name, sentence=f"{type(error).__name__}: {error}", trace=traceback.format_exc())
    words = [verdict["verdict"] for verdict in result.told["verdicts"]]
    told = ", ".join(f"{words.count(word)} {word}" for word in dict.fromkeys(words)) or "no verdict"
    bars.say(f"{name}: {told} ({done.seconds:.1f} s)")
    return result

"""``suchus optimise NAME|FILE.toml``: the search for a better gait or body, resumable."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

import tyro

from suchus.apps.cli.entry import BadCommand
from suchus.apps.cli.options import SCHEDULER, parse
from suchus.apps.cli.terminal import working
from suchus.core.errors import UnknownName
from suchus.core.files import check_name, check_replaceable, check_writable, path_exists
from suchus.core.jobs import at_scheduler
from suchus.experiments.optimise import AIMS, READY, Optimisation, read_optimisation, write_results
from suchus.experiments.optimise import optimise as conduct
from suchus.experiments.optimise.conduct import run_files
from suchus.experiments.optimise.ready import FOR_ANY_ROBOT
from suchus.experiments.optimise.results import RESULT
from suchus.robot.design import Robot


@dataclass(frozen=True, slots=True, kw_only=True)
class OptimiseOptions:
    """Options of ``suchus optimise``."""

    what: Annotated[str, tyro.conf.Positional]
    """A ready-made search, or a TOML file; see docs/optimise.md."""
    robot: Robot | None = None
    """Another robot for the search crawl, each of its two groups with its best legs; by default caiman."""
    out: Path | None = None
    """Folder of results; by default out/optimise/NAME. A search that began there is continued."""
    evaluations: int | None = None
    """Number of candidates that each condition may try; the generation in which they run out is finished. More than
    before continues an earlier search."""
    seed: int | None = None
    """Seed of the search."""
    scheduler: SCHEDULER = None


def optimise(words: Sequence[str]) -> int:
    """Search, or finish a search, print the result, and return 0.

    Raises:
        SuchusError: the words or the file make no sense, or nothing can be written.
    """
    ready = "\n".join(f"  {name}: {builder.__doc__}" for name, builder in READY.items())
    description = f"Search for a better gait or body. A search that was stopped is continued. Ready-made:\n{ready}"
    options = parse(OptimiseOptions, "suchus optimise", words, description)
    spec = _read_search(options)
    folder = options.out or Path("out") / "optimise" / spec.name
    check_writable(folder)
    for file_name in (RESULT, *(file for arm in spec.arms for file in run_files(spec, arm.name))):
        check_replaceable(folder / file_name)
    cpu = time.process_time()
    with at_scheduler(options.scheduler) as client, working() as bars:
        results = conduct(spec, folder, progress=bars.reporter(spec.name), client=client)
        bars.say("the best are run again, drawn and packed for replay")
        result = write_results(spec, results, folder)
    for search in results:
        for name, i in zip(search.names, search.chosen_indices, strict=True):
            aims = ", ".join(
                f"{aim.name} {float(search.history[f'aim_{aim.name}'][0]):.3g} to "
                f"{float(search.history[f'aim_{aim.name}'][i]):.3g} {AIMS[aim.name].unit}"
                for aim in spec.aims
            )
            print(f"{name}: {aims}; {result / name}.toml")
    print(f"{time.process_time() - cpu:.0f} s of processor time; the page is {result / 'index.html'}")
    return 0


def _read_search(options: OptimiseOptions) -> Optimisation:
    """Return the search that is asked for."""
    if options.robot is not None and options.what not in FOR_ANY_ROBOT:
        raise BadCommand(
            f"--robot is for the search {' or '.join(FOR_ANY_ROBOT)}; {options.what} is of the robot that it names: "
            "leave --robot out, or write the robot into the file of the search."
        )
    if options.what in READY:
        spec = READY[options.what](options.robot) if options.robot is not None else READY[options.what]()
    elif options.what.endswith(".toml") or path_exists(Path(options.what)):
        spec = read_optimisation(Path(options.what))
    else:
        raise UnknownName("search", options.what, READY)
    if options.out is None:
        check_name(spec.name, "search")
    if options.evaluations is not None:
        spec = replace(spec, evaluations=options.evaluations)
    return spec if options.seed is None else replace(spec, seed=options.seed)

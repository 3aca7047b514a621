"""``suchus study FILE.toml``: many runs, their results into a folder that a kill cannot spoil."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

import tyro
import xarray as xr

from suchus.apps.cli.entry import BadCommand
from suchus.apps.cli.options import CSV, SCHEDULER, TABLES, parse
from suchus.apps.cli.terminal import working
from suchus.article.verdict import listed
from suchus.core.errors import UnreadableFile
from suchus.core.files import check_name, check_replaceable, path_exists, write_tables
from suchus.core.jobs import at_scheduler
from suchus.core.jobs.store import RESULTS, TABLE
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.study import Claims, answer_finished, conduct, conduct_claims, read_study
from suchus.experiments.study.claims_page import SHARES, write_claims, write_renewed
from suchus.experiments.study.varied import conduct_varied, varied_finished, varied_study

CLAIMS = "claims"


@dataclass(frozen=True, slots=True, kw_only=True)
class StudyOptions:
    """Options of ``suchus study``."""

    file: Annotated[Path, tyro.conf.Positional]
    """The study, a TOML file, or ``claims``, the article's claims over plausible designs; see docs/studies.md."""
    scheduler: SCHEDULER = None
    jobs: int = 1
    """How many processes run it, which share the threads; each takes a batch at a time. The results are the
    same."""
    samples: int | None = None
    """Number of points of a sampled study; with another number than before it is another study."""
    out: Path | None = None
    """Folder of the store; by default out/studies/NAME. A store of the same study is continued, any other refused."""
    finished: bool = False
    """Only for ``claims``: run nothing, and answer from the samples in the store, the largest power of two of them."""
    only: tuple[str, ...] = ()
    """Only for ``claims``: these experiments alone are asked again, without the walks, and their rows are put into the
    table of shares that ships. With ``--finished`` from what the store holds of them."""
    csv: CSV = False
    """Write the results as CSV files with units in the header too, into the folder csv in the store."""


def study(words: Sequence[str]) -> int:
    """Conduct a study, or finish it, print the result, and return 0.

    Raises:
        SuchusError: the words or the file make no sense, or the store cannot be written to.
    """
    description = "Run many variants of one run, and store what is measured. A study that was stopped is continued."
    options = parse(StudyOptions, "suchus study", words, description)
    if options.jobs < 1:
        raise BadCommand(f"--jobs is {options.jobs}; at least 1 process is needed.")
    if options.jobs > 1 and options.scheduler is not None:
        raise BadCommand("--jobs and --scheduler exclude each other: the workers of a cluster are started with it.")
    if str(options.file) == CLAIMS and not path_exists(options.file):
        return _study_claims(options)
    spec = read_study(options.file)
    if options.only:
        raise BadCommand("--only is for claims only; another study has nothing but its own runs.")
    if options.finished:
        raise BadCommand("--finished is for claims only; other studies write their results when they are complete.")
    if options.samples is not None:
        spec = replace(spec, samples=options.samples)
    if options.out is None:
        check_name(spec.name, "study")
    folder = options.out or Path("out") / "studies" / spec.name
    for name in (RESULTS, TABLE, *[TABLES] * options.csv):
        check_replaceable(folder / name)
    with at_scheduler(options.scheduler) as client, working() as bars:
        results = conduct(spec, folder, progress=bars.reporter(spec.name), client=client, jobs=options.jobs)
    failed = {sample: str(error) for sample, error in enumerate(results.error.values) if error}
    print(f"{results.sizes['sample']} runs, {len(failed)} failed: {folder / RESULTS}, {folder / TABLE}")
    if options.csv:
        print(f"the results as CSV with units: {write_tables(results, folder / TABLES)}")
    for sample, error in list(failed.items())[:1]:
        print(f"the first that failed is sample {sample}: {error}")
    return 0


def _study_claims(options: StudyOptions) -> int:
    """Conduct the ready-made study of the claims, or finish it."""
    claims = Claims() if options.samples is None else Claims(samples=options.samples)
    folder = options.out or Path("out") / "studies" / CLAIMS
    specs = [study for experiment in EXPERIMENTS.values() if (study := varied_study(experiment)) is not None]
    unknown = [name for name in options.only if name not in {spec.name for spec in specs}]
    if unknown:
        study_names = listed([spec.name for spec in specs])
        raise BadCommand(f"--only {', '.join(unknown)} cannot be asked again; those that can are {study_names}.")
    for name in ("result", "renewed"):
        check_replaceable(folder / name)
    specs = [spec for spec in specs if not options.only or spec.name in options.only]
    if options.finished:
        record = None if options.only else answer_finished(claims, folder)
        results = {spec.name: result for spec in specs if (result := varied_finished(spec, folder)) is not None}
        return _write_answers(record, results, folder)
    with at_scheduler(options.scheduler) as client, working() as bars:
        record = None
        if not options.only:
            record = conduct_claims(claims, folder, progress=bars.reporter(CLAIMS), client=client, jobs=options.jobs)
        results = {
            spec.name: conduct_varied(spec, folder, progress=bars.reporter(spec.name), client=client, jobs=options.jobs)
            for spec in specs
        }
        return _write_answers(record, results, folder)


def _write_answers(record: xr.Dataset | None, varied_results: Mapping[str, xr.Dataset], folder: Path) -> int:
    """Write the verdicts on the claims, print where they are, and return 0.

    Args:
        record: record of the study of walks; None: only rows of single experiments are renewed.
        varied_results: results of the varied experiments, by name.
        folder: folder of the study.

    Raises:
        UnreadableFile: there is nothing to answer from.
    """
    if record is None:
        return _renew_share_rows(varied_results, folder)
    result = write_claims(record, folder / "result", varied_results)
    walked_count = int((record.status == "walked").sum())
    rerun_count = sum(results.sizes["sample"] for results in varied_results.values())
    print(
        f"{record.sizes['sample']} designs and gaits, {walked_count} walked, and {rerun_count} designs and settings of "
        f"{len(varied_results)} other experiments; the page is {result / 'index.html'}"
    )
    return 0


def _renew_share_rows(varied_results: Mapping[str, xr.Dataset], folder: Path) -> int:
    """Write the rows of single experiments into the table of shares, print which they are, and return 0."""
    if not varied_results:
        raise UnreadableFile(
            f"{folder} holds too few points of what was asked; leave out --finished, and they are made."
        )
    result = write_renewed(varied_results, folder / "renewed")
    rows = sum(results.sizes["claim"] for results in varied_results.values())
    row_sources = listed([f"{name} ({results.sizes['sample']} designs)" for name, results in varied_results.items()])
    print(
        f"{rows} rows of {row_sources} are renewed in the table of shares, {result / SHARES}; "
        "other rows are as they ship"
    )
    return 0

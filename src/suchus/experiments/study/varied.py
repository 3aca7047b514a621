"""An experiment repeated with other plausible designs and settings, for claims that the study of walks cannot judge."""

import json
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import xarray as xr

from suchus.article.verdict import Rule, listed
from suchus.core.checks import Checks
from suchus.core.errors import IncompatibleRecord, SuchusError
from suchus.core.jobs import Job, Store, finish, place_for
from suchus.core.jobs.store import MARK, concatenate_tables, read_description
from suchus.core.progress import Progress, silent
from suchus.experiments.claims import RULES, design_sweep_of
from suchus.experiments.study.answers import answer_claims
from suchus.experiments.study.claim_measures import judge_samples, words
from suchus.experiments.study.plan import evenly, joint_values, only_forbids, vary_assumption
from suchus.experiments.study.study import Vary
from suchus.robot.design import Robot, unit_at, value_at, with_values
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS

MIN_POINTS = 8
"""Fewest points for a fraction of designs [-]; with fewer its interval would span half of the range."""


class Question(Protocol):
    """An experiment, which is a frozen dataclass."""

    def name(self) -> str:
        """Return its name in the catalog."""

    def simulate_measures(self, measure_names: Collection[str], progress: Progress = silent) -> Mapping[str, Any]:
        """Return the numbers that are wanted at least, each with its ``value``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class VariedStudy:
    """An experiment that runs once at each point of a plan of designs and settings."""

    name: str
    """Name of the experiment."""
    experiment: Question
    """The question from which all differ."""
    vary: tuple[Vary, ...]
    """Fields of the experiment that vary, over their plausible ranges."""
    claims: tuple[str, ...]
    """Keys of the claims that are judged."""
    samples: int
    """Number of points of the Sobol sequence [-]."""
    seed: int = 0
    """Seed of its scrambling [-]."""

    def __post_init__(self) -> None:
        with Checks("the study of settings", self) as check:
            check.whole("samples", 1, 100_000)
            check.whole("seed", 0, 2**32 - 1)
            check.that(len(self.vary) > 0, f"{self.name} varies nothing; name at least one field in VARIED")

    @property
    def rules(self) -> tuple[Rule, ...]:
        """The rules that judge each point."""
        return tuple(RULES[claim] for claim in self.claims)

    def point(self, sample: int) -> dict[str, Any]:
        """Return the values of a point, by field; the first points stay the same, however many there are."""
        shares = evenly("sobol", self.samples, len(self.vary), self.seed)[sample]
        takes_whole = {vary.field: isinstance(value_at(self.experiment, vary.field), int) for vary in self.vary}
        values = joint_values(self.experiment, self.vary, shares, takes_whole)
        return {vary.field: values[vary.field] for vary in self.vary}

    def question_at(self, sample: int) -> Question:
        """Return the question of a point.

        Raises:
            InvalidDesign: its values cannot be together.
        """
        return with_values(self.experiment, self.point(sample))


def varied_study(question: Question, samples: int | None = None) -> VariedStudy | None:
    """Return the study of an experiment's designs and settings, or None where it declares none.

    Args:
        question: the experiment, as in the catalog.
        samples: number of points; as many as the experiment asks for if None [-].
    """
    sweep = design_sweep_of(question.name())
    if sweep is None:
        return None
    experiment: Any = replace(question, **sweep.settings)  # type: ignore[type-var]
    varies = [
        Vary(field=path, low=lower_bound, high=upper_bound)
        for path, (lower_bound, upper_bound, _) in sweep.over.items()
    ]
    for design_field in sweep.designs:
        design = getattr(experiment, design_field)
        shelves: Any = ROBOTS if isinstance(design, Robot) else GAITS
        choices = shelves.beside(design.name, "chosen", ())
        varies += [
            vary_assumption(f"{design_field}.{choice.field}", choice)
            for choice in choices
            if not only_forbids(choice.field)
        ]
    return VariedStudy(
        name=question.name(),
        experiment=experiment,
        vary=tuple(varies),
        claims=sweep.claims,
        samples=sweep.samples if samples is None else samples,
    )


def conduct_varied(
    study: VariedStudy, folder: Path, *, progress: Progress = silent, client: Any = None, jobs: int = 1
) -> xr.Dataset:
    """Run the experiment at every point that is missing in the store, and judge the claims.

    Args:
        study: the experiment and its points.
        folder: folder of the stores, one below it for each experiment; each point is kept as it is finished.
        progress: told how many points are done.
        client: a ``distributed.Client``, whose workers then ask; this machine if None.
        jobs: number of processes of this machine.

    Returns:
        Number, truth and word of each claim at every point, see ``answers.answer_claims``, ``value`` over ``sample``
        and ``parameter``, and ``status``.

    Raises:
        Unwritable: the store cannot be written to.
        IncompatibleRecord: the store is another study's or another version's, or a rule needs what is not measured.
    """
    job = Job(
        name=f"claims of {study.name}",
        kind="study",
        piece="design",
        unit="designs",
        work=partial(ask, study),
        items=range(study.samples),
        failures=lambda result: int((result.error != "").sum()),
    )
    with Store(folder / study.name, study).opened() as store:
        finish(job, store, place=place_for("a study", client=client, jobs=jobs), progress=progress)
        return _with_provenance(answer_varied(study, store.gather(study.samples)), folder / study.name)


def varied_finished(study: VariedStudy, folder: Path) -> xr.Dataset | None:
    """Return the answer from the points that are stored, whatever version stored them; None where there are too few.

    Args:
        study: the experiment and its points.
        folder: folder of the stores.

    Raises:
        IncompatibleRecord: they are points of another plan, so that nobody knows any more what varied.
    """
    store = Store(folder / study.name, study)
    stored_fields = (
        read_description(folder / study.name, key="fields") if (folder / study.name / MARK).is_file() else {}
    )
    changed_names = [
        name for name in ("vary", "seed") if stored_fields and stored_fields.get(name) != repr(getattr(study, name))
    ]
    if changed_names:
        raise IncompatibleRecord(
            f"{folder / study.name} holds points of another plan, which differs in {listed(changed_names)}: numbers "
            f"were added or have other ranges since. Renew it: suchus study claims --only {study.name} --out FOLDER"
        )
    tables = [store.get(sample) for sample in range(study.samples) if store.has(sample)]
    return (
        _with_provenance(answer_varied(study, concatenate_tables(tables)), folder / study.name)
        if len(tables) >= MIN_POINTS
        else None
    )


def _with_provenance(record: xr.Dataset, folder: Path) -> xr.Dataset:
    return record.assign_attrs(made_by=json.dumps(read_description(folder)))


def ask(study: VariedStudy, sample: int, progress: Progress = silent) -> xr.Dataset:
    """Return the measures that the rules need at one point, or the reason why there are none in ``error``."""
    measure_names = sorted(set().union(*(rule.needs for rule in study.rules)))
    numbers, error = dict.fromkeys(measure_names, np.nan), ""
    try:
        measures = study.question_at(sample).simulate_measures(measure_names, progress)
        numbers = {name: float(measures[name].value) for name in measure_names}
    except SuchusError as refused:
        error = f"{type(refused).__name__}: {' '.join(str(refused).split())}"
    columns: dict[str, Any] = {name: ("sample", [value]) for name, value in numbers.items()}
    return xr.Dataset(columns | {"error": ("sample", [error])}, coords={"sample": [sample]})


def answer_varied(study: VariedStudy, results: xr.Dataset) -> xr.Dataset:
    """Return number, truth and word of each claim from the measures at the points.

    Args:
        study: what was asked.
        results: results of ``ask``, one or more points.
    """
    points = [study.point(int(sample)) for sample in results.sample.values]
    measures = {str(name): results[name].values for name in results.data_vars if name != "error"}
    kinds = [str(error).partition(":")[0] for error in results.error.values]
    value = np.array([[float(point[vary.field]) for vary in study.vary] for point in points])
    record = xr.Dataset(
        {
            "status": ("sample", np.array([_STATUS.get(kind, "impossible") for kind in kinds])),
            "value": (("sample", "parameter"), value, {"units": "1", "long_name": "each in its own unit"}),
        },
        coords={
            "parameter": [vary.field for vary in study.vary],
            "parameter_unit": ("parameter", [unit_at(study.experiment, vary.field) for vary in study.vary]),
        },
    )
    claim_results = {rule.claim: judge_samples(rule, measures) for rule in study.rules}
    claim_words = np.array([words(rule, measures) for rule in study.rules], dtype=object)
    claim_words[:, record.status.values != "asked"] = ""
    record["word"] = (
        ("claim", "sample"),
        claim_words.astype(str),
        {"units": "1", "long_name": "what it says of the claim"},
    )
    return record.merge(answer_claims(claim_results, value))


_STATUS: Mapping[str, str] = {"": "asked", "OutsideLimits": "outside limits", "Diverged": "diverged"}

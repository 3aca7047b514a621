"""The ready-made study of the article's claims: plausible designs and gaits, with and without spine, tail, joints."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from suchus.article.paper import CYCLES
from suchus.core.checks import Checks
from suchus.core.errors import UnreadableFile
from suchus.core.jobs import source_versions
from suchus.core.jobs.store import read_description
from suchus.core.progress import Progress, silent
from suchus.experiments.study.answers import agreement, answers
from suchus.experiments.study.arm import Arm
from suchus.experiments.study.claim_measures import FAULTY, METRICS, RUNS, judge_samples, measures_of, swept_rules
from suchus.experiments.study.conduct import conduct, finished
from suchus.experiments.study.plan import only_forbids, vary_assumption
from suchus.experiments.study.study import Study
from suchus.robot.design import Robot, unit_at, value_at
from suchus.robot.gaits import GAITS, conditions_of
from suchus.robot.motion import START, Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import FAILED_JOINTS, Run, joint_failure

FINE = 0.002  # [s]; the time step of results
_TRUNK = ("trunk_bend", "tail_bend", "tail_pitch")  # what the conditions differ in; the rest of a gait is its legs


@dataclass(frozen=True, slots=True, kw_only=True)
class Claims:
    """Every number that the article does not give, drawn from its plausible range, all at once.

    The numbers are those of ``chosen`` beside the built-in robot and gait, but for the limits of the joints: a limit
    only forbids, and whether a gait is forbidden is counted apart. Each sample is a robot and a gait, run in
    every condition of spine and tail, see ``claim_measures.RUNS``.
    """

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot whose other fields all samples share."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The crawl whose other fields all samples share."""
    samples: int = 2048
    """Number of designs and gaits, best a power of two, as Sobol's sequence asks [-]; about a quarter cannot walk."""
    together: int = 16
    """Number of samples that are simulated together, and lost when the study is killed [-]."""
    coarse: tuple[float, ...] = (0.01, 0.005)
    """Time steps that are tried, the first that agrees with 2 ms is taken; 2 ms if none does [s]."""
    compared: int = 64
    """So many samples are run with 2 ms as well, to see which time step agrees [-]."""
    alike: float = 0.95
    """Share of the compared samples and claims whose truth must be the same [-]."""
    biased: float = 0.05
    """A time step that turns a claim one way so much more often than the other that chance does so less often than
    this is refused too [-]."""
    least: float = 0.05
    """An intact robot with spine and tail that gets no farther cannot lose anything that could be measured [m]."""
    cycles: int = int(CYCLES)
    """Number of cycles that are measured [-]."""
    seed: int = 0
    """Seed of the Sobol sequence's scrambling [-]."""

    def __post_init__(self) -> None:
        """Refuse settings outside their ranges."""
        with Checks("claims", self) as check:
            check.whole("samples", 1, 1_000_000)
            check.whole("together", 1, 1_000)
            check.whole("compared", 1, 100_000)
            check.whole("cycles", 1, 1_000)
            check.whole("seed", 0, 2**32 - 1)
            check.number("alike", 0.0, 1.0, "")
            check.number("biased", 0.0, 1.0, "")

    def study(self, samples: int, timestep: float) -> Study:
        """Return the study of so many samples; a study of more samples begins with the same ones.

        Args:
            samples: number of designs [-].
            timestep: time step of the physics [s].
        """
        rows = [(f"robot.{choice.field}", choice) for choice in ROBOTS.beside("caiman", "chosen", ())]
        rows += [(f"gait.{choice.field}", choice) for choice in GAITS.beside("belly_crawl", "chosen", ())]
        return Study(
            name="claims",
            run=Run(robot=self.robot, gait=self.gait),
            vary=tuple(vary_assumption(path, choice) for path, choice in rows if not only_forbids(path)),
            measure=METRICS,
            design="sobol",
            samples=samples,
            arms=self._arms(),
            seed=self.seed,
            duration=START + self.cycles * self.gait.period,
            timestep=timestep,
            every=5,
            chunk=self.together * len(RUNS),
        )

    def _arms(self) -> tuple[Arm, ...]:
        """Return what each run of a sample sets, after everything that varies."""
        crawl = GAITS["belly_crawl"]
        sets: dict[str, Mapping[str, Any]] = {}
        for name, gait in conditions_of(ROBOTS["caiman"], crawl, GAITS["limbs_only"]).items():
            trunk_fields = {
                field_name: (value_at(gait, field_name), value_at(crawl, field_name)) for field_name in _TRUNK
            }
            sets[name] = {
                f"gait.{field_name}": condition_value
                for field_name, (condition_value, crawl_value) in trunk_fields.items()
                if condition_value != crawl_value
            }
        sets |= {
            f"{name}_{joint}": {**sets[name], "faults": joint_failure(self.robot, self.gait, joint, "limp")}
            for name in FAULTY
            for joint in FAILED_JOINTS
        }
        return tuple(Arm(name=name, values=sets[name]) for name in RUNS)

    def record(self, study: Study, results: xr.Dataset) -> xr.Dataset:
        """Return the results by sample and run, with number and truth of each claim.

        Args:
            study: study of ``Claims.study``.
            results: results of all runs, as ``run_chunk`` describes them.
        """
        names = [v.field for v in study.vary]
        shape = results.sizes["sample"] // len(RUNS), len(RUNS)
        status = np.array([_status(row) for row in results.error.values.reshape(shape)])
        has_walked = np.isin(status, ("walked", "came apart"))[:, None]
        columns = [str(c) for c in results.data_vars if c not in (*names, "seed", "arm", "error")]
        run_columns = {
            c: (("sample", "run"), np.where(has_walked, results[c].values.reshape(shape), np.nan), results[c].attrs)
            for c in columns
        }
        values = np.column_stack([results[name].values[:: len(RUNS)] for name in names])
        record = xr.Dataset(
            run_columns
            | {
                "status": ("sample", status, {"units": "1", "long_name": "what became of it"}),
                "value": (("sample", "parameter"), values, {"units": "1", "long_name": "each in its own unit"}),
            },
            coords={
                "run": list(RUNS),
                "parameter": names,
                "parameter_unit": ("parameter", [unit_at(study.run, name) for name in names]),
            },
        )
        return record.merge(answers(record, self.least)).assign_attrs(
            timestep=study.timestep,
            seed=self.seed,
            cycles=self.cycles,
            agreed="[]",
            made_by=json.dumps(source_versions()),
        )


def conduct_claims(
    claims_study: Claims, folder: str | Path, *, progress: Progress = silent, client: Any = None, jobs: int = 1
) -> xr.Dataset:
    """Find the time step that agrees with the full one, run what is not in the stores yet, and answer.

    Args:
        claims_study: the study.
        folder: folder for its stores, one below it for each time step that is compared and one for the runs.
        progress: told which study runs, and how many of its runs are done.
        client: a ``distributed.Client``, whose workers then run the batches; this process if None.
        jobs: number of processes of this machine, see ``conduct``.

    Returns:
        See ``Claims.record``; attributes say which time step was taken, as JSON how it and the others agreed, and
        what made the runs.

    Raises:
        Unwritable: a store cannot be written to.
        IncompatibleRecord: a store is another study's or another version's, or a rule needs what is not measured.
        NoCluster: the cluster was lost.
    """
    folder = Path(folder)
    empty_measures = measures_of(xr.Dataset(coords={"sample": []}), claims_study.least)
    for rule in swept_rules():  # an hour before it would be found out
        judge_samples(rule, empty_measures)

    def run(samples: int, timestep: float, place: str) -> xr.Dataset:
        """Return the record of the study with so many samples and this time step [s], stored in ``place``."""
        study = replace(claims_study.study(samples, timestep), name=f"claims_{place}")

        def tell(stage: str, share: float) -> None:
            progress(f"{place.replace('_', ' ')}: {stage}", share)

        return claims_study.record(study, conduct(study, folder / place, progress=tell, client=client, jobs=jobs))

    full = run(claims_study.compared, FINE, _comparison_folder(FINE))
    agreed_timestep, agreed = FINE, []
    for timestep in claims_study.coarse:
        comparison = agreement(run(claims_study.compared, timestep, _comparison_folder(timestep)), full)
        agreed.append({"timestep": timestep, **comparison._asdict()})
        if comparison.same >= claims_study.alike and comparison.chance >= claims_study.biased:
            agreed_timestep = timestep
            break
    record = run(claims_study.samples, agreed_timestep, "runs")
    return record.assign_attrs(agreed=json.dumps(agreed), made_by=json.dumps(read_description(folder / "runs")))


def answer_finished(claims_study: Claims, folder: str | Path) -> xr.Dataset:
    """Answer from what ``conduct_claims`` has stored so far, whatever version stored it, and run nothing.

    Args:
        claims_study: the study.
        folder: folder of its stores.

    Returns:
        As of ``conduct_claims``, of as many finished samples as make a power of two.

    Raises:
        UnreadableFile: not even one batch of the runs is finished.
    """
    folder = Path(folder)

    def read_store(place: str) -> tuple[Study, xr.Dataset]:
        """Return a study and the results of its finished samples, as many as the largest power of two."""
        makers = read_description(folder / place, key="fields")
        samples, timestep = int(makers["samples"]), float(makers["timestep"])
        study = claims_study.study(samples, timestep)
        results = finished(study, folder / place)
        count = results.sizes["sample"] // len(RUNS)
        sample_count = 1 << max(count.bit_length() - 1, 0)
        if count == 0 or list(results.arm.values[: len(RUNS)]) != list(RUNS):
            raise UnreadableFile(f"{folder / place} holds no finished runs of this study; start it, or let it go on.")
        return study, results.isel(sample=slice(0, sample_count * len(RUNS)))

    full = claims_study.record(*read_store(_comparison_folder(FINE)))
    agreed = [
        {
            "timestep": timestep,
            **agreement(claims_study.record(*read_store(_comparison_folder(timestep))), full)._asdict(),
        }
        for timestep in claims_study.coarse
        if (folder / _comparison_folder(timestep)).is_dir()
    ]
    record = claims_study.record(*read_store("runs"))
    return record.assign_attrs(agreed=json.dumps(agreed), made_by=json.dumps(read_description(folder / "runs")))


def _comparison_folder(timestep: float) -> str:
    return f"compared_{1000 * timestep:g}ms"


def _status(errors: np.ndarray) -> str:
    """Return what became of a sample: of its runs none may be refused."""
    kinds = {str(error).partition(":")[0] for error in errors if error}
    if "OutsideLimits" in kinds:
        return "outside limits"
    if kinds - {"Diverged"}:
        return "impossible"
    return "came apart" if kinds else "walked"

"""The ready-made study of the article's claims: plausible designs and gaits, intact, limbs only, with joints lost."""

import json
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from suchus.design import Crocodile, unit_at, value_at
from suchus.design.checks import Checks
from suchus.gaits import GAITS
from suchus.land import LOST, Run, lost
from suchus.motion import START, Gait
from suchus.paper import CYCLES
from suchus.robots import ROBOTS
from suchus.study.answers import ARMS, STATES, agreement, answers
from suchus.study.arm import Arm
from suchus.study.conduct import Told, conduct
from suchus.study.study import Study, Vary

TRUNK = ("trunk_bend", "spine_phase", "tail_bend", "tail_phase", "tail_pitch")
"""What the control group holds still; the rest of a gait is its legs."""
FINE = 0.002  # [s]; the time step of results
_PER_SAMPLE = len(ARMS) * len(STATES)

Progress = Callable[[str, Told], None]
"""Called with which of the studies runs, and how far it is."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Claims:
    """Every number that the article does not give, drawn from its plausible range, all at once.

    The numbers are those of ``chosen`` beside the robot and the gait on the shelf, but for the limits of the joints: a
    limit only forbids, and whether a gait is forbidden is told apart.
    """

    robot: Crocodile = field(default_factory=lambda: ROBOTS["caiman"])
    """Whose other fields all samples share."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The crawl whose other fields all samples share."""
    control: Gait = field(default_factory=lambda: GAITS["limbs_only"])
    """What trunk and tail do in the control group."""
    samples: int = 2048
    """How many designs and gaits [-]; each makes ten runs, about a quarter cannot walk."""
    together: int = 32
    """How many samples are simulated together, and lost when the study is killed [-]."""
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
    """How many cycles are measured [-]."""
    seed: int = 0
    """Of the Sobol sequence's scrambling."""

    def __post_init__(self) -> None:
        with Checks("claims", self) as check:
            check.whole("samples", 1, 1_000_000)
            check.whole("together", 1, 1_000)
            check.whole("compared", 1, 100_000)
            check.whole("cycles", 1, 1_000)
            check.whole("seed", 0, 2**32 - 1)
            check.number("alike", 0.0, 1.0, "")
            check.number("biased", 0.0, 1.0, "")

    def study(self, samples: int, timestep: float) -> Study:
        """Return the study of so many samples; the first ones stay the same, however many."""
        rows = [(f"robot.{one.field}", one) for one in ROBOTS.beside("caiman", "chosen", ())]
        rows += [(f"gait.{one.field}", one) for one in GAITS.beside("belly_crawl", "chosen", ())]
        vary = tuple(Vary(field=path, low=one.low, high=one.high) for path, one in rows if "_range[" not in path)
        broken = ((), *(lost(self.robot, self.gait, joint, "limp") for joint in LOST))
        held = {f"gait.{name}": value_at(self.control, name) for name in TRUNK}
        return Study(
            name="claims",
            run=Run(robot=self.robot, gait=self.gait),
            vary=(*vary, Vary(field="faults", values=broken, each=True)),
            measure=("displacement", "height_std"),
            design="sobol",
            samples=samples,
            arms=(Arm(name=ARMS[0]), Arm(name=ARMS[1], values=held)),
            seed=self.seed,
            duration=START + self.cycles * self.gait.period,
            timestep=timestep,
            every=10,
            chunk=self.together * _PER_SAMPLE,
        )

    def record(self, study: Study, results: xr.Dataset) -> xr.Dataset:
        """Return the results by sample, arm and state, with what became of each claim."""
        names = [v.field for v in study.vary if not v.each]
        shape = results.sizes["sample"] // _PER_SAMPLE, len(ARMS), len(STATES)
        errors = results.error.values.reshape(shape[0], -1)
        status = np.array([_status(row) for row in errors])
        walked = np.isin(status, ("walked", "came apart"))[:, None, None]
        way, height = (
            np.where(walked, results[name].values.reshape(shape), np.nan) if name in results else np.full(shape, np.nan)
            for name in ("displacement_x", "height_std")
        )
        values = np.column_stack([results[name].values[::_PER_SAMPLE] for name in names])
        told = xr.Dataset(
            {
                "forward": (("sample", "arm", "state"), way, {"units": "m", "long_name": "displacement forward"}),
                "std": (("sample", "arm", "state"), height, {"units": "m", "long_name": "of the height of the mass"}),
                "status": ("sample", status, {"units": "1", "long_name": "what became of it"}),
                "value": (("sample", "parameter"), values, {"units": "1", "long_name": "each in its own unit"}),
            },
            coords={
                "arm": list(ARMS),
                "state": list(STATES),
                "parameter": names,
                "parameter_unit": ("parameter", [unit_at(study.run, name) for name in names]),
            },
        )
        return told.merge(answers(told, self.least))


def conduct_claims(asked: Claims, folder: Path, *, progress: Progress | None = None, client: Any = None) -> xr.Dataset:
    """Find the time step that agrees with the full one, run what is not in the stores yet, and answer.

    Args:
        asked: the study.
        folder: for its stores, one below it for each time step that is compared and one for the runs.
        progress: told which study runs, and how far it is.
        client: a ``distributed.Client``, whose workers then run the batches; this process if None.

    Returns:
        See ``answers.answers``; attributes say which time step was taken, and as JSON how it and the others agreed.

    Raises:
        Unwritable: a store cannot be written to.
        IncompatibleRecord: a store is another study's or another version's.
        NoCluster: the cluster was lost.
    """

    def run(samples: int, timestep: float, place: str) -> xr.Dataset:
        study = replace(asked.study(samples, timestep), name=f"claims_{place}")
        shown = None if progress is None else (lambda told: progress(place, told))
        results = conduct(study, folder / place, progress=shown, client=client)
        return asked.record(study, results)

    full = run(asked.compared, FINE, "compared_2ms")
    taken, agreed = FINE, []
    for timestep in asked.coarse:
        found = agreement(run(asked.compared, timestep, f"compared_{1000 * timestep:g}ms"), full)
        agreed.append({"timestep": timestep, **found._asdict()})
        if found.same >= asked.alike and found.chance >= asked.biased:
            taken = timestep
            break
    record = run(asked.samples, taken, "runs")
    return record.assign_attrs(timestep=taken, agreed=json.dumps(agreed))


def _status(errors: np.ndarray) -> str:
    """Return what became of a sample: of its ten runs none may be refused."""
    kinds = {str(error).partition(":")[0] for error in errors if error}
    if "OutsideLimits" in kinds:
        return "outside limits"
    if kinds - {"Diverged"}:
        return "impossible"
    return "came apart" if kinds else "walked"

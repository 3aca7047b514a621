"""Do the article's statements survive other choices of what it does not say?"""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from math import log2
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from scipy.stats import qmc

from suchus.design import Chosen, Crocodile, unit_at, with_values
from suchus.design.checks import require
from suchus.errors import InvalidDesign, OutsideLimits
from suchus.experiment import Experiment, Measure, Outcome, Progress, silent, staged, stopwatch
from suchus.figures.sensitivity import draw_claim
from suchus.gaits import GAITS
from suchus.land import LOST, Run, lost, simulate
from suchus.land.lost import Kind, Legs
from suchus.metrics import displacement, height_std
from suchus.motion import START, Gait, check_limits
from suchus.paper import CLAIMS, CYCLES
from suchus.record import Parts, check_writable
from suchus.robots import ROBOTS
from suchus.study.answers import ARMS, STATES, answers
from suchus.study.claims import TRUNK

_MADE_BY = (
    *("design", "robots", "gaits", "kinematics", "motion", "control", "model", "land", "metrics", "record"),
    "experiments/sensitivity.py",
    "study/answers.py",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Sensitivity(Experiment):
    """Every number that the article does not give, swept over its plausible range at once.

    The numbers are those of ``chosen`` beside the robot and the gait on the shelf, but for the limits of the joints: a
    limit only forbids, and whether a gait is forbidden is told apart. The points are a scrambled Sobol sequence. Each
    sample is a robot and a gait that walk with spine and tail and with limbs only, intact and with each of four joints
    lost. A sample that cannot be built, whose gait its joints cannot follow, or whose physics came apart, is counted.
    """

    title = "Do the article's statements survive other choices of what it does not say?"
    shows = "Section IV, Figs 15 to 21"
    in_reproduce = False
    decides = (
        "The gait decides, the machine hardly does: stroke of the legs, bend and phase of the trunk, lift and hip "
        "height lead the lists, while servos, friction, sizes and masses other than the tail's stay near chance. That "
        "spine and tail lengthen the way holds nearly everywhere. That they make the robot bear lost joints better is "
        "close to a toss of a coin, once each arm is measured against its own intact robot."
    )

    robot: Crocodile = field(default_factory=lambda: ROBOTS["caiman"])
    """Whose other fields all samples share."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The crawl whose other fields all samples share."""
    control: Gait = field(default_factory=lambda: GAITS["limbs_only"])
    """What trunk and tail do in the control group."""
    samples: int = 1024
    """How many designs and gaits, a power of two, as Sobol's sequence asks [-]; about a quarter cannot walk."""
    chunk: int = 32
    """How many samples are simulated at once, and kept as one part [-]."""
    cycles: int = int(CYCLES)
    """How many cycles are measured [-]."""
    kind: Kind = "limp"
    """How a joint is lost; see ``joint_faults``."""
    legs: Legs = "one"
    """In how many legs."""
    timestep: float = 0.01
    """Of the physics [s]; ``halved`` shows what it costs."""
    halved: int = 32
    """So many samples are repeated with half the time step [-]."""
    least: float = 0.05
    """An intact robot with spine and tail that gets no farther cannot lose anything that could be measured [m]."""
    parts: Path | None = Path("~/.cache/suchus/parts")
    """Folder that keeps finished parts, so that an interrupted run goes on where it stopped; None keeps nothing."""
    seed: int = 0
    """Of the sequence's scrambling."""

    def __post_init__(self) -> None:
        for name, least in (("samples", 2), ("chunk", 1), ("cycles", 1), ("halved", 0)):
            require("sensitivity", name, getattr(self, name), least, 2**20, "")
        if log2(self.samples) % 1:
            near = 2 ** round(log2(self.samples))
            raise InvalidDesign(f"sensitivity.samples is {self.samples}; a power of two is needed, such as {near}.")

    def quick(self) -> "Sensitivity":
        """Eight samples, one cycle; nothing is kept."""
        return replace(self, samples=8, chunk=4, cycles=1, halved=1, parts=None)

    def run(self, progress: Progress = silent) -> Outcome:
        """Sweep."""
        with stopwatch() as seconds:
            record = self._swept(progress)
            record = record.merge(answers(record, self.least))
            return Outcome(
                experiment=self.name(),
                measures=_measures(record),
                verdicts=(),
                record=record,
                settings=self.settings(),
                tables={"sensitivity.csv": _table(record)},
                seconds=seconds(),
            )

    def _chosen(self) -> tuple[tuple[Chosen, ...], tuple[Chosen, ...]]:
        """Return what is free about the robot and about the gait."""
        of_robot = ROBOTS.beside("caiman", "chosen", ())
        return tuple(one for one in of_robot if "_range[" not in one.field), GAITS.beside("belly_crawl", "chosen", ())

    def _points(self, free: Sequence[Chosen]) -> np.ndarray:
        """Return the value of every free number in every sample, (sample, parameter); more samples only add to them."""
        low, high = (np.array([getattr(one, end) for one in free]) for end in ("low", "high"))
        shares = qmc.Sobol(len(free), rng=self.seed).random_base2(round(log2(self.samples)))
        return np.asarray(low + (high - low) * shares)

    def _swept(self, progress: Progress) -> xr.Dataset:
        """Simulate every sample, part by part, and some of them again with half the time step."""
        of_robot, of_gait = self._chosen()
        points = self._points((*of_robot, *of_gait))
        if self.parts is not None:
            check_writable(self.parts.expanduser())
        asked = {name: value for name, value in self.settings().items() if name not in ("parts", "samples", "halved")}
        kept = Parts(self.parts, asked, _MADE_BY)
        jobs = [(at, self.timestep) for at in _spans(self.samples, self.chunk)]
        jobs += [(at, self.timestep / 2) for at in _spans(min(self.halved, self.samples), self.chunk)]
        done: dict[float, list[xr.Dataset]] = {self.timestep: [], self.timestep / 2: []}
        for number, (at, timestep) in enumerate(jobs):
            told = staged(
                progress, f"samples {at.start + 1} to {at.stop}", number / len(jobs), (number + 1) / len(jobs)
            )
            make = partial(self._walked, points[at], timestep, told)
            done[timestep].append(kept.get(f"{at.start}_{at.stop}_{1e6 * timestep:.0f}us", make))
            told(1.0)
        record = xr.concat(done[self.timestep], "sample")
        if self.halved:
            again = xr.concat(done[self.timestep / 2], "sample").drop_vars("status")
            fine = {str(v): f"fine_{v}" for v in again.data_vars} | {"sample": "repeated"}
            record = record.merge(again.rename(fine))
        record["value"] = (("sample", "parameter"), points, {"units": "1", "long_name": "each in its own unit"})
        names = [f"robot.{one.field}" for one in of_robot] + [f"gait.{one.field}" for one in of_gait]
        units = [unit_at(self.robot, one.field) for one in of_robot]
        units += [unit_at(self.gait, one.field) for one in of_gait]
        return record.assign_coords(parameter=names, parameter_unit=("parameter", units))

    def _walked(self, points: np.ndarray, timestep: float, progress: Callable[[float], None]) -> xr.Dataset:
        """Let some samples walk."""
        status, runs, walking = [], [], []
        for i, point in enumerate(points):
            try:
                runs += self._runs(point)
                walking.append(i)
                status.append("walked")
            except OutsideLimits:
                status.append("outside limits")
            except InvalidDesign:
                status.append("impossible")
        forward, std = (np.full((len(points), len(ARMS), len(STATES)), np.nan) for _ in range(2))
        if runs:
            duration = START + self.cycles * self.gait.period
            record = simulate(runs, duration=duration, timestep=timestep, every=10, progress=progress)
            shape = (len(walking), *forward.shape[1:])
            forward[walking] = displacement(record).sel(xyz="x").values.reshape(shape)
            std[walking] = height_std(record).values.reshape(shape)
            for i, broken in zip(
                walking, (record.cause.values.reshape(len(walking), -1) != "").any(axis=1), strict=True
            ):
                status[i] = "came apart" if broken else "walked"
        return xr.Dataset(
            {
                "forward": (("sample", "arm", "state"), forward, {"units": "m", "long_name": "displacement forward"}),
                "std": (("sample", "arm", "state"), std, {"units": "m", "long_name": "of the height of the mass"}),
                "status": ("sample", np.array(status), {"units": "1", "long_name": "what became of it"}),
            },
            coords={"arm": list(ARMS), "state": list(STATES)},
        )

    def _runs(self, point: np.ndarray) -> list[Run]:
        """Return the runs of one sample.

        Raises:
            InvalidDesign: such a robot or gait cannot be.
            OutsideLimits: the robot's joints cannot follow the gait.
        """
        of_robot, of_gait = self._chosen()
        values = [float(value) for value in point]
        robot = with_values(self.robot, {one.field: v for one, v in zip(of_robot, values, strict=False)})
        gait = with_values(self.gait, {one.field: v for one, v in zip(of_gait, values[len(of_robot) :], strict=True)})
        limbs = replace(gait, name=self.control.name, **{name: getattr(self.control, name) for name in TRUNK})
        for each in (gait, limbs):
            check_limits(robot, each)
        return [
            Run(robot=robot, gait=each, faults=faults)
            for each in (gait, limbs)
            for faults in ((), *(lost(robot, each, joint, self.kind, self.legs) for joint in LOST))
        ]

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw one picture per claim."""
        return {f"sensitivity_{key}": draw_claim(outcome.record, str(key)) for key in outcome.record.claim.values}


def _spans(whole: int, part: int) -> list[slice]:
    return [slice(start, min(start + part, whole)) for start in range(0, whole, part)]


def _measures(record: xr.Dataset) -> Mapping[str, Measure]:
    count = Counter(record.status.values.tolist())
    measures = {
        f"samples_{name.replace(' ', '_')}": Measure(count[name], "-")
        for name in ("walked", "outside limits", "impossible", "came apart")
    }
    for key in record.claim.values:
        told = record.sel(claim=key)
        there, claim = np.isfinite(told.number), CLAIMS[str(key)]
        measures[f"share_{key}"] = Measure(float(told.holds.where(there).mean()), "-")
        measures[f"told_{key}"] = Measure(int(there.sum()), "-")
        measures[f"median_{key}"] = Measure(float(told.number.median()), claim.unit)
        if claim.value is not None:
            near = abs(told.number - claim.value) <= claim.tolerance
            measures[f"printed_share_{key}"] = Measure(float(near.where(there).mean()), "-")
        measures[f"separation_{key}"] = Measure(float(told.border_separation), "-")
    if "fine_forward" in record:
        first = record.isel(sample=slice(0, record.sizes["repeated"]))
        off = abs(first.forward.values - record.fine_forward.values)
        both = np.isfinite(first.number.values) & np.isfinite(record.fine_number.values)
        turned = (first.holds.values != record.fine_holds.values)[both]
        measures["halving_median"] = Measure(float(np.nanmedian(off)) if np.isfinite(off).any() else np.nan, "m")
        measures["halving_turns"] = Measure(float(turned.mean()) if turned.size else np.nan, "-")
    return measures


def _table(record: xr.Dataset) -> str:
    """Return one row per claim: how often it is true, what its number follows, where its border is."""
    rows = ["claim,samples,true_share,median,low_5,high_95,border_parameter,border_at,true_side,separation,follows"]
    for key in record.claim.values:
        told = record.sel(claim=key)
        number = told.number.values[np.isfinite(told.number.values)]
        order = np.argsort(-abs(told.correlation.values))[:4]
        follows = " ".join(f"{record.parameter.values[i]}:{told.correlation.values[i]:+.2f}" for i in order)
        low, middle, high = np.quantile(number, (0.05, 0.5, 0.95)) if number.size else (np.nan,) * 3
        at, side = int(told.border_of), "above" if told.border_above else "below"
        name = str(record.parameter.values[at]) if at >= 0 else ""
        share = float(told.holds.values[np.isfinite(told.number.values)].mean()) if number.size else np.nan
        rows.append(
            f"{key},{number.size},{share:.3f},{middle:.4g},{low:.4g},{high:.4g},{name},{float(told.border_at):.4g},"
            f"{side if name else ''},{float(told.border_separation):.2f},{follows}"
        )
    return "\n".join(rows) + "\n"


experiment = Sensitivity()

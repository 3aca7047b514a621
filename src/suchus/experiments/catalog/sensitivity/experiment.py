"""Do the article's statements survive other choices of what it does not say?"""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import log2
from typing import Any, ClassVar

import numpy as np
import xarray as xr
from scipy import stats

from suchus.article.paper import CLAIMS, CYCLES
from suchus.article.verdict import SHARES
from suchus.article.verdict.judging import ROBUST, Share
from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign
from suchus.experiments.experiment import Experiment, Measure, Measures, Outcome, Progress, SimulationResult, silent
from suchus.experiments.study import Claims, conducted
from suchus.experiments.study.answers import share_interval
from suchus.experiments.study.claims_table import border_texts, claim_row, table
from suchus.robot.design import Robot
from suchus.robot.design.scale import control_period
from suchus.robot.gaits import GAITS
from suchus.robot.motion import Gait
from suchus.robot.robots import ROBOTS
from suchus.visual.figures.sensitivity import draw_shares, parameter_label

_MIN_CHANCE = 0.01  # how seldom chance alone may say that this run and the shipped table differ [-]
_COUNTS = {
    name: f"samples_{name.replace(' ', '_')}" for name in ("walked", "outside limits", "impossible", "came apart")
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Sensitivity(Experiment):
    """Every number that the article does not give, drawn from its plausible range at once.

    The first samples of ``suchus study claims``, which answers the same with 2 048 of them: the same points, runs and
    rules. Its shares of designs, which every verdict quotes, ship with suchus; this shows whether they still come out.
    """

    title = "Do the article's statements survive other choices of what it does not say?"
    shows = "Section IV, Figs 12 to 21"
    answers = ("samples_walked", "samples_impossible")
    reproduces: ClassVar[bool] = False
    needs = ("tables", "article_spine", "cable_tail")
    answer_minima: ClassVar[Mapping[str, float]] = {"samples": 16, "cycles": 2}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot whose other fields all samples share."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The crawl whose other fields all samples share."""
    samples: int = 16
    """Number of designs and gaits, a power of two, as Sobol's sequence asks [-]; about a quarter cannot walk."""
    cycles: int = int(CYCLES)
    """Number of cycles that are measured [-]."""
    timestep: float = 0.005
    """Time step of the physics [s]; that of the shipped table, which says how it agrees with 2 ms."""
    seed: int = 0
    """Seed of the sequence's scrambling [-]."""

    def __post_init__(self) -> None:
        """Refuse settings outside their ranges, and a number of samples that is no power of two."""
        with Checks(self.name(), self) as check:
            check.whole("samples", 2, 2**20)
            check.whole("cycles", 1, 1000)
            check.whole("seed", 0, 2**32 - 1)
            check.number("timestep", 1e-5, control_period(self.robot), "s")
        if log2(self.samples) % 1:
            nearest_power = 2 ** round(log2(self.samples))
            raise InvalidDesign(
                f"sensitivity.samples is {self.samples}; a power of two is needed, such as {nearest_power}."
            )

    def quick(self) -> "Sensitivity":
        """Four samples, of which one cannot walk, one cycle, a coarser time step."""
        return replace(self, samples=4, cycles=1, timestep=0.01)

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Run every sample in every condition, and judge each by the rules of the verdicts."""
        claims = Claims(robot=self.robot, gait=self.gait, samples=self.samples, cycles=self.cycles, seed=self.seed)
        study = claims.study(self.samples, self.timestep)
        record = claims.record(study, conducted(study, progress))
        record.attrs["shipped"] = int(self.comparable())
        return SimulationResult(record=record, tables={"sensitivity.csv": table(_rows(record))})

    def comparable(self) -> bool:
        """Whether the shipped table asks the same of the same robots and gaits."""
        reduced = replace(self, samples=2, seed=0)
        return reduced == replace(Sensitivity(), samples=2, seed=0)

    def measure(self, record: xr.Dataset) -> Measures:
        """Return what became of the samples, the share in which each claim holds, and how it agrees with the table."""
        count = Counter(record.status.values.tolist())
        measures = Measures({measure: Measure(count[name], "-") for name, measure in _COUNTS.items()})
        chances = []
        for key in (str(claim) for claim in record.claim.values):
            of_claim = record.sel(claim=key)
            is_answered = np.isfinite(of_claim.number.values)
            judged_count, hold_count = int(is_answered.sum()), int(of_claim.holds.values[is_answered].sum())
            lower_bound, upper_bound = share_interval(hold_count, judged_count)
            median = float(np.median(of_claim.number.values[is_answered])) if judged_count else float("nan")
            measures |= {
                f"share_{key}": Measure(hold_count / judged_count if judged_count else float("nan"), "-"),
                f"share_{key}_low": Measure(lower_bound, "-"),
                f"share_{key}_high": Measure(upper_bound, "-"),
                f"judged_{key}": Measure(judged_count, "-"),
                f"median_{key}": Measure(median, CLAIMS[key].unit),
            }
            if record.attrs["shipped"] and key in SHARES:
                chances.append(_chance(hold_count, judged_count, SHARES[key]))
        agreement_chance = min(1.0, len(chances) * min(chances)) if chances else float("nan")
        return measures | {
            "compared_with_shipped": Measure(len(chances), "-"),
            "shipped_agreement_chance": Measure(agreement_chance, "-"),
        }

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say which claims nearly all designs agree on, and whether the shipped table holds."""
        counts = {name.removeprefix("judged_"): count for name, count in measures.items() if name.startswith("judged_")}
        judged_claims = [key for key, count in counts.items() if count > 0]
        hold = [key for key in judged_claims if measures[f"share_{key}"] >= ROBUST]
        fail = [key for key in judged_claims if 1.0 - measures[f"share_{key}"] >= ROBUST]
        depend = [key for key in judged_claims if key not in (*hold, *fail)]
        claim_groups = {"hold": hold, "fail": fail, "depend": depend, "judged": judged_claims}
        return self.render_explanation(
            measures,
            designs=sum(measures[name] for name in _COUNTS.values()),
            alarm=_MIN_CHANCE,
            **{name: [_counted(key, measures) for key in keys] for name, keys in claim_groups.items()},
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the share of every claim beside that of the shipped table."""
        rows, record = _rows(outcome.record), outcome.record
        units = dict(zip(record.parameter.values.tolist(), record.parameter_unit.values.tolist(), strict=True))
        if not record.attrs["shipped"] or not SHARES:
            return {"sensitivity_shares": draw_shares(rows, border_texts(rows))}
        words = {
            key: f"{parameter_label(share.turned_by)} {'above' if share.above else 'below'} {share.at:.3g} "
            f"{units[share.turned_by]}"
            for key, share in SHARES.items()
            if share.turned_by in units and share.at is not None and max(share.share, 1 - share.share) < ROBUST
        }
        shipped = {key: (share.share, share.low, share.high) for key, share in SHARES.items()}
        return {"sensitivity_shares": draw_shares(rows, words, shipped)}


def _counted(key: str, measures: Mapping[str, float]) -> str:
    """Return the words of a claim with the number of designs in which it holds, of those that judge it."""
    judged_count = measures[f"judged_{key}"]
    hold_count = measures[f"share_{key}"] * judged_count
    return f"{key.replace('_', ' ')}: {hold_count:.0f} of {judged_count:.0f}"


def _rows(record: xr.Dataset) -> list[dict[str, Any]]:
    return [claim_row(record, str(claim)) for claim in record.claim.values]


def _chance(hold_count: int, judged_count: int, shipped: Share) -> float:
    """Return how likely chance alone makes two samples of designs differ so much, by Fisher's exact test [-]."""
    shipped_hold_count = round(shipped.share * shipped.designs)
    counts = np.array(
        [[hold_count, judged_count - hold_count], [shipped_hold_count, shipped.designs - shipped_hold_count]]
    )
    return float(stats.fisher_exact(counts).pvalue)


experiment = Sensitivity()

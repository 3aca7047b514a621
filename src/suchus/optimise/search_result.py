"""What a search found: everything it tried, the front, the best, and what was checked about them."""

from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from suchus.design import value_at, with_values
from suchus.land import Run
from suchus.optimise.score import ACTIVE, allowed, losses, over, units
from suchus.optimise.search import library, reference_of
from suchus.optimise.spec import Optimisation

_SHOWN = 3  # points of a front whose gaits are written and checked: both ends and the middle


@dataclass(frozen=True, slots=True, kw_only=True)
class SearchResult:
    """The result of the search in one condition."""

    spec: Optimisation
    """The search, of this condition alone."""
    start: xr.Dataset
    """Where it started, as ``evaluate`` returns it."""
    history: xr.Dataset
    """All candidates in order, the start first, with ``generation`` and ``score``."""
    checks: xr.Dataset | None = None
    """The best under other conditions; see ``checks.checked``."""
    near: xr.Dataset | None = None
    """Around the best; see ``checks.around``."""

    @property
    def arm(self) -> str:
        """Name of the condition."""
        return self.spec.arms[0].name

    @property
    def front(self) -> list[int]:
        """The candidates that no other allowed one betters in both aims, by the first aim."""
        return front_of(self.spec, self.history, units(self.spec, self.start))

    @property
    def chosen(self) -> list[int]:
        """The best candidate; of a front both ends and the middle; empty if none keeps all limits."""
        if self.spec.pareto:
            front = self.front
            picked = [round(i * (len(front) - 1) / (_SHOWN - 1)) for i in range(_SHOWN)] if front else []
            return [front[i] for i in dict.fromkeys(picked)]
        kept = np.flatnonzero(allowed(self.spec, self.history))
        return [int(kept[self.history.score.values[kept].argmin()])] if kept.size else []

    @property
    def shares(self) -> list[np.ndarray]:
        """Where the fields of the chosen lie in their ranges, each of shape (field,) [-]."""
        return [self.history.share.values[i] for i in self.chosen]

    @property
    def names(self) -> list[str]:
        """What the chosen are called: the arm, numbered where there are several."""
        several = len(self.chosen) > 1
        return [f"{self.arm}_{i + 1}" if several else self.arm for i in range(len(self.chosen))]

    @property
    def runs(self) -> list[Run]:
        """The chosen, their gaits called after search and condition."""
        return [
            titled(self.spec, self.spec.candidate(dict(zip(self.fields, share.tolist(), strict=True))), name)
            for share, name in zip(self.shares, self.names, strict=True)
        ]

    @property
    def fields(self) -> list[str]:
        """Dotted paths of the fields that varied."""
        return [v.field for v in self.spec.vary]

    def values(self, which: int) -> dict[str, tuple[float, float]]:
        """Return by field what the start has and what a chosen one has."""
        run = self.runs[which]
        return {f: (float(value_at(self.spec.run, f)), float(value_at(run, f))) for f in self.fields}

    def active(self, which: int) -> dict[str, tuple[float, float, bool]]:
        """Return by limit its value, what a chosen one has, and whether the limit is what stops it."""
        limits = {}
        for limit in self.spec.limits:
            has = float(self.history[f"limit_{limit.name}"][self.chosen[which]])
            limits[limit.name] = (limit.value, has, bool(over(limit, np.array([has]))[0] > -ACTIVE))
        return limits

    def best_so_far(self) -> np.ndarray:
        """Return after each candidate the value of the first aim of the best so far, NaN before there is one."""
        kept = allowed(self.spec, self.history)
        score = np.where(kept, self.history.score.values, np.inf)
        at = np.array([int(score[: i + 1].argmin()) for i in range(len(score))])
        values = self.history[f"aim_{self.spec.aims[0].name}"].values[at]
        return np.where(np.isfinite(score[at]), values, np.nan)

    def covered(self) -> np.ndarray:
        """Return after each generation the area that the front covers, in parts of the start's aims."""
        table, parts = self.history, units(self.spec, self.start)
        loss, kept = losses(self.spec, table, parts), allowed(self.spec, table)
        archive, areas = library("moarchiving").get_mo_archive([], reference_point=reference_of(self.spec), n_obj=2), []
        for number in range(int(table.generation.max()) + 1):
            for i in np.flatnonzero((table.generation.values == number) & kept):
                archive.add(loss[i].tolist())
            areas.append(float(archive.hypervolume))
        return np.array(areas)

    def with_checks(self, checks: xr.Dataset, near: xr.Dataset) -> "SearchResult":
        """Return the same with what was checked."""
        return replace(self, checks=checks, near=near)


def titled(spec: Optimisation, run: Run, name: str) -> Run:
    """Return a run whose gait, and robot if it varies, is called after search and condition."""
    called = f"{spec.name}_{name}"
    varied = any(v.field.startswith("robot.") for v in spec.vary)
    robot = with_values(run.robot, {"name": called}) if varied else run.robot
    return replace(run, gait=replace(run.gait, name=called), robot=robot, label=name)


def front_of(spec: Optimisation, table: xr.Dataset, parts: np.ndarray) -> list[int]:
    """Return the allowed candidates that no other betters in both aims, by the first aim; all aims of a sum as one."""
    kept = [int(i) for i in np.flatnonzero(allowed(spec, table))]
    if not kept or len(spec.aims) != 2:
        return []
    points = losses(spec, table, parts)[kept]
    archive = library("moarchiving").get_mo_archive(
        points.tolist(), reference_point=reference_of(spec), infos=kept, n_obj=2
    )
    return [int(i) for i in archive.infos]

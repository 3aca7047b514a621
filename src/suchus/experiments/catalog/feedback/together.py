"""Parts of the experiment, simulated in one batch where they last equally long: its time grows with control periods."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from jaxtyping import Bool

from suchus.experiments.catalog.feedback.known import KnownStarts
from suchus.experiments.experiment import Progress, staged
from suchus.robot.design.scale import coarse_step
from suchus.robot.motion import START
from suchus.sim.land import Run, simulate


class Part(NamedTuple):
    """Runs of one gait that last equally long."""

    runs: Sequence[Run]
    """The runs."""
    cycles: int
    """Simulated duration after the first second [cycle]."""
    is_shown: Bool[np.ndarray, " run"]
    """Whether each run lasts until the end; a start of the others may end as soon as it is known."""


def simulate_parts(parts: Sequence[Part], progress: Progress, *, known_after: float | None = None) -> list[xr.Dataset]:
    """Simulate the runs of some parts, and return the record of each part.

    A run has the same bytes whichever runs are beside it.

    Args:
        parts: the parts; all runs have one gait.
        progress: callback that gets the finished fraction.
        known_after: least duration in step until the end of a start that converges, where starts end as soon as it is
            known whether they do, see ``KnownStarts``; None: every run lasts until the end [cycle].
    """
    records: dict[int, xr.Dataset] = {}
    durations = sorted({part.cycles for part in parts})
    costs = [cycles * sum(len(part.runs) for part in parts if part.cycles == cycles) for cycles in durations]
    spent = np.concatenate([[0.0], np.cumsum(costs)]) / max(sum(costs), 1)
    for number, cycles in enumerate(durations):
        members = [i for i, part in enumerate(parts) if part.cycles == cycles]
        runs = [run for i in members for run in parts[i].runs]
        gait, is_shown = runs[0].gait, np.concatenate([parts[i].is_shown for i in members])
        record = simulate(
            runs,
            duration=START + cycles * gait.period,
            timestep=coarse_step(runs[0].robot),
            sample_stride=10,
            effort=False,
            ends=None if known_after is None else KnownStarts(gait, cycles, known_after, is_shown=is_shown),
            progress=staged(progress, "", spent[number], spent[number + 1]),
        )
        firsts = np.concatenate([[0], np.cumsum([len(parts[i].runs) for i in members])])
        for i, first, end in zip(members, firsts[:-1], firsts[1:], strict=True):
            records[i] = record.isel(run=slice(first, end))
    return [records[i] for i in range(len(parts))]

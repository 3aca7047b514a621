"""The waters of a batch of runs: what each is, how it changes, and what it does."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from jaxtyping import Float

from suchus import hydro
from suchus.design import GRAVITY
from suchus.design.ground import Ground
from suchus.land.lake import Lake
from suchus.land.run import Run


class Waters:
    """The numbers of the water of every run, in the memory that the physics reads and writes.

    Args:
        runs: of the batch, on dry land or in water.
        physics: the ``mujoco.batch.Batch``.
    """

    def __init__(self, runs: Sequence[Run], physics: Any) -> None:
        self._lakes = {sim: run.lake for sim, run in enumerate(runs) if run.lake is not None}
        self._changing = {sim: lake for sim, lake in self._lakes.items() if lake.changes()}
        self._ups = np.array([up(run.ground) for run in runs])
        self.rows: Float[np.ndarray, "run number"] = (
            physics.bind("userdata") if self._lakes else np.zeros((len(runs), 0))
        )
        """See ``hydro.table``; without columns where all is dry."""
        for sim in self._lakes:
            self.refill(sim)

    def __bool__(self) -> bool:
        return bool(self._lakes)

    def flood(self, time: float, breath: Float[np.ndarray, "run chamber"] | None = None) -> None:
        """Let level and breath of the lakes be what they are at a time, where they change or are commanded.

        Args:
            time: [s].
            breath: what controllers command of front and rear chambers, NaN where they leave it to the lake [-]; None
                for all.
        """
        for sim, lake in self._changing.items():
            self.rows[sim, hydro.LEVEL], self.rows[sim, _BREATH] = lake.at(time)
        if breath is not None and self._lakes:
            asked = np.isfinite(breath).all(axis=1)
            self.rows[asked, _BREATH] = breath[asked]

    def fill(self, sim: int, lake: Lake, time: float) -> None:
        """Let the water of a run be another one from now on; what the water did last stays to be read.

        Args:
            sim: a run that has a lake.
            lake: the other one.
            time: [s].
        """
        self._lakes[sim] = lake
        self._changing = {one: lake for one, lake in self._lakes.items() if lake.changes()}
        self.rows[sim, : hydro.FORCE] = lake.numbers(self._ups[sim], time)[: hydro.FORCE]

    def refill(self, sim: int) -> None:
        """Write the water of a run anew, as it is at the beginning; a reset of the physics drains it."""
        if sim in self._lakes:
            self.rows[sim] = self._lakes[sim].numbers(self._ups[sim])

    def tilt(self, sim: int, ground: Ground) -> None:
        """Let the ground of a run slope otherwise from now on; the level stays level."""
        if sim in self._lakes:
            self._ups[sim] = up(ground)

    def depths(self, roots: Float[np.ndarray, "run 3"]) -> Float[np.ndarray, " run"] | None:
        """Return how deep the roots are below the level of their water, 0 above it [m]; None if all is dry.

        Args:
            roots: their places in the world [m].
        """
        if not self._lakes:
            return None
        height = np.einsum("ij,ij->i", roots, self._ups)
        return np.asarray(np.maximum(self.rows[:, hydro.LEVEL] - height, 0.0))

    def acts(self) -> Float[np.ndarray, "run 4"]:
        """Return force [N] and power [W] of the water, as the physics left them; a view."""
        return self.rows[:, hydro.FORCE : hydro.FORCE + 4]


def up(ground: Ground) -> Float[np.ndarray, "3"]:
    """Return the direction against gravity in the frame of a tilted ground, a unit vector."""
    return -gravity(ground) / GRAVITY


def gravity(ground: Ground) -> Float[np.ndarray, "3"]:
    """Return gravity in the frame of a tilted ground [m/s2]."""
    down = np.array([-np.sin(ground.uphill), 0.0, -np.cos(ground.uphill)])
    c, s = np.cos(ground.sideways), np.sin(ground.sideways)
    return GRAVITY * np.array([down[0], down[2] * s, down[2] * c])


_BREATH = slice(hydro.BREATH, hydro.BREATH + 2)

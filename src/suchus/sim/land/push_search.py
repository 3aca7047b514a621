"""The smallest push that topples: a scan of forces, then a finer one below the first that does."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr
from jaxtyping import Bool, Float

from suchus.core.errors import InvalidDesign
from suchus.core.progress import Progress, silent, staged
from suchus.sim.land.run import Push, Run
from suchus.sim.land.simulation import simulate


def smallest_pushes(
    runs: Sequence[Run],
    directions: Sequence[tuple[float, float, float]],
    *,
    start_time: float,
    levels: Sequence[float],
    has_fallen: Callable[[xr.Dataset], xr.DataArray],
    refinement_count: int = 4,
    duration: float = 0.2,
    body: str = "thorax",
    wait: float = 3.0,
    timestep: float = 0.005,
    progress: Progress = silent,
) -> Float[np.ndarray, "run direction"]:
    """Return the smallest push that topples each run in each direction [N].

    All levels of all runs and directions go into one batch. A second batch has ``refinement_count`` evenly spaced
    forces between the first level that topples and the level below it. The answer is the smallest of the forces that
    topple, even if the robot survives a greater one. Where no level topples, the answer is infinite.

    Args:
        runs: runs without pushes of their own.
        directions: unit vectors in the world: forward, left, up.
        start_time: time at which the push begins [s].
        levels: forces to try, increasing [N].
        has_fallen: function that returns from a record whether each run fell, along the dimension ``run``; the last
            sample of the record is ``wait`` after the push.
        refinement_count: number of forces of the second batch; the answer is off by at most the gap between two of
            them.
        duration: duration of the push [s].
        body: name of the body that is pushed.
        wait: time from the end of the push to the end of a run [s].
        timestep: time step of the physics [s].
        progress: called with the finished fraction.

    Raises:
        InvalidDesign: the levels do not increase from above zero.
    """
    scanned_forces = np.array([0.0, *levels])
    if len(scanned_forces) < 2 or np.any(np.diff(scanned_forces) <= 0):
        raise InvalidDesign(f"levels are {tuple(levels)}; increasing forces above 0 N are needed.")
    trial = _Trial(
        runs,
        directions,
        Push(force=(0.0, 0.0, 0.0), at=start_time, duration=duration, body=body),
        has_fallen,
        wait,
        timestep,
    )
    forces = np.broadcast_to(scanned_forces[1:], (len(runs), len(directions), len(levels)))
    is_toppled_coarse = trial(forces, staged(progress, "coarse levels", 0.0, 0.6))
    first_level = np.where(is_toppled_coarse.any(axis=-1), is_toppled_coarse.argmax(axis=-1), len(levels))
    lower_force, smallest = scanned_forces[first_level], np.append(scanned_forces[1:], np.inf)[first_level]
    if refinement_count:
        bracket_width = np.where(
            np.isfinite(smallest), smallest - lower_force, 1.0
        )  # of those that never fall any will do: it is not used
        fine_forces = lower_force[..., None] + bracket_width[..., None] * (
            np.arange(1, refinement_count + 1) / (refinement_count + 1)
        )
        is_toppled_fine = trial(fine_forces, staged(progress, "finer levels", 0.6, 1.0))
        fine_smallest = np.take_along_axis(fine_forces, is_toppled_fine.argmax(axis=-1)[..., None], axis=-1)[..., 0]
        smallest = np.where(is_toppled_fine.any(axis=-1) & np.isfinite(smallest), fine_smallest, smallest)
    progress("finer levels", 1.0)
    return smallest


class _Trial(NamedTuple):
    """Runs to be pushed."""

    runs: Sequence[Run]
    directions: Sequence[tuple[float, float, float]]
    push: Push
    has_fallen: Callable[[xr.Dataset], xr.DataArray]
    wait: float
    timestep: float

    def __call__(
        self, forces: Float[np.ndarray, "run direction force"], progress: Progress
    ) -> Bool[np.ndarray, "run direction force"]:
        """Return whether each force [N] topples its run, shape (run, direction, force)."""
        batch = [
            replace(run, pushes=(replace(self.push, force=_force_vector(direction, force)),))
            for run, of_run in zip(self.runs, forces, strict=True)
            for direction, levels in zip(self.directions, of_run, strict=True)
            for force in levels
        ]
        end = self.push.at + self.push.duration + self.wait
        record = simulate(
            batch, duration=end, timestep=self.timestep, sample_stride=10, effort=False, progress=progress
        )
        return np.asarray(self.has_fallen(record).values, dtype=bool).reshape(forces.shape)


def _force_vector(direction: tuple[float, float, float], force: float) -> tuple[float, float, float]:
    x, y, z = direction
    return float(x * force), float(y * force), float(z * force)

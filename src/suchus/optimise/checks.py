"""Whether an optimum is one: with a finer time step, on other ground, begun otherwise; and what lies around it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from suchus.design import with_values
from suchus.design.scale import physics_step
from suchus.land import Run, simulate
from suchus.optimise.evaluate import columns, evaluate, measure
from suchus.optimise.spec import Optimisation

Evaluate = Callable[..., xr.Dataset]
"""Tries candidates; see ``evaluate.evaluate``."""
_NEAR = (-0.1, -0.05, 0.0, 0.05, 0.1)  # of each range


@dataclass(frozen=True, slots=True)
class Condition:
    """One condition of a check, and how it differs from the search."""

    tells: str
    """Description of the condition."""
    friction_scale: float = 1.0
    """Factor on the friction [-]."""
    noise: float = 0.0
    """Standard deviation of noise on every commanded angle [rad]."""
    seed: int = 0
    """Seed of the noise."""
    later: float = 0.0
    """Phase by which the walk begins later in its cycle [cycle]."""


CONDITIONS = (
    Condition("2 ms"),
    Condition("foot friction 0.5", friction_scale=0.625),
    Condition("foot friction 0.65", friction_scale=0.8125),
    Condition("foot friction 1.0", friction_scale=1.25),
    Condition("servo noise 0.01 rad, seed 1", noise=0.01, seed=1),
    Condition("servo noise 0.01 rad, seed 2", noise=0.01, seed=2),
    Condition("begun a quarter of a cycle later", later=0.25),
    Condition("begun 0.4 of a cycle later", later=0.4),
)
"""All with the robot's own time step, 2 ms for the caiman. Frictions are those of the caiman, whose feet have 0.8: a
rubber foot on floors from 0.5 to 1."""


def checked(spec: Optimisation, runs: Sequence[Run]) -> xr.Dataset:
    """Run the chosen, and where the search started, under every condition with the robot's own time step.

    Returns:
        ``aim_...`` and ``limit_...`` along ``run`` (the chosen, then ``start``) and ``condition``; NaN where it
        diverged.
    """
    who = [*runs, replace(spec.run, label="start")]
    batch = [_under(run, condition) for run in who for condition in CONDITIONS]
    record = simulate(batch, duration=spec.duration, timestep=physics_step(spec.run.robot), every=2)
    shape = len(who), len(CONDITIONS)
    sound = record.cause.values == ""
    return xr.Dataset(
        {
            name: (("run", "condition"), np.where(sound, values, np.nan).reshape(shape))
            for name, values in measure(spec, batch, record).items()
        },
        coords={"run": [run.label for run in who], "condition": [c.tells for c in CONDITIONS]},
    )


def _under(run: Run, condition: Condition) -> Run:
    phases = tuple((phase + condition.later + 1.0) % 1.0 for phase in run.gait.limb_phases)
    gait = replace(run.gait, limb_phases=phases)
    other = replace(run, gait=gait if condition.later else run.gait, noise=condition.noise, seed=condition.seed)
    return with_values(other, {"ground.friction_scale": run.ground.friction_scale * condition.friction_scale})


def around(spec: Optimisation, best: np.ndarray, tried: Evaluate = evaluate) -> xr.Dataset:
    """Move each field alone to both sides of the best, by a twentieth and a tenth of its range.

    Args:
        spec: the search.
        best: the shares of the ranges at which the best lies.
        tried: what tries candidates.

    Returns:
        ``share``, ``aim_...``, ``limit_...``, ``status`` over ``moved`` (which field) and ``step``.
    """
    fields = [v.field for v in spec.vary]
    points = np.array([best] * (len(fields) * len(_NEAR))).reshape(len(fields), len(_NEAR), -1)
    for i in range(len(fields)):
        points[i, :, i] = np.clip(best[i] + np.array(_NEAR), 0.0, 1.0)
    table = tried(spec, points.reshape(-1, len(fields)))
    shape = len(fields), len(_NEAR)
    return xr.Dataset(
        {name: (("moved", "step"), table[name].values.reshape(shape)) for name in ("status", *columns(spec))}
        | {"at": (("moved", "step"), np.array([points[i, :, i] for i in range(len(fields))]))},
        coords={"moved": fields, "step": list(_NEAR)},
    )

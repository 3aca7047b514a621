"""The conditions of the map, and the search for the best gait of each group in one of them."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from suchus.core.progress import Progress, silent
from suchus.experiments.optimise.evaluate import evaluate, score, units
from suchus.experiments.optimise.ready import crawl
from suchus.experiments.optimise.search import search
from suchus.experiments.optimise.spec import Optimisation
from suchus.experiments.study import Arm
from suchus.robot.design import Robot, Rod, Segment, Shell, with_values
from suchus.robot.design.scale import coarse_step
from suchus.robot.motion import START, Gait
from suchus.sim.land import Ground, Run

FREE, STILL = "free", "still"
"""Groups: spine and tail move; the axis is still, as in the control group."""
ARMS = (FREE, STILL)
"""Groups of the map."""
_POSTURE = "gait.tail_pitch"
"""Field of the axis that the control group may choose too: at which pitch the tail is held."""
_LIMITS = ("torque", "clearance", "sideways")
"""Limits of the ready search that hold on any ground: on grains and slopes loaded feet slide in every gait."""


class Cell(NamedTuple):
    """A condition of the map."""

    name: str
    """Name in the measures."""
    axis: str
    """What differs from the base: ``base`` where nothing does."""
    label: str
    """Label in the figure."""
    robot: Robot
    """The robot."""
    ground: Ground
    """The ground."""
    period: float
    """Period of the gaits [s]."""


def arm_searches(robot: Robot, gait: Gait, seed: int = 0) -> dict[str, Optimisation]:
    """Return the ready search for the best crawl of each group, from one gait, with equal legs, ranges and limits.

    Args:
        robot: the robot.
        gait: the gait with spine and tail, from which both groups start.
        seed: added to the seed of the ready search [-].
    """
    ready = crawl(robot)
    moving, still = ready.arms
    held = {name: value for name, value in still.values.items() if name != _POSTURE}
    whole = replace(
        ready,
        run=replace(ready.run, gait=gait),
        limits=tuple(limit for limit in ready.limits if limit.name in _LIMITS),
        arms=(moving, Arm(name=STILL, values=held)),
        seed=ready.seed + seed,
        reasons=(),
    )
    return {FREE: whole.for_arm(whole.arms[0]), STILL: whole.for_arm(whole.arms[1])}


def search_in_cell(
    spec: Optimisation,
    cell: Cell,
    start: Gait,
    *,
    evaluations: int,
    population: int,
    cycles: int,
    sigma: float,
    progress: Progress = silent,
) -> tuple[Gait, bool]:
    """Return the best gait that a search finds in a condition, and whether it keeps all limits.

    Candidates that exceed a limit count less by their excess, so that there is a best one where none keeps all.

    Args:
        spec: the search of one group.
        cell: the condition.
        start: gait from which the search starts.
        evaluations: number of candidates; the generation in which they run out is finished [-].
        population: candidates of a generation [-].
        cycles: cycles of each walk [-].
        sigma: first standard deviation of the candidates, as a part of each range [-].
        progress: told the share that is done.
    """
    gait = replace(start, period=cell.period)
    here = replace(
        spec,
        run=replace(spec.run, robot=cell.robot, ground=cell.ground, gait=gait),
        friction_scales=(cell.ground.friction_scale,),
        duration=round(START + cycles * cell.period, 2),
        timestep=coarse_step(cell.robot),
        evaluations=evaluations,
        population=population,
        sigma=sigma,
    )
    tables = [evaluate(here, np.array([here.start]))]
    parts, driver = units(here, tables[0]), search(here)
    while (done := sum(table.sizes["candidate"] for table in tables)) < evaluations:
        progress(cell.name, done / evaluations)
        table = evaluate(here, driver.ask())
        driver.tell(score(here, table, parts))
        tables.append(table)
    history = xr.concat(tables, "candidate")
    best = int(score(here, history, parts).argmin())
    shares = history.share.values[best]
    run = here.candidate({vary.field: float(share) for vary, share in zip(here.vary, shares, strict=True)})
    kept = all(
        float(history[f"limit_{limit.name}"][best]) * sign <= limit.value * sign
        for limit, sign in ((limit, -1.0 if limit.name == "clearance" else 1.0) for limit in here.limits)
    )
    return run.gait, kept


def with_tail_size(robot: Robot, size: float) -> Robot:
    """Return a robot whose tail is thicker by a factor: its area grows by the factor, its mass by the square of it.

    Args:
        robot: the design.
        size: factor on width and height of all shapes of the tail [-].
    """
    last = robot.root_index
    axis = tuple(_thickened(segment, size) if i > last else segment for i, segment in enumerate(robot.axis))
    return replace(robot, axis=axis)


def _thickened(segment: Segment, size: float) -> Segment:
    """Return a segment whose shapes are thicker and heavier."""
    shapes: list[Rod | Shell] = []
    for shape in segment.shapes:
        mass = size**2 * shape.mass
        if isinstance(shape, Rod):
            shapes.append(replace(shape, radius=size * shape.radius, mass=mass))
        else:
            length, width, height = shape.half
            shapes.append(replace(shape, half=(length, size * width, size * height), mass=mass))
    return replace(segment, shapes=tuple(shapes))


def on_fields_of_their_own(runs: list[Run], repeats: int) -> list[Run]:
    """Return runs whose bumps differ between the robots as built: the i-th of each condition has the field i.

    Args:
        runs: built robots, condition by condition.
        repeats: robots of each condition [-].
    """
    if runs[0].ground.relief is None:
        return runs
    return [with_values(run, {"ground.relief.seed": i % repeats}) for i, run in enumerate(runs)]

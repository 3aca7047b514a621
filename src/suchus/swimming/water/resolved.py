"""Swims by CFD: the robot in the flow solver, in the plane or in space, free, on the spot, tethered, or towed."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Protocol

import numpy as np
import xarray as xr

from suchus import flow
from suchus.core.errors import OutsideLimits
from suchus.core.progress import Progress
from suchus.robot.design import Robot
from suchus.swimming.water.outline import Outline
from suchus.swimming.water.plane_record import FreeSlice, TetheredSlice
from suchus.swimming.water.samples import Samples, run_on
from suchus.swimming.water.setting import DENSITY, FREE, ON_THE_SPOT, TETHERED, SwimSetting
from suchus.swimming.water.space_record import FreeInSpace, TetheredInSpace
from suchus.swimming.water.swim_setup import ResolvedSwim, box_grid, box_sides, straight_body
from suchus.swimming.water.undulation import Motion

__all__ = ["FREE", "ON_THE_SPOT", "TETHERED", "SwimSetting", "check_resolved_swim", "resolved_swim", "towed_drag"]

SPEEDS = 1e-4, 10.0
"""Least and greatest speed of a tow [m/s]."""
LENGTHS = 1.5, 100.0
"""Least and greatest distance of a tow [body length]."""
_RAMP = 0.5
"""Distance over which the stream around a towed body grows [body length]."""


class SwimObserver(Protocol):
    """Takes samples after every step of a swim, and makes its record."""

    def sample(self, sim: flow.Simulation, samples: Samples) -> None:
        """Store samples."""

    def record(self, sim: flow.Simulation, samples: Samples) -> xr.Dataset:
        """Return the record of the swim, from its samples and the record of the flow."""


_OBSERVERS: dict[tuple[int, bool], Callable[[ResolvedSwim], SwimObserver]] = {
    (2, False): FreeSlice,
    (2, True): TetheredSlice,
    (3, False): FreeInSpace,
    (3, True): TetheredInSpace,
}
"""Who samples and records a swim, by its axes and whether the body is tethered."""


def resolved_swim(
    robot: Robot,
    motion: Motion,
    setting: SwimSetting,
    *,
    sway: complex = 0j,
    turn: complex = 0j,
    checkpoint: Path | str | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Return a swim by CFD from rest; the motion grows over the first half cycle.

    A free body has the mass of the water that it displaces. The grid follows its centre; ``x`` and ``y`` of the record
    are in the frame of the grid at each instant.

    Args:
        robot: robot that swims.
        motion: how: with its joints, or as a wave that its midline follows exactly.
        setting: grid, water, time, and what moves the body.
        sway: harmonic of the displacement of a tethered body's snout to the right [m]; ``slender.recoil`` has those
            with which it exchanges no lateral momentum with the water.
        turn: harmonic of the direction of a tethered body's head [rad]; an exact wave brings its own.
        checkpoint: file that the state is kept in at every quarter of a cycle; if it exists, the swim goes on from
            there. None keeps nothing.
        progress: told the share that is done; None shows a progress bar.

    Returns:
        Per metre of depth in the plane. *Free, in the plane*: ``speed`` and ``power`` per cycle, snout, heading, tail
        and swing over the last two, fields at ``frames`` of the last. *Tethered, in the plane*: forces, moments and
        pressures along the tail over the last cycle, fields at its quarters; ``quarter_*`` hold what was at the
        quarters of every cycle but the first, which sets the water in motion. *Free, in space*: per cycle ``speed`` and
        ``thrust`` forward and ``power`` on the water; ``joint_torque`` over the last cycle, that of the water on what
        lies behind each of ``Outline.joint_positions``; wake and vortices at the end. *Tethered, in space*: over the
        last cycle ``thrust`` forward, ``aside`` to the right, ``power`` on the water, their means per cycle, ``sway``
        [m] and ``turn`` [rad] of the head, cosine and sine.

    Raises:
        OutsideLimits: the joints or servos cannot follow the motion.
        InvalidDesign: the boundary layer is too thin for the grid, the box too small, or the memory.
        UnreadableFile: the checkpoint is broken or belongs to another swim.
        Unwritable: the checkpoint cannot be written.
        Diverged: the flow diverged.
    """
    check_resolved_swim(robot, motion, setting, sway=sway, turn=turn)
    swim = ResolvedSwim(robot=robot, motion=motion, setting=setting, sway=sway, turn=turn)
    sim, observer = flow.Simulation(swim.setup), _OBSERVERS[setting.axes, setting.tethered](swim)
    samples = run_on(
        sim, swim.end, swim.period / 4, observer.sample, description=swim.key, checkpoint=checkpoint, progress=progress
    )
    return observer.record(sim, samples)


def check_resolved_swim(
    robot: Robot, motion: Motion, setting: SwimSetting, *, sway: complex = 0j, turn: complex = 0j
) -> None:
    """Refuse a swim beyond the limits of joints, servos, grid, box or machine, before anything runs."""
    ResolvedSwim(robot=robot, motion=motion, setting=setting, sway=sway, turn=turn).check()


def towed_drag(robot: Robot, speed: float, setting: SwimSetting, *, lengths: float = 4.0) -> float:
    """Return the drag of the straight body in a stream, its mean over the last length of the distance [N or N/m].

    Args:
        robot: robot whose body is meant, without its limbs.
        speed: speed of the stream, which grows over the first half length [m/s].
        setting: grid and water; its cycles, and what moves the body, do not matter.
        lengths: distance that the stream moves [body length].

    Raises:
        OutsideLimits: speed or distance are.
        InvalidDesign: the boundary layer is too thin for the grid.
        Diverged: the flow diverged.
    """
    _check_tow("speed", speed, *SPEEDS, "m/s")
    _check_tow("lengths", lengths, *LENGTHS, "body lengths")
    length, outline = robot.length, Outline(robot, setting.cells + 1)
    ramp_time = _RAMP * length / speed

    def stream(time: float) -> tuple[float, float]:
        fraction = min(time / ramp_time, 1.0)
        return speed * fraction * fraction * (3 - 2 * fraction), 0.0

    sim = flow.Simulation(
        flow.Setup(
            grid=box_grid(outline, replace(setting, free=TETHERED), 0.0), viscosity=setting.viscosity, density=DENSITY,
            bodies=(straight_body(outline, setting),), stream=stream, sides=box_sides(setting),
            tolerance=setting.largest_divergence(),
        )
    )  # fmt: skip
    series = sim.run(lengths * length / speed, progress=False).select_after((lengths - 1.0) * length / speed)
    return float(np.average(series.force()[:, 0], weights=series.step))


def _check_tow(name: str, value: float, lower_bound: float, upper_bound: float, unit: str) -> None:
    if not lower_bound <= value <= upper_bound:
        raise OutsideLimits(
            f"{name} of the tow is {value:.4g} {unit}; {lower_bound:g} to {upper_bound:g} {unit} is allowed."
        )

"""The robot's own body in the water of three dimensions with its motion given: swum on the spot, and towed straight.

Everything moves as it is prescribed, sway and turn of the head too, so that another model of the water can be asked for
the forces of the very same motion. A swim in which the water decides is ``space.swim_in_space``.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import xarray as xr

from suchus import flow
from suchus.design import Robot
from suchus.design.water import Water
from suchus.errors import OutsideLimits
from suchus.flow.memory import check_memory
from suchus.water.diary import Diary, Progress, run_on
from suchus.water.held import SAMPLES
from suchus.water.outline import Outline
from suchus.water.pool import cycle_means, motion_key
from suchus.water.slender import recoil
from suchus.water.space import Basin, basin_grid, check_swim_in_space, trunk
from suchus.water.tank import DENSITY, GROWS
from suchus.water.undulation import STILL, Motion

SPEEDS = 1e-4, 10.0
"""Least and greatest speed of a tow [m/s]."""
LENGTHS = 1.5, 100.0
"""Least and greatest distance of a tow [body length]."""
_RAMP = 0.5
"""Distance over which the stream around a towed body grows [body length]."""


def held_in_space(
    robot: Robot,
    motion: Motion,
    basin: Basin,
    *,
    checkpoint: Path | str | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Return the forces on a body that swims on the spot, swaying and turning as ``slender.recoil`` says it would.

    The motion grows over the first half cycle. The upper half is computed, as in ``swim_in_space``.

    Args:
        robot: who swims.
        motion: how.
        basin: grid, water and time; the body never moves on.
        checkpoint: file from which a run that was stopped goes on; None keeps nothing.
        progress: called with the share that is done; None shows a progress bar.

    Returns:
        Over the last cycle ``thrust`` of the water forward, ``aside`` to the right, ``power`` on the water; their means
        per cycle as ``cycle_thrust`` and ``cycle_power``; ``sway`` [m] and ``turn`` [rad] of the head, cosine and sine.

    Raises:
        OutsideLimits: the joints or servos cannot follow the motion.
        InvalidDesign: the boundary layer is too thin for the grid.
        UnreadableFile: the checkpoint is broken or belongs to another swim.
        Unwritable: the checkpoint cannot be written.
        Diverged: the flow diverged.
    """
    check_swim_in_space(robot, motion, basin)
    outline, period = Outline(robot, basin.cells + 1), 1.0 / motion.frequency
    sway, turn = recoil(outline, motion, 0.0, Water(viscosity=basin.viscosity))
    shape = trunk(
        outline, motion, grow=GROWS * period, tail_height=basin.tail_height, limbs=basin.limbs, sway=sway, turn=turn
    )
    grid = basin_grid(robot.length, outline, motion, basin, sway, turn)
    sim = flow.Simulation(
        flow.Setup(
            grid=grid, viscosity=basin.viscosity, density=DENSITY, bodies=(flow.Body(shape=shape),),
            sides=flow.Sides(low=flow.Mirror()), tolerance=basin.tolerance,
        )
    )  # fmt: skip
    end, about = basin.cycles * period, repr(("held", robot, motion_key(motion), basin))
    run_on(sim, end, period / 4, _nothing, about=about, checkpoint=checkpoint, progress=progress)
    ahead, power = cycle_means(sim.record, period, basin.cycles, ("force_x", "power"))
    phase = np.arange(1, SAMPLES + 1) / SAMPLES
    when, force = (sim.record.time - 0.5 * sim.record.step - end + period) / period, sim.record.force()
    series = {"thrust": (-force[:, 0], "N"), "aside": (force[:, 1], "N"), "power": (sim.record.column("power"), "W")}
    parts = {"part": ["cosine", "sine"], "phase": phase, "cycle": np.arange(1, basin.cycles + 1)}
    return xr.Dataset(
        {name: ("phase", np.interp(phase, when, values), {"units": unit}) for name, (values, unit) in series.items()}
        | {
            "cycle_thrust": ("cycle", -ahead, {"units": "N"}),
            "cycle_power": ("cycle", power, {"units": "W"}),
            "sway": ("part", [sway.real, -sway.imag], {"units": "m"}),
            "turn": ("part", [turn.real, -turn.imag], {"units": "rad"}),
        },
        coords=parts,
    )


def _nothing(sim: flow.Simulation, diary: Diary) -> None:
    """Note nothing: the flow's own record is enough."""


def towed_in_space(robot: Robot, speed: float, basin: Basin, *, lengths: float = 4.0) -> float:
    """Return the drag of the straight body in a stream, its mean over the last length of the distance [N].

    Args:
        robot: whose body, limbs left out.
        speed: of the stream, which grows over the first half length [m/s].
        basin: grid and water; its cycles do not matter.
        lengths: distance that the stream moves [body length].

    Raises:
        OutsideLimits: speed or distance are.
        InvalidDesign: the boundary layer is too thin for the grid.
        Diverged: the flow diverged.
    """
    _check_tow("speed", speed, *SPEEDS, "m/s")
    _check_tow("lengths", lengths, *LENGTHS, "body lengths")
    length, outline = robot.length, Outline(robot, basin.cells + 1)
    over = _RAMP * length / speed

    def stream(time: float) -> tuple[float, float]:
        part = min(time / over, 1.0)
        return speed * part * part * (3 - 2 * part), 0.0

    body = flow.Body(shape=replace(trunk(outline, STILL, tail_height=basin.tail_height), deforms=False))
    grid = basin_grid(length, outline, STILL, basin, 0j, 0j)
    check_memory(grid, np.float32)
    sim = flow.Simulation(
        flow.Setup(
            grid=grid, viscosity=basin.viscosity, density=DENSITY, bodies=(body,), stream=stream,
            sides=flow.Sides(low=flow.Mirror()), tolerance=basin.tolerance,
        )
    )  # fmt: skip
    series = sim.run(lengths * length / speed, progress=False).after((lengths - 1.0) * length / speed)
    return float(np.average(series.force()[:, 0], weights=series.step))


def _check_tow(name: str, value: float, low: float, high: float, unit: str) -> None:
    if not low <= value <= high:
        raise OutsideLimits(f"{name} of the tow is {value:.4g} {unit}; {low:g} to {high:g} {unit} is allowed.")

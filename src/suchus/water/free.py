"""The robot in the resolved flow on its own: from rest, in three degrees of freedom."""

from pathlib import Path

import numpy as np
import xarray as xr

from suchus import flow
from suchus.design import Crocodile
from suchus.kinematics.mass import GRAVITY
from suchus.water.diary import Diary, Progress, run_on
from suchus.water.held import SAMPLES, named
from suchus.water.immersed import immersed
from suchus.water.outline import Outline
from suchus.water.slender import Water, cycle, recoil
from suchus.water.swimming import wave_speed
from suchus.water.tank import DENSITY, GROWS, Tether, check_motion
from suchus.water.undulation import Motion
from suchus.water.view import View, kept, midline

_BOX = (3.5, 2.0)
"""Length and width of the box [body length]."""
_SLACK = 1e-6
"""Rounding of the phase [cycle]."""


def free_swim(
    robot: Crocodile,
    motion: Motion,
    setting: Tether,
    *,
    checkpoint: Path | str | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Return a swim from rest in three degrees of freedom, the body as heavy as the water it displaces.

    The grid travels with the body's centre; ``x`` and ``y`` of the record are in its frame at each instant.

    Args:
        robot: who swims.
        motion: how: with its joints, or as a wave that its midline follows exactly.
        setting: grid, water and time.
        checkpoint: file that the state is kept in at every quarter of a cycle; if it exists, the swim goes on from
            there. None keeps nothing.
        progress: called with the share that is done; None shows a progress bar.

    Raises:
        OutsideLimits: the joints or servos cannot follow the motion.
        InvalidDesign: the boundary layer is too thin for the grid, or the box too small.
        UnreadableFile: the checkpoint is broken or belongs to another swim.
        Diverged: the flow came apart.
    """
    length, period = robot.length, 1.0 / motion.frequency
    outline = Outline(robot, setting.cells + 1)
    check_motion(outline, motion, setting, *recoil(outline, motion, 0.0, Water()))
    grid = setting.grid(length, _BOX)
    shape = immersed(outline, motion, grow=GROWS * period, least=setting.least(length))
    body = flow.FreeBody(shape=shape, start=(0.5 * length, 0.0))
    sim = flow.Simulation(
        flow.Setup(grid=grid, viscosity=setting.viscosity, density=DENSITY, bodies=(body,), follow="body")
    )
    seen = _Free(outline, motion, View(grid, length, 2.25, 0.6), setting, period)
    diary = run_on(
        sim,
        setting.cycles * period,
        period / 4,
        seen.look,
        about=repr(("free", robot, named(motion), setting)),
        checkpoint=checkpoint,
        progress=progress,
    )
    return seen.record(sim, diary)


class _Free:
    """What is seen of a free body."""

    def __init__(self, outline: Outline, motion: Motion, view: View, setting: Tether, period: float) -> None:
        self._outline, self._motion, self._view = outline, motion, view
        self._end, self._period, self._frames = setting.cycles * period, period, setting.frames

    def look(self, sim: flow.Simulation, diary: Diary) -> None:
        left = (self._end - sim.time) / self._period
        if left > 2.0 + _SLACK:
            return
        spine, (position, _) = midline(sim), sim.frame
        ends = (spine.x[0] + position[0], spine.y[0] + position[1], spine.heading[0], spine.y[-1] + position[1])
        diary.note("track", sim.time, ends=np.array(ends))
        if left < 1.0 - (diary.count("frames") + 1) / self._frames + _SLACK:
            fields = self._view.fields(sim)
            diary.note("frames", sim.time, **{n: fields[n] for n in ("vorticity", "pressure")}, **kept(spine))

    def record(self, sim: flow.Simulation, diary: Diary) -> xr.Dataset:
        cycles, period, shape = round(self._end / self._period), self._period, sim.setup.bodies[0].shape
        speed, power = _means(sim.record, period, cycles)
        track = diary.page("track")
        even = self._end + period * (np.arange(2 * SAMPLES + 1) / SAMPLES - 2.0)
        ends = np.column_stack([np.interp(even, track["time"], column) for column in track["ends"].T])
        outline = self._outline
        data = xr.Dataset(
            {
                "speed": ("cycle", speed, {"units": "m/s"}),
                "power": ("cycle", power, {"units": "W/m"}),
                "snout_x": ("sample", ends[:, 0], {"units": "m"}),
                "snout_y": ("sample", ends[:, 1], {"units": "m"}),
                "heading": ("sample", ends[:, 2], {"units": "rad"}),
                "tail_y": ("sample", ends[:, 3], {"units": "m"}),
                "weight": ((), DENSITY * GRAVITY * shape.mass(sim.time).area, {"units": "N/m"}),
                "wave_speed": ((), wave_speed(outline, self._motion, cycle(outline, self._motion)), {"units": "m/s"}),
                "thin": ((), sim.thin["body"], {"units": "1"}),
            }
        )
        frames = diary.page("frames")
        shown = self._view.dataset(frames, "frame")
        phase = (frames["time"] - self._end) / period + 1.0
        return data.merge(shown.assign_coords(frame=("frame", phase, {"units": "1"})))


def _means(series: flow.Record, period: float, cycles: int) -> np.ndarray:
    """Return speed forward and power of each cycle, shape (2, cycle)."""
    out = np.empty((2, cycles))
    for i in range(cycles):
        part = (series.time > i * period * (1 + _SLACK)) & (series.time <= (i + 1) * period * (1 + _SLACK))
        for row, values in enumerate((-series.column("velocity_x"), series.column("power"))):
            out[row, i] = np.average(values[part], weights=series.step[part])
    return out

"""Free swimming of the robot by CFD: from rest, in three degrees of freedom."""

from pathlib import Path

import numpy as np
import xarray as xr

from suchus import flow
from suchus.design import GRAVITY, Robot
from suchus.water.diary import Diary, Progress
from suchus.water.held import SAMPLES
from suchus.water.measures import swing
from suchus.water.pool import SLACK, Pool, cycle_means
from suchus.water.slender import cycle
from suchus.water.swimming import wave_speed
from suchus.water.tank import DENSITY, Tether
from suchus.water.undulation import Motion
from suchus.water.view import View, kept, midline

_BOX = (3.5, 2.0)
"""Length and width of the box [body length]."""
TRACK = 40
"""Samples of the track in a cycle [-]."""


def free_swim(
    robot: Robot,
    motion: Motion,
    setting: Tether,
    *,
    checkpoint: Path | str | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Return a swim from rest in three degrees of freedom, the body as heavy as the water it displaces.

    Arguments and errors are those of ``tether``; the head turns as the water lets it. The grid travels with the body's
    centre; ``x`` and ``y`` of the record are in its frame at each instant.
    """
    pool = Pool.filled(robot, motion, setting, _BOX, None)
    return pool.swum(_Free(pool), checkpoint=checkpoint, progress=progress)


def check_free_swim(robot: Robot, motion: Motion, setting: Tether) -> None:
    """Refuse what joints, servos or grid cannot follow, before anything runs; errors are those of ``free_swim``."""
    Pool.filled(robot, motion, setting, _BOX, None)


class _Free:
    """Time series of a freely swimming body."""

    def __init__(self, pool: Pool) -> None:
        self._pool, self._view = pool, View(pool.grid, pool.robot.length, 2.25, 0.6)
        self._end, self._period, self._frames = pool.end, pool.period, pool.setting.frames

    def look(self, sim: flow.Simulation, diary: Diary) -> None:
        left = (self._end - sim.time) / self._period
        if left > 2.0 + SLACK:
            return
        spine, (position, _) = midline(sim), sim.frame
        snout = np.array([spine.x[0] + position[0], spine.heading[0]])
        diary.note("track", sim.time, snout=snout, across=spine.y + position[1])
        if left < 1.0 - (diary.count("frames") + 1) / self._frames + SLACK:
            fields = self._view.fields(sim)
            diary.note("frames", sim.time, **{n: fields[n] for n in ("vorticity", "pressure")}, **kept(spine))

    def record(self, sim: flow.Simulation, diary: Diary) -> xr.Dataset:
        period, outline, motion = self._period, self._pool.outline, self._pool.motion
        speed, power = cycle_means(sim.record, period, self._pool.setting.cycles, ("velocity_x", "power"))
        track = diary.page("track")
        even = self._end + period * (np.arange(2 * SAMPLES + 1) / SAMPLES - 2.0)
        snout, across = (
            np.column_stack([np.interp(even, track["time"], column) for column in track[name].T])
            for name in ("snout", "across")
        )
        swung, tip = swing(across), across[:, -1:]
        moment = self._period * np.arange(TRACK * self._pool.setting.cycles + 1) / TRACK
        centre = [np.interp(moment, sim.record.time, sim.record.column(name)) for name in ("x", "y")]
        data = xr.Dataset(
            {
                "speed": ("cycle", -speed, {"units": "m/s"}),
                "power": ("cycle", power, {"units": "W/m"}),
                "snout_x": ("sample", snout[:, 0], {"units": "m"}),
                "snout_y": ("sample", across[:, 0], {"units": "m"}),
                "heading": ("sample", snout[:, 1], {"units": "rad"}),
                "tail_y": ("sample", across[:, -1], {"units": "m"}),
                "swing": ("station", swung.amplitude, {"units": "m"}),
                "swing_late": (
                    "station",
                    swung.phase_lag,
                    {"units": "1", "long_name": "its phase lag [cycle]"},
                ),
                "sine_share": ("station", swung.share, {"units": "1"}),
                "tip_share": ("single", [_share(tip[:-SAMPLES]), _share(tip[SAMPLES:])], {"units": "1"}),
                "centre_x": ("moment", centre[0], {"units": "m", "long_name": "centre of mass, to the tail"}),
                "centre_y": ("moment", centre[1], {"units": "m", "long_name": "centre of mass, to the right"}),
                "weight": ((), DENSITY * GRAVITY * self._pool.shape.mass(sim.time).area, {"units": "N/m"}),
                "wave_speed": ((), wave_speed(outline, motion, cycle(outline, motion)), {"units": "m/s"}),
                "thin": ((), sim.thin["body"], {"units": "1"}),
            }
        )
        frames = diary.page("frames")
        shown = self._view.dataset(frames, "frame")
        phase = (frames["time"] - self._end) / period + 1.0
        return data.merge(shown.assign_coords(frame=("frame", phase, {"units": "1"})))


def _share(track: np.ndarray) -> float:
    """Return which share of a track's swing over one cycle is a sine, shape of the track (sample, 1) [-]."""
    return float(swing(track, 1).share[0])

"""The tethered robot in two-dimensional CFD, its snout fixed, as the article's Fig. 17 shows it."""

from pathlib import Path

import numpy as np
import xarray as xr

from suchus import flow
from suchus.design import Robot, cable_joints, layout
from suchus.motion.swim import trunk_yaws
from suchus.water.diary import Diary, Progress
from suchus.water.pool import SLACK, Pool, cycle_means
from suchus.water.skin import (
    PLACES,
    bend,
    convex_less_concave,
    joint_torques,
    place_of_difference,
    servo_torques,
    tail_sides,
)
from suchus.water.tank import Tether
from suchus.water.undulation import Motion
from suchus.water.view import View, kept

SAMPLES = 120
"""Samples of the measured cycle [-]."""
QUARTERS = (0.25, 0.5, 0.75, 1.0)
"""Instants of the measured cycle at which the article shows the pressure [cycle]."""
BOX = (2.75, 1.5)
"""Length and width of the box [body length]."""


def tether(
    robot: Robot,
    motion: Motion,
    setting: Tether,
    *,
    turn: complex = 0j,
    checkpoint: Path | str | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Return the flow around a body whose snout is fixed: forces over the last cycle, fields at its four quarters.

    ``quarter_*`` hold what was at the quarters of every cycle but the first, which sets the water in motion.

    Args:
        robot: who waves.
        motion: how: with its joints, or as a wave that its midline follows exactly.
        setting: grid, water and time.
        turn: harmonic of the head's direction [rad]; an exact wave brings its own.
        checkpoint: file that the state is kept in at every quarter of a cycle; if it exists, the swim goes on from
            there. None keeps nothing.
        progress: called with the share that is done; None shows a progress bar.

    Raises:
        OutsideLimits: the joints or servos cannot follow the motion.
        InvalidDesign: the boundary layer is too thin for the grid, or the box too small.
        UnreadableFile: the checkpoint is broken or belongs to another swim.
        Unwritable: the checkpoint cannot be written.
        Diverged: the flow diverged.
    """
    pool = Pool.filled(robot, motion, setting, BOX, turn)
    return pool.swum(_Held(pool), checkpoint=checkpoint, progress=progress)


class _Held:
    """Time series of a tethered body."""

    def __init__(self, pool: Pool) -> None:
        self._robot = pool.robot
        self._outline, self._view = pool.outline, View(pool.grid, pool.robot.length, 1.9, 0.6)
        self._start, self._period, self._cycles = pool.end - pool.period, pool.period, pool.setting.cycles
        self._settled = min(1, self._cycles - 1)

    def look(self, sim: flow.Simulation, diary: Diary) -> None:
        phase = (sim.time - self._start) / self._period
        turn = sim.time / self._period > self._settled + 0.25 * (diary.count("turns") + 1) - SLACK
        if phase <= SLACK and not turn:
            return
        surface = sim.surface()
        midline = sim.setup.bodies[0].shape.spine(sim.time)  # type: ignore[union-attr]
        sides = tail_sides(self._outline, surface)
        seen = {
            "difference": convex_less_concave(self._outline, surface, midline),
            "place": place_of_difference(sides),
        }
        if turn:
            diary.note("turns", sim.time, **seen)
        if phase <= SLACK:
            return
        diary.note(
            "steps",
            sim.time,
            **seen,
            bend=bend(self._outline, midline),
            torque=joint_torques(self._outline, surface, midline),
            servo=servo_torques(self._outline, surface, midline),
        )
        if phase > 0.25 * (diary.count("quarters") + 1) - SLACK:
            fields = self._view.fields(sim)
            diary.note("quarters", sim.time, sides=sides, **fields, **kept(midline))

    def record(self, sim: flow.Simulation, diary: Diary) -> xr.Dataset:
        place, yaws = layout(self._robot), trunk_yaws(self._robot)
        series, steps, quarters = sim.record.after(self._start), diary.page("steps"), diary.page("quarters")
        phase = np.arange(1, SAMPLES + 1) / SAMPLES
        seen = (steps["time"] - self._start) / self._period
        force, when = series.force(), (series.time - 0.5 * series.step - self._start) / self._period
        torques, servos = (
            np.column_stack([np.interp(phase, seen, column) for column in steps[name].T])
            for name in ("torque", "servo")
        )
        shown = self._view.dataset(quarters, "instant")
        ahead, power = cycle_means(sim.record, self._period, self._cycles, ("force_x", "power"))
        data = xr.Dataset(
            {
                "cycle_thrust": ("cycle", -ahead, {"units": "N/m"}),
                "cycle_power": ("cycle", power, {"units": "W/m"}),
                "thrust": ("phase", np.interp(phase, when, -force[:, 0]), {"units": "N/m"}),
                "aside": ("phase", np.interp(phase, when, force[:, 1]), {"units": "N/m"}),
                "power": ("phase", np.interp(phase, when, series.column("power")), {"units": "W/m"}),
                "joint_torque": (("phase", "joint"), torques, {"units": "N m/m"}),
                "servo_torque": (("phase", "servo"), servos, {"units": "N m"}),
                "difference": ("phase", np.interp(phase, seen, steps["difference"]), {"units": "Pa"}),
                "bend": ("phase", np.interp(phase, seen, steps["bend"]), {"units": "rad"}),
                "place": ("phase", np.interp(phase, seen, steps["place"]), {"units": "1"}),
                "sides": (("instant", "side", "tail"), quarters["sides"], {"units": "Pa"}),
                "noise": ((), _noise(series, self._period), {"units": "1"}),
                "thin": ((), sim.thin["body"], {"units": "1"}),
            },
            coords={
                "phase": phase,
                "instant": list(QUARTERS),
                "side": ["left", "right"],
                "tail": ("tail", np.linspace(0.0, 1.0, PLACES), {"units": "1"}),
                "joint": [*yaws, cable_joints(self._robot)[0]],
                "servo": [*yaws, *(place.servos[i] for i in place.cables)],
            },
        )
        return data.merge(shown).merge(self._turns(sim.record, diary))

    def _turns(self, series: flow.Record, diary: Diary) -> xr.Dataset:
        """Return what was at the four quarters of every cycle but the first, see ``measures.Quarters``."""
        seen, shape = diary.page("turns"), (self._cycles - self._settled, len(QUARTERS))
        when, force = series.time - 0.5 * series.step, series.force()
        at = {
            "difference": (seen["difference"], "Pa"),
            "place": (seen["place"], "1"),
            "thrust": (np.interp(seen["time"], when, -force[:, 0]), "N/m"),
            "aside": (np.interp(seen["time"], when, force[:, 1]), "N/m"),
        }
        dims = ("settled", "instant")
        data = {
            f"quarter_{name}": (dims, values.reshape(shape), {"units": unit}) for name, (values, unit) in at.items()
        }
        return xr.Dataset(data, coords={"settled": np.arange(self._settled, self._cycles) + 1})


def _noise(series: flow.Record, period: float) -> float:
    """Return the noise of the force along the body; not a number where the series is too short or constant [-]."""
    force = series.force()[:, 0]
    window = max(period / 12, 10 * float(series.step.mean()))  # enough steps for a cubic
    if series.time[-1] - series.time[0] < 2 * window or np.ptp(force) == 0.0:
        return float("nan")
    return flow.noise(series.time, force, window=window)

"""What a tethered and a free swim share: the robot's body in a box of water, and how a swim is run, noted and kept."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus import flow
from suchus.design import Robot
from suchus.design.water import Water
from suchus.water.diary import Diary, Progress, run_on
from suchus.water.immersed import immersed
from suchus.water.outline import Outline
from suchus.water.slender import recoil
from suchus.water.tank import DENSITY, GROWS, Tether, check_motion
from suchus.water.undulation import Motion

SLACK = 1e-6
"""Rounding of the phase [cycle]."""


class Witness(Protocol):
    """Who looks at a swim after every step, and says in the end what was seen."""

    def look(self, sim: flow.Simulation, diary: Diary) -> None:
        """Take notes."""

    def record(self, sim: flow.Simulation, diary: Diary) -> xr.Dataset:
        """Return what was seen."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Pool:
    """A robot's body in a box of water, snout at the origin."""

    robot: Robot
    """The robot that swims."""
    motion: Motion
    """Its swimming motion."""
    setting: Tether
    """Grid, water and time."""
    turn: complex | None
    """Harmonic of the direction of a tethered head; None for a free body [rad]."""
    outline: Outline
    """Outline of the robot, a station at every cell."""
    grid: flow.Grid
    """The cells."""
    shape: flow.Midline
    """The body in its own frame."""

    @classmethod
    def filled(
        cls, robot: Robot, motion: Motion, setting: Tether, box: tuple[float, float], turn: complex | None
    ) -> "Pool":
        """Return the pool, after checks.

        Args:
            robot: who swims.
            motion: how.
            setting: grid, water and time.
            box: length and width where the setting gives none [body length].
            turn: harmonic of the direction of a tethered head; None for a free body [rad].

        Raises:
            OutsideLimits: the joints or servos cannot follow the motion.
            InvalidDesign: the boundary layer is too thin for the grid.
        """
        outline = Outline(robot, setting.cells + 1)
        check_motion(outline, motion, setting, *(recoil(outline, motion, 0.0, Water()) if turn is None else (0j, turn)))
        shape = immersed(
            outline, motion, turn=turn or 0j, grow=GROWS / motion.frequency, least=setting.least(robot.length)
        )
        return cls(
            robot=robot,
            motion=motion,
            setting=setting,
            turn=turn,
            outline=outline,
            grid=setting.grid(robot.length, box),
            shape=shape,
        )

    @property
    def period(self) -> float:
        """Of one cycle [s]."""
        return 1.0 / self.motion.frequency

    @property
    def end(self) -> float:
        """Time at which the last cycle ends [s]."""
        return self.setting.cycles * self.period

    def swum(self, witness: Witness, *, checkpoint: Path | str | None, progress: Progress | None) -> xr.Dataset:
        """Swim, and return what the witness saw.

        Args:
            witness: who takes the notes.
            checkpoint: see ``tether``.
            progress: see ``tether``.

        Raises:
            UnreadableFile: the checkpoint is broken or belongs to another swim.
            Unwritable: it cannot be written.
            Diverged: the flow diverged.
        """
        free = self.turn is None
        start = (0.5 * self.robot.length, 0.0)
        body = flow.FreeBody(shape=self.shape, start=start) if free else flow.Body(shape=self.shape)
        setup = flow.Setup(
            grid=self.grid,
            viscosity=self.setting.viscosity,
            density=DENSITY,
            bodies=(body,),
            follow="body" if free else None,
        )
        sim = flow.Simulation(setup)
        about = repr((self.turn, self.robot, motion_key(self.motion), self.setting))
        diary = run_on(
            sim, self.end, self.period / 4, witness.look, about=about, checkpoint=checkpoint, progress=progress
        )
        return witness.record(sim, diary)


def motion_key(motion: Motion) -> object:
    """Return what identifies a motion, in full."""
    return motion if not hasattr(motion, "middles") else (motion.name, motion.frequency, motion.middles.tobytes())


def cycle_means(
    series: flow.Record, period: float, cycles: int, names: Sequence[str]
) -> Float[np.ndarray, "name cycle"]:
    """Return the mean of each cycle, steps weighted with their length.

    Args:
        series: of a swim from its start.
        period: of one cycle [s].
        cycles: how many [-].
        names: columns of the record.
    """
    out = np.empty((len(names), cycles))
    for i in range(cycles):
        part = (series.time > i * period * (1 + SLACK)) & (series.time <= (i + 1) * period * (1 + SLACK))
        for row, name in enumerate(names):
            out[row, i] = np.average(series.column(name)[part], weights=series.step[part])
    return out

"""The book that a simulation keeps: what acts on each body in every step, and the rows of the record."""

from dataclasses import dataclass, field

import numpy as np

from suchus.errors import Diverged
from suchus.flow.exchange import Reaction, contents_of, reaction, skin
from suchus.flow.force import ControlVolume, Load
from suchus.flow.pose import Pose
from suchus.flow.record import COLUMNS, HEAD, Record
from suchus.flow.setup import Setup
from suchus.flow.shape import Markers
from suchus.flow.water import Water

FASTEST = 100.0
"""Speed, over that of stream and bodies, above which a simulation counts as diverged [-]."""


@dataclass(slots=True)
class Log:
    """Rows of the record, and what the bodies' regions held at the last step."""

    setup: Setup
    """What is simulated."""
    rows: list[np.ndarray] = field(default_factory=list)
    """One row per step."""
    held: np.ndarray = field(default_factory=lambda: np.zeros((0, contents_of(2))))
    """What each body's region held at the end of the last step; see ``exchange.contents``."""
    controls: list[ControlVolume] = field(default_factory=list)
    """Boxes whose momentum is followed."""
    control_rows: list[tuple[float, float]] = field(default_factory=list)
    """Force from the first box, step by step [N/m]."""

    def hold(self, water: Water, outlines: list[Markers]) -> np.ndarray:
        """Note what the placed bodies' regions hold now; return what they held before."""
        grid, before = self.setup.grid, self.held
        skins = [skin(m, water.offset, grid.origin, grid.cell) for m in outlines]
        self.held = water.contents() - np.array(skins).reshape(-1, contents_of(2))
        return before

    def reactions(
        self, water: Water, outlines: list[Markers], about: list[tuple[float, float]], dt: float,
        push: tuple[float, float],
    ) -> list[Reaction]:  # fmt: skip
        """Return what the water did to each body in the step that just ended."""
        before = self.hold(water, outlines)
        grid = self.setup.grid
        return [
            reaction(
                given, was, now, dt=dt, push=push, about=np.array(point), origin=grid.origin, h=grid.cell,
                density=self.setup.density,
            )
            for given, was, now, point in zip(water.given, before, self.held, about, strict=True)
        ]  # fmt: skip

    def control(self, water: Water, dt: float, push: tuple[float, float]) -> None:
        """Note the force from the box, if there is one."""
        for box in self.controls:
            self.control_rows.append(box.force(water, dt, push, self.setup.density))

    def refuse_nonsense(self, fastest: float, reference: float, row: np.ndarray, good: dict[str, np.ndarray]) -> None:
        """Refuse fields that are no longer finite or far too fast; the error keeps the last good ones.

        Args:
            fastest: fastest water now [m/s].
            reference: fastest stream, body or wall so far, or water at the start [m/s].
            row: the row of the record that just came out.
            good: velocities before the step [m/s].

        Raises:
            Diverged: saying when, and what to change.
        """
        if np.isfinite(fastest) and np.isfinite(row).all() and not (reference > 0 and fastest > FASTEST * reference):
            return
        raise Diverged(
            f"at t = {row[0]:.4g} s the fastest water moves with {fastest:.3g} m/s, where stream and bodies "
            f"have {reference:.3g} m/s; take a smaller courant (now {self.setup.courant}), a finer grid or a lower "
            f"Reynolds number. The last good velocities are in the error's record['u'] and ['v'].",
            time=float(row[0] - row[1]), record={**{k: v.copy() for k, v in good.items()}, "record": self.record},
        )  # fmt: skip

    @property
    def record(self) -> Record:
        """The time series so far."""
        bodies = self.setup.bodies
        rows = np.array(self.rows).reshape(len(self.rows), HEAD + len(bodies) * len(COLUMNS))
        return Record(
            names=tuple(b.name for b in bodies), time=rows[:, 0], step=rows[:, 1], cycles=rows[:, 2:4].astype(int),
            divergence=rows[:, 4], bodies=rows[:, HEAD:].reshape(len(rows), len(bodies), len(COLUMNS)),
        )  # fmt: skip


def columns(load: Load, act: Reaction, frame: np.ndarray, place: Pose, error: float) -> list[float]:
    """Return the ``COLUMNS`` of one body.

    Args:
        load: pressure and friction along its outline.
        act: what the water did to it.
        frame: mean velocity of the grid [m/s].
        place: where it is.
        error: estimated error of its force [-].
    """
    power = act.power - float(frame @ np.array(act.force))
    return [
        *load.pressure, *load.shear, act.torque, power, *place.position, place.angle, *place.velocity, place.spin,
        *act.force, error,
    ]  # fmt: skip

"""The book that a simulation keeps: what acts on each body in every step, and the rows of the record."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from suchus.errors import Diverged
from suchus.flow.exchange import Reaction, contents_of, reaction, skin
from suchus.flow.force import ControlVolume, Load
from suchus.flow.pose import Pose
from suchus.flow.record import COLUMNS, HEAD, SPACE_COLUMNS, Record
from suchus.flow.setup import Setup
from suchus.flow.shape import Markers
from suchus.flow.solid import Skin
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
    held: np.ndarray = field(init=False)
    """What each body's region held at the end of the last step; see ``exchange.contents``."""
    controls: list[ControlVolume] = field(default_factory=list)
    """Boxes whose momentum is followed."""
    control_rows: list[tuple[float, float]] = field(default_factory=list)
    """Force from the first box, step by step [N/m]."""

    def __post_init__(self) -> None:
        self.held = np.zeros((0, contents_of(self.setup.grid.axes)))

    def hold(self, water: Water, outlines: Sequence[Markers | Skin]) -> np.ndarray:
        """Note what the placed bodies' regions hold now; return what they held before.

        Of a body that mirrors cut that is the part inside the domain.
        """
        grid, before = self.setup.grid, self.held
        skins = [
            0.5 ** sum(cut) * skin(m, water.offset, grid.origin, grid.cell)
            for m, cut in zip(outlines, water.cut, strict=True)
        ]
        self.held = water.contents() - np.array(skins).reshape(-1, contents_of(grid.axes))
        return before

    def reactions(
        self, water: Water, outlines: Sequence[Markers | Skin], about: list[tuple[float, ...]], dt: float,
        push: tuple[float, ...],
    ) -> list[Reaction]:  # fmt: skip
        """Return what the water did to each whole body in the step that just ended."""
        before = self.hold(water, outlines)
        grid = self.setup.grid
        return [
            reaction(
                given, was, now, dt=dt, push=push, about=np.array(point), origin=grid.origin, h=grid.cell,
                density=self.setup.density,
            ).whole(cut)
            for given, was, now, point, cut in zip(water.given, before, self.held, about, water.cut, strict=True)
        ]  # fmt: skip

    def control(self, water: Water, dt: float, push: tuple[float, ...]) -> None:
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
        bodies, names = self.setup.bodies, COLUMNS if self.setup.grid.axes == 2 else SPACE_COLUMNS
        rows = np.array(self.rows).reshape(len(self.rows), HEAD + len(bodies) * len(names))
        return Record(
            names=tuple(b.name for b in bodies), time=rows[:, 0], step=rows[:, 1], cycles=rows[:, 2:4].astype(int),
            divergence=rows[:, 4], bodies=rows[:, HEAD:].reshape(len(rows), len(bodies), len(names)), columns=names,
        )  # fmt: skip


def columns(load: Load | None, act: Reaction, frame: np.ndarray, place: Pose, error: float) -> list[float]:
    """Return the columns of the record of one body.

    Args:
        load: pressure and friction along its outline; None in space.
        act: what the water did to it.
        frame: mean velocity of the grid [m/s].
        place: where it is.
        error: estimated error of its force [-].
    """
    power = act.power - float(frame @ np.array(act.force))
    along = () if load is None else (*load.pressure, *load.shear)
    return [
        *along, act.torque, power, *place.position, place.angle, *place.velocity, place.spin, *act.force, error
    ]  # fmt: skip

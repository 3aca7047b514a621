"""Log of a simulation: the loads on each body in every step, and the rows of the record."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from suchus.core.errors import Diverged
from suchus.flow.body import AnyBody, rows_of
from suchus.flow.force import ControlVolume, Load
from suchus.flow.markers import Markers
from suchus.flow.midline import Spined
from suchus.flow.momentum import Reaction, contents_of, reaction, skin_contents
from suchus.flow.pose import Pose, cross
from suchus.flow.record import COLUMNS, PART_COLUMNS, ROW_HEADER_SIZE, SPACE_COLUMNS, Record
from suchus.flow.setup import Setup
from suchus.flow.water import Fluid

MAX_SPEED_RATIO = 100.0
"""Speed, over that of stream and bodies, above which a simulation counts as diverged [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FlowLoads:
    """Loads of the water on one body in one step."""

    reference_point: np.ndarray
    """Point of the torques, in the frame of the grid, shape (axis,) [m]."""
    total: Reaction
    """Load on the whole body, mean over the step."""
    parts: Reaction
    """Load on each of its parts, along the first axis; of a body that is not divided the whole."""
    internal_pressure: np.ndarray
    """What the pressure does inside the parts, where there is no water: its integral over each and its first moments
    about ``reference_point``, shape (part, 1 + axis), 0 in a body that is not divided [N, N m; N m, N m2].

    By this pressure the parts push each other; it is no load of the water. Rigid parts do work against it where the
    body bends."""


@dataclass(slots=True)
class Log:
    """Rows of the record, and what the bodies' regions held at the last step."""

    setup: Setup
    """Set-up of the simulation."""
    rows: list[np.ndarray] = field(default_factory=list)
    """One row per step."""
    region_contents: np.ndarray = field(init=False)
    """Contents of the region of each part of each body at the end of the last step; see ``momentum.add_contents``."""
    controls: list[ControlVolume] = field(default_factory=list)
    """Boxes whose momentum is followed."""
    control_rows: list[tuple[float, ...]] = field(default_factory=list)
    """Force from the first box, step by step [N/m, N]."""

    def __post_init__(self) -> None:
        self.region_contents = np.zeros((0, contents_of(self.setup.grid.ndim)))

    def store_contents(self, water: Fluid, outlines: Sequence[Markers]) -> None:
        """Store the contents of the placed bodies' regions; of a body that mirrors cut, the part inside the domain."""
        grid = self.setup.grid
        body_contents = [
            0.5 ** sum(mirror_cuts) * skin_contents(outline, water.offset, grid.origin, grid.cell, len(rows))
            for outline, mirror_cuts, rows in zip(outlines, water.mirror_cuts, water.rows, strict=True)
        ]
        self.region_contents = water.contents() - np.concatenate(
            [np.zeros((0, contents_of(grid.ndim))), *body_contents]
        )

    def reactions(
        self, water: Fluid, reference_points: list[tuple[float, ...]], dt: float, push: tuple[float, ...],
        previous_contents: np.ndarray,
    ) -> list[FlowLoads]:  # fmt: skip
        """Return the loads on each body and its parts in the step that just ended; see ``store_contents``.

        Args:
            water: after the step.
            reference_points: point of the torques of each body, in the frame of the grid [m].
            dt: length of the step [s].
            push: uniform acceleration of the water [m/s^2].
            previous_contents: ``region_contents`` at the start of the step.
        """
        grid, loads = self.setup.grid, []
        step_sums = water.immersion_sums, previous_contents, self.region_contents
        for rows, point, mirror_cuts in zip(water.rows, reference_points, water.mirror_cuts, strict=True):
            position = np.array(point)
            sums = [part_sums[rows.start : rows.stop] for part_sums in step_sums]
            if len(rows) > 1:
                sums = [np.concatenate([part_sums[:1] + part_sums[1:].sum(axis=0), part_sums]) for part_sums in sums]
            actions = reaction(
                *sums,
                dt=dt,
                push=push,
                reference_point=position,
                origin=grid.origin,
                h=grid.cell,
                density=self.setup.density,
            ).of_whole_body(mirror_cuts)
            body_action, parts = actions[0], actions if len(rows) == 1 else actions[1:]
            pressed = np.zeros((len(rows), 1 + grid.ndim))
            if len(water.immersion_sums) > len(water.rows):
                scale = 2 ** sum(mirror_cuts) * self.setup.density * grid.cell ** (grid.ndim + 1) / dt
                pressed = scale * water.internal_pressure_sums[rows.start : rows.stop]
                pressed[:, 1:] = grid.cell * pressed[:, 1:] - pressed[:, :1] * (position - np.array(grid.origin))
            loads.append(FlowLoads(reference_point=position, total=body_action, parts=parts, internal_pressure=pressed))
        return loads

    def control(self, water: Fluid, dt: float, push: tuple[float, ...]) -> None:
        """Append the force from the control volumes, if there are any."""
        for box in self.controls:
            self.control_rows.append(box.force(water, dt, push, self.setup.density))

    def refuse_nonsense(self, fastest: float, reference: float, row: np.ndarray, good: dict[str, np.ndarray]) -> None:
        """Refuse fields that are not finite or far too fast; the error has the last good velocities.

        Args:
            fastest: fastest water now [m/s].
            reference: fastest stream, body or wall so far, or water at the start [m/s].
            row: the row of the record that just came out.
            good: velocities before the step [m/s].

        Raises:
            Diverged: saying when, and what to change.
        """
        if (
            np.isfinite(fastest)
            and np.isfinite(row).all()
            and not (reference > 0 and fastest > MAX_SPEED_RATIO * reference)
        ):
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
        bodies, names = self.setup.bodies, COLUMNS if self.setup.grid.ndim == 2 else SPACE_COLUMNS
        counts = [
            len(rows) if _is_divided(body) else 1 for body, rows in zip(bodies, rows_of(list(bodies)), strict=True)
        ]
        body_columns, parts = len(bodies) * len(names), sum(n for n in counts if n > 1)
        rows = np.array(self.rows).reshape(len(self.rows), ROW_HEADER_SIZE + body_columns + parts * len(PART_COLUMNS))
        return Record(
            names=tuple(b.name for b in bodies), time=rows[:, 0], step=rows[:, 1], cycles=rows[:, 2:4].astype(int),
            divergence=rows[:, 4],
            bodies=rows[:, ROW_HEADER_SIZE : ROW_HEADER_SIZE + body_columns].reshape(len(rows), len(bodies),
            len(names)),
            columns=names, parts=rows[:, ROW_HEADER_SIZE + body_columns :].reshape(len(rows), parts, len(PART_COLUMNS)),
            divided=tuple(n if n > 1 else 0 for n in counts),
        )  # fmt: skip


def _is_divided(body: AnyBody) -> bool:
    """Return whether the record has the parts of a body: those along a midline."""
    return isinstance(body.shape, Spined)


def columns(load: Load | None, act: Reaction, frame: np.ndarray, place: Pose, error: float) -> list[float]:
    """Return the columns of the record of one body.

    Args:
        load: pressure and friction along its outline; None in space.
        act: load of the water on the body.
        frame: mean velocity of the grid [m/s].
        place: pose of the body.
        error: estimated error of its force [-].
    """
    power = float(act.power - frame @ act.force)
    surface_forces = () if load is None else (*load.pressure, *load.shear)
    flat = len(act.moment) == 1
    angles = (place.angle,) if flat else (place.angle, place.pitch, place.roll)
    spins = (place.spin,) if flat else (place.spin_x, place.spin_y, place.spin)
    return [
        *surface_forces, *act.moment, power, *place.position, *angles, *place.velocity, *spins, *act.force, error
    ]  # fmt: skip


def part_columns(
    body: AnyBody, acts: Reaction, reference_point: tuple[float, ...], pose: Pose, time: float, frame: np.ndarray
) -> list[float]:
    """Return ``record.PART_COLUMNS`` of a body's parts one after the other; nothing of a body of one part.

    Args:
        body: which.
        acts: load of the water on each part, its torque about one point.
        reference_point: that point, in the frame of the grid [m].
        pose: pose of the body, in the frame of the grid.
        time: end of the step [s].
        frame: mean velocity of the grid [m/s].
    """
    force, torque = acts.force, acts.moment
    if len(force) < 2 or not _is_divided(body):
        return []
    assert isinstance(body.shape, Spined)
    power = acts.power - force @ frame
    rear_force, rear_moment = (load[::-1].cumsum(axis=0)[::-1] for load in (force, torque))
    ends = body.shape.position_at(time, pose, np.array([0.0, *body.shape.cuts])) - np.array(reference_point)
    if len(reference_point) == 2:
        joint = rear_moment[:, 0] - (ends[:, 0] * rear_force[:, 1] - ends[:, 1] * rear_force[:, 0])
    else:  # the midline bends about the body's z
        joint = (rear_moment - np.stack(cross(ends.T, rear_force.T), axis=1)) @ pose.matrix[:, 2]
    columns: list[float] = np.column_stack([force[:, :2], torque[:, -1], power, joint]).ravel().tolist()
    return columns

"""A flow under way: steps, runs with progress and checkpoints, and shows its fields."""

from collections.abc import Callable
from pathlib import Path

import numba
import numpy as np

from suchus import threads
from suchus.errors import Diverged, OutsideLimits
from suchus.flow import checkpoint as store
from suchus.flow.added import added_mass
from suchus.flow.body import Body
from suchus.flow.compiled import PAD
from suchus.flow.force import ControlVolume, Surface, edge_mean, sample
from suchus.flow.free import FreeBody, Swimmer
from suchus.flow.immerse import wall_offset
from suchus.flow.pose import Pose
from suchus.flow.progress import Bar
from suchus.flow.record import COLUMNS, Record
from suchus.flow.setup import Setup
from suchus.flow.shape import Markers
from suchus.flow.water import Water

ADDED_EVERY = 8
"""Steps after which a free body's added mass is computed anew [-]."""

FASTEST = 100.0
"""Speed, over that of stream and bodies, above which a simulation counts as diverged [-]."""


def _fastest_marker(markers: Markers) -> float:
    """Return the fastest speed of a body's surface in the frame of the grid [m/s]."""
    return float(np.hypot(markers.velocity_x, markers.velocity_y).max())


LANDING = 16
"""Steps before the end of a run over which the time step is evened out, so that the last one is no jolt [-]."""


def _even(dt: float, left: float) -> float:
    """Return the step that arrives in whole steps, once the end is near [s]."""
    count = np.ceil(left / dt * (1 - 1e-9))
    return float(left / count) if count <= LANDING else dt


class Simulation:
    """A flow that starts with the water moving like the far stream and goes on step by step.

    Attributes:
        setup: what is simulated.
        time: how far it has come [s].
        water: velocity and pressure.
        thin: per body, the share of its length that is too thin for the grid to hold the water back.
    """

    def __init__(self, setup: Setup, *, thread_count: int | None = None) -> None:
        self.setup = setup
        self.thin = setup.check()
        self.time = 0.0
        self.water = Water(setup.grid, setup.sides, setup.viscosity, setup.dtype)
        self.frame = np.zeros((2, 2))  # position and velocity of the grid
        self.swimmers = {b.name: Swimmer.of(b) for b in setup.bodies if isinstance(b, FreeBody)}
        self._threads = threads.count() if thread_count is None else thread_count
        self._rows: list[np.ndarray] = []
        self._controls: list[ControlVolume] = []
        self._control_rows: list[tuple[float, float]] = []
        self._last = 0.0
        self._frame_velocity_at(0.0)
        stream = self._stream(0.0)
        self.water.u[:], self.water.v[:] = stream
        self.water.border.stream = stream
        self._placed = False
        outlines = [b.shape.markers(0.0, self._in_frame(self.pose(b.name)), setup.grid.cell) for b in setup.bodies]
        self._speed = max([float(np.hypot(*stream)), 1e-12] + [_fastest_marker(m) for m in outlines])
        self._fastest = 0.0  # fastest water after the last step
        self._reference = 0.0  # fastest stream, body or wall so far
        self._peak = 2 * self._speed  # fastest water so far; beside a bluff body, twice the stream

    # --- state -------------------------------------------------------------------------------------------------

    def pose(self, name: str, time: float | None = None) -> Pose:
        """Return the pose of a body in the world, now or (unless it is free) at another time [s]."""
        body = next(b for b in self.setup.bodies if b.name == name)
        if isinstance(body, Body):
            return body.pose(self.time if time is None else time)
        return self.swimmers[name].pose(body.shape.mass(self.time if time is None else time))

    def _in_frame(self, pose: Pose) -> Pose:
        (fx, fy), (fu, fv) = self.frame
        return Pose(
            position=(pose.position[0] - fx, pose.position[1] - fy), angle=pose.angle,
            velocity=(pose.velocity[0] - fu, pose.velocity[1] - fv), spin=pose.spin,
        )  # fmt: skip

    def _stream(self, time: float) -> tuple[float, float]:
        u, v = self.setup.far(time)
        return float(u - self.frame[1, 0]), float(v - self.frame[1, 1])

    def _frame_velocity_at(self, time: float) -> None:
        if self.setup.follow is None:
            return
        name = self.setup.follow
        velocity = self.swimmers[name].rate[:2] if name in self.swimmers else np.array(self.pose(name, time).velocity)
        self.frame[1] = np.where(self.setup.follow_axes, velocity, 0.0)

    # --- one step ----------------------------------------------------------------------------------------------

    def next_step(self) -> float:
        """Return the time step that the fields allow [s].

        Raises:
            OutsideLimits: a fixed step is asked for and carries water over more than a cell.
        """
        fastest = max(self._fastest if self._rows else self.water.fastest(), self._speed)
        limit = self.setup.grid.cell / (fastest + 4 * float(self.water.nu))
        if self.setup.step is None:
            return self.setup.courant * limit
        if self.setup.step > 1.2 * limit:
            raise OutsideLimits(
                f"at t = {self.time:.4g} s a step of {self.setup.step:.3g} s has Courant number "
                f"{self.setup.step / limit:.3g}; above 1 it explodes. Take a step of at most {0.8 * limit:.3g} s, "
                f"or None."
            )
        return self.setup.step

    def advance(self, dt: float | None = None) -> None:
        """Advance by one step [s].

        Raises:
            Diverged: the fields are no longer finite or far too fast; the record's fields are the last good ones.
        """
        numba.set_num_threads(min(self._threads, numba.config.NUMBA_NUM_THREADS))
        if not self._rows:
            self._speed = max(self._speed, self.water.fastest(), self.setup.sides.fastest(self.setup.grid))
        dt = self.next_step() if dt is None else dt
        for swimmer in self.swimmers.values():
            swimmer.advance(self.time, dt, self.setup.density)
        old_frame = self.frame.copy()
        self._frame_velocity_at(self.time + dt)
        self.frame[0] += dt * 0.5 * (old_frame[1] + self.frame[1])
        time = self.time + dt
        poses = [self._in_frame(self.pose(b.name, time)) for b in self.setup.bodies]
        moving = self.setup.follow is not None or not all(b.still for b in self.setup.bodies)
        offset = wall_offset(float(self.water.nu), self._peak, self.setup.courant)
        if moving or not self._placed or abs(offset - self.water.offset) > 2e-3:
            self.water.offset = offset
            self.water.place(list(self.setup.bodies), poses, time)
            self._placed = True
        markers = [
            b.shape.markers(time, p, self.setup.grid.cell) for b, p in zip(self.setup.bodies, poses, strict=True)
        ]
        ahead = float(np.hypot(*self._stream(time)))
        self._speed = max([self._speed, ahead] + [_fastest_marker(m) for m in markers])  # it may just start to move
        push = tuple(-(self.frame[1] - old_frame[1]) / dt)
        limits = (self.setup.tolerance * self._speed, 10 * self.setup.tolerance * self._speed)
        self.water.step(dt, self._stream(time), (float(push[0]), float(push[1])), limits)
        self.time, self._last = time, dt
        self._note(dt, poses, markers, push)

    def _note(self, dt: float, poses: list[Pose], outlines: list[Markers], push: tuple[float, ...]) -> None:
        water, setup = self.water, self.setup
        fastest = self._fastest = water.fastest()
        row = np.zeros(5 + len(setup.bodies) * len(COLUMNS))
        body_speed = 0.0
        for k, (body, pose, markers) in enumerate(zip(setup.bodies, poses, outlines, strict=True)):
            surface = sample(water, markers, setup.density)
            swimmer = self.swimmers.get(body.name)
            about = pose.position if swimmer is None else tuple(swimmer.place[:2] - self.frame[0])
            load = surface.load((float(about[0]), float(about[1])))
            world = self.pose(body.name)
            row[5 + k * len(COLUMNS) : 5 + (k + 1) * len(COLUMNS)] = [
                *load.pressure, *load.shear, load.torque, load.power + float(self.frame[1] @ -np.array(load.force)),
                *world.position, world.angle, *world.velocity, world.spin,
            ]  # fmt: skip
            if swimmer is not None:
                row[5 + k * len(COLUMNS) + 6 : 5 + (k + 1) * len(COLUMNS)] = [*swimmer.place, *swimmer.rate]
                swimmer.load = np.array([*load.force, load.torque])
                if swimmer.steps % ADDED_EVERY == 1:
                    swimmer.added = added_mass(water, markers, (float(about[0]), float(about[1])), setup.density)
            body_speed = max(body_speed, _fastest_marker(markers))
        self._peak = max(self._peak, fastest)
        self._speed = max(float(np.hypot(*water.border.stream)), body_speed, min(fastest, 10 * self._speed), 1e-12)
        solves = water.solves
        row[:5] = [self.time, dt, solves[0].cycles, solves[1].cycles, solves[1].largest / self._speed]
        for control in self._controls:
            self._control_rows.append(control.force(water, dt, (push[0], push[1]), setup.density))
        self._reference = reference = max(
            self._reference, float(np.hypot(*water.border.stream)), body_speed, setup.sides.fastest(setup.grid)
        )
        if not np.isfinite(fastest) or not np.isfinite(row).all() or (reference > 0 and fastest > FASTEST * reference):
            good = {"u": water._u2.copy(), "v": water._v2.copy()}
            raise Diverged(
                f"at t = {self.time:.4g} s the fastest water moves with {fastest:.3g} m/s, where stream and bodies "
                f"have {reference:.3g} m/s; take a smaller courant (now {setup.courant}), a finer grid or a lower "
                f"Reynolds number. The last good velocities are in the error's record['u'] and ['v'].",
                time=self.time - dt, record={**good, "record": self.record},
            )  # fmt: skip
        self._rows.append(row)

    # --- a run -------------------------------------------------------------------------------------------------

    def run(
        self,
        until: float,
        *,
        watch: Callable[["Simulation"], None] | None = None,
        every: float | None = None,
        checkpoint: Path | str | None = None,
        checkpoint_every: float = 60.0,
        progress: bool = True,
    ) -> Record:
        """Advance until a time and return the record from the beginning.

        Args:
            until: time to reach, exactly [s].
            watch: called with the simulation whenever ``every`` seconds of flow time have passed, and at the end.
            every: interval of ``watch`` [s]; None calls it after every step.
            checkpoint: file that the state is saved to; if it exists, the run goes on from there.
            checkpoint_every: wall-clock seconds between two savings [s].
            progress: whether a run longer than two seconds shows a progress bar.

        Raises:
            Diverged: see ``advance``.
            UnreadableFile: the checkpoint is broken or belongs to another setup.
            Unwritable: the checkpoint cannot be written.
        """
        path = None if checkpoint is None else Path(checkpoint)
        if path is not None and path.exists():
            store.load(self, path)
        cells = self.setup.grid.cells[0] * self.setup.grid.cells[1]
        due = self._due(every)
        saver = store.Saver(path, checkpoint_every)
        with Bar(self.time, until, cells, show=progress) as bar:
            try:
                while self.time < until * (1 - 1e-12):
                    self.advance(_even(self.next_step(), until - self.time))
                    if until - self.time < 1e-6 * self._last:  # rounding must not leave a tiny last step
                        self.time = until
                    bar.move(self.time)
                    if watch is not None and (self.time >= due or self.time == until):
                        watch(self)
                        due = self._due(every)
                    saver.save(self)
            finally:
                saver.save(self, now=True)
        return self.record

    def _due(self, every: float | None) -> float:
        return 0.0 if every is None else (np.floor(self.time / every * (1 + 1e-12)) + 1) * every * (1 - 1e-12)

    def control(self, margin: float) -> None:
        """Follow the momentum through a box ``margin`` [m] around the bodies; see ``control_forces``."""
        if not self._placed:
            poses = [self._in_frame(self.pose(b.name)) for b in self.setup.bodies]
            self.water.place(list(self.setup.bodies), poses, self.time)
        j0, j1, i0, i1 = self.water.window
        k = round(margin / self.setup.grid.cell)
        nx, ny = self.setup.grid.cells
        box = (max(j0 - k, PAD + 2), min(j1 + k, PAD + ny - 2), max(i0 - k, PAD + 2), min(i1 + k, PAD + nx - 2))
        self._controls = [ControlVolume(box)]

    @property
    def control_forces(self) -> np.ndarray:
        """Force on all bodies from the momentum through the box, one row per step since ``control`` [N/m]."""
        return np.array(self._control_rows).reshape(-1, 2)

    # --- what there is to see ----------------------------------------------------------------------------------

    @property
    def record(self) -> Record:
        """The time series so far."""
        n = len(self.setup.bodies)
        rows = np.array(self._rows).reshape(len(self._rows), 5 + n * len(COLUMNS))
        return Record(
            names=tuple(b.name for b in self.setup.bodies), time=rows[:, 0], step=rows[:, 1],
            cycles=rows[:, 2:4].astype(int), divergence=rows[:, 4],
            bodies=rows[:, 5:].reshape(len(rows), n, len(COLUMNS)),
        )  # fmt: skip

    def surface(self, name: str | None = None) -> Surface:
        """Return pressure and friction along a body's outline, positions in the frame of the grid."""
        body = next(b for b in self.setup.bodies if name in (None, b.name))
        pose = self._in_frame(self.pose(body.name))
        return sample(self.water, body.shape.markers(self.time, pose, self.setup.grid.cell), self.setup.density)

    @property
    def velocity(self) -> tuple[np.ndarray, np.ndarray]:
        """Velocity relative to the grid at the cell centres, two arrays of shape (ny, nx) [m/s]."""
        u, v = self.water.u, self.water.v
        inner = np.s_[PAD:-PAD, PAD:-PAD]
        return (
            0.5 * (u[inner] + u[PAD:-PAD, PAD + 1 : u.shape[1] - PAD + 1]),
            0.5 * (v[inner] + v[PAD + 1 : v.shape[0] - PAD + 1, PAD:-PAD]),
        )

    @property
    def pressure(self) -> np.ndarray:
        """Pressure at the cell centres, zero on the average along the sides, shape (ny, nx) [Pa]."""
        p = self.water.p
        return self.setup.density * (p[PAD:-PAD, PAD:-PAD] - self.water.dtype(edge_mean(p)))

    @property
    def vorticity(self) -> np.ndarray:
        """Vorticity at the inner corners of the cells, shape (ny - 1, nx - 1) [1/s]."""
        u, v = self.water.u, self.water.v
        a, b = PAD + 1, -PAD
        return ((v[a:b, a:b] - v[a:b, a - 1 : b - 1]) - (u[a:b, a:b] - u[a - 1 : b - 1, a:b])) / self.setup.grid.cell

    @property
    def fluid_share(self) -> np.ndarray:
        """Share of the fluid at the cell centres, 0 inside the bodies and 1 outside, shape (ny, nx) [-]."""
        mu0_u, mu0_v = self.water.mu0
        a, b = PAD, -PAD
        return 0.25 * (
            mu0_u[a:b, a:b] + mu0_u[a:b, a + 1 : mu0_u.shape[1] + b + 1]
            + mu0_v[a:b, a:b] + mu0_v[a + 1 : mu0_v.shape[0] + b + 1, a:b]
        )  # fmt: skip

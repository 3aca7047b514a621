"""A running flow simulation: time steps, runs with progress and checkpoints, and access to the fields."""

from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import replace
from math import isfinite, prod
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np

from suchus.core import threads
from suchus.core.errors import InvalidDesign, OutsideLimits, UnknownName
from suchus.core.kinds import is_number, show
from suchus.flow import checkpoint as store
from suchus.flow import contact
from suchus.flow.added import AddedMass, added_mass, generalised_added_mass, symmetric
from suchus.flow.ahead import precompile
from suchus.flow.body import AnyBody, Body
from suchus.flow.compiled import PAD
from suchus.flow.consistency import Consistency, LinkSource, MidlineSource, MotionSource
from suchus.flow.fields import Fields
from suchus.flow.force import ControlVolume, Surface, sample
from suchus.flow.free import FreeBody
from suchus.flow.immerse import wall_offset
from suchus.flow.linked import Linked
from suchus.flow.log import FlowLoads, Log, columns, part_columns
from suchus.flow.markers import Markers, kernel_array, max_speed
from suchus.flow.memory import Snapshot, restore_snapshot, take_snapshot
from suchus.flow.midline import CachedMidline, Spined
from suchus.flow.nest import Nested
from suchus.flow.pose import CachedMotion, Pose, length, speeds
from suchus.flow.progress import Bar
from suchus.flow.rake import due_after
from suchus.flow.record import Record
from suchus.flow.resolution import estimate_force_error
from suchus.flow.setup import Setup
from suchus.flow.solid import Cylinder, Sphere
from suchus.flow.swimmer import Swimmer
from suchus.flow.twist import Twists, accelerate, add_twists, join_twists, resting_twists
from suchus.flow.watch import SIDE_CHECK_INTERVAL, Watch
from suchus.flow.water import Fluid

MIN_THREAD_CELLS = 16_384
"""Cells for each thread of the kernels: on fewer, threads wait for each other longer than they compute [-]."""

ADDED_MASS_INTERVAL = 8
"""Steps between two computations of a free body's added mass [-]."""

RATE_CHECK_INTERVAL = 8
"""Steps between two comparisons of a bending body's rates with its positions [-]."""

LAYER_SPEED_FACTOR = 1.5
"""Factor by which a moving body may exceed the speed that the grid resolves before the run stops [-]."""

MAX_STEP_RATIO = 1.2
"""Largest step over the one in which the fastest water or body crosses a cell [-]."""

OFFSET_TOLERANCE = 1e-3
"""Change of the wall offset above which bodies at rest are placed again [cells]; it changes a force by 0.04 %."""


def _remembering(body: AnyBody, ndim: int) -> AnyBody:
    """Return a body whose motion and midline, if it has one, are cached for each time within a step.

    Its poses have as many components as the domain has axes.

    Args:
        body: the body.
        ndim: number of axes of the domain, 2 or 3.
    """
    if isinstance(body, Body):
        checked = body.pose
        is_fixed = isinstance(body.motion, Pose)
        motion = CachedMotion(lambda time: checked(time).in_dimensions(ndim))
        body = replace(body, motion=checked(0.0).in_dimensions(ndim) if is_fixed else motion)
    if not isinstance(body.shape, Spined):
        return body
    shape = copy(body.shape)
    object.__setattr__(shape, "spine", CachedMidline(shape.spine))
    return replace(body, shape=shape)


def _fastest_marker(markers: Markers) -> float:
    """Return the fastest speed of a body's surface in the frame of the grid [m/s]."""
    speed: float = max_speed(kernel_array(markers.velocities), np.zeros(len(markers.velocities)))
    return speed


Watcher = Callable[["Simulation"], None]
"""Function that is called with the simulation during a run."""

_CHANGING = {"time": "time", "_last": "_last_step", "_speed": "_speed", "_reference": "_reference"}
"""Numbers that change, by their key in a checkpoint."""

MAX_EVENED_STEPS = 16
"""Steps before the end of a run over which the time step is evened out, so that the last step is not much shorter
[-]."""


class Simulation(Fields):
    """A flow that starts with the velocity of the far stream and advances step by step.

    Attributes:
        setup: what is simulated.
        time: time reached [s].
        water: velocity and pressure.
        thin_fractions: for each body, the fraction of its length that is thinner than the kernel: no water passes it,
            but its force is noisy.
    """

    def __init__(self, setup: Setup, *, thread_count: int | None = None) -> None:
        """Check the setup and place bodies and water at time 0.

        Args:
            setup: what is simulated.
            thread_count: threads of the kernels; None takes those of ``threads.count``, and fewer for a small grid [-].

        Raises:
            InvalidDesign: bodies overlap, or see ``Setup.check_bodies``.
        """
        self.setup = setup
        self.thin_fractions = setup.check_bodies()
        precompile(setup.grid.ndim, setup.dtype)
        self.time = 0.0
        options = setup.sides, setup.viscosity, setup.dtype, setup.scheme, setup.integrator
        self.water = (
            Fluid(setup.grid, *options)
            if setup.coarse_grid is None
            else Nested(setup.grid, setup.coarse_grid, *options)
        )
        self.ndim = setup.grid.ndim
        self.frame = np.zeros((2, self.ndim))  # position and velocity of the grid
        self._bodies = [_remembering(body, self.ndim) for body in setup.bodies]
        self._numbers = {body.name: number for number, body in enumerate(self._bodies)}
        self.swimmers = {b.name: Swimmer.from_body(b) for b in self._bodies if isinstance(b, FreeBody)}
        cells = sum(prod(layer.grid.cells) for layer in self.water.layers)
        max_threads = max(1, cells // MIN_THREAD_CELLS)
        self._threads = min(threads.count(), max_threads) if thread_count is None else thread_count
        if self._threads < 1:
            raise OutsideLimits(f"a simulation is to use {thread_count} threads; give at least 1.")
        self._log, self._watch = Log(setup), Watch(setup)
        self._last_step = 0.0
        self._frame_velocity_at(0.0)
        stream = self._stream(0.0)
        for layer in self.water.layers:
            for c, component in enumerate(layer.velocity):
                component[:] = setup.initial_velocity(c, layer.grid) - self.frame[1, c]
            layer.border.stream = stream
        self._walls = contact.wall_planes(setup.sides, setup.coarse_grid or setup.grid)
        self._is_placed, self._are_static = False, all(b.is_static for b in self._bodies)
        self._layer_stream: tuple[float, ...] | None = None
        self._starts_at_once = length(stream) > 0 and setup.start is None
        self._latest_step: _LatestStep | None = None
        self._loads: list[FlowLoads] = []
        self._poses: list[Pose] = []  # of bodies at the end of the last step, in the frame of the grid
        self._fastest_marker_speed: tuple[list[Markers], float] | None = None
        self._outlines = outlines = [
            b.shape.markers(0.0, self._in_frame(self.pose(b.name)), setup.grid.cell) for b in self._bodies
        ]
        self._speed = max([length(stream), 1e-12] + [_fastest_marker(m) for m in outlines])
        self._fastest = 0.0  # fastest water after the last step
        self._reference = 0.0  # fastest stream, body or wall so far
        self._reaches = {
            body.name: float(speeds(outline.points - np.array(self._torque_point(body.name, Pose()))[:, None]).max())
            for body, outline in zip(self._bodies, outlines, strict=True)
            if body.name in self.swimmers
        }
        self.water.place(self._bodies, [self._in_frame(self.pose(b.name)) for b in self._bodies], 0.0)
        shared = self._watch.overlap_message(self.water, 0.0)
        if shared is not None:
            raise InvalidDesign(shared)
        for body, mirror_cuts in zip(self._bodies, self.water.mirror_cuts, strict=True):
            if isinstance(body, FreeBody) and body.free is None:
                self.swimmers[body.name].is_free &= np.array(symmetric(mirror_cuts))
        self._log.store_contents(self.water, outlines)
        self._refuse_passage(outlines, 0.0)
        self._watch.inputs()
        self._watch.layers(
            [setup.layer_error(b, m, stream, 0.0) for b, m in zip(self._bodies, outlines, strict=True)]
        )  # fmt: skip
        self._consistency_checks = [consistency for b in self._bodies for consistency in self._consistencies_of(b)]

    def _consistencies_of(self, body: AnyBody) -> list[Consistency]:
        """Return the checks that compare a body's prescribed rates with its positions during the run.

        All prescribed functions are checked once at time 0. Functions that never change are not checked again.
        """
        cell, consistencies, changing = self.setup.grid.cell, [], []
        if isinstance(body, Body):
            pose = body.pose(0.0)
            outline = body.shape.markers(0.0, pose, cell)
            reach = float(speeds(outline.points - np.array(pose.position)[:, None]).max())
            fixed = isinstance(body.motion, Pose)
            if fixed and isinstance(body.shape, Cylinder | Sphere):  # it may spin in place
                pose = replace(pose, spin=0.0, spin_x=0.0, spin_y=0.0)
            if not fixed or any(pose.velocity) or pose.spins.any():  # else nothing is to be compared
                source = MotionSource(
                    body.name, lambda t: pose if fixed else body.pose(t), reach
                )  # fmt: skip
                consistencies.append(Consistency(source, cell))
                changing.append(not fixed)
        if isinstance(body.shape, Spined):
            midline = MidlineSource(body.name, body.shape.spine)
            consistencies.append(Consistency(midline, cell, check_interval=RATE_CHECK_INTERVAL))
            changing.append(not body.shape.rigid)
        if isinstance(body.shape, Linked):
            links = LinkSource(body.name, body.shape.motion, body.shape.bounding_radii)
            consistencies.append(Consistency(links, cell, check_interval=RATE_CHECK_INTERVAL))
            changing.append(True)
        step = self.setup.step or self._limit(max(self.water.fastest(), self._speed))
        for consistency, is_changing in zip(consistencies, changing, strict=True):
            consistency.start(0.0, consistency.max_step(0.0, step))
            if not is_changing and isinstance(consistency.source, MidlineSource):
                consistency.source.refuse_motion(0.0, step, cell)
        return [consistency for consistency, is_changing in zip(consistencies, changing, strict=True) if is_changing]

    # --- state -------------------------------------------------------------------------------------------------

    def pose(self, name: str, time: float | None = None) -> Pose:
        """Return the pose of a body in the world frame.

        Args:
            name: name of the body.
            time: another time than the present one, for a body that is not free [s].
        """
        body = self._bodies[self._number(name)]
        if isinstance(body, Body):
            return body.pose(self.time if time is None else time)
        return self.swimmers[name].pose(body.shape.mass(self.time if time is None else time))

    def _in_frame(self, pose: Pose) -> Pose:
        """Return a pose of the world frame in the frame of the grid."""
        if self.setup.follow is None:  # the grid stays where it is
            return pose
        position, velocity = (
            tuple(a - b for a, b in zip(vector, frame, strict=True))
            for vector, frame in zip((pose.position, pose.velocity), self.frame, strict=True)
        )
        return replace(pose, position=position, velocity=velocity)

    def _stream(self, time: float) -> tuple[float, ...]:
        """Return the velocity of the far water in the frame of the grid [m/s]."""
        return tuple(
            float(component - frame_component)
            for component, frame_component in zip(self.setup.far_velocity(time), self.frame[1], strict=True)
        )

    def _frame_velocity_at(self, time: float) -> None:
        """Set the velocity of the grid to that of the body that it follows, at a time [s]."""
        if self.setup.follow is None:
            return
        name = self.setup.follow
        velocity = self.swimmers[name].rate if name in self.swimmers else np.array(self.pose(name, time).velocity)
        travels = self.setup.follow_axes[: self.ndim]
        self.frame[1, : len(travels)] = np.where(travels, velocity[: len(travels)], 0.0)

    # --- one step ----------------------------------------------------------------------------------------------

    def next_step(self) -> float:
        """Return the time step that the fields and the accelerations of the bodies allow [s].

        Raises:
            OutsideLimits: a fixed step is asked for in which water or a body moves by more than a cell.
        """
        self._set_first_speed()
        if not self._log.rows and not any(swimmer.added_mass.any() for swimmer in self.swimmers.values()):
            self._prepare_free_bodies(self.water.offset)
        limit = self._limit(max(self._fastest if self._log.rows else self.water.fastest(), self._speed))
        if self.setup.step is None:
            for consistency in self._consistency_checks:
                limit = consistency.max_step(self.time, limit)
            return self._accelerating_step(self.setup.courant * limit, self.setup.courant)
        self._refuse_long_step(self.setup.step, limit)
        longest = self._accelerating_step(self.setup.step, MAX_STEP_RATIO)
        if longest < self.setup.step:
            raise OutsideLimits(
                f"at t = {self.time:.4g} s a body accelerates so fast that it moves by more than a cell in a step of "
                f"{self.setup.step:.3g} s. Take a step of at most {0.8 * longest:.3g} s, or None."
            )
        return self.setup.step

    def _refuse_long_step(self, dt: float, limit: float) -> None:
        """Refuse a step in which water or a body moves by more than a cell.

        Args:
            dt: the step [s].
            limit: longest step by the speeds [s].

        Raises:
            OutsideLimits: with the Courant number and the step that is allowed.
        """
        if dt > MAX_STEP_RATIO * limit:
            raise OutsideLimits(
                f"at t = {self.time:.4g} s a step of {dt:.3g} s has Courant number {dt / limit:.3g}; above 1 it "
                f"explodes. Take a step of at most {0.8 * limit:.3g} s, or None."
            )

    def _accelerating_step(self, dt: float, courant: float) -> float:
        """Return the longest step in which no body that accelerates moves by more than a part of a cell [s].

        Args:
            dt: length of the step that the speeds allow [s].
            courant: that part [-].
        """
        max_distance, contacts = courant * self.setup.grid.cell, self._contacts(dt)
        for name, swimmer in self.swimmers.items():
            if self.setup.contact is None and not swimmer.is_pushed(self.setup.density):
                continue  # the water alone moves it, and its speed bounds the step
            relative_to = self.frame[1].copy()
            if name == self.setup.follow:  # the water passes it, and it does not move in the grid
                travels = (*self.setup.follow_axes, False)[: self.ndim]
                relative_to = np.where(travels, self.setup.far_velocity(self.time), relative_to)
            dt = swimmer.max_step(
                self.time, dt, self.setup.density, contacts.get(name), relative_to, self._reaches[name],
                max_distance,
            )  # fmt: skip
        return dt

    def _prepare_free_bodies(self, offset: float) -> None:
        """Compute the added mass of bodies that are pushed and have not moved yet; their first step needs it.

        Args:
            offset: offset of the wall in the first step [cells].
        """
        if self._log.rows:
            return
        numbers = [
            k
            for k, body in enumerate(self._bodies)
            if body.name in self.swimmers
            and (self.swimmers[body.name].is_pushed(self.setup.density) or self.setup.contact is not None)
        ]
        if not numbers:
            return
        if offset != self.water.offset:
            self.water.offset = offset
            self.water.place(self._bodies, [self._in_frame(self.pose(b.name)) for b in self._bodies], self.time)
        for number in numbers:
            point = self._torque_point(self._bodies[number].name, Pose())
            self._set_added_mass(number, point)

    def _set_added_mass(self, number: int, point: tuple[float, ...]) -> None:
        """Compute the added mass of a free body in the placed water.

        Args:
            number: index of the body.
            point: its centre of mass, in the frame of the grid [m].
        """
        swimmer = self.swimmers[self._bodies[number].name]
        if swimmer.is_free.any():
            free_degrees = swimmer.is_free if self.ndim == 3 else None
            mass = added_mass(self.water, self._outlines[number], point, self.setup.density, number, free_degrees)
            swimmer.set_added_mass(mass, self.time)

    def _set_first_speed(self) -> None:
        """Before the first step, take the speeds of the water and of what the sides impose, as of a lid that moves."""
        if not self._log.rows:
            self._reference = self.water.fastest()
            self._speed = max(self._speed, self._reference, self.water.imposed(self.time))

    def _limit(self, fastest: float) -> float:
        """Return the time step at which the fastest water crosses one cell, with a margin for friction [s]."""
        return self.setup.grid.cell / (fastest + 2 * self.ndim * float(self.water.nu))

    def advance(self, dt: float | None = None) -> None:
        """Advance by one step.

        Args:
            dt: length of the step; None takes ``next_step`` [s].

        Raises:
            Diverged: the fields are not finite or far too fast; the record's fields are those of the last valid step.
            InvalidDesign: a body leaves the domain, is too fast for the grid, or its rates do not match its positions.
            OutsideLimits: ``dt`` is not positive, or water or a body would move by more than a cell.
        """
        numba.set_num_threads(min(self._threads, numba.config.NUMBA_NUM_THREADS))
        self._set_first_speed()
        dt = self.next_step() if dt is None else dt
        if not (is_number(dt) and isfinite(dt) and dt > 0):
            raise OutsideLimits(
                f"a step is to last {show(dt)} s; give a positive time, or None to let the solver choose."
            )
        self._refuse_long_step(dt, self._limit(max(self._fastest, self._speed)))
        for consistency in self._consistency_checks:
            consistency.check_step(self.time, dt)
        offset = wall_offset(float(self.water.nu) * dt / self.setup.grid.cell)
        self._prepare_free_bodies(offset)
        contacts = self._contacts(dt)
        for name, swimmer in self.swimmers.items():
            swimmer.advance(self.time, dt, self.setup.density, contacts.get(name))
        old_frame = self.frame.copy()
        self._frame_velocity_at(self.time + dt)
        self.frame[0] += dt * 0.5 * (old_frame[1] + self.frame[1])
        time = self.time + dt
        moving = self.setup.follow is not None or not self._are_static
        if moving or not self._is_placed:
            self._poses = [self._in_frame(self.pose(b.name, time)) for b in self._bodies]
        poses = self._poses
        has_new_places = moving or not self._is_placed or abs(offset - self.water.offset) > OFFSET_TOLERANCE
        if has_new_places:
            self.water.offset = offset
            self.water.place(self._bodies, poses, time)
            self._is_placed = True
            self._watch.overlap(self.water, time)
        if moving:
            cell = self.setup.grid.cell
            self._outlines = [b.shape.markers(time, p, cell) for b, p in zip(self._bodies, poses, strict=True)]
            self._refuse_passage(self._outlines, time)
        stream = self._stream(time)
        if has_new_places or stream != self._layer_stream:
            self._layer_stream = stream
            self._watch.layers(
                [
                    self.setup.layer_error(b, m, stream, time, slack=LAYER_SPEED_FACTOR)
                    for b, m in zip(self._bodies, self._outlines, strict=True)
                ]
            )
        imposed_speed = self.water.imposed(time)
        body_speed = self._body_speed()  # a body may just start to move
        self._speed = max(self._speed, length(stream), imposed_speed, body_speed)
        push = tuple(-(self.frame[1] - old_frame[1]) / dt)
        limits = (self.setup.tolerance * self._speed, 10 * self.setup.tolerance * self._speed)
        self.water.step(dt, stream, tuple(map(float, push)), limits, time)
        self.time, self._last_step = time, dt
        drift = 0.5 * (old_frame[1] + self.frame[1])
        contents = self._log.region_contents
        self._latest_step = _LatestStep(dt, poses, push, drift, contents, body_speed, imposed_speed)
        self._note(self._latest_step, has_new_places=has_new_places)
        self._log.control(self.water, dt, push)

    def _body_speed(self) -> float:
        """Return the fastest speed of the bodies' surfaces in the frame of the grid [m/s]."""
        if self._fastest_marker_speed is None or self._fastest_marker_speed[0] is not self._outlines:
            speed = max(map(_fastest_marker, self._outlines), default=0.0)
            self._fastest_marker_speed = self._outlines, speed
        return self._fastest_marker_speed[1]

    def _contacts(self, dt: float) -> dict[str, np.ndarray]:
        """Return the contact force and torque on each body in the middle of the next step, by name [N/m, N].

        Args:
            dt: length of that step [s].
        """
        setup = self.setup
        if setup.contact is None or not self.swimmers:
            return {}
        outlines, centres = [], []
        for body in self._bodies:
            outline = body.shape.markers(self.time, self.pose(body.name), setup.grid.cell)
            half_step = 0.5 * dt
            outlines.append(replace(outline, points=outline.points + half_step * outline.velocities))
            swimmer = self.swimmers.get(body.name)
            centres.append(
                np.zeros(self.ndim)
                if swimmer is None
                else swimmer.coordinates[: self.ndim] + half_step * swimmer.rate[: self.ndim]
            )
        contact_forces = contact.forces(setup.contact, outlines, centres, self._walls)
        return dict(zip([b.name for b in self._bodies], contact_forces, strict=True))

    def _refuse_passage(self, outlines: Sequence[Markers], time: float) -> None:
        """Refuse a body that has gone through a wall, and warn of one that is too near to it.

        Args:
            outlines: outlines or skins of the bodies, in the frame of the grid.
            time: time, for the message [s].

        Raises:
            InvalidDesign: naming body, wall and remedy.
        """
        cell = self.setup.grid.cell
        for wall in self._walls:
            for body, outline in zip(self._bodies, outlines, strict=True):
                clearance = float(wall.distances(outline.points).min())
                if clearance < -contact.MAX_WALL_DEPTH * cell:
                    raise InvalidDesign(self._passage_text(body, outline, wall, -clearance, time))
                if clearance < contact.MIN_WALL_CLEARANCE * cell:
                    self._watch.clearance(body, wall, clearance, time)

    def _passage_text(
        self, body: AnyBody, outline: Markers, wall: contact.WallPlane, depth: float, time: float
    ) -> str:  # fmt: skip
        """Return the message about a body that has gone through a wall.

        Args:
            body: the body.
            outline: its outline or skin, in the frame of the grid.
            wall: the wall.
            depth: how far it lies beyond the wall [m].
            time: time [s].
        """
        text = (
            f"at t = {time:.4g} s {body.name} lies {depth:.3g} m deep in the {wall.name} side, a "
            f"{type(getattr(self.setup.sides, wall.name)).__name__} at {'xyz'[wall.axis]} = {wall.position:.6g} m"
        )
        if body.name not in self.swimmers:
            return f"{text}: give a motion that stays in the water, or enlarge the grid."
        law, cell = self.setup.contact, self.setup.grid.cell
        gap = 2.5 * cell if law is None else law.gap
        tangential = [float(np.ptp(line)) for d, line in enumerate(outline.points) if d != wall.axis]
        weight = abs(self.swimmers[body.name].applied[wall.axis]) if law is None else 0.0
        mass = (body.density or self.setup.density) * body.shape.mass(time).volume  # type: ignore[union-attr]
        speed = self._fastest_approach(body.name, outline, wall)
        needed = (3.0 * mass * speed**2 / gap + 4 * weight) / prod(tangential)
        if law is not None:
            needed = max(needed, 4 * law.pressure)
        return (
            f"{text}, and moved towards it with up to {speed:.3g} m/s: give contact=BodyContact(gap={gap:.3g}, "
            f"pressure={needed:.2g}){'' if law is None else f', whose pressure is now {law.pressure:.3g} Pa'}."
        )

    def _fastest_approach(self, name: str, outline: Markers, wall: contact.WallPlane) -> float:
        """Return the largest speed with which a body has moved towards a wall so far [m/s].

        The film of water has slowed the body by the time at which it reaches the wall.

        Args:
            name: name of the body.
            outline: its outline or skin now, in the frame of the grid.
            wall: the wall.
        """
        velocities = [float(outline.velocities[wall.axis].mean())]
        if self._log.rows:
            velocities += self._log.record.column(f"velocity_{'xyz'[wall.axis]}", name).tolist()
        return max(0.0, *(-wall.inward * velocity for velocity in velocities))

    def _torque_point(self, name: str, pose: Pose) -> tuple[float, ...]:
        """Return the reference point of a body's torque in the frame of the grid [m]."""
        if name not in self.swimmers:
            return pose.position
        return tuple((np.array(self.swimmers[name].place_and_rate.position) - self.frame[0]).tolist())

    def _note(self, step: "_LatestStep", *, has_new_places: bool) -> None:
        """Compute the forces of a step, give them to the free bodies, and append a row to the record.

        Args:
            step: the step, whose fields are those of the water now.
            has_new_places: whether the bodies, or their velocities, have been placed in the water in this step.
        """
        water, setup, dt, poses, outlines = self.water, self.setup, step.dt, step.poses, self._outlines
        fastest = self._fastest = water.fastest()
        torque_points = [self._torque_point(b.name, p) for b, p in zip(self._bodies, poses, strict=True)]
        if has_new_places:
            self._log.store_contents(water, outlines)
        values: list[float] = []
        self._loads = self._log.reactions(water, torque_points, dt, step.push, step.contents_before)
        part_values: list[float] = []
        for k, (body, markers, point, loads) in enumerate(
            zip(self._bodies, outlines, torque_points, self._loads, strict=True)
        ):  # fmt: skip
            act = loads.total
            load = sample(water, markers, setup.density).load(point) if water.ndim == 2 else None
            body_pose = self.pose(body.name)
            swimmer = self.swimmers.get(body.name)
            if swimmer is not None:
                body_pose = swimmer.place_and_rate
                swimmer.load = np.array([*act.force, *act.moment])
                if swimmer.steps % ADDED_MASS_INTERVAL == 1:
                    self._set_added_mass(k, point)
            error = max(self._watch.errors[k], self._start_error(body))
            values += columns(load, act, step.drift, body_pose, error)
            part_values += part_columns(body, loads.parts, point, poses[k], self.time, step.drift)
        stream_speed, body_speed = length(water.border.stream), step.body_speed
        self._speed = max(stream_speed, body_speed, min(fastest, 10 * self._speed), 1e-12)
        self._reference = max(self._reference, stream_speed, body_speed, step.imposed_speed)
        solves = water.solves
        row = np.array(
            [
                self.time, dt, solves[0].cycles, solves[-1].cycles, solves[-1].max_divergence / self._speed, *values,
                *part_values,
            ]
        )  # fmt: skip
        good = dict(zip("uvw", water.previous_velocity, strict=False))
        self._log.refuse_nonsense(fastest, self._reference, row, good)
        self._log.rows.append(row)
        if len(self._log.rows) % SIDE_CHECK_INTERVAL == 0:
            self._watch.sides(water, self.time)
            self._watch.wakes(water, self.time)
            self._watch.headings(self.time)

    def _start_error(self, body: AnyBody) -> float:
        """Return the estimated error of a body's force while the boundary layer of a sudden start grows [-].

        The layer is ``sqrt(viscosity time)`` thin until it is as thick as that of the steady flow.
        """
        if not self._starts_at_once:
            return 0.0
        cells = float(np.sqrt(self.setup.viscosity * self.time)) / self.setup.grid.cell
        return min(estimate_force_error(cells, is_compact=body.shape.is_compact), 1.0)

    def last_loads(self, name: str) -> FlowLoads:
        """Return the force of the water on a body and on each of its parts in the last step.

        Args:
            name: name of the body.

        Raises:
            UnknownName: there is no such body.
            OutsideLimits: no step has been taken since the simulation was set up or resumed.
        """
        if self._latest_step is None:
            raise OutsideLimits("the loads of the last step are asked for before any step was taken; call advance.")
        return self._loads[self._number(name)]

    @property
    def drift(self) -> np.ndarray:
        """Mean velocity of the grid in the last step, shape (axis,) [m/s]."""
        return np.zeros(self.ndim) if self._latest_step is None else self._latest_step.drift

    def accelerate(self, twists: Mapping[str, Twists]) -> None:
        """Change the velocities of bodies at the end of the last step, and let the water follow; see ``twist``.

        The last row of the record is computed anew. From now on, the shape and motion of a ``Body``, which are
        prescribed from outside, must match the new velocities.

        Args:
            twists: change of the velocity of each part, by name of the body.

        Raises:
            UnknownName: there is no such body.
            InvalidDesign: the number of twists is not the number of the body's parts.
            OutsideLimits: no step has been taken yet.
            Diverged: see ``advance``.
        """
        if self._latest_step is None:
            raise OutsideLimits("bodies are to be accelerated before any step was taken; call advance first.")
        body_twists = [resting_twists(len(rows), self.ndim) for rows in self.water.rows]
        for name, motion in twists.items():
            number = self._number(name)
            if motion.reference_points.shape != body_twists[number].reference_points.shape:
                raise InvalidDesign(
                    f"{name} is given the motions of {len(motion.reference_points)} parts, and it has "
                    f"{len(body_twists[number].reference_points)}; give one for each part, from the first to the last."
                )
            body_twists[number] = motion
        accelerate(self.water, join_twists(body_twists), self._latest_step.dt)
        self._outlines = [
            add_twists(outline, motion) for outline, motion in zip(self._outlines, body_twists, strict=True)
        ]
        self.clear_shape_cache()
        self._log.rows.pop()
        self._latest_step = self._latest_step._replace(body_speed=self._body_speed())
        self._note(self._latest_step, has_new_places=True)

    def added_mass(self, name: str, modes: Sequence[Twists]) -> AddedMass:
        """Return the generalised added mass of a body for motions of its parts; sides and other bodies stay fixed.

        Args:
            name: name of the body.
            modes: motions of its parts, one a row of the matrix; see ``added.generalised_added_mass``.

        Raises:
            UnknownName: there is no such body.
            NotConverged: the pressure solver did not converge.
        """
        number = self._number(name)
        resting = [resting_twists(len(rows), self.ndim) for rows in self.water.rows]
        joined_modes = [join_twists([*resting[:number], mode, *resting[number + 1 :]]) for mode in modes]
        return generalised_added_mass(self.water, self._outlines, joined_modes, self.setup.density)

    def _number(self, name: str) -> int:
        """Return the index of a body by its name.

        Raises:
            UnknownName: there is no such body.
        """
        number = self._numbers.get(name)
        if number is None:
            raise UnknownName("body", name, list(self._numbers) or ("none",))
        return number

    def clear_shape_cache(self) -> None:
        """Clear the cached poses and midlines of all bodies, because the functions behind them have changed."""
        for body in self._bodies:
            if isinstance(body, Body) and isinstance(body.motion, CachedMotion):
                body.motion.clear()
            if isinstance(body.shape, Spined) and isinstance(body.shape.spine, CachedMidline):
                body.shape.spine.clear()

    def snapshot(self) -> Snapshot:
        """Return a copy of the whole state, for ``restore``."""
        return take_snapshot(self)

    def restore(self, snapshot: Snapshot) -> None:
        """Return to a snapshot of this simulation; the next steps repeat those after the snapshot byte by byte.

        Args:
            snapshot: see ``snapshot``.
        """
        restore_snapshot(self, snapshot)
        self.clear_shape_cache()
        self._latest_step = None
        if snapshot.arrays["b"].size:
            poses = [self._in_frame(self.pose(b.name)) for b in self._bodies]
            self.water.place(self._bodies, poses, self.time)
            self.water.b[:] = snapshot.arrays["b"]

    def state(self) -> store.State:
        """Return the whole state, for a checkpoint."""
        numbers = {key: np.array(getattr(self, name)) for key, name in _CHANGING.items()}
        rows = np.array(self._log.rows).reshape(len(self._log.rows), -1)
        swimmers = {f"{n}.{key}": value for n, s in self.swimmers.items() for key, value in s.state().items()}
        return {
            **numbers,
            **self.water.state(),
            **swimmers,
            "frame": self.frame,
            "rows": rows,
            "held": self._log.region_contents,
            "b": self.water.b,
        }

    def resume(self, state: store.State) -> None:
        """Continue from the state of a checkpoint.

        Args:
            state: see ``state``.
        """
        for key, name in _CHANGING.items():
            setattr(self, name, float(state[key]))
        self.frame = state["frame"]
        self._log.rows, self._log.region_contents = list(state["rows"]), state["held"]
        self.water.resume(state)
        self._fastest = self.water.fastest()
        for name, swimmer in self.swimmers.items():
            swimmer.resume({key.removeprefix(f"{name}."): state[key] for key in state if key.startswith(f"{name}.")})
        self.clear_shape_cache()
        self._poses = [self._in_frame(self.pose(b.name)) for b in self._bodies]
        self.water.place(self._bodies, self._poses, self.time)
        if self.water.b.shape == state["b"].shape:
            self.water.b[:] = state["b"]  # as it was after ``accelerate``
        self._is_placed = bool(self._log.rows)  # as in the continued run, which keeps its offset

    # --- a run -------------------------------------------------------------------------------------------------

    def run(
        self,
        end_time: float,
        *,
        watch: Watcher | Sequence[Watcher] | None = None,
        watch_interval: float | None = None,
        checkpoint: Path | str | None = None,
        checkpoint_every: float = 60.0,
        progress: bool = True,
    ) -> Record:
        """Advance until a time and return the record from the beginning.

        Args:
            end_time: time to reach, exactly [s].
            watch: called with the simulation whenever ``every`` seconds of flow time have passed, and at the end;
                one or several, such as a ``Rake`` or a ``FieldSeries``.
            watch_interval: interval of ``watch`` [s]; None calls it after every step.
            checkpoint: file that the state is saved to; if it exists, the run goes on from there.
            checkpoint_every: wall-clock seconds between two savings [s].
            progress: whether a run longer than two seconds shows a progress bar.

        Raises:
            Diverged: see ``advance``.
            UnreadableFile: the checkpoint is broken or belongs to another setup.
            Unwritable: the checkpoint cannot be written.
            OutsideLimits: ``until`` is not a time, or one that has passed.
        """
        if not (is_number(end_time) and isfinite(end_time)):
            raise OutsideLimits(f"the run is to last until {show(end_time)} s; give a finite time.")
        self._refuse_past(end_time, "the run", "a new Simulation")
        path = None if checkpoint is None else Path(checkpoint)
        if path is not None and path.exists():
            store.load(self, path)
            self._refuse_past(end_time, f"the run of the checkpoint {path}", "another file")
        cells = sum(prod(layer.grid.cells) for layer in self.water.layers)
        watchers = _watchers(watch)
        due = due_after(self.time, watch_interval)
        saver = store.Saver(path, checkpoint_every)
        with Bar(self.time, end_time, cells, show=progress) as bar:
            try:
                while self.time < end_time * (1 - 1e-12):
                    self.advance(_even_step(self.next_step(), end_time - self.time))
                    if end_time - self.time < 1e-6 * self._last_step:  # rounding must not leave a tiny last step
                        self.time = end_time
                    bar.move(self.time)
                    if watchers and (self.time >= due or self.time == end_time):
                        for watcher in watchers:
                            watcher(self)
                        due = due_after(self.time, watch_interval)
                    saver.save(self)
            finally:
                saver.save(self, is_forced=True)
        self._watch.sides(self.water, self.time)
        self._watch.wakes(self.water, self.time)
        self._watch.symmetry(self.water, self.time)
        self._watch.headings(self.time)
        return self.record

    def _refuse_past(self, end_time: float, subject: str, remedy: str) -> None:
        """Refuse an end time that has already passed.

        Args:
            end_time: the end time [s].
            subject: what ends then, for the message.
            remedy: what to give instead, for the message.

        Raises:
            OutsideLimits: naming both times and the remedy.
        """
        if end_time < self.time * (1 - 1e-12):
            raise OutsideLimits(
                f"{subject} has come to t = {self.time:.6g} s already and cannot end at {end_time:.6g} s; give a later "
                f"time, or {remedy}."
            )

    def control(self, margin: float) -> None:
        """Record the momentum balance of a box around the bodies from now on; see ``control_forces``.

        Args:
            margin: distance of the sides of the box from the bodies' window [m].

        Raises:
            InvalidDesign: a mirror cuts a body, so that no box goes around it; there is no body; or the margin is not
                a number of at least 0.
        """
        if not self._bodies:
            raise InvalidDesign("a control volume goes around bodies, and there is none; give a body.")
        if not (is_number(margin) and isfinite(margin) and margin >= 0):
            raise InvalidDesign(
                f"the margin of the control volume is {show(margin)} m; give a distance of at least 0, so that the box "
                f"is around the bodies."
            )
        if not self._is_placed:
            poses = [self._in_frame(self.pose(b.name)) for b in self._bodies]
            self.water.place(self._bodies, poses, self.time)
        for body, mirror_cuts in zip(self._bodies, self.water.mirror_cuts, strict=True):
            if any(mirror_cuts):
                raise InvalidDesign(
                    f"a mirror cuts {body.name}, and a control volume goes all around bodies; take Record.force."
                )
        k, window = round(margin / self.setup.grid.cell), self.water.window
        box = tuple(
            end
            for start, stop, cells in zip(window[::2], window[1::2], reversed(self.setup.grid.cells), strict=True)
            for end in (max(start - k, PAD + 2), min(stop + k, PAD + cells - 2))
        )
        volume = ControlVolume(box)
        volume.start(self.water)
        self._log.controls = [volume]

    @property
    def control_forces(self) -> np.ndarray:
        """Force on all bodies from the momentum through the box, one row per step since ``control`` [N/m, N]."""
        return np.array(self._log.control_rows).reshape(-1, self.setup.grid.ndim)

    # --- what there is to see ----------------------------------------------------------------------------------

    def surface(self, name: str | None = None) -> Surface:
        """Return pressure and friction along the outline or over the skin of a body, in the frame of the grid.

        Only the part of a body inside the domain counts if mirrors cut it.

        Args:
            name: name of the body; None takes the first one.

        Raises:
            UnknownName: there is no such body, or none at all.
        """
        names = [b.name for b in self._bodies]
        if not names or name not in (None, *names):
            raise UnknownName("body", "" if name is None else name, names or ("none",))
        body, grid = self._bodies[0 if name is None else names.index(name)], self.setup.grid
        skin = body.shape.markers(self.time, self._in_frame(self.pose(body.name)), grid.cell)
        if grid.ndim == 3:
            low_corner = np.array(grid.origin)[:, None]
            high_corner = low_corner + np.array(grid.size)[:, None]
            skin = skin.select(((skin.points >= low_corner) & (skin.points <= high_corner)).all(axis=0))
        return sample(self.water, skin, self.setup.density)


class _LatestStep(NamedTuple):
    """Data of the last step."""

    dt: float
    """Its length [s]."""
    poses: list[Pose]
    """Bodies at its end, in the frame of the grid."""
    push: tuple[float, ...]
    """Uniform acceleration of the water [m/s^2]."""
    drift: np.ndarray
    """Mean velocity of the grid [m/s]."""
    contents_before: np.ndarray
    """Momentum in the bodies' regions at the start of the step; see ``momentum.add_contents``."""
    body_speed: float
    """Fastest speed of a body's surface in the frame of the grid [m/s]."""
    imposed_speed: float
    """Fastest speed that a side imposes at its end [m/s]."""


def _watchers(watch: Watcher | Sequence[Watcher] | None) -> tuple[Watcher, ...]:
    """Return the functions that are called during a run.

    Raises:
        InvalidDesign: one is no function.
    """
    watchers = () if watch is None else tuple(watch) if isinstance(watch, Sequence) else (watch,)
    for watcher in watchers:
        if not callable(watcher):
            raise InvalidDesign(f"watch is {show(watch)}; give a function of the simulation, or several in a list.")
    return watchers


def _even_step(dt: float, remaining: float) -> float:
    """Return the length of a step that divides the remaining time evenly near the end of a run [s].

    Args:
        dt: length of the step that the fields allow [s].
        remaining: time to the end of the run [s].
    """
    count = np.ceil(remaining / dt * (1 - 1e-9))
    return float(remaining / count) if count <= MAX_EVENED_STEPS else dt

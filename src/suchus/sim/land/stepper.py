"""One robot with its servos, springs, controller and troubles, stepped by whoever knows what the water does to it.

Time advances in intervals of whole physics steps. An interval is repeated until force and motion converge: each
iteration begins in the same state, and repeats the commands and pushes of the first one. An interval ends where a fault
begins, or where a push begins or ends.

``state`` and ``resume`` continue a stopped run to the same bytes. Controllers and faults have no stored state: they
decide again from their stored inputs, and must return the same commands.

In the plane the root moves forward, to the left and about the vertical. Its other coordinates are locked by an inertia
of ``LOCKED`` times the robot's. In space the water acts on all coordinates of the robot.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import takewhile
from typing import Any, NamedTuple

import mujoco
import numpy as np
import xarray as xr
from jaxtyping import Bool, Float
from mujoco.batch import SimulationError

from suchus.core import water_table as hydro
from suchus.core.errors import Diverged, UnreadableFile
from suchus.robot.control import Command, Controller
from suchus.robot.design import layout
from suchus.sim.fault import Fault
from suchus.sim.land.batch import Beginning, SimulationBatch
from suchus.sim.land.links import RobotLinks
from suchus.sim.land.loop import Loop
from suchus.sim.land.meter import ABSOLUTE_POWER, servo_effort
from suchus.sim.land.readings import Recorder
from suchus.sim.land.run import Run
from suchus.sim.model import joint_addresses
from suchus.sim.model.stability import damping_of

LOCKED = 1e7
"""Inertia of the root against heave, roll and pitch, over the robot's own [-]."""
_PLANE, _LOCKED_DOFS = (0, 1, 5), (2, 3, 4)


@dataclass(frozen=True, slots=True, kw_only=True)
class CoordinateState:
    """Where the root and some joints are, and how fast they move.

    In space the root has a place of seven numbers, its position and a quaternion, and six rates: its velocity in the
    world and its angular velocity about its own axes.
    """

    position: Float[np.ndarray, " place"]
    """Root along, to the left and its yaw, then the joints; in space see above [m, rad, -]."""
    rate: Float[np.ndarray, " coordinate"]
    """Their rates [m/s, rad/s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StepInterval:
    """Displacement, works and momentum of the robot over an interval of time.

    Works are those of the forces as they act over each step, dampers and the servos' loops with the velocity at its
    end, along the mean of its velocities at both ends: they add up to the kinetic energy that is gained.
    """

    displacement: Float[np.ndarray, " coordinate"]
    """Integral of the coordinates' velocities [m, rad]."""
    servo_work: float
    """Work of the servos on the joints [J]."""
    passive_work: float
    """Work of springs, dampers, friction and joint limits on the joints [J]."""
    energy: float
    """Kinetic energy at its end, the water's not counted [J]."""
    effort: float
    """Work of the servos, braking counted as much as driving [J]."""
    momentum: Float[np.ndarray, " axis"]
    """Momentum of the whole robot at its end, along and to the left, in space upwards too, the water's not counted
    [kg m/s]."""
    momentum_defect: Float[np.ndarray, " axis"]
    """Momentum gained without a force, since MuJoCo's step uses the mass matrix of its start [kg m/s]."""


@dataclass(slots=True)
class _Saved:
    """State at the beginning of an interval, to which each iteration returns."""

    state: np.ndarray
    step: int
    last_decision: "_Decision | None"
    passive: np.ndarray
    bias: np.ndarray
    inertia: np.ndarray
    added_mass: np.ndarray
    momentum: np.ndarray
    decisions: dict[int, "_Decision"] = field(default_factory=dict)


@dataclass(slots=True)
class _Tape:
    """Velocities and forces in each physics step of an interval.

    Velocities, passive and bias forces have one more entry, that of the start.
    """

    velocity: list[np.ndarray]
    passive: list[np.ndarray]
    bias: list[np.ndarray]
    servo_force: list[np.ndarray] = field(default_factory=list)
    constraint_force: list[np.ndarray] = field(default_factory=list)
    smooth: list[np.ndarray] = field(default_factory=list)


class _Decision(NamedTuple):
    """Command and pushes of a control period, with the inputs that they were decided from."""

    command: Command
    """What the servos are commanded."""
    external_force: np.ndarray
    """Forces from outside [N]."""
    inputs: dict[str, np.ndarray]
    """What controller and faults decided by; see ``SimulationBatch.controller_inputs``."""


class Stepper:
    """A run whose water is solved elsewhere.

    Args:
        run: run of one robot.
        joints: names of those that the water feels beside the root, which then moves in its plane; None for all, and
            a root that moves in space.
        timestep: time step of the physics [s], a whole part of the control period.
        ticks: control periods for which controller, noise and record are prepared.
        controller: what decides; None for the one that the run names.
        begin: state in which it begins; None for the controller's first posture.
    """

    def __init__(
        self,
        run: Run,
        joints: tuple[str, ...] | None,
        timestep: float,
        ticks: int,
        *,
        controller: Controller | None = None,
        begin: Beginning | None = None,
    ) -> None:
        """Start the loop, select the coordinates of the water, and find the steps at which faults and pushes change."""
        self._loop = loop = Loop([run], timestep, ticks=ticks + 1, controller=controller)
        if begin is not None:
            loop.restart(0, begin, run.faults, run.pushes)
        self.timestep, self.period = timestep, loop.period
        self._per_tick = round(loop.period / timestep)
        self._batch, self._physics = loop.batch, loop.batch.physics
        self.model: Any = loop.batch.model
        self._recorder: Recorder = loop.recorder(ticks + 1)
        self._ticks = ticks
        self.links = RobotLinks(self.model)
        """What the robot is made of, and how it moves in space."""
        self.in_plane = joints is not None
        joints = self.links.joints if joints is None else joints
        self._places = joint_addresses(self.model, joints)
        hinge_dofs = [int(self.model.joint(name).dofadr[0]) for name in joints]
        self.dofs = np.array([*(_PLANE if self.in_plane else range(6)), *hinge_dofs])
        self._joints = joints
        hinges = [self.model.joint(name) for name in joints]
        self._ranges = np.array(
            [
                hinge.range if hinge.id in np.flatnonzero(self.model.jnt_limited) else (-np.inf, np.inf)
                for hinge in hinges
            ]
        ).reshape(-1, 2)
        self._other_hinges = [
            name for name in layout(run.robot).hinges
            if self.in_plane and name not in joints and name in {hinge.name for hinge in run.robot.axis_hinges}
        ]  # fmt: skip
        self._data = mujoco.MjData(self.model)
        self._applied = self._physics.bind("qfrc_applied")
        self._external_forces = self._physics.bind("xfrc_applied")
        self._user = self._physics.bind("userdata")
        self._servo_force, self._passive, self._constraint_force = (
            self._physics.bind(f"qfrc_{name}") for name in ("actuator", "passive", "constraint")
        )
        self._smooth, self._bias = self._physics.bind("qfrc_smooth"), self._physics.bind("qfrc_bias")
        self._mass_matrix = np.zeros((self.model.nv, self.model.nv))
        self.steps = 0
        self.initial_coordinates: CoordinateState = self.coordinates
        """State in which the present stretch began."""
        self._saved: _Saved | None = None
        self._decision: _Decision | None = None
        self._decided: list[_Decision] = []
        self._servo_steps: dict[int, tuple[np.ndarray, np.ndarray, np.ndarray]] = {}
        self._is_read = False
        ends = [time / loop.period for push in run.pushes for time in (push.at, push.at + push.duration)]
        ticks_of = [float(tick) for fault in run.faults for tick in _change_ticks(fault, loop.period, ticks)]
        ticks_of += [round_(end) for end in ends for round_ in (np.floor, np.ceil)]
        self._troubles = np.unique(np.array(ticks_of, int)) * self._per_tick
        self.set_added_mass(np.zeros((len(self.dofs), len(self.dofs))))
        self._physics.forward()
        self._batch.read_sensors(slice(None))
        self._is_looked_at = False
        self._update_kinematics()
        self._damping = damping_of(self.model, self._data)
        self._tape = _Tape([], [], [])

    # --- where it is -------------------------------------------------------------------------------------------

    @property
    def time(self) -> float:
        """Time since the beginning [s]."""
        return self.steps * self.timestep

    @property
    def coordinates(self) -> CoordinateState:
        """Root and joints now."""
        qpos, qvel = self._batch.qpos[0], self._batch.qvel[0]
        if not self.in_plane:
            return CoordinateState(position=qpos.copy(), rate=qvel.copy())
        w, x, y, z = qpos[3:7]
        yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        return CoordinateState(
            position=np.array([qpos[0], qpos[1], yaw, *qpos[self._places]]), rate=np.array(qvel[self.dofs])
        )  # fmt: skip

    @property
    def off_plane(self) -> tuple[str, float]:
        """Joint of the axis that is bent out of the plane the most, and by how much [rad]; an empty name for none."""
        bends = {
            name: float(self._batch.qpos[0, int(self.model.joint(name).qposadr[0])]) for name in self._other_hinges
        }
        bent_joint = max(bends, key=lambda name: abs(bends[name]), default="")
        return bent_joint, bends.get(bent_joint, 0.0)

    @property
    def stopped_joints(self) -> dict[str, float]:
        """Joints that are at the end of their range, with their angles [rad]."""
        angles, (lower_limits, upper_limits) = self._batch.qpos[0, self._places], self._ranges.T
        joint_indices = np.flatnonzero((angles <= lower_limits) | (angles >= upper_limits))
        return {self._joints[k]: float(angles[k]) for k in joint_indices}

    def mass(self) -> Float[np.ndarray, "coordinate coordinate"]:
        """Return the mass matrix of the coordinates as they are now, without the water's [kg, kg m, kg m2]."""
        self._update_kinematics()
        return np.array(self._mass_matrix[np.ix_(self.dofs, self.dofs)])

    def centre(self) -> Float[np.ndarray, "3"]:
        """Return the centre of mass in the world [m]."""
        self._update_kinematics()
        return np.array(self._data.subtree_com[1])

    def show(self, batch: SimulationBatch, row: int) -> None:
        """Let a run of another batch of such robots be where this one is, and feel the same."""
        self._read_sensors()
        batch.set_controller_inputs(row, self._batch.controller_inputs(0))
        batch.physics.state[row] = self._physics.state[0]

    def _update_kinematics(self) -> None:
        """Compute positions, centre of mass and mass matrix of the present state, once in each state."""
        if self._is_looked_at:
            return
        self._is_looked_at = True
        data, model = self._data, self.model
        data.qpos[:], data.qvel[:] = self._batch.qpos[0], self._batch.qvel[0]
        data.userdata[:] = 0.0
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_crb(model, data)
        mujoco.mj_fullM(model, data, self._mass_matrix)

    # --- what the water does -----------------------------------------------------------------------------------

    def set_added_mass(
        self, added_mass: Float[np.ndarray, "coordinate coordinate"]
    ) -> Float[np.ndarray, "coordinate coordinate"]:
        """Let joints and root have an added mass from now on; return how much of it MuJoCo's matrix has room for.

        It has none between joints on different branches of the tree, as trunk and tail. What it takes in the place of
        these is never too little in any motion, so that the matrix stays positive definite.
        """
        model = self.model
        matrix = np.zeros((model.nv, model.nv))
        matrix[np.ix_(self.dofs, self.dofs)] = added_mass
        heavy = LOCKED * float(model.body_mass.sum())
        for dof in _LOCKED_DOFS if self.in_plane else ():
            matrix[dof, dof] = heavy
        rows, columns = self._entries
        is_entry = np.zeros(matrix.shape, bool)
        is_entry[rows, columns] = is_entry[columns, rows] = True
        matrix = np.where(is_entry, matrix, 0.0) + _dominating_matrix(np.where(is_entry, 0.0, matrix), is_entry)
        self._user[0, hydro.NUMBERS :] = 0.0
        self._user[0, hydro.NUMBERS : hydro.NUMBERS + len(rows)] = matrix[rows, columns]
        return np.array(matrix[np.ix_(self.dofs, self.dofs)])

    @cached_property
    def _entries(self) -> tuple[np.ndarray, np.ndarray]:
        """Rows and columns of MuJoCo's matrix that have room."""
        rows = np.repeat(np.arange(self.model.nv), self.model.M_rownnz)
        return rows, np.array(self.model.M_colind)[: len(rows)]

    def _added_mass_matrix(self) -> Float[np.ndarray, "dof dof"]:
        """Return the added mass in the mass matrix of all degrees of freedom."""
        (rows, columns), matrix = self._entries, np.zeros_like(self._mass_matrix)
        entries = self._user[0, hydro.NUMBERS : hydro.NUMBERS + len(rows)]
        matrix[rows, columns] = matrix[columns, rows] = entries
        return matrix

    @property
    def axis_count(self) -> int:
        """Axes in which the root moves [-]."""
        return 2 if self.in_plane else 3

    def _momentum(self) -> Float[np.ndarray, " axis"]:
        """Return the momentum of the whole robot along the axes in which the root moves [kg m/s]."""
        self._update_kinematics()
        return np.asarray(self._mass_matrix[: self.axis_count] @ self._batch.qvel[0])

    # --- going on ----------------------------------------------------------------------------------------------

    def begin(self) -> None:
        """Begin an interval in the present state."""
        self.initial_coordinates = self.coordinates
        period_start = self.steps - self._per_tick
        self._servo_steps = {step: row for step, row in self._servo_steps.items() if step >= period_start}
        state, passive, bias = self._physics.state[0].copy(), self._passive[0].copy(), self._bias[0].copy()
        added_mass, momentum = self._added_mass_matrix(), self._momentum()
        self._saved = _Saved(
            state, self.steps, self._decision, passive, bias, self._mass_matrix + added_mass, added_mass, momentum
        )  # fmt: skip

    def steps_until(self, time: float, max_steps: int, landing: int = 0) -> int:
        """Return the number of physics steps of the next interval; it ends at a time [s], fault or push at the latest.

        Args:
            time: time at which an interval must end [s].
            max_steps: greatest number of physics steps in an interval [-].
            landing: number of intervals of about equal length before such an end, so that none is very short [-].
        """
        later_troubles = self._troubles[self._troubles > self.steps]
        remaining = max(min([round(time / self.timestep) - self.steps, *(later_troubles[:1] - self.steps).tolist()]), 1)
        stretches = -(-remaining // max_steps)
        return -(-remaining // stretches) if stretches <= max(landing, 1) else max_steps

    def go(self, count: int, force: Float[np.ndarray, " coordinate"]) -> CoordinateState:
        """Step through the interval that was begun, under a constant force of the water; ``account`` evaluates it.

        Args:
            count: physics steps.
            force: along the coordinates, that on a body that does not accelerate; the added mass comes on top [N, N m].

        Returns:
            Root and joints at its end.

        Raises:
            Diverged: the physics did.
        """
        saved = self._saved
        assert saved is not None
        water_numbers = self._user[0].copy()
        self._physics.state[0] = saved.state
        self._user[0] = water_numbers
        self.steps, self._decision = saved.step, saved.last_decision
        self._is_looked_at = False
        self._applied[0] = 0.0
        self._applied[0, self.dofs] = force
        sensors, speeds, torques = self._batch.sensors[0], self._batch.velocities, self._batch.torques
        tape = self._tape = _Tape([self._batch.qvel[0].copy()], [saved.passive], [saved.bias])
        for _ in range(count):
            if self.steps % self._per_tick == 0:
                self._decide(saved)
            start_speeds = sensors[speeds].copy()
            assert self._decision is not None
            self._batch.ctrl[0] = self._decision.command.targets[0]
            try:
                self._physics.step(None, 1, int(mujoco.mjtStage.mjSTAGE_VEL))
            except SimulationError as error:
                raise Diverged(
                    f"at t = {self.time:.4g} s the robot in the flow diverged: {self._physics.error(0)}; take a "
                    f"shorter timestep than {self.timestep:g} s.", time=self.time,
                ) from error  # fmt: skip
            tape.velocity.append(self._batch.qvel[0].copy())
            tape.passive.append(self._passive[0].copy())
            tape.bias.append(self._bias[0].copy())
            tape.servo_force.append(self._servo_force[0].copy())
            tape.constraint_force.append(self._constraint_force[0].copy())
            tape.smooth.append(self._smooth[0].copy())
            self._servo_steps[self.steps] = sensors[torques].copy(), start_speeds, sensors[speeds].copy()
            self.steps += 1
        return self.coordinates

    def account(self) -> StepInterval:
        """Return displacement, works and momentum of the last iteration of the interval."""
        saved = self._saved
        assert saved is not None
        tape, dt = self._tape, self.timestep
        rate = np.array(tape.velocity)
        displacement, gained = 0.5 * dt * (rate[1:] + rate[:-1]), np.diff(rate, axis=0)
        # MuJoCo's implicit step takes dampers and servos at the velocity it leads to: by so much they differ from qfrc
        implicit_force = gained / dt @ saved.inertia - np.array(tape.smooth) - np.array(tape.constraint_force)
        damped = -gained @ self._damping
        end_rate, momentum = rate[-1], self._momentum()
        impulse = dt * (np.array(tape.smooth) + np.array(tape.bias[:-1]) + np.array(tape.constraint_force)).sum(axis=0)
        applied_impulse = (impulse - saved.added_mass @ (end_rate - rate[0]))[: self.axis_count]
        return StepInterval(
            displacement=displacement.sum(axis=0)[self.dofs],
            servo_work=float(((np.array(tape.servo_force) + implicit_force - damped) * displacement).sum()),
            passive_work=float(
                ((np.array(tape.passive[:-1]) + np.array(tape.constraint_force) + damped) * displacement).sum()
            ),
            energy=0.5 * float(end_rate @ self._mass_matrix @ end_rate),
            effort=dt * len(displacement) * float(self._effort(saved.step, self.steps)[:, ABSOLUTE_POWER].sum()),
            momentum=momentum, momentum_defect=momentum - saved.momentum - applied_impulse,
        )  # fmt: skip

    def _decide(self, saved: _Saved) -> None:
        """Apply the decision of a control period, which is made in the first iteration alone, and store a sample."""
        tick = self.steps // self._per_tick
        is_known = tick in saved.decisions
        is_first = not (is_known and self.steps == saved.step)  # else the sensors are those of the end of the last go
        if is_first:
            self._read_sensors()
        if not is_known:
            saved.decisions[tick] = self._thought(tick)
            self._decided.append(saved.decisions[tick])
        self._decision = saved.decisions[tick]
        self._external_forces[0] = self._decision.external_force
        self._is_read = False
        if is_first:
            self._store(tick)

    def _thought(self, tick: int) -> _Decision:
        inputs = self._batch.controller_inputs(0)
        self._loop.tick = self._loop.clocks[:] = tick
        self._loop.decide()
        return _Decision(self._loop.command, self._external_forces[0].copy(), inputs)

    def _read_sensors(self) -> None:
        if not self._is_read:
            self._batch.read_sensors(slice(None))

    def _store(self, tick: int) -> None:
        assert self._decision is not None
        if tick > 0:
            self._batch.effort[0] = self._effort(self.steps - self._per_tick, self.steps)
        if tick <= self._ticks:
            self._recorder.store(tick, self._decision.command.phase, self._decision.command.targets)

    def _effort(self, start: int, end: int) -> Float[np.ndarray, "servo 6"]:
        """Return what the servos did between two physics steps, in the order of ``record.EFFORT``."""
        rows = [self._servo_steps[step] for step in range(start, end)]
        torque, start_speed, end_speed = (np.array(values)[:, None] for values in zip(*rows, strict=True))
        return servo_effort(torque, start_speed, end_speed, self._batch.laws)[0]

    def finish(self) -> None:
        """Keep the last sample, if the run has come to the end of a control period."""
        if self.steps % self._per_tick == 0:
            self._read_sensors()
            self._store(self.steps // self._per_tick)

    # --- stopped and gone on -----------------------------------------------------------------------------------

    def state(self) -> dict[str, np.ndarray]:
        """Return all with which this run can go on in another process, between two stretches."""
        self._read_sensors()  # where a control period ends the next decision is by this, else by what is read later
        inputs = [decision.inputs for decision in self._decided]
        return {
            "steps": np.array(self.steps), "physics": self._physics.state[0].copy(),
            "servo_steps": np.array([self._servo_steps[step] for step in self._recent_steps(self.steps)]),
            "targets": np.array([decision.command.targets[0] for decision in self._decided]),
            **{f"felt.{name}": np.array([sample[name] for sample in inputs]) for name in (inputs[0] if inputs else ())},
            **{f"now.{name}": values for name, values in self._batch.controller_inputs(0).items()},
            **{f"samples.{name}": values for name, values in self._recorder.state().items()},
        }  # fmt: skip

    def _recent_steps(self, end: int) -> range:
        """Return the last physics steps before ``end``, as many as a control period has."""
        return range(max(end - self._per_tick, 0), end)

    def resume(self, state: Mapping[str, np.ndarray]) -> None:
        """Go on from the state of a run of the same robot that was stopped; to be asked of a fresh one.

        Raises:
            UnreadableFile: controller or faults decide otherwise than they did then.
        """
        parts = {kind: _with_prefix(state, f"{kind}.") for kind in ("felt", "now", "samples")}
        for tick, targets in enumerate(state["targets"]):
            self._batch.set_controller_inputs(0, {name: values[tick] for name, values in parts["felt"].items()})
            self._decision = self._thought(tick)
            self._decided.append(self._decision)
            if not np.array_equal(self._decision.command.targets[0], targets):
                raise UnreadableFile(
                    f"what was kept of the run {self._loop.runs[0].label!r} cannot go on: its controller commands "
                    f"otherwise at t = {tick * self.period:.4g} s than it did. Delete what was kept to start anew."
                )
        self.steps = int(state["steps"])
        self._servo_steps = dict(zip(self._recent_steps(self.steps), map(tuple, state["servo_steps"]), strict=True))
        self._recorder.resume(parts["samples"])
        self._batch.set_controller_inputs(0, parts["now"])
        self._physics.state[0] = state["physics"]
        self._physics.forward(None, int(mujoco.mjtStage.mjSTAGE_VEL))
        self._is_looked_at = False
        self._is_read = self.steps % self._per_tick == 0
        self.initial_coordinates = self.coordinates

    def end(self, time: float, cause: str) -> None:
        """Let the run have ended at a time [s], with the last samples that were taken until then."""
        self._batch.alive[0], self._batch.end_times[0], self._batch.cause[0] = False, time, cause

    def record(self) -> xr.Dataset:
        """Return what was read, in the schema of a run; NaN where nothing has been yet."""
        return self._recorder.record(np.arange(self._ticks + 1) * self.period)


def _change_ticks(fault: Fault, period: float, ticks: int) -> list[int]:
    """Return the control periods in which a fault begins or ends, from those of a run.

    Args:
        fault: the fault.
        period: control period [s].
        ticks: control periods of the run [-].
    """
    spells = takewhile(lambda spell: spell[0] <= ticks, fault.persistence.spell_ticks(fault.part, fault.at, period))
    return [tick for spell in spells for tick in spell if tick is not None and tick <= ticks]


def _with_prefix(state: Mapping[str, np.ndarray], start: str) -> dict[str, np.ndarray]:
    """Return the values whose names begin with ``start``, by the rest of their names."""
    return {name.removeprefix(start): values for name, values in state.items() if name.startswith(start)}


def _dominating_matrix(
    missing: Float[np.ndarray, "n n"], is_entry: Bool[np.ndarray, "n n"]
) -> Float[np.ndarray, "n n"]:
    """Return a matrix whose quadratic form is nowhere smaller than that of another one, with allowed entries alone.

    It is the absolute value where that has allowed entries alone, else a diagonal of sums.

    Args:
        missing: the symmetric matrix.
        is_entry: whether each entry of the result may differ from zero.
    """
    values, vectors = np.linalg.eigh(missing)
    size = (vectors * np.abs(values)) @ vectors.T
    if np.abs(np.where(is_entry, 0.0, size)).max() <= 1e-9 * np.abs(size).max(initial=1e-300):
        return np.where(is_entry, size, 0.0)
    return np.diag(np.abs(missing).sum(axis=1))

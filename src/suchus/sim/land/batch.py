"""A batch of MuJoCo simulations, each with its own ground, water and faults, and what its sensors say of a period."""

import copy
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import Any, NamedTuple

import mujoco
import numpy as np
from jaxtyping import Float
from mujoco.batch import MODEL_FIELDS, Batch, SimulationError

from suchus.core import threads
from suchus.robot.design import Robot, layout
from suchus.robot.design.ground import Grains, Ground, Relief
from suchus.robot.design.pieces import pieces
from suchus.robot.motion import hip_height
from suchus.sim.immersion import wetting
from suchus.sim.land.afloat import surfaced
from suchus.sim.land.clear import check_clear
from suchus.sim.land.corrected import SectionChange, change_sections
from suchus.sim.land.grain_loads import GrainLoads
from suchus.sim.land.lake import Waters, gravity, up_direction
from suchus.sim.land.meter import ABSOLUTE_POWER, Meter, ServoLaws, servo_effort
from suchus.sim.land.run import Afloat, Run
from suchus.sim.model import SUPPLY, activations, compile_model, force_sensors, standing, supplies
from suchus.sim.model.granular import granular_model
from suchus.sim.model.wet import wet_model
from suchus.sim.record import EFFORT

_RUNS_IN_CACHE = 8  # measured with the caiman: the time of a step is least from 6 to 12
_TOO_FAST = 1e3  # [rad/s] or [m/s]; nothing on a robot moves so fast: the physics has diverged
FAST_ITERATIONS = 10
"""Iterations of the contact solver in fast physics [-]."""
_SERVO_FIELDS = ("actuator_gainprm", "actuator_biasprm", "actuator_forcerange")
_ARRAY_FIELDS = tuple(sorted(name for name in MODEL_FIELDS if not name.startswith("opt.")))
_CURRENT = int(mujoco.mjtStage.mjSTAGE_VEL)  # after a step, positions and velocities describe the new state


class Beginning(NamedTuple):
    """State in which a robot begins."""

    qpos: Float[np.ndarray, " q"]
    """Generalised positions [m], [rad]."""
    qvel: Float[np.ndarray, " v"]
    """Generalised velocities [m/s], [rad/s]."""
    act: Float[np.ndarray, " a"]
    """Inner states of the servos: slew-limited targets and integrals."""
    commanded: Float[np.ndarray, " servo"]
    """Last commanded angle of each servo [rad]."""


class SimulationBatch:
    """The simulations of one group of runs, whose robots share a topology.

    Runs of one robot on one relief share a model, with per-run values where they differ (``Batch.expand``). Where
    robots or reliefs differ, each has a model (``Batch.set_models``), which runs share until one's values change.
    """

    def __init__(self, runs: Sequence[Run], timestep: float, *, fast: bool = False) -> None:
        """Compile the models, bind the physics' arrays, and apply ground, supply and medium of each run.

        Args:
            runs: runs of one group.
            timestep: time step of the physics [s].
            fast: whether contacts are solved in less time and with less accuracy, see ``simulate``.
        """
        bodies = [(run.robot, run.ground.relief, _section_change(run), _grains(run)) for run in runs]
        has_water = any(run.lake is not None or run.solved_flow is not None for run in runs)
        if has_water:
            wetting.install()
        max_pieces = max(len(pieces(run.robot)) for run in runs) if has_water else 0
        is_solved = runs[0].solved_flow is not None
        models = {
            body: _model(body, timestep, max_pieces, is_solved=is_solved, fast=fast) for body in dict.fromkeys(bodies)
        }
        shared = models[bodies[0]]
        self.model = shared
        self._single = len(models) == 1
        self._models: list[Any] = [] if self._single else [models[body] for body in bodies]
        self._owned: set[int] = set()
        self._is_modified = False
        self._expanded: set[str] = set()
        self._timestep, self._robots = timestep, [run.robot for run in runs]
        self.physics = Batch(shared, len(runs), nthread=min(threads.count(), len(runs)), persistent=True)
        self.laws = ServoLaws(shared, self._robots)
        """The numbers by which the torques of the servos follow."""
        self._rewired: set[int] = set(range(len(runs)))
        self._compile = partial(_model, timestep=timestep, max_pieces=max_pieces, is_solved=is_solved, fast=fast)
        self._picture_data: Any = None
        self._body_fields: set[str] = set()  # fields in which robots that were put in differ from the first
        self._lay_ground(runs)
        if self._models:
            self.physics.set_models(self._models)
            self._is_modified = False
        self.qpos, self.qvel, self.ctrl, self.sensors = (
            self.physics.bind(name) for name in ("qpos", "qvel", "ctrl", "sensordata")
        )
        self.activations, self._external_forces = self.physics.bind("act"), self.physics.bind("xfrc_applied")
        self.readings = self.sensors.copy()
        self._lengths = self.physics.bind("actuator_length")
        self._shafts = self._lengths.copy()
        self._sensing = True
        self._grain_loads = (
            None if runs[0].ground.grains is None else GrainLoads(shared, runs[0].robot, self.physics.bind("userdata"))
        )
        self.waters = Waters([run.lake for run in runs], [run.ground for run in runs], self.physics)
        forces = force_sensors(runs[0].robot)
        self._forces = slice(int(shared.sensor(forces[0]).adr[0]), int(shared.sensor(forces[-1]).adr[0]) + 3)
        self._live_forces, self._mean = self.sensors[:, self._forces], self.readings[:, self._forces]
        self._sum, self._speeds = np.zeros_like(self._live_forces), np.zeros_like(self.qvel)
        names = layout(runs[0].robot).servos
        self.velocities, self.torques = (
            slice(
                int(shared.sensor(f"{names[0]}_{quantity}").adr[0]),
                int(shared.sensor(f"{names[-1]}_{quantity}").adr[0]) + 1,
            )
            for quantity in ("velocity", "torque")
        )
        self.period_means = np.zeros((len(runs), 4))
        """Means of force and power of the water over the last control period, shape (run, 4) [N, W]."""
        self.effort = np.zeros((len(runs), len(names), len(EFFORT)))
        """What each servo did in it, in the order of ``record.EFFORT``."""
        self._meters: dict[int, Meter] = {}
        self.alive = np.ones(len(runs), dtype=bool)
        self.end_times = np.full(len(runs), np.inf)
        self.cause = [""] * len(runs)

    def field(self, name: str, sim: int) -> np.ndarray:
        """Return a run's own values of a model field, for writing; ``commit`` after it."""
        if name.startswith("actuator_"):
            self._rewired.add(sim)
        if self._single:
            self._expanded.add(name)
            values: np.ndarray = self.physics.expand(name)[sim]
            return values
        self._is_modified = True
        owner: Any = self._private_model(sim)
        for attribute in name.split("."):
            owner = getattr(owner, attribute)
        return np.asarray(owner)

    def exchange(self, sim: int, run: Run) -> None:
        """Give a run a robot of other masses and a ground of another slope and friction; ``restart`` it after this.

        Args:
            sim: the run.
            run: run whose robot and ground it gets; its relief is not looked at.
        """
        model = self._compile((run.robot, run.ground.relief, _section_change(run), _grains(run)))
        self._body_fields |= {name for name in _ARRAY_FIELDS if not _are_equal(self.model, model, name)}
        for name in sorted(self._body_fields):
            self.field(name, sim)[:] = getattr(model, name)
        self.field("geom_friction", sim)[:] = model.geom_friction
        self.field("geom_friction", sim)[1:, 0] *= run.ground.friction_scale
        self.tilt(sim, run.ground)
        self._robots[sim] = run.robot
        self.commit()

    def commit(self) -> None:
        """Let the physics know of written model fields, and the meters of changed servos."""
        if self._models and self._is_modified:
            self.physics.set_models(self._models)
            self._is_modified = False
        for sim in self._rewired:
            self.laws.read(sim, *(self._now(name, sim) for name in _SERVO_FIELDS))
        self._rewired.clear()

    def _now(self, name: str, sim: int) -> np.ndarray:
        """Return a run's present values of a model field, for reading."""
        if not self._single:
            return np.asarray(getattr(self._models[sim], name))
        if name in self._expanded:
            values: np.ndarray = self.physics.expand(name)[sim]
            return values
        return np.asarray(getattr(self.model, name))

    def _private_model(self, sim: int) -> Any:
        """Return a run's model, which it shares with no other from now on."""
        if sim not in self._owned:
            self._models[sim] = copy.copy(self._models[sim])
            self._owned.add(sim)
        return self._models[sim]

    def _lay_ground(self, runs: Sequence[Run]) -> None:
        """Write friction, slope, supply and medium of each run into its model."""
        for sim, run in enumerate(runs):
            if run.ground.friction_scale != 1.0:
                self.field("geom_friction", sim)[1:, 0] *= run.ground.friction_scale
            if run.ground.uphill or run.ground.sideways:
                self.field("opt.gravity", sim)[:] = gravity(run.ground)
            if run.supply != 1.0:
                self.supply(sim, run.supply)
            if run.afloat is not None:
                self._cast_off(sim, run.afloat)
            if run.solved_flow is not None:
                self._lift(sim)

    def _lift(self, sim: int) -> None:
        """Take weight and contact from a run: it hovers in deep water."""
        self.field("opt.gravity", sim)[:] = 0.0
        no_contact = int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        self._set_option("disableflags", sim, int(self.model.opt.disableflags) | no_contact)

    def _cast_off(self, sim: int, medium: Afloat) -> None:
        """Remove gravity and contacts from a run and put it into a fluid, integrated by Runge-Kutta steps."""
        self.field("opt.gravity", sim)[:] = 0.0
        self._set_option("density", sim, medium.density)
        self._set_option("viscosity", sim, medium.viscosity)
        self._set_option("integrator", sim, int(mujoco.mjtIntegrator.mjINT_RK4))
        self.laws.is_implicit[sim] = False
        no_contact = int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        self._set_option("disableflags", sim, int(self.model.opt.disableflags) | no_contact)

    def _set_option(self, name: str, sim: int, value: float) -> None:
        """Write one physics option of one run; call ``commit`` after it."""
        if self._single:
            self.physics.expand(f"opt.{name}")[sim] = value
        else:
            setattr(self._private_model(sim).opt, name, value)
            self._is_modified = True

    def power(self, sim: int, servo: str, *, is_powered: bool) -> None:
        """Give a servo its torque, or take it away, from the next ``commit`` on.

        Args:
            sim: the run.
            servo: name of the servo.
            is_powered: whether it gets its torque.
        """
        bit = 1 << int(self.model.actuator(servo).group[0])
        self.laws.is_powered[sim, int(self.model.actuator(servo).id)] = is_powered
        self._rewired.add(sim)
        disabled_groups = (
            self.physics.expand("opt.disableactuator")[sim]
            if self._single
            else self._private_model(sim).opt.disableactuator
        )
        self._set_option(
            "disableactuator", sim, int(disabled_groups) & ~bit if is_powered else int(disabled_groups) | bit
        )

    @property
    def pressed(self) -> np.ndarray:
        """The contact forces among the readings, for writing, shape (run, 3 forces) [N]."""
        return self._mean

    def supply(self, sim: int, fraction: float) -> None:
        """Let a run's servos that have a winding get a share of their supply, from the next ``commit`` on.

        Args:
            sim: the run.
            fraction: fraction of the supply of the design [-].
        """
        volts = supplies(self._robots[sim])
        motors = ~np.isnan(volts)
        if motors.any():
            self.field("actuator_gainprm", sim)[motors, SUPPLY] = fraction * volts[motors]

    def angles(self, sim: int) -> np.ndarray:
        """Return the angles of a run's joints at the servos' shafts as they are now, shape (servo,) [rad]."""
        angles: np.ndarray = self._shafts[sim]
        return angles

    def tilt(self, sim: int, ground: Ground) -> None:
        """Let a ground slope as it says from now on; its friction and relief are not looked at."""
        self.field("opt.gravity", sim)[:] = gravity(ground)
        self.waters.tilt(sim, ground)

    def push(self, sim: int, body: str, force: np.ndarray) -> None:
        """Let a force act on the centre of mass of a body from now on.

        Args:
            sim: the run.
            body: name of the body.
            force: force in the world, shape (3,) [N]; zeros end the push.
        """
        self._external_forces[sim, self.model.body(body).id, :3] = force

    def place_robots(self, runs: Sequence[Run], initial_angles: np.ndarray) -> None:
        """Put every robot on the ground in its first posture, nothing below the surface.

        Args:
            runs: the runs.
            initial_angles: the servo angles at the start, shape (run, servo) [rad].

        Raises:
            InvalidDesign: a robot would begin inside a relief.
        """
        postures: dict[object, tuple[np.ndarray, np.ndarray]] = {}
        floating_postures: dict[object, np.ndarray] = {}
        for sim, run in enumerate(runs):
            height = hip_height(run.robot, run.gait)
            key = (run.robot, height, initial_angles[sim].tobytes())
            if key not in postures:
                model = compile_model(run.robot, self._timestep)  # every run begins on even ground
                posture = standing(model, run.robot, height, initial_angles[sim])
                postures[key] = posture, activations(model, initial_angles[sim])
            self.qpos[sim], self.activations[sim] = postures[key]
            if run.lake is not None:
                float_key = (key, run.lake, run.ground)
                if float_key not in floating_postures:
                    floating_postures[float_key] = surfaced(
                        run.robot, run.lake, up_direction(run.ground), self.qpos[sim], self._timestep
                    )
                self.qpos[sim] = floating_postures[float_key]
            if run.afloat is None:
                check_clear(run.robot, run.ground.relief, self.qpos[sim], self._timestep)
            self.ctrl[sim] = initial_angles[sim]
        self.physics.forward()
        self.read_sensors(slice(None))

    def read_sensors(self, selection: int | slice) -> None:
        """Copy the sensors of the selected runs into ``readings``; means become the values of this instant."""
        self.readings[selection], self._shafts[selection], self.period_means[selection] = (
            self.sensors[selection],
            self._lengths[selection],
            0.0,
        )
        self._mean[selection] = self._contact_forces()[selection]
        if self.waters:
            self.period_means[selection] = self.waters.acts()[selection]
        self.commit()
        torques, speeds = self.sensors[None, :, self.torques], self.sensors[None, :, self.velocities]
        self.effort[selection] = servo_effort(torques, speeds, speeds, self.laws)[selection]

    def controller_inputs(self, sim: int) -> dict[str, np.ndarray]:
        """Return copies of the inputs of a run's controllers and faults: sensors, shaft angles, positions, loads."""
        return {name: values[sim].copy() for name, values in self._decided_by.items()}

    def set_controller_inputs(self, sim: int, inputs: Mapping[str, np.ndarray]) -> None:
        """Set the inputs of a run's controllers and faults, as ``controller_inputs`` returned them at another time."""
        for name, values in self._decided_by.items():
            values[sim] = inputs[name]

    @property
    def _decided_by(self) -> dict[str, np.ndarray]:
        return {
            "readings": self.readings,
            "shafts": self._shafts,
            "qpos": self.qpos,
            "worked": self.period_means,
            "effort": self.effort,
        }

    def body_poses(self, sim: int, names: Sequence[str]) -> tuple[np.ndarray, np.ndarray]:
        """Return positions [m] and unit quaternions wxyz of some bodies of a run, shapes (body, 3) and (body, 4).

        Args:
            sim: the run.
            names: names of the bodies.
        """
        data = mujoco.MjData(self.model) if self._picture_data is None else self._picture_data
        self._picture_data = data
        data.qpos[:] = self.qpos[sim]
        mujoco.mj_kinematics(self.model, data)
        rows = [self.model.body(name).id for name in names]
        return np.array(data.xpos[rows]), np.array(data.xquat[rows])

    def restart(self, sim: int, begin: Beginning) -> None:
        """Put one robot into a state, without pushes, also after it has diverged; the injector handles its faults.

        The others stay as they are. From then on it moves as a robot of a fresh batch does, to the last bit.

        Args:
            sim: index of the robot in the batch.
            begin: the state in which it begins.
        """
        sim_ids = np.array([sim])
        self._sense(True)
        self.physics.reset(sim_ids, stage=mujoco.mjtStage.mjSTAGE_NONE)
        self.qpos[sim], self.qvel[sim], self.ctrl[sim] = begin.qpos, begin.qvel, begin.commanded
        self.activations[sim] = begin.act
        self.waters.refill(sim)
        self.physics.forward(sim_ids)
        self.read_sensors(sim)
        self.alive[sim], self.end_times[sim], self.cause[sim] = True, np.inf, ""

    def advance(
        self,
        targets: np.ndarray,
        steps: int,
        time: float,
        selection: np.ndarray | None = None,
        *,
        need_forces: bool = True,
        need_readings: bool = True,
        need_effort: bool = True,
        only_power: bool = False,
    ) -> None:
        """Command servo angles and advance the runs that are alive by some physics steps.

        A run that diverges is stopped; ``end_times`` and ``cause`` hold the time and the reason.

        On return ``readings`` holds what the sensors say: contact forces as their mean over the steps, as a pressure
        sensor filters them, everything else as it is now.

        Args:
            targets: shape (run, servo) [rad].
            steps: number of physics steps.
            time: time at which they begin [s].
            selection: whether each run is advanced, shape (run,); None advances all.
            need_forces: whether contact forces are needed as means; if not, they are those of the last step, which
                is faster.
            need_readings: whether ``readings`` are needed; if not, they stay as they were, and a step takes a ninth
                less time.
            need_effort: whether ``effort`` is needed; if not, it stays as it was. It needs the sensors in each step.
            only_power: whether of ``effort`` the size of the power alone is needed; the rest stays as it was.
        """
        # what all runs share is done at once: with one run alone each of these lines shows in its time
        going = self._going(selection)
        if going is None or self.alive.all():
            self.ctrl[:] = targets
        else:
            self.ctrl[self.alive] = targets[self.alive]
        meter = self._meter(steps) if need_effort or self.waters else None
        self._sense(need_readings or meter is not None)
        calls = steps if need_forces or meter is not None else 1
        self._sum.fill(0.0)
        for sims, rows in self._portions(going, calls):
            portion = sims
            for call in range(calls):
                try:
                    self.physics.step(portion, steps // calls, _CURRENT)
                except SimulationError as error:
                    for sim in error.ids:
                        self.end(int(sim), time, self.physics.error(int(sim)))
                    remaining = np.arange(len(self.alive)) if portion is None else portion
                    portion = remaining[self.alive[remaining]]
                self._sum[rows] += self._contact_forces(rows)
                if meter is not None:
                    meter.record_step(call, rows)
        if meter is not None:
            chosen = slice(None) if selection is None else selection
            meter.finish(self.period_means, self.effort, chosen, only_power=only_power)
        self.readings[:], self._shafts[:] = self.sensors, self._lengths
        np.divide(self._sum, calls, out=self._mean)
        np.abs(self.qvel, out=self._speeds)
        if not self._speeds.max() < _TOO_FAST:  # a NaN is not below anything
            self._end_fast_runs(selection, time)

    def advance_periods(
        self, targets: Float[np.ndarray, "period run servo"], steps: int, times: Sequence[float], selection: np.ndarray
    ) -> Float[np.ndarray, "period run"]:
        """Advance runs on dry land by some control periods, and return the power of their servos in each [W].

        The states, ``readings`` and powers are those of as many calls of ``advance``, in less time. Powers are sums of
        their sizes over the servos.

        Args:
            targets: commanded servo angles in each period [rad].
            steps: number of physics steps in a period.
            times: time at which each period begins [s].
            selection: whether each run is advanced, shape (run,).
        """
        periods = len(targets)
        meter = self._meter(periods * steps)
        self._sense(True)
        self._sum.fill(0.0)
        going, is_all = self._going(selection), bool(self.alive.all())
        for period, time in enumerate(times):
            if is_all:
                self.ctrl[:] = targets[period]
            else:
                self.ctrl[self.alive] = targets[period][self.alive]
            for step in range(steps):
                try:
                    self.physics.step(going, 1, _CURRENT)
                except SimulationError as error:
                    for sim in error.ids:
                        self.end(int(sim), time, self.physics.error(int(sim)))
                    going, is_all = self._going(selection), False
                meter.record_step(period * steps + step)
                if period == periods - 1:
                    self._sum += self._contact_forces()
            if not np.vdot(self.qvel, self.qvel) < _TOO_FAST**2:  # cheaper than the greatest speed, and not below it
                self._end_fast_runs(selection, time)
                going, is_all = self._going(selection), bool(self.alive.all())
        powers = meter.powers(periods)
        self.effort[selection, :, ABSOLUTE_POWER] = powers[-1][selection]
        self.readings[:], self._shafts[:] = self.sensors, self._lengths
        np.divide(self._sum, steps, out=self._mean)
        return np.asarray(powers.sum(axis=2))

    def _portions(self, going: np.ndarray | None, calls: int) -> list[tuple[np.ndarray | None, slice]]:
        """Return the runs that are stepped together through a control period, and the rows of arrays of each portion.

        The physics of some runs stays in the processor's cache from one call to the next, that of a large batch does
        not. Several threads hand runs to each other, and gain nothing. The rows of all portions are those of all runs.

        Args:
            going: indices of the runs that are stepped; None for all.
            calls: number of calls of the physics in a control period.
        """
        count = len(self.alive) if going is None else len(going)
        if calls == 1 or count <= _RUNS_IN_CACHE or self.physics.nthread > 1:
            return [(going, slice(None))]
        sims = np.arange(count) if going is None else going
        parts = [sims[first : first + _RUNS_IN_CACHE] for first in range(0, count, _RUNS_IN_CACHE)]
        firsts = [0, *(int(part[0]) for part in parts[1:]), len(self.alive)]
        return [(part, slice(first, end)) for part, (first, end) in zip(parts, pairwise(firsts), strict=True)]

    def _contact_forces(self, rows: slice = slice(None)) -> np.ndarray:
        """Return the forces of the parts on the ground, hard or of grains, as they are now, shape (run, 3 forces)."""
        forces = self._live_forces[rows]
        return forces if self._grain_loads is None else forces + self._grain_loads.forces()[rows]

    def _end_fast_runs(self, selection: np.ndarray | None, time: float) -> None:
        """Stop the runs that move faster than anything on a robot does."""
        np.abs(self.qvel, out=self._speeds)
        fastest = self._speeds.max(axis=1)
        for sim in np.flatnonzero(self._living(selection) & ~(fastest < _TOO_FAST)):
            self.end(int(sim), time, f"a speed of {fastest[sim]:.3g} was reached")

    def copy(self, sims: np.ndarray, whom: np.ndarray) -> None:
        """Copy the states, readings and failures of some runs to others.

        Args:
            sims: indices of the runs that are overwritten, shape (n,).
            whom: index of the run that each of them copies, shape (n,).
        """
        self.physics.state[sims] = self.physics.state[whom]
        self.readings[sims], self._shafts[sims] = self.readings[whom], self._shafts[whom]
        self.period_means[sims], self.effort[sims] = self.period_means[whom], self.effort[whom]
        for sim, source in zip(sims, whom, strict=True):
            if not self.alive[source]:
                self.end(int(sim), float(self.end_times[source]), self.cause[source])

    def _sense(self, is_on: bool) -> None:
        """Switch the computation of sensors on or off; the computed states are the same."""
        if is_on == self._sensing:
            return
        self._sensing, bit = is_on, int(mujoco.mjtDisableBit.mjDSBL_SENSOR)
        if self._single:
            flags = self.physics.expand("opt.disableflags")
            flags[:] = flags & ~bit if is_on else flags | bit
            return
        for model in {id(model): model for model in self._models}.values():
            model_flags = int(model.opt.disableflags)
            model.opt.disableflags = model_flags & ~bit if is_on else model_flags | bit
        self._is_modified = True
        self.commit()

    def _meter(self, steps: int) -> Meter:
        """Return the meter of a control period, which is kept from one to the next."""
        if steps not in self._meters:
            self._meters[steps] = Meter(self.waters.rows, self.sensors, self.velocities, self.torques, self.laws, steps)
        self._meters[steps].begin(self.readings)
        return self._meters[steps]

    def _living(self, selection: np.ndarray | None) -> np.ndarray:
        """Return whether each selected run is alive, shape (run,)."""
        return self.alive if selection is None else self.alive & selection

    def _going(self, selection: np.ndarray | None) -> np.ndarray | None:
        """Return the indices of the runs that are stepped; None for all."""
        going = self._living(selection)
        return None if going.all() else np.flatnonzero(going)

    def end(self, sim: int, time: float, cause: str = "") -> None:
        """Stop a run that is alive.

        Args:
            sim: the run.
            time: when it ends [s].
            cause: what failed; empty where nothing did.
        """
        if self.alive[sim]:
            self.alive[sim], self.end_times[sim], self.cause[sim] = False, time, cause


def _section_change(run: Run) -> SectionChange | None:
    """Return what the lake of a run changes of its robot's pieces; None on dry land."""
    return None if run.lake is None else run.lake.section_change


def _grains(run: Run) -> Grains | None:
    """Return the grains of a run's ground, with its factor on their strength; None where it is hard."""
    grains = run.ground.grains
    return None if grains is None else replace(grains, strength=run.ground.strength)


def _are_equal(first: Any, second: Any, name: str) -> bool:
    """Return whether a field of two models has the same numbers."""
    return np.array_equal(getattr(first, name), getattr(second, name))


def _model(
    body: tuple[Robot, Relief | None, SectionChange | None, Grains | None],
    timestep: float,
    max_pieces: int,
    *,
    is_solved: bool = False,
    fast: bool = False,
) -> Any:
    """Return a compiled model without island discovery, with a table of water pieces if ``max_pieces`` is above 0.

    A robot is one island, so that the bytes are the same, and a step takes a sixteenth less time.

    Args:
        body: robot, relief of its ground, change of its sections, and grains of its ground.
        timestep: time step of the physics [s].
        max_pieces: pieces that the table of the water has room for; 0 on dry land.
        is_solved: whether a flow solver computes the water.
        fast: whether contacts are solved in less time and with less accuracy.
    """
    robot, relief, change, grains = body
    if grains is not None:
        base_model = granular_model(robot, timestep, grains)
    elif max_pieces:
        base_model = wet_model(robot, timestep, relief, max_pieces, acting=True, is_solved=is_solved)
    else:
        base_model = compile_model(robot, timestep, relief)
    model = copy.copy(base_model)
    if change is not None:
        change_sections(model, change)
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_ISLAND)
    if fast and grains is None:  # this solver knows the mass matrix without what grains add
        model.opt.cone = mujoco.mjtCone.mjCONE_PYRAMIDAL
        model.opt.solver = mujoco.mjtSolver.mjSOL_PGS
        model.opt.iterations = FAST_ITERATIONS
        model.opt.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    return model

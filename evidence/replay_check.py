"""Replay of a record in plain MuJoCo: the commands of the record drive the model, without the loop of suchus.

``replay`` steps a robot's model with ``mujoco.mj_step`` under the servo angles that a record holds, and measures by
MuJoCo's own arrays what suchus records: positions, contact forces, torques, work. Its energy and momentum balances show
that both are complete. ``python -m evidence.replay_check`` replays every body with its gait, and with faults.

It replays dry land without a controller's hidden inputs: a record in water needs the water's forces, which are no part
of MuJoCo.
"""

import sys
from collections.abc import Callable, Mapping, MutableMapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import mujoco
import numpy as np
import xarray as xr
from rich.console import Console
from rich.table import Table

import suchus
from suchus.core.errors import IncompatibleRecord
from suchus.robot.design import GRAVITY, Robot, layout
from suchus.robot.gaits import default_gait
from suchus.robot.motion import START
from suchus.sim.fault import Fault, SensorFault
from suchus.sim.land import Backlash, Push, Run, simulate
from suchus.sim.land.lake import gravity
from suchus.sim.metrics import ground_force
from suchus.sim.model import activations, compile_model, joint_addresses
from suchus.sim.model.actuators import slew_column
from suchus.sim.persistence import Persistence
from suchus.sim.record import ground_of


@dataclass(frozen=True, slots=True, kw_only=True)
class Replay:
    """Differences between a record and its replay, and what the replay's balances leave open."""

    position_error: float
    """Greatest difference of the root's position [m]."""
    torque_error: float
    """Greatest difference of a sampled torque over the greatest torque [-]."""
    work_error: float
    """Difference of the net work of all servos over their absolute work [-]."""
    absolute_work_error: float
    """Difference of the absolute work of all servos over it [-]."""
    square_error: float
    """Greatest difference of a servo's root mean square torque over the greatest of them [-]."""
    load_error: float
    """Mean of the vertical contact force that the record lacks, over the weight [-]."""
    momentum_error: float
    """Momentum that weight, contacts and pushes do not explain, over weight times duration [-]."""
    energy_error: float
    """Energy that servos, springs, dampers and contacts do not explain, over all that they turn over [-]."""


def replay(record: xr.Dataset, robot: Robot, *, faults: Sequence[Fault] = (), pushes: Sequence[Push] = ()) -> Replay:
    """Replay the record of one run on dry land, and compare it from the end of the first second on.

    Robots settle in the first second: they fall by a little, and a time step loses energy in an impact.

    Args:
        record: with a sample of every control period, from the first.
        robot: whose record it is.
        faults: of the run.
        pushes: of the run.

    Raises:
        IncompatibleRecord: the record is in water, was thinned out, or does not begin at 0.
    """
    _check(record)
    timestep, period = float(record.timestep), float(record.control_period)
    ground = ground_of(record)
    assert ground is not None
    model = _copy(compile_model(robot, timestep, ground.relief))
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_ISLAND)
    model.opt.enableflags |= int(mujoco.mjtEnableBit.mjENBL_ENERGY)
    model.geom_friction[1:, 0] *= ground.friction_scale
    model.opt.gravity[:] = gravity(ground)
    data = mujoco.MjData(model)
    targets = record.servo_target.transpose("time", "servo").values
    _begin(model, data, record, robot)
    broken = [_BrokenPart(fault, _PlainPlant(model, data, robot), period) for fault in faults]
    account = _Account(model, data, timestep)
    samples: list[tuple[np.ndarray, np.ndarray]] = []
    for tick in range(len(targets) - 1):
        if tick == round(START / period):
            account.begin()
            samples.clear()
        for part in broken:
            part.act(tick, targets[tick])
        _push(model, data, pushes, tick * period, (tick + 1) * period)
        data.ctrl[:] = targets[tick]
        for _ in range(round(period / timestep)):
            account.step()
        samples.append((data.qpos[:3].copy(), account.torque.copy()))
        account.close_period()
    return _compare(record, samples, account)


def _check(record: xr.Dataset) -> None:
    """Refuse a record that cannot be replayed."""
    step = float(record.time[1] - record.time[0]) if record.sizes["time"] > 1 else np.nan
    if "water_level" in record:
        raise IncompatibleRecord("a record in water cannot be replayed: MuJoCo has no forces of the water.")
    if not str(record.stands_on.item()):
        raise IncompatibleRecord("a record of a floating robot cannot be replayed: it stands on no ground.")
    if abs(step - float(record.control_period)) > 1e-9 or abs(float(record.time[0])) > 1e-9:
        raise IncompatibleRecord(
            f"a replay needs a sample of every control period ({float(record.control_period):g} s) from time 0; this "
            f"record has one every {step:g} s from {float(record.time[0]):g} s. Simulate with sample_stride=1."
        )


def _copy(model: Any) -> Any:
    """Return a model of its own; compiled ones are shared."""
    return model.__copy__()


def _begin(model: Any, data: Any, record: xr.Dataset, robot: Robot) -> None:
    """Put the model into the state of the first sample, at rest."""
    first = record.isel(time=0)
    data.qpos[:3], data.qpos[3:7] = first.position.values, first.orientation.values
    data.qpos[joint_addresses(model, layout(robot).hinges)] = first.joint_angle.values
    target, angle = first.servo_target.values, first.servo_angle.values
    initial = np.where(np.abs(target - angle) < 1e-6, target, angle)  # a first command with noise is not the posture
    data.act[:] = activations(model, initial)
    mujoco.mj_forward(model, data)


def _push(model: Any, data: Any, pushes: Sequence[Push], start: float, end: float) -> None:
    """Apply the mean forces of the pushes in a control period [s]."""
    data.xfrc_applied[:] = 0.0
    for push in pushes:
        data.xfrc_applied[model.body(push.body).id, :3] += push.overlap_fraction(start, end) * np.array(push.force)


EXACT_ANGLE = 1e-9
"""Difference of two angles that are the same but for rounding [rad]."""


class _BrokenPart:
    """A fault of a replay, with the control periods in which it is present.

    Args:
        fault: the fault.
        plant: what it writes to.
        period: control period [s].
    """

    def __init__(self, fault: Fault, plant: "_PlainPlant", period: float) -> None:
        """Note the first spell."""
        self._fault, self._plant, self._period = _as_recorded(fault), plant, period
        self._spells = fault.persistence.spell_ticks(fault.part, fault.at, period)
        self._begin, self._end = self._next_spell()

    def act(self, tick: int, targets: np.ndarray) -> None:
        """Begin, act or end in a control period, in which the servos are commanded these angles [rad]."""
        if self._end is not None and tick >= self._end:
            self._fault.mend(self._plant)
            self._begin, self._end = self._next_spell()
        if self._begin is None or tick < self._begin:
            return
        self._plant.time = (tick - self._begin) * self._period
        self._plant.targets = dict(zip(layout(self._plant.robot).servos, targets, strict=True))
        if tick == self._begin:
            self._plant.memory = {}
            self._fault.apply(self._plant)
        self._fault.command(self._plant)

    def _next_spell(self) -> tuple[int | None, int | None]:
        """Return the first control period of the next spell and the first one after it; None where there is none."""
        return next(self._spells, (None, None))


def _as_recorded(fault: Fault) -> Fault:
    """Return a fault that acts on recorded commands as the fault itself acts on the controller's.

    A record holds the angle of the shaft while a servo is free within its backlash, and otherwise that of the gap's
    end: from there no gap is left.
    """
    return replace(fault, gap=min(fault.gap, EXACT_ANGLE)) if isinstance(fault, Backlash) else fault


@dataclass(slots=True)
class _PlainPlant:
    """A ``fault.Plant`` that writes to one MuJoCo model; nothing is sensed."""

    model: Any
    data: Any
    robot: Robot
    time: float = 0.0
    memory: dict[str, float] = field(default_factory=dict)
    targets: MutableMapping[str, float] = field(default_factory=dict)
    original_rows: dict[tuple[str, int], np.ndarray] = field(default_factory=dict)
    unpowered: int = 0
    """Bits of the groups of servos from which the torque was taken."""

    def angle(self, servo: str) -> float:
        """Return the angle at a servo's shaft as it is now [rad]; a step leaves that at its own beginning."""
        for update in (mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_tendon, mujoco.mj_transmission):
            update(self.model, self.data)
        return float(self.data.actuator_length[self.model.actuator(servo).id])

    def felt(self, group: str, part_name: str | None = None) -> np.ndarray:
        """Return no readings: a replay has no sensors."""
        del group, part_name
        return np.zeros(1)

    def parameter(self, field: str, element: str) -> np.ndarray:
        """Return a row of a model field for writing."""
        accessor = {"actuator": self.model.actuator, "geom": self.model.geom, "body": self.model.body}
        kind = field.partition("_")[0]
        row = int(accessor[kind](element).id) if kind in accessor else int(self.model.joint(element).dofadr[0])
        values = np.asarray(getattr(self.model, field))[row : row + 1]
        self.original_rows.setdefault((field, row), values.copy())
        return values[0] if values.ndim > 1 else values

    def speed_limit(self, servo: str) -> np.ndarray:
        """Return the speed limit of a servo for writing [rad/s]."""
        column = slew_column(self.model, servo)
        return self.parameter("actuator_dynprm", servo)[column : column + 1]

    def unpower(self, servo: str) -> None:
        """Take the torque from a servo."""
        self.unpowered |= 1 << int(self.model.actuator(servo).group[0])
        self.model.opt.disableactuator |= self.unpowered

    def restore(self) -> None:
        """Undo what was written."""
        for (name, row), original in self.original_rows.items():
            np.asarray(getattr(self.model, name))[row : row + 1] = original
        self.model.opt.disableactuator &= ~self.unpowered
        self.original_rows, self.unpowered = {}, 0


class _Account:
    """Steps a model and sums up work, energy, momentum and contact forces, all by MuJoCo's own arrays."""

    def __init__(self, model: Any, data: Any, timestep: float) -> None:
        """Take the model and its state."""
        self.model, self.data, self.timestep = model, data, timestep
        self._mass, self._moment = np.zeros((model.nv, model.nv)), np.zeros((model.nu, model.nv))
        self._pushing = np.zeros(model.nv)
        self.mass = float(model.body_mass[1:].sum())
        self.begin()

    def begin(self) -> None:
        """Begin all sums at zero in the present state."""
        self.torque = np.zeros(self.model.nu)
        self.work = self.absolute_work = self.other_work = self.turnover = 0.0
        self.square = np.zeros(self.model.nu)
        self.impulse = np.zeros(3)
        self.loads: list[float] = []
        self._load, self._steps, self.count = 0.0, 0, 0
        self.start_momentum: np.ndarray | None = None
        self.start_energy = 0.0
        self.momentum, self.energy = np.zeros(3), 0.0

    def step(self) -> None:
        """Take one step of the physics, and add to the sums."""
        model, data, timestep = self.model, self.data, self.timestep
        mujoco.mj_step1(model, data)
        start_rate, shaft_rate = data.qvel.copy(), data.actuator_velocity.copy()
        mujoco.mj_fullM(model, data, self._mass)
        mujoco.mju_sparse2dense(
            self._moment, data.actuator_moment, data.moment_rownnz, data.moment_rowadr, data.moment_colind
        )
        self._note()
        self._pushing[:] = 0.0
        for body in np.flatnonzero(data.xfrc_applied.any(axis=1)):
            force, torque = data.xfrc_applied[body, :3], data.xfrc_applied[body, 3:]
            mujoco.mj_applyFT(model, data, force, torque, data.xipos[body], body, self._pushing)
        mujoco.mj_step2(model, data)
        self.torque = data.actuator_force.copy()
        gained = data.qvel - start_rate
        implicit = self._mass @ gained / timestep - data.qfrc_smooth - data.qfrc_constraint
        damping = -model.dof_damping * gained
        for actuator in np.flatnonzero(model.actuator_trntype == int(mujoco.mjtTrn.mjTRN_TENDON)):
            row = self._moment[actuator] / model.actuator_gear[actuator, 0]
            damping -= float(model.tendon_damping[model.actuator_trnid[actuator, 0]] * (row @ gained)) * row
        applied = self.torque + np.linalg.lstsq(self._moment[:, 6:].T, (implicit - damping)[6:], rcond=None)[0]
        mean_rate = 0.5 * timestep * (start_rate + data.qvel)
        shaft_way = 0.5 * timestep * (shaft_rate + self._moment @ data.qvel)
        self.work += float(applied @ shaft_way)
        self.absolute_work += float(np.abs(applied * shaft_way).sum())
        passive = data.qfrc_passive - data.qfrc_spring  # the energy of springs is among the potential energy
        outer = data.qfrc_constraint + data.qfrc_applied + self._pushing
        other_work = float((passive + damping + outer) @ mean_rate)
        self.other_work += other_work
        self.turnover += float(np.abs(applied * shaft_way).sum()) + abs(other_work)
        self.square += applied**2
        contact = self._contact_force()
        self._load += float(-contact @ model.opt.gravity) / float(np.linalg.norm(model.opt.gravity))
        push = data.xfrc_applied[:, :3].sum(axis=0)
        self.impulse += timestep * (contact + push + self.mass * model.opt.gravity)
        self._steps += 1
        self.count += 1

    def _note(self) -> None:
        """Store momentum and energy of the state at hand; the first ones are those of the start."""
        mujoco.mj_subtreeVel(self.model, self.data)
        momentum = self.mass * self.data.subtree_linvel[0]
        self.momentum, self.energy = np.array(momentum), float(self.data.energy.sum())
        if self.start_momentum is None:
            self.start_momentum, self.start_energy = self.momentum, self.energy

    def _contact_force(self) -> np.ndarray:
        """Return the force of the ground on the robot by all its contacts, in the world, shape (3,) [N]."""
        total, wrench = np.zeros(3), np.zeros(6)
        for index in range(self.data.ncon):
            contact = self.data.contact[index]
            first, second = (int(self.model.geom_bodyid[geom]) for geom in contact.geom)
            if first and second:
                continue  # of two parts of the robot on each other
            mujoco.mj_contactForce(self.model, self.data, index, wrench)
            force = contact.frame.reshape(3, 3).T @ wrench[:3]
            total += force if second else -force  # MuJoCo's is that on the second body
        return total

    def close_period(self) -> None:
        """End a control period: its mean contact force becomes a sample."""
        self.loads.append(self._load / self._steps)
        self._load, self._steps = 0.0, 0


def _compare(record: xr.Dataset, samples: Sequence[tuple[np.ndarray, np.ndarray]], account: _Account) -> Replay:
    """Return the differences between a record and what an account says of its replay."""
    mujoco.mj_step1(account.model, account.data)
    account._note()
    positions, torques = (np.array(values) for values in zip(*samples, strict=True))
    recorded = record.isel(time=slice(record.sizes["time"] - len(samples), None))
    period = float(record.control_period)
    torque = recorded.servo_torque.transpose("time", "servo").values
    net_work = period * float(recorded.servo_power.sum())
    absolute_work = period * float(recorded.servo_absolute_power.sum())
    rms = np.sqrt(recorded.servo_mean_square_torque.mean("time").values)
    own_rms = np.sqrt(account.square / account.count)
    up = -account.model.opt.gravity / np.linalg.norm(account.model.opt.gravity)
    forces = ground_force(recorded).transpose("time", "xyz").values
    weight = account.mass * GRAVITY
    duration = account.count * account.timestep
    assert account.start_momentum is not None
    missing = account.momentum - account.start_momentum - account.impulse
    gained = account.energy - account.start_energy
    scale = max(account.absolute_work, 1e-12)
    return Replay(
        position_error=float(np.abs(positions - recorded.position.values).max()),
        torque_error=float(np.abs(torques - torque).max() / max(np.abs(torque).max(), 1e-12)),
        work_error=abs(net_work - account.work) / scale,
        absolute_work_error=abs(absolute_work - account.absolute_work) / scale,
        square_error=float(np.abs(rms - own_rms).max() / max(own_rms.max(), 1e-12)),
        load_error=float(np.mean(account.loads) - (forces @ up).mean()) / weight,
        momentum_error=float(np.linalg.norm(missing)) / (weight * duration),
        energy_error=abs(account.work + account.other_work - gained) / max(account.turnover, 1e-12),
    )


LIMITS: Mapping[str, float] = {
    "position_error": 1e-9, "torque_error": 1e-9, "work_error": 1e-3, "absolute_work_error": 5e-3,
    "square_error": 5e-3, "load_error": 0.01, "momentum_error": 2e-3, "energy_error": 2e-3,
}  # fmt: skip
"""Greatest absolute values of a ``Replay`` that agrees."""


PAGE_WIDTH = 150
"""Width of the table in a file [character]."""
FAULT_TIME = 1.5
"""Time at which the faults of the replayed runs begin [s]."""


def runs() -> list[Run]:
    """Return the runs that are replayed: each body of the catalog in its gaits, and in its own gait with each fault."""
    bodies = [robot for robot in suchus.ROBOTS.values() if layout(robot).limbs]
    walks = [
        Run(robot=robot, gait=gait, label=f"{robot.name} {gait.name}")
        for robot in bodies
        for gait in suchus.GAITS.values()
        if _suits(robot, gait)
    ]
    broken = [
        Run(
            robot=robot, gait=default_gait(robot), faults=(fault,),
            label=f"{robot.name} {fault.name} {fault.persistence.kind}",
        )
        for robot in bodies
        for fault in faults_of(robot)
    ]  # fmt: skip
    return [*walks, *broken]


def faults_of(robot: Robot) -> list[Fault]:
    """Return each kind of fault of the first part of a robot, as one that stays, recovers, and comes and goes."""
    settings: Mapping[str, Mapping[str, float]] = {
        "backlash": {"gap": 0.1}, "delayed": {"delay": 0.1}, "offset": {"angle": 0.2}, "slow": {"speed": 0.5},
        "weak": {"fraction": 0.3},
    }  # fmt: skip
    persistences = (Persistence(), Persistence(duration=0.4), Persistence(rate=2.0, length=0.1, seed=1))
    found = []
    for name, kind in suchus.FAULTS.items():
        make: Callable[..., Fault] = kind
        for persistence in persistences[:1] if issubclass(kind, SensorFault) else persistences:
            part = kind.parts(robot)[0]
            found.append(make(part, at=FAULT_TIME, persistence=persistence, **settings.get(name, {})))
    return found


def _suits(robot: Robot, gait: Any) -> bool:
    """Return whether a robot can walk in a gait."""
    try:
        simulate([Run(robot=robot, gait=gait)], duration=0.1)
    except suchus.core.errors.SuchusError:
        return False
    return True


def main() -> int:
    """Replay all runs and print the table and the count; return 1 where one disagrees."""
    table, bad, replayed = Table("run", *(name.replace("_", " ") for name in LIMITS)), 0, runs()
    for run in replayed:
        record = simulate([run], duration=3.0)
        result = replay(record.isel(run=0), run.robot, faults=run.faults, pushes=run.pushes)
        values = {name: getattr(result, name) for name in LIMITS}
        agrees = all(abs(values[name]) <= LIMITS[name] for name in LIMITS)
        bad += not agrees
        table.add_row(run.label, *(f"{value:.2g}" for value in values.values()), style=None if agrees else "red")
    console = Console() if sys.stdout.isatty() else Console(width=PAGE_WIDTH)
    console.print(table)
    console.print(f"{len(replayed) - bad} of {len(replayed)} records agree.")
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())

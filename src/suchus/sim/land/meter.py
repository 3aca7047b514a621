"""What servos and water do over a control period: means over its physics steps, within which both vary.

Servos are commanded anew at the first physics step of a control period, and answer within it. One sample a period is
locked to that answer: it is no measure of work, heat or peaks.
"""

from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from jaxtyping import Bool, Float

from suchus.core import water_table as hydro
from suchus.robot.design import Robot, layout
from suchus.sim.model import SUPPLY, supplies
from suchus.sim.record import EFFORT

_LOOP_DAMPING = 6
"""Column of ``actuator_gainprm`` in which MuJoCo's dcmotor keeps the derivative gain of its loop [N m s/rad]."""
_PID_DAMPING = 2
"""Column of ``actuator_biasprm`` in which MuJoCo's pid keeps minus its derivative gain [N m s/rad]."""
_FULL_SUPPLY = 0.98
"""Fraction of the supply from which on a servo is taken to have all of it [-]; a winding that is 5 K warmer than its
room has so much less torque of the same voltage."""
_MIN_TORQUE = 1e-9
"""Least torque [N m] that a torque is compared with."""
MEAN_TORQUE, MEAN_SQUARE, POWER, ABSOLUTE_POWER, PEAK, USE = range(len(EFFORT))
"""Columns of the effort of a servo, in the order of ``record.EFFORT``."""


class ServoLaws:
    """The numbers of each servo of a batch by which its torque follows, as the models have them now.

    Args:
        model: model that the runs begin with.
        robots: robots of the runs.
    """

    def __init__(self, model: Any, robots: Sequence[Robot]) -> None:
        """Read the servos of each run from its design; ``read`` follows what faults change."""
        servos = [[robot.servo(name) for name in layout(robot).servos] for robot in robots]
        shape = len(robots), len(servos[0])
        self._is_motor = model.actuator_dyntype == int(mujoco.mjtDyn.mjDYN_DCMOTOR)
        self._volts = np.array([supplies(robot) for robot in robots]).reshape(shape)
        self.stall_torque = np.array([[servo.torque for servo in row] for row in servos]).reshape(shape)
        """Torque at standstill and full supply, shape (run, servo) [N m]."""
        no_load_speed = np.array(
            [[np.inf if servo.winding is None else servo.ideal_speed for servo in row] for row in servos]
        ).reshape(shape)
        self.supplied_torque = self.stall_torque.copy()
        """Torque at standstill with the present supply [N m]."""
        self.limit = np.zeros(shape)
        """Greatest torque of the servo's drive [N m]."""
        self.damping = np.zeros(shape)
        """Loss of torque with speed that MuJoCo's implicit step takes into account [N m s/rad]."""
        self.falling_torque = self.stall_torque / no_load_speed
        """Torque that a speed in its direction takes away, over that speed [N m s/rad]."""
        self.full_supply_damping = np.zeros(shape)
        """What ``damping`` is while a servo has its full supply, on which its loop has no influence [N m s/rad]."""
        self.is_implicit = np.ones(len(robots), dtype=bool)
        """Whether the physics of a run takes implicit steps, shape (run,)."""
        self.is_powered = np.ones(shape, dtype=bool)
        """Whether each servo has torque at all."""

    def read(
        self, sim: int, gain: Float[np.ndarray, "servo n"], bias: Float[np.ndarray, "servo n"],
        force_range: Float[np.ndarray, "servo 2"],
    ) -> None:  # fmt: skip
        """Take the numbers of one run from the fields of its model.

        Args:
            sim: the run.
            gain: ``actuator_gainprm``.
            bias: ``actuator_biasprm``.
            force_range: ``actuator_forcerange`` [N m].
        """
        self.limit[sim] = force_range[:, 1]
        loop_damping = np.where(self._is_motor, gain[:, _LOOP_DAMPING], -bias[:, _PID_DAMPING])
        acts = self.is_powered[sim] & self.is_implicit[sim]
        self.damping[sim] = loop_damping * acts
        self.full_supply_damping[sim] = np.where(self._is_motor, self.falling_torque[sim], loop_damping) * acts
        supply = gain[:, SUPPLY] / self._volts[sim]
        self.supplied_torque[sim] = self.stall_torque[sim] * np.where(np.isnan(supply), 1.0, supply)


class Meter:
    """Records forces and powers of water and servos in each physics step of a control period.

    The torque of a servo in a step is the one that MuJoCo's implicit step applies, with the speed at its end. The
    sensor shows the torque at the speed of its start, which is greater while the servo answers a new command: the work
    of the former hardly depends on the time step, that of the latter is a quarter too great at 5 ms.

    Args:
        water: water of the batch, shape (run, ``hydro.NUMBERS``) or (run, 0) on dry land; read anew at every step.
        sensors: sensors of the batch, shape (run, sensor); likewise.
        velocities: where the servos' speeds are among the sensors.
        torques: where their torques are.
        laws: laws of the servos.
        steps: steps of the physics in a control period.
    """

    def __init__(
        self, water: np.ndarray, sensors: np.ndarray, velocities: slice, torques: slice, laws: ServoLaws, steps: int
    ) -> None:
        """Reserve arrays for the readings of one control period."""
        first_sensor, last_sensor = min(velocities.start, torques.start), max(velocities.stop, torques.stop)
        self._columns, self._steps = slice(first_sensor, last_sensor), steps
        self._is_wet, self._laws = bool(water.shape[1]), laws
        self._acts, self._sensors = water[:, hydro.FORCE : hydro.FORCE + 4], sensors[:, self._columns]
        self._did, self._history = np.zeros((steps, *self._acts.shape)), np.zeros((steps + 1, *self._sensors.shape))
        self._speeds = self._history[..., velocities.start - first_sensor : velocities.stop - first_sensor]
        self._torque = self._history[1:, :, torques.start - first_sensor : torques.stop - first_sensor]

    def begin(self, readings: Float[np.ndarray, "run sensor"]) -> None:
        """Store the sensor readings before the first step.

        Args:
            readings: readings of all sensors after the last period. A run that parts from its leader has the leader's
                readings, but old sensors.
        """
        self._history[0] = readings[:, self._columns]

    def record_step(self, step: int, rows: slice = slice(None)) -> None:
        """Store water forces and sensor readings of some runs after a physics step.

        Args:
            step: number of the step.
            rows: the runs.
        """
        self._did[step, rows] = self._acts[rows]
        self._history[step + 1, rows] = self._sensors[rows]

    def powers(self, periods: int) -> Float[np.ndarray, "period run servo"]:
        """Return the mean size of the power of each servo in each of some equal parts of the steps [W].

        Args:
            periods: number of parts.
        """
        power = self._speeds[:-1] + self._speeds[1:]
        power *= applied_torque(self._torque, self._speeds[:-1], self._speeds[1:], self._laws)
        power *= 0.5
        np.abs(power, out=power)
        steps = self._steps // periods
        means: np.ndarray = np.add.reduce(power.reshape(periods, steps, *power.shape[1:]), axis=1)
        means *= 1.0 / steps
        return means

    def finish(
        self,
        water: np.ndarray,
        effort: np.ndarray,
        selection: Bool[np.ndarray, " run"] | slice,
        *,
        only_power: bool = False,
    ) -> None:
        """Write what the water and the servos did in the control period.

        Args:
            water: means of force and power of the water, shape (run, 4) [N, W]; written.
            effort: effort of each servo, shape (run, servo, 6), in the order of ``record.EFFORT``; written.
            selection: runs for which they are written.
            only_power: whether the size of the power alone is written.
        """
        if self._is_wet:
            water[selection] = self._did.mean(axis=0)[selection]
        if only_power:
            effort[selection, :, ABSOLUTE_POWER] = self.powers(1)[0][selection]
            return
        values = servo_effort(self._torque, self._speeds[:-1], self._speeds[1:], self._laws)
        if isinstance(selection, slice):
            effort[:] = values
        else:
            effort[selection] = values[selection]


def applied_torque(
    torque: Float[np.ndarray, "step run servo"],
    start_speed: Float[np.ndarray, "step run servo"],
    end_speed: Float[np.ndarray, "step run servo"],
    laws: ServoLaws,
) -> Float[np.ndarray, "step run servo"]:
    """Return the torque that MuJoCo's implicit steps apply; the arguments are those of ``servo_effort`` [N m]."""
    standstill_torque = np.abs(torque + laws.falling_torque * start_speed)  # of the same voltage
    has_full_supply = standstill_torque >= _FULL_SUPPLY * laws.supplied_torque
    applied = (end_speed - start_speed) * np.where(has_full_supply, laws.full_supply_damping, laws.damping)
    applied *= np.abs(torque) < laws.limit  # a torque at its limit stays there
    return np.asarray(np.subtract(torque, applied, out=applied))


def servo_effort(
    torque: Float[np.ndarray, "step run servo"],
    start_speed: Float[np.ndarray, "step run servo"],
    end_speed: Float[np.ndarray, "step run servo"],
    laws: ServoLaws,
) -> Float[np.ndarray, "run servo 6"]:
    """Return the effort of each servo over some physics steps, in the order of ``record.EFFORT``.

    Args:
        torque: torque by the sensor, at the start of each step [N m].
        start_speed: speed of the shaft before each step [rad/s].
        end_speed: after it [rad/s].
        laws: laws of the servos.
    """
    effort = np.empty((*torque.shape[1:], len(EFFORT)))
    step_weight = 1.0 / len(torque)

    def mean(values: np.ndarray) -> np.ndarray:
        """Return the mean over the steps, added in their order: the same bytes whatever runs a batch holds."""
        means: np.ndarray = np.add.reduce(values, axis=0)
        means *= step_weight
        return means

    applied = applied_torque(torque, start_speed, end_speed, laws)
    size = np.abs(applied)
    effort[..., MEAN_TORQUE], effort[..., MEAN_SQUARE] = mean(applied), mean(applied * applied)
    power = start_speed + end_speed
    power *= applied
    power *= 0.5
    effort[..., POWER], effort[..., ABSOLUTE_POWER] = mean(power), mean(np.abs(power))
    np.minimum(size.max(axis=0), laws.limit, out=effort[..., PEAK])  # an implicit step may go beyond it
    available = np.copysign(laws.falling_torque, applied)
    available *= end_speed
    np.subtract(laws.supplied_torque, available, out=available)
    np.minimum(available, laws.limit, out=available)
    np.maximum(available, _MIN_TORQUE, out=available)
    size /= available
    effort[..., USE] = size.max(axis=0)
    return effort


def joint_effort(efforts: Sequence[Float[np.ndarray, "... 6"]], weights: Sequence[float]) -> Float[np.ndarray, "... 6"]:
    """Return the effort over several intervals from that over each.

    Args:
        efforts: in each interval.
        weights: fraction of the time of each interval; they sum up to 1 [-].
    """
    stacked = np.stack(efforts)
    factors = np.asarray(weights).reshape(-1, *(1,) * (stacked.ndim - 1))
    joint: np.ndarray = np.add.reduce(factors * stacked, axis=0)
    joint[..., PEAK:] = stacked[..., PEAK:].max(axis=0)
    return joint

"""Reading a batch's sensors: for the controller at every period, for the record at every sample."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from suchus.control import Sensed
from suchus.design import LEGS, joint_names, servo_names
from suchus.land.bench import Bench
from suchus.land.run import Run
from suchus.model import TRUNK_BODIES, joint_addresses, sensor_names
from suchus.record import dataset, ground_text


class Readings:
    """The sensors of a batch, and everything that was read."""

    def __init__(self, bench: Bench, runs: Sequence[Run], samples: int) -> None:
        self._bench = bench
        self._runs = runs
        model = bench.model
        self._at = {
            name: slice(int(model.sensor(name).adr[0]), int(model.sensor(name).adr[0] + model.sensor(name).dim[0]))
            for name in sensor_names()
        }
        self._felt = {
            "servo_position": self._span(servo_names(), "position"),
            "servo_velocity": self._span(servo_names(), "velocity"),
            "servo_torque": self._span(servo_names(), "torque"),
            "orientation": self._at["imu_orientation"],
            "angular_velocity": self._at["imu_gyroscope"],
            "acceleration": self._at["imu_accelerometer"],
        }
        self._pressed = {
            "foot_pressure": self._upward(LEGS),
            "belly_pressure": self._upward(TRUNK_BODIES),
            "tail_pressure": self._at["tail_force"].start + 2,
        }
        self._joints = joint_addresses(model, joint_names(runs[0].robot))
        n = len(runs)
        self._sensors = np.full((n, samples, model.nsensordata), np.nan)
        self._qpos = np.full((n, samples, model.nq), np.nan)
        self._phase = np.full((n, samples, 4), np.nan)
        self._targets = np.full((n, samples, len(servo_names())), np.nan)

    def store(self, sample: int, phase: np.ndarray, targets: np.ndarray) -> None:
        """Keep one sample of the living."""
        alive = slice(None) if self._bench.alive.all() else self._bench.alive
        self._sensors[alive, sample] = self._bench.readings[alive]
        self._qpos[alive, sample] = self._bench.qpos[alive]
        self._phase[alive, sample] = phase[alive]
        self._targets[alive, sample] = targets[alive]

    def sensed(self, time: float) -> Sensed:
        """Return what the robots feel now."""
        read = self._bench.readings
        felt = {name: read[:, where].copy() for name, where in self._felt.items()}
        pressed = {name: -read[:, where] for name, where in self._pressed.items()}
        return Sensed(time=time, **felt, **pressed)

    def sample(self, run: int, sample: int) -> dict[str, np.ndarray]:
        """Return one stored sample of one run: the variables of ``record.VARIABLES`` without run and time."""
        return {name: np.array(values[run, sample]) for name, values in self._arrays().items()}

    def record(self, time: np.ndarray) -> xr.Dataset:
        """Return everything that was read, in the schema of a run."""
        robots = [run.robot for run in self._runs]
        arrays = self._arrays()
        last = np.minimum(self._bench.ended, time[-1])
        per_run = {
            "mass": np.array([robot.mass for robot in robots]),
            "period": np.array([run.gait.period for run in self._runs]),
            "duty_factor": np.array([run.gait.duty_factor for run in self._runs]),
            "ended": last,
            "cause": np.array(self._bench.cause),
            "stands_on": np.array([ground_text(None if run.afloat else run.ground) for run in self._runs]),
        }
        coordinates: dict[str, Sequence[object] | np.ndarray] = {
            "run": np.arange(len(robots)),
            "time": time,
            "leg": LEGS,
            "segment": TRUNK_BODIES,
            "joint": joint_names(robots[0]),
            "servo": servo_names(),
            "robot": [robot.name for robot in robots],
            "gait": [run.gait.name for run in self._runs],
            "label": [run.label or run.gait.name for run in self._runs],
        }
        return dataset(arrays, per_run, coordinates)

    def _arrays(self) -> dict[str, np.ndarray]:
        read = self._sensors
        n, samples = read.shape[:2]

        def block(names: Sequence[str], suffix: str) -> np.ndarray:
            return self._block(read, names, suffix)

        return {
            "position": self._qpos[..., :3],
            "orientation": self._qpos[..., 3:7],
            "joint_angle": self._qpos[..., self._joints],
            "centre_of_mass": read[..., self._at["centre_of_mass"]],
            "angular_momentum": read[..., self._at["angular_momentum"]],
            "snout": block(("snout",), "position"),
            "tail_tip": block(("tail_tip",), "position"),
            "foot_position": block([f"{leg}_foot" for leg in LEGS], "position").reshape(n, samples, 4, 3),
            # the sensors read the robot's force on the ground; the record holds the ground's on the robot
            "foot_force": -block(LEGS, "force").reshape(n, samples, 4, 3),
            "belly_force": -block(TRUNK_BODIES, "force").reshape(n, samples, len(TRUNK_BODIES), 3),
            "tail_force": -read[..., self._at["tail_force"]],
            "servo_angle": block(servo_names(), "position"),
            "servo_velocity": block(servo_names(), "velocity"),
            "servo_torque": block(servo_names(), "torque"),
            "servo_target": self._targets,
            "limb_phase": self._phase,
            "angular_velocity": read[..., self._at["imu_gyroscope"]],
            "acceleration": read[..., self._at["imu_accelerometer"]],
        }

    def _block(self, read: np.ndarray, names: Sequence[str], suffix: str) -> np.ndarray:
        """Return neighbouring sensors as one array."""
        return np.array(read[..., self._span(names, suffix)])

    def _span(self, names: Sequence[str], suffix: str) -> slice:
        """Return where neighbouring sensors stand."""
        return slice(self._at[f"{names[0]}_{suffix}"].start, self._at[f"{names[-1]}_{suffix}"].stop)

    def _upward(self, names: Sequence[str]) -> slice:
        """Return where the vertical parts of neighbouring forces stand."""
        all_parts = self._span(names, "force")
        return slice(all_parts.start + 2, all_parts.stop, 3)

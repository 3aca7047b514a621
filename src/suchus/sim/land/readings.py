"""The sensors of a batch: their present readings for controllers, and their samples as a record."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus.core import water_table as hydro
from suchus.core.water_table import column
from suchus.robot.control import Sensed
from suchus.robot.design import GRAVITY, Robot, layout
from suchus.robot.design.pieces import chambers, pieces
from suchus.sim.land.batch import SimulationBatch
from suchus.sim.land.lake import lake_text, up_direction
from suchus.sim.land.meter import joint_effort
from suchus.sim.land.run import Run
from suchus.sim.model import ambient, joint_addresses, sensor_names, warming
from suchus.sim.record import EFFORT, ELECTRICAL, WATER, dataset, ground_text


class Sensors:
    """Columns and present readings of the sensors of a batch."""

    def __init__(self, batch: SimulationBatch, robot: Robot) -> None:
        """Look up the columns of each sensor in the model."""
        self._batch = batch
        self.layout = robot_layout = layout(robot)
        model = batch.model
        self._columns = {
            name: slice(int(model.sensor(name).adr[0]), int(model.sensor(name).adr[0] + model.sensor(name).dim[0]))
            for name in sensor_names(robot_layout.robot)
        }
        self._sensor_columns = {
            "servo_position": self.span(robot_layout.servos, "position"),
            "servo_velocity": self.span(robot_layout.servos, "velocity"),
            "servo_torque": self.span(robot_layout.servos, "torque"),
            "orientation": self._columns["imu_orientation"],
            "angular_velocity": self._columns["imu_gyroscope"],
            "acceleration": self._columns["imu_accelerometer"],
        }
        self._pressed = {
            "foot_pressure": self._upward(robot_layout.limb_names),
            "belly_pressure": self._upward(robot_layout.trunk),
        }

    def __getitem__(self, name: str) -> Float[np.ndarray, "run n"]:
        """Return the present readings of a sensor in every run; a view, which the next control period overwrites."""
        return self._batch.readings[:, self._columns[name]]

    def columns(self, name: str) -> slice:
        """Return where the values of one sensor stand in a row of readings."""
        return self._columns[name]

    def span(self, names: Sequence[str], suffix: str) -> slice:
        """Return where the values of neighbouring sensors, ``NAME_SUFFIX`` for each name, stand in a row."""
        if not names:
            return slice(0, 0)
        return slice(self._columns[f"{names[0]}_{suffix}"].start, self._columns[f"{names[-1]}_{suffix}"].stop)

    def tail(self, rows: np.ndarray) -> np.ndarray:
        """Return the force of the tail on the ground in rows of readings; zero where there is no tail [N]."""
        columns = self._columns.get("tail_force")
        return np.zeros((*rows.shape[:-1], 3)) if columns is None else rows[..., columns]

    def sensed(self, time: float) -> Sensed:
        """Return the present sensor readings of the robots, in new arrays."""
        rows = self._batch.readings
        new_rows = rows.copy()  # once, in the place of each of its parts
        readings = {name: new_rows[:, columns] for name, columns in self._sensor_columns.items()}
        pressed = {name: -rows[:, columns] for name, columns in self._pressed.items()}
        depth = self._batch.waters.depths(self._batch.qpos[:, :3])
        return Sensed(time=time, **readings, **pressed, tail_pressure=-self.tail(rows)[..., 2], depth=depth)

    def _upward(self, names: Sequence[str]) -> slice:
        """Return where the vertical parts of neighbouring forces stand."""
        all_parts = self.span(names, "force")
        return slice(min(all_parts.start + 2, all_parts.stop), all_parts.stop, 3)


class Recorder:
    """Keeps samples of a batch, for which there is room from the beginning, and makes them a record.

    Args:
        batch: the simulations.
        sensors: sensors of the batch.
        runs: runs of the batch.
        samples: for how many there is room.
        has_effort: whether what the servos do is kept too.
    """

    def __init__(
        self, batch: SimulationBatch, sensors: Sensors, runs: Sequence[Run], samples: int, *, has_effort: bool = True
    ) -> None:
        """Reserve an array of NaN for each quantity that is sampled."""
        self._batch, self._sensors, self._runs = batch, sensors, runs
        self._layout = robot_layout = sensors.layout
        self._joints = joint_addresses(batch.model, robot_layout.hinges)
        self._foot_radii = np.array(
            [[limb.girdle.limb.foot.radius for limb in layout(run.robot).limbs] for run in runs]
        )
        shape = len(runs), samples
        self._readings = np.full((*shape, batch.readings.shape[1]), np.nan)
        self._qpos = np.full((*shape, batch.qpos.shape[1]), np.nan)
        self._phase = np.full((*shape, len(robot_layout.limbs)), np.nan)
        self._targets = np.full((*shape, len(robot_layout.servos)), np.nan)
        self._water = np.full((*shape, batch.waters.rows.shape[1]), np.nan)
        self._period_means = np.full((*shape, batch.period_means.shape[1]), np.nan)
        self._has_effort = has_effort
        self._effort = np.full((*shape, *batch.effort.shape[1:]) if has_effort else (*shape, 0, 0), np.nan)
        self._gathered: list[tuple[np.ndarray, np.ndarray]] = []
        self._temperature_columns = warming(batch.model, runs[0].robot)
        self._air = np.array([ambient(run.robot) for run in runs])
        heated = len(robot_layout.servos) if (self._temperature_columns >= 0).any() else 0
        self._temperature = np.full((*shape, heated), np.nan)

    def gather(self) -> None:
        """Note what water and servos did in a control period that ends between two samples."""
        self._gathered.append((self._batch.period_means.copy(), self._batch.effort.copy()))

    def _since_sample(self) -> tuple[np.ndarray, np.ndarray]:
        """Return what water and servos did since the sample before, and begin anew."""
        water, effort = self._batch.period_means, self._batch.effort
        if self._gathered:
            waters, efforts = zip(*self._gathered, (water, effort), strict=True)
            water = np.mean(waters, axis=0)
            effort = joint_effort(efforts, [1.0 / len(efforts)] * len(efforts))
            self._gathered.clear()
        return water, effort

    def store(self, sample: int, phase: np.ndarray, targets: np.ndarray) -> None:
        """Store one sample of the runs that are alive.

        Args:
            sample: its number.
            phase: phase of the limbs, shape (run, limb) [cycle].
            targets: commanded servo angles, shape (run, servo) [rad].
        """
        alive = slice(None) if self._batch.alive.all() else self._batch.alive
        self._readings[alive, sample] = self._batch.readings[alive]
        self._qpos[alive, sample] = self._batch.qpos[alive]
        self._phase[alive, sample] = phase[alive]
        self._targets[alive, sample] = targets[alive]
        self._water[alive, sample] = self._batch.waters.rows[alive]
        water_means, effort = self._since_sample()
        self._period_means[alive, sample] = water_means[alive]
        if self._has_effort:
            self._effort[alive, sample] = effort[alive]
        if self._temperature.shape[-1]:
            self._temperature[alive, sample] = (
                self._batch.activations[alive][:, self._temperature_columns] + self._air[alive]
            )

    def state(self) -> dict[str, np.ndarray]:
        """Return copies of all samples, by name."""
        return {name: values.copy() for name, values in self._stored_arrays.items()}

    def resume(self, state: Mapping[str, np.ndarray]) -> None:
        """Load the samples that another recorder of the same runs stored."""
        for name, values in self._stored_arrays.items():
            values[:] = state[name]

    @property
    def _stored_arrays(self) -> dict[str, np.ndarray]:
        return {
            "readings": self._readings, "qpos": self._qpos, "phase": self._phase, "targets": self._targets,
            "water": self._water, "worked": self._period_means, "effort": self._effort,
            "temperature": self._temperature,
        }  # fmt: skip

    def sample(self, run: int, sample: int) -> dict[str, np.ndarray]:
        """Return one stored sample of one run: ``record.VARIABLES`` and ``record.EFFORT`` without run and time.

        In water those of ``record.WATER`` too, with servos that warm up that of ``record.HEAT``.
        """
        arrays = self._arrays()
        water_arrays = self._water_arrays(arrays["foot_force"]) if self._water.shape[-1] else {}
        return {
            name: np.array(values[run, sample])
            for name, values in (arrays | self._efforts() | water_arrays | self._warmed()).items()
        }

    def record(self, time: np.ndarray) -> xr.Dataset:
        """Return all samples as a record, see ``record.schema``."""
        robots = [run.robot for run in self._runs]
        # parts of a block of all sensors would keep the whole block
        arrays = {name: np.ascontiguousarray(values) for name, values in self._arrays().items()}
        end_times = np.minimum(self._batch.end_times, time[-1])
        per_run = {
            "mass": np.array([robot.mass for robot in robots]),
            "period": np.array([run.gait.period for run in self._runs]),
            "duty_factor": np.array([run.gait.duty_factor for run in self._runs]),
            "ended": end_times,
            "cause": np.array(self._batch.cause),
            "stands_on": np.array(
                [ground_text(None if run.afloat or run.solved_flow else run.ground) for run in self._runs]
            ),
        }
        coordinates: dict[str, Sequence[object] | np.ndarray] = {
            "run": np.arange(len(robots)),
            "time": time,
            "leg": self._layout.limb_names,
            "segment": self._layout.trunk,
            "joint": self._layout.hinges,
            "servo": self._layout.servos,
            "robot": [robot.name for robot in robots],
            "gait": [run.gait.name for run in self._runs],
            "label": [run.label or run.gait.name for run in self._runs],
        }
        record = dataset(arrays | self._efforts() | self._warmed(), per_run, coordinates)
        if not self._water.shape[-1]:
            return record
        return _with_water(
            record, self._water_arrays(arrays["foot_force"]), [lake_text(run.lake) for run in self._runs]
        )

    def _efforts(self) -> dict[str, np.ndarray]:
        """Return the samples of what servos do by the names of ``record.EFFORT``."""
        if not self._has_effort:
            return {}
        efforts = {name: np.ascontiguousarray(self._effort[..., k]) for k, name in enumerate(EFFORT)}
        return efforts | electrical_power(
            efforts, [run.robot for run in self._runs], [run.supply for run in self._runs]
        )

    def _warmed(self) -> dict[str, np.ndarray]:
        """Return how warm the servos are, by the name of ``record.HEAT``; nothing where none warms up."""
        return {"servo_temperature": self._temperature} if self._temperature.shape[-1] else {}

    def _water_arrays(self, foot_force: np.ndarray) -> dict[str, np.ndarray]:
        """Return the samples of the water by the names of ``record.WATER``."""
        water, period_means = self._water, self._period_means
        total = np.array([column(pieces(run.robot), "volume").sum() for run in self._runs])
        ups = np.array([up_direction(run.ground) for run in self._runs])
        air = np.array([chambers(run.robot) for run in self._runs])
        air[air.sum(axis=1) == 0.0] = 1.0  # nothing to share out
        air_kept = water[..., hydro.AIR_FRACTION : hydro.AIR_FRACTION + 2]
        weight = GRAVITY * np.array([run.robot.mass for run in self._runs])
        return {
            "water_level": water[..., hydro.LEVEL],
            "air_fraction": np.einsum("rtc,rc->rt", air_kept, air / air.sum(axis=1, keepdims=True)),
            "air_fraction_front": air_kept[..., 0],
            "share_under": water[..., hydro.SUBMERGED_VOLUME] / total[:, None],
            "water_force": period_means[..., :3],
            "water_power": period_means[..., 3],
            "feet_share": (foot_force.sum(axis=2) @ ups[:, :, None])[..., 0] / weight[:, None],
        }

    def _arrays(self) -> dict[str, np.ndarray]:
        """Return the samples by the names of ``record.VARIABLES``, each of shape (run, time, ...)."""
        rows, robot_layout = self._readings, self._layout

        def block(names: Sequence[str], suffix: str) -> np.ndarray:
            return np.array(rows[..., self._sensors.span(names, suffix)])

        def points(names: Sequence[str], suffix: str) -> np.ndarray:
            return block(names, suffix).reshape(*rows.shape[:2], len(names), 3)

        feet = points(robot_layout.limb_names, "force")
        turns = block([f"{limb}_foot" for limb in robot_layout.limb_names], "orientation")
        turns = turns.reshape(*rows.shape[:2], len(robot_layout.limb_names), 4)
        return {
            "position": self._qpos[..., :3],
            "orientation": self._qpos[..., 3:7],
            "joint_angle": self._qpos[..., self._joints],
            "centre_of_mass": rows[..., self._sensors.columns("centre_of_mass")],
            "angular_momentum": rows[..., self._sensors.columns("angular_momentum")],
            "snout": block(("snout",), "position"),
            "tail_tip": block(("tail_tip",), "position"),
            "foot_position": points([f"{limb}_foot" for limb in robot_layout.limb_names], "position"),
            "foot_roll": rolling_displacement(turns, self._foot_radii),
            # the sensors read the robot's force on the ground; the record holds the ground's on the robot
            "foot_force": -feet,
            "limb_force": feet - points(robot_layout.limb_names, "limb_force"),
            "belly_force": -points(robot_layout.trunk, "force"),
            "tail_force": -self._sensors.tail(rows),
            "servo_angle": block(robot_layout.servos, "position"),
            "servo_velocity": block(robot_layout.servos, "velocity"),
            "servo_torque": block(robot_layout.servos, "torque"),
            "servo_target": self._targets,
            "limb_phase": self._phase,
            "angular_velocity": rows[..., self._sensors.columns("imu_gyroscope")],
            "acceleration": rows[..., self._sensors.columns("imu_accelerometer")],
        }


def electrical_power(
    efforts: Mapping[str, np.ndarray], robots: Sequence[Robot], supply_ratios: Sequence[float]
) -> dict[str, np.ndarray]:
    """Return the power that servos draw, by the name of ``record.ELECTRICAL``; nothing where no servo has a winding.

    The current of a motor is in proportion to its torque, ``I = torque stall_current / stall_torque``. Its winding
    loses ``R I^2``, cold, and its electronics take the idle current. Driving work comes on top; what a servo takes up
    while it brakes is not returned to the supply.

    Args:
        efforts: arrays of ``record.EFFORT``, each of shape (run, time, servo).
        robots: robot of each run.
        supply_ratios: share of their supply that the servos of each run get [-].
    """
    servos = [[robot.servo(name) for name in layout(robot).servos] for robot in robots]
    if not any(servo.winding is not None for row in servos for servo in row):
        return {}
    copper, idle = np.full((2, len(robots), len(servos[0])), np.nan)
    for run, row in enumerate(servos):
        for place, servo in enumerate(row):
            if servo.winding is not None:
                loss = servo.winding.volts * servo.winding.stall_current
                copper[run, place] = loss / servo.torque**2
                idle[run, place] = supply_ratios[run] * servo.winding.volts * servo.winding.idle_current
    driving = 0.5 * (efforts["servo_power"] + efforts["servo_absolute_power"])
    losses = copper[:, None] * efforts["servo_mean_square_torque"] + idle[:, None]
    return {"servo_electrical_power": losses + driving}


def rolling_displacement(
    orientation: Float[np.ndarray, "run time limb 4"], radius: Float[np.ndarray, "run limb"]
) -> Float[np.ndarray, "run time limb 3"]:
    """Return how far each ball has rolled over level ground since the first sample [m].

    Between two samples a ball turns by a vector, and its centre advances by that vector times the radius, upward.

    Args:
        orientation: orientation of the balls in the world, unit quaternions.
        radius: radius of the balls [m].
    """
    before, after = orientation[:, :-1], orientation[:, 1:]
    vector = before[..., :1] * after[..., 1:] - after[..., :1] * before[..., 1:]
    vector -= np.cross(after[..., 1:], before[..., 1:])
    cosine = (before * after).sum(axis=-1)
    sine = np.linalg.norm(vector, axis=-1)
    angle_per_sine = np.divide(
        2.0 * np.arctan2(sine, np.abs(cosine)), sine, out=np.full_like(sine, 2.0), where=sine > 1e-9
    )
    turn = (np.copysign(1.0, cosine) * angle_per_sine)[..., None] * vector
    steps = np.stack([turn[..., 1], -turn[..., 0], np.zeros_like(sine)], axis=-1) * radius[:, None, :, None]
    way = np.zeros((*orientation.shape[:-1], 3))
    np.cumsum(steps, axis=1, out=way[:, 1:])
    way[np.isnan(orientation[..., 0])] = np.nan
    return way


def thin(record: xr.Dataset, stride: int) -> xr.Dataset:
    """Return every ``stride``-th sample of a record from the first, with the effort of all samples in between."""
    thinned = record.isel(time=slice(None, None, stride))
    if stride == 1:
        return thinned
    efforts = np.stack([record[name].transpose("time", ...).values for name in EFFORT], axis=-1)
    intervals = [efforts[end - stride + 1 : end + 1] for end in range(stride, record.sizes["time"], stride)]
    means = np.stack([efforts[0], *(joint_effort(list(rows), [1.0 / stride] * stride) for rows in intervals)])
    dims = ("time", *(dim for dim in record["servo_power"].dims if dim != "time"))
    series = {name: means[..., k] for k, name in enumerate(EFFORT)}
    for name in set(ELECTRICAL) & set(record.data_vars):
        values = record[name].transpose("time", ...).values
        parts = [values[end - stride + 1 : end + 1].mean(axis=0) for end in range(stride, record.sizes["time"], stride)]
        series[str(name)] = np.stack([values[0], *parts])
    return thinned.assign(
        {
            name: xr.DataArray(values, dims=dims, attrs=record[name].attrs).transpose(*record[name].dims)
            for name, values in series.items()
        }
    )


def with_equal_variables(records: Sequence[xr.Dataset]) -> list[xr.Dataset]:
    """Return records that hold the same variables: on dry land the water does nothing, and its level is NaN."""
    if len({"water_level" in record for record in records}) < 2:
        return list(records)
    equal = []
    for record in records:
        if "water_level" in record:
            equal.append(record)
            continue
        shape = record.sizes["run"], record.sizes["time"]
        dry = {name: np.zeros((*shape, *(3 for dim in dims if dim == "xyz"))) for name, (dims, _, _) in WATER.items()}
        equal.append(_with_water(record, dry | {"water_level": np.full(shape, np.nan)}, shape[0] * [""]))
    return equal


def _with_water(record: xr.Dataset, values: Mapping[str, np.ndarray], lakes: Sequence[str]) -> xr.Dataset:
    """Return a record with the variables of the water added."""
    attributes = {"units": "1", "long_name": "the lake as JSON; empty on dry land"}
    water_variables: dict[str, Any] = {
        name: (("run", *dims), values[name], {"units": unit, "long_name": long_name})
        for name, (dims, unit, long_name) in WATER.items()
    }
    return record.assign(water_variables | {"swims_in": ("run", np.array(lakes, dtype=object).astype(str), attributes)})

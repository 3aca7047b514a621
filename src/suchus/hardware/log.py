"""The log of a driven robot: a record like that of a simulation, with the variables of the bus."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from suchus.core.rotation import rotate
from suchus.robot.design import Robot, layout
from suchus.robot.kinematics.tail import bend_of_servo
from suchus.robot.motion import Gait
from suchus.sim.record import BUS_VARIABLES, VARIABLES, dataset
from suchus.visual.skin import Poses, poses


class DriveLog:
    """Collects ticks, and converts them to a record.

    Args:
        robot: robot that is driven.
        gait: gait in which it moves.
    """

    def __init__(self, robot: Robot, gait: Gait) -> None:
        self._robot, self._gait = robot, gait
        self._times: list[float] = []
        self._rows: list[dict[str, np.ndarray]] = []

    def __len__(self) -> int:
        return len(self._rows)

    def keep(self, time: float, values: Mapping[str, Any]) -> None:
        """Add a tick.

        Args:
            time: time at which it was planned, since the controller's beginning [s].
            values: values by the names of ``record.VARIABLES`` and ``record.BUS_VARIABLES``; those left out are not
                known.
        """
        self._times.append(time)
        self._rows.append({name: np.array(value, dtype=float) for name, value in values.items()})

    def record(self, cause: str, attributes: Mapping[str, Any]) -> xr.Dataset:
        """Return the record.

        Args:
            cause: why it ended early; empty if it did not.
            attributes: what else is known of the drive.
        """
        robot, gait, place = self._robot, self._gait, layout(self._robot)
        sizes = {
            "time": len(self._times), "leg": len(place.limbs), "segment": len(place.trunk), "xyz": 3, "wxyz": 4,
            "joint": len(place.hinges), "servo": len(place.servos),
        }  # fmt: skip
        arrays = {
            name: self._column(name, tuple(sizes[dim] for dim in dims))
            for name, (dims, _, _) in {**VARIABLES, **BUS_VARIABLES}.items()
        }
        arrays["joint_angle"] = hinge_angles(robot, arrays["servo_angle"])
        per_run = {
            "mass": np.array([robot.mass]),
            "period": np.array([gait.period]),
            "duty_factor": np.array([gait.duty_factor]),
            "ended": np.array([self._times[-1] if self._times else 0.0]),
            "cause": np.array([cause]),
            "stands_on": np.array([""]),
        }
        coordinates: dict[str, Any] = {
            "run": np.arange(1), "time": np.array(self._times), "leg": place.limb_names, "segment": place.trunk,
            "joint": place.hinges, "servo": place.servos, "robot": [robot.name], "gait": [gait.name],
            "label": ["driven"],
        }  # fmt: skip
        record = dataset({name: value[None] for name, value in arrays.items()}, per_run, coordinates)
        driven_variables = {
            name: (("run", *dims), arrays[name][None], {"units": unit, "long_name": meaning})
            for name, (dims, unit, meaning) in BUS_VARIABLES.items()
        }
        drive_record = record.assign(driven_variables).isel(run=0)
        drive_record.attrs.update(attributes)
        return drive_record

    def _column(self, name: str, shape: tuple[int, ...]) -> np.ndarray:
        """Return the values of a variable in all ticks; NaN in ticks without one."""
        column = np.full(shape, np.nan)
        for i, row in enumerate(self._rows):
            if name in row:
                column[i] = row[name]
        return column


def hinge_angles(robot: Robot, servos: np.ndarray) -> np.ndarray:
    """Return the angles of all hinges at servo angles: a cable bends its hinges evenly, springs stay at rest.

    Args:
        robot: the design.
        servos: shape (..., servo) [rad].

    Paper: Eq. (18).
    """
    place = layout(robot)
    angles = np.zeros((*servos.shape[:-1], len(place.hinges)))
    for servo, hinge in enumerate(place.servo_hinges):
        if hinge >= 0:
            angles[..., hinge] = servos[..., servo]
        else:
            cable, pulley_angle = place.cable(servo), servos[..., servo]
            is_known = np.isfinite(pulley_angle)
            bend = np.where(is_known, bend_of_servo(cable, np.where(is_known, pulley_angle, 0.0)), np.nan)
            for name in cable.hinges:
                angles[..., place.hinges.index(name)] = bend / len(cable.hinges)
    return angles


def foot_centers(robot: Robot, bones: Poses) -> np.ndarray:
    """Return the centres of the feet in postures, shape (..., leg, 3) [m].

    Args:
        robot: the design.
        bones: the postures.
    """
    centers = []
    for limb in layout(robot).limbs:
        forward, outward, up = limb.girdle.limb.links[-1].end
        end = np.array([forward, limb.side * outward, up])
        centers.append(bones.positions[..., limb.tip, :] + rotate(bones.quaternions[..., limb.tip, :], end))
    if not centers:
        return np.zeros((*bones.positions.shape[:-2], 0, 3))
    return np.stack(centers, axis=-2)


def fix_in_place(record: xr.Dataset, robot: Robot) -> xr.Dataset:
    """Return a log that can be shown: a robot without a measured position is fixed above the ground, without loads.

    Args:
        record: record of one run; one that says where the robot was is returned as it is.
        robot: robot of the record.
    """
    if "servo_heard" not in record or np.isfinite(record.position.values).any():
        return record
    servo_angles = record.servo_angle.values
    angles = np.where(
        np.isfinite(servo_angles), servo_angles, record.servo_target.values
    )  # servos that tell nothing are where sent
    record = record.assign(joint_angle=record.joint_angle.copy(data=hinge_angles(robot, angles)))
    record = record.isel(time=np.isfinite(angles).all(axis=-1))
    count, place = record.sizes["time"], layout(robot)
    position = np.zeros((count, 3))
    level = np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
    quaternions = record.orientation.values
    orientation = np.where(np.isfinite(quaternions).all(axis=-1, keepdims=True), quaternions, level)
    bones = poses(robot, position, orientation, record.joint_angle.values)
    feet = foot_centers(robot, bones)
    foot_radii = np.array([limb.girdle.limb.foot.radius for limb in place.limbs])
    min_height = float(min(bones.positions[..., 2].min(initial=0.0), (feet[..., 2] - foot_radii).min(initial=0.0)))
    position[:, 2] = -min_height + 0.1 * robot.length * bool(not place.limbs) + 0.02 * robot.length
    tips = feet + position[:, None]
    variables = {
        "position": position, "orientation": orientation, "centre_of_mass": position, "foot_position": tips,
        "foot_force": np.zeros((count, len(place.limbs), 3)), "belly_force": np.zeros((count, len(place.trunk), 3)),
        "tail_force": np.zeros((count, 3)), "snout": position, "tail_tip": bones.positions[:, -1] + position,
    }  # fmt: skip
    return record.assign({name: record[name].copy(data=values) for name, values in variables.items()})

"""From a record to the frames of a replay."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from suchus.core.errors import IncompatibleRecord
from suchus.robot.design import Robot, joint_names, layout
from suchus.sim.record import check_land
from suchus.visual.skin import Poses, poses

RATE = 30.0
"""Frames kept for each second [1/s]; the player moves smoothly between them."""
MAX_FRAMES = 2700
"""Frames kept at most [-]: a minute and a half at the full rate, 1 MB; longer runs get fewer per second."""
_VARIABLES = (
    *("position", "orientation", "joint_angle", "centre_of_mass", "foot_position", "foot_force"),
    *("tail_force", "tail_tip"),
)


class Frames(NamedTuple):
    """Poses, forces and water level of a run, sampled at equal steps of time."""

    start: float
    """Time of the first frame [s]."""
    rate: float
    """Frames in a second [1/s]."""
    bones: Poses
    """(frame, bone, ...)."""
    mass: np.ndarray
    """Centre of mass, (frame, 3) [m]."""
    feet: np.ndarray
    """Centres of the feet, (frame, limb, 3) [m]."""
    forces: np.ndarray
    """Forces of the ground on the feet, (frame, limb, 3) [N]."""
    tail: np.ndarray
    """Tip of the tail [m] and the normal force of the ground on the tail [N], (frame, 4)."""
    level: np.ndarray | None
    """Level of the water above the world's origin, against gravity, (frame,) [m]; None on dry land."""


def check_record(record: xr.Dataset, robot: Robot) -> xr.Dataset:
    """Check a record and return its one run with the variables that a replay needs.

    Raises:
        IncompatibleRecord: it is no run on land, several runs, of another robot, or without a frame.
    """
    check_land(record, _VARIABLES, "what a replay is to be made from")
    if "run" in record.dims:
        count = record.sizes["run"]
        if count != 1:
            raise IncompatibleRecord(f"the record holds {count} runs; choose one, as in record.isel(run=0).")
        record = record.isel(run=0)
    if "robot" in record.coords and str(record.robot.item()) != robot.name:
        raise IncompatibleRecord(
            f"the record is of robot {record.robot.item()!r}, not of {robot.name!r}: give the robot that was recorded."
        )
    joints, expected = [str(name) for name in record.joint.values], list(joint_names(robot))
    if joints != expected:
        odd = sorted(set(joints) ^ set(expected)) or joints
        raise IncompatibleRecord(
            f"the record's {len(joints)} joints are not the {len(expected)} of {robot.name!r}: {', '.join(odd[:4])} "
            f"{'is' if len(odd) == 1 else 'are'} not in both; give the robot that was recorded."
        )
    limbs = layout(robot).limb_names
    if tuple(map(str, record.leg.values)) != limbs:
        raise IncompatibleRecord(
            f"the record's legs are {', '.join(map(str, record.leg.values))}, not {', '.join(limbs) or 'none'}."
        )
    run_variables = record[[*_VARIABLES, *(name for name in ("water_level",) if name in record)]]
    values = np.concatenate([_rows(run_variables[name]) for name in _VARIABLES], axis=1)
    count = int(np.logical_and.accumulate(np.isfinite(values).all(axis=1)).sum())
    if count == 0:
        raise IncompatibleRecord("the record has no frame to show: run for longer than one sample.")
    return run_variables.isel(time=slice(0, count))


def frames(record: xr.Dataset, robot: Robot, rate: float | None = None) -> Frames:
    """Return the frames of one run.

    Args:
        record: record of one run, as ``check_record`` returns it.
        robot: robot of the record.
        rate: frames in a second [1/s]; by default the nearest to ``RATE`` that the samples give, fewer of a long run.
    """
    time = record.time.values.astype(float)
    span = float(time[-1] - time[0])
    if rate is None:
        step = span / max(len(time) - 1, 1)
        stride = max(1, round(1.0 / RATE / step), int(np.ceil(len(time) / MAX_FRAMES))) if step > 0 else 1
        rate = 1.0 / (stride * step) if step > 0 else RATE
    frame_times = time[0] + np.arange(int(span * rate + 1e-6) + 1) / rate
    samples = np.clip(
        np.searchsorted(time, frame_times - 0.5 * np.median(np.diff(time, append=time[-1] + 1))), 0, len(time) - 1
    )
    sampled = record.isel(time=samples)
    values = {name: sampled[name].values.astype(float) for name in _VARIABLES}
    return Frames(
        start=float(time[0]),
        rate=float(rate),
        bones=poses(robot, values["position"], values["orientation"], values["joint_angle"]),
        mass=values["centre_of_mass"],
        feet=values["foot_position"],
        forces=values["foot_force"],
        tail=np.column_stack([values["tail_tip"], values["tail_force"][:, 2]]),
        level=_level(sampled),
    )


def _rows(variable: xr.DataArray) -> np.ndarray:
    """Return the numbers of a variable, one row for each time."""
    values = np.asarray(variable.transpose("time", ...).values, dtype=float)
    return values.reshape(len(values), int(np.prod(values.shape[1:])))


def _level(record: xr.Dataset) -> np.ndarray | None:
    """Return the level of the water in each frame; None where there is none."""
    if "water_level" not in record or record.water_level.dims != ("time",):
        return None
    level = np.asarray(record.water_level.values, dtype=float)
    return level if np.isfinite(level).all() else None

"""The schema of a run on land: dimensions, variables and units of its ``xarray.Dataset``."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from suchus.errors import IncompatibleRecord

XYZ = ("x", "y", "z")
WXYZ = ("w", "x", "y", "z")

VARIABLES: Mapping[str, tuple[tuple[str, ...], str, str]] = {
    "position": (("time", "xyz"), "m", "pelvis in the world"),
    "orientation": (("time", "wxyz"), "1", "pelvis in the world, unit quaternion"),
    "centre_of_mass": (("time", "xyz"), "m", "of the whole robot in the world"),
    "angular_momentum": (("time", "xyz"), "kg m2/s", "of the whole robot about its centre of mass, in the world"),
    "snout": (("time", "xyz"), "m", "tip of the snout in the world"),
    "tail_tip": (("time", "xyz"), "m", "tip of the tail in the world"),
    "foot_position": (("time", "leg", "xyz"), "m", "centre of each foot in the world"),
    "foot_force": (("time", "leg", "xyz"), "N", "of the ground on each foot, in the world"),
    "belly_force": (("time", "segment", "xyz"), "N", "of the ground on each body of the trunk, in the world"),
    "tail_force": (("time", "xyz"), "N", "of the ground on the tail, in the world"),
    "joint_angle": (("time", "joint"), "rad", "every hinge"),
    "servo_angle": (("time", "servo"), "rad", "at the servo's shaft"),
    "servo_velocity": (("time", "servo"), "rad/s", "at the servo's shaft"),
    "servo_torque": (("time", "servo"), "N m", "at the servo's shaft"),
    "servo_target": (("time", "servo"), "rad", "commanded angle"),
    "limb_phase": (("time", "leg"), "1", "phase of each limb, not wrapped [cycle]"),
    "angular_velocity": (("time", "xyz"), "rad/s", "of the pelvis, in its own frame"),
    "acceleration": (("time", "xyz"), "m/s2", "of the pelvis with gravity, in its own frame"),
}
"""Name of each variable: its dimensions after ``run``, its unit, what it is."""

PER_RUN: Mapping[str, tuple[str, str]] = {
    "mass": ("kg", "of the robot"),
    "period": ("s", "of the gait"),
    "duty_factor": ("1", "of the gait"),
    "ended": ("s", "time of the last valid sample"),
    "cause": ("1", "why the run ended early; empty if it did not"),
    "stands_on": ("1", "the ground as JSON, slopes [rad], lengths [m]; empty if the robot floats; see ``ground_of``"),
}


def dataset(
    arrays: Mapping[str, np.ndarray],
    per_run: Mapping[str, np.ndarray],
    coordinates: Mapping[str, Sequence[object] | np.ndarray],
) -> xr.Dataset:
    """Put arrays into the schema.

    Args:
        arrays: one per name of ``VARIABLES``, each ``(run, *dimensions)``.
        per_run: one per name of ``PER_RUN``, each ``(run,)``.
        coordinates: labels of the dimensions ``run``, ``time``, ``leg``, ``segment``, ``joint``, ``servo``; further
            ones belong to ``run``.

    Raises:
        IncompatibleRecord: a variable is missing.
    """
    missing = [name for name in VARIABLES if name not in arrays] + [name for name in PER_RUN if name not in per_run]
    if missing:
        raise IncompatibleRecord(f"a record needs {', '.join(missing)} too.")
    data = xr.Dataset(coords={"xyz": list(XYZ), "wxyz": list(WXYZ)})
    for name, labels in coordinates.items():
        along = name if name in ("run", "time", "leg", "segment", "joint", "servo") else "run"
        data.coords[name] = (along, np.asarray(labels))
    data.coords["time"].attrs["units"] = "s"
    for name, (dims, unit, what) in VARIABLES.items():
        data[name] = (("run", *dims), arrays[name], {"units": unit, "long_name": what})
    for name, (unit, what) in PER_RUN.items():
        data[name] = ("run", per_run[name], {"units": unit, "long_name": what})
    data.attrs["schema"] = "suchus land record 1"
    return data

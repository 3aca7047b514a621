"""How equally the joints of the tail turn."""

from collections.abc import Sequence

import xarray as xr

from suchus.metrics.window import between
from suchus.motion import START


def tail_joint_spread(angles: xr.DataArray, joints: Sequence[str]) -> xr.DataArray:
    """Return over time the greatest less the least angle among the cable joints of the tail [rad].

    Paper: section III.C, "the angle of rotation of each joint is the same".

    Args:
        angles: of joints by name, with the dimension ``joint`` [rad].
        joints: names of the cable joints; see ``design.cable_joints``.
    """
    bends = angles.sel(joint=list(joints))
    return (bends.max("joint") - bends.min("joint")).assign_attrs(units="rad", long_name="spread of the tail's joints")


def tail_joint_spread_max(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the greatest difference between the angles of two cable joints of the tail at one time [rad]."""
    part = between(record, start, end)
    names = [str(name) for name in part.joint.values if str(name).startswith("tail_yaw")]
    return tail_joint_spread(part.joint_angle, names).max("time").assign_attrs(units="rad")


measures = (tail_joint_spread_max,)

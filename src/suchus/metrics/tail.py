"""How alike the joints of the tail turn."""

import xarray as xr

from suchus.metrics.window import between
from suchus.motion import START


def tail_joint_spread_max(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the greatest difference between the angles of two cable joints of the tail at one time [rad]."""
    part = between(record, start, end)
    names = [str(name) for name in part.joint.values if str(name).startswith("tail_yaw")]
    angles = part.joint_angle.sel(joint=names)
    return (angles.max("joint") - angles.min("joint")).max("time").assign_attrs(units="rad")

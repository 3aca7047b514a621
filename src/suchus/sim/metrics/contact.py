"""The force of the ground on each limb and on the whole robot, from all contacts that a record holds."""

import xarray as xr


def limb_load(record: xr.Dataset) -> xr.DataArray:
    """Return the force of the ground on each limb, its foot and its links together [N].

    A force plate under the limb shows it; a sensor in the foot shows ``foot_force`` alone. Where nothing measures the
    links, as in a log of servos or a record of an earlier release, it is the foot's.
    """
    if "limb_force" not in record:
        return record.foot_force
    return (record.foot_force + record.limb_force.fillna(0.0)).assign_attrs(units="N")


def ground_force(record: xr.Dataset) -> xr.DataArray:
    """Return the force of the ground on the whole robot: on limbs, trunk and tail [N].

    On dry land its mean over a steady cycle is the robot's weight, against gravity.
    """
    limbs, trunk = limb_load(record), record.belly_force
    total: xr.DataArray = limbs.sum("leg", skipna=False) + trunk.sum("segment", skipna=False) + record.tail_force
    return total.assign_attrs(units="N")

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


def contact_path(record: xr.Dataset) -> xr.DataArray:
    """Return over time a point that moves as each foot does where it touches level ground [m].

    It is the foot's centre less the way that its ball rolled: a ball that rolls without sliding has a point at rest. In
    records that do not hold ``foot_roll`` it is the centre.
    """
    return record.foot_position - record.foot_roll if "foot_roll" in record else record.foot_position


def ground_force(record: xr.Dataset) -> xr.DataArray:
    """Return the force of the ground on the whole robot: on limbs, trunk and tail [N].

    On dry land its mean over a steady cycle is the robot's weight, against gravity.
    """
    limbs, trunk = limb_load(record), record.belly_force
    total: xr.DataArray = limbs.sum("leg", skipna=False) + trunk.sum("segment", skipna=False) + record.tail_force
    return total.assign_attrs(units="N")

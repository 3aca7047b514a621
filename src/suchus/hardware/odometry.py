"""How far a robot walked by its own legs: an estimate from joint angles and the feet that stand."""

import numpy as np
import xarray as xr

from suchus.hardware.log import foot_centers, hinge_angles
from suchus.robot.design import GRAVITY, Robot, layout
from suchus.sim.land.readings import rolling_displacement
from suchus.sim.metrics.gait import LOADED_SHARE
from suchus.visual.skin import poses


def walked_distance(record: xr.Dataset, robot: Robot) -> float:
    """Return the horizontal distance between the beginning and the end of a drive [m]; NaN if nothing tells it.

    A measured position gives the distance. Without one it is an estimate: feet that stand are taken to roll on their
    balls without slip. Slip backward makes the estimate too long. A foot stands by its measured load, else by the phase
    of its limb.

    Args:
        record: the log of a drive, or a record of one run.
        robot: robot that was driven.
    """
    walk = record.sel(time=slice(0.0, None))
    positions = walk.position.values[:, :2]
    positions = positions[np.isfinite(positions).all(axis=1)]
    if len(positions) > 1:
        return float(np.hypot(*(positions[-1] - positions[0])))
    servo_angles = np.where(np.isfinite(walk.servo_angle.values), walk.servo_angle.values, walk.servo_target.values)
    is_standing = _standing_feet(walk, robot)
    is_known = np.isfinite(servo_angles).all(axis=1)
    if not layout(robot).limbs or is_known.sum() < 2 or not is_standing.any():
        return float("nan")
    servo_angles, is_standing = servo_angles[is_known], is_standing[is_known]
    count = len(servo_angles)
    level = np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
    bones = poses(robot, np.zeros((count, 3)), level, hinge_angles(robot, servo_angles))
    feet = foot_centers(robot, bones)[..., :2]
    limbs = layout(robot).limbs
    radii = np.array([[limb.girdle.limb.foot.radius for limb in limbs]])
    turns = bones.quaternions[None][:, :, [limb.tip for limb in limbs]]
    rolled = rolling_displacement(turns, radii)[0, ..., :2]
    heading, place = np.eye(2), np.zeros(2)
    for i in range(1, count):
        is_planted = is_standing[i - 1] & is_standing[i]
        if is_planted.any():
            contact = feet[i - 1] + rolled[i] - rolled[i - 1]
            rotation, translation = _planar_motion(contact[is_planted], feet[i][is_planted])
            place = place + heading @ translation
            heading = heading @ rotation
    return float(np.hypot(*place))


def _standing_feet(walk: xr.Dataset, robot: Robot) -> np.ndarray:
    """Return which feet stand at each sample, shape (time, leg)."""
    loads = walk.foot_force.values[..., 2]
    if np.isfinite(loads).any():
        is_loaded: np.ndarray = loads > LOADED_SHARE * robot.mass * GRAVITY
        return is_loaded
    swing_fraction = 1.0 - float(walk.duty_factor)
    is_in_stance: np.ndarray = np.mod(walk.limb_phase.values, 1.0) >= swing_fraction  # False where the phase is NaN
    return is_in_stance


def _planar_motion(before: np.ndarray, after: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return rotation and translation of the body between two samples, by points that stay in the world.

    Args:
        before: points in the body at the first sample, shape (point, 2) [m].
        after: the same points in the body at the second sample [m].
    """
    center_before, center_after = before.mean(axis=0), after.mean(axis=0)
    from_center, to_center = after - center_after, before - center_before
    cosine = float((from_center * to_center).sum())
    sine = float((from_center[:, 0] * to_center[:, 1] - from_center[:, 1] * to_center[:, 0]).sum())
    size = np.hypot(cosine, sine)
    rotation = np.eye(2) if size < 1e-12 else np.array([[cosine, -sine], [sine, cosine]]) / size
    return rotation, center_before - rotation @ center_after

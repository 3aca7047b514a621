"""How steadily the body is carried."""

import numpy as np
import xarray as xr
from jaxtyping import Float
from scipy.spatial import ConvexHull, QhullError

from suchus.core import rotation
from suchus.robot.motion import START
from suchus.sim.metrics.gait import loaded, stance, threshold_of
from suchus.sim.metrics.window import time_window


def height_std(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the standard deviation of the height of the centre of mass [m]."""
    return time_window(record, start, end).centre_of_mass.sel(xyz="z").std("time")


def height_peak_to_peak(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the highest less the lowest height of the centre of mass [m]."""
    height = time_window(record, start, end).centre_of_mass.sel(xyz="z")
    return height.max("time") - height.min("time")


def tilt(record: xr.Dataset) -> xr.Dataset:
    """Return over time the ``roll`` (left side up positive) and ``pitch`` (nose down positive) of the pelvis [rad]."""
    roll, pitch = (
        xr.apply_ufunc(angle, record.orientation, input_core_dims=[["wxyz"]])
        for angle in (rotation.roll, rotation.pitch)
    )
    return xr.Dataset({"roll": roll.assign_attrs(units="rad"), "pitch": pitch.assign_attrs(units="rad")})


def roll_peak_to_peak(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the greatest less the least roll of the pelvis [rad]."""
    roll = tilt(time_window(record, start, end))["roll"]
    return roll.max("time") - roll.min("time")


def support_polygon(record: xr.Dataset, time: float, threshold: float | None = None) -> Float[np.ndarray, "corner 2"]:
    """Return the corners of the hull of what carries the body at one time, in order [m].

    Standing feet count, and the tail where it is loaded. A loaded tail stands for its tip, the farthest place where it
    can touch: the support is never larger than that.

    Args:
        record: record of one run.
        time: [s].
        threshold: least normal force of what carries [N]; a share of the weight if None.
    """
    instant = record.sel(time=time, method="nearest")
    stands = loaded(instant, threshold).values
    points = np.asarray(instant.foot_position.sel(xyz=["x", "y"]).values[stands], dtype=float)
    if float(instant.tail_force.sel(xyz="z")) > float(threshold_of(record, threshold)):
        points = np.vstack([points, instant.tail_tip.sel(xyz=["x", "y"]).values.astype(float)])
    if len(points) < 3:
        return points
    try:
        return np.asarray(points[ConvexHull(points).vertices])
    except QhullError:  # all of them in a line
        return points


def support_distance(record: xr.Dataset, time: float) -> float:
    """Return how far the projected centre of mass lies outside the support by feet and tail [m].

    With two points the support is the line between them; inside a polygon the distance is negative, to the nearest
    side.

    Args:
        record: record of one run.
        time: [s].
    """
    corners = support_polygon(record, time)
    com = record.centre_of_mass.sel(time=time, method="nearest").sel(xyz=["x", "y"]).values.astype(float)
    if len(corners) == 0:
        return float("nan")
    if len(corners) == 1:
        return float(np.linalg.norm(com - corners[0]))
    distance = min(_to_segment(com, a, b) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True))
    return -distance if len(corners) >= 3 and _is_inside(com, corners) else distance


def line_distance(record: xr.Dataset) -> xr.DataArray:
    """Return over time how far the projected centre of mass is from the line through the two feet that stand [m].

    Not a number at times at which fewer or more than two feet stand: there is no such line then.
    """
    stands = stance(record).transpose(..., "leg")
    feet = record.foot_position.sel(xyz=["x", "y"]).transpose(*stands.dims, "xyz").values.astype(float)
    com = record.centre_of_mass.sel(xyz=["x", "y"]).transpose(*stands.dims[:-1], "xyz").values.astype(float)
    first_leg = stands.values.argmax(axis=-1)
    second_leg = stands.sizes["leg"] - 1 - stands.values[..., ::-1].argmax(axis=-1)
    start, end = (np.take_along_axis(feet, i[..., None, None], axis=-2)[..., 0, :] for i in (first_leg, second_leg))
    line, offset = end - start, com - start
    with np.errstate(invalid="ignore", divide="ignore"):
        distance = abs(line[..., 0] * offset[..., 1] - line[..., 1] * offset[..., 0]) / np.linalg.norm(line, axis=-1)
    two = stands.sum("leg") == 2
    return two.copy(data=distance).where(two).assign_attrs(units="m")


def line_distance_max(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the greatest distance of the projected centre of mass from the line of two feet that alone carry [m].

    Not a number where two feet never carry alone: a tail or a belly on the ground is a third support.
    """
    window = time_window(record, start, end)
    return line_distance(window).where(_on_two_feet(window)).max("time").assign_attrs(units="m")


def two_feet_alone_share(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the share of the time in which two feet carry, and neither another one nor tail or belly [-]."""
    return _on_two_feet(time_window(record, start, end)).mean("time").assign_attrs(units="1")


def _on_two_feet(record: xr.Dataset) -> xr.DataArray:
    """Tell when two feet and nothing else carry."""
    other_load = record.tail_force.sel(xyz="z") + record.belly_force.sel(xyz="z").sum("segment")
    return (stance(record).sum("leg") == 2) & (other_load <= threshold_of(record))


def _to_segment(point: np.ndarray, start: np.ndarray, end: np.ndarray) -> float:
    segment = end - start
    length2 = float(segment @ segment)
    fraction = 0.0 if length2 == 0 else float(np.clip((point - start) @ segment / length2, 0.0, 1.0))
    return float(np.linalg.norm(point - start - fraction * segment))


def _is_inside(point: np.ndarray, corners: np.ndarray) -> bool:
    edges = np.roll(corners, -1, axis=0) - corners
    offsets = point - corners
    cross = edges[:, 0] * offsets[:, 1] - edges[:, 1] * offsets[:, 0]
    return bool((cross >= 0).all() or (cross <= 0).all())


measures = (height_peak_to_peak, height_std, line_distance_max, roll_peak_to_peak, two_feet_alone_share)

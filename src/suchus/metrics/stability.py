"""How steadily the body is carried."""

import numpy as np
import xarray as xr
from jaxtyping import Float
from scipy.spatial import ConvexHull, QhullError

from suchus.errors import IncompatibleRecord
from suchus.metrics.gait import loaded
from suchus.metrics.window import between
from suchus.motion import START


def height_std(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the standard deviation of the height of the centre of mass [m]."""
    return between(record, start, end).centre_of_mass.sel(xyz="z").std("time")


def height_peak_to_peak(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the highest less the lowest height of the centre of mass [m]."""
    height = between(record, start, end).centre_of_mass.sel(xyz="z")
    return height.max("time") - height.min("time")


def tilt(record: xr.Dataset) -> xr.Dataset:
    """Return over time the ``roll`` (left side up positive) and ``pitch`` (nose down positive) of the pelvis [rad]."""
    w, x, y, z = (record.orientation.sel(wxyz=c) for c in "wxyz")
    roll = xr.apply_ufunc(np.arctan2, 2 * (w * x + y * z), 1 - 2 * (x**2 + y**2))
    pitch = xr.apply_ufunc(np.arcsin, (2 * (w * y - z * x)).clip(-1.0, 1.0))
    return xr.Dataset({"roll": roll.assign_attrs(units="rad"), "pitch": pitch.assign_attrs(units="rad")})


def roll_peak_to_peak(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the greatest less the least roll of the pelvis [rad]."""
    roll = tilt(between(record, start, end))["roll"]
    return roll.max("time") - roll.min("time")


def support_polygon(record: xr.Dataset, time: float, threshold: float | None = None) -> Float[np.ndarray, "corner 2"]:
    """Return the corners of the hull of the standing feet at one time, in order [m].

    Args:
        record: of one run.
        time: [s].
        threshold: least normal force of a standing foot [N]; a share of the weight if None.
    """
    now = record.sel(time=time, method="nearest")
    stands = loaded(now, threshold).values
    feet = np.asarray(now.foot_position.sel(xyz=["x", "y"]).values[stands], dtype=float)
    if len(feet) < 3:
        return feet
    try:
        return np.asarray(feet[ConvexHull(feet).vertices])
    except QhullError:  # the feet stand in a line
        return feet


def support_distance(record: xr.Dataset, time: float, threshold: float | None = None) -> float:
    """Return how far the projected centre of mass lies outside the support [m].

    With two standing feet the support is the line between them; inside a polygon the distance is negative, to the
    nearest side.

    Args:
        record: of one run.
        time: [s].
        threshold: least normal force of a standing foot [N]; a share of the weight if None.
    """
    corners = support_polygon(record, time, threshold)
    com = record.centre_of_mass.sel(time=time, method="nearest").sel(xyz=["x", "y"]).values.astype(float)
    if len(corners) == 0:
        return float("nan")
    if len(corners) == 1:
        return float(np.linalg.norm(com - corners[0]))
    nearest = min(_to_segment(com, a, b) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True))
    return -nearest if len(corners) >= 3 and _inside(com, corners) else nearest


def line_distance(record: xr.Dataset, time: float) -> float:
    """Return how far the projected centre of mass is from the line through the two feet meant to stand [m].

    Args:
        record: of one run whose gait has two feet standing at that time.
        time: [s].

    Raises:
        IncompatibleRecord: not two feet are meant to stand.
    """
    now = record.sel(time=time, method="nearest")
    stands = (np.mod(now.limb_phase, 1.0) >= 1.0 - now.duty_factor).values
    if stands.sum() != 2:
        raise IncompatibleRecord(f"at {time} s {stands.sum()} feet are meant to stand; a line needs two.")
    first, second = now.foot_position.sel(xyz=["x", "y"]).values[stands].astype(float)
    along = (second - first) / np.linalg.norm(second - first)
    to = now.centre_of_mass.sel(xyz=["x", "y"]).values.astype(float) - first
    return float(abs(along[0] * to[1] - along[1] * to[0]))


def _to_segment(point: np.ndarray, start: np.ndarray, end: np.ndarray) -> float:
    along = end - start
    length2 = float(along @ along)
    share = 0.0 if length2 == 0 else float(np.clip((point - start) @ along / length2, 0.0, 1.0))
    return float(np.linalg.norm(point - start - share * along))


def _inside(point: np.ndarray, corners: np.ndarray) -> bool:
    ahead = np.roll(corners, -1, axis=0) - corners
    to = point - corners
    cross = ahead[:, 0] * to[:, 1] - ahead[:, 1] * to[:, 0]
    return bool((cross >= 0).all() or (cross <= 0).all())

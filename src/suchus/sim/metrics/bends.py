"""How spine and tail bend: the angles of Fig. 12 in the article's signs, and how equally the joints of a tail turn."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
import xarray as xr

from suchus.article.paper.signs import spine_lateral
from suchus.robot.motion import START
from suchus.sim.metrics.window import time_window


def tail_joint_spread(angles: xr.DataArray, joints: Sequence[str]) -> xr.DataArray:
    """Return over time the greatest less the least angle among the cable joints of the tail [rad].

    Paper: section III.C, "the angle of rotation of each joint is the same".

    Args:
        angles: angles of joints by name, with the dimension ``joint`` [rad].
        joints: names of the cable joints; see ``design.cable_joints``.
    """
    bends = angles.sel(joint=list(joints))
    return (bends.max("joint") - bends.min("joint")).assign_attrs(units="rad", long_name="spread of the tail's joints")


def tail_joint_spread_max(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return the greatest difference between the angles of two cable joints of the tail at one time [rad]."""
    window = time_window(record, start, end)
    names = [str(name) for name in window.joint.values if str(name).startswith("tail_yaw")]
    return tail_joint_spread(window.joint_angle, names).max("time").assign_attrs(units="rad")


BendRegion = Literal["spine", "tail"]
_WIGGLE = 0.1  # of the range of an angle: less is no change of side


def lateral_bend(record: xr.Dataset, region: BendRegion) -> xr.DataArray:
    """Return the lateral bend of the spine or the tail's cable section over time, the sum of its joints [rad]."""
    names = [str(name) for name in record.joint.values if str(name).startswith(f"{region}_yaw")]
    bend = record.joint_angle.sel(joint=names).sum("joint")
    return (spine_lateral(bend) if region == "spine" else bend).assign_attrs(units="rad")


def spine_amplitude(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return half of the range of the spine's lateral bend [rad]."""
    return _amplitude(_window(record, "spine", start, end))


def tail_amplitude(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return half of the range of the tail's lateral bend [rad]."""
    return _amplitude(_window(record, "tail", start, end))


def tail_swing_least(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return how far the tail swings to the side that it swings to less, negative if it never gets there [rad]."""
    return smaller_swing(_window(record, "tail", start, end))


def smaller_swing(bend: xr.DataArray) -> xr.DataArray:
    """Return how far a bend over ``time`` swings to the side that it swings to less, negative if it never gets there.

    The unit is that of the bend.
    """
    right_swing, left_swing = bend.max("time"), -bend.min("time")
    return right_swing.where(right_swing < left_swing, left_swing)


def spine_sine_share(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return how much of the variance of the spine's bend a sine at the gait's frequency explains [-]."""
    bend = _window(record, "spine", start, end)
    turn = 2 * np.pi * (bend.time - bend.time[0]) / record.period
    return xr.apply_ufunc(_explained, bend, turn, input_core_dims=[["time"], ["time"]], vectorize=True)


def spine_swings(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return how often the spine's bend changes its side in a cycle [-]; two are one bend to each side."""
    return _swings(record, "spine", start, end)


def tail_swings(record: xr.Dataset, start: float = START, end: float | None = None) -> xr.DataArray:
    """Return how often the tail's bend changes its side in a cycle [-]; two are one bend to each side."""
    return _swings(record, "tail", start, end)


def _window(record: xr.Dataset, region: BendRegion, start: float, end: float | None) -> xr.DataArray:
    """Return a bend over whole cycles: the last sample, which begins the next one, is left out."""
    return lateral_bend(time_window(record, start, end).isel(time=slice(0, -1)), region)


def _amplitude(bend: xr.DataArray) -> xr.DataArray:
    return (bend.max("time") - bend.min("time")) / 2


def _swings(record: xr.Dataset, region: BendRegion, start: float, end: float | None) -> xr.DataArray:
    return bend_swings(_window(record, region, start, end), record.period)


def bend_swings(bend: xr.DataArray, period: xr.DataArray) -> xr.DataArray:
    """Return how often a bend over whole cycles changes its side in a cycle [-].

    Args:
        bend: bend angle over time, without the sample that begins the next cycle [rad].
        period: period of a cycle [s].
    """
    step = float(bend.time[1] - bend.time[0])
    cycles = bend.sizes["time"] * step / period
    counts = xr.apply_ufunc(_changes, bend, input_core_dims=[["time"]], vectorize=True)
    return counts / cycles


def _explained(angle: np.ndarray, turn: np.ndarray) -> float:
    """Return the share of an angle's variance in the cosine and sine of a phase that takes whole turns."""
    deviation = angle - angle.mean()
    terms = (np.cos(turn), np.sin(turn))  # orthogonal over whole cycles
    explained = sum((deviation * term).mean() ** 2 / (term**2).mean() for term in terms)
    variance = (deviation**2).mean()
    return float(explained / variance) if variance > 0 else 0.0


def _changes(angle: np.ndarray) -> float:
    """Return how often an angle that repeats itself changes its side, small wiggles about the middle not counted."""
    sides = np.sign(angle[abs(angle) > _WIGGLE * max(float(np.ptp(angle)), 1e-12)])
    return float(np.count_nonzero(sides != np.roll(sides, 1))) if sides.size else 0.0


measures = (
    spine_amplitude, spine_sine_share, spine_swings, tail_amplitude, tail_joint_spread_max, tail_swing_least,
    tail_swings,
)  # fmt: skip

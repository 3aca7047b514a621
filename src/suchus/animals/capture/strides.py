"""The strides of a walk, and its mean cycle over the phase: the tables of measurements.

A stride begins with a lift-off of LF, or of the first tracked foot, or without feet at the beginning of the film. An
interval from ``NAME_low`` to ``NAME_high`` has 95 % confidence. For a single stride it follows from the noise of the
keypoints, for all strides also from their differences.
"""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
import xarray as xr
from jaxtyping import Float
from scipy.stats import t as student

from suchus.animals.capture.angles import azimuth, bend_angles, joint_bends
from suchus.animals.capture.cycle import PeriodicFit, fit, harmonics_for
from suchus.animals.capture.feet import FootContact, FootSweep, continuous
from suchus.animals.capture.swings import Clock
from suchus.animals.capture.tracks import Tracks

_Z_95 = 1.96  # standard errors in half a 95 % interval
_SLOPE = np.sqrt(12.0)  # standard error of a slope over a whole stride, over that of a mean
# Standard error of a slope fitted with three harmonics of the same stride, over that of a slope alone:
# the harmonics explain most of a straight line.
_SLOPE_INFLATION = float((1 - 12 / (2 * np.pi**2) * sum(1 / k**2 for k in (1, 2, 3))) ** -0.5)
_SHARED = 1.5  # cycles per independent cycle: neighbours share marks of the clock, and their errors
_EXTRAPOLATION_ERROR = 0.1  # half width of a pace beyond the marks of the clock, over the pace
_MIN_TURN = 0.05  # [rad]; change of heading in a stride from which on paths are straightened
_MIN_VISIBLE_FRACTION = 0.8  # least fraction of a stride's frames with a point that shows its advance
_MIN_FRAMES = 8  # least frames of a stride
PHASES = 100
"""Phases of the mean cycle in tables [-]."""


def times(n: int) -> float:
    """Return the factor on the standard error of n values that gives a 95 % interval."""
    return float(student.ppf(0.975, n - 1)) if n > 1 else float("nan")


def per_stride(tracks: Tracks, clock: Clock, feet: Mapping[str, FootContact], start_phase: float) -> xr.Dataset:
    """Return the measurements of every complete stride, over ``stride`` and ``leg``, with intervals.

    Args:
        tracks: the keypoints, by the clock.
        clock: on which strides last equally long.
        feet: feet that were seen.
        start_phase: phase at which strides begin [cycle].
    """
    period = clock.period
    first_stride = int(np.ceil(tracks.time[0] / period - start_phase - 1e-6))
    last_stride = int(np.floor(tracks.time[-1] / period - start_phase + 1e-6))
    numbers = np.arange(first_stride, last_stride)
    ends = clock.seconds(np.arange(first_stride, last_stride + 1) + start_phase)
    stride_list = [tracks.between((k + start_phase) * period, (k + start_phase + 1) * period) for k in numbers]
    lasts, jitter = np.diff(ends), _jitter(feet)
    rows = [_body(stride_tracks, period) for stride_tracks in stride_list]
    data = xr.Dataset(coords={"stride": ("stride", np.arange(1, len(numbers) + 1), {"units": "1"})})
    data["start"] = ("stride", ends[:-1], _attributes("s", "time at which the stride begins"))
    cut_error = np.hypot(jitter, _EXTRAPOLATION_ERROR * _extrapolated(clock, numbers + start_phase))
    error = cut_error * period
    _add_with_interval(data, "period", ("stride",), lasts, error, "s", "duration of the stride")
    unit = tracks.unit
    kinds = {
        "stride_length": (unit, "distance by which the trunk goes on"),
        "turning": ("rad", "change of heading over the stride, left positive"),
        "spine_lateral_amplitude": ("rad", "amplitude of the spine's lateral angle, first harmonic"),
        "tail_lateral_amplitude": ("rad", "amplitude of the tail's lateral angle, first harmonic"),
        "spine_vertical_amplitude": ("rad", "amplitude of the spine's vertical angle, first harmonic"),
        "tail_vertical_amplitude": ("rad", "amplitude of the tail's vertical angle, first harmonic"),
    }
    for name, (unit_of, meaning) in kinds.items():
        pairs = np.array([row.get(name, (np.nan, np.nan)) for row in rows]).reshape(-1, 2)
        if np.isfinite(pairs[:, 0]).any():
            error = np.hypot(pairs[:, 1], cut_error * pairs[:, 0]) if name == "stride_length" else pairs[:, 1]
            _add_with_interval(data, name, ("stride",), pairs[:, 0], error, unit_of, meaning)
            if name == "stride_length":
                speed, error = (pairs / lasts[:, None]).T
                _add_with_interval(data, "speed", ("stride",), speed, error, f"{unit}/s", "mean speed of the trunk")
    if feet:
        _put_feet(data, clock, feet, start_phase, numbers, unit)
    return data


def _extrapolated(clock: Clock, starts: Float[np.ndarray, " stride"]) -> Float[np.ndarray, " stride"]:
    """Return how far the ends of strides lie before the first mark of the clock and after the last one [cycle]."""
    early_cycles, late_cycles = clock.cycles[0] - starts, starts + 1.0 - clock.cycles[-1]
    return np.asarray(np.maximum(early_cycles, 0.0) + np.maximum(late_cycles, 0.0))


def _jitter(feet: Mapping[str, FootContact]) -> float:
    """Return the half width of the interval of a stride's duration, from differences between the feet [cycle]."""
    deviations = []
    for foot in feet.values():
        phases = foot.swings.phase
        mean = np.angle(np.mean(np.exp(2j * np.pi * phases))) / (2 * np.pi)
        deviations += list((phases - mean + 0.5) % 1.0 - 0.5)
    return float(_Z_95 * np.sqrt(2) * np.std(deviations)) if len(deviations) > 2 else 0.0


def _body(stride_tracks: Tracks, period: float) -> dict[str, tuple[float, float]]:
    """Return advance, turn and bends of the trunk in one stride, each with the half width of its interval."""
    quantities: dict[str, tuple[float, float]] = {}
    if stride_tracks.view == "top":
        front, rear = stride_tracks.line
        heading = continuous(azimuth(stride_tracks, front, rear))
        quantities |= _amplitude_row("turning", heading, stride_tracks, period, drift=1)
    turning = quantities.get("turning", (0.0, 0.0))[0]
    advances, noise, point_count = [], [], 0
    for name in stride_tracks.trunk_chain:
        place = _straightened(stride_tracks.time, stride_tracks.at(name)[:, :2], turning / period)
        n = int(np.isfinite(place[:, 0]).sum())
        if n >= max(_MIN_FRAMES, _MIN_VISIBLE_FRACTION * len(place)):
            count = harmonics_for(n, stride_tracks.rate * period, max_harmonics=3)
            courses = [fit(stride_tracks.time, row, period, harmonics=count, drift=1) for row in place.T]
            advances.append([course.drift[0] * period for course in courses])
            noise.append(float(np.linalg.norm([course.noise for course in courses]) / np.sqrt(2 * n)))
            point_count += 1
    if advances:
        mean = np.mean(advances, axis=0)
        error = _Z_95 * _SLOPE_INFLATION * _SLOPE * float(np.linalg.norm(noise)) / point_count
        length = float(np.hypot(*mean))
        if abs(turning) > _MIN_TURN:  # points ahead of others head elsewhere
            length = float(np.mean(np.hypot(*np.transpose(advances))))
        quantities["stride_length"] = length, error
    for name, series in bend_angles(stride_tracks)._asdict().items():
        quantities |= _amplitude_row(f"{name}_amplitude", series, stride_tracks, period)
    return quantities


def _straightened(
    time: Float[np.ndarray, " frame"], place: Float[np.ndarray, "frame axis"], turning_rate: float
) -> Float[np.ndarray, "frame axis"]:
    """Return the path of a point as it would be if the animal did not turn: sway that turns would look like advance.

    Args:
        time: by the clock [s].
        place: of the point, NaN where it was lost [m or px].
        turning_rate: mean change of heading [rad/s].
    """
    is_seen = np.isfinite(place).all(axis=-1)
    if abs(turning_rate) * (time[-1] - time[0]) < _MIN_TURN or is_seen.sum() < 2:
        return place
    filled_path = np.stack([np.interp(time, time[is_seen], row[is_seen]) for row in place.T], axis=-1)
    steps, angle = np.diff(filled_path, axis=0), -turning_rate * ((time[1:] + time[:-1]) / 2 - (time[0] + time[-1]) / 2)
    c, s = np.cos(angle), np.sin(angle)
    turned_steps = np.stack([c * steps[:, 0] - s * steps[:, 1], s * steps[:, 0] + c * steps[:, 1]], axis=-1)
    path = np.concatenate([np.zeros((1, 2)), np.cumsum(turned_steps, axis=0)]) + filled_path[0]
    return np.where(is_seen[:, None], path, np.nan)


def _amplitude_row(
    name: str, series: np.ndarray, stride_tracks: Tracks, period: float, drift: int = 0
) -> dict[str, tuple[float, float]]:
    """Return amplitude or drift of an angle over a stride, with the half width of its interval [rad]."""
    n = int(np.isfinite(series).sum())
    if n < max(_MIN_FRAMES, _MIN_VISIBLE_FRACTION * len(series) if drift else 0):
        return {}
    course = fit(
        stride_tracks.time,
        series,
        period,
        harmonics=harmonics_for(n, stride_tracks.rate * period, max_harmonics=3),
        drift=drift,
    )
    if drift:
        return {name: (course.drift[0] * period, _Z_95 * _SLOPE_INFLATION * _SLOPE * course.noise / np.sqrt(n))}
    return {name: (float(abs(course.harmonics[0])), _Z_95 * course.error)}


def _put_feet(
    data: xr.Dataset, clock: Clock, feet: Mapping[str, FootContact], start_phase: float, numbers: np.ndarray, unit: str
) -> None:
    """Add times of lift-off and touchdown, duty factors, phases and step lengths of each foot to the strides."""
    data.coords["leg"] = ("leg", list(feet))
    shape = (len(numbers), len(feet))
    names = ("lift_off", "touch_down", "duty", "limb_phase", "step_length")
    columns = {name: (np.full(shape, np.nan), np.full(shape, np.nan)) for name in names}
    middles = np.full(shape, np.nan)
    for j, foot in enumerate(feet.values()):
        swings = foot.swings
        for i, phase in enumerate(swings.phase):
            row = int(np.floor(phase - start_phase + 1e-9)) - (int(numbers[0]) if len(numbers) else 0)
            if not 0 <= row < len(numbers):
                continue
            half, edge = swings.shares[i] / 2, np.hypot(swings.phases_error[i], swings.shares_error[i] / 2)
            lift_off, touch_down = phase + swings.skew - half, phase + swings.skew + half
            lift_off_time, touch_down_time = clock.seconds(np.array([lift_off, touch_down]))
            columns["lift_off"][0][row, j], columns["touch_down"][0][row, j] = lift_off_time, touch_down_time
            for name in ("lift_off", "touch_down"):
                columns[name][1][row, j] = _Z_95 * edge * clock.period
            columns["duty"][0][row, j] = 1.0 - swings.shares[i]
            columns["duty"][1][row, j] = _Z_95 * swings.shares_error[i]
            columns["step_length"][0][row, j] = swings.paths[i]
            columns["step_length"][1][row, j] = _Z_95 * swings.paths_error[i]
            middles[row, j], columns["limb_phase"][1][row, j] = phase, _Z_95 * swings.phases_error[i]
    if "LF" in feet:
        lead = list(feet).index("LF")
        columns["limb_phase"][0][:] = (middles[:, lead, None] - middles) % 1.0
        errors = columns["limb_phase"][1]
        errors[:] = np.where(np.arange(len(feet)) == lead, 0.0, np.hypot(errors[:, lead, None], errors))
    else:
        del columns["limb_phase"]
    attributes = {
        "lift_off": ("s", "time at which the foot leaves the ground"),
        "touch_down": ("s", "time at which the foot comes to rest"),
        "duty": ("1", "share of the stride in which the foot rests on the ground"),
        "limb_phase": ("cycle", "how much earlier than LF the foot is in the middle of its stance"),
        "step_length": (unit, "distance over the ground from one place of the foot to the next"),
    }
    for name, (value, error) in columns.items():
        _add_with_interval(data, name, ("stride", "leg"), value, error, *attributes[name])


def over_phase(
    tracks: Tracks,
    angles: Mapping[str, PeriodicFit],
    sweeps: Mapping[str, FootSweep],
    cycle_fits: Sequence[tuple[Mapping[str, PeriodicFit], Mapping[str, FootSweep]]],
    period: float,
    start_phase: float,
    start_error: float,
) -> xr.Dataset:
    """Return angles and curvature over the phase of the mean cycle, with intervals from the variation of cycles.

    Args:
        tracks: the keypoints, by the clock.
        angles: angles of trunk and tail over all cycles.
        sweeps: sweeps of the feet over all cycles.
        cycle_fits: the same of every cycle by itself.
        period: period of a cycle [s].
        start_phase: phase at which the cycle begins [cycle].
        start_error: half the width of the interval of that [cycle].
    """
    phase = np.arange(PHASES) / PHASES
    time = (phase + start_phase) * period
    data = xr.Dataset(coords={"phase": ("phase", phase, {"units": "1"})})
    for name, angle in angles.items():
        angle_fits = [cycle_angles[name] for cycle_angles, _ in cycle_fits if name in cycle_angles]
        curves = np.array([angle_fit.mean + angle_fit.swing(time) for angle_fit in angle_fits]).reshape(-1, PHASES)
        value = angle.mean + angle.swing(time)
        side = "right" if name.endswith("lateral") else "down"
        meaning = f"{name.replace('_', ' ')} angle, {side} positive"
        _add_with_interval(data, name, ("phase",), value, half_width(value, curves, start_error), "rad", meaning)
    if sweeps:
        data.coords["leg"] = ("leg", list(sweeps))
        value = np.array([_forward_offset(foot_sweep, start_phase) for foot_sweep in sweeps.values()])
        curves = np.array(
            [
                [_forward_offset(cycle_sweeps[leg], start_phase) for leg in sweeps]
                for _, cycle_sweeps in cycle_fits
                if set(sweeps) <= set(cycle_sweeps)
            ]
        )
        error = half_width(value, curves.reshape(-1, *value.shape), start_error)
        _add_with_interval(
            data, "foot_ahead", ("leg", "phase"), value, error, tracks.unit, "distance of the foot ahead of its girdle"
        )
        value = np.array([_protraction(foot_sweep, start_phase) for foot_sweep in sweeps.values()])
        curves = np.array(
            [
                [_protraction(cycle_sweeps[leg], start_phase) for leg in sweeps]
                for _, cycle_sweeps in cycle_fits
                if set(sweeps) <= set(cycle_sweeps)
            ]
        )
        error = half_width(value, curves.reshape(-1, *value.shape), start_error)
        _add_with_interval(
            data, "protraction", ("leg", "phase"), value, error, "rad", "angle of the foot ahead of abreast its girdle"
        )
    _put_curvature(data, tracks, period, start_phase, start_error, len(cycle_fits))
    return data


def _protraction(path: FootSweep, start_phase: float) -> Float[np.ndarray, " phase"]:
    """Return the angle of a foot ahead of the direction abreast of its girdle, over the phase of tables [rad]."""
    return np.arctan2(_forward_offset(path, start_phase), path.outward)


def _forward_offset(path: FootSweep, start_phase: float) -> Float[np.ndarray, " phase"]:
    """Return the position of a foot ahead of its girdle, over the phase of tables [m or px]."""
    grid = np.arange(len(path.forward)) / len(path.forward)
    return np.interp(np.arange(PHASES) / PHASES + start_phase, grid, path.forward, period=1.0)


def _put_curvature(
    data: xr.Dataset, tracks: Tracks, period: float, start_phase: float, start_error: float, count: int
) -> None:
    """Add the curvature at each point between two segments of the midline, positive to the right or down."""
    chain = tracks.midline
    if len(chain) < 3:
        return
    links = np.array(
        [float(np.nanmedian(np.linalg.norm(tracks.at(a) - tracks.at(b), axis=-1))) for a, b in pairwise(chain)]
    )
    positions = np.cumsum(links)[:-1] / links.sum()
    bends = -joint_bends(tracks, chain) / ((links[1:] + links[:-1]) / 2)[:, None]
    time = (np.arange(PHASES) / PHASES + start_phase) * period
    value, error = np.full((2, len(bends), PHASES), np.nan)
    size, size_error = np.full((2, len(bends)), np.nan)
    for i, series in enumerate(bends):
        n = int(np.isfinite(series).sum())
        if n < _MIN_FRAMES:
            continue
        mean_fit = fit(tracks.time, series, period, harmonics=harmonics_for(n, tracks.rate * period, max_harmonics=4))
        cycle_fits = []
        for k in range(count):
            use = (tracks.time >= tracks.time[0] + k * period) & (tracks.time < tracks.time[0] + (k + 1) * period)
            m = int(np.isfinite(series[use]).sum())
            if m >= _MIN_FRAMES:
                cycle_fits.append(
                    fit(
                        tracks.time[use],
                        series[use],
                        period,
                        harmonics=harmonics_for(m, tracks.rate * period, max_harmonics=4),
                    )
                )
        value[i] = mean_fit.mean + mean_fit.swing(time)
        error[i] = half_width(
            value[i],
            np.array([cycle_fit.mean + cycle_fit.swing(time) for cycle_fit in cycle_fits]).reshape(-1, PHASES),
            start_error,
        )
        size[i] = abs(mean_fit.harmonics[0])
        size_error[i] = half_width(size[i], np.array([abs(cycle_fit.harmonics[0]) for cycle_fit in cycle_fits]), 0.0)
    attributes = {"units": "1", "long_name": "distance from the front end of the midline, 1 at its rear end"}
    data.coords["place"] = ("place", positions, attributes)
    data["keypoint"] = ("place", list(chain[1:-1]), {"long_name": "keypoint at which the midline bends"})
    side = "right" if tracks.view == "top" else "down"
    unit = f"1/{tracks.unit}"
    lengths = ((links[1:] + links[:-1]) / 2)[:, None]
    data["bend"] = (
        ("place", "phase"),
        value * lengths,
        _attributes("rad", f"angle between both segments, {side} positive"),
    )
    _add_with_interval(
        data, "curvature", ("place", "phase"), value, error, unit, f"curvature of the midline, concave {side} positive"
    )
    _add_with_interval(
        data, "curvature_amplitude", ("place",), size, size_error, unit, "amplitude of the curvature, first harmonic"
    )


def half_width(value: np.ndarray | float, cycle_values: np.ndarray, start_error: float) -> np.ndarray:
    """Return the half width of a mean's 95 % interval, from the variation of single cycles.

    It contains the difference between the fit to all cycles and the mean of single cycles, and the uncertainty of the
    phase at which the cycle begins.

    Args:
        value: value over all cycles, any shape; where ``start_error`` is given, phases are the last axis.
        cycle_values: values of single cycles, their number first.
        start_error: half the width of the interval of the cycle's beginning [cycle].
    """
    n = len(cycle_values)
    if n < 2:
        return np.full(np.shape(value), np.nan)
    spread = times(n) * np.std(cycle_values, axis=0, ddof=1) / np.sqrt(n / _SHARED)
    bias = np.mean(cycle_values, axis=0) - value
    slope = 0.0 if np.ndim(value) == 0 or not start_error else np.gradient(value, axis=-1) * np.shape(value)[-1]
    return np.asarray(np.sqrt(spread**2 + bias**2 + (slope * start_error) ** 2))


def _attributes(unit: str, meaning: str) -> dict[str, str]:
    return {"units": unit, "long_name": meaning}


def _add_with_interval(
    data: xr.Dataset,
    name: str,
    dims: tuple[str, ...],
    value: np.ndarray,
    error: np.ndarray,
    unit: str,
    meaning: str,
) -> None:
    """Add a quantity and both ends of its interval to a dataset."""
    data[name] = (dims, value, _attributes(unit, meaning))
    data[f"{name}_low"] = (dims, value - error, _attributes(unit, f"lower end of the 95 % interval of {name}"))
    data[f"{name}_high"] = (dims, value + error, _attributes(unit, f"upper end of the 95 % interval of {name}"))

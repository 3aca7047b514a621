"""Duration and time of a foot's swings, from its positions on the ground.

A foot rests at one position, then moves to the next. First the middle of each swing is estimated. Then all strides are
superimposed, each from mid-stance to mid-stance, and one swing is fitted to them. The speed over the time u of the
swing, 0 to 1, is ``(1 - |2 u**s - 1|**q)**p``: q flattens the middle, p softens the ends, s shifts the peak. The
uncertainty of the edges contains that of the shape.

The swings of all feet define a clock that follows the animal's pace: on it all strides have the same duration.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.optimize import least_squares

_SMOOTH = 0.04  # [cycle]; standard deviation of the smoothing that separates swings, not their edges
_TURNS = 0.15  # share of the range of its path by which a foot must pass the middle, or it is noise
_HALF = 0.25  # [cycle]; least time in the film before and after the middle of a swing
_MIN_DURATION = 0.02  # [cycle]; shortest swing
_SHAPE, _SHAPES = np.log([1.4, 2.4, 1.0]), np.array([0.5, 0.5, 0.25])  # logarithms of p, q, s: mean and spread
_EVEN_SPREAD = 1.2  # spread of the logarithm of p below its mean: a swing may be at an even speed
_MIN_SHAPE, _MAX_SHAPE = np.log([0.05, 1.5, 0.6]), np.log([2.5, 6.0, 1.6])  # their bounds; p near 0 is an even speed
_EDGES, _PLACES = 0.15, 0.5  # [cycle], [stride]; prior spread of edges and positions
_ROUNDS, _STEPS = 4, 4
_SOFTNESS = 4  # index of the logarithm of p among the parameters of the pooled fit
_STANCE_MARGIN = 0.25  # fraction of a stance at either end that may belong to the swing
_MAX_STANCE = 1.0  # [cycle]; longer, and a swing between was not seen
_TAIL = 4.0  # standard deviations at which a frame counts half
_BLUR = 0.05  # [stride]; first scale of the robust fit
_SHARP = 4e-3  # [stride]; least error of a position
_MARGIN = 0.2  # [cycle]; frames around a swing that are fitted; farther ones may be slips
_UNSEEN = 0.7  # hidden fraction of a swing within which its edges are unknown
_FAST_FRACTION = 0.5  # fraction of the greatest speed above which a foot is fast
_FAMILY = 0.02  # error of the edges by the shape, over the duration of a swing
_MAX_FRAMES = 1200  # greatest number of frames in a fit
_EXACT = 1e-9  # relative tolerance of a fit
_GRID = np.linspace(0.0, 1.0, 161)


class SwingMidpoints(NamedTuple):
    """Times of the middle of each swing of a foot, in ascending order."""

    time: Float[np.ndarray, " swing"]
    """Halfway from lift-off to touchdown [s]."""
    error: Float[np.ndarray, " swing"]
    """Standard error of each by its own frames [s]."""


class Swing(NamedTuple):
    """The swing of one foot, from all its strides; shares are of a stride, phases count from time zero [cycle]."""

    phase: Float[np.ndarray, " swing"]
    """Phase of the middle of the fast part of each swing: feet that slide before they lift off do not move it."""
    skew: float
    """How much later than that the swing is half over [cycle]."""
    share: float
    """Duration of the swing as a fraction of the cycle [-]."""
    share_error: float
    """Standard error of that by the frames, the unknown shape of the swing included [-]."""
    middle_error: float
    """The same of where the middle of the swing lies against all of ``phase`` [cycle]."""
    scatter: float
    """Standard deviation of the share from stride to stride that noise does not explain [-]."""
    shares: Float[np.ndarray, " swing"]
    """Duration of each swing by its own frames [cycle]."""
    shares_error: Float[np.ndarray, " swing"]
    """Standard error of each, that of all included [cycle]."""
    phases_error: Float[np.ndarray, " swing"]
    """Standard error of each phase by its own frames [cycle]."""
    paths: Float[np.ndarray, " swing"]
    """Distance over the ground from each place to the next [m or px]."""
    paths_error: Float[np.ndarray, " swing"]
    """Standard error of each [m or px]."""


class _Frames(NamedTuple):
    """Visible frames around each swing, from mid-stance to mid-stance; weight 0 in the rest of the array."""

    time: Float[np.ndarray, "swing frame"]  # [cycle]
    trace: Float[np.ndarray, "swing frame"]  # from one place to the next, in strides
    weight: Float[np.ndarray, "swing frame"]
    stride: Float[np.ndarray, " swing"]  # [m or px]


def swing_midpoints(time: np.ndarray, place: np.ndarray, forward: np.ndarray, period: float) -> SwingMidpoints:
    """Return the middles of all complete swings; there may be none.

    Args:
        time: shape (frame,) [s].
        place: position of the foot over the ground, shape (frame, 2), NaN where it was not seen [m or px].
        forward: how far it is ahead of its body, shape (frame,); it tells the swings from each other.
        period: period of the cycle, roughly [s].
    """
    frames, parameters = _swing_frames(time / period, place, _turns(time / period, forward))
    if not len(parameters):
        return SwingMidpoints(np.zeros(0), np.zeros(0))
    parameters, error, _, _, _ = _fit_each_swing(frames, parameters)
    return SwingMidpoints(parameters[:, :2].mean(axis=1) * period, error * period)


def swing(time: np.ndarray, place: np.ndarray, forward: np.ndarray, period: float) -> Swing | None:
    """Return the mean swing of a foot, or None without a complete swing.

    Args:
        time: by a clock on which every stride lasts about a period, shape (frame,) [s].
        place: see ``swing_midpoints``.
        forward: see ``swing_midpoints``.
        period: period of the cycle [s].
    """
    frames, parameters = _swing_frames(time / period, place, _turns(time / period, forward))
    if not len(parameters):
        return None
    parameters, error, durations, durations_error, places_error = _fit_each_swing(frames, parameters)
    middle, is_seen = parameters[:, :2].mean(axis=1), frames.weight > 0
    offset = (frames.time - middle[:, None])[is_seen]
    trace = ((frames.trace - parameters[:, 2, None]) / (parameters[:, 3] - parameters[:, 2])[:, None])[is_seen]
    is_near = np.abs(offset) < float(np.mean(durations)) / 2 + _MARGIN
    offset, trace = _median_frames(offset[is_near], trace[is_near])
    pooled_fit, covariance = _fit_pooled_swing(offset, trace, float(np.mean(durations)))
    parameters, _, durations, durations_error, places_error = _fit_each_swing(frames, parameters, pooled_fit[4:])
    duration_weights, middle_weights = np.array([-1.0, 1.0]), np.array([0.5, 0.5])
    duration, half = float(pooled_fit[:2] @ duration_weights), float(pooled_fit[:2] @ middle_weights)
    fast = float(pooled_fit[0] + duration * _fast(pooled_fit[4:]))
    gap = _gap(offset, pooled_fit[0], pooled_fit[1])
    blind = gap / 2 if gap > _UNSEEN * duration else 0.0
    duration_error = float(
        np.linalg.norm([np.sqrt(duration_weights @ covariance @ duration_weights), _FAMILY * duration, blind])
    )
    scatter = float(np.sqrt(max(0.0, np.var(durations) - np.mean(durations_error**2))))
    return Swing(
        phase=middle + fast,
        skew=half - fast,
        share=duration,
        share_error=duration_error,
        middle_error=float(np.hypot(np.sqrt(middle_weights @ covariance @ middle_weights), blind / 2)),
        scatter=scatter,
        shares=np.maximum(duration + durations - np.mean(durations), _MIN_DURATION),
        shares_error=np.sqrt(duration_error**2 + durations_error**2),
        phases_error=error,
        paths=(parameters[:, 3] - parameters[:, 2]) * frames.stride,
        paths_error=places_error * frames.stride,
    )


def _gap(times: np.ndarray, start: float, end: float) -> float:
    """Return the longest interval without a frame in and around a swing [cycle]."""
    edges = np.concatenate([[start], np.sort(times), [end]])
    is_inside = (edges[1:] > start) & (edges[:-1] < end)
    return float(np.diff(edges)[is_inside].max(initial=0.0))


def _median_frames(times: np.ndarray, trace: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return medians of successive frames, such that at most ``_MAX_FRAMES`` remain."""
    order = np.argsort(times, kind="stable")
    size = -(-len(times) // _MAX_FRAMES)
    use = order[: len(order) // size * size].reshape(-1, size)
    return times[use].mean(axis=1), np.median(trace[use], axis=1)


def _turns(time: np.ndarray, forward: np.ndarray) -> Float[np.ndarray, "swing 2"]:
    """Return the approximate phases at which a foot turns forward and back again [cycle].

    The path along the body is smoothed. A swing is a rise from well below the middle to well above it.
    """
    is_seen = np.isfinite(forward)
    if is_seen.sum() < 4:
        return np.zeros((0, 2))
    step = _SMOOTH / 4
    grid_time = np.arange(time[0], time[-1] + step, step)
    trace = np.interp(grid_time, time[is_seen], forward[is_seen])
    reach = np.exp(-0.5 * (np.arange(-12, 13) / 4.0) ** 2)
    smooth = np.convolve(np.pad(trace, 12, mode="edge"), reach / reach.sum(), mode="valid")
    lower_bound, upper_bound = np.percentile(smooth, [5, 95])
    middle, threshold = (lower_bound + upper_bound) / 2, _TURNS * (upper_bound - lower_bound)
    side = np.where(smooth > middle + threshold, 1, np.where(smooth < middle - threshold, -1, 0))
    side_indices = np.flatnonzero(side)
    rises = np.flatnonzero((side[side_indices][:-1] < 0) & (side[side_indices][1:] > 0))
    window, turns = round(0.5 / step), []
    for fall_index, rise_index in zip(side_indices[rises], side_indices[rises + 1], strict=True):
        rear_part, front_part = (
            smooth[max(0, fall_index - window) : fall_index + 1],
            smooth[rise_index : rise_index + window],
        )
        turns.append(
            (grid_time[fall_index - np.argmin(rear_part[::-1])], grid_time[rise_index + int(np.argmax(front_part))])
        )
    return np.array(turns).reshape(-1, 2)


def stance_intervals(time: np.ndarray, forward: np.ndarray, period: float) -> Float[np.ndarray, "stance 2"]:
    """Return the inner parts of a foot's stances between two swings, by its path along the body alone [s].

    Args:
        time: shape (frame,) [s].
        forward: how far the foot is ahead of its body, shape (frame,).
        period: of the cycle, roughly [s].
    """
    turns = _turns(time / period, forward) * period
    start, end = turns[:-1, 1], turns[1:, 0]
    margin = _STANCE_MARGIN * (end - start)
    is_stance = (end > start) & (end - start < _MAX_STANCE * period)
    return np.stack([start + margin, end - margin], axis=1)[is_stance]


def _swing_frames(time: np.ndarray, place: np.ndarray, turns: np.ndarray) -> tuple[_Frames, np.ndarray]:
    """Return the frames around each swing, and first guesses of its edges and positions."""
    middle = turns.mean(axis=1)
    borders = np.concatenate([middle[:1] - 0.6, (middle[1:] + middle[:-1]) / 2, middle[-1:] + 0.6])
    is_seen = np.isfinite(place).all(axis=1)
    parts, parameters, strides = [], [], []
    for (turn, back), left_border, right_border in zip(turns, borders[:-1], borders[1:], strict=True):
        centre = (turn + back) / 2
        if centre - time[0] < _HALF or time[-1] - centre < _HALF:
            continue
        use = is_seen & (time >= left_border) & (time <= right_border)
        is_before, is_after = use & (time <= turn + _MIN_DURATION), use & (time >= back - _MIN_DURATION)
        if is_before.sum() < 2 or is_after.sum() < 2:
            continue
        start_place, end_place = np.median(place[is_before], axis=0), np.median(place[is_after], axis=0)
        stride = float(np.linalg.norm(end_place - start_place))
        if stride == 0.0:
            continue
        parts.append((time[use], (place[use] - start_place) @ (end_place - start_place) / stride**2))
        strides.append(stride)
        parameters.append((turn, max(back, turn + _MIN_DURATION), 0.0, 1.0))
    max_frames = max((len(times) for times, _ in parts), default=0)
    frames = np.zeros((3, len(parts), max_frames))
    for k, (times, trace) in enumerate(parts):
        frames[:, k, : len(times)] = times, trace, np.ones(len(times))
    return _Frames(frames[0], frames[1], frames[2], np.array(strides)), np.array(parameters).reshape(-1, 4)


def _course(shape: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return path and speed of a swing on ``_GRID``: the fraction of the path, and paths per swing."""
    p, q, s = np.exp(shape)
    speed = (1.0 - np.abs(2.0 * _GRID**s - 1.0) ** q) ** p
    path = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2)])
    return path / path[-1], speed / path[-1] * (len(_GRID) - 1)


def _fast(shape: np.ndarray) -> float:
    """Return the middle of the fast part of a swing [swing]."""
    speed = _course(shape)[1]
    fast = np.flatnonzero(speed > _FAST_FRACTION * speed.max())
    lower_bound, upper_bound = (
        np.interp(_FAST_FRACTION * speed.max(), speed[i], _GRID[i])
        for i in (
            [fast[0] - 1, fast[0]],
            [fast[-1] + 1, fast[-1]],
        )
    )
    return float(lower_bound + upper_bound) / 2


def _fit_each_swing(
    frames: _Frames, start: np.ndarray, shape: np.ndarray = _SHAPE
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Fit lift-off, touchdown and both positions of each swing, with one shape for all.

    The fit takes Gauss-Newton steps with robust weights. The durations have a prior about their mean; without it noise
    would shorten some swings and lengthen others.

    Returns:
        Lift-off, touchdown [cycle] and both places [stride] of each, the standard errors of its middle, how long it
        lasts without being drawn to the mean, and the standard error of that [cycle]; the standard error of the
        distance of its places [stride].
    """
    parameters, loose = start.copy(), np.diag(1.0 / np.array([_EDGES, _EDGES, _PLACES, _PLACES]) ** 2)
    duration, halves = np.array([-1.0, 1.0, 0.0, 0.0]), np.array([0.5, 0.5, 0.0, 0.0])
    path_weights = np.array([0.0, 0.0, -1.0, 1.0])
    durations = parameters @ duration
    durations_error = np.full(len(parameters), _EDGES)
    for i in range(_ROUNDS):
        mean = (
            float(np.median(durations))
            if i == 0
            else float(np.average(durations, weights=1.0 / (durations_error**2 + _MIN_DURATION**2)))
        )
        duration_variance = max(float(np.var(durations) - np.mean(durations_error**2)), (_MIN_DURATION / 2) ** 2)
        for _ in range(_STEPS):
            A, r = _normal(frames, parameters, shape)
            duration_prior = np.outer(duration, duration) / duration_variance
            pull = (
                r
                + (start - parameters) @ loose
                + (mean - parameters @ duration)[:, None] / duration_variance * duration
            )
            parameters = parameters + np.clip(
                np.linalg.solve(A + loose + duration_prior, pull[..., None])[..., 0], -0.1, 0.1
            )
            parameters[:, 1] = np.maximum(parameters[:, 1], parameters[:, 0] + _MIN_DURATION)
        covariance = np.linalg.inv(A + loose)
        free = parameters + np.einsum("kij,kj->ki", covariance, r + (start - parameters) @ loose)
        durations, durations_error = free @ duration, np.sqrt(np.einsum("i,kij,j->k", duration, covariance, duration))
    error = np.sqrt(np.einsum("i,kij,j->k", halves, covariance, halves))
    return (
        parameters,
        error,
        durations,
        durations_error,
        np.sqrt(np.einsum("i,kij,j->k", path_weights, covariance, path_weights)),
    )


def _normal(frames: _Frames, parameters: np.ndarray, shape: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the normal matrices and right-hand sides of the fits to all swings."""
    lift_off, touch_down, start_place, end_place = (parameters[:, i, None] for i in range(4))
    u = np.clip((frames.time - lift_off) / (touch_down - lift_off), 0.0, 1.0)
    course, speed = _course(shape)
    fraction, run = (
        np.interp(u, _GRID, course),
        (end_place - start_place) / (touch_down - lift_off) * np.interp(u, _GRID, speed),
    )
    J = np.stack([run * (u - 1), -run * u, 1 - fraction, fraction], axis=-1)
    residual = frames.trace - start_place - (end_place - start_place) * fraction
    spread = _spread(residual[frames.weight > 0])
    w = frames.weight / (1.0 + (residual / (_TAIL * spread)) ** 2) / spread**2
    return np.einsum("kni,kn,knj->kij", J, w, J), np.einsum("kni,kn,kn->ki", J, w, residual)


def _spread(residual: np.ndarray) -> float:
    return max(1.4826 * float(np.median(np.abs(residual))), _SHARP)


def _fit_pooled_swing(times: np.ndarray, trace: np.ndarray, share: float) -> tuple[np.ndarray, np.ndarray]:
    """Fit one swing to all frames.

    Returns:
        Lift-off and touchdown about the middle [cycle], places before and after [stride] and the shape; and the
        covariance of the first two.
    """
    expected = np.array([-share / 2, share / 2, 0.0, 1.0, *_SHAPE])
    loose = np.array([_EDGES, _EDGES, _PLACES, _PLACES, *_SHAPES])
    spread = 0.0

    def residuals(x: np.ndarray) -> np.ndarray:
        u = np.clip((times - x[0]) / max(x[1] - x[0], _MIN_DURATION), 0.0, 1.0)
        residual = trace - x[2] - (x[3] - x[2]) * np.interp(u, _GRID, _course(x[4:])[0])
        prior = (x - expected) / loose
        if x[_SOFTNESS] < expected[_SOFTNESS]:
            prior[_SOFTNESS] *= _SHAPES[0] / _EVEN_SPREAD
        return np.asarray(np.concatenate([residual / spread, prior]))

    edge = 4 * loose[:4]
    bounds = (
        np.concatenate([expected[:4] - edge, _MIN_SHAPE]),
        np.concatenate([expected[:4] + edge, _MAX_SHAPE]),
    )
    x = expected
    spread = _BLUR
    for exact in (1e-3, 1e-4, _EXACT):
        solution = least_squares(residuals, x, bounds=bounds, loss="cauchy", f_scale=_TAIL, x_scale=loose, xtol=exact)
        x = solution.x
        spread = _spread(spread * solution.fun[: -len(x)])
    slopes = np.asarray(solution.jac)
    return x, np.linalg.inv(slopes.T @ slopes)[:2, :2]


_MIN_SWINGS = 6  # swings of all feet together below which pace cannot be told from noise
_DROPPED_MARKS = 3  # marks of the fewest swings at either end of the film, which are too uncertain
_SWINGS_PER_MARK = 4  # swings whose mean is one mark of the clock: noise and a limping foot weigh little then


_MIN_PIECE = 1e-3  # [marks]; shortest part of the marks that shows a pace
_TREND_NOISE = 0.03  # relative difference of two periods that is probably noise
_TREND_REACH = 0.7  # [cycle]; from the middle of the last cycle between marks to that of what lies beyond


class Clock(NamedTuple):
    """Numbers of cycles at given times; interpolation and extrapolation are linear.

    Before the first mark and after the last one the pace is that of the nearest cycle, and its trend.
    """

    time: Float[np.ndarray, " mark"]
    """Increasing [s]."""
    cycles: Float[np.ndarray, " mark"]
    """Increasing [cycle]."""
    period: float
    """Mean of a cycle [s]."""

    def read(self, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
        """Return the time on the clock, in mean periods [s]."""
        interpolation = np.interp(time, self.time, self.cycles)
        first_period, last_period = self._end_periods()
        extrapolation = np.minimum(time - self.time[0], 0.0) / first_period
        extrapolation += np.maximum(time - self.time[-1], 0.0) / last_period
        return np.asarray(self.period * (interpolation + extrapolation))

    def seconds(self, cycles: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
        """Return the times at given numbers of cycles [s]."""
        interpolation = np.interp(cycles, self.cycles, self.time)
        first_period, last_period = self._end_periods()
        extrapolation = first_period * np.minimum(cycles - self.cycles[0], 0.0)
        extrapolation += last_period * np.maximum(cycles - self.cycles[-1], 0.0)
        return np.asarray(interpolation + extrapolation)

    def _end_periods(self) -> tuple[float, float]:
        """Return the duration of a cycle before the first mark and after the last one [s].

        It is that of the nearest cycle between marks, and its trend over the three nearest.
        """
        first_cycle, last_cycle = self.cycles[[0, -1]]
        first_periods = [self._periods(first_cycle + i, first_cycle + i + 1.0) for i in range(3)]
        last_periods = [self._periods(last_cycle - i - 1.0, last_cycle - i) for i in range(3)]
        return _with_trend(*first_periods), _with_trend(*last_periods)

    def _periods(self, start: float, end: float) -> float:
        """Return the mean period between two cycle numbers, as far as the marks go; NaN outside of them [s]."""
        start, end = max(start, float(self.cycles[0])), min(end, float(self.cycles[-1]))
        if end - start < _MIN_PIECE * (self.cycles[-1] - self.cycles[0]):
            return float("nan")
        first_time, last_time = np.interp([start, end], self.cycles, self.time)
        return float((last_time - first_time) / (end - start))


def _with_trend(nearest_period: float, second_period: float, third_period: float) -> float:
    """Return the period beyond the end of the marks from those of the nearest cycles.

    Only a trend of the same sense in all of them goes on; a small difference, or one that turns, is noise.
    """
    differences = np.array([nearest_period - second_period, second_period - third_period])
    differences = differences[np.isfinite(differences)]
    if not len(differences) or np.ptp(np.sign(differences)) > 0:
        return nearest_period
    difference = float(differences[0])
    weight = difference**2 / (difference**2 + (_TREND_NOISE * nearest_period) ** 2)
    return float(
        np.clip(nearest_period + _TREND_REACH * weight * difference, 0.7 * nearest_period, 1.4 * nearest_period)
    )


def walk_clock(feet: Mapping[str, SwingMidpoints], period: float) -> Clock:
    """Return the clock of a walk; a uniform one if too few swings were seen.

    Each foot has a constant phase lag behind the first foot on this clock.

    Args:
        feet: the middles of their swings.
        period: period of a cycle, roughly [s].
    """
    rows = [foot for foot in feet.values() if len(foot.time) >= 2]
    if sum(len(foot.time) for foot in rows) < _MIN_SWINGS:
        return Clock(np.array([0.0, period]), np.array([0.0, 1.0]), period)
    lead_foot = max(rows, key=lambda foot: (len(foot.time), -float(foot.error.mean())))
    lasts = float(np.median(np.diff(lead_foot.time)))
    cycle_numbers = _cycle_numbers(lead_foot.time, lasts)
    even_clock = Clock(
        lead_foot.time, cycle_numbers, (lead_foot.time[-1] - lead_foot.time[0]) / (cycle_numbers[-1] - cycle_numbers[0])
    )
    times, cycles, weights = [], [], []
    for foot in rows:
        phases = even_clock.read(foot.time) / even_clock.period
        lag = np.angle(np.mean(np.exp(2j * np.pi * phases))) / (2 * np.pi)
        times.append(foot.time)
        cycles.append(np.round(phases - lag) + lag)
        weights.append(1.0 / (foot.error**2 + (0.01 * lasts) ** 2))
    time, cycle, weight = (np.concatenate(columns) for columns in (times, cycles, weights))
    order = np.argsort(cycle, kind="stable")
    return _clock_of_marks(time[order], cycle[order], weight[order])


def _cycle_numbers(time: np.ndarray, lasts: float) -> np.ndarray:
    """Return the cycle number of each swing of a foot; a missing swing leaves a gap."""
    return np.concatenate([[0.0], np.cumsum(np.maximum(1.0, np.round(np.diff(time) / lasts)))])


def _clock_of_marks(time: np.ndarray, cycle: np.ndarray, weight: np.ndarray) -> Clock:
    """Return the clock through means of several successive swings; at the ends of the film, of fewer."""
    kernel = np.ones(min(_SWINGS_PER_MARK, len(time) - 1))
    total = np.convolve(weight, kernel)[_DROPPED_MARKS:-_DROPPED_MARKS]
    times = np.convolve(weight * time, kernel)[_DROPPED_MARKS:-_DROPPED_MARKS] / total
    shows = np.convolve(weight * cycle, kernel)[_DROPPED_MARKS:-_DROPPED_MARKS] / total
    steps = [np.diff(np.maximum.accumulate(row)) > 0 for row in (times, shows)]
    rises = np.concatenate([[True], steps[0] & steps[1]])
    slope = np.polyfit(time, cycle, 1, w=np.sqrt(weight))[0]
    return Clock(times[rises], shows[rises], float(1.0 / slope))

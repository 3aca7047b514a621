"""How long a foot swings, and when: from where it is over the ground.

A foot rests at one place, then moves to the next. First the middle of each swing is found by itself. Then all strides
are laid over each other, each from mid-stance to mid-stance, and one swing is fitted to them: when it begins and ends,
and how the speed runs in between,
``(1 - |2 u**s - 1|**q)**p`` over the time u of the swing, 0 to 1. q flattens the middle, p softens the ends, s hurries
one of them. How little is known of a swing's slow ends is so a part of how uncertain its edges are.

From the swings of all feet follows a clock that keeps the animal's pace: on it every stride lasts equally long.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.optimize import least_squares

_SMOOTH = 0.04  # [cycle]; standard deviation of the smoothing that separates swings, not their edges
_TURNS = 0.15  # share of the range of its path by which a foot must pass the middle, or it is noise
_HALF = 0.25  # [cycle]; what must have been filmed before and after the middle of a swing
_LEAST = 0.02  # [cycle]; shortest swing
_SHAPE, _SHAPES = np.log([1.4, 2.4, 1.0]), np.array([0.5, 0.5, 0.25])  # logarithms of p, q, s: expected, and how far
_LEAST_SHAPE, _MOST_SHAPE = np.log([0.8, 1.5, 0.6]), np.log([2.5, 6.0, 1.6])  # no foot is known to move otherwise
_EDGES, _PLACES = 0.15, 0.5  # [cycle], [stride]; the same of edges about where the foot turns, and of its places
_ROUNDS, _STEPS = 4, 4
_TAIL = 4.0  # standard deviations at which a frame counts half
_BLUR = 0.05  # [stride]; from which on frames are looked at more and more sharply
_SHARP = 4e-3  # [stride]; places are not trusted beyond
_NEAR = 0.2  # [cycle]; what is farther before and after a swing may be a slip
_UNSEEN = 0.7  # share of a swing from which on, unseen, it might begin and end anywhere within
_QUICK = 0.5  # share of its top speed from which on a foot is fast
_FAMILY = 0.02  # share of a swing; how far the best of these shapes leaves the edges of another from where they are
_MOST = 1200  # frames that are fitted at once
_EXACT = 1e-9  # relative change at which a fit is done
_GRID = np.linspace(0.0, 1.0, 161)


class Middles(NamedTuple):
    """When a foot was in the middle of each of its swings, in the order of time."""

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
    """Duration of each swing, drawn to that of all as far as noise blurs it [cycle]."""
    shares_error: Float[np.ndarray, " swing"]
    """Standard error of each, that of all included [cycle]."""
    phases_error: Float[np.ndarray, " swing"]
    """Standard error of each phase by its own frames [cycle]."""
    paths: Float[np.ndarray, " swing"]
    """Distance over the ground from each place to the next [m or px]."""
    paths_error: Float[np.ndarray, " swing"]
    """Standard error of each [m or px]."""


class _Frames(NamedTuple):
    """What is seen around each swing, from mid-stance to mid-stance; weight 0 where nothing is."""

    time: Float[np.ndarray, "swing frame"]  # [cycle]
    trace: Float[np.ndarray, "swing frame"]  # from one place to the next, in strides
    weight: Float[np.ndarray, "swing frame"]
    stride: Float[np.ndarray, " swing"]  # [m or px]


def middles(time: np.ndarray, place: np.ndarray, ahead: np.ndarray, period: float) -> Middles:
    """Return the middles of the swings that were filmed from stance to stance; there may be none.

    Args:
        time: shape (frame,) [s].
        place: of the foot over the ground, shape (frame, 2), NaN where it was not seen [m or px].
        ahead: how far it is ahead of its body, shape (frame,); it tells the swings from each other.
        period: of the cycle, roughly [s].
    """
    frames, own = _cut(time / period, place, _turns(time / period, ahead))
    if not len(own):
        return Middles(np.zeros(0), np.zeros(0))
    own, error, _, _, _ = _each(frames, own)
    return Middles(own[:, :2].mean(axis=1) * period, error * period)


def swing(time: np.ndarray, place: np.ndarray, ahead: np.ndarray, period: float) -> Swing | None:
    """Return the swing of a foot, or None if none was filmed from stance to stance.

    Args:
        time: by a clock on which every stride lasts about a period, shape (frame,) [s].
        place: see ``middles``.
        ahead: see ``middles``.
        period: of the cycle [s].
    """
    frames, own = _cut(time / period, place, _turns(time / period, ahead))
    if not len(own):
        return None
    own, error, lasts, unsure, blurred = _each(frames, own)
    middle, seen = own[:, :2].mean(axis=1), frames.weight > 0
    when = (frames.time - middle[:, None])[seen]
    trace = ((frames.trace - own[:, 2, None]) / (own[:, 3] - own[:, 2])[:, None])[seen]
    near = np.abs(when) < float(np.mean(lasts)) / 2 + _NEAR
    when, trace = _thinned(when[near], trace[near])
    found, covariance = _pooled(when, trace, float(np.mean(lasts)))
    apart, halves = np.array([-1.0, 1.0]), np.array([0.5, 0.5])
    share, half = float(found[:2] @ apart), float(found[:2] @ halves)
    fast = float(found[0] + share * _fast(found[4:]))
    gap = _gap(when, found[0], found[1])
    blind = gap / 2 if gap > _UNSEEN * share else 0.0
    share_error = float(np.linalg.norm([np.sqrt(apart @ covariance @ apart), _FAMILY * share, blind]))
    scatter = float(np.sqrt(max(0.0, np.var(lasts) - np.mean(unsure**2))))
    own_part = scatter**2 / np.maximum(scatter**2 + unsure**2, 1e-12)
    return Swing(
        phase=middle + fast,
        skew=half - fast,
        share=share,
        share_error=share_error,
        middle_error=float(np.hypot(np.sqrt(halves @ covariance @ halves), blind / 2)),
        scatter=scatter,
        shares=np.maximum(share + own_part * (lasts - np.mean(lasts)), _LEAST),
        shares_error=np.sqrt(share_error**2 + own_part * unsure**2),
        phases_error=error,
        paths=(own[:, 3] - own[:, 2]) * frames.stride,
        paths_error=blurred * frames.stride,
    )


def _gap(when: np.ndarray, start: float, end: float) -> float:
    """Return the longest time of a swing, and around it, in which no frame is [cycle]."""
    edges = np.concatenate([[start], np.sort(when), [end]])
    inside = (edges[1:] > start) & (edges[:-1] < end)
    return float(np.diff(edges)[inside].max(initial=0.0))


def _thinned(when: np.ndarray, trace: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Put frames together that are next to each other, by their medians, until they are few enough."""
    order = np.argsort(when, kind="stable")
    size = -(-len(when) // _MOST)
    use = order[: len(order) // size * size].reshape(-1, size)
    return when[use].mean(axis=1), np.median(trace[use], axis=1)


def _turns(time: np.ndarray, ahead: np.ndarray) -> Float[np.ndarray, "swing 2"]:
    """Return when a foot turns forward and back again, roughly [cycle].

    Its path along the body is smoothed; a swing is where that rises from well below the middle to well above it.
    """
    seen = np.isfinite(ahead)
    if seen.sum() < 4:
        return np.zeros((0, 2))
    step = _SMOOTH / 4
    even = np.arange(time[0], time[-1] + step, step)
    trace = np.interp(even, time[seen], ahead[seen])
    reach = np.exp(-0.5 * (np.arange(-12, 13) / 4.0) ** 2)
    smooth = np.convolve(np.pad(trace, 12, mode="edge"), reach / reach.sum(), mode="valid")
    low, high = np.percentile(smooth, [5, 95])
    middle, far = (low + high) / 2, _TURNS * (high - low)
    side = np.where(smooth > middle + far, 1, np.where(smooth < middle - far, -1, 0))
    known = np.flatnonzero(side)
    up = np.flatnonzero((side[known][:-1] < 0) & (side[known][1:] > 0))
    most, found = round(0.5 / step), []
    for last, first in zip(known[up], known[up + 1], strict=True):
        before, after = smooth[max(0, last - most) : last + 1], smooth[first : first + most]
        found.append((even[last - np.argmin(before[::-1])], even[first + int(np.argmax(after))]))
    return np.array(found).reshape(-1, 2)


def _cut(time: np.ndarray, place: np.ndarray, turns: np.ndarray) -> tuple[_Frames, np.ndarray]:
    """Return the frames around each swing and a first guess of its edges and places."""
    middle = turns.mean(axis=1)
    borders = np.concatenate([middle[:1] - 0.6, (middle[1:] + middle[:-1]) / 2, middle[-1:] + 0.6])
    seen = np.isfinite(place).all(axis=1)
    parts, own, strides = [], [], []
    for (turn, back), left, right in zip(turns, borders[:-1], borders[1:], strict=True):
        centre = (turn + back) / 2
        if centre - time[0] < _HALF or time[-1] - centre < _HALF:
            continue
        use = seen & (time >= left) & (time <= right)
        before, after = use & (time <= turn + _LEAST), use & (time >= back - _LEAST)
        if before.sum() < 2 or after.sum() < 2:
            continue
        here, there = np.median(place[before], axis=0), np.median(place[after], axis=0)
        stride = float(np.linalg.norm(there - here))
        if stride == 0.0:
            continue
        parts.append((time[use], (place[use] - here) @ (there - here) / stride**2))
        strides.append(stride)
        own.append((turn, max(back, turn + _LEAST), 0.0, 1.0))
    most = max((len(times) for times, _ in parts), default=0)
    frames = np.zeros((3, len(parts), most))
    for k, (times, trace) in enumerate(parts):
        frames[:, k, : len(times)] = times, trace, np.ones(len(times))
    return _Frames(frames[0], frames[1], frames[2], np.array(strides)), np.array(own).reshape(-1, 4)


def _course(shape: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the share of its path that a foot has covered, and its speed in paths per swing, on ``_GRID``."""
    p, q, s = np.exp(shape)
    speed = (1.0 - np.abs(2.0 * _GRID**s - 1.0) ** q) ** p
    gone = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2)])
    return gone / gone[-1], speed / gone[-1] * (len(_GRID) - 1)


def _fast(shape: np.ndarray) -> float:
    """Return where in a swing the middle of its fast part lies [swing]."""
    speed = _course(shape)[1]
    fast = np.flatnonzero(speed > _QUICK * speed.max())
    low, high = (
        np.interp(_QUICK * speed.max(), speed[i], _GRID[i])
        for i in (
            [fast[0] - 1, fast[0]],
            [fast[-1] + 1, fast[-1]],
        )
    )
    return float(low + high) / 2


def _each(frames: _Frames, start: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Fit each swing by itself, of the shape that is expected.

    Gauss and Newton's steps, in rounds in which frames far off count less. Edges are drawn to those of a swing of the
    mean duration, or noise would sharpen some swings and hide others.

    Returns:
        Lift-off, touchdown [cycle] and both places [stride] of each, the standard errors of its middle, how long it
        lasts without being drawn to the mean, and the standard error of that [cycle]; the standard error of the
        distance of its places [stride].
    """
    own, loose = start.copy(), np.diag(1.0 / np.array([_EDGES, _EDGES, _PLACES, _PLACES]) ** 2)
    duration, halves = np.array([-1.0, 1.0, 0.0, 0.0]), np.array([0.5, 0.5, 0.0, 0.0])
    far = np.array([0.0, 0.0, -1.0, 1.0])
    lasts = own @ duration
    unsure = np.full(len(own), _EDGES)
    for i in range(_ROUNDS):
        mean = float(np.median(lasts)) if i == 0 else float(np.average(lasts, weights=1.0 / (unsure**2 + _LEAST**2)))
        drawn = max(float(np.var(lasts) - np.mean(unsure**2)), (_LEAST / 2) ** 2)
        for _ in range(_STEPS):
            A, r = _normal(frames, own)
            alike = np.outer(duration, duration) / drawn
            pull = r + (start - own) @ loose + (mean - own @ duration)[:, None] / drawn * duration
            own = own + np.clip(np.linalg.solve(A + loose + alike, pull[..., None])[..., 0], -0.1, 0.1)
            own[:, 1] = np.maximum(own[:, 1], own[:, 0] + _LEAST)
        alone = np.linalg.inv(A + loose)
        free = own + np.einsum("kij,kj->ki", alone, r + (start - own) @ loose)
        lasts, unsure = free @ duration, np.sqrt(np.einsum("i,kij,j->k", duration, alone, duration))
    error = np.sqrt(np.einsum("i,kij,j->k", halves, alone, halves))
    return own, error, lasts, unsure, np.sqrt(np.einsum("i,kij,j->k", far, alone, far))


def _normal(frames: _Frames, own: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the normal matrices of the swings and their right sides."""
    off, on, here, there = (own[:, i, None] for i in range(4))
    u = np.clip((frames.time - off) / (on - off), 0.0, 1.0)
    course, speed = _course(_SHAPE)
    share, run = np.interp(u, _GRID, course), (there - here) / (on - off) * np.interp(u, _GRID, speed)
    J = np.stack([run * (u - 1), -run * u, 1 - share, share], axis=-1)
    left = frames.trace - here - (there - here) * share
    spread = _spread(left[frames.weight > 0])
    w = frames.weight / (1.0 + (left / (_TAIL * spread)) ** 2) / spread**2
    return np.einsum("kni,kn,knj->kij", J, w, J), np.einsum("kni,kn,kn->ki", J, w, left)


def _spread(left: np.ndarray) -> float:
    return max(1.4826 * float(np.median(np.abs(left))), _SHARP)


def _pooled(when: np.ndarray, trace: np.ndarray, share: float) -> tuple[np.ndarray, np.ndarray]:
    """Fit one swing to all frames.

    Returns:
        Lift-off and touchdown about the middle [cycle], places before and after [stride] and the shape; and the
        covariance of the first two.
    """
    expected = np.array([-share / 2, share / 2, 0.0, 1.0, *_SHAPE])
    loose = np.array([_EDGES, _EDGES, _PLACES, _PLACES, *_SHAPES])
    spread = 0.0

    def missed(x: np.ndarray) -> np.ndarray:
        u = np.clip((when - x[0]) / max(x[1] - x[0], _LEAST), 0.0, 1.0)
        left = trace - x[2] - (x[3] - x[2]) * np.interp(u, _GRID, _course(x[4:])[0])
        return np.asarray(np.concatenate([left / spread, (x - expected) / loose]))

    edge = 4 * loose[:4]
    bounds = (
        np.concatenate([expected[:4] - edge, _LEAST_SHAPE]),
        np.concatenate([expected[:4] + edge, _MOST_SHAPE]),
    )
    x = expected
    spread = _BLUR
    for exact in (1e-3, 1e-4, _EXACT):
        found = least_squares(missed, x, bounds=bounds, loss="cauchy", f_scale=_TAIL, x_scale=loose, xtol=exact)
        x = found.x
        spread = _spread(spread * found.fun[: -len(x)])
    slopes = np.asarray(found.jac)
    return x, np.linalg.inv(slopes.T @ slopes)[:2, :2]


_FEWEST = 6  # swings of all feet together below which pace cannot be told from noise
_TOGETHER = 4  # swings whose mean is one mark of the clock: noise and a limping foot weigh little then


class Clock(NamedTuple):
    """Times and how many cycles had passed then; in between and beyond it goes on evenly."""

    time: Float[np.ndarray, " mark"]
    """Increasing [s]."""
    cycles: Float[np.ndarray, " mark"]
    """Increasing [cycle]."""
    period: float
    """Mean of a cycle [s]."""

    def read(self, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
        """Return what the clock shows, in mean periods [s]."""
        inside = np.interp(time, self.time, self.cycles)
        beyond = np.minimum(time - self.time[0], 0.0) + np.maximum(time - self.time[-1], 0.0)
        return np.asarray(self.period * inside + beyond)

    def seconds(self, cycles: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
        """Return when the clock shows so many cycles [s]."""
        inside = np.interp(cycles, self.cycles, self.time)
        beyond = np.minimum(cycles - self.cycles[0], 0.0) + np.maximum(cycles - self.cycles[-1], 0.0)
        return np.asarray(inside + self.period * beyond)


def paced(feet: Mapping[str, Middles], period: float) -> Clock:
    """Return the clock of a walk; an even one where too few swings were seen.

    Every foot counts its own swings; the phase lag of each other foot behind the first one is the same in all
    cycles on the clock.

    Args:
        feet: the middles of their swings.
        period: of a cycle, roughly [s].
    """
    rows = [foot for foot in feet.values() if len(foot.time) >= 2]
    if sum(len(foot.time) for foot in rows) < _FEWEST:
        return Clock(np.array([0.0, period]), np.array([0.0, 1.0]), period)
    first = max(rows, key=lambda foot: (len(foot.time), -float(foot.error.mean())))
    lasts = float(np.median(np.diff(first.time)))
    counted = _counted(first.time, lasts)
    even = Clock(first.time, counted, (first.time[-1] - first.time[0]) / (counted[-1] - counted[0]))
    times, cycles, weights = [], [], []
    for foot in rows:
        shown = even.read(foot.time) / even.period
        lag = np.angle(np.mean(np.exp(2j * np.pi * shown))) / (2 * np.pi)
        times.append(foot.time)
        cycles.append(np.round(shown - lag) + lag)
        weights.append(1.0 / (foot.error**2 + (0.01 * lasts) ** 2))
    time, cycle, weight = (np.concatenate(part) for part in (times, cycles, weights))
    order = np.argsort(cycle, kind="stable")
    return _marked(time[order], cycle[order], weight[order])


def _counted(time: np.ndarray, lasts: float) -> np.ndarray:
    """Number the swings of a foot; one that was not seen is passed over."""
    return np.concatenate([[0.0], np.cumsum(np.maximum(1.0, np.round(np.diff(time) / lasts)))])


def _marked(time: np.ndarray, cycle: np.ndarray, weight: np.ndarray) -> Clock:
    """Put swings that follow each other together, and draw the clock through their means."""
    ones = np.ones(min(_TOGETHER, len(time) - 1))
    total = np.convolve(weight, ones, mode="valid")
    times = np.convolve(weight * time, ones, mode="valid") / total
    shows = np.convolve(weight * cycle, ones, mode="valid") / total
    steps = [np.diff(np.maximum.accumulate(row)) > 0 for row in (times, shows)]
    rises = np.concatenate([[True], steps[0] & steps[1]])
    slope = np.polyfit(time, cycle, 1, w=np.sqrt(weight))[0]
    return Clock(times[rises], shows[rises], float(1.0 / slope))
